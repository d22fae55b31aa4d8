//! Functions that a system's program calls: shapes, norms and hedges, each asked of its equation in `fspid-fuzzy`.

use fspid_fuzzy::hedge::Hedge;
use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::system::{SNorm, TNorm};
use fspid_numeric::Real;
use fspid_numeric::scalar::Scalar;

use super::Trouble;
use super::root;
use crate::compose::{exponential, precision_of};
use crate::program::{
    Argument, Expression, Function, Kind, Parameter, Precision, Statement, local, number,
};
use crate::trace::{Listing, Traced};

/// The functions that have been asked for, each once.
#[derive(Default)]
pub(super) struct Library {
    pub(super) functions: Vec<Function>,
}

/// The positions of the parameters that a shape's function takes: an end at infinity makes it another function, which
/// does not ask for that side.
pub(super) fn used(kind: ShapeKind, params: &[f64]) -> Vec<usize> {
    let left = params.first().is_none_or(|value| value.is_finite());
    let right = params.last().is_none_or(|value| value.is_finite());
    let half = params.len() / 2;
    match kind {
        ShapeKind::Trapezoid | ShapeKind::Rectangle => {
            let of_left = (0..half).filter(|_| left);
            of_left.chain((half..params.len()).filter(|_| right)).collect()
        }
        _ => (0..params.len()).collect(),
    }
}

impl Library {
    fn has(&self, name: &str) -> bool {
        self.functions.iter().any(|function| function.name == name)
    }

    /// Adds a function that is an equation, and those that it calls.
    fn traced<R: Real>(
        &mut self,
        name: &'static str,
        doc: &'static str,
        parameters: &[&'static str],
        equation: impl FnOnce() -> Option<Traced>,
    ) -> Result<&'static str, Trouble> {
        if self.has(name) {
            return Ok(name);
        }
        let mut listing = Listing::new(precision_of::<R>());
        let value = equation().ok_or(Trouble::Foreign("an inverse"))?;
        if let Some(foreign) = listing.foreign() {
            return Err(Trouble::Foreign(foreign));
        }
        let mut body = listing.values(&[("outcome", value)]);
        body.push(Statement::Return(Some(local("outcome"))));
        self.helpers::<R>(&body);
        let real = |name: &&'static str| Parameter { name, kind: Kind::Real, written: false };
        self.functions.push(Function {
            name,
            doc,
            parts: &[],
            parameters: parameters.iter().map(real).collect(),
            answers: Some(Kind::Real),
            body,
        });
        Ok(name)
    }

    /// Adds what statements call.
    pub(super) fn helpers<R: Real>(&mut self, body: &[Statement]) {
        let text = format!("{body:?}");
        if text.contains("Call(\"exponential\"") && !self.has("exponential") {
            self.functions.insert(0, exponential::function::<R>());
        }
        if text.contains("Call(\"square_root\"") {
            self.square_root::<R>();
        }
    }

    pub(super) fn square_root<R: Real>(&mut self) {
        if !self.has("square_root") {
            self.functions.insert(0, root::function(precision_of::<R>()));
        }
    }

    /// The grade of a value in a set; `params` are read where they stand.
    pub(super) fn grade<R: Real>(
        &mut self,
        (kind, params): (ShapeKind, &[f64]),
        given: Vec<Expression>,
        x: Expression,
    ) -> Result<Expression, Trouble> {
        let Some(name) = shape_function(kind, params)? else { return Ok(number(1.0)) };
        let names = names_of(kind, params);
        let mut parameters = vec!["x"];
        parameters.extend(used(kind, params).into_iter().map(|position| names[position]));
        let equation = || Some(kind.grade(&lifted(kind, params), Traced::read(local("x"))));
        let name =
            self.traced::<R>(name, "Grade of a value in a fuzzy set.", &parameters, equation);
        let name = name.map_err(|trouble| trouble.of("the membership function", kind.name()))?;
        Ok(called(name, [x].into_iter().chain(given)))
    }

    /// Where a strictly rising or falling set has a grade.
    pub(super) fn inverse<R: Real>(
        &mut self,
        (kind, params): (ShapeKind, &[f64]),
        given: Vec<Expression>,
        grade: Expression,
    ) -> Result<Expression, Trouble> {
        let name = inverse_name(kind).ok_or(Trouble::Foreign("an inverse"));
        let mut parameters = vec!["grade"];
        let names = names_of(kind, params);
        parameters.extend(names.iter().copied());
        let equation = || kind.inverse(&lifted(kind, params), Traced::read(local("grade")));
        let doc = "The value that has a grade in a rising or falling fuzzy set.";
        let name = name.and_then(|name| self.traced::<R>(name, doc, &parameters, equation));
        let name = name.map_err(|trouble| trouble.of("the inverse of", kind.name()))?;
        Ok(called(name, [grade].into_iter().chain(given)))
    }

    /// Two grades joined by an *and*.
    pub(super) fn t_norm<R: Real>(
        &mut self,
        norm: &TNorm,
        left: Expression,
        right: Expression,
    ) -> Result<Expression, Trouble> {
        let TNorm::Kind(kind) = norm else { return Err(Trouble::Formula) };
        let equation = || Some(kind.apply(Traced::read(local("a")), Traced::read(local("b"))));
        let name = underscored(kind.name());
        let name = self.traced::<R>(name, "Both of two grades.", &["a", "b"], equation)?;
        Ok(called(name, [left, right]))
    }

    /// Two grades joined by an *or*.
    pub(super) fn s_norm<R: Real>(
        &mut self,
        norm: &SNorm,
        left: Expression,
        right: Expression,
    ) -> Result<Expression, Trouble> {
        let SNorm::Kind(kind) = norm else { return Err(Trouble::Formula) };
        let equation = || Some(kind.apply(Traced::read(local("a")), Traced::read(local("b"))));
        let name = underscored(kind.name());
        let name = self.traced::<R>(name, "Either of two grades.", &["a", "b"], equation)?;
        Ok(called(name, [left, right]))
    }

    /// The larger of two numbers, as `maximum` says it.
    pub(super) fn larger<R: Real>(
        &mut self,
        left: Expression,
        right: Expression,
    ) -> Result<Expression, Trouble> {
        self.s_norm::<R>(&fspid_fuzzy::SNormKind::Maximum.into(), left, right)
    }

    /// A grade after hedges, the last of which acts first.
    pub(super) fn hedged<R: Real>(
        &mut self,
        hedges: &[Hedge],
        grade: Expression,
    ) -> Result<Expression, Trouble> {
        hedges.iter().rev().try_fold(grade, |grade, hedge| {
            if *hedge == Hedge::Any {
                return Ok(number(1.0));
            }
            let doc = "A grade after a hedge.";
            let name = if *hedge == Hedge::Not { "complement" } else { hedge.name() };
            let equation = || Some(hedge.apply(Traced::read(local("grade"))));
            let name = self.traced::<R>(name, doc, &["grade"], equation);
            let name = name.map_err(|trouble| trouble.of("the hedge", hedge.name()))?;
            Ok(called(name, [grade]))
        })
    }
}

/// A call with values.
pub(super) fn called(
    name: &'static str,
    given: impl IntoIterator<Item = Expression>,
) -> Expression {
    Expression::Call(name, given.into_iter().map(Argument::Value).collect())
}

/// Parameters as the function reads them.
fn lifted(kind: ShapeKind, params: &[f64]) -> Vec<Traced> {
    let (names, used) = (names_of(kind, params), used(kind, params));
    let lift = |(position, value): (usize, &f64)| match used.contains(&position) {
        true => Traced::read(local(names[position])),
        false => Traced::constant(*value),
    };
    params.iter().enumerate().map(lift).collect()
}

/// Functions of sets given by points, by how many there are, with the names of their parameters.
const POINTS: [[&str; 3]; 12] = [
    ["points_1", "at_1", "grade_1"],
    ["points_2", "at_2", "grade_2"],
    ["points_3", "at_3", "grade_3"],
    ["points_4", "at_4", "grade_4"],
    ["points_5", "at_5", "grade_5"],
    ["points_6", "at_6", "grade_6"],
    ["points_7", "at_7", "grade_7"],
    ["points_8", "at_8", "grade_8"],
    ["points_9", "at_9", "grade_9"],
    ["points_10", "at_10", "grade_10"],
    ["points_11", "at_11", "grade_11"],
    ["points_12", "at_12", "grade_12"],
];

/// The names of a shape's parameters, as every language takes them.
fn names_of(kind: ShapeKind, params: &[f64]) -> Vec<&'static str> {
    if kind.repeats() {
        return POINTS.iter().flat_map(|[_, at, grade]| [*at, *grade]).take(params.len()).collect();
    }
    let name = |name| if name == "end" { "last" } else { name };
    kind.params().iter().map(|param| name(param.name)).collect()
}

/// The function of a shape; nothing for one that holds everything.
fn shape_function(kind: ShapeKind, params: &[f64]) -> Result<Option<&'static str>, Trouble> {
    if kind.repeats() {
        let function = POINTS.get((params.len() / 2).saturating_sub(1));
        return function.map(|[name, ..]| Some(*name)).ok_or(Trouble::Said(
            "a set has more than twelve points",
            "possible are twelve, or several sets",
        ));
    }
    let used = used(kind, params);
    let has_left = used.first() == Some(&0);
    Ok(match (kind, used.len() == params.len()) {
        (_, true) => Some(underscored(kind.name())),
        _ if used.is_empty() => None,
        (ShapeKind::Trapezoid, _) => Some(if has_left { "rising_side" } else { "falling_side" }),
        _ => Some(if has_left { "at_least" } else { "at_most" }),
    })
}

/// A name of a family, as every language takes it.
fn underscored(name: &'static str) -> &'static str {
    match name {
        "gaussian-product" => "gaussian_product",
        "linear-s" => "linear_s",
        "linear-z" => "linear_z",
        "semi-ellipse" => "semi_ellipse",
        "sigmoid-difference" => "sigmoid_difference",
        "sigmoid-product" => "sigmoid_product",
        "smooth-s" => "smooth_s",
        "smooth-z" => "smooth_z",
        // What a controller does in a sample is called so.
        "step" => "threshold_step",
        "algebraic-product" => "algebraic_product",
        "algebraic-sum" => "algebraic_sum",
        "bounded-difference" => "bounded_difference",
        "bounded-sum" => "bounded_sum",
        "drastic-product" => "drastic_product",
        "drastic-sum" => "drastic_sum",
        "einstein-product" => "einstein_product",
        "einstein-sum" => "einstein_sum",
        "hamacher-product" => "hamacher_product",
        "hamacher-sum" => "hamacher_sum",
        "nilpotent-minimum" => "nilpotent_minimum",
        "nilpotent-maximum" => "nilpotent_maximum",
        "normalized-sum" => "normalized_sum",
        "unbounded-sum" => "unbounded_sum",
        // The others have no hyphen; a test walks over all of them.
        other => other,
    }
}

fn inverse_name(kind: ShapeKind) -> Option<&'static str> {
    Some(match kind {
        ShapeKind::Arc => "inverse_arc",
        ShapeKind::Concave => "inverse_concave",
        ShapeKind::LinearS => "inverse_linear_s",
        ShapeKind::LinearZ => "inverse_linear_z",
        ShapeKind::Ramp => "inverse_ramp",
        ShapeKind::Sigmoid => "inverse_sigmoid",
        ShapeKind::SmoothS => "inverse_smooth_s",
        ShapeKind::SmoothZ => "inverse_smooth_z",
        _ => return None,
    })
}

/// The precision's smallest normal number.
pub(super) const fn least(precision: Precision) -> f64 {
    match precision {
        Precision::Single => f32::MIN_POSITIVE as f64,
        Precision::Double => f64::MIN_POSITIVE,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fspid_fuzzy::{SNormKind, TNormKind};

    #[test]
    fn every_member_of_the_families_is_a_function_of_a_good_name_or_asks_for_the_platform() {
        let mut library = Library::default();
        let mut refused = Vec::new();
        for kind in ShapeKind::ALL {
            let given = kind.example().iter().map(|value| number(*value)).collect();
            let grade = library.grade::<f64>((*kind, kind.example()), given, number(0.0));
            if let Err(Trouble::Asks(_, function)) = grade {
                refused.push((kind.name(), function));
            }
            let given = kind.example().iter().map(|value| number(*value)).collect();
            let _ = library.inverse::<f64>((*kind, kind.example()), given, number(0.5));
        }
        assert_eq!(refused, [("bell", "pow"), ("cosine", "cos")]);
        for kind in TNormKind::ALL {
            assert!(library.t_norm::<f64>(&(*kind).into(), number(0.0), number(1.0)).is_ok());
        }
        for kind in SNormKind::ALL {
            assert!(library.s_norm::<f64>(&(*kind).into(), number(0.0), number(1.0)).is_ok());
        }
        for hedge in Hedge::NAMED {
            assert!(library.hedged::<f64>(&[*hedge], number(0.5)).is_ok());
        }
        assert!(library.hedged::<f64>(&[Hedge::Power(3.0)], number(0.5)).is_err());
        let good = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
        for function in &library.functions {
            assert!(function.name.chars().all(good), "{}", function.name);
            // What a controller does in a sample is called so.
            assert!(!["step", "reset", "hold", "infer"].contains(&function.name));
        }
    }
}
