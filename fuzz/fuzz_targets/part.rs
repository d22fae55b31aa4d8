//! Arbitrary bytes as the file of a campaign, a part or a merged one: refused, or read as a table, row group by row group and
//! column by column; what keeps the digest that it names has a summary too, or says why not.
//!
//! A panic of the Parquet library that the reader catches is no finding here: the reader answers it.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use fspid_campaign::summary::{Summary, SummarySettings, text};
use fspid_campaign::table::Reader;

pub(crate) fn read(bytes: &[u8]) -> Option<()> {
    let path = file();
    std::fs::write(path, bytes).expect("a file can be written");
    // The hook of the fuzzer ends the process where something panics, whether it is caught or not; what is not caught still
    // ends it, where the fuzzer catches it.
    std::panic::set_hook(Box::new(|_| {}));
    table(path)
}

fn table(path: &Path) -> Option<()> {
    let reader = Reader::open(path).ok()?;
    let mut rows = 0;
    for table in reader.tables() {
        rows += table.ok()?.rows();
    }
    assert_eq!(rows, reader.rows(), "as many rows as the footer says");
    for column in reader.schema().columns() {
        for values in reader.column(&column.name).expect("a column of the schema") {
            values.ok()?;
        }
    }
    reader.verify().ok()?;
    if let Ok(summary) = Summary::of(path, SummarySettings::default()) {
        assert!(!text(&summary).is_empty());
    }
    Some(())
}

/// One for each process: several fuzz side by side.
fn file() -> &'static Path {
    static FILE: OnceLock<PathBuf> = OnceLock::new();
    FILE.get_or_init(|| {
        std::env::temp_dir().join(format!("fspid-fuzz-{}.parquet", std::process::id()))
    })
}
