//! An aircraft of which its source has a linear model at one condition, and nothing else.

use fspid_lti::{LtiError, Matrix, StateSpace, TransferFunction};

use crate::error::AircraftError;
use crate::transfer::transfer_function;

/// A longitudinal linear model: states and elevator.
///
/// $$ \dot x = A x + b \delta_e $$
#[derive(Debug, Clone, PartialEq)]
pub struct LinearData {
    /// What the states are, in the order of the rows.
    pub states: Vec<LinearState>,
    /// State matrix.
    pub a: Matrix,
    /// Input column.
    pub b: Matrix,
    /// Which way the elevator of the input column is counted.
    pub elevator: LinearElevator,
    /// Rates of change of the states by the air's pitch rate, rad/s, if the source tells them.
    pub by_pitch_gust: Option<Vec<f64>>,
    /// The flight condition at which the model holds, if the source tells it.
    pub condition: Option<LinearCondition>,
    /// Wing span, m, if the source tells it; turbulence depends on it.
    pub span_m: Option<f64>,
}

/// A longitudinal state, as a deviation from the condition.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LinearState {
    /// Forward velocity in m/s.
    ForwardVelocity,
    /// Downward velocity in m/s.
    DownwardVelocity,
    /// Angle of attack in rad.
    Alpha,
    /// Pitch rate in rad/s.
    PitchRate,
    /// Pitch in rad.
    Theta,
}

/// Which way a linear model counts its elevator.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum LinearElevator {
    /// Positive is trailing edge down, which turns the nose down.
    #[default]
    NoseDownPositive,
    /// Positive turns the nose up.
    NoseUpPositive,
}

/// The level flight around which a linear model holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinearCondition {
    /// True airspeed.
    pub airspeed_m_s: f64,
    /// Geopotential altitude.
    pub altitude_m: f64,
    /// Mach number as the source prints it.
    pub mach: Option<f64>,
}

impl LinearData {
    /// The model as a system: elevator in, all states out.
    ///
    /// # Errors
    /// Matrices that do not fit each other.
    pub fn system(&self) -> Result<StateSpace, AircraftError> {
        self.driven_by(self.b.clone())
    }

    /// Pitch over elevator, in the model's own sense of the elevator.
    ///
    /// # Errors
    /// Matrices that do not fit each other; a model without pitch among its states, or one that the elevator does not
    /// reach.
    pub fn theta_over_elevator(&self) -> Result<TransferFunction, AircraftError> {
        self.theta_over(&self.system()?)
    }

    /// Numerators of pitch over the air's velocity forward and down, rad per m/s, and over its pitch rate, rad per
    /// rad/s: the denominator is that of [`Self::theta_over_elevator`]; empty for no effect.
    ///
    /// Forces depend on the motion through the air, so that a gust along a velocity acts as that velocity with its sign
    /// reversed; columns of $A$ for $u$ and $w$ have no part that is inertial:
    ///
    /// $$ \dot x = A x + b \delta_e - A_u u_g - A_w w_g + b_q q_g, \qquad A_w = A_\alpha / V $$
    ///
    /// That of the pitch rate has one ($u_0 q$, and the part of $\dot w$ in the moment), and the matrix does not tell
    /// it from the air's; the source must. `None` where it does not, and for a model without the forward velocity or
    /// without both downward velocity and an angle of attack at a known airspeed.
    ///
    /// # Errors
    /// As [`Self::theta_over_elevator`].
    pub fn theta_over_gusts(&self) -> Result<Option<[Vec<f64>; 3]>, AircraftError> {
        let forward = self.minus_column(LinearState::ForwardVelocity, 1.0);
        let by_alpha = || {
            let airspeed_m_s = self.condition?.airspeed_m_s;
            self.minus_column(LinearState::Alpha, 1.0 / airspeed_m_s)
        };
        let down = self.minus_column(LinearState::DownwardVelocity, 1.0).or_else(by_alpha);
        let (Some(forward), Some(down), Some(pitch)) = (forward, down, &self.by_pitch_gust) else {
            return Ok(None);
        };
        let numerators = [&forward, &down, pitch].map(|column| self.theta_over_column(column));
        let [forward, down, pitch] = numerators;
        Ok(Some([forward?, down?, pitch?]))
    }

    /// The column of a state in the state matrix times `-size`.
    fn minus_column(&self, state: LinearState, size: f64) -> Option<Vec<f64>> {
        let place = self.states.iter().position(|known| *known == state)?;
        (0..self.states.len()).map(|row| Some(-size * self.a.get(row, place)?)).collect()
    }

    /// The numerator of pitch over an input that enters by a column; empty where it does not reach pitch.
    fn theta_over_column(&self, column: &[f64]) -> Result<Vec<f64>, AircraftError> {
        let rows: Vec<[f64; 1]> = column.iter().map(|entry| [*entry]).collect();
        match self.theta_over(&self.driven_by(Matrix::from_rows(&rows)?)?) {
            Ok(found) => Ok(found.numerator().coefficients().to_vec()),
            Err(AircraftError::Linear(LtiError::ZeroPolynomial { .. })) => Ok(Vec::new()),
            Err(error) => Err(error),
        }
    }

    fn driven_by(&self, column: Matrix) -> Result<StateSpace, AircraftError> {
        let states = self.states.len();
        let (c, d) = (Matrix::identity(states), Matrix::zeros(states, 1));
        Ok(StateSpace::new(self.a.clone(), column, c, d)?)
    }

    fn theta_over(&self, system: &StateSpace) -> Result<TransferFunction, AircraftError> {
        let theta = self.states.iter().position(|state| *state == LinearState::Theta);
        transfer_function(system, 0, theta.ok_or(AircraftError::NoPitch)?)
    }
}
