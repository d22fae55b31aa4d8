//! Frequencies at which everything is known that does not depend on the gains.

use super::chain::Chain;
use super::control::SeriesControl;
use super::place;
use crate::complex::{Complex, modulus, quotient};
use crate::error::LtiError;
use crate::sampled::scan;

/// Places in a decade, before those that are needed between them.
const PER_DECADE: f64 = 8.0;
/// How far below the slowest pole frequencies begin to look alike.
const BELOW_POLES: f64 = 1e-3;
/// No frequency is lower, and no pole that is nearer to z = 1 counts, in units of $\tan (\omega T / 2)$.
const LOWEST: f64 = 1e-9;
/// The last place before Nyquist's frequency in even steps.
const LAST: f64 = 0.98;
/// Signs are told from here on to both ends: nearer to them rounding decides what is real.
const END: f64 = 5e-11;
/// Between two places no part of a response may turn further: the tangent of some 25 degrees, and its square.
const TURN_SQR: f64 = 0.22;
/// Halvings of a step between two places; a pole on the circle would be halved for ever.
const HALVINGS: usize = 20;

/// Places beyond which no more are put between them: each lightly damped pole needs some twenty.
const PLACES_MAX: usize = 3000;

/// What is known at one place: $d$, and $c x$ for each output, divided by their size.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Known {
    pub(super) place: f64,
    pub(super) under: Complex,
    pub(super) over: Vec<Complex>,
}

/// Places from 0 to 1, rising, close where any part turns.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Grid {
    pub(super) known: Vec<Known>,
}

impl Grid {
    /// Empty for a chain that is not sound.
    ///
    /// # Errors
    /// Poles of the open loop that are not found.
    pub(super) fn new(chain: &Chain, control: &SeriesControl) -> Result<Self, LtiError> {
        if !chain.is_sound() {
            return Ok(Self { known: Vec::new() });
        }
        let open = Open { chain, control };
        let mut places = starting_places(&chain.poles()?);
        places.sort_by(f64::total_cmp);
        places.dedup();
        let mut known: Vec<Known> = Vec::with_capacity(2 * places.len());
        for place in places {
            let next = open.at(place);
            if let Some(last) = known.last().cloned()
                && last.place >= END
                && place <= 1.0 - END
            {
                open.fill(&last, &next, HALVINGS, &mut known);
            }
            known.push(next);
        }
        Ok(Self { known })
    }
}

/// Even steps in the logarithm to both ends, the angles of the poles, the ends and what lies next to them.
fn starting_places(poles: &[Complex]) -> Vec<f64> {
    // |s| of a pole, s = ζ/(ζ + 2), is its tan(ωT/2).
    let sizes = poles.iter().map(|&zeta| modulus(quotient(zeta, zeta + 2.0)));
    let slowest = sizes.filter(|&size| size > LOWEST).fold(1.0, f64::min);
    let lowest = (BELOW_POLES * slowest).max(LOWEST);
    let step = libm::exp10(1.0 / PER_DECADE);
    let mut places = vec![0.0, END, 1.0 - END, 1.0];
    let mut tangent = lowest;
    while tangent < 1.0 {
        places.push(tangent / (1.0 + tangent));
        places.push(LAST.min(1.0 / (1.0 + tangent)));
        tangent *= step;
    }
    let angles = poles.iter().filter(|zeta| zeta.im > 0.0);
    places.extend(angles.map(|zeta| place::of_angle(libm::atan2(zeta.im, 1.0 + zeta.re))));
    places
}

/// A plant and its controller.
struct Open<'a> {
    chain: &'a Chain,
    control: &'a SeriesControl,
}

impl Open<'_> {
    fn at(&self, place: f64) -> Known {
        let zeta = place::zeta(place);
        let parts = self.chain.at(zeta);
        let of_gain = |gain| self.control.at(self.control.of_gain(gain), zeta).0 * parts.measured;
        let denominator = self.control.denominator(zeta);
        let under = parts.under * denominator;
        let fixed = core::iter::once(parts.fixed * denominator);
        let over: Vec<Complex> = fixed.chain((0..self.control.gains()).map(of_gain)).collect();
        let size = over.iter().chain([&under]).fold(0.0, |size, part| size + part.l1_norm());
        let scale = if size > 0.0 { 1.0 / size } else { 1.0 };
        Known { place, under: under * scale, over: over.iter().map(|part| part * scale).collect() }
    }

    /// Places between two, until nothing turns far from one to the next.
    fn fill(&self, from: &Known, to: &Known, halvings: usize, known: &mut Vec<Known>) {
        if halvings == 0 || known.len() > PLACES_MAX || from.is_near(to) {
            return;
        }
        let middle = self.at(scan::middle(from.place, to.place));
        self.fill(from, &middle, halvings - 1, known);
        known.push(middle.clone());
        self.fill(&middle, to, halvings - 1, known);
    }
}

impl Known {
    /// Whether each part turns little on the way to another place.
    fn is_near(&self, next: &Self) -> bool {
        let parts = self.over.iter().zip(&next.over).chain([(&self.under, &next.under)]);
        parts.into_iter().all(|(from, to)| !turns_far(*from, *to, TURN_SQR))
    }
}

/// Whether the angle between two numbers has a tangent whose square is larger; never from or to 0.
pub(super) fn turns_far(from: Complex, to: Complex, tangent_sqr: f64) -> bool {
    let (along, across) = (from.re * to.re + from.im * to.im, from.re * to.im - from.im * to.re);
    !(along >= 0.0) || across * across > tangent_sqr * along * along
}
