//! What "and" and "or" mean for grades: t-norms and s-norms, one file each, one row in the list.
//!
//! An equation is written once, generic over [`Scalar`]. It is arranged so that the identity
//! ($a \otimes 1 = a$, $a \oplus 0 = a$) holds to the last bit and no division is 0/0.

mod algebraic_product;
mod algebraic_sum;
mod bounded_difference;
mod bounded_sum;
mod drastic_product;
mod drastic_sum;
mod einstein_product;
mod einstein_sum;
mod hamacher_product;
mod hamacher_sum;
mod maximum;
mod minimum;
mod nilpotent_maximum;
mod nilpotent_minimum;
mod normalized_sum;
mod unbounded_sum;

pub use algebraic_product::AlgebraicProduct;
pub use algebraic_sum::AlgebraicSum;
pub use bounded_difference::BoundedDifference;
pub use bounded_sum::BoundedSum;
pub use drastic_product::DrasticProduct;
pub use drastic_sum::DrasticSum;
pub use einstein_product::EinsteinProduct;
pub use einstein_sum::EinsteinSum;
pub use hamacher_product::HamacherProduct;
pub use hamacher_sum::HamacherSum;
pub use maximum::Maximum;
pub use minimum::Minimum;
pub use nilpotent_maximum::NilpotentMaximum;
pub use nilpotent_minimum::NilpotentMinimum;
pub use normalized_sum::NormalizedSum;
pub use unbounded_sum::UnboundedSum;

use fspid_numeric::scalar::Scalar;

/// An "and" of two grades in [0, 1].
pub trait TNorm {
    /// Name in files and messages.
    const NAME: &'static str;
    /// The "or" that is its mirror image: $a \oplus b = 1 - (1 - a) \otimes (1 - b)$.
    const DUAL: SNormKind;

    /// $a \otimes b$.
    fn apply<S: Scalar>(a: S, b: S) -> S;
}

/// An "or" of two grades in [0, 1].
pub trait SNorm {
    /// Name in files and messages.
    const NAME: &'static str;

    /// $a \oplus b$.
    fn apply<S: Scalar>(a: S, b: S) -> S;
}

/// A divisor that is not negative, and not 0 either.
fn not_zero<S: Scalar>(divisor: S) -> S {
    divisor.larger(S::constant(f64::from_bits(1)))
}

/// Makes the enum of a list of norms.
macro_rules! family {
    ($(#[$doc:meta])* $kind:ident, $norm:ident, [$($member:ident),* $(,)?]) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum $kind {
            $(#[doc = concat!("See [`", stringify!($member), "`](enum@", stringify!($member), ").")] $member,)*
        }

        impl $kind {
            /// Every norm.
            pub const ALL: &[Self] = &[$(Self::$member),*];

            /// Name in files and messages.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$member => <$member as $norm>::NAME,)* }
            }

            /// The norm of two grades in [0, 1].
            #[inline]
            #[must_use]
            pub fn apply<S: Scalar>(self, a: S, b: S) -> S {
                match self { $(Self::$member => <$member as $norm>::apply(a, b),)* }
            }

            /// The norm with that name.
            #[must_use]
            pub fn from_name(name: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|kind| kind.name() == name)
            }
        }
    };
}

// One row a norm.
family!(
    /// A t-norm, chosen at run time.
    TNormKind, TNorm, [
    Minimum, AlgebraicProduct, BoundedDifference, DrasticProduct, EinsteinProduct, HamacherProduct, NilpotentMinimum,
]);
family!(
    /// An s-norm, chosen at run time.
    SNormKind, SNorm, [
    Maximum, AlgebraicSum, BoundedSum, DrasticSum, EinsteinSum, HamacherSum, NilpotentMaximum, NormalizedSum, UnboundedSum,
]);

impl TNormKind {
    /// The "or" that is its mirror image: $a \oplus b = 1 - (1 - a) \otimes (1 - b)$.
    #[must_use]
    pub const fn dual(self) -> SNormKind {
        match self {
            Self::Minimum => Minimum::DUAL,
            Self::AlgebraicProduct => AlgebraicProduct::DUAL,
            Self::BoundedDifference => BoundedDifference::DUAL,
            Self::DrasticProduct => DrasticProduct::DUAL,
            Self::EinsteinProduct => EinsteinProduct::DUAL,
            Self::HamacherProduct => HamacherProduct::DUAL,
            Self::NilpotentMinimum => NilpotentMinimum::DUAL,
        }
    }
}

#[cfg(test)]
mod tests;
