//! How an aircraft is loaded: mass, centre of gravity and inertia of a flight, apart from those of its source.

use fspid_numeric::Scalar;

use super::{DerivativeData, Inertia};
use crate::aerodynamics::derivatives::{
    Geometry, Lateral, LateralCoefficient, Longitudinal, LongitudinalCoefficient,
};
use crate::error::AircraftError;
use crate::mass::MassProperties;

/// What is loaded otherwise than in the data; what is left out is theirs.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Loading {
    /// Mass.
    pub mass_kg: Option<f64>,
    /// Centre of gravity behind the leading edge of the mean chord, as a share of that chord.
    pub cg_mac: Option<f64>,
    /// About the forward axis of the fuselage.
    pub roll: Option<Moment>,
    /// About the right axis.
    pub pitch: Option<Moment>,
    /// About the downward axis of the fuselage.
    pub yaw: Option<Moment>,
    /// Product of inertia in fuselage axes.
    pub ixz_kg_m2: Option<f64>,
}

/// A moment of inertia, in one of two ways.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Moment<T = f64> {
    /// Itself, kg m².
    Inertia(T),
    /// By the radius of gyration k, m: $I = m k^2$ with the mass that flies.
    Gyration(T),
}

impl<T: Scalar> Moment<T> {
    /// The moment of inertia of a mass, kg m².
    pub(crate) fn of(self, mass_kg: T) -> T {
        match self {
            Self::Inertia(value_kg_m2) => value_kg_m2,
            Self::Gyration(radius_m) => mass_kg * radius_m * radius_m,
        }
    }
}

impl Loading {
    /// True where everything is as in the data.
    #[must_use]
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// The inertia of a mass; what is not loaded otherwise is that of the data, whatever the mass.
    fn inertia(&self, data: &Inertia, mass_kg: f64) -> Inertia {
        let moment = |loaded: Option<Moment>, known| loaded.map_or(known, |it| it.of(mass_kg));
        Inertia {
            ix_kg_m2: moment(self.roll, data.ix_kg_m2),
            iy_kg_m2: moment(self.pitch, data.iy_kg_m2),
            iz_kg_m2: moment(self.yaw, data.iz_kg_m2),
            ixz_kg_m2: self.ixz_kg_m2.unwrap_or(data.ixz_kg_m2),
        }
    }

    /// Mass properties with this loading, in the axes in which the properties are.
    #[must_use]
    pub fn applied(&self, mass: MassProperties) -> MassProperties {
        let MassProperties { ix_kg_m2, iy_kg_m2, iz_kg_m2, ixz_kg_m2, .. } = mass;
        let mass_kg = self.mass_kg.unwrap_or(mass.mass_kg);
        let data = Inertia { ix_kg_m2, iy_kg_m2, iz_kg_m2, ixz_kg_m2 };
        let Inertia { ix_kg_m2, iy_kg_m2, iz_kg_m2, ixz_kg_m2 } = self.inertia(&data, mass_kg);
        MassProperties { mass_kg, ix_kg_m2, iy_kg_m2, iz_kg_m2, ixz_kg_m2, ..mass }
    }
}

impl DerivativeData {
    /// The aircraft with another loading. The flight condition of the data, and with it the wing, stays.
    ///
    /// # Errors
    /// [`AircraftError::NoReferenceCg`] for a centre of gravity where the data do not say to which one the derivatives
    /// belong.
    pub fn loaded(self, loading: Loading) -> Result<Self, AircraftError> {
        if loading.cg_mac.is_some() && self.reference.cg_mac.is_none() {
            return Err(AircraftError::NoReferenceCg);
        }
        Ok(Self { loading, ..self })
    }

    /// How far the centre of gravity is behind that of the derivatives, in chords.
    #[must_use]
    pub fn cg_aft_chords(&self) -> f64 {
        match (self.loading.cg_mac, self.reference.cg_mac) {
            (Some(loaded), Some(reference)) => loaded - reference,
            _ => 0.0,
        }
    }
}

impl<T: Scalar> Longitudinal<T> {
    /// The derivatives about a centre of gravity that many chords further aft.
    ///
    /// With the centre of gravity $\Delta$ chords aft, the old place is that far ahead of it: lift there turns the nose
    /// up, and pitching moves it down through the air by $2 \Delta \hat q$ of angle of attack,
    /// $\hat q = q \bar c / 2 V$.
    ///
    /// $$ C_{L_q}' = C_{L_q} - 2 \Delta C_{L_\alpha}, \quad C_{D_q}' = C_{D_q} - 2 \Delta C_{D_\alpha}, \quad
    ///    C_{m_q}' = C_{m_q} + \Delta (C_{L_q} - 2 C_{m_\alpha}) - 2 \Delta^2 C_{L_\alpha} $$
    /// $$ C_{m_i}' = C_{m_i} + \Delta C_{L_i}, \qquad i = 1, \alpha, \dot\alpha, u, \delta_e $$
    ///
    /// As in the books, lift stands for the force across the chord (drag adds some $C_D / C_{L_\alpha}$, a hundredth), the
    /// place moves along the forward axis of the reference flight, and the angle of attack's rate is the same at both
    /// places.
    ///
    /// # Source
    /// B. Etkin and L. D. Reid, Dynamics of Flight, 3rd edition, chapter 2 and appendix on the transfer of derivatives;
    /// R. C. Nelson, Flight Stability and Automatic Control, 2nd edition, chapter 2 ($C_{m_\alpha} = C_{L_\alpha}(h - h_n)$);
    /// J. Roskam, Airplane Flight Dynamics and Automatic Flight Controls, Part I, chapter 3. Derived anew from the
    /// geometry, and checked against it in the tests.
    #[must_use]
    pub fn moved(&self, aft_chords: T) -> Self {
        let Self { lift, drag, pitch, thrust_speed } = *self;
        // α where the derivatives belong is α less this much times q̂.
        let lag = T::constant(2.0) * aft_chords;
        let turned = LongitudinalCoefficient {
            reference: pitch.reference + aft_chords * lift.reference,
            alpha: pitch.alpha + aft_chords * lift.alpha,
            alpha_rate: pitch.alpha_rate + aft_chords * lift.alpha_rate,
            pitch_rate: pitch.pitch_rate + aft_chords * lift.pitch_rate,
            speed: pitch.speed + aft_chords * lift.speed,
            elevator: pitch.elevator + aft_chords * lift.elevator,
        };
        let lagging = |row: LongitudinalCoefficient<T>| LongitudinalCoefficient {
            pitch_rate: row.pitch_rate - lag * row.alpha,
            ..row
        };
        Self { lift: lagging(lift), drag: lagging(drag), pitch: lagging(turned), thrust_speed }
    }
}

impl Lateral {
    /// The derivatives about a centre of gravity that many chords further aft, as [`Longitudinal::moved`]: side force
    /// ahead turns the nose right, and yawing adds $2 \Delta_b \hat r$ of sideslip there, with $\Delta_b$ in spans.
    ///
    /// $$ C_{n_i}' = C_{n_i} + \Delta_b C_{Y_i}, \qquad C_{i_r}' = C_{i_r} + 2 \Delta_b C_{i_\beta} $$
    #[must_use]
    pub fn moved(&self, aft_chords: f64, geometry: &Geometry) -> Self {
        let aft_spans = aft_chords * geometry.chord_m / geometry.span_m;
        let Self { side, roll, yaw } = *self;
        let turned = LateralCoefficient {
            beta: yaw.beta + aft_spans * side.beta,
            roll_rate: yaw.roll_rate + aft_spans * side.roll_rate,
            yaw_rate: yaw.yaw_rate + aft_spans * side.yaw_rate,
            aileron: yaw.aileron + aft_spans * side.aileron,
            rudder: yaw.rudder + aft_spans * side.rudder,
        };
        let leading = |row: LateralCoefficient| LateralCoefficient {
            yaw_rate: row.yaw_rate + 2.0 * aft_spans * row.beta,
            ..row
        };
        Self { side: leading(side), roll: leading(roll), yaw: leading(turned) }
    }
}
