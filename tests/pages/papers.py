#!/usr/bin/env python3
"""The page that lists the papers' equations: papers.py PROGRAMS [PAGE]

Every header and test of a row exists, with the names in it. Every command ends without an error, and
every linked page has a program. Each equation of both papers has a row. PROGRAMS is the folder of the
programs, PAGE another page than docs/site/papers.md.
"""

import pathlib
import re
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
EQUATIONS = {"Paper 002": 50, "Paper 000": 27}
HEADING = ["paper", "equation or claim", "code, and below it the test", "to see it"]
ABSENT = "not in the library"
PLACE = re.compile(r"([\w/.]+\.[hc]pp)(?:: (`\w+`(?:, `\w+`)*))?")
CASE = r"BOOST_(?:AUTO|FIXTURE|DATA)_TEST_CASE(?:_TEMPLATE)?\(\s*{}\b"
FOUND = []  # what is wrong


def rows(page):
    """(line's number, paper, cells) of each row of the tables."""
    paper = None
    for number, line in enumerate(page.read_text().splitlines(), 1):
        if line.startswith("## "):
            paper = line[3:]
        if not line.startswith("|") or line.startswith("|---"):
            continue
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) != len(HEADING):
            FOUND.append(f"{page.name}:{number}: {len(cells)} cells, not {len(HEADING)}")
        elif cells != HEADING:
            yield number, paper, cells


def places(text):
    """(path, names) of each file that a text names, (None, part) of anything else."""
    for part in text.split("; "):
        match = PLACE.fullmatch(part)
        yield (match[1], re.findall(r"\w+", match[2] or "")) if match else (None, part)


def faults_of_places(text, without, folders, defined):
    """The faults of half a cell, which names places, or begins with the words that it names none."""
    if text.startswith(without):
        return
    for path, names in places(text):
        if path is None:
            yield f"'{names}' is neither a file with names nor begins with '{without}'"
        elif not path.startswith(folders) or not (ROOT / path).is_file():
            yield f"{path} is no file in {' or '.join(folders)}"
        else:
            source = (ROOT / path).read_text()
            yield from (f"{path} has no {name}" for name in names if not defined(name, source))


def in_code(name, source):
    return re.search(rf"\b{name}\b", re.sub(r"//.*", "", source))


def is_case(name, source):
    return re.search(CASE.format(name), source)


def equations(label):
    """The equations of a row's first cell: (35), (3a-c) or (30), (31)."""
    return [int(number) for number in re.findall(r"\((\d+)", label)]


def faults_of_link(link):
    target = re.fullmatch(r"\[[^]]+\]\((\w+\.md)\)", link)
    page = ROOT / "docs/site" / target[1] if target else None
    if not page or not page.is_file() or "```cpp" not in page.read_text():
        yield f"'{link}' is neither a command nor a page with a program"


def faults_of_command(command, programs):
    program, *arguments = command.split()
    try:
        run = subprocess.run([programs / program, *arguments], cwd=ROOT / "examples/scenes",
                             capture_output=True, text=True)
    except OSError as error:
        yield f"`{command}`: {error.strerror}"
        return
    if run.returncode != 0:
        yield f"`{command}` exits with {run.returncode}: {run.stderr.strip()}"


def check(page, programs):
    covered = {paper: set() for paper in EQUATIONS}
    commands = {}
    count = 0
    for number, paper, (label, _, proof, shown) in rows(page):
        count += 1
        covered[paper].update(equations(label))
        code, _, test = proof.partition("<br>")
        faults = [*faults_of_places(code, ABSENT, ("motor/", "dynamics/"), in_code)]
        if test or not code.startswith(ABSENT):
            faults.extend(faults_of_places(test, "no test", ("tests/",), is_case))
        command = re.fullmatch(r"`([^`]+)`", shown)
        if command:
            commands.setdefault(command[1], number)
        elif shown != "-":
            faults.extend(faults_of_link(shown))
        FOUND.extend(f"{page.name}:{number}: {fault}" for fault in faults)
    for paper, last in EQUATIONS.items():
        missing = sorted(set(range(1, last + 1)) - covered[paper])
        if missing:
            FOUND.append(f"{page.name}: no row for {missing} of {paper}")
    begin = time.monotonic()
    for command, number in commands.items():
        FOUND.extend(f"{page.name}:{number}: {fault}" for fault in faults_of_command(command, programs))
    print(f"{count} rows, {len(commands)} commands in {time.monotonic() - begin:.1f} s")


def main(programs, page=ROOT / "docs/site/papers.md"):
    check(pathlib.Path(page), pathlib.Path(programs).resolve())
    print("\n".join(FOUND))
    return 1 if FOUND else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
