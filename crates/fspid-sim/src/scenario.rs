//! What flies: a scenario without options and without invalid state.

use crate::actuated::Actuated;
use crate::actuator::Actuator;
use crate::aircraft::{AircraftFlight, AircraftPlant, Changing};
use crate::autopilot::{Autopilot, Throttle};
use crate::controller::Controller;
use crate::error::SimError;
use crate::external::{External, NamedExternal};
use crate::external_plant::{Around, ExternalFlight, ExternalPlant};
use crate::gust_response;
use crate::plant::{LinearPlant, Plant, PlantChange};
use crate::propagation::Propagation;
use crate::propagator::Propagator;
use crate::sensor::Sensor;
use crate::signal::{Disturbance, Edge, Entry, Leaves, Profile};
use crate::surroundings::Surroundings;
use crate::timing::Timing;

/// A controller and what it is called.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedController {
    /// Name in traces and reports; unique in its scenario.
    pub name: String,
    /// The controller.
    pub controller: Controller,
}

/// A controller of the scenario, internal or external.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Flyer<'a> {
    /// With equations.
    Own(&'a NamedController),
    /// Without.
    External(&'a NamedExternal),
}

impl<'a> Flyer<'a> {
    /// Name in traces and reports.
    #[must_use]
    pub fn name(self) -> &'a str {
        match self {
            Self::Own(named) => &named.name,
            Self::External(named) => &named.name,
        }
    }

    /// The same without its name.
    #[must_use]
    pub fn respondent(self) -> Respondent<'a> {
        match self {
            Self::Own(named) => Respondent::Equations(&named.controller),
            Self::External(named) => Respondent::External(&named.external),
        }
    }

    /// The equations, if there are any.
    #[must_use]
    pub fn controller(self) -> Option<&'a Controller> {
        match self {
            Self::Own(named) => Some(&named.controller),
            Self::External(_) => None,
        }
    }
}

/// The controller that computes the commands of a flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Respondent<'a> {
    /// Equations.
    Equations(&'a Controller),
    /// A program.
    External(&'a External),
}

/// A flight to be simulated, once for each controller.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// Name in reports.
    pub name: String,
    /// The aircraft.
    pub plant: Plant,
    /// Changes of a linear plant in flight, in order of time.
    pub plant_changes: Vec<PlantChange>,
    /// What moves the elevator.
    pub actuator: Actuator,
    /// Samples.
    pub timing: Timing,
    /// Commanded pitch.
    pub setpoint: Profile,
    /// What disturbs.
    pub disturbances: Vec<Disturbance>,
    /// Who answers.
    pub controllers: Vec<NamedController>,
    /// Who answers without equations, and flies behind the others.
    pub externals: Vec<NamedExternal>,
    /// Moving air and sensors; by default none.
    pub surroundings: Surroundings,
    /// What commands pitch, throttle and bank of an aircraft, beside the set-point; by default nothing.
    pub autopilot: Option<Autopilot>,
}

/// Which noises of disturbances are asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Noises {
    /// None: noise pushes nowhere.
    None,
    /// Those at servo and elevator, which move the aircraft.
    ThatMove,
}

impl Scenario {
    /// A flight with an ideal actuator in calm air, without anybody who answers yet; `name` is the title of reports.
    #[must_use]
    pub fn new(name: &str, plant: impl Into<Plant>, timing: Timing, setpoint: Profile) -> Self {
        Self {
            name: name.to_owned(),
            plant: plant.into(),
            plant_changes: Vec::new(),
            actuator: Actuator::ideal(),
            timing,
            setpoint,
            disturbances: Vec::new(),
            controllers: Vec::new(),
            externals: Vec::new(),
            surroundings: Surroundings::default(),
            autopilot: None,
        }
    }

    /// The same with one more controller, which flies alone as the others do.
    #[must_use]
    pub fn with_controller(mut self, name: &str, controller: Controller) -> Self {
        self.controllers.push(NamedController { name: name.to_owned(), controller });
        self
    }

    /// What is flown, for however long: scenarios of which this is the same fly the same as far as both go, but for a wait at the trim
    /// before set-point or disturbances move it. Disturbances of no size are left out.
    #[must_use]
    pub fn whenever(&self) -> Self {
        let mut flown = Self { timing: self.timing.shortest(), ..self.clone() };
        let stands_by_itself = match &self.plant {
            Plant::Linear(_) => self.plant_changes.is_empty(),
            Plant::Aircraft(plant) => *plant.changing() == Changing::default(),
            Plant::External(_) => false,
        };
        flown.disturbances.retain(|it| it.part().0 != 0.0);
        let is_calm = self.autopilot.is_none() && self.surroundings == Surroundings::default();
        if stands_by_itself && is_calm {
            flown.begin_at_once();
        }
        flown
    }

    /// What acts within the flight: without the set-point, and the disturbances, that would begin at its end or after.
    #[must_use]
    pub fn within_its_time(&self) -> Self {
        let end_s = self.timing.end_s();
        let mut flown = self.clone();
        flown.disturbances.retain(|it| it.starts_s() < end_s);
        if matches!(self.setpoint.leaves_s(), Leaves::At(at_s) if at_s >= end_s) {
            flown.setpoint = Profile::still();
        }
        flown
    }

    /// Brings set-point and disturbances forward together, to where the first of them begins; what has times of its own stays.
    fn begin_at_once(&mut self) {
        let setpoint_s = match self.setpoint.leaves_s() {
            Leaves::At(at_s) => Some(at_s),
            Leaves::Never => {
                self.setpoint = Profile::still();
                None
            }
            Leaves::ByTimes => return,
        };
        if self.disturbances.iter().any(Disturbance::is_noise) {
            return;
        }
        let starts_s = self.disturbances.iter().map(Disturbance::starts_s).chain(setpoint_s);
        let Some(first_s) = starts_s.reduce(f64::min) else { return };
        self.setpoint = match setpoint_s {
            Some(_) => self.setpoint.earlier(first_s),
            None => Profile::still(),
        };
        for disturbance in &mut self.disturbances {
            *disturbance = disturbance.earlier(first_s);
        }
    }

    /// Everybody who answers, in the order of the flights.
    pub fn flyers(&self) -> impl Iterator<Item = Flyer<'_>> {
        let externals = self.externals.iter().map(Flyer::External);
        self.controllers.iter().map(Flyer::Own).chain(externals)
    }

    /// Starts another simulator and every external controller once and lets it go, as who flies many flights does first.
    ///
    /// # Errors
    /// [`SimError`] names the first that cannot fly, or not more than once.
    pub fn start_externals(&self) -> Result<(), SimError> {
        if let Plant::External(plant) = &self.plant {
            self.external_flight(plant)?.start()?;
        }
        self.externals.iter().try_for_each(|named| {
            named.external.source.require_many_flights()?;
            named.external.start().map(drop)
        })
    }

    /// When disturbances begin to push the loop, s, ascending; noise does where it is among these, and what is of no size nowhere.
    #[must_use]
    pub fn pushes_s(&self, noises: Noises) -> Vec<f64> {
        let counts = |it: &Disturbance| match noises {
            Noises::None => !it.is_noise(),
            Noises::ThatMove => !it.is_noise() || it.entry() != Entry::Measurement,
        };
        let pushes = |it: &&Disturbance| counts(it) && it.part().0 != 0.0;
        let pushing = self.disturbances.iter().filter(pushes);
        let mut pushes_s: Vec<f64> = pushing.map(Disturbance::starts_s).collect();
        pushes_s.sort_by(f64::total_cmp);
        pushes_s
    }

    /// Whether the air around the aircraft moves: wind, gusts or turbulence.
    #[must_use]
    pub fn has_moving_air(&self) -> bool {
        let weather = self.surroundings.weather.as_ref();
        weather.is_some_and(|it| !it.winds.is_empty() || it.turbulence.is_some())
    }

    /// What disturbances add at a place at each sample, rad, noise left out; nothing where none enters there.
    #[must_use]
    pub fn loads_rad(&self, entry: Entry) -> Option<Vec<f64>> {
        self.entering_rad(entry, |disturbance| !disturbance.is_noise())
    }

    /// The same of those that count.
    fn entering_rad(
        &self,
        entry: Entry,
        counts: impl Fn(&Disturbance) -> bool,
    ) -> Option<Vec<f64>> {
        let mut sum: Option<Vec<f64>> = None;
        for (stream, disturbance) in (0_u64..).zip(&self.disturbances) {
            if disturbance.entry() == entry && counts(disturbance) {
                let values = sum.get_or_insert_with(|| vec![0.0; self.timing.rows()]);
                disturbance.add_to(values, self.timing, stream);
            }
        }
        sum
    }

    /// Everything that does not depend on the controller, computed once.
    ///
    /// # Errors
    /// [`SimError`] where a plant change alters the order or makes a model that cannot be sampled,
    /// or where air moves around a plant that does not feel it.
    pub fn prepare(&self) -> Result<Prepared, SimError> {
        let (setpoint_rad, edges) = self.setpoint.sampled(self.timing);
        let column = |entry: Entry| self.entering_rad(entry, |_| true);
        for stack in self.externals.iter().filter_map(|it| it.external.source.flight_stack()) {
            let name = stack.protocol.name();
            stack
                .check(&self.plant, self.autopilot.is_some())
                .map_err(|reason| SimError::FlightStack { name, reason })?;
        }
        let (stages, gusts) = (self.stages()?, self.gusts()?);
        let gust_responses = match (&self.surroundings.weather, &gusts) {
            (Some(weather), Some(gusts)) => {
                gust_response::responses(weather, self.timing, gusts, &stages)?
            }
            _ => None,
        };
        Ok(Prepared {
            timing: self.timing,
            delay_samples: self.actuator.delay_samples(),
            setpoint_rad,
            edges,
            at_servo: column(Entry::Servo),
            at_elevator: column(Entry::Elevator),
            at_measurement: column(Entry::Measurement),
            stages,
            gusts,
            gust_responses,
            pitch_sensor: self.surroundings.pitch_sensor,
            rate_sensor: self.surroundings.rate_sensor,
            autopilot: self.checked_autopilot()?.cloned(),
            throttle: self.plant.aircraft().map(Throttle::of),
        })
    }

    /// True for a flight that [`batch`](crate::batch) can fly: a linear plant in calm air behind a first-order servo,
    /// seen as it is.
    #[must_use]
    pub fn flies_side_by_side(&self) -> bool {
        let Surroundings { weather, pitch_sensor, rate_sensor } = &self.surroundings;
        let is_seen = pitch_sensor.is_none() && rate_sensor.is_none();
        let is_calm = weather.is_none();
        self.plant.linear().is_some() && is_calm && is_seen && self.actuator.is_first_order_servo()
    }

    /// The autopilot, if this plant and this flight can have it.
    fn checked_autopilot(&self) -> Result<Option<&Autopilot>, SimError> {
        let Some(autopilot) = &self.autopilot else { return Ok(None) };
        match &self.plant {
            Plant::Aircraft(plant) => autopilot.check(plant, self.timing)?,
            // Whether it has an engine is for the simulator to say.
            Plant::External(plant) if plant.simulator.shows_aircraft() => {
                autopilot.check_timing(self.timing)?;
            }
            Plant::Linear(_) | Plant::External(_) => return Err(SimError::AutopilotNeedsAircraft),
        }
        Ok(Some(autopilot))
    }

    fn gusts(&self) -> Result<Option<Vec<[f64; 3]>>, SimError> {
        let (Some(weather), Plant::Linear(_)) = (&self.surroundings.weather, &self.plant) else {
            return Ok(None);
        };
        if self.lasting_plants().iter().any(|(_, plant)| !plant.feels_gusts()) {
            return Err(SimError::NoGustEntry);
        }
        weather.gusts(self.timing).map(Some)
    }

    /// A plant of the scenario, discretised: as one with a first-order servo in calm air, by legs else.
    pub(crate) fn propagation(
        &self,
        plant: &LinearPlant,
        dt_s: f64,
    ) -> Result<Propagation, SimError> {
        if self.surroundings.weather.is_none() && self.actuator.is_first_order_servo() {
            return Propagator::new(plant, self.actuator, dt_s).map(Propagation::AsOne);
        }
        Actuated::new(plant, self.actuator, dt_s).map(Propagation::ByLegs)
    }

    /// The one stage of a flight whose plant is an aircraft.
    fn aircraft_stages(&self, plant: &AircraftPlant) -> Result<Vec<Stage>, SimError> {
        if !self.plant_changes.is_empty() {
            return Err(SimError::AircraftChanges);
        }
        let weather = self.surroundings.weather.as_ref();
        let flight = AircraftFlight::new(plant, self.actuator, weather, self.timing)?;
        Ok(vec![Stage { from: 0, propagation: Propagation::Aircraft(Box::new(flight)) }])
    }

    /// The one stage of a flight that another simulator flies.
    fn external_stages(&self, plant: &ExternalPlant) -> Result<Vec<Stage>, SimError> {
        if !self.plant_changes.is_empty() {
            return Err(SimError::OtherSimulatorChanges);
        }
        let flight = self.external_flight(plant)?;
        Ok(vec![Stage { from: 0, propagation: Propagation::External(Box::new(flight)) }])
    }

    fn external_flight(&self, plant: &ExternalPlant) -> Result<ExternalFlight, SimError> {
        let weather = self.surroundings.weather.as_ref();
        let moves_throttle = self.autopilot.as_ref().is_some_and(Autopilot::moves_throttle);
        let around = Around { weather, moves_throttle };
        ExternalFlight::new(plant, self.actuator, self.timing, around)
    }

    /// The plant's discretisations, each with the sample from which it holds.
    fn stages(&self) -> Result<Vec<Stage>, SimError> {
        match &self.plant {
            Plant::Linear(plant) => self.linear_stages(plant),
            Plant::Aircraft(plant) => self.aircraft_stages(plant),
            Plant::External(plant) => self.external_stages(plant),
        }
    }

    fn linear_stages(&self, plant: &LinearPlant) -> Result<Vec<Stage>, SimError> {
        if let Some((_, at_s)) = self.ramp_without_effect() {
            return Err(SimError::RampWithoutEffect { at_s });
        }
        let dt_s = self.timing.dt_s();
        let new_stage = |from, plant: &LinearPlant| {
            Ok::<_, SimError>(Stage { from, propagation: self.propagation(plant, dt_s)? })
        };
        let mut stages = vec![new_stage(0, plant)?];
        let mut before = plant.clone();
        let mut changes = self.plant_changes.iter().peekable();
        while let Some(change) = changes.next() {
            let begin = self.timing.first_sample_at(change.at_s());
            let end = self.timing.first_sample_at(change.at_s() + change.ramp_s());
            let next_begin = changes
                .peek()
                .map_or(self.timing.rows(), |next| self.timing.first_sample_at(next.at_s()));
            // Within a ramp the coefficients are those of each sample's own time, held through it.
            for k in begin..=end.min(next_begin.saturating_sub(1)) {
                let plant = change.between(&before, fraction(change, self.timing.time_s(k)))?;
                stages.push(new_stage(k, &plant)?);
            }
            let reached_s = self.timing.time_s(next_begin);
            before = change.between(&before, fraction(change, reached_s))?;
        }
        Ok(stages)
    }

    /// The first change of the plant, from 0, whose ramp goes through a plant that the elevator does not move, and when, s:
    /// however long the flight is, and wherever samples lie.
    #[must_use]
    pub fn ramp_without_effect(&self) -> Option<(usize, f64)> {
        let mut before = self.plant.linear()?.clone();
        for (number, change) in self.plant_changes.iter().enumerate() {
            let until_s =
                self.plant_changes.get(number + 1).map_or(f64::INFINITY, PlantChange::at_s);
            let ramp = (change.ramp_s() > 0.0).then(|| change.without_effect(&before)).flatten();
            let at_s = ramp.map(|fraction| change.at_s() + fraction * change.ramp_s());
            if let Some(at_s) = at_s.filter(|at_s| *at_s < until_s) {
                return Some((number, at_s));
            }
            before = change.between(&before, fraction(change, until_s)).ok()?;
        }
        None
    }

    /// Every linear plant that lasts: the first, and the one after each change.
    #[must_use]
    pub fn lasting_plants(&self) -> Vec<(f64, &LinearPlant)> {
        let first = self.plant.linear().into_iter().map(|plant| (0.0, plant));
        let later = self.plant_changes.iter().map(|change| (change.at_s(), change.target()));
        first.chain(later).collect()
    }
}

fn fraction(change: &PlantChange, time_s: f64) -> f64 {
    if change.ramp_s() > 0.0 {
        // The same allowance for rounding as everywhere: a millionth of the ramp.
        let fraction = (time_s - change.at_s()) / change.ramp_s();
        if fraction > 1.0 - 1e-6 { 1.0 } else { fraction.max(0.0) }
    } else {
        1.0
    }
}

/// A discretised plant and the sample from which it holds.
#[derive(Clone, Debug)]
pub(crate) struct Stage {
    pub(crate) from: usize,
    pub(crate) propagation: Propagation,
}

/// What all controllers of a scenario share: sampled signals and discretised plants.
#[derive(Clone, Debug)]
pub struct Prepared {
    pub(crate) timing: Timing,
    pub(crate) delay_samples: usize,
    pub(crate) setpoint_rad: Vec<f64>,
    pub(crate) edges: Vec<Edge>,
    pub(crate) at_servo: Option<Vec<f64>>,
    pub(crate) at_elevator: Option<Vec<f64>>,
    pub(crate) at_measurement: Option<Vec<f64>>,
    pub(crate) stages: Vec<Stage>,
    pub(crate) gusts: Option<Vec<[f64; 3]>>,
    /// What the air's change within each sample adds to a linear plant; none where it does not change.
    pub(crate) gust_responses: Option<Vec<Vec<f64>>>,
    pub(crate) pitch_sensor: Option<Sensor>,
    pub(crate) rate_sensor: Option<Sensor>,
    pub(crate) autopilot: Option<Autopilot>,
    pub(crate) throttle: Option<Throttle>,
}

impl Prepared {
    /// Samples.
    #[must_use]
    pub fn timing(&self) -> Timing {
        self.timing
    }

    /// Commanded pitch at each sample, rad.
    #[must_use]
    pub fn setpoint_rad(&self) -> &[f64] {
        &self.setpoint_rad
    }

    /// The steps in the command.
    #[must_use]
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// True where the controller sees through a sensor.
    #[must_use]
    pub fn has_sensors(&self) -> bool {
        self.pitch_sensor.is_some() || self.rate_sensor.is_some()
    }

    /// True where something commands pitch from around the loop.
    #[must_use]
    pub fn has_autopilot(&self) -> bool {
        self.autopilot.is_some()
    }

    /// True for a flight in six degrees of freedom, here or in another simulator.
    #[must_use]
    pub fn is_aircraft(&self) -> bool {
        self.stages.iter().any(|stage| match &stage.propagation {
            Propagation::Aircraft(_) => true,
            Propagation::External(flight) => flight.shows_aircraft(),
            Propagation::AsOne(_) | Propagation::ByLegs(_) => false,
        })
    }

    /// Names of what a nonlinear aircraft shows of its configurations, its fuel and the ground.
    pub(crate) fn shown_names(&self) -> Vec<&'static str> {
        let mut flights = self.stages.iter().filter_map(|stage| match &stage.propagation {
            Propagation::Aircraft(flight) => Some(flight.shown_names()),
            _ => None,
        });
        flights.next().unwrap_or_default()
    }

    /// The air's velocity forward and down, m/s, and its pitch rate, rad/s, at each sample of a linear
    /// plant; none in calm air.
    ///
    /// What an aircraft meets depends on its way, and stands in its trace.
    #[must_use]
    pub fn gusts(&self) -> Option<&[[f64; 3]]> {
        self.gusts.as_deref()
    }
}
