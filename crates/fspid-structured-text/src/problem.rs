//! What is wrong with a text, or happened while it ran.

use crate::value::Kind;

/// A mistake and where it is.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("line {line}: {mistake}")]
pub struct Problem {
    /// The line, from 1; 0 where it is about no line.
    pub line: usize,
    /// What is wrong.
    pub mistake: Mistake,
}

/// What is wrong.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Mistake {
    /// A character that the language does not have here.
    #[error("`{0}` stands for nothing")]
    Character(char),
    /// A remark that does not end, or holds another one.
    #[error("a remark is not closed, or holds another remark")]
    Remark,
    /// A number whose type a compiler would choose.
    #[error("the literal {0} has no type")]
    Untyped(String),
    /// A literal that is none of its type.
    #[error("{0} is no literal of its type")]
    Literal(String),
    /// Something else was to stand there.
    #[error("{expected} is missing before {found}")]
    Missing {
        /// What was to stand there.
        expected: String,
        /// What does.
        found: String,
    },
    /// A name that some compiler has for itself.
    #[error("{0} is reserved")]
    Reserved(String),
    /// A name with underscores side by side or at its end.
    #[error("{0} is no identifier")]
    Name(String),
    /// A name that nothing declares.
    #[error("{0} is not declared")]
    Undeclared(String),
    /// A name that is declared twice, in any case of its letters.
    #[error("{0} is declared twice")]
    Twice(String),
    /// A value of another type is wanted.
    #[error("{0} is wanted, not {1}")]
    Type(Kind, Kind),
    /// An operation that a type does not have.
    #[error("{0} has no operation {1}")]
    Operation(Kind, &'static str),
    /// A list in place of a value, or a value in place of a list.
    #[error("{0} is not used as what it is: a list, a value or an instance")]
    Use(String),
    /// A write to what must not be written.
    #[error("{0} must not be written to")]
    ReadOnly(String),
    /// Two operators whose order every reader has to know.
    #[error("brackets are missing beside {0}")]
    Brackets(&'static str),
    /// A list with another number of values than places.
    #[error("{0} has {1} places and {2} values")]
    Length(String, usize, usize),
    /// Not every input of an instance is given, once.
    #[error("a call of {0} does not give each input once")]
    Inputs(String),
    /// A value that was read before it was written.
    #[error("{0} is read before it is written")]
    Unset(String),
    /// An index outside of its list.
    #[error("index {1} of {0}, which ends at {2}")]
    Index(String, i32, usize),
    /// A whole number beyond its type.
    #[error("a whole number leaves its type")]
    Overflow,
}

impl Mistake {
    /// With its line.
    pub(crate) fn at(self, line: usize) -> Problem {
        Problem { line, mistake: self }
    }
}
