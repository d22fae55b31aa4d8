//! Steps of an aircraft that changes: configurations that move, fuel that is burnt.

use fspid_aircraft::aerodynamics::varied::VariedModel;
use fspid_aircraft::integrate::rk4;
use fspid_aircraft::{
    Controls, Flow, ForceModel, Instant, MassProperties, RIGID_STATES, RigidState,
};

use super::{AircraftFlight, Holding, MOST_TRIES, Moving, STATES, Way, joined, parted, place};
use crate::aircraft::changing::{Changing, Fuel, Shown};

/// How near to empty a tank is empty, of what was in it.
const DRY: f64 = 1e-12;

/// What is integrated, with the fuel that was burnt.
const BURNING_STATES: usize = STATES + 1;

/// A model and how it changes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Varying<'a> {
    model: &'a VariedModel,
    changing: &'a Changing,
}

impl AircraftFlight {
    /// The model and its changes, of an aircraft that has any.
    pub(super) fn varying(&self) -> Option<Varying<'_>> {
        let model = self.aircraft().model().varied()?;
        Some(Varying { model, changing: self.plant.changing() })
    }

    /// Names of what samples show of the changes.
    pub(crate) fn shown_names(&self) -> Vec<&'static str> {
        self.varying().map(|it| Shown::names(it.model, it.changing)).unwrap_or_default()
    }

    /// What a sample shows of the changes, and the first limit that is left.
    pub(super) fn shown(&self, body: &Moving) -> Option<Shown> {
        let varying = self.varying()?;
        let mass_kg = self.mass(body).mass_kg;
        let at = [body.time_s, body.state.altitude_m()];
        Some(Shown::of(varying.model, varying.changing, at, [mass_kg, body.burnt_kg]))
    }

    /// The first limit that the flow or what is read off tables leaves, or an empty tank.
    pub(super) fn departure(
        &self,
        body: &Moving,
        (flow, controls): (&Flow, &Controls),
    ) -> Option<fspid_aircraft::Departure> {
        let Some(varying) = self.varying() else {
            return self.aircraft().model().departure(flow, controls);
        };
        let now = varying.at(self, body.time_s, body.burnt_kg);
        let left = now.model().departure(flow, controls);
        let dry = || varying.changing.fuel().and_then(|fuel| fuel.departure(body.burnt_kg));
        left.or_else(dry)
    }

    /// The body's mass properties now.
    pub(super) fn mass(&self, body: &Moving) -> MassProperties {
        match self.varying().and_then(|varying| varying.changing.fuel()) {
            Some(fuel) => fuel.body.with(fuel.left_kg(body.burnt_kg)),
            None => *self.aircraft().mass(),
        }
    }

    /// The throttle that acts: none where the tank is empty.
    pub(super) fn fed_throttle(&self, burnt_kg: f64, throttle: f64) -> f64 {
        let fuel = self.varying().and_then(|varying| varying.changing.fuel());
        let is_dry = fuel.is_some_and(|fuel| burnt_kg >= fuel.body.full_kg());
        if is_dry { 0.0 } else { throttle }
    }

    /// The motion after a step in which the aircraft changes, cut where its tank runs dry.
    pub(super) fn stepped_varying(
        &self,
        varying: Varying<'_>,
        (body, held): (&Moving, &Holding),
        step_s: f64,
    ) -> Moving {
        let next = self.burnt(varying, (body, held), step_s);
        let Some(fuel) = varying.changing.fuel() else { return next };
        let full_kg = fuel.body.full_kg();
        if body.burnt_kg >= full_kg || next.burnt_kg < full_kg {
            return next;
        }
        let (dry, at_s) = self.ran_dry(varying, (body, held), (&next, step_s), fuel);
        self.burnt(varying, (&dry, held), step_s - at_s)
    }

    /// The motion where the tank runs dry within a step, and how long a step reaches it: by regula falsi.
    fn ran_dry(
        &self,
        varying: Varying<'_>,
        (body, held): (&Moving, &Holding),
        (next, step_s): (&Moving, f64),
        fuel: &Fuel,
    ) -> (Moving, f64) {
        let full_kg = fuel.body.full_kg();
        let (mut before, mut after) = ((0.0, body.burnt_kg), (step_s, next.burnt_kg));
        let mut found = (*body, 0.0);
        for _ in 0..MOST_TRIES {
            let share = (full_kg - before.1) / (after.1 - before.1);
            let at_s = before.0 + (after.0 - before.0) * share;
            found = (self.burnt(varying, (body, held), at_s), at_s);
            let burnt_kg = found.0.burnt_kg;
            if (burnt_kg - full_kg).abs() <= DRY * full_kg {
                break;
            }
            if burnt_kg < full_kg {
                before = (at_s, burnt_kg);
            } else {
                after = (at_s, burnt_kg);
            }
        }
        (Moving { burnt_kg: full_kg, ..found.0 }, found.1)
    }

    /// One step of Runge and Kutta with the fuel as a state.
    fn burnt(
        &self,
        varying: Varying<'_>,
        (body, held): (&Moving, &Holding),
        step_s: f64,
    ) -> Moving {
        let mut next = *body;
        let stages = self.stages(&mut next.actuator, held, step_s);
        let throttle_of = |power| self.acting_throttle(power, held.throttle);
        let is_fed = self.fed_throttle(body.burnt_kg, 1.0) > 0.0;
        let rate = |time_s: f64, values: &[f64; BURNING_STATES]| {
            let [begin, middle, end] = &stages;
            let controls = match time_s {
                t if t <= 0.0 => begin,
                t if t < step_s => middle,
                _ => end,
            };
            let mut own = [0.0; STATES];
            own.copy_from_slice(&values[..STATES]);
            let way = parted(&own);
            let throttle = if is_fed { throttle_of(way.power) } else { 0.0 };
            let controls = Controls { throttle, ..*controls };
            let at = (&way, body.time_s + time_s, values[STATES]);
            self.varying_rate(varying, at, (&controls, held), is_fed)
        };
        let mut start = [body.burnt_kg; BURNING_STATES];
        start[..STATES].copy_from_slice(&joined(body));
        let values = rk4::step(rate, 0.0, &start, step_s);
        let mut own = [0.0; STATES];
        own.copy_from_slice(&values[..STATES]);
        let Way { state, distance_m, power } = parted(&own);
        Moving {
            state: RigidState { attitude: state.attitude.normalised(), ..state },
            distance_m,
            power,
            time_s: body.time_s + step_s,
            burnt_kg: values[STATES],
            ..next
        }
    }

    /// Rates of the body's state, of the way through the air, of the engine's power and of the fuel that is burnt.
    fn varying_rate(
        &self,
        varying: Varying<'_>,
        (way, time_s, burnt_kg): (&Way, f64, f64),
        (controls, held): (&Controls, &Holding),
        is_fed: bool,
    ) -> [f64; BURNING_STATES] {
        let Way { state, distance_m, power } = way;
        let place = place(state, &self.atmosphere, [*distance_m, time_s]);
        let air = self.atmosphere.at(&place, held.turbulence);
        let aircraft = varying.at(self, time_s, burnt_kg);
        let instant = aircraft.instant(state, controls, &air);
        let mut all = [0.0; BURNING_STATES];
        all[..RIGID_STATES].copy_from_slice(&state.rate(&instant.accelerations));
        all[RIGID_STATES] = instant.flow.airspeed_m_s;
        let asked = self.gearing().power(held.throttle);
        all[RIGID_STATES + 1] = self.plant.spool().rate_per_s(*power, asked);
        let fuel = varying.changing.fuel().filter(|_| is_fed);
        all[STATES] = fuel.map_or(0.0, |fuel| {
            fuel.consumption.rate_kg_s(aircraft.model().thrust_n(&instant.flow, controls))
        });
        all
    }

    /// Everything at one instant of the motion, in the flow that is there.
    pub(super) fn instant_in(
        &self,
        flow: Flow,
        body: &Moving,
        controls: &Controls,
        air: &fspid_aircraft::AirMotion,
    ) -> Instant {
        match self.varying() {
            Some(varying) => {
                let now = varying.at(self, body.time_s, body.burnt_kg);
                now.instant_in(flow, &body.state, controls, air)
            }
            None => self.aircraft().instant_in(flow, &body.state, controls, air),
        }
    }
}

impl<'a> Varying<'a> {
    /// The aircraft at a time with that much fuel burnt.
    fn at(
        &self,
        flight: &AircraftFlight,
        time_s: f64,
        burnt_kg: f64,
    ) -> fspid_aircraft::Aircraft<fspid_aircraft::aerodynamics::varied::VariedNow<'a>> {
        let fuel = self.changing.fuel().map(|fuel| (&fuel.body, fuel.left_kg(burnt_kg)));
        self.model.at(flight.aircraft(), self.changing.shares(time_s), fuel)
    }
}
