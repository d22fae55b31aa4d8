//! Formulas of variables, as MathML's content markup writes them.

use fspid_numeric::scalar::Scalar;

use crate::finding::Origin;
use crate::number::Number;

/// A formula.
#[derive(Clone, Debug, PartialEq)]
pub enum Expression {
    /// A number.
    Number(f64),
    /// The value of the variable with that identifier.
    Variable {
        /// Identifier.
        id: String,
        /// Where it was written.
        origin: Origin,
    },
    /// A function of other formulas.
    Apply(Function, Vec<Self>),
}

/// What a formula does with its operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Function {
    /// A function of one operand.
    One(One),
    /// A function of two operands.
    Two(Two),
    /// A function of two operands that is carried on from the left over one or more.
    Fold(Two),
    /// Difference of two operands, or the negative of one.
    Minus,
    /// Value and condition, value and condition, …, value otherwise: the first value whose condition is not 0.
    Piecewise,
}

/// A function of one operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names are those of mathematics")]
pub enum One {
    Abs,
    Arccos,
    Arccosh,
    Arcsin,
    Arcsinh,
    Arctan,
    Arctanh,
    Ceiling,
    Cos,
    Cosh,
    Exp,
    Floor,
    Ln,
    Log,
    Negate,
    Not,
    Root,
    Sin,
    Sinh,
    Square,
    Tan,
    Tanh,
}

/// A function of two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names are those of mathematics")]
pub enum Two {
    Add,
    And,
    Arctan2,
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

/// Every function by the name of its MathML element, in alphabetical order.
///
/// `atan2` is the function that DAVE-ML adds as a `csymbol`: the angle of the point $(x, y)$ with $y$ first.
pub(crate) const FUNCTIONS: &[(&str, Function)] = &[
    ("abs", Function::One(One::Abs)),
    ("and", Function::Fold(Two::And)),
    ("arccos", Function::One(One::Arccos)),
    ("arccosh", Function::One(One::Arccosh)),
    ("arcsin", Function::One(One::Arcsin)),
    ("arcsinh", Function::One(One::Arcsinh)),
    ("arctan", Function::One(One::Arctan)),
    ("arctanh", Function::One(One::Arctanh)),
    ("atan2", Function::Two(Two::Arctan2)),
    ("ceiling", Function::One(One::Ceiling)),
    ("cos", Function::One(One::Cos)),
    ("cosh", Function::One(One::Cosh)),
    ("divide", Function::Two(Two::Divide)),
    ("eq", Function::Two(Two::Equal)),
    ("exp", Function::One(One::Exp)),
    ("floor", Function::One(One::Floor)),
    ("geq", Function::Two(Two::GreaterOrEqual)),
    ("gt", Function::Two(Two::Greater)),
    ("leq", Function::Two(Two::LessOrEqual)),
    ("ln", Function::One(One::Ln)),
    ("log", Function::One(One::Log)),
    ("lt", Function::Two(Two::Less)),
    ("max", Function::Fold(Two::Max)),
    ("min", Function::Fold(Two::Min)),
    ("minus", Function::Minus),
    ("neq", Function::Two(Two::NotEqual)),
    ("not", Function::One(One::Not)),
    ("or", Function::Fold(Two::Or)),
    ("piecewise", Function::Piecewise),
    ("plus", Function::Fold(Two::Add)),
    ("power", Function::Two(Two::Power)),
    ("rem", Function::Two(Two::Remainder)),
    ("root", Function::One(One::Root)),
    ("sin", Function::One(One::Sin)),
    ("sinh", Function::One(One::Sinh)),
    ("tan", Function::One(One::Tan)),
    ("tanh", Function::One(One::Tanh)),
    ("times", Function::Fold(Two::Multiply)),
];

impl Function {
    /// The function with that name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        let found = FUNCTIONS.iter().find(|(known, _)| *known == name);
        found.map(|&(_, function)| function)
    }

    /// Name of the MathML element; empty for a negative and a square, which are written as `minus` and `power`.
    #[must_use]
    pub fn name(self) -> &'static str {
        let found = FUNCTIONS.iter().find(|(_, function)| *function == self);
        found.map_or("", |&(name, _)| name)
    }

    /// All names, with commas.
    pub(crate) fn names() -> String {
        FUNCTIONS.iter().map(|&(name, _)| name).collect::<Vec<_>>().join(", ")
    }

    /// How many operands it takes if it does not take that many.
    #[must_use]
    pub fn refuses(self, operands: usize) -> Option<&'static str> {
        let (good, expected) = match self {
            Self::One(_) => (operands == 1, "1 operand"),
            Self::Two(_) => (operands == 2, "2 operands"),
            Self::Fold(_) => (operands >= 1, "at least 1 operand"),
            Self::Minus => (operands == 1 || operands == 2, "1 or 2 operands"),
            Self::Piecewise => {
                (operands >= 3 && operands % 2 == 1, "at least one <piece>, and <otherwise>")
            }
        };
        if good { None } else { Some(expected) }
    }
}

impl One {
    pub(crate) fn apply<N: Number>(self, a: N) -> N {
        match self {
            Self::Abs => a.abs(),
            Self::Arccos => a.acos(),
            Self::Arccosh => a.acosh(),
            Self::Arcsin => a.asin(),
            Self::Arcsinh => a.asinh(),
            Self::Arctan => a.atan(),
            Self::Arctanh => a.atanh(),
            Self::Ceiling => a.ceil(),
            Self::Cos => a.cos(),
            Self::Cosh => a.cosh(),
            Self::Exp => a.exp(),
            Self::Floor => a.floor(),
            Self::Ln => a.ln(),
            Self::Log => a.log10(),
            Self::Negate => -a,
            Self::Not => truth(!is_true(a)),
            Self::Root => a.sqrt(),
            Self::Sin => a.sin(),
            Self::Sinh => a.sinh(),
            Self::Square => a.square(),
            Self::Tan => a.tan(),
            Self::Tanh => a.tanh(),
        }
    }
}

impl Two {
    #[allow(clippy::float_cmp, reason = "the formula asks whether two numbers are equal")]
    pub(crate) fn apply<N: Number>(self, a: N, b: N) -> N {
        match self {
            Self::Add => a + b,
            Self::And => truth(is_true(a) && is_true(b)),
            Self::Arctan2 => angle_of(a, b),
            Self::Divide => a / b,
            Self::Equal => truth(a.value() == b.value()),
            Self::Greater => truth(a.value() > b.value()),
            Self::GreaterOrEqual => truth(a.value() >= b.value()),
            Self::Less => truth(a.value() < b.value()),
            Self::LessOrEqual => truth(a.value() <= b.value()),
            Self::Max => chosen(a, b, a.value() > b.value()),
            Self::Min => chosen(a, b, a.value() < b.value()),
            Self::Multiply => a * b,
            Self::NotEqual => truth(a.value() != b.value()),
            Self::Or => truth(is_true(a) || is_true(b)),
            Self::Power => a.pow(b),
            Self::Remainder => a.remainder(b),
            Self::Subtract => a - b,
        }
    }
}

/// The angle of the point $(x, y)$ in $[-\pi, \pi]$: behind the origin a zero below 0, as the negative of 0 is, has its own
/// side of the cut.
fn angle_of<N: Number>(y: N, x: N) -> N {
    let (angle, [y, x]) = (y.atan2(x), [y.value(), x.value()]);
    let below = y.abs() <= 0.0 && y.is_sign_negative() && x < 0.0;
    if below { angle - N::constant(core::f64::consts::TAU) } else { angle }
}

/// The first if it is preferred or not a number, else the second.
fn chosen<N: Number>(a: N, b: N, first: bool) -> N {
    if first || a.value().is_nan() { a } else { b }
}

/// Whether a number means true: it is not 0 and not NaN.
pub(crate) fn is_true<N: Number>(a: N) -> bool {
    a.value().abs() > 0.0
}

fn truth<N: Scalar>(holds: bool) -> N {
    if holds { N::one() } else { N::zero() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fspid_numeric::scalar::Dual;

    #[test]
    fn every_function_is_found_by_its_name_and_names_itself() {
        for &(name, function) in FUNCTIONS {
            assert_eq!(Function::named(name), Some(function));
            assert_eq!(function.name(), name);
        }
        assert!(FUNCTIONS.is_sorted_by_key(|&(name, _)| name));
        assert_eq!(Function::named("factorial"), None);
    }

    #[test]
    fn nothing_that_is_not_a_number_passes_a_comparison() {
        for two in [Two::Less, Two::LessOrEqual, Two::Greater, Two::GreaterOrEqual, Two::Equal] {
            assert_eq!(two.apply(f64::NAN, 1.0), 0.0);
        }
        assert!(Two::Min.apply(f64::NAN, 1.0).is_nan() && Two::Max.apply(1.0, f64::NAN).is_nan());
    }

    /// It was π, so that the angle of the negative of 0 differed from that of other readers of the format.
    #[test]
    fn the_angle_of_the_negative_of_nothing_lies_below_the_cut() {
        let pi = core::f64::consts::PI;
        let below = One::Negate.apply(0.0);
        assert_eq!(Two::Arctan2.apply(below, -2.0), -pi);
        assert_eq!(Two::Arctan2.apply(0.0, -2.0), pi);
        assert_eq!(Two::Arctan2.apply(below, 2.0).to_bits(), (-0.0_f64).to_bits());
        let [y, x] = Dual::variables([0.0_f64, -2.0]);
        let sloping = Two::Arctan2.apply(-y, x);
        assert_eq!((sloping.value, sloping.derivative[0]), (-pi, 0.5));
    }

    #[test]
    fn a_power_has_a_slope_in_base_and_exponent() {
        let [base, exponent] = Dual::variables([3.0_f64, 2.0]);
        let whole = Two::Power.apply(base, exponent);
        assert_eq!(whole.value, 9.0);
        assert!((whole.derivative[0] - 6.0).abs() < 1e-12);
        assert!((whole.derivative[1] - 9.0 * libm_ln(3.0)).abs() < 1e-12);
    }

    fn libm_ln(value: f64) -> f64 {
        Scalar::ln(value)
    }
}
