//! Figures of campaigns: what many flights say, side by side for each controller.
//!
//! Counts, quantiles and intervals come from the caller; here they get a place. Controllers differ by more
//! than colour everywhere: by their row, their panel or the sign that marks them.

mod areas;
mod distribution;
mod envelope;
mod interval;
mod scatter;
mod share_map;
#[cfg(test)]
pub(super) mod tests;
mod trade;

pub use distribution::{DistributionFigure, DistributionRow, LimitLine};
pub use envelope::{EnvelopeBand, EnvelopeFigure, EnvelopePanel};
pub use interval::{IntervalColumn, IntervalFigure, IntervalMark, IntervalRow};
pub use scatter::RunScatter;
pub use share_map::{ShareCell, ShareMap};
pub use trade::{TradeFigure, TradeSeries};
