//! An aircraft over speeds and altitudes: where it can be flown, and what it is like there.

mod autopilot;
mod column;
mod csv;
mod figures;
mod judged;
mod point;
mod text;

use std::path::Path;

use fspid_aircraft::envelope::{EnvelopeGrid, Evenly, one_thread};
use fspid_aircraft::qualities::Category;
use serde_json::{Map, Value, json};

use super::condition::{AirChoice, Question};
use super::facts::key;
use super::parse::span;
use crate::analysis::Stability;
use crate::json::with_null_reasons;
use autopilot::Autopilot;
use column::{Column, columns};
use fspid_scenario::aircraft::AircraftFailure;
use fspid_scenario::aircraft::units::{Kind, LENGTHS, SPEEDS, Units};
use fspid_scenario::supervisor::Refused;
use point::{Point, loop_at, reason};

/// Why there is no radius, and no decay.
const NO_RADIUS: &str = "the loop is undecided, or too fast or too slow for a number, or the aircraft does not fly there";

/// Speeds and altitudes, and whose loop is judged there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnvelopeQuestion<'a> {
    /// The aircraft and its air; its speed and altitude are not read.
    pub question: Question<'a>,
    /// True airspeeds, as `first:last:count`.
    pub speeds: &'a str,
    /// Altitudes, as `first:last:count`.
    pub altitudes: &'a str,
    /// For which flying qualities are judged.
    pub category: Category,
    /// A scenario whose controller flies the aircraft.
    pub scenario: Option<&'a Path>,
    /// Which of its controllers, if there are several.
    pub controller: Option<&'a str>,
}

/// An aircraft over speeds and altitudes.
#[derive(Clone, Debug)]
pub struct Envelope {
    title: String,
    name: String,
    units: Units,
    air: AirChoice,
    category: Category,
    speeds_m_s: Vec<f64>,
    altitudes_m: Vec<f64>,
    /// One for each altitude and speed, the speeds running fastest.
    points: Vec<Point>,
    autopilot: Option<Autopilot>,
}

/// Trims and linearises an aircraft at every speed and altitude.
///
/// # Errors
/// [`AircraftFailure`]: as [`super::flight`]; ranges that cannot be used; a scenario that is wrong or has no such
/// controller. A point that cannot be flown is no error.
pub fn envelope(question: &EnvelopeQuestion<'_>) -> Result<Envelope, AircraftFailure> {
    let data = question.question.data()?;
    let aircraft = question.question.aircraft_of(&data)?;
    let units = question.question.units;
    let (speeds_m_s, altitudes_m) = grid(question, units)?;
    let autopilot =
        question.scenario.map(|path| Autopilot::load(path, question.controller)).transpose()?;
    let category = question.category;
    let grid = EnvelopeGrid {
        airspeeds_m_s: speeds_m_s.clone(),
        altitudes_m: altitudes_m.clone(),
        category,
        ..EnvelopeGrid::even(
            Evenly { first: 0.0, last: 0.0, count: 0 },
            Evenly { first: 0.0, last: 0.0, count: 0 },
        )
    };
    let threads = std::thread::available_parallelism().unwrap_or(one_thread());
    let points = aircraft.envelope(&grid, threads, |linear| {
        let target = linear.trim.target;
        let density_kg_m3 = aircraft.environment().air_at(target.altitude_m).density_kg_m3;
        let pressure_pa = 0.5 * density_kg_m3 * target.airspeed_m_s * target.airspeed_m_s;
        Some(autopilot.as_ref()?.judge(&aircraft, target, pressure_pa))
    });
    let (title, name) = (data.title, data.name);
    let air = question.question.air;
    Ok(Envelope { title, name, units, air, category, speeds_m_s, altitudes_m, points, autopilot })
}

fn grid(
    question: &EnvelopeQuestion<'_>,
    units: Units,
) -> Result<(Vec<f64>, Vec<f64>), AircraftFailure> {
    let mut problems = Vec::new();
    let mut read = |option, text, known: &[_], kind| {
        span(option, text, known, units.of(kind)).map_err(|problem| problems.push(problem)).ok()
    };
    let speeds = read("--speeds", question.speeds, &SPEEDS, Kind::Speed);
    let altitudes = read("--altitudes", question.altitudes, &LENGTHS, Kind::Length);
    if speeds.as_ref().is_some_and(|speeds| speeds.iter().any(|speed| !(*speed > 0.0))) {
        problems.push("--speeds must be above 0".to_owned());
    }
    match (speeds, altitudes) {
        (Some(speeds), Some(altitudes)) if problems.is_empty() => Ok((speeds, altitudes)),
        _ => Err(AircraftFailure::Refused(Refused::all(problems))),
    }
}

impl Envelope {
    /// What is told of every point.
    fn columns(&self) -> Vec<&'static Column> {
        columns(self.autopilot.is_some())
    }

    /// At how many of the points that can be flown the loop stands so.
    fn loops(&self, stability: Stability) -> usize {
        self.points.iter().filter_map(loop_at).filter(|it| it.stability == stability).count()
    }

    /// The same of each word that there is.
    fn loop_points(&self) -> Value {
        let all = [Stability::Stable, Stability::Unstable, Stability::Undecided];
        let counts = all.map(|it| (it.word().to_owned(), json!(self.loops(it))));
        Value::Object(counts.into_iter().collect())
    }

    /// The envelope for programs.
    #[must_use]
    pub fn json(&self) -> Value {
        let units = self.units;
        let list = |kind, values: &[f64]| -> Vec<f64> {
            values.iter().map(|value| units.told(kind, *value)).collect()
        };
        let mut whole = Map::new();
        let mut put = |key: &str, value: Value| whole.insert(key.to_owned(), value);
        put("aircraft", json!(self.name));
        put("units", json!(units.name()));
        put("category", json!(format!("{:?}", self.category)));
        put("controller", json!(self.autopilot.as_ref().map(Autopilot::name)));
        put("loop", json!(self.autopilot.as_ref().map(Autopilot::in_words)));
        put("loop_points", json!(self.autopilot.as_ref().map(|_| self.loop_points())));
        let speeds = list(Kind::Speed, &self.speeds_m_s);
        put(&key("airspeeds", Kind::Speed, units), json!(speeds));
        let altitudes = list(Kind::Length, &self.altitudes_m);
        put(&key("altitudes", Kind::Length, units), json!(altitudes));
        let points: Vec<Value> = self.points.iter().map(|point| self.point_json(point)).collect();
        put("points", Value::Array(points));
        let decay = key("loop_decay", Kind::Rate, units);
        let reasons = [
            ("controller", "no controller was asked for"),
            ("loop", "no controller was asked for"),
            ("loop_points", "no controller was asked for"),
            ("loop_stability", "the aircraft does not fly there"),
            (
                "loop_reason",
                "the loop is stable and has a margin, or the aircraft does not fly there",
            ),
            (
                "loop_gain_margin_db",
                "the loop is not known to be stable, as loop_reason says, or has no margin",
            ),
            (decay.as_str(), NO_RADIUS),
            ("loop_spectral_radius", NO_RADIUS),
            (
                "longitudinal_time_to_double_s",
                "no longitudinal motion runs away, or the aircraft does not fly there",
            ),
            ("reason", "nothing is amiss: the aircraft flies there"),
        ];
        with_null_reasons(Value::Object(whole), &reasons)
    }

    fn point_json(&self, point: &Point) -> Value {
        let units = self.units;
        let speed = (key("airspeed", Kind::Speed, units), point.target.airspeed_m_s, Kind::Speed);
        let altitude =
            (key("altitude", Kind::Length, units), point.target.altitude_m, Kind::Length);
        let mut entry = Map::new();
        for (key, value, kind) in [speed, altitude] {
            entry.insert(key, json!(units.told(kind, value)));
        }
        entry.insert("flyable".to_owned(), json!(point.flight.is_ok()));
        entry.insert("reason".to_owned(), json!(reason(point, units)));
        for column in self.columns() {
            let value = column.of(point).map(|value| units.told(column.kind, value));
            entry.insert(key(column.key, column.kind, units), json!(value));
        }
        if self.autopilot.is_some() {
            let found = loop_at(point);
            let stability = found.map(|it| it.stability.word());
            entry.insert("loop_stability".to_owned(), json!(stability));
            entry.insert("loop_reason".to_owned(), json!(found.and_then(|it| it.reason.clone())));
        }
        Value::Object(entry)
    }
}
