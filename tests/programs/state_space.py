"""The matrices of analyze --state-space against its --response, without numpy.

Usage: state_space.py ANALYZE OCTAVE

Checks the sizes of A, B, C, D by their names, and the response C (i w - A)^-1 B + D at every
frequency. With a second argument that is not empty, Octave computes the same.
"""

import cmath
import csv
import json
import pathlib
import subprocess
import sys
import tempfile

SCENE = """
[solve]
t_end = 1
[[body]]
name = "arm"
joint = { kind = "revolute", axis = [0, 1, 0] }
mass = 2
centre = [0.1, 0, -0.3]
inertia = [0.3, 0.3, 0.2]
damping = 0.1
[[body]]
name = "fore arm"
parent = "arm"
joint = { kind = "revolute", axis = [0, 1, 0], position = [0, 0, -0.6] }
mass = 1
centre = [0, 0, -0.2]
inertia = [0.1, 0.1, 0.1]
spring = { stiffness = 3 }
[[sensor]]
name = "pickoff"
kind = "joint"
joint = "arm"
[[controller]]
name = "servo"
reads = ["pickoff.angle"]
drives = ["arm"]
law = { kind = "pid", proportional = 40, derivative = 3, filter = 0.02 }
[gravity]
kind = "uniform"
vector = [0, 0, -9.81]
"""
INPUT = "joint.fore arm"
OUTPUT = "arm.angle"
OCTAVE = """
s = jsondecode(fileread('%s'));
i = find(strcmp({s.inputs.name}, '%s'));
o = find(strcmp({s.outputs.name}, '%s'));
rows = dlmread('%s', ',', 1, 0);
for k = 1:size(rows, 1)
  w = rows(k, 1);
  H = s.C(o, :) * ((1i * w * eye(size(s.A)) - s.A) \\ s.B(:, i)) + s.D(o, i);
  if (abs(H - rows(k, 2) * exp(1i * rows(k, 3))) > 1e-12 * abs(H) + 1e-15) exit(1); end
end
"""


def solve(matrix, right):
    """Gauss's elimination with the greatest pivot of a column."""
    rows = [list(row) + [value] for row, value in zip(matrix, right)]
    n = len(rows)
    for k in range(n):
        pivot = max(range(k, n), key=lambda i: abs(rows[i][k]))
        rows[k], rows[pivot] = rows[pivot], rows[k]
        for i in range(k + 1, n):
            factor = rows[i][k] / rows[k][k]
            rows[i] = [a - factor * b for a, b in zip(rows[i], rows[k])]
    x = [0] * n
    for k in reversed(range(n)):
        x[k] = (rows[k][n] - sum(rows[k][j] * x[j] for j in range(k + 1, n))) / rows[k][k]
    return x


def check_sizes(plant):
    n, m, p = (len(plant[key]) for key in ("states", "inputs", "outputs"))
    assert plant["dt"] == 0 and n == 5 and m > 0 and p > 0, (n, m, p)
    for key, height, width in (("A", n, n), ("B", n, m), ("C", p, n), ("D", p, m)):
        assert len(plant[key]) == height, key
        assert all(len(row) == width for row in plant[key]), key
    for one in plant["inputs"] + plant["outputs"]:
        assert one["name"] and "unit" in one, one


def check_response(plant, table):
    i = [one["name"] for one in plant["inputs"]].index(INPUT)
    o = [one["name"] for one in plant["outputs"]].index(OUTPUT)
    for row in table:
        s = 1j * float(row["frequency"])
        open_loop = [[(s if a == b else 0) - x for b, x in enumerate(line)]
                     for a, line in enumerate(plant["A"])]
        eta = solve(open_loop, [line[i] for line in plant["B"]])
        found = sum(c * x for c, x in zip(plant["C"][o], eta)) + plant["D"][o][i]
        wanted = cmath.rect(float(row["amplitude"]), float(row["phase"]))
        assert abs(found - wanted) < 1e-12 * abs(wanted) + 1e-15, (s, found, wanted)


def main():
    analyze, octave = sys.argv[1:]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        scene, table, matrices = folder / "s.toml", folder / "r.csv", folder / "p.json"
        scene.write_text(SCENE)
        subprocess.run([analyze, scene, "--response", INPUT, "--to", OUTPUT, "--frequencies",
                        "0.1:100:40", "--csv", table, "--state-space", matrices],
                       check=True, stdout=subprocess.DEVNULL)
        plant = json.loads(matrices.read_text())
        check_sizes(plant)
        with table.open() as rows:
            check_response(plant, list(csv.DictReader(rows)))
        if octave:
            script = folder / "check.m"
            script.write_text(OCTAVE % (matrices, INPUT, OUTPUT, table))
            subprocess.run([octave, "--norc", script], check=True)


main()
