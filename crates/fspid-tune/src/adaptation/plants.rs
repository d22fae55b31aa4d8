//! Which flights are of the same plant, however that is written.
//!
//! What is written otherwise may fly the same: a limit that never acts, or another ninth digit, makes no other plant, and would
//! count as evidence once more. Two plants are one where each of their flights is alike with either of them.

use fspid_core::Gains;
use rayon::prelude::*;

use super::draws::Parts;
use super::flown::First;
use super::trace::{Sketch, Trace};
use crate::error::TuneError;

/// Most flights in which all plants are told apart before pairs of them are asked in all of their flights.
const PROBES: usize = 8;

/// Which flights are of the same plant, and the mean gains of all and of each; lost flights have no part in means.
#[derive(Clone, Debug)]
pub(super) struct Plants {
    /// In how many ways each plant is written.
    pub(super) written: Vec<usize>,
    /// The plant of each flight.
    pub(super) of: Vec<usize>,
    pub(super) all: Gains<f64>,
    pub(super) means: Vec<Gains<f64>>,
}

impl Plants {
    /// Of flights, and what a flight shows with the plant of another one, both by their numbers; none where it cannot be
    /// flown.
    pub(super) fn of(
        firsts: &[First],
        fly: impl Fn(usize, usize) -> Result<Option<Trace>, TuneError> + Sync,
    ) -> Result<Self, TuneError> {
        let mut keys: Vec<&str> = Vec::new();
        let as_written: Vec<usize> = firsts.iter().map(|it| place_of(&mut keys, &it.key)).collect();
        let asked = Asked { firsts, as_written: &as_written, fly };
        let plant_of = asked.plants(keys.len())?;
        let count = plant_of.iter().max().map_or(0, |last| last + 1);
        let written = |plant: usize| plant_of.iter().filter(|it| **it == plant).count();
        let written = (0..count).map(written).collect();
        let of: Vec<usize> = as_written.iter().map(|it| plant_of[*it]).collect();
        let all = mean_of(firsts, &of, |_| true).unwrap_or(Gains::ZERO);
        let mean = |plant: usize| mean_of(firsts, &of, |it| it == plant).unwrap_or(all);
        Ok(Self { written, all, means: (0..count).map(mean).collect(), of })
    }

    pub(super) fn count(&self) -> usize {
        self.written.len()
    }

    /// Mean gains of all flights without each part of the plants.
    pub(super) fn without(&self, firsts: &[First], parts: &Parts) -> Vec<Gains<f64>> {
        let without = |part: usize| mean_of(firsts, &self.of, |it| parts.part(it) != Some(part));
        (0..parts.count()).map(|part| without(part).unwrap_or(self.all)).collect()
    }

    /// Places of the flights of a plant that are not lost as they are.
    pub(super) fn flown<'a>(
        &'a self,
        plant: usize,
        firsts: &'a [First],
    ) -> impl Iterator<Item = usize> + 'a {
        let mine = self.of.iter().zip(firsts).enumerate();
        mine.filter(move |(_, (of, first))| **of == plant && !first.lost).map(|(place, _)| place)
    }
}

/// Plants as they are written, and how they are told apart.
struct Asked<'a, F> {
    firsts: &'a [First],
    /// The number of the plant of each flight, as it is written.
    as_written: &'a [usize],
    fly: F,
}

impl<F: Fn(usize, usize) -> Result<Option<Trace>, TuneError> + Sync> Asked<'_, F> {
    /// The plant that each is that is written.
    fn plants(&self, written: usize) -> Result<Vec<usize>, TuneError> {
        let probed = self.probed(written)?;
        let may_be_one = |own: usize, leader: usize| {
            probed[own].iter().zip(&probed[leader]).all(|it| match it {
                (Some(one), Some(other)) => one.may_be_like(other),
                (one, other) => one.is_none() && other.is_none(),
            })
        };
        // The first that each plant is written as.
        let mut leaders: Vec<usize> = Vec::new();
        let mut plant_of = Vec::with_capacity(written);
        for own in 0..written {
            let mut found = None;
            for (plant, leader) in leaders.iter().enumerate() {
                if may_be_one(own, *leader) && self.are_one(own, *leader)? {
                    found = Some(plant);
                    break;
                }
            }
            plant_of.push(found.unwrap_or(leaders.len()));
            if found.is_none() {
                leaders.push(own);
            }
        }
        Ok(plant_of)
    }

    /// What each plant shows in some flights, those of the largest commands, which limits and rates are met in.
    fn probed(&self, written: usize) -> Result<Vec<Vec<Option<Sketch>>>, TuneError> {
        let mut probes: Vec<usize> = Vec::new();
        let mut order: Vec<usize> = self.flown(|_| true).collect();
        let amplitude = |place: &usize| self.firsts[*place].amplitude_deg;
        order.sort_by(|a, b| amplitude(b).total_cmp(&amplitude(a)));
        for place in order {
            let is_new =
                probes.iter().all(|it| self.firsts[*it].signals != self.firsts[place].signals);
            if probes.len() < PROBES && is_new {
                probes.push(place);
            }
        }
        // Of one plant there is nothing to tell apart.
        let probes = if written > 1 { probes } else { Vec::new() };
        (0..written)
            .into_par_iter()
            .map(|plant| probes.iter().map(|probe| self.probe(*probe, plant)).collect())
            .collect()
    }

    fn probe(&self, flight: usize, plant: usize) -> Result<Option<Sketch>, TuneError> {
        if self.as_written[flight] == plant {
            return Ok(Some(self.firsts[flight].sketch.clone()));
        }
        Ok(self.flies(flight, plant)?.map(|trace| trace.sketch()))
    }

    /// Whether all flights of two plants are alike with either of them.
    fn are_one(&self, one: usize, other: usize) -> Result<bool, TuneError> {
        for (plant, beside) in [(one, other), (other, one)] {
            for flight in self.flown(|it| it == plant) {
                let Some(found) = self.flies(flight, beside)? else { return Ok(false) };
                if !self.firsts[flight].sketch.may_be_like(&found.sketch()) {
                    return Ok(false);
                }
                let own = self.flies(flight, plant)?;
                if !own.is_some_and(|own| own.is_like(&found)) {
                    return Ok(false);
                }
            }
        }
        Ok(true)
    }

    /// What a flight shows with a plant.
    fn flies(&self, flight: usize, plant: usize) -> Result<Option<Trace>, TuneError> {
        let first = self.as_written.iter().position(|it| *it == plant);
        first.map_or(Ok(None), |first| (self.fly)(flight, first))
    }

    /// Places of the flights of some plants that are not lost.
    fn flown(&self, is_asked: impl Fn(usize) -> bool) -> impl Iterator<Item = usize> {
        let all = self.firsts.iter().zip(self.as_written).enumerate();
        all.filter(move |(_, (first, plant))| !first.lost && is_asked(**plant)).map(|(it, _)| it)
    }
}

/// The place of a key among those that are known; a new one is put behind them.
fn place_of<'a>(keys: &mut Vec<&'a str>, key: &'a str) -> usize {
    let place = keys.iter().position(|it| *it == key).unwrap_or(keys.len());
    if place == keys.len() {
        keys.push(key);
    }
    place
}

/// Mean gains of the flights of some plants that are not lost.
fn mean_of(firsts: &[First], of: &[usize], is_asked: impl Fn(usize) -> bool) -> Option<Gains<f64>> {
    let asked = firsts.iter().zip(of).filter(|(first, of)| !first.lost && is_asked(**of));
    let (mut sum, mut count) = ([0.0; 3], 0.0);
    for Gains { kp, ki, kd } in asked.map(|(first, _)| first.mean()) {
        sum = [sum[0] + kp, sum[1] + ki, sum[2] + kd];
        count += 1.0;
    }
    let [kp, ki, kd] = sum.map(|it| it / count);
    (count > 0.0).then_some(Gains { kp, ki, kd })
}
