//! Trims and linearises NASA's F-16 from a folder with F16_aero.dml, F16_prop.dml and F16_inertia.dml, and compares with
//! published and independent figures: `cargo run --release -p fspid-daveml --example f16 -- FOLDER`
//!
//! The figures in the literature do not all belong to the same numbers. Stevens and Lewis's program has the inverses of
//! mass and pitch inertia with three and four digits (1.57e-3, 1.792e-5). A widely copied
//! transcription in Python besides has -0.415 for -0.416 in the table of CZ and -170 for -710 in that of the idle thrust:
//! with these, and not without, the figures of the independent program come out. Each variant reproduces its figures to their last digit.
#![allow(clippy::print_stdout, reason = "an example that is run by hand")]

use std::path::Path;
use std::process::ExitCode;

use fspid_aircraft::Gearing;
use fspid_aircraft::{
    Aircraft, Controls, Environment, Linearisation, Range, Travel, TrimTarget, VelocityForm,
};
use fspid_daveml::flight::{Body, Setting, TableForces};
use fspid_daveml::{Model, read};
use fspid_numeric::scalar::Scalar;

type Failure = Box<dyn std::error::Error>;

const FOOT_M: f64 = 0.3048;
const SLUG_FT2_KG_M2: f64 = 1.355_817_948_331_4;
const SLUG_KG: f64 = 14.593_902_937_206_364;
const SLUG_FT3_KG_M3: f64 = 515.378_818_393_2;

/// Mass in slug and pitch inertia in slug ft² of the book's program.
const BOOK: (f64, f64) = (1.0 / 1.57e-3, 1.0 / 1.792e-5);

/// Entries that some transcriptions have otherwise: file, what it says, what they say.
const TRANSCRIBED: [(&str, &str, &str); 2] = [
    ("F16_aero.dml", ".770,.241,-.100,-.416,", ".770,.241,-.100,-.415,"),
    ("F16_prop.dml", "-1020.0, -710.0,", "-1020.0, -170.0,"),
];

/// A figure and half of its last digit.
type Figure = (f64, f64);

/// What holds at a condition with the centre of gravity at 0.35 of the chord and gravity 32.17 ft/s².
struct Case {
    what: &'static str,
    airspeed_ft_s: f64,
    altitude_ft: f64,
    book_body: bool,
    transcribed: bool,
    /// Throttle, elevator in deg, α in rad; then rows V, α, q of A in (V, α, θ, q) with B per degree, as far as known.
    figures: &'static [Figure],
}

const CASES: [Case; 4] = [
    Case {
        what: "NASA's files as they are",
        airspeed_ft_s: 502.0,
        altitude_ft: 0.0,
        book_body: false,
        transcribed: false,
        figures: &[],
    },
    Case {
        what: "the trim that Stevens and Lewis print",
        airspeed_ft_s: 502.0,
        altitude_ft: 0.0,
        book_body: true,
        transcribed: false,
        figures: &[(0.1385, 5e-5), (-0.7588, 5e-5), (0.03691, 5e-6)],
    },
    Case {
        what: "an independent program with the transcribed tables",
        airspeed_ft_s: 502.0,
        altitude_ft: 0.0,
        book_body: true,
        transcribed: true,
        figures: &[
            (0.13855, 5e-6),
            (-0.75824, 5e-6),
            (0.037027, 5e-7),
            (-0.019312, 5e-7),
            (8.8163, 5e-5),
            (-32.17, 5e-3),
            (-0.5785, 5e-5),
            (0.17355, 5e-6),
            (-0.000254, 5e-7),
            (-1.0157, 5e-5),
            (0.0, 5e-6),
            (0.90505, 5e-6),
            (-0.002150, 5e-7),
            (0.0, 5e-6),
            (0.82226, 5e-6),
            (0.0, 5e-6),
            (-1.07741, 5e-6),
            (-0.17555, 5e-6),
        ],
    },
    Case {
        what: "the same at altitude",
        airspeed_ft_s: 500.0,
        altitude_ft: 15_000.0,
        book_body: true,
        transcribed: true,
        figures: &[
            (0.18063, 5e-6),
            (-0.58319, 5e-6),
            (0.074261, 5e-7),
            (-0.013623, 5e-7),
            (-6.3901, 5e-5),
            (-32.17, 5e-3),
            (-1.1177, 5e-5),
            (0.07708, 5e-6),
            (-0.000255, 5e-7),
            (-0.63775, 5e-6),
            (0.0, 5e-6),
            (0.93802, 5e-6),
            (-0.001356, 5e-7),
            (0.0, 5e-6),
            (0.51617, 5e-6),
            (0.0, 5e-6),
            (-0.67819, 5e-6),
            (-0.10939, 5e-6),
        ],
    },
];

fn main() -> ExitCode {
    let folder = std::env::args().nth(1).unwrap_or_default();
    match CASES.iter().try_for_each(|case| case.show(Path::new(&folder))) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            println!("{error}");
            ExitCode::from(2)
        }
    }
}

impl Case {
    fn show(&self, folder: &Path) -> Result<(), Failure> {
        println!("{} ft/s, {} ft: {}", self.airspeed_ft_s, self.altitude_ft, self.what);
        let aircraft = self.aircraft(folder)?;
        let trim = aircraft.trim(TrimTarget {
            airspeed_m_s: self.airspeed_ft_s * FOOT_M,
            altitude_m: self.altitude_ft * FOOT_M,
            flight_path_rad: 0.0,
        })?;
        let found = figures(&aircraft.linearise(&trim))?;
        for row in [&found[..3], &found[3..8], &found[8..13], &found[13..]] {
            println!("  {row:10.6?}");
        }
        let off = found
            .iter()
            .zip(self.figures)
            .find(|(found, (expected, half))| !((*found - expected).abs() <= half * (1.0 + 1e-9)));
        match off {
            None => Ok(()),
            Some((found, (expected, _))) => Err(format!("{found} is not {expected}").into()),
        }
    }

    fn model(&self, folder: &Path, name: &str) -> Result<Model, Failure> {
        let mut text = std::fs::read_to_string(folder.join(name))?;
        for (_, written, transcribed) in TRANSCRIBED.iter().filter(|(file, ..)| *file == name) {
            if !text.contains(written) {
                return Err(format!("{name} has no `{written}`").into());
            }
            if self.transcribed {
                text = text.replace(written, transcribed);
            }
        }
        Ok(read(&text)?.model)
    }

    /// The atmosphere of the book at the altitude, as if it were the same everywhere.
    ///
    /// Stevens and Lewis, *Aircraft Control and Simulation*, appendix A, `ADC`.
    fn environment(&self) -> Environment {
        let ratio = 1.0 - 0.703e-5 * self.altitude_ft;
        let density = 2.377e-3 * Scalar::pow(ratio, 4.14) * SLUG_FT3_KG_M3;
        let sound = (1.4 * 1716.3 * 519.0 * ratio).sqrt() * FOOT_M;
        Environment::uniform(32.17 * FOOT_M, density, sound)
    }

    fn aircraft(&self, folder: &Path) -> Result<Aircraft<TableForces>, Failure> {
        let inertia = self.model(folder, "F16_inertia.dml")?;
        let Body { mut mass, centre_of_mass_m } =
            Body::of(&inertia, &[35.0], 160.0 * SLUG_FT2_KG_M2)?;
        if self.book_body {
            mass.mass_kg = BOOK.0 * SLUG_KG;
            mass.iy_kg_m2 = BOOK.1 * SLUG_FT2_KG_M2;
        }
        let degrees = |size: f64| Range::within(size.to_radians());
        let travel = Travel {
            elevator_rad: degrees(25.0),
            aileron_rad: degrees(21.5),
            rudder_rad: degrees(30.0),
            throttle: Range { min: 0.0, max: 1.0 },
        };
        let setting = Setting { centre_of_mass_m, gearing: Gearing::StevensLewis, travel };
        let engine = Some(self.model(folder, "F16_prop.dml")?);
        let forces = TableForces::new(self.model(folder, "F16_aero.dml")?, engine, setting)?;
        Ok(Aircraft::new(mass, forces, self.environment())?)
    }
}

/// Throttle, elevator, α, then three rows of five, in feet and degrees; the states of the library are (V, α, q, θ).
fn figures(linear: &Linearisation) -> Result<[f64; 18], Failure> {
    let Controls { throttle, elevator_rad, .. } = linear.trim.controls;
    let system = linear.longitudinal(VelocityForm::SpeedAndAngle)?;
    let mut figures = vec![throttle, elevator_rad.to_degrees(), linear.trim.point.alpha_rad];
    let scale = [FOOT_M, 1.0, 1.0, 1.0];
    for row in 0..3 {
        for column in [0, 1, 3, 2] {
            let entry = system.a().get(row, column).unwrap_or(f64::NAN);
            figures.push(entry * scale[column] / scale[row]);
        }
        let entry = system.b().get(row, 0).unwrap_or(f64::NAN);
        figures.push(entry.to_radians() / scale[row]);
    }
    figures.try_into().map_err(|_| "eighteen figures".into())
}
