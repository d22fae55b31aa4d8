//! Where to look, and how hard.

use alloc::vec::Vec;
use core::fmt;

use crate::system::{System, Universe};
use fspid_numeric::scalar::Interval;

/// Where to look, and how hard. Nothing depends on a clock.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceOptions {
    /// Lower and upper end of each input; by default the universes.
    pub domain: Option<Vec<[f64; 2]>>,
    /// The inputs at rest; by default 0, or the middle of a domain without 0.
    pub rest: Option<Vec<f64>>,
    /// Bounds of values may be so far apart, in the unit of the output.
    pub value_tolerance: f64,
    /// Bounds of slopes may be so far apart, in output per input.
    pub slope_tolerance: f64,
    /// Bounds of shares of the domain may be so far apart.
    pub share_tolerance: f64,
    /// Most boxes for each single question.
    pub boxes: u64,
}

impl Default for SurfaceOptions {
    fn default() -> Self {
        Self {
            domain: None,
            rest: None,
            value_tolerance: 1e-7,
            slope_tolerance: 1e-3,
            share_tolerance: 2e-3,
            boxes: 40_000,
        }
    }
}

/// Why a surface cannot be looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SurfaceError {
    /// An input has no universe, and no domain was given.
    NoUniverse {
        /// Position of the input.
        input: usize,
    },
    /// A domain whose ends are not finite numbers in ascending order.
    Domain {
        /// Position of the input.
        input: usize,
    },
    /// Not as many numbers as the system has inputs.
    Count {
        /// How many were given.
        found: usize,
        /// How many are needed.
        expected: usize,
    },
    /// A rest point outside of the domain.
    Rest {
        /// Position of the input.
        input: usize,
    },
    /// A formula names an output: the answers depend on the answers before.
    Remembers,
}

impl fmt::Display for SurfaceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoUniverse { input } => {
                write!(f, "input {} has no universe, and no domain was given", input + 1)
            }
            Self::Domain { input } => write!(
                f,
                "the domain of input {} is not two finite numbers in ascending order",
                input + 1
            ),
            Self::Count { found, expected } => {
                write!(f, "{found} values for {expected} inputs")
            }
            Self::Remembers => f.write_str(
                "a formula names an output: the answers depend on those before, and no surface says that",
            ),
            Self::Rest { input } => {
                write!(f, "the rest point lies outside the domain of input {}", input + 1)
            }
        }
    }
}

impl core::error::Error for SurfaceError {}

impl SurfaceOptions {
    pub(super) fn domain(&self, system: &System) -> Result<Vec<Interval>, SurfaceError> {
        if system.parts.formulas_name_outputs() {
            return Err(SurfaceError::Remembers);
        }
        let expected = system.parts.inputs.len();
        let given = self.domain.as_deref();
        if let Some(found) = given.map(<[_]>::len).filter(|&found| found != expected) {
            return Err(SurfaceError::Count { found, expected });
        }
        let universes = system.parts.inputs.iter().enumerate();
        universes
            .map(|(input, part)| {
                let universe = |u: Universe| [u.lower, u.upper];
                let own = given.and_then(|domain| domain.get(input).copied());
                let [lower, upper] = own
                    .or(part.universe.map(universe))
                    .ok_or(SurfaceError::NoUniverse { input })?;
                let side = Interval::new(lower, upper).filter(|side| side.is_bounded());
                side.ok_or(SurfaceError::Domain { input })
            })
            .collect()
    }

    pub(super) fn rest(&self, domain: &[Interval]) -> Result<Vec<f64>, SurfaceError> {
        let Some(rest) = &self.rest else {
            let rest = |side: &Interval| if side.contains(0.0) { 0.0 } else { side.midpoint() };
            return Ok(domain.iter().map(rest).collect());
        };
        let (found, expected) = (rest.len(), domain.len());
        if found != expected {
            return Err(SurfaceError::Count { found, expected });
        }
        let outside = rest.iter().zip(domain).position(|(rest, side)| !side.contains(*rest));
        outside.map_or_else(|| Ok(rest.clone()), |input| Err(SurfaceError::Rest { input }))
    }
}
