//! A system seen along one or two of its inputs while the others stay where they are.

use std::fmt::Write as _;

use fspid_fuzzy::system::{Input, Membership, System, Universe};

use super::answer::named;
use crate::figure::{LineFigure, LinePanel, Series, SeriesStyle, Surface, SurfaceKind, Svg};
use crate::file::problem::nearest;
use crate::inference::Refused;

/// Nodes along each input of a surface.
const NODES: usize = 81;
/// Points of a curve.
const POINTS: usize = 401;
/// Most nodes along an input.
const MOST_NODES: usize = 1001;

/// Which part of a system is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Question<'a> {
    /// The input to the right; the first that is free if left out.
    pub x: Option<&'a str>,
    /// The input to the back; the next that is free if left out.
    pub y: Option<&'a str>,
    /// Values of other inputs, `name=value`; the middle of their ranges if left out.
    pub fixed: &'a [String],
    /// Ranges to draw over, `name=lower..upper`; those of the file if left out.
    pub spans: &'a [String],
    /// The output; all of them if left out.
    pub output: Option<&'a str>,
    /// Nodes along each input.
    pub nodes: Option<usize>,
}

/// A slice that was evaluated.
#[derive(Clone, Debug)]
pub struct Slice<'a> {
    system: &'a System,
    /// One or two inputs, with their nodes.
    axes: Vec<(usize, Vec<f64>)>,
    /// Values of the other inputs.
    fixed: Vec<(usize, f64)>,
    outputs: Vec<usize>,
    /// For each output its values, the first axis running fastest; NaN where there is no answer.
    values: Vec<Vec<f64>>,
}

/// Evaluates a slice.
///
/// # Errors
/// [`Refused`] with everything that is wrong with the question.
pub fn slice<'a>(system: &'a System, question: &Question<'_>) -> Result<Slice<'a>, Refused> {
    let mut asking = Asking { system, problems: Vec::new() };
    let slice = asking.slice(question);
    match slice {
        Some(slice) if asking.problems.is_empty() => Ok(slice.evaluated()),
        _ => Err(Refused::all(asking.problems)),
    }
}

struct Asking<'a> {
    system: &'a System,
    problems: Vec<String>,
}

impl<'a> Asking<'a> {
    fn slice(&mut self, question: &Question<'_>) -> Option<Slice<'a>> {
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
        let count = question.nodes.unwrap_or(if chosen.len() == 1 { POINTS } else { NODES });
        if !(2..=MOST_NODES).contains(&count) {
            self.problems.push(format!("--nodes is {count}; allowed is 2 to {MOST_NODES}"));
            return None;
        }
        let mut axes = Vec::new();
        for &input in &chosen {
            if !is_free(&input) {
                let name = parts.inputs.get(input).map_or("", |input| input.name.as_str());
                self.problems.push(format!("{name} is drawn along, so it cannot be fixed"));
            }
            axes.extend(self.span(input, &spans).map(|span| (input, nodes(span, count))));
        }
        let mut fixed = Vec::new();
        for (input, value) in given.iter().enumerate().filter(|(n, _)| !chosen.contains(n)) {
            let value = value.or_else(|| self.span(input, &spans).map(|span| span.middle()));
            fixed.extend(value.map(|value| (input, value)));
        }
        let outputs = self.outputs(question.output);
        Some(Slice { system: self.system, axes, fixed, outputs, values: Vec::new() })
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
            let meant = nearest(name, known).map(|meant| format!("; did you mean {meant}?"));
            let meant = meant.unwrap_or_default();
            let known = known.join(", ");
            self.problems.push(format!("there is no {what} `{name}`{meant} known are {known}"));
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
pub(super) fn spans(
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

impl Slice<'_> {
    fn evaluated(mut self) -> Self {
        let inputs = self.system.parts().inputs.len();
        let mut values = vec![Vec::new(); self.outputs.len()];
        let mut workspace = self.system.workspace();
        for point in self.points() {
            let mut row = vec![0.0; inputs];
            let drawn = self.axes.iter().map(|axis| axis.0).zip(point);
            for (input, value) in drawn.chain(self.fixed.iter().copied()) {
                if let Some(place) = row.get_mut(input) {
                    *place = value;
                }
            }
            let answers = self.system.evaluate(&row, &mut workspace).unwrap_or_default();
            for (values, output) in values.iter_mut().zip(&self.outputs) {
                let answer = answers.get(*output).and_then(|answer| answer.value);
                values.push(answer.unwrap_or(f64::NAN));
            }
        }
        self.values = values;
        self
    }

    /// The nodes of the grid, the first axis running fastest.
    fn points(&self) -> Vec<Vec<f64>> {
        match self.axes.as_slice() {
            [(_, xs)] => xs.iter().map(|x| vec![*x]).collect(),
            [(_, xs), (_, ys)] => ys.iter().flat_map(|y| xs.iter().map(|x| vec![*x, *y])).collect(),
            _ => Vec::new(),
        }
    }

    fn input_name(&self, input: usize) -> &str {
        self.system.parts().inputs.get(input).map_or("", |input| input.name.as_str())
    }

    fn output_name(&self, output: usize) -> &str {
        self.system.parts().outputs.get(output).map_or("", |output| output.name.as_str())
    }

    /// What stays where it is: `food = 5, wine = 3`; empty if nothing does.
    #[must_use]
    pub fn fixed_in_words(&self) -> String {
        let pair = |(input, value): &(usize, f64)| format!("{} = {value}", self.input_name(*input));
        self.fixed.iter().map(pair).collect::<Vec<_>>().join(", ")
    }

    /// A figure for each output, with its name: a surface over two inputs, a curve over one.
    #[must_use]
    pub fn figures(&self) -> Vec<(&str, Svg)> {
        let figure = |(output, values): (&usize, &Vec<f64>)| {
            let name = self.output_name(*output);
            (name, self.figure(name, values))
        };
        self.outputs.iter().zip(&self.values).map(figure).collect()
    }

    fn figure(&self, name: &str, values: &[f64]) -> Svg {
        let fixed = self.fixed_in_words();
        let title = if fixed.is_empty() { name.to_owned() } else { format!("{name} at {fixed}") };
        match self.axes.as_slice() {
            [(x, xs), (y, ys)] => {
                let surface = Surface {
                    title,
                    x_label: self.input_name(*x).to_owned(),
                    y_label: self.input_name(*y).to_owned(),
                    z_label: name.to_owned(),
                    xs: xs.clone(),
                    ys: ys.clone(),
                    values: values.chunks(xs.len().max(1)).map(<[f64]>::to_vec).collect(),
                    limit: None,
                };
                surface.render(SurfaceKind::Relief)
            }
            axes => curve(title, name, (axes, self), values),
        }
    }

    /// The grid as CSV: the inputs that are drawn along, then the outputs.
    #[must_use]
    pub fn csv(&self) -> String {
        let drawn = self.axes.iter().map(|axis| self.input_name(axis.0));
        let names = drawn.chain(self.outputs.iter().map(|output| self.output_name(*output)));
        let mut csv = names.map(crate::rows::quoted).collect::<Vec<_>>().join(",");
        csv.push('\n');
        for (index, point) in self.points().iter().enumerate() {
            let answers = self.values.iter().map(|values| values.get(index).copied());
            let cells = point.iter().copied().map(Some).chain(answers);
            let cells: Vec<String> = cells
                .map(|cell| {
                    cell.filter(|x| !x.is_nan()).map_or(String::new(), |x| format!("{x:?}"))
                })
                .collect();
            // Writing to a string cannot fail.
            let _ = writeln!(csv, "{}", cells.join(","));
        }
        csv
    }
}

fn curve(
    title: String,
    name: &str,
    (axes, slice): (&[(usize, Vec<f64>)], &Slice<'_>),
    values: &[f64],
) -> Svg {
    let (input, xs) = axes.first().map_or((0, [].as_slice()), |(n, xs)| (*n, xs.as_slice()));
    let series = Series {
        name: String::new(),
        style: SeriesStyle::Numbered(0),
        x: xs.to_vec(),
        y: values.to_vec(),
        stairs: false,
    };
    let panel = LinePanel {
        y_label: name.to_owned(),
        x_label: slice.input_name(input).to_owned(),
        series: vec![series],
        ..LinePanel::default()
    };
    LineFigure { title, panels: vec![panel], width_px: 720.0 }.render()
}
