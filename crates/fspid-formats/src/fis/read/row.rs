//! A line of `[Rules]`: `1 -2.20, 3 (0.5) : 1`.

use crate::cursor::Cursor;
use crate::fis::hedge::{Coded, NONE};
use crate::number;
use crate::report::wrong;
use fspid_diagnostics::{Place, Problem};

use super::value::{not_a_number, over, sign};

/// An index: which set, and what is made of its grade.
#[derive(Clone, Copy, Debug)]
pub(super) struct Index<'a> {
    /// From 1; 0 for a variable that is not used.
    pub(super) set: usize,
    pub(super) coded: Coded,
    pub(super) place: Place,
    pub(super) word: &'a str,
}

/// A rule as it is written.
#[derive(Debug)]
pub(super) struct RuleRow<'a> {
    pub(super) place: Place,
    pub(super) inputs: Vec<Index<'a>>,
    pub(super) outputs: Vec<Index<'a>>,
    pub(super) weight: f64,
    /// Whether `2`, *or*, joins the inputs.
    pub(super) any: bool,
}

/// Takes a line apart.
pub(super) fn row<'a>(mut line: Cursor<'a>) -> Result<RuleRow<'a>, Problem> {
    let place = line.place();
    let inputs = indices(&mut line)?;
    sign(&mut line, ',', "between inputs and outputs")?;
    let outputs = indices(&mut line)?;
    sign(&mut line, '(', "before the weight")?;
    let weight = weight(&mut line)?;
    sign(&mut line, ')', "behind the weight")?;
    sign(&mut line, ':', "before the connective")?;
    let any = connective(&mut line)?;
    over(line)?;
    Ok(RuleRow { place, inputs, outputs, weight, any })
}

fn is_separator(next: char) -> bool {
    next.is_whitespace() || matches!(next, ',' | '(' | ')' | ':' | '%' | '#')
}

fn indices<'a>(line: &mut Cursor<'a>) -> Result<Vec<Index<'a>>, Problem> {
    let mut found = Vec::new();
    loop {
        line.skip_blanks();
        let place = line.place();
        let word = line.take_while(|next| !is_separator(next));
        if word.is_empty() {
            return Ok(found);
        }
        found.push(index(word, place)?);
    }
}

/// `2`, `-1.20`, `1.000`, `1e0`.
fn index(word: &str, place: Place) -> Result<Index<'_>, Problem> {
    let value = number::finite(word).map_err(|refused| not_a_number(place, word, refused))?;
    let digits = number::written(value.abs());
    let (set, fraction) = digits.split_once('.').unwrap_or((&digits, ""));
    let expected = "a whole number, or one with a hedge of two digits such as `1.20`";
    let refused = || wrong(place, word, "is no index of a set", expected);
    let set: usize = set.parse().map_err(|_| refused())?;
    let code = match fraction.len() {
        0 => NONE,
        1 => fraction.parse::<u8>().map_err(|_| refused())? * 10,
        2 => fraction.parse().map_err(|_| refused())?,
        _ => return Err(refused()),
    };
    if set == 0 && code != NONE {
        return Err(refused());
    }
    Ok(Index { set, coded: Coded { negated: value < 0.0, code }, place, word })
}

fn weight(line: &mut Cursor) -> Result<f64, Problem> {
    let place = line.place();
    let word = line.take_while(|next| !is_separator(next));
    let value = number::finite(word).map_err(|refused| not_a_number(place, word, refused))?;
    if (0.0..=1.0).contains(&value) {
        return Ok(value);
    }
    Err(wrong(place, word, "is no weight", "a number from 0 to 1"))
}

fn connective(line: &mut Cursor) -> Result<bool, Problem> {
    let place = line.place();
    let word = line.take_while(|next| !is_separator(next));
    match number::finite(word).map(f64::to_bits) {
        Ok(bits) if bits == 1.0_f64.to_bits() => Ok(false),
        Ok(bits) if bits == 2.0_f64.to_bits() => Ok(true),
        _ => Err(wrong(place, word, "is no connective", "`1` for and, or `2` for or")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_index_is_a_set_a_sign_and_two_digits() {
        let read = |word| {
            let found = index(word, Place { line: 1, column: 1 }).map_err(|p| p.to_string())?;
            Ok::<_, String>((found.set, found.coded.negated, found.coded.code))
        };
        assert_eq!(read("3"), Ok((3, false, 0)));
        assert_eq!(read("1.000"), Ok((1, false, 0)));
        assert_eq!(read("-2.2"), Ok((2, true, 20)));
        assert_eq!(read("2.05"), Ok((2, false, 5)));
        assert_eq!(read("1.990"), Ok((1, false, 99)));
        assert_eq!(read("0"), Ok((0, false, 0)));
        assert_eq!(read("1.0e+00"), Ok((1, false, 0)));
        for word in ["0.2", "1.234", "1e30", "x", "nan", "--1", ""] {
            assert!(read(word).is_err(), "{word}");
        }
    }
}
