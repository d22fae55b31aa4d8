//! Which samples a program has held, of one that tells its faults latched.
//!
//! A fault is news once, and what the guard of a program is nobody says. But a sample that is held is answered by the last
//! answer once more, and one that is smaller than another which was believed is believed as well.

use fspid_core::{Faults, Sample, Step};

/// Faults at which a controller holds its command.
pub(super) const HOLDING: [Faults; 3] = [Faults::NOT_FINITE, Faults::IMPLAUSIBLE, Faults::OVERFLOW];

/// Those that a program tells of samples that it does not believe. One of 32 bits may find a sample infinite that is not.
const UNBELIEVED: [Faults; 2] = [Faults::NOT_FINITE, Faults::IMPLAUSIBLE];

/// What was learnt of a program in a flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Latched {
    /// Faults that it has told so far.
    faults: Faults,
    /// Its last answer.
    last: Option<Step<f64>>,
    /// The largest angle that it has believed, rad.
    angle_rad: f64,
    /// The largest rate that it has believed or has no use for, rad/s.
    rate_rad_s: f64,
}

impl Latched {
    /// Before the first sample.
    pub(super) const NONE: Self =
        Self { faults: Faults::NONE, last: None, angle_rad: 0.0, rate_rad_s: 0.0 };

    /// The faults of this sample, of which the angles are finite, by its answer.
    pub(super) fn fault(&mut self, sample: Sample<f64>, step: &Step<f64>) -> Faults {
        let is_finite = sample.rate_rad_s.is_finite();
        // Only a rate can have latched that, and does so each time.
        let before = if is_finite { self.faults } else { self.faults.without(Faults::NOT_FINITE) };
        let told = step.faults.without(before);
        let fault = match HOLDING.iter().any(|&it| told.contains(it)) {
            true => told,
            false => self.silent(sample, step).unwrap_or(told),
        };
        if !HOLDING.iter().any(|&it| fault.contains(it)) {
            self.believe(sample);
        }
        self.faults = step.faults;
        self.last = Some(*step);
        fault
    }

    fn believe(&mut self, sample: Sample<f64>) {
        let (angle_rad, rate_rad_s) = sizes(sample);
        self.angle_rad = self.angle_rad.max(angle_rad);
        if rate_rad_s.is_finite() {
            self.rate_rad_s = self.rate_rad_s.max(rate_rad_s);
        }
    }

    /// The fault for which it held a sample without a word, since it told that fault before.
    fn silent(&self, sample: Sample<f64>, step: &Step<f64>) -> Option<Faults> {
        // What moves was not held.
        self.last.filter(|last| is_again(last, step))?;
        let refuses = UNBELIEVED.iter().any(|&it| self.faults.contains(it));
        let (angle_rad, rate_rad_s) = sizes(sample);
        let believed =
            angle_rad <= self.angle_rad && rate_rad_s <= self.rate_rad_s.max(self.angle_rad);
        match believed {
            false if refuses => Some(Faults::IMPLAUSIBLE),
            _ => self.faults.contains(Faults::OVERFLOW).then_some(Faults::OVERFLOW),
        }
    }
}

/// The larger angle, rad, and the rate, rad/s, without signs.
fn sizes(sample: Sample<f64>) -> (f64, f64) {
    let angle_rad = sample.setpoint_rad.abs().max(sample.measurement_rad.abs());
    (angle_rad, sample.rate_rad_s.abs())
}

/// True for the last answer once more: a command that is held is cut by no limit.
fn is_again(last: &Step<f64>, step: &Step<f64>) -> bool {
    let numbers = |step: &Step<f64>| {
        [step.command_rad, step.gains.kp, step.gains.ki, step.gains.kd].map(f64::to_bits)
    };
    !step.saturated && numbers(last) == numbers(step)
}
