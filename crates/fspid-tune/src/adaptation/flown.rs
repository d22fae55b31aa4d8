//! Flights of the self-tuner, as it is and treated.

use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use fspid_campaign::engine::{self, FlightResult, Judging, Memory, Stability};
use fspid_core::{Fspid, Gains, Pid};
use fspid_scenario::file::Study;
use fspid_scenario::measure::Measure;
use fspid_scenario::units::degrees;
use fspid_sim::replay::{Replay, fly_replayed, fly_watching_inputs};
use fspid_sim::{Controller, Instant, Outcome, Prepared, SimError, Surroundings, Weather};

use super::trace::{Sketch, Trace};
use super::treatment::{COUNT, Treatment};
use crate::draw::Draw;
use crate::error::TuneError;
use crate::flights::hex_digest;

/// Error beyond which a flight is lost, deg: as in a contest.
pub(super) const LOST_DEG: f64 = 90.0;

/// Everybody is measured as it flew.
const JUDGING: Judging = Judging { stability: Stability::AsFlown, loads: false };

/// Who may stop the work, and how much of it is done.
#[derive(Clone, Copy)]
pub struct Watch<'a> {
    /// Whether it shall stop; asked before each flight.
    pub stops: &'a (dyn Fn() -> bool + Sync),
    /// Flights flown so far.
    pub flown: &'a AtomicUsize,
}

impl Watch<'_> {
    pub(super) fn ask(&self, flights: usize) -> Result<(), TuneError> {
        self.flown.fetch_add(flights, Ordering::Relaxed);
        if (self.stops)() { Err(TuneError::Stopped) } else { Ok(()) }
    }
}

/// What a flight came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Value {
    pub(super) iae_deg_s: f64,
    pub(super) travel_deg: f64,
    pub(super) lost: bool,
    /// Whether it breaks a requirement; none where that was not asked.
    pub(super) broken: Option<bool>,
    /// Whether its loop is stable at rest, in a word; none where that was not asked.
    pub(super) stability: Option<&'static str>,
}

impl Value {
    pub(super) const LOST: Self = Self {
        iae_deg_s: f64::INFINITY,
        travel_deg: f64::INFINITY,
        lost: true,
        broken: None,
        stability: None,
    };

    pub(super) fn of(flight: &FlightResult) -> Self {
        let measured = |measure| flight.metrics.measured(measure).unwrap_or(f64::INFINITY);
        let iae_deg_s = measured(Measure::ErrorIntegral);
        let travel_deg = measured(Measure::ElevatorTravel);
        // Written so that NaN is lost.
        let near = degrees(flight.metrics.largest_error_rad) <= LOST_DEG;
        let lost = flight.metrics.verdict.is_failure() || !near || !iae_deg_s.is_finite();
        let broken = flight.judgements.iter().any(|judgement| !judgement.met);
        let stability = flight.at_rest.stability_word();
        Self { iae_deg_s, travel_deg, lost, broken: Some(broken), stability }
    }
}

/// Adds up what a [`Value`] has, sample by sample.
#[derive(Default)]
struct Meter {
    error_rad: f64,
    travel_rad: f64,
    elevator_rad: Option<f64>,
    is_far: bool,
}

impl Meter {
    fn take(&mut self, instant: &Instant) -> ControlFlow<()> {
        let error_rad = (instant.setpoint_rad - instant.theta_rad).abs();
        self.error_rad += error_rad;
        let before = self.elevator_rad.replace(instant.elevator_rad);
        self.travel_rad += before.map_or(0.0, |before| (instant.elevator_rad - before).abs());
        self.is_far |= !(degrees(error_rad) <= LOST_DEG);
        ControlFlow::Continue(())
    }

    fn value(&self, outcome: Outcome, dt_s: f64) -> Value {
        if outcome != Outcome::Completed || self.is_far {
            return Value::LOST;
        }
        let (iae_deg_s, travel_deg) = (degrees(self.error_rad * dt_s), degrees(self.travel_rad));
        Value { iae_deg_s, travel_deg, lost: false, broken: None, stability: None }
    }
}

/// The self-tuner of a study that has one controller.
pub(super) fn tuner(study: &Study) -> Option<&Fspid<f64>> {
    match study.scenario.controllers.first().map(|named| &named.controller) {
        Some(Controller::SelfTuning(fspid)) => Some(fspid),
        _ => None,
    }
}

/// What the supervisor did in a flight.
#[derive(Clone, Debug, Default)]
pub(super) struct Record {
    gains: Vec<Gains<f64>>,
    inputs: Vec<[f64; 2]>,
    lost: bool,
    trace: Trace,
}

impl Record {
    fn of(prepared: &Prepared, controller: &Fspid<f64>) -> Result<Self, SimError> {
        let (mut record, mut meter) = (Self::default(), Meter::default());
        let outcome = fly_watching_inputs(prepared, controller, |instant, inputs| {
            record.gains.push(instant.step.gains);
            let Gains { kp, ki, kd } = instant.step.gains;
            record.trace.push([instant.theta_rad, instant.elevator_rad, kp, ki, kd]);
            record.inputs.push(inputs);
            meter.take(&instant)
        })?;
        record.lost = meter.value(outcome, prepared.timing().dt_s()).lost;
        Ok(record)
    }

    /// Mean and variance over time of each gain.
    fn moments(&self) -> [[f64; 2]; 3] {
        let of = |gain: fn(&Gains<f64>) -> f64| {
            let count = self.gains.len().max(1) as f64;
            let mean = self.gains.iter().map(gain).sum::<f64>() / count;
            let square = |it: &Gains<f64>| (gain(it) - mean) * (gain(it) - mean);
            [mean, self.gains.iter().map(square).sum::<f64>() / count]
        };
        [of(|it| it.kp), of(|it| it.ki), of(|it| it.kd)]
    }
}

/// What is known of a flight before it is treated.
#[derive(Clone, Debug)]
pub(super) struct First {
    /// The same for flights whose plant is written alike.
    pub(super) key: String,
    /// What it shows, in short.
    pub(super) sketch: Sketch,
    /// Change of pitch acceleration with the elevator, 1/s².
    pub(super) effectiveness_1_s2: Option<f64>,
    pub(super) airspeed_m_s: Option<f64>,
    /// Largest commanded pitch, deg.
    pub(super) amplitude_deg: f64,
    /// Mean and variance over time of kp, ki, kd.
    pub(super) moments: [[f64; 2]; 3],
    pub(super) lost: bool,
    /// The same for flights with the same command, disturbances, air and sensors.
    pub(super) signals: String,
}

/// Flies a study as it is; the gains of each sample beside what is known of it.
pub(super) fn first(
    study: &Study,
    watch: Watch<'_>,
) -> Result<(First, Vec<Gains<f64>>), TuneError> {
    watch.ask(1)?;
    let scenario = &study.scenario;
    let prepared = scenario.prepare().map_err(|error| unflown(&error))?;
    let tuner = tuner(study).ok_or_else(no_tuner)?;
    let record = Record::of(&prepared, tuner).map_err(|error| unflown(&error))?;
    let parts = (&scenario.plant, &scenario.plant_changes, &scenario.actuator);
    let largest = prepared.setpoint_rad().iter().fold(0.0, |most: f64, it| most.max(it.abs()));
    let first = First {
        key: hex_digest(&format!("{parts:?}")),
        sketch: record.trace.sketch(),
        effectiveness_1_s2: effectiveness_1_s2(study),
        airspeed_m_s: study.airframes.first().and_then(|it| it.airspeed_m_s),
        amplitude_deg: degrees(largest),
        moments: record.moments(),
        lost: record.lost,
        signals: signals(study, &prepared),
    };
    Ok((first, record.gains))
}

impl First {
    /// Mean gains of the flight.
    pub(super) fn mean(&self) -> Gains<f64> {
        let [[kp, _], [ki, _], [kd, _]] = self.moments;
        Gains { kp, ki, kd }
    }
}

/// What a flight shows with the plant of another study in the place of its own; none where that cannot be flown.
pub(super) fn with_plant_of(
    mut study: Study,
    other: Study,
    watch: Watch<'_>,
) -> Result<Option<Trace>, TuneError> {
    watch.ask(1)?;
    let (own, other) = (&mut study.scenario, other.scenario);
    (own.plant, own.plant_changes, own.actuator) =
        (other.plant, other.plant_changes, other.actuator);
    let Ok(prepared) = own.prepare() else { return Ok(None) };
    let tuner = tuner(&study).ok_or_else(no_tuner)?;
    Ok(Record::of(&prepared, tuner).ok().map(|record| record.trace))
}

/// Everything that enters a flight beside its plant; where it flies is the plant's.
fn signals(study: &Study, prepared: &Prepared) -> String {
    let scenario = &study.scenario;
    let own = (prepared.setpoint_rad(), &scenario.disturbances, scenario.timing);
    let Surroundings { weather, pitch_sensor, rate_sensor } = &scenario.surroundings;
    let moves = |it: &&Weather| !it.winds.is_empty() || it.turbulence.is_some();
    let air = weather.as_ref().filter(moves).map(|it| (&it.winds, &it.turbulence));
    hex_digest(&format!(
        "{own:?} {air:?} {pitch_sensor:?} {rate_sensor:?} {:?}",
        scenario.autopilot
    ))
}

/// Sums of the gains of flights at each sample, and how many they are.
type Sums = Vec<[f64; 4]>;

/// Sums of the gains that flights with the same signals have at each sample.
#[derive(Clone, Debug, Default)]
pub(super) struct Schedules {
    of_signals: Vec<Schedule>,
    /// Signals that a plant flies more than once, and the plant.
    again: BTreeSet<(String, usize)>,
}

/// Those of the same signals.
#[derive(Clone, Debug, Default)]
struct Schedule {
    signals: String,
    all: Sums,
    /// Of each part of the plants that has some.
    parts: Vec<(usize, Sums)>,
    /// Of each plant that has more than one such flight.
    plants: Vec<(usize, Sums)>,
}

impl Schedules {
    /// Without gains yet; of flights, and the plant of each.
    pub(super) fn of(firsts: &[First], plants: &[usize]) -> Self {
        let (mut once, mut again) = (BTreeSet::new(), BTreeSet::new());
        for (first, plant) in firsts.iter().zip(plants).filter(|(first, _)| !first.lost) {
            if !once.insert((&first.signals, *plant)) {
                again.insert((first.signals.clone(), *plant));
            }
        }
        Self { of_signals: Vec::new(), again }
    }

    /// Takes in a flight that is not lost, of a plant that may be in a part.
    pub(super) fn add(
        &mut self,
        signals: &str,
        (plant, part): (usize, Option<usize>),
        gains: &[Gains<f64>],
    ) {
        let known = self.of_signals.iter().position(|it| it.signals == signals);
        let place = known.unwrap_or(self.of_signals.len());
        if known.is_none() {
            let signals = signals.to_owned();
            self.of_signals.push(Schedule { signals, ..Schedule::default() });
        }
        let schedule = &mut self.of_signals[place];
        add(&mut schedule.all, gains);
        if let Some(part) = part {
            add_to(&mut schedule.parts, part, gains);
        }
        if self.again.contains(&(signals.to_owned(), plant)) {
            add_to(&mut schedule.plants, plant, gains);
        }
    }

    /// Mean gains of the flights of other plants with the same signals, sample by sample, without those of a part of the
    /// plants; none where there are none.
    fn of_others(
        &self,
        (signals, plant): (&str, usize),
        own: &Record,
        without: Option<usize>,
    ) -> Option<Vec<Gains<f64>>> {
        let Schedule { all, parts, plants, .. } =
            self.of_signals.iter().find(|it| it.signals == signals)?;
        let left = parts.iter().find(|(part, _)| Some(*part) == without).map(|(_, sums)| sums);
        let of_plant = plants.iter().find(|(it, _)| *it == plant).map(|(_, sums)| sums);
        let others = all.iter().zip(&own.gains).enumerate().map(|(sample, (sum, own))| {
            let at = |sums: Option<&Sums>| sums.and_then(|sums| sums.get(sample)).copied();
            let left = at(left).unwrap_or_default();
            let own = at(of_plant).unwrap_or([own.kp, own.ki, own.kd, 1.0]);
            let mut others = [0.0; 4];
            for (place, other) in others.iter_mut().enumerate() {
                *other = sum[place] - left[place] - own[place];
            }
            let [kp, ki, kd, count] = others;
            (count > 0.5).then(|| Gains { kp: kp / count, ki: ki / count, kd: kd / count })
        });
        others.collect()
    }
}

fn add_to(known: &mut Vec<(usize, Sums)>, of: usize, gains: &[Gains<f64>]) {
    match known.iter_mut().find(|(it, _)| *it == of) {
        Some((_, sums)) => add(sums, gains),
        None => {
            let mut sums = Sums::new();
            add(&mut sums, gains);
            known.push((of, sums));
        }
    }
}

fn add(sums: &mut Sums, gains: &[Gains<f64>]) {
    sums.resize(sums.len().max(gains.len()), [0.0; 4]);
    for (sum, Gains { kp, ki, kd }) in sums.iter_mut().zip(gains) {
        *sum = [sum[0] + kp, sum[1] + ki, sum[2] + kd, sum[3] + 1.0];
    }
}

/// How much the pitch acceleration changes with the elevator, 1/s²: the limit of $s^2 \theta / \delta_e$ for large $s$, of
/// an aircraft by its linear model at the trim. None for plants whose pitch does not follow with two integrations.
fn effectiveness_1_s2(study: &Study) -> Option<f64> {
    let plant = &study.scenario.plant;
    let trimmed = plant.aircraft().and_then(|aircraft| aircraft.linear().ok());
    let linear = plant.linear().or(trimmed.as_ref())?.transfer_function();
    let lead = |coefficients: &[f64]| coefficients.first().copied();
    let numerator = lead(linear.numerator().coefficients())?;
    let denominator = lead(linear.denominator().coefficients())?;
    (linear.relative_degree() == 2).then_some((numerator / denominator).abs())
}

/// A flight in a study's words that cannot be flown.
fn unflown(error: &SimError) -> TuneError {
    TuneError::Engine { reason: error.to_string() }
}

fn no_tuner() -> TuneError {
    TuneError::Engine { reason: "the controller has no supervisor in every case".to_owned() }
}

/// Values of each treatment, one for each seed.
pub(super) type Values = [Vec<Value>; COUNT];

/// What a flight is worth treated.
#[derive(Clone, Debug)]
pub(super) struct Treated {
    pub(super) values: Values,
    /// What depends on other plants, without each part of the plants: with the mean gains of all flights, and with those of
    /// the other plants.
    pub(super) left: Vec<[Option<Value>; 2]>,
}

impl Treated {
    /// The values where a part of the plants had not flown.
    pub(super) fn without(&self, part: usize) -> Values {
        let mut values = self.values.clone();
        let left = self.left.get(part).copied().unwrap_or_default();
        for (treatment, value) in Treatment::OF_OTHERS.into_iter().zip(left) {
            values[treatment.place()] = value.into_iter().collect();
        }
        values
    }
}

/// A flight that is flown again with gains or inputs that somebody has.
struct Again<'a> {
    prepared: Prepared,
    tuner: &'a Fspid<f64>,
    record: Record,
    /// The plant that it is of.
    plant: usize,
    signals: String,
}

impl<'a> Again<'a> {
    fn of(study: &'a Study, plant: usize) -> Result<Self, TuneError> {
        let prepared = study.scenario.prepare().map_err(|error| unflown(&error))?;
        let tuner = tuner(study).ok_or_else(no_tuner)?;
        let record = Record::of(&prepared, tuner).map_err(|error| unflown(&error))?;
        Ok(Self { signals: signals(study, &prepared), prepared, tuner, record, plant })
    }

    fn fly(&self, replay: Replay<'_>) -> Result<Value, TuneError> {
        flown(&self.prepared, self.tuner, replay).map_err(|error| unflown(&error))
    }

    /// With the gains that its flight has on other plants, without a part of them; none where there are none.
    fn of_others(
        &self,
        schedules: &Schedules,
        without: Option<usize>,
        watch: Watch<'_>,
    ) -> Result<Option<Value>, TuneError> {
        if self.record.lost {
            return Ok(None);
        }
        let others = schedules.of_others((&self.signals, self.plant), &self.record, without);
        let fly = |gains: Vec<Gains<f64>>| {
            watch.ask(1)?;
            self.fly(Replay::Gains(&gains))
        };
        others.map(fly).transpose()
    }
}

/// Flies a study with the gains that its flight has on other plants, without each part of these; not without its own part.
pub(super) fn without_parts(
    study: &Study,
    (plant, part, parts): (usize, usize, usize),
    schedules: &Schedules,
    watch: Watch<'_>,
) -> Result<Vec<Option<Value>>, TuneError> {
    let again = Again::of(study, plant)?;
    let without = |left: usize| match left == part {
        true => Ok(None),
        false => again.of_others(schedules, Some(left), watch),
    };
    (0..parts).map(without).collect()
}

/// Flies a study, given by its number and its plant, with its own gains and inputs at other moments, and with the gains that
/// its flight has on other plants.
pub(super) fn replayed(
    study: &Study,
    (number, plant): (usize, usize),
    schedules: &Schedules,
    (seed, seeds): (u64, u64),
    watch: Watch<'_>,
) -> Result<Values, TuneError> {
    let mut values = Values::default();
    let again = Again::of(study, plant)?;
    let record = &again.record;
    values[Treatment::OtherPlants.place()].extend(again.of_others(schedules, None, watch)?);
    for seed in (0..seeds).map(|place| seed.wrapping_add(place)) {
        watch.ask(Treatment::DRAWN.len())?;
        let mut draw = Draw::of(seed, number as u64);
        let turned = turned(&record.gains, &mut draw);
        let order = draw.order(record.gains.len());
        let gains = shuffled(&record.gains, &order);
        let inputs = shuffled(&record.inputs, &order);
        let replays = [Replay::Gains(&turned), Replay::Gains(&gains), Replay::Inputs(&inputs)];
        for (treatment, replay) in Treatment::DRAWN.into_iter().zip(replays) {
            values[treatment.place()].push(again.fly(replay)?);
        }
    }
    Ok(values)
}

fn flown(prepared: &Prepared, tuner: &Fspid<f64>, replay: Replay<'_>) -> Result<Value, SimError> {
    let mut meter = Meter::default();
    let outcome = fly_replayed(prepared, tuner, replay, |instant| meter.take(&instant))?;
    Ok(meter.value(outcome, prepared.timing().dt_s()))
}

/// Begun at another place, the first entries behind the last.
fn turned<T: Copy>(entries: &[T], draw: &mut Draw) -> Vec<T> {
    let mut turned = entries.to_vec();
    // Not where they are.
    let by = 1 + draw.below(entries.len().saturating_sub(1));
    turned.rotate_left(by.min(entries.len()));
    turned
}

fn shuffled<T: Copy>(entries: &[T], order: &[usize]) -> Vec<T> {
    order.iter().filter_map(|&place| entries.get(place).copied()).collect()
}

/// The study with gains that stand still in place of the supervisor; none for gains that make no controller.
pub(super) fn frozen(study: &Study, gains: Gains<f64>) -> Option<Study> {
    let fixed = Pid::new(gains, tuner(study)?.config_at(gains)).ok()?;
    let mut frozen = study.clone();
    frozen.scenario.controllers.first_mut()?.controller = Controller::Fixed(fixed);
    Some(frozen)
}

/// Judged flights of studies of one case, side by side where they can; none for a study that cannot be flown.
pub(super) fn judged(
    memory: &mut Memory,
    studies: &[Study],
    watch: Watch<'_>,
) -> Result<Vec<Option<FlightResult>>, TuneError> {
    watch.ask(studies.len())?;
    let flown = engine::fly_judging(memory, studies, JUDGING);
    Ok(flown.into_iter().map(|flights| flights.ok()?.into_iter().next()).collect())
}

/// Values of a study that flies with gains that stand still, one after the other.
pub(super) fn standing(
    memory: &mut Memory,
    study: &Study,
    gains: &[Gains<f64>],
    watch: Watch<'_>,
) -> Result<Vec<Value>, TuneError> {
    let studies: Option<Vec<Study>> = gains.iter().map(|gains| frozen(study, *gains)).collect();
    let flights = match &studies {
        Some(studies) => judged(memory, studies, watch)?,
        None => vec![None; gains.len()],
    };
    let value = |flight: &Option<FlightResult>| flight.as_ref().map_or(Value::LOST, Value::of);
    Ok(flights.iter().map(value).collect())
}
