//! A flight as a linear programme: the sampled plant, its exogenous inputs, and constraints on the command.

use fspid_numeric::scalar::{Interval, Scalar};
use fspid_proof::check::{ActuatorLag, IntervalMatrix, PrintedPlant, printed};
use fspid_sim::actuator::ActuatorParts;
use fspid_sim::{Inflow, Plant, Scenario};

use crate::error::{LimitError, Refusal};
use crate::still::{Assumed, Still};
use crate::travel::Travel;

/// More samples take minutes and gigabytes.
const MOST_SAMPLES: usize = 30_000;

/// Effects of a scenario that the limit neglects or simplifies.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SaidBeside {
    /// Sensors and what disturbs them concern nobody who knows the flight before.
    SeesEverything,
    /// The actuator has no limits: commands are taken to be within these, rad.
    Within(f64),
    /// Until something happens commands are taken to be near zero.
    Still(Still),
    /// The deadband is taken for none where the command's way counts: the limit may be lower than what is possible.
    Deadband,
    /// A command that is cut counts as cut, and its travel for as much as the disturbance at the servo moves: the limit
    /// may be lower than what is possible.
    ServoDisturbance,
    /// The air is taken as the flight computes it, rounding included.
    Air,
}

/// The sampled plant with its actuator: $z_{k+1} = A z_k + B v_k + \Gamma d_k + w_k$.
#[derive(Clone, Debug)]
pub(crate) struct Sampled {
    /// Number of states; pitch angle first, the deflection at `deflection`.
    pub(crate) states: usize,
    pub(crate) deflection: usize,
    /// Every matrix that the printed coefficients can mean.
    pub(crate) a: IntervalMatrix,
    /// By the target of the lag.
    pub(crate) by_target: Vec<Interval>,
    /// By what disturbs the elevator, over the states of the plant.
    pub(crate) by_elevator: Vec<Interval>,
}

/// Whose way counts, in terms of the programme.
#[derive(Clone, Debug)]
pub(crate) struct Counted {
    /// The state whose way counts; `None` for the target.
    pub(crate) state: Option<usize>,
    /// What is added to it at each sample, rad.
    pub(crate) offset_rad: Vec<f64>,
    /// First sample that counts.
    pub(crate) first: usize,
    /// First sample that does not.
    pub(crate) end: usize,
    /// True where the jump from zero to the first counts.
    pub(crate) from_rest: bool,
    /// How much more travel the programme allows than was asked for, rad, upper bound.
    pub(crate) more_rad: f64,
}

/// What a rate limit or stops leave open between samples.
#[derive(Clone, Debug)]
pub(crate) struct Between {
    /// Upper bound of the integral of the difference of two ways that an elevator goes between the same ends, over its
    /// change, s.
    pub(crate) apart_s: f64,
    /// $|e^{A t} B|$ over all times of a sample, entry by entry as intervals.
    pub(crate) response: Vec<Interval>,
}

/// A flight with its command left free: the data of the linear programme.
#[derive(Clone, Debug)]
pub struct Question {
    pub(crate) dt_s: f64,
    pub(crate) rows: usize,
    pub(crate) plant: Sampled,
    pub(crate) inflow: Inflow,
    pub(crate) actuator: ActuatorParts,
    /// Limits of the target of the lag, rad; of what it amounts to where rate or stops hold the elevator.
    target_rad: (f64, f64),
    still: Option<Still>,
    /// Limits of the targets at the first samples, rad: before a command arrives, and while commands are still.
    quiet_rad: Vec<(f64, f64)>,
    /// Largest change of the deflection over a sample, rad, rounded up.
    pub(crate) most_change_rad: Option<f64>,
    pub(crate) between: Option<Between>,
    pub(crate) counted: Counted,
    /// Targets before the first command arrives, rad; none where they are not known.
    pub(crate) before_rad: Vec<f64>,
    /// What is said beside the answer.
    pub(crate) beside: Vec<SaidBeside>,
}

impl Question {
    /// Of a scenario, with what is taken of commands.
    ///
    /// # Errors
    /// [`LimitError::Refused`] with everything that no limit can be told of; where the plant cannot be sampled.
    pub fn of(scenario: &Scenario, travel: Travel, assumed: Assumed) -> Result<Self, LimitError> {
        let refusals = refusals(scenario, travel);
        if !refusals.is_empty() {
            return Err(LimitError::Refused(refusals));
        }
        let found = scenario.timing.rows();
        if found > MOST_SAMPLES {
            return Err(LimitError::TooLong { found, most: MOST_SAMPLES });
        }
        let (inflow, plant) = scenario.inflow()?;
        let (dt_s, rows) = (scenario.timing.dt_s(), scenario.timing.rows());
        let actuator = scenario.actuator.parts();
        let printed_plant = |lag| PrintedPlant {
            numerator: plant.transfer_function().numerator().coefficients(),
            denominator: plant.transfer_function().denominator().coefficients(),
            elevator_sign: plant.elevator_sign(),
            lag,
            dt_s,
        };
        let sampled = Sampled::new(&printed_plant, actuator, plant.order())?;
        let mut beside = Vec::new();
        if scenario.surroundings.weather.is_some() {
            beside.push(SaidBeside::Air);
        }
        let limits = Limits::new(actuator, assumed.within_rad, &inflow, dt_s);
        if let Some(within_rad) = limits.assumed_rad {
            beside.push(SaidBeside::Within(within_rad));
        }
        beside.extend(assumed.still.map(SaidBeside::Still));
        let between = between(&printed_plant, actuator, dt_s)?;
        let mut question = Self {
            dt_s,
            rows,
            plant: sampled,
            actuator,
            target_rad: limits.target_rad,
            still: assumed.still,
            quiet_rad: Vec::new(),
            most_change_rad: limits.most_change_rad,
            between,
            counted: Counted::none(),
            before_rad: Vec::new(),
            inflow,
            beside,
        };
        question.before_rad = question.before();
        question.quiet_rad = question.quiet();
        question.inflow.at_elevator_rad.iter_mut().for_each(|it| *it += actuator.bias_rad);
        question.counted = question.counted(travel);
        question.say(scenario, travel);
        Ok(question)
    }

    /// What is said beside the answer.
    #[must_use]
    pub fn beside(&self) -> &[SaidBeside] {
        &self.beside
    }

    /// Commanded pitch at each sample, rad.
    #[must_use]
    pub fn setpoint_rad(&self) -> &[f64] {
        &self.inflow.setpoint_rad
    }

    /// Sample period, s.
    #[must_use]
    pub fn dt_s(&self) -> f64 {
        self.dt_s
    }

    /// Stops of the deflection that a programme has to know of, rad: without a lag they are limits of the target.
    pub(crate) fn stops(&self) -> Option<(f64, f64)> {
        self.actuator.travel_rad.filter(|_| self.actuator.lag.order() > 0)
    }

    /// Samples until a command arrives at the actuator.
    pub(crate) fn delay(&self) -> usize {
        self.actuator.delay_samples.min(self.rows)
    }

    pub(crate) fn at_servo(&self, k: usize) -> f64 {
        self.inflow.at_servo_rad.get(k).copied().unwrap_or(0.0)
    }

    pub(crate) fn at_elevator(&self, k: usize) -> f64 {
        self.inflow.at_elevator_rad.get(k).copied().unwrap_or(0.0)
    }

    /// What enters the states over a sample beside the target.
    pub(crate) fn entering(&self, k: usize) -> Vec<Interval> {
        let elevator = Interval::point(self.at_elevator(k));
        let air = self.inflow.by_air.get(k);
        let by_air = |place: usize| air.and_then(|air| air.get(place)).copied().unwrap_or(0.0);
        let by_elevator = self.plant.by_elevator.iter().enumerate();
        by_elevator.map(|(place, by)| *by * elevator + Interval::point(by_air(place))).collect()
    }

    /// Limits of the target at a sample, rad, outward.
    pub(crate) fn target_at(&self, k: usize) -> (f64, f64) {
        self.within(self.quiet_rad.get(k))
    }

    /// Limits of any target, rad, and of one that is within these as well.
    pub(crate) fn within(&self, quiet_rad: Option<&(f64, f64)>) -> (f64, f64) {
        let (low, high) = self.target_rad;
        let cut = |(least, most): &(f64, f64)| (least.clamp(low, high), most.clamp(low, high));
        quiet_rad.map_or((low, high), cut)
    }

    /// Limits of the targets at the first samples, rad.
    pub(crate) fn quiet_rad(&self) -> &[(f64, f64)] {
        &self.quiet_rad
    }

    /// The same for somebody who takes the servo for disturbed as it is at a sample, and whose elevator is here, rad.
    pub(crate) fn quiet_as_at(&self, k: usize, here_rad: f64) -> Vec<(f64, f64)> {
        let own_rad = self.still.map_or(0.0, |still| still.within_rad);
        let (least, most) = self.still_target(self.at_servo(k), own_rad);
        // What a target amounts to lies between it and where the elevator is.
        let held = (least.min(here_rad), most.max(here_rad));
        let range = if self.between.is_some() { held } else { (least, most) };
        vec![range; self.quiet_rad.len()]
    }

    /// Targets before the first command arrives, rad. Where rate or stops hold the elevator, what one amounts to is known
    /// only if it is where the elevator begins.
    fn before(&self) -> Vec<f64> {
        let before: Vec<f64> =
            (0..self.delay()).map(|k| self.target_of(self.at_servo(k))).collect();
        let known = self.between.is_none() || before.iter().all(|it| it.abs() <= 0.0);
        if known { before } else { Vec::new() }
    }

    /// What targets are within before a command arrives, and while commands are still, rad. No zero is among these:
    /// commands that are still cannot take back what disturbs the servo.
    fn quiet(&self) -> Vec<(f64, f64)> {
        let still = self.still.map_or(0, |still| still.until.saturating_add(self.delay()));
        let each = (0..self.rows.min(still.max(self.delay()))).map(|k| self.quiet_target(k));
        if self.between.is_none() {
            return each.collect();
        }
        // Where rate or stops hold the elevator, a target amounts to what would have brought it as far by the lag alone.
        // From further up, and with a target further up, it ends further up.
        let held = Held::new(self.actuator, self.dt_s);
        let each = each.scan((0.0_f64, 0.0_f64), |here, (least, most)| {
            let from = Interval::between(here.0, here.1);
            *here = (held.moved(here.0, least).lower(), held.moved(here.1, most).upper());
            let amounts = held.amounts(from, Interval::between(here.0, here.1));
            // It lies between the target and where the elevator is.
            let (low, high) = (least.min(from.lower()), most.max(from.upper()));
            Some((amounts.lower().clamp(low, high), amounts.upper().clamp(low, high)))
        });
        each.collect()
    }

    /// A command as it may be given at a sample, rad. A solver keeps a range to its tolerance only, and a deadband makes a
    /// command out of what is left over.
    pub(crate) fn allowed(&self, k: usize, command_rad: f64) -> f64 {
        match self.still.filter(|still| k < still.until) {
            Some(still) => command_rad.clamp(-still.within_rad, still.within_rad),
            None => command_rad,
        }
    }

    /// What a target of that time may be, rad.
    fn quiet_target(&self, k: usize) -> (f64, f64) {
        let given = self.still.filter(|_| k >= self.delay());
        self.still_target(self.at_servo(k), given.map_or(0.0, |still| still.within_rad))
    }

    /// What the target of a command within ± `own_rad` may be, rad.
    fn still_target(&self, at_servo_rad: f64, own_rad: f64) -> (f64, f64) {
        let (at_servo, own) = (Interval::point(at_servo_rad), Interval::point(own_rad));
        let least = self.target_of((at_servo - own).lower());
        let most = self.target_of((at_servo + own).upper());
        match self.actuator.deadband_rad > 0.0 {
            // Subtracting the deadband rounds.
            true => (least.next_down(), most.next_up()),
            false => (least, most),
        }
    }

    /// The target of the lag for what arrives at the actuator, rad; without a lag a stop cuts it.
    pub(crate) fn target_of(&self, arriving_rad: f64) -> f64 {
        let limits = self.actuator.command_limits_rad;
        let cut = limits.map_or(arriving_rad, |(least, most)| arriving_rad.clamp(least, most));
        let dead = self.actuator.deadband_rad;
        let target = cut - cut.clamp(-dead, dead);
        self.bare_stops().map_or(target, |(least, most)| target.clamp(least, most))
    }

    /// What has to arrive for a target, rad.
    pub(crate) fn command_of(&self, target_rad: f64) -> f64 {
        let dead = self.actuator.deadband_rad;
        if target_rad == 0.0 { 0.0 } else { target_rad + dead.copysign(target_rad) }
    }

    /// Stops that no lag stands before, rad.
    fn bare_stops(&self) -> Option<(f64, f64)> {
        self.actuator.travel_rad.filter(|_| self.actuator.lag.order() == 0)
    }

    /// True where commands may differ of which the actuator makes the same.
    fn cuts(&self) -> bool {
        let limited = self.actuator.command_limits_rad.is_some() || self.bare_stops().is_some();
        limited || self.actuator.deadband_rad > 0.0
    }

    /// First sample whose target does nothing and counts for nothing.
    pub(crate) fn target_end(&self) -> usize {
        let last = self.rows.saturating_sub(1);
        if self.counted.state.is_none() { self.counted.end.max(last) } else { last }
    }

    fn counted(&self, travel: Travel) -> Counted {
        let (rows, delay) = (self.rows, self.delay());
        let at_once = self.actuator.lag.order() == 0 && self.between.is_none();
        let last = rows.saturating_sub(1);
        match travel {
            Travel::Elevator => Counted {
                state: (!at_once).then_some(self.plant.deflection),
                offset_rad: self.inflow.at_elevator_rad.clone(),
                first: 0,
                end: rows,
                from_rest: false,
                more_rad: 0.0,
            },
            Travel::Command | Travel::CommandFromRest => {
                let from_rest = travel == Travel::CommandFromRest;
                let at_servo = &self.inflow.at_servo_rad;
                let cut = self.cuts();
                let way = way_up(at_servo.get(delay..).unwrap_or_default(), from_rest);
                Counted {
                    state: None,
                    offset_rad: at_servo.iter().map(|it| if cut { 0.0 } else { -it }).collect(),
                    first: delay,
                    end: last,
                    from_rest,
                    more_rad: if cut { way } else { 0.0 },
                }
            }
        }
    }

    fn say(&mut self, scenario: &Scenario, travel: Travel) {
        let surroundings = &scenario.surroundings;
        let sees = surroundings.pitch_sensor.is_some()
            || surroundings.rate_sensor.is_some()
            || scenario
                .disturbances
                .iter()
                .any(|it| it.entry() == fspid_sim::signal::Entry::Measurement);
        if sees {
            self.beside.push(SaidBeside::SeesEverything);
        }
        if travel != Travel::Elevator && self.actuator.deadband_rad > 0.0 {
            self.beside.push(SaidBeside::Deadband);
        }
        if self.counted.more_rad > 0.0 {
            self.beside.push(SaidBeside::ServoDisturbance);
        }
    }
}

impl Counted {
    fn none() -> Self {
        let offset_rad = Vec::new();
        Self { state: None, offset_rad, first: 0, end: 0, from_rest: false, more_rad: 0.0 }
    }

    pub(crate) fn offset(&self, k: usize) -> f64 {
        self.offset_rad.get(k).copied().unwrap_or(0.0)
    }
}

/// The way of a signal, rad, rounded up.
fn way_up(values: &[f64], from_rest: bool) -> f64 {
    let point = Interval::point;
    let first = values.first().copied().filter(|_| from_rest).unwrap_or(0.0);
    let pairs = values.windows(2).map(|pair| (point(pair[1]) - point(pair[0])).magnitude());
    pairs.fold(point(first.abs()), |sum, step| sum + point(step)).upper()
}

fn refusals(scenario: &Scenario, travel: Travel) -> Vec<Refusal> {
    let parts = scenario.actuator.parts();
    let order = parts.lag.order();
    let stopped = parts.travel_rad.is_some() && order > 0;
    let held = parts.rate_limit_rad_s.is_some() || stopped;
    [
        (matches!(scenario.plant, Plant::Aircraft(_)), Refusal::Nonlinear),
        (matches!(scenario.plant, Plant::External(_)), Refusal::OtherSimulator),
        (!scenario.plant_changes.is_empty(), Refusal::Changes),
        (scenario.autopilot.is_some(), Refusal::Autopilot),
        (parts.play_rad > 0.0, Refusal::Play),
        (held && order == 2, Refusal::SecondOrderLimits),
        (held && order < 2 && travel != Travel::Elevator, Refusal::CommandThroughLimits),
    ]
    .into_iter()
    .filter_map(|(refused, why)| refused.then_some(why))
    .collect()
}

impl Sampled {
    fn new<'a>(
        plant: &impl Fn(ActuatorLag) -> PrintedPlant<'a>,
        actuator: ActuatorParts,
        order: usize,
    ) -> Result<Self, LimitError> {
        let whole = plant(actuator.lag.into()).sampled()?;
        let bare = plant(ActuatorLag::None).sampled()?;
        let states = whole.states;
        let rows: Vec<&[Interval]> = whole.rows.chunks(states + 1).collect();
        let by_state: Vec<&[Interval]> = rows.iter().map(|row| &row[..states]).collect();
        let last = |row: &&[Interval]| row.last().copied().unwrap_or(Interval::ENTIRE);
        let bare_rows: Vec<&[Interval]> = bare.rows.chunks(bare.states + 1).take(order).collect();
        Ok(Self {
            states,
            deflection: order,
            a: IntervalMatrix::from_rows(&by_state)?,
            by_target: rows.iter().map(last).collect(),
            by_elevator: bare_rows.iter().map(last).collect(),
        })
    }
}

/// What the target of the lag may be, and how far the deflection may go in a sample.
struct Limits {
    target_rad: (f64, f64),
    most_change_rad: Option<f64>,
    assumed_rad: Option<f64>,
}

impl Limits {
    fn new(actuator: ActuatorParts, within_rad: f64, inflow: &Inflow, dt_s: f64) -> Self {
        let dead = actuator.deadband_rad;
        let point = Interval::point;
        // What is left of a limit behind the deadband, outward.
        let beyond = |limit: f64| {
            let left = (point(limit.abs()) - point(dead)).upper().max(0.0);
            left.copysign(limit)
        };
        let commanded = actuator.command_limits_rad.map(|(a, b)| (beyond(a), beyond(b)));
        let disturbed = inflow.at_servo_rad.iter().fold(0.0_f64, |most, it| most.max(it.abs()));
        let assumed = (point(within_rad) + point(disturbed)).upper();
        let given = commanded.or(actuator.travel_rad);
        let (low, high) = commanded.unwrap_or((-assumed, assumed));
        let rate = actuator.rate_limit_rad_s.map(|rate| (printed(rate) * printed(dt_s)).upper());
        let mut target_rad = (low, high);
        let mut most_change_rad = rate;
        if let Some((least, most)) = actuator.travel_rad {
            let range = (point(most) - point(least)).upper();
            most_change_rad = Some(rate.map_or(range, |rate| rate.min(range)));
            let more = most_change_rad.map_or(0.0, |change| {
                let covered = covered(actuator, dt_s);
                (point(change) / covered).upper()
            });
            // A stop cuts what a far target would have done; without a lag it cuts the target itself.
            let reach = if actuator.lag.order() == 0 { 0.0 } else { more };
            let low_end = (point(least) - point(reach)).lower();
            let high_end = (point(most) + point(reach)).upper();
            target_rad = (low.min(least).max(low_end), high.max(most).min(high_end));
            if actuator.lag.order() == 0 {
                target_rad = (low.max(least), high.min(most));
            }
        }
        Self { target_rad, most_change_rad, assumed_rad: given.is_none().then_some(within_rad) }
    }
}

/// An elevator of a lag of first order, or none, between rate limit and stops, over a sample whose target is held.
struct Held {
    actuator: ActuatorParts,
    dt_s: Interval,
    covered: Interval,
}

impl Held {
    fn new(actuator: ActuatorParts, dt_s: f64) -> Self {
        Self { actuator, dt_s: printed(dt_s), covered: covered(actuator, dt_s) }
    }

    /// Where it is at the end, rad.
    fn moved(&self, here_rad: f64, target_rad: f64) -> Interval {
        let (here, target) = (Interval::point(here_rad), Interval::point(target_rad));
        let down = target_rad < here_rad;
        let gap = if down { here - target } else { target - here };
        let way = match self.actuator.rate_limit_rad_s {
            Some(rate) => self.way(gap, printed(rate)),
            None => gap * self.covered,
        };
        let end = if down { here - way } else { here + way };
        let (least, most) = self.actuator.travel_rad.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
        Interval::between(end.lower().clamp(least, most), end.upper().clamp(least, most))
    }

    /// How far it goes towards a target that is so far away, rad: at its rate for a time d, and by the lag from then on,
    /// $R d + (g - R d) (1 - e^{-(T - d) / \tau})$.
    fn way(&self, gap: Interval, rate: Interval) -> Interval {
        let tau_s = self.actuator.lag.time_constant_s().map_or(Interval::ZERO, printed);
        let most_s = self.dt_s.upper();
        let time = (gap - rate * tau_s) / rate;
        let held =
            Interval::between(time.lower().clamp(0.0, most_s), time.upper().clamp(0.0, most_s));
        let far = rate * held;
        if self.actuator.lag.order() == 0 {
            return far;
        }
        let left = self.dt_s - held;
        far + (gap - far) * (Interval::ONE - (-(left / tau_s)).exp())
    }

    /// The target by which the lag alone would have gone as far, rad.
    fn amounts(&self, from: Interval, to: Interval) -> Interval {
        from + (to - from) / self.covered
    }
}

/// The share of its way to a held target that a lag of first order covers in a sample; 1 for no lag.
pub(crate) fn covered(actuator: ActuatorParts, dt_s: f64) -> Interval {
    match actuator.lag.time_constant_s() {
        Some(tau) => Interval::ONE - (-(printed(dt_s) / printed(tau))).exp(),
        None => Interval::ONE,
    }
}

/// What a rate limit or stops leave open between samples; `None` where neither is there.
fn between<'a>(
    plant: &impl Fn(ActuatorLag) -> PrintedPlant<'a>,
    actuator: ActuatorParts,
    dt_s: f64,
) -> Result<Option<Between>, LimitError> {
    let stops = actuator.travel_rad.is_some() && actuator.lag.order() > 0;
    if actuator.rate_limit_rad_s.is_none() && !stops {
        return Ok(None);
    }
    let (time, half) = (printed(dt_s), Interval::point(0.5));
    // Areas below the way of the elevator, of its change and the period: by the lag alone, and at a constant rate.
    let by_lag = match actuator.lag.time_constant_s() {
        Some(tau) => Interval::ONE / covered(actuator, dt_s) - printed(tau) / time,
        None => Interval::ONE,
    };
    let below = by_lag - half;
    let above = if stops { Interval::ONE - by_lag } else { Interval::ZERO };
    let apart_s = (time * below).upper().max((time * above).upper());
    let response = plant(ActuatorLag::None).impulse_within_sample()?;
    Ok(Some(Between { apart_s, response }))
}
