//! The longitudinal linear model from derivatives, with the gusts that they feel.

use fspid_lti::Matrix;

use crate::error::{SimError, positive};
use crate::plant::{ElevatorSign, LinearPlant};

/// Dimensional derivatives about level flight in stability axes: forces over mass, moments over
/// inertia, per state. Any consistent unit of length; the elevator is trailing edge down positive.
///
/// $$ \dot u = X_u (u - u_g) + X_w (w - w_g) - g \theta + X_\delta \delta $$
/// $$ \dot w = Z_u (u - u_g) + Z_w (w - w_g) + u_0 q + Z_q (q - q_g) + Z_{\dot w} (\dot w - \dot w_g) + Z_\delta \delta $$
/// $$ \dot q = M_u (u - u_g) + M_w (w - w_g) + M_q (q - q_g) + M_{\dot w} (\dot w - \dot w_g) + M_\delta \delta $$
///
/// with $\dot \theta = q$.
/// Gusts are frozen while the aircraft flies through them, so that $\dot w_g = -u_0 q_g$; with it
/// $q_g$ acts through $M_q - u_0 M_{\dot w}$ and $Z_q - u_0 Z_{\dot w}$.
///
/// # Source
/// Equations: R. C. Nelson, Flight Stability and Automatic Control, with air-relative velocities.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LongitudinalDerivatives {
    /// Speed $u_0$.
    pub u0: f64,
    /// Gravity g.
    pub gravity: f64,
    /// $X_u, X_w, X_\delta$.
    pub x: [f64; 3],
    /// $Z_u, Z_w, Z_{\dot w}, Z_q, Z_\delta$.
    pub z: [f64; 5],
    /// $M_u, M_w, M_{\dot w}, M_q, M_\delta$.
    pub m: [f64; 5],
}

/// States u, w, q, θ.
const STATES: usize = 4;
/// Inputs δ, u_g, w_g, q_g.
const INPUTS: usize = 4;

/// The model $\dot x = A x + B (\delta, u_g, w_g, q_g)$ with states u, w, q, θ.
#[derive(Clone, Debug, PartialEq)]
pub struct LongitudinalModel {
    /// State matrix.
    pub a: [[f64; STATES]; STATES],
    /// Input matrix.
    pub b: [[f64; INPUTS]; STATES],
}

impl LongitudinalDerivatives {
    /// The first-order equations, $\dot w$ eliminated.
    ///
    /// # Errors
    /// [`SimError::Number`] for a speed that is not positive and for $Z_{\dot w} = 1$.
    pub fn model(&self) -> Result<LongitudinalModel, SimError> {
        let u0 = positive("speed u0", self.u0)?;
        let ([x_u, x_w, x_d], [z_u, z_w, z_wd, z_q, z_d], [m_u, m_w, m_wd, m_q, m_d]) =
            (self.x, self.z, self.m);
        let effective_mass = positive("1 - Z_wdot", 1.0 - z_wd)?;
        let heave_a = [z_u, z_w, u0 + z_q, 0.0].map(|value| value / effective_mass);
        let heave_b = [z_d, -z_u, -z_w, u0 * z_wd - z_q].map(|value| value / effective_mass);
        let with_heave = |own: [f64; 4], heave: [f64; 4]| -> [f64; 4] {
            std::array::from_fn(|input| own[input] + m_wd * heave[input])
        };
        Ok(LongitudinalModel {
            a: [
                [x_u, x_w, 0.0, -self.gravity],
                heave_a,
                with_heave([m_u, m_w, m_q, 0.0], heave_a),
                [0.0, 0.0, 1.0, 0.0],
            ],
            b: [
                [x_d, -x_u, -x_w, 0.0],
                heave_b,
                with_heave([m_d, -m_u, -m_w, u0 * m_wd - m_q], heave_b),
                [0.0; 4],
            ],
        })
    }

    /// The plant from elevator and gusts to pitch angle. Velocities of gusts are in the unit of the
    /// derivatives times `unit_m`, m: 1 for metres, 0.3048 for derivatives in feet.
    ///
    /// # Errors
    /// As [`LongitudinalDerivatives::model`], and those of [`LinearPlant::new`].
    pub fn plant(&self, unit_m: f64) -> Result<LinearPlant, SimError> {
        let unit_m = positive("unit of length, m", unit_m)?;
        let (denominator, numerators) = self.model()?.transfer_functions()?;
        let [elevator, u, w, q] = numerators;
        let per_m = |numerator: [f64; 3]| numerator.map(|coefficient| coefficient / unit_m);
        LinearPlant::new(&elevator, &denominator, ElevatorSign::NoseDownPositive)?.with_gusts([
            &per_m(u),
            &per_m(w),
            &q,
        ])
    }
}

impl LongitudinalModel {
    /// Denominator and the numerators from δ, u_g, w_g, q_g to θ, highest power first.
    ///
    /// $$ (s I - A)^{-1} = \frac{1}{D(s)} \sum_{k=1}^{n} F_k s^{n-k}, \qquad F_1 = I, \quad
    /// a_k = -\frac{\operatorname{tr} (A F_k)}{k}, \quad F_{k+1} = A F_k + a_k I $$
    ///
    /// # Source
    /// The algorithm of Faddeev and Leverrier.
    ///
    /// # Errors
    /// [`SimError::Linear`] for entries that are not finite.
    pub fn transfer_functions(&self) -> Result<([f64; 5], [[f64; 3]; INPUTS]), SimError> {
        let (a, b) = (Matrix::from_rows(&self.a)?, Matrix::from_rows(&self.b)?);
        let mut f = Matrix::identity(STATES);
        let mut denominator = [1.0, 0.0, 0.0, 0.0, 0.0];
        let mut numerators = [[0.0; 3]; INPUTS];
        for k in 1..=STATES {
            let adjugate = f.product(&b)?;
            // θ is the last state; the coefficient of s³ is zero, since no input moves θ at once.
            for (input, numerator) in numerators.iter_mut().enumerate() {
                if let Some(coefficient) =
                    k.checked_sub(2).and_then(|place| numerator.get_mut(place))
                {
                    *coefficient = adjugate.get(STATES - 1, input).unwrap_or(0.0);
                }
            }
            let image = a.product(&f)?;
            let trace: f64 = (0..STATES).filter_map(|i| image.get(i, i)).sum();
            let coefficient = -trace / k as f64;
            if let Some(place) = denominator.get_mut(k) {
                *place = coefficient;
            }
            f = image.sum(&Matrix::identity(STATES).scaled(coefficient))?;
        }
        Ok((denominator, numerators))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nelson's rounded derivatives of the Navion, ft and s.
    pub(super) const NAVION: LongitudinalDerivatives = LongitudinalDerivatives {
        u0: 176.0,
        gravity: 32.2,
        x: [-0.045, 0.036, 0.0],
        z: [-0.369, -2.02, 0.0, 0.0, -28.15],
        m: [0.0, -0.05, -0.0051, -2.05, -11.874],
    };

    /// The Boeing 747-200 of Roskam, cruise low, nominal constants, ft and s.
    const B747: LongitudinalDerivatives = LongitudinalDerivatives {
        u0: 673.0,
        gravity: 32.2,
        x: [-0.006_529, 0.023_743, 0.0],
        z: [-0.110_403, -0.525_303, -0.016_854, -10.6948, -25.5659],
        m: [2.5166e-5, -0.001_935_83, -0.000_157_052, -0.541_693, -1.693_656],
    };

    fn close(found: &[f64], expected: &[f64], relative: f64) {
        for (found, expected) in found.iter().zip(expected) {
            assert!((found / expected - 1.0).abs() < relative, "{found} {expected}");
        }
    }

    /// Handbook oracle: both printed to some seven digits.
    #[test]
    fn the_elevator_transfer_functions_are_those_of_the_handbook() {
        let (denominator, [elevator, ..]) =
            NAVION.model().and_then(|model| model.transfer_functions()).expect("allowed");
        close(&elevator, &[-11.730_435, -23.105_85, -1.173_743], 1e-6);
        close(&denominator, &[1.0, 5.0126, 13.177_826, 0.670_174, 0.594_09], 2e-6);
        let (denominator, [elevator, ..]) =
            B747.model().and_then(|model| model.transfer_functions()).expect("allowed");
        close(&elevator, &[-1.689_707, -0.837_298, -0.009_776], 1e-4);
        close(&denominator, &[1.0, 1.167_111, 1.550_850, 0.012_426, 0.007_186], 1e-4);
    }

    /// In air that moves evenly an aircraft at rest relative to it feels nothing: each gust input is
    /// minus the column of its state, less what is inertial (gravity, u0 q).
    #[test]
    fn a_gust_is_the_motion_of_the_aircraft_with_its_sign_reversed() {
        let LongitudinalModel { a, b } = B747.model().expect("allowed");
        for row in 0..3 {
            assert_eq!((b[row][1], b[row][2]), (-a[row][0], -a[row][1]));
        }
    }

    /// Long after a step of u_g the aircraft drifts with it: no pitch is left. D(0) θ = N_u(0).
    #[test]
    fn a_steady_wind_leaves_no_pitch() {
        for derivatives in [NAVION, B747] {
            let (denominator, [_, u, w, _]) =
                derivatives.model().and_then(|model| model.transfer_functions()).expect("allowed");
            for numerator in [u, w] {
                assert!((numerator[2] / denominator[4]).abs() < 1e-12, "{numerator:?}");
            }
        }
    }

    #[test]
    fn a_plant_in_feet_feels_a_gust_in_metres_a_second() {
        let (feet, metres) = (NAVION.plant(0.3048).expect("allowed"), NAVION.plant(1.0));
        assert_eq!(feet.elevator_sign(), ElevatorSign::NoseDownPositive);
        let (feet, metres) = (feet.gust_columns(), metres.expect("allowed").gust_columns());
        let ([_, w_feet, q_feet], [_, w_metres, q_metres]) =
            (feet.expect("has gusts"), metres.expect("has gusts"));
        close(
            &w_feet[1..],
            &w_metres.iter().skip(1).map(|h| h / 0.3048).collect::<Vec<_>>(),
            1e-12,
        );
        assert_eq!(q_feet, q_metres);
        // θ'' starts with -M_w - M_wd Z_w for w_g, and with u0 M_wd - M_q for q_g.
        close(&w_metres[1..2], &[0.05 - 0.0051 * 2.02], 1e-12);
        close(&q_metres[1..2], &[2.05 - 176.0 * 0.0051], 1e-12);
    }

    #[test]
    fn derivatives_that_make_no_model_are_refused() {
        assert!(LongitudinalDerivatives { u0: 0.0, ..NAVION }.model().is_err());
        let z = [0.0, 0.0, 1.0, 0.0, 0.0];
        assert!(LongitudinalDerivatives { z, ..NAVION }.model().is_err());
        let x = [f64::NAN; 3];
        assert!(LongitudinalDerivatives { x, ..NAVION }.plant(1.0).is_err());
        assert!(NAVION.plant(0.0).is_err());
    }
}
