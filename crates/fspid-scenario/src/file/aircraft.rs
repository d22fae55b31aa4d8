//! Aircraft that the program carries, and files of the same form: from the units of a source to SI.

mod linear;
pub(super) mod variations;

use std::path::Path;

use fspid_aircraft::aerodynamics::derivatives::{
    Geometry, Lateral, LateralCoefficient, Longitudinal, LongitudinalCoefficient,
};
use fspid_aircraft::data::{AircraftData, DerivativeData, Inertia, Loading, ModelData, Reference};
use fspid_aircraft::{Range, Travel, Validity};

use crate::carried::aircraft_text;
use crate::file::files::Files;
use crate::file::spec::aircraft as keys;
use crate::file::spec::{AIRCRAFT_FILE, AircraftKind};
use crate::file::tables::tables;
use crate::keyed::{
    Key, Section, check,
    document::{self, Item},
};
use crate::units::{FOOT_M, KNOT_M_S, POUND_FORCE_N, POUND_KG, SLUG_KG, radians};
use fspid_diagnostics::{Problems, Report};

/// Size in SI of a unit that a key of an aircraft may have; degrees stand apart, and all others are SI.
pub(super) fn unit_size(unit: &str) -> f64 {
    match unit {
        "kt" => KNOT_M_S,
        "ft" | "ft/s" | "ft/s2" => FOOT_M,
        "ft/min" => FOOT_M / 60.0,
        "nmi" => 1852.0,
        "lb" => POUND_KG,
        "lb/h" => POUND_KG / 3600.0,
        "lb/(lbf h)" => POUND_KG / (POUND_FORCE_N * 3600.0),
        "ft2" => FOOT_M * FOOT_M,
        "lbf" => POUND_FORCE_N,
        "psf" => POUND_FORCE_N / (FOOT_M * FOOT_M),
        "slug ft2" | "slug ft2/s" => SLUG_KG * FOOT_M * FOOT_M,
        "slug/ft3" => SLUG_KG / (FOOT_M * FOOT_M * FOOT_M),
        _ => 1.0,
    }
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
        let mass = written.and_then(|file| file.member(keys::MASS.name.as_str()));
        let weight = |key: Key<f64>| {
            Some(unit_size(key.unit()) * mass?.member(key.name.as_str())?.number()?)
        };
        let weight_n = keys::WEIGHT.into_iter().find_map(weight);
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
    let text = |key| section.get::<str>(key).unwrap_or_default().to_owned();
    let model = match section.variant()? {
        AircraftKind::Linear => ModelData::Linear(linear::model(report, section)?),
        AircraftKind::Tables => {
            ModelData::Forces(Box::new(tables(report, files, (section, place), given.cg_mac)?))
        }
        AircraftKind::Derivatives => {
            ModelData::Derivatives(Box::new(derivatives(report, section, given)?))
        }
    };
    let variations = variations::variations(report, section);
    Some(AircraftData {
        name: text(keys::NAME),
        title: text(keys::TITLE),
        source: text(keys::SOURCE),
        notes: text(keys::NOTES),
        model,
        variations: variations?,
    })
}

fn derivatives(report: &mut Report, section: &Section, given: Given) -> Option<DerivativeData> {
    let part = |key| section.get(key);
    let reference = reference(part(keys::REFERENCE)?)?;
    let flown_n = quantity(part(keys::MASS)?, keys::WEIGHT)?;
    let weight_n = given.weight_n.unwrap_or(flown_n);
    // A scenario that changes the weight loads the aircraft; its wing carries what the file says.
    let mass_kg = flown_n.total_cmp(&weight_n).is_ne().then_some(flown_n / reference.gravity_m_s2);
    let data = DerivativeData {
        reference,
        geometry: geometry(part(keys::GEOMETRY)?)?,
        weight_n,
        inertia: inertia(part(keys::MASS)?)?,
        loading: Loading { mass_kg, ..Loading::default() },
        longitudinal: longitudinal(part(keys::LONGITUDINAL)?)?,
        lateral: part(keys::LATERAL).and_then(lateral),
        validity: validity(part(keys::VALIDITY)?)?,
        travel: travel(part(keys::TRAVEL)?)?,
    };
    for doubt in data.doubts() {
        report.warn(format!("the aircraft's {doubt}"));
    }
    match data.mass_properties().validate() {
        Ok(()) => Some(data),
        Err(error) => {
            let allowed = "moments of inertia that a body can have".to_owned();
            section.wrong(report, keys::MASS, error.to_string(), allowed);
            None
        }
    }
}

fn reference(section: &Section) -> Option<Reference> {
    let airspeed_m_s = quantity(section, keys::REFERENCE_AIRSPEED)?;
    let density_kg_m3 = quantity(section, keys::DENSITY)?;
    let own_pa = 0.5 * density_kg_m3 * airspeed_m_s * airspeed_m_s;
    Some(Reference {
        airspeed_m_s,
        altitude_m: quantity(section, keys::REFERENCE_ALTITUDE)?,
        density_kg_m3,
        dynamic_pressure_pa: quantity(section, keys::DYNAMIC_PRESSURE).unwrap_or(own_pa),
        mach: section.get(keys::REFERENCE_MACH)?,
        gravity_m_s2: quantity(section, keys::GRAVITY)?,
        alpha_rad: radians(section.get(keys::REFERENCE_ALPHA_DEG)?),
        cg_mac: section.get(keys::CG_MAC),
    })
}

fn geometry(section: &Section) -> Option<Geometry> {
    Some(Geometry {
        area_m2: quantity(section, keys::AREA)?,
        span_m: quantity(section, keys::SPAN)?,
        chord_m: quantity(section, keys::CHORD)?,
    })
}

fn inertia(section: &Section) -> Option<Inertia> {
    Some(Inertia {
        ix_kg_m2: quantity(section, keys::IX)?,
        iy_kg_m2: quantity(section, keys::IY)?,
        iz_kg_m2: quantity(section, keys::IZ)?,
        ixz_kg_m2: quantity(section, keys::IXZ)?,
    })
}

fn longitudinal(section: &Section) -> Option<Longitudinal> {
    let row = |key| section.get(key).map(longitudinal_row);
    Some(Longitudinal {
        lift: row(keys::LIFT)?,
        drag: row(keys::DRAG)?,
        pitch: row(keys::PITCH)?,
        thrust_speed: plain(section, keys::THRUST_SPEED),
    })
}

fn longitudinal_row(row: &Section) -> LongitudinalCoefficient {
    LongitudinalCoefficient {
        reference: plain(row, keys::COEFFICIENT_REFERENCE),
        alpha: plain(row, keys::ALPHA),
        alpha_rate: plain(row, keys::ALPHA_RATE),
        pitch_rate: plain(row, keys::PITCH_RATE),
        speed: plain(row, keys::SPEED),
        elevator: plain(row, keys::ELEVATOR),
    }
}

fn lateral(section: &Section) -> Option<Lateral> {
    let row = |key| section.get(key).map(lateral_row);
    Some(Lateral { side: row(keys::SIDE)?, roll: row(keys::ROLL)?, yaw: row(keys::YAW)? })
}

fn lateral_row(row: &Section) -> LateralCoefficient {
    LateralCoefficient {
        beta: plain(row, keys::BETA),
        roll_rate: plain(row, keys::ROLL_RATE),
        yaw_rate: plain(row, keys::YAW_RATE),
        aileron: plain(row, keys::AILERON),
        rudder: plain(row, keys::RUDDER),
    }
}

fn validity(section: &Section) -> Option<Validity> {
    Some(Validity {
        airspeed_m_s: range(section, keys::VALIDITY_AIRSPEED)?,
        mach: range(section, [keys::VALIDITY_MACH])?,
        alpha_rad: range(section, [keys::VALIDITY_ALPHA_DEG])?,
        beta_rad: range(section, [keys::BETA_DEG])?,
        altitude_m: range(section, keys::VALIDITY_ALTITUDE)?,
    })
}

fn travel(section: &Section) -> Option<Travel> {
    Some(Travel { throttle: range(section, [keys::THROTTLE])?, ..surfaces(section)? })
}

/// Travel of the surfaces, with a throttle from 0 to 1.
pub(super) fn surfaces(section: &Section) -> Option<Travel> {
    Some(Travel {
        elevator_rad: range(section, [keys::ELEVATOR_DEG])?,
        aileron_rad: range(section, [keys::AILERON_DEG])?,
        rudder_rad: range(section, [keys::RUDDER_DEG])?,
        throttle: Range { min: 0.0, max: 1.0 },
    })
}

/// A coefficient, 0 if it is left out.
fn plain(section: &Section, key: Key<f64>) -> f64 {
    section.get(key).unwrap_or(0.0)
}

/// The value in SI of the one of these keys that is given; they differ in their units.
pub(super) fn quantity<const N: usize>(section: &Section, keys: [Key<f64>; N]) -> Option<f64> {
    keys.into_iter().find_map(|key| Some(unit_size(key.unit()) * section.get(key)?))
}

/// As [`quantity`], for two ends; degrees become radians.
fn range<const N: usize>(section: &Section, keys: [Key<(f64, f64)>; N]) -> Option<Range> {
    keys.into_iter().find_map(|key| {
        let (min, max) = section.get(key)?;
        Some(match key.unit() {
            "deg" => Range { min: radians(min), max: radians(max) },
            unit => Range { min: unit_size(unit) * min, max: unit_size(unit) * max },
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use fspid_aircraft::data::Laws;
    use fspid_aircraft::{AircraftError, Environment};
    use fspid_data::{AIRCRAFT, AIRCRAFT_CLASSES};

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

    /// A class means something with six kinds in it that can be trimmed and flown.
    #[test]
    fn every_aircraft_is_in_one_class_and_every_class_has_six_kinds_with_derivatives() {
        let of = |kinds: &[&[&'static str]]| kinds.concat();
        let mut named: Vec<&str> =
            AIRCRAFT_CLASSES.iter().flat_map(|(_, kinds)| of(kinds)).collect();
        let mut known: Vec<&str> = AIRCRAFT.iter().map(|(name, _)| *name).collect();
        named.sort_unstable();
        known.sort_unstable();
        assert_eq!(named, known);
        for (class, kinds) in AIRCRAFT_CLASSES {
            let flies = |name: &&str| aircraft(name).expect("carried").derivatives().is_ok();
            let kinds = kinds.iter().filter(|files| files.iter().any(flies)).count();
            assert!(kinds >= 6, "{class}: {kinds}");
        }
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
