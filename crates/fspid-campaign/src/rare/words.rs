//! The answer in words, for people.

use super::answer::Rare;
use super::importance::{Importance, LEAST_EFFECTIVE};
use super::interval::Interval;
use super::question::Method;
use super::seldom::Seldom;
use super::subset::{Known, Subset, Unfinished};
use crate::summary::words::{number, whole};

/// Moves of which fewer are made keep the chains where they are.
const FEW_MADE: f64 = 0.1;

impl Unfinished {
    /// Why there is no interval, in words.
    #[must_use]
    pub const fn in_words(self) -> &'static str {
        match self {
            Self::Spent => {
                "the flights were spent before failures were reached; ask for more with --flights"
            }
            Self::Flat => {
                "no flight was nearer to the failure than others that are alike: nothing that is drawn leads there, as far as was seen"
            }
            Self::Deep => {
                "no team of flights, or too few of one, reached a failure on the levels that are climbed at most, down to 3e-13"
            }
            Self::Lost => "a team of flights found no way up; ask for more flights with --flights",
            Self::Apart => {
                "the teams' estimates are too far apart for an interval that holds what it says; ask for more flights with --flights"
            }
            Self::Uneven => {
                "a few weights decide: the distribution that was fitted does not fit the failures; take --method subset"
            }
        }
    }
}

impl Subset {
    /// Mean of the teams' estimates of the probability to be above the first rungs.
    #[must_use]
    pub fn reached(&self, rungs: usize) -> f64 {
        let estimates = self.teams.estimates(rungs);
        estimates.iter().sum::<f64>() / estimates.len().max(1) as f64
    }
}

impl Rare {
    /// The answer for people.
    #[must_use]
    pub fn text(&self) -> String {
        let mut out = format!(
            "{} fails {} ({}) {}\n",
            self.controller,
            self.requirement.id,
            self.requirement.limits_in_words(),
            self.headline()
        );
        if let Some(interval) = self.interval() {
            out.push_str(&self.hours(interval));
        }
        out.push_str(&self.cost());
        for (method, known) in self.known().into_iter().filter(|_| self.known().len() > 1) {
            out.push_str(&format!("  {}: {}\n", in_words(method), known_in_words(known)));
        }
        if let Some(subset) = self.found.subset.as_ref().filter(|it| !it.rungs.is_empty()) {
            out.push_str(&self.levels(subset));
        }
        if let Some(importance) = &self.found.importance {
            out.push_str(&format!(
                "  failures that were weighed: {}, as good as {:.0} of one weight\n",
                whole(importance.failing),
                importance.effective
            ));
        }
        if let Some(likeliest) = &self.likeliest {
            let which = likeliest.distance.map_or_else(
                || "a failure of those flown".to_owned(),
                |distance| {
                    format!("the likeliest failure of those flown, {distance:.2} standard deviations off the middle")
                },
            );
            out.push_str(&format!("\n  {which}:\n"));
            for change in &likeliest.changes {
                out.push_str(&format!("    {change}\n"));
            }
            out.push_str(&format!("    again: {}\n", likeliest.command));
        }
        out.push('\n');
        for note in self.notes() {
            out.push_str(&format!("{note}\n"));
        }
        out
    }

    /// The number, or what is known in its place.
    fn headline(&self) -> String {
        if self.agree() == Some(false) {
            return format!(
                "with a probability that the two methods DISAGREE about: at most {} a flight, and no number",
                number(self.at_most())
            );
        }
        match self.interval() {
            Some(interval) if self.question.method == Method::Importance => format!(
                "once in {} flights, as far as one region of failures was found\n  a flight: {}",
                once(interval.estimate),
                range(interval)
            ),
            Some(interval) => format!(
                "once in {} flights\n  a flight: {}",
                once(interval.estimate),
                range(interval)
            ),
            None => {
                let why = self.known().into_iter().find_map(|(_, known)| match known {
                    Known::Below { why, .. } => Some(why.in_words()),
                    Known::Within(_) => None,
                });
                format!(
                    "at most {} a flight (95 %); no number: {}",
                    number(self.at_most()),
                    why.unwrap_or_default()
                )
            }
        }
    }

    fn hours(&self, Interval { estimate, low, high, .. }: Interval) -> String {
        let [estimate, low, high] = [estimate, low, high].map(|it| number(self.per_hour(it)));
        format!(
            "  an hour: {estimate} ({low} to {high}), converted: flights of {} s, one after the other\n",
            number(self.flight_s)
        )
    }

    fn cost(&self) -> String {
        let flown = whole(self.flights());
        match self.plain_flights() {
            Some(plain) if plain > self.flights() as f64 => format!(
                "  flights: {flown}; plain sampling takes {} for an interval as narrow, {} times as many\n",
                number(plain),
                number(plain / self.flights().max(1) as f64)
            ),
            Some(plain) => format!(
                "  flights: {flown}; plain sampling takes {}: it is not rare, and `fspid campaign run` is cheaper\n",
                number(plain)
            ),
            None => format!("  flights: {flown}\n"),
        }
    }

    fn levels(&self, subset: &Subset) -> String {
        let unit = match self.requirement.measure.unit() {
            "" => String::new(),
            unit => format!(" {unit}"),
        };
        let mut out = format!(
            "\n  {:<28}  {:<12}  moves made\n",
            "within so much of the limit", "probability"
        );
        for (place, rung) in subset.rungs.iter().enumerate() {
            let made = subset.teams.made.get(place).copied().unwrap_or(0.0);
            out.push_str(&format!(
                "  {:<28}  {:<12}  {:.0} %\n",
                format!("{}{unit}", number(-rung.level)),
                number(subset.reached(place + 1)),
                100.0 * made
            ));
        }
        let failing = subset.reached(subset.teams.shares.len());
        out.push_str(&format!("  {:<28}  {}\n", "beyond it", number(failing)));
        out
    }

    /// Whether what is required is met, and how many flights nobody can tell of.
    fn required_in_words(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if self.undecided > 0 {
            notes.push(format!(
                "Stability at rest is UNDECIDED of {} of the {} flights, which count as well flown in every number: `fspid simulate` says why.",
                whole(self.undecided),
                whole(self.flights())
            ));
        }
        if let (Some(most), Some(is_allowed)) = (self.question.most, self.is_allowed()) {
            let verdict = match (is_allowed, self.at_most() <= most) {
                (true, _) => "MET",
                (false, true) => "NOT MET, for nobody can tell whether all that flew is stable",
                (false, false) => "NOT MET",
            };
            notes.push(format!(
                "Required: at most {} a flight. The upper end is {}: {verdict}.",
                number(most),
                number(self.at_most())
            ));
        }
        notes
    }

    /// What should be known beside the number.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        let slow = |subset: &Subset| subset.teams.made.iter().any(|made| *made < FEW_MADE);
        if self.found.subset.as_ref().is_some_and(slow) {
            let why = if self.draws_seeds {
                ": seeds are drawn anew by each move, and few new ones come as near"
            } else {
                ""
            };
            notes.push(format!(
                "Few moves were made on some level, so that its flights are much alike{why}. The interval counts that, as far as teams differ; more flights are surer."
            ));
        }
        if let Some(Importance { effective, .. }) = self.found.importance
            && effective < LEAST_EFFECTIVE
        {
            notes.push(format!(
                "Importance sampling found as much as {effective:.0} failures of one weight; below {LEAST_EFFECTIVE:.0} it gives no interval."
            ));
        }
        if self.question.method == Method::Importance {
            notes.push("One normal distribution was fitted to the failures. Another region of failures that it did not find is not in the number and not in the interval: --method both asks subset simulation as well.".to_owned());
        }
        match self.agree() {
            Some(false) => notes.push("Where two methods disagree, one of them has not found all failures, or its interval is too narrow: ask again with more flights and another seed.".to_owned()),
            Some(true) => notes.push("Both methods agree within their intervals.".to_owned()),
            None => {}
        }
        notes.extend(self.required_in_words());
        let Seldom { share, likeliest } = &self.hardly_flown;
        if *share > 0.0 {
            notes.push(format!(
                "Of what is chosen among, combinations that come in {} of all flights were met too seldom to know what they do: all of that is in the upper end. The likeliest of them is {}. Ask again with it alone (--set), or with more flights.",
                number(*share),
                likeliest.join(", ")
            ));
        }
        notes.push("It is about the dispersions as they are written. Failures in a region that no flight came near are not in it.".to_owned());
        notes
    }
}

/// The name of a method in a sentence.
const fn in_words(method: Method) -> &'static str {
    match method {
        Method::Subset => "subset simulation",
        Method::Importance => "importance sampling",
        Method::Both => "both",
    }
}

fn known_in_words(known: Known) -> String {
    match known {
        Known::Within(interval) => range(interval),
        Known::Below { most, why } => format!("at most {}: {}", number(most), why.in_words()),
    }
}

fn range(Interval { estimate, low, high, .. }: Interval) -> String {
    format!("{} ({} to {} with 95 %)", number(estimate), number(low), number(high))
}

/// How many flights there are to one failure.
fn once(probability: f64) -> String {
    let flights = 1.0 / probability;
    if flights < 1e15 { whole(libm::round(flights) as u64) } else { number(flights) }
}
