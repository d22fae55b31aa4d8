//! The caps of a certificate: how large each of its parts may be, and what is said of one that is larger.

use core::fmt;

/// Most states of a loop.
pub const MOST_STATES: usize = 128;
/// Most states of a loop with fixed gains, where a proof is looked for: 26 take 2.4 s and 46 take 57 s.
pub const MOST_STATES_FIXED: usize = 40;
/// Most states of a loop whose gains move, where a proof is looked for.
pub const MOST_STATES_SEARCHED: usize = 24;
/// Most cells along each of the supervisor's inputs.
pub const MOST_DIVISIONS: usize = 96;
/// Most double cones of a claim.
pub const MOST_CONES: usize = 96;
/// Longest sequence of gains that is multiplied out.
pub const MOST_SAMPLES: usize = 20_000;
/// Most changes of a commanded signal.
pub const MOST_CHANGES: usize = 4096;
/// Most boxes along the set-points of steps.
pub const MOST_PIECES: usize = 4096;
/// Most parts of the loads of steps.
pub const MOST_LOADS: usize = 64;
/// Most legs of commanded flights.
pub const MOST_LEGS: usize = 64;
/// Most sets of a leg, which are kept until they are joined.
pub const MOST_LEG_SETS: usize = 1024;
/// Most parts along set-points or loads in each group, and most groups of a leg.
pub const MOST_LEG_PARTS: usize = 1024;
/// Most bounds of what disturbances do.
pub const MOST_BOUNDS: usize = 24;
/// Most parts of a family.
pub const MOST_PARTS: usize = 4096;
/// Most patches of a family.
pub const MOST_PATCHES: usize = 64;
/// Most parameters of a box of plants, as a family has them.
pub const MOST_PARAMETERS: usize = 8;

/// Most work of a re-check: cubes of the number of states, one for each inequality. That is some minutes.
pub const MOST_WORK: u64 = 4_000_000_000;

/// A part of a certificate that is larger than allowed, or of another size than the loop asks for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrongSize {
    /// Where in the certificate, as in its file.
    pub path: &'static str,
    /// What is counted.
    pub what: &'static str,
    /// How many there are.
    pub found: u64,
    /// How many there may be.
    pub least: u64,
    /// The most; equal to the least where the loop leaves no choice.
    pub most: u64,
}

impl fmt::Display for WrongSize {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { path, what, found, least, most } = self;
        match (least, most) {
            (least, most) if least == most => {
                write!(f, "{path}: {found} {what}; the loop asks for {most}")
            }
            (0, most) => write!(f, "{path}: {found} {what}; allowed are up to {most}"),
            (least, most) => write!(f, "{path}: {found} {what}; allowed are {least} to {most}"),
        }
    }
}

/// Everything whose size is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrongSizes(pub Vec<WrongSize>);

impl fmt::Display for WrongSizes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (place, wrong) in self.0.iter().enumerate() {
            write!(f, "{}{wrong}", if place == 0 { "" } else { "; " })?;
        }
        Ok(())
    }
}
