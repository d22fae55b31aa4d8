//! `[Input1]` and `[Output1]`.

use fspid_fuzzy::OutOfRange;
use fspid_fuzzy::system::{Conclusion, FallbackValue, Input, Membership, Output, Universe};

use super::losses::Losses;
use super::shape::{Function, function};
use crate::adapt::reach;
use crate::number::{written, written_all};
use crate::report::clipped;

/// The section of an input. In a system with interval sets every membership function is a `pair`.
pub(super) fn input(number: usize, input: &Input, pair: bool, losses: &mut Losses) -> String {
    let place = format!("input `{}`", input.name);
    if !input.enabled {
        losses.never(format!("{place} is switched off, which the file cannot say"));
    }
    if input.out_of_range != OutOfRange::Evaluate {
        losses.lost(format!("{place}: MATLAB evaluates values outside the range as they are"));
    }
    let universe = input.universe.unwrap_or_else(|| {
        let universe = reach(input);
        losses.lost(format!(
            "{place} has no range; {} to {} is written",
            written(universe.lower),
            written(universe.upper)
        ));
        universe
    });
    let sets = input.terms.iter().zip(1..).map(|(term, number)| {
        let slot = Slot::new(&place, number, &term.name, losses);
        slot.set((&term.membership, term.lower.as_ref()), universe, pair, losses)
    });
    let sets: String = sets.collect();
    let name = label(&input.name, losses);
    section(&format!("Input{number}"), &name, universe, input.terms.len(), &sets)
}

/// The section of an output.
pub(super) fn output(number: usize, output: &Output, pair: bool, losses: &mut Losses) -> String {
    let place = format!("output `{}`", output.name);
    if !output.enabled {
        losses.never(format!("{place} is switched off, which the file cannot say"));
    }
    let weighs = output.defuzzifier.sampling().is_none();
    if output.clamp && weighs {
        losses.lost(format!("{place}: MATLAB does not move answers into the range"));
    }
    let universe = output.universe.unwrap_or_else(|| {
        losses.lost(format!("{place} has no range; -1 to 1 is written"));
        Universe { lower: -1.0, upper: 1.0 }
    });
    falls_back(&place, output, universe, losses);
    let sets = output.terms.iter().zip(1..).map(|(term, number)| {
        let slot = Slot::new(&place, number, &term.name, losses);
        match &term.conclusion {
            Conclusion::Set { membership, lower } => {
                slot.set((membership, lower.as_ref()), universe, pair, losses)
            }
            other => slot.value(other, pair, losses),
        }
    });
    let sets: String = sets.collect();
    let name = label(&output.name, losses);
    section(&format!("Output{number}"), &name, universe, output.terms.len(), &sets)
}

/// In the file the answer without a firing rule is the middle of the range.
fn falls_back(place: &str, output: &Output, universe: Universe, losses: &mut Losses) {
    let middle = match output.fallback.value {
        FallbackValue::Middle => true,
        FallbackValue::Number(number) => number.to_bits() == universe.middle().to_bits(),
        FallbackValue::Nothing => false,
    };
    if output.fallback.previous || !middle {
        losses.lost(format!("{place}: where no rule fires MATLAB answers the middle of the range"));
    }
}

fn section(heading: &str, name: &str, universe: Universe, count: usize, sets: &str) -> String {
    let range = written_all(&[universe.lower, universe.upper]);
    format!("[{heading}]\nName='{name}'\nRange=[{range}]\nNumMFs={count}\n{sets}\n")
}

/// A name that can stand between quotes on one line.
pub(super) fn label(name: &str, losses: &mut Losses) -> String {
    let fits = |next: char| next != '\'' && !next.is_control();
    if name.chars().all(fits) && name.trim() == name {
        return name.into();
    }
    let other: String =
        name.trim().chars().map(|next| if fits(next) { next } else { '_' }).collect();
    losses.lost(format!("the name `{}` is written as `{other}`", clipped(name)));
    other
}

/// A place for a set or number: `MF2='label'`.
struct Slot {
    /// For messages.
    place: String,
    number: usize,
    label: String,
}

impl Slot {
    fn new(variable: &str, number: usize, name: &str, losses: &mut Losses) -> Self {
        let place = format!("{variable}, term `{}`", clipped(name));
        Self { place, number, label: label(name, losses) }
    }

    fn line(&self, side: &str, name: &str, params: &[f64]) -> String {
        let Self { number, label, .. } = self;
        let params = written_all(params).replace("inf", "Inf");
        format!("MF{number}{side}='{label}':'{name}',[{params}]\n")
    }

    fn set(
        &self,
        (upper, lower): (&Membership, Option<&Membership>),
        universe: Universe,
        pair: bool,
        losses: &mut Losses,
    ) -> String {
        let mut line = |side, membership: &Membership| {
            let function = function(&self.place, membership, universe, pair, losses);
            let Function { name, mut params, height } = function;
            params.extend(pair.then_some(height));
            self.line(side, name, &params)
        };
        if !pair {
            return line("", upper);
        }
        line("U", upper) + &line("L", lower.unwrap_or(upper))
    }

    /// A number or a linear function.
    fn value(&self, conclusion: &Conclusion, pair: bool, losses: &mut Losses) -> String {
        match conclusion {
            Conclusion::Constant(value) if pair => self.line("", "constant", &[*value; 2]),
            Conclusion::Constant(value) => self.line("", "constant", &[*value]),
            Conclusion::Interval(ends) => self.line("", "constant", ends),
            Conclusion::Linear { coefficients, constant } if !pair => {
                self.line("", "linear", &[&coefficients[..], &[*constant]].concat())
            }
            _ => {
                let message = "neither a number nor, without interval sets, a linear function";
                losses.never(format!("{}: {message}", self.place));
                String::new()
            }
        }
    }
}
