//! Models as TOML: written and read back bit for bit, and refused where something is wrong.
#![allow(clippy::unwrap_used, clippy::indexing_slicing, reason = "a test")]

use fspid_daveml::document::{
    Breakpoints, Document, Expression, GridTable, Mention, Role, Variable,
};
use fspid_daveml::{Model, data, read};
use proptest::prelude::*;

const TOY: &str = include_str!("data/toy.dml");

#[test]
fn a_model_is_read_back_as_it_was_with_all_it_says_about_itself() {
    let reading = read(TOY).unwrap();
    let again = data::read(&data::write(&reading.document)).unwrap();
    assert_eq!(again.document, reading.document);
    assert_eq!(again.model, reading.model);
    assert!(again.model.check().passed());
}

#[test]
fn the_text_is_the_recorded_one() {
    let text = data::write(&read(TOY).unwrap().document);
    assert_eq!(
        text,
        include_str!("data/toy.toml"),
        "if this is meant, write it to toy.toml:\n{text}"
    );
    assert!(text.lines().all(|line| !line.starts_with("values") || line.len() <= 140));
}

fn refusal(from: &str, to: &str) -> String {
    let text = include_str!("data/toy.toml");
    assert!(text.contains(from), "{from}");
    data::read(&text.replacen(from, to, 1)).unwrap_err().to_string()
}

#[test]
fn mistakes_are_told_with_their_place() {
    assert_eq!(refusal("schema = 1", "schema = 2"), "`2`: unknown schema; expected 1");
    let key = refusal("symbol = \"V\"", "symbl = \"V\"");
    assert!(key.contains("unknown field `symbl`, expected one of `id`, `name`"), "{key}");
    assert!(key.split(':').next().unwrap().parse::<usize>().unwrap() > 20, "{key}");
    let formula = refusal("times(CL0, factor)", "times(CL0 factor)");
    assert!(formula.contains("`factor)` in the formula; expected `,` or `)`"), "{formula}");
    assert_eq!(
        refusal("times(CL0, factor)", "times(CL0, fctor)").lines().next().unwrap(),
        "`fctor`: there is no variable with this identifier; expected AR, CD, CD0, CL, CL0, Cm, Cm0, M, V, alpha, angle, \
         factor, flap, gust, path, stall, trig"
    );
    let number = refusal("initial = 8.0", "initial = nan");
    assert!(number.starts_with("`AR`: a number that cannot be used; expected finite"), "{number}");
    let key = refusal("units = \"m_s\"\n", "");
    assert!(key.contains("missing field `units`"), "{key}");
    assert!(refusal("id = \"V\"", "id = \"V V\"").contains("cannot be the identifier"));
}

#[test]
fn a_document_can_be_put_together_without_a_file() {
    let variable = |id: &str, roles: Vec<Role>, formula| Variable {
        id: id.into(),
        name: id.into(),
        units: "nd".into(),
        roles,
        formula,
        ..Variable::default()
    };
    let minus_x = Expression::Apply(
        fspid_daveml::Function::Minus,
        vec![Expression::Variable { id: "x".into(), origin: Default::default() }],
    );
    let document = Document {
        variables: vec![
            variable("x", vec![Role::Input], None),
            variable("y", vec![Role::Output], Some(minus_x)),
        ],
        ..Document::default()
    };
    let mut outputs = [0.0];
    Model::new(&document).unwrap().evaluate(&[2.0], &mut outputs).unwrap();
    assert_eq!(outputs[0].to_bits(), (-2.0_f64).to_bits());
}

proptest! {
    #[test]
    fn numbers_keep_their_bits(values in prop::collection::vec(-1e100..1e100_f64, 1..40), small in prop::num::f64::SUBNORMAL) {
        let values: Vec<_> = values.into_iter().chain([small, -0.0]).collect();
        let document = Document {
            breakpoints: vec![Breakpoints { id: "A".into(), values: values.clone(), ..Breakpoints::default() }],
            tables: vec![GridTable {
                id: "T".into(),
                breakpoints: vec![Mention { id: "A".into(), ..Mention::default() }],
                values: values.clone(),
                ..GridTable::default()
            }],
            ..Document::default()
        };
        let again = data::read(&data::write(&document)).unwrap().document;
        let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        prop_assert_eq!(bits(&again.tables[0].values), bits(&values));
    }

    #[test]
    fn garbage_never_panics(text in "\\PC{0,200}") {
        let _ = data::read(&text);
    }
}
