//! Tables of results: columns with names and units, written as Parquet and read again.
