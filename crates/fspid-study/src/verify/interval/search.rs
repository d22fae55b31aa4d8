//! Outwards on a grid, then inwards: which values are looked at.

use fspid_diagnostics::digits::rounded;
use serde_json::{Value, json};

use super::TOLERANCE;

/// Distances on each side.
const DISTANCES: i32 = 15;
/// Digits of a value that is looked at.
const DIGITS: usize = 6;

/// Why a value does not hold.
#[derive(Clone, Debug, PartialEq)]
pub enum Why {
    /// What is not met there, a sentence each.
    NotMet(Vec<String>),
    /// The scenario may not have it, or cannot be flown with it.
    Refused(String),
    /// The flight would have so many samples that nobody looked.
    TooLong {
        /// How many.
        samples: usize,
    },
}

/// A value beyond the interval.
#[derive(Clone, Debug, PartialEq)]
pub struct Beyond {
    /// The nearest value that was looked at and does not hold.
    pub value: f64,
    /// Why.
    pub why: Why,
}

/// An end of the interval.
#[derive(Clone, Debug, PartialEq)]
pub struct End {
    /// The outermost value that holds, all that were looked at on the way to it included.
    pub holds: f64,
    /// What is beyond; none where the search ended.
    pub beyond: Option<Beyond>,
}

/// What was found around a value.
#[derive(Clone, Debug, PartialEq)]
pub struct Search {
    /// Below and above; both at the present value if it does not hold.
    pub ends: [End; 2],
    /// Why the present value does not hold.
    pub why: Option<Why>,
    /// The nearest value that holds, where the present one does not and one was found.
    pub nearest: Option<f64>,
    /// Every value that was looked at, in that order, and whether it holds.
    pub looks: Vec<(f64, bool)>,
}

/// What is asked of each value: why it does not hold, or nothing.
type Look<'a> = dyn FnMut(f64) -> Option<Why> + 'a;

struct Walk<'a> {
    present: f64,
    size: f64,
    whole: bool,
    look: &'a mut Look<'a>,
    looks: Vec<(f64, bool)>,
}

impl Search {
    /// Looks around `present`, whose size is `size`.
    pub fn around<'a>(present: f64, size: f64, whole: bool, look: &'a mut Look<'a>) -> Self {
        let mut walk = Walk { present, size, whole, look, looks: Vec::new() };
        let why = walk.asked(present);
        let here = || End { holds: present, beyond: None };
        let (ends, nearest) = match &why {
            None => ([-1.0, 1.0].map(|side| walk.end(side)), None),
            Some(_) => ([here(), here()], walk.nearest()),
        };
        Self { ends, why, nearest, looks: walk.looks }
    }
}

impl Walk<'_> {
    fn asked(&mut self, value: f64) -> Option<Why> {
        let why = (self.look)(value);
        self.looks.push((value, why.is_none()));
        why
    }

    /// A value as it is looked at.
    fn tidy(&self, value: f64) -> f64 {
        if self.whole { value.round() } else { rounded(value, DIGITS) }
    }

    /// The values of the grid on a side, from the nearest on; none that no number can be.
    fn grid(&self, side: f64) -> Vec<f64> {
        let mut values = vec![self.present];
        for step in 0..DISTANCES {
            // Whole powers of two are exact, so that the grid meets 0 and twice the value.
            let root = if step % 2 == 0 { 1.0 } else { std::f64::consts::SQRT_2 };
            let distance = libm::exp2(f64::from(step / 2 - 4)) * root * self.size;
            let value = self.tidy(self.present + side * distance);
            if value.is_finite() && values.last().is_some_and(|last| (value - last) * side > 0.0) {
                values.push(value);
            }
        }
        values.remove(0);
        values
    }

    /// The end of what holds, around a value that holds.
    fn end(&mut self, side: f64) -> End {
        let mut holds = self.present;
        for value in self.grid(side) {
            match self.asked(value) {
                None => holds = value,
                Some(why) => return self.closer(holds, Beyond { value, why }),
            }
        }
        End { holds, beyond: None }
    }

    /// Halves what lies between a value that holds and one that does not.
    fn closer(&mut self, mut holds: f64, mut beyond: Beyond) -> End {
        while let Some(value) = self.between(holds, beyond.value) {
            match self.asked(value) {
                None => holds = value,
                Some(why) => beyond = Beyond { value, why },
            }
        }
        End { holds, beyond: Some(beyond) }
    }

    /// A value between two; none where they are close enough, or no number of so many digits lies between.
    fn between(&self, one: f64, other: f64) -> Option<f64> {
        let is_close = match self.whole {
            true => (one - other).abs() <= 1.0,
            false => (one - other).abs() <= TOLERANCE * self.size,
        };
        let (least, most) = (one.min(other), one.max(other));
        let value = self.tidy(0.5 * one + 0.5 * other);
        (!is_close && least < value && value < most).then_some(value)
    }

    /// The nearest value that holds, around one that does not: the grid outwards on both sides, then closer.
    fn nearest(&mut self) -> Option<f64> {
        let [below, above] = [-1.0, 1.0].map(|side| self.grid(side));
        let mut before = [self.present; 2];
        for step in 0..below.len().max(above.len()) {
            let mut found = None;
            for (side, values) in [&below, &above].into_iter().enumerate() {
                let Some(&value) = values.get(step) else { continue };
                match self.asked(value) {
                    Some(_) => before[side] = value,
                    None => found = self.nearer(found, (before[side], value)),
                }
            }
            if found.is_some() {
                return found;
            }
        }
        None
    }

    /// The nearer one of what was found before and what lies between a value that fails and one that holds.
    fn nearer(&mut self, found: Option<f64>, (fails, holds): (f64, f64)) -> Option<f64> {
        let beyond = Beyond { value: fails, why: Why::NotMet(Vec::new()) };
        let here = self.closer(holds, beyond).holds;
        let distance = |value: f64| (value - self.present).abs();
        found.filter(|found| distance(*found) <= distance(here)).or(Some(here))
    }
}

impl Beyond {
    pub(super) fn json(&self) -> Value {
        json!({ "value": self.value, "kind": self.why.kind(), "why": self.why.words() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Looks around a value for where `good` is.
    fn found(present: f64, whole: bool, good: impl Fn(f64) -> bool) -> Search {
        let mut look =
            |value| (!good(value)).then(|| Why::NotMet(vec![format!("{value} is not good")]));
        let size = if present == 0.0 { 1.0 } else { present.abs() };
        Search::around(present, size, whole, &mut look)
    }

    #[test]
    fn the_ends_are_within_the_tolerance_on_the_side_that_holds() {
        for (least, most) in [(0.41, 1.72), (0.9999, 1.0001), (-3.0, 8.9)] {
            let found = found(1.0, false, |value| (least..=most).contains(&value));
            let [below, above] = found.ends;
            assert!((least..=least + TOLERANCE).contains(&below.holds), "{below:?}");
            assert!((most - TOLERANCE..=most).contains(&above.holds), "{above:?}");
            let [outside, further] = [below.beyond, above.beyond].map(|it| it.expect("one").value);
            assert!(outside < least && further > most, "{outside} {further}");
        }
    }

    #[test]
    fn where_everything_holds_the_search_ends_and_says_no_reason() {
        let Search { ends: [below, above], looks, .. } = found(2.0, false, |_| true);
        assert_eq!((below.beyond, above.beyond, looks.len()), (None, None, 31));
        assert_eq!((below.holds, above.holds), (-14.0, 18.0));
        assert!(looks.contains(&(0.0, true)) && looks.contains(&(4.0, true)));
    }

    #[test]
    fn no_value_is_looked_at_twice_and_none_between_the_ends_fails() {
        for present in [1.0_f64, -0.37, 0.0, 1e-9, 7e11] {
            let size = if present == 0.0 { 1.0 } else { present.abs() };
            let good = |value: f64| (value - present).abs() < 0.83 * size;
            let Search { ends: [below, above], looks, .. } = found(present, false, good);
            for (n, (value, holds)) in looks.iter().enumerate() {
                assert!(looks.iter().skip(n + 1).all(|(other, _)| other != value), "{value}");
                assert_eq!(*holds, (below.holds..=above.holds).contains(value), "{value}");
            }
        }
    }

    #[test]
    fn whole_numbers_stay_whole_and_end_at_neighbours() {
        let found = found(5.0, true, |value| (3.0..=11.0).contains(&value));
        assert!(found.looks.iter().all(|(value, _)| value.fract() == 0.0));
        let [below, above] = found.ends;
        assert_eq!((below.holds, above.holds), (3.0, 11.0));
        assert_eq!(below.beyond.map(|it| it.value), Some(2.0));
        assert_eq!(above.beyond.map(|it| it.value), Some(12.0));
    }

    #[test]
    fn where_the_present_value_fails_the_nearest_that_holds_is_found_if_one_is() {
        let there = found(1.0, false, |value| value >= 1.6 || value <= 0.1);
        assert!(there.why.is_some());
        let nearest = there.nearest.expect("one that holds");
        assert!((1.6..=1.6 + TOLERANCE).contains(&nearest), "{nearest}");
        assert_eq!(found(1.0, false, |_| false).nearest, None);
    }
}
