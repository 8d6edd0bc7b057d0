#!/usr/bin/env python3
"""The sentences of docs/scene_files.md: scene_file_promises.py PROGRAMS [PAGE]

Each row of promises/ quotes a sentence of the page, and runs a scene that shows it. The quotes are
in the page, and the programs do what they say. Every other sentence is in promises/elsewhere.py.
PROGRAMS is the folder of the programs, PAGE another page than docs/scene_files.md.
"""

import concurrent.futures
import csv
import importlib
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

from promises.table import NEAR, ROWS, TOLERANCE, Ends, Near

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent


def plain(text):
    """The text with single blanks."""
    return " ".join(text.split())


def sentences(page):
    """The sentences of the text, and the rows of its tables."""
    text = re.sub(r"```.*?```|^    .*?$|^#.*?$|^\|[-|]*\|$", "", page, flags=re.S | re.M)
    for block in re.split(r"\n\s*\n|\n(?=[-|] ?)", text):
        if block.startswith("|"):
            yield plain(block)
        else:
            yield from re.split(r"(?<=[.:])\s+(?=[A-Z`])", plain(block))


def at(table, place):
    """The value at a place as "final.joints.a.rate", whose last part may be a number of a list."""
    for key in place.split("."):
        table = table[int(key)] if isinstance(table, list) else table[key]
    return table


def flat(value):
    return [y for x in value for y in flat(x)] if isinstance(value, list) else [value]


def is_near(found, wanted):
    if isinstance(wanted, (str, bool)):
        return found == wanted
    if not isinstance(wanted, Near):
        wanted = Near(wanted, NEAR * max(1, *(abs(x) for x in [0, *flat(wanted)])))
    pairs = zip(flat(found), flat(wanted.value), strict=True)
    return all(abs(x - y) <= wanted.tolerance for x, y in pairs)


def text_of(wanted):
    return f"{wanted.value} within {wanted.tolerance:.1g}" if isinstance(wanted, Near) else wanted


def columns(row, word):
    """The numbers of the columns that a word of [output] selects."""
    names = [name for name in row if name == word or re.match(re.escape(word) + "[. ]", name)]
    if not names:
        raise LookupError(f"no column {word}")
    return [row[name] for name in names]


def faults_of_rows(rows, wanted):
    for column, value in wanted.items():
        found = [row[column] for row in rows]
        bare = value.value if isinstance(value, Near) else value
        expected = [bare(row["t"]) for row in rows] if callable(bare) else bare
        if not is_near(found, Near(expected, value.tolerance) if bare is not value else expected):
            worst = max(range(len(found)), key=lambda i: abs(found[i] - expected[i]))
            yield f"{column} is {found[worst]} in row {worst}, not {expected[worst]}"


def faults_of_values(value_of, wanted):
    for place, value in wanted.items():
        found = value_of(place)
        if not is_near(found, value):
            yield f"{place} is {found}, not {text_of(value)}"


def faults_of_run(found, rows, wanted):
    wanted = {"json": {}, "start": {}, "rows": {}, **wanted}
    yield from faults_of_values(lambda place: at(found, place), wanted.pop("json"))
    yield from faults_of_values(lambda word: columns(rows[0], word), wanted.pop("start"))
    yield from faults_of_rows(rows, wanted.pop("rows"))
    yield from faults_of_values(lambda word: columns(rows[-1], word), wanted)


def faults(programs, scene, wanted, program, files):
    """The differences between what a row wants and what the program does."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for path, text in {**files, "s.toml": scene}.items():
            (folder / path).write_text(text)
        command = [programs / program, "s.toml", "--json"]
        command += ["--csv", "rows.csv"] if program == "simulate" else []
        run = subprocess.run(
            command, cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, text=True
        )
        end = Ends(2, wanted) if isinstance(wanted, str) else wanted
        if not isinstance(end, Ends):
            end = Ends(0, "")
        if run.returncode != end.status or end.text not in run.stderr:
            return [f"ends with {run.returncode}, not {end.status} and '{end.text}': {run.stderr}"]
        if end.status or wanted is None:
            return []
        found = json.loads(run.stdout)
        rows = []
        if program == "simulate":
            with open(folder / "rows.csv", newline="") as file:
                rows = [{k: float(v) for k, v in row.items()} for row in csv.DictReader(file)]
        if callable(wanted):
            return [*(wanted(found, rows) or [])]
        return [*faults_of_run(found, rows, wanted)]


def checked(programs, row):
    quote, scene, wanted, program, files = row
    scene += "" if "[solve]" in scene else f"[solve]\nt_end = 1\ntolerance = {TOLERANCE}\n"
    try:
        return faults(programs, scene, wanted, program, files), scene
    except (LookupError, TypeError, ValueError) as error:
        return [f"{type(error).__name__}: {error}"], scene


def main(programs, page=ROOT / "docs/scene_files.md"):
    text = pathlib.Path(page).read_text()
    for table in sorted((HERE / "promises").glob("*.py")):
        importlib.import_module(f"promises.{table.stem}")
    if programs == "--left":
        quotes = [plain(row[0]) for row in ROWS]
        print(*(s for s in sentences(text) if not any(q in s for q in quotes)), sep="\n")
        return 0
    begin = time.monotonic()
    programs = pathlib.Path(programs).resolve()
    lost = sorted({row[0] for row in ROWS if plain(row[0]) not in plain(text)})
    for quote in lost:
        print(f"{page} does not say '{quote}'")
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = [*pool.map(lambda row: checked(programs, row), ROWS)]
    count = 0
    for row, (found, scene) in zip(ROWS, results):
        for fault in found:
            count += 1
            print(f"'{row[0]}'\n  {fault}\n{scene}")
    print(f"{len(ROWS)} runs for {len({row[0] for row in ROWS})} quotes", end=" ")
    print(f"in {time.monotonic() - begin:.1f} s, {count} faults")
    return 1 if lost or count else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
