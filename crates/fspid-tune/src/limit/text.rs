//! The answer for people.

use fspid_page::columns::{Align, Columns};
use fspid_page::number::fixed;
use fspid_scenario::units::degrees;

use super::words::{beside, called, causal_is_told, down, in_unit, lead, none, share, unit, up};
use super::{Answer, Rung, Standing};

pub(super) fn text(answer: &Answer) -> String {
    let mut out = format!("{}\n\n{}\n", answer.lead_name(), lead(answer));
    out.push_str(&ladder(answer));
    out.push_str(&controllers_with_beside(answer));
    out
}

/// The table of the controllers, and what is said beside it.
pub(super) fn controllers_with_beside(answer: &Answer) -> String {
    let mut out = String::new();
    if !answer.controllers.is_empty() {
        out.push_str(&format!("\n{}", controllers(answer)));
    }
    let told = beside(answer);
    if !told.is_empty() {
        out.push('\n');
    }
    told.iter().for_each(|line| out.push_str(&format!("{line}\n")));
    out
}

impl Answer {
    /// The scenario's name, as a heading.
    pub(super) fn lead_name(&self) -> String {
        match self.scenario.trim() {
            "" => "How good could any controller be?".to_owned(),
            name => format!("{name}: how good could any controller be?"),
        }
    }
}

fn ladder(answer: &Answer) -> String {
    let measure = answer.options.measure;
    let (name, unit) = (called(measure), unit(measure));
    let travel = format!("{} [deg]", answer.options.travel.words());
    let proved = format!("{name} proved, at least [{unit}]");
    let reached = format!("reached [{unit}]");
    let without = format!("without the future [{unit}]");
    let mut head = vec![
        (travel.as_str(), Align::Right),
        (proved.as_str(), Align::Right),
        (reached.as_str(), Align::Right),
    ];
    let causal = causal_is_told(answer);
    if causal {
        head.push((without.as_str(), Align::Right));
    }
    let mut rows = Columns::new(&head);
    for rung in &answer.rungs {
        let mut row = vec![fixed(degrees(rung.travel_rad), 2)];
        row.extend(limits(answer, rung));
        if causal {
            row.push(without_future(answer, rung));
        }
        rows.row(row);
    }
    let refused = answer.rungs.iter().filter_map(|rung| {
        let why = none(rung)?;
        Some(format!("  at {} deg: {why}\n", fixed(degrees(rung.travel_rad), 2)))
    });
    format!("\n{rows}{}", refused.collect::<String>())
}

/// What is proved, and what is reached.
pub(super) fn limits(answer: &Answer, rung: &Rung) -> [String; 2] {
    let measure = answer.options.measure;
    let proved = rung.limit.as_ref().ok().map(|it| down(in_unit(measure, it.proved)));
    let reached = rung.reached.map(|it| up(in_unit(measure, it.measure)));
    [proved, reached].map(|it| it.unwrap_or("\u{2013}".to_owned()))
}

pub(super) fn without_future(answer: &Answer, rung: &Rung) -> String {
    let told = rung.causal.as_ref();
    told.map_or("\u{2013}".to_owned(), |it| up(in_unit(answer.options.measure, it.reached.measure)))
}

fn controllers(answer: &Answer) -> String {
    let measure = answer.options.measure;
    let unit = unit(measure);
    let (own, least) = (format!("{} [{unit}]", called(measure)), format!("limit there [{unit}]"));
    let mut rows = Columns::new(&[
        ("controller", Align::Left),
        (own.as_str(), Align::Right),
        ("travel [deg]", Align::Right),
        (least.as_str(), Align::Right),
        ("of what is possible", Align::Right),
    ]);
    for it in &answer.controllers {
        let [value, way] = flown(answer, it);
        let least =
            it.rung.as_ref().map_or("\u{2013}".to_owned(), |it| limits(answer, it)[0].clone());
        rows.row(vec![it.name.clone(), value, way, least, possible(it)]);
    }
    let lost = answer.controllers.iter().filter_map(|it| {
        let why = it.flown.as_ref().err()?;
        Some(format!("  {}: {why}; nothing to compare\n", it.name))
    });
    format!("{rows}{}", lost.collect::<String>())
}

/// What a controller reached, and took.
pub(super) fn flown(answer: &Answer, standing: &Standing) -> [String; 2] {
    match &standing.flown {
        Ok((value, way)) => {
            let value = in_unit(answer.options.measure, *value);
            [up(value), fixed(degrees(*way), 2)]
        }
        Err(_) => ["\u{2013}".to_owned(), "\u{2013}".to_owned()],
    }
}

/// How much of what is possible a controller reaches.
pub(super) fn possible(standing: &Standing) -> String {
    let flown = standing.flown.as_ref().ok();
    let told = standing.rung.as_ref().zip(flown).and_then(|(rung, (value, _))| share(rung, *value));
    told.unwrap_or("\u{2013}".to_owned())
}
