//! One test per claim.

use fspid_study::reproduce::Status;
use fspid_study::reproduce::Status::{Approached, Contradicted, Reproduced};

use crate::paper;

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
}

#[test]
fn every_claim_of_the_program_has_a_test() {
    for (id, _) in paper().statuses() {
        assert!(TESTED.contains(&id), "{id} has no test");
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
    assert_eq!(fspid_study::reproduce::fallen(paper()), []);
}
