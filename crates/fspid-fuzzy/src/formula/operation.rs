//! What a formula is made of, once read.

use fspid_numeric::scalar::{Interval, Scalar};

/// One step of computing a formula.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Operation {
    /// Put down a number.
    Number(f64),
    /// Put down the value of a variable.
    Variable(usize),
    /// Replace the last number.
    One(One),
    /// Replace the last two numbers.
    Two(Two),
}

/// A function of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum One {
    Abs,
    Acos,
    Acosh,
    Asin,
    Asinh,
    Atan,
    Atanh,
    Ceil,
    Cos,
    Cosh,
    Cube,
    Exp,
    Floor,
    Log,
    Log10,
    Log1p,
    Negate,
    Not,
    Round,
    Sign,
    Sin,
    Sinh,
    Sqrt,
    Square,
    Tan,
    Tanh,
}

/// A function of two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Two {
    Add,
    And,
    Atan2,
    Divide,
    Equal,
    Greater,
    GreaterOrEqual,
    Less,
    LessOrEqual,
    Max,
    Min,
    Multiply,
    NotEqual,
    Or,
    Power,
    Remainder,
    Subtract,
}

/// A function that can be called by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Function {
    One(One),
    Two(Two),
}

impl Function {
    pub(super) const fn arguments(self) -> usize {
        match self {
            Self::One(_) => 1,
            Self::Two(_) => 2,
        }
    }

    pub(super) const fn operation(self) -> Operation {
        match self {
            Self::One(function) => Operation::One(function),
            Self::Two(function) => Operation::Two(function),
        }
    }
}

/// Every function by name.
pub(super) const FUNCTIONS: &[(&str, Function)] = &[
    ("abs", Function::One(One::Abs)),
    ("acos", Function::One(One::Acos)),
    ("acosh", Function::One(One::Acosh)),
    ("asin", Function::One(One::Asin)),
    ("asinh", Function::One(One::Asinh)),
    ("atan", Function::One(One::Atan)),
    ("atan2", Function::Two(Two::Atan2)),
    ("atanh", Function::One(One::Atanh)),
    ("ceil", Function::One(One::Ceil)),
    ("cos", Function::One(One::Cos)),
    ("cosh", Function::One(One::Cosh)),
    ("eq", Function::Two(Two::Equal)),
    ("exp", Function::One(One::Exp)),
    ("fabs", Function::One(One::Abs)),
    ("floor", Function::One(One::Floor)),
    ("fmod", Function::Two(Two::Remainder)),
    ("ge", Function::Two(Two::GreaterOrEqual)),
    ("gt", Function::Two(Two::Greater)),
    ("le", Function::Two(Two::LessOrEqual)),
    ("ln", Function::One(One::Log)),
    ("log", Function::One(One::Log)),
    ("log10", Function::One(One::Log10)),
    ("log1p", Function::One(One::Log1p)),
    ("lt", Function::Two(Two::Less)),
    ("max", Function::Two(Two::Max)),
    ("min", Function::Two(Two::Min)),
    ("neq", Function::Two(Two::NotEqual)),
    ("pow", Function::Two(Two::Power)),
    ("round", Function::One(One::Round)),
    ("sign", Function::One(One::Sign)),
    ("sin", Function::One(One::Sin)),
    ("sinh", Function::One(One::Sinh)),
    ("sqrt", Function::One(One::Sqrt)),
    ("tan", Function::One(One::Tan)),
    ("tanh", Function::One(One::Tanh)),
];

/// Every constant by name.
pub(super) const CONSTANTS: &[(&str, f64)] = &[("pi", core::f64::consts::PI)];

impl One {
    pub(super) fn apply<S: Scalar>(self, a: S) -> S {
        match self {
            Self::Abs => a.abs(),
            Self::Acos => a.acos(),
            Self::Acosh => a.acosh(),
            Self::Asin => a.asin(),
            Self::Asinh => a.asinh(),
            Self::Atan => a.atan(),
            Self::Atanh => a.atanh(),
            Self::Ceil => a.ceil(),
            Self::Cos => a.cos(),
            Self::Cosh => a.cosh(),
            Self::Cube => a * a.square(),
            Self::Exp => a.exp(),
            Self::Floor => a.floor(),
            Self::Log => a.ln(),
            Self::Log10 => a.log10(),
            Self::Log1p => a.ln_1p(),
            Self::Negate => -a,
            Self::Not => S::one() - a.truth(),
            Self::Round => a.round(),
            Self::Sign => a.sign(),
            Self::Sin => a.sin(),
            Self::Sinh => a.sinh(),
            Self::Sqrt => a.sqrt(),
            Self::Square => a.square(),
            Self::Tan => a.tan(),
            Self::Tanh => a.tanh(),
        }
    }
}

impl One {
    /// True if it has a value for every number of an interval.
    pub(super) fn is_defined_on(self, a: Interval) -> bool {
        match self {
            Self::Acos | Self::Asin => -1.0 <= a.lower() && a.upper() <= 1.0,
            Self::Acosh => 1.0 <= a.lower(),
            Self::Atanh => -1.0 < a.lower() && a.upper() < 1.0,
            Self::Log | Self::Log10 => 0.0 < a.lower(),
            Self::Log1p => -1.0 < a.lower(),
            Self::Sqrt => 0.0 <= a.lower(),
            Self::Tan => !a.cos().contains(0.0),
            _ => true,
        }
    }
}

impl Two {
    /// The same for every two numbers of two intervals.
    pub(super) fn is_defined_on(self, a: Interval, b: Interval) -> bool {
        match self {
            Self::Divide | Self::Remainder => !b.contains(0.0),
            Self::Power => a.lower() > 0.0 || b.is_point() && is_count(b.lower()),
            Self::Atan2 => !(a.contains(0.0) && b.contains(0.0)),
            _ => true,
        }
    }
}

impl Operation {
    /// True if it cannot jump wherever it [has a value](super::Formula::has_value).
    pub(super) fn is_continuous(self) -> bool {
        match self {
            Self::Number(_) | Self::Variable(_) => true,
            Self::One(function) => function.is_continuous(),
            Self::Two(function) => function.is_continuous(),
        }
    }
}

impl One {
    fn is_continuous(self) -> bool {
        match self {
            Self::Abs
            | Self::Asinh
            | Self::Atan
            | Self::Cos
            | Self::Cosh
            | Self::Cube
            | Self::Exp
            | Self::Negate
            | Self::Sin
            | Self::Sinh
            | Self::Square
            | Self::Tan
            | Self::Tanh => true,
            Self::Ceil | Self::Floor | Self::Not | Self::Round | Self::Sign => false,
            // Steeper than anything at the ends of their domains.
            Self::Acos | Self::Acosh | Self::Asin | Self::Atanh | Self::Sqrt => false,
            Self::Log | Self::Log10 | Self::Log1p => false,
        }
    }
}

impl Two {
    fn is_continuous(self) -> bool {
        match self {
            Self::Add | Self::Divide | Self::Max | Self::Min | Self::Multiply | Self::Subtract => {
                true
            }
            Self::And | Self::Or | Self::Atan2 | Self::Power | Self::Remainder => false,
            Self::Equal | Self::Greater | Self::GreaterOrEqual => false,
            Self::Less | Self::LessOrEqual | Self::NotEqual => false,
        }
    }
}

/// True for 0, 1, 2 …
fn is_count(number: f64) -> bool {
    number >= 0.0 && libm::floor(number).total_cmp(&number).is_eq()
}

impl Two {
    pub(super) fn apply<S: Scalar>(self, a: S, b: S) -> S {
        match self {
            Self::Add => a + b,
            Self::And => a.truth().smaller(b.truth()),
            Self::Atan2 => a.atan2(b),
            Self::Divide => a / b,
            Self::Equal => less(a, b, S::zero(), less(b, a, S::zero(), S::one())),
            Self::Greater => less(b, a, S::one(), S::zero()),
            Self::GreaterOrEqual => less(a, b, S::zero(), S::one()),
            Self::Less => less(a, b, S::one(), S::zero()),
            Self::LessOrEqual => less(b, a, S::zero(), S::one()),
            Self::Max => a.larger(b),
            Self::Min => a.smaller(b),
            Self::Multiply => a * b,
            Self::NotEqual => less(a, b, S::one(), less(b, a, S::one(), S::zero())),
            Self::Or => a.truth().larger(b.truth()),
            Self::Power => a.pow(b),
            Self::Remainder => a.remainder(b),
            Self::Subtract => a - b,
        }
    }
}

/// `then` where `a < b`, else `otherwise`.
fn less<S: Scalar>(a: S, b: S, then: S, otherwise: S) -> S {
    a.if_less(b, then, otherwise)
}
