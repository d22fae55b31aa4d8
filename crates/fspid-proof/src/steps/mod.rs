//! Steps from rest with the limits acting on the way.
//!
//! An ellipsoid in which no limit acts is small: a step of a degree leaves it at once. But the loop that is at rest when its
//! set-point steps has one state alone, and all flights of a range of steps differ in two numbers, set-point and load. They
//! are flown together, box by box, in affine arithmetic: limits, rates and anti-windup as the simulator has them, gains
//! anywhere between their bounds over the cells that the supervisor may see. Where all flights of a box are in an ellipsoid
//! around their rest in which no limit acts, the linear proof takes over.

mod affine;
mod ball;
mod cut;
mod flights;
mod gains;
mod near;
mod sample;
mod servo;
mod terminal;
#[cfg(test)]
mod tests;
mod tuned;
mod wide;

use fspid_core::{Fspid, IntegralForm, Law, SelfTuner};
use fspid_fuzzy::Output;
use fspid_fuzzy::system::System;
use fspid_numeric::scalar::Interval;
use fspid_sim::Controller;
use fspid_sim::loop_model::LoopModel;

use crate::certificate::{Certificate, Claim};
use crate::description::LoopDescription;
use crate::gain_set::GainSet;
use crate::limits;
use crate::rest::Rest;
use crate::scope::Range;
use flights::{Landed, Patch, Ready};
use near::system;
use sample::{Moment, Stop};
use terminal::NearRest;
use tuned::Tuner;

pub(crate) use near::corners_within;

pub use terminal::{NearGains, Terminal};

/// Longest flight of a set, s, and in samples.
const LONGEST_S: f64 = 400.0;
const MOST_SAMPLES: usize = 40_000;
/// Most work of a re-check, in samples of gains that stand still, and how many of these one of gains that move takes: some
/// seconds. A search may take so many times as much.
const MOST_CHECKED: usize = 280_000;
const MOVING: usize = 6;
/// The same where they remember: some dozens of sets of half a minute, each of them flown with hundreds of unknowns.
const MOST_CHECKED_REMEMBERED: usize = 16 * MOST_CHECKED;
const SEARCHED: usize = 6;
/// Most boxes along the set-points.
pub const MOST_PIECES: usize = 4096;
/// Most parts of the loads.
pub const MOST_LOADS: usize = 64;
/// The narrowest box that is flown, as a share of the set-points that are asked for.
const NARROWEST: f64 = 1.0 / 2048.0;

/// Steps from rest that end at their set-point, limits acting on the way.
///
/// From rest at the trim without a load, a step of the set-point by up to `setpoint_rad` and at the same sample one of a load
/// at the elevator by up to `load_rad`, either way, both of which then stay. Gains that remember begin at the nominal ones, or
/// at those that a long rest has brought them to, from wherever they were ([`Stepped::rested_s`]).
#[derive(Clone, Debug, PartialEq)]
pub struct Steps {
    /// Largest step, rad.
    pub setpoint_rad: f64,
    /// Largest load, rad of elevator.
    pub load_rad: f64,
    /// Near rest.
    pub terminal: Terminal,
    /// Where boxes end along the set-points, rad; from the first to the last.
    pub ends: Vec<f64>,
    /// Parts that the loads are flown in.
    pub loads: usize,
}

/// What was proved of steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stepped {
    /// Largest step, rad.
    pub setpoint_rad: f64,
    /// Largest load, rad of elevator.
    pub load_rad: f64,
    /// Sets of flights.
    pub sets: usize,
    /// No limit acts any more after so long, s.
    pub settled_s: f64,
    /// In some flight a limit may act.
    pub limited: bool,
    /// Of gains that remember, how long a rest has to last before a step that is not at the controller's first sample, s: they
    /// are then at those of rest, but for a thousandth of the way.
    pub rested_s: Option<f64>,
}

/// Why nothing is claimed of steps.
pub(crate) fn not_covered(description: &LoopDescription) -> Option<&'static str> {
    if let Some(what) = limits::not_covered(description) {
        return Some(what);
    }
    if description.resolves_in_steps() {
        return Some("a sensor that resolves in steps is not flown in sets");
    }
    if description.controller.config().integral == IntegralForm::Literal {
        return Some("the literal integral is not flown in sets");
    }
    if let Controller::SelfTuning(fspid) = &description.controller {
        return not_flown(fspid);
    }
    None
}

/// What of a self-tuner is not flown in sets.
fn not_flown(fspid: &Fspid<f64>) -> Option<&'static str> {
    let tuner = fspid.tuner();
    if tuner.settings().law == Law::Memoryless {
        return (!tuner.is_plain()).then_some(
            "gains that jump by a supervisor that is a network or whose rules conclude numbers, that sees something else than error and change, through sets that are not even, or whose gains something follows are not flown in sets",
        );
    }
    if Tuner::of(fspid).is_none() {
        return Some(
            "gains that remember are flown in sets where they leak, by rules that conclude numbers, refuse no input and have no dead zone, and see the change of the error or the error of a model",
        );
    }
    // Rest then depends on the gains, which come to theirs as late as they like.
    let weight = fspid.config().setpoint_weights.proportional;
    let holds = weight.to_bits() != 1.0_f64.to_bits()
        || tuner.settings().gain_coupling.setpoint_weight != 0.0;
    holds.then_some(
        "gains that remember and move what holds a set-point, by a set-point weight that is not 1, are not flown in sets; `feedforward` holds it beside them",
    )
}

/// Most work of a re-check.
fn most_checked(description: &LoopDescription) -> usize {
    if remembers(description) { MOST_CHECKED_REMEMBERED } else { MOST_CHECKED }
}

/// True for a self-tuner whose gains remember.
pub(crate) fn remembers(description: &LoopDescription) -> bool {
    let Controller::SelfTuning(fspid) = &description.controller else { return false };
    fspid.tuner().settings().law != Law::Memoryless
}

/// True where a load moves the pitch rate at once, and the controller sees it: it is not said whether before or after.
fn sees_loads_at_once(model: &LoopModel<Interval>, load_rad: f64) -> bool {
    let at_once = model.plant().rate.iter().skip(2).any(|entry| entry.magnitude() > 0.0);
    load_rad > 0.0 && model.settings().config.rate_gain_s != 0.0 && at_once
}

/// Where an error stays, gains that move are not those at the origin, and rest is elsewhere.
fn is_elsewhere(description: &LoopDescription, rest: &Rest) -> bool {
    matches!(description.controller, Controller::SelfTuning(_)) && !(rest.error_rad <= 0.0)
}

/// True where a flight to the other side is the mirror image: then one side is flown.
fn is_odd(description: &LoopDescription) -> bool {
    let config = description.controller.config();
    if let Controller::SelfTuning(fspid) = &description.controller
        && !answers_evenly(fspid.tuner())
    {
        return false;
    }
    let even =
        |ends: Option<(f64, f64)>| ends.is_none_or(|(least, most)| (least + most).abs() <= 0.0);
    let clamps = match &config.anti_windup {
        fspid_core::AntiWindup::Clamping(limits) => Some((limits.lower(), limits.upper())),
        _ => None,
    };
    let output = config.limits.as_ref().map(|limits| (limits.lower(), limits.upper()));
    let actuator = &description.actuator;
    [clamps, output, actuator.command_limits_rad(), actuator.travel_rad()].into_iter().all(even)
}

/// True where rules that conclude numbers answer the same to inputs of the other sign.
fn answers_evenly(tuner: &SelfTuner<f64>) -> bool {
    let Some(table) = tuner.supervisor().numbers() else { return false };
    Output::ALL.into_iter().all(|output| {
        let numbers: Vec<u64> =
            table.grid(output).iter().flatten().map(|number| (number + 0.0).to_bits()).collect();
        numbers.iter().eq(numbers.iter().rev())
    })
}

/// A form that falls for all gains, for the ball around what is told apart: that of the claim, where it is one for all gains
/// and has a rate. Gains that stand still are those near rest.
fn common(certificate: &Certificate, terminal: &Terminal) -> Terminal {
    match (&certificate.claim, &certificate.description.controller) {
        (Claim::CommonQuadratic { form, rate }, Controller::SelfTuning(_)) if *rate < 1.0 => {
            Terminal { form: form.clone(), rate: *rate, ..terminal.clone() }
        }
        _ => terminal.clone(),
    }
}

/// A claim about steps in the making, or in the check.
struct Flights<'a> {
    ready: Ready<'a>,
    description: &'a LoopDescription,
    longest: usize,
    /// Work of a sample.
    each: usize,
    /// Work so far, and the most.
    flown: usize,
    most: usize,
    stops: fn() -> bool,
}

impl<'a> Flights<'a> {
    fn of(
        description: &'a LoopDescription,
        model: &LoopModel<Interval>,
        set: &GainSet,
        terminals: [&Terminal; 2],
        system: Option<&'a System>,
    ) -> Option<Self> {
        let ready = Ready::of(description, model, set, terminals, system).ok()??;
        let dt_s = description.controller.config().dt_s;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
        let longest = ((LONGEST_S / dt_s) as usize).min(MOST_SAMPLES);
        let (flown, most) = (0, most_checked(description));
        let each = match &description.controller {
            Controller::Fixed(_) => 1,
            Controller::SelfTuning(_) => MOVING,
        };
        Some(Self { ready, description, longest, each, flown, most, stops: crate::solve::never })
    }

    /// Flies all loads of a piece of set-points, the first sample being the controller's own or not.
    fn piece(&mut self, setpoint: [f64; 2], load_rad: f64, loads: usize) -> Result<Landed, Stop> {
        let mut worst = Landed::default();
        let remembers = self.description.settings().memory.previous;
        let moments = [Moment::Stepped, Moment::First];
        let moments = if remembers { &moments[..] } else { &moments[..1] };
        for part in 0..loads {
            let at = |part: usize| load_rad * (2.0 * part as f64 / loads as f64 - 1.0);
            let patch = Patch { setpoint, load: [at(part), at(part + 1)] };
            for moment in moments {
                if (self.stops)() || self.flown > self.most {
                    return Err(Stop::Lost);
                }
                let landed = self.ready.fly(patch, *moment, self.longest);
                let samples = landed.as_ref().map_or_else(|(_, samples)| *samples, |it| it.samples);
                self.flown += samples * self.each;
                let landed = landed.map_err(|(stop, _)| stop)?;
                worst.samples = worst.samples.max(landed.samples);
                worst.limited |= landed.limited;
            }
        }
        Ok(worst)
    }

    /// Boxes from zero outwards to one side, as far as they are flown within the work of a re-check.
    fn side(&mut self, to: f64, load_rad: f64, loads: usize, allowed: usize) -> Vec<f64> {
        let mut ends = vec![0.0];
        let (mut at, mut width, mut of_check) = (0.0_f64, 0.25 * to, 0);
        while at.abs() < to.abs() && ends.len() < MOST_PIECES / 2 {
            let next = if (at + width).abs() >= to.abs() { to } else { at + width };
            let piece = if to < 0.0 { [next, at] } else { [at, next] };
            let before = self.flown;
            let landed = self.piece(piece, load_rad, loads);
            let work = self.flown - before;
            if landed.is_ok() {
                of_check += work;
                if of_check > allowed {
                    break;
                }
                ends.push(next);
                at = next;
                width *= 1.5;
            } else {
                width *= 0.5;
                if width.abs() < NARROWEST * to.abs() || self.flown > self.most {
                    break;
                }
            }
        }
        ends
    }
}

impl Steps {
    /// The largest steps of a proved loop, up to those of its range, that are found to end at their set-point.
    pub(crate) fn found(
        certificate: &Certificate,
        model: &LoopModel<Interval>,
        [set, held]: [&GainSet; 2],
        stops: fn() -> bool,
    ) -> Option<Self> {
        let description = &certificate.description;
        let Range { setpoint_rad, load_rad } = certificate.range;
        // Sets of both are as many as those of one times those of the other; gains that remember need narrow ones.
        let load_rad = if remembers(description) { 0.0 } else { load_rad };
        let limited = !description.limits().is_empty();
        if not_covered(description).is_some() || !limited || !(setpoint_rad > 0.0) {
            return None;
        }
        let rest = Rest::of(description, set, certificate.range).ok()?;
        if is_elsewhere(description, &rest) || sees_loads_at_once(model, load_rad) {
            return None;
        }
        let near = NearRest { certificate, enclosed: model, held, rest: &rest };
        let terminal = near.found(stops)?;
        let system = system(description);
        let common = common(certificate, &terminal);
        let forms = [&terminal, &common];
        let mut flights = Flights::of(description, model, set, forms, system.as_ref())?;
        let most_checked = most_checked(description);
        (flights.stops, flights.most) = (stops, SEARCHED * most_checked / 2);
        let odd = is_odd(description);
        let allowed = if odd { most_checked } else { most_checked / 2 };
        let loads = if load_rad > 0.0 { 2 } else { 1 };
        let up = flights.side(setpoint_rad, load_rad, loads, allowed);
        let reached = up.last().copied().unwrap_or(0.0);
        flights.most += flights.flown;
        let down = match odd {
            true => vec![0.0],
            false => flights.side(-reached, load_rad, loads, allowed),
        };
        let most = match odd {
            true => reached,
            false => reached.min(-down.last().copied().unwrap_or(0.0)),
        };
        if !(most > 0.0) || stops() {
            return None;
        }
        let below = down.into_iter().rev().map(|end| end.max(-most));
        let mut ends: Vec<f64> =
            below.chain(up.into_iter().skip(1).map(|end| end.min(most))).collect();
        ends.dedup_by(|one, other| one.to_bits() == other.to_bits());
        Some(Self { setpoint_rad: most, load_rad, terminal, ends, loads })
    }

    /// Proves the claim anew.
    pub(crate) fn proved(
        &self,
        certificate: &Certificate,
        model: &LoopModel<Interval>,
        set: &GainSet,
        stops: fn() -> bool,
    ) -> Result<Stepped, &'static str> {
        let description = &certificate.description;
        if let Some(what) = not_covered(description) {
            return Err(what);
        }
        self.fits(certificate)?;
        let rest = Rest::of(description, set, certificate.range);
        if sees_loads_at_once(model, self.load_rad) {
            return Err("steps: the pitch rate shows a load at once");
        }
        if !rest.is_ok_and(|rest| !is_elsewhere(description, &rest)) {
            return Err("steps: where the gains move and an error stays, rest is not known");
        }
        let system = system(description);
        let common = common(certificate, &self.terminal);
        let forms = [&self.terminal, &common];
        let mut flights = Flights::of(description, model, set, forms, system.as_ref())
            .ok_or("steps: the loop near rest is not enclosed")?;
        flights.stops = stops;
        let dt_s = description.controller.config().dt_s;
        let (mut worst, mut sets) = (Landed::default(), 0);
        for pair in self.ends.windows(2) {
            let landed = flights.piece([pair[0], pair[1]], self.load_rad, self.loads);
            let landed = landed.map_err(|stop| match stop {
                Stop::Guard => "steps: a flight may meet the sample guard",
                Stop::Travel => "steps: a flight may meet an end of the actuator's travel",
                Stop::Lost => "steps: a set of flights is not shown to end near its rest",
            })?;
            worst.samples = worst.samples.max(landed.samples);
            worst.limited |= landed.limited;
            sets += self.loads;
        }
        Ok(Stepped {
            setpoint_rad: self.setpoint_rad,
            load_rad: self.load_rad,
            sets,
            settled_s: worst.samples as f64 * dt_s,
            limited: worst.limited,
            rested_s: flights.ready.rests_s(),
        })
    }

    /// Whether the boxes fill the steps, and the steps lie in the range that the claim near rest is made for.
    fn fits(&self, certificate: &Certificate) -> Result<(), &'static str> {
        let range = Range { setpoint_rad: self.setpoint_rad, load_rad: self.load_rad };
        if !range.is_allowed() || !certificate.range.covers(range) {
            return Err("steps: beyond the range of the claim");
        }
        if certificate.output_factor.to_bits() != 1.0_f64.to_bits() {
            return Err("steps: of a loop at another output scale");
        }
        let rising = self.ends.windows(2).all(|pair| pair[0] < pair[1]);
        let first = if is_odd(&certificate.description) { 0.0 } else { -self.setpoint_rad };
        let filled = self.ends.first().is_some_and(|end| *end <= first)
            && self.ends.last().is_some_and(|end| *end >= self.setpoint_rad);
        if !rising || !filled {
            return Err("steps: the boxes do not fill the steps");
        }
        Ok(())
    }

    /// The claim that the form near rest is checked as.
    pub(crate) fn near_rest(&self, certificate: &Certificate) -> Certificate {
        let Terminal { form, rate, level, gains: _ } = &self.terminal;
        Certificate {
            claim: Claim::CommonQuadratic { form: form.clone(), rate: *rate },
            level: Some(*level),
            steps: None,
            disturbances: Vec::new(),
            ..certificate.clone()
        }
    }
}
