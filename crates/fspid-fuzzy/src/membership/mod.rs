//! Membership functions: one file each, one row in the list below `family!`.
//!
//! A member brings its name, its parameters with units and ranges, an example and its equation in C
//! beside the one in Rust, so that documentation, checks and generated code come from one place.
//! The equation is written once, generic over [`Scalar`]: the same line answers values,
//! derivatives with respect to the input and to every parameter, and sound intervals.

mod arc;
mod bell;
mod concave;
mod cosine;
mod gaussian;
mod gaussian_product;
mod linear_s;
mod linear_z;
mod pi;
mod points;
mod ramp;
mod rectangle;
mod semi_ellipse;
mod side;
mod sigmoid;
mod sigmoid_difference;
mod sigmoid_product;
mod singleton;
mod smooth_s;
mod smooth_z;
mod spike;
mod step;
mod trapezoid;
mod triangle;

pub use arc::Arc;
pub use bell::Bell;
pub use concave::Concave;
pub use cosine::Cosine;
pub use gaussian::Gaussian;
pub(crate) use gaussian::SIGMA_PER_SPACING;
pub use gaussian_product::GaussianProduct;
pub use linear_s::LinearS;
pub use linear_z::LinearZ;
pub use pi::Pi;
pub use points::Points;
pub use ramp::Ramp;
pub use rectangle::Rectangle;
pub use semi_ellipse::SemiEllipse;
pub(crate) use side::{root, smooth, smooth_inverse};
pub use sigmoid::Sigmoid;
pub use sigmoid_difference::SigmoidDifference;
pub use sigmoid_product::SigmoidProduct;
pub use singleton::Singleton;
pub use smooth_s::SmoothS;
pub use smooth_z::SmoothZ;
pub use spike::Spike;
pub use step::Step;
pub use trapezoid::Trapezoid;
pub use triangle::Triangle;

use crate::error::FuzzyError;
use fspid_numeric::scalar::Scalar;

/// What values a parameter may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Range {
    /// Any finite number.
    Finite,
    /// Any finite number above zero.
    Positive,
    /// Any finite number but zero.
    NonZero,
    /// Any number, infinities included.
    Extended,
    /// A grade, from 0 to 1.
    Grade,
    /// 1 or -1.
    Sign,
}

impl Range {
    /// The range in words.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::Finite => "a finite number",
            Self::Positive => "a finite number above 0",
            Self::NonZero => "a finite number other than 0",
            Self::Extended => "a number, inf or -inf",
            Self::Grade => "a number from 0 to 1",
            Self::Sign => "1 or -1",
        }
    }

    /// True if `value` is in the range; false for NaN.
    #[must_use]
    pub fn allows(self, value: f64) -> bool {
        match self {
            Self::Finite => value.is_finite(),
            Self::Positive => value.is_finite() && value > 0.0,
            Self::NonZero => value.is_finite() && value != 0.0,
            Self::Extended => !value.is_nan(),
            Self::Grade => (0.0..=1.0).contains(&value),
            Self::Sign => matches!(value, 1.0 | -1.0),
        }
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
    /// Grade there, in [0, 1]; at a jump two vertices share their `x`, at an isolated point three.
    pub grade: f64,
}

/// Hands on the corners that are not at infinity; of a set without any, one with its grade.
fn finite_vertices<const N: usize>(corners: [(f64, f64); N], each: &mut dyn FnMut(Vertex)) {
    let mut seen = false;
    for (x, grade) in corners.into_iter().filter(|(x, _)| x.is_finite()) {
        seen = true;
        each(Vertex { x, grade });
    }
    if !seen {
        each(Vertex { x: 0.0, grade: 1.0 });
    }
}

/// A kind of membership function over one variable.
pub trait Shape {
    /// Name in files and messages.
    const NAME: &'static str;
    /// Parameters in order. If [`REPEATS`](Self::REPEATS), the group that is repeated.
    const PARAMS: &'static [Param];
    /// Parameters of a typical member.
    const EXAMPLE: &'static [f64];
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

    /// Grade of membership of `x`, from 0 to 1, also of an infinite `x`; 0 or NaN for NaN. The
    /// parameters are as many as [`PARAMS`](Self::PARAMS) says and have been checked.
    fn grade<S: Scalar>(params: &[S], x: S) -> S;

    /// The corners of a piecewise-linear member from left to right; before the first and after the
    /// last the grade stays what it is there. Nothing for other members.
    fn vertices(params: &[f64], each: &mut dyn FnMut(Vertex)) {
        let _ = (params, each);
    }

    /// Where the grade has a kink or a jump, or where its curvature may have one, in any order.
    /// By default the vertices.
    fn corners(params: &[f64], each: &mut dyn FnMut(f64)) {
        Self::vertices(params, &mut |vertex| each(vertex.x));
    }

    /// The `x` of a grade in [0, 1] where the member rises or falls strictly (Tsukamoto's method);
    /// infinite for a grade that is only approached, `None` for members that do neither.
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
    let whole_groups = !params.is_empty() && params.len().is_multiple_of(S::PARAMS.len().max(1));
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
            $(#[doc = concat!("See [`", stringify!($member), "`](enum@", stringify!($member), ").")] $member,)*
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
family![
    Arc,
    Bell,
    Concave,
    Cosine,
    Gaussian,
    GaussianProduct,
    LinearS,
    LinearZ,
    Pi,
    Points,
    Ramp,
    Rectangle,
    SemiEllipse,
    Sigmoid,
    SigmoidDifference,
    SigmoidProduct,
    Singleton,
    SmoothS,
    SmoothZ,
    Spike,
    Step,
    Trapezoid,
    Triangle,
];

#[cfg(test)]
mod tests;
