//! A body, the forces on it and the world it flies in: the equations of motion.

mod varied;

use crate::aerodynamics::{ForceModel, Loads};
use crate::atmosphere::Environment;
use crate::controls::Controls;
use crate::error::AircraftError;
use crate::flow::{AirMotion, Flow};
use crate::integrate::rk4;
use crate::mass::MassProperties;
use crate::rigid_body::{Accelerations, RIGID_STATES, RigidState};
use crate::validity::Departure;
use crate::vector::Vector3;

/// An aircraft that can be flown.
#[derive(Debug, Clone, PartialEq)]
pub struct Aircraft<M> {
    mass: MassProperties,
    model: M,
    environment: Environment,
}

/// What happens at one instant of a flight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instant {
    /// The air as the aircraft meets it.
    pub flow: Flow,
    /// Loads of air and engine.
    pub loads: Loads,
    /// Rates of change of velocity components and body rates.
    pub accelerations: Accelerations,
    /// Rate of the angle of attack.
    pub alpha_rate_rad_s: f64,
}

impl<M: ForceModel> Aircraft<M> {
    /// Aircraft of a body and its forces in an environment.
    ///
    /// # Errors
    /// Mass properties that no body has; gravity that is not a finite number.
    pub fn new(
        mass: MassProperties,
        model: M,
        environment: Environment,
    ) -> Result<Self, AircraftError> {
        mass.validate()?;
        AircraftError::unless_finite("gravity in m/s²", environment.gravity_m_s2)?;
        Ok(Self { mass, model, environment })
    }

    /// The same of properties that are known to be those of a body.
    #[inline(always)]
    pub(crate) fn of(mass: MassProperties, model: M, environment: Environment) -> Self {
        Self { mass, model, environment }
    }

    /// The same body in the same environment, its forces in another form.
    #[must_use]
    pub fn with_model<N: ForceModel>(self, form: impl FnOnce(M) -> N) -> Aircraft<N> {
        let Self { mass, model, environment } = self;
        Aircraft { mass, model: form(model), environment }
    }

    /// Another body with other forces in the same environment; the body is one that [`Self::new`] takes.
    fn with_parts<N>(&self, mass: MassProperties, model: N) -> Aircraft<N> {
        Aircraft { mass, model, environment: self.environment }
    }

    /// Mass properties.
    #[must_use]
    pub fn mass(&self) -> &MassProperties {
        &self.mass
    }

    /// Forces.
    #[must_use]
    pub fn model(&self) -> &M {
        &self.model
    }

    /// Gravity and air.
    #[must_use]
    pub fn environment(&self) -> &Environment {
        &self.environment
    }

    /// The air as the aircraft meets it.
    ///
    /// $$ v_a = v - R^T v_{wind} - v_{gust}, \quad \omega_a = \omega - \omega_{gust} $$
    #[must_use]
    pub fn flow(&self, state: &RigidState, motion: &AirMotion) -> Flow {
        let altitude_m = state.altitude_m();
        let [velocity_m_s, rates_rad_s] = Self::through_air(state, motion);
        Flow::new(velocity_m_s, rates_rad_s, altitude_m, self.environment.air_at(altitude_m))
    }

    /// Velocity and rates through the air in body axes.
    #[inline(always)]
    pub(crate) fn through_air(state: &RigidState, motion: &AirMotion) -> [Vector3; 2] {
        let wind_body_m_s = state.attitude.to_body(motion.wind_ned_m_s);
        [
            state.velocity_body_m_s - wind_body_m_s - motion.gust_body_m_s,
            state.rates_rad_s - motion.gust_rates_rad_s,
        ]
    }

    /// Everything at one instant.
    ///
    /// Loads depend on the rate of the angle of attack, which depends on the loads. Both dependences are linear, so
    /// the rate follows in closed form from the rates that come out when 0 and 1 are put in:
    ///
    /// $$ \dot\alpha = \frac{\dot\alpha_0}{1 - (\dot\alpha_1 - \dot\alpha_0)} $$
    ///
    /// The rate is that of the aircraft through the steady wind; the gust's own change is left to the gust rates.
    #[must_use]
    pub fn instant(&self, state: &RigidState, controls: &Controls, motion: &AirMotion) -> Instant {
        self.instant_in(self.flow(state, motion), state, controls, motion)
    }

    /// [`instant`](Self::instant) in the [`flow`](Self::flow) that is there, for who knows it already.
    #[inline(always)]
    #[must_use]
    pub fn instant_in(
        &self,
        flow: Flow,
        state: &RigidState,
        controls: &Controls,
        motion: &AirMotion,
    ) -> Instant {
        let steady = self.model.loads(&flow, controls);
        let per_rate = self.model.loads_per_alpha_rate(&flow);
        let without = self.accelerations(state, steady);
        let acceleration = self.relative_acceleration(state, motion, &without);
        let alpha_rate_0 = flow.alpha_rate_rad_s(acceleration);
        let gain = flow.alpha_rate_rad_s((1.0 / self.mass.mass_kg) * per_rate.force_n);
        let alpha_rate_rad_s = alpha_rate_0 / (1.0 - gain);
        let loads = steady.plus(per_rate.scaled(alpha_rate_rad_s));
        let accelerations = self.accelerations(state, loads);
        Instant { flow, loads, accelerations, alpha_rate_rad_s }
    }

    #[inline(always)]
    fn accelerations(&self, state: &RigidState, loads: Loads) -> Accelerations {
        let gravity = self.environment.gravity_m_s2;
        state.accelerations(&self.mass, gravity, loads.force_n, loads.moment_n_m)
    }

    /// Rate of change of the velocity through the wind: in body axes a steady wind turns against the body.
    #[inline(always)]
    fn relative_acceleration(
        &self,
        state: &RigidState,
        motion: &AirMotion,
        accelerations: &Accelerations,
    ) -> Vector3 {
        let wind_body_m_s = state.attitude.to_body(motion.wind_ned_m_s);
        accelerations.velocity_rate_body_m_s2 + state.rates_rad_s.cross(wind_body_m_s)
    }

    /// Rate of change of the state vector of [`RigidState::to_array`].
    #[must_use]
    pub fn rate(
        &self,
        state: &[f64; RIGID_STATES],
        controls: &Controls,
        motion: &AirMotion,
    ) -> [f64; RIGID_STATES] {
        let state = RigidState::from_array(state);
        state.rate(&self.instant(&state, controls, motion).accelerations)
    }

    /// State after `dt_s` with controls and air held, by one step of the classical method of Runge and Kutta.
    ///
    /// The attitude comes back with length one. Controls are not limited here: what moves them does that.
    #[must_use]
    pub fn step(
        &self,
        state: &RigidState,
        controls: &Controls,
        motion: &AirMotion,
        dt_s: f64,
    ) -> RigidState {
        let rate = |_: f64, state: &[f64; RIGID_STATES]| self.rate(state, controls, motion);
        let end = RigidState::from_array(&rk4::step(rate, 0.0, &state.to_array(), dt_s));
        RigidState { attitude: end.attitude.normalised(), ..end }
    }

    /// First limit of the model by which the flow, or what it reads off its data, is outside.
    #[must_use]
    pub fn departure(
        &self,
        state: &RigidState,
        controls: &Controls,
        motion: &AirMotion,
    ) -> Option<Departure> {
        self.model.departure(&self.flow(state, motion), controls)
    }
}

impl Instant {
    /// Load factors along the body axes: what accelerometers at the centre of gravity feel, in multiples of gravity.
    ///
    /// $$ n = \frac{F}{m g} $$
    /// In level flight the third is near −1; pilots quote its negative.
    #[must_use]
    pub fn load_factors(&self, mass_kg: f64, gravity_m_s2: f64) -> Vector3 {
        load_factors(self.loads.force_n, mass_kg, gravity_m_s2)
    }
}

/// [`Instant::load_factors`] of a force of air and engine in N.
#[must_use]
pub fn load_factors(force_n: Vector3, mass_kg: f64, gravity_m_s2: f64) -> Vector3 {
    (1.0 / (mass_kg * gravity_m_s2)) * force_n
}
