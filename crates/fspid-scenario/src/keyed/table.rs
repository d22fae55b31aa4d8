//! Tables: lists of keys, which of them exclude each other, and kinds.

use super::key::{KeyName, KeyRow};

/// A table of a text: its keys, which of them exclude each other, and its variants if it is chosen by `kind`.
pub(crate) struct Table {
    /// What it is, in a line.
    pub(crate) doc: &'static str,
    /// Keys in groups that several tables may share.
    pub(crate) groups: &'static [&'static [KeyRow]],
    /// Ways of saying the same thing, of which exactly one must be used.
    pub(crate) choices: &'static [Choice],
    /// The kinds, if the table has a `kind`.
    pub(crate) variants: &'static [Variant],
}

impl Table {
    /// Keys without those of a variant.
    pub(crate) fn keys(&self) -> impl Iterator<Item = KeyRow> + use<> {
        self.groups.iter().copied().flatten().copied()
    }

    /// The keys together with those of the variant that is called `kind`.
    pub(crate) fn keys_of(&self, kind: &str) -> impl Iterator<Item = KeyRow> + use<> {
        let variant = self.variants.iter().find(|variant| variant.name == kind);
        self.keys().chain(variant.into_iter().flat_map(|variant| variant.table.keys()))
    }

    /// The keys together with those of all variants; several variants may have the same key.
    pub(crate) fn all_keys(&self) -> impl Iterator<Item = KeyRow> + use<> {
        self.keys().chain(self.variants.iter().flat_map(|variant| variant.table.keys()))
    }

    /// True if the table may be empty, so that an absent one has its defaults.
    pub(crate) fn may_be_empty(&self) -> bool {
        let is_free = self.variants.is_empty() && self.choices.is_empty();
        is_free && !self.keys().any(|key| key.is_required())
    }
}

/// A table without choices and kinds.
pub(crate) const fn plain(doc: &'static str, groups: &'static [&'static [KeyRow]]) -> Table {
    choosing(doc, groups, &[])
}

/// A table without kinds.
pub(crate) const fn choosing(
    doc: &'static str,
    groups: &'static [&'static [KeyRow]],
    choices: &'static [Choice],
) -> Table {
    Table { doc, groups, choices, variants: &[] }
}

/// A table whose `kind` says what else is in it.
pub(crate) const fn of_kinds(
    doc: &'static str,
    groups: &'static [&'static [KeyRow]],
    variants: &'static [Variant],
) -> Table {
    Table { doc, groups, choices: &[], variants }
}

/// What a word behind `kind` adds.
pub(crate) const fn variant(name: &'static str, table: Table) -> Variant {
    Variant { name, table }
}

/// One kind of a table that is chosen by `kind`.
pub(crate) struct Variant {
    /// The word.
    pub(crate) name: &'static str,
    /// What it adds.
    pub(crate) table: Table,
}

/// Groups of keys that exclude each other.
pub(crate) struct Choice {
    /// The alternatives.
    pub(crate) ways: &'static [Way],
}

/// One alternative: keys that must be there together, and keys that may be.
pub(crate) struct Way {
    /// All of these.
    pub(crate) required: &'static [KeyName],
    /// And any of these.
    pub(crate) optional: &'static [KeyName],
}

/// Exactly one of some keys.
macro_rules! one_of {
    ($($key:expr),+) => {
        $crate::keyed::Choice { ways: &[$($crate::keyed::Way { required: &[$key.name], optional: &[] }),+] }
    };
}

pub(crate) use one_of;
