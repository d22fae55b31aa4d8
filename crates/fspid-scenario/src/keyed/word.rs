//! Words of a file as types.
//!
//! The list that a key allows and the type that a reader matches come from the same lines, and readers match without a
//! wildcard: a word that is added or renamed does not compile until every reader says what it means.

/// A type of which each value is a word of a file.
pub(crate) trait Word: Copy + Sync + 'static {
    /// The words, in the order in which they are told.
    const WORDS: &'static [&'static str];
    /// The values, in the same order.
    const ALL: &'static [Self];

    /// The value that a word stands for.
    fn from_word(word: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|value| value.word() == word)
    }

    /// The word for the value.
    fn word(self) -> &'static str;
}

/// A choice of words as an enum of its own.
macro_rules! words {
    ($(#[$doc:meta])* $name:ident { $($variant:ident = $word:literal),+ $(,)? }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[allow(clippy::enum_variant_names, reason = "the words of the file have it")]
        pub(crate) enum $name { $($variant),+ }

        impl $name {
            /// The word in files.
            #[allow(dead_code, reason = "kinds of tables name their variants by it")]
            pub(crate) const fn name(self) -> &'static str {
                match self { $(Self::$variant => $word),+ }
            }
        }

        $crate::keyed::word::words_of!($name { $($variant = $word),+ });
    };
}

/// Words for the values of an enum that there is already; a value without a word does not compile.
macro_rules! words_of {
    ($name:ty { $($variant:ident = $word:literal),+ $(,)? }) => {
        impl $crate::keyed::word::Word for $name {
            const WORDS: &'static [&'static str] = &[$($word),+];
            const ALL: &'static [Self] = &[$(<$name>::$variant),+];

            fn word(self) -> &'static str {
                match self { $(<$name>::$variant => $word),+ }
            }
        }
    };
}

pub(crate) use {words, words_of};
