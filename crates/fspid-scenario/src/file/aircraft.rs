//! Aircraft that the program carries, and files of the same form: from the units of a source to SI.

mod linear;

use std::path::Path;

use fspid_aircraft::aerodynamics::derivatives::{
    Geometry, Lateral, LateralCoefficient, Longitudinal, LongitudinalCoefficient,
};
use fspid_aircraft::data::{AircraftData, DerivativeData, Inertia, Loading, ModelData, Reference};
use fspid_aircraft::{Range, Travel, Validity};
use fspid_data::AIRCRAFT;

use crate::file::check;
use crate::file::document::{self, Item};
use crate::file::files::Files;
use crate::file::section::Section;
use crate::file::spec::{AIRCRAFT_FILE, AircraftKind};
use crate::file::tables::tables;
use crate::units::{FOOT_M, KNOT_M_S, POUND_FORCE_N, SLUG_KG, radians};
use fspid_diagnostics::{Problems, Report};

/// Units that a key may end with, and their size in SI; degrees stand apart.
const UNITS: [(&str, f64); 19] = [
    ("kt", KNOT_M_S),
    ("ft_s", FOOT_M),
    ("m_s", 1.0),
    ("ft_s2", FOOT_M),
    ("m_s2", 1.0),
    ("ft", FOOT_M),
    ("m", 1.0),
    ("ft2", FOOT_M * FOOT_M),
    ("m2", 1.0),
    ("lbf", POUND_FORCE_N),
    ("n", 1.0),
    ("psf", POUND_FORCE_N / (FOOT_M * FOOT_M)),
    ("pa", 1.0),
    ("slug_ft2", SLUG_KG * FOOT_M * FOOT_M),
    ("slug_ft2_s", SLUG_KG * FOOT_M * FOOT_M),
    ("slug_ft3", SLUG_KG / (FOOT_M * FOOT_M * FOOT_M)),
    ("kg_m2", 1.0),
    ("kg_m2_s", 1.0),
    ("kg_m3", 1.0),
];

/// Names of the aircraft that the program carries.
#[must_use]
pub fn aircraft_names() -> Vec<&'static str> {
    AIRCRAFT.iter().map(|(name, _)| *name).collect()
}

/// The text of an aircraft by its name.
pub(super) fn aircraft_text(name: &str) -> Option<&'static str> {
    let known = AIRCRAFT.iter().find(|(known, _)| *known == name);
    known.map(|(_, text)| *text)
}

/// The aircraft of that name, `None` if the program carries none.
#[must_use]
pub fn aircraft(name: &str) -> Option<AircraftData> {
    // The tests read every aircraft that is carried.
    parse_aircraft(aircraft_text(name)?, name, None).ok()
}

/// Reads an aircraft file from a text called `name` in messages. Files of tables are relative to `folder`; without one
/// there can be none.
///
/// # Errors
/// Everything that is wrong with it.
pub fn parse_aircraft(
    text: &str,
    name: &str,
    folder: Option<&Path>,
) -> Result<AircraftData, Problems> {
    parse_aircraft_at(text, name, (folder, None))
}

/// As [`parse_aircraft`], an aircraft of tables with its centre of gravity at a share of its chord.
pub fn parse_aircraft_at(
    text: &str,
    name: &str,
    (folder, cg_mac): (Option<&Path>, Option<f64>),
) -> Result<AircraftData, Problems> {
    let mut report = Report::default();
    let mut files = Files::new(folder);
    let given = Given { cg_mac, ..Given::default() };
    let file = document::read(&mut report, None, text)
        .and_then(|item| check::table(&mut report, &AIRCRAFT_FILE, &item, ""))
        .filter(|section| section.sound)
        .and_then(|section| {
            aircraft_data(&mut report, &mut files, (&section, Path::new("")), given)
        });
    report.finish(name)?;
    file.ok_or_else(|| Problems::new(name, Vec::new(), 0))
}

/// What a scenario knows of an aircraft before its file is read.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Given {
    /// Weight of the reference as the file has it, where a change of the scenario makes another of it.
    pub(super) weight_n: Option<f64>,
    /// Centre of gravity for an aircraft of tables, whose body depends on it.
    pub(super) cg_mac: Option<f64>,
}

impl Given {
    /// The weight that a file has, before it is changed.
    pub(super) fn of(written: Option<&Item>, cg_mac: Option<f64>) -> Self {
        let mass = written.and_then(|file| file.member("mass"));
        let weight = |(key, size): (&str, f64)| Some(size * mass?.member(key)?.number()?);
        let weight_n =
            [("weight_lbf", POUND_FORCE_N), ("weight_n", 1.0)].into_iter().find_map(weight);
        Self { weight_n, cg_mac }
    }
}

/// The aircraft of a checked file, whose tables are relative to `place` in the folder of `files`.
pub(super) fn aircraft_data(
    report: &mut Report,
    files: &mut Files<'_>,
    (section, place): (&Section, &Path),
    given: Given,
) -> Option<AircraftData> {
    let text = |name: &str| section.text(name).unwrap_or_default().to_owned();
    let model = match section.variant()? {
        AircraftKind::Linear => ModelData::Linear(linear::model(report, section)?),
        AircraftKind::Tables => {
            ModelData::Forces(Box::new(tables(report, files, (section, place), given.cg_mac)?))
        }
        AircraftKind::Derivatives => {
            ModelData::Derivatives(Box::new(derivatives(report, section, given)?))
        }
    };
    Some(AircraftData {
        name: text("name"),
        title: text("title"),
        source: text("source"),
        notes: text("notes"),
        model,
    })
}

fn derivatives(report: &mut Report, section: &Section, given: Given) -> Option<DerivativeData> {
    let part = |name: &str| section.section(name);
    let reference = reference(part("reference")?)?;
    let flown_n = quantity(part("mass")?, "weight")?;
    let weight_n = given.weight_n.unwrap_or(flown_n);
    // A scenario that changes the weight loads the aircraft; its wing carries what the file says.
    let mass_kg = flown_n.total_cmp(&weight_n).is_ne().then_some(flown_n / reference.gravity_m_s2);
    let data = DerivativeData {
        reference,
        geometry: geometry(part("geometry")?)?,
        weight_n,
        inertia: inertia(part("mass")?)?,
        loading: Loading { mass_kg, ..Loading::default() },
        longitudinal: longitudinal(part("longitudinal")?)?,
        lateral: part("lateral").and_then(lateral),
        validity: validity(part("validity")?)?,
        travel: travel(part("travel")?)?,
    };
    match data.mass_properties().validate() {
        Ok(()) => Some(data),
        Err(error) => {
            let allowed = "moments of inertia that a body can have".to_owned();
            report.value(section.at("mass"), &section.path("mass"), error.to_string(), allowed);
            None
        }
    }
}

fn reference(section: &Section) -> Option<Reference> {
    let airspeed_m_s = quantity(section, "airspeed")?;
    let density_kg_m3 = section.number("density_kg_m3").or_else(|| quantity(section, "density"))?;
    let own_pa = 0.5 * density_kg_m3 * airspeed_m_s * airspeed_m_s;
    Some(Reference {
        airspeed_m_s,
        altitude_m: quantity(section, "altitude")?,
        density_kg_m3,
        dynamic_pressure_pa: quantity(section, "dynamic_pressure").unwrap_or(own_pa),
        mach: section.number("mach")?,
        gravity_m_s2: quantity(section, "gravity")?,
        alpha_rad: radians(section.number("alpha_deg")?),
        cg_mac: section.number("cg_mac"),
    })
}

fn geometry(section: &Section) -> Option<Geometry> {
    Some(Geometry {
        area_m2: quantity(section, "area")?,
        span_m: quantity(section, "span")?,
        chord_m: quantity(section, "chord")?,
    })
}

fn inertia(section: &Section) -> Option<Inertia> {
    Some(Inertia {
        ix_kg_m2: quantity(section, "ix")?,
        iy_kg_m2: quantity(section, "iy")?,
        iz_kg_m2: quantity(section, "iz")?,
        ixz_kg_m2: quantity(section, "ixz")?,
    })
}

fn longitudinal(section: &Section) -> Option<Longitudinal> {
    let row = |name: &str| section.section(name).map(longitudinal_row);
    Some(Longitudinal {
        lift: row("lift")?,
        drag: row("drag")?,
        pitch: row("pitch")?,
        thrust_speed: plain(section, "thrust_speed"),
    })
}

fn longitudinal_row(row: &Section) -> LongitudinalCoefficient {
    LongitudinalCoefficient {
        reference: plain(row, "reference"),
        alpha: plain(row, "alpha"),
        alpha_rate: plain(row, "alpha_rate"),
        pitch_rate: plain(row, "pitch_rate"),
        speed: plain(row, "speed"),
        elevator: plain(row, "elevator"),
    }
}

fn lateral(section: &Section) -> Option<Lateral> {
    let row = |name: &str| section.section(name).map(lateral_row);
    Some(Lateral { side: row("side")?, roll: row("roll")?, yaw: row("yaw")? })
}

fn lateral_row(row: &Section) -> LateralCoefficient {
    LateralCoefficient {
        beta: plain(row, "beta"),
        roll_rate: plain(row, "roll_rate"),
        yaw_rate: plain(row, "yaw_rate"),
        aileron: plain(row, "aileron"),
        rudder: plain(row, "rudder"),
    }
}

fn validity(section: &Section) -> Option<Validity> {
    Some(Validity {
        airspeed_m_s: range(section, "airspeed")?,
        mach: range(section, "mach")?,
        alpha_rad: range(section, "alpha")?,
        beta_rad: range(section, "beta")?,
        altitude_m: range(section, "altitude")?,
    })
}

fn travel(section: &Section) -> Option<Travel> {
    Some(Travel { throttle: range(section, "throttle")?, ..surfaces(section)? })
}

/// Travel of the surfaces, with a throttle from 0 to 1.
pub(super) fn surfaces(section: &Section) -> Option<Travel> {
    Some(Travel {
        elevator_rad: range(section, "elevator")?,
        aileron_rad: range(section, "aileron")?,
        rudder_rad: range(section, "rudder")?,
        throttle: Range { min: 0.0, max: 1.0 },
    })
}

/// A coefficient, 0 if it is left out.
fn plain(section: &Section, name: &str) -> f64 {
    section.number(name).unwrap_or(0.0)
}

/// The value in SI of the key that begins with a name and ends with a unit.
pub(super) fn quantity(section: &Section, name: &str) -> Option<f64> {
    let given =
        |(unit, size): &(&str, f64)| Some(size * section.number(&format!("{name}_{unit}"))?);
    UNITS.iter().find_map(given)
}

/// As [`quantity`], for two ends; degrees become radians, and a key may have no unit.
fn range(section: &Section, name: &str) -> Option<Range> {
    if let Some((min, max)) = section.interval(&format!("{name}_deg")) {
        return Some(Range { min: radians(min), max: radians(max) });
    }
    let given = |(unit, size): &(&str, f64)| {
        section.interval(&format!("{name}_{unit}")).map(|ends| (ends, *size))
    };
    let plain = || section.interval(name).map(|ends| (ends, 1.0));
    let ((min, max), size) = UNITS.iter().find_map(given).or_else(plain)?;
    Some(Range { min: size * min, max: size * max })
}

#[cfg(test)]
mod tests {
    use super::*;
    use fspid_aircraft::data::Laws;
    use fspid_aircraft::{AircraftError, Environment};

    fn text(name: &str) -> &'static str {
        AIRCRAFT.iter().find(|(known, _)| *known == name).expect("carried").1
    }

    #[test]
    fn every_aircraft_that_is_carried_reads_under_its_own_name() {
        for (name, text) in AIRCRAFT {
            let data = parse_aircraft(text, name, None).expect("a shipped file is right");
            assert_eq!(data.name, name);
            assert!(!data.source.is_empty());
        }
        assert_eq!(aircraft("concorde"), None);
    }

    #[test]
    fn feet_and_pounds_become_si() {
        let data = aircraft("navion").expect("carried");
        let navion = data.derivatives().expect("derivatives");
        assert!((navion.reference.airspeed_m_s - 53.6448).abs() < 1e-12);
        assert!((navion.weight_n - 12_232.609_442).abs() < 1e-6);
        assert!((navion.inertia.iy_kg_m2 - 4_067.453_845).abs() < 1e-6);
        assert!((navion.reference.density_kg_m3 - 1.225_571).abs() < 1e-6);
        assert!((navion.reference.dynamic_pressure_pa - 1_763.429_9).abs() < 1e-4);
        assert!((navion.validity.alpha_rad.max - 0.174_533).abs() < 1e-6);
    }

    #[test]
    fn the_same_aircraft_in_si_is_the_same() {
        let imperial = aircraft("navion").expect("carried");
        let metric = text("navion")
            .replace("airspeed_ft_s = 176.0", "airspeed_m_s = 53.6448")
            .replace("chord_ft = 5.7", "chord_m = 1.73736")
            .replace("altitude_ft = [-1000.0, 15000.0]", "altitude_m = [-304.8, 4572.0]");
        let metric = parse_aircraft(&metric, "metric", None).expect("right");
        let [imperial, metric] =
            [imperial, metric].map(|data| *data.derivatives().expect("derivatives"));
        assert!((metric.geometry.chord_m - imperial.geometry.chord_m).abs() < 1e-12);
        assert!((metric.reference.airspeed_m_s - imperial.reference.airspeed_m_s).abs() < 1e-12);
        assert!((metric.validity.altitude_m.max - imperial.validity.altitude_m.max).abs() < 1e-9);
    }

    #[test]
    fn a_quantity_in_two_units_or_in_none_is_a_problem() {
        let both = text("navion").replace("span_ft = 33.4", "span_ft = 33.4\nspan_m = 10.18");
        let problems = parse_aircraft(&both, "both.toml", None).expect_err("two spans").to_string();
        assert!(problems.contains("not together with `span_ft`"), "{problems}");
        let none = text("navion").replace("span_ft = 33.4\n", "");
        let problems = parse_aircraft(&none, "none.toml", None).expect_err("no span").to_string();
        assert!(problems.contains("span_ft"), "{problems}");
    }

    #[test]
    fn inertias_of_no_body_and_equations_of_the_wrong_length_are_problems() {
        let flat = text("navion").replace("ixz_slug_ft2 = 0.0", "ixz_slug_ft2 = 9000.0");
        let problems = parse_aircraft(&flat, "flat.toml", None).expect_err("no body").to_string();
        assert!(problems.contains("belong to no body"), "{problems}");
        let short = text("ctms-transport").replace("[0.0, 56.7, 0.0]", "[0.0, 56.7]");
        let problems =
            parse_aircraft(&short, "short.toml", None).expect_err("too short").to_string();
        assert!(problems.contains("2 numbers for 3 states"), "{problems}");
    }

    #[test]
    fn an_aircraft_from_a_file_flies_or_says_why_not() {
        let flies = |name: &str| {
            let data = aircraft(name).expect("carried");
            data.aircraft(Laws::default(), Environment::STANDARD).map(|_| ())
        };
        assert_eq!(flies("b747-cruise-low"), Ok(()));
        let refused = AircraftError::LinearOnly { name: "etkin-747".to_owned() };
        assert_eq!(flies("etkin-747"), Err(refused));
    }
}
