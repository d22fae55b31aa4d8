//! The norms of a general system: a member of the family, or a formula.

use crate::formula::Formula;
use crate::norm::{SNormKind, TNormKind};
use fspid_numeric::scalar::Scalar;

macro_rules! norm {
    ($(#[$doc:meta])* $name:ident, $kind:ident) => {
        $(#[$doc])*
        #[derive(Clone, Debug, PartialEq)]
        pub enum $name {
            /// A member of the family.
            Kind($kind),
            /// A formula in the two grades `a` (variable 0) and `b` (variable 1), cut off to [0, 1].
            Formula(Formula),
        }

        impl $name {
            /// The norm of two grades.
            #[inline]
            pub fn apply<S: Scalar>(&self, left: S, right: S) -> S {
                match self {
                    Self::Kind(kind) => kind.apply(left, right),
                    Self::Formula(formula) => formula.evaluate(&[left, right]).unit(),
                }
            }

            /// True for this member of the family.
            #[must_use]
            pub fn is(&self, kind: $kind) -> bool {
                matches!(self, Self::Kind(found) if *found == kind)
            }
        }

        impl From<$kind> for $name {
            fn from(kind: $kind) -> Self {
                Self::Kind(kind)
            }
        }
    };
}

norm!(
    /// A t-norm: *and*, or the shaping of a conclusion by a rule's strength.
    TNorm,
    TNormKind
);
norm!(
    /// An s-norm: *or*, or the joining of several rules' conclusions.
    SNorm,
    SNormKind
);

impl Default for TNorm {
    fn default() -> Self {
        Self::Kind(TNormKind::Minimum)
    }
}

impl Default for SNorm {
    fn default() -> Self {
        Self::Kind(SNormKind::Maximum)
    }
}
