//! Forces from stability derivatives: an aircraft as the appendix of a textbook describes it.
//!
//! Body axes are the stability axes of the reference flight: forward is where the aircraft flew there, so angle of
//! attack and pitch count from it. Good for some degrees and some tens of per cent of speed around the reference;
//! there is no stall, and Mach number enters by the speed derivatives only.

use crate::aerodynamics::{ForceModel, Loads};
use crate::controls::Controls;
use crate::flow::Flow;
use crate::validity::{Travel, Validity};
use crate::vector::Vector3;

/// One longitudinal coefficient and its derivatives, all without unit, angles in rad.
///
/// $$ C = C_1 + C_\alpha \alpha + \frac{\bar c}{2V} \left( C_{\dot\alpha} \dot\alpha + C_q q \right) +
///      C_u \frac{V - u_0}{u_0} + C_{\delta_e} \delta_e $$
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct LongitudinalCoefficient<T = f64> {
    /// At the reference.
    pub reference: T,
    /// By angle of attack.
    pub alpha: T,
    /// By its rate, made dimensionless with half a chord.
    pub alpha_rate: T,
    /// By pitch rate, made dimensionless with half a chord.
    pub pitch_rate: T,
    /// By relative change of speed.
    pub speed: T,
    /// By elevator.
    pub elevator: T,
}

/// Derivatives of one lateral coefficient, all without unit, angles in rad.
///
/// $$ C = C_\beta \beta + \frac{b}{2V} \left( C_p p + C_r r \right) +
///      C_{\delta_a} \delta_a + C_{\delta_r} \delta_r $$
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct LateralCoefficient {
    /// By sideslip.
    pub beta: f64,
    /// By roll rate, made dimensionless with half a span.
    pub roll_rate: f64,
    /// By yaw rate, made dimensionless with half a span.
    pub yaw_rate: f64,
    /// By aileron.
    pub aileron: f64,
    /// By rudder.
    pub rudder: f64,
}

/// Lift, drag and pitching moment.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Longitudinal<T = f64> {
    /// $C_L$, up across the flow.
    pub lift: LongitudinalCoefficient<T>,
    /// $C_D$, back along the flow.
    pub drag: LongitudinalCoefficient<T>,
    /// $C_m$, nose up.
    pub pitch: LongitudinalCoefficient<T>,
    /// $C_{T_{xu}}$: thrust by relative change of speed, made dimensionless with the dynamic pressure.
    pub thrust_speed: T,
}

/// Side force, rolling moment and yawing moment.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Lateral {
    /// $C_Y$, to the right.
    pub side: LateralCoefficient,
    /// $C_l$, right wing down.
    pub roll: LateralCoefficient,
    /// $C_n$, nose right.
    pub yaw: LateralCoefficient,
}

/// Lengths that make coefficients into forces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Geometry {
    /// Wing area.
    pub area_m2: f64,
    /// Wing span.
    pub span_m: f64,
    /// Mean chord.
    pub chord_m: f64,
}

/// How drag depends on lift.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum DragLaw {
    /// Along the tangent at the reference: as linear theory has it, wrong by the square of the excursion.
    #[default]
    Linear,
    /// By the parabola through the reference with the same tangent, $C_D = C_{D_0} + k C_L^2$ with
    /// $2 k C_{L_1} C_{L_\alpha} = C_{D_\alpha}$.
    Polar,
}

/// How thrust depends on speed at a fixed throttle.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum ThrustLaw {
    /// Not at all.
    #[default]
    Constant,
    /// As the source's derivative says: $T = \bar q S \left( C_{T_1} + C_{T_{xu}} (V - u_0)/u_0 \right)$.
    WithSpeed,
}

/// An aircraft's forces from derivatives about one flight condition.
///
/// $$ X = \bar q S (C_L \sin\alpha - C_D \cos\alpha) + T, \quad Z = -\bar q S (C_L \cos\alpha + C_D \sin\alpha) $$
///
/// A throttle of 1 is the thrust that balances the drag of the reference.
///
/// # Source
/// R. C. Nelson, Flight Stability and Automatic Control, 2nd edition, chapter 3; J. Roskam, Airplane Flight Dynamics
/// and Automatic Flight Controls, Part I, chapters 3 and 5.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DerivativeModel {
    /// Lengths.
    pub geometry: Geometry,
    /// Lift, drag, pitching moment.
    pub longitudinal: Longitudinal,
    /// Side force, roll, yaw.
    pub lateral: Lateral,
    /// Airspeed of the reference.
    pub reference_airspeed_m_s: f64,
    /// Thrust at the reference.
    pub reference_thrust_n: f64,
    /// Drag away from the reference.
    pub drag_law: DragLaw,
    /// Thrust away from the reference.
    pub thrust_law: ThrustLaw,
    /// Where the derivatives are worth something.
    pub validity: Validity,
    /// Stops of the controls.
    pub travel: Travel,
}

impl LongitudinalCoefficient {
    /// Value without the angle of attack's rate.
    #[inline(always)]
    fn steady(&self, variables: &Variables) -> f64 {
        self.reference
            + self.alpha * variables.alpha_rad
            + self.pitch_rate * variables.pitch
            + self.speed * variables.speed
            + self.elevator * variables.elevator_rad
    }
}

impl LateralCoefficient {
    #[inline(always)]
    fn value(&self, variables: &Variables) -> f64 {
        self.beta * variables.beta_rad
            + self.roll_rate * variables.roll
            + self.yaw_rate * variables.yaw
            + self.aileron * variables.aileron_rad
            + self.rudder * variables.rudder_rad
    }
}

/// What coefficients depend on; rates without unit.
struct Variables {
    alpha_rad: f64,
    beta_rad: f64,
    roll: f64,
    pitch: f64,
    yaw: f64,
    speed: f64,
    elevator_rad: f64,
    aileron_rad: f64,
    rudder_rad: f64,
}

impl DerivativeModel {
    #[inline(always)]
    fn variables(&self, flow: &Flow, controls: &Controls) -> Variables {
        let half_span_s = half_time_s(self.geometry.span_m, flow);
        Variables {
            alpha_rad: flow.alpha_rad,
            beta_rad: flow.beta_rad,
            roll: half_span_s * flow.rates_rad_s.x,
            pitch: half_time_s(self.geometry.chord_m, flow) * flow.rates_rad_s.y,
            yaw: half_span_s * flow.rates_rad_s.z,
            speed: self.relative_speed(flow),
            elevator_rad: controls.elevator_rad,
            aileron_rad: controls.aileron_rad,
            rudder_rad: controls.rudder_rad,
        }
    }

    #[inline(always)]
    fn relative_speed(&self, flow: &Flow) -> f64 {
        (flow.airspeed_m_s - self.reference_airspeed_m_s) / self.reference_airspeed_m_s
    }

    #[inline(always)]
    fn drag(&self, variables: &Variables) -> f64 {
        let tangent = self.longitudinal.drag.steady(variables);
        match self.drag_law {
            DragLaw::Linear => tangent,
            DragLaw::Polar => tangent + self.polar_excess(variables.alpha_rad),
        }
    }

    /// Parabola less tangent: $k (C_{L_\alpha} \alpha)^2$.
    #[inline(always)]
    fn polar_excess(&self, alpha_rad: f64) -> f64 {
        let Longitudinal { lift, drag, .. } = &self.longitudinal;
        0.5 * drag.alpha / lift.reference * lift.alpha * alpha_rad * alpha_rad
    }

    /// Lift and drag coefficients as a force, without the side force.
    #[inline(always)]
    fn force(&self, flow: &Flow, lift: f64, drag: f64) -> Vector3 {
        let (sin, cos) = flow.alpha_sin_cos;
        let scale_n = flow.dynamic_pressure_pa() * self.geometry.area_m2;
        scale_n * Vector3::new(lift * sin - drag * cos, 0.0, -lift * cos - drag * sin)
    }

    /// Rolling, pitching and yawing moment coefficients as a moment.
    #[inline(always)]
    fn moment(&self, flow: &Flow, roll: f64, pitch: f64, yaw: f64) -> Vector3 {
        let Geometry { area_m2, span_m, chord_m } = self.geometry;
        let scale_n = flow.dynamic_pressure_pa() * area_m2;
        scale_n * Vector3::new(span_m * roll, chord_m * pitch, span_m * yaw)
    }
}

/// Time in s in which half a length is flown; 0 at rest, where rates have no effect.
#[inline(always)]
fn half_time_s(length_m: f64, flow: &Flow) -> f64 {
    if flow.airspeed_m_s == 0.0 { 0.0 } else { 0.5 * length_m / flow.airspeed_m_s }
}

impl ForceModel for DerivativeModel {
    #[inline(always)]
    fn loads(&self, flow: &Flow, controls: &Controls) -> Loads {
        let variables = self.variables(flow, controls);
        let Longitudinal { lift, pitch, .. } = &self.longitudinal;
        let Lateral { side, roll, yaw } = &self.lateral;
        let scale_n = flow.dynamic_pressure_pa() * self.geometry.area_m2;
        let across =
            Vector3::new(self.thrust_n(flow, controls), scale_n * side.value(&variables), 0.0);
        Loads {
            force_n: self.force(flow, lift.steady(&variables), self.drag(&variables)) + across,
            moment_n_m: self.moment(
                flow,
                roll.value(&variables),
                pitch.steady(&variables),
                yaw.value(&variables),
            ),
        }
    }

    #[inline(always)]
    fn loads_per_alpha_rate(&self, flow: &Flow) -> Loads {
        let half_chord_s = half_time_s(self.geometry.chord_m, flow);
        let Longitudinal { lift, drag, pitch, .. } = &self.longitudinal;
        Loads {
            force_n: self.force(
                flow,
                half_chord_s * lift.alpha_rate,
                half_chord_s * drag.alpha_rate,
            ),
            moment_n_m: self.moment(flow, 0.0, half_chord_s * pitch.alpha_rate, 0.0),
        }
    }

    #[inline(always)]
    fn thrust_n(&self, flow: &Flow, controls: &Controls) -> f64 {
        let reference_n = match self.thrust_law {
            ThrustLaw::Constant => self.reference_thrust_n,
            ThrustLaw::WithSpeed => {
                let change = self.longitudinal.thrust_speed * self.relative_speed(flow);
                let coefficient = self.longitudinal.drag.reference + change;
                flow.dynamic_pressure_pa() * self.geometry.area_m2 * coefficient
            }
        };
        controls.throttle * reference_n
    }

    fn validity(&self) -> &Validity {
        &self.validity
    }

    fn travel(&self) -> &Travel {
        &self.travel
    }
}
