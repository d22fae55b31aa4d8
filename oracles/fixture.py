"""Writes fixtures: one header line, shortest round-trip digits, Unix line ends."""
from pathlib import Path

CRATES = Path(__file__).resolve().parent.parent / "crates"


def text(value):
    """Shortest text that reads back to the same double; words and whole numbers stay as they are."""
    return value if isinstance(value, str) else repr(value if isinstance(value, int) else float(value))


def write(crate, name, header, rows):
    """Writes `crates/<crate>/tests/data/<name>` and says so."""
    path = CRATES / crate / "tests" / "data" / name
    path.parent.mkdir(parents=True, exist_ok=True)
    lines = [header] + [",".join(text(value) for value in row) for row in rows]
    path.write_text("\n".join(lines) + "\n", newline="\n")
    print(f"{crate}/{name}: {len(rows)} rows, {path.stat().st_size} bytes")
