//! The outcome for programs.

use fspid_study::json::with_null_reasons;
use serde::Serialize;
use serde_json::{Map, Value, json};

use super::compare::{CONFIDENCE, Comparison, Ratio, Standing};
use super::headline::{Headline, headline};
use super::judged::{CaseGroup, Contestant, Design, Quantity};
use super::outcome::{First, Outcome};
use super::summary::{Spread, Summary};

/// Version of the format.
const SCHEMA: u32 = 1;

/// Why keys of the answer are null.
const NULLS: [(&str, &str); 7] = [
    ("winner", "none is known to be better than all others; `why` says more"),
    ("compared", "it is the one that all others are compared with"),
    ("mirror", "no case is another's mirror image"),
    ("draws_seed", "nothing is drawn"),
    ("mirror_of", "the case is no other's mirror image"),
    ("tuning", "nothing was tuned"),
    ("against", "there is none to compare with"),
];

pub(super) fn json(outcome: &Outcome) -> Value {
    let judged = &outcome.judged;
    let name = |place: usize| judged.contestants.get(place).map(|it| it.name.as_str());
    let setting = &outcome.setting;
    let effort = setting.efforts.first();
    let tuned = effort.map(|effort| {
        json!({
            "optimiser": effort.optimiser,
            "budget": effort.budget,
            "seeds": setting.efforts.iter().map(|it| it.seed).collect::<Vec<_>>(),
            "objectives": setting.objectives,
            "limits": setting.limits,
            "cases": setting.training,
            "runs": setting.training_runs,
        })
    });
    let controllers = judged.contestants.iter().zip(&outcome.summaries).enumerate();
    let groups =
        judged.groups().into_iter().enumerate().map(|(place, CaseGroup { name, cases })| {
            let first = outcome.first_of_group(place);
            json!({ "name": name, "cases": cases.len(), "ranking": ranking(outcome, &first) })
        });
    let answer = json!({
        "schema": SCHEMA,
        "scenario": setting.scenario,
        "digest": setting.digest,
        "confidence": CONFIDENCE,
        "against": name(judged.against),
        "tuning": tuned,
        "verdict": verdict(outcome),
        "ranking": ranking(outcome, &outcome.first()),
        "groups": groups.collect::<Vec<_>>(),
        "cases": cases(outcome),
        "controllers": controllers.map(|(place, (it, summary))| controller(outcome, place, it, summary)).collect::<Vec<_>>(),
    });
    with_null_reasons(answer, &NULLS)
}

/// What stands at the head of the text and of the page.
fn verdict(outcome: &Outcome) -> Value {
    let Headline { word, winner, why, .. } = headline(outcome);
    let name = |place: usize| outcome.judged.contestants.get(place).map(|it| it.name.as_str());
    let beside = outcome.beside_first.iter().flatten().map(|it| {
        json!({
            "name": name(it.contestant),
            "standing": standing(it),
            "by_lost_flights": it.by_flights,
            "p_adjusted": it.p_adjusted,
            "lost_p_adjusted": it.lost.p_adjusted,
            "evidence_cases": it.evidence,
        })
    });
    json!({
        "winner": winner.and_then(name),
        "words": word,
        "why": why,
        "first": name(outcome.leader()),
        "beside_first": beside.collect::<Vec<_>>(),
    })
}

fn ranking<'a>(outcome: &'a Outcome, first: &First) -> Vec<&'a str> {
    first.ranking.iter().map(|place| outcome.judged.contestants[*place].name.as_str()).collect()
}

fn cases(outcome: &Outcome) -> Vec<Value> {
    let judged = &outcome.judged;
    let case = |(place, case): (usize, &super::Case)| {
        let errors = judged.contestants.iter().zip(&outcome.summaries);
        let errors: Map<String, Value> = errors
            .map(|(it, summary)| {
                let part = &summary.cases[place];
                (it.name.clone(), json!(part.spread(Quantity::ERROR)))
            })
            .collect();
        json!({
            "name": case.name,
            "group": case.group,
            "set": case.set,
            "runs": case.runs,
            "draws_seed": case.draws_seed,
            "mirror_of": case.mirror_of.map(|it| judged.cases[it].name.as_str()),
            "iae_deg_s": errors,
        })
    };
    judged.cases.iter().enumerate().map(case).collect()
}

fn controller(
    outcome: &Outcome,
    place: usize,
    contestant: &Contestant,
    summary: &Summary,
) -> Value {
    let groups = outcome.judged.groups().into_iter().zip(&summary.groups);
    let groups: Vec<Value> = groups
        .map(|(group, it)| json!({ "name": group.name, "measures": measures(&it.spreads), "flights": it.count }))
        .collect();
    let mirror = summary.mirror.map(|it| {
        json!({
            "largest_relative_difference": it.error,
            "lost_on_one_side": it.error.is_infinite(),
            "largest_overshoot_difference_pct": it.overshoot_pct,
            "case": outcome.judged.cases[it.case].name,
        })
    });
    let compare = |quantity: &str, found: Option<&Vec<Comparison>>| {
        let found = found.and_then(|all| all.iter().find(|it| it.contestant == place));
        (quantity.to_owned(), found.map_or(Value::Null, |it| comparison(outcome, it)))
    };
    let compared: Map<String, Value> = [
        compare("iae_deg_s", outcome.error.as_ref()),
        compare("elevator_travel_deg", outcome.activity.as_ref()),
        compare("cost", outcome.cost.as_ref()),
    ]
    .into_iter()
    .collect();
    let is_reference = place == outcome.judged.against;
    json!({
        "name": contestant.name,
        "tuned": contestant.is_tuned,
        "measures": measures(&summary.whole.spreads),
        "measures_where_nobody_lost": measures(&summary.whole.kept),
        "flights": summary.whole.count,
        "lost_interval": summary.lost,
        "failed_interval": summary.failed,
        "groups": groups,
        "mirror": mirror,
        "compared": if is_reference { Value::Null } else { Value::Object(compared) },
        "designs": contestant.designs.iter().map(design).collect::<Vec<_>>(),
    })
}

fn design(design: &Design) -> Value {
    match &design.found {
        None => Value::Null,
        Some(found) => json!({
            "seed": found.effort.seed,
            "cost": found.cost,
            "candidates": found.candidates,
            "flights_per_candidate": found.flights,
            "stop": found.stop,
            "parameters": found.numbers,
            "reasons": found.reasons.iter().map(|it| it.trim()).collect::<Vec<_>>(),
        }),
    }
}

/// How a controller stands beside the other, in a word for programs.
fn standing(found: &Comparison) -> &'static str {
    match (found.standing, found.is_sure) {
        (Standing::Better, true) => "better",
        (Standing::Worse, true) => "worse",
        (Standing::Better, false) => "ahead",
        (Standing::Worse, false) => "behind",
        (Standing::Open, _) => "not significant",
        (Standing::Barred, _) => "barred by failures",
    }
}

/// JSON has no infinity: a ratio with lost flights is null, and the flights are counted beside it.
fn comparison(outcome: &Outcome, found: &Comparison) -> Value {
    let names = outcome.judged.groups();
    let groups = names.iter().zip(&found.groups);
    let groups = groups.map(|(group, ratio)| GroupRatio { ratio, name: &group.name });
    let cases = outcome.judged.cases.iter().zip(&found.cases);
    let cases: Map<String, Value> =
        cases.map(|(case, it)| (case.name.clone(), json!(libm::exp(*it)))).collect();
    let typical = found.typical.map(|it| {
        let interval = [it.lower, it.upper].map(libm::exp);
        json!({
            "ratio": libm::exp(it.estimate),
            "interval": interval,
            "p": it.p,
        })
    });
    json!({
        "standing": standing(found),
        "evidence_cases": found.evidence,
        "by_lost_flights": found.by_flights,
        "lost": found.lost,
        "ratio_of_means": found.ratio_of_means,
        "mean_ratio": found.ratio,
        "typical": typical,
        "p": found.p,
        "p_adjusted": found.p_adjusted,
        "groups": groups.collect::<Vec<_>>(),
        "case_ratios": cases,
    })
}

/// A group of cases with the mean ratio over them.
#[derive(Serialize)]
struct GroupRatio<'a> {
    #[serde(flatten)]
    ratio: &'a Ratio,
    name: &'a str,
}

fn measures(spreads: &[Option<Spread>]) -> Map<String, Value> {
    let all = Quantity::all().zip(spreads);
    all.map(|(quantity, it)| (quantity.name().to_owned(), json!(it))).collect()
}
