//! What differs from run to run of a campaign: distributions of the numbers of a scenario.
//!
//! A distribution takes a point of the open unit cube to numbers, by the inverse of its cumulative
//! distribution in each dimension, so that points that are spread evenly give values that are.
//! Where points come from is not known here, nor what the numbers mean: they have the units of
//! whatever they are written into.

use std::fmt;

mod choice;
mod cholesky;
mod correlated;
mod dispersed;
mod error;
mod normal;
pub mod standard_normal;
mod uniform;

#[cfg(test)]
mod tests;

pub use choice::Choice;
pub use correlated::Correlated;
pub use dispersed::{Dispersion, Drawn, Target};
pub use error::DispersionError;
pub use normal::Normal;
pub use uniform::{LogUniform, Uniform};

/// Seeds are below this, 2⁵², so that TOML's integers and JSON's numbers hold them exactly.
pub const SEED_LIMIT: u64 = 1 << 52;

/// What a distribution gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Draw {
    /// A number.
    Number(f64),
    /// Which value of a list, counted from 0.
    Index(usize),
    /// A seed for the random numbers of a run.
    Seed(u64),
}

/// The values between which a draw lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ends {
    /// The smallest one.
    pub smallest: Draw,
    /// The largest one.
    pub largest: Draw,
}

/// How something differs from run to run.
#[derive(Clone, Debug, PartialEq)]
pub enum Distribution {
    /// Normal, truncated or not.
    Normal(Normal),
    /// Uniform.
    Uniform(Uniform),
    /// Uniform in the logarithm.
    LogUniform(LogUniform),
    /// One of several values.
    Choice(Choice),
    /// A seed of its own for each run: the first 52 binary digits of the coordinate.
    ///
    /// It depends, as the coordinate does, on the campaign's seed, the dimension and the run. No
    /// two runs of a Latin hypercube or of Sobol's sequence share a seed: their coordinates differ
    /// in these digits. Of n random points two do with a probability of about n²/2⁵³: 1e-4 for
    /// a million runs.
    Seed,
    /// Several normal numbers that depend on each other.
    Correlated(Correlated),
}

impl Distribution {
    /// How many coordinates it takes, which is also how many values it gives.
    #[must_use]
    pub fn dimensions(&self) -> usize {
        match self {
            Self::Correlated(correlated) => correlated.entries().len(),
            _ => 1,
        }
    }

    /// Appends the values at a point of the open unit cube, one for each coordinate.
    ///
    /// # Errors
    /// [`DispersionError::Coordinates`] and [`DispersionError::Coordinate`] for a point with
    /// another number of coordinates than [`Distribution::dimensions`] or with one that is not
    /// strictly between 0 and 1.
    pub fn draw(&self, u: &[f64], into: &mut Vec<Draw>) -> Result<(), DispersionError> {
        let [first, ..] = *checked(u, self.dimensions())? else { return Ok(()) };
        into.push(match self {
            Self::Normal(normal) => Draw::Number(normal.quantile(first)),
            Self::Uniform(uniform) => Draw::Number(uniform.quantile(first)),
            Self::LogUniform(uniform) => Draw::Number(uniform.quantile(first)),
            Self::Choice(choice) => Draw::Index(choice.index(first)),
            Self::Seed => Draw::Seed((first * SEED_LIMIT as f64) as u64),
            Self::Correlated(correlated) => {
                into.extend(correlated.values(u).into_iter().map(Draw::Number));
                return Ok(());
            }
        });
        Ok(())
    }

    /// The ends of each value.
    ///
    /// Nothing comes from beyond them, but for the open side of a normal distribution that is not
    /// truncated there: of that side they leave out a share of 0.00135, as three standard
    /// deviations do.
    #[must_use]
    pub fn ends(&self) -> Vec<Ends> {
        let numbers = |[smallest, largest]: [f64; 2]| Ends {
            smallest: Draw::Number(smallest),
            largest: Draw::Number(largest),
        };
        match self {
            Self::Normal(normal) => vec![numbers(normal.ends())],
            Self::Uniform(uniform) => vec![numbers([uniform.lower(), uniform.upper()])],
            Self::LogUniform(uniform) => vec![numbers([uniform.lower(), uniform.upper()])],
            Self::Choice(choice) => {
                let [smallest, largest] = choice.ends().map(Draw::Index);
                vec![Ends { smallest, largest }]
            }
            Self::Seed => {
                vec![Ends { smallest: Draw::Seed(0), largest: Draw::Seed(SEED_LIMIT - 1) }]
            }
            Self::Correlated(correlated) => {
                correlated.entries().iter().map(|entry| numbers(entry.ends())).collect()
            }
        }
    }
}

/// In words, for what columns of results mean.
impl fmt::Display for Distribution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Normal(normal) => {
                let (mean, deviation) = (normal.mean(), normal.standard_deviation());
                write!(f, "normal, mean {mean:?}, standard deviation {deviation:?}")?;
                let ends = [("from", normal.lower()), ("to", normal.upper())];
                let mut cut = ends.into_iter().filter_map(|(word, end)| Some((word, end?)));
                cut.try_for_each(|(word, end)| write!(f, ", {word} {end:?}"))
            }
            Self::Uniform(uniform) => {
                write!(f, "uniform from {:?} to {:?}", uniform.lower(), uniform.upper())
            }
            Self::LogUniform(uniform) => {
                write!(f, "log-uniform from {:?} to {:?}", uniform.lower(), uniform.upper())
            }
            Self::Choice(choice) => write!(f, "one of {} values", choice.count()),
            Self::Seed => f.write_str("a seed for each run"),
            Self::Correlated(correlated) => {
                write!(f, "one of {} correlated normals", correlated.entries().len())
            }
        }
    }
}

/// A point, if it is one of the open unit cube of so many dimensions.
fn checked(u: &[f64], dimensions: usize) -> Result<&[f64], DispersionError> {
    if u.len() != dimensions {
        return Err(DispersionError::Coordinates { found: u.len(), allowed: dimensions });
    }
    match u.iter().position(|u| !(0.0 < *u && *u < 1.0)) {
        Some(index) => Err(DispersionError::Coordinate { index, value: u[index] }),
        None => Ok(u),
    }
}
