//! The nearest system that the language can say.

use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::system::{
    Activation, Conclusion, Defuzzifier, FallbackValue, Input, Membership, Output, Parts,
    RuleBlock, SNorm, Sampling, SetReading, TNorm, Universe,
};
use fspid_fuzzy::{OutOfRange, SNormKind};

use super::Kind;
use crate::adapt::{TYPE_1, is_asked, numbered_fallback, reach, sampled, without_disabled_rules};
use crate::fit;
use crate::fml::shape;
use crate::fml::words::{S_NORMS, T_NORMS, word_of};
use crate::identifiers;
use crate::loss::Loss;
use crate::number::written as number;

const NAMES: identifiers::Rule = identifiers::Rule {
    readable: |name| !name.is_empty() && name.trim() == name && name.chars().all(is_text),
    documented: |_| true,
    description: "characters that XML has, no blank first or last",
};

/// A character that can stand in XML and comes back as itself.
pub(super) fn is_text(found: char) -> bool {
    !found.is_control() && !matches!(found, '\u{fffe}' | '\u{ffff}')
}

pub(super) fn adapted(parts: &Parts, loss: &mut Loss) -> Parts {
    let mut parts = parts.clone();
    NAMES.apply(&mut parts, loss);
    without_disabled_rules(&mut parts, loss);
    left_out(&mut parts, loss);
    parts.inputs.iter_mut().for_each(|found| input(found, loss));
    parts.outputs.iter_mut().for_each(|found| output(found, loss));
    added_up(&mut parts, loss);
    let kinds: Vec<Kind> = parts.outputs.iter().map(Kind::of).collect();
    parts.blocks.iter_mut().for_each(|found| block(found, &kinds, loss));
    parts
}

/// Descriptions, blocks that are switched off, characters that XML lacks.
fn left_out(parts: &mut Parts, loss: &mut Loss) {
    let before = parts.blocks.len();
    parts.blocks.retain(|block| block.enabled);
    if parts.blocks.len() < before {
        loss.note("rule blocks that are switched off are left out");
    }
    let variables = parts.inputs.iter_mut().map(|input| &mut input.description);
    let variables = variables.chain(parts.outputs.iter_mut().map(|o| &mut o.description));
    let blocks = parts.blocks.iter_mut().map(|block| &mut block.description);
    let mut described = false;
    for text in variables.chain(blocks).chain([&mut parts.description]) {
        described |= !text.is_empty();
        text.clear();
    }
    if described {
        loss.note("descriptions are left out");
    }
    let rules = parts.blocks.iter_mut().flat_map(|block| {
        let rules = block.rules.iter_mut().map(|rule| &mut rule.name);
        rules.chain([&mut block.name])
    });
    for name in rules.chain([&mut parts.name]) {
        let new: String = name.chars().map(|c| if is_text(c) { c } else { ' ' }).collect();
        let new = new.trim();
        if new != name {
            loss.note(format!("a name is written as `{new}`"));
            *name = new.to_owned();
        }
    }
}

fn enabled(name: &str, enabled: bool, loss: &mut Loss) {
    if !enabled {
        loss.cannot(name, "is switched off, which has no words in FML", "a variable that is on");
    }
}

fn input(input: &mut Input, loss: &mut Loss) {
    enabled(&input.name, input.enabled, loss);
    if input.out_of_range != OutOfRange::Evaluate {
        loss.lose(&input.name, "moves or refuses values outside its range", "it takes any value");
        input.out_of_range = OutOfRange::Evaluate;
    }
    if input.universe.is_none() {
        let range = reach(input);
        let written = format!("{} to {}", number(range.lower), number(range.upper));
        loss.lose(&input.name, "has no range, which the standard asks for", &written);
        input.universe = Some(range);
    }
    for term in &mut input.terms {
        let what = format!("{}.{}", input.name, term.name);
        set(&what, &mut term.membership, term.lower.as_ref(), input.universe, loss);
    }
}

/// True where the answer without a rule is a number outside of the range, in which readers of FML keep it.
fn has_default_outside(output: &Output) -> bool {
    match (output.fallback.value, output.universe) {
        (FallbackValue::Number(value), Some(range)) => {
            !(range.lower <= value && value <= range.upper)
        }
        _ => false,
    }
}

fn output(output: &mut Output, loss: &mut Loss) {
    enabled(&output.name, output.enabled, loss);
    sampled(output, loss, Sampling::Exact, |sampling| sampling == Sampling::Exact);
    numbered_fallback(output);
    if output.fallback.previous {
        loss.lose(&output.name, "keeps its answer where no rule fires", "its default alone");
        output.fallback.previous = false;
    }
    if output.clamp {
        match output.defuzzifier.sampling() {
            Some(_) if has_default_outside(output) => {
                loss.lose(&output.name, "its default lies outside of its range", "the end of it");
            }
            Some(_) => loss.note(format!("`{}`: an integral stays in its range", output.name)),
            None => loss.lose(&output.name, "its answer is limited to its range", "no limit"),
        }
        output.clamp = false;
    }
    match output.defuzzifier {
        Defuzzifier::WeightedSum(_) => {
            let expected = "`weighted-average`, or a .toml or .fll file";
            loss.cannot(&output.name, "a weighted sum has no words in FML", expected);
        }
        Defuzzifier::WeightedAverage(SetReading::InverseTsukamoto)
            if Kind::of(output) == Kind::Tsukamoto =>
        {
            let message = "sets that are asked for their grade at a strength have no words in FML";
            loss.cannot(&output.name, message, "a .toml or .fll file");
        }
        _ if output.defuzzifier.sampling().is_some() => joined(output, loss),
        _ => {}
    }
    terms(output, loss);
}

fn joined(output: &mut Output, loss: &mut Loss) {
    let name = output.name.clone();
    s_norm(&name, "accumulation", &mut output.aggregation, loss);
}

/// Weighted outputs have no accumulation in the language: a rule that asks one finds conclusions added up.
fn added_up(parts: &mut Parts, loss: &mut Loss) {
    let asked: Vec<bool> = (0..parts.outputs.len()).map(|index| is_asked(parts, index)).collect();
    for (output, asked) in parts.outputs.iter_mut().zip(asked) {
        let weighs = output.defuzzifier.sampling().is_none();
        if asked && weighs && !output.aggregation.is(SNormKind::UnboundedSum) {
            let message = "rules ask how strongly it was concluded, and how that is joined has no words in FML";
            loss.lose(&output.name, message, "the unbounded sum");
            output.aggregation = SNormKind::UnboundedSum.into();
        }
    }
}

fn terms(output: &mut Output, loss: &mut Loss) {
    let kind = Kind::of(output);
    for term in &mut output.terms {
        let what = format!("{}.{}", output.name, term.name);
        match &mut term.conclusion {
            // Points are not asked for the place of a grade.
            Conclusion::Set { membership, .. }
                if kind == Kind::Tsukamoto && shape::written(membership).is_none() =>
            {
                let message =
                    "this monotone set has no words in FML, and points cannot stand for it";
                loss.cannot(&what, message, "sides that are straight or smooth, of full height");
            }
            Conclusion::Set { membership, lower } => {
                set(&what, membership, lower.as_ref(), output.universe, loss);
            }
            Conclusion::Interval(_) => {
                loss.cannot(&what, "an interval has no words in FML", TYPE_1);
            }
            Conclusion::Formula(_) => {
                let expected = "a number or a plane";
                loss.cannot(&what, "a formula has no words in FML", expected);
            }
            Conclusion::Constant(_) | Conclusion::Linear { .. } if kind == Kind::Tsukamoto => {
                let message = "stands beside fuzzy sets, which FML keeps apart";
                loss.cannot(&what, message, "sets alone, or numbers alone");
            }
            Conclusion::Constant(_) | Conclusion::Linear { .. } => {}
        }
    }
}

/// Puts points in place of a set that the language has no element for: exactly where it is made of
/// straight pieces, else near it if losses are allowed.
fn set(
    what: &str,
    membership: &mut Membership,
    lower: Option<&Membership>,
    universe: Option<Universe>,
    loss: &mut Loss,
) {
    if lower.is_some() {
        loss.cannot(what, "a type-2 set has no words in FML", TYPE_1);
    }
    if shape::written(membership).is_some() || is_points(membership) {
        return;
    }
    let Membership::Shape { kind, params, height } = &*membership else {
        loss.cannot(what, "a formula has no words in FML", "a set with a shape");
        return;
    };
    if let Some(points) = straight(*kind, params, *height) {
        *membership = of_points(points);
        return;
    }
    let message = format!("{} has no words in FML", kind.name());
    let Some(universe) = universe else {
        loss.cannot(what, message, "a range over which it can be approximated");
        return;
    };
    let landmarks = fit::Landmarks::of(*kind, params);
    let grade = |x: f64| height * kind.grade(params, x);
    let fit = fit::fit(grade, universe.lower, universe.upper, &landmarks);
    let instead = format!(
        "{} points with grades within {:.1e} of the curve, level beyond {} and {}",
        fit.points.len() / 2,
        fit.error,
        number(universe.lower),
        number(universe.upper)
    );
    loss.lose(what, &message, &instead);
    *membership = of_points(fit.points);
}

fn of_points(params: Vec<f64>) -> Membership {
    Membership::Shape { kind: ShapeKind::Points, params, height: 1.0 }
}

fn is_points(set: &Membership) -> bool {
    matches!(set, Membership::Shape { kind: ShapeKind::Points, height, .. } if !(*height < 1.0))
}

/// The corners of a set of straight pieces.
fn straight(kind: ShapeKind, params: &[f64], height: f64) -> Option<Vec<f64>> {
    let mut points: Vec<f64> = Vec::new();
    kind.vertices(params, &mut |vertex| {
        let point = [vertex.x, height * vertex.grade];
        if !points.ends_with(&point) {
            points.extend(point);
        }
    });
    (!points.is_empty() && ShapeKind::Points.check(&points).is_ok()).then_some(points)
}

fn block(block: &mut RuleBlock, kinds: &[Kind], loss: &mut Loss) {
    let name = block.name.clone();
    if block.activation != Activation::General {
        let expected = "every rule to act, or a .toml or .fll file";
        loss.cannot(&name, "the activation method has no words in FML", expected);
    }
    s_norm(&name, "or", &mut block.or, loss);
    for (what, norm) in [("and", &block.and), ("implication", &block.implication)] {
        let known = matches!(norm, TNorm::Kind(kind) if word_of(T_NORMS, kind).is_some());
        if !known {
            let message = format!("`{what}` by a formula has no words in FML");
            loss.cannot(&name, message, "a norm with a name");
        }
    }
    let concluded = |rule: &fspid_fuzzy::system::Rule| {
        let own = rule.consequents.iter().filter_map(|found| kinds.get(found.output));
        own.copied().collect::<Vec<_>>()
    };
    let all: Vec<Kind> = block.rules.iter().flat_map(concluded).collect();
    let mixed = all.iter().any(|kind| Some(kind) != all.first());
    if mixed && block.rules.iter().any(|rule| rule.antecedent.asks_outputs()) {
        let message =
            "rules about sets and about numbers that ask about outputs keep no order in FML";
        loss.cannot(&name, message, "rule blocks of one kind");
    }
}

/// A norm without a word becomes the bounded sum, if losses are allowed.
fn s_norm(name: &str, what: &str, norm: &mut SNorm, loss: &mut Loss) {
    match norm {
        SNorm::Kind(kind) if word_of(S_NORMS, kind).is_some() => {}
        SNorm::Kind(kind) => {
            let message = format!("`{what}` by {} has no words in FML", kind.name());
            loss.lose(name, &message, "`BSUM`, the bounded sum");
            *norm = SNormKind::BoundedSum.into();
        }
        SNorm::Formula(_) => {
            let message = format!("`{what}` by a formula has no words in FML");
            loss.cannot(name, message, "a norm with a name");
        }
    }
}
