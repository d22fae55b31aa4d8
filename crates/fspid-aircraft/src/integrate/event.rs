//! When something happens within a step: an altitude is crossed, a limit is met.

use crate::integrate::dormand_prince::Step;

/// Which way a function of the state goes through zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Crossing {
    /// From below or zero to above.
    Rising,
    /// From above or zero to below.
    Falling,
    /// Either.
    Any,
}

impl Crossing {
    fn happens(self, before: f64, after: f64) -> bool {
        let (rising, falling) = (before <= 0.0 && after > 0.0, before >= 0.0 && after < 0.0);
        match self {
            Self::Rising => rising,
            Self::Falling => falling,
            Self::Any => rising || falling,
        }
    }
}

/// First time in s after which a function of time and state has crossed zero within a step, to neighbouring numbers.
///
/// Only the signs at both ends are looked at, so two crossings within one step are missed: keep `step_max_s` below the
/// time between them. Found by bisection, which ends after some fifty evaluations whatever the function.
pub fn locate<const N: usize>(
    step: &Step<N>,
    crossing: Crossing,
    function: impl Fn(f64, &[f64; N]) -> f64,
) -> Option<f64> {
    let value = |time_s: f64| function(time_s, &step.at(time_s));
    let (mut low_s, mut high_s) = (step.start_s, step.end_s());
    let before = function(low_s, &step.start);
    let after = function(high_s, &step.end);
    if !crossing.happens(before, after) {
        return None;
    }
    loop {
        let middle_s = 0.5 * (low_s + high_s);
        if !(low_s < middle_s && middle_s < high_s) {
            return Some(high_s);
        }
        let crossed = if after > 0.0 { value(middle_s) > 0.0 } else { value(middle_s) < 0.0 };
        if crossed { high_s = middle_s } else { low_s = middle_s }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrate::dormand_prince::{DormandPrince, Tolerance};

    /// A stone thrown up at 10 m/s from 0 m: highest after 10/g, back after 20/g.
    fn crossings(crossing: Crossing, of: fn(f64, &[f64; 2]) -> f64) -> Vec<f64> {
        let stone = |_: f64, state: &[f64; 2]| [state[1], -9.8];
        let tolerance = Tolerance { step_max_s: 0.3, ..Tolerance::default() };
        let steps = DormandPrince::new(stone, (0.0, 3.0), [0.0, 10.0], tolerance);
        let steps = steps.expect("well posed").map(|step| step.expect("no failure"));
        steps.filter_map(|step| locate(&step, crossing, of)).collect()
    }

    #[test]
    fn the_top_and_the_fall_are_found_to_rounding() {
        let top = crossings(Crossing::Falling, |_, state| state[1]);
        assert_eq!(top.len(), 1);
        assert!((top[0] - 10.0 / 9.8).abs() < 1e-12, "{top:?}");
        let ground = crossings(Crossing::Falling, |_, state| state[0]);
        assert_eq!(ground.len(), 1);
        assert!((ground[0] - 20.0 / 9.8).abs() < 1e-12, "{ground:?}");
    }

    #[test]
    fn a_crossing_the_other_way_is_not_reported() {
        assert!(crossings(Crossing::Rising, |_, state| state[1]).is_empty());
        assert_eq!(crossings(Crossing::Any, |_, state| state[1]).len(), 1);
    }
}
