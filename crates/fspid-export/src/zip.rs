//! Files in a zip archive: the same bytes each time.
//!
//! As PKWARE's APPNOTE 6.3 has it: a header before each file, the directory at the end, no part that newer versions
//! brought. Every file is dated 1980-01-01, the first day that the format knows.

use crate::file::File;

/// Days and months count from 1.
const FIRST_DAY: u16 = (1 << 5) | 1;
/// 2.0: folders and deflate.
const VERSION: u16 = 20;
const DEFLATED: u16 = 8;
/// Names are UTF-8.
const FLAGS: u16 = 1 << 11;
/// Of deflate, as slow as it gets; an archive has some tens of kilobytes.
const LEVEL: u8 = 10;

/// The archive of these files, in this order: the same bytes each time, every file dated 1980-01-01.
#[must_use]
pub fn archive(files: &[File]) -> Vec<u8> {
    let (mut bytes, mut directory) = (Vec::new(), Vec::new());
    for file in files {
        let packed = miniz_oxide::deflate::compress_to_vec(&file.bytes, LEVEL);
        let common = common(file, &packed);
        let offset = size(bytes.len());
        bytes.extend(*b"PK\x03\x04");
        bytes.extend(&common);
        bytes.extend(file.name.as_bytes());
        bytes.extend(packed);
        directory.extend(*b"PK\x01\x02");
        directory.extend(VERSION.to_le_bytes());
        directory.extend(common);
        // No comment, the first disk, no attributes.
        directory.extend([0; 10]);
        directory.extend(offset.to_le_bytes());
        directory.extend(file.name.as_bytes());
    }
    let (offset, count) = (size(bytes.len()), files.len() as u16);
    let length = size(directory.len());
    bytes.extend(directory);
    bytes.extend(*b"PK\x05\x06");
    bytes.extend([0; 4]);
    bytes.extend([count.to_le_bytes(), count.to_le_bytes()].concat());
    bytes.extend([length.to_le_bytes(), offset.to_le_bytes()].concat());
    bytes.extend([0; 2]);
    bytes
}

/// What both headers say of a file.
fn common(file: &File, packed: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for short in [VERSION, FLAGS, DEFLATED, 0, FIRST_DAY] {
        bytes.extend(short.to_le_bytes());
    }
    for long in [checksum(&file.bytes), size(packed.len()), size(file.bytes.len())] {
        bytes.extend(long.to_le_bytes());
    }
    bytes.extend((file.name.len() as u16).to_le_bytes());
    bytes.extend([0; 2]);
    bytes
}

fn size(bytes: usize) -> u32 {
    u32::try_from(bytes).unwrap_or(u32::MAX)
}

/// CRC-32 as zip has it (ISO 3309), bit by bit.
fn checksum(bytes: &[u8]) -> u32 {
    let mut rest = u32::MAX;
    for byte in bytes {
        rest ^= u32::from(*byte);
        for _ in 0..8 {
            rest = (rest >> 1) ^ (0xedb8_8320 & 0_u32.wrapping_sub(rest & 1));
        }
    }
    !rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checksum_of_the_nine_digits_is_that_of_the_standard() {
        assert_eq!(checksum(b"123456789"), 0xcbf4_3926);
    }
}
