//! Writes tables of results with every kind of column and every corner case into a folder, for
//! `checks/parquet/read_back.py` to read:
//!
//! ```sh
//! cargo run -p fspid-campaign --example table -- out/tables
//! ```

use std::error::Error;
use std::fs::{self, File};
use std::path::Path;
use std::sync::Arc;

use fspid_campaign::table::{
    Cell, Column, ColumnTable, Digest, Kind, MAX_TEXT_BYTES, ROWS_PER_GROUP, Reader, Schema, Writer,
};

/// Columns of every kind: all different, few different, one for all, none at all.
fn schema() -> Result<Arc<Schema>, Box<dyn Error>> {
    let columns = vec![
        Column::new("run", Kind::Integer).meaning("Index of the run."),
        Column::new("seed", Kind::Integer).meaning("Whole numbers over the whole range."),
        Column::new("overshoot_pct", Kind::Float)
            .unit("%")
            .meaning("Numbers that are all different."),
        Column::new("rise_time_s", Kind::Float)
            .unit("s")
            .meaning("Multiples of 20 ms; \"quotes\", ü."),
        Column::new("corner", Kind::Float)
            .unit("rad/s")
            .meaning("NaN, infinities, zeros, tiny and huge."),
        Column::new("mass_kg", Kind::Float).unit("kg").meaning("The same number everywhere."),
        Column::new("nothing_m", Kind::Float).unit("m").meaning("Never there."),
        Column::new("verdict", Kind::Text).meaning("Few different texts."),
        Column::new("reason", Kind::Text).meaning("Texts that are all different, empty and long."),
        Column::new("no text", Kind::Text).meaning("Never there."),
        Column::new("settled", Kind::Boolean),
        Column::new("läuft.weiter", Kind::Boolean).meaning("A name with a dot; never there."),
    ];
    Ok(Arc::new(Schema::new(columns)?))
}

/// Numbers at which something could go wrong.
const CORNERS: [f64; 12] = [
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    0.0,
    -0.0,
    5e-324,
    -5e-324,
    f64::MAX,
    f64::MIN,
    f64::EPSILON,
    0.1,
    f64::from_bits(0xfff8_dead_beef_0001),
];

/// A number that looks random and is the same everywhere: the finaliser of SplitMix64 (Steele, Lea and
/// Flood 2014).
const fn mixed(row: usize) -> u64 {
    let z = (row as u64).wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// The table of so many rows.
fn table(rows: usize) -> Result<ColumnTable, Box<dyn Error>> {
    let mut table = ColumnTable::new(schema()?);
    for row in 0..rows {
        let random = mixed(row);
        // Of 53 bits, so that the division by 2⁵³ is exact.
        let unit = (random >> 11) as f64 / 9_007_199_254_740_992.0;
        let reason = match row % 9 {
            0 => String::new(),
            1 if row == 1 => "ü€😀\u{0}".repeat(MAX_TEXT_BYTES / 10),
            _ => format!("run {row}: {random:x} \"ä\"\n"),
        };
        table.push(&[
            (row as i64).into(),
            (row % 11 > 0).then_some(random.cast_signed()).into(),
            (100.0 * unit).into(),
            (row % 4 > 0).then_some((random % 1500) as f64 * 0.02).into(),
            (row % 13 < 12).then(|| CORNERS.get(row % 13).copied()).flatten().into(),
            63_731.5.into(),
            Cell::Absent,
            ["met", "not met", "not flown"].get(row % 5).copied().into(),
            reason.as_str().into(),
            Cell::Absent,
            (row % 3 > 0).then_some(random.is_multiple_of(2)).into(),
            Cell::Absent,
        ])?;
    }
    Ok(table)
}

/// Writes a table and reads it again.
fn write(path: &Path, table: &ColumnTable) -> Result<Digest, Box<dyn Error>> {
    let metadata = [("campaign".to_owned(), "an example, ü".to_owned())];
    let mut writer = Writer::new(File::create(path)?, table.schema(), &metadata)?;
    writer.write(table)?;
    let (_, digest) = writer.finish(&[("rows".to_owned(), table.rows().to_string())])?;
    Reader::open(path)?.verify()?;
    Ok(digest)
}

#[expect(clippy::print_stdout, reason = "says what it wrote")]
fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "out/tables".to_owned());
    fs::create_dir_all(&folder)?;
    for rows in [0, 1, 1000, ROWS_PER_GROUP, 2 * ROWS_PER_GROUP + 1] {
        let path = Path::new(&folder).join(format!("rows-{rows}.parquet"));
        println!("{} {}", write(&path, &table(rows)?)?, path.display());
    }
    Ok(())
}
