"""Prints where the numbers of cross.digits differ between machines, in units of the last place.

Usage: python3 tests/cross/compare.py MACHINE...    of build/MACHINE, as script/cross makes them
"""

import math
import pathlib
import subprocess
import sys

BUILD = pathlib.Path(__file__).resolve().parent.parent.parent / "build"


def digits(machine):
    run = subprocess.run(["ctest", "--preset", machine, "--verbose", "--tests-regex", r"^cross\.digits$"],
                         cwd=BUILD.parent, capture_output=True, text=True, check=True)
    lines = [line.partition(": ")[2] for line in run.stdout.splitlines() if line[:1].isdigit()]
    rows = [line.rsplit(None, 1) for line in lines if line[28:29] == " "]
    return {name.strip(): float(value) for name, value in rows}


machines = sys.argv[1:]
numbers = {machine: digits(machine) for machine in machines}
first = numbers[machines[0]]
print("units in the last place, from", machines[0])
print(f"{'':28}", *(f"{machine:>8}" for machine in machines[1:]), f"  {machines[0]}")
for name, value in first.items():
    apart = [(numbers[machine].get(name, math.nan) - value) / math.ulp(value) for machine in machines[1:]]
    print(f"{name:28}", *(f"{off:8.0f}" for off in apart), f"  {value!r}")
