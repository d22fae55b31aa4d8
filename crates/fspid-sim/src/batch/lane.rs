//! Numbers of all lanes, and truths about them as masks.

/// One number a lane.
pub(super) type Lanes<const W: usize> = [f64; W];
/// One truth a lane, as wide as a number: [`YES`] or [`NO`].
pub(super) type Mask<const W: usize> = [u64; W];

/// True.
pub(super) const YES: u64 = u64::MAX;
/// False.
pub(super) const NO: u64 = 0;

/// A truth as a mask.
#[inline(always)]
pub(super) fn mask(truth: bool) -> u64 {
    if truth { YES } else { NO }
}

/// True if all lanes are.
#[inline(always)]
pub(super) fn all<const W: usize>(truths: &Mask<W>) -> bool {
    truths.iter().fold(YES, |all, truth| all & truth) == YES
}

/// The value moved into `[lower, upper]`, as `Real::limited` does.
#[inline(always)]
pub(super) fn limited(value: f64, lower: f64, upper: f64) -> f64 {
    if value < lower {
        lower
    } else if value > upper {
        upper
    } else {
        value
    }
}

/// Declares numbers of one flight, and the same of all lanes.
macro_rules! numbers {
    (
        $(#[$one_doc:meta])* $one:ident,
        $(#[$many_doc:meta])* $many:ident:
        $($(#[$field_doc:meta])* $field:ident),+ $(,)?
    ) => {
        $(#[$one_doc])*
        #[derive(Clone, Copy, Debug)]
        pub(super) struct $one {
            $($(#[$field_doc])* pub(super) $field: f64,)+
        }

        $(#[$many_doc])*
        #[derive(Clone, Debug)]
        pub(super) struct $many<const W: usize> {
            $($(#[$field_doc])* pub(super) $field: $crate::batch::lane::Lanes<W>,)+
        }

        impl<const W: usize> $many<W> {
            /// The same numbers in each lane.
            pub(super) fn same(one: $one) -> Self {
                Self { $($field: [one.$field; W],)+ }
            }

            /// Puts one flight's numbers into a lane.
            pub(super) fn set(&mut self, lane: usize, one: $one) {
                $(self.$field[lane] = one.$field;)+
            }
        }
    };
}
pub(super) use numbers;
