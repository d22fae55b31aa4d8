#![doc = include_str!("../README.md")]
//!
//! Colours are CSS variables with fallbacks, so that one file is right on white paper and inline in a dark page;
//! [`page_style`] is the style sheet for such a page. Why no library draws them
//! is in `docs/decisions/0023-own-line-charts.md`.
//!
//! No features. Not here: what is drawn is computed elsewhere; a figure finds no peak and no margin.

mod analysis;
mod axis;
mod campaign;
mod conclusion;
mod contour;
mod cursor;
pub mod diagrams;
mod gaps;
mod line;
mod membership;
mod page;
mod plot;
mod ratio;
mod rules;
mod sign;
mod style;
mod surface;
mod svg;
#[cfg(test)]
mod tests;
mod text;
mod thin;
mod tiles;
mod view;

pub use analysis::{
    BodeFigure, CLOSED_LOOP_DB, CellState, Crossing, Exclusion, GainCell, GainMap, GainSet,
    GainSurface, LocusSample, LoopCurve, LoopPoint, MapCell, MapPoint, Margin, MarginDisk,
    MarginMark, NicholsFigure, NyquistFigure, PeakMark, Polar, PoleZeroMap, RadiusFigure,
    RootLocus, SensitivityFigure, Transfer,
};
pub use campaign::{
    DistributionFigure, DistributionRow, EnvelopeBand, EnvelopeFigure, EnvelopePanel,
    IntervalColumn, IntervalFigure, IntervalMark, IntervalRow, LimitLine, RunScatter, ShareCell,
    ShareMap, TradeFigure, TradeSeries,
};
pub use conclusion::{ConclusionFigure, Part};
pub use line::{Band, LineFigure, LinePanel, Series};
pub use membership::memberships;
pub use ratio::RatioFigure;
pub use rules::{Mark, RuleTable, SEVEN};
pub use style::{SeriesStyle, page_style};
pub use surface::{Surface, SurfaceKind};
pub use svg::Svg;
pub use tiles::Tiles;
pub use view::Observer;
