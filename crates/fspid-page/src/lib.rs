//! Pages of HTML without any outside reference or needed script, and numbers for people.
//!
//! Sentences stand in the templates, numbers are computed by whoever asks for a page; nothing in a template knows a
//! value of its own. What a user has named is escaped wherever it appears, in figures too.
//!
//! ```
//! use fspid_page::analysis::{AnalysisPage, Standing, Verdict};
//! let verdict = Verdict {
//!     standing: Standing::Good,
//!     word: "Stable".to_owned(),
//!     name: "<PID>".to_owned(),
//!     detail: "every mode decays".to_owned(),
//! };
//! let page = AnalysisPage { title: "loops".to_owned(), verdicts: vec![verdict], ..AnalysisPage::default() };
//! assert!(page.render().contains("&lt;PID&gt;"));
//! ```
//!
//! Not here: what is measured and judged, and how a line is drawn.

pub mod analysis;
pub mod campaign;
pub mod html;
pub mod markdown;
pub mod number;
pub mod page;

#[doc(hidden)]
pub use minijinja;
