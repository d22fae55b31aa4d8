//! How strongly the rules fire at least.

use alloc::collections::BTreeSet;
use alloc::vec;
use alloc::vec::Vec;

use super::field::Field;
use super::firing::has_two_grades;
use super::objective::{Coverage as Strongest, StrongestGrade};
use super::options::SurfaceOptions;
use crate::audit::Statement;
use crate::audit::search::{Effort, Extreme, middle, minimum};
use crate::system::{Activation, Membership, Step, System, TNorm, Variable};
use fspid_numeric::scalar::Interval;

/// Where the question falls apart into one for each input, this is cheap to ask for.
const TOLERANCE: f64 = 1e-9;

/// How strongly the strongest rule about an output fires at least.
#[derive(Clone, Debug, PartialEq)]
pub struct Coverage {
    /// The smallest strength of the strongest rule.
    pub least: Extreme,
    /// Whether some rule fires everywhere; refuted by a point where none does. Open where inputs have
    /// type-2 sets.
    pub statement: Statement<Vec<f64>>,
}

pub(super) fn of_output(
    field: &mut Field<'_>,
    output: usize,
    domain: &[Interval],
    options: &SurfaceOptions,
) -> Coverage {
    let system = field.firing.system;
    if has_two_grades(system) {
        let bounds = [0.0, f64::INFINITY];
        let least = Extreme { bounds, at: middle(domain), boxes: 0, settled: false };
        return Coverage { least, statement: Statement::Open };
    }
    let conclusions = system.conclusions.iter().filter(|c| c.output == output);
    let mut rules: Vec<usize> = conclusions.map(|conclusion| conclusion.rule).collect();
    rules.dedup();
    let least = match complete_grid(system, &rules) {
        Some(statements) => by_input(field, &rules, &statements, domain, options),
        None => {
            let effort = Effort { tolerance: options.slope_tolerance, boxes: options.boxes };
            minimum(&mut Strongest { field, rules: &rules }, domain, effort)
        }
    };
    field.boxes += least.boxes;
    let [low, high] = least.bounds;
    let statement = if low > 0.0 {
        Statement::Proved
    } else if high <= 0.0 {
        Statement::Refuted(least.at.clone())
    } else {
        Statement::Open
    };
    Coverage { least, statement }
}

/// For each input the statements about it, if the rules join every combination of one statement
/// about each. No t-norm $T$ falls with its arguments, so that then
///
/// $$ \min_x \max_r T(\mu_{r1}(x_1), \dots) = T(\min_{x_1} \max_k \mu_k(x_1), \dots) $$
fn complete_grid(system: &System, rules: &[usize]) -> Option<Vec<BTreeSet<usize>>> {
    let mut statements = vec![BTreeSet::new(); system.parts.inputs.len()];
    let mut combinations = BTreeSet::new();
    let first = system.rules.get(*rules.first()?)?.block;
    for rule in rules.iter().map(|&rule| system.rules.get(rule)) {
        let rule = rule?;
        let block = system.parts.blocks.get(rule.block)?;
        let plain = rule.block == first && block.activation == Activation::General;
        // A formula may fall with its arguments.
        if !plain || rule.weight < 1.0 || !matches!(block.and, TNorm::Kind(_)) {
            return None;
        }
        let mut combination = vec![None; statements.len()];
        for step in system.program.steps.get(rule.steps.clone())? {
            match *step {
                Step::And => {}
                Step::Statement(index) => {
                    let statement = system.program.statements.get(index)?;
                    let Variable::Input(input) = statement.variable else { return None };
                    if depends_on_others(system, statement) {
                        return None;
                    }
                    if combination.get_mut(input)?.replace(index).is_some() {
                        return None;
                    }
                    statements.get_mut(input)?.insert(index);
                }
                _ => return None,
            }
        }
        combinations.insert(combination.into_iter().collect::<Option<Vec<usize>>>()?);
    }
    let cells = statements.iter().try_fold(1_usize, |n, own| n.checked_mul(own.len()))?;
    (combinations.len() == cells).then_some(statements)
}

/// True if a grade may depend on other inputs than its own.
fn depends_on_others(system: &System, statement: &crate::system::Statement) -> bool {
    let Variable::Input(input) = statement.variable else { return true };
    let term = statement.term.and_then(|term| system.parts.inputs.get(input)?.terms.get(term));
    match term.map(|term| &term.membership) {
        Some(Membership::Formula { formula, .. }) => {
            (0..system.parts.inputs.len()).any(|other| formula.uses(other + 1))
        }
        Some(Membership::Shape { .. }) | None => false,
    }
}

fn by_input(
    field: &mut Field<'_>,
    rules: &[usize],
    statements: &[BTreeSet<usize>],
    domain: &[Interval],
    options: &SurfaceOptions,
) -> Extreme {
    let effort = Effort { tolerance: TOLERANCE, boxes: options.boxes };
    let system = field.firing.system;
    let block = rules.first().and_then(|&rule| system.rules.get(rule)).map(|rule| rule.block);
    let and = block.and_then(|block| system.parts.blocks.get(block)).map(|block| &block.and);
    let mut whole = Extreme { bounds: [1.0; 2], at: Vec::new(), boxes: 0, settled: true };
    for (input, own) in statements.iter().enumerate() {
        // The other inputs do not matter; they are held anywhere.
        let mut line: Vec<Interval> = middle(domain).into_iter().map(Interval::point).collect();
        if let (Some(place), Some(side)) = (line.get_mut(input), domain.get(input)) {
            *place = *side;
        }
        let found = minimum(&mut StrongestGrade { field, statements: own }, &line, effort);
        let joined = [0, 1].map(|end: usize| {
            let [own, before] = [&found.bounds, &whole.bounds];
            let (own, before) = (own.get(end).copied(), before.get(end).copied());
            let point = |bound: Option<f64>| Interval::point(bound.unwrap_or(0.0));
            let joined = and.map(|and| and.apply(point(before), point(own)));
            joined.unwrap_or(Interval::UNIT)
        });
        let [low, high] = joined;
        whole.bounds = [low.lower().max(0.0), high.upper().min(1.0)];
        whole.at.push(found.at.get(input).copied().unwrap_or(0.0));
        whole.boxes += found.boxes;
        whole.settled &= found.settled;
    }
    whole
}
