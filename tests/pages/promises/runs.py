"""Sentences on mistakes, units, the end of a run, methods and approximations."""

import math

from promises.table import (
    BALL, DISC, FIXED, FREE, HINGE, SLIDE, WEIGHT, Ends, Near, body, guide, named, part, promise,
    quaternion, report, sensor, solve
)

SCENE = body(DISC, "%s")
KEYS = ("`file:line:column: key: reason`: an unknown or missing key, a wrong type, or a value that "
        "is not physical.")
for key, reason in (
    ("masss = 1", "s.toml:4:1: body 'a'.masss: is no key here"),
    ("damping = true", "s.toml:4:11: body 'a'.damping: must be a number, not true"),
    ("damping = -1", "s.toml:4:11: body 'a'.damping: must not be below 0"),
):
    promise(KEYS, part("[[body]]", 'name = "a"', DISC, key, "mass "
                                                            "= 1", "inertia = [1, 1, 1]"), reason)
promise("any text", 'title = "Gyro \\u00e9 \\"1\\""\n' + body(FIXED),
        {"json": {"title": 'Gyro \u00e9 "1"'}})
promise("a body, its joint, and the forces on it; at least one", guide("inertial"), "no [[body]]")

promise("latitude and azimuth of a site always do",
        guide("earth", "latitude = 1", "height = 0", "azimuth_deg = 0") + body(FIXED),
        "guide.latitude: is no key here")
promise("latitude and azimuth of a site always do",
        guide("earth", "latitude_deg = 1", "height = 0", "azimuth = 0") + body(FIXED),
        "guide.azimuth: is no key here")
promise("quaternions `[w, x, y, z]` of norm 1",
        body(BALL, "initial = { attitude = [1, 0, 0, 0.1] }"), "of norm 1.0049")

# Units.
promise("A number may be a text with a unit",
        WEIGHT + body(HINGE, 'mass = "500 g"', 'centre = ["5 mm", 0, 0]', "inertia = [0, 1, 1]",
                      'drive = "constant-rate"', 'initial = { rate = "2400 rpm" }')
        + report("reactions"),
        {"start": {"a.force x": -0.5 * 0.005 * (80 * math.pi) ** 2, "a.force z": 5}})
for text, rate in (("2400 rpm", 80 * math.pi), ("3 Hz", 6 * math.pi), ("2 1/s", 2),
                   ("90 deg/s", math.pi / 2), ("2 rev/min", math.pi / 15)):
    promise("1 Hz is one revolution per second, 2 pi rad/s." if "Hz" in text else
            "Units are combined as in", SCENE % f'initial = {{ rate = "{text}" }}',
            {"start": {"a.rate": rate}})
for text in ("10 N m", "10 N*m", "10 Nm", "10 N m/rad", "0.01 kN m"):
    promise("Radian may be left out: 1/s is rad/s, and N m is N m/rad.",
            SCENE % f'spring = {{ stiffness = "{text}" }}\ninitial = {{ angle = 1 }}',
            {"rows": {"a.angle": lambda t: math.cos(math.sqrt(10) * t)}})
promise("A product after `/` needs brackets.", SCENE % 'damping = "4 N m/rad s"',
    "is unclear after")
promise("Where an angle has no place, an angle is an error.", SCENE % 'force = "4 N m/rad"', "N m")
promise("The unit must have the dimension of the key, and the error names both.",
        body(DISC, 'mass = "5 mm"'), "'5 mm' is a length (m), wanted a mass (kg)")
promise("A key in degrees (`angle_deg`) takes plain numbers only.",
        SCENE % 'initial = { angle_deg = "3 deg" }', "must be a plain number")
for first, second in (('"5 mm"', "0.005"), ('"0.3 t"', "300"), ('"1 h"', "3600")):
    promise('`"5 mm"` is the same double as 0.005', (
        body(SLIDE, f"initial = {{ displacement = {first}}}")
        + body(SLIDE, f"initial = {{ displacement = {second} }}", name="b")).replace(
            '"0.3 t"', '"300 m"').replace('"1 h"', '"3.6 km"'),
        lambda found, rows: [] if rows[0]["a.displacement"] == rows[0]["b.displacement"] else [
            "no"])
promise('`"30 deg"` the same as 30 at a key that ends in `_deg`',
        body(DISC, 'initial = { angle = "30 deg" }')
        + body(DISC, "initial = { angle_deg = 30 }", name="b"),
        lambda found, rows: [] if rows[0]["a.angle"] == rows[0]["b.angle"] else ["they differ"])
LOG = {"l.csv": "t,yaw,pitch,roll\n" + "".join(f"{k / 10},0,0,0\n" for k in range(12))}
for key in ("skip", "skip_after_header", "time_zero"):
    promise("Whole numbers without unit (`seed`, `skip`) and `time_zero` take no unit.",
            guide("table", 'file = "l.csv"', f'{key} = "1 s"') + body(FIXED), f"guide.{key}",
            files=LOG)
promise("Whole numbers without unit (`seed`, `skip`) and `time_zero` take no unit.",
        body(FIXED) + sensor("gyro", 'seed = "1 s"'), "sensor 's'.seed")

# The end, and the outputs.
promise("`initial` is the state at this time. Functions of time, guides and output times count "
        "from t = 0",
        body(SLIDE, "initial = { displacement = 7 }", "force = { rate = 6 }")
        + solve(3, "t_begin = 2", "output_step = 0.5"),
        # From 7 m at rest at 2 s: the integrals of 6 t.
        {"rows": {"t": [2, 2.5, 3], "a.rate": lambda t: 3 * (t * t - 4),
                  "a.displacement": lambda t: 7 + t**3 - 12 * t + 16}})
promise("(t_end - t_begin)/500", SCENE % "" + solve(6, "t_begin = 1"),
        {"rows": {"t": [1 + k / 100 for k in range(501)]}})
promise("s, after `t_begin`", SCENE % "" + solve(1, "t_begin = 1"), "must be after t_begin")
for tolerance, reason in (("1e-15", Ends(4, "")), ("1e-2", None), ("9e-16", "lies outside"),
                          ("1.1e-2", "lies outside")):
    promise("attitudes in rad, the rest relative to its greatest size or, if that is smaller, to "
            "1e-3 in SI units; 1e-15 to 1e-2",
            WEIGHT + body(HINGE, "centre = [1, 0, 0]", "damping = 1") + solve(
                100, f"tolerance = {tolerance}"), reason)
for name, method in (("auto", "closed form"), ("automatic", "closed form"), ("taylor", "taylor"),
                     ("closed form", "closed form"), ("verner98", "verner98"),
                     ("gauss16", "gauss16"), ("radau13", "radau13")):
    promise("`automatic` is `auto`", WEIGHT + body(HINGE, "centre = [1, 0, 0]")
            + solve(1, f'method = "{name}"', "tolerance = 1e-10"),
            lambda found, rows, m=method: [] if m == "closed form" and found["method"] not in (
                "taylor", "verner98") or found["method"] == m else [found["method"]])
promise("`splitting` is for single tops of the library, and refused for scenes of a file",
        SCENE % "" + solve(1, 'method = "splitting"'), "splitting")
for name in ("elements", "constraints", "reactions", "terms"):
    promise("bearing forces and torques; forces of elements; of constraints; relative, guide and "
            "Coriolis parts", body(FREE) + named("element", "e", "spring",
                                                 'between = ["guide", "a"]', "stiffness = 1",
                                                 "at = [[0, 0, 1], [0, 0, 0]]")
            + named("constraint", "k", "point", 'between = ["guide", "a"]') + report(name),
            lambda found, rows, n=name: [] if {w for w in ("elements", "constraints", "reactions",
                                                           "terms") if w in found["final"]} == {n}
            else [f"final has {[*found['final']]}"])

# Methods.
SWING = body(HINGE, "centre = [1, 0, 0]", "%s")
STEPS = ("taylor", "verner98", "radau13", "gauss16")
ON = "On any other guide it is one body in a `spherical` joint at its centre of mass."
EXCLUDE = ("Elements, loads, joint forces, controllers and gravity that is not uniform exclude it.")
TURNS = guide("rotating", "angular_velocity = [0, 0, 1]")
SPIN = "initial = { angular_velocity = [1, 2, 3] }"
SPRING = named("element", "e", "spring", 'between = ["guide", "a"]', "stiffness = 1",
               "at = [[0, 0, 9], [0, 0, 0]]")
CARDAN = (
    body(DISC, "inertia = [1, 2, 3]", "initial = { rate = 0.1 }")
    + body('joint = { kind = "revolute", axis = [1, 0, 0] }', 'parent = "a"', "inertia = [1, 2, 3]",
           "initial = { angle = 0.3 }", name="b")
    + body(HINGE, 'parent = "b"', "inertia = [1, 2, 1]", "%s", name="c")
)
for quote, scene, is_closed in (
    ("one body in a revolute joint", WEIGHT + SWING % "", True),
    ("one free body with the centre of mass at its origin", WEIGHT + body(FREE, SPIN), True),
    ("one free body with the centre of mass at its origin",
     WEIGHT + body(FREE, SPIN, "centre = [0, 0, 1]"), False),
    ("one body held at a point, with the centre of mass there",
     WEIGHT + body(BALL, SPIN, "inertia = [2, 3, 4]"), True),
    ("one body held at a point, a symmetric top with the centre of mass on its axis, and z "
     "vertical",
     WEIGHT + body(BALL, SPIN, "centre = [0, 0, 1]", "inertia = [2, 2, 3]"), True),
    ("one body held at a point, a symmetric top with the centre of mass on its axis, and z "
     "vertical",
     WEIGHT.replace("[0, 0, -10]", "[10, 0, 0]")
     + body(BALL, SPIN, "centre = [0, 0, 1]", "inertia = [2, 2, 3]"), False),
    ("free or at constant speed", CARDAN % 'rotor = { mode = "free", speed = 50 }', True),
    ("free or at constant speed", CARDAN % 'rotor = { mode = "regulated", speed = 50 }', True),
    ("free or at constant speed", CARDAN % 'rotor = { mode = "torque", torque = 1 }', False),
    ("The rings do not turn over",
     (CARDAN % 'rotor = { mode = "free", speed = 0 }').replace("angle = 0.3", "rate = 3"), False),
    (ON, TURNS + body(BALL, SPIN, "inertia = [2, 3, 4]"), True),
    (ON, TURNS + WEIGHT + body(BALL, SPIN, "inertia = [2, 3, 4]"), True),
    (ON, TURNS + body(FREE, SPIN, "inertia = [2, 3, 4]"), False),
    (ON, TURNS + WEIGHT + SWING % "", False),
    (EXCLUDE, WEIGHT + SWING % "force = 1", False),
    (EXCLUDE, WEIGHT + SWING % "damping = 1", False),
    (EXCLUDE, WEIGHT + SWING % "load = { torque = [0, 1, 0] }", False),
    (EXCLUDE, WEIGHT + SWING % "" + SPRING, False),
    (EXCLUDE, WEIGHT + SWING % "" + sensor("joint") + part(
        "[[controller]]", 'name = "k"', 'reads = ["s.angle"]', 'drives = ["a"]',
        'law = { kind = "pid", proportional = 1 }'), False),
    (EXCLUDE, part("[gravity]", 'kind = "point"', "mu = 1", "centre = "
                                                            "[0, 0, 9]") + SWING % "", False),
    ("A body that rotates about a point must have its principal axes as axes.",
     body(BALL, SPIN, "inertia = [2, 3, 4, 0.1, 0, 0]"), False),
):
    promise(quote, scene, lambda found, rows, c=is_closed: []
            if (found["method"] not in STEPS) == c else [f"the method is {found['method']}"])
promise("It turns as in the inertial frame. The sign of its quaternion is that nearer to the "
        "start's.",
        TURNS + body(BALL, f"initial = {{ attitude = {[-x for x in quaternion('z', 0.5)]} }}")
        + solve(1, "tolerance = 1e-10"),
        # At rest on the guide: it turns with it in the inertial frame.
        {"rows": {"a.qw": lambda t: -math.cos(0.25), "a.qz": lambda t: -math.sin(0.25)}})
DAMPED = WEIGHT + SWING % "damping = 1"
DRAG = "a `drag` with a quadratic part or on a moving guide, or a gravity that is not uniform"
ELEMENT = "an element, except a `gear` or `coupling`, and a constraint"
OTHERS = "All other scenes use the Taylor series of their motion"
GUIDE = "a guide of kind `course`, `table`, `rates` or `chain`"
SAMPLES = {"l.csv": "t,value,yaw,pitch,roll\n" + "".join(f"{k / 10},0,0,0,0\n" for k in range(12))}
LINK = '{ kind = "rotating", angular_velocity = [0, 0, 1] }'
SECOND = DAMPED + body(DISC, name="b")
for quote, scene, is_series in (
    (OTHERS, DAMPED, True), (OTHERS, TURNS + DAMPED, True), (OTHERS, SECOND, True),
    (DRAG, WEIGHT + SWING % 'load = { kind = "drag", linear = [1, 1, 1] }', True),
    (DRAG, WEIGHT + SWING % 'load = { kind = "drag", quadratic = [1, 1, 1] }', False),
    (DRAG, TURNS + SWING % 'load = { kind = "drag", linear = [1, 1, 1] }', False),
    (DRAG, part("[gravity]", 'kind = "point"', "mu = 1", "centre = [0, 0, 9]") + SWING % "", False),
    (ELEMENT, DAMPED + SPRING, False),
    *((ELEMENT, SECOND + named("element", "g", kind, 'joints = ["a", "b"]', "stiffness = 2"), True)
      for kind in ("gear", "coupling")),
    (ELEMENT, SECOND + named("constraint", "g", "gear", 'joints = ["a", "b"]', "ratio = 2"), False),
    (GUIDE, guide("course", "latitude = 0.5", "heading = 0", "speed = 1") + SWING % "", False),
    (GUIDE, guide("chain", f"links = [{LINK}, {LINK}]") + DAMPED, False),
    (GUIDE, guide("table", 'file = "l.csv"', "sigma = 0") + DAMPED, False),
    ("a function of time from a file", WEIGHT + SWING % 'force = { file = "l.csv", sigma = 0 }',
     False),
    ("a body with a `free` joint to another body", DAMPED + body(FREE, 'parent = "a"', name="b"),
     False),
    ("- a controller", DAMPED + sensor("joint") + part(
        "[[controller]]", 'name = "k"', 'reads = ["s.angle"]', 'drives = ["a"]',
        'law = { kind = "pid", proportional = 1 }'), False),
):
    promise(quote, scene, lambda found, rows, s=is_series: []
            if (found["method"] == "taylor") == s else [f"the method is {found['method']}"],
            files=SAMPLES)

promise("Its rings have their principal axes there, and all centres of mass lie in the point.",
        CARDAN.replace("inertia = [1, 2, 3]", "inertia = [1, 2, 3]\ncentre = [0, 0, 0.1]", 1)
        % 'rotor = { mode = "free", speed = 50 }',
        lambda found, rows: [] if found["method"] in STEPS else [found["method"]])
STEADY = body(SLIDE, "force = { steps = [[0.3, 2]] }")
for model in ("exact", "small"):
    promise("any, with constraints and continuous controllers; forces may jump",
            STEADY + solve(1, f'model = "{model}"', "tolerance = 1e-9"),
            {"rows": {"a.displacement": Near(lambda t: max(0, t - 0.3) ** 2, 1e-9)}})
# A guide that swings through 2 rad, and a relaxed spring on it: Euler's force is large.
promise("exact in the motion of the guide",
        guide("motion", "angles = { pitch = { terms = [{ amplitude = 2, frequency = 3 }] } }")
        + body(HINGE, "spring = { stiffness = 400 }") + solve(1,
            'model = "small"', "tolerance = 1e-9"),
        # q'' + 400 q = 18 sin 3 t, with q = q' = 0.
        {"rows": {"a.angle": Near(lambda t: 18 / 391 * (math.sin(3 * t) - 0.15 * math.sin(20 * t)),
                                  1e-9)}})

# Approximations.
SMALL = WEIGHT + body(HINGE, "centre = [0, 0, -1]", "initial = { angle = 0.01 }")


def distance(found, rows):
    if not 0 < found["error"]["distance"] <= found["error"]["model"]:
        yield f"the errors are {found['error']}"


for model in ("linear", "small"):
    promise("`error.distance` is then the true distance",
            SMALL + solve(1, f'model = "{model}"', "compare = true", "tolerance = 1e-2"), distance)
    promise("The exact motion is computed only with `compare = true`",
            SMALL + solve(1, f'model = "{model}"', "tolerance = 1e-2"),
            lambda found, rows: [f"{found['error']}"] if "distance" in found["error"] else [])
for keys, has in (("compare = false", False), ("", False), ("compare = true", True)):
    promise("computes the exact motion beside an approximation",
            SMALL + solve(1, 'model = "linear"', keys, "tolerance = 1e-2"),
            lambda found, rows, h=has: [] if ("distance" in found["error"]) == h else ["distance"])
promise("`error.model` of `--json` is its greatest value at the outputs.",
        SMALL + solve(1, 'model = "linear"', "tolerance = 1e-2"),
        lambda found, rows: [] if 1e-8 < found["error"]["model"] < 1e-3 else [f"{found['error']}"])
promise("eta' = A eta about the steady motion at or next to the start",
        SMALL + solve(1, 'model = "linear"', "tolerance = 1e-2"),
        {"rows": {"a.angle": lambda t: 0.01 * math.cos(math.sqrt(5) * t)}})  # m g s/(I + m s^2)
promise("(reactions, terms, energy) are exact for the approximate states",
        SMALL + report("reactions") + solve(1, 'model = "linear"', "tolerance = 1e-2",
                                            "output_times = [0, 1]"),
        # At rest at 0.01 rad: along the arm the weight, across it half of its component.
        {"start": {"a.force z": 10 * math.cos(0.01), "a.force x": -10 * math.sin(0.01) / 2}})
promise("A run ends, with exit status 3, where an attitude is off by more than 1 rad.",
        WEIGHT + body(BALL, "centre = [0, 0, -1]", "initial = { angular_velocity = [0, 9, 0] }")
        + solve(9, 'model = "linear"'), Ends(3, "an attitude is off by more than 1 rad"))
promise("guides and loads that do not change",
        guide("motion", "angles = { yaw = { terms = [{ amplitude = 1, frequency = 1 }] } }")
        + SMALL + solve(1, 'model = "linear"'), "no steady motion")

# At rest but for its rotor.
AT_REST = CARDAN.replace("angle = 0.3", "angle = 0.001").replace("rate = 0.1", "rate = 0")
FAST = AT_REST % 'rotor = { mode = "regulated", speed = 900 }'
for model, scene, reason in (
    ("precession", SMALL, "no rotor"), ("foeppl", SMALL, "foeppl"),
    ("fuchs-weigand", SMALL, "fuchs-weigand"), ("precession", FAST, None), ("foeppl", FAST, None),
    ("fuchs-weigand", FAST, None),
):
    promise("Other scenes are refused, with the reason.",
            scene + solve(0.1, f'model = "{model}"', "tolerance = 1e-2"), reason)
promise("angles of rotors grow uniformly", FAST + solve(0.1,
    'model = "precession"', "tolerance = 1e-2"),
        {"rows": {"c.angle": lambda t: 900 * t}})
# 0.1 g beside the axis.
UNBALANCED = (AT_REST % "").replace(HINGE, HINGE + '\ndrive = "constant-rate"').replace(
    'name = "c"', 'name = "c"\ncentre = [1e-4, 0, 0]\ninitial = { rate = 900 }')
for model, reason in (("fuchs-weigand", None), ("foeppl", "foeppl")):
    promise("if its speed is regulated it may be unbalanced",
            UNBALANCED + solve(0.01, f'model = "{model}"', "tolerance = 1e-2"), reason)
for model in ("foeppl", "fuchs-weigand"):
    for guided, reason in (("", None), (TURNS, "guide")):
        promise('A rotor with `mode = "free"` needs a guide at rest.',
                guided + AT_REST % 'rotor = { mode = "free", speed = 900 }'
                + solve(0.1, f'model = "{model}"', "tolerance = 1e-2"), reason)
promise("A scene with functions of time has no equilibria.",
        WEIGHT + body(HINGE, "centre = [0, 0, -1]",
                      "force = { terms = [{ amplitude = 1, frequency = 1 }] }"),
        lambda found, rows: [f"{found['equilibria']}"] if found.get("equilibria") else [],
        program="analyze")
