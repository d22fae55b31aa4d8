//! A system seen along one or two of its inputs while the others stay where they are.

mod question;

use fspid_fuzzy::audit::SurfaceError;
use fspid_fuzzy::system::System;
use serde_json::{Value, json};

use crate::json::present;
use fspid_plot::{LineFigure, LinePanel, Series, SeriesStyle, Surface, SurfaceKind, Svg};
use fspid_scenario::supervisor::Refused;

use super::answer::Roughness;
use question::Asking;
pub(super) use question::spans;

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
    roughness: Roughness,
}

/// Evaluates a slice.
///
/// # Errors
/// [`Refused`] with everything that is wrong with the question.
pub fn slice<'a>(system: &'a System, question: &Question<'_>) -> Result<Slice<'a>, Refused> {
    if system.parts().formulas_name_outputs() {
        return Err(Refused::one(SurfaceError::Remembers.to_string()));
    }
    let mut asking = Asking { system, problems: Vec::new() };
    let slice = asking.slice(question);
    match slice {
        Some(slice) if asking.problems.is_empty() => Ok(slice.evaluated()),
        _ => Err(Refused::all(asking.problems)),
    }
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
            self.roughness.count(self.system, answers);
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

    /// What is to be known of values that the drawings and the tables do not say: which of them are hardly known.
    #[must_use]
    pub fn remarks(&self) -> Vec<String> {
        self.roughness.in_words(self.system, &self.outputs)
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
            axes => curve(title, name, axes, self, values),
        }
    }

    /// The answer for programs: the nodes along each input, where the others stay, and the values of each output, the
    /// first input running fastest; null where there is no answer, which the key `null` tells.
    #[must_use]
    pub fn json(&self) -> Value {
        let axis = |(input, nodes): &(usize, Vec<f64>)| json!({ "input": self.input_name(*input), "nodes": nodes });
        let fixed = |(input, value): &(usize, f64)| json!({ "input": self.input_name(*input), "value": value });
        let values = |(output, values): (&usize, &Vec<f64>)| {
            let values: Vec<Option<f64>> =
                values.iter().map(|value| Some(*value).filter(|it| it.is_finite())).collect();
            let worst = self.roughness.of(*output).map(|(_, bound)| bound);
            present(
                json!({ "output": self.output_name(*output), "values": values, "error_bound": worst }),
            )
        };
        let has_none = self.values.iter().flatten().any(|value| !value.is_finite());
        present(json!({
            "schema": 1,
            "null": has_none.then_some("the rules gave no finite answer there"),
            "axes": self.axes.iter().map(axis).collect::<Vec<_>>(),
            "fixed": self.fixed.iter().map(fixed).collect::<Vec<_>>(),
            "outputs": self.outputs.iter().zip(&self.values).map(values).collect::<Vec<_>>(),
        }))
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
            csv.push_str(&format!("{}\n", cells.join(",")));
        }
        csv
    }
}

fn curve(
    title: String,
    name: &str,
    axes: &[(usize, Vec<f64>)],
    slice: &Slice<'_>,
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
