//! The re-check of a whole certificate: what it says is believed because this function answers `Ok`.

mod boxed;
mod disturbed;
mod moving;
mod remains;
#[cfg(test)]
mod tests;

use fspid_core::{Fspid, Gains, Law, SecondInput};
use fspid_lti::Matrix;
use fspid_numeric::scalar::Interval;
use fspid_sim::Controller;
use fspid_sim::loop_model::LoopModel;

use crate::caps::WrongSizes;
use crate::certificate::{Certificate, Claim};
use crate::check::{IntervalMatrix, NotProved, Relaxation, decreases, is_positive, prove_growth};
use crate::description::NotProvable;
use crate::disturbances::Disturbed;
use crate::family::{CheckedFamily, FamilyError};
use crate::gain_set::{
    Cone, GainSet, HeldGains, IncrementMap, KnownSlopes, NoSlopes, input_rows, producible,
};
use crate::limits;
use crate::nonlinear::{CheckedNonlinear, NonlinearError};
use crate::rest::{NoRest, Rest};
use crate::sizes;
use crate::solve::never;
use crate::steps::{Checked, Ended, Stepped, Terminal, corners_within};

pub(crate) use disturbed::DrivenLoop;
pub(crate) use moving::{Corner, part_in};
pub use remains::Remains;

/// Result of a certificate's re-check.
#[derive(Clone, Debug, PartialEq)]
pub struct Rechecked {
    /// Boxes of gains that cover everything the tuner can produce.
    pub cells: usize,
    /// Inequalities that were proved.
    pub inequalities: usize,
    /// Bounds of each gain.
    pub bounds: [Interval; 3],
    /// The gains are those that the law reaches, which are not every combination within the bounds.
    pub gains_are_reached: bool,
    /// Whether the law was proved to keep to the rate that is claimed, in every flight; false for claims that are not about
    /// a rate.
    pub keeps_to_the_rate: bool,
    /// Where a level is claimed: how far the pitch angle may be off, everything else at rest, to lie within,
    /// rad.
    pub pitch_within_rad: Option<f64>,
    /// The claim is about every constant set-point, as long as no limit acts, not only about those in its range.
    pub any_setpoint: bool,
    /// The claim is about every constant load, likewise.
    pub any_load: bool,
    /// How far rest may be from the set-point, rad, at the set-points and loads of the range: without an integral an error
    /// stays; infinite where nothing bounds it.
    pub rest_error_rad: f64,
    /// How far from rest the pitch angle may stay, rad; 0 where every deviation decreases for ever.
    pub remains_rad: f64,
    /// Steps from rest that were flown in sets; none where none are claimed.
    pub stepped: Option<Stepped>,
    /// The flights that a scenario commands, flown in sets; none where none are claimed.
    pub ended: Option<Ended>,
    /// Members of a family; none where none is claimed.
    pub family: Option<CheckedFamily>,
    /// What disturbances do at most, from rest, in the order of the certificate; what it has for limits alone is in each of
    /// the others.
    pub disturbed: Vec<Disturbed>,
    /// The nonlinear aircraft; none where nothing is claimed of it.
    pub nonlinear: Option<CheckedNonlinear>,
}

/// What the proof of a claim came to.
#[derive(Clone, Debug, Default)]
struct Proved {
    inequalities: usize,
    keeps_to_the_rate: bool,
    pitch_within_rad: Option<f64>,
    remains_rad: f64,
}

/// Why a certificate is not believed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RecheckError {
    /// The loop is not one that a proof can speak of.
    #[error(transparent)]
    NotProvable(#[from] NotProvable),
    /// An inequality does not hold, or not with certainty.
    #[error("{}{reason}", at(.gains))]
    Inequality {
        /// Which gains; none where the inequality is not about gains.
        gains: Option<Gains<f64>>,
        /// What was found.
        reason: NotProved,
    },
    /// The certificate is too large, or its parts do not fit the loop; nothing was computed.
    #[error("{0}")]
    Sizes(WrongSizes),
    /// Nothing is known of rest for these set-points and loads.
    #[error(transparent)]
    Rest(#[from] NoRest),
    /// Nothing bounds what the gains make of the command that holds set-points and loads.
    #[error(
        "gains that move make something of the command that holds a set-point or a load, and nothing bounds it: {0}"
    )]
    Held(#[from] NoSlopes),
    /// Every inequality holds, and what they leave is no statement about the flight.
    #[error("{0}")]
    Remains(Remains),
    /// Gains that are not known to be out of reach let the loop grow.
    #[error(
        "what is known to hold every gain of the controller holds {} as well, at which the loop grows standing still; whether it ever comes there is not known",
        gains_in_words(.gains)
    )]
    Grows {
        /// Which.
        gains: Gains<f64>,
    },
    /// The family is not proved.
    #[error(transparent)]
    Family(#[from] FamilyError),
    /// Nothing is proved of the nonlinear aircraft.
    #[error(transparent)]
    Nonlinear(#[from] NonlinearError),
    /// The certificate does not fit together.
    #[error("{what}")]
    Malformed {
        /// What is wrong.
        what: &'static str,
    },
}

/// At which gains, if at some.
fn at(gains: &Option<Gains<f64>>) -> String {
    let words = |Gains { kp, ki, kd }| format!("at kp {kp:?}, ki {ki:?}, kd {kd:?}: ");
    gains.map_or_else(String::new, words)
}

fn gains_in_words(Gains { kp, ki, kd }: &Gains<f64>) -> String {
    format!("kp {kp:.4}, ki {ki:.4}, kd {kd:.4}")
}

impl From<WrongSizes> for RecheckError {
    fn from(wrong: WrongSizes) -> Self {
        Self::Sizes(wrong)
    }
}

impl From<Remains> for RecheckError {
    fn from(remains: Remains) -> Self {
        Self::Remains(remains)
    }
}

impl From<NotProved> for RecheckError {
    fn from(reason: NotProved) -> Self {
        Self::Inequality { gains: None, reason }
    }
}

impl Certificate {
    /// Proves the claim anew, from the description alone.
    ///
    /// # Errors
    /// [`RecheckError`] with the first inequality that is not proved.
    pub fn check(&self) -> Result<Rechecked, RecheckError> {
        self.check_until(never)
    }

    /// As [`check`](Self::check) for somebody who may not want the answer any more: where `stops` says so, nothing is proved.
    ///
    /// # Errors
    /// As [`check`](Self::check).
    pub fn check_until(&self, stops: fn() -> bool) -> Result<Rechecked, RecheckError> {
        Recheck::of(self)?.until(stops).run()
    }
}

/// A certificate with what it is checked against.
pub(crate) struct Recheck<'a> {
    certificate: &'a Certificate,
    model: LoopModel<Interval>,
    set: GainSet,
    /// Rest for the set-points and loads of the claim.
    rest: Rest,
    /// The set with what the gains make of the command that is held there.
    held: GainSet,
    /// What of that command is left out, rad.
    off_rad: f64,
    /// Asked before each inequality.
    stops: fn() -> bool,
}

fn malformed(what: &'static str) -> RecheckError {
    RecheckError::Malformed { what }
}

fn allowed_rate(rate: f64) -> Result<(), RecheckError> {
    let good = rate > 0.0 && rate <= 1.0;
    good.then_some(()).ok_or(malformed("the rate is not above 0 and at most 1"))
}

impl<'a> Recheck<'a> {
    /// Everything enclosed anew from the description.
    fn of(certificate: &'a Certificate) -> Result<Self, RecheckError> {
        if !(certificate.output_factor >= 0.0 && certificate.output_factor.is_finite()) {
            return Err(malformed("the output factor is not 0 or more"));
        }
        sizes::check(certificate)?;
        let description = certificate.description.clone().provable()?;
        let model = description.enclosed()?;
        let set = match &description.controller {
            Controller::Fixed(pid) => GainSet::fixed(pid.gains()),
            Controller::SelfTuning(fspid) => IncrementMap::of(fspid.tuner(), certificate.divisions)
                .map_err(NotProvable::from)?
                .sampled_every(fspid.config().dt_s)
                .gains(certificate.output_factor),
        };
        Self::with(certificate, model, set, &KnownSlopes::default())
    }

    /// With enclosures that were made before, of the same description.
    pub(crate) fn with(
        certificate: &'a Certificate,
        model: LoopModel<Interval>,
        set: GainSet,
        known: &KnownSlopes,
    ) -> Result<Self, RecheckError> {
        if !certificate.range.is_allowed() {
            return Err(malformed("set-points and loads are not two finite numbers, 0 or more"));
        }
        // Gains that grow standing still, or in an order of our own, say nothing of what is held.
        let description = &certificate.description;
        let rest = if certificate.claim.is_of_stability() {
            Rest::of(description, &set, certificate.range)?
        } else {
            Rest::NOTHING
        };
        let (held, off_rad) = match &certificate.description.controller {
            Controller::Fixed(_) => (set.clone(), 0.0),
            Controller::SelfTuning(fspid) => {
                set.holding(fspid, certificate.output_factor, rest.held, known)?
            }
        };
        Ok(Self { certificate, model, set, rest, held, off_rad, stops: never })
    }

    /// The same for somebody who may not want the answer any more; where `stops` says so, nothing is proved.
    pub(crate) fn until(self, stops: fn() -> bool) -> Self {
        Self { stops, ..self }
    }

    pub(crate) fn run(&self) -> Result<Rechecked, RecheckError> {
        // Also of what the solver found: what is written must be read again.
        sizes::check(self.certificate)?;
        let description = &self.certificate.description;
        if self.certificate.level.is_some()
            && let Some(what) = limits::not_covered(description)
        {
            return Err(malformed(what));
        }
        let Proved { inequalities, keeps_to_the_rate, pitch_within_rad, remains_rad } =
            self.proved()?;
        let stepped = self.stepped()?;
        let ended = self.ended()?;
        let disturbed = self.disturbed(remains_rad)?;
        let family = self
            .certificate
            .family
            .as_ref()
            .map(|family| family.check(self.certificate, &self.set, self.stops));
        let family = family.transpose()?;
        let nonlinear = self
            .certificate
            .nonlinear
            .as_ref()
            .map(|claim| claim.check(self.certificate, &self.set, self.stops));
        let nonlinear = nonlinear.transpose()?;
        let bounds = self.set.bounds();
        Ok(Rechecked {
            cells: self.set.cells.len(),
            inequalities,
            bounds,
            gains_are_reached: self.set.reached.is_some(),
            keeps_to_the_rate,
            pitch_within_rad,
            any_setpoint: self.rest.any_setpoint,
            any_load: self.rest.any_load,
            rest_error_rad: self.rest.error_rad,
            remains_rad,
            stepped,
            ended,
            family,
            disturbed,
            nonlinear,
        })
    }

    /// Proves that a form decreases, and that no limit acts, for all gains that there are within its level.
    fn holds_near_rest(&self, terminal: &Terminal) -> Result<(), RecheckError> {
        let Terminal { form, rate, .. } = terminal;
        let description = &self.certificate.description;
        if let Some(what) = limits::not_covered(description) {
            return Err(malformed(what));
        }
        self.form(form, *rate)?;
        if !(*rate < 1.0) || self.off_rad > 0.0 || self.is_blurred() {
            return Err(malformed("flights in sets: near rest something remains"));
        }
        for corner in corners_within(description, &self.model, &self.held, terminal)? {
            self.holds(corner, form, *rate, None)?;
        }
        Ok(())
    }

    /// Proves what is claimed of steps: the form near rest as any other, then the flights.
    fn stepped(&self) -> Result<Option<Stepped>, RecheckError> {
        let Some(steps) = &self.certificate.steps else { return Ok(None) };
        self.ends_near_rest(&steps.terminal)?;
        steps.proved(self.flights()).map(Some).map_err(malformed)
    }

    /// The same of the flights that a scenario commands.
    fn ended(&self) -> Result<Option<Ended>, RecheckError> {
        let Some(commanded) = &self.certificate.commanded else { return Ok(None) };
        self.ends_near_rest(&commanded.terminal)?;
        commanded.proved(self.flights()).map(Some).map_err(malformed)
    }

    fn flights(&self) -> Checked<'_> {
        let Self { certificate, model, set, stops, .. } = self;
        Checked { certificate, model, set, stops: *stops }
    }

    /// Proves the form of the end of flights.
    fn ends_near_rest(&self, terminal: &Terminal) -> Result<(), RecheckError> {
        if !self.certificate.claim.is_of_stability() {
            return Err(malformed("flights in sets: of a loop that is not claimed to be stable"));
        }
        let near_rest = terminal.near_rest(self.certificate);
        let known = KnownSlopes::default();
        let near = Recheck::with(&near_rest, self.model.clone(), self.set.clone(), &known)?;
        near.until(self.stops).holds_near_rest(terminal)
    }

    fn proved(&self) -> Result<Proved, RecheckError> {
        let only = |inequalities| Proved { inequalities, ..Proved::default() };
        match &self.certificate.claim {
            Claim::CommonQuadratic { form, rate } => {
                let proved = self.common_quadratic(form, *rate)?;
                self.with_pitch(proved, form, *rate)
            }
            Claim::SProcedure { form, rate, multipliers } => {
                let proved = self.s_procedure(form, *rate, multipliers)?;
                self.with_pitch(proved, form, *rate)
            }
            Claim::BoundedRate(claim) => self.bounded_rate(claim),
            Claim::FrozenGrowth { input, factor, form, direction } => {
                self.growth(&[*input], *factor, form, direction).map(only)
            }
            Claim::SequenceGrowth { inputs, factor, form, direction } => {
                self.growth(inputs, *factor, form, direction).map(only)
            }
        }
    }

    fn with_pitch(
        &self,
        inequalities: usize,
        form: &Matrix,
        rate: f64,
    ) -> Result<Proved, RecheckError> {
        let level = self.certificate.level;
        let within = |level| limits::pitch_within(&self.model, form, level);
        let pitch_within_rad = level.and_then(within);
        let remains_rad = self.remains(form, rate)?;
        self.is_little(remains_rad)?;
        Ok(Proved { inequalities, keeps_to_the_rate: false, pitch_within_rad, remains_rad })
    }

    /// The closed loop at gains.
    fn closed(&self, gains: Gains<Interval>) -> Result<IntervalMatrix, RecheckError> {
        closed(&self.model, gains)
    }

    fn form(&self, form: &Matrix, rate: f64) -> Result<(), RecheckError> {
        allowed_rate(rate)?;
        let size = self.model.size() + self.more_states();
        if (form.rows(), form.columns()) != (size, size) {
            return Err(malformed("the form has another size than the loop's state"));
        }
        Ok(is_positive(form)?)
    }

    /// States of the memory that gains have of a held command.
    fn more_states(&self) -> usize {
        let Certificate { description, range, .. } = self.certificate;
        let remembers = self.held.remembered.is_some();
        if remembers { description.remembered_states(*range) } else { 0 }
    }

    /// The loop at gains with all that a held command adds.
    fn held_loop(&self, held: HeldGains) -> Result<IntervalMatrix, RecheckError> {
        let at = points(held.gains);
        let model = self.model.with_change_gain(Interval::point(held.change_gain));
        match (held.remembered, &self.certificate.description.controller) {
            (Some(corner), Controller::SelfTuning(fspid)) => {
                let rows = corner.closed(&model, fspid, at);
                IntervalMatrix::from_rows(&rows).map_err(|error| NotProved::from(error).into())
            }
            _ => closed(&model, at),
        }
    }

    /// Proves at gains that the form decreases, and that no limit acts within the level.
    fn holds(
        &self,
        held: HeldGains,
        form: &Matrix,
        rate: f64,
        relaxation: Option<Relaxation<'_>>,
    ) -> Result<usize, RecheckError> {
        if (self.stops)() {
            return Err(malformed("nobody wants the answer any more"));
        }
        let HeldGains { gains, change_gain, remembered } = held;
        let doubt = |reason| RecheckError::Inequality { gains: Some(gains), reason };
        decreases(form, rate, &self.held_loop(held)?, relaxation).map_err(doubt)?;
        let Some(level) = self.certificate.level else { return Ok(1) };
        if remembered.is_some() {
            return Err(malformed(
                "no level is claimed of a loop whose gains remember what is held",
            ));
        }
        let at = points(gains);
        let model = self.model.with_change_gain(Interval::point(change_gain));
        let description = &self.certificate.description;
        let limits = limits::rows(description, &model, at, &self.rest);
        Ok(1 + limits::prove(&limits, form, level).map_err(doubt)?)
    }

    fn common_quadratic(&self, form: &Matrix, rate: f64) -> Result<usize, RecheckError> {
        self.form(form, rate)?;
        let holds = |(_, gains)| self.holds(gains, form, rate, None);
        let proved = self.held.held_corners().map(holds).sum::<Result<usize, RecheckError>>()?;
        Ok(1 + proved)
    }

    fn s_procedure(
        &self,
        form: &Matrix,
        rate: f64,
        multipliers: &[f64],
    ) -> Result<usize, RecheckError> {
        self.form(form, rate)?;
        let Controller::SelfTuning(fspid) = &self.certificate.description.controller else {
            return Err(malformed("fixed gains are tied to nothing"));
        };
        if fspid.tuner().settings().law != Law::Memoryless {
            return Err(malformed("gains that remember are not tied to the error of the moment"));
        }
        if fspid.tuner().settings().second_input != SecondInput::Change {
            return Err(malformed("gains are tied to another input than the change of the error"));
        }
        // Without a cone nothing would be asked of the loop at all: sizes were checked.
        if self.rest.error_rad > 0.0 {
            return Err(malformed(
                "where an error stays, gains are not tied to how far rest is off",
            ));
        }
        if self.is_blurred() {
            return Err(malformed(
                "with a resolution the supervisor sees another error than the loop's",
            ));
        }
        let corners: Vec<(usize, HeldGains)> = self.held.held_corners().collect();
        let mut proved = 1;
        for (cone, tau) in self.set.cones(multipliers.len()).iter().zip(multipliers) {
            let region = cone_form(&self.model, fspid, cone);
            let relaxation = Relaxation { weight: *tau, matrix: &region };
            let inside = corners.iter().filter(|(cell, _)| cone.cells.contains(cell));
            for (_, gains) in inside {
                proved += self.holds(*gains, form, rate, Some(relaxation))?;
            }
        }
        Ok(proved)
    }

    /// Multiplies the loops of a sequence of produced gains and proves that the product grows.
    fn growth(
        &self,
        inputs: &[[f64; 2]],
        factor: f64,
        form: &Matrix,
        direction: &[f64],
    ) -> Result<usize, RecheckError> {
        if !(factor >= 1.0 && factor.is_finite()) {
            return Err(malformed("the factor of the growth is below 1"));
        }
        let mut product = IntervalMatrix::identity(self.model.size());
        for input in inputs {
            if !can_see(&self.certificate.description.controller, *input) {
                return Err(malformed("an input whose scale is 0 is not 0"));
            }
            let gains = produced(&self.certificate.description.controller, *input);
            let closed = self.closed(points(gains))?;
            product = closed.product(&product).map_err(NotProved::from)?;
        }
        let slowed = product.scaled(Interval::ONE / Interval::point(factor));
        prove_growth(&slowed, form, direction)?;
        Ok(2)
    }
}

fn closed(
    model: &LoopModel<Interval>,
    gains: Gains<Interval>,
) -> Result<IntervalMatrix, RecheckError> {
    let rows = model.closed(gains);
    IntervalMatrix::from_rows(&rows).map_err(|error| NotProved::from(error).into())
}

/// The gains that a controller has at an input of its supervisor.
pub(crate) fn produced(controller: &Controller, [error, change]: [f64; 2]) -> Gains<f64> {
    match controller {
        Controller::Fixed(pid) => pid.gains(),
        Controller::SelfTuning(fspid) => producible(fspid.tuner(), error, change),
    }
}

/// Whether the supervisor can ever see an input: one whose scale is 0 stays 0.
fn can_see(controller: &Controller, [error, change]: [f64; 2]) -> bool {
    let Controller::SelfTuning(fspid) = controller else { return true };
    let scale = fspid.tuner().settings().input_scale;
    (scale.error_per_rad != 0.0 || error == 0.0) && (scale.change_per_rad != 0.0 || change == 0.0)
}

fn points(gains: Gains<f64>) -> Gains<Interval> {
    let Gains { kp, ki, kd } = gains;
    Gains { kp: Interval::point(kp), ki: Interval::point(ki), kd: Interval::point(kd) }
}

/// The quadratic form that is not negative where the supervisor's inputs lie in a double cone:
///
/// $$ z^T Q z = (n_1 \cdot x)(n_2 \cdot x), \qquad x = (s_e e, s_c \Delta e) $$
pub(crate) fn cone_form(
    model: &LoopModel<Interval>,
    fspid: &Fspid<f64>,
    cone: &Cone,
) -> IntervalMatrix {
    let point = Interval::point;
    let [error, change] = input_rows(model, fspid);
    // The sign of both inputs together does not matter to a double cone.
    let side = |normal: [f64; 2]| -> Vec<Interval> {
        let inputs = error.iter().zip(&change);
        inputs.map(|(e, c)| point(normal[0]) * *e + point(normal[1]) * *c).collect()
    };
    let [first, second] = cone.normals.map(side);
    let half = point(0.5);
    let entry = |row: usize, column: usize| {
        half * (first[row] * second[column] + first[column] * second[row])
    };
    let size = model.size();
    let rows: Vec<Vec<Interval>> =
        (0..size).map(|row| (0..size).map(|column| entry(row, column)).collect()).collect();
    IntervalMatrix::from_rows(&rows).unwrap_or_else(|_| IntervalMatrix::zeros(size, size))
}
