//! The pitch rate, sent or not.

use fspid_study::fly::Angles;

use super::{numbers, pilot, said};

#[test]
fn a_missing_rate_is_estimated_and_told_once_where_it_is_needed() {
    let climb: String =
        (0..200).fold(String::new(), |text, k| text + &format!("0 {} 0.01\n", f64::from(k) * 0.1));
    let with_rate: String = climb.lines().map(|line| format!("{line} 10\n")).collect();
    let answers = |name, input: &str| said(&mut pilot(name, Angles::Degrees), input.as_bytes());
    let (estimated, told) = answers("P", &climb);
    assert_eq!(
        told,
        "line 1: no pitch rate, which this controller needs; a filter of 0.02 s estimates it\n"
    );
    let last = |answers: &str| numbers(answers).pop().expect("200 of them");
    let (measured, told) = answers("P", &with_rate);
    assert_eq!(told, "");
    assert!((last(&estimated) - last(&measured)).abs() < 1e-9);
    assert_eq!(answers("PID", &climb), answers("PID", &with_rate));
}

#[test]
fn a_rate_that_is_missing_for_a_while_goes_on_from_the_last_measured_one() {
    let mut pilot = pilot("P", Angles::Degrees);
    let (answers, _) = said(&mut pilot, b"0 1 0.01 10\n0 1.1 0.01 10\n0 1.2 0.01\n0 1.2 0.01 10\n");
    let commands = numbers(&answers);
    assert!((commands[2] - commands[3]).abs() < 1e-12, "{answers}");
}
