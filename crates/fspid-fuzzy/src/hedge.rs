//! Words that sharpen or soften a grade: very, somewhat, not, …

use crate::error::FuzzyError;
use crate::membership::{root, smooth, smooth_inverse};
use fspid_numeric::scalar::Scalar;

/// A function of a grade, from [0, 1] to [0, 1].
///
/// # Source
/// Zadeh, *A fuzzy-set-theoretic interpretation of linguistic hedges*, 1972; names and formulas as
/// documented for fuzzylite. Powers are what the fractions in the rules of `.fis` files mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hedge {
    /// $1$
    Any,
    /// $2a^2$ up to $a = \frac12$, then $1 - 2(1 - a)^2$.
    Extremely,
    /// $1 - a$
    Not,
    /// $\sqrt{a/2}$ up to $a = \frac12$, then $1 - \sqrt{(1 - a)/2}$: the inverse of `extremely`.
    Seldom,
    /// $\sqrt a$
    Somewhat,
    /// $a^2$
    Very,
    /// $a^p$ with a finite $p$ above 0, see [`power`](Self::power).
    Power(f64),
}

impl Hedge {
    /// The hedges that are named in rules.
    pub const NAMED: &[Self] =
        &[Self::Any, Self::Extremely, Self::Not, Self::Seldom, Self::Somewhat, Self::Very];

    /// The power hedge $a^p$.
    ///
    /// # Errors
    /// [`FuzzyError::Parameter`] if `p` is not a finite number above 0.
    pub const fn power(p: f64) -> Result<Self, FuzzyError> {
        if p > 0.0 && p.is_finite() {
            return Ok(Self::Power(p));
        }
        Err(FuzzyError::Parameter { name: "power", found: p, allowed: "a finite number above 0" })
    }

    /// Name in files and messages.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Any => "any",
            Self::Extremely => "extremely",
            Self::Not => "not",
            Self::Seldom => "seldom",
            Self::Somewhat => "somewhat",
            Self::Very => "very",
            Self::Power(_) => "power",
        }
    }

    /// The hedge with that name, if it is among the [`NAMED`](Self::NAMED).
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::NAMED.iter().copied().find(|hedge| hedge.name() == name)
    }

    /// The grade that the hedge makes of a `grade` in [0, 1]. Where the slope of a root is infinite,
    /// at 0 (and at 1 for `seldom`), it counts as 0.
    #[must_use]
    pub fn apply<S: Scalar>(self, grade: S) -> S {
        match self {
            Self::Any => S::one(),
            Self::Extremely => smooth(grade),
            Self::Not => S::one() - grade,
            Self::Seldom => smooth_inverse(grade),
            Self::Somewhat => root(grade),
            Self::Very => grade.square(),
            Self::Power(p) => S::zero().if_less(grade, grade.pow(S::constant(p)), S::zero()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grades() -> impl Iterator<Item = f64> {
        (0..=1000).map(|k| f64::from(k) / 1000.0)
    }

    fn all() -> impl Iterator<Item = Hedge> {
        Hedge::NAMED.iter().copied().chain([0.5, 3.0, 4.0].map(Hedge::Power))
    }

    #[test]
    fn every_hedge_stays_within_zero_and_one_and_keeps_the_order() {
        for hedge in all() {
            let mut before = hedge.apply(0.0);
            for grade in grades().map(|grade| hedge.apply(grade)) {
                assert!((0.0..=1.0).contains(&grade), "{}: {grade}", hedge.name());
                let in_order = if hedge == Hedge::Not { grade <= before } else { grade >= before };
                assert!(in_order, "{}: {before} then {grade}", hedge.name());
                before = grade;
            }
        }
    }

    #[test]
    fn every_hedge_but_any_and_not_leaves_zero_and_one_alone() {
        for hedge in all().filter(|hedge| !matches!(hedge, Hedge::Any | Hedge::Not)) {
            assert_eq!([0.0, 1.0].map(|a| hedge.apply(a)), [0.0, 1.0], "{}", hedge.name());
        }
        assert_eq!([0.0, 1.0].map(|a| Hedge::Not.apply(a)), [1.0, 0.0]);
        assert_eq!([0.0, 0.3, 1.0].map(|a| Hedge::Any.apply(a)), [1.0; 3]);
    }

    #[test]
    fn the_hedges_are_the_documented_formulas() {
        let at_a_quarter = [1.0, 0.125, 0.75, 0.353_553_390_593_273_8, 0.5, 0.0625];
        let at_three_quarters =
            [1.0, 0.875, 0.25, 0.646_446_609_406_726_2, 0.75_f64.sqrt(), 0.5625];
        for (index, hedge) in Hedge::NAMED.iter().enumerate() {
            assert!((hedge.apply(0.25) - at_a_quarter[index]).abs() < 2e-16, "{}", hedge.name());
            let error = (hedge.apply(0.75) - at_three_quarters[index]).abs();
            assert!(error < 2e-16, "{}", hedge.name());
        }
    }

    #[test]
    fn somewhat_undoes_very_and_seldom_undoes_extremely() {
        for a in grades() {
            assert!((Hedge::Somewhat.apply(Hedge::Very.apply(a)) - a).abs() < 1e-15);
            assert!((Hedge::Seldom.apply(Hedge::Extremely.apply(a)) - a).abs() < 1e-12);
        }
    }

    #[test]
    fn powers_say_the_same_as_the_words_for_them() {
        for a in grades() {
            assert!((Hedge::Power(2.0).apply(a) - Hedge::Very.apply(a)).abs() < 2e-16);
            assert!((Hedge::Power(0.5).apply(a) - Hedge::Somewhat.apply(a)).abs() < 2e-16);
        }
    }

    #[test]
    fn a_power_that_is_not_above_zero_is_refused() {
        for p in [0.0, -1.0, f64::INFINITY, f64::NAN] {
            assert!(matches!(Hedge::power(p), Err(FuzzyError::Parameter { name: "power", .. })));
        }
        assert_eq!(Hedge::power(0.5), Ok(Hedge::Power(0.5)));
    }

    #[test]
    fn names_are_unique_and_found_again() {
        for hedge in Hedge::NAMED {
            assert_eq!(Hedge::from_name(hedge.name()), Some(*hedge));
        }
        assert_eq!(Hedge::from_name("power"), None);
    }
}
