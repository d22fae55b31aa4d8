"""Dictionaries as TOML and as changes of a scenario."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from .errors import InputError

_PLAIN = frozenset("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-")
_ESCAPES = {'"': '\\"', "\\": "\\\\", "\n": "\\n", "\r": "\\r", "\t": "\\t"}


def _text(value: str) -> str:
    control = {chr(code): f"\\u{code:04x}" for code in (*range(32), 127)}
    return '"' + "".join({**control, **_ESCAPES}.get(sign, sign) for sign in value) + '"'


def _key(key: object) -> str:
    if not isinstance(key, str):
        raise InputError(f"{key!r} is no name of a setting; names are texts")
    return key if key and set(key) <= _PLAIN else _text(key)


def value_of(value: object) -> str:
    """A value as TOML writes it, in one line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _text(value)
    # Their own words: those of a float of NumPy, or of a member of an enum, are no TOML.
    if isinstance(value, int):
        return int.__repr__(value)
    if isinstance(value, float):
        return float.__repr__(value)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_key(key)} = {value_of(each)}" for key, each in value.items()) + " }"
    # Numbers and arrays of NumPy say what they are in Python.
    plain = getattr(value, "tolist", None)
    if plain is not None:
        return value_of(plain())
    if isinstance(value, Sequence) and not isinstance(value, bytes):
        return "[" + ", ".join(value_of(each) for each in value) + "]"
    raise InputError(f"{value!r} is no value of a setting; allowed are numbers, texts, lists and dictionaries")


def text_of(table: Mapping[str, Any]) -> str:
    """A dictionary as TOML, a key a line: a table within it is written in that line."""
    if not isinstance(table, Mapping):
        raise InputError(f"a scenario is a dictionary, and not {type(table).__name__}")
    return "".join(f"{_key(key)} = {value_of(value)}\n" for key, value in table.items())


def changes(table: Mapping[str, Any]) -> list[str]:
    """A dictionary as changes ``path=value``; dictionaries in it are parts of paths."""
    return list(_changes("", table))


def _changes(before: str, table: Mapping[str, Any]) -> Iterator[str]:
    for key, value in table.items():
        # A path that is written as one, such as "controller.PID.kp", stays as it is.
        path = f"{before}.{_key(key)}" if before else str(key)
        if isinstance(value, Mapping):
            yield from _changes(path, value)
        else:
            yield f"{path}={value_of(value)}"
