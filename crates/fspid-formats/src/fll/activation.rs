//! Activation methods.

use fspid_fuzzy::system::{Activation, Comparison};

use super::lines::{Line, numbers, whole};
use crate::number::written as number;
use crate::report::Report;
use crate::vocabulary::known;

/// Activation methods.
const ACTIVATIONS: [&str; 7] =
    ["General", "First", "Last", "Highest", "Lowest", "Proportional", "Threshold"];

/// Signs of comparisons.
const COMPARISONS: [(&str, Comparison); 6] = [
    ("<", Comparison::Less),
    ("<=", Comparison::AtMost),
    ("==", Comparison::Equal),
    ("!=", Comparison::Unequal),
    (">=", Comparison::AtLeast),
    (">", Comparison::Greater),
];

/// The method with its parameters; what is wrong is reported.
pub(super) fn read(line: Line, report: &mut Report) -> Option<Activation> {
    let mut tokens = line.tokens();
    let word = tokens.advance();
    let sign = COMPARISONS.iter().find(|row| tokens.next.is(row.0));
    if word.is("Threshold") && sign.is_some() {
        tokens.advance();
    }
    let first_place = tokens.next.place();
    let found = numbers(tokens, report)?;
    let values: Vec<f64> = found.iter().map(|number| number.value).collect();
    let comparison = sign.map_or(Comparison::AtLeast, |row| row.1);
    let activation = build(word.text, &values, comparison);
    if activation.is_none() {
        let unknown = !ACTIVATIONS.iter().any(|known| word.is(known));
        let (place, text, message) = match unknown {
            true => (word.place(), word.text, "not an activation method"),
            false => (first_place, "", "does not fit this activation method"),
        };
        let expected =
            if unknown { known(ACTIVATIONS.into_iter(), word.text) } else { FITS.into() };
        report.problem(place, text, message, expected);
    }
    activation
}

const FITS: &str = "`First` and `Last` with a count and a threshold, `Highest` and `Lowest` with a \
                    count, `Threshold` with a comparison and a number, the others with nothing";

fn build(word: &str, values: &[f64], comparison: Comparison) -> Option<Activation> {
    let is = |name: &str| word.eq_ignore_ascii_case(name);
    match values {
        [] if is("General") => Some(Activation::General),
        [] if is("Proportional") => Some(Activation::Proportional),
        [] if is("Threshold") => Some(Activation::Threshold { comparison, threshold: 0.0 }),
        &[threshold] if is("Threshold") => Some(Activation::Threshold { comparison, threshold }),
        [] => counted(word, 1, None),
        &[count] => counted(word, whole(count)?, None),
        &[count, threshold] => counted(word, whole(count)?, Some(threshold)),
        _ => None,
    }
}

/// Methods that choose a number of rules; two of them know a threshold, too.
fn counted(word: &str, count: u32, given: Option<f64>) -> Option<Activation> {
    let is = |name: &str| word.eq_ignore_ascii_case(name);
    let threshold = given.unwrap_or(0.0);
    match given {
        _ if is("First") => Some(Activation::First { count, threshold }),
        _ if is("Last") => Some(Activation::Last { count, threshold }),
        None if is("Highest") => Some(Activation::Highest { count }),
        None if is("Lowest") => Some(Activation::Lowest { count }),
        _ => None,
    }
}

/// The method with its parameters as they are written.
pub(super) fn written(activation: Activation) -> String {
    match activation {
        Activation::General => "General".into(),
        Activation::First { count, threshold } => format!("First {count} {}", number(threshold)),
        Activation::Last { count, threshold } => format!("Last {count} {}", number(threshold)),
        Activation::Highest { count } => format!("Highest {count}"),
        Activation::Lowest { count } => format!("Lowest {count}"),
        Activation::Proportional => "Proportional".into(),
        Activation::Threshold { comparison, threshold } => {
            let sign = COMPARISONS.iter().find(|row| row.1 == comparison).map_or(">=", |row| row.0);
            format!("Threshold {sign} {}", number(threshold))
        }
    }
}
