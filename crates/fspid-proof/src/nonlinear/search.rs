//! Looks for a box and a form for the nonlinear aircraft, in ordinary arithmetic.
//!
//! The box has the shape of the flight from a pitch angle that is off, and grows for as long as the ellipsoid inside of it
//! holds more of the pitch angle; then each side is tried wider and narrower. What is found is proved as any claim is that
//! was read.

use std::borrow::Cow;

use fspid_aircraft::enclosure::{MOTION, MotionNumbers};
use fspid_core::Gains;
use fspid_lti::Matrix;
use fspid_numeric::scalar::Interval;
use fspid_sim::Controller;
use fspid_sim::loop_model::{LoopModel, SampledPlant};

use super::near::Near;
use super::transition::{DENSITY, Reach, Transition};
use super::{Begun, CheckedNonlinear, Nonlinear, NonlinearError, not_covered, of_loop};
use crate::certificate::Certificate;
use crate::description::{LoopDescription, NotProvable};
use crate::gain_set::GainSet;
use crate::prove::{Effort, Prover};
use crate::scope::Asked;
use crate::solve::{self, WidestProblem, widest};

/// Of the sides of the box the form is made for so much, the rest being for motions within a sample and for rounding.
const SIDES: f64 = 0.985;
/// The form is made for a box that is larger than the one that is claimed by this share.
const ROOM: f64 = 0.1;
/// Weight of what one sample may be off by.
const BLUR: f64 = 6.0;
/// Shares of the decay of the linear loop at which the form still falls: what is not told apart asks for room.
const SHARES: [f64; 3] = [0.75, 0.9, 0.5];
/// A box that is not proved is made smaller by this factor, so many times at most.
const SHRUNK: f64 = 0.88;
const SMALLER: usize = 16;
/// Pitch angle that the first box is made for, rad: a quarter of a degree.
const FIRST_RAD: f64 = 4.4e-3;
/// Factors between the boxes that are tried, coarse and fine.
const GROWTH: f64 = 1.8;
const SIDE: f64 = 1.25;
/// Sweeps over the sides.
const SWEEPS: usize = 2;
/// Most boxes that are tried; fewer where each has gains of its own, which makes a form eight times the work.
const MOST_BOXES: usize = 60;
const MOST_BOXES_NEAR: usize = 24;
/// The first box of gains of its own is smaller by this factor. Chosen, as the two above.
const FIRST_NEAR: f64 = 0.25;
/// A level is tried so many times, each time smaller.
const LEVELS: i32 = 8;
/// Shares of the decay at the corners that are claimed, if they are proved.
const RATES: [f64; 3] = [0.8, 0.5, 0.2];
/// Numbers of the motion before this one bend little: pitch and pitch rate.
const STIFF: usize = 2;
/// Samples of the flight that the box has its shape of.
const FLIGHT_SAMPLES: usize = 6000;

/// Outcome of the search for a proof of the nonlinear aircraft.
#[derive(Clone, Debug, PartialEq)]
pub enum NonlinearVerdict {
    /// Proved, with what its re-check found.
    Proved(Box<Nonlinear>, CheckedNonlinear),
    /// Not proved.
    Open(NotNonlinear),
}

/// Why nothing is proved of the nonlinear aircraft.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NotNonlinear {
    /// The loop has something of which the claim does not speak.
    #[error("{0}")]
    NotCovered(&'static str),
    /// No trim is found.
    #[error("no straight flight is found that the derivatives hold, or not only one")]
    NoTrim,
    /// However small the box, no form falls in it.
    #[error(
        "however small the box around the trim, no form was found that falls under all motions in it"
    )]
    NoForm,
    /// What was found is not proved.
    #[error("what was found is not proved: {0}")]
    NotProved(NonlinearError),
}

/// Searches for an invariant neighbourhood of the trim in which motions of the nonlinear aircraft converge to it.
///
/// # Errors
/// As [`certify`](crate::certify).
pub fn prove_nonlinear(
    certificate: &Certificate,
    aircraft: &MotionNumbers,
    effort: &Effort,
) -> Result<NonlinearVerdict, NotProvable> {
    let description = &certificate.description;
    if let Some(what) = not_covered(description) {
        return Ok(NonlinearVerdict::Open(NotNonlinear::NotCovered(what)));
    }
    let asked = Asked::rest();
    let prover = Prover::new(description, &asked, effort)?;
    let set = prover.set(1.0);
    let near = match &description.controller {
        Controller::Fixed(_) => None,
        Controller::SelfTuning(fspid) => match Near::of(fspid) {
            Some(near) => Some(near),
            None => {
                let what = "how far the reference model goes from where it begins is not bounded";
                return Ok(NonlinearVerdict::Open(NotNonlinear::NotCovered(what)));
            }
        },
    };
    let search = Search { prover: &prover, set: &set, near, certificate, aircraft, effort };
    let found = search.run();
    if (effort.stops)() {
        return Err(NotProvable::Stopped);
    }
    Ok(match found {
        Ok((claim, checked)) => NonlinearVerdict::Proved(Box::new(claim), checked),
        Err(reason) => NonlinearVerdict::Open(reason),
    })
}

struct Search<'a> {
    prover: &'a Prover<'a>,
    set: &'a GainSet,
    /// Where only gains are asked for that come of what is seen near the trim.
    near: Option<Near<'a>>,
    certificate: &'a Certificate,
    aircraft: &'a MotionNumbers,
    effort: &'a Effort,
}

/// A box with the form that was made for it, and how much of the pitch angle its ellipsoid holds, rad.
#[derive(Clone)]
struct Found {
    reach: Reach,
    form: Matrix,
    /// How fast it falls between the corners.
    rate: f64,
    pitch_rad: f64,
}

impl Search<'_> {
    fn description(&self) -> &LoopDescription {
        &self.certificate.description
    }

    fn begun(&self) -> Begun {
        if self.near.is_some() { Begun::Reset } else { Begun::Anyhow }
    }

    /// The gains that may fly in a box.
    fn set_in(&self, reach: &Reach) -> Option<Cow<'_, GainSet>> {
        let Some(near) = &self.near else { return Some(Cow::Borrowed(self.set)) };
        near.gains(near.in_box(reach)).map(Cow::Owned)
    }

    fn run(&self) -> Result<(Nonlinear, CheckedNonlinear), NotNonlinear> {
        let trim = self.aircraft.trim().ok_or(NotNonlinear::NoTrim)?;
        let probe = |reach| Nonlinear {
            begun: self.begun(),
            aircraft: *self.aircraft,
            reach,
            form: Matrix::identity(1),
            rate: 1.0,
            level: 1.0,
        };
        let known = |reach| probe(reach).is_known_in(&trim).is_ok();
        let shape = self.shape().ok_or(NotNonlinear::NoForm)?;
        let (mut best, mut doubt) = (None::<(Nonlinear, CheckedNonlinear)>, NotNonlinear::NoForm);
        let slowest =
            self.slowest(shape.scaled(FIRST_NEAR * FIRST_RAD)).ok_or(NotNonlinear::NoForm)?;
        for share in SHARES {
            if self.near.is_some() && best.is_some() {
                break;
            }
            let rate = 1.0 - share * (1.0 - slowest);
            let Some(mut found) = self.largest(shape, rate, &known) else { continue };
            let most = |best: &Option<(Nonlinear, CheckedNonlinear)>| {
                best.as_ref().map_or(0.0, |(_, checked)| checked.pitch_within_rad)
            };
            // Somewhat less than what ordinary arithmetic finds, until it is proved.
            for _ in 0..SMALLER {
                if found.pitch_rad <= most(&best) {
                    break;
                }
                match self.proved(&found) {
                    Ok(proved) if proved.1.pitch_within_rad > most(&best) => {
                        best = Some(proved);
                        break;
                    }
                    Ok(_) => break,
                    Err(reason) => doubt = NotNonlinear::NotProved(reason),
                }
                let reach = found.reach.scaled(SHRUNK);
                let Some(next) = self.form_for(reach, rate, Some(&found.form)) else { break };
                found = next;
            }
        }
        best.ok_or(doubt)
    }

    /// The box with the most of the pitch angle that is found.
    fn largest(&self, shape: Reach, rate: f64, known: &impl Fn(Reach) -> bool) -> Option<Found> {
        let (first, most_boxes) = match self.near {
            Some(_) => (FIRST_NEAR * FIRST_RAD, MOST_BOXES_NEAR),
            None => (FIRST_RAD, MOST_BOXES),
        };
        let mut boxes = 0;
        let mut tried = |reach: Reach, best: &Option<Found>| -> Option<Found> {
            boxes += 1;
            if boxes > most_boxes || (self.effort.stops)() || !known(reach) {
                return None;
            }
            let found = self.form_for(reach, rate, best.as_ref().map(|it| &it.form))?;
            let most = best.as_ref().map_or(0.0, |best| best.pitch_rad);
            (found.pitch_rad > 1.01 * most).then_some(found)
        };
        let mut best = None;
        let mut size = first;
        while let Some(found) = tried(shape.scaled(size), &best) {
            best = Some(found);
            size *= GROWTH;
        }
        best.as_ref()?;
        for _ in 0..SWEEPS {
            let mut moved = false;
            // All sides together first, then each.
            let sides = core::iter::once(None).chain((0..=MOTION).map(Some));
            for (side, factor) in sides.flat_map(|side| [(side, SIDE), (side, 1.0 / SIDE)]) {
                let Some(from) = best.as_ref().map(|it| it.reach) else { continue };
                let mut reach = from;
                let all = reach.motion.iter_mut().chain([&mut reach.command_rad]);
                for (place, it) in all.enumerate() {
                    if side.is_none_or(|side| side == place) {
                        *it *= factor;
                    }
                }
                if let Some(found) = tried(reach, &best) {
                    (best, moved) = (Some(found), true);
                }
            }
            if !moved {
                break;
            }
        }
        best
    }

    /// How far each side comes in the linear flight from a pitch angle of 1 rad, everything else at rest.
    fn shape(&self) -> Option<Reach> {
        let nowhere = Reach { motion: [0.0; MOTION], command_rad: 0.0 };
        let model = self.loops(&nowhere).ok()?.1.first()?.midpoint();
        let [kp, ki, kd] = self.set.rest.map(Interval::midpoint);
        let gains = Gains { kp, ki, kd };
        let (matrix, arriving) = (model.closed(gains), model.arriving_row(gains));
        let mut state = model.pitch_off(1.0);
        let mut most = nowhere;
        for _ in 0..FLIGHT_SAMPLES {
            let along =
                |row: &Vec<f64>| row.iter().zip(&state).map(|(by, at)| by * at).sum::<f64>();
            for (most, at) in most.motion.iter_mut().zip(&state) {
                *most = most.max(at.abs());
            }
            most.command_rad = most.command_rad.max(along(&arriving).abs());
            state = matrix.iter().map(along).collect();
        }
        most.is_allowed().then_some(most)
    }

    /// The factor per sample of the slowest motion of the linear loop, at the gains that span all of them.
    fn slowest(&self, first: Reach) -> Option<f64> {
        let nowhere = Reach { motion: [0.0; MOTION], command_rad: 0.0 };
        let model = self.loops(&nowhere).ok()?.1.first()?.midpoint();
        let matrices = self.prover.matrices_of(&[model], &*self.set_in(&first)?)?;
        let radii = matrices.iter().map(|it| fspid_lti::spectral_radius(it).ok());
        radii.collect::<Option<Vec<_>>>()?.into_iter().reduce(f64::max)
    }

    fn loops(
        &self,
        reach: &Reach,
    ) -> Result<(Transition, Vec<LoopModel<Interval>>), NonlinearError> {
        let transition = Transition::of(self.description(), self.aircraft, reach)?;
        let settings = self.description().settings();
        let plants = transition.corners.iter().cloned();
        let loops = plants.map(|plant| LoopModel::new(plant, settings.clone())).collect();
        Ok((transition, loops))
    }

    /// Loops between corners that the form is made for: θ and q bend little, and stand in their middle.
    fn apart(&self, transition: &Transition) -> Vec<LoopModel<f64>> {
        let bits = transition.sides.iter().enumerate();
        let stands = |number: usize| number < STIFF || number == DENSITY;
        let fixed =
            bits.filter(|(_, number)| stands(**number)).fold(0, |sum, (bit, _)| sum | 1 << bit);
        let corners = &transition.corners;
        let settings = self.description().settings();
        let kept = (0..corners.len()).filter(|corner| corner & fixed == 0);
        let middle = |corner: usize| {
            let own = (0..corners.len()).filter(|it| it & !fixed == corner);
            let (mut sum, mut count) = (vec![0.0; corners[corner].rows.len()], 0.0);
            for other in own {
                count += 1.0;
                for (sum, it) in sum.iter_mut().zip(&corners[other].rows) {
                    *sum += it.midpoint();
                }
            }
            let rate = corners[corner].rate.iter().map(|it| it.midpoint()).collect();
            let rows = sum.into_iter().map(|it| it / count).collect();
            let plant = SampledPlant { states: corners[corner].states, rows, rate };
            LoopModel::new(plant, settings.clone())
        };
        kept.map(middle).collect()
    }

    /// A form for a box, with the widest ellipsoid inside of it.
    fn form_for(&self, reach: Reach, rate: f64, known: Option<&Matrix>) -> Option<Found> {
        let (transition, loops) = self.loops(&reach.scaled(1.0 + ROOM)).ok()?;
        let middles = self.apart(&transition);
        let set = self.set_in(&reach)?;
        let matrices = self.prover.matrices_of(&middles, &set)?;
        let direction = middles.first()?.pitch_off(1.0);
        let mut rows = self.prover.limited(&set)?;
        rows.extend(self.sides((&transition, loops.first()?), &set, reach));
        rows.extend(self.seen(loops.first()?, &reach));
        let directions = directions(&direction, (&transition, &reach, rate));
        let problem =
            WidestProblem { matrices: &matrices, rows: &rows, directions: &directions, rate };
        let effort = solve::Effort { stops: self.effort.stops, ..solve::Effort::default() };
        let from = |form: &Matrix| widest(&problem, form, &effort);
        let form =
            known.and_then(from).or_else(|| from(&self.prover.common_at(&matrices, rate)?))?;
        let size: f64 = (0..direction.len())
            .flat_map(|i| (0..direction.len()).map(move |j| (i, j)))
            .map(|(i, j)| direction[i] * form.get(i, j).unwrap_or(f64::NAN) * direction[j])
            .sum();
        let pitch_rad = 1.0 / size.sqrt();
        pitch_rad.is_finite().then_some(Found { reach, form, rate, pitch_rad })
    }

    /// Rows of what has to stay in the box, each over its side.
    fn sides(
        &self,
        (transition, model): (&Transition, &LoopModel<Interval>),
        set: &GainSet,
        reach: Reach,
    ) -> Vec<Vec<f64>> {
        let mut rows = Vec::new();
        for (_, held) in set.held_corners() {
            let arriving = model.arriving_row(super::points(held.gains));
            let over = |it: &Interval| it.midpoint() / (SIDES * reach.command_rad);
            rows.push(arriving.iter().map(over).collect());
            for (end, own) in transition.within.iter().enumerate() {
                for ((place, row), side) in own.iter().enumerate().zip(reach.motion) {
                    let drift = if end == 0 { 0.0 } else { transition.drifts[place].upper() };
                    let room = SIDES * side - drift - reach.blur_of(row);
                    // Where nothing is left no form is wide enough.
                    let over = |it: Interval| it.midpoint() / room.max(f64::EPSILON * side);
                    rows.push(of_loop(row, &arriving).into_iter().map(over).collect());
                }
            }
        }
        rows
    }

    /// Rows of what a supervisor sees that the box does not bound by itself, each over its most in it.
    fn seen(&self, model: &LoopModel<Interval>, reach: &Reach) -> Vec<Vec<f64>> {
        let Some(near) = &self.near else { return Vec::new() };
        let over = |(row, most): (Vec<Interval>, f64)| {
            row.iter().map(|it| it.midpoint() / (SIDES * most)).collect()
        };
        near.rows(model, reach).into_iter().map(over).collect()
    }

    /// The claim with the largest level that is proved, and then the best rate of those that are tried.
    fn proved(&self, found: &Found) -> Result<(Nonlinear, CheckedNonlinear), NonlinearError> {
        let claim = |level: f64, rate: f64| {
            let (aircraft, reach, form) = (*self.aircraft, found.reach, found.form.clone());
            Nonlinear { begun: self.begun(), aircraft, reach, form, rate, level }
        };
        let checked =
            |claim: &Nonlinear| claim.check(self.certificate, self.set, self.effort.stops);
        let rates = RATES.map(|share| 1.0 - share * (1.0 - found.rate));
        let mut last = NonlinearError::Malformed { what: "no level was tried" };
        for number in 0..LEVELS {
            let level = 1.0 - 0.02 * f64::from(number);
            let mut proved = |rate: f64| {
                let claim = claim(level, rate);
                checked(&claim).map(|it| (claim, it)).map_err(|reason| last = reason).ok()
            };
            // In air of several densities only what falls at a rate keeps motions near.
            let plain = if self.aircraft.height_m > 0.0 { None } else { Some(proved(1.0)) };
            if plain == Some(None) {
                continue;
            }
            if let Some(found) = rates.into_iter().find_map(proved).or(plain.flatten()) {
                return Ok(found);
            }
        }
        Err(last)
    }
}

/// What the ellipsoid is to hold: the pitch angle, and, with weight, what one sample may be off by.
///
/// Of states that are off by b at the end of a sample the root of the form may grow by $\sqrt{P_{ii}} b_i$, where the rate
/// has room for $1 - \rho$ at the edge.
fn directions(
    pitch: &[f64],
    (transition, reach, rate): (&Transition, &Reach, f64),
) -> Vec<Vec<f64>> {
    let size = pitch.len();
    let scaled = |row: &[f64], by: f64| row.iter().map(|it| by * it).collect::<Vec<f64>>();
    let [most, ..] = reach.motion;
    let mut directions = vec![scaled(pitch, most)];
    let off = transition.blurs.iter().zip(&transition.drifts);
    let off = off.map(|(blur, drift)| blur + drift.upper());
    for (place, blur) in off.enumerate().filter(|(_, blur)| *blur > 0.0) {
        let mut unit = vec![0.0; size];
        unit[place] = BLUR * blur / (1.0 - rate);
        directions.push(unit);
    }
    directions
}
