//! What is commanded and what disturbs, as functions of time.

mod disturbance;
mod mixed_noise;
pub(crate) mod noise;
mod profile;
mod shape;

pub use disturbance::{Disturbance, Entry};
pub use mixed_noise::{NoMixture, Noise};
pub(crate) use profile::Leaves;
pub use profile::{Edge, Interpolation, Profile};
pub use shape::Shape;
pub(crate) use shape::extremes_from;
