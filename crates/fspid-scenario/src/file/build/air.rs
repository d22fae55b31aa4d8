//! Winds, gusts and turbulence around an aircraft.

use std::sync::Arc;

use fspid_aircraft::Air;
use fspid_sim::air::{
    Follows, FullCycle, Intensity, LogShear, Microburst, RampHold, Severity, Steady, Turbulence,
    Wind, design_gust_m_s,
};
use fspid_sim::signal::Noise;
use fspid_sim::{Plant, Simulator, Weather};

use super::flown::{Flown, Way};
use super::wind_table::table;
use super::{judged, rad};
use crate::file::aircraft::quantity;
use crate::file::files::Files;
use crate::file::spec::air as keys;
use crate::file::spec::air::{GustKind, WindKind};
use crate::file::spec::scenario::{GUST, TURBULENCE, WIND};
use crate::keyed::Section;
use crate::keyed::word::Word as _;
use crate::units::FOOT_M;
use fspid_diagnostics::Report;

/// The air that the file lets move, `None` for calm air around a linear plant.
///
/// What gusts and turbulence are along the way depends on the airspeed, so that an assumed one flies in calm air alone.
/// A nonlinear aircraft always has a course, since its heading is one.
pub(super) fn weather(
    report: &mut Report,
    files: &mut Files<'_>,
    (section, flown): (&Section, &Flown),
) -> Option<Weather> {
    // An FMU has its own, and what the file lets move was refused.
    let external = flown.plant.external();
    if external.is_some_and(|plant| matches!(plant.simulator, Simulator::Fmu(_))) {
        return None;
    }
    let parts = [WIND, TURBULENCE].map(|key| section.get(key));
    let parts = parts.into_iter().flatten().chain(section.sections(GUST));
    let silent = flown.plant.linear().is_some_and(|plant| !plant.feels_gusts());
    let Some(way) = flown.way.filter(|way| !silent && !way.assumed) else {
        parts.for_each(|part| refuse(report, part, (flown.way.is_some(), silent)));
        return None;
    };
    let calm = parts.count() == 0;
    let weather = Weather {
        course: way.course,
        winds: winds(report, files, (section, way)),
        turbulence: turbulence(report, files, (section.get(TURBULENCE), way)),
    };
    let is_steady = weather.winds.iter().all(|wind| matches!(wind, Wind::Steady(_)));
    if external.is_some() && !(is_steady && weather.turbulence.is_none()) {
        report.warn(WITHOUT_RATES.to_owned());
    }
    let has_course = matches!(flown.plant, Plant::Aircraft(_));
    (!calm || has_course).then_some(weather)
}

/// What of our air JSBSim does not take.
const WITHOUT_RATES: &str = "JSBSim takes velocities of the air alone: the rates p, q and r of gusts and turbulence, which aircraft of our own feel, are left out of this flight";

/// Of a plant, or of an aircraft whose file has too little on it.
fn refuse(report: &mut Report, part: &Section, (is_aircraft, silent): (bool, bool)) {
    const ENOUGH: &str = "still air, or an aircraft file with a condition, equations of u and of w or alpha, and by_pitch_gust in them";
    let (message, allowed) = match (is_aircraft, silent) {
        (false, _) => (
            "a plant does not say how moving air acts on it",
            "an `aircraft` in place of the plant",
        ),
        (true, true) => {
            ("the linear model of the aircraft does not say how moving air acts on it", ENOUGH)
        }
        (true, false) => (
            "the aircraft's file has no condition, so that its speed through moving air would be an assumption",
            ENOUGH,
        ),
    };
    report.value(part.place, &part.path, message, allowed);
}

fn winds(report: &mut Report, files: &mut Files<'_>, (section, way): (&Section, Way)) -> Vec<Wind> {
    let sound = |part: &&Section| part.sound;
    let wind = section.get(WIND).filter(sound).and_then(|part| wind(report, files, part));
    let gusts = section.sections(GUST).iter().filter(sound);
    wind.into_iter().chain(gusts.filter_map(|part| gust(report, part, way))).collect()
}

fn wind(report: &mut Report, files: &mut Files<'_>, part: &Section) -> Option<Wind> {
    Some(match part.variant()? {
        WindKind::LogShear => Wind::LogShear(LogShear {
            w20_m_s: quantity(part, keys::W20)?,
            from_rad: rad(part.get(keys::FROM)?),
            roughness_m: part.get(keys::ROUGHNESS_M)?,
        }),
        WindKind::Microburst => Wind::Microburst(Microburst {
            outflow_m_s: part.get(keys::OUTFLOW_M_S)?,
            radius_m: part.get(keys::RADIUS_M)?,
            peak_height_m: part.get(keys::PEAK_HEIGHT_M)?,
            axis_m: [part.get(keys::NORTH_M)?, part.get(keys::EAST_M)?],
        }),
        WindKind::Steady => Wind::Steady(steady(part)?),
        WindKind::Table => Wind::Table(Arc::new(table(report, files, part)?)),
    })
}

/// The air moves away from where the wind comes from.
fn steady(part: &Section) -> Option<Steady> {
    let speed_m_s = quantity(part, keys::SPEED)?;
    let (east, north) = libm::sincos(rad(part.get(keys::FROM)?));
    let earth_m_s = [-speed_m_s * north, -speed_m_s * east, -part.get(keys::UP_M_S)?];
    Some(Steady { earth_m_s })
}

fn gust(report: &mut Report, part: &Section, way: Way) -> Option<Wind> {
    let start_m = part.get(keys::AT_S)? * way.course.airspeed_m_s;
    if part.variant() == Some(GustKind::Design) {
        return design_gust(report, part, way, start_m).map(Wind::FullCycle);
    }
    let amplitude_m_s =
        [part.get(keys::FORWARD_M_S)?, part.get(keys::RIGHT_M_S)?, -part.get(keys::GUST_UP_M_S)?];
    Some(match part.variant()? {
        GustKind::FullCycle => {
            let gradient_m = part.get(keys::GRADIENT_M)?;
            Wind::FullCycle(FullCycle { amplitude_m_s, gradient_m, start_m })
        }
        GustKind::RampHold => {
            let length_m = part.get(keys::LENGTH_M)?;
            Wind::RampHold(RampHold { amplitude_m_s, length_m, start_m })
        }
        GustKind::Design => return None,
    })
}

/// Shortest and longest gradient distance of CS 25.341(a)(2).
const GRADIENTS_M: [f64; 2] = [30.0 * FOOT_M, 350.0 * FOOT_M];

/// One of the vertical gusts of a sweep: odd cases upward, even ones downward, distances in rising order.
fn design_gust(report: &mut Report, part: &Section, way: Way, start_m: f64) -> Option<FullCycle> {
    let (case, gradients) = (part.get(keys::CASE)?, part.get(keys::GRADIENTS)?);
    if case > 2 * gradients {
        let message = format!("{gradients} gradient distances up and down are fewer cases");
        part.wrong(report, keys::CASE, message, format!("1 to {}", 2 * gradients));
        return None;
    }
    let [shortest_m, longest_m] = GRADIENTS_M;
    let share = ((case - 1) / 2) as f64 / (gradients - 1) as f64;
    let gradient_m = shortest_m + share * (longest_m - shortest_m);
    let gust = design_gust_m_s(way.altitude_m, gradient_m, part.get(keys::ALLEVIATION)?);
    let equivalent_m_s = judged(report, (part, keys::CASE), gust)?;
    let airspeed_m_s = way.course.airspeed_m_s;
    let density_kg_m3 = 2.0 * way.dynamic_pressure_pa / (airspeed_m_s * airspeed_m_s);
    let sea_level_kg_m3 = Air::standard(0.0).ok()?.density_kg_m3;
    let true_m_s = equivalent_m_s * (sea_level_kg_m3 / density_kg_m3).sqrt();
    let down_m_s = if case % 2 == 1 { -true_m_s } else { true_m_s };
    Some(FullCycle { amplitude_m_s: [0.0, 0.0, down_m_s], gradient_m, start_m })
}

fn turbulence(
    report: &mut Report,
    files: &mut Files<'_>,
    (part, way): (Option<&Section>, Way),
) -> Option<Turbulence> {
    let part = part.filter(|part| part.sound)?;
    let aloft: Severity = part.get(keys::INTENSITY)?;
    let intensity = match part.get(keys::TURBULENCE_W20_M_S) {
        Some(w20_m_s) => Intensity::new(w20_m_s, aloft),
        None => Ok(aloft.into()),
    };
    Some(Turbulence {
        specification: part.get(keys::MODEL)?,
        intensity: judged(report, (part, keys::TURBULENCE_W20_M_S), intensity)?,
        height_m: way.course.height_m,
        airspeed_m_s: way.course.airspeed_m_s,
        wing_span_m: span_m(report, part, way)?,
        noise: noise(report, part)?,
        follows: follows(files, part, way),
        driven_until_s: f64::INFINITY,
    })
}

/// The mixture if there is one; the seed has no part then.
fn noise(report: &mut Report, part: &Section) -> Option<Noise> {
    match part.get(keys::MIXTURE) {
        Some(text) => judged(report, (part, keys::MIXTURE), text.parse::<Noise>()),
        None => Some(u64::try_from(part.get(keys::SEED)?).ok()?.into()),
    }
}

/// Whose height and airspeed: where the file does not say, those of a flight that does not stay at its height.
fn follows(files: &mut Files<'_>, part: &Section, way: Way) -> Follows {
    part.get(keys::FOLLOWS).unwrap_or_else(|| {
        let level = way.course.climb_rad == 0.0;
        let follows = if level { Follows::Start } else { Follows::Flight };
        files.fill(part.path(keys::FOLLOWS), follows.word());
        follows
    })
}

fn span_m(report: &mut Report, part: &Section, way: Way) -> Option<f64> {
    if way.span_m.is_none() {
        let message = "the aircraft's file has no span, on which turbulence depends";
        report.value(part.place, &part.path, message, "an aircraft file with a span");
    }
    way.span_m
}
