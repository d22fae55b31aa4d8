//! Interval type-2 systems: what is not followed is left open.

use fspid_fuzzy::audit::{RuleEffect, Statement, SurfaceAudit, SurfaceOptions, surface};
use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::system::{Antecedent, Membership, Rule, System};

use crate::system::build::{block, input, is, output, parts, rule, sets, system, then, triangle};

/// The same grade everywhere.
fn level(height: f64) -> Membership {
    Membership::Shape { kind: ShapeKind::Rectangle, params: vec![-1.0, 11.0], height }
}

/// One input with sets of these lower and upper grades, one output with two sets.
fn levels(grades: &[[f64; 2]], rules: Vec<Rule>) -> System {
    let mut input = input(0.0, 10.0, grades.iter().map(|[_, upper]| level(*upper)).collect());
    for (term, [lower, _]) in input.terms.iter_mut().zip(grades) {
        term.lower = Some(level(*lower));
    }
    let sets = sets(vec![triangle(0.0, 2.0, 4.0), triangle(6.0, 8.0, 10.0)]);
    system(parts(vec![input], vec![output(0.0, 10.0, sets)], vec![block(rules)]))
}

fn audited(system: &System) -> SurfaceAudit {
    let options = SurfaceOptions { boxes: 300, ..SurfaceOptions::default() };
    surface(system, &options).expect("universes are known")
}

fn interval(system: &System) -> [f64; 2] {
    let mut workspace = system.workspace();
    system.evaluate(&[5.0], &mut workspace).expect("finite");
    workspace.interval(0).expect("rules fire")
}

/// It used to be said to change nothing, because another is always stronger by the upper grades.
#[test]
fn a_rule_that_leads_by_its_lower_grade_alone_is_not_said_to_be_idle() {
    let grades = [[0.1, 1.0], [0.7, 0.8], [0.5, 0.5]];
    let rules =
        vec![rule(is(0, 0), then(0, 0)), rule(is(0, 1), then(0, 0)), rule(is(0, 2), then(0, 1))];
    let [with, without] =
        [rules.clone(), vec![rules[0].clone(), rules[2].clone()]].map(|it| levels(&grades, it));
    let audit = audited(&with);
    assert!(
        audit.rules.iter().all(|it| matches!(it, RuleEffect::Open { .. })),
        "{:?}",
        audit.rules
    );
    let [[_, with], [_, without]] = [with, without].map(|it| interval(&it));
    assert!((with - without).abs() > 0.1, "{with} {without}");
}

/// No rule used to be said to fire, because one minus the upper grade is 0.
#[test]
fn whether_rules_fire_everywhere_is_open_where_grades_are_intervals() {
    let negated = Antecedent::Not(Box::new(is(0, 0)));
    let system = levels(&[[0.3, 1.0]], vec![rule(negated, then(0, 0))]);
    assert!(interval(&system)[0] > 0.0);
    let coverage = &audited(&system).outputs[0].coverage;
    assert_eq!(coverage.statement, Statement::Open);
    assert!(coverage.least.bounds[0] <= 0.0 && coverage.least.bounds[1] >= 0.7);
}
