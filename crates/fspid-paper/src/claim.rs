//! The claims of the paper: what is printed, where it is read off, and how ours compares.

use fspid_scenario::measure::Measure;

/// A number as the paper prints it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Printed(pub &'static str);

impl Printed {
    /// A printed zero accepts this much, in its own unit: the paper draws lines, not noise.
    const ZERO_ACCEPTS: f64 = 0.5;
    /// Nearer than this share of the printed number is approached.
    const APPROACHED: f64 = 0.2;

    /// The number.
    #[must_use]
    pub fn value(self) -> f64 {
        // The list below holds nothing else; a test reads every entry.
        self.0.parse().unwrap_or(f64::NAN)
    }

    /// Half a unit of its last digit.
    #[must_use]
    pub fn half_unit(self) -> f64 {
        let decimals = self.0.split_once('.').map_or(0, |(_, decimals)| decimals.len());
        (0..decimals).fold(0.5, |half, _| half / 10.0)
    }

    /// How `ours` stands to the printed number.
    #[must_use]
    pub fn judge(self, ours: f64) -> Status {
        let (paper, distance) = (self.value(), (ours - self.value()).abs());
        let accepted = if paper == 0.0 { Self::ZERO_ACCEPTS } else { self.half_unit() };
        // A hair of rounding at the very edge of a digit is not a miss.
        if distance <= accepted * (1.0 + 1e-9) {
            Status::Reproduced
        } else if distance <= Self::APPROACHED * paper.abs() {
            Status::Approached
        } else {
            Status::Contradicted
        }
    }
}

/// How a claim stands. Ordered: a later one is worse.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Status {
    /// Equal to the printed digits.
    Reproduced,
    /// Within 20 %.
    Approached,
    /// Neither.
    Contradicted,
    /// Could not be found out; the note says why.
    Undetermined,
}

impl Status {
    /// All of them, best first.
    pub const ALL: [Self; 4] =
        [Self::Reproduced, Self::Approached, Self::Contradicted, Self::Undetermined];

    /// Name in answers.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::Approached => "approached",
            Self::Contradicted => "contradicted",
            Self::Undetermined => "undetermined",
        }
    }

    /// The status with that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|status| status.name() == name)
    }
}

/// Where a number is read off: a figure's flight, a controller, a step of the command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reading {
    /// Figure.
    pub figure: &'static str,
    /// Controllers; the worst counts where there are several.
    pub controllers: &'static [&'static str],
    /// Step of the command from 0.
    pub edge: usize,
    /// What is measured.
    pub measure: Measure,
}

/// How a claim's number comes from readings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// One reading (its magnitude).
    Value(Reading),
    /// A later reading that the paper compares with a first one: the change counts too.
    Later {
        /// What the paper compares with; the id of its claim.
        first: &'static str,
        /// The reading itself.
        reading: Reading,
    },
    /// Change from one claim's number to another's in per cent of one of the two.
    Percent {
        /// Claim of the first number.
        first: &'static str,
        /// Claim of the later number.
        later: &'static str,
        /// The paper divides gains by the first value and losses by the later one.
        of_later: bool,
    },
}

/// A number in the paper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Claim {
    /// Id.
    pub id: &'static str,
    /// What it is.
    pub quantity: &'static str,
    /// What is printed.
    pub paper: Printed,
    /// Its unit.
    pub unit: &'static str,
    /// How ours is found.
    pub source: Quantity,
}

const fn reading(
    figure: &'static str,
    controllers: &'static [&'static str],
    edge: usize,
    measure: Measure,
) -> Reading {
    Reading { figure, controllers, edge, measure }
}

const fn value(
    id: &'static str,
    quantity: &'static str,
    paper: &'static str,
    reading: Reading,
) -> Claim {
    let unit = reading.measure.unit();
    Claim { id, quantity, paper: Printed(paper), unit, source: Quantity::Value(reading) }
}

const fn later(
    id: &'static str,
    quantity: &'static str,
    paper: &'static str,
    first: &'static str,
    reading: Reading,
) -> Claim {
    let source = Quantity::Later { first, reading };
    Claim { source, ..value(id, quantity, paper, reading) }
}

const fn percent(
    id: &'static str,
    quantity: &'static str,
    paper: &'static str,
    [first, later]: [&'static str; 2],
    of_later: bool,
) -> Claim {
    let source = Quantity::Percent { first, later, of_later };
    Claim { id, quantity, paper: Printed(paper), unit: "%", source }
}

const PC: &[&str] = &["PC"];
const CPID: &[&str] = &["CPID"];
const FSPID: &[&str] = &["FSPID"];
/// The first upward edge of the square wave and the second: steps 0 and 2 of the command.
const FIRST: usize = 0;
const LATER: usize = 2;
use Measure::{FinalError, Overshoot, RiseTime};

/// Every number of the paper's results, in the order of its figures.
#[rustfmt::skip] // a table: one row a claim
pub const CLAIMS: &[Claim] = &[
    value("F5.1", "PC with inner loop, overshoot", "14.6", reading("5", PC, FIRST, Overshoot)),
    value("F5.2", "PC with inner loop, final error", "2", reading("5", PC, FIRST, FinalError)),
    value("F5.3", "CPID, final error", "3", reading("5", CPID, FIRST, FinalError)),
    value("F5.4.1", "FSPID, overshoot", "0", reading("5", FSPID, FIRST, Overshoot)),
    value("F5.4.2", "FSPID, final error", "0", reading("5", FSPID, FIRST, FinalError)),
    value("F6.2.1", "CPID, first tuning, overshoot", "22.8", reading("6", &["CPID 1"], FIRST, Overshoot)),
    value("F6.2.2", "CPID, second tuning, overshoot", "31", reading("6", &["CPID 2"], FIRST, Overshoot)),
    value("F6.3", "FSPID, overshoot", "0", reading("6", &["FSPID 1", "FSPID 2"], FIRST, Overshoot)),
    value("F8a.1.1", "FSPID rise time, first edge", "2.3", reading("8a", FSPID, FIRST, RiseTime)),
    later("F8a.1.2", "FSPID rise time, later edge", "1.09", "F8a.1.1", reading("8a", FSPID, LATER, RiseTime)),
    percent("F8a.1.3", "FSPID rise time, gain", "53", ["F8a.1.1", "F8a.1.2"], false),
    value("F8a.2.1", "CPID rise time, first edge", "2.32", reading("8a", CPID, FIRST, RiseTime)),
    later("F8a.2.2", "CPID rise time, later edge", "2.5", "F8a.2.1", reading("8a", CPID, LATER, RiseTime)),
    percent("F8a.2.3", "CPID rise time, loss", "7", ["F8a.2.1", "F8a.2.2"], true),
    value("F8b.1.1", "FSPID overshoot, first edge", "5.9", reading("8b", FSPID, FIRST, Overshoot)),
    later("F8b.1.2", "FSPID overshoot, later edge", "0", "F8b.1.1", reading("8b", FSPID, LATER, Overshoot)),
    value("F8b.1.3", "FSPID rise time, first edge", "1.4", reading("8b", FSPID, FIRST, RiseTime)),
    later("F8b.1.4", "FSPID rise time, later edge", "0.73", "F8b.1.3", reading("8b", FSPID, LATER, RiseTime)),
    percent("F8b.1.5", "FSPID rise time, gain", "48", ["F8b.1.3", "F8b.1.4"], false),
    value("F8b.2.1", "CPID overshoot, first edge", "6.2", reading("8b", CPID, FIRST, Overshoot)),
    later("F8b.2.2", "CPID overshoot, later edge", "3.3", "F8b.2.1", reading("8b", CPID, LATER, Overshoot)),
    value("F8b.2.3", "CPID rise time, first edge", "1.4", reading("8b", CPID, FIRST, RiseTime)),
    later("F8b.2.4", "CPID rise time, later edge", "1.72", "F8b.2.3", reading("8b", CPID, LATER, RiseTime)),
    percent("F8b.2.5", "CPID rise time, loss", "18", ["F8b.2.3", "F8b.2.4"], true),
    value("F9.1.1", "FSPID rise time, first edge", "1.38", reading("9", FSPID, FIRST, RiseTime)),
    later("F9.1.2", "FSPID rise time, later edge", "0.84", "F9.1.1", reading("9", FSPID, LATER, RiseTime)),
    percent("F9.1.3", "FSPID rise time, gain", "40", ["F9.1.1", "F9.1.2"], false),
    value("F9.1.4", "FSPID overshoot, first edge", "1.76", reading("9", FSPID, FIRST, Overshoot)),
    later("F9.1.5", "FSPID overshoot, later edge", "0", "F9.1.4", reading("9", FSPID, LATER, Overshoot)),
    value("F9.2.1", "CPID rise time, first edge", "1.5", reading("9", CPID, FIRST, RiseTime)),
    later("F9.2.2", "CPID rise time, later edge", "1.73", "F9.2.1", reading("9", CPID, LATER, RiseTime)),
    percent("F9.2.3", "CPID rise time, loss", "13.3", ["F9.2.1", "F9.2.2"], true),
    value("F9.2.4", "CPID overshoot, first edge", "2.2", reading("9", CPID, FIRST, Overshoot)),
    later("F9.2.5", "CPID overshoot, later edge (constant)", "2.2", "F9.2.4", reading("9", CPID, LATER, Overshoot)),
];

/// Status of a change from one edge to the next: right in sign and, within 20 % or the rounding of
/// the two printed numbers, in size.
#[must_use]
pub(super) fn judge_change(paper: (Printed, Printed), ours: (f64, f64)) -> Status {
    let (paper_change, our_change) = (paper.1.value() - paper.0.value(), ours.1 - ours.0);
    let rounding = paper.0.half_unit() + paper.1.half_unit();
    let distance = (our_change - paper_change).abs();
    let same_sign = paper_change * our_change > 0.0;
    if distance <= rounding.max(Printed::APPROACHED * paper_change.abs())
        && (same_sign || paper_change.abs() <= rounding)
    {
        Status::Reproduced
    } else {
        Status::Contradicted
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_is_reproduced_within_half_a_unit_of_its_last_digit() {
        assert_eq!(Printed("14.6").judge(14.649), Status::Reproduced);
        assert_eq!(Printed("14.6").judge(14.66), Status::Approached);
        assert_eq!(Printed("2").judge(2.49), Status::Reproduced);
        assert_eq!(Printed("2").judge(2.6), Status::Contradicted);
        assert_eq!(Printed("0").judge(0.4), Status::Reproduced);
        assert_eq!(Printed("0").judge(0.6), Status::Contradicted);
        assert_eq!(Printed("1.09").judge(f64::NAN), Status::Contradicted);
    }

    #[test]
    fn a_change_of_the_wrong_sign_or_size_is_contradicted() {
        let rise = (Printed("1.5"), Printed("1.73"));
        assert_eq!(judge_change(rise, (1.48, 1.72)), Status::Reproduced);
        assert_eq!(judge_change(rise, (1.58, 1.64)), Status::Contradicted);
        assert_eq!(judge_change(rise, (1.73, 1.5)), Status::Contradicted);
        let constant = (Printed("2.2"), Printed("2.2"));
        assert_eq!(judge_change(constant, (2.2, 2.17)), Status::Reproduced);
        assert_eq!(judge_change(constant, (2.4, 1.95)), Status::Contradicted);
    }

    #[test]
    fn every_claim_has_its_own_id_a_number_and_claims_to_compare_with() {
        for (index, claim) in CLAIMS.iter().enumerate() {
            assert!(claim.paper.value().is_finite(), "{}", claim.id);
            assert!(!CLAIMS[..index].iter().any(|other| other.id == claim.id), "{}", claim.id);
            let before = |id: &str| CLAIMS[..index].iter().any(|other| other.id == id);
            match claim.source {
                Quantity::Value(_) => {}
                Quantity::Later { first, .. } => assert!(before(first), "{}", claim.id),
                Quantity::Percent { first, later, .. } => {
                    assert!(before(first) && before(later), "{}", claim.id);
                }
            }
        }
    }
}
