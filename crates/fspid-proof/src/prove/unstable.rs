//! Gains, standing still or in a sequence, under which the loop grows.

use std::collections::BTreeSet;

use fspid_core::{Gains, Law};
use fspid_lti::{Matrix, spectral_radius};

use super::{Prover, Verdict};
use crate::certificate::Claim;
use crate::recheck::produced;
use crate::solve;

/// An input of the supervisor, the spectral radius of the loop with the gains there, and that loop.
type Frozen = ([f64; 2], f64, Matrix);

impl Prover<'_> {
    /// Gains that the loop really has, standing still, under which it grows: those at rest if they do, which
    /// says most, as it is the flown loop's own growth.
    pub(crate) fn frozen_growth(&self) -> Option<Verdict> {
        let worst = || self.frozen().into_iter().max_by(|one, other| one.1.total_cmp(&other.1));
        let at_rest = self.frozen_at([0.0; 2]).and_then(|found| self.growth_of(found));
        at_rest.or_else(|| self.growth_of(worst()?))
    }

    fn growth_of(&self, (input, radius, matrix): Frozen) -> Option<Verdict> {
        if !(radius > 1.0) {
            return None;
        }
        let solve::InstabilityForm { p: form, direction, factor, .. } =
            solve::instability_form(&matrix)?;
        let claim = Claim::FrozenGrowth { input, factor, form, direction };
        let (certificate, rechecked) = self.rechecked(claim, 1.0, None)?;
        Some(Verdict::Refuted(certificate, rechecked))
    }

    /// Inputs of the supervisor, the loop with the gains that it produces there, and its spectral radius.
    pub(super) fn frozen(&self) -> Vec<Frozen> {
        let inputs = self.inputs().into_iter().take_while(|_| !(self.effort.stops)());
        inputs.filter_map(|input| self.frozen_at(input)).collect()
    }

    fn frozen_at(&self, input: [f64; 2]) -> Option<Frozen> {
        let gains = produced(&self.description.controller, input);
        let matrix = self.model.closed_matrix(gains).ok()?;
        let radius = spectral_radius(&matrix).ok()?;
        Some((input, radius, matrix))
    }

    /// A grid over the supervisor's inputs; for fixed gains, and for gains that remember, rest alone.
    pub(super) fn inputs(&self) -> Vec<[f64; 2]> {
        let memoryless = self.tuned().filter(|f| f.tuner().settings().law == Law::Memoryless);
        let Some(fspid) = memoryless else {
            return vec![[0.0; 2]];
        };
        let (range, side) = (fspid.tuner().supervisor().range(), self.effort.frozen_points.max(2));
        let place = |index: usize| range * (2.0 * index as f64 / (side - 1) as f64 - 1.0);
        let scale = fspid.tuner().settings().input_scale;
        // An input whose scale is 0 stays 0 in every flight.
        let scaled = [scale.error_per_rad, scale.change_per_rad].map(|scale| scale != 0.0);
        let seen = |input: usize, index| if scaled[input] { place(index) } else { 0.0 };
        let pairs = (0..side).flat_map(|row| (0..side).map(move |column| (row, column)));
        pairs.map(|(row, column)| [seen(0, row), seen(1, column)]).collect()
    }

    /// Gains that the supervisor produces, in an order of our own, under which the loop grows.
    pub(super) fn sequence_growth(&self) -> Option<Verdict> {
        let frozen = self.frozen();
        if frozen.len() < 2 {
            return None;
        }
        let chosen = self.extreme(&frozen);
        let matrices: Vec<Matrix> =
            chosen.iter().filter_map(|&index| Some(frozen.get(index)?.2.clone())).collect();
        let growth = solve::growing_sequence(&matrices, &self.search())?;
        let mut product = Matrix::identity(self.model.size());
        let mut inputs = Vec::with_capacity(growth.sequence.len());
        for &place in &growth.sequence {
            inputs.push(frozen.get(*chosen.get(place)?)?.0);
            product = matrices.get(place)?.product(&product).ok()?;
        }
        let solve::InstabilityForm { p: form, direction, factor, .. } =
            solve::instability_form(&product)?;
        let claim = Claim::SequenceGrowth { inputs, factor, form, direction };
        let (certificate, rechecked) = self.rechecked(claim, 1.0, None)?;
        Some(Verdict::Refuted(certificate, rechecked))
    }

    /// Places of the gains that are largest in some direction: few, and at the corners of them all.
    pub(super) fn extreme(&self, frozen: &[Frozen]) -> Vec<usize> {
        let gains: Vec<[f64; 3]> = frozen
            .iter()
            .map(|(input, ..)| {
                let Gains { kp, ki, kd } = produced(&self.description.controller, *input);
                [kp, ki, kd]
            })
            .collect();
        let directions = (-1..=1_i32).flat_map(|kp| {
            (-1..=1_i32).flat_map(move |ki| (-1..=1_i32).map(move |kd| [kp, ki, kd]))
        });
        let spread: [f64; 3] = std::array::from_fn(|gain| {
            let values = gains.iter().map(|triple| triple[gain]);
            let (least, most) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), value| {
                (a.min(value), b.max(value))
            });
            if most > least { most - least } else { 1.0 }
        });
        let mut chosen = BTreeSet::new();
        for direction in directions {
            let along = |triple: &[f64; 3]| -> f64 {
                (0..3).map(|gain| f64::from(direction[gain]) * triple[gain] / spread[gain]).sum()
            };
            let best = gains.iter().enumerate();
            let best = best.max_by(|one, other| along(one.1).total_cmp(&along(other.1)));
            chosen.extend(best.map(|(index, _)| index));
        }
        chosen.into_iter().collect()
    }
}
