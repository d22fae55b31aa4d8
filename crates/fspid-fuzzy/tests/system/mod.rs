//! General systems: what they answer, and what they keep to.

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

pub(crate) mod build;
mod integral;
mod maximum;
mod oracle;
mod outline;
mod policies;
mod properties;
mod random;
mod relations;
mod rules;
mod sampled;
mod supervisor;
mod tipper;
