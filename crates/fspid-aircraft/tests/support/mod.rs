//! The shipped aircraft, for tests: a reader without messages for mistakes in a file.

#![allow(dead_code, reason = "no test uses everything")]

use fspid_aircraft::aerodynamics::derivatives::{
    Geometry, Lateral, LateralCoefficient, Longitudinal, LongitudinalCoefficient,
};
use fspid_aircraft::data::{
    AircraftData, DerivativeData, Inertia, LinearData, LinearElevator, LinearState, Loading,
    ModelData, Reference, Variations,
};
use fspid_aircraft::{AircraftMode, ModeName, Range, Travel, Validity};
use fspid_lti::Matrix;
use toml::{Table, Value};

pub(crate) const FOOT_M: f64 = 0.3048;
pub(crate) const POUND_FORCE_N: f64 = 4.448_221_615_260_5;
pub(crate) const SLUG_KG: f64 = POUND_FORCE_N / FOOT_M;
pub(crate) const DEG_RAD: f64 = core::f64::consts::PI / 180.0;

/// Unit at the end of a key, and its size in SI.
const UNITS: [(&str, f64); 18] = [
    ("slug_ft2", SLUG_KG * FOOT_M * FOOT_M),
    ("slug_ft3", SLUG_KG / (FOOT_M * FOOT_M * FOOT_M)),
    ("ft_s2", FOOT_M),
    ("ft_s", FOOT_M),
    ("ft2", FOOT_M * FOOT_M),
    ("ft", FOOT_M),
    ("lbf", POUND_FORCE_N),
    ("psf", POUND_FORCE_N / (FOOT_M * FOOT_M)),
    ("deg", DEG_RAD),
    ("rad", 1.0),
    ("kg_m2", 1.0),
    ("kg_m3", 1.0),
    ("m_s2", 1.0),
    ("m_s", 1.0),
    ("m2", 1.0),
    ("m", 1.0),
    ("n", 1.0),
    ("pa", 1.0),
];

macro_rules! files {
    ($($name:literal),* $(,)?) => {
        [$(($name, include_str!(concat!("../../../../data/aircraft/", $name, ".toml")))),*]
    };
}

const FILES: [(&str, &str); 23] = files![
    "navion",
    "b747-approach",
    "b747-cruise-low",
    "b747-cruise-high",
    "cessna-172",
    "etkin-747",
    "ctms-transport",
    "cessna-310",
    "beech-99",
    "beaver",
    "twin-otter",
    "dc-8-approach",
    "dc-8-cruise",
    "jetstar",
    "learjet-24",
    "citation-500",
    "convair-880",
    "aerosonde",
    "zagi",
    "skywalker-x8",
    "ultra-stick-25e",
    "anaconda",
    "mini-mutt",
];

/// Aircraft with stability derivatives: those whose file is of no other kind.
pub(crate) fn with_derivatives() -> impl Iterator<Item = &'static str> {
    let kinds = FILES.iter().map(|(name, text)| (*name, text.contains("kind = \"derivatives\"")));
    kinds.filter_map(|(name, is_one)| is_one.then_some(name))
}

pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    FILES.iter().map(|(name, _)| *name)
}

pub(crate) fn aircraft(name: &str) -> AircraftData {
    let (_, text) = FILES.iter().find(|(known, _)| *known == name).expect("a shipped aircraft");
    let file: Table = text.parse().expect("a shipped file is TOML");
    let model = match string(&file, "kind").as_str() {
        "linear" => ModelData::Linear(linear(&file)),
        _ => ModelData::Derivatives(Box::new(derivatives(&file))),
    };
    let [name, title, source, notes] =
        ["name", "title", "source", "notes"].map(|key| string(&file, key));
    AircraftData { name, title, source, notes, model, variations: Variations::default() }
}

pub(crate) fn derivative_data(name: &str) -> DerivativeData {
    *aircraft(name).derivatives().expect("an aircraft with derivatives")
}

/// Frequency, rad/s, and damping ratio of the short period and of the phugoid, which come first.
pub(crate) fn short_period_and_phugoid(modes: &[AircraftMode]) -> [f64; 4] {
    assert_eq!([modes[0].name, modes[1].name], [ModeName::ShortPeriod, ModeName::Phugoid]);
    let [short, long] = [0, 1].map(|index: usize| modes[index].mode().expect("a mode"));
    [
        short.natural_frequency_rad_s,
        short.damping_ratio,
        long.natural_frequency_rad_s,
        long.damping_ratio,
    ]
}

fn derivatives(file: &Table) -> DerivativeData {
    let [reference, geometry, mass, travel, validity] =
        ["reference", "geometry", "mass", "travel", "validity"].map(|key| table(file, key));
    DerivativeData {
        reference: Reference {
            airspeed_m_s: number(reference, "airspeed"),
            altitude_m: number(reference, "altitude"),
            density_kg_m3: number(reference, "density"),
            dynamic_pressure_pa: if reference.keys().any(|key| key.starts_with("dynamic_pressure"))
            {
                number(reference, "dynamic_pressure")
            } else {
                let airspeed = number(reference, "airspeed");
                0.5 * number(reference, "density") * airspeed * airspeed
            },
            mach: number(reference, "mach"),
            gravity_m_s2: number(reference, "gravity"),
            alpha_rad: number(reference, "alpha"),
            cg_mac: reference.get("cg_mac").and_then(Value::as_float),
        },
        geometry: Geometry {
            area_m2: number(geometry, "area"),
            span_m: number(geometry, "span"),
            chord_m: number(geometry, "chord"),
        },
        weight_n: number(mass, "weight"),
        inertia: Inertia {
            ix_kg_m2: number(mass, "ix"),
            iy_kg_m2: number(mass, "iy"),
            iz_kg_m2: number(mass, "iz"),
            ixz_kg_m2: number(mass, "ixz"),
        },
        loading: Loading::default(),
        longitudinal: longitudinal(table(file, "longitudinal")),
        lateral: file.get("lateral").and_then(Value::as_table).map(lateral),
        validity: Validity {
            airspeed_m_s: range(validity, "airspeed"),
            mach: range(validity, "mach"),
            alpha_rad: range(validity, "alpha"),
            beta_rad: range(validity, "beta"),
            altitude_m: range(validity, "altitude"),
        },
        travel: Travel {
            elevator_rad: range(travel, "elevator"),
            aileron_rad: range(travel, "aileron"),
            rudder_rad: range(travel, "rudder"),
            throttle: range(travel, "throttle"),
        },
    }
}

fn longitudinal(section: &Table) -> Longitudinal {
    let coefficient = |key: &str| {
        let row = table(section, key);
        LongitudinalCoefficient {
            reference: plain(row, "reference"),
            alpha: plain(row, "alpha"),
            alpha_rate: plain(row, "alpha_rate"),
            pitch_rate: plain(row, "pitch_rate"),
            speed: plain(row, "speed"),
            elevator: plain(row, "elevator"),
        }
    };
    let [lift, drag, pitch] = ["lift", "drag", "pitch"].map(coefficient);
    Longitudinal { lift, drag, pitch, thrust_speed: plain(section, "thrust_speed") }
}

fn lateral(section: &Table) -> Lateral {
    let coefficient = |key: &str| {
        let row = table(section, key);
        LateralCoefficient {
            beta: plain(row, "beta"),
            roll_rate: plain(row, "roll_rate"),
            yaw_rate: plain(row, "yaw_rate"),
            aileron: plain(row, "aileron"),
            rudder: plain(row, "rudder"),
        }
    };
    let [side, roll, yaw] = ["side", "roll", "yaw"].map(coefficient);
    Lateral { side, roll, yaw }
}

/// Feet become metres in the states and in their rates; angles stay.
fn linear(file: &Table) -> LinearData {
    let equations: Vec<&Table> =
        array(file, "equations").iter().map(|row| row.as_table().expect("an equation")).collect();
    let names: Vec<String> = equations.iter().map(|row| string(row, "state")).collect();
    let scale = |name: &String| if name.ends_with("_ft_s") { FOOT_M } else { 1.0 };
    let scales: Vec<f64> = names.iter().map(scale).collect();
    let rows = equations.iter().zip(&scales);
    let a = rows.clone().map(|(row, rate)| {
        let values = array(row, "by_states").iter().zip(&scales);
        values.map(|(value, state)| float(value) * rate / state).collect::<Vec<_>>()
    });
    let b = rows.map(|(row, rate)| [plain(row, "by_elevator") * rate]);
    LinearData {
        states: names.iter().map(|name| state(name)).collect(),
        a: Matrix::from_rows(&a.collect::<Vec<_>>()).expect("a matrix"),
        b: Matrix::from_rows(&b.collect::<Vec<_>>()).expect("a column"),
        elevator: match string(file, "elevator_sign").as_str() {
            "nose-up-positive" => LinearElevator::NoseUpPositive,
            _ => LinearElevator::NoseDownPositive,
        },
        by_pitch_gust: None,
        condition: None,
        span_m: None,
    }
}

fn state(name: &str) -> LinearState {
    match name {
        "u_ft_s" => LinearState::ForwardVelocity,
        "w_ft_s" => LinearState::DownwardVelocity,
        "alpha_rad" => LinearState::Alpha,
        "q_rad_s" => LinearState::PitchRate,
        "theta_rad" => LinearState::Theta,
        other => panic!("{other} is not a longitudinal state"),
    }
}

fn table<'a>(parent: &'a Table, key: &str) -> &'a Table {
    parent.get(key).and_then(Value::as_table).unwrap_or_else(|| panic!("no section {key}"))
}

fn array<'a>(parent: &'a Table, key: &str) -> &'a Vec<Value> {
    parent.get(key).and_then(Value::as_array).unwrap_or_else(|| panic!("no list {key}"))
}

fn string(parent: &Table, key: &str) -> String {
    parent.get(key).and_then(Value::as_str).unwrap_or_else(|| panic!("no text {key}")).into()
}

fn float(value: &Value) -> f64 {
    value.as_float().expect("a number")
}

/// A number without unit, 0 if it is not there.
fn plain(section: &Table, key: &str) -> f64 {
    section.get(key).map_or(0.0, float)
}

/// The value of a key that begins with a name and ends with a unit, and the unit's size.
fn entry<'a>(section: &'a Table, name: &str) -> (&'a Value, f64) {
    let with_unit = section.iter().find_map(|(key, value)| {
        let unit = key.strip_prefix(name)?.strip_prefix('_').unwrap_or("");
        let (_, size) = UNITS.iter().find(|(known, _)| *known == unit)?;
        Some((value, *size))
    });
    with_unit.or(section.get(name).map(|value| (value, 1.0))).unwrap_or_else(|| panic!("no {name}"))
}

fn number(section: &Table, name: &str) -> f64 {
    let (value, unit) = entry(section, name);
    float(value) * unit
}

fn range(section: &Table, name: &str) -> Range {
    let (value, unit) = entry(section, name);
    let ends: Vec<f64> = value.as_array().expect("two ends").iter().map(float).collect();
    Range::new("range of a file", ends[0] * unit, ends[1] * unit).expect("ends in order")
}
