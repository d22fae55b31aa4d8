//! The rules as written.

mod antecedent;
mod grid;
mod labels;
mod order;

use alloc::vec;
use alloc::vec::Vec;

use crate::hedge::Hedge;
use crate::norm::SNormKind;
use crate::system::{
    Activation, Antecedent, Consequent, Defuzzifier, Rule, RuleBlock, Statement, System, TNorm,
    Variable,
};
pub(super) use antecedent::canonical;
use antecedent::implied_by;

pub use grid::GridAudit;
pub use labels::{AxisAudit, Direction, Exchange, LabelAudit, Neighbours, PairAudit};

/// Where a rule stands in the parts of its system.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct RulePosition {
    /// Position of the block.
    pub block: usize,
    /// Position of the rule in its block.
    pub rule: usize,
}

/// What is true of the rules as written. Rules and blocks that are switched off are left out.
#[derive(Clone, Debug, PartialEq)]
pub struct RuleBaseAudit {
    /// Rules that are switched on.
    pub rules: usize,
    /// Pairs of rules that conclude different terms of an output from the same antecedent.
    pub contradictions: Vec<Contradiction>,
    /// Pairs of rules with the same antecedent and the same conclusions.
    pub duplicates: Vec<Duplicate>,
    /// Rules without which no answer would change, because another rule always says the same at
    /// least as strongly.
    pub redundant: Vec<Redundant>,
    /// For each input, how many rules ask for each of its terms.
    pub inputs: Vec<Vec<usize>>,
    /// One for each output.
    pub outputs: Vec<OutputRules>,
}

/// The rules about one output.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputRules {
    /// How many rules conclude each term.
    pub uses: Vec<usize>,
    /// The rules as a grid over the terms of the inputs; `None` if some rule is not a plain
    /// conjunction of terms.
    pub grid: Option<GridAudit>,
}

/// Two rules that conclude different terms of one output from the same antecedent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Contradiction {
    /// The two rules.
    pub rules: [RulePosition; 2],
    /// Position of the output.
    pub output: usize,
    /// Positions of the two terms.
    pub terms: [usize; 2],
}

/// Two rules with the same antecedent and the same conclusions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Duplicate {
    /// The two rules.
    pub rules: [RulePosition; 2],
    /// Whether their weights are the same too.
    pub same_weight: bool,
}

/// A rule that another rule makes superfluous: its conclusions are among the other's, and
/// $T(a, b) \le a$ for every t-norm, so that it is never the stronger one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Redundant {
    /// The superfluous rule.
    pub rule: RulePosition,
    /// The rule that says the same at least as strongly.
    pub because_of: RulePosition,
}

/// A rule that is switched on, with its antecedent in a form that can be compared.
pub(super) struct ActiveRule<'a> {
    pub(super) position: RulePosition,
    pub(super) block: &'a RuleBlock,
    pub(super) rule: &'a Rule,
    pub(super) antecedent: Antecedent,
}

/// The rules that are switched on.
pub(super) fn active_rules(system: &System) -> Vec<ActiveRule<'_>> {
    let blocks = system.parts().blocks.iter().enumerate().filter(|(_, block)| block.enabled);
    let rules = blocks.flat_map(|(index, block)| {
        let rules = block.rules.iter().enumerate().filter(|(_, rule)| rule.enabled);
        rules.map(move |(rule_index, rule)| ActiveRule {
            position: RulePosition { block: index, rule: rule_index },
            block,
            rule,
            antecedent: canonical(&rule.antecedent, block),
        })
    });
    rules.collect()
}

/// What is true of the rules of a system as they are written.
#[must_use]
pub fn rule_base(system: &System) -> RuleBaseAudit {
    let rules = active_rules(system);
    let parts = system.parts();
    let inputs = (0..parts.inputs.len()).map(|input| input_uses(system, &rules, input));
    let outputs = (0..parts.outputs.len()).map(|output| OutputRules {
        uses: output_uses(system, &rules, output),
        grid: grid::audit(system, &rules, output),
    });
    let (inputs, outputs) = (inputs.collect(), outputs.collect());
    let mut audit = RuleBaseAudit {
        rules: rules.len(),
        contradictions: Vec::new(),
        duplicates: Vec::new(),
        redundant: Vec::new(),
        inputs,
        outputs,
    };
    for (index, later) in rules.iter().enumerate() {
        for earlier in rules.get(..index).unwrap_or_default() {
            audit.compare(system, earlier, later);
        }
    }
    audit
}

impl RuleBaseAudit {
    fn compare(&mut self, system: &System, earlier: &ActiveRule<'_>, later: &ActiveRule<'_>) {
        let rules = [earlier.position, later.position];
        if earlier.antecedent == later.antecedent {
            let same_weight = earlier.rule.weight.total_cmp(&later.rule.weight).is_eq();
            if same_conclusions(earlier.rule, later.rule) {
                self.duplicates.push(Duplicate { rules, same_weight });
            }
            let contradictions = contradictions(earlier.rule, later.rule);
            self.contradictions.extend(
                contradictions.into_iter().map(|(output, terms)| Contradiction {
                    rules,
                    output,
                    terms,
                }),
            );
        }
        // Of two that make each other superfluous, the later one is.
        for (rule, other) in [(later, earlier), (earlier, later)] {
            let known = self.redundant.iter().any(|r| {
                r.rule == rule.position
                    || (r.rule == other.position && r.because_of == rule.position)
            });
            if !known && makes_superfluous(system, other, rule) {
                let (rule, because_of) = (rule.position, other.position);
                self.redundant.push(Redundant { rule, because_of });
            }
        }
    }
}

fn same_conclusions(left: &Rule, right: &Rule) -> bool {
    concludes_all(left, right) && concludes_all(right, left)
}

/// True if `rule` concludes everything that `other` concludes.
fn concludes_all(rule: &Rule, other: &Rule) -> bool {
    other.consequents.iter().all(|consequent| rule.consequents.contains(consequent))
}

/// Outputs about which the two rules conclude different terms.
fn contradictions(earlier: &Rule, later: &Rule) -> Vec<(usize, [usize; 2])> {
    let concludes = |rule: &Rule, found: &Consequent| {
        rule.consequents.iter().any(|c| c.output == found.output && c.term == found.term)
    };
    let mut found = Vec::new();
    for first in &earlier.consequents {
        for second in later.consequents.iter().filter(|second| second.output == first.output) {
            let agree = concludes(later, first) || concludes(earlier, second);
            if first.term != second.term && !agree {
                found.push((first.output, [first.term, second.term]));
            }
        }
    }
    found
}

/// True if what a rule concludes rises with the strength of its antecedent, and that with the grades of its statements: a
/// formula may fall, and `not` makes much of little.
fn rises_with_strength(rule: &ActiveRule<'_>) -> bool {
    let falls = |it: &Consequent| it.hedges.contains(&Hedge::Not);
    matches!(rule.block.and, TNorm::Kind(_))
        && matches!(rule.block.implication, TNorm::Kind(_))
        && !rule.rule.consequents.iter().any(falls)
}

/// True if rules further down may notice a rule, or it notices those between: some rule asks how strongly
/// one of its conclusions has been drawn so far, or it asks that of an output itself.
fn takes_part_in_a_chain(system: &System, rule: &Rule) -> bool {
    rule.antecedent.asks_outputs()
        || rule.consequents.iter().any(|it| is_asked(system, it.output, it.term))
}

/// True if some rule asks how strongly a term of an output has been concluded.
pub(super) fn is_asked(system: &System, output: usize, term: usize) -> bool {
    let asked = |it: &Statement| it.variable == Variable::Output(output) && it.term == Some(term);
    system.program.statements.iter().any(asked)
}

/// True if `rule` changes no answer as long as `other` is there.
fn makes_superfluous(system: &System, other: &ActiveRule<'_>, rule: &ActiveRule<'_>) -> bool {
    // With an s-norm that adds up, in an average, or where rules compete, every rule counts.
    let keeps_strongest = |consequent: &Consequent| {
        system.parts().outputs.get(consequent.output).is_some_and(|output| {
            let averages = matches!(
                output.defuzzifier,
                Defuzzifier::WeightedAverage(_) | Defuzzifier::WeightedSum(_)
            );
            output.aggregation.is(SNormKind::Maximum) && !averages
        })
    };
    let plain = rule.block.activation == Activation::General
        && other.block.activation == Activation::General
        && rule.block.implication == other.block.implication
        && rule.block.and == other.block.and
        && rule.rule.consequents.iter().all(keeps_strongest)
        && rises_with_strength(rule)
        && !takes_part_in_a_chain(system, rule.rule);
    plain
        && rule.rule.weight <= other.rule.weight
        && concludes_all(other.rule, rule.rule)
        && implied_by(&other.antecedent, &rule.antecedent)
}

/// How many rules ask for each term of an input.
fn input_uses(system: &System, rules: &[ActiveRule<'_>], input: usize) -> Vec<usize> {
    let terms = system.parts().inputs.get(input).map_or(0, |i| i.terms.len());
    let mut uses = vec![0; terms];
    for rule in rules {
        for (term, count) in uses.iter_mut().enumerate() {
            *count += usize::from(asks_for(&rule.rule.antecedent, input, term));
        }
    }
    uses
}

fn asks_for(antecedent: &Antecedent, input: usize, term: usize) -> bool {
    match antecedent {
        Antecedent::Always => false,
        Antecedent::Is(statement) => {
            statement.variable == Variable::Input(input) && statement.term == Some(term)
        }
        Antecedent::All(parts) | Antecedent::Any(parts) => {
            parts.iter().any(|part| asks_for(part, input, term))
        }
        Antecedent::Not(part) => asks_for(part, input, term),
    }
}

/// How many rules conclude each term of an output.
fn output_uses(system: &System, rules: &[ActiveRule<'_>], output: usize) -> Vec<usize> {
    let terms = system.parts().outputs.get(output).map_or(0, |o| o.terms.len());
    let mut uses = vec![0; terms];
    for consequent in rules.iter().flat_map(|rule| &rule.rule.consequents) {
        if let Some(count) = uses.get_mut(consequent.term).filter(|_| consequent.output == output) {
            *count += 1;
        }
    }
    uses
}
