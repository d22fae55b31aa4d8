//! Membership functions: which element has which numbers.

use fspid_fuzzy::FuzzyError;
use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::system::Membership;

use super::FAR;
use super::document::{Context, Element};
use crate::vocabulary::known;

/// An element and how its `param1`, `param2`, … become a shape.
struct ShapeElement {
    name: &'static str,
    count: usize,
    shape: fn(&[f64]) -> (ShapeKind, Vec<f64>),
}

fn same(kind: ShapeKind, params: &[f64]) -> (ShapeKind, Vec<f64>) {
    (kind, params.to_vec())
}

/// Falls to the left of the centre, 1 to the right of it.
fn right_gaussian(params: &[f64]) -> (ShapeKind, Vec<f64>) {
    let sided = |&[centre, sigma]: &[f64; 2]| vec![centre, sigma, centre.max(FAR), sigma];
    (ShapeKind::GaussianProduct, params.first_chunk().map(sided).unwrap_or_default())
}

/// 1 to the left of the centre.
fn left_gaussian(params: &[f64]) -> (ShapeKind, Vec<f64>) {
    let sided = |&[centre, sigma]: &[f64; 2]| vec![centre.min(-FAR), sigma, centre, sigma];
    (ShapeKind::GaussianProduct, params.first_chunk().map(sided).unwrap_or_default())
}

const ROWS: &[ShapeElement] = &[
    ShapeElement { name: "triangularShape", count: 3, shape: |p| same(ShapeKind::Triangle, p) },
    ShapeElement { name: "trapezoidShape", count: 4, shape: |p| same(ShapeKind::Trapezoid, p) },
    ShapeElement { name: "trapezoidalShape", count: 4, shape: |p| same(ShapeKind::Trapezoid, p) },
    ShapeElement { name: "gaussianShape", count: 2, shape: |p| same(ShapeKind::Gaussian, p) },
    ShapeElement { name: "rightGaussianShape", count: 2, shape: right_gaussian },
    ShapeElement { name: "leftGaussianShape", count: 2, shape: left_gaussian },
    ShapeElement { name: "rightLinearShape", count: 2, shape: |p| same(ShapeKind::LinearS, p) },
    ShapeElement { name: "leftLinearShape", count: 2, shape: |p| same(ShapeKind::LinearZ, p) },
    ShapeElement { name: "piShape", count: 4, shape: |p| same(ShapeKind::Pi, p) },
    ShapeElement { name: "sShape", count: 2, shape: |p| same(ShapeKind::SmoothS, p) },
    ShapeElement { name: "zShape", count: 2, shape: |p| same(ShapeKind::SmoothZ, p) },
    ShapeElement { name: "rectangularShape", count: 2, shape: |p| same(ShapeKind::Rectangle, p) },
    ShapeElement { name: "singletonShape", count: 1, shape: |p| same(ShapeKind::Singleton, p) },
];

/// Elements that are no row.
const POINTS: [&str; 3] = ["pointSetShape", "pointSetMonotonicShape", "userShape"];

/// What the files before the standard call right is left in it: `RightLinearShape` fell.
fn of_before(name: &str) -> Option<&'static str> {
    const MIRRORED: [(&str, &str); 4] = [
        ("RightLinearShape", "leftLinearShape"),
        ("LeftLinearShape", "rightLinearShape"),
        ("RightGaussianShape", "leftGaussianShape"),
        ("LeftGaussianShape", "rightGaussianShape"),
    ];
    MIRRORED.iter().find(|row| row.0 == name).map(|row| row.1)
}

/// The shape inside of a term.
pub(super) fn read(term: Element<'_, '_>, context: &mut Context<'_>) -> Option<Membership> {
    let mut shapes = term.children();
    let Some(shape) = shapes.next() else {
        let expected = known(names(), "");
        context.problem(term.start(), "", "the term has no shape", expected);
        return None;
    };
    if let Some(second) = shapes.next() {
        let message = "a second shape in one term";
        context.problem(second.start(), second.name(), message, "one shape");
    }
    if shape.is_any(&POINTS) {
        return points(shape, context);
    }
    let before = of_before(shape.name());
    let name = before.unwrap_or(shape.name());
    let Some(row) = ROWS.iter().find(|row| row.name.eq_ignore_ascii_case(name)) else {
        refuse(shape, context);
        return None;
    };
    sided(shape, row, before.is_some(), context);
    let params = parameters(shape, context)?;
    if row.name == "piShape" && params.len() == 2 {
        return pi(shape, &params, context);
    }
    if params.len() != row.count {
        let message = format!("has {} parameters", params.len());
        context.problem(shape.start(), shape.name(), message, row.count.to_string());
        return None;
    }
    let (kind, params) = (row.shape)(&params);
    checked(shape, kind, params, context)
}

fn names() -> impl Iterator<Item = &'static str> + Clone {
    // Of two names for one shape the standard's.
    let own = ROWS.iter().map(|row| row.name).filter(|name| *name != "trapezoidalShape");
    own.chain(["pointSetShape"])
}

fn refuse(shape: Element<'_, '_>, context: &mut Context<'_>) {
    let message = match shape.name().to_ascii_lowercase().as_str() {
        "circulardefinition" => "a set that is defined by others is not read",
        name if name.starts_with("custom") => "a function of one's own is never run",
        _ => "not known as a shape",
    };
    context.problem(shape.start(), shape.name(), message, known(names(), shape.name()));
}

/// Says which way a set with one side is read, for descriptions of the language differ.
fn sided(shape: Element<'_, '_>, row: &ShapeElement, before: bool, context: &mut Context<'_>) {
    let way = match row.name {
        "rightLinearShape" | "rightGaussianShape" => "rises to 1 and stays there",
        "leftLinearShape" | "leftGaussianShape" => "begins with 1 and falls",
        _ => return,
    };
    let whose = if before {
        "files from before the standard mean it"
    } else {
        "the standard's library has it"
    };
    let message = format!("`{}` {way}, as {whose}; other tools turn it round", shape.name());
    context.note_once(shape.start(), &message);
}

/// `param1`, `param2`, … up to the first that is missing.
fn parameters(shape: Element<'_, '_>, context: &mut Context<'_>) -> Option<Vec<f64>> {
    const NAMES: [&str; 4] = ["param1", "param2", "param3", "param4"];
    context.only(shape, &NAMES);
    let mut found = Vec::new();
    for name in NAMES.into_iter().take_while(|name| shape.attribute(name).is_some()) {
        found.push(context.number(shape, name)?);
    }
    Some(found)
}

/// Centre and width, as Zadeh has it.
fn pi(shape: Element<'_, '_>, params: &[f64], context: &mut Context<'_>) -> Option<Membership> {
    let &[centre, width] = params else { return None };
    let message =
        "`piShape` with two numbers is read as centre and width: 0 at one width from the centre";
    context.note_once(shape.start(), message);
    let sides = vec![centre - width, centre, centre, centre + width];
    checked(shape, ShapeKind::Pi, sides, context)
}

fn points(shape: Element<'_, '_>, context: &mut Context<'_>) -> Option<Membership> {
    context.only(shape, &["interpolationMethod", "degree"]);
    let method = shape.attribute("interpolationMethod").unwrap_or("linear");
    if !method.eq_ignore_ascii_case("linear") {
        let at = shape.place_of("interpolationMethod");
        context.problem(at, method, "this interpolation is not computed here", "`linear`");
        return None;
    }
    let mut params = Vec::new();
    for point in shape.children() {
        if !point.is("point") {
            context.refuse(point, shape.name(), &["point"]);
            return None;
        }
        context.only(point, &["x", "y"]);
        for name in ["x", "y"] {
            if point.attribute(name).is_none() {
                let expected = "`x` and `y`";
                context.problem(point.start(), "", "a point lacks a number", expected);
            }
            params.push(context.number(point, name)?);
        }
    }
    checked(shape, ShapeKind::Points, params, context)
}

/// The set, unless its parameters are refused; then at the one that is wrong.
fn checked(
    shape: Element<'_, '_>,
    kind: ShapeKind,
    params: Vec<f64>,
    context: &mut Context<'_>,
) -> Option<Membership> {
    let (kind, params) = narrow(kind, params);
    match kind.check(&params) {
        Ok(()) => Some(Membership::Shape { kind, params, height: 1.0 }),
        Err(FuzzyError::Parameter { name, found, allowed }) => {
            let message = format!("not allowed as `{name}` of {}", shape.name());
            context.problem(shape.start(), &crate::number::written(found), message, allowed);
            None
        }
        Err(error) => {
            context.problem(shape.start(), shape.name(), error.to_string(), "");
            None
        }
    }
}

/// Sets of no width are singletons.
fn narrow(kind: ShapeKind, params: Vec<f64>) -> (ShapeKind, Vec<f64>) {
    match (kind, &params[..]) {
        (ShapeKind::Triangle | ShapeKind::Trapezoid, &[first, ..])
            if params.iter().all(|value| value.to_bits() == first.to_bits()) =>
        {
            (ShapeKind::Singleton, vec![first])
        }
        _ => (kind, params),
    }
}

/// The element and numbers of a set, if the language has one that is just this.
pub(super) fn written(set: &Membership) -> Option<(&'static str, Vec<f64>)> {
    let Membership::Shape { kind, params, height } = set else { return None };
    if *height < 1.0 {
        return None;
    }
    let row = |name: &'static str| Some((name, params.clone()));
    match (*kind, &params[..]) {
        (ShapeKind::Triangle, _) => row("triangularShape"),
        (ShapeKind::Trapezoid, &[a, b, c, d]) => match (a.is_finite(), d.is_finite()) {
            (true, true) => row("trapezoidShape"),
            (false, true) => Some(("leftLinearShape", vec![c, d])),
            (true, false) => Some(("rightLinearShape", vec![a, b])),
            (false, false) => None,
        },
        (ShapeKind::Gaussian, _) => row("gaussianShape"),
        (ShapeKind::GaussianProduct, &[c, sigma, far, _]) if far >= FAR => {
            Some(("rightGaussianShape", vec![c, sigma]))
        }
        (ShapeKind::GaussianProduct, &[far, _, c, sigma]) if far <= -FAR => {
            Some(("leftGaussianShape", vec![c, sigma]))
        }
        (ShapeKind::LinearS, _) => row("rightLinearShape"),
        (ShapeKind::LinearZ, _) => row("leftLinearShape"),
        (ShapeKind::Ramp, &[start, end]) if start < end => row("rightLinearShape"),
        (ShapeKind::Ramp, &[start, end]) => Some(("leftLinearShape", vec![end, start])),
        (ShapeKind::Pi, _) => row("piShape"),
        (ShapeKind::SmoothS, _) => row("sShape"),
        (ShapeKind::SmoothZ, _) => row("zShape"),
        // An infinite end has no words.
        (ShapeKind::Rectangle, &[start, end]) if start.is_finite() && end.is_finite() => {
            row("rectangularShape")
        }
        (ShapeKind::Singleton, _) => row("singletonShape"),
        _ => None,
    }
}
