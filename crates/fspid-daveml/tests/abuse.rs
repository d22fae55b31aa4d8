//! Texts that are out to do harm, and texts that mean nothing.
#![allow(clippy::unwrap_used, reason = "a test")]

use proptest::prelude::*;

const TOY: &str = include_str!("data/toy.dml");

fn sentences(text: &str) -> String {
    fspid_daveml::read(text).expect_err("the text is no model").to_string()
}

#[test]
fn a_text_that_is_too_long_is_not_even_looked_at() {
    let long = " ".repeat(fspid_daveml::MAX_INPUT_BYTES + 1);
    assert_eq!(sentences(&long), "10485761 bytes; expected at most 10485760 bytes");
}

#[test]
fn entities_that_grow_are_refused_before_they_grow() {
    let mut text = String::from("<!DOCTYPE DAVEfunc [<!ENTITY a0 \"ha\">");
    for level in 1..30 {
        let inside = format!("&a{};", level - 1).repeat(10);
        text += &format!("<!ENTITY a{level} \"{inside}\">");
    }
    text += "]><DAVEfunc>&a29;</DAVEfunc>";
    assert!(sentences(&text).starts_with("1:20: `[`: declarations inside the file"));
}

#[test]
fn entities_from_elsewhere_are_not_fetched() {
    let text = "<!DOCTYPE DAVEfunc SYSTEM \"file:///etc/passwd\"><DAVEfunc>&passwd;</DAVEfunc>";
    assert!(sentences(text).contains("not well-formed"));
}

#[test]
fn a_hundred_thousand_elements_inside_each_other_are_refused() {
    let deep = "<DAVEfunc>".repeat(100_000) + &"</DAVEfunc>".repeat(100_000);
    let answer = sentences(&deep);
    assert_eq!(
        answer,
        "1:641: `DAVEfunc`: nested too deeply; expected at most 64 elements inside each other"
    );
    assert!(sentences(&"<a>".repeat(100_000)).contains("not well-formed"));
}

#[test]
fn ten_mebibytes_of_anything_come_to_an_end() {
    let room = fspid_daveml::MAX_INPUT_BYTES - 100;
    let many = format!("<DAVEfunc>{}</DAVEfunc>", "<a/>".repeat(room / 4));
    assert!(sentences(&many).contains("nodes limit") || sentences(&many).contains("not supported"));
    let numbers = "0 ".repeat(room / 2);
    let text = format!(
        "<DAVEfunc><breakpointDef bpID=\"A\"><bpVals>{numbers}</bpVals></breakpointDef></DAVEfunc>"
    );
    assert!(sentences(&text).contains("a model without variables"));
    let words = "x\n".repeat(room / 2);
    let text = format!(
        "<DAVEfunc><breakpointDef bpID=\"A\"><bpVals>{words}</bpVals></breakpointDef></DAVEfunc>"
    );
    assert_eq!(sentences(&text).lines().count(), 100);
}

#[test]
fn more_variables_than_allowed_are_refused() {
    let variables: String = (0..1025)
        .map(|index| format!("<variableDef name=\"v{index}\" varID=\"v{index}\" units=\"nd\"><isInput/></variableDef>"))
        .collect();
    assert_eq!(
        sentences(&format!("<DAVEfunc>{variables}</DAVEfunc>")),
        "1025 variables; expected at most 1024"
    );
}

#[test]
fn a_formula_may_be_as_deep_as_elements_may() {
    let formula = |depth: usize| {
        let (open, close) = ("<apply><minus/>".repeat(depth), "</apply>".repeat(depth));
        format!(
            "<DAVEfunc><variableDef name=\"y\" varID=\"y\" units=\"nd\"><calculation><math>{open}<cn>1</cn>{close}\
             </math></calculation><isOutput/></variableDef></DAVEfunc>"
        )
    };
    let model = fspid_daveml::read(&formula(59)).unwrap().model;
    let mut answer = [0.0];
    model.evaluate(&[], &mut answer).unwrap();
    assert_eq!(answer[0].to_bits(), (-1.0_f64).to_bits());
    assert!(sentences(&formula(60)).contains("nested too deeply"));
}

proptest! {
    #[test]
    fn garbage_never_panics(text in "\\PC{0,200}") {
        let _ = fspid_daveml::read(&text);
    }

    #[test]
    fn a_model_with_a_piece_cut_out_or_doubled_never_panics(start in 0_usize..9000, length in 0_usize..400, twice: bool) {
        let mut text = TOY.to_owned();
        let end = (start + length).min(text.len());
        let start = start.min(end);
        prop_assume!(text.is_char_boundary(start) && text.is_char_boundary(end));
        let piece = if twice { text[start..end].repeat(2) } else { String::new() };
        text.replace_range(start..end, &piece);
        if let Ok(reading) = fspid_daveml::read(&text) {
            let _ = reading.model.check();
        }
    }

    #[test]
    fn any_inputs_are_answered(inputs in prop::collection::vec(prop::num::f64::ANY, 5)) {
        let model = fspid_daveml::read(TOY).unwrap().model;
        let mut outputs = [0.0; 5];
        prop_assert!(model.evaluate(&inputs, &mut outputs).is_ok());
    }
}
