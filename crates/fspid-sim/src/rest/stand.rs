//! Stability of an equilibrium: whether a rest holds, the one verdict for flights, analyses and requirements. Poles of the linear
//! loop tell; where the rules have a kink there, motions of the piecewise linear loop do.

use fspid_core::{Gains, SecondInput};

use super::{Doubt, Rest, Side, integral, slopes};
use crate::controller::Controller;
use crate::error::SimError;
use crate::loop_model::{Clocks, LoopModel, SampledPlant};
use crate::scenario::Scenario;

/// Motions that are followed around a kink. One that grows does so by itself after a while, wherever it starts; several
/// starts are for loops with several ways to move. What all of them miss is undecided, never stable.
const MOTIONS: u64 = 6;
/// For so many samples: two minutes at 100 Hz, the first half of which is for what dies out.
const SAMPLES: usize = 12_000;
/// By so much a motion has to grow over the second half, as a logarithm, to be called growing: twice. Rounding makes no
/// difference of that size; what grows more slowly, less than twice a minute at 100 Hz, stays undecided.
const GROWN: f64 = core::f64::consts::LN_2;

/// Whether something grows around a rest, as far as its linear loop tells.
///
/// Limits of controller and servo do not act at rest and change nothing about it. Poles that rounding may carry across
/// the unit circle, to whichever side, decide nothing.
///
/// With a kink at rest the loop is linear on each of its sides, and a motion may go around through several. One side
/// that alone would grow then proves nothing: motions may leave it faster than they grow. So motions are followed
/// through the sides as they come; the rest is [`Stand::Grows`] if one of them does, and if none is seen to,
/// [`Doubt::OneSide`] says that it is not decided.
///
/// Where so much is on its way that it is no state ([`MOST_AS_STATES`](crate::loop_model::MOST_AS_STATES)), no motion is
/// followed, and one unstable side is [`Doubt::LongWay`].
///
/// Of a sensor with a clock of its own the age changes: the loop is asked for what a whole time makes of it after which
/// all ages come again. Where they do not, or a way is long, it is asked with the largest age and with none, and near a
/// time after which they nearly come again; where the answers differ, it is [`Doubt::ChangingAge`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stand {
    /// It is stable on every side.
    Holds,
    /// Something grows.
    Grows {
        /// By what, a sample: the spectral radius of the one loop there is, or what a motion was seen to grow by.
        spectral_radius: f64,
    },
    /// Neither is known, and why.
    Undecided(Doubt),
}

/// The loop of one side: stable, unstable, or neither for all that is known.
#[derive(Clone, Copy)]
pub(crate) enum Found {
    Stable,
    Unstable(f64),
    Blurred(f64),
}

/// A loop and its gains.
pub(super) type Model = (LoopModel<f64>, Gains<f64>);

/// The loops of one sample, one for each side, and what the supervisor sees in it by state: its two inputs.
struct Phase {
    closed: Vec<Vec<Vec<f64>>>,
    seen: [Vec<f64>; 2],
}

/// What the loops of all sides say together; where one is unstable beside others, motions are followed.
pub(crate) fn stand_of_sides(
    found: &[Found],
    follow: Option<impl FnOnce() -> Option<f64>>,
) -> Stand {
    let unstable = found.iter().filter_map(|it| match *it {
        Found::Unstable(radius) => Some(radius),
        Found::Stable | Found::Blurred(_) => None,
    });
    // A NaN is no radius, and no stable loop.
    let larger = |one: f64, other: f64| if other > one || other.is_nan() { other } else { one };
    if let Some(spectral_radius) = unstable.reduce(larger) {
        if found.len() == 1 || !spectral_radius.is_finite() {
            return Stand::Grows { spectral_radius };
        }
        let Some(follow) = follow else {
            return Stand::Undecided(Doubt::LongWay { spectral_radius });
        };
        return match follow() {
            Some(spectral_radius) => Stand::Grows { spectral_radius },
            None => Stand::Undecided(Doubt::OneSide { spectral_radius }),
        };
    }
    let blurred = found.iter().filter_map(|it| match *it {
        Found::Blurred(radius) => Some(radius),
        Found::Stable | Found::Unstable(_) => None,
    });
    blurred.reduce(larger).map_or(Stand::Holds, |spectral_radius| {
        Stand::Undecided(Doubt::Rounding { spectral_radius })
    })
}

/// What a rest says that does not hold without the dead zone: within the zone it does.
fn beyond_dead_zone(stand: Stand) -> Stand {
    match stand {
        Stand::Grows { spectral_radius }
        | Stand::Undecided(
            Doubt::Rounding { spectral_radius }
            | Doubt::OneSide { spectral_radius }
            | Doubt::LongWay { spectral_radius },
        ) => Stand::Undecided(Doubt::DeadZone { spectral_radius }),
        stand => stand,
    }
}

/// What the poles of a loop say.
pub(super) fn found((model, gains): &Model) -> Result<Found, SimError> {
    match model.unstable_radius(*gains) {
        Ok(None) => Ok(Found::Stable),
        Ok(Some(radius)) => Ok(Found::Unstable(radius)),
        Err(SimError::Linear(error)) => {
            error.undecided_radius().map(Found::Blurred).ok_or(error.into())
        }
        Err(error) => Err(error),
    }
}

impl Rest {
    /// Whether something grows.
    ///
    /// # Errors
    /// Eigenvalues that are not found.
    pub fn stand(
        &self,
        scenario: &Scenario,
        plant: &SampledPlant<f64>,
        controller: &Controller,
    ) -> Result<Stand, SimError> {
        Ok(match self.stand_as_it_is(scenario, plant, controller)? {
            Stand::Holds => match self.sides.first() {
                Some(side) if integral::may_not_come_to_rest(controller, side.gains) => {
                    Stand::Undecided(Doubt::IntegralGain)
                }
                _ => Stand::Holds,
            },
            stand if self.is_beyond_dead_zone => beyond_dead_zone(stand),
            Stand::Grows { spectral_radius } if self.is_only_commanded => {
                Stand::Undecided(Doubt::Commanded { spectral_radius })
            }
            stand => stand,
        })
    }

    fn stand_as_it_is(
        &self,
        scenario: &Scenario,
        plant: &SampledPlant<f64>,
        controller: &Controller,
    ) -> Result<Stand, SimError> {
        let models = self.models(scenario, plant, controller);
        let changing = models.iter().find(|(model, _)| model.has_changing_ages());
        match changing.and_then(|(model, _)| Clocks::of(scenario, model)) {
            Some(clocks) => self.stand_with_clocks(&models, clocks),
            None => self.stand_of(&models),
        }
    }

    /// The same of loops, one for each side.
    pub(super) fn stand_of(&self, models: &[Model]) -> Result<Stand, SimError> {
        let found = models.iter().map(found).collect::<Result<Vec<Found>, _>>()?;
        let is_long = models.iter().any(|(model, _)| model.settings().is_long());
        let follow = || self.growth_of_motions(&[models.to_vec()]);
        Ok(stand_of_sides(&found, (!is_long).then_some(follow)))
    }

    /// The growth a sample of the motion that grows most around the kinks of this rest, through all its sides as they
    /// come; none where no motion is seen to grow. Loops are those of one sample after the other, over and over, one for
    /// each side.
    pub(super) fn growth_of_motions(&self, phases: &[Vec<Model>]) -> Option<f64> {
        let phases: Vec<Phase> = phases.iter().map(|models| self.phase(models)).collect();
        let size = phases.first()?.seen[0].len();
        // Sides with other states, such as one without an integral, are not one after the other in a motion.
        let same_states =
            phases.iter().flat_map(|phase| &phase.closed).all(|rows| rows.len() == size);
        if same_states { self.largest_growth(&phases) } else { None }
    }

    /// The same where one loop for each side is given by its rows, with what its supervisor sees of a state: its two inputs.
    pub(crate) fn growth_through(
        &self,
        closed: Vec<Vec<Vec<f64>>>,
        seen: [Vec<f64>; 2],
    ) -> Option<f64> {
        self.largest_growth(&[Phase { closed, seen }])
    }

    /// The loops of one sample, and what the supervisor sees in it.
    fn phase(&self, models: &[Model]) -> Phase {
        let closed = models.iter().map(|(model, gains)| model.closed(*gains)).collect();
        let seen = models.first().map_or_else(Default::default, |(first, _)| {
            let [error, change] = first.error_rows();
            let second = match self.second_input {
                SecondInput::Change => change,
                SecondInput::Rate => first.seen_rows()[1].iter().map(|rate| -rate).collect(),
                SecondInput::ModelError(_) => error.clone(),
            };
            [error, second]
        });
        Phase { closed, seen }
    }

    /// The loop of each side.
    fn models(
        &self,
        scenario: &Scenario,
        plant: &SampledPlant<f64>,
        controller: &Controller,
    ) -> Vec<Model> {
        let several = self.sides.len() > 1;
        let model = |side: &Side| side.around(scenario, plant, controller, several);
        self.sides.iter().map(|side| (model(side), side.gains)).collect()
    }

    /// The growth a sample of the motion that grows most, if one is seen to grow.
    fn largest_growth(&self, phases: &[Phase]) -> Option<f64> {
        let grown = (0..MOTIONS).map(|motion| self.growth(phases, motion));
        let largest = grown.fold(f64::NEG_INFINITY, f64::max);
        let samples = (SAMPLES - SAMPLES / 2) as f64;
        (largest > GROWN).then(|| libm::exp(largest / samples))
    }

    /// Logarithm of the growth of one motion over the second half of the samples.
    fn growth(&self, phases: &[Phase], motion: u64) -> f64 {
        let order = phases.first().map_or(0, |phase| phase.seen[0].len());
        let mut state: Vec<f64> = (0..order as u64).map(|place| scattered(motion, place)).collect();
        let mut next = vec![0.0; order];
        let mut grown = 0.0;
        for (sample, phase) in phases.iter().cycle().take(SAMPLES).enumerate() {
            let units =
                [0, 1].map(|input| self.seen_per_unit[input] * product(&phase.seen[input], &state));
            let rows = &phase.closed[self.of_direction[slopes::direction(units)]];
            for (next, row) in next.iter_mut().zip(rows) {
                *next = product(row, &state);
            }
            let size = next.iter().fold(0.0, |size, value| f64::max(size, value.abs()));
            if size == 0.0 {
                return f64::NEG_INFINITY;
            }
            // Sides are cones: only the direction of a state matters.
            for (state, next) in state.iter_mut().zip(&next) {
                *state = next / size;
            }
            if sample >= SAMPLES / 2 {
                grown += libm::log(size);
            }
        }
        grown
    }

    /// Joins sides whose loops do not differ, as where no constant is held.
    pub(super) fn join_equal_sides(&mut self) {
        let mut sides: Vec<Side> = Vec::new();
        let mut new_places = Vec::new();
        for side in &self.sides {
            let known = sides.iter().position(|it| it == side);
            new_places.push(known.unwrap_or_else(|| {
                sides.push(*side);
                sides.len() - 1
            }));
        }
        self.of_direction = self.of_direction.map(|place| new_places[place]);
        self.sides = sides;
    }
}

fn product(row: &[f64], state: &[f64]) -> f64 {
    row.iter().zip(state).map(|(by, value)| by * value).sum()
}

/// A number between -1 and 1, the same each time: splitmix64.
fn scattered(motion: u64, place: u64) -> f64 {
    let mut bits = (motion << 32 | place).wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    (bits ^ bits >> 31) as f64 / (1_u64 << 63) as f64 - 1.0
}
