//! Control laws in DAVE-ML, bound to the aircraft that they fly.

use std::path::Path;
use std::sync::Arc;

use fspid_aircraft::{AirMotion, ForceModel as _, Gearing, Range};
use fspid_daveml::flight::{Control, ControlLaw, FlightError, Heard};
use fspid_sim::control_law::{ControlLaw as Flies, LawAnswer, SharedLaw};
use fspid_sim::external::Asked;
use fspid_sim::{AircraftPlant, AircraftSample, ExternalSource, Seen, Timing};

use super::flown::Flown;
use crate::file::files::Files;
use crate::file::spec::controller as keys;
use crate::file::spec::controller::TrimmedControl;
use crate::file::tables;
use crate::keyed::Section;
use fspid_diagnostics::Report;

/// The control law of a sound section.
pub(super) fn law(
    report: &mut Report,
    files: &mut Files<'_>,
    section: &Section,
    (flown, timing, has_autopilot): (&Flown, Timing, bool),
) -> Option<ExternalSource> {
    if has_autopilot {
        let message =
            "a control law moves all controls by itself, and outer loops or modes would too";
        let allowed = "one of both: `control_law`, or `outer_loop`, `total_energy` and `mode`";
        section.wrong(report, keys::CONTROL_LAW, message, allowed);
        return None;
    }
    let Some(plant) = flown.plant.aircraft() else {
        let message = "a control law hears all that an aircraft shows, and this plant shows pitch";
        let allowed = "a nonlinear aircraft of fspid, as `[aircraft]`";
        section.wrong(report, keys::CONTROL_LAW, message, allowed);
        return None;
    };
    let model = tables::model(report, files, (section, keys::CONTROL_LAW), Path::new(""))?;
    let heading_rad = flown.way.map_or(0.0, |way| way.course.heading_rad);
    let at_rest = at_rest(plant, heading_rad);
    let inputs = section.sections(keys::LAW_INPUT);
    let laws = laws(report, section, inputs, (model, plant, &at_rest, timing))?;
    let path = section.get(keys::CONTROL_LAW)?.into();
    let law = FlownLaw {
        laws,
        heading_rad,
        trim_elevator_rad: plant.trim().point.elevator_rad,
        gearing: plant.aircraft().model().gearing(),
        throttle: plant.aircraft().model().travel().throttle,
    };
    Some(ExternalSource::Law(SharedLaw { path, law: Arc::new(law) }))
}

/// What the law hears at the trim.
fn at_rest(plant: &AircraftPlant, heading_rad: f64) -> Heard {
    let (trim, aircraft) = (plant.trim(), plant.aircraft());
    let instant = aircraft.instant(&trim.state, &trim.controls, &AirMotion::STILL);
    let attitude = trim.state.euler();
    Heard {
        airspeed_m_s: instant.flow.airspeed_m_s,
        equivalent_airspeed_m_s: instant.flow.equivalent_airspeed_m_s(),
        mach: instant.flow.mach(),
        altitude_m: trim.target.altitude_m,
        alpha_rad: instant.flow.alpha_rad,
        sideslip_rad: instant.flow.beta_rad,
        attitude_rad: [attitude.phi_rad, attitude.theta_rad, heading_rad],
        rates_rad_s: [0.0; 3],
        right_of_course_m: 0.0,
    }
}

/// The law from each sample on at which an input changes.
fn laws(
    report: &mut Report,
    section: &Section,
    inputs: &[Section],
    (model, plant, at_rest, timing): (fspid_daveml::Model, &AircraftPlant, &Heard, Timing),
) -> Option<Vec<(usize, ControlLaw)>> {
    let sample = |part: &Section| Some(timing.first_sample_at(part.get(keys::LAW_INPUT_AT_S)?));
    let mut begins: Vec<usize> = inputs.iter().map(sample).collect::<Option<_>>()?;
    begins.push(0);
    begins.sort_unstable();
    begins.dedup();
    let first = first_values(inputs)?;
    let mut law = match ControlLaw::new(model, &first) {
        Ok(law) => law,
        Err(error) => {
            let allowed = "a law with an elevator, and an `input` for what a flight does not show";
            section.wrong(report, keys::CONTROL_LAW, error.to_string(), allowed);
            return None;
        }
    };
    let mut all = Vec::new();
    for begin in begins {
        for part in inputs.iter().filter(|part| sample(part) == Some(begin)) {
            if let Err(error) = apply(&mut law, part, (plant, at_rest)) {
                let allowed = "inputs of the file, and a control that its input moves";
                part.wrong(report, keys::LAW_INPUT_NAME, error.to_string(), allowed);
                return None;
            }
        }
        all.push((begin, law.clone()));
    }
    Some(all)
}

/// What is set at the start, with 0 for what is to be found; an input that is set later only is not set here.
fn first_values(inputs: &[Section]) -> Option<Vec<(String, f64)>> {
    let at_start = |part: &&Section| part.get(keys::LAW_INPUT_AT_S).is_some_and(|at_s| at_s <= 0.0);
    let set = |part: &&Section| !part.given(keys::LAW_INPUT_ADDED);
    let value = |part: &Section| {
        let value = part.get(keys::LAW_INPUT_VALUE).unwrap_or(0.0);
        Some((part.get(keys::LAW_INPUT_NAME)?.to_owned(), value))
    };
    inputs.iter().filter(at_start).filter(set).map(value).collect()
}

fn apply(
    law: &mut ControlLaw,
    part: &Section,
    (plant, at_rest): (&AircraftPlant, &Heard),
) -> Result<(), FlightError> {
    let name = part.get(keys::LAW_INPUT_NAME).unwrap_or_default();
    if let Some(value) = part.get(keys::LAW_INPUT_VALUE) {
        return law.set(name, value);
    }
    if let Some(added) = part.get(keys::LAW_INPUT_ADDED) {
        return law.add(name, added);
    }
    let trim = plant.trim();
    let power = plant.aircraft().model().gearing().power(trim.controls.throttle);
    match part.get(keys::LAW_INPUT_TRIMS) {
        Some(TrimmedControl::Elevator) => {
            law.trim(name, at_rest, (Control::Elevator, trim.point.elevator_rad)).map(drop)
        }
        Some(TrimmedControl::Throttle) => {
            law.trim(name, at_rest, (Control::Power, power)).map(drop)
        }
        None => Ok(()),
    }
}

/// A law in flight.
#[derive(Debug)]
struct FlownLaw {
    /// Each with the sample from which it holds, ascending, the first from the start.
    laws: Vec<(usize, ControlLaw)>,
    /// Course of the first course line, which goes through the start.
    heading_rad: f64,
    trim_elevator_rad: f64,
    gearing: Gearing,
    throttle: Range,
}

impl FlownLaw {
    fn heard(&self, seen: &Seen, aircraft: &AircraftSample) -> Heard {
        let [measured_rad, rate_rad_s] = seen.measured;
        let [roll_rad_s, yaw_rad_s] = aircraft.roll_yaw_rad_s;
        let [north_m, east_m] = aircraft.position_m;
        let (sine, cosine) = libm::sincos(self.heading_rad);
        // The loop sees pitch as a change from the trim.
        let pitch_rad = aircraft.attitude_rad + (measured_rad - seen.theta_rad);
        Heard {
            airspeed_m_s: aircraft.airspeed_m_s,
            equivalent_airspeed_m_s: aircraft.equivalent_airspeed_m_s,
            mach: aircraft.mach,
            altitude_m: aircraft.altitude_m,
            alpha_rad: aircraft.alpha_rad,
            sideslip_rad: aircraft.sideslip_rad,
            attitude_rad: [aircraft.bank_rad, pitch_rad, aircraft.heading_rad],
            rates_rad_s: [roll_rad_s, rate_rad_s, yaw_rad_s],
            right_of_course_m: east_m * cosine - north_m * sine,
        }
    }

    /// The throttle of a power, as a fraction of its travel.
    fn throttle(&self, power: f64) -> f64 {
        let Range { min, max } = self.throttle;
        (self.gearing.throttle(power) - min) / (max - min)
    }
}

impl Flies for FlownLaw {
    fn answer(&self, seen: &Seen, aircraft: &AircraftSample) -> LawAnswer {
        let held = self.laws.iter().take_while(|(from, _)| *from <= seen.k).last();
        let wanted = held.map(|(_, law)| law.wanted(&self.heard(seen, aircraft)));
        let elevator_rad = wanted.map_or(f64::NAN, |wanted| wanted.elevator_rad);
        let lateral = wanted.and_then(|wanted| match (wanted.aileron_rad, wanted.rudder_rad) {
            (None, None) => None,
            (aileron, rudder) => Some([aileron.unwrap_or(0.0), rudder.unwrap_or(0.0)]),
        });
        LawAnswer {
            command_rad: self.trim_elevator_rad - elevator_rad,
            asked: Asked {
                throttle: wanted.and_then(|it| it.power).map(|power| self.throttle(power)),
                lateral_rad: lateral,
            },
        }
    }
}
