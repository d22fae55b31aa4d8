//! Finding the unpublished parameters.
mod problem;
