//! AggregatedSet sets with curved sides, integrated with an error bound that is proved.

use alloc::vec::Vec;

use super::super::defuzzifier::{Defuzzifier, Sampling};
use super::super::parts::{Conclusion, Membership, Output};
use super::curve::JoinedCurve;
use super::joined::scale;
use super::maximum::search;
use super::sampled::Concluded;
use fspid_numeric::quadrature::Quadrature;
use fspid_numeric::scalar::Interval;

/// What integration over an output's universe needs to know beforehand.
#[derive(Clone, Debug)]
pub(crate) struct Integral {
    lower: f64,
    upper: f64,
    /// Where sets have kinks or jumps, in ascending order.
    corners: Vec<f64>,
}

impl Integral {
    /// For an output whose integral itself is asked for.
    pub(crate) fn of(output: &Output) -> Option<Self> {
        let universe =
            output.universe.filter(|_| output.defuzzifier.sampling() == Some(Sampling::Exact))?;
        let mut corners = Vec::new();
        for term in &output.terms {
            if let Conclusion::Set { membership: Membership::Shape { kind, params, .. }, .. } =
                &term.conclusion
            {
                kind.corners(params, &mut |x| corners.push(x));
            }
        }
        corners.retain(|&x| universe.lower < x && x < universe.upper);
        corners.sort_by(f64::total_cmp);
        corners.dedup();
        Some(Self { lower: universe.lower, upper: universe.upper, corners })
    }

    /// The number that a method reads off, and how far it may be from the true one; nothing for a
    /// set without area.
    pub(crate) fn number(
        &self,
        method: Defuzzifier,
        concluded: &Concluded<'_>,
        order: &mut Vec<usize>,
    ) -> Option<(f64, f64)> {
        let strongest = concluded.levels.iter().fold(0.0_f64, |top, l| top.max(l.strength));
        let curve = JoinedCurve::new(*concluded, order, scale(strongest)?);
        let quadrature = Quadrature::new(self.lower, self.upper)?.with_corners(&self.corners);
        let runs = || search(&curve, [self.lower, self.upper], &self.corners);
        match method {
            Defuzzifier::Centroid(_) => {
                quadrature.integrate(&curve).centroid().map(|found| self.middle(found))
            }
            Defuzzifier::Bisector(_) => quadrature.bisector(&curve).map(|found| self.middle(found)),
            Defuzzifier::SmallestOfMaximum(_) => runs()?.smallest(),
            Defuzzifier::MeanOfMaximum(_) => runs()?.mean(),
            Defuzzifier::LargestOfMaximum(_) => runs()?.largest(),
            Defuzzifier::WeightedAverage(_) | Defuzzifier::WeightedSum(_) => None,
        }
    }

    /// The middle of an interval within the universe, and its half width.
    fn middle(&self, found: Interval) -> (f64, f64) {
        let universe = Interval::between(self.lower, self.upper);
        let found = found.intersection(universe).unwrap_or(found);
        (found.midpoint(), found.radius())
    }
}
