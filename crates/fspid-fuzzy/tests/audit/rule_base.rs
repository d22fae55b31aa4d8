//! The facts of the paper's rule base by name, and rule bases that are wrong on purpose.

use fspid_fuzzy::Label;
use fspid_fuzzy::audit::{Direction, LabelAudit, RulePosition, rule_base};
use fspid_fuzzy::system::{Antecedent, Parts, Statement, System, Variable};

use super::{MIRRORED, PRINTED, parts, system};

const KP: usize = 0;
const KI: usize = 1;
const KD: usize = 2;

fn labels(text: &str, output: usize) -> LabelAudit {
    let audit = rule_base(&system(text));
    audit.outputs[output].grid.clone().expect("a grid").labels.expect("terms in order")
}

fn cells(list: &[[Vec<usize>; 2]]) -> Vec<(&'static str, &'static str)> {
    let name = |rank: usize| Label::ALL[rank].name();
    list.iter().map(|[first, _]| (name(first[0]), name(first[1]))).collect()
}

fn printed() -> Parts {
    parts(PRINTED, fspid_fuzzy::Defuzzifier::Exact)
}

fn audited(parts: Parts) -> fspid_fuzzy::audit::RuleBaseAudit {
    rule_base(&System::new(parts).expect("a sound system"))
}

#[test]
fn the_paper_s_rule_base_has_no_hole_contradiction_or_repetition() {
    let audit = rule_base(&system(PRINTED));
    assert_eq!(audit.rules, 49);
    assert!(audit.contradictions.is_empty() && audit.duplicates.is_empty());
    assert!(audit.redundant.is_empty());
    assert_eq!(audit.inputs, [[7; 7], [7; 7]]);
    for output in &audit.outputs {
        let grid = output.grid.as_ref().expect("a grid");
        assert_eq!((grid.cells, grid.holes.len(), grid.ambiguous.len()), (49, 0, 0));
    }
}

#[test]
fn the_paper_s_terms_are_used_as_often_as_counted_by_hand() {
    let audit = rule_base(&system(PRINTED));
    assert_eq!(audit.outputs[KP].uses, [3, 11, 7, 8, 8, 8, 4]);
    assert_eq!(audit.outputs[KI].uses, [6, 4, 9, 11, 8, 5, 6]);
    assert_eq!(audit.outputs[KD].uses, [4, 6, 12, 9, 11, 3, 4]);
}

#[test]
fn the_paper_s_labels_are_odd_but_for_six_pairs_of_dkp_and_one_of_dki() {
    let [kp, ki] = [KP, KI].map(|output| labels(PRINTED, output).odd);
    assert_eq!((kp.pairs, ki.pairs), (24, 24));
    let expected =
        [("NB", "PS"), ("NM", "NM"), ("NM", "ZO"), ("NM", "PB"), ("NS", "NS"), ("NS", "PB")];
    assert_eq!(cells(&kp.violations), expected);
    assert_eq!(cells(&ki.violations), [("ZO", "NM")]);
    assert!(kp.own_images.is_empty() && ki.own_images.is_empty());
}

#[test]
fn eighteen_mirrored_pairs_of_the_paper_s_dkd_are_not_even() {
    let even = labels(PRINTED, KD).even;
    assert_eq!((even.pairs, even.violations.len()), (24, 18));
}

#[test]
fn exchanging_the_paper_s_inputs_changes_two_cells_of_dkp_and_one_of_dki() {
    let broken = |output| labels(PRINTED, output).exchange[0].cells.violations.len();
    assert_eq!((broken(KP), broken(KI)), (2, 1));
}

#[test]
fn the_paper_s_dkp_falls_and_dki_rises_without_exception_in_steps_of_one_label() {
    for (output, direction) in [(KP, Direction::Falling), (KI, Direction::Rising)] {
        for axis in labels(PRINTED, output).along {
            assert_eq!((axis.neighbours, axis.direction), (42, direction));
            assert!(axis.exceptions.is_empty());
            assert_eq!(axis.largest_jump, 1);
        }
    }
}

#[test]
fn the_paper_s_dkd_jumps_by_up_to_four_labels() {
    let along = labels(PRINTED, KD).along;
    assert_eq!((along[0].largest_jump, along[1].largest_jump), (3, 4));
    let large: usize = along.iter().map(|axis| axis.large_jumps.len()).sum();
    assert_eq!(large, 5);
    assert!(along.iter().all(|axis| !axis.exceptions.is_empty()));
}

#[test]
fn the_mirrored_table_answers_opposite_inputs_alike() {
    for output in [KP, KI, KD] {
        let labels = labels(MIRRORED, output);
        assert!(labels.even.holds(), "{output}");
        assert!(!labels.odd.holds(), "{output}");
    }
}

#[test]
fn a_hole_is_found_with_its_cell() {
    let mut parts = printed();
    parts.blocks[0].rules[10].enabled = false;
    let audit = audited(parts);
    assert_eq!(audit.rules, 48);
    assert!(audit.outputs.iter().all(|o| o.grid.as_ref().expect("a grid").holes == [[1, 3]]));
}

#[test]
fn a_contradiction_is_found_whatever_the_order_of_its_statements() {
    let mut parts = printed();
    let mut rule = parts.blocks[0].rules[8].clone();
    if let Antecedent::All(statements) = &mut rule.antecedent {
        statements.reverse();
    }
    rule.consequents[KP].term = 0;
    parts.blocks[0].rules.push(rule);
    let audit = audited(parts);
    let [only] = audit.contradictions.as_slice() else { panic!("{:?}", audit.contradictions) };
    assert_eq!(only.rules.map(|r| r.rule), [8, 49]);
    assert_eq!((only.output, only.terms), (KP, [6, 0]));
    assert_eq!(audit.outputs[KP].grid.as_ref().expect("a grid").ambiguous, [[1, 1]]);
    assert!(audit.duplicates.is_empty());
}

#[test]
fn a_duplicate_is_found_and_superfluous() {
    let mut parts = printed();
    let mut rule = parts.blocks[0].rules[8].clone();
    rule.weight = 0.5;
    parts.blocks[0].rules.push(rule);
    let audit = audited(parts);
    let [only] = audit.duplicates.as_slice() else { panic!("{:?}", audit.duplicates) };
    assert_eq!((only.rules.map(|r| r.rule), only.same_weight), ([8, 49], false));
    let [redundant] = audit.redundant.as_slice() else { panic!("{:?}", audit.redundant) };
    assert_eq!(redundant.rule, RulePosition { block: 0, rule: 49 });
    assert_eq!(redundant.because_of, RulePosition { block: 0, rule: 8 });
}

#[test]
fn a_rule_with_fewer_conditions_makes_the_narrower_one_superfluous() {
    let mut parts = printed();
    let mut rule = parts.blocks[0].rules[8].clone();
    let statement = Statement { variable: Variable::Input(0), term: Some(1), hedges: vec![] };
    rule.antecedent = Antecedent::Is(statement);
    parts.blocks[0].rules.push(rule);
    let audit = audited(parts);
    let found: Vec<_> = audit.redundant.iter().map(|r| (r.rule.rule, r.because_of.rule)).collect();
    assert_eq!(found, [(8, 49)]);
}

#[test]
fn a_term_that_no_rule_uses_counts_zero() {
    let mut parts = printed();
    let mut term = parts.outputs[KI].terms[3].clone();
    term.name = "idle".into();
    parts.outputs[KI].terms.push(term);
    let audit = audited(parts);
    assert_eq!(audit.outputs[KI].uses, [6, 4, 9, 11, 8, 5, 6, 0]);
    // Two terms in one place have no order, and so no label facts; the grid is still there.
    assert_eq!(audit.outputs[KI].grid.as_ref().map(|grid| grid.labels.is_none()), Some(true));
}
