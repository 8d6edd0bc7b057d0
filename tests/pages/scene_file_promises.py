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
import pathlib
import re
import subprocess
import sys
import tempfile
import time

from promises.table import NEAR, ROWS, TOLERANCE, Ends, Near

HERE = pathlib.Path(__file__).resolve().parent
WORKERS = 2  # as many as PROCESSORS in CMakeLists.txt
ROOT = HERE.parent.parent


def plain(text):
    """The text with single blanks."""
    return " ".join(text.split())


def sentences(page):
    """The sentences of the page, and the rows of its tables."""
    code = r"^```.*?^```$|^    .*?$|^#.*?$|^\|[^\n]*\n\|[-|]*$"  # and headings, heads of tables
    text = re.sub(code, "", page, flags=re.S | re.M)
    for block in re.split(r"\n\s*\n|\n(?=[-|] ?)", text):
        block = re.sub(r"^(- )?(\*\*[\w, ]+\*\*:)?", "", plain(block)).strip()
        rows = block.startswith("|") or not block
        yield from filter(None, [block] if rows else re.split(r"(?<=\.) (?=[A-Z`])", block))


def unproven(page, quotes):
    """The sentences of which no quote is a part, and which are no part of a quote."""
    quotes = [plain(quote) for quote in quotes]
    for sentence in sentences(page):
        if not any(quote in sentence or sentence in quote for quote in quotes):
            yield sentence


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


def faults_of_page(text, quotes, elsewhere, remarks):
    """Quotes that the page lacks, sentences without a quote, and tests that do not exist."""
    quotes = {*quotes, *(quote for quote, _ in elsewhere), *remarks}
    for quote in sorted(quote for quote in quotes if plain(quote) not in plain(text)):
        yield f"the page does not say '{quote}'"
    for sentence in unproven(text, quotes):
        yield f"no test for '{sentence}'"
    for quote, place in elsewhere:
        path, name = place.split(": ")
        source = (ROOT / path).read_text()
        if not re.search(rf"(TEST_CASE(_TEMPLATE)?\(\s*|def ){name}\b", source):
            yield f"'{quote}': {path} has no {name}"


def main(programs, page=ROOT / "docs/scene_files.md"):
    begin = time.monotonic()
    for table in sorted((HERE / "promises").glob("*.py")):
        module = importlib.import_module(f"promises.{table.stem}")
        if table.stem == "elsewhere":
            elsewhere, remarks = module.ELSEWHERE, module.REMARKS
    quotes = {row[0] for row in ROWS}
    found = [*faults_of_page(pathlib.Path(page).read_text(), quotes, elsewhere, remarks)]
    programs = pathlib.Path(programs).resolve()
    with concurrent.futures.ThreadPoolExecutor(WORKERS) as pool:
        results = [*pool.map(lambda row: checked(programs, row), ROWS)]
    for row, (faults_of_row, scene) in zip(ROWS, results):
        found.extend(f"'{row[0]}'\n  {fault}\n{scene}" for fault in faults_of_row)
    print(f"{len(ROWS)} runs for {len(quotes)} quotes in {time.monotonic() - begin:.1f} s,")
    print(f"{len(elsewhere)} quotes in other tests, faults: {len(found)}", *found, sep="\n")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
