//! Formulas in text, such as the consequents of Sugeno rules or norms of one's own.
//!
//! Arithmetic only: numbers, named variables, `pi`, operators, brackets and a fixed list of
//! functions. There are no assignments, no conditions but 0 and 1, and nothing that can loop: a
//! formula of n bytes is read in O(n) and computed in O(n), without recursion and, when computed,
//! without the heap.
//!
//! | from loosest to tightest | |
//! | --- | --- |
//! | `or` | 1 if either is not 0 |
//! | `and` | 1 if neither is 0 |
//! | `+ -` | |
//! | `* / %` | `%` is the remainder with the sign of the dividend |
//! | `- +` before a number | so `-2^2` is -4 |
//! | `^` | from right to left: `2^3^2` is 512 |
//! | `! not ~` before a number | `!` and `not` are 1 for 0 and 0 for all else; `~` is minus: `~2^2` is 4 |
//!
//! Functions: see [`Formula::functions`], in any case. `log` and `ln` are the natural logarithm. Comparisons are functions
//! of two numbers, `gt ge lt le eq neq`, and answer 0 or 1.
//!
//! # Source
//! The operators and functions are those documented for fuzzylite's `Function` term.

mod error;
mod operation;
mod parse;
mod token;

use alloc::string::String;
use alloc::vec::Vec;

pub use error::{FormulaError, FormulaErrorKind};
use operation::{FUNCTIONS, Operation};

use fspid_numeric::scalar::{Interval, Scalar};

/// Longest text, in bytes.
const MAX_BYTES: usize = 64 * 1024;
/// Most numbers, variables, operators and functions.
const MAX_PARTS: usize = 1024;
/// Most brackets and operators that wait for their right side, and most numbers that wait for an
/// operator.
const MAX_DEPTH: usize = 64;

/// A formula that has been read and can be computed.
///
/// ```
/// use fspid_fuzzy::Formula;
///
/// let formula = Formula::parse("0.5 * (e + ec)^2", &["e", "ec"])?;
/// assert_eq!(formula.evaluate(&[1.0, -3.0]), 2.0);
/// # Ok::<(), fspid_fuzzy::FormulaError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Formula {
    text: String,
    /// In postfix order; valid: never more than [`MAX_DEPTH`] operands, one at the end.
    code: Vec<Operation>,
}

impl Formula {
    /// Reads a formula in the variables `names`, which are later referred to by their index.
    ///
    /// A variable hides a function or constant of the same name.
    ///
    /// # Errors
    /// [`FormulaError`] with the position of the first thing that is wrong.
    pub fn parse(text: &str, names: &[&str]) -> Result<Self, FormulaError> {
        Ok(Self { text: text.into(), code: parse::parse(text, names)? })
    }

    /// The text as it was given.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// True if the variable with that index occurs.
    #[must_use]
    pub fn uses(&self, variable: usize) -> bool {
        self.code.contains(&Operation::Variable(variable))
    }

    /// True if nothing in it may jump, wherever it [has a value](Self::has_value).
    pub(crate) fn is_continuous(&self) -> bool {
        self.code.iter().all(|part| part.is_continuous())
    }

    /// The names of all functions.
    pub fn functions() -> impl Iterator<Item = &'static str> {
        FUNCTIONS.iter().map(|&(name, _)| name)
    }

    /// The value, with one of `values` for each variable; a variable that has none is NaN.
    ///
    /// Allocates nothing.
    pub fn evaluate<S: Scalar>(&self, values: &[S]) -> S {
        let mut stack = Stack { operands: [S::zero(); MAX_DEPTH], count: 0 };
        for &part in &self.code {
            match part {
                Operation::Number(value) => stack.push(S::constant(value)),
                Operation::Variable(index) => {
                    stack.push(values.get(index).copied().unwrap_or(S::constant(f64::NAN)));
                }
                Operation::One(function) => {
                    let a = stack.pop();
                    stack.push(function.apply(a));
                }
                Operation::Two(function) => {
                    let b = stack.pop();
                    let a = stack.pop();
                    stack.push(function.apply(a, b));
                }
            }
        }
        stack.pop()
    }

    /// True if it is known to have a finite value for all values of these intervals, one for each variable: no root or logarithm
    /// of what may be negative, no quotient by what may be zero.
    ///
    /// Allocates nothing.
    #[must_use]
    pub fn has_value(&self, values: &[Interval]) -> bool {
        let mut stack = Stack { operands: [Interval::ZERO; MAX_DEPTH], count: 0 };
        self.code.iter().all(|part| {
            let (is_defined, value) = match *part {
                Operation::Number(value) => (value.is_finite(), Interval::constant(value)),
                Operation::Variable(index) => match values.get(index) {
                    Some(value) => (true, *value),
                    None => (false, Interval::ENTIRE),
                },
                Operation::One(function) => {
                    let a = stack.pop();
                    (function.is_defined_on(a), function.apply(a))
                }
                Operation::Two(function) => {
                    let b = stack.pop();
                    let a = stack.pop();
                    (function.is_defined_on(a, b), function.apply(a, b))
                }
            };
            stack.push(value);
            is_defined && value.lower().is_finite() && value.upper().is_finite()
        })
    }
}

impl core::fmt::Display for Formula {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(&self.text)
    }
}

/// The numbers that wait for an operator.
struct Stack<S> {
    operands: [S; MAX_DEPTH],
    count: usize,
}

impl<S: Scalar> Stack<S> {
    fn push(&mut self, value: S) {
        if let Some(place) = self.operands.get_mut(self.count) {
            *place = value;
            self.count += 1;
        }
    }

    fn pop(&mut self) -> S {
        self.count = self.count.saturating_sub(1);
        self.operands.get(self.count).copied().unwrap_or(S::zero())
    }
}

#[cfg(test)]
mod tests;
