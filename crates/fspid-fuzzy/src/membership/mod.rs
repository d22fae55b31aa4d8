//! Membership functions: one file each, one row in [`FAMILY`].
//!
//! A member brings its name, its parameters with units and ranges, an example and its equation in C
//! beside the one in Rust, so that documentation, checks and generated code come from one place.

mod gaussian;
mod triangle;

pub use gaussian::Gaussian;
pub use triangle::Triangle;

use crate::error::FuzzyError;
use crate::real::Real;

/// What values a parameter may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Range {
    /// Any finite number.
    Finite,
    /// Any finite number above zero.
    Positive,
}

impl Range {
    /// The range in words.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::Finite => "a finite number",
            Self::Positive => "a finite number above 0",
        }
    }

    /// True if `value` is in the range; false for NaN.
    #[must_use]
    pub fn allows(self, value: f64) -> bool {
        value.is_finite() && (matches!(self, Self::Finite) || value > 0.0)
    }
}

/// A parameter of a membership function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Param {
    /// Name in files and messages.
    pub name: &'static str,
    /// Unit; `variable` stands for the unit of the variable itself.
    pub unit: &'static str,
    /// Allowed values.
    pub range: Range,
}

/// A membership function over one variable.
pub trait Shape<R: Real>: Sized {
    /// Name in files and messages.
    const NAME: &'static str;
    /// Parameters in order.
    const PARAMS: &'static [Param];
    /// Parameters of a typical member.
    const EXAMPLE: &'static [f64];
    /// The grade as a C expression in `x` and the parameters.
    const C: &'static str;

    /// The member with these parameters, in the order of [`PARAMS`](Self::PARAMS).
    ///
    /// # Errors
    /// [`FuzzyError::Parameter`] names the first parameter that is missing or out of its range.
    fn new(params: &[f64]) -> Result<Self, FuzzyError>;

    /// Grade of membership of `x`, from 0 to 1.
    fn grade(&self, x: R) -> R;
}

/// The parameters of `S`, each within its range.
fn checked<R: Real, S: Shape<R>, const N: usize>(params: &[f64]) -> Result<[R; N], FuzzyError> {
    let mut values = [R::ZERO; N];
    for (index, (param, value)) in S::PARAMS.iter().zip(&mut values).enumerate() {
        let found = params.get(index).copied().unwrap_or(f64::NAN);
        *value = R::from_f64(found);
        if !(param.range.allows(found) && param.range.allows(value.to_f64())) {
            let allowed = param.range.text();
            return Err(FuzzyError::Parameter { name: param.name, found, allowed });
        }
    }
    Ok(values)
}

/// A row of the list of members: name, parameters, example, equation in C.
#[derive(Clone, Copy, Debug)]
pub struct Member {
    /// Name in files and messages.
    pub name: &'static str,
    /// Parameters in order.
    pub params: &'static [Param],
    /// Parameters of a typical member.
    pub example: &'static [f64],
    /// The grade as a C expression.
    pub c: &'static str,
    /// Grade of `x` for parameters, or why they are refused.
    pub grade: fn(&[f64], f64) -> Result<f64, FuzzyError>,
}

const fn row<S: Shape<f64>>() -> Member {
    Member {
        name: S::NAME,
        params: S::PARAMS,
        example: S::EXAMPLE,
        c: S::C,
        grade: |params, x| Ok(S::new(params)?.grade(x)),
    }
}

/// Every membership function.
pub const FAMILY: &[Member] = &[row::<Gaussian<f64>>(), row::<Triangle<f64>>()];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_member_grades_within_zero_and_one_and_reaches_one() {
        for member in FAMILY {
            let grades = (-1000..=1000)
                .map(|i| (member.grade)(member.example, f64::from(i) * 0.01).expect("example"));
            let mut top = 0.0_f64;
            for grade in grades {
                assert!((0.0..=1.0).contains(&grade), "{}: {grade}", member.name);
                top = top.max(grade);
            }
            assert!(top > 0.999, "{} tops at {top}", member.name);
        }
    }

    #[test]
    fn every_member_refuses_bad_parameters_by_name() {
        for member in FAMILY {
            for (index, param) in member.params.iter().enumerate() {
                for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -1.0] {
                    let mut params = [0.0; 8];
                    params[..member.example.len()].copy_from_slice(member.example);
                    params[index] = bad;
                    let answer = (member.grade)(&params[..member.example.len()], 0.0);
                    let refused = matches!(answer,
                        Err(FuzzyError::Parameter { name, .. }) if name == param.name);
                    assert_eq!(refused, !param.range.allows(bad), "{} {bad}", member.name);
                }
            }
            assert!((member.grade)(&[], 0.0).is_err(), "{} without parameters", member.name);
        }
    }

    #[test]
    fn every_member_names_its_parameters_in_its_c_expression() {
        for member in FAMILY {
            for param in member.params {
                assert!(member.c.contains(param.name), "{}: {}", member.name, param.name);
            }
        }
    }
}
