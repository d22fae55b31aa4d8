//! Gains of a sign that turns the loop around: with a command that turns the nose up whatever the elevator does, the sign of
//! an elevator is none of the gains'.

use fspid_core::Gains;
use fspid_diagnostics::digits::to_digits;

/// A gain that turns the loop around, in words: a negative kp, or the first negative one where none is positive. None where
/// there is none.
#[must_use]
pub fn turned_in_words(gains: Gains<f64>) -> Option<String> {
    let (name, gain) = turned(gains)?;
    let positive = to_digits(-gain, 5);
    Some(format!(
        "{name} is negative, and here a positive command turns the nose up whatever the elevator does, so gains are positive ({name} = {positive})"
    ))
}

/// The same with the question that is left where the sign is meant.
#[must_use]
pub fn turned_and_asked_in_words(gains: Gains<f64>) -> Option<String> {
    let (name, _) = turned(gains)?;
    let why = turned_in_words(gains)?;
    Some(format!("{why}; if {name} is meant so, is elevator_sign right?"))
}

fn turned(gains: Gains<f64>) -> Option<(&'static str, f64)> {
    let named = [("kp", gains.kp), ("ki", gains.ki), ("kd", gains.kd)];
    let is_turned = gains.kp < 0.0 || named.iter().all(|(_, gain)| *gain <= 0.0);
    named.into_iter().find(|(_, gain)| is_turned && *gain < 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gains_are_turned_by_a_negative_kp_or_where_none_is_positive() {
        let of = |kp, ki, kd| turned(Gains { kp, ki, kd }).map(|(name, _)| name);
        assert_eq!(of(-1.5, 0.5, 0.15), Some("kp"));
        assert_eq!(of(0.0, -0.5, 0.0), Some("ki"));
        assert_eq!(of(0.0, 0.0, -0.5), Some("kd"));
        assert_eq!(of(1.5, -0.5, -0.15), None);
        assert_eq!(of(0.0, -0.5, 0.15), None);
        assert_eq!(of(0.0, 0.0, 0.0), None);
    }
}
