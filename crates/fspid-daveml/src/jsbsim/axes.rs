//! Functions of the axes and their sums, as coefficients of the standard.

use std::collections::BTreeMap;

use crate::MAX_VARIABLES;
use crate::document::{Document, Role, Variable};
use crate::expression::Expression;
use crate::finding::{Findings, Origin};
use crate::formula::{is_name, parse};
use crate::jsbsim::class::Share;
use crate::jsbsim::expression::is_part;
use crate::jsbsim::metrics::{AREA, CHORD, Metrics, SPAN};
use crate::jsbsim::property::{
    ALPHA, ALTITUDE, BETA, Builder, LIFT_AT_REST, LIFT_SQUARED, MACH, named,
};
use crate::jsbsim::{ends, required, surface};
use crate::xml::element::Element;

/// Axes along the flow, those of the body, and those of moments.
const WIND: [&str; 3] = ["DRAG", "SIDE", "LIFT"];
const BODY: [&str; 3] = ["X", "Y", "Z"];
const MOMENTS: [&str; 3] = ["ROLL", "PITCH", "YAW"];

/// Coefficients along and about the axes of the body, and their names in the standard.
const COEFFICIENTS: [(&str, &str); 6] = [
    ("CX", "aeroBodyForceCoefficient_X"),
    ("CY", "aeroBodyForceCoefficient_Y"),
    ("CZ", "aeroBodyForceCoefficient_Z"),
    ("Cl", "aeroBodyMomentCoefficient_Roll"),
    ("Cm", "aeroBodyMomentCoefficient_Pitch"),
    ("Cn", "aeroBodyMomentCoefficient_Yaw"),
];

/// What the box of a flight has.
const BOXED: [&str; 4] = [ALPHA, BETA, MACH, ALTITUDE];

/// A function of the file.
struct Piece<'a, 'i> {
    element: Element<'a, 'i>,
    id: String,
    axis: Option<&'static str>,
    /// Functions that it names.
    needs: Vec<usize>,
}

/// The model of `<aerodynamics>`.
pub(super) fn read(
    root: Element<'_, '_>,
    (metrics, held): (&Metrics, &[(String, f64)]),
    findings: &mut Findings,
) -> Document {
    let Some(part) = required(root, "aerodynamics", findings) else { return Document::default() };
    let mut builder = Builder::new(metrics, held, surface::scaled(root), findings);
    let pieces = pieces(part, &mut builder);
    if pieces.len() <= MAX_VARIABLES {
        in_order(&pieces, &mut builder);
        coefficients(&pieces, part, &mut builder);
    } else {
        let message = format!("{} functions", pieces.len());
        builder.findings.problem(part.origin(), "", message, format!("at most {MAX_VARIABLES}"));
    }
    builder.unused();
    let mut document = builder.document;
    // What is too large is told when the model is compiled.
    if document.tables.len() <= MAX_VARIABLES {
        let variables = entering(&document);
        ends::widen(&mut document, &variables, findings);
    }
    document
}

/// Every variable that enters a table, those of the box first: the ends of their tables bound a flight.
fn entering(document: &Document) -> Vec<String> {
    let mut variables = BOXED.map(str::to_owned).to_vec();
    for input in document.functions.iter().flat_map(|function| &function.inputs) {
        if !variables.contains(&input.variable.id) {
            variables.push(input.variable.id.clone());
        }
    }
    variables
}

/// Every function, with those that it names.
fn pieces<'a, 'i>(part: Element<'a, 'i>, builder: &mut Builder<'_>) -> Vec<Piece<'a, 'i>> {
    let (mut pieces, mut axes) = (Vec::new(), Vec::new());
    for child in part.children(builder.findings) {
        match child.name() {
            "function" => pieces.push(piece(child, None, pieces.len())),
            "axis" => {
                let Some(axis) = axis(child, builder.findings) else { continue };
                if axes.contains(&axis) {
                    let message =
                        "a second axis of this name, of which JSBSim flies the last alone";
                    builder.findings.problem(
                        child.origin(),
                        axis,
                        message,
                        "one axis of each name",
                    );
                }
                axes.push(axis);
                for function in child.children(builder.findings) {
                    match function.name() {
                        "function" => pieces.push(piece(function, Some(axis), pieces.len())),
                        _ if !is_part(function) => {}
                        _ => function.refuse("axis", "function", builder.findings),
                    }
                }
            }
            "alphalimits" | "hysteresis_limits" => {
                child.leave_out("there is no hysteresis of a stall", builder.findings);
            }
            _ if !is_part(child) => {}
            _ => child.refuse("aerodynamics", "function, axis", builder.findings),
        }
    }
    let index: BTreeMap<String, usize> =
        pieces.iter().enumerate().map(|(index, piece)| (piece.id.clone(), index)).collect();
    for piece in &mut pieces {
        piece.needs = needs(piece.element, &index);
    }
    pieces
}

fn piece<'a, 'i>(
    element: Element<'a, 'i>,
    axis: Option<&'static str>,
    count: usize,
) -> Piece<'a, 'i> {
    let name = element.optional("name");
    let id = if name.is_empty() { format!("function-{}", count + 1) } else { name };
    // JSBSim takes any text for a name; formulas here take no white space, comma or bracket.
    let sign = |sign: char| sign.is_whitespace() || "(),".contains(sign);
    Piece { element, id: id.replace(sign, "_"), axis, needs: Vec::new() }
}

/// The axis of that name, in pounds and feet, if its frame is the usual.
fn axis(element: Element<'_, '_>, findings: &mut Findings) -> Option<&'static str> {
    element.only(&["name", "unit"], findings);
    let unit = element.optional("unit");
    if !matches!(unit.to_ascii_uppercase().as_str(), "" | "LBS" | "LBS*FT" | "FT*LBS") {
        let message = "this unit is not known here";
        findings.problem(element.origin(), &unit, message, "LBS for forces, LBS*FT for moments");
    }
    let name = element.optional("name");
    let found = WIND.iter().chain(&BODY).chain(&MOMENTS).find(|it| it.eq_ignore_ascii_case(&name));
    if found.is_none() {
        let expected = [WIND, BODY, MOMENTS].concat().join(", ");
        findings.problem(element.origin(), &name, "this axis is not supported", expected);
    }
    found.copied()
}

/// Functions that a function names.
fn needs(element: Element<'_, '_>, index: &BTreeMap<String, usize>) -> Vec<usize> {
    let names = element
        .descendants()
        .filter(|it| matches!(it.name(), "property" | "p" | "independentVar"))
        .map(Element::prose);
    names.filter_map(|name| index.get(name.trim_start_matches('-').trim()).copied()).collect()
}

/// Reads the functions of the axes and those that they name, each behind those that it names.
fn in_order(pieces: &[Piece<'_, '_>], builder: &mut Builder<'_>) {
    let mut wanted = vec![false; pieces.len()];
    let mut open: Vec<usize> = (0..pieces.len())
        .filter(|&index| pieces.get(index).is_some_and(|piece| piece.axis.is_some()))
        .collect();
    while let Some(index) = open.pop() {
        let Some(known) = wanted.get_mut(index) else { continue };
        if !core::mem::replace(known, true)
            && let Some(piece) = pieces.get(index)
        {
            open.extend(&piece.needs);
        }
    }
    let mut waiting: Vec<usize> =
        (0..pieces.len()).filter(|&index| wanted.get(index) == Some(&true)).collect();
    let mut done = vec![false; pieces.len()];
    loop {
        let before = waiting.len();
        waiting.retain(|&index| {
            let Some(piece) = pieces.get(index) else { return false };
            let ready = piece.needs.iter().all(|&need| done.get(need) == Some(&true));
            if ready {
                function(piece, builder);
                if let Some(done) = done.get_mut(index) {
                    *done = true;
                }
            }
            !ready
        });
        if waiting.len() == before {
            break;
        }
    }
    for piece in waiting.iter().filter_map(|&index| pieces.get(index)) {
        let message = "this function asks for itself, by way of others or at once";
        builder.findings.problem(piece.element.origin(), &piece.id, message, "no circle");
    }
}

/// Reads one function.
fn function(piece: &Piece<'_, '_>, builder: &mut Builder<'_>) {
    let element = piece.element;
    element.only(&["name"], builder.findings);
    let children = element.children(builder.findings);
    let parts: Vec<_> = children.into_iter().filter(|child| is_part(*child)).collect();
    let term = match parts.as_slice() {
        [part] => builder.expression(*part, &piece.id),
        _ => {
            let message = format!("the number of formulas is {}", parts.len());
            builder.findings.problem(element.origin(), &piece.id, message, "one");
            None
        }
    };
    let Some(term) = term else { return builder.refuse(&piece.id) };
    let is_free = is_name(&piece.id) && piece.id != LIFT_AT_REST;
    if !is_free || builder.document.variables.iter().any(|it| it.id == piece.id) {
        let message = "this name cannot be that of a function, or is used already";
        builder.findings.problem(element.origin(), &piece.id, message, "another name");
        return builder.refuse(&piece.id);
    }
    if piece.axis.is_some() && !term.class.pressure {
        let message = "this load is not proportional to the dynamic pressure";
        let expected = "a product with aero/qbar-psf, or a sum of such";
        builder.findings.problem(element.origin(), &piece.id, message, expected);
        return builder.refuse(&piece.id);
    }
    let units = match piece.axis {
        Some(axis) if MOMENTS.contains(&axis) => "ft3",
        Some(_) => "ft2",
        None => "nd",
    };
    let variable = Variable {
        formula: Some(term.formula),
        description: element.prose_of("description"),
        origin: element.origin(),
        ..named(&piece.id, &piece.id, units)
    };
    builder.add(variable, term.class);
}

/// Sums of the axes, and the coefficients that they make.
fn coefficients(pieces: &[Piece<'_, '_>], part: Element<'_, '_>, builder: &mut Builder<'_>) {
    let has =
        |axes: [&str; 3]| pieces.iter().any(|it| it.axis.is_some_and(|it| axes.contains(&it)));
    let (wind, body) = (has(WIND), has(BODY));
    if wind == body || !builder.findings.good() {
        if wind == body {
            let message = "forces along the flow and along the body, or none at all";
            let expected = "axes DRAG, SIDE and LIFT, or X, Y and Z";
            builder.findings.problem(part.origin(), "aerodynamics", message, expected);
        }
        return;
    }
    let forces = if wind { WIND } else { BODY };
    let own = own(builder);
    for axis in forces.into_iter().chain(MOMENTS) {
        let ids = pieces.iter().filter(|piece| piece.axis == Some(axis)).map(|it| it.id.as_str());
        sum(&format!("axis/{axis}{own}"), ids.collect(), builder);
    }
    at_rest(pieces, part, builder);
    let origin = Origin(None);
    if wind {
        // The angles stand in the formulas below even where no function asks for them.
        let _ = (builder.property(ALPHA, origin), builder.property(BETA, origin));
    }
    let [x, y, z] =
        if wind { along_the_body(&own) } else { BODY.map(|it| format!("axis/{it}{own}")) };
    let moment =
        |axis: &str, length: &str| format!("divide(axis/{axis}{own}, times({AREA}, {length}))");
    let texts = [
        format!("divide({x}, {AREA})"),
        format!("divide({y}, {AREA})"),
        format!("divide({z}, {AREA})"),
        moment("ROLL", SPAN),
        moment("PITCH", CHORD),
        moment("YAW", SPAN),
    ];
    for ((id, name), text) in COEFFICIENTS.into_iter().zip(texts) {
        let (id, formula) = (format!("{id}{own}"), parse(&text).ok());
        let variable = Variable { formula, roles: vec![Role::Output], ..named(&id, name, "nd") };
        builder.document.variables.push(variable);
    }
}

/// Forces along the axes of the body from those along the flow.
fn along_the_body(own: &str) -> [String; 3] {
    [
        format!(
            "minus(minus(times(axis/LIFT{own}, sin({ALPHA})), times(axis/DRAG{own}, cos({ALPHA}), cos({BETA}))), \
             times(axis/SIDE{own}, cos({ALPHA}), sin({BETA})))"
        ),
        format!("minus(times(axis/SIDE{own}, cos({BETA})), times(axis/DRAG{own}, sin({BETA})))"),
        format!(
            "minus(minus(minus(times(axis/LIFT{own}, cos({ALPHA}))), times(axis/DRAG{own}, sin({ALPHA}), cos({BETA}))), \
             times(axis/SIDE{own}, sin({ALPHA}), sin({BETA})))"
        ),
    ]
}

/// What follows the names of sums and coefficients, so that no function or property of the file has one of them.
fn own(builder: &Builder<'_>) -> String {
    let coefficients = COEFFICIENTS.map(|(id, _)| id.to_owned());
    let axes = [WIND, BODY, MOMENTS].concat().into_iter().map(|axis| format!("axis/{axis}"));
    let ids: Vec<_> = coefficients.into_iter().chain(axes).collect();
    let variables = &builder.document.variables;
    let mut own = String::new();
    while variables.iter().any(|it| {
        it.id.strip_suffix(own.as_str()).is_some_and(|id| ids.iter().any(|taken| taken == id))
    }) {
        own.push('_');
    }
    own
}

/// A variable that is the sum of others; 0 without any.
fn sum(id: &str, ids: Vec<&str>, builder: &mut Builder<'_>) {
    let formula = match ids.as_slice() {
        [] => Ok(Expression::Number(0.0)),
        [one] => parse(one),
        ids => parse(&format!("plus({})", ids.join(", "))),
    };
    builder.document.variables.push(Variable { formula: formula.ok(), ..named(id, id, "nd") });
}

/// The lift whose square is asked for.
fn at_rest(pieces: &[Piece<'_, '_>], part: Element<'_, '_>, builder: &mut Builder<'_>) {
    if !builder.squares_lift() {
        return;
    }
    let lift: Vec<_> = pieces.iter().filter(|piece| piece.axis == Some("LIFT")).collect();
    let mixed = lift.iter().find(|piece| builder.class(&piece.id).rate == Share::Linear);
    if let Some(piece) = mixed {
        let message = "this lift has a part by the rate of the angle of attack and another one, and its square is asked for";
        let expected = "two functions";
        builder.findings.problem(piece.element.origin(), &piece.id, message, expected);
    }
    if lift.is_empty() {
        builder.findings.problem(part.origin(), LIFT_SQUARED, "there is no lift", "an axis LIFT");
    }
    let ids = lift.iter().filter(|piece| !builder.rests(&piece.id)).map(|it| it.id.as_str());
    let ids: Vec<_> = ids.collect();
    sum(LIFT_AT_REST, ids, builder);
}
