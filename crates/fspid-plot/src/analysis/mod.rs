//! Figures of loop analysis: frequency responses, poles, maps of margins, sets of gains.
//!
//! What is drawn has been computed elsewhere; only what a picture needs is derived here: decibels, an
//! unwrapped phase, sensitivities from the open loop, lines between poles, convex outlines. A margin or a peak
//! that is marked is the caller's number, never one read off the points.

mod bode;
mod chart;
mod clip;
mod cover;
mod dots;
mod frequency;
mod gain_map;
mod gain_set;
mod gain_surface;
mod label;
mod locus;
mod map_cells;
mod nichols;
mod notes;
mod nyquist;
mod pole_zero;
mod radius;
mod response;
mod sensitivity;
mod stack;
#[cfg(test)]
pub(super) mod tests;
mod z_plane;

pub use bode::BodeFigure;
pub use gain_map::{GainMap, MapCell, MapPoint};
pub use gain_set::{CellState, GainCell, GainSet};
pub use gain_surface::GainSurface;
pub use locus::{Crossing, LocusSample, RootLocus};
pub use nichols::{CLOSED_LOOP_DB, Exclusion, NicholsFigure};
pub use nyquist::{MarginDisk, NyquistFigure};
pub use pole_zero::PoleZeroMap;
pub use radius::RadiusFigure;
pub use response::{LoopCurve, LoopPoint, Margin, MarginMark, Polar};
pub use sensitivity::{PeakMark, SensitivityFigure, Transfer};
