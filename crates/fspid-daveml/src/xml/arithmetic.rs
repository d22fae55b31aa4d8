//! Numbers that a file writes out, such as `(2/5)π`.

use core::f64::consts::PI;

/// Deepest nesting of brackets and signs.
const DEEPEST: usize = 16;

/// The value of numbers and π with `+ - * /` and brackets, in which side by side is a product; `None` for any other text.
pub(super) fn arithmetic(text: &str) -> Option<f64> {
    let mut reader = Reader { rest: text.trim(), depth: 0 };
    let value = reader.sum()?;
    (reader.rest.is_empty() && value.is_finite()).then_some(value)
}

struct Reader<'a> {
    rest: &'a str,
    depth: usize,
}

impl Reader<'_> {
    /// Takes a sign if it comes next.
    fn take(&mut self, sign: &str) -> bool {
        let rest = self.rest.strip_prefix(sign);
        if let Some(rest) = rest {
            self.rest = rest.trim_start();
        }
        rest.is_some()
    }

    fn sum(&mut self) -> Option<f64> {
        let mut value = self.product()?;
        loop {
            if self.take("+") {
                value += self.product()?;
            } else if self.take("-") || self.take("−") {
                value -= self.product()?;
            } else {
                return Some(value);
            }
        }
    }

    fn product(&mut self) -> Option<f64> {
        let mut value = self.factor()?;
        loop {
            if self.take("*") || self.take("·") || self.take("×") {
                value *= self.factor()?;
            } else if self.take("/") {
                value /= self.factor()?;
            } else if self.rest.starts_with(['(', 'π', 'p']) {
                value *= self.factor()?;
            } else {
                return Some(value);
            }
        }
    }

    fn factor(&mut self) -> Option<f64> {
        self.depth += 1;
        let value = if self.depth > DEEPEST { None } else { self.deeper() };
        self.depth -= 1;
        value
    }

    fn deeper(&mut self) -> Option<f64> {
        if self.take("(") {
            let value = self.sum()?;
            return self.take(")").then_some(value);
        }
        if self.take("-") || self.take("−") {
            return Some(-self.factor()?);
        }
        if self.take("π") || self.take("pi") {
            return Some(PI);
        }
        self.number()
    }

    /// Digits with a point and an exponent.
    fn number(&mut self) -> Option<f64> {
        let digits =
            |text: &str| text.len() - text.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        let mut end = digits(self.rest);
        if self.rest.get(end..)?.starts_with('.') {
            end += 1;
            end += digits(self.rest.get(end..)?);
        }
        if let Some(tail) = self.rest.get(end..)?.strip_prefix(['e', 'E']) {
            let sign = tail.len() - tail.trim_start_matches(['+', '-']).len();
            let exponent = digits(tail.get(sign..)?);
            if sign <= 1 && exponent > 0 {
                end += 1 + sign + exponent;
            }
        }
        let value = self.rest.get(..end)?.parse().ok()?;
        self.rest = self.rest.get(end..)?.trim_start();
        Some(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_out_is_worked_out() {
        for (text, expected) in [
            ("(2/5)π", 0.4 * PI),
            ("2π", 2.0 * PI),
            ("(2/5)*pi", 0.4 * PI),
            ("1/2 + 3*(4 - 2)", 6.5),
            ("-(1)", -1.0),
            ("1e-3/2", 5e-4),
            ("2(3)", 6.0),
        ] {
            assert_eq!(arithmetic(text), Some(expected), "{text}");
        }
    }

    #[test]
    fn other_text_is_no_number() {
        for text in
            ["", "x", "1/0", "(2", "2)", "1 2", "--", "π2", "0x10", "nan", "inf", "1,5", "piece"]
        {
            assert_eq!(arithmetic(text), None, "{text}");
        }
        assert_eq!(arithmetic(&"(".repeat(100_000)), None);
        assert_eq!(arithmetic(&"-".repeat(100_000)), None);
    }
}
