//! Where a search for bounds of disturbances looks whose forms move with the gains.

use fspid_core::Gains;
use fspid_numeric::scalar::Interval;

use super::Prover;
use super::bounded::Sides;
use super::disturbed::{Place, Places};
use crate::certificate::BoundedRate;
use crate::gain_set::GainSet;
use crate::recheck::{Recheck, RecheckError};
use crate::solve::{fastest_moving_form, kept_of, motions_from};

/// As in the search for stability, gains are left away that lie outside of the others by no more than this share of half
/// their extent; the gain is then asked of more.
const THINNED: [f64; 2] = [0.2, 0.02];
/// Steps along each gain between which a form that was found is asked as well.
const STEPS: usize = 3;

/// Places for a claim, with a form that decreases at all of them: one that falls about as fast as any, or, where none is
/// found, that of the claim.
pub(super) fn places(
    prover: &Prover<'_>,
    recheck: &Recheck<'_>,
    set: &GainSet,
    claim: &BoundedRate,
) -> Result<Option<Places>, RecheckError> {
    let sides = Sides::of(set);
    let changes: Vec<f64> = sides.moving.iter().map(|&gain| claim.changes[gain]).collect();
    let place = |now: Vec<f64>| -> Result<Place, RecheckError> {
        let gains = enclosed(sides.gains(&now));
        let next = motions_from(&now, &changes);
        Ok(Place { at: recheck.driven_at(gains)?, now, next })
    };
    let of = |tolerance: f64| set.hull_within(tolerance).into_iter().map(|it| sides.of_gains(it));
    let spanning: Vec<Vec<f64>> = of(THINNED[0]).collect();
    let asked = |now: &Vec<f64>| sides.part(set, now.iter().map(|it| [*it, *it]).collect());
    let between = between(sides.moving.len()).into_iter().filter(|now| asked(now).is_some());
    let solved = spanning.iter().cloned().chain([middle(&spanning)]).map(place);
    let solved = solved.collect::<Result<Vec<Place>, RecheckError>>()?;
    let all = of(THINNED[1]).chain(between).map(place);
    let all = all.collect::<Result<Vec<Place>, RecheckError>>()?;
    let own = core::iter::once(0).chain(sides.moving.iter().map(|gain| gain + 1));
    let own = own.map(|part| claim.forms[part].clone()).collect();
    let mut places = Places { solved, all, start: own, moving: sides.moving.clone() };
    let fastest = prover.moving_problem(set, claim.changes, |problem| {
        fastest_moving_form(problem, &prover.search())
    });
    let corners = places.motions();
    let falls = |forms: &Vec<_>| kept_of(forms, &corners).is_some_and(|kept| kept < 1.0);
    if let Some(fastest) = fastest.flatten().filter(falls) {
        places.start = fastest;
    }
    Ok(falls(&places.start).then_some(places))
}

fn enclosed(Gains { kp, ki, kd }: Gains<f64>) -> Gains<Interval> {
    Gains { kp: Interval::point(kp), ki: Interval::point(ki), kd: Interval::point(kd) }
}

/// The mean of some gains.
fn middle(places: &[Vec<f64>]) -> Vec<f64> {
    let share = 1.0 / places.len() as f64;
    let along = |gain: usize| places.iter().map(|place| share * place[gain]).sum();
    (0..places.first().map_or(0, Vec::len)).map(along).collect()
}

/// A grid over the box.
fn between(gains: usize) -> Vec<Vec<f64>> {
    let count = (STEPS + 1).pow(u32::try_from(gains).unwrap_or(0));
    let along = |number: usize, gain: u32| {
        let step = number / (STEPS + 1).pow(gain) % (STEPS + 1);
        2.0 * step as f64 / STEPS as f64 - 1.0
    };
    let gains = u32::try_from(gains).unwrap_or(0);
    (0..count).map(|number| (0..gains).map(|gain| along(number, gain)).collect()).collect()
}
