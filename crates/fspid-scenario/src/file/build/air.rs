//! Winds, gusts and turbulence around an aircraft.

use fspid_sim::air::{
    Follows, FullCycle, Intensity, LogShear, Microburst, RampHold, Severity, Steady, Turbulence,
    Wind,
};
use fspid_sim::{Plant, Weather};

use super::flight::{Flown, Way};
use super::{judged, rad};
use crate::file::aircraft::quantity;
use crate::file::files::Files;
use crate::file::section::Section;
use crate::file::spec::air::{GustKind, WindKind};
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
    let parts = ["wind", "turbulence"].map(|name| section.section(name));
    let parts = parts.into_iter().flatten().chain(section.sections("gust"));
    let silent = flown.plant.linear().is_some_and(|plant| !plant.feels_gusts());
    let Some(way) = flown.way.filter(|way| !silent && !way.assumed) else {
        parts.for_each(|part| refuse(report, part, (flown.way.is_some(), silent)));
        return None;
    };
    let calm = parts.count() == 0;
    let weather = Weather {
        course: way.course,
        winds: winds(section, way),
        turbulence: turbulence(report, files, (section.section("turbulence"), way)),
    };
    let linear = matches!(flown.plant, Plant::Linear(_));
    (!(calm && linear)).then_some(weather)
}

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

fn winds(section: &Section, way: Way) -> Vec<Wind> {
    let sound = |part: &&Section| part.sound;
    let wind = section.section("wind").filter(sound).and_then(wind);
    let gusts = section.sections("gust").iter().filter(sound);
    wind.into_iter().chain(gusts.filter_map(|part| gust(part, way))).collect()
}

fn wind(part: &Section) -> Option<Wind> {
    Some(match part.variant()? {
        WindKind::LogShear => Wind::LogShear(LogShear {
            w20_m_s: quantity(part, "w20")?,
            from_rad: rad(part.number("from_deg")?),
            roughness_m: part.number("roughness_m")?,
        }),
        WindKind::Microburst => Wind::Microburst(Microburst {
            outflow_m_s: part.number("outflow_m_s")?,
            radius_m: part.number("radius_m")?,
            peak_height_m: part.number("peak_height_m")?,
            axis_m: [part.number("north_m")?, part.number("east_m")?],
        }),
        WindKind::Steady => Wind::Steady(steady(part)?),
    })
}

/// The air moves away from where the wind comes from.
fn steady(part: &Section) -> Option<Steady> {
    let speed_m_s = quantity(part, "speed")?;
    let (east, north) = libm::sincos(rad(part.number("from_deg")?));
    let earth_m_s = [-speed_m_s * north, -speed_m_s * east, -part.number("up_m_s")?];
    Some(Steady { earth_m_s })
}

fn gust(part: &Section, way: Way) -> Option<Wind> {
    let amplitude_m_s =
        [part.number("forward_m_s")?, part.number("right_m_s")?, -part.number("up_m_s")?];
    let start_m = part.number("at_s")? * way.course.airspeed_m_s;
    Some(match part.variant()? {
        GustKind::FullCycle => {
            let gradient_m = part.number("gradient_m")?;
            Wind::FullCycle(FullCycle { amplitude_m_s, gradient_m, start_m })
        }
        GustKind::RampHold => {
            let length_m = part.number("length_m")?;
            Wind::RampHold(RampHold { amplitude_m_s, length_m, start_m })
        }
    })
}

fn turbulence(
    report: &mut Report,
    files: &mut Files<'_>,
    (part, way): (Option<&Section>, Way),
) -> Option<Turbulence> {
    let part = part.filter(|part| part.sound)?;
    let aloft: Severity = part.word("intensity")?;
    let intensity = match part.number("w20_m_s") {
        Some(w20_m_s) => Intensity::new(w20_m_s, aloft),
        None => Ok(aloft.into()),
    };
    Some(Turbulence {
        specification: part.word("model")?,
        intensity: judged(report, (part, "w20_m_s"), intensity)?,
        height_m: way.course.height_m,
        airspeed_m_s: way.course.airspeed_m_s,
        wing_span_m: span_m(report, part, way)?,
        seed: u64::try_from(part.integer("seed")?).ok()?,
        follows: follows(files, part, way),
    })
}

/// Whose height and airspeed: where the file does not say, those of a flight that does not stay at its height.
fn follows(files: &mut Files<'_>, part: &Section, way: Way) -> Follows {
    part.word("follows").unwrap_or_else(|| {
        let level = way.course.climb_rad == 0.0;
        let (follows, word) =
            if level { (Follows::Start, "start") } else { (Follows::Flight, "flight") };
        files.fill(part.path("follows"), word);
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
