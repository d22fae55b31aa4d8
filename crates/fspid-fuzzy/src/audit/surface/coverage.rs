//! How strongly the rules fire at least.

use alloc::vec::Vec;

use super::field::Field;
use super::objective;
use super::options::SurfaceOptions;
use crate::audit::Statement;
use crate::audit::search::{Effort, Extreme, minimum};
use crate::scalar::Interval;

/// How strongly the strongest rule about an output fires at least.
#[derive(Clone, Debug, PartialEq)]
pub struct Coverage {
    /// The smallest strength of the strongest rule.
    pub least: Extreme,
    /// Whether some rule fires everywhere; refuted by a point where none does.
    pub statement: Statement<Vec<f64>>,
}

pub(super) fn of_output(
    field: &mut Field<'_>,
    output: usize,
    domain: &[Interval],
    options: &SurfaceOptions,
) -> Coverage {
    let system = field.firing.system;
    let conclusions = system.conclusions.iter().filter(|c| c.output == output);
    let mut rules: Vec<usize> = conclusions.map(|conclusion| conclusion.rule).collect();
    rules.dedup();
    let effort = Effort { tolerance: options.slope_tolerance, boxes: options.boxes };
    let mut strength = objective::Coverage { field, rules: &rules };
    let least = minimum(&mut strength, domain, effort);
    field.boxes += least.boxes;
    let [low, high] = least.bounds;
    let statement = if low > 0.0 {
        Statement::Proved
    } else if high <= 0.0 {
        Statement::Refuted(least.at.clone())
    } else {
        Statement::Open
    };
    Coverage { least, statement }
}
