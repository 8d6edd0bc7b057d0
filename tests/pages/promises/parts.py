"""Sentences on elements and constraints."""

import math

from promises.table import (
    BALL, DISC, FREE, HINGE, NEAR, WEIGHT, Ends, Near, body, guide, named, promise, quaternion,
    report, sensor, solve
)

SLED = body('joint = { kind = "prismatic", axis = [1, 0, 0] }', "%s")
FORCE = sensor("point")  # of 1 kg


def element(kind, *lines, name="e"):
    return named("element", name, kind, *lines)


def constraint(kind, *lines, name="e"):
    return named("constraint", name, kind, *lines)


SOON = solve(1e-6, "output_step = 1e-6")
TO_A = 'between = ["guide", "a"]'

# A sled at 3 m that moves at 2 m/s, and the other end of the spring 4 m beside its track.
MOVING = SLED % "initial = { displacement = 3, rate = 2 }" + FORCE
ASIDE = "at = [[0, 4, 0], [0, 0, 0]]"
LONG, RATE = 5, 2 * 0.6
promise("pull k (L - length) + d L' along the straight line between the points",
        MOVING + element("spring", TO_A, ASIDE, "stiffness = 7", "length = 2", "damping = 0.5"),
        {"start": {"s.acceleration x": -0.6 * (7 * (LONG - 2) + 0.5 * RATE)}})
promise("pull k (L - length) + d (L' - length') along the straight line between the points, if L > "
        "length and it is above 0",
        MOVING + element("rope", TO_A, ASIDE, "stiffness = 7",
                         "length = { constant = 2, rate = 3 }", "damping = 0.5"),
        {"start": {"s.acceleration x": -0.6 * (7 * (LONG - 2) + 0.5 * (RATE - 3))}})
for keys in ("length = 6", "length = { constant = 4.999, rate = 900 }"):  # slack, and would push
    promise("pull k (L - length) + d (L' - length') along the straight line between the points, "
            "if L > length and it is above 0",
            MOVING + element("rope", TO_A, ASIDE, "stiffness = 7", keys,
                             "damping = 0.5") + SOON, {"start": {"s.acceleration x": 0}})
WHEELS = body(DISC, "inertia = [1, 1, 2]", "initial = { angle = 3, rate = 4 }") + body(
    DISC, "inertia = [3, 3, 5]", "initial = { angle = 6, rate = 7 }", name="b")


def gear_accelerates(found, rows, ratio=0.5):
    """The rates a hundredth of a second later: of second order in the time."""
    force = -3 * (3 - ratio * 6) - 2 * (4 - ratio * 7)
    t = rows[1]["t"]
    for column, wanted in (("a.rate", 4 + force / 2 * t), ("b.rate", 7 - ratio * force / 5 * t)):
        if abs(rows[1][column] - wanted) > 40 * t * t:
            yield f"{column} is {rows[1][column]}, not {wanted}, after {t} s"


for kind in ("gear", "coupling"):
    for ratio, key in ((0.5, "ratio = 0.5"), (1, "")):
        promise(
            "joint force -k (q_a - ratio q_b) - d (q_a' - ratio q_b') in joint a, and -ratio "
            "times it in joint b" if key else "`ratio` is 1 by default.",
            WHEELS + element(kind, 'joints = ["a", "b"]', key,
                "stiffness = 3", "damping = 2") + SOON,
            lambda found, rows, r=ratio: gear_accelerates(found, rows, r))
# Masses of 1 and 3 kg: the impulses are opposite.
promise("It acts on both of its bodies or joints with opposite signs.",
        MOVING + body('joint = { kind = "prismatic", axis = [1, 0, 0] }', "mass = 3", name="b")
        + element("spring", 'between = ["a", "b"]', "stiffness = 7", "damping = 0.5"),
        lambda found, rows: [f"{row}" for row in rows
                             if abs(row["a.rate"] + 3 * row["b.rate"] - 2) > NEAR])
promise("any except those of bodies and other elements",
        MOVING + element("spring", TO_A, "stiffness = 1", name="a"), "is the name of a body")
promise("`at` is a point of each, numbers on the body's axes or a name in `points`. Without `at` "
        "they are the bodies' origins.", MOVING + element("spring", TO_A, "stiffness = 7"),
        {"start": {"s.acceleration x": -21}})
promise("`length` is that of the unloaded spring, 0 by default.",
        MOVING + element("spring", TO_A, "stiffness = 7"), {"start": {"s.acceleration x": -21}})
for displacement, pull in ((0.15, -10), (0.25, 25), (0.05, -30), (0.4, 100)):
    promise("Between them the pull is linear, and the first and the last piece go on straight.",
            SLED % f"initial = {{ displacement = {displacement} }}" + FORCE
            + element("spring", TO_A, "table = [[0.1, -20], [0.2, 0], [0.3, 50]]") + SOON,
            {"start": {"s.acceleration x": -pull}})
promise("`joints` are two bodies whose joints have one coordinate each: `revolute`, `prismatic` or "
        "`screw`.", body(DISC) + body('joint = { kind = "screw", axis = [0, 0, 1], pitch = 1 }',
                                      name="b") + element("gear", 'joints = ["a", "b"]',
                                                          "stiffness = 3"), None)
promise("Rotors take no element, because no force may depend on their angle.",
        body(DISC, 'rotor = { mode = "free", speed = 3 }')
        + element("spring", TO_A, "stiffness = 1"), "is a rotor")
promise("that does not jump: a winch", MOVING + element(
    "rope", TO_A, "stiffness = 1", "length = { steps = [[0, 2], [1, 3]] }"), "a winch needs time")

# A mount on a first body that is turned by a quarter: its axes move with it.
BASE = body('joint = { kind = "fixed", orientation = [0.7071067811865476, 0, 0, '
            "0.7071067811865476] }", name="base")
BLOCK = body(FREE, 'parent = "base"', "initial = { position = [0.1, 0.2, 0.3], velocity = [4, 5, "
                                      "6], angular_velocity = "
                                      "[1, 2, 3] }") + report("elements") + SOON
ON_BASE = 'between = ["base", "a"]'
promise("They are force and torque on the second body about its point, on the first body's axes.",
        BASE + BLOCK + element("mount", ON_BASE, "stiffness = "
                                                 "[2, 3, 4]", "damping = [0.5, 0.6, 0.7]",
                               "turning_damping = [1, 2, 3]", "preload = [9, 8, 7, 6, 5, 4]"),
        {"start": {"e.force": [9 - 0.2 - 2, 8 - 0.6 - 3, 7 - 1.2 - 4.2],
                   "e.torque": [6 - 1, 5 - 4, 4 - 9]}})
promise("`axes` is their attitude against the first body, a quaternion, by default the same axes.",
        BASE + BLOCK + element("mount", ON_BASE, "stiffness = [2, 3, 4]",
                               f"axes = {quaternion('z', math.pi / 2)}"),
        {"start": {"e.force": [-0.3, -0.4, -1.2]}})  # x of the mount is y of the body
promise("A matrix is three numbers, its diagonal, or three rows of three.",
        BASE + BLOCK + element("mount", ON_BASE,
                               "stiffness = [[2, 1, 0], [0, 3, 0], [0, 0, 4]]"),
        {"start": {"e.force": [-0.4, -0.6, -1.2]}})
promise("C `coupling`", BASE + BLOCK + element(
    "mount", ON_BASE, "stiffness = [2, 3, 4]", "coupling = [[0, 0, 0], [5, 0, 0], [0, 0, 0]]"),
    {"start": {"e.torque": [-5 * 0.2, 0, 0]}})  # C transposed times d
SHAFT = body(DISC, "initial = { angle = 0.4 }") + report("elements")
promise("K and T may be unsymmetric, as for an oil film; then there is no potential.",
        BASE + BLOCK + element("mount", ON_BASE,
                               "stiffness = [[2, 1, 0], [-1, 3, 0], [0, 0, 4]]"),
        lambda found, rows: [f"{found['invariants']}"] if any(
            entry["name"] == "energy" for entry in found["invariants"]) else [])
for key in ("stiffness", "turning_stiffness", "damping", "turning_damping"):
    promise("All keys but one may be left out.",
            BASE + BLOCK + element("mount", ON_BASE, f"{key} = [1, 2, 3]"), None)
promise("All keys but one may be left out.", BASE + BLOCK + element("mount", ON_BASE), "is missing")
promise("With `report.elements` the run has columns `NAME.force x` .., `NAME.torque x` .., and "
        "`final.elements.NAME` in JSON.",
        MOVING + report("elements") + element("spring", TO_A, "stiffness = 0", "damping = 1e-300"),
        {"json": {"final.elements.e.force": [0, 0, 0], "final.elements.e.torque": [0, 0, 0]},
         "e": [0, 0, 0, 0, 0, 0]})
promise("J takes theta' to w, and is 1 for small angles.",
        SHAFT + element("mount", TO_A, "turning_stiffness = [0, 0, 5]"),
        {"start": {"e.torque": [0, 0, -2]}})
promise("A mount is unloaded where both points meet and both bodies have the same attitude.",
        BASE + body(FREE, 'parent = "base"') + report("elements")
        + element("mount", ON_BASE, "stiffness = [2, 3, 4]", "turning_stiffness = [5, 6, 7]"),
        {"e.force": [0, 0, 0], "e.torque": [0, 0, 0]})
promise("A symmetric stiffness therefore keeps the energy for any rotation.",
        body(BALL, "inertia = [2, 3, 4]", "initial = { angular_velocity = [1, 2, 1] }")
        + element("mount", TO_A, "turning_stiffness = [[5, 1, 0], [1, 6, 0], [0, 0, 7]]"),
        {"json": {"invariants.0.name": "energy", "invariants.0.largest_drift": Near(0, 1e-10)}})
SPINNING = body(DISC, "initial = { rate = 4 }") + solve(1, "tolerance = 1e-9")
promise("If a torque depends on theta, theta must stay below 3 rad.",
        SPINNING + element("mount", TO_A, "turning_stiffness = [0, 0, 1e-3]"), Ends(3,
            "rotated by more than 3 rad"))
promise("If a torque depends on theta, theta must stay below 3 rad.",
        SPINNING + element("mount", TO_A, "turning_damping = [0, 0, 1e-3]"), None)
promise("Those of a gear act on the body of joint b, along or about its axis, about its origin.",
        WHEELS + report("elements")
        + element("gear", 'joints = ["a", "b"]', "ratio = 0.5", "stiffness = 3"),
        {"start": {"e.force": [0, 0, 0], "e.torque": [0, 0, -0.5 * -3 * (3 - 0.5 * 6)]}})
promise("Those of a gear act on the body of joint b, along or about its axis, about its origin.",
        SLED % "initial = { displacement = 2 }" + body(
            'joint = { kind = "prismatic", axis = [0, 1, 0], position = [7, 0, 0] }', name="b")
        + report("elements") + element("gear", 'joints = ["a", "b"]', "stiffness = 3"),
        {"start": {"e.force": [0, 6, 0], "e.torque": [0, 0, 0]}})

# Constraints: what stays of the motion of a free body, or what holds it.
HELD = WEIGHT + report("constraints")
promise("two points coincide", HELD + body(FREE) + constraint(
    "point", TO_A, "at = [[1, 2, 3], [1, 2, 3]]") + sensor("point", "at = [1, 2, 3]"),
    {"s.position": [1, 2, 3], "s.velocity": [0, 0, 0]})
promise("two points coincide, and an axis of each body",
        HELD + body(FREE, "centre = [1, 0, 0]", "inertia = [1, 1, 1]")
        + constraint("revolute", TO_A, "axis = [0, 0, 1]"),
        {"a": [1, *[0] * 12], "e.force": [0, 0, 10], "e.torque": [0, -10, 0]})
promise("two points coincide, and the attitude of the start is kept",
        HELD
        + body(FREE, f"initial = {{ attitude = {quaternion('y', 0.5)}, position = [1, 0, 0] }}")
        + constraint("fixed", TO_A, "at = [[1, 0, 0], [0, 0, 0]]"),
        {"a": [math.cos(0.25), 0, math.sin(0.25), 0, 1, *[0] * 8]})
promise("two points coincide, and an axis of the second body is perpendicular to one of the first",
        body(FREE, "initial = { angular_velocity = [2, 0, 3] }") + constraint(
            "universal", TO_A, "axis = [[0, 0, 1], [1, 0, 0]]")
        + sensor("point", "at = [1, 0, 0]"),
        lambda found, rows: [f"it is off by {row['s.position z']}" for row in rows
                             if abs(row["s.position z"]) > NEAR])
promise("a point of the second body moves along a line of the first; the attitude of the start is "
        "kept", WEIGHT + body(FREE, f"initial = {{ attitude = {quaternion('x', 0.5)} }}")
        + constraint("prismatic", TO_A, "axis = [3, 0, -4]"),
        {"a": [math.cos(0.25), math.sin(0.25), 0, 0, 0.6 * 4, 0, -0.8 * 4, 0, 0, 0, 0.6 * 8, 0,
               -0.8 * 8]})
# 10 m/s^2 along (3, -4)/5: 8 m/s^2.
promise("two points keep a distance",
        body(FREE, "initial = { position = [2, 0, 0], velocity = [0, 3, 0] }")
        + constraint("distance", TO_A, "length = 2"),
        {"rows": {"a.x": lambda t: 2 * math.cos(1.5 * t), "a.y": lambda t: 2 * math.sin(1.5 * t)}})
GEARED = body(DISC, "initial = { angle = %s, rate = -8 }") + body(
    DISC, "initial = { angle = 2, rate = 4 }", name="b")
promise("It does no work.",
        WEIGHT + body(FREE, "initial = { position = [2, 0, 0], velocity = [0, 3, 0] }")
        + constraint("distance", TO_A, "length = 2"),
        {"json": {"invariants.0.name": "energy", "invariants.0.start": 4.5,
                  "invariants.0.largest_drift": 0}})
promise("Each step ends on the conditions, for positions and velocities, as does each output.",
        WEIGHT + body(FREE, "initial = { position = [2, 0, 0], velocity = [0, 3, 0] }")
        + constraint("distance", TO_A, "length = 2"),
        lambda found, rows: [f"{row}" for row in rows if abs(
            math.hypot(row["a.x"], row["a.y"], row["a.z"]) - 2) > 1e-14 or abs(
            row["a.x"] * row["a.vx"] + row["a.y"] * row["a.vy"] + row[
                "a.z"] * row["a.vz"]) > 1e-13])
promise("`offset` is 0 by default", GEARED % -4 + constraint(
    "gear", 'joints = ["a", "b"]', "ratio = -2"), {"rows": {"a.angle": lambda t: -4 - 8 * t}})
promise("With `report.constraints` the run has columns `NAME.force x` .., `NAME.torque x` .., "
        "and `final.constraints.NAME` in JSON: force and torque on the second body about its "
        "point, on the first body's axes.",
        HELD + body(FREE) + constraint("fixed", TO_A, "at = [[1, 0, 0], [1, 0, 0]]"),
        {"json": {"final.constraints.e.force": [0, 0, 10],
                  "final.constraints.e.torque": [0, 10, 0]}})  # the weight acts 1 m behind
promise("q_a = ratio q_b + offset", GEARED % -3.5 + constraint(
    "gear", 'joints = ["a", "b"]', "ratio = -2", "offset = 0.5"),
    {"rows": {"a.angle": lambda t: -3.5 - 8 * t, "b.angle": lambda t: 2 + 4 * t}})
promise("q_a = ratio q_b + offset", GEARED % (math.pi - 4) + constraint(
    "gear", 'joints = ["a", "b"]', "ratio = -2", "offset_deg = 180"),
    {"rows": {"a.angle": lambda t: math.pi - 4 - 8 * t}})
promise("The start must fulfil the constraints to 1e-9 of the lengths in them.",
        GEARED % -3.4 + constraint("gear", 'joints = ["a", "b"]', "ratio = -2", "offset = 0.5"),
        "the start is off by")
BAR = body(FREE, "initial = { position = [%s, 0, 0] }") + constraint(
    "distance", TO_A, "length = 2")
promise("The start must fulfil the constraints "
        "to 1e-9 of the lengths in them.", BAR % "2.000000001",
        None)
promise("The start must fulfil the constraints to 1e-9 of the lengths in them.", BAR % "2.00000001",
        "the start is off by")
# A wheel rolls straight on with omega r; a ball on a plane keeps its velocity.
ROLLER = ("initial = { position = [0, 0, 0.5], velocity = [3, 0, 0], "
          "angular_velocity = [0, 6, 0] }")
for axis in ("axis = [0, 1, 0]", ""):
    promise("a wheel, or without `axis` a ball, rolls on a plane without slipping",
            HELD + body(FREE, "inertia = [1, 2, 1]" if axis else "inertia = [2, 2, 2]", ROLLER)
            + constraint("rolling", 'body = "a"', "radius = 0.5", axis,
                         "plane = { normal = [0, 0, 1] }"),
            {"rows": {"a.x": lambda t: 3 * t, "a.wy": lambda t: 6}, "e.force": [0, 0, 10]})
promise("which is across the blade",
        HELD + body('joint = { kind = "planar", axis = [0, 0, 1] }', "force = [0, 5, 0]",
                    "initial = { velocity = [3, 0] }")
        + constraint("blade", 'body = "a"', "direction = [0, 1, 0]"),
        {"rows": {"a.displacement 1": lambda t: 3 * t, "a.displacement 2": lambda t: 0}})
promise("any except those of bodies, elements and other constraints", MOVING
        + element("spring", TO_A, "stiffness = 1") + constraint("point", TO_A),
            "is used by an earlier element")
promise("Rotors take no constraint.", body(DISC, 'rotor = { mode = "free", speed = 3 }')
        + constraint("point", TO_A), "is a rotor")
promise("That of the second body is the same direction at the start.",
        body(FREE, f"initial = {{ attitude = {quaternion('x', math.pi / 2)}, "
             "angular_velocity = [0, 3, 0] }") + constraint("revolute", TO_A, "axis = [0, 0, 1]")
        + sensor("gyro", name="w"),  # z of the guide is y of the body
        {"rows": {"w.y": lambda t: 3, "w.x": lambda t: 0, "w.z": lambda t: 0}})
promise("a `universal` needs two", body(FREE) + constraint("universal", TO_A, "axis = [0, 0, 1]"),
        "must be two axes")
for plane, wanted in (("plane = { point = [0, 0, 1], normal = [0, 0, 1] }", 1.5),
                      ("plane = { normal = [0, 0, 1] }", 0.5)):
    promise("`tube` is the radius of the rim's cross-section, 0 by default.",
            HELD + body(FREE, f"initial = {{ position = [0, 0, {wanted + 0.1}] }}")
            + constraint("rolling", 'body = "a"', "radius = 0.5", "axis = [0, 1, 0]", "tube = 0.1",
                         plane), {"a.z": wanted + 0.1})
promise("is on the axes of `on`, `\"guide\"` by default",
        body(DISC, "initial = { rate = 2 }", name="table")
        + body(FREE, "initial = { position = [0, 0, 0.5], angular_velocity = [0, 0, 2] }")
        + constraint("rolling", 'body = "a"', "radius = 0.5", "plane = { normal = [0, 0, 1] }",
                     'on = "table"'),
        {"rows": {"a.z": lambda t: 0.5, "table.rate": lambda t: 2}})
promise("`direction` of a `blade` is on the body's axes, and the velocity is relative to the "
        "guide.",
        guide("rotating", "angular_velocity = [0, 0, 0]", "origin_velocity = [0, 9, 0]")
        + body(FREE, f"initial = {{ attitude = {quaternion('z', math.pi / 2)}, "
               "velocity = [0, 3, 0] }") + constraint("blade",
                   'body = "a"', "direction = [0, 1, 0]"),
        {"rows": {"a.y": lambda t: 3 * t, "a.x": lambda t: 0}})
# Equal masses on two tracks: each moves by half of what is wrong.
promise("With `solve.assemble = true` the nearest start that does is taken: the least change, "
        "weighted with the masses.",
        SLED % "initial = { displacement = 1 }" + body(
            'joint = { kind = "prismatic", axis = [1, 0, 0] }', "mass = 3", name="b",)
        + constraint("gear", 'joints = ["a", "b"]', "ratio = 1") + solve(1, "assemble = true"),
        {"start": {"a.displacement": 0.25, "b.displacement": 0.25}})
promise("A constraint that no start near fulfils is told by name.",
        body(HINGE) + constraint("point", TO_A, "at = [[0, 0, 5], [0, 0, 1]]")
        + solve(1, "assemble = true"), "'e'")
TWICE = body(FREE) + constraint("fixed", TO_A) + constraint("point", TO_A, name="more")
promise("Conditions that follow from others are told by name and number.", TWICE,
        lambda found, rows: [] if len(found["warnings"]) == 1 and "more" in str(found["warnings"])
        and "3" in str(found["warnings"]) else [f"the warnings are {found['warnings']}"])
promise("They are legal, and of all reactions the smallest are taken.", TWICE + HELD,
        {"e.force": [0, 0, 5], "more.force": [0, 0, 5]})
BALL_ABOVE = body(FREE, "initial = { position = [0, 0, 0.5] }") + constraint(
    "rolling", 'body = "a"', "radius = 0.5", "plane = { normal = [0, 0, 1] }")
promise("If it pulls at an output, there is a warning with time and force.",
        HELD.replace("-10", "10") + BALL_ABOVE,
        lambda found, rows: [] if len(found["warnings"]) == 1 and "10 N" in str(found["warnings"])
        and "e" in str(found["warnings"]) else [f"the warnings are {found['warnings']}"])
promise("A contact of `rolling` never lifts off.", HELD.replace("-10", "10") + BALL_ABOVE,
        {"a.z": 0.5, "e.force": [0, 0, -10]})
promise("The point of `rolling` is the contact.",
        HELD + body(FREE, "initial = { position = [0, 0, 0.5] }",
                    'load = { force = [3, 0, 0], axes = "guide" }', "inertia = [0.25, 0.25, 0.25]")
        + constraint("rolling", 'body = "a"', "radius = 0.5", "plane = { normal = [0, 0, 1] }"),
        # A ball with I = m r^2: half of the force is friction.
        {"start": {"e.force": [-1.5, 0, 10], "e.torque": [0, 0, 0]}})
promise("The model of a scene with constraints must be `exact` or `small`.",
        BALL_ABOVE + solve(1, 'model = "linear"'), "model")
promise("The model of a scene with constraints must be `exact` or `small`.",
        WEIGHT + BALL_ABOVE + solve(1, 'model = "small"'), None)
promise("are points (length, pull)",
        SLED % "initial = { displacement = 0.3 }" + FORCE
        + element("spring", TO_A, "table = [[0.1, -20], [0.2, 0], [0.3, 50]]") + SOON,
        {"start": {"s.acceleration x": -50}})
# Seen from the guide x of the first body is y: the readings are those on the base's axes.
promise("All are on the mount's axes, which move with the first body.",
        BASE + BLOCK + element("mount", ON_BASE, "stiffness = [2, 0, 0]")
        + sensor("reaction", 'element = "e"', 'axes = "guide"', on=""),
        {"start": {"s.force": [0, -0.2, 0]}})
# The pin is along y of the first body, which is -x of the guide.
promise("`axis` is on the first body's axes.",
        BASE + body(FREE, 'parent = "base"', "initial = { angular_velocity = [0, 3, 0] }")
        + constraint("revolute", ON_BASE, "axis = [0, 1, 0]"), {"rows": {"a.wy": lambda t: 3}})
promise("`warnings` of `--json` is the list of both.",
        HELD.replace("-10", "10") + BALL_ABOVE + constraint(
            "blade", 'body = "a"', "at = [0, 0, -0.5]", "direction = [0, 1, 0]", name="more"),
        lambda found, rows: [] if len(found["warnings"]) == 2 else [f"{found['warnings']}"])
promise("force and torque about the point that an element or a constraint exerts on its second "
        "body",
        HELD + body(FREE) + constraint("point", TO_A)
        + sensor("reaction", 'constraint = "e"', "at = [1, 0, 0]", on=""),
        {"s.force": [0, 0, 10], "s.torque": [0, 10, 0]})
promise("moves the start onto the [constraints](#constraint)",
        BAR % "2.5" + solve(1, "assemble = true"), {"start": {"a.x": 2}})
promise("moves the start onto the [constraints](#constraint)",
        BAR % "2.5" + solve(1, "assemble = false"), "the start is off by")
