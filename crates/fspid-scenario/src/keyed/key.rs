//! Keys: constants that know the type of what they hold.

use std::fmt;

use super::held::Held;
use super::kind::{Kind, KindOf};
use super::section::Checked;

/// The name of a key. Only a key makes one, so that nothing is looked up by a word that may be misspelt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct KeyName(&'static str);

impl KeyName {
    /// As it stands in a text.
    pub(crate) const fn as_str(self) -> &'static str {
        self.0
    }
}

impl fmt::Display for KeyName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.0)
    }
}

impl<V: Held + ?Sized> From<Key<V>> for KeyName {
    fn from(key: Key<V>) -> Self {
        key.name
    }
}

/// A key of a table that holds a `V`.
pub(crate) struct Key<V: Held + ?Sized> {
    pub(crate) name: KeyName,
    kind: Kind,
    presence: Presence<V::Default>,
    /// What it means, in a line.
    doc: &'static str,
}

impl<V: Held + ?Sized> Clone for Key<V> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<V: Held + ?Sized> Copy for Key<V> {}

/// Whether a key must be there, and what holds if it is not.
#[derive(Clone, Copy)]
enum Presence<D> {
    Required,
    /// Nothing holds; the doc or a [`Choice`](super::Choice) says what that means.
    Optional,
    Default(D),
}

impl<V: Held + ?Sized> Key<V> {
    /// The unit, empty where there is none.
    pub(crate) const fn unit(&self) -> &'static str {
        self.kind.unit()
    }
}

/// A key of whatever type, as the check, the schema and lists of settings know it.
pub(crate) trait AnyKey: Sync {
    fn name(&self) -> KeyName;
    fn kind(&self) -> &Kind;
    fn doc(&self) -> &'static str;
    fn is_required(&self) -> bool;
    /// What holds where nothing is given.
    fn default(&self) -> Option<Checked>;
}

/// A key in the list of a table.
pub(crate) type KeyRow = &'static dyn AnyKey;

impl<V: Held + ?Sized> AnyKey for Key<V> {
    fn name(&self) -> KeyName {
        self.name
    }

    fn kind(&self) -> &Kind {
        &self.kind
    }

    fn doc(&self) -> &'static str {
        self.doc
    }

    fn is_required(&self) -> bool {
        matches!(self.presence, Presence::Required)
    }

    fn default(&self) -> Option<Checked> {
        match self.presence {
            Presence::Default(default) => V::checked(default),
            Presence::Required | Presence::Optional => None,
        }
    }
}

/// A key that must be there.
pub(crate) const fn required<V: Held + ?Sized>(
    name: &'static str,
    kind: KindOf<V>,
    doc: &'static str,
) -> Key<V> {
    Key { name: KeyName(name), kind: kind.any, presence: Presence::Required, doc }
}

/// A key that may be left out.
pub(crate) const fn optional<V: Held + ?Sized>(
    name: &'static str,
    kind: KindOf<V>,
    doc: &'static str,
) -> Key<V> {
    Key { name: KeyName(name), kind: kind.any, presence: Presence::Optional, doc }
}

/// A key with a default.
pub(crate) const fn defaulted<V: Held + ?Sized>(
    name: &'static str,
    kind: KindOf<V>,
    default: V::Default,
    doc: &'static str,
) -> Key<V> {
    Key { name: KeyName(name), kind: kind.any, presence: Presence::Default(default), doc }
}
