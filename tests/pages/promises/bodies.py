"""Sentences on gravity, bodies and loads."""

import math

from promises.table import (
    BALL, DISC, FIXED, FREE, HINGE, SLIDE, UNIVERSAL, WEIGHT, Near, body, cross, guide, part,
    promise, quaternion, report, sensor, solve, turned
)

MU = 3.986004418e14
EARTH, A, J2 = 7.292115e-5, 6378137.0, 0.484166774985e-3 * math.sqrt(5)


def gravity(kind, *lines):
    return part("[gravity]", f'kind = "{kind}"', *lines)


FALLING = body(FREE) + sensor("point", 'against = "inertial"') + solve(1, "output_times = [0, 1]")
TILTED = guide("rotating", "angular_velocity = [0, 0, 0]",
               f"attitude = {quaternion('y', math.pi / 2)}")

promise("no gravity", gravity("none") + FALLING, {"s.acceleration": [0, 0, 0]})
promise("on guide axes: it moves with the guide", TILTED + WEIGHT + FALLING,
        {"s.acceleration": [-10, 0, 0]})
promise("on inertial axes: it is constant",
        TILTED + gravity("inertial", "vector = [0, 0, -10]") + FALLING,
        {"s.acceleration": [0, 0, -10]})
promise(
    "of a point mass, at every body's centre of mass; `centre` is on inertial axes, by default the "
    "inertial origin",
    gravity("point", "mu = 50") + body(FREE, "initial = { position = [3, 0, 4] }")
    + sensor("point", 'against = "inertial"'),
    {"start": {"s.acceleration": [-50 / 25 * 0.6, 0, -50 / 25 * 0.8]}},
)
promise(
    "of a point mass, at every body's centre of mass; `centre` is on inertial axes, by default the "
    "inertial origin",
    gravity("point", "mu = 50", "centre = [0, 0, 9]") + TILTED
    + body(FREE, "centre = [1, 0, 0]") + sensor("point", "at = [1, 0, 0]", 'against = "inertial"'),
    {"start": {"s.acceleration": [0, 0, 50 / 100]}},  # from 1 m below the origin
)
# 3/2 J2 mu R^2/r^4 ((5 u^2 - 1) e - 2 u p), u = e.p: on the pole's axis and across it.
for at, wanted in (([0, 0, 5], [0, 0, -2 * (1 - 3 * 0.1 * 4 / 25)]),
                   ([5, 0, 0], [-2 * (1 + 1.5 * 0.1 * 4 / 25), 0, 0])):
    promise(
        "with the first term of a planet's flattening; the pole is z by default",
        gravity("j2", "mu = 50", "j2 = 0.1", "radius = 2")
        + body(FREE, f"initial = {{ position = {at} }}") + sensor("point", 'against = "inertial"'),
        {"start": {"s.acceleration": wanted}},
    )
EQUATOR = guide("earth", "latitude_deg = 0", "height = 1000", "azimuth_deg = 0")
STILL = body(FIXED) + sensor("accelerometer")
R = A + 1000
promise(
    "the point mass and J2 of WGS84",
    EQUATOR + gravity("earth", 'field = "j2"') + STILL,
    {"s": Near([-MU / R**2 * (1 + 1.5 * J2 * (A / R) ** 2) + EARTH**2 * R, 0, 0], 1e-9)},
)
for field in ((), ('field = "normal"',)):
    promise(
        '`"normal"` (default), as `gravity = "normal"` of the guide',
        guide("earth", "latitude_deg = 0", "height = 0", "azimuth_deg = 0")
        + gravity("earth", *field) + STILL, {"s": Near([-9.7803253359, 0, 0], 1e-9)},
    )
promise(
    "Without `[gravity]` the field is `gravity` of an `earth` or `course` guide, or `none`.",
    guide("earth", "latitude_deg = 0", "height = 0", "azimuth_deg = 0", "gravity = 9") + STILL,
    {"s": [-9, 0, 0]},
)
promise(
    "Without `[gravity]` the field is `gravity` of an `earth` or `course` guide, or `none`.",
    FALLING, {"s.acceleration": [0, 0, 0]},
)
for lines in ('kind = "uniform"', "vector = [0, 0, 1]"), ('kind = "earth"',), (
        'kind = "point"', "mu = 1"):
    promise(
        "A number there excludes any other field.",
        guide("earth", "latitude_deg = 0", "height = 0", "azimuth_deg = 0", "gravity = 9")
        + part("[gravity]", *lines) + STILL, "gives gravity a second time",
    )
# The torque 3 mu/r^3 e x (I e) on a body that is held 5 m from the centre.
HELD = body('joint = { kind = "fixed", position = [3, 0, 4] }', "inertia = [2, 3, 4]") + report(
    "reactions")
TORQUE = [3 * 50 / 125 * x for x in cross([-0.6, 0, -0.8], [-1.2, 0, -3.2])]
promise(
    "The torque about a point mass is 3 mu/r^3 e x (I e), e the unit vector to the body.",
    gravity("point", "mu = 50", "gradient = true") + HELD, {"a.torque": [-x for x in TORQUE]},
)
for lines, wanted in ((("mu = 50",), 0), (("mu = 50", "gradient = true"), TORQUE[1])):
    promise(
        "The default is `true` for `orbit` and `false` otherwise.",
        gravity("point", *lines) + HELD, {"a.torque y": -wanted},
    )
N2 = MU / 7e6**3  # the orbit's rate squared
for lines, wanted in (((), 3 * N2), (("gradient = false",), 0)):
    promise(
        "The default is `true` for `orbit` and `false` otherwise.",
        guide("orbit", "semi_major_axis = 7e6") + gravity("orbit", *lines)
        + body(BALL, "inertia = [2, 3, 4]",
               f"initial = {{ attitude = {quaternion('z', math.pi / 4)} }}")
        + sensor("gyro"),
        # e = (1, -1)/sqrt(2) on body axes, and the rate n of the orbit about z.
        lambda found, rows, w=wanted: [] if math.isclose(
            rows[1]["s.z"] - rows[0]["s.z"], w * -0.5 / 4 * rows[1]["t"], rel_tol=1e-4,
            abs_tol=1e-18) else [f"the rate changes by {rows[1]['s.z'] - rows[0]['s.z']}"],
    )
promise(
    "A body whose centre of mass is at the field's centre at the start is an error.",
    gravity("point", "mu = 50") + FALLING, "is at the centre of the field at the start",
)
# Radial and along the orbit: Clohessy and Wiltshire, to first order in 1 m of 7000 km.
N = math.sqrt(N2)
promise(
    "A body 1 m away keeps 12 digits of its position.",
    guide("orbit", "semi_major_axis = 7e6") + gravity("orbit")
    + body(FREE, "inertia = [1e-9, 1e-9, 1e-9]", "initial = { position = [0, 0, 1] }")
    + solve(1000, "output_times = [1000]"),
    {"a.z": Near(math.cos(1000 * N), 1e-12)},
)
promise(
    "Gravity `point` beside a guide of kind `orbit` is the same field, but keeps eight digits of the "
    "tide.",
    guide("orbit", "semi_major_axis = 7e6") + gravity("point", f"mu = {MU}")
    + body(FREE, "inertia = [1e-9, 1e-9, 1e-9]", "initial = { position = [0, 0, 1] }")
    + solve(1000, "output_times = [1000]", "tolerance = 1e-8"),
    {"a.z": Near(math.cos(1000 * N), 1e-8)},
)

promise("any, except `guide`", body(FIXED, name="guide"), "reserved")
promise("any, except `guide`", body(FIXED, name="inertial"), None)
promise('`"guide"` (default) or an earlier body; a rotor carries nothing',
        body(HINGE, 'rotor = { mode = "free", speed = 1 }') + body(FIXED, 'parent = "a"', name="b"),
        "can carry nothing")
for key, value in (("centre", "[0, 0, 0]"), ("parent", '"guide"'), ("drive", '"none"'),
                   ("hold", "false"), ("damping", "0"), ("load", "[]"), ("points", "{}")):
    promise("coordinates and rates at `t_begin`, see below; 0 by default",
            body(HINGE, f"{key} = {value}"), {"a.angle": 0, "a.rate": 0})
promise(
    "centre of mass from the joint, body axes; about the CENTRE OF MASS, 3 principal moments or 6 "
    "entries xx, yy, zz, xy, xz, yz of the matrix",
    body(HINGE, "mass = 2", "centre = [3, 0, 0]", "inertia = [1, 5, 6]", "force = 46"),
    {"a.rate": 46 / (5 + 2 * 9)},
)
promise(
    "centre of mass from the joint, body axes; about the CENTRE OF MASS, 3 principal moments or 6 "
    "entries xx, yy, zz, xy, xz, yz of the matrix",
    body('joint = { kind = "revolute", axis = [1, 2, 3] }', "inertia = [9, 8, 7, 1, 2, 0.5]",
         "force = 7"),
    # The moment about (1, 2, 3)/sqrt(14): the quadratic form of the matrix.
    {"a.rate": 7 / ((9 + 4 * 8 + 9 * 7 + 2 * (2 * 1 + 3 * 2 + 6 * 0.5)) / 14)},
)
promise("joint force -stiffness (q - rest)",
        body(HINGE, "spring = { stiffness = 4, rest = 0.5 }"),
        {"rows": {"a.angle": lambda t: 0.5 - 0.5 * math.cos(2 * t)}})
promise("joint force -damping q'", body(HINGE, "damping = 2", "initial = { rate = 3 }"),
        {"rows": {"a.rate": lambda t: 3 * math.exp(-2 * t)}})
promise("A ball joint has `damping` alone",
        body(BALL, "damping = 2", "initial = { angular_velocity = [1, 2, 3] }"),
        {"rows": {"a.wx": lambda t: math.exp(-2 * t), "a.wz": lambda t: 3 * math.exp(-2 * t)}})
for lines in ("spring = { stiffness = 1 }",), ("force = 1",):
    promise("A ball joint has `damping` alone", body(BALL, *lines), "needs a single coordinate")
promise("for a revolute body that is symmetric about its axis",
        body(HINGE, "inertia = [1, 1, 1.1]", 'rotor = { mode = "free", speed = 1 }'),
        "is not symmetric about its axis")
promise('`"constant-rate"` keeps the rate of a joint with one coordinate.',
        body(HINGE, 'drive = "constant-rate"', "damping = 2", "initial = { rate = 3 }"),
        {"rows": {"a.rate": lambda t: 3, "a.angle": lambda t: 3 * t},
         "json": {"final.joints.a.drive_torque": 6, "final.joints.a.drive_power": 18}})
promise("The force or torque and its power are reported.",
        body(SLIDE, "mass = 2", "drive = { displacement = { terms = [{ amplitude = 3, frequency = "
             "5 }] } }") + WEIGHT,
        {"json": {"final.joints.a.drive_torque": 2 * (10 - 75 * math.sin(5)),
                  "final.joints.a.drive_power": 2 * (10 - 75 * math.sin(5)) * 15 * math.cos(5)}})
promise("given joint force, constant or a", body(HINGE, "force = 2"), {"a.rate": 2, "a.angle": 1})
promise("`true` locks the joint",
        WEIGHT + body(HINGE, "centre = [1, 0, 0]", "hold = true", "initial = { angle = 0.5 }"),
        {"rows": {"a.angle": lambda t: 0.5, "a.rate": lambda t: 0}})
promise("points of the body by name, on its axes",
        body(HINGE, "points = { tip = [0, 0, 2] }", "initial = { angle = 0.5 }")
        + sensor("point", 'at = "tip"'), {"s.position": [2 * math.sin(0.5), 0, 2 * math.cos(0.5)]})

# A body that is held at a quarter turn, and the forces that hold it.
QUARTER = body('joint = { kind = "fixed", orientation = [0.7071067811865476, 0, 0, '
               "0.7071067811865476] }", "load = { %s }") + report("reactions") + TILTED
for axes, on_body in (("", [3, 0, 0]), (', axes = "body"', [3, 0, 0]),
                      (', axes = "guide"', [0, -3, 0]), (', axes = "inertial"', [0, 0, 3])):
    promise(
        "The force acts at `point` on body axes, the torque is about the body's origin; `axes` are "
        "`body` (default), `guide` or `inertial`",
        QUARTER % f"force = [3, 0, 0], point = [0, 1, 0]{axes}"
        + sensor("reaction", name="held"),
        {"held.force": [-x for x in on_body],
         "held.torque": [-x for x in cross([0, 1, 0], on_body)]},
    )

# Joints.
AT = sensor("point", "at = [1, 0, 0]") + sensor("point", "at = [0, 1, 0]", name="r")
promise("angle about `axis`", body(DISC, "initial = { angle = 0.5, rate = 2 }") + AT,
        {"start": {"s.position": [math.cos(0.5), math.sin(0.5), 0], "a.rate": 2}})
promise("displacement along `axis`",
        body('joint = { kind = "prismatic", axis = [0, 3, 4] }',
             "initial = { displacement = 5, rate = 2 }") + sensor("point"),
        {"start": {"s.position": [0, 3, 4], "s.velocity": [0, 1.2, 1.6]}})
promise("angles about `axis`, then about the rotated `second_axis`",
        body(UNIVERSAL, "initial = { angle = [0.5, 0.7], rate = [0, 2] }") + AT + sensor("gyro",
                                                                                     name="w"),
        {"start": {"r.position": turned("z", 0.5, turned("x", 0.7, [0, 1, 0])), "w": [2, 0, 0]}})
promise("angle about `axis`, displacement along it",
        body('joint = { kind = "cylindrical", axis = [0, 0, 2] }', "initial = { angle = 0.5, "
             "displacement = 3, rate = 2, velocity = 4 }") + AT,
        {"start": {"s.position": [math.cos(0.5), math.sin(0.5), 3],
                   "s.velocity": [-2 * math.sin(0.5), 2 * math.cos(0.5), 4]}})
promise("two displacements perpendicular to `axis`, angle about it",
        body('joint = { kind = "planar", axis = [0, 0, 1] }', "initial = { displacement = [3, 4], "
             "angle = 0.5, velocity = [5, 6], rate = 2 }") + AT,
        {"start": {"s.position": [3 + math.cos(0.5), 4 + math.sin(0.5), 0],
                   "s.velocity": [5 - 2 * math.sin(0.5), 6 + 2 * math.cos(0.5), 0]}})
promise("| `spherical` | attitude | `attitude`, `angular_velocity` |",
        body(BALL, f"initial = {{ attitude = {quaternion('z', 0.5)}, angular_velocity = [0, 0, 2] }}")
        + AT, {"start": {"s.position": [math.cos(0.5), math.sin(0.5), 0],
                         "s.velocity": [-2 * math.sin(0.5), 2 * math.cos(0.5), 0]}})
promise("| `fixed` | none | |", body(FIXED, "initial = { rate = 1 }"), "initial.rate: is no key here")
promise("attitude and position",
        body(FREE, f"initial = {{ attitude = {quaternion('z', 0.5)}, angular_velocity = [0, 0, 2], "
             "position = [3, 4, 5], velocity = [6, 7, 8] }") + AT,
        {"start": {"s.position": [3 + math.cos(0.5), 4 + math.sin(0.5), 5],
                   "s.velocity": [6 - 2 * math.sin(0.5), 7 + 2 * math.cos(0.5), 8]}})
promise("`position` (of the joint) and axes are on the parent's axes; `orientation` rotates the "
        "body's axes relative to the parent's.",
        body('joint = { kind = "fixed", orientation = [0.7071067811865476, 0, 0, '
             "0.7071067811865476] }")
        + body('joint = { kind = "prismatic", axis = [1, 0, 0], position = [2, 0, 0] }',
               'parent = "a"', "initial = { displacement = 3 }", name="b")
        + sensor("point", on="b"), {"s.position": [0, 5, 0]})
promise("Attitudes, positions and velocities are relative to the parent, angular velocities on "
        "body axes.",
        body(DISC, "initial = { rate = 2 }")
        + body(FREE, 'parent = "a"', f"initial = {{ attitude = {quaternion('x', math.pi / 2)}, "
               "angular_velocity = [0, 3, 0], position = [1, 0, 0], velocity = [4, 0, 0] }", name=
                   "b")
        + sensor("gyro", on="b", name="w") + sensor("point", on="b"),
        {"start": {"w": [0, 5, 0], "s.velocity": [4, 2, 0]}})
promise("A `screw` advances by `pitch` metres per RADIAN: 0.0008 for a thread of 5 mm per "
        "revolution, negative for a left-handed one.",
        body('joint = { kind = "screw", axis = [0, 0, 1], pitch = -0.5 }',
             "initial = { angle = 3, rate = 4 }") + sensor("point"),
        {"start": {"s.position": [0, 0, -1.5], "s.velocity": [0, 0, -2]}})


def planar(axis, *second):
    keys = "".join(f", second_axis = {a}" for a in second)
    return (body(f'joint = {{ kind = "planar", axis = {axis}{keys} }}',
                 "initial = { displacement = [2, 3], angle = 1 }") + sensor("point"))


for axis, first, second in (([1, 0, 0], [0, 1, 0], [0, 0, 1]), ([0, 1, 0], [0, 0, 1], [1, 0, 0]),
                            ([0, 0, 1], [1, 0, 0], [0, 1, 0]), ([0, 0, -1], [1, 0, 0], [0, -1, 0]),
                            ([4, 3, 0], [-0.6, 0.8, 0], [0, 0, 1])):
    promise(
        "Without that key an axis of the parent takes its part: the one that follows the axis "
        "nearest to `axis` in the order x, y, z, x. The second direction is `axis` times the "
        "first.",
        planar(axis), {"s.position": [2 * x + 3 * y for x, y in zip(first, second)]},
    )
promise("The first direction is the component of `second_axis` perpendicular to `axis`.",
        planar([0, 0, 1], [0, 5, 7]), {"s.position": [-3, 2, 0]})
promise("The displacements of a `planar` joint are along two directions of the parent, independent of "
        "the body's rotation.",
        body('joint = { kind = "planar", axis = [0, 0, 1] }',
             "initial = { angle = 2, rate = 7, velocity = [3, 0] }") + sensor("point"),
        {"rows": {"s.position x": lambda t: 3 * t, "s.position y": lambda t: 0}})
promise("Stiffness, damping and force of a displacement are in N/m, N s/m and N.",
        body(SLIDE, "mass = 2", 'spring = { stiffness = "8 N/m", rest = "1 m" }', 'damping = '
             '"0 N s/m"', 'force = "8 N"'), {"rows": {"a.displacement":
                                                      lambda t: 2 - 2 * math.cos(2 * t)}})

# A rotor on a carrier that turns about the same axis: moments of inertia 3 and 1.
CARRIER = body(DISC, "inertia = [3, 3, 3]", "force = 2") + body(
    DISC, 'parent = "a"', "rotor = { %s }", name="b")
promise("A free rotor keeps its cyclic momentum.", CARRIER % 'mode = "free", speed = 5',
        {"rows": {"a.rate": lambda t: 2 / 3 * t, "b.rate": lambda t: 5 - 2 / 3 * t}})
promise("A regulated rotor keeps its speed relative to its carrier, or follows a given one, by the "
        "necessary torque.", CARRIER % 'mode = "regulated", speed = 5',
        {"rows": {"a.rate": lambda t: t / 2, "b.rate": lambda t: 5}})
promise("A regulated rotor keeps its speed relative to its carrier, or follows a given one, by the "
        "necessary torque.", CARRIER % 'mode = "regulated", speed = { constant = 5, rate = 2 }',
        {"rows": {"a.rate": lambda t: 0 * t, "b.rate": lambda t: 5 + 2 * t}})
promise("`mode` of a rotor is `free`, `regulated` or `torque`.",
        CARRIER % 'mode = "torque", torque = 0.6, speed = 5',
        {"rows": {"a.rate": lambda t: 1.4 / 3 * t, "b.rate": lambda t: 5 + (0.6 - 1.4 / 3) * t}})

# Loads.
promise("-(L v + Q \\|v\\| v) at the point, and the torque -A w",
        body(FREE, "load = { kind = \"drag\", linear = [0.5, 0, 0], angular = [0, 0, 0.25] }",
             "initial = { velocity = [2, 3, 0], angular_velocity = [0, 0, 0] }"),
        {"rows": {"a.vx": lambda t: 2 * math.exp(-t / 2), "a.vy": lambda t: 3}})
promise("-(L v + Q \\|v\\| v) at the point, and the torque -A w",
        body(FREE, "load = { kind = \"drag\", quadratic = [0.5, 0.5, 0.5] }",
             "initial = { velocity = [2, 0, 0] }"), {"rows": {"a.vx": lambda t: 2 / (1 + t)}})
promise("v and w are the velocity of the point and the angular velocity relative to the guide",
        guide("rotating", "angular_velocity = [0, 0, 3]")
        + body(DISC, "load = { kind = \"drag\", angular = [0, 0, 2] }", "initial = { rate = 5 }"),
        {"rows": {"a.rate": lambda t: 5 * math.exp(-2 * t)}})
promise("The moment is on body axes, in A m^2; the field is on guide axes, in tesla",
        body(DISC, "load = { kind = \"magnet\", moment = [2, 0, 0], field = [0, 3, 0] }",
             "initial = { angle = 0.5 }") + sensor("point", "at = [1, 0, 0]"),
        # The angular acceleration m B cos(angle) moves the tip, beside its angle.
        {"start": {"s.acceleration": [-3 * math.sin(1), 6 * math.cos(0.5) ** 2, 0]}})
promise("A magnet in a constant field on a guide at rest keeps the energy, of which -m.B is a "
        "part.",
        body(DISC, "load = { kind = \"magnet\", moment = [2, 0, 0], field = [0, 3, 0] }",
             "initial = { angle = 0.5, rate = 2 }"),
        {"json": {"invariants.0.name": "energy",
                  "invariants.0.start": 2 - 6 * math.sin(0.5), "invariants.0.largest_drift": 0}})
