//! The linear model of pitch over a whole range of masses, speeds, altitudes and derivatives: every entry between bounds.
//!
//! Straight flight with wings level has closed forms: the elevator follows from the moments, the thrust from the forces
//! along the flight path, and the angle of attack is the root of one equation, which Newton's method encloses in interval
//! arithmetic. The derivatives of the equations of motion are written out, not differenced. For aircraft of derivatives to
//! which nothing is added (no configurations, Mach rows, ground or engine of their own).

mod motion;

use fspid_numeric::scalar::{Base, Dual, Interval, Scalar};

use crate::aerodynamics::derivatives::{
    DragLaw, Geometry, Longitudinal, LongitudinalCoefficient, ThrustLaw,
};
use crate::atmosphere::{AirModel, Environment, SCALE_K_M, Stratum};
use crate::data::{DerivativeData, Laws, Moment};
use crate::trim::TrimTarget;
use crate::validity::Range;

pub use motion::{MOTION, MotionNumbers, MotionOver};

/// Rounding of the standard atmosphere's powers, as a share.
const AIR_ROUNDING: f64 = 1e-12;
/// Place of the airspeed in rows.
const SPEED: usize = 2;
/// Most steps of Newton's method.
const MOST_STEPS: usize = 40;

/// A straight flight of an aircraft of derivatives, every number between bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnclosedFlight<T> {
    /// Mass.
    pub mass_kg: T,
    /// How the moment of inertia in pitch is known.
    pub inertia: Moment<T>,
    /// How far the centre of gravity is behind that of the derivatives, in chords.
    pub aft_chords: T,
    /// True airspeed.
    pub airspeed_m_s: T,
    /// Geopotential altitude.
    pub altitude_m: T,
    /// Climb angle.
    pub flight_path_rad: T,
    /// Coefficients about the centre of gravity of the derivatives.
    pub longitudinal: Longitudinal<T>,
    geometry: Geometry,
    reference_airspeed_m_s: f64,
    alpha_rad: Interval,
    laws: Laws,
    environment: Environment,
}

/// The linear model of pitch: rates of θ, q, V and α by these and by the elevator (SI, elevator as the derivatives count it).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnclosedModel<T> {
    /// State matrix, row by row.
    pub by_states: [[T; 4]; 4],
    /// By elevator.
    pub by_elevator: [T; 4],
}

/// What holds a straight flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnclosedTrim<T> {
    /// Angle of attack from the reference's, rad.
    pub alpha_rad: T,
    /// Elevator, rad.
    pub elevator_rad: T,
    /// Thrust, N.
    pub thrust_n: T,
}

fn point<T: Scalar>(value: f64) -> T {
    T::constant(value)
}

/// Where a trim is looked for.
fn searched(alpha: Range) -> Interval {
    Interval::between(alpha.min.max(-0.8), alpha.max.min(0.8))
}

/// Every number of a row as it is.
fn fixed<T: Scalar>(row: LongitudinalCoefficient) -> LongitudinalCoefficient<T> {
    let LongitudinalCoefficient { reference, alpha, alpha_rate, pitch_rate, speed, elevator } = row;
    LongitudinalCoefficient {
        reference: point(reference),
        alpha: point(alpha),
        alpha_rate: point(alpha_rate),
        pitch_rate: point(pitch_rate),
        speed: point(speed),
        elevator: point(elevator),
    }
}

impl<T: Sought> EnclosedFlight<T> {
    /// The flight of an aircraft at a target, each number as it is.
    #[must_use]
    pub fn of(
        data: &DerivativeData,
        laws: Laws,
        environment: Environment,
        target: TrimTarget,
    ) -> Self {
        // About the derivatives' own centre of gravity, with the lift that carries the weight of the reference.
        let own = DerivativeData { loading: crate::data::Loading::default(), ..*data };
        let Longitudinal { lift, drag, pitch, thrust_speed } = own.force_model(laws).longitudinal;
        let inertia = match data.loading.pitch {
            Some(Moment::Gyration(radius_m)) => Moment::Gyration(point(radius_m)),
            Some(Moment::Inertia(value)) => Moment::Inertia(point(value)),
            None => Moment::Inertia(point(data.inertia.iy_kg_m2)),
        };
        let longitudinal = Longitudinal {
            lift: fixed(lift),
            drag: fixed(drag),
            pitch: fixed(pitch),
            thrust_speed: point(thrust_speed),
        };
        let alpha = data.validity.alpha_rad;
        Self {
            mass_kg: point(data.mass_kg()),
            inertia,
            aft_chords: point(data.cg_aft_chords()),
            airspeed_m_s: point(target.airspeed_m_s),
            altitude_m: point(target.altitude_m),
            flight_path_rad: point(target.flight_path_rad),
            longitudinal,
            geometry: data.geometry,
            reference_airspeed_m_s: data.reference.airspeed_m_s,
            alpha_rad: searched(alpha),
            laws,
            environment,
        }
    }

    /// Density of the air; none over altitudes in which the temperature's slope changes.
    fn density_kg_m3(&self) -> Option<T> {
        let altitude = self.altitude_m.bounds();
        let density = match self.environment.air {
            AirModel::Uniform(air) => T::constant(air.density_kg_m3),
            AirModel::Standard => {
                let layer = Stratum::over(altitude.lower(), altitude.upper())?;
                let above = self.altitude_m - T::constant(layer.base_m);
                let base = T::constant(layer.air.temperature_k);
                let scale = T::constant(SCALE_K_M);
                let ratio = if layer.lapse_k_m == 0.0 {
                    (-(scale * above) / base).exp()
                } else {
                    let lapse = T::constant(layer.lapse_k_m);
                    (T::one() + lapse * above / base).pow(-(scale / lapse) - T::one())
                };
                T::constant(layer.air.density_kg_m3) * ratio
            }
        };
        Some(density * T::enclosing(Interval::between(1.0 - AIR_ROUNDING, 1.0 + AIR_ROUNDING)))
    }

    /// Relative change of speed from the reference.
    fn relative_speed(&self) -> T {
        let reference = T::constant(self.reference_airspeed_m_s);
        (self.airspeed_m_s - reference) / reference
    }

    /// The coefficients about the centre of gravity that flies.
    fn coefficients(&self) -> Longitudinal<T> {
        self.longitudinal.moved(self.aft_chords)
    }

    /// $\bar q S$, N.
    fn scale_n(&self) -> Option<T> {
        let half = T::constant(0.5) * self.density_kg_m3()? * T::constant(self.geometry.area_m2);
        Some(half * self.airspeed_m_s.square())
    }

    /// Angle of attack, elevator and thrust of every straight flight within; none where they are not found, or not only
    /// one.
    ///
    /// With $\delta = -(C_{m_1} + C_{m_\alpha} \alpha + C_{m_u} \hat u) / C_{m_\delta}$ and
    /// $T \cos\alpha = \bar q S C_D + m g \sin\gamma$ the forces across the flight path leave
    ///
    /// $$ f(\alpha) = \bar q S C_L + (\bar q S C_D + m g \sin\gamma) \tan\alpha - m g \cos\gamma = 0 $$
    #[must_use]
    pub fn trim(&self) -> Option<EnclosedTrim<T>> {
        let Longitudinal { lift, drag, pitch, .. } = self.coefficients();
        let (scale, speed) = (self.scale_n()?, self.relative_speed());
        let weight = self.mass_kg * T::constant(self.environment.gravity_m_s2);
        let (along, across) =
            (weight * self.flight_path_rad.sin(), weight * self.flight_path_rad.cos());
        // What the elevator that balances the moments makes of lift and drag.
        let per_moment = |row: &LongitudinalCoefficient<T>| row.elevator / pitch.elevator;
        let still = pitch.reference + pitch.speed * speed;
        let balanced = |row: &LongitudinalCoefficient<T>| {
            let share = per_moment(row);
            [row.reference + row.speed * speed - share * still, row.alpha - share * pitch.alpha]
        };
        let [lift_at_0, lift_slope] = balanced(&lift);
        let [drag_at_0, drag_slope] = balanced(&drag);
        let bend = self.polar_bend();
        let drag_of = |alpha: T| drag_at_0 + drag_slope * alpha + bend * alpha.square();
        let value = |alpha: T| {
            let drag = scale * drag_of(alpha) + along;
            scale * (lift_at_0 + lift_slope * alpha) + drag * alpha.tan() - across
        };
        let slope = |alpha: T| {
            let drag = scale * drag_of(alpha) + along;
            let bent = drag_slope + T::constant(2.0) * bend * alpha;
            scale * lift_slope + scale * bent * alpha.tan() + drag / alpha.cos().square()
        };
        let alpha = root(self.alpha_rad, value, slope)?;
        let elevator = -(still + pitch.alpha * alpha) / pitch.elevator;
        let thrust = (scale * drag_of(alpha) + along) / alpha.cos();
        Some(EnclosedTrim { alpha_rad: alpha, elevator_rad: elevator, thrust_n: thrust })
    }

    /// k of the parabola of drag over the angle of attack beyond its tangent; 0 along the tangent.
    fn polar_bend(&self) -> T {
        match self.laws.drag {
            DragLaw::Linear => T::zero(),
            DragLaw::Polar => {
                let Longitudinal { lift, drag, .. } = self.longitudinal;
                T::constant(0.5) * drag.alpha / lift.reference * lift.alpha
            }
        }
    }

    /// Slope of the thrust over speed, N s/m, at a thrust.
    fn thrust_by_speed(&self, thrust_n: T) -> T {
        match self.laws.thrust {
            ThrustLaw::Constant => T::zero(),
            ThrustLaw::WithSpeed => {
                let Longitudinal { drag, thrust_speed, .. } = self.longitudinal;
                let coefficient = drag.reference + thrust_speed * self.relative_speed();
                let share = thrust_speed / T::constant(self.reference_airspeed_m_s) / coefficient;
                thrust_n * (T::constant(2.0) / self.airspeed_m_s + share)
            }
        }
    }

    /// The linear model around the trim of every flight within; none where there is no trim, or none is found.
    ///
    /// $$ m \dot V = -\bar q S C_D + T \cos\alpha - m g \sin(\theta - \alpha), \quad
    ///    m V (\dot\alpha - q) = -\bar q S C_L - T \sin\alpha + m g \cos(\theta - \alpha), \quad
    ///    I_y \dot q = \bar q S \bar c C_m $$
    ///
    /// differentiated at $\dot V = \dot\alpha = q = 0$.
    #[must_use]
    pub fn model(&self) -> Option<EnclosedModel<T>> {
        let (trim, scale) = (self.trim()?, self.scale_n()?);
        let Longitudinal { lift, drag, pitch, .. } = self.coefficients();
        let half_chord_s =
            T::constant(0.5) * T::constant(self.geometry.chord_m) / self.airspeed_m_s;
        let alpha_rate = self.alpha_rate_row(&trim, &lift, scale);
        // What a coefficient has of the angle of attack's rate, which follows from the other rows.
        let with_rate = |row: [T; 5], by_rate: T| -> [T; 5] {
            core::array::from_fn(|at| row[at] + half_chord_s * by_rate * alpha_rate[at])
        };
        let mut moments = self.slopes(&trim, &pitch, T::zero());
        // The moment is 0 at the trim, whatever the pressure.
        moments[SPEED] = pitch.speed / T::constant(self.reference_airspeed_m_s);
        let moments = with_rate(moments, pitch.alpha_rate);
        let drags = with_rate(self.slopes(&trim, &drag, self.polar_bend()), drag.alpha_rate);
        let per_inertia =
            scale * T::constant(self.geometry.chord_m) / self.inertia.of(self.mass_kg);
        let theta_rate = [T::zero(), T::one(), T::zero(), T::zero(), T::zero()];
        let rows = [
            theta_rate,
            moments.map(|it| per_inertia * it),
            self.speed_rate_row(&trim, drags, scale),
            alpha_rate,
        ];
        let bounded = rows.iter().flatten().all(|it| it.bounds().is_bounded());
        bounded.then(|| EnclosedModel {
            by_states: rows.map(|[theta, q, speed, alpha, _]| [theta, q, speed, alpha]),
            by_elevator: rows.map(|row| row[4]),
        })
    }

    /// A coefficient times the share of the dynamic pressure by θ, q, V, α and elevator, without the angle of attack's rate.
    fn slopes(&self, trim: &EnclosedTrim<T>, row: &LongitudinalCoefficient<T>, bend: T) -> [T; 5] {
        let alpha = trim.alpha_rad;
        let at_trim = row.reference
            + row.alpha * alpha
            + row.speed * self.relative_speed()
            + row.elevator * trim.elevator_rad
            + bend * alpha.square();
        let pressure = T::constant(2.0) / self.airspeed_m_s;
        [
            T::zero(),
            T::constant(0.5) * T::constant(self.geometry.chord_m) / self.airspeed_m_s
                * row.pitch_rate,
            row.speed / T::constant(self.reference_airspeed_m_s) + pressure * at_trim,
            row.alpha + T::constant(2.0) * bend * alpha,
            row.elevator,
        ]
    }

    /// Rate of the angle of attack by θ, q, V, α and elevator.
    ///
    /// $(\bar q S C_L + T \sin\alpha) / (m V)$ holds the weight at the trim, $(g / V) \cos\gamma$: what both lose with 1/V
    /// cancels.
    fn alpha_rate_row(
        &self,
        trim: &EnclosedTrim<T>,
        lift: &LongitudinalCoefficient<T>,
        scale: T,
    ) -> [T; 5] {
        let (sin, cos) = (trim.alpha_rad.sin(), trim.alpha_rad.cos());
        let momentum = self.mass_kg * self.airspeed_m_s;
        let across = scale / momentum;
        let gravity = T::constant(self.environment.gravity_m_s2);
        let turning = gravity / self.airspeed_m_s * self.flight_path_rad.sin();
        let own = [
            -turning,
            T::one(),
            -(self.thrust_by_speed(trim.thrust_n) * sin / momentum),
            turning - trim.thrust_n * cos / momentum,
            T::zero(),
        ];
        let lifts = self.slopes(trim, lift, T::zero());
        let half_chord_s =
            T::constant(0.5) * T::constant(self.geometry.chord_m) / self.airspeed_m_s;
        let rest = T::one() + across * half_chord_s * lift.alpha_rate;
        core::array::from_fn(|at| (own[at] - across * lifts[at]) / rest)
    }

    /// Rate of the airspeed by θ, q, V, α and elevator, with what the drag has of each.
    fn speed_rate_row(&self, trim: &EnclosedTrim<T>, drags: [T; 5], scale: T) -> [T; 5] {
        let (sin, cos) = (trim.alpha_rad.sin(), trim.alpha_rad.cos());
        let falling = T::constant(self.environment.gravity_m_s2) * self.flight_path_rad.cos();
        let own = [
            -falling,
            T::zero(),
            self.thrust_by_speed(trim.thrust_n) * cos / self.mass_kg,
            falling - trim.thrust_n * sin / self.mass_kg,
            T::zero(),
        ];
        let per_mass = scale / self.mass_kg;
        core::array::from_fn(|at| own[at] - per_mass * drags[at])
    }
}

/// Numbers of which bounds are known, so that a root can be enclosed.
pub trait Sought: Scalar {
    /// Everything within, without slopes.
    fn enclosing(value: Interval) -> Self;
    /// What the value lies between.
    fn bounds(&self) -> Interval;
    /// A root with the slopes that it has where `residual` is what the function is there, its slopes by all but the root
    /// among it, and `slope` that by the root: $x' = -\partial_p f / \partial_x f$.
    fn at_root(root: Interval, residual: Self, slope: Interval) -> Self;
}

impl Sought for Interval {
    fn enclosing(value: Interval) -> Self {
        value
    }

    fn bounds(&self) -> Interval {
        *self
    }

    fn at_root(root: Interval, _: Self, _: Interval) -> Self {
        root
    }
}

impl<const N: usize> Sought for Dual<Interval, N> {
    fn enclosing(value: Interval) -> Self {
        Self::fixed(value)
    }

    fn bounds(&self) -> Interval {
        self.value
    }

    fn at_root(root: Interval, residual: Self, slope: Interval) -> Self {
        let derivative = residual.derivative.map(|by| (-by).scaled(Interval::ONE / slope));
        Self { value: root, derivative }
    }
}

/// The only root of a function within, by Newton's method: $N(X) = m - f(m) / f'(X)$.
fn root<T: Sought>(within: Interval, value: impl Fn(T) -> T, slope: impl Fn(T) -> T) -> Option<T> {
    let (mut root, mut exists) = (within, false);
    for _ in 0..MOST_STEPS {
        let slopes = slope(T::enclosing(root)).bounds();
        if slopes.contains(0.0) || !slopes.is_bounded() {
            return None;
        }
        let middle = Interval::point(root.midpoint());
        let next = middle - value(T::enclosing(middle)).bounds() / slopes;
        exists |= root.encloses(next);
        let narrowed = next.intersection(root)?;
        if narrowed == root {
            break;
        }
        root = narrowed;
    }
    let there = T::enclosing(root);
    exists.then(|| T::at_root(root, value(there), slope(there).bounds()))
}
