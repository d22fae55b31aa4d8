//! Which number of a loop a place of a scenario is.

use fspid_scenario::file::SettingPath;

/// A number of the loop that may lie between bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LoopNumber {
    /// A coefficient of the plant's numerator, highest power first.
    Numerator(usize),
    /// A coefficient of its denominator.
    Denominator(usize),
    /// The actuator's τ, s.
    TimeConstant,
    /// The actuator's natural frequency, rad/s.
    NaturalFrequency,
    /// The actuator's damping ratio.
    Damping,
}

impl LoopNumber {
    /// The number at a place; none for places that are none of these.
    pub(super) fn at(path: &SettingPath) -> Option<Self> {
        let text = path.text();
        let (table, rest) = text.split_once('.')?;
        let last = rest.rsplit('.').next()?;
        match (table, last) {
            ("actuator", "time_constant_s") => Some(Self::TimeConstant),
            ("actuator", "natural_frequency_rad_s") => Some(Self::NaturalFrequency),
            ("actuator", "damping") => Some(Self::Damping),
            ("plant", _) => {
                let (name, index) = last.strip_suffix(']')?.split_once('[')?;
                let index = index.parse().ok()?;
                match name {
                    "numerator" => Some(Self::Numerator(index)),
                    "denominator" => Some(Self::Denominator(index)),
                    _ => None,
                }
            }
            _ => None,
        }
    }
}
