//! Aircraft from derivatives side by side: every number of theirs stands in an array of lanes, so that a loop over lanes
//! becomes vectors.
//!
//! The equations are those of a single aircraft: each loop asks the functions of [`Aircraft`], [`Flow`] and the rest for one
//! lane. Elementary functions alone are the [`fspid_numeric::straight`] ones, and those of `libm` in lanes where they
//! are not. So every lane has the bits of the aircraft that flies alone; the tests compare them.
//!
//! Which vectors a machine has is the caller's business: all of this is inlined into what it compiles for them.

#![allow(
    clippy::needless_range_loop,
    reason = "a lane is a place in many arrays at once, and such loops become vectors"
)]

use fspid_numeric::straight;

use crate::aerodynamics::derivatives::{
    DerivativeModel, DragLaw, Geometry, Lateral, LateralCoefficient, Longitudinal,
    LongitudinalCoefficient, ThrustLaw,
};
use crate::aircraft::Aircraft;
use crate::atmosphere::{Air, Environment};
use crate::controls::{CONTROLS, Controls};
use crate::flow::{AirMotion, Flow, ahead_m_s};
use crate::mass::MassProperties;
use crate::quaternion::EulerAngles;
use crate::rigid_body::{RIGID_STATES, RigidState};
use crate::validity::{Travel, Validity};
use crate::vector::Vector3;

/// Aircraft side by side: as many as the widest vectors have lanes.
pub const LANES: usize = 8;

/// One number of each aircraft.
pub type Lanes = [f64; LANES];
/// Three numbers of each aircraft.
pub type Lanes3 = [Lanes; 3];

/// Bodies and their forces, one a lane.
#[derive(Clone, Debug)]
pub struct Abreast {
    environments: [Environment; LANES],
    gravity_m_s2: Lanes,
    mass: [Lanes; 6],
    forces: Coefficients,
}

/// A body, where it flies, and its forces.
pub type Member<'a> = (&'a MassProperties, &'a Environment, &'a DerivativeModel);

/// Why an aircraft cannot fly beside the first one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OtherLaws;

/// What the air does around each aircraft.
#[derive(Clone, Copy, Debug, Default)]
pub struct Airs {
    /// Velocity of the wind: north, east, down.
    pub wind_ned_m_s: Lanes3,
    /// Velocity of the gust in body axes.
    pub gust_body_m_s: Lanes3,
    /// Rotation of the gust in body axes.
    pub gust_rates_rad_s: Lanes3,
}

impl Airs {
    /// Puts the air of one aircraft into its lane.
    #[inline]
    pub fn put(&mut self, lane: usize, motion: &AirMotion) {
        put(&mut self.wind_ned_m_s, lane, motion.wind_ned_m_s);
        put(&mut self.gust_body_m_s, lane, motion.gust_body_m_s);
        put(&mut self.gust_rates_rad_s, lane, motion.gust_rates_rad_s);
    }

    #[inline(always)]
    fn at(&self, lane: usize) -> AirMotion {
        AirMotion {
            wind_ned_m_s: at(&self.wind_ned_m_s, lane),
            gust_body_m_s: at(&self.gust_body_m_s, lane),
            gust_rates_rad_s: at(&self.gust_rates_rad_s, lane),
        }
    }
}

/// The flow around each aircraft.
#[derive(Clone, Copy, Debug, Default)]
pub struct Flows {
    velocity_body_m_s: Lanes3,
    rates_rad_s: Lanes3,
    airspeed_m_s: Lanes,
    alpha_rad: Lanes,
    sin_alpha: Lanes,
    cos_alpha: Lanes,
    beta_rad: Lanes,
    altitude_m: Lanes,
    temperature_k: Lanes,
    pressure_pa: Lanes,
    density_kg_m3: Lanes,
    speed_of_sound_m_s: Lanes,
}

impl Flows {
    /// Puts the flow around one aircraft into its lane.
    #[inline]
    pub fn put(&mut self, lane: usize, flow: &Flow) {
        put(&mut self.velocity_body_m_s, lane, flow.velocity_body_m_s);
        put(&mut self.rates_rad_s, lane, flow.rates_rad_s);
        self.airspeed_m_s[lane] = flow.airspeed_m_s;
        self.alpha_rad[lane] = flow.alpha_rad;
        (self.sin_alpha[lane], self.cos_alpha[lane]) = flow.alpha_sin_cos;
        self.beta_rad[lane] = flow.beta_rad;
        self.altitude_m[lane] = flow.altitude_m;
        self.temperature_k[lane] = flow.air.temperature_k;
        self.pressure_pa[lane] = flow.air.pressure_pa;
        self.density_kg_m3[lane] = flow.air.density_kg_m3;
        self.speed_of_sound_m_s[lane] = flow.air.speed_of_sound_m_s;
    }

    /// The flow around one aircraft.
    #[inline(always)]
    #[must_use]
    pub fn at(&self, lane: usize) -> Flow {
        Flow {
            velocity_body_m_s: at(&self.velocity_body_m_s, lane),
            rates_rad_s: at(&self.rates_rad_s, lane),
            airspeed_m_s: self.airspeed_m_s[lane],
            alpha_rad: self.alpha_rad[lane],
            alpha_sin_cos: (self.sin_alpha[lane], self.cos_alpha[lane]),
            beta_rad: self.beta_rad[lane],
            altitude_m: self.altitude_m[lane],
            air: Air {
                temperature_k: self.temperature_k[lane],
                pressure_pa: self.pressure_pa[lane],
                density_kg_m3: self.density_kg_m3[lane],
                speed_of_sound_m_s: self.speed_of_sound_m_s[lane],
            },
        }
    }

    /// True airspeeds, m/s.
    #[must_use]
    pub fn airspeed_m_s(&self) -> &Lanes {
        &self.airspeed_m_s
    }
}

/// Forces and accelerations of each aircraft, as far as a sample of a flight shows them.
#[derive(Clone, Copy, Debug, Default)]
pub struct Felt {
    /// Force of air and engine in body axes.
    pub force_n: Lanes3,
    /// Rates of change of the velocity's components.
    pub velocity_rate_body_m_s2: Lanes3,
}

/// Bank, pitch and heading of each aircraft, rad.
pub type Angles = Lanes3;

#[inline]
fn put(lanes: &mut Lanes3, lane: usize, vector: Vector3) {
    for (lanes, value) in lanes.iter_mut().zip(vector.to_array()) {
        lanes[lane] = value;
    }
}

#[inline(always)]
fn at(lanes: &Lanes3, lane: usize) -> Vector3 {
    Vector3::new(lanes[0][lane], lanes[1][lane], lanes[2][lane])
}

#[inline(always)]
fn state_at(states: &[Lanes; RIGID_STATES], lane: usize) -> RigidState {
    let mut values = [0.0; RIGID_STATES];
    for (value, lanes) in values.iter_mut().zip(states) {
        *value = lanes[lane];
    }
    RigidState::from_array(&values)
}

impl Felt {
    /// Force, N, and rates of change of the velocity's components, m/s², of one aircraft.
    #[must_use]
    pub fn at(&self, lane: usize) -> [Vector3; 2] {
        [at(&self.force_n, lane), at(&self.velocity_rate_body_m_s2, lane)]
    }
}

impl Abreast {
    /// An aircraft in every lane.
    #[must_use]
    pub fn new((mass, environment, model): Member<'_>) -> Self {
        let mut all = Self {
            environments: [*environment; LANES],
            gravity_m_s2: [0.0; LANES],
            mass: [[0.0; LANES]; 6],
            forces: Coefficients::new(model),
        };
        for lane in 0..LANES {
            // Of its own laws.
            let _ = all.put(lane, (mass, environment, model));
        }
        all
    }

    /// Puts an aircraft into its lane.
    ///
    /// # Errors
    /// [`OtherLaws`] for drag or thrust by another law than that of the others.
    pub fn put(
        &mut self,
        lane: usize,
        (mass, environment, model): Member<'_>,
    ) -> Result<(), OtherLaws> {
        self.environments[lane] = *environment;
        self.gravity_m_s2[lane] = environment.gravity_m_s2;
        let MassProperties { mass_kg, ix_kg_m2, iy_kg_m2, iz_kg_m2, ixz_kg_m2, engine_kg_m2_s } =
            *mass;
        let numbers = [mass_kg, ix_kg_m2, iy_kg_m2, iz_kg_m2, ixz_kg_m2, engine_kg_m2_s];
        for (lanes, number) in self.mass.iter_mut().zip(numbers) {
            lanes[lane] = number;
        }
        self.forces.put(lane, model)
    }

    #[inline(always)]
    fn at(&self, lane: usize) -> Aircraft<DerivativeModel> {
        let [mass_kg, ix_kg_m2, iy_kg_m2, iz_kg_m2, ixz_kg_m2, engine_kg_m2_s] =
            self.mass.map(|lanes| lanes[lane]);
        let mass =
            MassProperties { mass_kg, ix_kg_m2, iy_kg_m2, iz_kg_m2, ixz_kg_m2, engine_kg_m2_s };
        let gravity_m_s2 = self.gravity_m_s2[lane];
        // The air is in the flow.
        let environment = Environment { gravity_m_s2, ..Environment::STANDARD };
        Aircraft::of(mass, self.forces.at(lane), environment)
    }

    /// [`Aircraft::flow`] of each aircraft.
    #[inline(always)]
    pub fn flows(&self, states: &[Lanes; RIGID_STATES], airs: &Airs, flows: &mut Flows) {
        let mut ahead = [0.0; LANES];
        for lane in 0..LANES {
            let (state, motion) = (state_at(states, lane), airs.at(lane));
            let [velocity_m_s, rates_rad_s] =
                Aircraft::<DerivativeModel>::through_air(&state, &motion);
            for (lanes, value) in flows.velocity_body_m_s.iter_mut().zip(velocity_m_s.to_array()) {
                lanes[lane] = value;
            }
            for (lanes, value) in flows.rates_rad_s.iter_mut().zip(rates_rad_s.to_array()) {
                lanes[lane] = value;
            }
            flows.airspeed_m_s[lane] = velocity_m_s.norm();
            flows.altitude_m[lane] = state.altitude_m();
            ahead[lane] = ahead_m_s(velocity_m_s);
        }
        let [u, v, w] = flows.velocity_body_m_s;
        atan2(&w, &u, &mut flows.alpha_rad);
        atan2(&v, &ahead, &mut flows.beta_rad);
        sin_cos(&flows.alpha_rad, [&mut flows.sin_alpha, &mut flows.cos_alpha]);
        self.airs_at(flows);
    }

    /// The air at the altitudes.
    #[inline(always)]
    fn airs_at(&self, flows: &mut Flows) {
        let mut straight = [true; LANES];
        for lane in 0..LANES {
            let (air, is_straight) = Air::in_lowest_layer(flows.altitude_m[lane]);
            flows.temperature_k[lane] = air.temperature_k;
            flows.pressure_pa[lane] = air.pressure_pa;
            flows.density_kg_m3[lane] = air.density_kg_m3;
            flows.speed_of_sound_m_s[lane] = air.speed_of_sound_m_s;
            straight[lane] = is_straight;
        }
        for lane in 0..LANES {
            if !(straight[lane] && self.environments[lane].is_standard()) {
                let air = self.environments[lane].air_at(flows.altitude_m[lane]);
                flows.temperature_k[lane] = air.temperature_k;
                flows.pressure_pa[lane] = air.pressure_pa;
                flows.density_kg_m3[lane] = air.density_kg_m3;
                flows.speed_of_sound_m_s[lane] = air.speed_of_sound_m_s;
            }
        }
    }

    /// Rates of change of each state, as [`RigidState::rate`] of what [`Aircraft::instant_in`] answers.
    #[inline(always)]
    pub fn rates(
        &self,
        states: &[Lanes; RIGID_STATES],
        controls: &[Lanes; CONTROLS],
        airs: &Airs,
        flows: &Flows,
        rates: &mut [Lanes; RIGID_STATES],
    ) {
        for lane in 0..LANES {
            let (state, motion) = (state_at(states, lane), airs.at(lane));
            let controls = Controls::from_array(controls.map(|lanes| lanes[lane]));
            let instant = self.at(lane).instant_in(flows.at(lane), &state, &controls, &motion);
            let changes = state.rate(&instant.accelerations);
            for (lanes, value) in rates.iter_mut().zip(changes) {
                lanes[lane] = value;
            }
        }
    }

    /// Forces and accelerations of each aircraft, as [`Aircraft::instant_in`] answers them.
    #[inline(always)]
    pub fn felt(
        &self,
        states: &[Lanes; RIGID_STATES],
        controls: &[Lanes; CONTROLS],
        airs: &Airs,
        flows: &Flows,
        felt: &mut Felt,
    ) {
        for lane in 0..LANES {
            let (state, motion) = (state_at(states, lane), airs.at(lane));
            let controls = Controls::from_array(controls.map(|lanes| lanes[lane]));
            let instant = self.at(lane).instant_in(flows.at(lane), &state, &controls, &motion);
            let force_n = instant.loads.force_n.to_array();
            let rates = instant.accelerations.velocity_rate_body_m_s2.to_array();
            for axis in 0..3 {
                felt.force_n[axis][lane] = force_n[axis];
                felt.velocity_rate_body_m_s2[axis][lane] = rates[axis];
            }
        }
    }
}

/// Makes attitudes of length one again.
#[inline(always)]
pub fn normalise(states: &mut [Lanes; RIGID_STATES]) {
    for lane in 0..LANES {
        let attitude = state_at(states, lane).attitude.normalised().to_array();
        for (part, value) in attitude.into_iter().enumerate() {
            states[6 + part][lane] = value;
        }
    }
}

/// [`RigidState::euler`] of each aircraft.
#[inline(always)]
pub fn angles(states: &[Lanes; RIGID_STATES], angles: &mut Angles) {
    let mut sides = [[0.0; LANES]; 6];
    let mut straight = [true; LANES];
    for lane in 0..LANES {
        let parts = state_at(states, lane).attitude.angle_sides();
        let [_, _, _, _, forward_east, forward_north] = parts;
        straight[lane] = straight::is_straight_hypot(forward_north, forward_east);
        for (lanes, value) in sides.iter_mut().zip(parts) {
            lanes[lane] = value;
        }
        sides[3][lane] = straight::hypot_squared(forward_north, forward_east).sqrt();
    }
    for lane in 0..LANES {
        if !straight[lane] {
            sides[3][lane] = libm::hypot(sides[5][lane], sides[4][lane]);
        }
    }
    let [phi_y, phi_x, theta_y, theta_x, psi_y, psi_x] = &sides;
    atan2(phi_y, phi_x, &mut angles[0]);
    atan2(theta_y, theta_x, &mut angles[1]);
    atan2(psi_y, psi_x, &mut angles[2]);
}

/// The angles of one aircraft.
#[inline]
#[must_use]
pub fn angles_at(angles: &Angles, lane: usize) -> EulerAngles {
    let [phi_rad, theta_rad, psi_rad] = angles.map(|lanes| lanes[lane]);
    EulerAngles { phi_rad, theta_rad, psi_rad }
}

/// `libm::atan2` in each lane.
#[inline(always)]
pub fn atan2(y: &Lanes, x: &Lanes, angles: &mut Lanes) {
    let mut straight = [true; LANES];
    for lane in 0..LANES {
        straight[lane] = straight::is_straight_atan2(y[lane], x[lane]);
        angles[lane] = straight::atan2(y[lane], x[lane]);
    }
    if straight != [true; LANES] {
        for lane in 0..LANES {
            if !straight[lane] {
                angles[lane] = libm::atan2(y[lane], x[lane]);
            }
        }
    }
}

/// `libm::sincos` in each lane.
#[inline(always)]
pub fn sin_cos(angles_rad: &Lanes, [sines, cosines]: [&mut Lanes; 2]) {
    let mut straight = [true; LANES];
    for lane in 0..LANES {
        straight[lane] = straight::is_straight_sin_cos(angles_rad[lane]);
        (sines[lane], cosines[lane]) = straight::sin_cos(angles_rad[lane]);
    }
    if straight != [true; LANES] {
        for lane in 0..LANES {
            if !straight[lane] {
                (sines[lane], cosines[lane]) = libm::sincos(angles_rad[lane]);
            }
        }
    }
}

/// The numbers of [`DerivativeModel`]s, whose laws are one.
#[derive(Clone, Debug)]
struct Coefficients {
    geometry: [Lanes; 3],
    longitudinal: [[Lanes; 6]; 3],
    thrust_speed: Lanes,
    lateral: [[Lanes; 5]; 3],
    reference_airspeed_m_s: Lanes,
    reference_thrust_n: Lanes,
    drag_law: DragLaw,
    thrust_law: ThrustLaw,
}

impl Coefficients {
    fn new(model: &DerivativeModel) -> Self {
        Self {
            geometry: [[0.0; LANES]; 3],
            longitudinal: [[[0.0; LANES]; 6]; 3],
            thrust_speed: [0.0; LANES],
            lateral: [[[0.0; LANES]; 5]; 3],
            reference_airspeed_m_s: [0.0; LANES],
            reference_thrust_n: [0.0; LANES],
            drag_law: model.drag_law,
            thrust_law: model.thrust_law,
        }
    }

    fn put(&mut self, lane: usize, model: &DerivativeModel) -> Result<(), OtherLaws> {
        if (model.drag_law, model.thrust_law) != (self.drag_law, self.thrust_law) {
            return Err(OtherLaws);
        }
        let Geometry { area_m2, span_m, chord_m } = model.geometry;
        for (lanes, value) in self.geometry.iter_mut().zip([area_m2, span_m, chord_m]) {
            lanes[lane] = value;
        }
        let Longitudinal { lift, drag, pitch, thrust_speed } = model.longitudinal;
        for (rows, coefficient) in self.longitudinal.iter_mut().zip([lift, drag, pitch]) {
            let LongitudinalCoefficient {
                reference,
                alpha,
                alpha_rate,
                pitch_rate,
                speed,
                elevator,
            } = coefficient;
            let values = [reference, alpha, alpha_rate, pitch_rate, speed, elevator];
            for (lanes, value) in rows.iter_mut().zip(values) {
                lanes[lane] = value;
            }
        }
        let Lateral { side, roll, yaw } = model.lateral;
        for (rows, coefficient) in self.lateral.iter_mut().zip([side, roll, yaw]) {
            let LateralCoefficient { beta, roll_rate, yaw_rate, aileron, rudder } = coefficient;
            for (lanes, value) in rows.iter_mut().zip([beta, roll_rate, yaw_rate, aileron, rudder])
            {
                lanes[lane] = value;
            }
        }
        self.thrust_speed[lane] = thrust_speed;
        self.reference_airspeed_m_s[lane] = model.reference_airspeed_m_s;
        self.reference_thrust_n[lane] = model.reference_thrust_n;
        Ok(())
    }

    #[inline(always)]
    fn at(&self, lane: usize) -> DerivativeModel {
        let longitudinal = |rows: &[Lanes; 6]| LongitudinalCoefficient {
            reference: rows[0][lane],
            alpha: rows[1][lane],
            alpha_rate: rows[2][lane],
            pitch_rate: rows[3][lane],
            speed: rows[4][lane],
            elevator: rows[5][lane],
        };
        let lateral = |rows: &[Lanes; 5]| LateralCoefficient {
            beta: rows[0][lane],
            roll_rate: rows[1][lane],
            yaw_rate: rows[2][lane],
            aileron: rows[3][lane],
            rudder: rows[4][lane],
        };
        DerivativeModel {
            geometry: Geometry {
                area_m2: self.geometry[0][lane],
                span_m: self.geometry[1][lane],
                chord_m: self.geometry[2][lane],
            },
            longitudinal: Longitudinal {
                lift: longitudinal(&self.longitudinal[0]),
                drag: longitudinal(&self.longitudinal[1]),
                pitch: longitudinal(&self.longitudinal[2]),
                thrust_speed: self.thrust_speed[lane],
            },
            lateral: Lateral {
                side: lateral(&self.lateral[0]),
                roll: lateral(&self.lateral[1]),
                yaw: lateral(&self.lateral[2]),
            },
            reference_airspeed_m_s: self.reference_airspeed_m_s[lane],
            reference_thrust_n: self.reference_thrust_n[lane],
            drag_law: self.drag_law,
            thrust_law: self.thrust_law,
            // No part of the equations of motion.
            validity: Validity::EVERYWHERE,
            travel: Travel::UNLIMITED,
        }
    }
}
