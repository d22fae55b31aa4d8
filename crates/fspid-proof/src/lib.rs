#![doc = include_str!("../README.md")]
//!
//! The one-sample matrix of the loop is affine in the gains, so that one quadratic form that decreases at
//! the corners of a set of gains decreases for every gain in it, however fast the gains move:
//!
//! $$ M(k)^T P M(k) \prec \rho^2 P \quad \text{for every corner } k $$
//!
//! The plant's one-sample matrix is a matrix exponential; the re-check encloses it, too.
//!
//! No features. Not here: files, texts, scenarios.

mod asked;
mod bearing;
mod caps;
mod certificate;
pub mod check;
mod description;
mod disturbances;
mod family;
pub mod gain_set;
mod limits;
mod nonlinear;
mod prove;
mod recheck;
mod reference_model;
mod remembered;
mod rest;
mod scope;
pub mod sizes;
pub mod solve;
mod steps;

pub use asked::left_out_of;
pub use bearing::Bearing;
pub use caps::{MOST_BOUNDS, MOST_PARAMETERS, MOST_PARTS, MOST_PATCHES};
pub use certificate::{BoundedRate, Certificate, Claim};
pub use description::{LoopDescription, NotProvable};
pub use disturbances::{AirPart, DisturbanceBound, Disturbed, Extent, Quantity, Way, ways_of};
pub use family::{
    CheckedFamily, Family, FamilyError, FamilyVerdict, Pace, Parameter, Part as FamilyPart, Patch,
    ScaledSensor, Uncertain, numbers, prove_family,
};
pub use limits::{AtLimit, pitch_within};
pub use nonlinear::{
    Begun, CheckedNonlinear, Nonlinear, NonlinearError, NonlinearVerdict, NotNonlinear, Reach,
    prove_nonlinear,
};
pub use prove::{
    Effort, Largest, Outcome, Unbounded, Verdict, bound_disturbances, certify, is_proved,
};
pub use recheck::{RecheckError, Rechecked, Remains};
pub use rest::NoRest;
pub use scope::{Asked, LeftOut, Range, Scope};
pub use steps::{
    Commanded, Commands, Ended, Group as LegGroup, Leg, NearGains, Shares, Stepped, Steps, Terminal,
};
