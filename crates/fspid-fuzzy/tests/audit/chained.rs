//! Rules that ask what other rules have concluded.

use fspid_fuzzy::audit::{RuleEffect, SurfaceAudit, SurfaceOptions, rule_base, surface};
use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::norm::SNormKind;
use fspid_fuzzy::system::{
    Antecedent, Conclusion, Defuzzifier, Parts, Rule, SetReading, Statement, System, Variable,
};

use crate::system::build::{
    answers, block, input, is, output, parts, rule, sets, shape, system, then, triangle,
};

fn concluded(output: usize, term: usize) -> Antecedent {
    let (variable, hedges) = (Variable::Output(output), vec![]);
    Antecedent::Is(Statement { variable, term: Some(term), hedges })
}

fn audited(system: &System) -> SurfaceAudit {
    let options = SurfaceOptions { boxes: 300, ..SurfaceOptions::default() };
    surface(system, &options).expect("universes are known")
}

/// One input whose value is the grade of its set, two outputs of one set each.
fn chain(rules: Vec<Rule>) -> Parts {
    let input = input(0.0, 1.0, vec![shape(ShapeKind::Ramp, &[0.0, 1.0])]);
    let outputs = [[0.0, 2.0, 4.0], [6.0, 8.0, 10.0]]
        .map(|[left, peak, right]| output(0.0, 10.0, sets(vec![triangle(left, peak, right)])));
    parts(vec![input], outputs.into(), vec![block(rules)])
}

/// It used to be called superfluous and idle, because a later rule says the same more strongly; but
/// between the two stands one that asks what has been concluded so far.
#[test]
fn a_rule_whose_conclusion_is_asked_before_a_stronger_one_is_not_superfluous() {
    let weaker = Rule { weight: 0.5, ..rule(is(0, 0), then(0, 0)) };
    let rules = vec![weaker, rule(concluded(0, 0), then(1, 0)), rule(is(0, 0), then(0, 0))];
    let with = system(chain(rules.clone()));
    let without = system(chain(rules[1..].to_vec()));
    assert!(answers(&with, &[0.7])[1].value.is_some());
    assert!(answers(&without, &[0.7])[1].value.is_none());
    assert!(rule_base(&with).redundant.is_empty());
    let idle = audited(&with).rules.into_iter().find(|it| matches!(it, RuleEffect::None { .. }));
    assert_eq!(idle, None);
}

/// The later one used to be called superfluous, though the earlier one is asked too early to fire.
#[test]
fn a_rule_that_asks_an_output_is_not_superfluous_beside_an_earlier_one_that_says_the_same() {
    let ask = || rule(concluded(0, 0), then(1, 0));
    let with = system(chain(vec![ask(), rule(is(0, 0), then(0, 0)), ask()]));
    assert!(answers(&with, &[0.7])[1].value.is_some());
    assert!(rule_base(&with).redundant.is_empty());
    let idle = audited(&with).rules.into_iter().find(|it| matches!(it, RuleEffect::None { .. }));
    assert_eq!(idle, None);
}

/// Such bounds used to end at 1, as if nothing could be concluded more strongly.
#[test]
fn what_is_asked_of_an_output_may_be_above_one_where_conclusions_or_grades_add_up() {
    let sum = Defuzzifier::WeightedSum(SetReading::Tsukamoto);
    let outputs = || [0, 1].map(|_| output(0.0, 1.0, vec![Conclusion::Constant(1.0)]));
    let input = || input(0.0, 1.0, vec![shape(ShapeKind::Ramp, &[0.0, 1.0])]);
    let up = || rule(is(0, 0), then(0, 0));
    let mut added = parts(
        vec![input()],
        outputs().into(),
        vec![block(vec![up(), up(), up(), rule(concluded(0, 0), then(1, 0))])],
    );
    added.outputs.iter_mut().for_each(|output| output.defuzzifier = sum);
    let mut graded = added.clone();
    added.outputs[0].aggregation = SNormKind::UnboundedSum.into();
    let any = Antecedent::Any(vec![is(0, 0), is(0, 0), is(0, 0)]);
    graded.blocks[0].rules[0].antecedent = any;
    graded.blocks[0].or = SNormKind::UnboundedSum.into();
    for parts in [added, graded] {
        let system = system(parts);
        let found = answers(&system, &[1.0])[1].value.expect("rules fire");
        assert!((found - 3.0).abs() < 1e-12, "{found}");
        let proved = &audited(&system).outputs[1];
        assert!(proved.least.bounds[0] <= 0.0 && found <= proved.most.bounds[1], "{proved:?}");
    }
}
