//! Local stability of a nonlinear aircraft about each of its trims: the pitch loop, the lateral and airspeed dynamics, and
//! every mode of the autopilot.

mod blown;

use fspid_core::Gains;
use fspid_lti::{eigenvalues, modulus};

use crate::aircraft::{AircraftPlant, Change, Standing, step_s};
use crate::controller::Controller;
use crate::error::SimError;
use crate::in_flight::{Alone, poles_of_mode, radii_alone};
use crate::leads_to::{Place, places};
use crate::plant::{LinearPlant, Plant};
use crate::rest::{Doubt, Rest, RestPoint};
use crate::scenario::Scenario;
use crate::sensor::Seeing;
use crate::stability::{
    GrowthAtRest, MODE_RADIUS, Undecided, Unstable, doubling_s, growth_of_plant, holds,
};
use blown::{Blown, blown};

/// A controller and the gains that it has at rest.
type Held<'a> = (&'a Controller, Gains<f64>);

/// Largest |λ| h of a motion that steps of the classical method of Runge and Kutta follow: there it is off by 3·10⁻⁴ a step.
const FOLLOWED: f64 = 0.5;

/// What grows about the trims of a scenario's aircraft, as it is at the start and as it comes to be.
pub(crate) fn growth(
    scenario: &Scenario,
    aircraft: &AircraftPlant,
    controller: &Controller,
    gains: Gains<f64>,
) -> Result<GrowthAtRest, SimError> {
    let mut found = GrowthAtRest::default();
    let standings = aircraft.standings();
    for standing in &standings {
        let Some(own) = standing.flown_in(scenario) else {
            found.doubt(Undecided::at_trim(Doubt::ChangedAircraft));
            continue;
        };
        let of_it = match (standing.by, of_standing(&own, standing, (controller, gains))) {
            (Change::Nothing, of_it) => of_it?,
            (Change::Configuration, Ok(of_it)) => of_it,
            // How much is burnt only the flight tells.
            (Change::Fuel, Ok(of_it)) if of_it.holds() => of_it,
            (Change::Configuration | Change::Fuel, _) => doubted(Doubt::ChangedAircraft),
        };
        found = found.and(of_it);
    }
    // Where a flight comes to later is in doubt at most.
    if found.holds() {
        found.undecided =
            of_places(scenario, (aircraft, &standings), (controller, gains), |_| true)?;
    }
    if let Some(last) = standings.iter().rfind(|it| it.by != Change::Fuel) {
        for own in blown(scenario) {
            if found.holds() {
                found.undecided = of_air(&own, last, (aircraft, &standings), (controller, gains))?;
            }
        }
    }
    Ok(found)
}

/// The first doubt of the modes that come to another air, of the aircraft that there is last.
fn of_air(
    own: &Blown,
    last: &Standing,
    (aircraft, standings): (&AircraftPlant, &[Standing]),
    held: Held<'_>,
) -> Result<Option<Undecided>, SimError> {
    let mine = |mode: usize| own.modes.contains(&mode);
    let of_it = last.flown_in(&own.scenario).map(|it| of_modes(&it, last, held, mine));
    let GrowthAtRest { certain, undecided } = of_it.transpose()?.unwrap_or_default();
    let grown = certain.map(|it| Undecided::at_trim(own.seen_as.doubt(it.spectral_radius)));
    match grown.or(undecided) {
        None => of_places(&own.scenario, (aircraft, standings), held, mine),
        doubt => Ok(doubt),
    }
}

/// The first doubt of where these modes of a flight come to.
fn of_places(
    scenario: &Scenario,
    (aircraft, standings): (&AircraftPlant, &[Standing]),
    held: Held<'_>,
    asked: impl Fn(usize) -> bool,
) -> Result<Option<Undecided>, SimError> {
    let places = places(scenario, aircraft, standings, held);
    let places = places.iter().filter(|it| it.led.is_none_or(|led| asked(led.mode)));
    let mut doubts = places.map(|it| of_place(scenario, it, held));
    doubts.find_map(Result::transpose).transpose()
}

fn doubted(doubt: Doubt) -> GrowthAtRest {
    GrowthAtRest { certain: None, undecided: Some(Undecided::at_trim(doubt)) }
}

/// The same of one aircraft, which the scenario has.
fn of_standing(
    scenario: &Scenario,
    standing: &Standing,
    (controller, gains): Held<'_>,
) -> Result<GrowthAtRest, SimError> {
    let Some(plant) = scenario.plant.aircraft() else { return Ok(GrowthAtRest::default()) };
    let linear = plant.linear()?;
    let mut found = growth_of_plant(scenario, (standing.from_s, &linear), controller, gains)?;
    if scenario.autopilot.is_some() && found.certain.is_some() {
        // With a throttle that stays, pitch may run away by itself where the modes hold airspeed and path too. They are asked
        // below with the gains at rest, so that what more a rest has is asked of pitch alone.
        let rests = Rest::all(scenario, &linear, controller, gains);
        if rests.iter().all(|rest| rest.adds_nothing_to(gains)) {
            found.certain = None;
        }
    }
    // Differences about a kink are of no motion.
    if found.certain.is_some() || linear.is_between_slopes() {
        return Ok(found);
    }
    if !is_followed(scenario, plant)? {
        found.doubt(Undecided::at_trim(Doubt::FastMotion));
    }
    Ok(found.and(match &scenario.autopilot {
        None => alone(scenario, (controller, gains)),
        Some(_) => of_modes(scenario, standing, (controller, gains), |_| true)?,
    }))
}

/// True where the steps of the integration are short beside every motion of the airframe.
fn is_followed(scenario: &Scenario, plant: &AircraftPlant) -> Result<bool, SimError> {
    let full = plant.aircraft().linearise(plant.trim()).full().map_err(|_| SimError::NotLinear)?;
    let fastest_rad_s = eigenvalues(full.a())?.iter().map(|s| modulus(*s)).fold(0.0, f64::max);
    // Written so that NaN is not.
    Ok(fastest_rad_s * step_s(scenario.timing.dt_s()) <= FOLLOWED)
}

/// Written so that NaN grows.
fn grows(spectral_radius: f64) -> bool {
    !(spectral_radius <= MODE_RADIUS)
}

/// Small motions with nothing around the pitch loop, which is asked by itself.
fn alone(scenario: &Scenario, held: Held<'_>) -> GrowthAtRest {
    // Who leaves the trim within the few samples that are flown grows; what else cannot be asked is judged by its pitch alone.
    let radii = |seeing| match radii_alone(scenario, held, seeing) {
        Err(SimError::LeavesTrim { .. }) => {
            Some(Alone { pitching: f64::INFINITY, all: Some(f64::INFINITY) })
        }
        other => other.ok().flatten(),
    };
    let Some(latest) = radii(Seeing::first(scenario)) else { return GrowthAtRest::default() };
    if let Some(spectral_radius) = latest.all.filter(|radius| grows(*radius)) {
        return doubted(Doubt::Wings { spectral_radius });
    }
    let worst = |it: Alone| it.all.unwrap_or(it.pitching);
    if grows(worst(latest)) {
        return GrowthAtRest::default();
    }
    let others = Seeing::others(scenario).into_iter();
    let mut grown = others.filter_map(|seeing| Some((seeing, worst(radii(seeing)?))));
    let first = grown.find(|(_, radius)| grows(*radius));
    first.map_or(GrowthAtRest::default(), |(seeing, radius)| doubted(of_seeing(seeing, radius)))
}

/// What is in doubt where a flight comes to that goes on. In a mode everything is asked together: its pitch loop alone, with a
/// throttle that stays and a path that nobody holds, may run away slowly where the mode does not.
fn of_place(
    scenario: &Scenario,
    place: &Place,
    (controller, gains): Held<'_>,
) -> Result<Option<Undecided>, SimError> {
    let grown = |spectral_radius| match place.led {
        None => Doubt::HeldOn { spectral_radius },
        Some(led) => Doubt::Led { led, spectral_radius },
    };
    let Some(plant) = &place.plant else {
        return Ok(place.led.map(|led| Undecided::at_trim(Doubt::LedNowhere(led))));
    };
    let linear = plant.linear()?;
    // Differences about a kink are of no motion.
    if linear.is_between_slopes() {
        return Ok(Some(Undecided::at_trim(Doubt::Kink)));
    }
    let there = Plant::Aircraft(Box::new(plant.clone()));
    let mut own = Scenario { plant: there, ..scenario.clone() };
    if let (Some(led), Some(autopilot)) = (place.led, &mut own.autopilot) {
        *autopilot = autopilot.released(led.mode, place.at_limits);
    }
    let found = match place.led {
        None => growth_of_plant(&own, (0.0, &linear), controller, gains)?
            .and(alone(&own, (controller, gains))),
        // Who leaves the place within a few samples grows.
        Some(led) => of_mode(&own, led.mode, (controller, gains))
            .unwrap_or_else(|_| doubted(grown(f64::INFINITY)))
            .and(by_what_is_held(&own, &linear, (controller, gains))?),
    };
    let certain = found.certain.map(|it| Undecided::at_trim(grown(it.spectral_radius)));
    Ok(certain.or(found.undecided))
}

/// What grows of the pitch loop by what is held, where it does not with the gains at rest: what grows with these, slowly, the
/// mode may hold.
fn by_what_is_held(
    scenario: &Scenario,
    linear: &LinearPlant,
    (controller, gains): Held<'_>,
) -> Result<GrowthAtRest, SimError> {
    let rests = Rest::all(scenario, linear, controller, gains);
    let is_asked = rests.iter().any(|rest| !rest.adds_nothing_to(gains))
        && holds(scenario, linear, gains, controller.config());
    match is_asked {
        true => growth_of_plant(scenario, (0.0, linear), controller, gains),
        false => Ok(GrowthAtRest::default()),
    }
}

/// Why it is not decided where sensors that show motions otherwise change the answer.
fn of_seeing(seeing: Seeing, spectral_radius: f64) -> Doubt {
    match seeing {
        Seeing::Erecting => Doubt::Erection { spectral_radius },
        Seeing::Earliest | Seeing::Midway | Seeing::Latest | Seeing::AsTheyCome => {
            Doubt::ChangingAge
        }
    }
}

/// The first of these modes of the autopilot in which something grows.
fn of_modes(
    scenario: &Scenario,
    standing: &Standing,
    held: Held<'_>,
    asked: impl Fn(usize) -> bool,
) -> Result<GrowthAtRest, SimError> {
    let modes = standing.modes(scenario).into_iter().filter(|(number, _)| asked(*number));
    let last = scenario.autopilot.as_ref().map_or(0, |it| it.modes().len()).saturating_sub(1);
    let mut found = GrowthAtRest::default();
    for (number, begins_s) in modes {
        let of_mode = match of_mode(scenario, number, held) {
            Err(SimError::LongWay { .. }) => doubted(Doubt::LongMode),
            other => other?,
        };
        let from_s = begins_s.max(standing.from_s);
        // When a mode ends the flight tells: what both last is certain.
        let meets =
            !standing.is_after_a_change() || (number == last && standing.until_s == f64::INFINITY);
        found = found.and(match of_mode.certain {
            Some(it) if meets => {
                GrowthAtRest { certain: Some(Unstable { from_s, ..it }), ..of_mode }
            }
            Some(_) => doubted(Doubt::ChangedAircraft),
            None => of_mode,
        });
    }
    Ok(found)
}

/// One mode, with sensors as they may show its motions.
fn of_mode(scenario: &Scenario, mode: usize, held: Held<'_>) -> Result<GrowthAtRest, SimError> {
    let first = poles_of_mode(scenario, held, mode, Seeing::first(scenario))?;
    let spectral_radius = first.spectral_radius;
    if let Some(doubt) = first.doubt {
        return Ok(doubted(doubt));
    }
    let radius =
        |seeing| poles_of_mode(scenario, held, mode, seeing).map(|poles| poles.spectral_radius);
    for seeing in Seeing::others(scenario) {
        let doubt = of_seeing(seeing, spectral_radius);
        // A loop that grows with every age may hold while it changes: such a one was flown.
        if doubt == Doubt::ChangingAge && grows(spectral_radius) {
            return Ok(doubted(doubt));
        }
        let other = radius(seeing)?;
        if grows(other) && !grows(spectral_radius) {
            return Ok(doubted(of_seeing(seeing, other)));
        }
    }
    let doubling_s = doubling_s(spectral_radius, scenario.timing.dt_s());
    let (from_s, at, mode) = (0.0, RestPoint::TRIM, Some(mode));
    let certain = Unstable { spectral_radius, from_s, doubling_s, at, mode };
    Ok(GrowthAtRest { certain: grows(spectral_radius).then_some(certain), undecided: None })
}

#[cfg(test)]
mod tests;
