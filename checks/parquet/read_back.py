#!/usr/bin/env python3
"""Reads tables of results with pandas, Polars and DuckDB and compares what they say.

    python read_back.py FILE [FILE ...]

For each file, the three readers must agree with each other, and with the digest that the file carries, on the number
of rows, the names and types of the columns, and every cell. The digest is computed anew from the cells that each
reader gives, by the rules in the documentation of `fspid_campaign::table::Digest`; nothing is shared with the Rust
code. Prints a line a reader; exit code 1 if anything differs.
"""

import hashlib
import json
import math
import struct
import sys

import duckdb
import pandas
import polars
import pyarrow
import pyarrow.parquet

KINDS = {"float": 1, "integer": 2, "text": 3, "boolean": 4}
# What each reader must call a column of a kind.
TYPES = {
    "pandas": {"float": "double[pyarrow]", "integer": "int64[pyarrow]", "text": "string[pyarrow]", "boolean": "bool[pyarrow]"},
    "polars": {"float": "Float64", "integer": "Int64", "text": "String", "boolean": "Boolean"},
    "duckdb": {"float": "DOUBLE", "integer": "BIGINT", "text": "VARCHAR", "boolean": "BOOLEAN"},
}
NAN = struct.pack("<Q", 0x7FF8000000000000)


def text(value):
    """A text as it is digested: its length in bytes, then its UTF-8."""
    encoded = value.encode()
    return struct.pack("<Q", len(encoded)) + encoded


def cell(kind, value):
    """A cell as it is digested."""
    if value is None:
        return b"\0"
    if kind == "float":
        body = NAN if math.isnan(value) else struct.pack("<d", value)
    elif kind == "integer":
        body = struct.pack("<q", value)
    elif kind == "text":
        body = text(value)
    else:
        body = b"\1" if value else b"\0"
    return bytes([KINDS[kind]]) + body


def content_digest(columns, cells):
    """The digest of the columns and their cells, given column by column."""
    digest = hashlib.sha256(b"fspid table 1\n" + struct.pack("<Q", len(columns)))
    for column in columns:
        digest.update(text(column["name"]) + bytes([KINDS[column["kind"]]]))
        digest.update(text(column["unit"]) + text(column["meaning"]))
    for row in zip(*cells, strict=True):
        for column, value in zip(columns, row, strict=True):
            digest.update(cell(column["kind"], value))
    return digest.hexdigest()


def metadata_digest(pairs):
    """The digest of key-value metadata."""
    return hashlib.sha256(b"".join(text(key) + text(value) for key, value in pairs)).hexdigest()


def with_pandas(path):
    """Names, types and cells as pandas has them, column by column. Its Arrow types tell NaN from nothing."""
    frame = pandas.read_parquet(path, engine="pyarrow", dtype_backend="pyarrow")
    cells = [pyarrow.array(frame.iloc[:, i].array).to_pylist() for i in range(frame.shape[1])]
    return list(frame.columns), [str(kind) for kind in frame.dtypes], cells


def with_polars(path):
    """Names, types and cells as Polars has them."""
    frame = polars.read_parquet(path)
    return frame.columns, [str(kind) for kind in frame.dtypes], [series.to_list() for series in frame]


def with_duckdb(path):
    """Names, types and cells as DuckDB has them."""
    relation = duckdb.read_parquet(path)
    rows = relation.fetchall()
    columns = [list(column) for column in zip(*rows, strict=True)] or [[] for _ in relation.columns]
    return relation.columns, [str(kind) for kind in relation.types], columns


READERS = {"pandas": with_pandas, "polars": with_polars, "duckdb": with_duckdb}


def summary(kind, cells):
    """What can be said of a column in short: how many cells are absent, and a sum that does not depend on the reader."""
    present = [value for value in cells if value is not None]
    if kind == "text":
        total = hashlib.sha256(b"".join(text(value) for value in present)).hexdigest()[:16]
    elif kind == "float":
        total = repr(math.fsum(value for value in present if abs(value) < 1e300))
    else:
        total = repr(sum(present))
    return len(cells) - len(present), total


def queries(path, columns, cells):
    """Questions that engines answer from statistics if they can; yields what they answer wrongly.

    A statistic that leaves NaN out would make an engine that takes NaN for the largest number skip rows.
    """
    relation = duckdb.read_parquet(path)
    lazy = polars.scan_parquet(path)
    for column, values in zip(columns, cells, strict=True):
        name = column["name"]
        if column["kind"] not in ("float", "integer"):
            continue
        present = [value for value in values if value is not None]
        bounds = [1e300, 0.0, -1e300] if column["kind"] == "float" else [0, 16384, 10**18]
        for bound in bounds:
            # Both engines order NaN above all numbers.
            expected = sum(1 for value in present if value > bound or value != value)
            sql = '"' + name.replace('"', '""') + '"'
            found = {
                "duckdb": relation.filter(f"{sql} > {bound!r}").aggregate("count(*)").fetchall()[0][0],
                "polars": lazy.filter(polars.col(name) > bound).select(polars.len()).collect().item(),
            }
            for reader, count in found.items():
                if count != expected:
                    yield f"{reader}: {count} rows with {name} > {bound!r}, but {expected} have it"


def problems(path):
    """Everything that is wrong with a file; prints a line a reader."""
    file = pyarrow.parquet.ParquetFile(path)
    # From DuckDB, which keeps the order of the file; pyarrow gives the pairs in the order of a hash map.
    pairs = duckdb.execute("select key, value from parquet_kv_metadata(?)", [path]).fetchall()
    pairs = [(key.decode(), value.decode()) for key, value in pairs]
    stored = dict(pairs)
    if stored != {key.decode(): value.decode() for key, value in file.metadata.metadata.items()}:
        yield "pyarrow and DuckDB find other metadata"
    columns = json.loads(stored["fspid.columns"])["columns"]
    if pairs[-1] != ("fspid.metadata_digest", metadata_digest(pairs[:-1])):
        yield "the digest of the metadata is another"
    first = None
    for reader, read in READERS.items():
        names, types, cells = read(path)
        digest = content_digest(columns, cells)
        print(f"{path}: {reader:7} {len(cells[0]):6} rows, {len(cells)} columns, digest {digest}")
        if names != [column["name"] for column in columns]:
            yield f"{reader}: columns are called {names}"
        if types != [TYPES[reader][column["kind"]] for column in columns]:
            yield f"{reader}: columns have the types {types}"
        if len(cells[0]) != file.metadata.num_rows:
            yield f"{reader}: {len(cells[0])} rows, the file says {file.metadata.num_rows}"
        if digest != stored["fspid.digest"]:
            yield f"{reader}: the file says its digest is {stored['fspid.digest']}"
        summaries = [summary(column["kind"], values) for column, values in zip(columns, cells, strict=True)]
        first = first or summaries
        for column, mine, other in zip(columns, summaries, first, strict=True):
            if mine != other:
                yield f"{reader}: {column['name']} has (absent, sum) {mine}, the first reader found {other}"
    yield from queries(path, columns, cells)


def main(paths):
    if not paths:
        sys.exit(__doc__)
    found = [f"{path}: {problem}" for path in paths for problem in problems(path)]
    for problem in found:
        print(problem, file=sys.stderr)
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main(sys.argv[1:])
