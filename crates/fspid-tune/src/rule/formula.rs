//! The formulas: from an ultimate point or a model to gains.

use super::Form;
use super::isa::Isa;
use super::model::Model;
use super::ultimate::UltimatePoint;

/// Lag at the natural frequency of the ITAE polynomial that may come from the dead time it leaves out. Twice as much
/// makes three of the project's five plants unstable.
const LAG_RAD: f64 = 0.25;

/// Gains with the formula that gave them.
pub(super) struct Computed {
    pub(super) isa: Isa,
    pub(super) formula: &'static str,
    /// Weight of the set-point in the proportional term, where the rule has one.
    pub(super) setpoint_weight: Option<f64>,
    pub(super) warnings: Vec<String>,
}

impl Computed {
    fn new(isa: Isa, formula: &'static str) -> Self {
        Self { isa, formula, setpoint_weight: None, warnings: Vec::new() }
    }

    fn weighted(self, weight: f64) -> Self {
        Self { setpoint_weight: Some(weight), ..self }
    }

    fn warned(mut self, applies: bool, warning: impl FnOnce() -> String) -> Self {
        if applies {
            self.warnings.push(warning());
        }
        self
    }
}

/// Ziegler and Nichols (1942), table of the ultimate-sensitivity method.
pub(super) fn ziegler_nichols(point: &UltimatePoint, form: Form) -> Computed {
    let UltimatePoint { gain: ku, period_s: tu, .. } = *point;
    match form {
        Form::P => Computed::new(Isa::proportional(0.5 * ku), "Kc = 0.5 Ku"),
        Form::Pi => Computed::new(
            Isa { gain: 0.45 * ku, ti_s: tu / 1.2, td_s: 0.0 },
            "Kc = 0.45 Ku, Ti = Tu/1.2",
        ),
        Form::Pid => Computed::new(
            Isa { gain: 0.6 * ku, ti_s: 0.5 * tu, td_s: 0.125 * tu },
            "Kc = 0.6 Ku, Ti = Tu/2, Td = Tu/8",
        ),
    }
}

/// Tyreus and Luyben (1992), Luyben (1996) for PID.
pub(super) fn tyreus_luyben(point: &UltimatePoint, form: Form) -> Computed {
    let UltimatePoint { gain: ku, period_s: tu, .. } = *point;
    match form {
        Form::P | Form::Pi => Computed::new(
            Isa { gain: ku / 3.2, ti_s: 2.2 * tu, td_s: 0.0 },
            "Kc = Ku/3.2, Ti = 2.2 Tu",
        ),
        Form::Pid => Computed::new(
            Isa { gain: ku / 2.2, ti_s: 2.2 * tu, td_s: tu / 6.3 },
            "Kc = Ku/2.2, Ti = 2.2 Tu, Td = Tu/6.3",
        ),
    }
}

/// Skogestad (2003), table 1; the series form of the paper is turned into the parallel one. $\tau_c = L$ by default.
pub(super) fn simc(model: &Model, closed_loop_s: Option<f64>) -> Computed {
    let tau = closed_loop_s.unwrap_or_else(|| model.dead_s());
    let sum = tau + model.dead_s();
    match *model {
        Model::Lag { gain, time_s, .. } => Computed::new(
            Isa { gain: time_s / (gain * sum), ti_s: time_s.min(4.0 * sum), td_s: 0.0 },
            "Kc = T/(K (tau_c + L)), Ti = min(T, 4 (tau_c + L))",
        ),
        Model::Integrator { slope, .. } => Computed::new(
            Isa { gain: 1.0 / (slope * sum), ti_s: 4.0 * sum, td_s: 0.0 },
            "Kc = 1/(K' (tau_c + L)), Ti = 4 (tau_c + L)",
        ),
        Model::TwoLags { gain, time_s: [first, second], .. } => Computed::new(
            Isa::from_series(first / (gain * sum), first.min(4.0 * sum), second),
            "series form: Kc = T1/(K (tau_c + L)), Ti = min(T1, 4 (tau_c + L)), Td = T2",
        ),
        Model::IntegratorLag { slope, time_s, .. } => Computed::new(
            Isa::from_series(1.0 / (slope * sum), 4.0 * sum, time_s),
            "series form: Kc = 1/(K' (tau_c + L)), Ti = 4 (tau_c + L), Td = T2",
        ),
    }
    .warned(tau < model.dead_s(), || {
        format!("tau_c = {tau:.4} s is shorter than the dead time of {:.4} s: Skogestad's recommendation for robustness is tau_c >= L", model.dead_s())
    })
}

/// Lambda tuning: Dahlin (1968) for pi, Rivera, Morari and Skogestad (1986) for pid, Chien and Fruehauf (1990) for
/// integrating processes. $\lambda = T$ by default, $3 L$ where there is no T or where it is longer.
pub(super) fn lambda(model: &Model, form: Form, closed_loop_s: Option<f64>) -> Computed {
    let dead = model.dead_s();
    let cautious = 3.0 * dead;
    match (*model, form) {
        (Model::Lag { gain, time_s, .. }, Form::Pid) => {
            let lambda = closed_loop_s.unwrap_or(time_s.max(cautious));
            let half = 0.5 * dead;
            let isa = Isa {
                gain: (half + time_s) / (gain * (half + lambda)),
                ti_s: time_s + half,
                td_s: time_s * dead / (dead + 2.0 * time_s),
            };
            Computed::new(
                isa,
                "Kc = (L/2 + T)/(K (L/2 + lambda)), Ti = T + L/2, Td = T L/(L + 2 T)",
            )
        }
        (Model::Lag { gain, time_s, .. }, _) => {
            let lambda = closed_loop_s.unwrap_or(time_s.max(cautious));
            let isa = Isa { gain: time_s / (gain * (lambda + dead)), ti_s: time_s, td_s: 0.0 };
            Computed::new(isa, "Kc = T/(K (lambda + L)), Ti = T")
        }
        (model, form) => {
            let slope = slope_of(&model);
            let lambda = closed_loop_s.unwrap_or(cautious);
            let ti_s = 2.0 * lambda + dead;
            if form == Form::Pid {
                let sum = lambda + 0.5 * dead;
                let td_s = (lambda * dead + 0.25 * dead * dead) / ti_s;
                return Computed::new(
                    Isa { gain: ti_s / (slope * sum * sum), ti_s, td_s },
                    "Kc = (2 lambda + L)/(K' (lambda + L/2)^2), Ti = 2 lambda + L, Td = (lambda L + L^2/4)/(2 lambda + L)",
                );
            }
            let sum = lambda + dead;
            Computed::new(
                Isa { gain: ti_s / (slope * sum * sum), ti_s, td_s: 0.0 },
                "Kc = (2 lambda + L)/(K' (lambda + L)^2), Ti = 2 lambda + L",
            )
        }
    }
}

/// Åström and Hägglund (2004): AMIGO. Set-point weight 0 for τ = L/(L + T) up to a half, 1 above.
pub(super) fn amigo(model: &Model, form: Form) -> Computed {
    let dead = model.dead_s();
    match (*model, form) {
        (Model::Lag { gain, time_s, .. }, Form::Pid) => {
            let isa = Isa {
                gain: (0.2 + 0.45 * time_s / dead) / gain,
                ti_s: dead * (0.4 * dead + 0.8 * time_s) / (dead + 0.1 * time_s),
                td_s: 0.5 * dead * time_s / (0.3 * dead + time_s),
            };
            let formula = "Kc = (0.2 + 0.45 T/L)/K, Ti = L (0.4 L + 0.8 T)/(L + 0.1 T), Td = 0.5 L T/(0.3 L + T)";
            Computed::new(isa, formula).weighted(weight(dead, time_s))
        }
        (Model::Lag { gain, time_s, .. }, _) => {
            let sum = dead + time_s;
            let bend = 0.35 - dead * time_s / (sum * sum);
            let below = time_s * time_s + 12.0 * dead * time_s + 7.0 * dead * dead;
            let isa = Isa {
                gain: (0.15 + bend * time_s / dead) / gain,
                ti_s: 0.35 * dead + 13.0 * dead * time_s * time_s / below,
                td_s: 0.0,
            };
            let formula = "Kc = (0.15 + (0.35 - L T/(L + T)^2) T/L)/K, Ti = 0.35 L + 13 L T^2/(T^2 + 12 L T + 7 L^2)";
            Computed::new(isa, formula).weighted(weight(dead, time_s))
        }
        (model, Form::Pid) => {
            let gain = 0.45 / (slope_of(&model) * dead);
            let isa = Isa { gain, ti_s: 8.0 * dead, td_s: 0.5 * dead };
            Computed::new(isa, "integrating: Kc = 0.45/(K' L), Ti = 8 L, Td = 0.5 L").weighted(0.0)
        }
        (model, _) => {
            let gain = 0.35 / (slope_of(&model) * dead);
            let isa = Isa { gain, ti_s: 13.4 * dead, td_s: 0.0 };
            Computed::new(isa, "integrating: Kc = 0.35/(K' L), Ti = 13.4 L").weighted(0.0)
        }
    }
}

fn weight(dead_s: f64, time_s: f64) -> f64 {
    if dead_s <= time_s { 0.0 } else { 1.0 }
}

/// Rovira, Murrill and Smith (1969): least ITAE after a step of the set-point, for lags with 0.1 ≤ L/T ≤ 1.
pub(super) fn rovira([gain, time_s, dead_s]: [f64; 3], form: Form) -> Computed {
    let ratio = dead_s / time_s;
    let given = if form == Form::Pid {
        let isa = Isa {
            gain: 0.965 * libm::pow(ratio, -0.85) / gain,
            ti_s: time_s / (0.796 - 0.1465 * ratio),
            td_s: 0.308 * time_s * libm::pow(ratio, 0.929),
        };
        let formula =
            "Kc = 0.965 (L/T)^-0.85/K, Ti = T/(0.796 - 0.1465 L/T), Td = 0.308 T (L/T)^0.929";
        Computed::new(isa, formula)
    } else {
        let isa = Isa {
            gain: 0.586 * libm::pow(ratio, -0.916) / gain,
            ti_s: time_s / (1.03 - 0.165 * ratio),
            td_s: 0.0,
        };
        Computed::new(isa, "Kc = 0.586 (L/T)^-0.916/K, Ti = T/(1.03 - 0.165 L/T)")
    };
    given.warned(!(0.1..=1.0).contains(&ratio), || {
        format!("L/T = {ratio:.3} is outside of 0.1 to 1, for which the formulas were fitted")
    })
}

/// Graham and Lathrop (1953): gains of an integrating model, its dead time left out, that make the characteristic
/// polynomial the one of least ITAE after a step. The set-point enters through the integral alone, so that no zero
/// spoils the step.
///
/// $$ s^3 + 1.75 \omega s^2 + 2.15 \omega^2 s + \omega^3, \qquad s^2 + 1.4 \omega s + \omega^2 $$
///
/// $\omega = 0.25 / L$ by default: a quarter of a radian of lag that the polynomial does not know of.
pub(super) fn graham_lathrop(model: &Model, form: Form, omega_rad_s: Option<f64>) -> Computed {
    let (slope, dead) = (slope_of(model), model.dead_s());
    let omega = omega_rad_s.unwrap_or(LAG_RAD / dead);
    let given = match *model {
        Model::IntegratorLag { time_s, .. } if form == Form::Pid && 1.75 * omega * time_s > 1.0 => {
            let square = omega * omega * time_s;
            let kp = 2.15 * square / slope;
            let isa = Isa {
                gain: kp,
                ti_s: 2.15 / omega,
                td_s: (1.75 * omega * time_s - 1.0) / (2.15 * square),
            };
            Computed::new(isa, "kp = 2.15 w^2 T2/K', ki = w^3 T2/K', kd = (1.75 w T2 - 1)/K'")
        }
        _ => {
            let isa = Isa { gain: 1.4 * omega / slope, ti_s: 1.4 / omega, td_s: 0.0 };
            Computed::new(isa, "kp = 1.4 w/K', ki = w^2/K'").warned(form == Form::Pid, || {
                format!("the polynomial of third order needs a second time constant with 1.75 w T2 > 1 at w = {omega:.3} rad/s, and the model has none: the one of second order was taken")
            })
        }
    };
    let lag = omega * dead;
    given.weighted(0.0).warned(lag > LAG_RAD * (1.0 + 1e-9), || {
        format!("w L = {lag:.2} rad: the dead time that the polynomial leaves out is not small")
    })
}

/// K' of an integrating model; of a lag the slope that it starts with.
fn slope_of(model: &Model) -> f64 {
    match *model {
        Model::Lag { gain, time_s, .. } => gain / time_s,
        Model::TwoLags { gain, time_s: [first, _], .. } => gain / first,
        Model::Integrator { slope, .. } | Model::IntegratorLag { slope, .. } => slope,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lag(gain: f64, time_s: f64, dead_s: f64) -> Model {
        Model::Lag { gain, time_s, dead_s }
    }

    #[track_caller]
    fn is(found: Isa, wanted: [f64; 3], digit: f64) {
        let found = [found.gain, found.ti_s, found.td_s];
        for (found, wanted) in found.into_iter().zip(wanted) {
            assert!((found - wanted).abs() <= 0.5 * digit, "{found} for {wanted}");
        }
    }

    #[test]
    fn amigo_gives_the_gains_of_its_authors_examples() {
        // K. J. Astrom and T. Hagglund, Advanced PID Control (2006), the lag-dominated and the balanced example, to
        // the digits printed there.
        let dominated = amigo(&lag(1.0, 1.04, 0.075), Form::Pid);
        is(dominated.isa, [6.44, 0.361, 0.0367], 1e-2);
        assert_eq!(dominated.setpoint_weight, Some(0.0));
        is(amigo(&lag(1.0, 2.9, 1.42), Form::Pid).isa, [1.12, 2.40, 0.619], 1e-2);
        assert_eq!(amigo(&lag(1.0, 0.1, 1.0), Form::Pid).setpoint_weight, Some(1.0));
    }

    #[test]
    fn simc_gives_the_gains_of_its_author_s_example() {
        // Skogestad (2003), process E1, 1/((s + 1)(0.2 s + 1)): by the half rule T = 1.1 and L = 0.1.
        is(simc(&lag(1.0, 1.1, 0.1), None).isa, [5.5, 0.8, 0.0], 1e-12);
        let quick = simc(&lag(1.0, 1.1, 0.1), Some(0.05));
        assert!(quick.warnings.iter().any(|it| it.contains("shorter than the dead time")));
    }

    #[test]
    fn an_integrator_is_the_limit_of_a_slow_lag() {
        // K/(T s + 1) with K = K' T and T without end.
        let (slow, integrator) =
            (lag(1e9, 1e9, 0.5), Model::Integrator { slope: 1.0, dead_s: 0.5 });
        let near = |one: Isa, other: Isa| {
            let off =
                [one.gain / other.gain, one.ti_s / other.ti_s].map(|ratio| (ratio - 1.0).abs());
            assert!(off.iter().all(|off| *off < 5e-3), "{one:?} {other:?}");
        };
        near(simc(&slow, None).isa, simc(&integrator, None).isa);
        near(amigo(&slow, Form::Pid).isa, amigo(&integrator, Form::Pid).isa);
        near(amigo(&slow, Form::Pi).isa, amigo(&integrator, Form::Pi).isa);
    }

    #[test]
    fn formulas_say_when_they_are_used_beyond_what_they_were_fitted_to() {
        assert!(rovira([1.0, 1.0, 0.5], Form::Pid).warnings.is_empty());
        assert_eq!(rovira([1.0, 1.0, 1.5], Form::Pid).warnings.len(), 1);
        assert_eq!(rovira([1.0, 1.0, 0.05], Form::Pi).warnings.len(), 1);
        let model = Model::Integrator { slope: 1.0, dead_s: 0.5 };
        assert_eq!(graham_lathrop(&model, Form::Pi, Some(2.0)).warnings.len(), 1);
        assert!(graham_lathrop(&model, Form::Pi, None).warnings.is_empty());
    }
}
