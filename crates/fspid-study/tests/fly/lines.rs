//! What each line does, and what it does not.

use fspid_study::fly::{Angles, Summary};

use super::{pilot, said};

/// What the PID says to these lines, in degrees.
fn pid(input: &str) -> (Vec<String>, String, Summary) {
    let mut pilot = pilot("PID", Angles::Degrees);
    let (answers, told) = said(&mut pilot, input.as_bytes());
    (answers.lines().map(str::to_owned).collect(), told, pilot.summary())
}

#[test]
fn after_a_reset_the_second_flight_is_the_first() {
    let input = "5 0 0.01\n5 0.1 0.01\nreset\n5 0 0.01\n5 0.1 0.01\n";
    let (answers, told, summary) = pid(input);
    assert_eq!(answers[2], "ok");
    assert_eq!(answers[..2], answers[3..]);
    assert_eq!((told.as_str(), summary.resets, summary.commands), ("", 1, 4));
}

#[test]
fn empty_lines_and_comments_are_not_answered_and_counted_as_lines() {
    let (answers, told, _) = pid("# begin\n\n  \r\n5 0 0.01\n#\n5 0.1 x\n");
    assert_eq!(answers.len(), 2);
    assert_eq!(told, "line 6: `x` is not a number; the command was held\n");
}

#[test]
fn a_line_that_cannot_be_used_holds_the_command_and_leaves_no_trace_in_the_flight() {
    let good = ["5 0 0.01", "5 0.1 0.01", "4 0.2 0.01", "4 0.3 0.01"];
    let (smooth, _, _) = pid(&good.join("\n"));
    for bad in
        ["1 2", "rest", "5 nan 0.01", "inf 1 0.01", "5 1e300 0.01", "5 0 0", "5 0 -1", "5 0 nan"]
    {
        let input = [good[0], good[1], bad, good[2], good[3]].join("\n");
        let (answers, told, summary) = pid(&input);
        assert_eq!(answers[2], answers[1], "{bad}");
        assert_eq!([&answers[..2], &answers[3..]].concat(), smooth, "{bad}");
        assert!(told.starts_with("line 3: ") && told.ends_with("; the command was held\n"));
        assert_eq!((summary.held, summary.slips, summary.commands), (1, 0, 5), "{bad}");
    }
}

#[test]
fn before_the_first_good_sample_the_command_is_zero() {
    let (answers, _, _) = pid("x\n5 nan 1\n");
    assert_eq!(answers, ["0.0", "0.0"]);
}

#[test]
fn another_period_is_counted_and_changes_no_command() {
    let (kept, told, _) = pid("5 0 0.01\n5 0.1 0.01\n5 0.2 0.010000000001\n");
    assert_eq!(told, "");
    let (slipped, told, summary) = pid("5 0 7\n5 0.1 0.011\n5 0.2 1e300\n");
    assert_eq!(slipped, kept);
    assert_eq!((summary.slips, summary.held), (2, 0));
    assert_eq!(told.lines().count(), 1, "{told}");
    assert!(told.starts_with("line 2: dt_s is 0.011 and the period 0.01"), "{told}");
}

#[test]
fn the_first_sample_of_a_flight_may_say_that_no_time_has_passed() {
    let (answers, told, summary) = pid("5 0 0\n5 0.1 0.01\nreset\n5 0 0\n");
    assert_eq!((answers[0] == answers[3], told.as_str()), (true, ""));
    assert!(summary.is_clean());
}
