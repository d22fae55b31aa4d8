//! General fuzzy systems for people: asking, drawing, converting, explaining.
//!
//! One function per verb. How a system computes is `fspid-fuzzy`'s business, how other tools write it down
//! `fspid-formats`'.

mod answer;
mod audit;
mod explain;
mod marks;
mod slice;
mod table;
mod words;

pub use answer::{Asked, ask};
pub use audit::{Audit, Chapter, Finding, Mark, Question as AuditQuestion, audit};
pub use explain::{Basis, Explanation, Lack, Share, Shares, WhyNot, explain};
pub use marks::{Along, RuleMarks, rule_marks};
pub use slice::{Question as SliceQuestion, Slice, slice};
pub use table::SystemTable;
