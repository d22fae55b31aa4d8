//! Whether a system is one that a supervisor with numbers can fly, and its numbers.

use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::norm::TNormKind;
use fspid_fuzzy::system::{
    Activation, Antecedent, Conclusion, Defuzzifier, Input, Membership, Output, Parts, Rule,
    RuleBlock, Term, Variable,
};
use fspid_fuzzy::{LABEL_COUNT, Label, NumberGrid};

/// How far a centre or a foot may be from its place, in ranges: what printing ten digits leaves.
const SAME_PLACE: f64 = 1e-9;
/// Names of the inputs.
const INPUTS: [&str; 2] = ["error", "change"];
/// Digits of the range that are shown.
const SHOWN_DIGITS: i32 = 4;
/// Most digits behind the point.
const MOST_DIGITS: i32 = 17;
/// Most cells that a message names.
const MOST_CELLS: usize = 3;

/// The numbers of a system.
#[derive(Clone, Debug, PartialEq)]
pub struct Numbers {
    /// Where the outermost sets have their centres.
    pub range: f64,
    /// The numbers, in the order of [`fspid_fuzzy::Output::ALL`].
    pub grids: [NumberGrid<f64>; 3],
}

impl Numbers {
    /// A line for each grid with numbers beyond a range: such numbers no supervisor of that range flies.
    #[must_use]
    pub fn beyond(&self, range: f64) -> Vec<String> {
        let largest = |grid: &NumberGrid<f64>| {
            grid.as_flattened().iter().fold(0.0, |most: f64, number| most.max(number.abs()))
        };
        let line = |(output, grid): (fspid_fuzzy::Output, &NumberGrid<f64>)| {
            let (name, largest) = (output.name(), largest(grid));
            let told =
                || format!("{name} has numbers up to {largest:?}, beyond the range of {range:?}");
            (!is_within(largest, range)).then(told)
        };
        fspid_fuzzy::Output::ALL.into_iter().zip(&self.grids).filter_map(line).collect()
    }

    /// The grids as a supervisor of this range takes them: what printing put a trace beyond the range is at its
    /// end. Numbers that are further away stay there, and [`beyond`](Self::beyond) tells them.
    #[must_use]
    pub fn grids_within(&self, range: f64) -> [NumberGrid<f64>; 3] {
        self.grids.map(|grid| grid.map(|row| row.map(|number| at_most(number, range))))
    }

    /// The numbers as a scenario takes them in `[controller.supervisor]`, rounded to what can be seen in a flight
    /// and, where they lie within the range, not past it.
    #[must_use]
    pub fn toml(&self) -> String {
        let mut out = format!("range = {:?}\n", self.range);
        for (output, grid) in fspid_fuzzy::Output::ALL.into_iter().zip(&self.grids) {
            out.push_str(&format!("numbers.{} = [\n", output.name()));
            let texts = grid.map(|row| row.map(|number| self.shown(number)));
            let width = texts.as_flattened().iter().map(String::len).max().unwrap_or(0);
            for row in texts {
                out.push_str(&format!(
                    "  [{}],\n",
                    row.map(|text| format!("{text:>width$}")).join(", ")
                ));
            }
            out.push_str("]\n");
        }
        out
    }

    /// A number rounded to the digits that the range asks for; all of its digits where they are too many for
    /// decimals.
    fn shown(&self, number: f64) -> String {
        let number = at_most(number, self.range);
        let digits = SHOWN_DIGITS - libm::ceil(libm::log10(self.range)) as i32;
        if digits > MOST_DIGITS {
            return format!("{number:?}");
        }
        let digits = digits.max(1) as usize;
        let text = format!("{number:.digits$}");
        let is_past = text.parse().is_ok_and(|rounded: f64| rounded.abs() > self.range);
        match is_past && number.abs() <= self.range {
            true => format!("{number:?}"),
            false => text,
        }
    }

    /// The range and the three grids, as they are.
    #[must_use]
    pub fn json(&self) -> serde_json::Value {
        let [kp, ki, kd] = &self.grids;
        serde_json::json!({ "range": self.range, "delta_kp": kp, "delta_ki": ki, "delta_kd": kd })
    }
}

/// Whether a number is within a range that was printed and read again.
fn is_within(number: f64, range: f64) -> bool {
    number.abs() <= range * (1.0 + SAME_PLACE)
}

/// A number a trace beyond the range at its end; every other as it is.
fn at_most(number: f64, range: f64) -> f64 {
    if is_within(number, range) { number.clamp(-range, range) } else { number }
}

/// The numbers of a system of Takagi and Sugeno of order zero that is what a
/// [`NumberTable`](fspid_fuzzy::NumberTable) describes.
///
/// Its inputs are `error` and `change`, in any order, each with seven triangles that reach from neighbour to
/// neighbour, evenly over a range around zero, the outermost of which may be level outwards; its outputs are `delta_kp`, `delta_ki` and `delta_kd`. One block of
/// rules joins them by products, one rule or several for each of the 49 cells, with a number for each output.
/// Beyond the range the system is not looked at.
///
/// # Errors
/// Everything in which it differs, a sentence each.
pub fn numbers_of(parts: &Parts) -> Result<Numbers, Vec<String>> {
    let mut told = Vec::new();
    let inputs = named(&mut told, "input", &parts.inputs, &INPUTS, |input| input.name.as_str());
    let names = fspid_fuzzy::Output::ALL.map(fspid_fuzzy::Output::name);
    let outputs = named(&mut told, "output", &parts.outputs, &names, |it| it.name.as_str());
    let ([error, change], [kp, ki, kd]) = match (inputs.as_slice(), outputs.as_slice()) {
        (&[error, change], &[kp, ki, kd]) => ([error, change], [kp, ki, kd]),
        _ => return Err(told),
    };
    let axes = [error, change].map(|at| Axis::of(&mut told, at, &parts.inputs[at]));
    let block = block(&mut told, parts);
    for at in [kp, ki, kd] {
        check_output(&mut told, &parts.outputs[at]);
    }
    let ([Some(error), Some(change)], Some(block)) = (axes, block) else {
        return Err(told);
    };
    let range = error.range;
    if !((change.range - range).abs() <= SAME_PLACE * range) {
        told.push(format!("error reaches to {range:?}, and change to {:?}", change.range));
    }
    let mut cells =
        Cells { axes: [&error, &change], outputs: [kp, ki, kd], found: [[[None; 7]; 7]; 3] };
    for (number, rule) in block.rules.iter().enumerate().filter(|(_, rule)| rule.enabled) {
        if let Err(what) = cells.take(parts, rule) {
            told.push(format!("rule {}: {what}", number + 1));
        }
    }
    let grids = cells.grids(&mut told, &names);
    if told.is_empty() { Ok(Numbers { range, grids }) } else { Err(told) }
}

/// Positions of the variables with these names; nothing unless there are exactly these.
fn named<T>(
    told: &mut Vec<String>,
    what: &str,
    variables: &[T],
    names: &[&str],
    name: impl Fn(&T) -> &str,
) -> Vec<usize> {
    let found: Vec<&str> = variables.iter().map(&name).collect();
    let places: Vec<usize> =
        names.iter().filter_map(|name| found.iter().position(|it| it == name)).collect();
    if places.len() == names.len() && found.len() == names.len() {
        return places;
    }
    told.push(format!("its {what}s are {}, not {}", found.join(", "), names.join(", ")));
    Vec::new()
}

/// An input whose sets are the partition.
struct Axis {
    /// Position of the input.
    input: usize,
    range: f64,
    /// Which of the seven each term is.
    places: Vec<usize>,
}

impl Axis {
    fn of(told: &mut Vec<String>, at: usize, input: &Input) -> Option<Self> {
        let name = &input.name;
        let before = told.len();
        if !input.enabled {
            told.push(format!("{name} is switched off"));
        }
        if input.terms.len() != LABEL_COUNT {
            told.push(format!("{name} has {} sets, not seven", input.terms.len()));
        }
        let mut corners = Vec::new();
        for term in &input.terms {
            match triangle(term) {
                Some(triangle) => corners.push(triangle),
                None => told.push(format!("{name}: set {} is no triangle of height 1", term.name)),
            }
        }
        if told.len() > before {
            return None;
        }
        let range = corners.iter().fold(0.0, |most: f64, [_, centre, _]| most.max(*centre));
        let mut order: Vec<usize> = (0..LABEL_COUNT).collect();
        order.sort_by(|one, other| corners[*one][1].total_cmp(&corners[*other][1]));
        let mut places = vec![0; LABEL_COUNT];
        for (place, &term) in order.iter().enumerate() {
            places[term] = place;
            let (centre, spacing) = (range * (place as f64 - 3.0) / 3.0, range / 3.0);
            let is_at = |found: f64, place: f64| (found - place).abs() <= SAME_PLACE * range;
            let [left, peak, right] = corners[term];
            // Beyond the range nothing is asked of the outermost sets.
            let is_sound = range > 0.0
                && is_at(peak, centre)
                && (place == 0 || is_at(left, centre - spacing))
                && (place == LABEL_COUNT - 1 || is_at(right, centre + spacing));
            if !is_sound {
                let term = &input.terms[term].name;
                let [from, to] = [centre - spacing, centre + spacing];
                told.push(format!(
                    "{name}: set {term} is a triangle over {left:?}, {peak:?}, {right:?}; even sets have {from:?}, {centre:?}, {to:?} there"
                ));
            }
        }
        if let Some(universe) = input.universe
            && !(universe.lower <= range * (SAME_PLACE - 1.0)
                && universe.upper >= range * (1.0 - SAME_PLACE))
        {
            told.push(format!(
                "{name} lives in {:?} to {:?}, and its sets reach to {range:?}",
                universe.lower, universe.upper
            ));
        }
        (told.len() == before).then_some(Self { input: at, range, places })
    }
}

/// Foot, peak and foot of a triangle of height 1; a side that is level is infinitely far.
#[allow(clippy::float_cmp, reason = "a height that is not exactly 1 changes the grades")]
fn triangle(term: &Term) -> Option<[f64; 3]> {
    const FAR: f64 = f64::INFINITY;
    let (Membership::Shape { kind, params, height }, None) = (&term.membership, &term.lower) else {
        return None;
    };
    let corners = match (kind, params.as_slice()) {
        (ShapeKind::Triangle, &[left, peak, right]) => [left, peak, right],
        (ShapeKind::LinearZ, &[peak, right]) => [-FAR, peak, right],
        (ShapeKind::LinearS, &[left, peak]) => [left, peak, FAR],
        (ShapeKind::Ramp, &[foot, peak]) if foot < peak => [foot, peak, FAR],
        (ShapeKind::Ramp, &[foot, peak]) => [-FAR, peak, foot],
        (ShapeKind::Points, &[peak, 1.0, right, 0.0]) => [-FAR, peak, right],
        (ShapeKind::Points, &[left, 0.0, peak, 1.0]) => [left, peak, FAR],
        _ => return None,
    };
    (*height == 1.0).then_some(corners)
}

/// The one block of rules.
fn block<'a>(told: &mut Vec<String>, parts: &'a Parts) -> Option<&'a RuleBlock> {
    let enabled: Vec<&RuleBlock> = parts.blocks.iter().filter(|block| block.enabled).collect();
    let &[block] = enabled.as_slice() else {
        told.push(format!("it has {} blocks of rules, not one", enabled.len()));
        return None;
    };
    if !block.and.is(TNormKind::AlgebraicProduct) {
        told.push("its rules do not join grades by the product".to_owned());
    }
    if block.activation != Activation::General {
        told.push("not every rule acts as strongly as it fires".to_owned());
    }
    Some(block)
}

fn check_output(told: &mut Vec<String>, output: &Output) {
    let name = &output.name;
    if !output.enabled {
        told.push(format!("{name} is switched off"));
    }
    if !matches!(output.defuzzifier, Defuzzifier::WeightedAverage(_)) {
        told.push(format!(
            "{name} is the {} of its rules, not the weighted-average",
            output.defuzzifier.name()
        ));
    }
    let numbers = output.terms.iter().filter_map(|term| match term.conclusion {
        Conclusion::Constant(number) => Some(number),
        _ => None,
    });
    if let (true, Some(universe)) = (output.clamp, output.universe)
        && numbers.clone().any(|number| !(universe.lower..=universe.upper).contains(&number))
    {
        told.push(format!("{name} is cut off at {:?} and {:?}", universe.lower, universe.upper));
    }
}

/// The cells as rules fill them.
struct Cells<'a> {
    axes: [&'a Axis; 2],
    /// Positions of the three outputs.
    outputs: [usize; 3],
    found: [[[Option<f64>; LABEL_COUNT]; LABEL_COUNT]; 3],
}

impl Cells<'_> {
    #[allow(clippy::float_cmp, reason = "a weight that is not exactly 1 changes the mean")]
    fn take(&mut self, parts: &Parts, rule: &Rule) -> Result<(), String> {
        if rule.weight != 1.0 {
            return Err(format!("its weight is {:?}, not 1", rule.weight));
        }
        let [row, column] = self.cell(&rule.antecedent).ok_or_else(|| {
            "its condition is not that error is in one set and change in one, without hedges"
                .to_owned()
        })?;
        for consequent in &rule.consequents {
            let output = &parts.outputs[consequent.output];
            let conclusion = output.terms.get(consequent.term).map(|term| &term.conclusion);
            let Some(Conclusion::Constant(number)) = conclusion else {
                return Err(format!("what it says of {} is no number", output.name));
            };
            if !consequent.hedges.is_empty() {
                return Err(format!("what it says of {} is hedged", output.name));
            }
            let Some(gain) = self.outputs.iter().position(|at| *at == consequent.output) else {
                continue;
            };
            if self.found[gain][row][column].replace(*number).is_some() {
                let cell = [Label::ALL[row].name(), Label::ALL[column].name()].join(", ");
                return Err(format!("cell ({cell}) of {} has a number already", output.name));
            }
        }
        Ok(())
    }

    /// The cell that a condition names.
    fn cell(&self, antecedent: &Antecedent) -> Option<[usize; 2]> {
        let Antecedent::All(statements) = antecedent else {
            return None;
        };
        let mut cell = [None; 2];
        for statement in statements {
            let Antecedent::Is(statement) = statement else {
                return None;
            };
            let (Variable::Input(input), Some(term), []) =
                (statement.variable, statement.term, statement.hedges.as_slice())
            else {
                return None;
            };
            let axis = self.axes.iter().position(|axis| axis.input == input)?;
            let place = *self.axes[axis].places.get(term)?;
            if cell[axis].replace(place).is_some() {
                return None;
            }
        }
        Some([cell[0]?, cell[1]?])
    }

    /// The numbers; cells without one are told.
    fn grids(&self, told: &mut Vec<String>, names: &[&str; 3]) -> [NumberGrid<f64>; 3] {
        let mut grids = [[[0.0; LABEL_COUNT]; LABEL_COUNT]; 3];
        for ((grid, found), name) in grids.iter_mut().zip(&self.found).zip(names) {
            let mut holes = Vec::new();
            for (row, (cells, found)) in grid.iter_mut().zip(found).enumerate() {
                for (column, (cell, found)) in cells.iter_mut().zip(found).enumerate() {
                    match found {
                        Some(number) => *cell = *number,
                        None => {
                            holes.push(format!("({}, {})", Label::ALL[row], Label::ALL[column]))
                        }
                    }
                }
            }
            if !holes.is_empty() {
                let first = holes.iter().take(MOST_CELLS).cloned().collect::<Vec<_>>().join(", ");
                let more = if holes.len() > MOST_CELLS { ", …" } else { "" };
                told.push(format!("{} cells of {name} have no number: {first}{more}", holes.len()));
            }
        }
        grids
    }
}
