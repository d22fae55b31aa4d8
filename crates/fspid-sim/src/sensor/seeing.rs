//! Which ages of its values a sensor shows where small motions are asked.

/// How sensors show small motions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Seeing {
    /// As late as they ever are, gyros upright.
    Latest,
    /// Those with a clock of their own by it, over a time after which all ages come again; gyros upright.
    AsTheyCome,
    /// Those with a clock of their own as early as they ever are.
    Earliest,
    /// Those with a clock of their own halfway between: as late as they are in the mean.
    Midway,
    /// As late as they ever are, with gyros that follow the apparent vertical, which is all that small motions see of
    /// erection at a bounded rate.
    Erecting,
}
