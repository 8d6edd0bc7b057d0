"""Sentences on bodies and loads."""

import math

from promises.table import (
    BALL, DISC, FIXED, FREE, HINGE, SLIDE, UNIVERSAL, WEIGHT, body, cross, guide, promise,
    quaternion, report, sensor, turned
)

TILTED = guide("rotating", "angular_velocity = [0, 0, 0]",
               f"attitude = {quaternion('y', math.pi / 2)}")


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
        body(BALL, f"initial = {{ attitude = {quaternion('z', 0.5)}, "
             "angular_velocity = [0, 0, 2] }")
        + AT, {"start": {"s.position": [math.cos(0.5), math.sin(0.5), 0],
                         "s.velocity": [-2 * math.sin(0.5), 2 * math.cos(0.5), 0]}})
promise("| `fixed` | none | |", body(FIXED, "initial = { rate = 1 }"),
    "initial.rate: is no key here")
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
promise("The displacements of a `planar` joint are along two directions of the parent, "
        "independent of the body's rotation.",
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
promise("An unbalanced or unsymmetric wheel is an ordinary body, with `drive` if its speed is "
        "constant.",
        body(DISC, "centre = [1, 0, 0]", "inertia = [1, 2, 3]", 'drive = "constant-rate"',
             "initial = { rate = 3 }") + report("reactions"), {"a.force": [-9, 0, 0]})
promise("With `axis` along z they are x and y of the parent.", planar([0, 0, 1]),
        {"s.position": [2, 3, 0]})
for kind in ("", 'kind = "force", '):
    promise("| `force` (default) |",
            body(FREE, f"load = {{ {kind}force = [0, 2, 0], point = [3, 0, 0] }}"),
            {"json": {"final.joints.a.angular_velocity.2": 6}})
