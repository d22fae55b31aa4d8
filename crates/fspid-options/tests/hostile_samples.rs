//! The short lane of the example of that name.

use fspid_options::hostile::{attack, structures};

#[test]
fn no_sample_makes_a_command_that_is_none_or_is_remembered_or_moves_faster_than_allowed() {
    let found = attack(20_261_123, 400_000);
    assert!(found.is_clean(), "{found:?}");
    // Each structure was met, and what is held is neither everything nor nothing.
    assert!(found.controllers >= structures().len() as u64, "{found:?}");
    assert!(10 * found.held > found.samples && 2 * found.held < found.samples, "{found:?}");
}
