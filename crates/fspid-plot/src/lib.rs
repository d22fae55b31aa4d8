//! Figures: data in, one self-contained SVG out.
//!
//! All inputs are plain owned data in display units (degrees, seconds); all outputs are [`Svg`]. A figure
//! never fails: what is not finite interrupts a line, what is empty is drawn empty. The same input gives
//! the same bytes. Colours are CSS variables with fallbacks, so one file is right on white paper and
//! inline in a dark page; [`page_style`] is the style sheet for such a page.
//!
//! This crate draws and does not compute: peaks, tolerances and ratios come from its callers. Why `kuva`
//! draws the line charts and our own code the rest is in `docs/decisions/0001-figures.md`.

mod analysis;
mod axis;
mod campaign;
mod conclusion;
mod contour;
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
    MarginMark, NicholsFigure, NyquistFigure, PeakMark, PoleZeroMap, RadiusFigure, RootLocus,
    SensitivityFigure, Transfer,
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
