//! A reader of zip archives, by their directory as others read them.

fn number(bytes: &[u8], at: usize, size: usize) -> usize {
    bytes[at..at + size].iter().rev().fold(0, |all, byte| (all << 8) | usize::from(*byte))
}

/// Name and content of each file.
pub(crate) fn unpacked(archive: &[u8]) -> Vec<(String, Vec<u8>)> {
    let end = archive.len() - 22;
    assert_eq!(&archive[end..end + 4], b"PK\x05\x06");
    let (count, mut at) = (number(archive, end + 10, 2), number(archive, end + 16, 4));
    let mut files = Vec::new();
    for _ in 0..count {
        assert_eq!(&archive[at..at + 4], b"PK\x01\x02");
        let [packed, size] = [20, 24].map(|field| number(archive, at + field, 4));
        let name_size = number(archive, at + 28, 2);
        let name = archive[at + 46..at + 46 + name_size].to_vec();
        let local = number(archive, at + 42, 4);
        assert_eq!(&archive[local..local + 4], b"PK\x03\x04");
        assert_eq!(archive[local + 4..local + 28], archive[at + 6..at + 30]);
        let data = local + 30 + name_size;
        let content = miniz_oxide::inflate::decompress_to_vec(&archive[data..data + packed]);
        let content = content.expect("deflated");
        assert_eq!(content.len(), size);
        files.push((String::from_utf8(name).expect("UTF-8"), content));
        at += 46 + name_size;
    }
    files
}
