//! The outcome for people.

use super::compare::Standing;
use super::judged::Quantity;
use super::outcome::Outcome;
use super::words::{by_group, cautions, change, counted, headline, name, number, p_value, sentence, spread};

pub(super) fn text(outcome: &Outcome) -> String {
    let mut out = format!("{}\n\n", headline(outcome));
    for found in outcome.error.iter().flatten() {
        out.push_str(&format!("{}\n", sentence(outcome, found)));
    }
    out.push_str("\nFirst to last, by kind of case:\n");
    by_group(outcome).iter().for_each(|line| out.push_str(&format!("  {line}\n")));
    out.push('\n');
    table(outcome, &mut out);
    mirrors(outcome, &mut out);
    out.push_str(&format!("\n{}\n", held(outcome)));
    cautions(outcome).iter().for_each(|line| out.push_str(&format!("{line}\n")));
    out
}

/// How it was held, in a few words.
pub(super) fn held(outcome: &Outcome) -> String {
    let (judged, setting) = (&outcome.judged, &outcome.setting);
    let tuned = judged.contestants.iter().filter(|it| it.is_tuned).count();
    let cases = counted(judged.cases.len(), "case", "cases");
    let mut text = match setting.efforts.first().filter(|_| tuned > 0) {
        None => "Nobody was tuned; all fly as they are written".to_owned(),
        Some(effort) => format!(
            "{} tuned alike by {}, {} candidates, {}; others as they are written",
            counted(tuned, "controller", "controllers"),
            effort.optimiser,
            effort.budget,
            counted(setting.efforts.len(), "seed", "seeds"),
        ),
    };
    text.push_str(&format!("; judged on {cases} that nobody was tuned on"));
    if setting.runs > 0 {
        text.push_str(&format!(" with {} of the dispersions each", counted(setting.runs as usize, "draw", "draws")));
    }
    text.push('.');
    text
}

fn table(outcome: &Outcome, out: &mut String) {
    let width = outcome.judged.contestants.iter().map(|it| it.name.chars().count()).max();
    let width = width.unwrap_or(0).clamp(10, 40);
    out.push_str(&format!(
        "  {:<width$}  {:>26}  {:>14}  {:>26}  {:>12}  {:>12}  {:<12}\n",
        "controller", "IAE [deg s]", "to the other", "elevator travel [deg]", "lost", "failed", "standing"
    ));
    for place in outcome.first().ranking {
        let (it, summary) = (&outcome.judged.contestants[place], &outcome.summaries[place]);
        let designs = it.designs.len();
        let of = |quantity| spread(summary.whole.spread(quantity), designs);
        let count = summary.whole.count;
        let (change, standing) = match outcome.comparison(place) {
            None => ("\u{2013}".to_owned(), "compared with".to_owned()),
            Some(found) => {
                let word = match found.standing {
                    Standing::Better => "better",
                    Standing::Worse => "worse",
                    Standing::Open => "not significant",
                };
                let ratio = found.ratio.mean.map_or("none".to_owned(), change);
                (ratio, format!("{word}, {}", p_value(found.p_adjusted)))
            }
        };
        let name: String = it.name.chars().take(width).collect();
        out.push_str(&format!(
            "  {name:<width$}  {:>26}  {change:>14}  {:>26}  {:>12}  {:>12}  {standing}\n",
            of(Quantity::ERROR),
            of(Quantity::ACTIVITY),
            format!("{} of {}", count.lost, count.of),
            format!("{} of {}", count.failed, count.of),
        ));
    }
    out.push_str("  Median over the seeds (quartiles) of the mean over the cases; a lost flight makes its mean \"lost\".\n");
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
pub(super) fn mirror(
    outcome: &Outcome,
    place: usize,
    summary: &super::Summary,
) -> Option<String> {
    let found = summary.mirror?;
    let case = &outcome.judged.cases[found.case].name;
    let error = match found.error.is_infinite() {
        true => format!("lost in one direction and not in the other (\"{case}\")"),
        false => format!("{} % of the IAE (\"{case}\")", number(100.0 * found.error)),
    };
    let overshoot = found.overshoot_pct.filter(|it| it.is_finite()).map_or(String::new(), |it| {
        format!(", {} points of overshoot", number(it))
    });
    Some(format!("{}: {error}{overshoot}", name(outcome, place)))
}
