//! Rules that conclude the same about an output that weighs its terms.
//!
//! The standard and jFuzzyLogic join their strengths by `ACCU` and weigh the term once, where a weighted method here adds
//! up. They are read as one rule whose condition is joined by that norm, which is the same answer.

use std::collections::BTreeMap;

use fspid_fuzzy::SNormKind;
use fspid_fuzzy::system::{Antecedent, Consequent, Parts, Rule, RuleBlock, SNorm, TNorm, Variable};

use crate::fcl::connectives::Uses;
use crate::repeated;
use crate::rule::{MAX_DEPTH, depth};

/// A term of an output.
type Conclusion = (usize, usize);

/// Joins the rules that conclude the same about an output; tells how many became how many.
///
/// # Errors
/// Why one rule cannot say it.
pub(super) fn join(parts: &mut Parts, output: usize) -> Result<Option<[usize; 2]>, &'static str> {
    let terms = repeated::terms(parts, output);
    let Some(norm) = parts.outputs.get(output).and_then(|own| single(&own.aggregation)) else {
        return Ok(None);
    };
    let Some(&(block, _)) = terms.values().flatten().next() else { return Ok(None) };
    if terms.values().flatten().any(|&(other, _)| other != block) {
        return Err("they stand in several rule blocks");
    }
    let Some(block) = parts.blocks.get_mut(block) else { return Ok(None) };
    let asks =
        |rule: &Rule| rule.antecedent.asks(&|variable| matches!(variable, Variable::Output(_)));
    if block.rules.iter().any(asks) {
        return Err("rules beside them ask outputs, which are answered in the order of the rules");
    }
    let before = block.rules.len();
    with_or(block, norm)?;
    let wanted = terms.keys().map(|&term| ((output, term), Vec::new())).collect();
    block.rules = rewritten(&block.rules, wanted, norm)?;
    Ok(Some([before, block.rules.len()]))
}

/// The norm that joins two strengths as an accumulation does; none where they are added up.
fn single(aggregation: &SNorm) -> Option<SNormKind> {
    match aggregation {
        SNorm::Kind(SNormKind::UnboundedSum) | SNorm::Formula(_) => None,
        // A sum above 1 becomes 1.
        SNorm::Kind(SNormKind::NormalizedSum) => Some(SNormKind::BoundedSum),
        SNorm::Kind(kind) => Some(*kind),
    }
}

/// Gives a block this *or*; an *or* of its rules is said by *and* and *not* where that is the same.
fn with_or(block: &mut RuleBlock, norm: SNormKind) -> Result<(), &'static str> {
    if Uses::of(&block.rules).or && !block.or.is(norm) {
        let mirrored = matches!(block.and, TNorm::Kind(and) if block.or.is(and.dual()));
        if !mirrored {
            return Err("their block has another OR, which is no mirror image of its AND");
        }
        for rule in &mut block.rules {
            rule.antecedent = without_or(&rule.antecedent);
        }
    }
    block.or = norm.into();
    Ok(())
}

/// *a or b* as *not (not a and not b)*.
fn without_or(antecedent: &Antecedent) -> Antecedent {
    let each = |parts: &[Antecedent]| parts.iter().map(without_or).collect::<Vec<_>>();
    match antecedent {
        Antecedent::Any(parts) => {
            negated(Antecedent::All(each(parts).into_iter().map(negated).collect()))
        }
        Antecedent::All(parts) => Antecedent::All(each(parts)),
        Antecedent::Not(part) => negated(without_or(part)),
        Antecedent::Always | Antecedent::Is(_) => antecedent.clone(),
    }
}

fn negated(part: Antecedent) -> Antecedent {
    Antecedent::Not(Box::new(part))
}

/// The rules without the wanted conclusions, and where the first of each stood a rule for all of them.
fn rewritten(
    rules: &[Rule],
    mut wanted: BTreeMap<Conclusion, Vec<Rule>>,
    norm: SNormKind,
) -> Result<Vec<Rule>, &'static str> {
    let key = |own: &Consequent| (own.output, own.term);
    for rule in rules {
        for own in &rule.consequents {
            if let Some(all) = wanted.get_mut(&key(own)) {
                all.push(Rule { consequents: vec![own.clone()], ..rule.clone() });
            }
        }
    }
    let mut found = Vec::with_capacity(rules.len());
    for rule in rules {
        let is_wanted = |own: &&Consequent| wanted.contains_key(&key(own));
        let kept: Vec<Consequent> =
            rule.consequents.iter().filter(|own| !is_wanted(own)).cloned().collect();
        let begun: Vec<Vec<Rule>> = rule
            .consequents
            .iter()
            .filter_map(|own| wanted.get_mut(&key(own)).map(std::mem::take))
            .collect();
        if !kept.is_empty() {
            found.push(Rule { consequents: kept, ..rule.clone() });
        }
        for all in begun.into_iter().filter(|all| !all.is_empty()) {
            found.push(one(all, norm)?);
        }
    }
    Ok(found)
}

/// One rule for all that conclude the same.
fn one(rules: Vec<Rule>, norm: SNormKind) -> Result<Rule, &'static str> {
    let Some(first) = rules.first().cloned() else { return Err("they are none") };
    let weight = first.weight;
    let alike = rules.iter().all(|rule| rule.weight.total_cmp(&weight).is_eq());
    // The greatest of weighted strengths is the weighted greatest; no other norm allows that.
    if !alike || (weight < 1.0 && norm != SNormKind::Maximum) {
        return Err("they have weights");
    }
    if rules.iter().flat_map(|rule| &rule.consequents).any(|own| !own.hedges.is_empty()) {
        return Err("their conclusions are hedged");
    }
    let antecedent = Antecedent::Any(rules.into_iter().map(|rule| rule.antecedent).collect());
    if depth(&antecedent) > MAX_DEPTH {
        return Err("their conditions are nested too deeply");
    }
    Ok(Rule { antecedent, ..first })
}
