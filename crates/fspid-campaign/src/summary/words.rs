//! Numbers, probabilities and notes in words, for people.

use std::fmt;

use fspid_diagnostics::digits::{grouped, without_zeros};
use fspid_study::simulation::FAILS_BY_ITSELF;

use super::data::{Head, MeasureCount, Note, Probability, QuantileSummary, Severity, Shards};
use crate::sample::Sampling;

/// Four significant digits: more say nothing of a campaign.
#[must_use]
pub fn number(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return if value.is_nan() { "NaN".to_owned() } else { signed(format!("{value}")) };
    }
    let scientific = format!("{value:.3e}");
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if (-4..6).contains(&exponent) {
        let decimals = usize::try_from(3 - exponent).unwrap_or(0);
        return signed(format!("{value:.decimals$}"));
    }
    signed(format!("{mantissa}e{exponent}"))
}

/// A whole number, from five digits on in groups of three: `10 000`, `3000`.
#[must_use]
pub fn whole(value: u64) -> String {
    match value {
        0..10_000 => value.to_string(),
        _ => grouped(value),
    }
}

/// A confidence or a share of the flights in percent, with the digits it has: `95 %`, `99.9 %`.
#[must_use]
pub fn percent(share: f64) -> String {
    format!("{} %", without_zeros(&format!("{:.6}", 100.0 * share)))
}

/// A small share in percent, rounded up to two digits: `0.049 %`.
#[must_use]
pub fn at_most_percent(share: f64) -> String {
    format!("{} %", outwards(share, decimals(share), true))
}

/// `INCOMPLETE: from 990 of 1000 shards, 9900 of 10 000 runs`.
#[must_use]
pub fn incomplete(shards: Shards, runs: u64, planned_runs: u64) -> String {
    format!(
        "INCOMPLETE: from {} of {} shards, {} of {} runs",
        whole(shards.found),
        whole(shards.of),
        whole(runs),
        whole(planned_runs)
    )
}

/// Minus signs as print has them.
fn signed(text: String) -> String {
    text.replace('-', "\u{2212}")
}

impl Probability {
    /// `12 of 10 000: 0.12 % (0.06 % to 0.21 %)`; `0 of 3000: at most 0.10 % (95 %)`.
    ///
    /// Ends of intervals are rounded outwards, with two significant digits of the interval's width.
    #[must_use]
    pub fn in_words(&self, confidence: f64) -> String {
        let counts = format!("{} of {}", whole(self.count), whole(self.of));
        let sure = percent(confidence);
        if let Some(most) = self.at_most {
            let most = outwards(most, decimals(most), true);
            return format!("{counts}: at most {most} % ({sure})");
        }
        if let Some(least) = self.at_least {
            let least = outwards(least, decimals(1.0 - least), false);
            return format!("{counts}: at least {least} % ({sure})");
        }
        let Some(estimate) = self.estimate else {
            return counts;
        };
        let decimals = decimals(self.upper - self.lower);
        let lower = outwards(self.lower, decimals, false);
        let upper = outwards(self.upper, decimals, true);
        format!("{counts}: {:.decimals$} % ({lower} % to {upper} %)", 100.0 * estimate)
    }
}

/// Decimals of a percentage that leave two significant digits of `width`.
fn decimals(width: f64) -> usize {
    // From 99 on, rounding up makes it a power of ten, which has one more digit.
    let power = libm::floor(libm::log10(100.0 * width / 0.99));
    if power.is_finite() { (1.0 - power).clamp(0.0, 12.0) as usize } else { 2 }
}

/// Relative error that bounds of probabilities may have, generously.
const ROUNDING: f64 = 1e-12;

/// A share in percent with so many decimals, rounded up or down.
fn outwards(share: f64, decimals: usize, up: bool) -> String {
    let scale: f64 = format!("1e{}", decimals + 2).parse().unwrap_or(100.0);
    // What rounding has left of a decimal is that decimal.
    let scaled = share * scale;
    let rounded = if up {
        libm::ceil(scaled * (1.0 - ROUNDING))
    } else {
        libm::floor(scaled * (1.0 + ROUNDING))
    };
    format!("{:.decimals$}", 100.0 * (rounded / scale))
}

impl Head {
    /// That parts are missing, if they are.
    #[must_use]
    pub fn incomplete(&self) -> Option<String> {
        let missing = self.shards.filter(|_| self.runs < self.planned_runs)?;
        Some(incomplete(missing, self.runs, self.planned_runs))
    }
}

impl QuantileSummary {
    /// `3.412`, or `3.412 (±0.049 %)` with how far its rank may be off, in percent of the flights.
    #[must_use]
    pub fn in_words(&self) -> String {
        let value = number(self.value);
        match self.sketch.map(|sketch| sketch.rank_error).filter(|error| *error > 0.0) {
            Some(error) => format!("{value} (\u{b1}{})", at_most_percent(error)),
            None => value,
        }
    }
}

impl Severity {
    /// The word for it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Diverged => "diverged",
            Self::HitGround => crate::rows::HIT_GROUND,
            Self::ControllerLost => crate::rows::CONTROLLER_LOST,
            Self::PlantLost => crate::rows::PLANT_LOST,
            Self::Unstable => "unstable",
            Self::Refused => "refused",
            Self::ModeNeverBegan => crate::rows::MODE_NEVER_BEGAN,
            Self::LeftRange => "left the range",
            Self::RequirementsNotMet => "requirements not met",
            Self::NotSettled => "not settled",
        }
    }
}

impl Note {
    /// The word for it in files.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Incomplete { .. } => "incomplete",
            Self::FromSketches { .. } => "from-sketches",
            Self::RunsNotIndependent { .. } => "runs-not-independent",
            Self::NothingRequired { .. } => "nothing-required",
            Self::SharesOvercorrected => "shares-overcorrected",
            Self::FirstRunsOnly { .. } => "first-runs-only",
            Self::Missing { .. } => "missing",
            Self::NotFinite { .. } => "not-finite",
        }
    }
}

/// Most measures that a note names of those that are missing in equally many flights.
const NAMED: usize = 3;

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Incomplete { shards, runs, planned_runs } => {
                let part = incomplete(*shards, *runs, *planned_runs);
                write!(f, "{part}. What is missing need not be like what is there.")
            }
            Self::FromSketches { rows, relative_width } => write!(
                f,
                "Of {} rows quantiles are from sketches: each is off by at most {} of its value, and its rank by what \
                 stands beside it, by nothing where nothing does. Bars of histograms are off by as much at their \
                 edges. Counts, extremes, means and spreads are exact.",
                whole(*rows),
                at_most_percent(*relative_width)
            ),
            Self::RunsNotIndependent { sampling } => {
                let points = match sampling {
                    Sampling::LatinHypercube => "the points of a Latin hypercube are not",
                    Sampling::Sobol => "the points of a Sobol' sequence are not",
                    Sampling::Random => "these are",
                };
                write!(
                    f,
                    "Intervals assume independent runs; {points}. For means and probabilities the intervals are \
                     then usually too wide, which is not guaranteed."
                )
            }
            Self::NothingRequired { controller } => write!(
                f,
                "{controller}: nothing is required of it. A flight of it fails that does not settle, or that \
                 {FAILS_BY_ITSELF}."
            ),
            Self::SharesOvercorrected => f.write_str(
                "Shares of the variance are corrected as for independent runs, which takes off too much on a \
                 Sobol' sequence: the truth lies between the corrected and the uncorrected share.",
            ),
            Self::FirstRunsOnly { runs_used, runs } => write!(
                f,
                "Correlations and shares of the variance are of the first {} of {} runs.",
                whole(*runs_used),
                whole(*runs)
            ),
            Self::Missing { controller, measures } => {
                write!(
                    f,
                    "{controller}: not every flight has every measure; what is said is of those that do. Without: "
                )?;
                counted(f, measures)
            }
            Self::NotFinite { controller, measures } => {
                write!(f, "{controller}: infinite or NaN, and left out: ")?;
                counted(f, measures)
            }
        }
    }
}

/// Counts with the names they belong to: `5082 flights rise_time_s, overshoot_pct and 9 others; …`.
fn counted(f: &mut fmt::Formatter<'_>, measures: &[MeasureCount]) -> fmt::Result {
    let mut left: Vec<&MeasureCount> = measures.iter().collect();
    let mut between = "";
    while let Some(&&MeasureCount { flights: count, .. }) = left.first() {
        let (same, others): (Vec<_>, Vec<_>) = left.into_iter().partition(|it| it.flights == count);
        left = others;
        let named: Vec<&str> = same.iter().take(NAMED).map(|it| it.name.as_str()).collect();
        let flights = if count == 1 { "flight" } else { "flights" };
        write!(f, "{between}{} {flights} {}", whole(count), named.join(", "))?;
        if same.len() > NAMED {
            write!(f, " and {} more", same.len() - NAMED)?;
        }
        between = "; ";
    }
    f.write_str(".")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(count: u64, of: u64) -> String {
        Probability::of(count, of, 0.95).expect("counts").in_words(0.95)
    }

    /// 12 of 10 000: Clopper and Pearson give 0.0620 % to 0.2096 %.
    #[test]
    fn probabilities_have_the_digits_that_their_intervals_leave_them() {
        assert_eq!(words(12, 10_000), "12 of 10 000: 0.12 % (0.06 % to 0.21 %)");
        assert_eq!(words(0, 3000), "0 of 3000: at most 0.10 % (95 %)");
        assert_eq!(words(300, 300), "300 of 300: at least 99.0 % (95 %)");
        assert_eq!(words(1, 1), "1 of 1: at least 5 % (95 %)");
        assert_eq!(words(7, 20), "7 of 20: 35 % (15 % to 60 %)");
        assert_eq!(words(0, 0), "0 of 0");
    }

    #[test]
    fn measures_missing_in_equally_many_flights_are_named_together() {
        let names = [("a", 5), ("b", 2), ("c", 5), ("d", 5), ("e", 5), ("f", 1)];
        let measures = names.map(|(name, flights)| MeasureCount { name: name.to_owned(), flights });
        let measures = measures.to_vec();
        let note = Note::NotFinite { controller: "A".to_owned(), measures };
        assert_eq!(
            note.to_string(),
            "A: infinite or NaN, and left out: 5 flights a, c, d and 1 more; 2 flights b; 1 flight f."
        );
    }

    #[test]
    fn numbers_have_four_digits() {
        for (value, expected) in [
            (0.0, "0"),
            (-0.0, "0"),
            (0.012_345, "0.01235"),
            (-12.345, "\u{2212}12.35"),
            (12_345.678, "12346"),
            (1.5e7, "1.500e7"),
            (-2e-6, "\u{2212}2.000e\u{2212}6"),
            (f64::NAN, "NaN"),
            (f64::NEG_INFINITY, "\u{2212}inf"),
        ] {
            assert_eq!(number(value), expected);
        }
        assert_eq!([whole(9999), whole(10_000), whole(1_234_567)], ["9999", "10 000", "1 234 567"]);
        assert_eq!([percent(0.95), percent(0.999), percent(0.5)], ["95 %", "99.9 %", "50 %"]);
    }
}
