"""Sentences on controllers and on the columns of the output."""

import math

from promises.table import (
    BALL, DISC, FREE, SLIDE, WEIGHT, Near, body, named, part, promise, sensor, solve
)


def controller(law, *lines, reads='["s.rate"]', drives='["a"]', name="c"):
    return part("[[controller]]", f'name = "{name}"', f"reads = {reads}", f"drives = {drives}",
                f"law = {{ {law} }}", *lines)


def pid(*keys):
    return 'kind = "pid", ' + ", ".join(keys)


def space(*keys):
    return 'kind = "state-space", ' + ", ".join(keys)


WHEEL = body(DISC, "initial = { angle = 2, rate = 3 }") + sensor("joint")
P = pid("proportional = 4")
# A clamped joint: what the law reads is a function of the time, and not changed by its output.
CLOCK = body(DISC, "drive = { angle = { rate = 3 } }") + sensor("joint") + body(
    SLIDE, name="b")
TO_B = {"reads": '["s.angle"]', "drives": '["b"]'}

promise("The input of every law is the error `e = reference - reading`, one number for each "
        "reading.",
        CLOCK + controller(P, "reference = 5", **TO_B),
        {"rows": {"c.b": lambda t: 4 * (5 - 3 * t)},
         "json": {"final.sensors.c.value": 4 * (5 - 3)}})
promise("for several readings a list; 0 by default",
        CLOCK + controller(space("D = [[1, 10]]"), "reference = [5, { rate = 2 }]",
                           reads='["s.angle", "s.rate"]', drives='["b"]'),
        {"rows": {"c.b": lambda t: 5 - 3 * t + 10 * (2 * t - 3)}})
promise("columns of sensors, or names of sensors: all their columns.",
        CLOCK + controller(space("D = [[1, 10]]"), reads='["s"]', drives='["b"]'),
        {"rows": {"c.b": lambda t: -3 * t - 30}})
promise("For a pid the name of a `joint` sensor stands for its coordinates, that of a `point` "
        "for its position", CLOCK + controller(P, reads='["s"]', drives='["b"]'),
        {"rows": {"c.b": lambda t: -12 * t}})
promise("For a pid the name of a `joint` sensor stands for its coordinates, that of a `point` "
        "for its position", body(FREE, "initial = { position = [1, 2, 3] }") + sensor("point")
        + controller(P, reads='["s"]', drives='["load.a.force.x", "load.a.force.y", '
                                              '"load.a.force.z"]'),
        {"start": {"c": [-4, -8, -12], "s.acceleration": [-4, -8, -12]}})
promise("a further force of the body's joint, one for each rate. A rotor needs `mode = \"torque\"`",
        body(DISC, "initial = { rate = 3 }", "force = 2") + sensor("joint") + controller(P),
        {"rows": {"a.rate": lambda t: 0.5 + 2.5 * math.exp(-4 * t)}})
for mode, reason in (('"torque", torque = 0', None), ('"free", speed = 3', "'a'"),
                     ('"regulated", speed = 3', "'a'")):
    promise("a further force of the body's joint, one for each rate. A rotor needs `mode = "
            "\"torque\"`", body(DISC, f"rotor = {{ mode = {mode} }}") + sensor("joint")
            + controller(P), reason)
TWO = body('joint = { kind = "cylindrical", axis = [0, 0, 1] }', "initial = { angle = 1, "
           "displacement = 2 }") + sensor("joint")
promise("`BODY`, with several rates `BODY.1`, `BODY.2`, ..",
        TWO + controller(P, reads='["s"]'), {"start": {"c.a.1": -4, "c.a.2": -8}})
promise("one of these forces", TWO + controller(P, reads='["s.displacement"]',
                                                drives='["joint.a.2"]'),
        {"rows": {"a.displacement": lambda t: 2 * math.cos(2 * t), "a.angle": lambda t: 1},
         "start": {"c.a.2": -8}})
promise("a further load on the body, on its axes about its origin",
        body(FREE, "centre = [1, 0, 0]", "inertia = [1, 1, 1]",
             "initial = { attitude = [0.7071067811865476, 0, 0, 0.7071067811865476] }")
        + sensor("point", "at = [1, 0, 0]") + sensor("gyro", name="w")
        + controller(space("A = [[0]]", "B = [[0]]", "C = [[1]]", "D = [[0]]", "initial = [6]"),
                     reads='["w.x"]', drives='["load.a.force.x"]'),
        # 6 N along the body's x through its centre of mass, y of the guide.
        {"start": {"s.acceleration": [0, 6, 0]}, "rows": {"c.a.force.x": lambda t: 6}})
WINCH = body(SLIDE, "initial = { displacement = -2 }") + named(
    "element", "e", "rope", 'between = ["guide", "a"]', "stiffness = 5", "length = 1", "%s"
) + sensor("point") + sensor("joint", name="j")
promise("a length in m that a winch pays out, in addition to the rope's `length`",
        WINCH % "" + controller(pid("proportional = 0.25"), reads='["j.displacement"]',
                                drives='["e"]'),
        {"start": {"c.e": 0.5, "s.acceleration z": 5 * (2 - 1.5)}})
promise("The law of a rope with `damping` needs a `period`.",
        WINCH % "damping = 1" + controller(P, reads='["j.displacement"]', drives='["e"]'), "period")
promise("To control a speed, give the rotor `mode = \"torque\"` and a controller that reads its "
        "rate",
        body(DISC, 'rotor = { mode = "torque", torque = 0, speed = 3 }') + sensor("joint")
        + controller(P, "reference = 5"),
        {"rows": {"a.rate": lambda t: 5 - 2 * math.exp(-4 * t)}})

# The laws on e = 5 - 3 t.
promise("Continuous: s' = e, and d = (e - f)/`filter` with f' = d.",
        CLOCK + controller(pid("proportional = 4", "integral = 2", "derivative = 0.5",
                               "filter = 0.25"), "reference = 5", **TO_B),
        # f follows from 0: f = 5 - 3 t + 0.75 - 5.75 exp(-4 t).
        {"rows": {"c.b": lambda t: 4 * (5 - 3 * t) + 2 * (5 * t - 1.5 * t * t)
                  + 0.5 * (5.75 * math.exp(-4 * t) - 0.75) * 4}})
promise("A `derivative` needs a `filter`, a time constant in s.",
        CLOCK + controller(pid("derivative = 1"), **TO_B), "filter")
STEP = 0.125
TIMES = [k * STEP for k in range(9)]


def sampled(smooth):
    """The outputs at the samples: s, d and e as on the page; d begins with 0, as e before."""
    outputs, s, d, last = [], 0, 0, 0
    for t in TIMES:
        e = 5 - 3 * t
        s += STEP * e
        d = smooth * d + (1 - smooth) * (e - last) / STEP
        outputs.append(4 * e + 2 * s + 0.5 * d)
        last = e
    return outputs


SAMPLED = solve(1, f"output_step = {STEP}")
WITH_FILTER = ("Sampled with the period T: s_k = s_k-1 + T e_k, and d_k = a d_k-1 + (1 - a) (e_k - "
               "e_k-1)/T with a = exp(-T/`filter`).")
for filtered, smooth in (("filter = 0.25", math.exp(-STEP / 0.25)), ("", 0)):
    promise(WITH_FILTER if filtered else "Without `filter` it is the difference quotient.",
            CLOCK + controller(pid(*filter(None, ["proportional = 4", "integral = 2",
                                                  "derivative = 0.5", filtered])),
                               "reference = 5", f"period = {STEP}", **TO_B) + SAMPLED,
            {"rows": {"c.b": sampled(smooth)}})
promise("x' = A x + B e, u = C x + D e; sampled x_k+1 = A x_k + B e_k, u_k = C x_k + D e_k",
        CLOCK + controller(space("A = [[-2]]", "B = [[3]]", "C = [[4]]", "D = [[5]]",
                                 "initial = [6]"), "reference = { rate = 4 }", **TO_B),
        # e = t: x = 3 (t/2 - 1/4) + (6 + 3/4) exp(-2 t).
        {"rows": {"c.b": lambda t: 4 * (1.5 * t - 0.75 + 6.75 * math.exp(-2 * t)) + 5 * t}})


def discrete():
    outputs, x = [], 6
    for t in TIMES:
        outputs.append(4 * x + 5 * t)
        x = 0.5 * x + 3 * t
    return outputs


promise("x' = A x + B e, u = C x + D e; sampled x_k+1 = A x_k + B e_k, u_k = C x_k + D e_k",
        CLOCK + controller(space("A = [[0.5]]", "B = [[3]]", "C = [[4]]", "D = [[5]]",
                                 "initial = [6]"), "reference = { rate = 4 }", f"period = {STEP}",
                           **TO_B) + SAMPLED, {"rows": {"c.b": discrete()}})
promise("Matrices are lists of rows. `A`, `B` and `C` may be left out: the law is then `D` alone.",
        CLOCK + controller(space("D = [[5]]"), **TO_B), {"rows": {"c.b": lambda t: -15 * t}})


# The output reaches its limit of 1 to a step of I T e <= 0.25. It comes down with the first e < 0.
def stays_near_its_limit(found, rows):
    for last, row in zip(rows, rows[1:]):
        e = 5 - 3 * row["t"]
        if not 0.75 <= row["c.b"] <= 1 and 0.75 <= row["t"] and e > 0:
            yield f"the output is {row['c.b']} at t = {row['t']}"
        if e < 0 and abs(row["c.b"] - last["c.b"] - 0.4 * STEP * e) > 1e-12:
            yield f"the output goes from {last['c.b']} to {row['c.b']} at t = {row['t']}"


promise("The integral part s I of a pid does not drive an output beyond its limit. In that "
        "direction s grows until the output is at the limit.",
        CLOCK + controller(pid("integral = 0.4"), "reference = 5", "limit = 1", f"period = {STEP}",
                           **TO_B) + solve(2.5, f"output_step = {STEP}"), stays_near_its_limit)
promise("The integral part s I of a pid does not drive an output beyond its limit. In that "
        "direction s grows until the output is at the limit.",
        CLOCK + controller(pid("integral = 2"), "reference = 5", "limit = 1", **TO_B)
        + solve(2, "output_step = 0.125", "tolerance = 1e-10"),
        # Continuous: 2 s = 1 at 0.1 s, and e changes its sign at 5/3 s; s fades out at 1 + 1e-6.
        {"rows": {"c.b": Near(lambda t: min(1, 2 * (5 * t - 1.5 * t * t)) if t < 0.2 else
                              1 - 3 * max(0, t - 5 / 3) ** 2, 1.1e-6)}})
promise("the greatest size of the outputs, a number or one for each",
        CLOCK + controller(P, "reference = 5", "limit = 2", **TO_B),
        {"rows": {"c.b": lambda t: max(-2, min(2, 4 * (5 - 3 * t)))}})
promise("samples at `t_begin` and at multiples of the period after it; outputs are held in "
        "between.",
        CLOCK + controller(P, "period = 0.25", **TO_B)
        + solve(1.1, "t_begin = 0.1", "output_times = [0.1, 0.2, 0.3, 0.4, 1.0, 1.1]"),
        {"rows": {"c.b": [-12 * t for t in (0.1, 0.1, 0.1, 0.35, 0.85, 1.1)]}})
promise("s, from a sample to its output; needs `period`",
        CLOCK + controller(P, "period = 0.25", "delay = 0.1", **TO_B)
        + solve(1, "output_times = [0, 0.3, 0.4, 0.55, 0.65]"),
        {"rows": {"c.b": [0, 0, -3, -3, -6]}})
promise("s, from a sample to its output; needs `period`",
        CLOCK + controller(P, "delay = 0.1", **TO_B), "period")

promise("Speeds of regulated rotors follow their `speed` alone.",
        body(DISC, 'rotor = { mode = "regulated", speed = 3 }') + sensor("joint") + controller(P),
            "'a'")
promise("Yaw and roll that a controller reads jump by 2 pi at +-pi.",
        CLOCK + sensor("attitude", 'as = "yaw pitch roll"', name="y")
        + controller(P, reads='["y.yaw"]', drives='["b"]') + solve(2,
            "output_times = [0, 1, 1.5, 2]",
                                                                   "tolerance = 1e-9"),
        {"rows": {"c.b": Near([0, -12, -4 * (4.5 - 2 * math.pi), -4 * (6 - 2 * math.pi)], 1e-8)}})

BIASED = body(FREE, "initial = { angular_velocity = [0, 0, 3] }") + sensor("gyro", "bias = 1")
promise("Controllers read true values: of an instrument with errors the columns `true x` ..",
        BIASED + controller(P, reads='["s.true z"]', drives='["load.a.torque.z"]'),
        {"rows": {"a.wz": lambda t: 3 * math.exp(-4 * t)}})
promise("Controllers read true values: of an instrument with errors the columns `true x` ..",
        BIASED + controller(P, reads='["s.z"]', drives='["load.a.torque.z"]'), "true")
for kind, keys, column in (("gyro", ("period = 0.1", "increments = true"), "s.dtheta x"),
                           ("reaction", (), "s.torque x"), ("azimuth", ("at = [0, 0, -1]",),
                                                            "s.azimuth")):
    promise("They cannot read increments, reactions and azimuths.",
            WEIGHT + body(BALL, "centre = [0, 0, -1]") + sensor(kind, *keys)
            + controller(P, "period = 0.1", reads=f'["{column}"]', drives='["load.a.torque.x"]'),
            "controller 'c'.reads")
FELT = body(SLIDE) + sensor("accelerometer")
for law, keys, reason in ((P, (), "accelerations"), (P, ("period = 0.1",), None),
                          (space("A = [[-1]]", "B = [[1]]", "C = [[1]]", "D = [[0]]"), (), None)):
    promise("An output that depends at once on a reading of accelerations would change this "
            "reading; it needs a `period`, or `D = 0`.", FELT + controller(law, *keys, reads=
                '["s.z"]'),
            reason)
for period, reason in (("0.2", None), ("0.25", "period"), ("0.05", "period"), ("", "period")):
    promise("A sensor with a `period` may be read by a controller with a multiple of that period.",
            body(DISC) + sensor("joint", "period = 0.1")
            + controller(P, f"period = {period}" if period else ""), reason)
promise("Controllers need the model `exact`, or without a `period` also `small`, and have no "
        "Taylor series.", WHEEL + controller(P),
        lambda found, rows: ["taylor"] if found["method"] == "taylor" else [])
for model, period, reason in (("small", "", None), ("small", "period = 0.1", "model"),
                              ("linear", "", "model")):
    promise("Controllers need the model `exact`, or without a `period` also `small`, and have no "
            "Taylor series.", body(DISC) + sensor("joint") + controller(P, period)
            + solve(1, f'model = "{model}"'), reason)
promise("After the joints a row of the CSV file has the memory of the controllers, columns "
        "`memory.NAME state 1`", CLOCK + controller(pid("integral = 2"), "reference = 5", **TO_B),
        lambda found, rows: [] if list(rows[0])[5] == "memory.c state 1" else [f"{[*rows[0]]}"])
promise("A row at the time of a sample has the memory before it and the outputs after it.",
        CLOCK + controller(space("A = [[1]]", "B = [[1]]", "C = [[0]]", "D = [[1]]"),
                           "reference = 5", "period = 0.25", **TO_B)
        + solve(0.5, "output_step = 0.25"),
        {"rows": {"memory.c state 1": [0, 5, 5 + 4.25], "c.b": [5, 5 - 0.75, 5 - 1.5]}})
promise("They are in `final.sensors` of `--json`", CLOCK + controller(P, **TO_B),
        {"json": {"final.sensors.c.value": -12}})

# Columns.
OUTPUT = body(FREE) + sensor("point")
for words, wanted in (('"s.position", "a.qw"', "t,s.position x,s.position y,s.position z,a.qw"),
                      ('"a.x", "s"', "t,a.x,s.position x,s.position y,s.position z,s.velocity x,"
                       "s.velocity y,s.velocity z,s.acceleration x,s.acceleration y,"
                       "s.acceleration z")):
    promise('`columns = ["rotor.angle", "tip.position", ..]` '
            "chooses the columns of `simulate --csv` after `t`, in this order. A word is a "
            "column, or selects all columns whose names continue after it with a dot or a blank.",
            OUTPUT + part("[output]", f"columns = [{words}]"),
            lambda found, rows, w=wanted: [] if ",".join(rows[0]) == w else [",".join(rows[0])])
promise("The default is all columns of the joints, of the reported reactions and of the sensors.",
        body(DISC) + sensor("gyro") + part("[report]", "reactions = true"),
        lambda found, rows: [] if [*rows[0]] == [
            "t", "a.angle", "a.rate", *(f"a.{w} {x}" for w in ("force", "torque") for x in "xyz"),
            "a.drive torque", "s.x", "s.y", "s.z"] else [f"{[*rows[0]]}"])
promise("Its outputs are columns `NAME.OUTPUT` of the CSV file.",
        CLOCK + controller(P, name="my law", **TO_B), {"rows": {"my law.b": lambda t: -12 * t}})
promise("u = P e + I s + D d, one reading for each output",
        CLOCK + controller(P, reads='["s.angle", "s.rate"]', drives='["b"]'),
        "one reading for each")
promise("All memory begins with 0, or with `initial`.",
        CLOCK + controller(pid("integral = 1"), **TO_B)
        + controller(space("A = [[0]]", "B = [[0]]", "C = [[1]]", "D = [[0]]", "initial = [7]"),
                     reads='["s.angle"]', drives='["load.b.torque.x"]', name="x"),
        {"start": {"memory.c": 0, "memory.x": 7, "x": 7}})
