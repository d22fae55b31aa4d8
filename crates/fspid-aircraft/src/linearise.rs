//! Small motions around a trim: the linear model that holds at any point of the envelope.

use fspid_lti::{LtiError, Matrix, StateSpace, TransferFunction};

use crate::aerodynamics::ForceModel;
use crate::aircraft::Aircraft;
use crate::controls::{CONTROLS, Controls};
use crate::error::AircraftError;
use crate::flow::AirMotion;
use crate::quaternion::{EulerAngles, Quaternion};
use crate::rigid_body::RigidState;
use crate::transfer::transfer_function;
use crate::trim::Trim;
use crate::vector::Vector3;

/// How many states the full linear model has.
pub const STATES: usize = 12;

/// Names of the states, in order.
pub const STATE_NAMES: [&str; STATES] = [
    "north_m",
    "east_m",
    "down_m",
    "u_m_s",
    "v_m_s",
    "w_m_s",
    "phi_rad",
    "theta_rad",
    "psi_rad",
    "p_rad_s",
    "q_rad_s",
    "r_rad_s",
];

/// Names of the inputs, in order.
pub const INPUT_NAMES: [&str; CONTROLS] = ["elevator_rad", "aileron_rad", "rudder_rad", "throttle"];

/// Half the width of a difference, as a part of the value or of 1 (100 m for a position).
const RELATIVE_STEP: f64 = 1e-5;

const U: usize = 3;
const V: usize = 4;
const W: usize = 5;
const PHI: usize = 6;
const THETA: usize = 7;
const P: usize = 9;
const Q: usize = 10;
const R: usize = 11;

/// A trim and the linear model around it: 12 states of [`STATE_NAMES`], 4 inputs of [`INPUT_NAMES`].
#[derive(Debug, Clone, PartialEq)]
pub struct Linearisation {
    /// Where.
    pub trim: Trim,
    /// State matrix, 12 by 12.
    pub a: Matrix,
    /// Input matrix, 12 by 4.
    pub b: Matrix,
}

/// How the motion of the aircraft is written as two numbers.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum VelocityForm {
    /// Components along the body axes, u and w in m/s; sideways v in m/s.
    #[default]
    Components,
    /// Airspeed V in m/s and angle of attack α in rad; sideways β in rad.
    SpeedAndAngle,
}

impl<M: ForceModel> Aircraft<M> {
    /// Linear model around a trim, by central differences.
    ///
    /// $$ \frac{\partial f}{\partial x} \approx \frac{f(x + h) - f(x - h)}{2 h}, \quad h = 10^{-5} \max(|x|, 1) $$
    ///
    /// Controls are moved to both sides even at their stops, so nothing is ever one-sided. Where the aircraft's data have a
    /// kink ([`has_kink_at`](Self::has_kink_at)) these are means of two slopes.
    #[must_use]
    pub fn linearise(&self, trim: &Trim) -> Linearisation {
        let (state, controls) = (to_euler_state(&trim.state), trim.controls.to_array());
        let by_state = |state: &[f64; STATES]| self.euler_rate(state, trim.controls);
        let by_controls =
            |controls: &[f64; CONTROLS]| self.euler_rate(&state, Controls::from_array(*controls));
        Linearisation {
            trim: *trim,
            a: jacobian(by_state, &state),
            b: jacobian(by_controls, &controls),
        }
    }

    /// States and controls of a trim, and their rate of change.
    pub(crate) fn rates_about(
        &self,
        trim: &Trim,
    ) -> ([f64; STATES + CONTROLS], impl Fn(&[f64; STATES + CONTROLS]) -> [f64; STATES]) {
        let (state, controls) = (to_euler_state(&trim.state), trim.controls.to_array());
        let both = |column: usize| match column.checked_sub(STATES) {
            None => state[column],
            Some(control) => controls[control],
        };
        let rate = |values: &[f64; STATES + CONTROLS]| {
            let state = core::array::from_fn(|row| values[row]);
            let controls = core::array::from_fn(|row| values[STATES + row]);
            self.euler_rate(&state, Controls::from_array(controls))
        };
        (core::array::from_fn(both), rate)
    }

    /// Rate of change of the twelve states in still air.
    fn euler_rate(&self, values: &[f64; STATES], controls: Controls) -> [f64; STATES] {
        let (state, angles) = from_euler_state(values);
        let accelerations = self.instant(&state, &controls, &AirMotion::STILL).accelerations;
        euler_state(
            state.velocity_ned_m_s(),
            accelerations.velocity_rate_body_m_s2,
            angles.rate(state.rates_rad_s),
            accelerations.angular_rad_s2,
        )
    }
}

impl Linearisation {
    /// Longitudinal motion: (u, w, q, θ) or (V, α, q, θ); inputs elevator and throttle; all states are outputs.
    ///
    /// Altitude is left out, as books do: the air does not change.
    ///
    /// # Errors
    /// Entries that are not finite.
    pub fn longitudinal(&self, form: VelocityForm) -> Result<StateSpace, AircraftError> {
        let system = self.part(&[U, W, Q, THETA], &[0, 3])?;
        match form {
            VelocityForm::Components => Ok(system),
            VelocityForm::SpeedAndAngle => Ok(similar(&system, &self.speed_and_angle()?)?),
        }
    }

    /// Lateral motion: (v, p, r, φ) or (β, p, r, φ); inputs aileron and rudder; all states are outputs.
    ///
    /// # Errors
    /// Entries that are not finite.
    pub fn lateral(&self, form: VelocityForm) -> Result<StateSpace, AircraftError> {
        let system = self.part(&[V, P, R, PHI], &[1, 2])?;
        match form {
            VelocityForm::Components => Ok(system),
            VelocityForm::SpeedAndAngle => {
                let mut change = Matrix::identity(4);
                change.set(0, 0, 1.0 / self.trim.target.airspeed_m_s)?;
                Ok(similar(&system, &change)?)
            }
        }
    }

    /// Everything: 12 states, 4 inputs, all states are outputs.
    ///
    /// # Errors
    /// Entries that are not finite.
    pub fn full(&self) -> Result<StateSpace, AircraftError> {
        self.part(&core::array::from_fn::<_, STATES, _>(|index| index), &[0, 1, 2, 3])
    }

    /// Pitch over elevator, of the longitudinal motion.
    ///
    /// # Errors
    /// Entries that are not finite; an elevator without effect.
    pub fn theta_over_elevator(&self) -> Result<TransferFunction, AircraftError> {
        transfer_function(&self.longitudinal(VelocityForm::Components)?, 0, 3)
    }

    fn part(&self, states: &[usize], inputs: &[usize]) -> Result<StateSpace, AircraftError> {
        let a = select(&self.a, states, states)?;
        let b = select(&self.b, states, inputs)?;
        let (c, d) = (Matrix::identity(states.len()), Matrix::zeros(states.len(), inputs.len()));
        Ok(StateSpace::new(a, b, c, d)?)
    }

    /// Change of (u, w, q, θ) into (V, α, q, θ) for small motions around the trim.
    ///
    /// $$ dV = \cos\alpha\ du + \sin\alpha\ dw, \quad V\ d\alpha = \cos\alpha\ dw - \sin\alpha\ du $$
    fn speed_and_angle(&self) -> Result<Matrix, LtiError> {
        let (sin, cos) = libm::sincos(self.trim.point.alpha_rad);
        let per_speed = 1.0 / self.trim.target.airspeed_m_s;
        Matrix::from_rows(&[
            [cos, sin, 0.0, 0.0],
            [-sin * per_speed, cos * per_speed, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ])
    }
}

/// The same system with states T x: A becomes T A T⁻¹, B becomes T B; the new states are the outputs.
fn similar(system: &StateSpace, change: &Matrix) -> Result<StateSpace, LtiError> {
    let inverse = change.solve(&Matrix::identity(change.rows()))?;
    let a = change.product(system.a())?.product(&inverse)?;
    let b = change.product(system.b())?;
    StateSpace::new(a, b, system.c().clone(), system.d().clone())
}

fn select(matrix: &Matrix, rows: &[usize], columns: &[usize]) -> Result<Matrix, LtiError> {
    let mut result = Matrix::zeros(rows.len(), columns.len());
    for (to_row, &row) in rows.iter().enumerate() {
        for (to_column, &column) in columns.iter().enumerate() {
            result.set(to_row, to_column, matrix.get(row, column).unwrap_or(f64::NAN))?;
        }
    }
    Ok(result)
}

/// Derivatives of a function of N numbers, column by column.
fn jacobian<const N: usize>(
    function: impl Fn(&[f64; N]) -> [f64; STATES],
    at: &[f64; N],
) -> Matrix {
    let mut result = Matrix::zeros(STATES, N);
    for column in 0..N {
        for (row, slope) in difference(&function, at, column).into_iter().enumerate() {
            // Every position lies inside: the matrix was made for them.
            let _ = result.set(row, column, slope);
        }
    }
    result
}

fn difference<const N: usize>(
    function: &impl Fn(&[f64; N]) -> [f64; STATES],
    at: &[f64; N],
    index: usize,
) -> [f64; STATES] {
    let (mut ahead, mut behind) = (*at, *at);
    let step = half_width(at[index]);
    ahead[index] += step;
    behind[index] -= step;
    let span = ahead[index] - behind[index];
    let (above, below) = (function(&ahead), function(&behind));
    core::array::from_fn(|row| (above[row] - below[row]) / span)
}

/// Half the width of a difference by a number.
pub(crate) fn half_width(value: f64) -> f64 {
    RELATIVE_STEP * value.abs().max(1.0)
}

fn to_euler_state(state: &RigidState) -> [f64; STATES] {
    let EulerAngles { phi_rad, theta_rad, psi_rad } = state.euler();
    let angles = Vector3::new(phi_rad, theta_rad, psi_rad);
    euler_state(state.position_ned_m, state.velocity_body_m_s, angles, state.rates_rad_s)
}

fn euler_state(
    position: Vector3,
    velocity: Vector3,
    angles: Vector3,
    rates: Vector3,
) -> [f64; STATES] {
    let parts = [position, velocity, angles, rates].map(Vector3::to_array);
    core::array::from_fn(|index| parts[index / 3][index % 3])
}

fn from_euler_state(values: &[f64; STATES]) -> (RigidState, EulerAngles) {
    let [north, east, down, u, v, w, phi_rad, theta_rad, psi_rad, p, q, r] = *values;
    let angles = EulerAngles { phi_rad, theta_rad, psi_rad };
    let state = RigidState {
        position_ned_m: Vector3::new(north, east, down),
        velocity_body_m_s: Vector3::new(u, v, w),
        attitude: Quaternion::from_euler(angles),
        rates_rad_s: Vector3::new(p, q, r),
    };
    (state, angles)
}
