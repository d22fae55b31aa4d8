//! The specification of the files, from which the checker, the schema and the defaults come.
//!
//! A key is added in one place: its row in the lists of this folder, and the line of `build` that
//! uses it.

/// Exactly one of some keys.
macro_rules! one_of {
    ($($name:literal),+) => {
        Choice { ways: &[$(Way { required: &[$name], optional: &[] }),+] }
    };
}

mod actuator;
pub(crate) mod air;
pub(crate) mod aircraft;
pub(crate) mod controller;
mod data;
pub(crate) mod dispersion;
pub(crate) mod flight;
mod keys;
mod lqi;
mod requirement;
mod scenario;
mod schedule;
mod sensor;
pub(crate) mod signal;
mod tables;
pub(crate) mod tuning;
pub(crate) mod word;

pub(crate) use aircraft::{AIRCRAFT_FILE, AircraftKind};
pub(crate) use data::{PLANT_FILE, RULE_FILE};
pub use keys::scenario_keys;
pub(crate) use requirement::{NOT_IN, ONLY_IN, REQUIREMENT_FILE, SET_FILE, names_in_words};
pub(crate) use scenario::SCENARIO;
pub(crate) use tuning::FRONT;

/// Largest size of an angle, in degrees: where a flight has diverged.
pub(crate) const ANGLE_LIMIT_DEG: f64 = 1e6;

/// A table of the file: its keys, which of them exclude each other, and its variants if it is
/// chosen by `kind`.
#[derive(Debug)]
pub(crate) struct Table {
    /// What it is, in a line.
    pub(crate) doc: &'static str,
    /// Keys in groups that several tables may share.
    pub(crate) groups: &'static [&'static [Key]],
    /// Ways of saying the same thing, of which exactly one must be used.
    pub(crate) choices: &'static [Choice],
    /// The kinds, if the table has a `kind`.
    pub(crate) variants: &'static [Variant],
}

impl Table {
    /// Keys without those of a variant.
    pub(crate) fn keys(&self) -> impl Iterator<Item = &'static Key> + use<> {
        self.groups.iter().copied().flatten()
    }

    /// The keys together with those of the variant that is called `kind`.
    pub(crate) fn keys_of(&self, kind: &str) -> impl Iterator<Item = &'static Key> + use<> {
        let variant = self.variants.iter().find(|variant| variant.name == kind);
        self.keys().chain(variant.into_iter().flat_map(|variant| variant.table.keys()))
    }

    /// True if the table may be empty, so that an absent one has its defaults.
    pub(crate) fn may_be_empty(&self) -> bool {
        let required = |key: &Key| matches!(key.presence, Presence::Required);
        self.variants.is_empty() && self.choices.is_empty() && !self.keys().any(required)
    }
}

/// One kind of a table that is chosen by `kind`.
#[derive(Debug)]
pub(crate) struct Variant {
    /// The word.
    pub(crate) name: &'static str,
    /// What it adds.
    pub(crate) table: Table,
}

/// Groups of keys that exclude each other.
#[derive(Debug)]
pub(crate) struct Choice {
    /// The alternatives.
    pub(crate) ways: &'static [Way],
}

/// One alternative: keys that must be there together, and keys that may be.
#[derive(Debug)]
pub(crate) struct Way {
    /// All of these.
    pub(crate) required: &'static [&'static str],
    /// And any of these.
    pub(crate) optional: &'static [&'static str],
}

/// A key of a table.
#[derive(Debug)]
pub(crate) struct Key {
    pub(crate) name: &'static str,
    pub(crate) kind: Kind,
    pub(crate) presence: Presence,
    /// What it means, in a line.
    pub(crate) doc: &'static str,
}

/// What a key holds.
#[derive(Debug)]
pub(crate) enum Kind {
    Number {
        unit: &'static str,
        range: Range,
    },
    Integer {
        least: i64,
        most: i64,
    },
    Boolean,
    /// Any text that is not empty.
    Text,
    /// Any text, also none at all.
    FreeText,
    /// One of these words.
    Word(&'static [&'static str]),
    /// The name of something that the program carries.
    Preset(fn() -> Vec<&'static str>),
    /// The path of a file.
    Path,
    /// Names or a path (`rules`), or the rules themselves in a table.
    Rules(&'static Table),
    /// A rule grid: seven lines of seven labels.
    Grid,
    /// A grid of numbers: seven lists of seven.
    NumberGrid,
    /// A defuzzifier by name.
    Defuzzifier,
    /// Something that its reader checks: what it may be in words, and its JSON Schema.
    Own {
        allowed: fn() -> String,
        schema: fn() -> serde_json::Value,
    },
    Numbers {
        unit: &'static str,
        range: Range,
        least: usize,
        most: usize,
    },
    /// A lower and a higher number.
    Interval {
        unit: &'static str,
        range: Range,
    },
    Table(&'static Table),
    Tables {
        table: &'static Table,
        least: usize,
        most: usize,
    },
}

impl Kind {
    /// The unit, empty where there is none.
    pub(crate) fn unit(&self) -> &'static str {
        match self {
            Self::Number { unit, .. }
            | Self::Numbers { unit, .. }
            | Self::Interval { unit, .. } => unit,
            _ => "",
        }
    }
}

/// Whether a key must be there, and what holds if it is not.
#[derive(Debug)]
pub(crate) enum Presence {
    Required,
    /// Nothing holds; the doc or a [`Choice`] says what that means.
    Optional,
    Default(Default),
}

/// A value that holds where none is given.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Default {
    Number(f64),
    Integer(i64),
    Boolean(bool),
    Word(&'static str),
}

/// Which numbers are allowed. All are finite.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Range {
    Finite,
    Positive,
    NotNegative,
    /// Ends included.
    Between(f64, f64),
    /// Above 0, up to and with the end.
    PositiveUpTo(f64),
    /// From 0 to the end, both included.
    UpTo(f64),
}

impl Range {
    pub(crate) fn contains(self, value: f64) -> bool {
        value.is_finite()
            && match self {
                Self::Finite => true,
                Self::Positive => value > 0.0,
                Self::NotNegative => value >= 0.0,
                Self::Between(least, most) => (least..=most).contains(&value),
                Self::PositiveUpTo(most) => value > 0.0 && value <= most,
                Self::UpTo(most) => (0.0..=most).contains(&value),
            }
    }

    /// The allowed numbers in words.
    pub(crate) fn words(self, unit: &str) -> String {
        let (of, unit) = match unit {
            "" => (String::new(), String::new()),
            unit => (format!(", in {unit}"), format!(" {unit}")),
        };
        match self {
            Self::Finite => format!("a finite number{of}"),
            Self::Positive => format!("a finite number above 0{of}"),
            Self::NotNegative => format!("a finite number, 0 or above{of}"),
            Self::Between(least, most) => format!("{} to {}{unit}", short(least), short(most)),
            Self::PositiveUpTo(most) => format!("above 0, up to {}{unit}", short(most)),
            Self::UpTo(most) => format!("0 to {}{unit}", short(most)),
        }
    }
}

/// A number for people: without a point where it is whole, with an exponent where it is long.
fn short(value: f64) -> String {
    if value == 0.0 || (1e-3..1e7).contains(&value.abs()) {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

// Short forms for the lists.

/// A key that must be there.
pub(crate) const fn required(name: &'static str, kind: Kind, doc: &'static str) -> Key {
    Key { name, kind, presence: Presence::Required, doc }
}

/// A key that may be left out.
pub(crate) const fn optional(name: &'static str, kind: Kind, doc: &'static str) -> Key {
    Key { name, kind, presence: Presence::Optional, doc }
}

/// A key with a default.
pub(crate) const fn defaulted(
    name: &'static str,
    kind: Kind,
    default: Default,
    doc: &'static str,
) -> Key {
    Key { name, kind, presence: Presence::Default(default), doc }
}

/// A table without choices and kinds.
pub(crate) const fn plain(doc: &'static str, groups: &'static [&'static [Key]]) -> Table {
    Table { doc, groups, choices: &[], variants: &[] }
}

/// A number of any size.
pub(crate) const fn finite(unit: &'static str) -> Kind {
    Kind::Number { unit, range: Range::Finite }
}

/// A time or another number, 0 or above.
pub(crate) const fn not_negative(unit: &'static str) -> Kind {
    Kind::Number { unit, range: Range::NotNegative }
}

/// A number above 0.
pub(crate) const fn positive(unit: &'static str) -> Kind {
    Kind::Number { unit, range: Range::Positive }
}

/// An angle in degrees.
pub(crate) const fn angle() -> Kind {
    Kind::Number { unit: "deg", range: Range::Between(-ANGLE_LIMIT_DEG, ANGLE_LIMIT_DEG) }
}
