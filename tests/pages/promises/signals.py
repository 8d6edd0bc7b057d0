"""Sentences on functions of time and on logs."""

import math

from promises.table import (
    DISC, FIXED, FREE, HINGE, SLIDE, Near, body, guide, log, named, promise, sensor, solve
)

CHANGES = "{ constant = 0.1, rate = 0.2 }"
VECTOR = "{ constant = [0.1, 0, 0], rate = [0.2, 0, 0] }"
COURSE = ["latitude = 0", "heading = 0", "speed = 1"]
ROPE = named("element", "e", "rope", 'between = ["guide", "a"]', "stiffness = 1")

LOADS = "`load.force`, `load.torque`, `load.field`"
FORCES = "`force` of a body, `rotor.torque`, and the `rotor.speed` of a regulated rotor"
DRIVES = "`angle`, `displacement` or `rate` of a `drive`"
for quote, scene in (
    (LOADS, body(FREE, f"load = {{ force = {VECTOR}, torque = {VECTOR} }}")),
    (LOADS, body(FREE, f'load = {{ kind = "magnet", moment = [1, 0, 0], field = {VECTOR} }}')),
    (FORCES, body(HINGE, f"force = {CHANGES}")),
    (FORCES, body(DISC, f'rotor = {{ mode = "torque", torque = {CHANGES} }}')),
    (FORCES, body(DISC, f'rotor = {{ mode = "regulated", speed = {CHANGES} }}')),
    (DRIVES, body(HINGE, f"drive = {{ angle = {CHANGES} }}")),
    (DRIVES, body(SLIDE, f"drive = {{ displacement = {CHANGES} }}")),
    (DRIVES, body(HINGE, f"drive = {{ rate = {CHANGES} }}")),
    ("`position` and `angles` of a guide of kind `motion`",
     guide("motion", f"position = {VECTOR}", f"angles = {{ yaw = {CHANGES} }}") + body(FIXED)),
    *(("`turn_rate`, `acceleration`, `climb` and an angle of `bank` of a guide of kind `course`",
       guide("course", *COURSE, f"{key} = {CHANGES}") + body(FIXED))
      for key in ("turn_rate", "acceleration", "climb", "bank")),
    ("`length` of a rope", body(FREE) + ROPE + f"length = {CHANGES}\n"),
):
    promise(quote, scene, None)
for scene in (
    body(HINGE, f"damping = {CHANGES}"),
    body(HINGE, f"spring = {{ stiffness = {CHANGES} }}"),
    body(FREE, f'load = {{ kind = "magnet", moment = {VECTOR}, field = [1, 0, 0] }}'),
    body(DISC, f'rotor = {{ mode = "free", speed = {CHANGES} }}'),
    guide("rotating", f"angular_velocity = {VECTOR}") + body(FIXED),
    guide("course", "latitude = 0", "heading = 0", f"speed = {CHANGES}") + body(FIXED),
    body(FREE) + named("element", "e", "spring", 'between = ["guide", "a"]', "stiffness = 1",
                       f"length = {CHANGES}"),
):
    promise("Tables are allowed for these keys:", scene, "s.toml:")

# The joint is driven, so that its angle is the function.
promise(
    "c + r t + sum of a sin(w t + p); each key may be missing",
    body(HINGE, "drive = { angle = { constant = 0.5, rate = -2, terms = [{ amplitude = 3, "
                "frequency = 4, phase = 5 }, { amplitude = 6, frequency = 7 }] } }"),
    {"rows": {"a.angle": lambda t: 0.5 - 2 * t + 3 * math.sin(4 * t + 5) + 6 * math.sin(7 * t),
              "a.rate": lambda t: -2 + 12 * math.cos(4 * t + 5) + 42 * math.cos(7 * t)}},
)
# The speed of 2 rad/s after 1 s is that of a constant force on 1 kg m^2.
promise("A table in place of a number or a vector is a function of time.",
        body(HINGE, "force = { constant = 2 }"), {"a.rate": 2})
promise(
    "the motion of the joint, from which the start follows",
    body(SLIDE, "drive = { displacement = { constant = 3, rate = 4 } }"),
    {"start": {"a.displacement": 3, "a.rate": 4}, "a.displacement": 7, "a.rate": 4},
)
# A force on 1 kg is the acceleration that a point reads.
PUSHED = sensor("point") + solve(5, "output_times = [0.5, 1.5, 2.5, 3.5, 4.5]")
promise(
    "the value of the latest time reached; 0 before the first time",
    body(SLIDE, "force = { steps = [[1, 2], [3, -5]] }") + PUSHED,
    {"rows": {"s.acceleration z": [0, 2, 2, -5, -5]}},
)
promise(
    "a polyline; constant before the first time and after the last",
    body(SLIDE, "force = { points = [[1, 2], [2, 4], [4, -5]] }") + PUSHED,
    {"rows": {"s.acceleration z": [2, 3, 4 - 9 / 4, 4 - 27 / 4, -5]}},
)
CUBE = [[k / 10, k**3 / 1000, 0] for k in range(-1, 12)]
promise(
    "a spline through the samples of a [log](#logs), with the keys of logs; for a vector the "
    "columns are `x`, `y`, `z`",
    body(SLIDE, 'force = { file = "l.csv", columns = { t = "time", value = "M" }, sigma = 0 }')
    + sensor("point"),
    {"rows": {"s.acceleration z": lambda t: t**3}},
    files={"l.csv": log("time,M,other", CUBE)},
)
promise(
    "a spline through the samples of a [log](#logs), with the keys of logs; for a vector the "
    "columns are `x`, `y`, `z`",
    body(FREE, 'load = { force = { file = "l.csv", sigma = 0 } }') + sensor("point"),
    {"rows": {"s.acceleration x": lambda t: t**3, "s.acceleration y": lambda t: 0 * t,
              "s.acceleration z": lambda t: 2.0}},
    files={"l.csv": log("t,x,y,z", [[*row, 2.0] for row in CUBE])},
)
for keys, scene in (
    ("the times", body(SLIDE, "force = { points = [[1, 2], [0, 4]] }")),
    ("the frequency", body(SLIDE, "force = { terms = [{ amplitude = 1, frequency = -1 }] }")),
):
    promise(
        "Times are in seconds and increase." if keys == "the times"
        else "`frequency` is in rad/s and not below 0.",
        scene, "not after" if keys == "the times" else "must not be below 0",
    )
promise(
    "`frequency_deg` and `phase_deg` are in degrees, and so are the values of a key that ends in "
    "`_deg` (`speed_deg`, `yaw_deg`).",
    body(HINGE, "drive = { angle_deg = { constant = 10, terms = [{ amplitude = 20, frequency_deg = "
         "180, phase_deg = 30 }] } }"),
    {"rows": {"a.angle": lambda t: (10 + 20 * math.sin(math.pi * (t + 1 / 6))) * math.pi / 180}},
)
TWO = ("{ constant = 2 }", "[{ constant = 2 }, { constant = 3 }]")
for force, second in zip(TWO, (2, 3)):
    promise(
        "In a joint of several coordinates one function applies to all of them, and a list has one "
        "for each.",
        body('joint = { kind = "cylindrical", axis = [0, 0, 1] }', f"force = {force}"),
        {"a.rate": 2, "a.velocity": second},
    )
promise(
    "Steps of the integrator end at every jump of a value or a rate, so jumps cost no accuracy.",
    body(SLIDE, "force = { steps = [[0.1234567, 3], [0.7654321, 0]] }"),
    {"a.rate": 3 * (0.7654321 - 0.1234567),
     "a.displacement": 3 * (0.7654321 - 0.1234567) * (1 - (0.7654321 + 0.1234567) / 2)},
)
for key, reason in (("speed = { points = [[0, 1], [1, 2]] }", None),
                    ("speed = { steps = [[0, 1], [0.5, 2]] }", "jumps at t = 0 s")):
    promise("The speed of a rotor may have `points`, not `steps`.",
            body(DISC, f'rotor = {{ mode = "regulated", {key} }}'), reason)
for joint, key, reason in (
    (HINGE, "rate", None), (HINGE, "angle", "drive.angle: jumps"),
    (SLIDE, "displacement", "drive.displacement: jumps"),
):
    promise(
        "The `rate` of a drive may have `points`, too; its `angle` and `displacement` may have "
        "neither.",
        body(joint, f"drive = {{ {key} = {{ points = [[0.2, 1], [0.5, 2]] }} }}"), reason,
    )
# w t is exact, and so is its sine to half a unit.
promise(
    "A sum keeps its digits for any length of the run: each term has an error of at most 3 units "
    "of 1.1e-16 times its amplitude.",
    body(SLIDE, "force = { terms = [{ amplitude = 1, frequency = 3 }] }") + sensor("point")
    + solve(100000001, "t_begin = 100000000", "output_step = 0.125", "tolerance = 1e-7"),
    {"rows": {"s.acceleration z": Near([math.sin(3 * (1e8 + k / 8)) for k in range(9)],
                                       3.5 * 1.1e-16)}},
)
FORCED = body(HINGE, "force = { terms = [{ amplitude = 1, frequency = 3 }] }", "damping = 1")
promise("Functions of time keep the Taylor series of a scene, except those from a file.", FORCED,
        {"json": {"method": "taylor"}})
promise(
    "Functions of time keep the Taylor series of a scene, except those from a file.",
    body(HINGE, 'force = { file = "l.csv", sigma = 0 }', "damping = 1"),
    lambda found, rows: ["taylor"] if found["method"] == "taylor" else [],
    files={"l.csv": log("t,value,other", CUBE)},
)
promise("`linear` is refused for it", FORCED + solve(1, 'model = "linear"'), "no steady motion")
GYRO = (
    body(DISC, "mass = 0", "inertia = [0, 0, 0]", name="outer")
    + body(HINGE, 'parent = "outer"', "mass = 0", "inertia = [0, 0, 0]", "%s", name="ring")
    + body('joint = { kind = "revolute", axis = [1, 0, 0] }', 'parent = "ring"',
           'rotor = { mode = "regulated", speed = 500 }', name="wheel")
)
SMOOTH = "load = { torque = { terms = [{ amplitude = [0, 1e-3, 0], frequency = 3 }] } }"
JUMPING = "force = { steps = [[0.5, 1e-3]] }"
for model, load, reason in (
    ("precession", SMOOTH, None), ("precession", JUMPING, "is for forces that do not jump"),
    ("small", SMOOTH, None), ("small", JUMPING, None),
):
    promise(
        "If something jumps, all approximations but `small` are refused.",
        GYRO % load + solve(1, f'model = "{model}"', "tolerance = 1e-3"), reason,
    )

# A guide that turns at 0.5 rad/s about z, in a log of the columns that a row needs.
HEADER = ["t", "yaw", "pitch", "roll", "x", "y", "z"]
TURNING = [[k / 10, k / 20, 0.0, 0.0, 0.0, 0.0, k / 10] for k in range(-1, 12)]
SEEN = body(FIXED) + sensor("gyro", name="w") + sensor("point", 'against = "inertial"', name="p")


def logged(quote, text, keys=(), wanted=None):
    if wanted is None:
        wanted = {"w": Near([0, 0, 0.5], 1e-9), "p.position": Near([0, 0, 1], 1e-9)}
    promise(quote, guide("table", 'file = "l.csv"', *keys) + SEEN, wanted, files={"l.csv": text})


def fields(separator, rows=TURNING, header=HEADER):
    return separator.join(header) + "\n" + "".join(
        separator.join(repr(x) for x in row) + "\n" for row in rows)


for separator in (",", ";", "\t", " ", "   "):
    logged("A log is a text file of numbers in columns, separated by commas, semicolons, tabs or "
           "blanks.", fields(separator))
logged("It must cover the run.", fields(",", TURNING[:8]), (), "'l.csv' ends at t = 0.6 s, the run")
logged("`yaw, pitch, roll` are rotations about z, the new y and the new x.",
       fields(",", [[t, 0.3, 0.5 * t, 1.0, 0.0, 0.0, 0.0] for t, *_ in TURNING]), (),
       # The rate of pitch on axes that are turned by roll.
       {"w": Near([0, 0.5 * math.cos(1), -0.5 * math.sin(1)], 1e-9)})
logged("Other columns are ignored.",
       fields(",", [[1.0, *row, 7.0] for row in TURNING], ["a", *HEADER, "b"]))
logged("If no name matches exactly, capitals and units in brackets are ignored.",
       fields(",", TURNING, ["T [s]", "Yaw [rad]", "PITCH", "Roll", "X [m]", "Y", "Z"]))
logged("A comment (`#` or `%`) may be the header. Text above it is skipped.",
       "a turntable\nof 2025\n% " + fields(","))
for usual in ("time,yaw,pitch,roll,tx,ty,tz", "timestamp,yaw,pitch,roll,surge,sway,heave"):
    logged("Other usual names match too: `time`, `timestamp`, `tx, ty, tz`, `surge, sway, heave` "
           "and the like.", fields(",", TURNING, usual.split(",")))
logged("If `columns` names the attitude, a position is read only if it is named too.", fields(","),
       ['columns = { yaw = "yaw", pitch = "pitch", roll = "roll" }'],
       {"w": Near([0, 0, 0.5], 1e-9), "p.position": [0, 0, 0]})
logged("If all columns are given by number, no header is needed, and lines without numbers above "
       "the rows are skipped.", fields(",", header=["some", "text"]),
       ["columns = { t = 1, yaw = 2, pitch = 3, roll = 4, x = 5, y = 6, z = 7 }"])
logged("A unit in the header that differs from the key (`t [ms]`, `yaw [deg]`, `x [mm]`) is an "
       "error that names the key.", fields(",", header=["t [ms]", *HEADER[1:]]), (), "time_unit")
logged("A unit in the header that differs from the key (`t [ms]`, `yaw [deg]`, `x [mm]`) is an "
       "error that names the key.", fields(",", header=["t", "yaw [deg]", *HEADER[2:]]), (),
           "angles")
logged("A unit in the header that differs from the key (`t [ms]`, `yaw [deg]`, `x [mm]`) is an "
       "error that names the key.", fields(",", header=[*HEADER[:6], "z [mm]"]), (), "'z [mm]'")
for at, name, columns in ((1, "yaw_deg", 'yaw = "yaw_deg", pitch = 3, roll = 4'),
                          (4, "x_mm", "x = 5, y = 6, z = 7")):
    logged("Names that end in a unit count as well, such as `yaw_deg` and `x_mm`.",
           fields(",", header=[*HEADER[:at], name, *HEADER[at + 1:]]),
           [f"columns = {{ {columns} }}"], f"'{name}'")
for number in ("+.5", "5e-001", "0.5"):
    logged("Numbers are written as `1.5`, `+.5` or `-1.5e-005`.",
           fields(",").replace("1.0,0.5,", f"1.0,{number},"))
for row, reason in (("0.55,,0,0,0,0,0", "l.csv:9: "), ("0.55,nan,0,0,0,0,0", "l.csv:9: "),
                    ("0.55,0,0,0,0,0", "l.csv:9: "), ("0.55,0,0,0,0,0,0,0", "l.csv:9: ")):
    lines = fields(",").splitlines()
    logged("An empty field, `nan` and a row with more or fewer fields are errors that name the "
           "line.",
           "\n".join([*lines[:8], row, *lines[8:]]), (), reason)
for norm, wanted in ((1.009, {"q.qw": Near(1, 1e-9)}), (1.011, "norm")):
    promise(
        "A time must be later than the previous one, and the norm of a quaternion 1 within 1 %.",
        guide("table", 'file = "l.csv"') + body(FIXED)
        + sensor("attitude", 'against = "inertial"', name="q"), wanted,
        files={"l.csv": log("t,qw,qx,qy,qz", [[t, norm, 0, 0, 0] for t, *_ in TURNING])},
    )
promise(
    "A quaternion may change its sign from row to row.",
    guide("table", 'file = "l.csv"', "sigma = 0") + SEEN, {"w": Near([0, 0, 0.5], 1e-9)},
    files={"l.csv": log("t,qw,qx,qy,qz", [
        [t, (-1) ** k * math.cos(yaw / 2), 0, 0, (-1) ** k * math.sin(yaw / 2)]
        for k, (t, yaw, *_) in enumerate(TURNING)])},
)
logged("seconds between neighbouring rows; a longer gap is an error; `\"any\"`", fields(","),
       ["longest_gap = 0.05"], "gap")
logged("At most ten million rows are kept, and a line has at most a megabyte.",
       fields(",") + "1.2,0" + " " * 1100000 + ",0,0,0,0,0\n", (), "l.csv:15: ")
logged("With `window` no row outside is used, so `window` can exclude damaged rows.",
       fields(",") + "1.2,nan,,,,,\n", ["window = [-0.1, 1.15]"])
logged("seconds between neighbouring rows; a longer gap is an error; `\"any\"`", fields(","),
       ['longest_gap = "any"'])
logged("`[from, to]` in seconds after `time_zero`: rows outside are not read",
       fields(",", [*TURNING[:12], [1.05, 1e9, 0, 0, 0, 0, 0]]), ["window = [-0.1, 1.02]"])
logged("lines before the header", "t,yaw,pitch,roll\n1,2,3,4\n" + fields(","), ["skip = 2"])
logged("lines between header and rows, such as units",
       fields(",").replace("heave", "").replace("\n", "\n0,0,0,0,0,0,9\n", 1),
       ["skip_after_header = 1"])
for rule, value in (("first", 0.2), ("last", 0.4), ("mean", 0.3)):
    twice = [[t, 0.0, 0.0, 0.0, z, 0.0, 0.0] for t, *_ in TURNING for z in
             ((0.2, 0.4) if abs(t - 0.5) < 1e-9 else (0.3,))]
    promise(
        'rows of equal times: `"first"`, `"last"`, `"mean"`',
        guide("table", 'file = "l.csv"', "sigma = 0", f'duplicates = "{rule}"') + SEEN
        + solve(1, "output_times = [0.5]"), {"p.position x": Near(value, 1e-9)},
        files={"l.csv": log(",".join(HEADER), twice)},
    )
for unit, factor in (("ms", 1000), ("us", 1e6), ("ns", 1e9)):
    logged('`"ms"`, `"us"`, `"ns"`', fields(",", [[t * factor, *row] for t, *row in TURNING]),
           [f'time_unit = "{unit}"'])
ROUNDED = [[round(k / 30, 2), k / 60, 0.0, 0.0, 0.0, 0.0, k / 30] for k in range(-30, 61)]
logged("rounded times of a regular rate are replaced by those of the rate",
       fields(",", ROUNDED), ["sigma = 0", "window = [-1, 2]"])
logged("**Time stamps** such as 0, 3, 7, 10 ms are rounded from a regular rate, here 300 Hz.",
       fields(",", [[round(k / 300, 3), k / 600, 0.0, 0.0, 0.0, 0.0, k / 300]
                    for k in range(-300, 601)]), ["sigma = 0", "window = [-1, 2]"])
for quote in ('`"exact"`: they are used as they are',
              "Without this the rounding would look like acceleration."):
    logged(quote, fields(",", ROUNDED), ["sigma = 0", 'time_stamps = "exact"'],
           lambda found, rows: [] if max(abs(row["w.z"] - 0.5) for row in rows) > 0.01
           else ["the rounding of the times has no effect"])
logged("unit of angles and angular rates",
       fields(",", [[t, yaw * 180 / math.pi, *row] for t, yaw, *row in TURNING]),
       ['angles = "deg"'])
logged('or `"first"`: the time of the first row',
       fields(",", [[t + 1e9, *row] for t, *row in TURNING]), ['time_zero = "first"'],
       {"w": Near([0, 0, 0.5], 1e-6), "p.position": Near([0, 0, 0.9], 1e-6)})
