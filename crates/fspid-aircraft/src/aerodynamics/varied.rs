//! Derivatives that do not stay: with what is extended, with Mach number, near the ground, about a moving centre of
//! gravity.
//!
//! A [`VariedModel`] is the model of forces at the start of a flight; [`VariedModel::at`] is the aircraft of a later
//! instant. Mach number and height come with the flow; what is extended and what fuel is left the caller knows.

use crate::aerodynamics::derivatives::{DerivativeModel, DragLaw, ThrustLaw};
use crate::aerodynamics::ground_effect::GroundEffect;
use crate::aerodynamics::increment::{Configuration, Increment};
use crate::aerodynamics::mach_table::MachTable;
use crate::aerodynamics::{ForceModel, Loads};
use crate::controls::Controls;
use crate::engine::Gearing;
use crate::error::AircraftError;
use crate::flow::Flow;
use crate::validity::{Departure, Range, Travel, Validity};
use crate::vector::Vector3;

/// A configuration and how far it is out.
#[derive(Debug, Clone, PartialEq)]
pub struct Deployed {
    /// What.
    pub configuration: Configuration,
    /// How far at the start of the flight, 0 to 1.
    pub share: f64,
}

/// What depends on the flow alone.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FlowEffects {
    /// By Mach number.
    pub mach: Option<MachTable>,
    /// By the height above the ground.
    pub ground: Option<GroundEffect>,
}

/// Derivatives with everything that is added to them in flight.
#[derive(Debug, Clone, PartialEq)]
pub struct VariedModel {
    base: DerivativeModel,
    aft_chords: f64,
    deployed: Vec<Deployed>,
    effects: FlowEffects,
    start: Standing,
}

/// Base and increments at one instant, apart from what depends on the flow.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Standing {
    /// About the centre of gravity.
    base: DerivativeModel,
    /// About that of the data.
    increment: Increment,
    aft_chords: f64,
}

/// The forces of a [`VariedModel`] at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VariedNow<'a> {
    standing: Standing,
    effects: &'a FlowEffects,
}

impl VariedModel {
    /// Derivatives about the centre of gravity of their data, which flies that many chords further aft, with what is
    /// added to them.
    ///
    /// # Errors
    /// A deployment that is not from 0 to 1.
    pub fn new(
        base: DerivativeModel,
        aft_chords: f64,
        deployed: Vec<Deployed>,
        effects: FlowEffects,
    ) -> Result<Self, AircraftError> {
        AircraftError::unless_finite("centre of gravity in chords", aft_chords)?;
        for Deployed { share, .. } in &deployed {
            if !(0.0..=1.0).contains(share) {
                let what = "deployment of a configuration";
                return Err(AircraftError::Outside { what, value: *share, min: 0.0, max: 1.0 });
            }
        }
        let shares = deployed.iter().map(|one| one.share);
        let start = Standing::of(&base, &deployed, &effects, (shares, aft_chords));
        Ok(Self { base, aft_chords, deployed, effects, start })
    }

    /// What can be extended.
    #[must_use]
    pub fn deployed(&self) -> &[Deployed] {
        &self.deployed
    }

    /// What depends on the flow.
    #[must_use]
    pub fn effects(&self) -> &FlowEffects {
        &self.effects
    }

    /// Mean chord, m.
    #[must_use]
    pub fn chord_m(&self) -> f64 {
        self.base.geometry.chord_m
    }

    /// The forces of another instant: with other shares of the [configurations](Self::deployed), in their order, and the
    /// centre of gravity that far behind its place at the start, m.
    pub(crate) fn now_with(
        &self,
        shares: impl Iterator<Item = f64>,
        moved_aft_m: f64,
    ) -> VariedNow<'_> {
        let moved = (shares, self.aft_chords_with(moved_aft_m));
        let standing = Standing::of(&self.base, &self.deployed, &self.effects, moved);
        VariedNow { standing, effects: &self.effects }
    }

    /// The same as the start of another flight.
    pub(crate) fn started_with(&self, shares: impl Iterator<Item = f64>, moved_aft_m: f64) -> Self {
        let aft_chords = self.aft_chords_with(moved_aft_m);
        let all = self.deployed.iter().cloned().zip(shares);
        let deployed: Vec<_> = all.map(|(one, share)| Deployed { share, ..one }).collect();
        let shares = deployed.iter().map(|one| one.share);
        let start = Standing::of(&self.base, &deployed, &self.effects, (shares, aft_chords));
        let (base, effects) = (self.base, self.effects.clone());
        Self { base, aft_chords, deployed, effects, start }
    }

    /// Chords that the centre of gravity is behind that of the data.
    fn aft_chords_with(&self, moved_aft_m: f64) -> f64 {
        self.aft_chords + moved_aft_m / self.chord_m()
    }

    fn now(&self) -> VariedNow<'_> {
        VariedNow { standing: self.start, effects: &self.effects }
    }
}

impl Standing {
    fn of(
        base: &DerivativeModel,
        deployed: &[Deployed],
        effects: &FlowEffects,
        (shares, aft_chords): (impl Iterator<Item = f64>, f64),
    ) -> Self {
        let mut validity = base.validity;
        if let Some(mach) = &effects.mach {
            validity.mach = both(validity.mach, mach.range());
        }
        let mut increment = Increment::default();
        for (Deployed { configuration, .. }, share) in deployed.iter().zip(shares) {
            increment = increment.plus(share, &configuration.increment);
            if share > 0.0 {
                let most = Range { min: f64::NEG_INFINITY, max: configuration.most_airspeed_m_s };
                validity.airspeed_m_s = both(validity.airspeed_m_s, most);
            }
        }
        let base = DerivativeModel { validity, ..about(*base, aft_chords) };
        Self { base, increment, aft_chords }
    }

    /// What is added, as a model of its own: it has no thrust, and its drag is as its rows say.
    fn added(&self, effects: &FlowEffects, flow: &Flow) -> DerivativeModel {
        let increment = match &effects.mach {
            Some(table) => self.increment.plus(1.0, &table.at(flow.mach())),
            None => self.increment,
        };
        let Increment { longitudinal, lateral } = increment;
        let model = DerivativeModel {
            longitudinal,
            lateral,
            reference_thrust_n: 0.0,
            drag_law: DragLaw::Linear,
            thrust_law: ThrustLaw::Constant,
            ..self.base
        };
        about(model, self.aft_chords)
    }
}

/// A model about a centre of gravity that many chords further aft.
fn about(model: DerivativeModel, aft_chords: f64) -> DerivativeModel {
    if aft_chords == 0.0 {
        return model;
    }
    DerivativeModel {
        longitudinal: model.longitudinal.moved(aft_chords),
        lateral: model.lateral.moved(aft_chords, &model.geometry),
        ..model
    }
}

/// What lies in two ranges.
fn both(one: Range, other: Range) -> Range {
    Range { min: one.min.max(other.min), max: one.max.min(other.max) }
}

impl VariedNow<'_> {
    /// The force that the ground takes off the drag due to lift.
    fn off_the_ground(&self, flow: &Flow, force_n: Vector3) -> Vector3 {
        let Some(ground) = &self.effects.ground else { return Vector3::ZERO };
        let scale_n = flow.dynamic_pressure_pa() * self.standing.base.geometry.area_m2;
        if scale_n <= 0.0 {
            return Vector3::ZERO;
        }
        let (sin, cos) = libm::sincos(flow.alpha_rad);
        // Of the loads without thrust: X sin α − Z cos α is the lift.
        let lift = (force_n.x * sin - force_n.z * cos) / scale_n;
        let drag_n = scale_n * ground.drag(flow.altitude_m, lift);
        -drag_n * Vector3::new(cos, 0.0, sin)
    }
}

impl ForceModel for VariedNow<'_> {
    fn loads(&self, flow: &Flow, controls: &Controls) -> Loads {
        let added = self.standing.added(self.effects, flow);
        let loads = self.standing.base.loads(flow, controls).plus(added.loads(flow, controls));
        let thrust_n = Vector3::new(self.thrust_n(flow, controls), 0.0, 0.0);
        let near_n = self.off_the_ground(flow, loads.force_n - thrust_n);
        Loads { force_n: loads.force_n + near_n, ..loads }
    }

    fn loads_per_alpha_rate(&self, flow: &Flow) -> Loads {
        let added = self.standing.added(self.effects, flow);
        self.standing.base.loads_per_alpha_rate(flow).plus(added.loads_per_alpha_rate(flow))
    }

    fn thrust_n(&self, flow: &Flow, controls: &Controls) -> f64 {
        self.standing.base.thrust_n(flow, controls)
    }

    fn has_engine(&self) -> bool {
        self.standing.base.has_engine()
    }

    fn gearing(&self) -> Gearing {
        self.standing.base.gearing()
    }

    fn validity(&self) -> &Validity {
        self.standing.base.validity()
    }

    fn travel(&self) -> &Travel {
        self.standing.base.travel()
    }

    fn beyond_data(&self, flow: &Flow, controls: &Controls) -> Option<Departure> {
        self.standing.base.beyond_data(flow, controls)
    }
}

impl ForceModel for VariedModel {
    fn loads(&self, flow: &Flow, controls: &Controls) -> Loads {
        self.now().loads(flow, controls)
    }

    fn loads_per_alpha_rate(&self, flow: &Flow) -> Loads {
        self.now().loads_per_alpha_rate(flow)
    }

    fn thrust_n(&self, flow: &Flow, controls: &Controls) -> f64 {
        self.now().thrust_n(flow, controls)
    }

    fn has_engine(&self) -> bool {
        self.start.base.has_engine()
    }

    fn gearing(&self) -> Gearing {
        self.start.base.gearing()
    }

    fn validity(&self) -> &Validity {
        self.start.base.validity()
    }

    fn travel(&self) -> &Travel {
        self.start.base.travel()
    }

    fn beyond_data(&self, flow: &Flow, controls: &Controls) -> Option<Departure> {
        self.start.base.beyond_data(flow, controls)
    }
}
