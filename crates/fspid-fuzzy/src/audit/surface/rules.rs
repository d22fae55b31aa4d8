//! What single rules and terms do.

use alloc::vec::Vec;

use super::continuity::{Jumps, jumps_of};
use super::field::Field;
use super::firing::{Firing, Slope, has_two_grades, has_value, unknown_slope};
use super::options::SurfaceOptions;
use crate::audit::rule_base::{RulePosition, is_asked, rule_base};
use crate::audit::search::{Effort, Extreme, Objective, maximum};
use crate::hedge::Hedge;
use crate::norm::SNormKind;
use crate::system::{Activation, Defuzzifier, System, TNorm};
use fspid_numeric::scalar::{Interval, Scalar};

/// Boxes for each rule and term; a point is mostly found at once.
const BOXES: u64 = 2_000;
/// A lead or grade is searched to this.
const TOLERANCE: f64 = 1e-6;

/// How far a term of an input is reached.
#[derive(Clone, Debug, PartialEq)]
pub struct TermReach {
    /// The highest grade over the domain; a term whose upper bound is 0 is never reached.
    pub highest: Extreme,
}

/// What a rule does to the surfaces.
#[derive(Clone, Debug, PartialEq)]
pub enum RuleEffect {
    /// Nothing: it never is the strongest rule for any of its conclusions. Without it the surfaces
    /// are the same.
    None {
        /// The rule.
        rule: RulePosition,
    },
    /// It is the only strongest rule for one of its conclusions.
    Leads {
        /// The rule.
        rule: RulePosition,
        /// Where.
        at: Vec<f64>,
        /// By how much at least.
        lead: f64,
        /// Change of each output there if the rule is left out; `None` where there is no answer.
        changes: Vec<Option<f64>>,
    },
    /// Neither was proved; of other rules than superfluous ones it never is where inputs have type-2 sets.
    Open {
        /// The rule.
        rule: RulePosition,
    },
}

/// How far each term of each input is reached.
pub(super) fn reaches(
    field: &mut Field<'_>,
    domain: &[Interval],
    options: &SurfaceOptions,
) -> Vec<Vec<TermReach>> {
    let inputs = field.firing.system.parts.inputs.iter().enumerate();
    let effort = Effort { tolerance: TOLERANCE, boxes: BOXES.min(options.boxes) };
    let all = inputs.map(|(input, part)| {
        let terms = 0..part.terms.len();
        let each = terms.map(|term| {
            let mut grade = Grade { firing: &mut field.firing, input, term };
            let highest = maximum(&mut grade, domain, effort);
            field.boxes += highest.boxes;
            TermReach { highest }
        });
        each.collect()
    });
    all.collect()
}

/// Grade of a term.
struct Grade<'f, 'a> {
    firing: &'f mut Firing<'a>,
    input: usize,
    term: usize,
}

impl Objective for Grade<'_, '_> {
    fn enclose(&mut self, cell: &[Interval], slopes: Option<&mut [Interval]>) -> Interval {
        let mut value = self.firing.term_grade(self.input, self.term, cell, None);
        for (input, place) in slopes.into_iter().flatten().enumerate() {
            value = self.firing.term_grade(self.input, self.term, cell, Some(input));
            [*place] = value.derivative;
        }
        value.value
    }
}

/// What each rule that is switched on does.
pub(super) fn effects(
    field: &mut Field<'_>,
    domain: &[Interval],
    options: &SurfaceOptions,
) -> Vec<RuleEffect> {
    let effort = Effort { tolerance: TOLERANCE, boxes: BOXES.min(options.boxes) };
    let system = field.firing.system;
    let redundant = rule_base(system).redundant;
    let each = system.rules.iter().enumerate().map(|(rule, resolved)| {
        let position = RulePosition { block: resolved.block, rule: resolved.rule };
        if stands_alone(system, rule) && redundant.iter().any(|known| known.rule == position) {
            return RuleEffect::None { rule: position };
        }
        effect(field, rule, position, domain, effort)
    });
    each.collect()
}

fn effect(
    field: &mut Field<'_>,
    rule: usize,
    position: RulePosition,
    domain: &[Interval],
    effort: Effort,
) -> RuleEffect {
    let system = field.firing.system;
    if has_two_grades(system) {
        return RuleEffect::Open { rule: position };
    }
    let mut all_none = stands_alone(system, rule);
    for rivals in rivals(system, rule) {
        let mut lead = Lead { firing: &mut field.firing, rule, rivals: &rivals };
        let found = best_lead(&mut lead, domain, effort);
        field.boxes += found.boxes;
        if found.bounds[0] > 0.0 {
            let changes = changes(system, position, &found.at);
            return RuleEffect::Leads {
                rule: position,
                at: found.at,
                lead: found.bounds[0],
                changes,
            };
        }
        all_none &= found.bounds[1] <= 0.0;
    }
    if all_none { RuleEffect::None { rule: position } } else { RuleEffect::Open { rule: position } }
}

/// True if leaving a rule out does not change how strongly the others act: not where strengths are
/// divided by their sum, rules are counted or ranked, or others ask what it concludes.
fn stands_alone(system: &System, rule: usize) -> bool {
    let block = system.rules.get(rule).and_then(|rule| system.parts.blocks.get(rule.block));
    let mut own = system.conclusions.iter().filter(|conclusion| conclusion.rule == rule);
    block.is_some_and(|block| block.activation == Activation::General)
        && !own.any(|it| is_asked(system, it.output, it.term))
}

/// A search that is content with a point where the lead is nearly as large as it gets.
fn best_lead(lead: &mut Lead<'_, '_>, domain: &[Interval], effort: Effort) -> Extreme {
    let rough = maximum(lead, domain, Effort { tolerance: 0.1, boxes: effort.boxes.min(300) });
    if rough.bounds[0] > 0.0 { rough } else { maximum(lead, domain, effort) }
}

/// For each conclusion of a rule, the other rules that conclude the same; none where every rule
/// counts.
fn rivals(system: &System, rule: usize) -> Vec<Vec<usize>> {
    let all = system.conclusions.iter();
    let own: Vec<_> = all.filter(|conclusion| conclusion.rule == rule).collect();
    let lists = own.iter().map(|own| {
        let output = system.parts.outputs.get(own.output);
        let strongest_counts = output.is_some_and(|output| {
            let sums = matches!(
                output.defuzzifier,
                Defuzzifier::WeightedAverage(_) | Defuzzifier::WeightedSum(_)
            );
            output.aggregation.is(SNormKind::Maximum) && !sums
        });
        // A formula may fall with the strength, and `not` makes much of little.
        let own_block = system.parts.blocks.get(own.block);
        let rises = !own.hedges.contains(&Hedge::Not)
            && own_block.is_some_and(|it| matches!(it.implication, TNorm::Kind(_)));
        let block = |rule: usize| {
            let block = system.rules.get(rule)?.block;
            system.parts.blocks.get(block).map(|block| &block.implication)
        };
        let same = system.conclusions.iter().filter(|other| {
            other.rule != rule
                && (other.output, other.term) == (own.output, own.term)
                && other.hedges == own.hedges
                && block(other.rule) == block(rule)
        });
        if strongest_counts && rises { same.map(|other| other.rule).collect() } else { Vec::new() }
    });
    lists.collect()
}

/// By how much a rule is stronger than all its rivals.
struct Lead<'f, 'a> {
    firing: &'f mut Firing<'a>,
    rule: usize,
    rivals: &'f [usize],
}

impl Objective for Lead<'_, '_> {
    fn enclose(&mut self, cell: &[Interval], slopes: Option<&mut [Interval]>) -> Interval {
        let mut lead = self.lead(cell, None);
        for (input, place) in slopes.into_iter().flatten().enumerate() {
            lead = self.lead(cell, Some(input));
            [*place] = lead.derivative;
        }
        lead.value
    }
}

impl Lead<'_, '_> {
    fn lead(&mut self, cell: &[Interval], along: Option<usize>) -> Slope {
        self.firing.fire(cell, along);
        let strength = |rule: usize| self.firing.acting.get(rule).copied().unwrap_or(Slope::zero());
        let rivals = self.rivals.iter().map(|&rival| strength(rival));
        let lead = strength(self.rule) - rivals.fold(Slope::zero(), Scalar::larger);
        let beaten = self.rivals.iter().any(|&r| self.firing.never_stronger(self.rule, r));
        // A rival that is never weaker is proved so even where the two are always equal.
        if beaten && lead.value.upper() > 0.0 {
            let value = lead.value.smaller(Interval::ZERO);
            return Slope { value, derivative: [Interval::ENTIRE] };
        }
        lead
    }
}

/// Change of each output at a point if a rule is left out.
fn changes(system: &System, position: RulePosition, at: &[f64]) -> Vec<Option<f64>> {
    let answers = |system: &System| -> Vec<Option<f64>> {
        let mut workspace = system.workspace();
        let answers = system.evaluate(at, &mut workspace);
        answers.map_or(Vec::new(), |answers| answers.iter().map(|a| a.value).collect())
    };
    let mut parts = system.parts.clone();
    let block = parts.blocks.get_mut(position.block);
    if let Some(rule) = block.and_then(|block| block.rules.get_mut(position.rule)) {
        rule.enabled = false;
    }
    let Ok(without) = System::new(parts) else { return Vec::new() };
    let (with, without) = (answers(system), answers(&without));
    with.iter().zip(&without).map(|(with, without)| Some((*without)? - (*with)?)).collect()
}

impl Firing<'_> {
    /// Grade of a term over a box.
    fn term_grade(
        &mut self,
        input: usize,
        term: usize,
        cell: &[Interval],
        along: Option<usize>,
    ) -> Slope {
        self.take_inputs(cell, along);
        let system = self.system;
        let membership = system
            .parts
            .inputs
            .get(input)
            .and_then(|part| part.terms.get(term))
            .map(|term| &term.membership);
        let x = self.inputs.get(input).copied().unwrap_or(Slope::zero());
        let Some(membership) = membership else { return Slope::zero() };
        let grade = self.grade_in(membership, x);
        let smooth = match jumps_of(membership) {
            Jumps::At(places) => places.is_empty(),
            Jumps::Anywhere => false,
        };
        match smooth && has_value(membership, input, &self.inputs) {
            true => grade,
            false => unknown_slope(grade.value),
        }
    }
}
