//! The answer for people.

use super::{Asked, Beyond, End, Interval, Why};
use fspid_diagnostics::digits::to_digits;
use fspid_diagnostics::listed;

/// Most sentences that are told of one value.
const MOST: usize = 3;

impl Asked {
    /// What has to hold, and of whom.
    #[must_use]
    pub fn words(&self) -> String {
        let of = self.controller.as_deref().map_or("all controllers".to_owned(), str::to_owned);
        let sets = match self.sets.as_slice() {
            [] => String::new(),
            sets => format!(", with {}", listed(sets)),
        };
        match self.requirements {
            0 => format!("{of}: stable at rest and every step settled, as nothing is required"),
            1 => format!("{of}: 1 requirement{sets}"),
            many => format!("{of}: {many} requirements{sets}"),
        }
    }
}

impl Why {
    /// In a word, for programs.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::NotMet(_) => "not met",
            Self::Refused(_) => "refused",
            Self::TooLong { .. } => "too long",
        }
    }

    /// In a sentence.
    #[must_use]
    pub fn words(&self) -> String {
        match self {
            Self::NotMet(found) => {
                let more = match found.len().saturating_sub(MOST) {
                    0 => String::new(),
                    more => format!("; and {more} more"),
                };
                found.iter().take(MOST).cloned().collect::<Vec<_>>().join("; ") + &more
            }
            Self::Refused(reason) => format!("refused: {reason}"),
            Self::TooLong { samples } => {
                format!("the flight would have {samples} samples and was not looked at")
            }
        }
    }
}

impl Interval {
    /// What was found, in sentences that say what was looked at and what was not.
    #[must_use]
    pub fn text(&self) -> String {
        let looks = self.search.looks.len();
        let asked = self.asked.words();
        if let Some(why) = &self.search.why {
            let way_out = match self.search.nearest {
                Some(value) => format!("The nearest value found that holds is {}.", told(value)),
                None => "No value that holds was found.".to_owned(),
            };
            return format!(
                "Does not hold at the present value {}: {}. {way_out} {} looked at; asked of {asked}.",
                told(self.present),
                why.words(),
                values(looks),
            );
        }
        let [below, above] = &self.search.ends;
        format!(
            "Holds at all {} looked at between {} and {}; what lies between them was not looked at. Below: {}. Above: {}. {} looked at, the ends to within {}; asked of {asked}.",
            values(self.inside()),
            told(below.holds),
            told(above.holds),
            beyond(below),
            beyond(above),
            values(looks),
            told(self.within),
        )
    }
}

fn values(count: usize) -> String {
    if count == 1 { "1 value".to_owned() } else { format!("{count} values") }
}

fn beyond(end: &End) -> String {
    match &end.beyond {
        Some(Beyond { value, why }) => format!("at {} {}", told(*value), why.words()),
        None => format!("the search ended at {}, which holds", told(end.holds)),
    }
}

/// A number with all digits that were flown.
fn told(value: f64) -> String {
    to_digits(value, 17)
}
