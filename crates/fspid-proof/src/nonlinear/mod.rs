//! A claim about the nonlinear aircraft near its trim.
//!
//! In a box of pitch, pitch rate, airspeed, angle of attack and elevator around the trim the motion lies between linear
//! ones ([`transition`]). Where one form falls under all of them with every gain, and the ellipsoid $z^T P z \le c$ keeps
//! the motion in that box at samples and between them, and no limit acts in it, every motion that begins in the
//! ellipsoid stays in the box and comes to rest at the trim: of the equations of motion, not of their linear model.
//!
//! Of a self-tuner it is asked with the gains that it comes to from its nominal ones by what its supervisor sees in that box
//! ([`near`]): the claim is of flights that begin with a reset ([`Begun`]).
//!
//! Said of: straight flight with the wings level, in still air, with the throttle of the trim, as long as the aircraft is no
//! further above or below the trim than the numbers say: the air there has any of the densities between two, of which one
//! is that of the trim. Where they are not the same the flight does not come to rest at the trim, but near it, as far as
//! another density has another trim. Further: the set-point at the trim, no load. The equations are meant as they are, not the steps in which
//! a simulation integrates them.

mod near;
mod search;
#[cfg(test)]
mod tests;
mod transition;

use fspid_aircraft::Range;
use fspid_aircraft::enclosure::{EnclosedTrim, MOTION, MotionNumbers};
use fspid_core::Gains;
use fspid_lti::Matrix;
use fspid_numeric::Scalar;
use fspid_numeric::scalar::Interval;
use fspid_sim::Controller;
use fspid_sim::loop_model::{LoopModel, Sensing};

use crate::certificate::{Certificate, Claim};
use crate::check::{NotProved, inside_limit, reach};
use crate::description::LoopDescription;
use crate::gain_set::{GainSet, KnownSlopes};
use crate::limits;
use crate::recheck::{Recheck, RecheckError};
use crate::scope::Range as Asked;

use near::Near;
pub use search::{NonlinearVerdict, NotNonlinear, prove_nonlinear};
pub use transition::Reach;
use transition::Transition;

/// What of a self-tuner a flight begins with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Begun {
    /// Any of its gains, wherever its reference model is.
    Anyhow,
    /// Its nominal gains, as after a reset, its reference model at rest at the first measurement.
    Reset,
}

/// A claim about the nonlinear aircraft.
#[derive(Clone, Debug, PartialEq)]
pub struct Nonlinear {
    /// What a flight begins with beside the ellipsoid.
    pub begun: Begun,
    /// The aircraft and its trim.
    pub aircraft: MotionNumbers,
    /// The box.
    pub reach: Reach,
    /// P.
    pub form: Matrix,
    /// ρ, at most 1.
    pub rate: f64,
    /// Level c of the ellipsoid $z^T P z \le c$ that no motion leaves.
    pub level: f64,
}

/// Result of the re-check of a claim about the nonlinear aircraft.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CheckedNonlinear {
    /// Matrices between which every sample lies.
    pub corners: usize,
    /// Inequalities that were proved.
    pub inequalities: usize,
    /// How far the pitch angle may be off, everything else at rest, to lie in the ellipsoid, rad.
    pub pitch_within_rad: f64,
    /// How far θ, q, V, α and elevator may come in the ellipsoid at samples, no more than the box.
    pub reached: [f64; MOTION],
    /// Least and most of kp, ki and kd on the way.
    pub gains: [Interval; 3],
    /// How far θ, q, V and α may stay from the trim in the end: 0 in air of one density, to which every motion comes back.
    pub remains: [f64; MOTION],
}

/// Why a claim about the nonlinear aircraft is not believed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NonlinearError {
    /// Its parts do not fit together.
    #[error("the nonlinear aircraft: {what}")]
    Malformed {
        /// What is wrong.
        what: &'static str,
    },
    /// The box leaves what is known of the aircraft.
    #[error("the nonlinear aircraft: {what} leaves {allowed} within the box")]
    Beyond {
        /// What.
        what: &'static str,
        /// What it leaves.
        allowed: &'static str,
    },
    /// An inequality is not proved.
    #[error("the nonlinear aircraft: {0}")]
    Inequality(Box<RecheckError>),
}

impl From<NotProved> for NonlinearError {
    fn from(reason: NotProved) -> Self {
        Self::Inequality(Box::new(reason.into()))
    }
}

impl From<RecheckError> for NonlinearError {
    fn from(reason: RecheckError) -> Self {
        Self::Inequality(Box::new(reason))
    }
}

/// What a loop must not have, of which a claim about the nonlinear aircraft says nothing; none where it has none of it.
#[must_use]
pub(crate) fn not_covered(description: &LoopDescription) -> Option<&'static str> {
    if description.resolves_in_steps() {
        return Some(
            "a sensor resolves in steps; resolution_deg and resolution_deg_s need to be 0",
        );
    }
    if description.actuator.bias_rad() != 0.0 {
        return Some("the actuator has a bias, so that rest is not at the trim");
    }
    if description.only_supervisor_sees_rate() && description.rate != Sensing::DIRECT {
        return Some(
            "the supervisor alone sees the pitch rate, by a sensor with a delay or a scale error",
        );
    }
    if let Some(what) = limits::not_covered(description) {
        return Some(what);
    }
    // One row and column each of θ, q, V, α.
    (description.denominator.len() != 5)
        .then_some("its linear model from elevator to pitch is not of order 4")
}

impl Nonlinear {
    /// The claim as a certificate of its own, about the return to the trim.
    fn alone(&self, certificate: &Certificate) -> Certificate {
        Certificate {
            range: Asked::REST,
            claim: Claim::CommonQuadratic { form: self.form.clone(), rate: self.rate },
            level: Some(self.level),
            steps: None,
            commanded: None,
            family: None,
            // Of the linear model, with a form of their own.
            disturbances: Vec::new(),
            nonlinear: None,
            ..certificate.clone()
        }
    }

    /// Encloses the motion anew and proves that the form falls, that the ellipsoid keeps to the box, and that no limit acts
    /// in it.
    pub(crate) fn check(
        &self,
        certificate: &Certificate,
        set: &GainSet,
        stops: fn() -> bool,
    ) -> Result<CheckedNonlinear, NonlinearError> {
        let description = &certificate.description;
        if let Some(what) = not_covered(description) {
            return Err(NonlinearError::Malformed { what });
        }
        if certificate.output_factor.to_bits() != 1.0_f64.to_bits() {
            let what = "the claim is of a loop at another output scale";
            return Err(NonlinearError::Malformed { what });
        }
        if !self.reach.is_allowed() {
            return Err(NonlinearError::Malformed { what: "a side of the box is not above 0" });
        }
        let Range { min, max } = self.aircraft.densities_kg_m3;
        if !(min <= self.aircraft.density_kg_m3 && self.aircraft.density_kg_m3 <= max) {
            let what = "the density of the trim is not among those of the air";
            return Err(NonlinearError::Malformed { what });
        }
        let trim = self.aircraft.trim();
        let what = "no trim is found, or not only one";
        self.is_known_in(&trim.ok_or(NonlinearError::Malformed { what })?)?;
        let transition = Transition::of(description, &self.aircraft, &self.reach)?;
        let alone = self.alone(certificate);
        let (known, settings) = (KnownSlopes::default(), description.settings());
        let corners = transition.corners.len();
        let plants = transition.corners.into_iter();
        let mut loops = plants.map(|plant| LoopModel::new(plant, settings.clone())).peekable();
        let what = "no motion is enclosed";
        // What a supervisor sees, and what arrives at the servo, does not depend on the plant.
        let first = loops.peek().ok_or(NonlinearError::Malformed { what })?;
        let flown = self.flown(certificate, set, first)?;
        let within = (&transition.within, transition.drifts.as_slice());
        let mut inequalities = self.keeps_to_the_box(first, &flown, within)?;
        let mut pitch_within_rad = f64::INFINITY;
        for model in loops {
            let found = Recheck::with(&alone, model, flown.clone(), &known)?.until(stops).run()?;
            inequalities += found.inequalities;
            pitch_within_rad = pitch_within_rad.min(found.pitch_within_rad.unwrap_or(0.0));
        }
        if !(pitch_within_rad > 0.0) {
            let what = "no pitch angle at all lies in the ellipsoid";
            return Err(NonlinearError::Malformed { what });
        }
        let reached = self.reached(description, self.level)?;
        let remains = match self.level_left(&transition.drifts)? {
            Some(level) => self.reached(description, level)?,
            None => [0.0; MOTION],
        };
        let gains = flown.bounds();
        Ok(CheckedNonlinear { corners, inequalities, pitch_within_rad, reached, gains, remains })
    }

    /// The gains that fly: all of the controller's, or those that it comes to in the ellipsoid.
    fn flown(
        &self,
        certificate: &Certificate,
        set: &GainSet,
        model: &LoopModel<Interval>,
    ) -> Result<GainSet, NonlinearError> {
        let controller = &certificate.description.controller;
        let (Begun::Reset, Controller::SelfTuning(fspid)) = (self.begun, controller) else {
            return Ok(set.clone());
        };
        let what = "nothing bounds the reference model";
        let near = Near::of(fspid).ok_or(NonlinearError::Malformed { what })?;
        let most = near.within(model, &self.reach, (&self.form, self.level))?;
        let what = "nothing bounds the gains by what the supervisor sees";
        let gains = near.gains(most);
        gains.ok_or(NonlinearError::Malformed { what })
    }

    /// Proves that the box stays where the derivatives are worth something, away from the elevator's stops, and flying.
    fn is_known_in(&self, trim: &EnclosedTrim<Interval>) -> Result<(), NonlinearError> {
        let around = |centre: Interval, reach: f64| centre + Interval::between(-reach, reach);
        let [_, _, speed, alpha, elevator] = self.aircraft.at_trim(trim);
        let [_, _, by_speed, by_alpha, by_elevator] = self.reach.motion;
        let inside =
            |it: Interval, least: f64, most: f64| least <= it.lower() && it.upper() <= most;
        let beyond = |what, allowed| Err(NonlinearError::Beyond { what, allowed });
        let MotionNumbers { alpha_rad, elevator_rad, airspeeds_m_s, .. } = &self.aircraft;
        if !inside(around(alpha, by_alpha), alpha_rad.min, alpha_rad.max) {
            return beyond("the angle of attack", "the range that the derivatives are known for");
        }
        if !inside(around(elevator, by_elevator), elevator_rad.min, elevator_rad.max) {
            return beyond("the elevator", "its travel");
        }
        let slowest = airspeeds_m_s.min.max(f64::MIN_POSITIVE);
        if !inside(around(speed, by_speed), slowest, airspeeds_m_s.max) {
            return beyond("the airspeed", "the range that the derivatives are known for");
        }
        Ok(())
    }

    /// Proves that within a sample, wherever it begins in the ellipsoid, the motion stays strictly inside of the box.
    ///
    /// Until a motion leaves the box it is one of those enclosed, and of those none comes to the faces.
    fn keeps_to_the_box(
        &self,
        model: &LoopModel<Interval>,
        set: &GainSet,
        (within, drifts): (&[[Vec<Interval>; MOTION]; 2], &[Interval]),
    ) -> Result<usize, NonlinearError> {
        // At the end of a sample so much less is left as the air may do by then.
        let left = |place: usize, end: usize| {
            let drift = if end == 0 { Interval::ZERO } else { drifts[place] };
            (Interval::point(self.reach.motion[place]) - drift).lower().next_down()
        };
        let mut rows = Vec::new();
        for (_, held) in set.held_corners() {
            let arriving = model.arriving_row(points(held.gains));
            rows.push((arriving.clone(), self.reach.command_rad.next_down()));
            for (end, own) in within.iter().enumerate() {
                let own = own.iter().enumerate();
                rows.extend(own.map(|(place, row)| (of_loop(row, &arriving), left(place, end))));
            }
        }
        for (row, limit) in &rows {
            inside_limit(&self.form, self.level, row, *limit)?;
        }
        Ok(rows.len())
    }

    /// Proves that air of other densities takes no motion out of the ellipsoid; answers the level that motions come down to,
    /// none where they come to rest.
    ///
    /// With $d$ what the air adds in a sample, $|z^+|_P \le \rho |z|_P + |d|_P$ and $|d|_P \le b = \sum_i |d_i| \sqrt{P_{ii}}$:
    ///
    /// $$ b \le (1 - \rho) \sqrt{c}, \qquad \limsup |z|_P \le \frac{b}{1 - \rho} $$
    fn level_left(&self, drifts: &[Interval]) -> Result<Option<f64>, NonlinearError> {
        if drifts.iter().all(|drift| drift.upper() <= 0.0) {
            return Ok(None);
        }
        let most = drifts.iter().enumerate().fold(Interval::ZERO, |sum, (place, drift)| {
            let own = self.form.get(place, place).unwrap_or(f64::NAN);
            sum + *drift * Interval::point(own).sqrt()
        });
        let left = Interval::ONE - Interval::point(self.rate);
        let root = Interval::point(most.upper()) / left;
        let level = (root * root).upper();
        // Written so that NaN is too much.
        if left.lower() > 0.0 && level <= self.level {
            return Ok(Some(level));
        }
        let what =
            "air of other densities takes motions out of the ellipsoid faster than the form falls";
        Err(NonlinearError::Malformed { what })
    }

    /// How far everything may come at samples, within a level.
    fn reached(
        &self,
        description: &LoopDescription,
        level: f64,
    ) -> Result<[f64; MOTION], NonlinearError> {
        let size = description.states();
        let mut reached = [0.0; MOTION];
        for (place, reached) in reached.iter_mut().enumerate() {
            let unit = |column| if column == place { Interval::ONE } else { Interval::ZERO };
            let row: Vec<Interval> = (0..size).map(unit).collect();
            *reached = reach(&self.form, level, &row)?;
        }
        Ok(reached)
    }
}

fn points(gains: Gains<f64>) -> Gains<Interval> {
    let Gains { kp, ki, kd } = gains;
    Gains { kp: Interval::point(kp), ki: Interval::point(ki), kd: Interval::point(kd) }
}

/// A row over states of the plant and the arriving command, as one over the states of the loop.
fn of_loop(row: &[Interval], arriving: &[Interval]) -> Vec<Interval> {
    let by_command = row.last().copied().unwrap_or(Interval::ZERO);
    let own = row.len().saturating_sub(1);
    let state = |(place, arriving): (usize, &Interval)| {
        let through = by_command * *arriving;
        if place < own { row[place] + through } else { through }
    };
    arriving.iter().enumerate().map(state).collect()
}
