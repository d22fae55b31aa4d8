//! Cases that fly the same are evidence once.

use fspid_tune::contest::Options;

use super::{marked, place};

/// Fourteen copies of a case made a winner of whom nobody was.
#[test]
fn copies_of_a_case_are_refused_however_they_are_written() {
    let copy = "\n[[contest.case]]\nname = \"copy\"\nset = [\"setpoint.amplitude_deg=2.00\"]\n";
    let told = place(&(marked() + copy)).refused(&Options::default());
    let expected = "case \"copy\" flies what case \"2 deg\" flies, and would count twice";
    assert!(told.contains(expected), "{told}");
}
