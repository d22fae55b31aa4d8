//! MATLAB's `.fis`, in all the dialects that tools write.
//!
//! What a file says is what MATLAB answers: integrals are sums over 101 samples, an output without
//! a firing rule answers the middle of its range, inputs outside their range are evaluated as they
//! are. Names of functions are looked up in tables and never run.
//!
//! | dialect | what is read |
//! | --- | --- |
//! | MATLAB up to version 2.0 | everything but functions of one's own |
//! | Octave's toolkit | other norms, hedges of any two digits, in conclusions too, `centroid_integral` |
//! | fuzzylite's export | its norms and shapes, `1.000` for an index, empty norms, infinities |
//! | Taskin's interval type-2 toolbox, `.t2fis` | `MF1U` and `MF1L` with heights, intervals as conclusions |
//! | MATLAB's type-2 since R2019b | refused by name: its files are not described anywhere |
//!
//! # Example
//!
//! ```
//! use fspid_formats::{WriteOptions, fis};
//!
//! let text = "[System]\nType='sugeno'\nDefuzzMethod='wtaver'\n\
//!             [Input1]\nName='x'\nRange=[0 1]\nMF1='all':'trapmf',[0 0 1 1]\n\
//!             [Output1]\nName='y'\nRange=[0 9]\nMF1='line':'linear',[2 5]\n\
//!             [Rules]\n1, 1 (1) : 1\n";
//! let reading = fis::read(text)?;
//! assert_eq!(reading.notes[0].to_string(), "`AndMethod` is missing; `min` is assumed");
//! let writing = fis::write(&reading.parts, WriteOptions::default())?;
//! assert!(writing.text.contains("MF1='line':'linear',[2 5]"));
//! # Ok::<(), fspid_formats::Problems>(())
//! ```

mod hedge;
mod read;
mod shape;
mod word;
mod write;

pub use read::read;
pub use write::write;
