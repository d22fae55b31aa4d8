//! Membership functions: one file each, one row in the list at the foot of [`family!`].
//!
//! A member brings its name, its parameters with units and ranges, an example and its equation in C
//! beside the one in Rust, so that documentation, checks and generated code come from one place.
//! The equation is written once, generic over [`Scalar`]: the same line answers values,
//! derivatives with respect to the input and to every parameter, and sound intervals.

mod gaussian;
mod triangle;

pub use gaussian::Gaussian;
pub(crate) use gaussian::SIGMA_PER_SPACING;
pub use triangle::Triangle;

use crate::error::FuzzyError;
use crate::scalar::Scalar;

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

/// A corner of a piecewise-linear membership function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Where, in the unit of the variable.
    pub x: f64,
    /// Grade there, in [0, 1]; at a jump two vertices share their `x`.
    pub grade: f64,
}

/// A kind of membership function over one variable.
pub trait Shape {
    /// Name in files and messages.
    const NAME: &'static str;
    /// Parameters in order. If [`REPEATS`](Self::REPEATS), the group that is repeated.
    const PARAMS: &'static [Param];
    /// Parameters of a typical member.
    const EXAMPLE: &'static [f64];
    /// The grade as a C expression in `x` and the parameters.
    const C: &'static str;
    /// True if the parameters are any number of groups of [`PARAMS`](Self::PARAMS).
    const REPEATS: bool = false;
    /// True if the graph consists of straight pieces (and jumps), which [`vertices`](Self::vertices)
    /// then tells; exact integrals rest on this.
    const PIECEWISE_LINEAR: bool = false;

    /// Whether the parameters, each within its range, go together (such as: in ascending order).
    ///
    /// # Errors
    /// [`FuzzyError::Parameter`] names the parameter that is wrong and says what is allowed.
    fn relation(params: &[f64]) -> Result<(), FuzzyError> {
        let _ = params;
        Ok(())
    }

    /// Grade of membership of `x`, from 0 to 1. The parameters are as many as
    /// [`PARAMS`](Self::PARAMS) says and have been checked.
    fn grade<S: Scalar>(params: &[S], x: S) -> S;

    /// The corners of a piecewise-linear member from left to right; before the first and after the
    /// last the grade stays what it is there. Nothing for other members.
    fn vertices(params: &[f64], each: &mut dyn FnMut(Vertex)) {
        let _ = (params, each);
    }

    /// Where the grade has a kink or a jump, in any order. By default the vertices.
    fn corners(params: &[f64], each: &mut dyn FnMut(f64)) {
        Self::vertices(params, &mut |vertex| each(vertex.x));
    }

    /// The `x` of a grade in [0, 1] where the member rises or falls strictly (Tsukamoto's method);
    /// `None` for members that do neither.
    fn inverse<S: Scalar>(params: &[S], grade: S) -> Option<S> {
        let _ = (params, grade);
        None
    }
}

/// Refuses the first parameter of `S` that is missing, too many or out of its range.
fn checked<S: Shape>(params: &[f64]) -> Result<(), FuzzyError> {
    let wrong = |param: &Param, found| FuzzyError::Parameter {
        name: param.name,
        found,
        allowed: param.range.text(),
    };
    let whole_groups = params.len().is_multiple_of(S::PARAMS.len().max(1));
    let count_fits = if S::REPEATS { whole_groups } else { params.len() == S::PARAMS.len() };
    if !count_fits {
        return Err(FuzzyError::ParameterCount {
            shape: S::NAME,
            found: params.len(),
            expected: S::PARAMS.len(),
            repeats: S::REPEATS,
        });
    }
    for (param, &found) in S::PARAMS.iter().cycle().zip(params) {
        if !param.range.allows(found) {
            return Err(wrong(param, found));
        }
    }
    S::relation(params)
}

/// Makes [`ShapeKind`] from the list of members.
macro_rules! family {
    ($($member:ident),* $(,)?) => {
        /// A kind of membership function, chosen at run time.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum ShapeKind {
            $(#[doc = concat!("See [`", stringify!($member), "`](struct@", stringify!($member), ").")] $member,)*
        }

        impl ShapeKind {
            /// Every membership function.
            pub const ALL: &[Self] = &[$(Self::$member),*];

            /// Name in files and messages.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$member => $member::NAME,)* }
            }

            /// Parameters in order.
            #[must_use]
            pub const fn params(self) -> &'static [Param] {
                match self { $(Self::$member => $member::PARAMS,)* }
            }

            /// Parameters of a typical member.
            #[must_use]
            pub const fn example(self) -> &'static [f64] {
                match self { $(Self::$member => $member::EXAMPLE,)* }
            }

            /// The grade as a C expression.
            #[must_use]
            pub const fn c(self) -> &'static str {
                match self { $(Self::$member => $member::C,)* }
            }

            /// True if the parameters are any number of groups of [`params`](Self::params).
            #[must_use]
            pub const fn repeats(self) -> bool {
                match self { $(Self::$member => $member::REPEATS,)* }
            }

            /// True if the graph consists of straight pieces and jumps.
            #[must_use]
            pub const fn is_piecewise_linear(self) -> bool {
                match self { $(Self::$member => $member::PIECEWISE_LINEAR,)* }
            }

            /// Whether a member may have these parameters.
            ///
            /// # Errors
            /// [`FuzzyError::ParameterCount`], or [`FuzzyError::Parameter`] for the first parameter
            /// that is not allowed.
            pub fn check(self, params: &[f64]) -> Result<(), FuzzyError> {
                match self { $(Self::$member => checked::<$member>(params),)* }
            }

            /// Grade of membership of `x`; the parameters must have passed [`check`](Self::check).
            #[inline]
            pub fn grade<S: Scalar>(self, params: &[S], x: S) -> S {
                match self { $(Self::$member => $member::grade(params, x),)* }
            }

            /// The corners of a piecewise-linear member from left to right; nothing for others.
            pub fn vertices(self, params: &[f64], each: &mut dyn FnMut(Vertex)) {
                match self { $(Self::$member => $member::vertices(params, each),)* }
            }

            /// Where the grade has a kink or a jump, in any order.
            pub fn corners(self, params: &[f64], each: &mut dyn FnMut(f64)) {
                match self { $(Self::$member => $member::corners(params, each),)* }
            }

            /// The `x` of a grade where the member is strictly monotone.
            pub fn inverse<S: Scalar>(self, params: &[S], grade: S) -> Option<S> {
                match self { $(Self::$member => $member::inverse(params, grade),)* }
            }

            /// The kind with that name.
            #[must_use]
            pub fn from_name(name: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|kind| kind.name() == name)
            }
        }
    };
}

// One row a member.
family![Gaussian, Triangle];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_member_grades_within_zero_and_one_and_reaches_one() {
        for kind in ShapeKind::ALL {
            let grades = (-1000..=1000).map(|i| kind.grade(kind.example(), f64::from(i) * 0.01));
            let mut top = 0.0_f64;
            for grade in grades {
                assert!((0.0..=1.0).contains(&grade), "{}: {grade}", kind.name());
                top = top.max(grade);
            }
            assert!(top > 0.999, "{} tops at {top}", kind.name());
        }
    }

    #[test]
    fn every_member_refuses_bad_parameters_by_name() {
        for kind in ShapeKind::ALL {
            assert_eq!(kind.check(kind.example()), Ok(()), "{}", kind.name());
            for (index, param) in kind.params().iter().enumerate() {
                for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -1.0] {
                    let mut params = kind.example().to_vec();
                    params[index] = bad;
                    let refused = matches!(kind.check(&params),
                        Err(FuzzyError::Parameter { name, .. }) if name == param.name);
                    if !param.range.allows(bad) {
                        assert!(refused, "{} {} {bad}", kind.name(), param.name);
                    }
                }
            }
            assert!(kind.check(&[]).is_err(), "{} without parameters", kind.name());
        }
    }

    #[test]
    fn every_member_names_its_parameters_in_its_c_expression() {
        for kind in ShapeKind::ALL {
            for param in kind.params() {
                assert!(kind.c().contains(param.name), "{}: {}", kind.name(), param.name);
            }
        }
    }
}
