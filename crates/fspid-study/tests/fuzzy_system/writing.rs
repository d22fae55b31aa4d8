//! What is written is read back as the same system, to the last bit.

use fspid_fuzzy::norm::{SNormKind, TNormKind};
use fspid_fuzzy::system::Parts;
use fspid_scenario::fuzzy_system::{Options, System, load, parse, write};
use fspid_study::fuzzy_system::{AuditQuestion, SliceQuestion, audit, slice};

use super::{EVERY_KEY, TIP, TYPE_2};

fn written(text: &str) -> (System, String) {
    let system = parse(text, "a.toml").unwrap_or_else(|problems| panic!("{problems}\n{text}"));
    let text = write(system.parts());
    (system, text)
}

/// Written and read back: the same parts, and then the same text.
fn comes_back(parts: &Parts) -> String {
    let text = write(parts);
    let (again, same) = written(&text);
    assert_eq!(again.parts(), parts, "{text}");
    assert_eq!(same, text);
    text
}

#[test]
fn every_key_is_read_written_and_read_back_as_the_same() {
    for text in [TIP, EVERY_KEY, TYPE_2] {
        let (system, _) = written(text);
        comes_back(system.parts());
    }
}

#[test]
fn a_rule_table_is_written_as_grids_and_answers_the_same_bits() {
    let options = Options { range: Some(5.0), ..Options::default() };
    let system = load("printed", options).expect("shipped").system;
    let text = comes_back(system.parts());
    assert!(
        text.contains("[rules.table.cells]\ndelta_kp = \"\"\"\nPB PB PM PM PS PS ZO\n"),
        "{text}"
    );
    let again = parse(&text, "printed.toml").expect("just written");
    let (mut one, mut two) = (system.workspace(), again.workspace());
    for n in 0..500 {
        let inputs = [5.5 * (f64::from(n) * 0.37).sin(), 5.5 * (f64::from(n) * 0.73).cos()];
        let before = system.evaluate(&inputs, &mut one).expect("finite").to_vec();
        assert_eq!(again.evaluate(&inputs, &mut two).expect("finite"), before);
    }
}

#[test]
fn every_norm_comes_back() {
    let (system, _) = written(TIP);
    for (and, or) in TNormKind::ALL.iter().zip(SNormKind::ALL.iter().cycle()) {
        let mut parts = system.parts().clone();
        parts.blocks[0].and = (*and).into();
        parts.blocks[0].implication = (*and).into();
        parts.blocks[0].or = (*or).into();
        parts.outputs[0].aggregation = (*or).into();
        comes_back(&parts);
    }
}

#[test]
fn every_shape_comes_back_with_the_bits_of_its_parameters() {
    use fspid_fuzzy::membership::ShapeKind;
    use fspid_fuzzy::system::Membership;
    let (system, _) = written(TIP);
    for kind in ShapeKind::ALL {
        let mut parts = system.parts().clone();
        let params: Vec<f64> = kind.example().to_vec();
        let membership = Membership::Shape { kind: *kind, params, height: 0.1 + 0.2 };
        parts.inputs[0].terms[0].membership = membership.clone();
        comes_back(&parts);
        parts.inputs[0].terms[0].lower = Some(membership);
        comes_back(&parts);
    }
}

#[test]
fn numbers_keep_their_bits() {
    let (system, _) = written(TIP);
    let numbers = [0.1 + 0.2, 1e-300, 5e-324, f64::MAX / 4.0, -0.0, 1.0 / 3.0, 1e16, 123_456_789.0];
    for number in numbers {
        let mut parts = system.parts().clone();
        let fallback = fspid_fuzzy::system::FallbackValue::Number(number);
        parts.outputs[0].fallback.value = fallback;
        let text = comes_back(&parts);
        let again = parse(&text, "a.toml").expect("just written");
        let fspid_fuzzy::system::FallbackValue::Number(back) =
            again.parts().outputs[0].fallback.value
        else {
            panic!("{text}");
        };
        assert_eq!(back.to_bits(), number.to_bits(), "{text}");
    }
}

#[test]
fn names_of_any_characters_come_back() {
    let odd = [
        "if", "is", "very", "not", "a b", "a\"b", "a\\b", "ä", "12", "1.5", "-", "a,b", "(",
        "a\tb", "#x", "x=y", "\u{202e}",
    ];
    for name in odd {
        let (system, _) = written(TIP);
        let mut parts = system.parts().clone();
        parts.inputs[0].name = name.to_owned();
        parts.inputs[0].terms[1].name = name.to_owned();
        parts.outputs[0].terms[0].name = name.to_owned();
        parts.blocks[0].name = name.to_owned();
        parts.blocks[0].rules[1].name = name.to_owned();
        parts.description = format!("{name}\n{name}");
        comes_back(&parts);
    }
    let options = Options { range: Some(5.0), ..Options::default() };
    let shipped = load("printed", options).expect("shipped").system;
    for name in odd {
        let mut parts = shipped.parts().clone();
        parts.outputs[1].terms[0].name = name.to_owned();
        parts.outputs[2].name = name.to_owned();
        comes_back(&parts);
    }
}

#[test]
fn a_system_with_nothing_but_variables_comes_back() {
    let (system, _) = written(TIP);
    let mut parts = system.parts().clone();
    parts.blocks.clear();
    parts.name.clear();
    parts.description.clear();
    parts.inputs[0].terms.clear();
    parts.outputs[0].terms.clear();
    let text = comes_back(&parts);
    assert!(!text.contains("terms") || text.matches("terms").count() == 1, "{text}");
}

/// Files of fuzzylite whose formulas name outputs were refused.
#[test]
fn a_formula_that_names_an_output_comes_back_and_its_surface_is_refused() {
    let text = include_str!("../systems/memory.toml");
    let (system, _) = written(text);
    comes_back(system.parts());
    assert!(system.parts().formulas_name_outputs());
    let told = audit(&system, &AuditQuestion::default()).expect_err("refused").to_string();
    assert!(told.contains("a formula names an output"), "{told}");
    // It was drawn, as if it had no memory.
    let drawn = slice(&system, &SliceQuestion::default()).expect_err("refused").to_string();
    assert_eq!(drawn, told);
}
