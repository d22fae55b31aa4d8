//! The pieces of a value: quoted words, numbers, lists of numbers.

use crate::cursor::Cursor;
use crate::number::{self, Refused};
use crate::report::wrong;
use fspid_diagnostics::{Place, Problem};

/// A number and the word that it was written as.
#[derive(Clone, Copy, Debug)]
pub(super) struct Number<'a> {
    pub(super) value: f64,
    pub(super) word: &'a str,
    pub(super) place: Place,
}

/// True where a comment begins.
fn is_comment(found: Option<char>) -> bool {
    matches!(found, Some('%' | '#'))
}

/// True if nothing but a comment is left.
pub(super) fn is_over(mut cursor: Cursor) -> bool {
    cursor.skip_blanks();
    cursor.is_empty() || is_comment(cursor.peek())
}

/// Refuses anything but a comment.
pub(super) fn over(mut cursor: Cursor) -> Result<(), Problem> {
    cursor.skip_blanks();
    if is_over(cursor) {
        return Ok(());
    }
    Err(wrong(
        cursor.place(),
        cursor.rest().trim_end(),
        "does not belong here",
        "the end of the line",
    ))
}

/// Passes `wanted`, blanks on both sides.
pub(super) fn sign(cursor: &mut Cursor, wanted: char, behind: &str) -> Result<(), Problem> {
    cursor.skip_blanks();
    if !cursor.eat(wanted) {
        let place = cursor.place();
        let found = cursor.take_while(|next| !next.is_whitespace());
        let message = if found.is_empty() { "the line ends too early" } else { "is in the way" };
        return Err(wrong(place, found, message, format!("`{wanted}` {behind}")));
    }
    cursor.skip_blanks();
    Ok(())
}

/// A word in single or double quotes; a quote that stands twice is one.
pub(super) fn quoted(cursor: &mut Cursor) -> Result<String, Problem> {
    let at = *cursor;
    let Some(quote) = cursor.peek().filter(|found| matches!(found, '\'' | '"')) else {
        let word = cursor.take_while(|next| !next.is_whitespace() && next != ':');
        return Err(wrong(at.place(), word, "stands without quotes", "a word in quotes"));
    };
    cursor.bump();
    let mut text = String::new();
    loop {
        text.push_str(cursor.take_while(|next| next != quote && next != '\n'));
        if !cursor.eat(quote) {
            return Err(wrong(at.place(), at.rest(), "the quote is never closed", ""));
        }
        if !cursor.eat(quote) {
            return Ok(text);
        }
        text.push(quote);
    }
}

/// A value that is one word: in quotes, or as it stands up to a comment.
pub(super) fn word(mut cursor: Cursor) -> Result<String, Problem> {
    if matches!(cursor.peek(), Some('\'' | '"')) {
        let text = quoted(&mut cursor)?;
        over(cursor)?;
        return Ok(text);
    }
    Ok(cursor.take_while(|next| !is_comment(Some(next))).trim().into())
}

/// The numbers of `[1 2, 3]`.
pub(super) fn list<'a>(cursor: &mut Cursor<'a>) -> Result<Vec<Number<'a>>, Problem> {
    sign(cursor, '[', "before a list of numbers")?;
    let mut numbers = Vec::new();
    loop {
        cursor.take_while(|next| next.is_whitespace() || matches!(next, ',' | ';'));
        if cursor.eat(']') {
            return Ok(numbers);
        }
        numbers.push(number(cursor)?);
    }
}

fn number<'a>(cursor: &mut Cursor<'a>) -> Result<Number<'a>, Problem> {
    let place = cursor.place();
    let word = cursor.take_while(|next| !next.is_whitespace() && !matches!(next, ',' | ';' | ']'));
    if word.is_empty() {
        return Err(wrong(place, "", "the list is never closed", "`]`"));
    }
    let value = number::ordered(word).map_err(|refused| not_a_number(place, word, refused))?;
    Ok(Number { value, word, place })
}

/// Says why a word is no number.
pub(super) fn not_a_number(place: Place, word: &str, refused: Refused) -> Problem {
    let expected = match refused {
        Refused::Syntax => "a number such as `1`, `-.5` or `1e-3`",
        Refused::NotANumber => "a number",
        Refused::TooLarge | Refused::Infinite => "a smaller number",
    };
    wrong(place, word, refused.to_string(), expected)
}

/// A value that counts something.
pub(super) fn count(mut cursor: Cursor) -> Result<f64, Problem> {
    let place = cursor.place();
    let word = cursor.take_while(|next| !next.is_whitespace() && !is_comment(Some(next)));
    over(cursor)?;
    match number::finite(word) {
        Ok(number) if number >= 0.0 && number.fract() == 0.0 => Ok(number),
        _ => Err(wrong(place, word, "is no count", "a whole number")),
    }
}
