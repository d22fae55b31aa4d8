//! The air that an aircraft flies through: winds, gusts and turbulence.
//!
//! # Axes
//! Earth axes are north, east, down. Body axes are forward, right, down; for a linear plant they are
//! those of its model: of the body for a linear aircraft, the stability axes of the reference condition for one known by a linear
//! model alone. Every velocity is that of the *air*, positive
//! along its axis: a headwind on a northerly course has a negative north component, an updraught a
//! negative down component.
//!
//! Rates are the angular velocity of the air about body axes as it would be in a rigid rotation, so
//! that the aerodynamic rates are those of the body less those of the air:
//!
//! $$ p_g = \frac{\partial w_g}{\partial y}, \quad q_g = -\frac{\partial w_g}{\partial x}, \quad
//! r_g = \frac{\partial v_g}{\partial x} $$
//!
//! Where a gust is frozen while the aircraft flies through it with airspeed $V$,
//! $q_g = -\dot w_g / V$ and $r_g = \dot v_g / V$.
//!
//! # What is where
//! [`Wind`] is the family of everything that is a function of place and time; [`Dryden`] is random
//! and has a state. Heights in the source documents are in feet; here they are in metres.

pub mod dryden;
mod grid;
pub mod wind;

pub(crate) use dryden::Shaping;
pub use dryden::{Dryden, DrydenState, Follows, Intensity, Severity, Specification, Turbulence};
pub use grid::GRID_S;
pub(crate) use grid::{Grid, Piece};
pub use wind::{
    AirMotion, AirPlace, Along, Corners, FullCycle, LogShear, Microburst, RampHold, Steady,
    TableRow, Wind, WindField, WindKind, WindTable, design_gust_m_s, reference_gust_m_s, sum_at,
};
