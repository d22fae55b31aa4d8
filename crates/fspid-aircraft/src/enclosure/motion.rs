//! The nonlinear motion in pitch around a trim: its derivatives at the trim, and how they bend over a box around it.
//!
//! The equations are those that fly, of straight flight with the wings level in still air of one density, asked with
//! intervals. For aircraft of derivatives to which nothing is added.

use fspid_numeric::scalar::{Dual, Interval, Scalar};

use super::{EnclosedFlight, EnclosedTrim, Sought};
use crate::aerodynamics::derivatives::{
    DragLaw, Geometry, Longitudinal, LongitudinalCoefficient, ThrustLaw,
};
use crate::atmosphere::{Air, Environment};
use crate::data::{DerivativeData, Laws, Loading, Moment};
use crate::trim::TrimTarget;
use crate::validity::{Range, Validity};

/// What the motion depends on: θ, q, V, α and the elevator as the derivatives count it, all from the trim.
pub const MOTION: usize = 5;
/// The speed of sound enters no force here.
const ANY_SPEED_OF_SOUND_M_S: f64 = 340.0;

/// A number with its slopes, and with three derivatives.
type Bent = Dual<Interval, MOTION>;
type Twice = Dual<Dual<Bent, MOTION>, MOTION>;

/// The numbers that the motion in pitch is made of, SI and rad, as floats: complete in themselves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionNumbers {
    /// Mass.
    pub mass_kg: f64,
    /// Moment of inertia in pitch.
    pub iy_kg_m2: f64,
    /// How far the centre of gravity is behind that of the derivatives, in chords.
    pub aft_chords: f64,
    /// True airspeed of the trim.
    pub airspeed_m_s: f64,
    /// Climb angle of the trim.
    pub flight_path_rad: f64,
    /// Density of the air at the trim.
    pub density_kg_m3: f64,
    /// How far above and below the trim the air is enclosed, m.
    pub height_m: f64,
    /// Densities of the air at those heights; that of the trim alone where `height_m` is 0.
    pub densities_kg_m3: Range,
    /// Gravity.
    pub gravity_m_s2: f64,
    /// Wing area.
    pub area_m2: f64,
    /// Mean chord.
    pub chord_m: f64,
    /// Airspeed to which the derivatives belong.
    pub reference_airspeed_m_s: f64,
    /// Coefficients about the centre of gravity of the derivatives.
    pub longitudinal: Longitudinal,
    /// Drag and thrust away from the reference.
    pub laws: Laws,
    /// Angles of attack for which the derivatives are worth something.
    pub alpha_rad: Range,
    /// Airspeeds for which they are, Mach numbers among it.
    pub airspeeds_m_s: Range,
    /// Stops of the elevator.
    pub elevator_rad: Range,
}

/// The motion over a box around a trim.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionOver {
    /// What holds the trim.
    pub trim: EnclosedTrim<Interval>,
    /// Rates of θ, q, V, α by [`MOTION`] numbers at the trim.
    pub slopes: [[Interval; MOTION]; 4],
    /// How each slope changes with each number, over the whole box and all densities: second derivatives.
    pub bends: [[[Interval; MOTION]; MOTION]; 4],
    /// What the largest change of the density does to each slope at the trim, over all densities.
    pub slopes_by_density: [[Interval; MOTION]; 4],
    /// What it does to the rates at the trim, likewise: air of another density has another trim.
    pub rates_by_density: [Interval; 4],
}

impl MotionNumbers {
    /// Those of an aircraft at a target, in the air up to `height_m` above and below it; without a height the air has
    /// everywhere the density that it has there.
    #[must_use]
    pub fn of(
        data: &DerivativeData,
        laws: Laws,
        (environment, height_m): (Environment, f64),
        target: TrimTarget,
    ) -> Self {
        let own = DerivativeData { loading: Loading::default(), ..*data };
        let Geometry { area_m2, chord_m, span_m: _ } = data.geometry;
        let Validity { airspeed_m_s, mach, alpha_rad, .. } = data.validity;
        let air = environment.air_at(target.altitude_m);
        let ends = [-height_m, 0.0, height_m].map(|by| environment.air_at(target.altitude_m + by));
        let most = |of: fn(&Air) -> f64| ends.iter().map(of).fold(f64::NAN, f64::max);
        let least = |of: fn(&Air) -> f64| ends.iter().map(of).fold(f64::NAN, f64::min);
        let (sound, density) = (|it: &Air| it.speed_of_sound_m_s, |it: &Air| it.density_kg_m3);
        Self {
            mass_kg: data.mass_kg(),
            iy_kg_m2: data.mass_properties().iy_kg_m2,
            aft_chords: data.cg_aft_chords(),
            airspeed_m_s: target.airspeed_m_s,
            flight_path_rad: target.flight_path_rad,
            density_kg_m3: air.density_kg_m3,
            height_m,
            densities_kg_m3: Range { min: least(density), max: most(density) },
            gravity_m_s2: environment.gravity_m_s2,
            area_m2,
            chord_m,
            reference_airspeed_m_s: data.reference.airspeed_m_s,
            longitudinal: own.force_model(laws).longitudinal,
            laws,
            alpha_rad,
            airspeeds_m_s: Range {
                min: airspeed_m_s.min.max(mach.min * most(sound)),
                max: airspeed_m_s.max.min(mach.max * least(sound)),
            },
            elevator_rad: data.travel.elevator_rad,
        }
    }

    /// The straight flight of the trim.
    fn flight(&self) -> EnclosedFlight<Interval> {
        let point = Interval::point;
        let lifted = |row: LongitudinalCoefficient| super::fixed::<Interval>(row);
        let Longitudinal { lift, drag, pitch, thrust_speed } = self.longitudinal;
        EnclosedFlight {
            mass_kg: point(self.mass_kg),
            inertia: Moment::Inertia(point(self.iy_kg_m2)),
            aft_chords: point(self.aft_chords),
            airspeed_m_s: point(self.airspeed_m_s),
            altitude_m: Interval::ZERO,
            flight_path_rad: point(self.flight_path_rad),
            longitudinal: Longitudinal {
                lift: lifted(lift),
                drag: lifted(drag),
                pitch: lifted(pitch),
                thrust_speed: point(thrust_speed),
            },
            // No span enters the motion in pitch.
            geometry: Geometry { area_m2: self.area_m2, span_m: 1.0, chord_m: self.chord_m },
            reference_airspeed_m_s: self.reference_airspeed_m_s,
            alpha_rad: super::searched(self.alpha_rad),
            laws: self.laws,
            environment: Environment::uniform(
                self.gravity_m_s2,
                self.density_kg_m3,
                ANY_SPEED_OF_SOUND_M_S,
            ),
        }
    }

    /// Angle of attack, elevator and thrust of the trim; none where it is not found, or not only one.
    #[must_use]
    pub fn trim(&self) -> Option<EnclosedTrim<Interval>> {
        self.flight().trim()
    }

    /// θ, q, V, α and elevator of a trim.
    #[must_use]
    pub fn at_trim(&self, trim: &EnclosedTrim<Interval>) -> [Interval; MOTION] {
        let point = Interval::point;
        let pitch = point(self.flight_path_rad) + trim.alpha_rad;
        [pitch, Interval::ZERO, point(self.airspeed_m_s), trim.alpha_rad, trim.elevator_rad]
    }

    /// Rates of θ, q, V, α at θ, q, V, α and elevator, all in whole and not from the trim, with the thrust of the trim's
    /// throttle.
    ///
    /// $$ \dot\theta = q, \quad I_y \dot q = \bar q S \bar c C_m, \quad
    ///    m \dot V = T \cos\alpha - \bar q S C_D - m g \sin(\theta - \alpha), \quad
    ///    m V (\dot\alpha - q) = -\bar q S C_L - T \sin\alpha + m g \cos(\theta - \alpha) $$
    ///
    /// # Source
    /// As [`DerivativeModel`](crate::aerodynamics::derivatives::DerivativeModel), whose rates they are; tests compare them.
    pub fn rates<T: Scalar>(&self, trim_thrust_n: T, at: [T; MOTION]) -> [T; 4] {
        self.rates_in(T::constant(self.density_kg_m3), trim_thrust_n, at)
    }

    /// The [`rates`](Self::rates) in air of another density than that of the trim; thrust that goes with the dynamic
    /// pressure goes with it.
    pub fn rates_in<T: Scalar>(&self, density: T, trim_thrust_n: T, at: [T; MOTION]) -> [T; 4] {
        let number = T::constant;
        let [theta, q, speed, alpha, elevator] = at;
        let Longitudinal { lift, drag, pitch, .. } = self.coefficients::<T>();
        let pressure_n = number(0.5) * density * number(self.area_m2) * speed.square();
        let half_chord_s = number(0.5) * number(self.chord_m) / speed;
        let change = self.relative(speed);
        let steady = |row: &LongitudinalCoefficient<T>| {
            row.reference
                + row.alpha * alpha
                + row.pitch_rate * (half_chord_s * q)
                + row.speed * change
                + row.elevator * elevator
        };
        let (mass, gravity) = (number(self.mass_kg), number(self.gravity_m_s2));
        let thrust_n = trim_thrust_n * self.thrust_share(density, speed);
        let (sine, cosine) = ((theta - alpha).sin(), (theta - alpha).cos());
        let across_n =
            mass * gravity * cosine - pressure_n * steady(&lift) - thrust_n * alpha.sin();
        let carried = mass * speed + pressure_n * half_chord_s * lift.alpha_rate;
        let alpha_rate = (across_n + mass * speed * q) / carried;
        let with_rate = |row: &LongitudinalCoefficient<T>| {
            steady(row) + half_chord_s * row.alpha_rate * alpha_rate
        };
        let drag = with_rate(&drag) + self.polar_bend::<T>() * alpha.square();
        let along = (thrust_n * alpha.cos() - pressure_n * drag) / mass - gravity * sine;
        let turning = pressure_n * number(self.chord_m) * with_rate(&pitch) / number(self.iy_kg_m2);
        [q, turning, along, alpha_rate]
    }

    /// Coefficients about the centre of gravity that flies.
    fn coefficients<T: Scalar>(&self) -> Longitudinal<T> {
        let Longitudinal { lift, drag, pitch, thrust_speed } = self.longitudinal;
        let whole = Longitudinal {
            lift: super::fixed::<T>(lift),
            drag: super::fixed::<T>(drag),
            pitch: super::fixed::<T>(pitch),
            thrust_speed: T::constant(thrust_speed),
        };
        whole.moved(T::constant(self.aft_chords))
    }

    fn relative<T: Scalar>(&self, speed: T) -> T {
        let reference = T::constant(self.reference_airspeed_m_s);
        (speed - reference) / reference
    }

    /// Thrust over that of the trim, at the same throttle.
    fn thrust_share<T: Scalar>(&self, density: T, speed: T) -> T {
        match self.laws.thrust {
            ThrustLaw::Constant => T::one(),
            ThrustLaw::WithSpeed => {
                let coefficient = |speed: T| {
                    T::constant(self.longitudinal.drag.reference)
                        + T::constant(self.longitudinal.thrust_speed) * self.relative(speed)
                };
                let trim = T::constant(self.airspeed_m_s);
                let pressure = density / T::constant(self.density_kg_m3) * (speed / trim).square();
                pressure * (coefficient(speed) / coefficient(trim))
            }
        }
    }

    fn polar_bend<T: Scalar>(&self) -> T {
        match self.laws.drag {
            DragLaw::Linear => T::zero(),
            DragLaw::Polar => {
                let Longitudinal { lift, drag, .. } = self.longitudinal;
                let per_lift = T::constant(drag.alpha) / T::constant(lift.reference);
                T::half() * per_lift * T::constant(lift.alpha)
            }
        }
    }

    /// The motion up to so far from the trim, either way; none without a trim, or where something has no bounds.
    ///
    /// With $p$ the way from the trim and $H_i$ the bends over the box, every mean of the slopes along a straight line from
    /// the trim to a point of the box lies in
    ///
    /// $$ \bar J \in J(0) + \tfrac{1}{2} \sum_i p_i H_i $$
    #[must_use]
    pub fn over(&self, reach: [f64; MOTION]) -> Option<MotionOver> {
        let trim = self.trim()?;
        let centre = self.at_trim(&trim);
        let slopes = self.slopes(&trim, centre);
        let around: [Interval; MOTION] =
            core::array::from_fn(|i| centre[i] + Interval::between(-reach[i], reach[i]));
        // By the mean value theorem from the bends at the trim, which is closer than to ask the box for them.
        let [at_trim, over] = [centre, around].map(|at| self.third(&trim, at));
        let bends = core::array::from_fn(|row| {
            let (here, there) = (&at_trim[row], &over[row]);
            core::array::from_fn(|i| {
                core::array::from_fn(|j| {
                    let way = |k: usize| Interval::between(-reach[k], reach[k]);
                    let by: Bent = there.derivative[i].derivative[j];
                    let along = (0..MOTION).map(|k| by.derivative[k] * way(k));
                    let near = here.derivative[i].derivative[j].value;
                    let near = along.fold(near, |sum, it| sum + it);
                    near.intersection(by.value).unwrap_or(by.value)
                })
            })
        });
        let (slopes_by_density, rates_by_density) = self.by_density(&trim, centre)?;
        let motion = MotionOver { trim, slopes, bends, slopes_by_density, rates_by_density };
        motion.is_bounded().then_some(motion)
    }

    /// The rates with their first three derivatives, enclosed wherever `at` is.
    fn third(&self, trim: &EnclosedTrim<Interval>, at: [Interval; MOTION]) -> [Twice; 4] {
        let first = Bent::variables(at);
        let second = Dual::<Bent, MOTION>::variables(first);
        let fixed = |it: Interval| Dual::fixed(Dual::fixed(Dual::fixed(it)));
        let density = fixed(self.densities());
        self.rates_in(density, fixed(trim.thrust_n), Twice::variables(second))
    }

    /// All densities, that of the trim among them.
    fn densities(&self) -> Interval {
        let Range { min, max } = self.densities_kg_m3;
        let trim = self.density_kg_m3;
        Interval::between(min.min(trim), max.max(trim))
    }

    /// What the largest change of the density does to slopes and rates at the trim, with the slopes over all densities:
    ///
    /// $$ J(\rho) - J(\rho_0) \in [-1, 1] \ \Delta \rho \ \partial_\rho J, \qquad
    ///    f(\rho) - f(\rho_0) \in [-1, 1] \ \Delta \rho \ \partial_\rho f $$
    fn by_density(
        &self,
        trim: &EnclosedTrim<Interval>,
        centre: [Interval; MOTION],
    ) -> Option<([[Interval; MOTION]; 4], [Interval; 4])> {
        let densities = self.densities();
        // Written so that NaN has no bounds.
        if !(densities.is_bounded() && densities.lower() > 0.0) {
            return None;
        }
        let most = (densities - Interval::point(self.density_kg_m3)).magnitude();
        let by = |it: Interval| Interval::point(most) * it;
        let [density] = Dual::<Interval, 1>::variables([densities]);
        let at = Dual::<Dual<Interval, 1>, MOTION>::variables(centre.map(Dual::fixed));
        let thrust = Dual::fixed(Dual::fixed(trim.thrust_n));
        let rates = self.rates_in(Dual::fixed(density), thrust, at);
        let slopes = rates.map(|row| row.derivative.map(|slope| by(slope.derivative[0])));
        Some((slopes, rates.map(|row| by(row.value.derivative[0]))))
    }

    /// Slopes of the rates, enclosed wherever `at` is.
    #[must_use]
    pub fn slopes(
        &self,
        trim: &EnclosedTrim<Interval>,
        at: [Interval; MOTION],
    ) -> [[Interval; MOTION]; 4] {
        let at = Dual::<Interval, MOTION>::variables(at);
        self.rates(Dual::enclosing(trim.thrust_n), at).map(|row| row.derivative)
    }
}

impl MotionOver {
    fn is_bounded(&self) -> bool {
        let slopes = self.slopes.iter().flatten();
        let bends = self.bends.iter().flatten().flatten();
        let more = self.slopes_by_density.iter().flatten().chain(&self.rates_by_density);
        slopes.chain(bends).chain(more).all(|it| it.is_bounded())
    }
}
