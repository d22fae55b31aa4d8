//! Files that are damaged, cut off, foreign or made to do harm.

use std::fs;
use std::path::Path;
use std::sync::{Arc, LazyLock};

use fspid_campaign::table::{
    COLUMNS_KEY, ColumnTable, Damage, Foreign, Kind, METADATA_DIGEST_KEY, Reader, TableError,
    Values,
};
use parquet::basic::{Compression, Repetition, Type as Physical};
use parquet::data_type::DoubleType;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use proptest::prelude::*;
use tempfile::tempdir;

use crate::table::{file, long_table, read, schema};

/// What comes of a file: nothing but an error, or all that was in it. Returns whether it was read.
fn survives(path: &Path, bytes: &[u8], original: &ColumnTable, place: &str) -> bool {
    let found = read(path, bytes).and_then(|(reader, table)| Ok((reader.verify()?, reader, table)));
    match found {
        Ok((_, reader, table)) => {
            assert!(table == *original, "{place}: other rows without an error");
            assert_eq!(reader.rows(), original.rows(), "{place}");
            assert_eq!(reader.metadata(), [("campaign".to_owned(), "test".to_owned())], "{place}");
            true
        }
        Err(TableError::Damaged { reason: Damage::Panic, .. }) => {
            panic!("{place}: the library panicked")
        }
        Err(error) => {
            assert!(error.to_string().contains("t.parquet"), "{place}: {error}");
            false
        }
    }
}

#[test]
fn a_file_with_any_byte_changed_is_refused_or_read_in_full() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("t.parquet");
    let table = long_table(12);
    let whole = file(&table);
    let mut read = 0;
    for place in 0..whole.len() {
        for change in [0x01, 0x02, 0x10, 0x80, 0xff] {
            let mut bytes = whole.clone();
            bytes[place] ^= change;
            read += usize::from(survives(
                &path,
                &bytes,
                &table,
                &format!("byte {place} ^ {change:#x}"),
            ));
        }
    }
    println!("{} bytes; {read} of {} changes did no harm", whole.len(), 5 * whole.len());
    // What does no harm are names of the writer, sizes nobody uses and padding.
    assert!(read < whole.len(), "{read} of {}", 5 * whole.len());
}

#[test]
fn a_file_cut_off_anywhere_is_refused() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("t.parquet");
    let table = long_table(12);
    let whole = file(&table);
    for length in 0..whole.len() {
        assert!(!survives(&path, &whole[..length], &table, &format!("{length} bytes")));
        assert!(matches!(Reader::open(&path), Err(TableError::NotParquet { .. })), "{length}");
    }
    let mut longer = whole;
    longer.extend(b"tail");
    assert!(!survives(&path, &longer, &table, "longer"));
}

/// Every row another float, so that the dictionary is given up on the way; and texts and counts.
fn mixed_table() -> ColumnTable {
    let schema = schema(&[Kind::Float, Kind::Text, Kind::Integer]);
    let mut table = ColumnTable::new(schema);
    for row in 0..3000_i64 {
        let text = format!("{}", row % 300);
        table
            .push(&[(row as f64).sqrt().into(), text.as_str().into(), (row * row).into()])
            .unwrap();
    }
    table
}

/// The table and its file, made once for all cases.
static MIXED: LazyLock<(ColumnTable, Vec<u8>)> = LazyLock::new(|| {
    let table = mixed_table();
    let bytes = file(&table);
    (table, bytes)
});

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]
    #[test]
    fn a_file_with_bytes_overwritten_is_refused_or_read_in_full(
        place in any::<prop::sample::Index>(),
        noise in prop::collection::vec(any::<u8>(), 1..12),
        footer in any::<bool>(),
    ) {
        let folder = tempdir().unwrap();
        let (table, mut bytes) = (&MIXED.0, MIXED.1.clone());
        // The footer is a small part of the file, and the part where most can go wrong.
        let first = if footer { bytes.len() - 1200 } else { 0 };
        let place = first + place.index(bytes.len() - first - noise.len());
        bytes[place..place + noise.len()].copy_from_slice(&noise);
        survives(&folder.path().join("t.parquet"), &bytes, table, &format!("{noise:?} at {place}"));
    }

    #[test]
    fn bytes_of_any_kind_are_refused(noise in prop::collection::vec(any::<u8>(), 0..200), magic in any::<bool>()) {
        let folder = tempdir().unwrap();
        let path = folder.path().join("t.parquet");
        let mut bytes = noise;
        if magic {
            let length = (bytes.len() as u32).to_le_bytes();
            bytes.splice(0..0, *b"PAR1");
            bytes.extend(length);
            bytes.extend(b"PAR1");
        }
        fs::write(&path, &bytes).unwrap();
        let error = Reader::open(&path).err();
        prop_assert!(error.is_some());
        let panicked = matches!(error, Some(TableError::Damaged { reason: Damage::Panic, .. }));
        prop_assert!(!panicked);
    }
}

#[test]
fn a_value_changed_within_its_page_is_found_by_the_digest() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("t.parquet");
    let mut bytes = file(&long_table(12));
    let place = bytes.windows(8).position(|window| window == 2.0_f64.to_le_bytes()).unwrap();
    bytes[place] ^= 1;
    let (reader, _) = read(&path, &bytes).unwrap();
    assert!(matches!(reader.verify(), Err(TableError::DigestDiffers { .. })));
}

#[test]
fn metadata_that_was_changed_is_found_when_the_file_is_opened() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("t.parquet");
    let mut bytes = file(&long_table(12));
    let place = bytes.windows(8).position(|window| window == b"campaign").unwrap();
    bytes[place] = b'k';
    fs::write(&path, &bytes).unwrap();
    let error = Reader::open(&path).err();
    assert!(
        matches!(error, Some(TableError::Damaged { reason: Damage::MetadataDigest { .. }, .. })),
        "{error:?}"
    );
}

#[test]
fn a_number_of_rows_that_the_row_groups_do_not_have_is_refused() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("t.parquet");
    let mut bytes = file(&long_table(12));
    // In the footer field 3, 12 as a signed number, then field 4, the list of row groups.
    let place = bytes.windows(3).rposition(|window| window == [0x16, 24, 0x19]).unwrap();
    bytes[place + 1] = 26;
    fs::write(&path, &bytes).unwrap();
    let error = Reader::open(&path).err();
    let told = Damage::Rows { told: 13, found: 12 }.to_string();
    assert!(error.as_ref().is_some_and(|error| error.to_string().ends_with(&told)), "{error:?}");
}

/// A dictionary of 2³¹ − 1 texts would be 64 GB before the first is looked at.
#[test]
fn a_dictionary_that_announces_more_than_it_has_is_refused() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("t.parquet");
    let texts = Values::Text(vec![Some("some".to_owned()); 60]);
    let whole = file(&ColumnTable::from_values(schema(&[Kind::Text]), vec![texts]).unwrap());
    // The header of the dictionary page: field 7 of the page, its field 1 with one value (2 as signed).
    let place = whole.windows(3).position(|window| window == [0x4c, 0x15, 0x02]).unwrap() + 2;
    let mut bytes = whole[..place].to_vec();
    bytes.extend([0xfe, 0xff, 0xff, 0xff, 0x0f]);
    bytes.extend(&whole[place + 1..]);
    let error = read(&path, &bytes).err();
    assert!(
        matches!(error, Some(TableError::Damaged { reason: Damage::Values { .. }, .. })),
        "{error:?}"
    );
    assert!(error.unwrap().to_string().contains("2147483647 values"));
}

/// What a file of another program is made of.
struct Other {
    compression: Compression,
    repetition: Repetition,
    rows: usize,
    nested: bool,
    keys: Vec<KeyValue>,
}

impl Other {
    fn new(keys: Vec<KeyValue>) -> Self {
        let (compression, repetition) = (Compression::UNCOMPRESSED, Repetition::OPTIONAL);
        Self { compression, repetition, rows: 3, nested: false, keys }
    }

    fn file(self) -> Vec<u8> {
        let column =
            Type::primitive_type_builder("a", Physical::DOUBLE).with_repetition(self.repetition);
        let mut column = Arc::new(column.build().unwrap());
        let mut deepest = i16::from(self.repetition == Repetition::OPTIONAL);
        if self.nested {
            let group = Type::group_type_builder("g").with_fields(vec![column]);
            column = Arc::new(group.with_repetition(Repetition::OPTIONAL).build().unwrap());
            deepest += 1;
        }
        let root =
            Arc::new(Type::group_type_builder("root").with_fields(vec![column]).build().unwrap());
        let properties = WriterProperties::builder()
            .set_compression(self.compression)
            .set_key_value_metadata((!self.keys.is_empty()).then_some(self.keys));
        let mut writer =
            SerializedFileWriter::new(Vec::new(), root, Arc::new(properties.build())).unwrap();
        let mut group = writer.next_row_group().unwrap();
        let mut column = group.next_column().unwrap().unwrap();
        let (values, levels) = (vec![0.5; self.rows], vec![deepest; self.rows]);
        column.typed::<DoubleType>().write_batch(&values, Some(&levels), None).unwrap();
        column.close().unwrap();
        group.close().unwrap();
        writer.into_inner().unwrap()
    }
}

/// The metadata of a file of ours with one column of floats, as another program may copy it.
fn own_keys(path: &Path) -> Vec<KeyValue> {
    use parquet::file::reader::{FileReader as _, SerializedFileReader};
    fs::write(path, file(&ColumnTable::new(schema(&[Kind::Float])))).unwrap();
    let reader = SerializedFileReader::new(fs::File::open(path).unwrap()).unwrap();
    reader.metadata().file_metadata().key_value_metadata().unwrap().clone()
}

#[test]
fn a_parquet_file_of_another_program_is_refused_with_the_difference() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("t.parquet");
    let keys = own_keys(&path);
    let own = || Other::new(keys.clone());
    let refusal = |bytes: Vec<u8>| match read(&path, &bytes) {
        Err(TableError::Foreign { reason, .. }) => reason,
        other => panic!("{other:?}"),
    };
    assert_eq!(refusal(Other::new(Vec::new()).file()), Foreign::NoKey { key: METADATA_DIGEST_KEY });
    assert_eq!(refusal(Other { nested: true, ..own() }.file()), Foreign::Nested);
    let required = Other { repetition: Repetition::REQUIRED, ..own() };
    assert_eq!(refusal(required.file()), Foreign::Column { index: 0 });
    let compressed = Other { compression: Compression::SNAPPY, ..own() };
    assert_eq!(refusal(compressed.file()), Foreign::Storage { row_group: 0, column: 0 });
    let large = refusal(Other { rows: 16_385, ..own() }.file());
    assert_eq!(large, Foreign::RowGroup { row_group: 0, rows: 16_385, allowed: 16_384 });
    assert!(keys.iter().any(|pair| pair.key == COLUMNS_KEY));

    // With the right keys, shape and encodings it is one of ours, but for its content.
    let (reader, table) = read(&path, &own().file()).unwrap();
    assert_eq!(table.floats("a").unwrap(), [Some(0.5); 3]);
    assert!(matches!(reader.verify(), Err(TableError::DigestDiffers { .. })));
}

#[test]
fn what_is_no_file_of_any_rows_is_refused_with_its_path() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("t.parquet");
    assert!(matches!(Reader::open(&path), Err(TableError::Open { .. })));
    assert!(matches!(Reader::open(folder.path()), Err(TableError::Open { .. })));
    for bytes in [&b""[..], b"PAR1", b"PAR1PAR1", b"PAR1....PAR2", b"run,overshoot\n1,2\n"] {
        fs::write(&path, bytes).unwrap();
        let error = Reader::open(&path).unwrap_err();
        assert!(matches!(error, TableError::NotParquet { .. }), "{error}");
        assert!(error.to_string().contains("t.parquet"), "{error}");
    }
    fs::write(&path, b"PAR1\xff\xff\xff\xffPAR1").unwrap();
    let error = Reader::open(&path).unwrap_err();
    assert!(
        matches!(error, TableError::Damaged { reason: Damage::FooterLength { .. }, .. }),
        "{error}"
    );
}
