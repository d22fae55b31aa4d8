//! What a certificate's file says of the nonlinear aircraft: its numbers, the box, the form.

use fspid_aircraft::Range;
use fspid_aircraft::aerodynamics::derivatives::{
    DragLaw, Longitudinal, LongitudinalCoefficient, ThrustLaw,
};
use fspid_aircraft::data::Laws;
use fspid_aircraft::enclosure::MotionNumbers;
use fspid_proof::{Begun, Nonlinear, Reach};
use serde::{Deserialize, Serialize};

use super::file::{Rows, matrix, rows};

/// A claim about the nonlinear aircraft as written.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct NonlinearFile {
    /// Left away where a flight may begin with any gains.
    #[serde(default, skip_serializing_if = "BegunFile::is_anyhow")]
    begins_with: BegunFile,
    aircraft: AircraftFile,
    #[serde(rename = "box")]
    reach: BoxFile,
    rate: f64,
    form: Rows,
    level: f64,
}

/// What of a self-tuner a flight begins with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum BegunFile {
    #[default]
    AnyGains,
    Reset,
}

impl BegunFile {
    fn is_anyhow(&self) -> bool {
        *self == Self::AnyGains
    }
}

/// The numbers that the motion is made of.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AircraftFile {
    mass_kg: f64,
    iy_kg_m2: f64,
    cg_aft_chords: f64,
    airspeed_m_s: f64,
    flight_path_rad: f64,
    density_kg_m3: f64,
    /// Left away by those for which the air has everywhere the density of the trim.
    #[serde(default, skip_serializing_if = "is_nothing")]
    height_m: f64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    densities_kg_m3: Option<[f64; 2]>,
    gravity_m_s2: f64,
    area_m2: f64,
    chord_m: f64,
    reference_airspeed_m_s: f64,
    lift: CoefficientFile,
    drag: CoefficientFile,
    pitch: CoefficientFile,
    thrust_speed: f64,
    drag_law: DragFile,
    thrust_law: ThrustFile,
    alpha_rad: [Option<f64>; 2],
    airspeeds_m_s: [Option<f64>; 2],
    elevator_rad: [Option<f64>; 2],
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct CoefficientFile {
    reference: f64,
    alpha: f64,
    alpha_rate: f64,
    pitch_rate: f64,
    speed: f64,
    elevator: f64,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum DragFile {
    Linear,
    Polar,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum ThrustFile {
    Constant,
    WithSpeed,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct BoxFile {
    pitch_rad: f64,
    pitch_rate_rad_s: f64,
    airspeed_m_s: f64,
    alpha_rad: f64,
    elevator_rad: f64,
    command_rad: f64,
}

impl NonlinearFile {
    pub(super) fn of(claim: &Nonlinear) -> Self {
        let Nonlinear { begun, aircraft, reach, form, rate, level } = claim;
        let Reach { motion, command_rad } = *reach;
        let [pitch_rad, pitch_rate_rad_s, airspeed_m_s, alpha_rad, elevator_rad] = motion;
        Self {
            begins_with: match begun {
                Begun::Anyhow => BegunFile::AnyGains,
                Begun::Reset => BegunFile::Reset,
            },
            aircraft: AircraftFile::of(aircraft),
            reach: BoxFile {
                pitch_rad,
                pitch_rate_rad_s,
                airspeed_m_s,
                alpha_rad,
                elevator_rad,
                command_rad,
            },
            rate: *rate,
            form: rows(form),
            level: *level,
        }
    }

    pub(super) fn build(self) -> Result<Nonlinear, String> {
        let BoxFile {
            pitch_rad,
            pitch_rate_rad_s,
            airspeed_m_s,
            alpha_rad,
            elevator_rad,
            command_rad,
        } = self.reach;
        let motion = [pitch_rad, pitch_rate_rad_s, airspeed_m_s, alpha_rad, elevator_rad];
        if (self.aircraft.height_m > 0.0) != self.aircraft.densities_kg_m3.is_some() {
            return Err("height_m and densities_kg_m3 stand together or not at all".to_owned());
        }
        Ok(Nonlinear {
            begun: match self.begins_with {
                BegunFile::AnyGains => Begun::Anyhow,
                BegunFile::Reset => Begun::Reset,
            },
            aircraft: self.aircraft.build(),
            reach: Reach { motion, command_rad },
            form: matrix(&self.form)?,
            rate: self.rate,
            level: self.level,
        })
    }
}

impl AircraftFile {
    pub(super) fn of(numbers: &MotionNumbers) -> Self {
        let MotionNumbers { longitudinal, laws, alpha_rad, airspeeds_m_s, elevator_rad, .. } =
            *numbers;
        let Longitudinal { lift, drag, pitch, thrust_speed } = longitudinal;
        Self {
            mass_kg: numbers.mass_kg,
            iy_kg_m2: numbers.iy_kg_m2,
            cg_aft_chords: numbers.aft_chords,
            airspeed_m_s: numbers.airspeed_m_s,
            flight_path_rad: numbers.flight_path_rad,
            density_kg_m3: numbers.density_kg_m3,
            height_m: numbers.height_m,
            densities_kg_m3: (numbers.height_m > 0.0)
                .then_some([numbers.densities_kg_m3.min, numbers.densities_kg_m3.max]),
            gravity_m_s2: numbers.gravity_m_s2,
            area_m2: numbers.area_m2,
            chord_m: numbers.chord_m,
            reference_airspeed_m_s: numbers.reference_airspeed_m_s,
            lift: lift.into(),
            drag: drag.into(),
            pitch: pitch.into(),
            thrust_speed,
            drag_law: match laws.drag {
                DragLaw::Linear => DragFile::Linear,
                DragLaw::Polar => DragFile::Polar,
            },
            thrust_law: match laws.thrust {
                ThrustLaw::Constant => ThrustFile::Constant,
                ThrustLaw::WithSpeed => ThrustFile::WithSpeed,
            },
            alpha_rad: ends(alpha_rad),
            airspeeds_m_s: ends(airspeeds_m_s),
            elevator_rad: ends(elevator_rad),
        }
    }

    fn build(self) -> MotionNumbers {
        MotionNumbers {
            mass_kg: self.mass_kg,
            iy_kg_m2: self.iy_kg_m2,
            aft_chords: self.cg_aft_chords,
            airspeed_m_s: self.airspeed_m_s,
            flight_path_rad: self.flight_path_rad,
            density_kg_m3: self.density_kg_m3,
            height_m: self.height_m,
            densities_kg_m3: match self.densities_kg_m3 {
                Some([min, max]) => Range { min, max },
                None => Range { min: self.density_kg_m3, max: self.density_kg_m3 },
            },
            gravity_m_s2: self.gravity_m_s2,
            area_m2: self.area_m2,
            chord_m: self.chord_m,
            reference_airspeed_m_s: self.reference_airspeed_m_s,
            longitudinal: Longitudinal {
                lift: self.lift.into(),
                drag: self.drag.into(),
                pitch: self.pitch.into(),
                thrust_speed: self.thrust_speed,
            },
            laws: Laws {
                drag: match self.drag_law {
                    DragFile::Linear => DragLaw::Linear,
                    DragFile::Polar => DragLaw::Polar,
                },
                thrust: match self.thrust_law {
                    ThrustFile::Constant => ThrustLaw::Constant,
                    ThrustFile::WithSpeed => ThrustLaw::WithSpeed,
                },
            },
            alpha_rad: range(self.alpha_rad),
            airspeeds_m_s: range(self.airspeeds_m_s),
            elevator_rad: range(self.elevator_rad),
        }
    }
}

/// True for a number that is left away.
fn is_nothing(value: &f64) -> bool {
    *value <= 0.0
}

/// Ends, none for an open one.
fn ends(range: Range) -> [Option<f64>; 2] {
    [range.min, range.max].map(|end| end.is_finite().then_some(end))
}

fn range([min, max]: [Option<f64>; 2]) -> Range {
    Range { min: min.unwrap_or(f64::NEG_INFINITY), max: max.unwrap_or(f64::INFINITY) }
}

impl From<LongitudinalCoefficient> for CoefficientFile {
    fn from(row: LongitudinalCoefficient) -> Self {
        let LongitudinalCoefficient { reference, alpha, alpha_rate, pitch_rate, speed, elevator } =
            row;
        Self { reference, alpha, alpha_rate, pitch_rate, speed, elevator }
    }
}

impl From<CoefficientFile> for LongitudinalCoefficient {
    fn from(row: CoefficientFile) -> Self {
        let CoefficientFile { reference, alpha, alpha_rate, pitch_rate, speed, elevator } = row;
        Self { reference, alpha, alpha_rate, pitch_rate, speed, elevator }
    }
}
