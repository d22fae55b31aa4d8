//! A design for people.

use fspid_diagnostics::lines::{add, line};
use fspid_lti::modulus;
use fspid_scenario::units::degrees;
use fspid_study::analysis::{Margins, PlantLoop};

use super::outcome::least_damped;
use super::{
    Design, FittedModel, Form, Identified, ModelParameter, RelayExperiment, UltimatePoint,
};

impl Design {
    /// What was found out, the gains, what came of them, and the lines for the scenario's controller at the end.
    #[must_use]
    pub fn text(&self) -> String {
        let mut out = format!("{}: {}, {}\n", self.scenario, self.rule.name(), self.form.name());
        line(&mut out, format_args!("  source             {}", self.rule.source()));
        push_identified(&mut out, &self.identified);
        line(&mut out, format_args!("  formula            {}", self.formula));
        self.push_gains(&mut out);
        line(&mut out, format_args!("\n  closed loop        {}", self.verdict.sentence()));
        for plant in &self.outcome.plants {
            if self.outcome.plants.len() > 1 {
                line(&mut out, format_args!("  plant from {} s on", plant.from_s));
            }
            push_loop(&mut out, plant);
        }
        if !self.warnings.is_empty() {
            out.push_str("\nWarnings:\n");
            self.warnings.iter().for_each(|it| line(&mut out, format_args!("  {it}")));
        }
        if !self.left_out.is_empty() {
            out.push_str("\nNot in these numbers:\n");
            self.left_out.iter().for_each(|it| line(&mut out, format_args!("  {it}")));
        }
        out.push_str("\nFor the scenario's controller:\n");
        out.push_str(&self.toml());
        out
    }

    /// The lines for the scenario's controller of kind `p` or `pid`: its gains, and what else the rule gave.
    #[must_use]
    pub fn toml(&self) -> String {
        let mut out = String::new();
        line(&mut out, format_args!("kp = {:?}", self.gains.kp));
        for (name, gain) in [("ki", self.gains.ki), ("kd", self.gains.kd)] {
            if gain != 0.0 {
                line(&mut out, format_args!("{name} = {gain:?}"));
            }
        }
        // What the configuration had before is in the scenario already; a plain controller has nothing to weigh.
        if self.given.rate_gain {
            line(&mut out, format_args!("rate_gain = {:?}", self.config.rate_gain_s));
        }
        if self.given.derivative_filter {
            let filter_s = self.config.derivative.filter_s;
            line(&mut out, format_args!("derivative_filter_s = {filter_s:?}"));
        }
        if self.given.setpoint_weights {
            let weights = self.config.setpoint_weights;
            line(
                &mut out,
                format_args!(
                    "setpoint_weights = {{ proportional = {:?}, derivative = {:?} }}",
                    weights.proportional, weights.derivative
                ),
            );
        }
        out
    }

    fn push_gains(&self, out: &mut String) {
        let gains = self.gains;
        let mut text = format!("kp {:.4}", gains.kp);
        for (name, gain, unit) in [("ki", gains.ki, "1/s"), ("kd", gains.kd, "s")] {
            if gain != 0.0 {
                add(&mut text, format_args!(", {name} {gain:.4} {unit}"));
            }
        }
        let isa = self.isa().filter(|_| self.form != Form::P);
        let times = isa.map_or(String::new(), |isa| {
            let derivative =
                if isa.td_s > 0.0 { format!(", Td {:.4} s", isa.td_s) } else { String::new() };
            format!(" (K {:.4}, Ti {:.4} s{derivative})", isa.gain, isa.ti_s)
        });
        line(out, format_args!("  gains              {text}{times}"));
        let config = &self.config;
        if config.rate_gain_s != 0.0 {
            let whose = if self.given.rate_gain { "" } else { ", as it was" };
            line(out, format_args!("  rate loop          gain {:.4} s{whose}", config.rate_gain_s));
        }
        if self.given.derivative_filter {
            let filter_s = config.derivative.filter_s;
            line(out, format_args!("  derivative filter  time constant {filter_s:.4} s"));
        }
        if self.given.setpoint_weights {
            let weights = config.setpoint_weights;
            line(
                out,
                format_args!(
                    "  set-point weights  proportional {}, derivative {}",
                    weights.proportional, weights.derivative
                ),
            );
        }
    }
}

fn push_identified(out: &mut String, identified: &Identified) {
    if let Some(point) = &identified.ultimate {
        line(
            out,
            format_args!("  ultimate point     {}, exact for the sampled loop", ultimate(point)),
        );
    }
    if let Some(relay) = &identified.relay {
        push_relay(out, relay);
    }
    if let Some(fitted) = &identified.model {
        push_model(out, fitted);
    }
    if let Some(poles) = &identified.poles {
        let third =
            poles.third_per_s.map_or(String::new(), |pole| format!(", and one at {pole:.4} 1/s"));
        line(
            out,
            format_args!(
                "  poles              a pair at {:.4} rad/s with damping {:.4}{third}",
                poles.frequency_rad_s, poles.damping
            ),
        );
    }
    if let Some(search) = &identified.search {
        let [kp, ki, rate] = search.start;
        line(
            out,
            format_args!(
                "  search             from kp {kp:.4}, ki {ki:.4}, rate gain {rate:.4} of cost {:.6} to cost {:.6} in {} evaluations",
                search.start_cost, search.cost, search.evaluations
            ),
        );
    }
}

fn ultimate(point: &UltimatePoint) -> String {
    format!(
        "gain Ku {:.4}, period Tu {:.4} s ({:.4} rad/s)",
        point.gain,
        point.period_s,
        point.frequency_rad_s()
    )
}

fn push_relay(out: &mut String, relay: &RelayExperiment) {
    line(
        out,
        format_args!(
            "  relay              ± {:.4} deg, hysteresis {:.4} deg: oscillation of {:.4} deg, period {:.4} s, settled at {:.1} s after {} cycles",
            degrees(relay.amplitude_rad),
            degrees(relay.hysteresis_rad),
            degrees(relay.oscillation_rad),
            relay.period_s,
            relay.settled_s,
            relay.cycles
        ),
    );
    line(
        out,
        format_args!(
            "  by the relay       {}, from a phase of {:.1} deg; this is what the rule was given",
            ultimate(&relay.ultimate),
            relay.phase_deg
        ),
    );
}

fn push_model(out: &mut String, fitted: &FittedModel) {
    let values =
        fitted.model.parameters().into_iter().map(|ModelParameter { name, value, unit }| {
            let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
            format!("{name} {value:.4}{unit}")
        });
    let mut values = values.collect::<Vec<_>>().join(", ");
    if let Some(relative) = fitted.model.relative_dead_time() {
        add(&mut values, format_args!("; L/(L + T) {relative:.3}"));
    }
    let [low, high] = fitted.band_rad_s;
    line(out, format_args!("  model              {}: {values}", fitted.model.equation()));
    line(
        out,
        format_args!(
            "  fit                to {}; off by up to {:.1} % from {low:.3} to {high:.3} rad/s",
            fitted.how,
            100.0 * fitted.fit_error
        ),
    );
}

fn push_loop(out: &mut String, plant: &PlantLoop) {
    match &plant.margins {
        Ok(margins) => push_margins(out, margins),
        Err(reason) => line(out, format_args!("  no margins         {reason}")),
    }
    let dt_s = plant.worst.open.dt_s();
    if let Some(mode) = least_damped(plant) {
        line(
            out,
            format_args!(
                "  least damped mode  damping {:.3} at {:.3} rad/s",
                mode.damping_ratio, mode.natural_frequency_rad_s
            ),
        );
    }
    let radius = plant.worst.closed_poles.iter().map(|pole| modulus(*pole)).fold(0.0, f64::max);
    if radius < 1.0 {
        let slowest_s = -dt_s / libm::log(radius);
        line(out, format_args!("  slowest mode       time constant {slowest_s:.3} s"));
    }
}

fn push_margins(out: &mut String, margins: &Margins) {
    let [low, high] = margins.gain_margin_db;
    let end =
        |db: f64| if db.is_finite() { format!("{db:+.2} dB") } else { "without end".to_owned() };
    line(out, format_args!("  gain margin        {} and {}", end(low), end(high)));
    let phase = match margins.gain_crossover_rad_s {
        Some(omega) => format!("{:.2} deg at {omega:.3} rad/s", margins.phase_margin_deg),
        None => "without end".to_owned(),
    };
    line(out, format_args!("  phase margin       {phase}"));
    line(
        out,
        format_args!(
            "  disk margin        {:.4}; sensitivity peak {:.4}",
            margins.disk_margin, margins.sensitivity_peak
        ),
    );
}
