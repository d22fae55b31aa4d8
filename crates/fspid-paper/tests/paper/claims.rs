//! One test per claim.

use fspid_paper::Status;
use fspid_paper::Status::{Approached, Contradicted, Reproduced};

use crate::paper::paper;

fn status(id: &str) -> Status {
    paper().statuses().find(|(of, _)| *of == id).map(|(_, status)| status).expect("a judged claim")
}

macro_rules! claims {
    ($($name:ident: $id:literal is $status:expr;)*) => {
        /// Every claim that has a test below.
        const TESTED: &[&str] = &[$($id),*];

        $(#[test]
        fn $name() {
            assert_eq!(status($id), $status, "{}", $id);
        })*
    };
}

claims! {
    the_proportional_loop_with_gyro_overshoots_as_printed: "F5.1" is Reproduced;
    the_proportional_loop_with_gyro_misses_its_command_as_printed: "F5.2" is Reproduced;
    the_cpid_of_figure_5_still_misses_3_percent_when_it_is_read: "F5.3" is Reproduced;
    the_fspid_of_figure_5_does_not_overshoot: "F5.4.1" is Reproduced;
    the_fspid_of_figure_5_reaches_its_command: "F5.4.2" is Reproduced;
    without_the_gyro_the_proportional_loop_hardly_damps: "F6.1" is Reproduced;
    the_first_cpid_of_figure_6_overshoots_as_printed: "F6.2.1" is Reproduced;
    the_second_cpid_of_figure_6_overshoots_as_printed: "F6.2.2" is Reproduced;
    no_fspid_of_figure_6_overshoots: "F6.3" is Reproduced;
    the_fspid_of_figure_8a_rises_slowly_at_first: "F8a.1.1" is Reproduced;
    the_fspid_of_figure_8a_rises_fast_later: "F8a.1.2" is Reproduced;
    the_fspid_of_figure_8a_gains_53_percent: "F8a.1.3" is Reproduced;
    the_cpid_of_figure_8a_rises_as_printed_at_first: "F8a.2.1" is Reproduced;
    the_cpid_of_figure_8a_rises_slower_later: "F8a.2.2" is Reproduced;
    the_cpid_of_figure_8a_loses_7_percent: "F8a.2.3" is Reproduced;
    the_fspid_of_figure_8b_overshoots_at_first: "F8b.1.1" is Reproduced;
    the_fspid_of_figure_8b_does_not_overshoot_later: "F8b.1.2" is Reproduced;
    the_fspid_of_figure_8b_rises_as_printed_at_first: "F8b.1.3" is Reproduced;
    the_fspid_of_figure_8b_rises_fast_later: "F8b.1.4" is Reproduced;
    the_cpid_of_figure_8b_overshoots_as_printed_at_first: "F8b.2.1" is Reproduced;
    the_cpid_of_figure_8b_overshoots_less_later: "F8b.2.2" is Reproduced;
    the_cpid_of_figure_8b_rises_as_printed_at_first: "F8b.2.3" is Reproduced;
    the_cpid_of_figure_8b_rises_slower_later: "F8b.2.4" is Reproduced;
    the_fspid_of_figure_9_rises_as_printed_at_first: "F9.1.1" is Reproduced;
    the_fspid_of_figure_9_rises_fast_later: "F9.1.2" is Reproduced;
    the_fspid_of_figure_9_overshoots_as_printed_at_first: "F9.1.4" is Reproduced;
    the_fspid_of_figure_9_does_not_overshoot_later: "F9.1.5" is Reproduced;
    the_fspid_of_figure_8b_gains_48_percent: "F8b.1.5" is Reproduced;
    the_fspid_of_figure_9_gains_40_percent: "F9.1.3" is Reproduced;
    the_controllers_without_gyro_damp_as_claimed: "S1" is Reproduced;
}

/// Claims that are not met, each with our answer and the reason.
macro_rules! misses {
    ($($name:ident: $id:literal is $status:expr;)*) => {
        /// Every claim that has a test below.
        const MISSED: &[&str] = &[$($id),*];

        $(#[test]
        fn $name() {
            assert_eq!(status($id), $status, "{}", $id);
        })*
    };
}

misses! {
    // The paper rounds and divides otherwise; 18 % and a quiet downward step exclude each other.
    the_cpid_of_figure_8b_loses_a_little_more_than_18_percent: "F8b.2.5" is Approached;
    // Equal overshoots at both steps ask for a settled loop, a change of rise time for an unsettled
    // one: no fixed-gain loop answers both as F9.2 has it.
    the_cpid_of_figure_9_rises_a_little_slower_at_first: "F9.2.1" is Approached;
    the_cpid_of_figure_9_hardly_changes_its_rise_time: "F9.2.2" is Contradicted;
    the_cpid_of_figure_9_loses_less_than_printed: "F9.2.3" is Contradicted;
    the_cpid_of_figure_9_overshoots_a_little_more_at_first: "F9.2.4" is Approached;
    the_cpid_of_figure_9_does_not_keep_its_overshoot: "F9.2.5" is Contradicted;
    // Over sizes and places of entry it depends; against a re-tuned CPID it never does.
    a_continuous_disturbance_is_resisted_better_in_most_cases: "F7.1" is Approached;
    an_abrupt_disturbance_is_resisted_worse_in_most_cases: "F7.2" is Contradicted;
    // The nonlinear gains make the loop more sensitive to the elevator's effectiveness, not less.
    a_changed_elevator_costs_the_fspid_more_than_the_cpid: "S2" is Contradicted;
    // In Fig. 5 the CPID's slow tail costs more than the overshoot of the PC.
    the_cpid_is_better_than_the_pc_without_the_gyro_only: "S3" is Approached;
    // Table 3 is odd in the error, rule 1 speaks of its size (erratum E8).
    table_3_does_not_do_what_the_rules_say: "S4" is Contradicted;
}

#[test]
fn every_claim_of_the_program_has_a_test() {
    for (id, _) in paper().statuses() {
        let tested = TESTED.contains(&id) || MISSED.contains(&id);
        assert!(tested, "{id} has no test");
    }
}

#[test]
fn every_claim_of_the_program_stands_in_the_document() {
    let document = include_str!("../../../../docs/paper/claims.md");
    for (id, _) in paper().statuses() {
        assert!(document.contains(&format!("| {id} |")), "docs/paper/claims.md lacks {id}");
    }
}

#[test]
fn no_claim_is_undetermined_and_every_miss_has_a_note() {
    for judged in &paper().claims {
        assert_ne!(judged.status, Status::Undetermined, "{}", judged.claim.id);
        assert!(judged.status == Reproduced || !judged.note.is_empty(), "{}", judged.claim.id);
    }
    for judged in &paper().statements {
        assert_ne!(judged.status, Status::Undetermined, "{}", judged.id);
        assert!(!judged.note.is_empty(), "{}", judged.id);
    }
}

#[test]
fn no_claim_has_fallen_below_its_record() {
    assert_eq!(fspid_paper::fallen(paper()), []);
}
