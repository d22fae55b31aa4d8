//! The linear model of an aircraft that another simulator flies, as an aircraft file.

use std::fmt;

use fspid_aircraft::data::{LinearCondition, LinearData, LinearElevator, LinearState};
use fspid_lti::{Complex, Matrix, TransferFunction, modulus};
use fspid_sim::external_plant::{JsbsimLinear, LongitudinalRates};
use fspid_sim::{ExternalPlant, SimError, Simulator};
use serde_json::{Value, json};

use fspid_scenario::file::Study;
use fspid_scenario::toml_text::quoted;
use fspid_scenario::units::degrees;

/// Frequencies between which the model is compared with the simulator's own, rad/s: where pitch loops cross over.
const COMPARED_RAD_S: [f64; 2] = [0.5, 20.0];
/// Points between them.
const POINTS: u32 = 60;
/// Largest share by which both may differ there.
const MOST_APART: f64 = 0.05;

/// A linear model that was found by differences.
#[derive(Clone, Debug)]
pub struct SimulatorModel {
    name: String,
    simulator: String,
    found: JsbsimLinear,
    altitude_m: f64,
    theta: TransferFunction,
    own: TransferFunction,
    apart: f64,
}

/// Why there is no model.
#[derive(Clone, Debug, PartialEq)]
pub enum NoModel {
    /// The scenario flies something else.
    NoSimulator,
    /// A path that climbs or descends, around which an aircraft file holds no model.
    NotLevel,
    /// The simulator was not asked, or has no such flight.
    Simulator(SimError),
    /// Its numbers make no model.
    NoTransfer(String),
    /// It differs from the simulator's own.
    Apart {
        /// Largest difference, as a share of the simulator's own.
        share: f64,
    },
}

impl fmt::Display for NoModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoSimulator => f.write_str("the scenario does not fly in JSBSim; allowed is one with `[simulator]` and kind = \"jsbsim\", or a model in DAVE-ML"),
            Self::NotLevel => f.write_str("the flight climbs or descends, and an aircraft file holds linear models of level flight; allowed is climb_angle_deg = 0"),
            Self::Simulator(error) => error.fmt(f),
            Self::NoTransfer(reason) => write!(f, "its differences make no linear model: {reason}"),
            Self::Apart { share } => write!(
                f,
                "the linear model by differences and JSBSim's own are {:.1} % apart between {} and {} rad/s, so that neither is believed; allowed are {} %",
                100.0 * share, COMPARED_RAD_S[0], COMPARED_RAD_S[1], 100.0 * MOST_APART
            ),
        }
    }
}

impl std::error::Error for NoModel {}

/// The linear model of the simulator's aircraft around the trim of the scenario.
///
/// # Errors
/// [`NoModel`] says why there is none.
pub fn import_simulator(study: &Study) -> Result<SimulatorModel, NoModel> {
    let plant: &ExternalPlant = study.scenario.plant.external().ok_or(NoModel::NoSimulator)?;
    let Simulator::Jsbsim(jsbsim) = &plant.simulator else { return Err(NoModel::NoSimulator) };
    if jsbsim.climb_rad != 0.0 {
        return Err(NoModel::NotLevel);
    }
    let found = plant.linear_model().map_err(NoModel::Simulator)?;
    let velocities = [LinearState::ForwardVelocity, LinearState::DownwardVelocity];
    let theta = transfer(&found.by_differences, velocities)?;
    // Along the path and the angle of attack: JSBSim's own states.
    let own = transfer(&found.own, [LinearState::ForwardVelocity, LinearState::Alpha])?;
    let apart = apart(&theta, &own);
    // Written so that NaN is apart.
    if !(apart <= MOST_APART) {
        return Err(NoModel::Apart { share: apart });
    }
    let (name, simulator) = (jsbsim.aircraft.clone(), format!("JSBSim {}", jsbsim.version));
    Ok(SimulatorModel { name, simulator, found, altitude_m: jsbsim.altitude_m, theta, own, apart })
}

fn transfer(
    rates: &LongitudinalRates,
    [first, second]: [LinearState; 2],
) -> Result<TransferFunction, NoModel> {
    let said = |error: &dyn fmt::Display| NoModel::NoTransfer(error.to_string());
    let column: Vec<[f64; 1]> = rates.by_elevator.iter().map(|entry| [*entry]).collect();
    let data = LinearData {
        states: vec![first, second, LinearState::PitchRate, LinearState::Theta],
        a: Matrix::from_rows(&rates.by_states).map_err(|error| said(&error))?,
        b: Matrix::from_rows(&column).map_err(|error| said(&error))?,
        elevator: LinearElevator::NoseDownPositive,
        by_pitch_gust: None,
        condition: None,
        span_m: None,
    };
    data.theta_over_elevator().map_err(|error| said(&error))
}

/// Largest distance of both answers, as a share of the second.
fn apart(one: &TransferFunction, other: &TransferFunction) -> f64 {
    let [least, most] = COMPARED_RAD_S;
    let at = |k: u32| {
        let omega_rad_s = least * libm::pow(most / least, f64::from(k) / f64::from(POINTS));
        let s = Complex::new(0.0, omega_rad_s);
        let (one, other) = (one.at(s), other.at(s));
        modulus(one - other) / modulus(other)
    };
    // Written so that NaN stays.
    (0..=POINTS).map(at).fold(0.0, |worst: f64, it| if it <= worst { worst } else { it })
}

impl SimulatorModel {
    fn condition(&self) -> LinearCondition {
        let (airspeed_m_s, altitude_m) = (self.found.airspeed_m_s, self.altitude_m);
        LinearCondition { airspeed_m_s, altitude_m, mach: Some(self.found.mach) }
    }

    /// The aircraft file: `[aircraft]` with `file`, flown linear, at the condition in it.
    #[must_use]
    pub fn toml(&self) -> String {
        let LinearCondition { airspeed_m_s, altitude_m, .. } = self.condition();
        let mut text = format!(
            "# Written by `fspid aircraft import`; in a scenario: [aircraft] with file = \"…\", airspeed_m_s = {airspeed_m_s:?}, altitude_m = {altitude_m:?}.\n\
             name = {}\n\
             title = {}\n\
             kind = \"linear\"\n\
             source = {}\n\
             notes = {}\n\
             elevator_sign = \"nose-down-positive\"\n\
             \n[condition]\n\
             airspeed_m_s = {airspeed_m_s:?}\n\
             altitude_m = {altitude_m:?}\n\
             mach = {:?}\n\
             \n[geometry]\n\
             span_m = {:?}\n",
            quoted(&self.name),
            quoted(&format!(
                "{} in {}, {altitude_m:.0} m, Mach {:.3}, linear",
                self.name, self.simulator, self.found.mach
            )),
            quoted(&format!(
                "central differences of the aircraft in {} at its trim",
                self.simulator
            )),
            quoted(&format!(
                "At most {:.2} % from JSBSim's own linearisation between {} and {} rad/s. Engines and propellers turn steadily at each point, and the throttle stays. Without by_pitch_gust, so that the air is calm.",
                100.0 * self.apart,
                COMPARED_RAD_S[0],
                COMPARED_RAD_S[1]
            )),
            self.found.mach,
            self.found.span_m,
        );
        let states = ["u_m_s", "w_m_s", "q_rad_s", "theta_rad"];
        let LongitudinalRates { by_states, by_elevator } = &self.found.by_differences;
        for ((state, row), input) in states.into_iter().zip(by_states).zip(by_elevator) {
            text += &format!(
                "\n[[equations]]\nstate = \"{state}\"\nby_states = {row:?}\nby_elevator = {input:?}\n"
            );
        }
        text
    }

    /// For people.
    #[must_use]
    pub fn text(&self) -> String {
        let LinearCondition { airspeed_m_s, altitude_m, .. } = self.condition();
        let list = |numbers: &[f64]| {
            numbers.iter().map(|it| format!("{it:.6}")).collect::<Vec<_>>().join(" ")
        };
        let [theta, own] = [&self.theta, &self.own]
            .map(|it| (list(it.numerator().coefficients()), list(it.denominator().coefficients())));
        format!(
            "{} in {}, {airspeed_m_s:.2} m/s, {altitude_m:.1} m, Mach {:.4}\n\
             trim         angle of attack {:.3} deg, elevator {:.3} deg\n\
             theta/elevator, elevator positive trailing edge down, highest power of s first\n\
             differences  {} / {}\n\
             JSBSim's own {} / {}\n\
             at most {:.2} % apart between {} and {} rad/s\n",
            self.name,
            self.simulator,
            self.found.mach,
            degrees(self.found.alpha_rad),
            degrees(self.found.elevator_rad),
            theta.0,
            theta.1,
            own.0,
            own.1,
            100.0 * self.apart,
            COMPARED_RAD_S[0],
            COMPARED_RAD_S[1],
        )
    }

    /// For programs.
    #[must_use]
    pub fn json(&self) -> Value {
        let LinearCondition { airspeed_m_s, altitude_m, mach } = self.condition();
        let function = |it: &TransferFunction| json!({ "numerator": it.numerator().coefficients(), "denominator": it.denominator().coefficients() });
        json!({
            "aircraft": self.name,
            "simulator": self.simulator,
            "condition": { "airspeed_m_s": airspeed_m_s, "altitude_m": altitude_m, "mach": mach },
            "trim": { "alpha_deg": degrees(self.found.alpha_rad), "elevator_deg": degrees(self.found.elevator_rad) },
            "theta_over_elevator": function(&self.theta),
            "simulators_own": function(&self.own),
            "apart": self.apart,
            "compared_rad_s": COMPARED_RAD_S,
        })
    }
}
