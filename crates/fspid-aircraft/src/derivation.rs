//! From stability derivatives to the polynomials of the paper, by the equations that books print.
//!
//! The check of [`crate::linearise`] by another way, and what reproduces the digits of the paper. Equations are
//! homogeneous in their units: feet and slugs in give feet out.

use fspid_lti::TransferFunction;

use crate::aerodynamics::derivatives::Longitudinal;
use crate::data::DerivativeData;
use crate::error::AircraftError;

/// What dimensionless derivatives are multiplied with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DerivationCondition {
    /// Airspeed $u_0$.
    pub airspeed_m_s: f64,
    /// Dynamic pressure Q.
    pub dynamic_pressure_pa: f64,
    /// Gravity g.
    pub gravity_m_s2: f64,
    /// Mass m.
    pub mass_kg: f64,
    /// Moment of inertia $I_y$.
    pub iy_kg_m2: f64,
    /// Wing area S.
    pub area_m2: f64,
    /// Mean chord.
    pub chord_m: f64,
}

/// Longitudinal derivatives of accelerations about level flight, in stability axes; letters as in books.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct DimensionalDerivatives {
    /// $X_u$ in 1/s.
    pub x_u: f64,
    /// $X_w$ in 1/s.
    pub x_w: f64,
    /// $X_{\delta_e}$ in m/s².
    pub x_elevator: f64,
    /// $Z_u$ in 1/s.
    pub z_u: f64,
    /// $Z_w$ in 1/s.
    pub z_w: f64,
    /// $Z_{\dot w}$, without unit.
    pub z_w_rate: f64,
    /// $Z_q$ in m/s.
    pub z_q: f64,
    /// $Z_{\delta_e}$ in m/s².
    pub z_elevator: f64,
    /// $M_u$ in 1/(m s).
    pub m_u: f64,
    /// $M_w$ in 1/(m s).
    pub m_w: f64,
    /// $M_{\dot w}$ in 1/m.
    pub m_w_rate: f64,
    /// $M_q$ in 1/s.
    pub m_q: f64,
    /// $M_{\delta_e}$ in 1/s².
    pub m_elevator: f64,
}

impl DerivationCondition {
    /// Condition of an aircraft's source, with the dynamic pressure and gravity that it prints.
    #[must_use]
    pub fn of(data: &DerivativeData) -> Self {
        Self {
            airspeed_m_s: data.reference.airspeed_m_s,
            dynamic_pressure_pa: data.reference.dynamic_pressure_pa,
            gravity_m_s2: data.reference.gravity_m_s2,
            mass_kg: data.mass_kg(),
            iy_kg_m2: data.inertia.iy_kg_m2,
            area_m2: data.geometry.area_m2,
            chord_m: data.geometry.chord_m,
        }
    }
}

impl DimensionalDerivatives {
    /// Derivatives of an aircraft at a condition.
    ///
    /// $$ X_u = -(C_{D_u} + 2 C_{D_1}) \tfrac{Q S}{m u_0} + (C_{T_{xu}} + 2 C_{T_{x1}}) \tfrac{Q S}{m u_0}, \quad
    ///    X_w = -(C_{D_\alpha} - C_{L_1}) \tfrac{Q S}{m u_0}, \quad X_{\delta_e} = -C_{D_{\delta_e}} \tfrac{Q S}{m} $$
    /// $$ Z_u = -(C_{L_u} + 2 C_{L_1}) \tfrac{Q S}{m u_0}, \quad Z_w = -(C_{L_\alpha} + C_{D_1}) \tfrac{Q S}{m u_0}, \quad
    ///    Z_{\dot w} = -C_{L_{\dot\alpha}} \tfrac{\bar c}{2 u_0} \tfrac{Q S}{m u_0}, \quad
    ///    Z_q = -C_{L_q} \tfrac{\bar c}{2 u_0} \tfrac{Q S}{m}, \quad Z_{\delta_e} = -C_{L_{\delta_e}} \tfrac{Q S}{m} $$
    /// $$ M_u = C_{m_u} \tfrac{Q S \bar c}{u_0 I_y}, \quad M_w = C_{m_\alpha} \tfrac{Q S \bar c}{u_0 I_y}, \quad
    ///    M_{\dot w} = C_{m_{\dot\alpha}} \tfrac{\bar c}{2 u_0} \tfrac{Q S \bar c}{u_0 I_y}, \quad
    ///    M_q = C_{m_q} \tfrac{\bar c}{2 u_0} \tfrac{Q S \bar c}{I_y}, \quad
    ///    M_{\delta_e} = C_{m_{\delta_e}} \tfrac{Q S \bar c}{I_y} $$
    ///
    /// # Source
    /// R. C. Nelson, Flight Stability and Automatic Control, 2nd edition, table 3.5; the thrust terms from J. Roskam,
    /// Airplane Flight Dynamics and Automatic Flight Controls, Part I, table 5.1, with $C_{T_{x1}} = C_{D_1}$.
    #[must_use]
    pub fn of(longitudinal: &Longitudinal, condition: &DerivationCondition) -> Self {
        let Longitudinal { lift, drag, pitch, thrust_speed } = longitudinal;
        let DerivationCondition { airspeed_m_s: u0, chord_m, .. } = *condition;
        let force_n = condition.dynamic_pressure_pa * condition.area_m2;
        let (along, turn) = (force_n / condition.mass_kg, force_n * chord_m / condition.iy_kg_m2);
        let half_chord_s = 0.5 * chord_m / u0;
        let thrust = thrust_speed + 2.0 * drag.reference;
        Self {
            x_u: (thrust - (drag.speed + 2.0 * drag.reference)) * along / u0,
            x_w: -(drag.alpha - lift.reference) * along / u0,
            x_elevator: -drag.elevator * along,
            z_u: -(lift.speed + 2.0 * lift.reference) * along / u0,
            z_w: -(lift.alpha + drag.reference) * along / u0,
            z_w_rate: -lift.alpha_rate * half_chord_s * along / u0,
            z_q: -lift.pitch_rate * half_chord_s * along,
            z_elevator: -lift.elevator * along,
            m_u: pitch.speed * turn / u0,
            m_w: pitch.alpha * turn / u0,
            m_w_rate: pitch.alpha_rate * half_chord_s * turn / u0,
            m_q: pitch.pitch_rate * half_chord_s * turn,
            m_elevator: pitch.elevator * turn,
        }
    }

    /// The same with thrust that does not depend on speed: $X_u = -(C_{D_u} + 2 C_{D_1}) Q S / (m u_0)$.
    #[must_use]
    pub fn with_constant_thrust(
        longitudinal: &Longitudinal,
        condition: &DerivationCondition,
    ) -> Self {
        let thrust_speed = -2.0 * longitudinal.drag.reference;
        Self::of(&Longitudinal { thrust_speed, ..*longitudinal }, condition)
    }

    /// The same with $Z_{\dot w} = Z_q = 0$, as the paper simplifies.
    #[must_use]
    pub fn simplified(self) -> Self {
        Self { z_w_rate: 0.0, z_q: 0.0, ..self }
    }

    /// Pitch over elevator with both longitudinal modes; the denominator begins with 1.
    ///
    /// $$ \begin{pmatrix} s - X_u & -X_w & g \cr
    ///    -Z_u & (1 - Z_{\dot w}) s - Z_w & -(u_0 + Z_q) s \cr
    ///    -M_u & -(M_{\dot w} s + M_w) & s^2 - M_q s \end{pmatrix}
    ///    \begin{pmatrix} u \cr w \cr \theta \end{pmatrix}
    ///    = \begin{pmatrix} X_{\delta_e} \cr Z_{\delta_e} \cr M_{\delta_e} \end{pmatrix} \delta_e $$
    ///
    /// # Source
    /// As [`DimensionalDerivatives::of`]; the paper prints $M_w$ with the opposite sign, which would be unstable.
    ///
    /// # Errors
    /// Derivatives that are not finite; an elevator without effect.
    pub fn theta_over_elevator(
        &self,
        airspeed_m_s: f64,
        gravity_m_s2: f64,
    ) -> Result<TransferFunction, AircraftError> {
        let mut rows = [
            [line(1.0, -self.x_u), line(0.0, -self.x_w), line(0.0, gravity_m_s2)],
            [
                line(0.0, -self.z_u),
                line(1.0 - self.z_w_rate, -self.z_w),
                line(-(airspeed_m_s + self.z_q), 0.0),
            ],
            [
                line(0.0, -self.m_u),
                line(-self.m_w_rate, -self.m_w),
                [0.0, -self.m_q, 1.0, 0.0, 0.0],
            ],
        ];
        let denominator = determinant(&rows);
        for (row, force) in rows.iter_mut().zip([self.x_elevator, self.z_elevator, self.m_elevator])
        {
            row[2] = line(0.0, force);
        }
        monic(&determinant(&rows), &denominator)
    }

    /// Pitch over elevator with the short period alone: speed held, the denominator begins with 1.
    ///
    /// $$ \frac{\theta}{\delta_e} = \frac{1}{s}
    ///    \frac{(M_{\delta_e} + M_{\dot w} Z_{\delta_e}) s + Z_{\delta_e} M_w - Z_w M_{\delta_e}}
    ///    {s^2 - (Z_w + M_q + u_0 M_{\dot w}) s + Z_w M_q - u_0 M_w} $$
    /// for $Z_{\dot w} = Z_q = 0$; otherwise from the same two equations with them.
    ///
    /// # Errors
    /// As [`DimensionalDerivatives::theta_over_elevator`].
    pub fn short_period(&self, airspeed_m_s: f64) -> Result<TransferFunction, AircraftError> {
        let along = line(1.0 - self.z_w_rate, -self.z_w);
        let across = line(-(airspeed_m_s + self.z_q), 0.0);
        let (pitch, turn) = (line(-self.m_w_rate, -self.m_w), [0.0, -self.m_q, 1.0, 0.0, 0.0]);
        let (z, m) = (line(0.0, self.z_elevator), line(0.0, self.m_elevator));
        let denominator = difference(&product(&along, &turn), &product(&across, &pitch));
        let numerator = difference(&product(&along, &m), &product(&z, &pitch));
        monic(&numerator, &denominator)
    }
}

/// A polynomial by rising powers of s.
type Powers = [f64; 5];

fn line(slope: f64, constant: f64) -> Powers {
    [constant, slope, 0.0, 0.0, 0.0]
}

/// Product whose degree the caller knows to be four at most.
fn product(left: &Powers, right: &Powers) -> Powers {
    core::array::from_fn(|power| {
        (0..=power).fold(0.0, |sum, index| sum + left[index] * right[power - index])
    })
}

fn difference(left: &Powers, right: &Powers) -> Powers {
    core::array::from_fn(|power| left[power] - right[power])
}

fn determinant(rows: &[[Powers; 3]; 3]) -> Powers {
    let minor = |first: usize, second: usize| {
        let down = product(&rows[1][first], &rows[2][second]);
        difference(&down, &product(&rows[1][second], &rows[2][first]))
    };
    let terms = [(0, minor(1, 2)), (1, minor(0, 2)), (2, minor(0, 1))];
    let [first, second, third] = terms.map(|(column, minor)| product(&rows[0][column], &minor));
    core::array::from_fn(|power| first[power] - second[power] + third[power])
}

/// Transfer function with leading zeros dropped and the denominator made to begin with 1.
fn monic(numerator: &Powers, denominator: &Powers) -> Result<TransferFunction, AircraftError> {
    let (numerator, denominator) = (falling(numerator), falling(denominator));
    let leading = denominator.first().copied().unwrap_or(f64::NAN);
    let scaled = |values: Vec<f64>| values.iter().map(|value| value / leading).collect::<Vec<_>>();
    Ok(TransferFunction::new(&scaled(numerator), &scaled(denominator))?)
}

fn falling(powers: &Powers) -> Vec<f64> {
    powers.iter().rev().copied().skip_while(|&value| value == 0.0).collect()
}
