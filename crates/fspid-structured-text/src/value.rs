//! Values and their types.

use std::fmt;

/// A type of the language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A real of 32 bits.
    Real,
    /// A real of 64 bits.
    Lreal,
    /// A whole number of 32 bits.
    Dint,
    /// A whole number from 0 to 255.
    Usint,
    /// Eight bits.
    Byte,
    /// True or false.
    Bool,
}

impl Kind {
    pub(crate) const ALL: [Self; 6] =
        [Self::Real, Self::Lreal, Self::Dint, Self::Usint, Self::Byte, Self::Bool];

    /// Its name in the language.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Real => "REAL",
            Self::Lreal => "LREAL",
            Self::Dint => "DINT",
            Self::Usint => "USINT",
            Self::Byte => "BYTE",
            Self::Bool => "BOOL",
        }
    }

    pub(crate) fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// What a value is where nothing else is said.
    pub(crate) const fn zero(self) -> Value {
        match self {
            Self::Real => Value::Real(0.0),
            Self::Lreal => Value::Lreal(0.0),
            Self::Dint => Value::Dint(0),
            Self::Usint => Value::Usint(0),
            Self::Byte => Value::Byte(0),
            Self::Bool => Value::Bool(false),
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A value of a type.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// A real of 32 bits.
    Real(f32),
    /// A real of 64 bits.
    Lreal(f64),
    /// A whole number of 32 bits.
    Dint(i32),
    /// A whole number from 0 to 255.
    Usint(u8),
    /// Eight bits.
    Byte(u8),
    /// True or false.
    Bool(bool),
}

impl Value {
    /// Its type.
    #[must_use]
    pub const fn kind(self) -> Kind {
        match self {
            Self::Real(_) => Kind::Real,
            Self::Lreal(_) => Kind::Lreal,
            Self::Dint(_) => Kind::Dint,
            Self::Usint(_) => Kind::Usint,
            Self::Byte(_) => Kind::Byte,
            Self::Bool(_) => Kind::Bool,
        }
    }

    /// The value of a typed literal: what stands behind the `#`.
    pub(crate) fn literal(kind: Kind, text: &str) -> Option<Self> {
        match kind {
            Kind::Real if is_real(text) => {
                text.parse().ok().filter(|it: &f32| it.is_finite()).map(Self::Real)
            }
            Kind::Lreal if is_real(text) => {
                text.parse().ok().filter(|it: &f64| it.is_finite()).map(Self::Lreal)
            }
            Kind::Dint => text.parse().ok().map(Self::Dint),
            Kind::Usint => text.parse().ok().map(Self::Usint),
            Kind::Byte => {
                let digits = text.strip_prefix("16#")?;
                u8::from_str_radix(digits, 16).ok().map(Self::Byte)
            }
            Kind::Real | Kind::Lreal | Kind::Bool => None,
        }
    }
}

/// Digits, a point, digits, and perhaps an exponent.
fn is_real(text: &str) -> bool {
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|it| it.is_ascii_digit());
    let unsigned = |text: &str| digits(text.strip_prefix(['+', '-']).unwrap_or(text));
    let (number, exponent) = match text.split_once('E') {
        Some((number, exponent)) => (number, unsigned(exponent)),
        None => (text, true),
    };
    number.split_once('.').is_some_and(|(whole, part)| unsigned(whole) && digits(part)) && exponent
}
