//! A guard between the pages of a file and the library that decodes them.
//!
//! The library (60.1) takes memory for as many values of a dictionary as its page announces, and
//! panics at a dictionary with fewer texts than it announces, at values that refer to a dictionary
//! that is not there, at encodings of levels that do not belong and at numbers of too many bytes. A
//! page passes only if it is of the few kinds that a [`Writer`](super::Writer) writes, a dictionary
//! only if it is what it announces, and runs only if they can be followed.
//!
//! Source of the layout of pages and runs: `Encodings.md` of Apache Parquet.

use parquet::basic::Encoding;
use parquet::column::page::{Page, PageMetadata, PageReader};
use parquet::errors::{ParquetError, Result};

use super::{Kind, layout};

/// Pages of a column of a row group, each looked at before it is handed on.
pub(super) struct Guard {
    pages: Box<dyn PageReader>,
    kind: Kind,
    /// Rows that the column of this row group still lacks.
    rows_left: usize,
    dictionary_seen: bool,
}

impl Guard {
    /// The pages of a column with a number of rows.
    pub(super) fn new(pages: Box<dyn PageReader>, kind: Kind, rows: usize) -> Self {
        Self { pages, kind, rows_left: rows, dictionary_seen: false }
    }

    /// Accepts a page or says what is wrong with it.
    fn check(&mut self, page: &Page) -> Result<()> {
        let fits = match page {
            Page::DictionaryPage { buf, num_values, encoding, .. } => {
                let first = !std::mem::replace(&mut self.dictionary_seen, true);
                let values = usize::try_from(*num_values)?;
                let whole = holds(self.kind, values, buf);
                first && whole && *encoding == Encoding::PLAIN
            }
            Page::DataPage { buf, num_values, encoding, def_level_encoding, .. } => {
                let rows = usize::try_from(*num_values)?;
                let left = self.rows_left.checked_sub(rows);
                self.rows_left = left.unwrap_or(0);
                let values = levels(buf, rows).filter(|_| rows > 0 && left.is_some());
                let known = values.is_some_and(|values| match encoding {
                    Encoding::PLAIN => layout::plain(self.kind),
                    Encoding::RLE_DICTIONARY => self.dictionary_seen && indices(values),
                    _ => false,
                });
                known && *def_level_encoding == Encoding::RLE
            }
            Page::DataPageV2 { .. } => false,
        };
        if fits { Ok(()) } else { Err(refusal(page)) }
    }
}

/// Whether a dictionary of a kind that has one is made of so many values and nothing else.
fn holds(kind: Kind, values: usize, bytes: &[u8]) -> bool {
    match kind {
        Kind::Float | Kind::Integer => values.checked_mul(8) == Some(bytes.len()),
        Kind::Text => count_texts(bytes) == Some(values),
        Kind::Boolean => false,
    }
}

/// How many texts there are, each behind its length in four bytes; none if the last is cut off.
fn count_texts(mut bytes: &[u8]) -> Option<usize> {
    let mut texts = 0;
    while let Some((length, rest)) = bytes.split_first_chunk() {
        bytes = rest.get(usize::try_from(u32::from_le_bytes(*length)).ok()?..)?;
        texts += 1;
    }
    bytes.is_empty().then_some(texts)
}

/// The values of a page of so many rows, behind its levels; none if those cannot be followed.
fn levels(page: &[u8], rows: usize) -> Option<&[u8]> {
    /// Bits of a level, which says whether there is a value.
    const WIDTH: u8 = 1;
    let (length, rest) = page.split_first_chunk()?;
    let length = usize::try_from(u32::from_le_bytes(*length)).ok()?;
    let (levels, values) = rest.split_at_checked(length)?;
    (count_in_runs(levels, WIDTH)? >= rows).then_some(values)
}

/// Whether values are indices into a dictionary that can be followed: their width, and runs of them.
fn indices(values: &[u8]) -> bool {
    let runs = values.split_first();
    runs.is_some_and(|(width, runs)| *width <= 32 && count_in_runs(runs, *width).is_some())
}

/// How many numbers of so many bits there are in runs; none if one cannot be followed.
///
/// A run begins with a number: twice how often the number behind it stands there, or twice how many
/// groups of eight numbers follow, and one more.
fn count_in_runs(mut bytes: &[u8], width: u8) -> Option<usize> {
    let mut count = 0_usize;
    while !bytes.is_empty() {
        let (header, rest) = split_number(bytes)?;
        let half = usize::try_from(header >> 1).ok()?;
        let (numbers, length) = if header & 1 == 1 {
            (half.checked_mul(8)?, half.checked_mul(width.into())?)
        } else {
            (half, usize::from(width).div_ceil(8))
        };
        bytes = rest.get(length..)?;
        count = count.checked_add(numbers)?;
    }
    Some(count)
}

/// A number of at most five bytes, seven bits each, the lowest first, and what follows it.
fn split_number(bytes: &[u8]) -> Option<(u64, &[u8])> {
    let last = bytes.iter().take(5).position(|byte| byte & 0x80 == 0)?;
    let (number, rest) = bytes.split_at_checked(last + 1)?;
    let number = number.iter().rev().fold(0, |number, byte| (number << 7) | u64::from(byte & 0x7f));
    Some((number, rest))
}

/// What is wrong with a page.
fn refusal(page: &Page) -> ParquetError {
    ParquetError::General(format!(
        "a page of type {:?} with {} values as {:?} in {} bytes does not belong there",
        page.page_type(),
        page.num_values(),
        page.encoding(),
        page.buffer().len()
    ))
}

impl Iterator for Guard {
    type Item = Result<Page>;

    fn next(&mut self) -> Option<Self::Item> {
        self.get_next_page().transpose()
    }
}

impl PageReader for Guard {
    fn get_next_page(&mut self) -> Result<Option<Page>> {
        let page = self.pages.get_next_page()?;
        page.iter().try_for_each(|page| self.check(page))?;
        Ok(page)
    }

    fn peek_next_page(&mut self) -> Result<Option<PageMetadata>> {
        Err(passed_over())
    }

    fn skip_next_page(&mut self) -> Result<()> {
        Err(passed_over())
    }
}

/// Rows are read from the first to the last; nothing asks to pass over some.
fn passed_over() -> ParquetError {
    ParquetError::NYI("passing over pages".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No pages; the checks are called on pages of their own.
    struct Empty;

    impl Iterator for Empty {
        type Item = Result<Page>;

        fn next(&mut self) -> Option<Self::Item> {
            None
        }
    }

    impl PageReader for Empty {
        fn get_next_page(&mut self) -> Result<Option<Page>> {
            Ok(None)
        }

        fn peek_next_page(&mut self) -> Result<Option<PageMetadata>> {
            Ok(None)
        }

        fn skip_next_page(&mut self) -> Result<()> {
            Ok(())
        }
    }

    /// A guard of a column of four rows.
    fn guard(kind: Kind) -> Guard {
        Guard::new(Box::new(Empty), kind, 4)
    }

    /// Levels of so many rows, all with a value, and then these bytes.
    fn page(rows: u8, encoding: Encoding, levels: Encoding, values: &[u8]) -> Page {
        let mut bytes = vec![2, 0, 0, 0, rows << 1, 1];
        bytes.extend(values);
        Page::DataPage {
            buf: bytes.into(),
            num_values: rows.into(),
            encoding,
            def_level_encoding: levels,
            rep_level_encoding: Encoding::RLE,
            statistics: None,
        }
    }

    fn dictionary(values: u32, bytes: &[u8]) -> Page {
        let (encoding, is_sorted) = (Encoding::PLAIN, false);
        Page::DictionaryPage { buf: bytes.to_vec().into(), num_values: values, encoding, is_sorted }
    }

    #[test]
    fn more_rows_than_the_row_group_has_do_not_pass() {
        let plain = |rows| page(rows, Encoding::PLAIN, Encoding::RLE, &[0; 40]);
        guard(Kind::Float).check(&plain(4)).unwrap();
        guard(Kind::Float).check(&plain(5)).unwrap_err();
        guard(Kind::Float).check(&plain(0)).unwrap_err();
        let mut guard = guard(Kind::Float);
        guard.check(&plain(3)).unwrap();
        guard.check(&plain(2)).unwrap_err();
    }

    #[test]
    fn levels_in_another_encoding_do_not_pass() {
        let levels = |encoding| page(4, Encoding::PLAIN, encoding, &[0; 32]);
        guard(Kind::Float).check(&levels(Encoding::RLE)).unwrap();
        guard(Kind::Float).check(&levels(Encoding::PLAIN)).unwrap_err();
    }

    #[test]
    fn values_in_an_encoding_that_a_kind_does_not_have_do_not_pass() {
        let delta = page(4, Encoding::DELTA_BINARY_PACKED, Encoding::RLE, &[0; 32]);
        guard(Kind::Integer).check(&delta).unwrap_err();
        let plain = page(4, Encoding::PLAIN, Encoding::RLE, &[0; 32]);
        guard(Kind::Text).check(&plain).unwrap_err();
    }

    #[test]
    fn a_dictionary_passes_once_and_as_long_as_it_says() {
        let text = [1, 0, 0, 0, b'a', 0, 0, 0, 0];
        let mut twice = guard(Kind::Text);
        twice.check(&dictionary(2, &text)).unwrap();
        twice.check(&dictionary(2, &text)).unwrap_err();
        for (values, bytes) in [(1, &text[..]), (3, &text), (2, &text[..8]), (u32::MAX, &text)] {
            guard(Kind::Text).check(&dictionary(values, bytes)).unwrap_err();
        }
        guard(Kind::Float).check(&dictionary(2, &[0; 16])).unwrap();
        guard(Kind::Float).check(&dictionary(3, &[0; 16])).unwrap_err();
        guard(Kind::Boolean).check(&dictionary(1, &[0])).unwrap_err();
    }

    #[test]
    fn indices_pass_behind_their_dictionary_and_in_runs_that_can_be_followed() {
        let indices = |bytes: &[u8]| page(4, Encoding::RLE_DICTIONARY, Encoding::RLE, bytes);
        let check = |bytes: &[u8]| {
            let mut guard = guard(Kind::Float);
            guard.check(&dictionary(2, &[0; 16])).unwrap();
            guard.check(&indices(bytes))
        };
        guard(Kind::Float).check(&indices(&[1, 8, 0])).unwrap_err();
        // A width of one bit, then four times the same index, or eight indices in a byte.
        check(&[1, 8, 0]).unwrap();
        check(&[1, 3, 0b0110_0101]).unwrap();
        // No width, too wide, a run without its index, a group without its byte.
        for bytes in [&[][..], &[33, 8, 0, 0, 0, 0, 0], &[1, 8], &[1, 3]] {
            check(bytes).unwrap_err();
        }
        // A number of more bytes than the library takes without panicking.
        let mut long = vec![1];
        long.extend([0x80; 12]);
        long.extend([1, 0]);
        check(&long).unwrap_err();
    }

    #[test]
    fn levels_that_are_fewer_than_the_rows_do_not_pass() {
        assert!(levels(&[2, 0, 0, 0, 8, 1, 7], 4).is_some_and(|values| values == [7]));
        assert!(levels(&[2, 0, 0, 0, 6, 1, 7], 4).is_none());
        assert!(levels(&[9, 0, 0, 0, 8, 1, 7], 4).is_none());
        assert!(levels(&[2, 0, 0], 4).is_none());
    }
}
