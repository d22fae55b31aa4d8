//! The equations of the controllers, each once, for every kind of number.
//!
//! What flies is asked with a float; flights side by side with the floats of each lane; a flight that is
//! linearised and the matrix of a loop with [dual numbers](fspid_numeric::scalar::Dual), and proofs with
//! duals of intervals. So an option that is added here is added everywhere.
//!
//! An equation chooses between cases of numbers only by [`if_less`](Scalar::if_less), never by `if`, as
//! everything that is generic over [`Scalar`] does. Cases of *structure* (which integral, which
//! anti-windup) are enums: they are the same for all lanes of a group and for all inputs of a derivative.
//! An option that is absent has numbers with which its equation does nothing: infinite limits, a factor
//! of 0.
//!
//! Not here: what is admitted, faults, overflow and the supervisor's answer, which have no derivative.

use fspid_numeric::{Real, Scalar};

use crate::limits::Limits;

mod pid;
mod tuner;

pub use pid::{AntiWindupKind, Free, Parts, PidEquations, PidNumbers, PidStructure, Regulated};
pub use tuner::{
    GainNumbers, LawKind, SecondInputKind, TunerEquations, TunerNumbers, TunerStructure,
};

/// Declares numbers by their names: a struct that is generic over their kind, so that it can hold those
/// of one controller or, in arrays, of many.
macro_rules! numbers {
    (
        $(#[$doc:meta])* $name:ident:
        $($(#[doc = $field_doc:literal])+ $field:ident),+ $(,)?
    ) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $name<S> {
            $($(#[doc = $field_doc])+ pub $field: S,)+
        }

        impl<S> $name<S> {
            /// How many numbers there are.
            pub const COUNT: usize = [$(stringify!($field)),+].len();

            /// Numbers from somewhere, one by one in the order of [`map`](Self::map).
            #[inline(always)]
            pub fn from_each(mut number: impl FnMut() -> S) -> Self {
                $name { $($field: number(),)+ }
            }

            /// The numbers as others, one by one.
            #[inline(always)]
            pub fn map<T>(&self, mut number: impl FnMut(&S) -> T) -> $name<T> {
                $name { $($field: number(&self.$field),)+ }
            }

            /// The numbers as others, one by one, each with its name and what it is in a line.
            pub fn map_named<T>(
                &self,
                mut number: impl FnMut(&'static str, &'static str, &S) -> T,
            ) -> $name<T> {
                $name {
                    $($field: number(
                        stringify!($field),
                        concat!($($field_doc),+),
                        &self.$field,
                    ),)+
                }
            }

            /// Puts others into these, one by one.
            #[inline(always)]
            pub fn put<T>(&mut self, others: $name<T>, mut put: impl FnMut(&mut S, T)) {
                $(put(&mut self.$field, others.$field);)+
            }
        }
    };
}
use numbers;

numbers! {
    /// What a controller remembers of the sample before, in numbers.
    Memory:
    /// Its command, rad.
    command_rad,
    /// The integral of `ki e` (bumpless) or the sum of `e` (literal), rad.
    integral,
    /// The filtered derivative, rad/s.
    derivative_rad_s,
    /// Its error, rad.
    error_rad,
    /// What the derivative acts on, rad.
    derivative_input_rad,
    /// Its proportional gain.
    kp,
    /// Its integral gain.
    ki,
    /// Its derivative gain.
    kd,
    /// Pitch of the reference model at this sample, rad.
    model_rad,
    /// Its rate, rad/s.
    model_rad_s,
}

/// The number moved into `[lower, upper]`; NaN stays NaN.
#[inline(always)]
fn limited<S: Scalar>(value: S, lower: S, upper: S) -> S {
    value.if_less(lower, lower, upper.if_less(value, upper, value))
}

/// Lower and upper end of limits, infinite where there are none.
fn ends<R: Real>(limits: Option<Limits<R>>) -> (R, R) {
    let infinity = R::from_f64(f64::INFINITY);
    limits.map_or((-infinity, infinity), |limits| (limits.lower(), limits.upper()))
}
