//! Sums over samples of the joined set, as other tools compute them.

use super::super::build::System;
use super::super::defuzzifier::{Defuzzifier, Sampling};
use super::super::parts::{Conclusion, Output};
use super::super::workspace::Workspace;

impl System {
    /// A sampled centroid; nothing if the samples have no area.
    pub(super) fn sampled(
        &self,
        index: usize,
        output: &Output,
        method: Defuzzifier,
        workspace: &mut Workspace,
    ) -> Option<f64> {
        let universe = output.universe?;
        let (samples, cells, offset, end_weight) = match method.sampling()? {
            Sampling::Endpoints(n) => (n, n - 1, 0.0, 1.0),
            Sampling::Trapezoid(n) => (n, n - 1, 0.0, 0.5),
            Sampling::Midpoint(n) => (n, n, 0.5, 1.0),
            Sampling::LeftEnd(n) => (n, n, 0.0, 1.0),
            Sampling::Vertices(_) | Sampling::Exact => return None,
        };
        let (mut area, mut moment) = (0.0_f64, 0.0_f64);
        for n in 0..samples {
            let is_end = n == 0 || n == samples - 1;
            let weight = if is_end { end_weight } else { 1.0 };
            let x = universe.lower + (f64::from(n) + offset) * (universe.span() / f64::from(cells));
            let grade = weight * self.joined_grade(index, output, x, workspace)?;
            area += grade;
            moment += x * grade;
        }
        (area >= f64::MIN_POSITIVE).then(|| moment / area)
    }

    /// Grade of the joined set at `x`.
    pub(crate) fn joined_grade(
        &self,
        index: usize,
        output: &Output,
        x: f64,
        workspace: &mut Workspace,
    ) -> Option<f64> {
        let Workspace { inputs, degrees, scratch, .. } = workspace;
        let mut joined = 0.0;
        for &position in &self.outputs.get(index)?.conclusions {
            let (resolved, &degree) = (self.conclusions.get(position)?, degrees.get(position)?);
            let block = self.parts.blocks.get(resolved.block)?;
            if let Conclusion::Set { membership, .. } = &output.terms.get(resolved.term)?.conclusion
            {
                let grade = membership.grade(x, inputs, &mut scratch.room);
                joined = output.aggregation.apply(joined, block.implication.apply(degree, grade));
            }
        }
        Some(joined)
    }
}
