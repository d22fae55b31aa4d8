//! What is said about files that cannot be read: every problem at once, each with its place.

use fspid_formats::fis;

const PAPER: &str = include_str!("data/fis/paper.fis");
const BROKEN: &str = include_str!("data/fis/broken.fis");

fn problems(text: &str) -> String {
    fis::read(text).expect_err("a file that is wrong").to_string()
}

/// What is said about the paper's controller with a change.
fn about(from: &str, to: &str) -> String {
    assert!(PAPER.contains(from), "{from}");
    problems(&PAPER.replacen(from, to, 1))
}

#[test]
fn every_problem_of_a_broken_file_is_told_with_its_place() {
    let expected = include_str!("data/fis/broken.txt");
    let found = problems(BROKEN);
    assert_eq!(found.trim(), expected.trim());
}

#[test]
fn an_empty_text_says_what_is_missing() {
    assert_eq!(
        problems(""),
        "there is no section `[System]`\n\
         there is no input; at least one is needed\n\
         there is no output; at least one is needed\n\
         there is no section `[Rules]`"
    );
}

#[test]
fn functions_of_one_s_own_are_refused_by_name_and_never_run() {
    assert_eq!(
        about("AndMethod='min'", "AndMethod='system(\"rm\")'"),
        "8:11: `system(\"rm\")`: unknown method; functions of one's own are never run; expected one of \
         `min`, `prod`, `algebraic_product`, `bounded_difference`, `drastic_product`, \
         `einstein_product`, `hamacher_product`, `nilpotent_minimum`"
    );
    let message = about("'NB':'gaussmf'", "'NB':'guassmf'");
    assert!(message.starts_with(
        "18:10: `guassmf`: unknown membership function; functions of one's own are never run"
    ));
    assert!(message.contains("did you mean `gaussmf`?"), "{message}");
    let message = about("'NB':'gaussmf',[0.7077681669066825 -5]", "'NB':'function',x^2");
    assert!(
        message.starts_with("18:10: `function`: a formula in a file is never run"),
        "{message}"
    );
}

#[test]
fn the_number_that_is_wrong_is_the_one_that_is_named() {
    let gaussian = "[0.7077681669066825 -5]";
    assert_eq!(
        about(gaussian, "[0 -5]"),
        "18:21: `0`: `gaussmf` [sigma centre]: sigma is 0.0; allowed is a finite number above 0"
    );
    assert_eq!(
        about(gaussian, "[1 x]"),
        "18:23: `x`: not a number; expected a number such as `1`, `-.5` or `1e-3`"
    );
    assert_eq!(
        about(gaussian, "[1 nan]"),
        "18:23: `nan`: NaN is not allowed here; expected a number"
    );
    assert_eq!(
        about(gaussian, "[1 1e999]"),
        "18:23: `1e999`: a number beyond the largest double, 1.797e308; expected a smaller number"
    );
}

#[test]
fn a_wrong_number_of_parameters_says_which_are_needed() {
    assert_eq!(
        about("[0.7077681669066825 -5]", "[1 2 3]"),
        "18:10: `gaussmf`: has 3 parameters; expected [sigma centre]"
    );
}

#[test]
fn a_rule_with_an_index_too_high_says_how_many_there_are() {
    assert_eq!(
        about("7 7, ", "7 8, "),
        "123:3: `8`: `ec` has 7 membership functions; expected at most 7"
    );
}

#[test]
fn unknown_keys_and_sections_are_refused_with_the_known_ones() {
    assert!(
        about("OrMethod=", "OrMethode=").contains("9:1: `OrMethode`: unknown key; expected one of")
    );
    assert!(about("OrMethod=", "OrMethode=").contains("did you mean `OrMethod`?"));
    assert_eq!(
        about("[Rules]", "[Rulez]").lines().next().unwrap_or_default(),
        "there is no section `[Rules]`"
    );
}

#[test]
fn a_section_or_a_key_that_stands_twice_is_refused() {
    let twice = format!("{PAPER}[System]\n");
    assert!(problems(&twice).contains("`[System]`: stands here again; the first is in line 1"));
    let message = about("OrMethod='max'", "AndMethod='max'");
    assert!(message.contains("9:1: `AndMethod`: stands here again; the first is in line 8"));
}

#[test]
fn a_defuzzifier_that_does_not_go_with_the_type_is_refused() {
    assert_eq!(
        about("'centroid'", "'wtaver'"),
        "12:14: `wtaver`: does not go with `Type`; expected `centroid`, `bisector`, `mom`, `lom` or `som`"
    );
}

#[test]
fn a_left_out_variable_is_told() {
    let message = about("[Input2]", "[Input3]");
    assert_eq!(message, "26:1: `input 3`: input 2 is left out");
}
