//! The answer for people.

use fspid_diagnostics::digits::{counted, to_digits};
use fspid_page::columns::{Align, Columns};
use fspid_page::number::significant;

use super::answer::{Answer, Followed, Moved, PlantRow, Row, Step};
use super::draws::{Estimate, FEWEST};
use super::treatment::Treatment;

impl Answer {
    /// For people.
    #[must_use]
    pub fn text(&self) -> String {
        let mut out = format!("{}\n{}\n\n", self.headline(), self.detail());
        out.push_str(&format!("{}, one thing after the other:\n", self.made_of()));
        out.push_str(&steps(self));
        out.push_str("\nThe same flights with something else in the place of the supervisor, beside them as they are:\n");
        out.push_str(&rows(self));
        out.push_str("\nHow the gains move:\n");
        self.moved.iter().for_each(|it| out.push_str(&format!("  {}\n", moved(it))));
        out.push_str("\nWhat the mean gains follow:\n");
        self.follows().iter().for_each(|it| out.push_str(&format!("  {it}\n")));
        out.push('\n');
        self.notes().iter().for_each(|it| out.push_str(&format!("{it}\n")));
        out
    }

    /// What the steps add up to: a win only where the error is smaller for certain, and nothing bars it.
    pub(super) fn whole(&self) -> &'static str {
        let is_smaller =
            self.win.is_some_and(|it| it.interval.is_some_and(|[_, upper]| upper < 1.0));
        let is_win = is_smaller && self.barred.is_none();
        if is_win { "win" } else { "difference" }
    }

    /// The heading of the steps.
    pub(super) fn made_of(&self) -> String {
        format!("What the {} is made of", self.whole())
    }

    /// Name of a step, and what it is in words.
    pub(super) fn called(&self, step: &Step) -> (&'static str, &'static str) {
        let is_known = self.step(Treatment::OtherPlants).is_some();
        match step.treatment {
            Treatment::AsItIs if !is_known => Treatment::UNKNOWN,
            treatment => treatment.step().unwrap_or_default(),
        }
    }

    fn step(&self, treatment: Treatment) -> Option<&Step> {
        self.steps.iter().find(|it| it.treatment == treatment)
    }

    /// True where the step makes the error smaller for certain, by more than nothing.
    pub(super) fn helps(&self, treatment: Treatment) -> bool {
        self.effect(treatment) == Effect::Helps
    }

    fn effect(&self, treatment: Treatment) -> Effect {
        let iae = self.step(treatment).and_then(|it| it.iae);
        match iae.and_then(|it| it.interval) {
            Some([_, upper]) if upper < 1.0 - NOTHING => Effect::Helps,
            Some([lower, _]) if lower > 1.0 + NOTHING => Effect::Harms,
            Some([lower, upper]) if lower > 1.0 - NOTHING && upper < 1.0 + NOTHING => {
                Effect::Nothing
            }
            _ => Effect::NotShown,
        }
    }

    /// Plants that have a flight in the win; the others are no evidence of it.
    #[must_use]
    pub fn plants_kept(&self) -> usize {
        self.plants.iter().filter(|it| it.kept > 0).count()
    }

    /// True where there are plants enough, and flights that other plants fly as well.
    pub(super) fn is_told(&self) -> bool {
        self.plants_kept() >= FEWEST && self.step(Treatment::OtherPlants).is_some()
    }

    /// What it comes to, in a sentence without numbers.
    #[must_use]
    pub fn headline(&self) -> String {
        let name = &self.controller;
        if self.plants_kept() < FEWEST {
            let words = |plants: usize| match plants {
                0 => "none is".to_owned(),
                1 => "one is".to_owned(),
                many => format!("{many} are"),
            };
            let (kept, all) = (self.plants_kept(), self.plants.len());
            let here = match kept == all {
                true => format!("here {} flown", words(all)),
                false => format!("of the {all} that fly here {} in the win", words(kept)),
            };
            return format!(
                "Of {name} nothing is said for certain: adaptation is judged over {FEWEST} plants or more, and {here}."
            );
        }
        if let Some(barred) = &self.barred {
            return barred.clone();
        }
        if self.step(Treatment::OtherPlants).is_none() {
            return format!(
                "Whether {name} adapts is open: no two plants fly the same command, disturbances and air."
            );
        }
        let told = self.what_helps();
        match self.win.and_then(|it| it.interval) {
            Some([lower, _]) if lower > 1.0 => {
                format!("{told} Its error is larger than that of {} all the same.", self.beside())
            }
            _ => told,
        }
    }

    /// Whether its adaptation and its answers to the moment help, in a sentence.
    fn what_helps(&self) -> String {
        let name = &self.controller;
        let (plant, moment) = (self.effect(Treatment::AsItIs), self.effect(Treatment::OtherPlants));
        match (plant, moment) {
            (Effect::Helps, Effect::Helps) => {
                format!("{name} adapts to its plant, and it answers the moment.")
            }
            (Effect::Helps, moment) => {
                format!(
                    "{name} adapts to its plant; that it answers the moment {}.",
                    moment.words()
                )
            }
            (plant, Effect::Helps) => format!(
                "{name} answers the moment, alike on every plant; that it adapts to its plant {}.",
                plant.words()
            ),
            (Effect::NotShown, Effect::NotShown) => {
                format!(
                    "That {name} adapts to its plant, or answers the moment, is not shown to help."
                )
            }
            (Effect::Nothing, Effect::Nothing) => format!(
                "That {name} adapts to its plant, or answers the moment, is not shown to help: neither changes a thousandth."
            ),
            (plant, moment) => format!(
                "That {name} adapts to its plant {}; that it answers the moment {}.",
                plant.words(),
                moment.words()
            ),
        }
    }

    /// What it is held against.
    fn beside(&self) -> &str {
        self.against.as_deref().unwrap_or("its own nominal gains")
    }

    /// The win in numbers.
    #[must_use]
    pub fn detail(&self) -> String {
        let beside = self.beside();
        let flights = counted(self.kept, "flight");
        let plants = counted(self.plants_kept(), "plant");
        let iae = self.win.map_or("no mean".to_owned(), change);
        let travel = self.win_travel.map_or("no mean".to_owned(), change);
        format!(
            "Beside {beside}: IAE {iae}, travel of the elevator {travel}; {flights} of {plants}."
        )
    }

    /// What the mean gains follow, a sentence for each gain.
    pub(super) fn follows(&self) -> Vec<String> {
        let all = self.following.iter().map(|it| {
            let mut words = Vec::new();
            let mut tell = |what: &str, found: Option<Followed>| {
                if let Some(found) = found {
                    words.push(format!("{what} {}", slope(found)));
                }
            };
            tell("with the effectiveness of the elevator", it.effectiveness);
            tell("the best gain with the same", it.best_by_effectiveness);
            tell("with the airspeed", it.airspeed);
            tell("with the best gain", it.best);
            if let Some(found) = it.amplitude {
                words.push(format!(
                    "within a plant {} % for a degree of command{} (r {})",
                    signed(100.0 * found.slope.value, 2),
                    interval(found.slope.map(|it| 100.0 * it), 2),
                    significant(found.correlation.value, 2)
                ));
            }
            match words.is_empty() {
                true => format!("{}: nothing differs, or it is not positive", it.gain),
                false => format!("{}: {}", it.gain, words.join("; ")),
            }
        });
        all.collect()
    }

    /// What is to be known before the numbers are believed.
    pub(super) fn notes(&self) -> Vec<String> {
        let (seeds, _, budget) = self.effort;
        // Beside few plants the headline says that they are few.
        let barred = self.barred.clone().filter(|barred| *barred != self.headline());
        let mut notes: Vec<String> = barred.into_iter().collect();
        notes.extend([
            "Gains of the other plants: at each moment the mean of those that the same flight has on all of them. They know command, disturbance, air and time, and not the plant; what the own gains do beyond them is adaptation.".to_owned(),
            "A step takes what later ones could have done as well; the order is that of how much has to be known. Frozen gains carry with them what follows the gains.".to_owned(),
            format!(
                "{} of time with each flight; the gains of a plant are the best of {budget} candidates within the gain limits (or 4 times nominal either way), with at most the travel of the flights as they are, breaking nothing that these keep.",
                counted(usize::try_from(seeds).unwrap_or(usize::MAX), "shuffle")
            ),
        ]);
        notes.push(match self.plants_kept() < FEWEST {
            true => format!("Fewer than {FEWEST} plants in the win: no intervals of it."),
            false => "Intervals are of 95 %, Student's, by what it changes to leave out plants, each with all its flights and its gains in the means of others, and seeds; of very few plants they are still somewhat short.".to_owned(),
        });
        let has_no_end = |it: &Step| it.share.is_some_and(|share| share.interval.is_none());
        if self.plants_kept() >= FEWEST && self.steps.iter().any(has_no_end) {
            notes.push("The shares have no intervals: the whole may be nothing, and of nothing anything is any share.".to_owned());
        }
        if self.kept < self.flights {
            notes.push(format!(
                "{} of {} left out of the win: lost with some of what it is made of, or flown on no other plant.",
                self.flights - self.kept,
                counted(self.flights, "flight")
            ));
        }
        notes.extend(self.of_plants());
        notes
    }

    /// What of the plants is no evidence, or none of its own.
    fn of_plants(&self) -> Vec<String> {
        let mut notes = Vec::new();
        let outside = self.plants.len() - self.plants_kept();
        if outside > 0 {
            let is = if outside == 1 { "is" } else { "are" };
            notes.push(format!(
                "{} of {} {is} in no part of the win, and no evidence of it: no interval and no count goes by {}.",
                outside,
                counted(self.plants.len(), "plant"),
                if outside == 1 { "it" } else { "them" }
            ));
        }
        for plant in self.plants.iter().filter(|it| it.written > 1) {
            notes.push(format!(
                "The plant of \"{}\" is written in {} ways, and is one: each of its flights is alike with any of them.",
                plant.name, plant.written
            ));
        }
        notes
    }
}

/// A ratio of errors that is no further from 1 is nothing, however certain it is.
const NOTHING: f64 = 1e-3;

/// What a step does to the error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Effect {
    Helps,
    Nothing,
    NotShown,
    Harms,
}

impl Effect {
    const fn words(self) -> &'static str {
        match self {
            Self::Helps => "helps",
            Self::Nothing => "changes less than a thousandth",
            Self::NotShown => "is not shown to help",
            Self::Harms => "makes it worse",
        }
    }
}

/// In the place of a number that there is not; "none" is a count of 0.
pub(super) const UNDEFINED: &str = "\u{2013}";

/// What moves by less, as a share of its mean, moves by rounding.
const STILL: f64 = 1e-9;

/// A ratio as a change: "10 % less (8 to 12 %)".
pub(super) fn change(ratio: Estimate) -> String {
    let percent = 100.0 * (ratio.value - 1.0);
    let interval = ratio.interval.map(|ends| ends.map(|it| 100.0 * (it - 1.0)));
    let interval = interval.map_or(String::new(), |[lower, upper]| {
        format!(" ({} to {} %)", signed(lower, 2), signed(upper, 2))
    });
    format!("{} %{interval}", signed(percent, 2))
}

/// With its sign, and so many digits.
fn signed(value: f64, digits: usize) -> String {
    let text = if value.abs() < 0.005 { "0".to_owned() } else { significant(value, digits) };
    if value >= 0.005 { format!("+{text}") } else { text }
}

fn interval(found: Estimate, digits: usize) -> String {
    found.interval.map_or(String::new(), |[lower, upper]| {
        format!(" ({} to {})", signed(lower, digits), signed(upper, digits))
    })
}

/// A share: "34 % (20 to 45 %)".
pub(super) fn share(found: Estimate) -> String {
    let percent = found.map(|it| 100.0 * it);
    let interval = percent.interval.map_or(String::new(), |[lower, upper]| {
        format!(" ({} to {} %)", whole(lower), whole(upper))
    });
    format!("{} %{interval}", whole(percent.value))
}

fn whole(value: f64) -> String {
    fspid_page::number::fixed(value, 0)
}

/// "-0.62 % for 1 % (-0.8 to -0.4), r -0.93".
pub(super) fn slope(found: Followed) -> String {
    format!(
        "{} % for 1 %{}, r {}",
        signed(found.slope.value, 2),
        interval(found.slope, 2),
        significant(found.correlation.value, 2)
    )
}

pub(super) fn lost(row: &Row) -> String {
    match row.lost {
        0 => "none".to_owned(),
        lost => format!("{lost} of {}", row.flights),
    }
}

pub(super) fn broken(row: &Row) -> String {
    row.broken.map_or("not asked".to_owned(), |it| format!("{it} of {}", row.flights))
}

/// Flights of loops that are unstable at rest, and those of which nobody can tell.
pub(super) fn unstable(row: &Row) -> String {
    match (row.unstable, row.undecided) {
        (Some(0), Some(0)) => "none".to_owned(),
        (Some(unstable), Some(0)) => format!("{unstable} of {}", row.flights),
        (Some(unstable), Some(undecided)) => {
            format!("{unstable} of {}, undecided {undecided}", row.flights)
        }
        _ => "not asked".to_owned(),
    }
}

fn steps(answer: &Answer) -> String {
    let of_whole = format!("share of the {}", answer.whole());
    let heads = ["what comes in", "IAE", &of_whole, "travel"];
    let mut table = Columns::new(&heads.map(|head| (head, Align::Left)));
    for step in &answer.steps {
        let (_, words) = answer.called(step);
        let number =
            |it: Option<Estimate>, of: fn(Estimate) -> String| it.map_or(UNDEFINED.to_owned(), of);
        table.row(vec![
            words.to_owned(),
            number(step.iae, change),
            number(step.share, share),
            number(step.travel, change),
        ]);
    }
    table.to_string()
}

fn rows(answer: &Answer) -> String {
    let heads = ["flown", "IAE", "travel", "lost", "breaks a requirement", "unstable at rest"];
    let mut table = Columns::new(&heads.map(|head| (head, Align::Left)));
    for row in &answer.rows {
        let number = |it: Option<Estimate>| it.map_or(UNDEFINED.to_owned(), change);
        let (iae, travel) = match row.treatment {
            Treatment::AsItIs => ("1".to_owned(), "1".to_owned()),
            _ => (number(row.iae), number(row.travel)),
        };
        table.row(vec![name(answer, row), iae, travel, lost(row), broken(row), unstable(row)]);
    }
    table.to_string()
}

/// What flew, by the name of the controller where it is another.
pub(super) fn name(answer: &Answer, row: &Row) -> String {
    match (row.treatment, &answer.against) {
        (Treatment::Against, Some(against)) => against.clone(),
        (treatment, _) => treatment.words().to_owned(),
    }
}

pub(super) fn moved(it: &Moved) -> String {
    let part = |found: Option<Estimate>| found.map_or(UNDEFINED.to_owned(), share);
    if !(it.deviation > STILL * it.mean.abs()) {
        return format!("{}: it does not move from {}", it.gain, to_digits(it.mean, 4));
    }
    format!(
        "{}: nominal {}, mean {}, deviation {}; of its variance {} between plants, {} between flights of a plant, {} within flights",
        it.gain,
        to_digits(it.nominal, 4),
        to_digits(it.mean, 4),
        to_digits(it.deviation, 3),
        part(it.between_plants),
        part(it.between_flights),
        part(it.within_flights)
    )
}

/// A number of a plant that may be unknown.
pub(super) fn known(value: Option<f64>) -> String {
    value.map_or("unknown".to_owned(), |it| to_digits(it, 3))
}

/// The gains of a plant, those of its flights and the best.
pub(super) fn gains(row: &PlantRow) -> [[String; 2]; 3] {
    let of = |gain: fn(&fspid_core::Gains<f64>) -> f64| {
        let best = row.best.as_ref().map(gain);
        [to_digits(gain(&row.mean), 4), best.map_or(UNDEFINED.to_owned(), |it| to_digits(it, 4))]
    };
    [of(|it| it.kp), of(|it| it.ki), of(|it| it.kd)]
}
