//! The files of a zip archive, as PKWARE's APPNOTE 6.3 has it: stored or deflated, without encryption, one disk.

use std::io;
use std::path::{Component, Path};

/// Largest size of all files together, in bytes: a controller has some tens of kilobytes, and a bomb is refused.
const MOST_BYTES: usize = 64 << 20;
/// Most files: a controller has some dozens, and each takes a moment in each flight.
const MOST_FILES: usize = 4096;
/// The bit of an entry's flags that says that it is encrypted.
const ENCRYPTED: usize = 1;
/// Longest end of an archive: its fixed part and a comment.
const LONGEST_END: usize = 22 + u16::MAX as usize;

/// The bytes of an archive, which is no larger than what is in it may be.
pub(crate) fn archive(path: &Path) -> io::Result<Vec<u8>> {
    let size = std::fs::metadata(path)?.len();
    if size > MOST_BYTES as u64 {
        return Err(bad("it is larger than 64 MiB"));
    }
    std::fs::read(path)
}

/// Writes the files of an archive into a folder.
pub(crate) fn unpack(archive: &[u8], folder: &Path) -> io::Result<()> {
    let mut left = MOST_BYTES;
    let mut files = 0;
    for entry in entries(archive).ok_or_else(|| bad("it is no zip archive"))? {
        let Entry { name, bytes } = entry?;
        files += 1;
        if files > MOST_FILES {
            return Err(bad("it has more than 4096 files"));
        }
        left =
            left.checked_sub(bytes.len()).ok_or_else(|| bad("its files are larger than 64 MiB"))?;
        let path = Path::new(&name);
        if !path.components().all(|part| matches!(part, Component::Normal(_))) {
            return Err(bad("a name in it leads out of the folder"));
        }
        let path = folder.join(path);
        if name.ends_with('/') {
            std::fs::create_dir_all(&path)?;
            continue;
        }
        std::fs::create_dir_all(path.parent().unwrap_or(folder))?;
        std::fs::write(&path, bytes)?;
    }
    Ok(())
}

struct Entry {
    name: String,
    bytes: Vec<u8>,
}

fn bad(reason: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, reason)
}

/// The entries of the directory at the end; `None` where there is none.
fn entries(archive: &[u8]) -> Option<impl Iterator<Item = io::Result<Entry>>> {
    let from = archive.len().saturating_sub(LONGEST_END);
    let end = from + archive.get(from..)?.windows(4).rposition(|it| it == b"PK\x05\x06")?;
    let count = short(archive, end + 10)?;
    let mut at = long(archive, end + 16)?;
    Some((0..count).map(move |_| {
        let (entry, next) = entry(archive, at).ok_or_else(|| bad("its directory is cut off"))?;
        at = next;
        entry
    }))
}

/// The entry at a place of the directory, and the place of the next.
fn entry(archive: &[u8], at: usize) -> Option<(io::Result<Entry>, usize)> {
    archive.get(at..)?.starts_with(b"PK\x01\x02").then_some(())?;
    let (flags, method) = (short(archive, at + 8)?, short(archive, at + 10)?);
    let [sum, packed, size] = [16, 20, 24].map(|offset| long(archive, at + offset));
    let (sum, packed, size) = (sum?, packed?, size?);
    let [name, extra, comment] = [28, 30, 32].map(|offset| short(archive, at + offset));
    let (name, next) = (name?, 46 + name? + extra? + comment?);
    let name = String::from_utf8_lossy(archive.get(at + 46..at + 46 + name)?).into_owned();
    // The header before the file has lengths of its own.
    let header = long(archive, at + 42)?;
    let begin = header + 30 + short(archive, header + 26)? + short(archive, header + 28)?;
    let packed = archive.get(begin..begin.checked_add(packed)?)?;
    let bytes = match method {
        _ if flags & ENCRYPTED != 0 => Err(bad("a file in it is encrypted")),
        0 => Ok(packed.to_vec()),
        8 => miniz_oxide::inflate::decompress_to_vec_with_limit(packed, size.min(MOST_BYTES))
            .map_err(|_| bad("a file in it cannot be unpacked")),
        _ => Err(bad("a file in it is neither stored nor deflated")),
    };
    let bytes = bytes.and_then(|bytes| match (bytes.len(), crc32(&bytes)) == (size, sum) {
        true => Ok(bytes),
        false => Err(bad("a file in it is damaged: its size or its sum is another than it says")),
    });
    Some((bytes.map(|bytes| Entry { name, bytes }), at + next))
}

/// The sum of a file's bytes: CRC-32 of the polynomial 0xedb88320, as APPNOTE 4.4.7 has it.
fn crc32(bytes: &[u8]) -> usize {
    let turned = |sum: u32, _| (sum >> 1) ^ (0xedb8_8320 & (sum & 1).wrapping_neg());
    let of_byte = |byte: u32| (0..8).fold(byte, turned);
    let table: [u32; 256] = std::array::from_fn(|byte| of_byte(byte as u32));
    let add = |sum: u32, byte: &u8| {
        let place = (sum ^ u32::from(*byte)) & 0xff;
        (sum >> 8) ^ table.get(place as usize).copied().unwrap_or_default()
    };
    !bytes.iter().fold(u32::MAX, add) as usize
}

fn short(bytes: &[u8], at: usize) -> Option<usize> {
    let found = bytes.get(at..at.checked_add(2)?)?;
    Some(usize::from(u16::from_le_bytes(found.try_into().ok()?)))
}

fn long(bytes: &[u8], at: usize) -> Option<usize> {
    let found = bytes.get(at..at.checked_add(4)?)?;
    usize::try_from(u32::from_le_bytes(found.try_into().ok()?)).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An archive of one stored file.
    fn stored(bytes: &[u8], flags: u8) -> Vec<u8> {
        let sizes = [(bytes.len() as u32).to_le_bytes(); 2].concat();
        let common = [
            &[20, 0, flags, 0, 0, 0, 0, 0, 0, 0][..],
            &(crc32(bytes) as u32).to_le_bytes(),
            &sizes,
        ]
        .concat();
        let mut archive = [b"PK\x03\x04", &common[..], &[1, 0, 0, 0, b'f'], bytes].concat();
        let at = (archive.len() as u32).to_le_bytes();
        archive.extend([b"PK\x01\x02\x14\x00", &common[..], &[1], &[0; 17], b"f"].concat());
        archive.extend(
            [&b"PK\x05\x06\0\0\0\0\x01\0\x01\0"[..], &[47, 0, 0, 0], &at, &[0; 2]].concat(),
        );
        archive
    }

    #[test]
    fn an_archive_is_unpacked_if_it_is_whole_and_readable() {
        let folder = tempfile::tempdir().expect("a folder");
        let refused =
            |archive: &[u8]| unpack(archive, folder.path()).err().map(|it| it.to_string());
        assert_eq!(crc32(b"123456789"), 0xcbf4_3926);
        let whole = stored(b"some bytes", 0);
        assert_eq!(refused(&whole), None);
        assert!(std::fs::read(folder.path().join("f")).is_ok_and(|found| found == b"some bytes"));
        let mut damaged = whole;
        damaged[35] ^= 1;
        assert!(refused(&damaged).is_some_and(|told| told.contains("damaged")));
        assert!(refused(&stored(b"secret", 1)).is_some_and(|told| told.contains("encrypted")));
    }

    #[test]
    fn what_is_no_archive_is_refused_wherever_it_is_cut() {
        let folder = std::env::temp_dir();
        assert!(unpack(b"", &folder).is_err());
        assert!(unpack(b"no archive at all, and longer than its end would be", &folder).is_err());
        let mut end = b"PK\x05\x06".to_vec();
        end.extend([0, 0, 0, 0, 1, 0, 1, 0, 9, 0, 0, 0, 200, 0, 0, 0, 0, 0]);
        assert!(unpack(&end, &folder).is_err());
    }

    /// An archive of one file that is packed.
    fn packed(name: &str, bytes: &[u8], said: u32) -> Vec<u8> {
        let packed = miniz_oxide::deflate::compress_to_vec(bytes, 9);
        let sizes = [packed.len() as u32, said].map(u32::to_le_bytes).concat();
        let name_size = (name.len() as u16).to_le_bytes();
        let sum = (crc32(bytes) as u32).to_le_bytes();
        let common = [&[20, 0, 0, 0, 8, 0, 0, 0, 0, 0][..], &sum, &sizes, &name_size, &[0, 0]];
        let common = common.concat();
        let file = [b"PK\x03\x04", &common[..], name.as_bytes(), &packed].concat();
        let entry = [b"PK\x01\x02\x14\0", &common[..], &[0; 14], name.as_bytes()].concat();
        let places = [entry.len() as u32, file.len() as u32].map(u32::to_le_bytes).concat();
        let end = [b"PK\x05\x06\0\0\0\0\x01\0\x01\0", &places[..], &[0, 0]].concat();
        [file, entry, end].concat()
    }

    #[test]
    fn a_bomb_is_refused_whatever_it_says_of_its_size() {
        let folder = tempfile::tempdir().expect("a folder");
        let bomb = vec![0; MOST_BYTES + 1];
        for said in [bomb.len() as u32, 9, u32::MAX] {
            assert!(unpack(&packed("bomb", &bomb, said), folder.path()).is_err(), "{said}");
            assert!(!folder.path().join("bomb").exists());
        }
        unpack(&packed("small", b"not one", 7), folder.path()).expect("unpacked");
        assert_eq!(std::fs::read(folder.path().join("small")).expect("a file"), b"not one");
    }
}
