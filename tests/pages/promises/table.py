"""Rows of the tables, and the parts that their scenes are made of."""

import math

ROWS = []  # (quote, scene, wanted, program, files)
TOLERANCE = 1e-12  # of the runs: what they compute is compared to ten times as much
NEAR = 10 * TOLERANCE

FIXED = 'joint = { kind = "fixed" }'
HINGE = 'joint = { kind = "revolute", axis = [0, 1, 0] }'
DISC = 'joint = { kind = "revolute", axis = [0, 0, 1] }'
SLIDE = 'joint = { kind = "prismatic", axis = [0, 0, 1] }'
UNIVERSAL = 'joint = { kind = "universal", axis = [0, 0, 1], second_axis = [1, 0, 0] }'
BALL = 'joint = { kind = "spherical" }'
FREE = 'joint = { kind = "free" }'
WEIGHT = '[gravity]\nkind = "uniform"\nvector = [0, 0, -10]\n'
DEGREE = math.pi / 180


class Near:
    """A number or a list of numbers, with its own tolerance."""

    def __init__(self, value, tolerance):
        self.value, self.tolerance = value, tolerance


class Ends:
    """A run that ends with this exit status, and with this text on standard error."""

    def __init__(self, status, text):
        self.status, self.text = status, text


def promise(quote, scene, wanted, program="simulate", files=None):
    """A row. wanted is one of

    - a text: the scene is refused, and the text is in the message
    - a table: the numbers of columns, or of all columns that begin with a name, in the last row.
      Its tables "start" and "rows" are on the first row and on all rows, the latter as lists or
      functions of the time; "json" is on places of the JSON object, as "final.t"
    - a function of (JSON object, rows) that returns the faults, or nothing
    - None: the scene is accepted
    """
    ROWS.append((quote, scene, wanted, program, files or {}))


def part(head, *lines):
    return f"{head}\n" + "\n".join(lines) + "\n"


def guide(kind, *lines):
    return part("[guide]", f'kind = "{kind}"', *lines)


def body(joint=FIXED, *lines, name="a"):
    keys = "\n".join(lines)
    matter = [] if "mass =" in keys else ["mass = 1"]
    matter += [] if "inertia =" in keys else ["inertia = [1, 1, 1]"]
    return part("[[body]]", f'name = "{name}"', joint, *matter, *lines)


def sensor(kind, *lines, name="s", on="a"):
    where = [f'{"joint" if kind in ("joint", "reaction") else "body"} = "{on}"'] if on else []
    return part("[[sensor]]", f'name = "{name}"', f'kind = "{kind}"', *where, *lines)


def named(table, name, kind, *lines):
    """An element or a constraint."""
    return part(f"[[{table}]]", f'name = "{name}"', f'kind = "{kind}"', *lines)


def solve(t_end=1, *lines):
    tolerance = [] if any("tolerance" in line for line in lines) else [f"tolerance = {TOLERANCE}"]
    return part("[solve]", f"t_end = {t_end}", *tolerance, *lines)


def report(*names):
    return part("[report]", *(f"{name} = true" for name in names))


def log(header, rows):
    return "\n".join([header, *(",".join(f"{x!r}" for x in row) for row in rows)]) + "\n"


def quaternion(axis, angle):
    """That of a rotation about the axis "x", "y" or "z", as a list for a scene."""
    return [math.cos(angle / 2), *(math.sin(angle / 2) * (axis == name) for name in "xyz")]


def cross(a, b):
    return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]


def turned(axis, angle, vector):
    """The vector after the rotation."""
    e = [float(axis == name) for name in "xyz"]
    s, c = math.sin(angle), math.cos(angle)
    along = sum(x * y for x, y in zip(e, vector))
    side = cross(e, vector)
    return [c * v + s * w + (1 - c) * along * x for v, w, x in zip(vector, side, e)]
