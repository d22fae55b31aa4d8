//! The outcome for people.

use fspid_page::columns::{Align, Columns};

use super::compare::Comparison;
use super::headline::{beside_first, headline};
use super::judged::{Judged, Quantity};
use super::outcome::Outcome;
use super::words::{
    by_group, cautions, columns, counted, cut, name, number, p_value, sentence, signed, spread_of,
    standing,
};

pub(super) fn text(outcome: &Outcome) -> String {
    let head = headline(outcome);
    let mut out = format!("{}: {}.\n\n", head.word, head.why);
    let ranking = outcome.first().ranking;
    let others = ranking.iter().filter(|place| Some(**place) != head.told);
    for found in others.filter_map(|place| outcome.comparison(*place)) {
        out.push_str(&format!("{}\n", sentence(outcome, found)));
    }
    beside_first(outcome).iter().for_each(|line| out.push_str(&format!("{line}\n")));
    out.push_str("\nFirst to last, by kind of case:\n");
    by_group(outcome).iter().for_each(|line| out.push_str(&format!("  {line}\n")));
    out.push('\n');
    table(outcome, &mut out);
    mirrors(outcome, &mut out);
    gains(outcome, &mut out);
    out.push_str(&format!("\n{}\n", held(outcome)));
    cautions(outcome).iter().for_each(|line| out.push_str(&format!("{line}\n")));
    out
}

/// How it was held, in a few words.
pub(super) fn held(outcome: &Outcome) -> String {
    let (judged, setting) = (&outcome.judged, &outcome.setting);
    let tuned = judged.contestants.iter().filter(|it| it.is_tuned).count();
    let cases = counted(judged.evidence().len(), "case", "cases");
    let mut text = match setting.efforts.first().filter(|_| tuned > 0) {
        None => "Nobody was tuned; all fly as they are written".to_owned(),
        Some(effort) => format!(
            "{} tuned alike by {}, {} candidates, {}{}{}",
            counted(tuned, "controller", "controllers"),
            effort.optimiser,
            effort.budget,
            counted(setting.efforts.len(), "seed", "seeds"),
            match setting.limits.is_empty() {
                true => String::new(),
                false => format!(", on average {}", setting.limits.join(", ")),
            },
            match judged.contestants.len() - tuned {
                0 => String::new(),
                1 => "; one as it is written".to_owned(),
                others => format!("; {others} as they are written"),
            },
        ),
    };
    text.push_str(&format!("; judged on {cases} that nobody was tuned on"));
    if setting.runs > 0 {
        text.push_str(&format!(
            " with {} of the dispersions each",
            counted(setting.runs as usize, "draw", "draws")
        ));
    }
    text.push('.');
    text
}

fn table(outcome: &Outcome, out: &mut String) {
    let mut rows = Columns::new(&[
        ("controller", Align::Left),
        ("IAE [deg s]", Align::Right),
        ("difference", Align::Right),
        ("elevator travel [deg]", Align::Right),
        ("difference", Align::Right),
        ("lost", Align::Right),
        ("failed", Align::Right),
        ("standing", Align::Left),
    ]);
    for place in outcome.first().ranking {
        let (it, summary) = (&outcome.judged.contestants[place], &outcome.summaries[place]);
        let of = |quantity| spread_of(outcome, place, quantity);
        let count = summary.whole.count;
        let difference = |found: Option<&Comparison>| {
            found.and_then(|it| it.ratio.mean).map_or("\u{2013}".to_owned(), signed)
        };
        rows.row(vec![
            cut(&it.name, 40),
            of(Quantity::ERROR),
            difference(outcome.comparison(place)),
            of(Quantity::ACTIVITY),
            difference(outcome.activity_of(place)),
            format!("{} of {}", count.lost, count.of),
            format!("{} of {}", count.failed, count.of),
            stands(outcome, place),
        ]);
    }
    out.push_str(&rows.to_string());
    out.push_str(&format!("  {}\n", columns(outcome)));
    out.push_str("  Differences: geometric means of the ratios case by case, over the cases that neither lost; not ratios of these columns.\n");
}

fn stands(outcome: &Outcome, place: usize) -> String {
    match outcome.comparison(place) {
        None => "compared with".to_owned(),
        Some(found) if found.by_flights => {
            format!("{}, {}", standing(found), p_value(found.lost.p_adjusted))
        }
        Some(found) => format!("{}, {}", standing(found), p_value(found.p_adjusted)),
    }
}

/// The gains at rest of self-tuning controllers beside the nominal ones: of the design that cost least, in the first case.
fn gains(outcome: &Outcome, out: &mut String) {
    let lines = outcome.judged.contestants.iter().filter_map(|it| {
        let design = it.designs.get(Judged::best(it))?;
        let words = design.flights.first()?.gains.as_ref()?;
        Some(format!("  {}: {words}\n", cut(&it.name, 40)))
    });
    let lines: String = lines.collect();
    if !lines.is_empty() {
        out.push_str(match outcome.judged.is_tuned() {
            true => "\nGains of the designs that cost least, in the first case:\n",
            false => "\nGains in the first case:\n",
        });
        out.push_str(&lines);
    }
}

fn mirrors(outcome: &Outcome, out: &mut String) {
    if outcome.summaries.iter().all(|it| it.mirror.is_none()) {
        return;
    }
    out.push_str("\nCases and their mirror images, at most apart by:\n");
    for (place, summary) in outcome.summaries.iter().enumerate() {
        if let Some(line) = mirror(outcome, place, summary) {
            out.push_str(&format!("  {line}\n"));
        }
    }
}

/// How alike a controller flies both directions.
pub(super) fn mirror(outcome: &Outcome, place: usize, summary: &super::Summary) -> Option<String> {
    let found = summary.mirror?;
    let case = &outcome.judged.cases[found.case].name;
    let error = match found.error.is_infinite() {
        true => format!("lost in one direction and not in the other (\"{case}\")"),
        false => format!("{} % of the IAE (\"{case}\")", number(100.0 * found.error)),
    };
    let overshoot = found
        .overshoot_pct
        .filter(|it| it.is_finite())
        .map_or(String::new(), |it| format!(", {} points of overshoot", number(it)));
    Some(format!("{}: {error}{overshoot}", name(outcome, place)))
}
