//! An answer: JSON, and columns of numbers beside it.

use serde_json::{Value, json};

/// What a question is answered with.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// The answer but for its columns, which it names by their numbers.
    pub json: Value,
    /// Columns of numbers.
    pub columns: Vec<Vec<f64>>,
}

impl Answer {
    /// An answer without columns.
    #[must_use]
    pub fn of(json: Value) -> Self {
        Self { json, columns: Vec::new() }
    }

    /// No answer, and why.
    #[must_use]
    pub fn refused(why: impl std::fmt::Display) -> Self {
        Self::of(json!({ "refused": why.to_string() }))
    }

    /// Keeps a column, and answers the number that the JSON names it by.
    pub(crate) fn keep(&mut self, column: Vec<f64>) -> usize {
        self.columns.push(column);
        self.columns.len() - 1
    }

    /// Keeps bytes as a column, eight in each number in the order in which they lie in memory, zeros behind the last.
    pub(crate) fn keep_bytes(&mut self, bytes: &[u8]) -> usize {
        let number = |eight: &[u8]| {
            let mut all = [0; 8];
            all[..eight.len()].copy_from_slice(eight);
            f64::from_le_bytes(all)
        };
        self.keep(bytes.chunks(8).map(number).collect())
    }

    /// As it lies in memory, all numbers little endian: the bytes of the JSON and the number of columns as two `u32`, the
    /// length of each column as `u32`, the JSON in UTF-8, zeros up to a multiple of eight, the columns as `f64`.
    #[must_use]
    pub fn bytes(&self) -> Vec<u8> {
        let text = self.json.to_string();
        let numbers: usize = self.columns.iter().map(Vec::len).sum();
        let head = 8 + 4 * self.columns.len();
        let mut out = Vec::with_capacity(head + text.len() + 8 + 8 * numbers);
        let mut put = |count: usize| {
            out.extend(u32::try_from(count).unwrap_or(u32::MAX).to_le_bytes());
        };
        put(text.len());
        put(self.columns.len());
        self.columns.iter().for_each(|column| put(column.len()));
        out.extend(text.as_bytes());
        out.resize(out.len().next_multiple_of(8), 0);
        // Bytes of an iterator would be added one by one: a third of the time of a flight.
        for number in self.columns.iter().flatten() {
            out.extend_from_slice(&number.to_le_bytes());
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_lies_in_memory_as_its_reader_expects() {
        let mut answer = Answer::of(json!({ "a": 1 }));
        assert_eq!(answer.keep(vec![1.5, -0.0]), 0);
        assert_eq!(answer.keep(Vec::new()), 1);
        let bytes = answer.bytes();
        let count =
            |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes"));
        assert_eq!([count(0), count(4), count(8), count(12)], [7, 2, 2, 0]);
        assert_eq!(&bytes[16..23], br#"{"a":1}"#);
        assert_eq!(bytes.len(), 24 + 2 * 8);
        let number = |at: usize| f64::from_le_bytes(bytes[at..at + 8].try_into().expect("eight"));
        assert_eq!(
            [number(24).to_bits(), number(32).to_bits()],
            [1.5_f64.to_bits(), (-0.0_f64).to_bits()]
        );
    }

    #[test]
    fn bytes_lie_in_a_column_as_they_were_with_zeros_behind_the_last() {
        let mut answer = Answer::of(Value::Null);
        let bytes: Vec<u8> = (0..=255).rev().chain([7]).collect();
        let at = answer.keep_bytes(&bytes);
        let back: Vec<u8> = answer.columns[at].iter().flat_map(|it| it.to_le_bytes()).collect();
        assert_eq!(back.len(), 264);
        assert_eq!((&back[..257], &back[257..]), (&bytes[..], &[0; 7][..]));
    }
}
