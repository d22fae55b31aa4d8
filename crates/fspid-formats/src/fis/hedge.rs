//! The fraction behind an index: a hedge.
//!
//! Two digits are ten times a power: `1.20` is the square of the first set's grade. fuzzylite gives
//! `.01` and `.99` a meaning of its own, which is the one taken here.

use fspid_fuzzy::Hedge;

/// Codes with a word of their own.
const WORDS: &[(u8, Hedge)] =
    &[(1, Hedge::Seldom), (5, Hedge::Somewhat), (20, Hedge::Very), (99, Hedge::Any)];

/// No hedge at all.
pub(super) const NONE: u8 = 0;

/// The hedge of a code; nothing for 0 and for 10, the power 1.
pub(super) fn of_code(code: u8) -> Option<Hedge> {
    if code == NONE || code == 10 {
        return None;
    }
    let word = WORDS.iter().find(|(known, _)| *known == code);
    Some(word.map_or_else(|| Hedge::Power(f64::from(code) / 10.0), |(_, hedge)| *hedge))
}

/// What an index says about a term's grade: a code, and whether it is subtracted from 1 after that.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Coded {
    /// One minus it.
    pub(super) negated: bool,
    /// Two digits.
    pub(super) code: u8,
}

/// The code of hedges as a rule has them, the last one acting first; nothing if there is none that
/// says exactly the same.
pub(super) fn to_code(hedges: &[Hedge]) -> Option<Coded> {
    let negations = hedges.iter().take_while(|hedge| **hedge == Hedge::Not).count();
    let negated = negations % 2 == 1;
    let code = match hedges.get(negations..)? {
        [] => NONE,
        [Hedge::Any, ..] => 99,
        [Hedge::Seldom] => 1,
        powers => code_of_power(product(powers)?)?,
    };
    Some(Coded { negated, code })
}

/// A power of a power is the product of the two.
fn product(hedges: &[Hedge]) -> Option<f64> {
    hedges.iter().try_fold(1.0, |product, hedge| Some(product * exponent(*hedge)?))
}

/// The power that a hedge is.
pub(super) fn exponent(hedge: Hedge) -> Option<f64> {
    match hedge {
        Hedge::Somewhat => Some(0.5),
        Hedge::Very => Some(2.0),
        Hedge::Power(power) => Some(power),
        _ => None,
    }
}

/// The code that reads back as just this power; `.01` and `.99` do not.
fn code_of_power(power: f64) -> Option<u8> {
    (2..99).find(|&code| (f64::from(code) / 10.0).to_bits() == power.to_bits())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_that_is_written_reads_back() {
        for code in (0..=99).filter(|code| *code != 10) {
            let hedges: Vec<_> = of_code(code).into_iter().collect();
            assert_eq!(to_code(&hedges), Some(Coded { negated: false, code }), "{code}");
        }
    }

    #[test]
    fn powers_of_powers_multiply_and_negations_cancel() {
        let code = |hedges: &[Hedge]| to_code(hedges).map(|coded| (coded.negated, coded.code));
        assert_eq!(code(&[Hedge::Very, Hedge::Very]), Some((false, 40)));
        assert_eq!(code(&[Hedge::Not, Hedge::Very, Hedge::Somewhat]), Some((true, 10)));
        assert_eq!(code(&[Hedge::Not, Hedge::Not]), Some((false, 0)));
        assert_eq!(code(&[Hedge::Very, Hedge::Not]), None);
        assert_eq!(code(&[Hedge::Extremely]), None);
        assert_eq!(code(&[Hedge::Power(9.9)]), None);
    }
}
