"""Python's values as the text of a scene file."""

import os
import re
from collections.abc import Iterable, Mapping
from numbers import Integral, Real

LISTS_OF_TABLES = ("body", "sensor", "element", "constraint", "controller")


def quoted(text):
    """The text as a basic string of TOML."""
    escaped = re.sub(r"[\x00-\x1f\x7f]", lambda c: f"\\u{ord(c[0]):04x}",
                     text.replace("\\", "\\\\").replace('"', '\\"'))
    return f'"{escaped}"'


def key_of(word):
    """A key of TOML, quoted if necessary."""
    return word if re.fullmatch("[A-Za-z0-9_-]+", word) else quoted(word)


def table(place, mapping):
    """An inline table of TOML."""
    entries = []
    for word, value in mapping.items():
        if not isinstance(word, str):
            raise TypeError(f"{place}: keys must be text, not {word!r}")
        at = f"{place}.{word}"
        if word == "inertia":
            value = _six_entries(at, value)
        entries.append(f"{key_of(word)} = {value_of(at, value)}")
    return "{" + ", ".join(entries) + "}"


def value_of(place, value):
    """A value of TOML; numbers keep all their digits.

    Raises TypeError naming the place, for a value that TOML does not have.
    """
    if hasattr(value, "tolist"):  # an array or a number of numpy
        value = value.tolist()
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, Integral):
        return str(int(value))
    if isinstance(value, Real):
        return repr(float(value))
    if isinstance(value, str):
        return quoted(value)
    if isinstance(value, Mapping):
        return table(place, value)
    if isinstance(value, Iterable) and not isinstance(value, (bytes, bytearray, set)):
        return "[" + ", ".join(value_of(f"{place}[{i}]", one) for i, one in enumerate(value)) + "]"
    raise TypeError(f"{place}: a scene has no value of type {type(value).__name__}")


def scene(keywords):
    """The text of a scene, with a line for each keyword and for each table of a list."""
    lines = []
    for key, value in keywords.items():
        if not isinstance(key, str):
            raise TypeError(f"keys of a scene must be text, not {key!r}")
        if key in LISTS_OF_TABLES and not isinstance(value, (str, Mapping)):
            tables = [value_of(f"{key}[{i}]", one) for i, one in enumerate(value)]
            text = "[\n" + "".join(one + ",\n" for one in tables) + "]"
        else:
            text = value_of(key, value)
        lines.append(f"{key_of(key)} = {text}\n")
    return "".join(lines)


def _six_entries(place, inertia):
    """A symmetric 3x3 matrix as xx, yy, zz, xy, xz, yz; anything else unchanged."""
    if hasattr(inertia, "tolist"):
        inertia = inertia.tolist()
    if isinstance(inertia, str) or not isinstance(inertia, Iterable):
        return inertia
    rows = [list(row) if isinstance(row, Iterable) and not isinstance(row, str) else row
            for row in inertia]
    if len(rows) != 3 or any(not isinstance(row, list) or len(row) != 3 for row in rows):
        return rows
    pairs = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
    if any(rows[i][k] != rows[k][i] for i, k in pairs):
        raise ValueError(f"{place}: a matrix of inertia must be symmetric")
    return [rows[i][k] for i, k in pairs]
