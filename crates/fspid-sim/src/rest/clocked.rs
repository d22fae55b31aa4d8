//! Stability of an equilibrium where a sensor has a clock of its own, so that the linear loop is periodic: the poles of what a
//! whole period of its ages makes of the loop (its monodromy matrix).

use fspid_lti::{Matrix, spectral_radius};

use super::stand::{Found, Model, Stand, found, stand_of_sides};
use super::{Doubt, Rest};
use crate::error::SimError;
use crate::loop_model::{Clocks, Phases};

/// Most products of numbers for the loop of a period: some tenths of a second.
const MOST_PRODUCTS: f64 = 2e8;
/// The loop of a period knows its outermost poles to this: the square root of the rounding of its entries, for a double
/// pole, with room. What lies so near to the unit circle decides nothing.
const KNOWN_TO: f64 = 1e-6;

impl Rest {
    /// Whether something grows of loops, one for each side, whose sensors have these clocks.
    pub(super) fn stand_with_clocks(
        &self,
        models: &[Model],
        clocks: Clocks,
    ) -> Result<Stand, SimError> {
        match clocks {
            Clocks::Period(phases) if is_affordable(models, &phases) => {
                self.stand_over(models, &phases)
            }
            Clocks::Nearly(all) if all.iter().all(|phases| is_affordable(models, phases)) => {
                let for_a_while = all.iter().map(|phases| self.stand_over(models, phases));
                let for_a_while = for_a_while.collect::<Result<Vec<Stand>, _>>()?;
                if let Some(grows) = largest_growth(&for_a_while) {
                    return Ok(grows);
                }
                let as_if_they_stayed = self.stand_at_each_age(models)?;
                Ok(for_a_while.into_iter().fold(as_if_they_stayed, together))
            }
            Clocks::Period(_) | Clocks::Nearly(_) => Ok(match self.stand_at_each_age(models)? {
                Stand::Holds => Stand::Undecided(Doubt::ChangingAge),
                stand => stand,
            }),
        }
    }

    /// With the largest age and with none, as if they stayed.
    fn stand_at_each_age(&self, models: &[Model]) -> Result<Stand, SimError> {
        let newest: Vec<Model> =
            models.iter().map(|(it, k)| (it.clone().without_changing_ages(), *k)).collect();
        Ok(together(self.stand_of(models)?, self.stand_of(&newest)?))
    }

    /// Over a time after which all ages come again.
    fn stand_over(&self, models: &[Model], phases: &Phases) -> Result<Stand, SimError> {
        let seeing = |sensing| -> Vec<Model> {
            models.iter().map(|(it, k)| (it.seeing(sensing), *k)).collect()
        };
        let phases: Vec<Vec<Model>> = phases.iter().map(|sensing| seeing(*sensing)).collect();
        let sides = 0..models.len();
        let found = sides.map(|side| found_over(&models[side], phases.iter().map(|it| &it[side])));
        let found = found.collect::<Result<Vec<Found>, _>>()?;
        Ok(stand_of_sides(&found, Some(|| self.growth_of_motions(&phases))))
    }
}

/// True where the loop of a period is worth its time.
fn is_affordable(models: &[Model], phases: &Phases) -> bool {
    let is_long = models.iter().any(|(model, _)| model.settings().is_long());
    let (Some(looks), false) = (phases.first(), is_long) else { return false };
    let products = |(model, gains): &Model| {
        let closed = model.seeing(*looks).closed(*gains);
        let entries = closed.iter().flatten().filter(|entry| **entry != 0.0).count();
        (entries * closed.len() * phases.len()) as f64
    };
    models.iter().map(products).sum::<f64>() <= MOST_PRODUCTS
}

/// The largest growth where all of them grow.
fn largest_growth(all: &[Stand]) -> Option<Stand> {
    let radii = all.iter().map(|it| match *it {
        Stand::Grows { spectral_radius } => Some(spectral_radius),
        Stand::Holds | Stand::Undecided(_) => None,
    });
    let radii = radii.collect::<Option<Vec<f64>>>()?;
    let spectral_radius = radii.into_iter().reduce(f64::max)?;
    Some(Stand::Grows { spectral_radius })
}

/// What two ways to look at a loop say together, neither of which it is.
fn together(one: Stand, other: Stand) -> Stand {
    match (one, other) {
        (Stand::Holds, Stand::Holds) => Stand::Holds,
        (Stand::Undecided(_), _) => one,
        (_, Stand::Undecided(_)) => other,
        (Stand::Grows { .. }, _) | (_, Stand::Grows { .. }) => Stand::Undecided(Doubt::ChangingAge),
    }
}

/// What the poles of a side's loop over a period say.
fn found_over<'a>(
    oldest: &Model,
    phases: impl Iterator<Item = &'a Model>,
) -> Result<Found, SimError> {
    let mut whole: Option<Vec<Vec<f64>>> = None;
    // The product is kept near one; what is taken out of it counts as a logarithm.
    let (mut taken_out, mut samples) = (0.0, 0.0);
    for (model, gains) in phases {
        let next = model.closed(*gains);
        let mut product = match whole {
            Some(whole) => product_of(&next, &whole),
            None => next,
        };
        let size = product.iter().flatten().fold(0.0, |size: f64, it| size.max(it.abs()));
        let is_finite = product.iter().flatten().all(|it| it.is_finite());
        if !is_finite {
            return Ok(Found::Unstable(f64::INFINITY));
        }
        let by = if size > 0.0 { size } else { 1.0 };
        product.iter_mut().flatten().for_each(|it| *it /= by);
        taken_out += libm::log(by);
        samples += 1.0;
        whole = Some(product);
    }
    let Some(whole) = whole else { return found(oldest) };
    let whole = Matrix::from_rows(&whole)?;
    let grown = taken_out + libm::log(spectral_radius(&whole)?);
    let a_sample = libm::exp(grown / samples);
    if grown > KNOWN_TO {
        return Ok(Found::Unstable(a_sample));
    }
    if grown < -KNOWN_TO {
        return Ok(Found::Stable);
    }
    Ok(Found::Blurred(a_sample))
}

/// The product of two matrices by rows; most entries of the left one, which hands values on, are 0.
fn product_of(left: &[Vec<f64>], right: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let row_of = |row: &Vec<f64>| {
        let mut sum = vec![0.0; right.len()];
        for (by, row) in row.iter().zip(right).filter(|(by, _)| **by != 0.0) {
            sum.iter_mut().zip(row).for_each(|(sum, value)| *sum += by * value);
        }
        sum
    };
    left.iter().map(row_of).collect()
}
