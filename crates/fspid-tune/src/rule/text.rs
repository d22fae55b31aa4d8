//! A design for people.

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
        out.push_str(&format!("  source             {}\n", self.rule.source()));
        push_identified(&mut out, &self.identified);
        out.push_str(&format!("  formula            {}\n", self.formula));
        self.push_gains(&mut out);
        out.push_str(&format!("\n  closed loop        {}\n", self.verdict.sentence()));
        for plant in &self.outcome.plants {
            if self.outcome.plants.len() > 1 {
                out.push_str(&format!("  plant from {} s on\n", plant.from_s));
            }
            push_loop(&mut out, plant);
        }
        if !self.warnings.is_empty() {
            out.push_str("\nWarnings:\n");
            self.warnings.iter().for_each(|it| out.push_str(&format!("  {it}\n")));
        }
        if !self.left_out.is_empty() {
            out.push_str("\nNot in these numbers:\n");
            self.left_out.iter().for_each(|it| out.push_str(&format!("  {it}\n")));
        }
        out.push_str("\nFor the scenario's controller:\n");
        out.push_str(&self.toml());
        out
    }

    /// The lines for the scenario's controller of kind `p` or `pid`: its gains, and what else the rule gave.
    #[must_use]
    pub fn toml(&self) -> String {
        let mut out = String::new();
        out.push_str(&format!("kp = {:?}\n", self.gains.kp));
        for (name, gain) in [("ki", self.gains.ki), ("kd", self.gains.kd)] {
            if gain != 0.0 {
                out.push_str(&format!("{name} = {gain:?}\n"));
            }
        }
        // What the configuration had before is in the scenario already; a plain controller has nothing to weigh.
        if self.given.rate_gain {
            out.push_str(&format!("rate_gain = {:?}\n", self.config.rate_gain_s));
        }
        if self.given.derivative_filter {
            let filter_s = self.config.derivative.filter_s;
            out.push_str(&format!("derivative_filter_s = {filter_s:?}\n"));
        }
        if self.given.setpoint_weights {
            let weights = self.config.setpoint_weights;
            out.push_str(&format!(
                "setpoint_weights = {{ proportional = {:?}, derivative = {:?} }}\n",
                weights.proportional, weights.derivative
            ));
        }
        out
    }

    fn push_gains(&self, out: &mut String) {
        let gains = self.gains;
        let mut text = format!("kp {:.4}", gains.kp);
        for (name, gain, unit) in [("ki", gains.ki, "1/s"), ("kd", gains.kd, "s")] {
            if gain != 0.0 {
                text.push_str(&format!(", {name} {gain:.4} {unit}"));
            }
        }
        let isa = self.isa().filter(|_| self.form != Form::P);
        let times = isa.map_or(String::new(), |isa| {
            let derivative =
                if isa.td_s > 0.0 { format!(", Td {:.4} s", isa.td_s) } else { String::new() };
            format!(" (K {:.4}, Ti {:.4} s{derivative})", isa.gain, isa.ti_s)
        });
        out.push_str(&format!("  gains              {text}{times}\n"));
        let config = &self.config;
        if config.rate_gain_s != 0.0 {
            let whose = if self.given.rate_gain { "" } else { ", as it was" };
            out.push_str(&format!(
                "  rate loop          gain {:.4} s{whose}\n",
                config.rate_gain_s
            ));
        }
        if self.given.derivative_filter {
            let filter_s = config.derivative.filter_s;
            out.push_str(&format!("  derivative filter  time constant {filter_s:.4} s\n"));
        }
        if self.given.setpoint_weights {
            let weights = config.setpoint_weights;
            out.push_str(&format!(
                "  set-point weights  proportional {}, derivative {}\n",
                weights.proportional, weights.derivative
            ));
        }
    }
}

fn push_identified(out: &mut String, identified: &Identified) {
    if let Some(point) = &identified.ultimate {
        out.push_str(&format!(
            "  ultimate point     {}, exact for the sampled loop\n",
            ultimate(point)
        ));
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
        out.push_str(&format!(
            "  poles              a pair at {:.4} rad/s with damping {:.4}{third}\n",
            poles.frequency_rad_s, poles.damping
        ));
    }
    if let Some(search) = &identified.search {
        let [kp, ki, rate] = search.start;
        out.push_str(&format!(
            "  search             from kp {kp:.4}, ki {ki:.4}, rate gain {rate:.4} of cost {:.6} to cost {:.6} in {} evaluations\n",
            search.start_cost, search.cost, search.evaluations
        ));
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
    out.push_str(&format!(
        "  relay              ± {:.4} deg, hysteresis {:.4} deg: oscillation of {:.4} deg, period {:.4} s, settled at {:.1} s after {} cycles\n",
        degrees(relay.amplitude_rad),
        degrees(relay.hysteresis_rad),
        degrees(relay.oscillation_rad),
        relay.period_s,
        relay.settled_s,
        relay.cycles
    ));
    out.push_str(&format!(
        "  by the relay       {}, from a phase of {:.1} deg; this is what the rule was given\n",
        ultimate(&relay.ultimate),
        relay.phase_deg
    ));
}

fn push_model(out: &mut String, fitted: &FittedModel) {
    let values =
        fitted.model.parameters().into_iter().map(|ModelParameter { name, value, unit }| {
            let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
            format!("{name} {value:.4}{unit}")
        });
    let mut values = values.collect::<Vec<_>>().join(", ");
    if let Some(relative) = fitted.model.relative_dead_time() {
        values.push_str(&format!("; L/(L + T) {relative:.3}"));
    }
    let [low, high] = fitted.band_rad_s;
    out.push_str(&format!("  model              {}: {values}\n", fitted.model.equation()));
    out.push_str(&format!(
        "  fit                to {}; off by up to {:.1} % from {low:.3} to {high:.3} rad/s\n",
        fitted.how,
        100.0 * fitted.fit_error
    ));
}

fn push_loop(out: &mut String, plant: &PlantLoop) {
    match &plant.margins {
        Ok(margins) => push_margins(out, margins),
        Err(reason) => out.push_str(&format!("  no margins         {reason}\n")),
    }
    let dt_s = plant.worst.open.dt_s();
    if let Some(mode) = least_damped(plant) {
        out.push_str(&format!(
            "  least damped mode  damping {:.3} at {:.3} rad/s\n",
            mode.damping_ratio, mode.natural_frequency_rad_s
        ));
    }
    let radius = plant.worst.closed_poles.iter().map(|pole| modulus(*pole)).fold(0.0, f64::max);
    if radius < 1.0 {
        let slowest_s = -dt_s / libm::log(radius);
        out.push_str(&format!("  slowest mode       time constant {slowest_s:.3} s\n"));
    }
}

fn push_margins(out: &mut String, margins: &Margins) {
    let [low, high] = margins.gain_margin_db;
    let end =
        |db: f64| if db.is_finite() { format!("{db:+.2} dB") } else { "without end".to_owned() };
    out.push_str(&format!("  gain margin        {} and {}\n", end(low), end(high)));
    let phase = match margins.gain_crossover_rad_s {
        Some(omega) => format!("{:.2} deg at {omega:.3} rad/s", margins.phase_margin_deg),
        None => "without end".to_owned(),
    };
    out.push_str(&format!("  phase margin       {phase}\n"));
    out.push_str(&format!(
        "  disk margin        {:.4}; sensitivity peak {:.4}\n",
        margins.disk_margin, margins.sensitivity_peak
    ));
}
