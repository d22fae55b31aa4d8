//! What counts for a requirement, and in which air.

use crate::units::FOOT_M;
use fspid_diagnostics::digits::to_digits;

/// Which air a flight must be in for a requirement to be asked of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Air {
    /// Still, or moving steadily.
    Smooth,
    /// With turbulence.
    Turbulent,
}

impl Air {
    /// The words in files.
    pub(crate) const NAMES: [&'static str; 2] = ["smooth", "turbulent"];

    /// The word in files and answers.
    #[must_use]
    pub const fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }

    /// The air with this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        [Self::Smooth, Self::Turbulent].into_iter().find(|air| air.name() == name)
    }
}

/// What counts for a requirement; a condition that is not given leaves everything in.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Conditions {
    /// Only steps of the command of this size, either way, deg.
    pub step_deg: Option<f64>,
    /// Band about the set-point that a recovery ends in, deg.
    pub within_deg: Option<f64>,
    /// Start of the time that counts, s.
    pub from_s: Option<f64>,
    /// End of the time that counts, s.
    pub to_s: Option<f64>,
    /// Lowest frequency that counts, Hz.
    pub from_hz: Option<f64>,
    /// Frequency from which on nothing counts, Hz.
    pub to_hz: Option<f64>,
    /// Altitude that is aimed at, ft.
    pub target_ft: Option<f64>,
    /// The same in m.
    pub target_m: Option<f64>,
    /// The air that it is asked in.
    pub air: Option<Air>,
}

/// Of a step's size: how far a step may be from the size that is asked for, so that 0.2 rad may be written as 11.46 deg.
const SAME_SIZE: f64 = 1e-3;

impl Conditions {
    /// The numbers among them by name, in the order of the file.
    #[must_use]
    pub fn numbers(&self) -> [(&'static str, Option<f64>); 8] {
        [
            ("step_deg", self.step_deg),
            ("within_deg", self.within_deg),
            ("from_s", self.from_s),
            ("to_s", self.to_s),
            ("from_hz", self.from_hz),
            ("to_hz", self.to_hz),
            ("target_ft", self.target_ft),
            ("target_m", self.target_m),
        ]
    }

    /// Altitude that is aimed at, m.
    #[must_use]
    pub fn target_altitude_m(&self) -> Option<f64> {
        self.target_m.or(self.target_ft.map(|feet| feet * FOOT_M))
    }

    /// True for a frequency that counts: from the lowest, below the highest.
    #[must_use]
    pub fn in_band(&self, frequency_rad_s: f64) -> bool {
        let hz = frequency_rad_s / (2.0 * std::f64::consts::PI);
        self.from_hz.is_none_or(|from| hz >= from) && self.to_hz.is_none_or(|to| hz < to)
    }

    /// True if only some frequencies count.
    #[must_use]
    pub fn has_band(&self) -> bool {
        self.from_hz.is_some() || self.to_hz.is_some()
    }

    /// True for a step of this size that counts, deg.
    #[must_use]
    pub fn counts_step(&self, size_deg: f64) -> bool {
        self.step_deg.is_none_or(|asked| (size_deg.abs() - asked).abs() <= SAME_SIZE * asked)
    }

    /// What counts, in words: "steps of 5 deg, from 0.06 Hz"; empty where everything does.
    #[must_use]
    pub fn in_words(&self) -> String {
        let mut words = Vec::new();
        let mut say = |text: Option<String>| words.extend(text);
        say(self.step_deg.map(|step| format!("steps of {} deg", to_digits(step, 6))));
        say(self.within_deg.map(|band| format!("within {} deg", to_digits(band, 6))));
        say(range(self.from_s, self.to_s, "s"));
        say(range(self.from_hz, self.to_hz, "Hz"));
        let target = |value: f64, unit: &str| format!("target {} {unit}", to_digits(value, 6));
        say(self.target_ft.map(|feet| target(feet, "ft")));
        say(self.target_m.map(|metres| target(metres, "m")));
        say(self.air.map(|air| format!("in {} air", air.name())));
        words.join(", ")
    }
}

/// "0.06 to 3 Hz", "from 0.06 Hz", "up to 3 Hz".
fn range(from: Option<f64>, to: Option<f64>, unit: &str) -> Option<String> {
    match (from, to) {
        (None, None) => None,
        (Some(from), Some(to)) => Some(format!("{from} to {to} {unit}")),
        (Some(from), None) => Some(format!("from {from} {unit}")),
        (None, Some(to)) => Some(format!("below {to} {unit}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_band_holds_its_lower_end_and_not_its_upper() {
        let band = Conditions { from_hz: Some(0.5), to_hz: Some(2.0), ..Conditions::default() };
        let tau = 2.0 * std::f64::consts::PI;
        assert!(band.in_band(0.5 * tau) && band.in_band(1.9 * tau));
        assert!(!band.in_band(2.0 * tau) && !band.in_band(0.49 * tau) && !band.in_band(f64::NAN));
    }

    #[test]
    fn a_step_counts_either_way_and_to_the_digits_that_people_write() {
        let asked = Conditions { step_deg: Some(0.2_f64.to_degrees()), ..Conditions::default() };
        assert!(asked.counts_step(11.46) && asked.counts_step(-11.459_156));
        assert!(
            !asked.counts_step(11.4) && !asked.counts_step(5.0) && !asked.counts_step(f64::NAN)
        );
        assert_eq!(asked.in_words(), "steps of 11.4592 deg");
    }

    #[test]
    fn air_is_read_back_from_its_name() {
        assert_eq!(Air::from_name("turbulent"), Some(Air::Turbulent));
        assert_eq!(Air::from_name("calm"), None);
    }
}
