//! What a question about a slice means: which inputs are drawn along, which stay where.

use fspid_fuzzy::system::{Input, Membership, System, Universe};

use super::{Question, Slice};
use crate::fuzzy_system::answer::{Roughness, check, named};
use fspid_diagnostics::known_words;
use fspid_scenario::count;

/// Nodes along each input of a surface.
const NODES: usize = 81;
/// Points of a curve.
const POINTS: usize = 401;

/// Collects what is wrong with a question.
pub(super) struct Asking<'a> {
    pub(super) system: &'a System,
    pub(super) problems: Vec<String>,
}

impl<'a> Asking<'a> {
    /// The slice, not yet evaluated.
    pub(super) fn slice(&mut self, question: &Question<'_>) -> Option<Slice<'a>> {
        let parts = self.system.parts();
        let given = named(self.system, question.fixed, &mut self.problems);
        let spans = self.spans(question.spans);
        let is_free = |input: &usize| given.get(*input).is_some_and(Option::is_none);
        let (x, y) = (self.input(question.x), self.input(question.y));
        let mut free =
            (0..parts.inputs.len()).filter(|n| is_free(n) && ![x, y].contains(&Some(*n)));
        let x = x.or_else(|| free.next());
        let y = y.or_else(|| free.next());
        let chosen: Vec<usize> = x.into_iter().chain(y).collect();
        if chosen.is_empty() {
            self.problems.push("every input is fixed; leave one or two of them free".to_owned());
        }
        if x.is_some() && x == y {
            self.problems.push("--x and --y name the same input".to_owned());
        }
        let nodes_along = question.nodes.unwrap_or(if chosen.len() == 1 { POINTS } else { NODES });
        if let Err(error) = count::NODES.check(nodes_along) {
            self.problems.push(error.to_string());
            return None;
        }
        let mut axes = Vec::new();
        for &input in &chosen {
            if !is_free(&input) {
                let name = parts.inputs.get(input).map_or("", |input| input.name.as_str());
                self.problems.push(format!("{name} is drawn along, so it cannot be fixed"));
            }
            axes.extend(self.span(input, &spans).map(|span| (input, nodes(span, nodes_along))));
        }
        let mut fixed = Vec::new();
        for (input, value) in given.iter().enumerate().filter(|(n, _)| !chosen.contains(n)) {
            let value = value.or_else(|| self.span(input, &spans).map(|span| span.middle()));
            let asked = self.system.parts().inputs.get(input).zip(value);
            self.problems.extend(asked.and_then(|(input, value)| check(input, value).err()));
            fixed.extend(value.map(|value| (input, value)));
        }
        let outputs = self.outputs(question.output);
        Some(Slice {
            system: self.system,
            axes,
            fixed,
            outputs,
            values: Vec::new(),
            roughness: Roughness::default(),
        })
    }

    /// The position of an input by its name.
    fn input(&mut self, name: Option<&str>) -> Option<usize> {
        let name = name?;
        let known: Vec<&str> = self.system.parts().inputs.iter().map(|i| i.name.as_str()).collect();
        self.position("input", name, &known)
    }

    fn outputs(&mut self, name: Option<&str>) -> Vec<usize> {
        let outputs = &self.system.parts().outputs;
        let known: Vec<&str> = outputs.iter().map(|output| output.name.as_str()).collect();
        match name {
            Some(name) => self.position("output", name, &known).into_iter().collect(),
            None => (0..known.len()).collect(),
        }
    }

    fn position(&mut self, what: &str, name: &str, known: &[&str]) -> Option<usize> {
        let found = known.iter().position(|known| *known == name);
        if found.is_none() {
            let known = known_words(name, known);
            self.problems.push(format!("there is no {what} `{name}`{known}"));
        }
        found
    }

    /// The ranges that are given, by input.
    fn spans(&mut self, texts: &[String]) -> Vec<(usize, Universe)> {
        let mut spans = Vec::new();
        for text in texts {
            let parts = text.rsplit_once('=').and_then(|(name, ends)| {
                let (lower, upper) = ends.split_once("..")?;
                let ends = (lower.trim().parse().ok()?, upper.trim().parse().ok()?);
                Some((name.trim(), Universe { lower: ends.0, upper: ends.1 }))
            });
            match parts {
                Some((name, span)) if span.lower < span.upper && span.span().is_finite() => {
                    spans.extend(self.input(Some(name)).map(|input| (input, span)));
                }
                _ => self.problems.push(format!("`{text}` is no range; write NAME=LOWER..UPPER")),
            }
        }
        spans
    }

    /// The range over which an input is drawn.
    fn span(&mut self, input: usize, spans: &[(usize, Universe)]) -> Option<Universe> {
        let given = spans.iter().find(|(of, _)| *of == input).map(|(_, span)| *span);
        let part = self.system.parts().inputs.get(input)?;
        let found = given.or(part.universe).or_else(|| extent(part));
        if found.is_none() {
            let name = &part.name;
            self.problems.push(format!("{name} has no range; add --span {name}=LOWER..UPPER"));
        }
        found
    }
}

/// The range of each input: as given, `name=lower..upper`, or that of the file.
pub(in crate::fuzzy_system) fn spans(
    system: &System,
    given: &[String],
    problems: &mut Vec<String>,
) -> Vec<Universe> {
    let mut asking = Asking { system, problems: Vec::new() };
    let given = asking.spans(given);
    let inputs = 0..system.parts().inputs.len();
    let spans = inputs.filter_map(|input| asking.span(input, &given)).collect();
    problems.append(&mut asking.problems);
    spans
}

/// From the first to the last corner of an input's sets.
fn extent(input: &Input) -> Option<Universe> {
    let (mut lower, mut upper) = (f64::INFINITY, f64::NEG_INFINITY);
    for term in &input.terms {
        if let Membership::Shape { kind, params, .. } = &term.membership {
            kind.corners(params, &mut |x| {
                lower = lower.min(if x.is_finite() { x } else { lower });
                upper = upper.max(if x.is_finite() { x } else { upper });
            });
        }
    }
    (lower < upper).then_some(Universe { lower, upper })
}

fn nodes(span: Universe, count: usize) -> Vec<f64> {
    let last = count.saturating_sub(1).max(1);
    let at = |n: usize| {
        let part = n as f64 / last as f64;
        if n == last { span.upper } else { span.lower + span.span() * part }
    };
    (0..count).map(at).collect()
}
