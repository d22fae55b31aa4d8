//! Numbers at the end of a text that holds a hundred thousand of them: none gets a text of its own first.

use std::fmt::Write as _;

/// The items, with `between` between them.
pub(super) fn list<T>(
    text: &mut String,
    between: &str,
    items: impl IntoIterator<Item = T>,
    put: impl Fn(&mut String, T),
) {
    for (index, item) in items.into_iter().enumerate() {
        if index > 0 {
            text.push_str(between);
        }
        put(text, item);
    }
}

/// A real as the shortest decimal number that reads back as itself, with a point and perhaps an exponent.
pub(super) fn decimal(text: &mut String, value: f64, is_single: bool) {
    let start = text.len();
    #[allow(clippy::cast_possible_truncation, reason = "numbers of a single program are singles")]
    let single = value as f32;
    let written = if is_single { write!(text, "{single:?}") } else { write!(text, "{value:?}") };
    written.expect("a text takes everything");
    let digits = text.bytes().skip(start);
    if let Some(exponent) = digits.clone().position(|it| it == b'e')
        && !digits.take(exponent).any(|it| it == b'.')
    {
        text.insert_str(start + exponent, ".0");
    }
}

/// The bits of a real, in hexadecimal digits.
pub(super) fn bits(text: &mut String, value: f64, is_single: bool) {
    #[allow(clippy::cast_possible_truncation, reason = "numbers of a single program are singles")]
    let single = value as f32;
    hexadecimal(text, if is_single { u64::from(single.to_bits()) } else { value.to_bits() });
}

/// A whole number in hexadecimal digits, as many as it needs.
fn hexadecimal(text: &mut String, number: u64) {
    text.push_str("0x");
    let digits = (u64::BITS - number.leading_zeros()).div_ceil(4).max(1);
    let digit = |place: u32| char::from(b"0123456789abcdef"[(number >> (4 * place)) as usize % 16]);
    text.extend((0..digits).rev().map(digit));
}

/// A byte in decimal digits.
pub(super) fn byte(text: &mut String, number: u8) {
    for (power, digit) in [(100, number / 100), (10, number / 10 % 10), (1, number % 10)] {
        if number >= power || power == 1 {
            text.push(char::from(b'0' + digit));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn put(write: impl Fn(&mut String)) -> String {
        let mut text = "before ".to_owned();
        write(&mut text);
        text.split_off(7)
    }

    #[test]
    fn whole_numbers_are_as_the_library_writes_them() {
        for number in 0..=u8::MAX {
            assert_eq!(put(|text| byte(text, number)), number.to_string());
        }
        for place in 0..64 {
            for number in
                [1_u64 << place, (1 << place) - 1, !0 << place, 0x1234_5678_9abc_def0 >> place]
            {
                assert_eq!(put(|text| hexadecimal(text, number)), format!("{number:#x}"));
            }
        }
    }

    #[test]
    fn a_decimal_number_has_a_point_before_its_exponent() {
        for (value, single, double) in [
            (1e20, "1.0e20", "1.0e20"),
            (-1e-7, "-1.0e-7", "-1.0e-7"),
            (1.5e-9, "1.5e-9", "1.5e-9"),
            (0.0, "0.0", "0.0"),
            (0.1, "0.1", "0.1"),
            (f64::from(0.1_f32), "0.1", "0.10000000149011612"),
        ] {
            assert_eq!(put(|text| decimal(text, value, true)), single);
            assert_eq!(put(|text| decimal(text, value, false)), double);
        }
    }
}
