//! Findings about the rules as written, and about what each of them does.

use fspid_fuzzy::audit::{RuleEffect, RulePosition};

use super::{Audit, Finding, Mark, count, finding, first_few};

pub(super) fn findings(audit: &Audit<'_>) -> Vec<Finding> {
    let mut all = vec![contradictions(audit), duplicates(audit), redundant(audit)];
    all.extend(effects(audit));
    all.extend(unused(audit));
    all.extend(unreached(audit));
    all
}

fn pair(audit: &Audit<'_>, rules: [RulePosition; 2]) -> String {
    let [one, other] = rules.map(|at| audit.rule(at));
    format!("{one} and {other}")
}

fn contradictions(audit: &Audit<'_>) -> Finding {
    let found = &audit.rules.contradictions;
    let rules = count(audit.rules.rules, "rule");
    if found.is_empty() {
        return finding(
            Mark::Holds,
            "contradictions",
            format!("{rules}; no two contradict each other"),
        );
    }
    let one = found.iter().map(|found| {
        let [a, b] = found.terms.map(|term| audit.output_term(found.output, term).to_owned());
        format!("{} conclude {a} and {b}", pair(audit, found.rules))
    });
    finding(Mark::NotMeant, "contradictions", format!("from the same condition {}", first_few(one)))
}

fn duplicates(audit: &Audit<'_>) -> Finding {
    let found = &audit.rules.duplicates;
    if found.is_empty() {
        return finding(Mark::Holds, "repetitions", "no rule is there twice");
    }
    let one = found.iter().map(|found| {
        let weights = if found.same_weight { "" } else { " with another weight" };
        format!("{} say the same{weights}", pair(audit, found.rules))
    });
    finding(Mark::Worth, "repetitions", first_few(one))
}

fn redundant(audit: &Audit<'_>) -> Finding {
    let found = &audit.rules.redundant;
    if found.is_empty() {
        return finding(
            Mark::Holds,
            "superfluous rules",
            "no rule is covered by another as written",
        );
    }
    let one = found.iter().map(|found| {
        format!(
            "{} changes nothing because of {}",
            audit.rule(found.rule),
            audit.rule(found.because_of)
        )
    });
    finding(Mark::Worth, "superfluous rules", first_few(one))
}

/// Rules that never lead, and those of which that could not be told.
fn effects(audit: &Audit<'_>) -> Vec<Finding> {
    let (mut idle, mut open) = (Vec::new(), Vec::new());
    for effect in &audit.surface.rules {
        match effect {
            RuleEffect::None { rule } => idle.push(audit.rule(*rule)),
            RuleEffect::Open { rule } => open.push(audit.rule(*rule)),
            RuleEffect::Leads { .. } => {}
        }
    }
    let mut all = Vec::new();
    if !idle.is_empty() {
        let sentence = format!(
            "never the strongest anywhere, so that they change nothing: {}",
            first_few(idle.into_iter())
        );
        all.push(finding(Mark::Worth, "idle rules", sentence));
    }
    if !open.is_empty() {
        let sentence =
            format!("not proved whether they change anything: {}", first_few(open.into_iter()));
        all.push(finding(Mark::Open, "idle rules", sentence));
    }
    if all.is_empty() {
        all.push(finding(Mark::Holds, "idle rules", "every rule is the strongest somewhere"));
    }
    all
}

/// Terms that no rule asks for.
fn unused(audit: &Audit<'_>) -> Option<Finding> {
    let inputs = audit.rules.inputs.iter().enumerate();
    let none = inputs.flat_map(|(input, uses)| {
        let unused = uses.iter().enumerate().filter(|(_, uses)| **uses == 0);
        unused.map(move |(term, _)| (input, term))
    });
    let none: Vec<String> = none
        .map(|(input, term)| format!("{} of {}", audit.input_term(input, term), audit.input(input)))
        .collect();
    let few = (!none.is_empty()).then(|| first_few(none.into_iter()))?;
    Some(finding(Mark::Worth, "unused terms", format!("no rule asks for {few}")))
}

/// Terms that are 0 over the whole range.
fn unreached(audit: &Audit<'_>) -> Option<Finding> {
    let inputs = audit.surface.terms.iter().enumerate();
    let none = inputs.flat_map(|(input, reaches)| {
        let dead = reaches.iter().enumerate().filter(|(_, reach)| reach.highest.bounds[1] <= 0.0);
        dead.map(move |(term, _)| (input, term))
    });
    let none: Vec<String> = none
        .map(|(input, term)| format!("{} of {}", audit.input_term(input, term), audit.input(input)))
        .collect();
    let few = (!none.is_empty()).then(|| first_few(none.into_iter()))?;
    Some(finding(Mark::NotMeant, "unreached terms", format!("no value of the range reaches {few}")))
}
