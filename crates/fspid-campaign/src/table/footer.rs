//! A look at the footer before the Parquet library sees it.
//!
//! The library (60.1) takes memory for as many children of a group of columns as a file announces and
//! calls itself for each level of groups, so that a footer of a few bytes could end the process where
//! no error can be returned. Tables of results are flat: the footer is walked here, and one whose
//! schema is not flat, or that cannot be followed, is refused. Everything else that the library takes
//! memory for it compares with the bytes there are.
//!
//! Source: the compact protocol of Apache Thrift and `parquet.thrift` of Apache Parquet: in a
//! `FileMetaData` field 2 is the list of `SchemaElement`, whose field 5 is the number of children.

use std::io::{self, Read, Seek, SeekFrom};

use super::checks::Refusal;
use super::{Damage, Foreign};

/// Types of the compact protocol, as they stand in the header of a field or list.
mod wire {
    pub(super) const TRUE: u8 = 1;
    pub(super) const FALSE: u8 = 2;
    pub(super) const BYTE: u8 = 3;
    pub(super) const I16: u8 = 4;
    pub(super) const I32: u8 = 5;
    pub(super) const I64: u8 = 6;
    pub(super) const DOUBLE: u8 = 7;
    pub(super) const BINARY: u8 = 8;
    pub(super) const LIST: u8 = 9;
    pub(super) const SET: u8 = 10;
    pub(super) const MAP: u8 = 11;
    pub(super) const STRUCT: u8 = 12;
}

/// Field of `FileMetaData` with the schema.
const SCHEMA: i64 = 2;

/// Field of `SchemaElement` with the number of children.
const CHILDREN: i64 = 5;

/// Depth beyond which a structure is not followed; the deepest of Parquet has 7 levels.
const MAX_DEPTH: u8 = 16;

/// First and last bytes of a Parquet file.
const MAGIC: [u8; 4] = *b"PAR1";

/// Bytes of the footer's length and the magic behind it.
const TAIL_BYTES: u64 = 8;

/// The footer of a file of so many bytes.
///
/// The inner error is for bytes that are there but wrong, the outer one for those that cannot be read.
pub(super) fn read(
    file: &mut (impl Read + Seek),
    bytes: u64,
) -> io::Result<Result<Vec<u8>, Refusal>> {
    let not_parquet = Ok(Err(Refusal::NotParquet(bytes)));
    let Some(room) = bytes.checked_sub(TAIL_BYTES + MAGIC.len() as u64) else { return not_parquet };
    let (mut head, mut length, mut tail) = ([0; 4], [0; 4], [0; 4]);
    file.read_exact(&mut head)?;
    file.seek(SeekFrom::Start(bytes - TAIL_BYTES))?;
    file.read_exact(&mut length)?;
    file.read_exact(&mut tail)?;
    if head != MAGIC || tail != MAGIC {
        return not_parquet;
    }
    let told = u64::from(u32::from_le_bytes(length));
    if told > room {
        return Ok(Err(Damage::FooterLength { told, bytes }.into()));
    }
    file.seek(SeekFrom::Start(bytes - TAIL_BYTES - told))?;
    let mut footer = Vec::new();
    file.take(told).read_to_end(&mut footer)?;
    Ok(Ok(footer))
}

/// Accepts a footer whose structure can be followed to its end and whose schema is flat.
pub(super) fn check(footer: &[u8]) -> Result<(), Refusal> {
    let mut walk = Walk { bytes: footer, at: 0, flat: true };
    let whole = walk.file_metadata().is_some();
    match (whole, walk.flat) {
        (true, true) => Ok(()),
        (true, false) => Err(Refusal::Foreign(Foreign::Nested)),
        (false, _) => Err(Refusal::Damaged(Damage::Footer { at: walk.at })),
    }
}

/// A place in a footer.
struct Walk<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Whether every schema so far was a root with columns and nothing else.
    flat: bool,
}

impl Walk<'_> {
    /// The next byte, none at the end.
    fn byte(&mut self) -> Option<u8> {
        let byte = *self.bytes.get(self.at)?;
        self.at += 1;
        Some(byte)
    }

    /// Passes over some bytes, none if there are not as many.
    fn pass(&mut self, bytes: u64) -> Option<()> {
        let at = self.at.checked_add(usize::try_from(bytes).ok()?)?;
        if at > self.bytes.len() {
            return None;
        }
        self.at = at;
        Some(())
    }

    /// A number without sign: seven bits a byte, the lowest first, the highest bit if more follow.
    fn number(&mut self) -> Option<u64> {
        let mut number = 0;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            number |= u64::from(byte & 0x7f) << shift;
            if byte & 0x80 == 0 {
                return Some(number);
            }
        }
        None
    }

    /// A number with sign, which is kept in the lowest bit.
    fn signed(&mut self) -> Option<i64> {
        let number = self.number()?;
        Some((number >> 1).cast_signed() ^ -(number & 1).cast_signed())
    }

    /// The next field of a structure, as type and number; `Some(None)` where the structure ends.
    #[expect(
        clippy::option_option,
        reason = "the end of the structure is not the end of the bytes"
    )]
    fn field(&mut self, last: i64) -> Option<Option<(u8, i64)>> {
        let header = self.byte()?;
        if header == 0 {
            return Some(None);
        }
        let field = match header >> 4 {
            0 => self.signed()?,
            step => last.checked_add(i64::from(step))?,
        };
        Some(Some((header & 0x0f, field)))
    }

    /// The header of a list: number and type of what is in it.
    fn list(&mut self) -> Option<(u64, u8)> {
        let header = self.byte()?;
        let length = match header >> 4 {
            15 => self.number()?,
            length => u64::from(length),
        };
        Some((length, header & 0x0f))
    }

    /// Walks a structure, with something else than passing over for some fields.
    fn structure(
        &mut self,
        depth: u8,
        mut visit: impl FnMut(&mut Self, u8, i64) -> Option<bool>,
    ) -> Option<()> {
        let mut last = 0;
        while let Some((kind, field)) = self.field(last)? {
            if !visit(self, kind, field)? {
                self.skip(kind, depth)?;
            }
            last = field;
        }
        Some(())
    }

    /// `FileMetaData`, to its end.
    fn file_metadata(&mut self) -> Option<()> {
        self.structure(MAX_DEPTH, |walk, kind, field| {
            let schema = field == SCHEMA && kind == wire::LIST;
            if schema {
                walk.schema()?;
            }
            Some(schema)
        })
    }

    /// The list of `SchemaElement`: a root whose children are all the others, which have none.
    fn schema(&mut self) -> Option<()> {
        let (length, kind) = self.list()?;
        for element in 0..length {
            if kind != wire::STRUCT {
                return None;
            }
            let mut children = 0;
            self.structure(MAX_DEPTH, |walk, kind, field| {
                let count = field == CHILDREN && kind == wire::I32;
                if count {
                    children = walk.signed()?;
                }
                Some(count)
            })?;
            let expected = if element == 0 { length - 1 } else { 0 };
            self.flat &= u64::try_from(children) == Ok(expected);
        }
        Some(())
    }

    /// Passes over a value of a type.
    fn skip(&mut self, kind: u8, depth: u8) -> Option<()> {
        let depth = depth.checked_sub(1)?;
        match kind {
            // In a field the type is the value.
            wire::TRUE | wire::FALSE => Some(()),
            wire::BYTE => self.pass(1),
            wire::I16 | wire::I32 | wire::I64 => self.number().map(drop),
            wire::DOUBLE => self.pass(8),
            wire::BINARY => {
                let length = self.number()?;
                self.pass(length)
            }
            wire::LIST | wire::SET => {
                let (length, kind) = self.list()?;
                (0..length).try_for_each(|_| self.skip_element(kind, depth))
            }
            wire::MAP => self.skip_map(depth),
            wire::STRUCT => self.structure(depth, |_, _, _| Some(false)),
            _ => None,
        }
    }

    /// Passes over an element of a list; a truth value has a byte there.
    fn skip_element(&mut self, kind: u8, depth: u8) -> Option<()> {
        if matches!(kind, wire::TRUE | wire::FALSE) { self.pass(1) } else { self.skip(kind, depth) }
    }

    /// Passes over a map.
    fn skip_map(&mut self, depth: u8) -> Option<()> {
        let length = self.number()?;
        if length == 0 {
            return Some(());
        }
        let kinds = self.byte()?;
        (0..length).try_for_each(|_| {
            self.skip_element(kinds >> 4, depth)?;
            self.skip_element(kinds & 0x0f, depth)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A `FileMetaData` with nothing but a schema of elements with these numbers of children.
    fn footer(children: &[u8]) -> Vec<u8> {
        let mut bytes = vec![0x29, (children.len() as u8) << 4 | wire::STRUCT];
        for count in children {
            bytes.extend([0x55, count << 1, 0]);
        }
        bytes.push(0);
        bytes
    }

    #[test]
    fn a_flat_schema_is_accepted() {
        check(&footer(&[3, 0, 0, 0])).unwrap();
    }

    #[test]
    fn a_group_within_the_schema_is_refused() {
        for children in [&[1, 1, 0][..], &[3, 0, 0], &[1, 0, 0], &[0, 1], &[60]] {
            let refusal = check(&footer(children)).unwrap_err();
            assert!(
                matches!(refusal, Refusal::Foreign(Foreign::Nested)),
                "{children:?} {refusal:?}"
            );
        }
    }

    #[test]
    fn a_footer_that_ends_early_is_refused_with_the_place() {
        let whole = footer(&[3, 0, 0, 0]);
        for length in 0..whole.len() {
            let refusal = check(&whole[..length]).unwrap_err();
            assert!(
                matches!(refusal, Refusal::Damaged(Damage::Footer { at }) if at <= length),
                "{refusal:?}"
            );
        }
    }

    #[test]
    fn structures_without_end_are_refused() {
        // Deep enough to run out of stack, if each level were a call.
        let deep = vec![0x1c; 4_000_000];
        assert!(matches!(check(&deep), Err(Refusal::Damaged(_))));
        // A list that says it has 2^63 lists.
        let mut long = vec![0x19, 0xf9];
        long.extend([0xff; 9]);
        long.push(0x01);
        assert!(matches!(check(&long), Err(Refusal::Damaged(_))));
    }
}
