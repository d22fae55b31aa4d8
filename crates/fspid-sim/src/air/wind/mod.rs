//! Winds and gusts as functions of place and time: one file each, one row in the list below
//! `winds!`.
//!
//! A member brings its name, its parameters with units and ranges, and an example, so that files,
//! checks and documentation come from one place. A [table](WindTable) is data and no numbers, and stands beside them.

mod full_cycle;
mod log_shear;
mod microburst;
mod one_minus_cosine;
mod ramp_hold;
mod steady;
mod table;

pub use full_cycle::{FullCycle, design_gust_m_s, reference_gust_m_s};
pub use log_shear::LogShear;
pub use microburst::Microburst;
pub use ramp_hold::RampHold;
pub use steady::Steady;
pub use table::{Along, TableRow, WindTable};

use std::sync::Arc;

use fspid_fuzzy::membership::{Param, Range};

use crate::error::SimError;

/// Where an aircraft is and how far it has come.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AirPlace {
    /// Time since the start, s.
    pub time_s: f64,
    /// Distance flown through the air since the start, m.
    pub distance_m: f64,
    /// Position north of the origin, m.
    pub north_m: f64,
    /// Position east of the origin, m.
    pub east_m: f64,
    /// Height above the ground, m.
    pub height_m: f64,
}

/// How the air moves at a place.
///
/// The air's velocity is the Earth part, turned into body axes, plus the body part; motions add.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AirMotion {
    /// Velocity along north, east, down, m/s.
    pub earth_m_s: [f64; 3],
    /// Velocity along forward, right, down of the body, m/s.
    pub body_m_s: [f64; 3],
    /// Angular velocity p, q, r about body axes, rad/s; the sense is that of the module above.
    pub body_rad_s: [f64; 3],
}

impl std::ops::Add for AirMotion {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let sum = |a: [f64; 3], b: [f64; 3]| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
        Self {
            earth_m_s: sum(self.earth_m_s, other.earth_m_s),
            body_m_s: sum(self.body_m_s, other.body_m_s),
            body_rad_s: sum(self.body_rad_s, other.body_rad_s),
        }
    }
}

/// Where a wind is not smooth along the way: an integration that ends a step there keeps its order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Corners {
    /// Distances flown through the air since the start, m.
    pub distance_m: Vec<f64>,
    /// Heights above the ground, m.
    pub height_m: Vec<f64>,
    /// Times since the start, s.
    pub time_s: Vec<f64>,
}

impl Corners {
    /// Those of a gust that begins at a distance and is that long.
    pub(super) fn along(start_m: f64, length_m: f64) -> Self {
        Self { distance_m: vec![start_m, start_m + length_m], ..Self::default() }
    }
}

/// The motion of several winds together.
#[must_use]
pub fn sum_at(winds: &[Wind], place: &AirPlace) -> AirMotion {
    winds.iter().fold(AirMotion::default(), |sum, wind| sum + wind.at(place))
}

/// A member of the family.
pub trait WindField: Sized {
    /// Name in files and messages.
    const NAME: &'static str;
    /// Parameters in order.
    const PARAMS: &'static [Param];
    /// Parameters of a typical member.
    const EXAMPLE: &'static [f64];

    /// The member with these parameters, which are as many as [`PARAMS`](Self::PARAMS) and within
    /// their ranges.
    fn from_checked(params: &[f64]) -> Self;

    /// How the air moves at a place. Finite wherever the place is.
    fn at(&self, place: &AirPlace) -> AirMotion;

    /// Where it is not smooth; nowhere if nothing is said.
    fn corners(&self) -> Corners {
        Corners::default()
    }
}

const fn number(name: &'static str, unit: &'static str) -> Param {
    Param { name, unit, range: Range::Finite }
}

const fn size(name: &'static str, unit: &'static str) -> Param {
    Param { name, unit, range: Range::Positive }
}

/// The first `N` parameters; 0 where there are fewer.
fn first<const N: usize>(params: &[f64]) -> [f64; N] {
    std::array::from_fn(|index| params.get(index).copied().unwrap_or(0.0))
}

fn checked<W: WindField>(params: &[f64]) -> Result<W, SimError> {
    if params.len() != W::PARAMS.len() {
        return Err(SimError::ParameterCount {
            kind: W::NAME,
            found: params.len(),
            allowed: W::PARAMS.len(),
        });
    }
    for (param, &found) in W::PARAMS.iter().zip(params) {
        if !param.range.allows(found) {
            let (what, allowed) = (param.name, param.range.text());
            return Err(SimError::Number { what, found, allowed });
        }
    }
    Ok(W::from_checked(params))
}

/// Makes [`Wind`] and [`WindKind`] from the list of members.
macro_rules! winds {
    ($($member:ident),* $(,)?) => {
        /// A wind or gust.
        #[derive(Clone, Debug, PartialEq)]
        #[non_exhaustive]
        pub enum Wind {
            /// Rows of data, see [`WindTable`].
            Table(Arc<WindTable>),
            $(#[doc = concat!("See [`", stringify!($member), "`](struct@", stringify!($member), ").")]
            $member($member),)*
        }

        /// What kinds of wind there are.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum WindKind {
            /// Rows of data, see [`WindTable`]; [`ALL`](Self::ALL) are the kinds that numbers make.
            Table,
            $(#[doc = concat!("See [`", stringify!($member), "`](struct@", stringify!($member), ").")]
            $member,)*
        }

        impl Wind {
            /// How the air moves at a place.
            #[must_use]
            pub fn at(&self, place: &AirPlace) -> AirMotion {
                match self {
                    Self::Table(table) => table.at(place),
                    $(Self::$member(wind) => wind.at(place),)*
                }
            }

            /// Where it is not smooth.
            #[must_use]
            pub fn corners(&self) -> Corners {
                match self {
                    Self::Table(table) => table.corners(),
                    $(Self::$member(wind) => wind.corners(),)*
                }
            }

            /// Which kind it is.
            #[must_use]
            pub fn kind(&self) -> WindKind {
                match self {
                    Self::Table(_) => WindKind::Table,
                    $(Self::$member(_) => WindKind::$member,)*
                }
            }
        }

        impl WindKind {
            /// Every kind that numbers make.
            pub const ALL: &[Self] = &[$(Self::$member),*];

            /// Name in files and messages.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { Self::Table => WindTable::NAME, $(Self::$member => $member::NAME,)* }
            }

            /// Parameters in order; a table has none.
            #[must_use]
            pub const fn params(self) -> &'static [Param] {
                match self { Self::Table => &[], $(Self::$member => $member::PARAMS,)* }
            }

            /// Parameters of a typical member; a table has none.
            #[must_use]
            pub const fn example(self) -> &'static [f64] {
                match self { Self::Table => &[], $(Self::$member => $member::EXAMPLE,)* }
            }

            /// The wind with these parameters.
            ///
            /// # Errors
            /// [`SimError::ParameterCount`], also for a table, which [`WindTable::new`] makes; or
            /// [`SimError::Number`] for the first parameter that is not allowed.
            pub fn build(self, params: &[f64]) -> Result<Wind, SimError> {
                match self {
                    Self::Table => Err(SimError::ParameterCount {
                        kind: WindTable::NAME,
                        found: params.len(),
                        allowed: 0,
                    }),
                    $(Self::$member => checked(params).map(Wind::$member),)*
                }
            }

            /// The kind with that name.
            #[must_use]
            pub fn from_name(name: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|kind| kind.name() == name)
            }
        }
    };
}

winds! {
    Steady,
    LogShear,
    Microburst,
    RampHold,
    FullCycle,
}

#[cfg(test)]
mod tests;
