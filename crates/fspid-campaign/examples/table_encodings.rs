//! Measures ways to write columns of numbers, for the choices in `table/layout.rs`:
//!
//! ```sh
//! cargo run --release -p fspid-campaign --example table_encodings
//! ```

use std::error::Error;
use std::fs::{self, File};
use std::sync::Arc;

use parquet::basic::{Compression, Encoding, Repetition, Type as Physical};
use parquet::column::reader::ColumnReaderImpl;
use parquet::data_type::DoubleType;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::reader::{FileReader as _, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;

/// Values of a column.
const ROWS: usize = 1 << 20;

/// Rows of a row group, as tables have them.
const GROUP: usize = fspid_campaign::table::ROWS_PER_GROUP;

/// A way to write: its name, encoding, largest dictionary in bytes, compression.
type Way = (&'static str, Encoding, Option<usize>, Compression);

/// The ways that were looked at.
const WAYS: [Way; 7] = [
    ("plain", Encoding::PLAIN, None, Compression::UNCOMPRESSED),
    ("plain, snappy", Encoding::PLAIN, None, Compression::SNAPPY),
    ("split, snappy", Encoding::BYTE_STREAM_SPLIT, None, Compression::SNAPPY),
    ("dictionary 16 KiB", Encoding::PLAIN, Some(16 << 10), Compression::UNCOMPRESSED),
    ("dictionary 64 KiB", Encoding::PLAIN, Some(64 << 10), Compression::UNCOMPRESSED),
    ("dictionary 1 MiB", Encoding::PLAIN, Some(1 << 20), Compression::UNCOMPRESSED),
    ("dictionary 16 KiB, snappy", Encoding::PLAIN, Some(16 << 10), Compression::SNAPPY),
];

/// A column: its name, and a value from a uniform number and the row.
type Column = (&'static str, fn(f64, usize) -> f64);

/// The columns: each a function of a number that is uniform in 0 … 1 and of the row.
fn columns() -> [Column; 6] {
    [
        ("uniform", |x, _| x),
        ("narrow", |x, _| 1.0 + 0.01 * x),
        ("multiples of 0.02", |x, _| (x * 1500.0).round() * 0.02),
        ("three values", |x, _| {
            if x < 0.3 {
                0.1
            } else if x < 0.7 {
                0.2
            } else {
                0.5
            }
        }),
        ("constant", |_, _| 3.25),
        ("index", |_, row| row as f64),
    ]
}

/// Numbers that are uniform in 0 … 1, by xorshift (Marsaglia 2003).
fn uniform() -> impl Iterator<Item = f64> {
    let mut state = 88_172_645_463_325_252_u64;
    std::iter::repeat_with(move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / 9_007_199_254_740_992.0
    })
}

/// A column as a file.
fn write(
    values: &[f64],
    (_, encoding, dictionary, compression): Way,
) -> Result<Vec<u8>, Box<dyn Error>> {
    let properties = WriterProperties::builder()
        .set_statistics_enabled(EnabledStatistics::None)
        .set_offset_index_disabled(true)
        .set_encoding(encoding)
        .set_compression(compression)
        .set_write_batch_size(256)
        .set_dictionary_enabled(dictionary.is_some())
        .set_dictionary_page_size_limit(dictionary.unwrap_or(0));
    let column =
        Type::primitive_type_builder("c", Physical::DOUBLE).with_repetition(Repetition::OPTIONAL);
    let root =
        Type::group_type_builder("root").with_fields(vec![Arc::new(column.build()?)]).build()?;
    let mut writer =
        SerializedFileWriter::new(Vec::new(), Arc::new(root), Arc::new(properties.build()))?;
    for part in values.chunks(GROUP) {
        let mut group = writer.next_row_group()?;
        let mut column = group.next_column()?.ok_or("a column too few")?;
        column.typed::<DoubleType>().write_batch(part, Some(&vec![1; part.len()]), None)?;
        column.close()?;
        group.close()?;
    }
    Ok(writer.into_inner()?)
}

/// Reads the column of a file; how many values it has.
fn read(path: &std::path::Path) -> Result<usize, Box<dyn Error>> {
    let file = SerializedFileReader::new(File::open(path)?)?;
    let (mut values, mut levels, mut count) = (Vec::new(), Vec::new(), 0);
    for index in 0..file.num_row_groups() {
        let group = file.get_row_group(index)?;
        let descriptor = group.metadata().column(0).column_descr_ptr();
        let mut column =
            ColumnReaderImpl::<DoubleType>::new(descriptor, group.get_column_page_reader(0)?);
        values.clear();
        levels.clear();
        count += column.read_records(GROUP, Some(&mut levels), None, &mut values)?.0;
    }
    Ok(count)
}

/// The shortest of five times that something takes, in ms.
#[expect(clippy::disallowed_types, reason = "it measures; nothing that is written depends on it")]
fn best_ms(mut what: impl FnMut() -> Result<(), Box<dyn Error>>) -> Result<f64, Box<dyn Error>> {
    let mut best = f64::INFINITY;
    for _ in 0..5 {
        let start = std::time::Instant::now();
        what()?;
        best = best.min(start.elapsed().as_secs_f64() * 1e3);
    }
    Ok(best)
}

#[expect(clippy::print_stdout, reason = "says what it measured")]
fn main() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("column.parquet");
    for (name, column) in columns() {
        let values: Vec<f64> =
            uniform().take(ROWS).enumerate().map(|(row, x)| column(x, row)).collect();
        for way in WAYS {
            let bytes = write(&values, way)?;
            fs::write(&path, &bytes)?;
            let write_ms = best_ms(|| write(&values, way).map(drop))?;
            let read_ms = best_ms(|| read(&path).map(drop))?;
            let size = bytes.len() as f64 / ROWS as f64;
            println!(
                "{name:18} {:26} {size:.2} B/value, written in {write_ms:.1} ms, read in {read_ms:.1} ms",
                way.0
            );
        }
    }
    Ok(())
}
