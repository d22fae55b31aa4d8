//! Which sets a dialect has words for.

use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::system::{Membership, Universe};

use crate::fcl::Dialect;
use crate::fit;
use crate::loss::Loss;
use crate::number::written as number;
use crate::vocabulary::shapes::{self, FUZZYLITE, JFUZZYLOGIC, ToolShape};

/// The words of a dialect.
fn rows(dialect: Dialect) -> &'static [ToolShape] {
    match dialect {
        Dialect::Iec => &[],
        Dialect::Fuzzylite => FUZZYLITE,
        Dialect::JFuzzyLogic => JFUZZYLOGIC,
    }
}

/// The text of a set, if the dialect has words for it.
pub(super) fn written(set: &Membership, dialect: Dialect) -> Option<String> {
    match set {
        Membership::Shape { kind, params, height } => singleton(*kind, params, *height)
            .or_else(|| by_word(*kind, params, *height, dialect))
            .or_else(|| by_points(*kind, params, *height)),
        Membership::Formula { formula, height } if dialect == Dialect::Fuzzylite => {
            let factor = (*height < 1.0).then(|| format!("{} * ", number(*height)));
            let text = formula.text();
            Some(match factor {
                Some(factor) => format!("Function {factor}({text})"),
                None => format!("Function {text}"),
            })
        }
        Membership::Formula { .. } => None,
    }
}

fn singleton(kind: ShapeKind, params: &[f64], height: f64) -> Option<String> {
    match params {
        &[value] if kind == ShapeKind::Singleton && !(height < 1.0) => Some(number(value)),
        _ => None,
    }
}

/// A word and numbers; in fuzzylite the height follows them. Points have their own way.
fn by_word(kind: ShapeKind, params: &[f64], height: f64, dialect: Dialect) -> Option<String> {
    if kind == ShapeKind::Points || (height < 1.0 && dialect != Dialect::Fuzzylite) {
        return None;
    }
    let row = shapes::of_kind(rows(dialect), kind)?;
    if dialect == Dialect::JFuzzyLogic && !shapes::needs_no_cut(kind, params) {
        return None;
    }
    // Half of a width among the smallest numbers loses its last bit: those words name another set.
    if row.ours(row.theirs(params)) != params {
        return None;
    }
    let height = (height < 1.0).then_some(height);
    let numbers = row.theirs(params).into_iter().chain(height).map(number);
    Some(format!("{} {}", row.word, numbers.collect::<Vec<_>>().join(" ")))
}

/// The corners of a piecewise-linear set.
fn by_points(kind: ShapeKind, params: &[f64], height: f64) -> Option<String> {
    let mut points: Vec<f64> = Vec::new();
    kind.vertices(params, &mut |vertex| {
        let point = [vertex.x, height * vertex.grade];
        // Corners that fall together are one; points stay as they are.
        if kind == ShapeKind::Points || !points.ends_with(&point) {
            points.extend(point);
        }
    });
    let fits = !points.is_empty() && ShapeKind::Points.check(&points).is_ok();
    fits.then(|| listed(&points))
}

fn listed(points: &[f64]) -> String {
    let pairs = points.chunks_exact(2).filter_map(|pair| match pair {
        &[x, grade] => Some(format!("({}, {})", number(x), number(grade))),
        _ => None,
    });
    pairs.collect::<Vec<_>>().join(" ")
}

/// Puts straight pieces in place of a set that the dialect has no words for, if losses are allowed.
pub(super) fn adapt(
    name: &str,
    set: &mut Membership,
    universe: Option<Universe>,
    dialect: Dialect,
    loss: &mut Loss,
) {
    if written(set, dialect).is_some() {
        return;
    }
    let Membership::Shape { kind, params, height } = &*set else {
        loss.cannot(name, no_words("a formula", dialect), "fuzzylite's dialect");
        return;
    };
    let Some(universe) = universe else {
        let expected = "another dialect, or a range over which it can be approximated";
        loss.cannot(name, no_words(kind.name(), dialect), expected);
        return;
    };
    let landmarks = fit::Landmarks::of(*kind, params);
    let grade = |x: f64| height * kind.grade(params, x);
    let fit = fit::fit(grade, universe.lower, universe.upper, &landmarks);
    let count = fit.points.len() / 2;
    let instead = format!(
        "{count} points with grades within {:.1e} of the curve, level beyond {} and {}",
        fit.error,
        number(universe.lower),
        number(universe.upper)
    );
    loss.lose(name, &no_words(kind.name(), dialect), &instead);
    *set = Membership::Shape { kind: ShapeKind::Points, params: fit.points, height: 1.0 };
}

/// Sets that are weighed are asked for the place of a grade, which points do not tell: another name of
/// the same set where the dialect has one.
pub(super) fn adapt_weighed(name: &str, set: &mut Membership, dialect: Dialect, loss: &mut Loss) {
    let Membership::Shape { kind, params, height } = &*set else {
        loss.cannot(name, no_words("a formula that is weighed", dialect), "numbers, or FLL");
        return;
    };
    let height = *height;
    let said = |kind, params: &[f64]| by_word(kind, params, height, dialect);
    let found = if said(*kind, params).is_some() {
        Some((*kind, params.clone()))
    } else {
        shapes::alias(*kind, params).filter(|(kind, params)| said(*kind, params).is_some())
    };
    let found = found.map(|(kind, params)| Membership::Shape { kind, params, height });
    match found.filter(crate::fll::is_monotone) {
        Some(found) => *set = found,
        None if singleton(*kind, params, height).is_some() => {}
        None => {
            let words = no_words(kind.name(), dialect);
            let message = format!("{words}, and points do not tell the place of a grade");
            loss.cannot(name, message, "fuzzylite's dialect, a .toml or .fll file");
        }
    }
}

fn no_words(what: &str, dialect: Dialect) -> String {
    format!("{what} has no words in the dialect of {}", dialect.name())
}
