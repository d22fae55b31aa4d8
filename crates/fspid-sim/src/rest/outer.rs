//! Steady state of a self-tuning outer loop around the pitch loop: the gains and slopes that it rests with.

use fspid_core::{Fspid, Gains, IntegralForm, SecondInput};

use super::{
    Held, Holding, Rest, RestPoint, Side, integrates, is_the_same_everywhere, leakage_per_s,
};

/// A target and a command of less than this are none: a trim is found to some 10⁻¹² of its speed.
const NOTHING: f64 = 1e-6;

impl Rest {
    /// The rest of a self-tuner of an outer loop that holds `target` with `command`, in the units of the controller: one side
    /// without constants that its gains multiply. None where that is not known: without an integral, which
    /// leaves an error; for gains that gather without end, and where the supervisor sees a rate.
    pub(crate) fn of_outer_loop(
        fspid: &Fspid<f64>,
        gains: Gains<f64>,
        [target, command]: [f64; 2],
    ) -> Option<Self> {
        if is_the_same_everywhere(fspid, 0.0) {
            return Some(Self::still(gains));
        }
        let (config, settings) = (fspid.config_at(gains), fspid.tuner().settings());
        let weight = fspid.config().setpoint_weights.proportional;
        let by_weight = config.setpoint_weights.proportional - 1.0;
        let coupled = settings.gain_coupling.setpoint_weight * gains.kp;
        let is_literal = config.integral == IntegralForm::Literal && gains.ki != 0.0;
        let integral = command - (gains.kp * by_weight + config.feedforward) * target;
        let held = Held {
            by_kp: (by_weight + coupled) * target,
            by_ki: if is_literal { integral / gains.ki } else { 0.0 },
            by_kd: 0.0,
        };
        let is_plain = (weight - 1.0) == 0.0 && settings.gain_coupling.setpoint_weight == 0.0;
        let has_target = !(is_plain || target.abs() <= NOTHING);
        let has_integral = is_literal && !(integral.abs() <= NOTHING);
        let leaves_error = !integrates(fspid) && (has_target || !(command.abs() <= NOTHING));
        if !(has_target || has_integral || leaves_error) {
            return Some(Self::still(gains));
        }
        let leakage_per_s = leakage_per_s(fspid);
        if leaves_error || leakage_per_s == Some(0.0) || settings.second_input == SecondInput::Rate
        {
            return None;
        }
        let holding = Holding { fspid, command_per_pitch: 0.0, gains, leakage_per_s };
        let is_silent = holding.is_silent([0.0; 2]);
        Some(holding.around(RestPoint::TRIM, (gains, held), [0.0; 2], is_silent))
    }

    /// True where nothing is added to these gains.
    pub(crate) fn adds_nothing_to(&self, gains: Gains<f64>) -> bool {
        self.sides == [Side::still(gains)]
    }

    /// True for a supervisor that sees how the error changes beside the error, and for none that sees the error twice.
    pub(crate) fn sees_change(&self) -> bool {
        matches!(self.second_input, SecondInput::Change)
    }
}

#[cfg(test)]
mod tests;
