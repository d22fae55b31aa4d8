//! Rules that conclude labels, over Gaussian sets.

use fspid_core::fuzzy::{Label, OutOfRange, Output, RuleTable, Supervisor};
use fspid_numeric::Real;

use super::super::members::Configuration;
use super::{GAINS, SETS, UNDERFLOW, clamped, is_outside};
use crate::program::{
    Argument, Expression, Function, Kind, Operator, Parameter, Part, Place, Statement, Value,
    element, local, member, member_element, number, whole,
};

const GRADES: [(&str, &str); 2] =
    [("seen_error", "error_grades"), ("seen_change", "change_grades")];

/// The function that fills the grades of one input.
pub(super) fn grades<R: Real>(
    configuration: &mut Configuration,
    supervisor: &Supervisor<R>,
) -> Function {
    let sets = supervisor.sets();
    let centres = sets.iter().map(|[centre, _]| centre.to_f64()).collect();
    let doc = "Centres of the input sets from NB to PB, in the units of the inputs.";
    configuration.add("set_centres", doc, Value::Reals(centres));
    let [[_, sigma], ..] = sets;
    let sigma =
        configuration.real("set_sigma", "Width of the input sets, their sigma.", sigma.to_f64());
    let centre = member_element(Part::Configuration, "set_centres", local("set"));
    let z = || local("distance");
    let exponent = number(-0.5) * (z() * z());
    let grade = Expression::Call("exponential", vec![Argument::Value(exponent)]);
    Function {
        name: "fill_grades",
        doc: "Grades of an input in its seven sets.",
        parts: &[Part::Configuration],
        parameters: vec![
            Parameter { name: "input", kind: Kind::Real, written: false },
            Parameter { name: "grades", kind: Kind::Reals(7), written: true },
        ],
        answers: None,
        body: vec![Statement::repeat(
            "set",
            SETS,
            vec![
                Statement::real("distance", (local("input") - centre) / sigma),
                Statement::set_element("grades", local("set"), grade),
            ],
        )],
    }
}

/// What `infer` does with its inputs.
pub(super) fn body<R: Real>(
    configuration: &mut Configuration,
    supervisor: &Supervisor<R>,
) -> Vec<Statement> {
    let Some(table) = supervisor.table() else { return Vec::new() };
    rules(configuration, &table);
    // Centres lie a spacing apart, the middle one at 0.
    let [.., spacing, _, _] = supervisor.sets().map(|[centre, _]| centre.to_f64());
    configuration.real("spacing", "Distance between two set centres.", spacing);
    let mut body: Vec<Statement> =
        GRADES.iter().map(|(_, grades)| Statement::Array((*grades).to_owned(), 7)).collect();
    body.extend(filled());
    body.push(Statement::Let("fault".to_owned(), Kind::Byte, Expression::Byte(0)));
    if supervisor.out_of_range() == OutOfRange::Evaluate {
        body.extend(evaluated::<R>());
    }
    body.extend(GAINS.map(|gain| Statement::Array(strengths(gain), 7)));
    body.push(Statement::Remark(
        "A rule is as strong as the weaker of its two grades, a label as its strongest rule; what a damaged table has \
         in the place of a label is none, and leads out of no array."
            .into(),
    ));
    body.extend(strongest_rules());
    for (gain, place) in GAINS.into_iter().zip(0..) {
        let centre = Expression::Call("centroid", vec![Argument::Array(strengths(gain))]);
        let increment = centre * member(Part::Configuration, "spacing");
        body.push(Statement::set_element("increments", whole(place), increment));
    }
    body.push(Statement::Return(Some(local("fault"))));
    body
}

/// The labels of the rules as members, row by row.
fn rules(configuration: &mut Configuration, table: &RuleTable) {
    for (gain, output) in GAINS.into_iter().zip(Output::ALL) {
        let grid = table.grid(output);
        let labels = Label::ALL.into_iter().flat_map(|error| {
            Label::ALL.into_iter().map(move |change| grid.at(error, change).index() as u8)
        });
        let doc = format!(
            "Labels that the rules conclude for {gain}, 0 for NB to 6 for PB: R1 to R49, error by error from NB to PB, \
             in each the changes from NB to PB."
        );
        configuration.add(&format!("rules_{gain}"), &doc, Value::Bytes(labels.collect()));
    }
}

fn strengths(gain: &str) -> String {
    format!("strengths_{gain}")
}

fn filled() -> Vec<Statement> {
    let fill = |(input, grades): (&str, &str)| {
        let arguments = vec![Argument::Value(local(input)), Argument::Array(grades.to_owned())];
        Statement::Call("fill_grades", arguments)
    };
    GRADES.map(fill).into()
}

/// Outside of the range: where every rule has underflowed, the answer is that for the clamped inputs.
fn evaluated<R: Real>() -> Vec<Statement> {
    let strongest = |(name, grades): (&str, &str)| {
        let grade = element(grades, local("set"));
        let larger = Statement::set(name, local(name).larger(grade));
        [Statement::real(name, number(0.0)), Statement::repeat("set", SETS, vec![larger])]
    };
    let mut outside: Vec<Statement> =
        [("strongest_error", GRADES[0].1), ("strongest_change", GRADES[1].1)]
            .into_iter()
            .flat_map(strongest)
            .collect();
    let rule = local("strongest_error").smaller(local("strongest_change"));
    let mut again = clamped();
    again.extend(filled());
    again.push(Statement::set("fault", Expression::Byte(UNDERFLOW)));
    let answers = number(R::MIN_POSITIVE.to_f64()).at_most(rule);
    outside.push(Statement::when(answers.negated(), again));
    vec![Statement::when(is_outside(), outside)]
}

/// The loops over all rules.
fn strongest_rules() -> [Statement; 2] {
    let (error, change) =
        (element("error_grades", local("row")), element("change_grades", local("column")));
    let mut rule = vec![Statement::real("strength", error.smaller(change))];
    for gain in GAINS {
        let label = member_element(Part::Configuration, &format!("rules_{gain}"), local("rule"));
        let name = format!("label_{gain}");
        let place = || Place::Element(strengths(gain), Box::new(local(&name)));
        let stronger = Statement::when(
            Expression::Read(place()).less(local("strength")),
            vec![Statement::Set(place(), local("strength"))],
        );
        rule.push(Statement::Let(name.clone(), Kind::Whole, label));
        // Two questions: not every language leaves the second one alone where the first says no.
        rule.push(Statement::when(local(&name).less(whole(SETS)), vec![stronger]));
    }
    rule.push(Statement::set("rule", Expression::binary(Operator::Add, local("rule"), whole(1))));
    let rows = Statement::repeat("row", SETS, vec![Statement::repeat("column", SETS, rule)]);
    [Statement::Let("rule".to_owned(), Kind::Whole, whole(0)), rows]
}
