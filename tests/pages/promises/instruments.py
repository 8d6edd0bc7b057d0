"""Sentences on sensors and their errors."""

import math
import statistics

from promises.table import (
    BALL, DISC, FIXED, FREE, NEAR, WEIGHT, Near, body, cross, guide, named, part, promise,
    quaternion, sensor, solve, turned
)

# A body on a turning guide, a quarter turn about its own axis ahead, 2 m from the origin.
TURNING = guide("rotating", "angular_velocity = [0, 0, 3]")
HELD = body('joint = { kind = "fixed", position = [2, 0, 0], orientation = [0.7071067811865476, '
            "0, 0, 0.7071067811865476] }", "points = { tip = [1, 0, 0] }")
TILT = f"axes = {quaternion('x', math.pi / 2)}"

promise("inertial angular velocity, on the sensor's axes",
        TURNING + HELD + sensor("gyro", TILT), {"s": [0, 3, 0]})
# The acceleration w^2 r points to the axis; on the tilted axes y is the body's z.
promise("specific force at the point, on the sensor's axes: inertial acceleration minus "
        "gravitation",
        TURNING + WEIGHT + HELD + sensor("accelerometer", 'at = "tip"', TILT),
        {"s": [-9, 10, -18]})
promise("`at` is a point on the body's axes, numbers or a name in `points`, by default the body's "
        "origin. The reading of a gyro is the same at all points.",
        TURNING + HELD + sensor("accelerometer") + sensor("gyro", "at = [4, 5, 6]", name="w"),
        {"s": [0, 18, 0], "w": [0, 0, 3]})
MOVING = body(DISC, "initial = { rate = 2 }") + body(
    'joint = { kind = "prismatic", axis = [1, 0, 0] }', 'parent = "a"',
    "initial = { displacement = 1, rate = 4 }", name="b")
promise("position, velocity and acceleration of the point, observed from `against`, on the axes of "
        "`axes`",
        MOVING + sensor("point", 'against = "a"', on="b") + solve(1e-6, "output_step = 1e-6"),
        {"start": {"s": [1, 0, 0, 4, 0, 0, 1 * 4, 0, 0]}})  # centrifugal: w^2 r
promise("`against` is `\"guide\"` (default), `\"inertial\"` or the name of a body.",
        TURNING + HELD + sensor("point"), {"s": [2, 0, 0, 0, 0, 0, 0, 0, 0]})
promise("Velocity and acceleration are the derivatives in the frame `against`.",
        TURNING + HELD + sensor("point", 'against = "inertial"', 'axes = "guide"'),
        {"s": [2, 0, 0, 0, 6, 0, -18, 0, 0]})
promise("`axes` of a `point` takes the same names, by default that of `against`.",
        TURNING + HELD + sensor("point", 'axes = "a"'), {"s.position": [0, -2, 0]})
ATTITUDE = body(BALL, f"initial = {{ attitude = {quaternion('z', 4.0)} }}")
promise("a quaternion with w >= 0, or angles of rotation about z, the new y, the new x",
        ATTITUDE + sensor("attitude"), {"s": [-x for x in quaternion("z", 4.0)]})
promise("a quaternion with w >= 0, or angles of rotation about z, the new y, the new x",
        ATTITUDE + sensor("attitude", 'as = "yaw pitch roll"'), {"s": [4 - 2 * math.pi, 0, 0]})
promise("`as` is `\"quaternion\"` (default) or `\"yaw pitch roll\"`.",
        ATTITUDE + sensor("attitude", 'as = "quaternion"') + sensor("attitude", name="d"),
        lambda found, rows: [] if rows[0]["s.qz"] == rows[0]["d.qz"] else [f"{rows[0]}"])
promise("coordinates and rates of the joint of the body with this name", MOVING
        + sensor("joint", on="b"), {"start": {"s.displacement": 1, "s.rate": 4}})
LOADED = WEIGHT + body('joint = { kind = "fixed", position = [5, 0, 0], orientation = '
                       "[0.7071067811865476, 0, 0, 0.7071067811865476] }", "centre = [2, 0, 0]")
promise("force and torque about the point that the parent exerts on that body through the joint",
        LOADED + sensor("reaction") + sensor("reaction", "at = [3, 0, 0]", name="r"),
        {"s": [0, 0, 10, 0, -20, 0], "r": [0, 0, 10, 0, 10, 0]})
promise("`axes` of a `reaction` is one of those names, or a quaternion relative to the body, by "
        "default the body's axes.",
        LOADED + sensor("reaction", 'axes = "guide"') + sensor("reaction", TILT, name="r"),
        {"s": [0, 0, 10, 20, 0, 0], "r": [0, 10, 0, 0, 0, 20]})
SPRING = named("element", "e", "spring", 'between = ["a", "b"]', "at = [[0, 0, 0], [0, 0, 2]]",
               "stiffness = 3")
PULLED = HELD + body('joint = { kind = "fixed", position = [2, 0, 0] }', name="b") + SPRING
REACTION = ('element = "e"',)
promise("For an element or a constraint the body is the first one. `at` is a point of the second "
        "body, by default its own.",
        PULLED + sensor("reaction", *REACTION, on="")
        + sensor("reaction", *REACTION, "at = [1, 0, 2]", on="", name="r"),
        # About x, 1 m behind the line of the pull: (-1, 0, 0) x (0, 0, -6), on the turned axes.
        {"s": [0, 0, -6, 0, 0, 0], "r": [0, 0, -6, *turned("z", -math.pi / 2, [0, -6, 0])]})


def pendulum(down, swing):
    """It hangs along a vector of norm 1, and starts from rest in the direction of another one."""
    turn = [0.05 * x for x in cross(down, swing)]
    start = [math.sqrt(1 - 0.05**2), *turn]
    return body(BALL, f"centre = {down}", "inertia = [0.1, 0.1, 0.1]",
                f"initial = {{ attitude = {start} }}") + sensor("azimuth", f"at = {down}")


CLOCKWISE = ("It is clockwise from above, from the guide's z axis, or from its x axis if z is "
             "nearly vertical.")
X_DOWN = WEIGHT.replace("[0, 0, -10]", "[10, 0, 0]")
promise(CLOCKWISE, WEIGHT + pendulum([0, 0, -1], [math.cos(0.5), -math.sin(0.5), 0]),
        {"s": Near(0.5, 1e-9)})
# With x down and z to the north, the east is -y.
promise(CLOCKWISE, X_DOWN + pendulum([1, 0, 0], [0, -math.sin(0.5), math.cos(0.5)]),
        {"s": Near(0.5, 1e-9)})
promise("It lies within a right angle of that axis.",
        X_DOWN + pendulum([1, 0, 0], [0, -math.sin(2), math.cos(2)]),
        {"s": Near(2 - math.pi, 1e-9)})
# A quarter of a second: the plane falls back by 1e-5 rad at most.
promise("On the `earth`, also as the first link of a `chain`, the site's azimuth is added.",
        guide("earth", "latitude_deg = 50", "height = 0", "azimuth_deg = 20", "gravity = 10")
        + pendulum([1, 0, 0], [0, -math.sin(0.5), math.cos(0.5)]) + solve(0.25),
        {"s": Near(0.5 + math.pi / 9, 1e-4)})
promise("On the `earth`, also as the first link of a `chain`, the site's azimuth is added.",
        guide("chain", "links = [{ kind = 'earth', latitude_deg = 50, height = 0, azimuth_deg = "
                       "20, gravity = 10 }, { kind = 'inertial' }]")
        + pendulum([1, 0, 0], [0, -math.sin(0.5), math.cos(0.5)]) + solve(0.25),
        {"s": Near(0.5 + math.pi / 9, 1e-4)})
HANGING = WEIGHT + body(BALL, "centre = [0, 0, -1]") + sensor("azimuth", "at = [0, 0, -1]")
promise("direction of the plane in which the point of a pendulum swings",
        HANGING.replace(WEIGHT, ""), "needs [gravity]")
SITE = ["latitude_deg = 50", "height = 0", "azimuth_deg = 0", 'gravity = "normal"']
promise("On the `earth` an accelerometer at rest reads the gravity of its site upwards, "
        "centrifugal part included.", guide("earth", *SITE) + body(FIXED) + sensor("accelerometer"),
        {"s": Near([-9.7803253359 * (1 + 0.00193185265241 * math.sin(50 * math.pi / 180) ** 2)
                    / math.sqrt(1 - 0.00669437999014 * math.sin(50 * math.pi / 180) ** 2), 0, 0],
                   1e-9)})
promise("Gravitation is that at the instrument, not at the body's centre of mass.",
        part("[gravity]", 'kind = "point"', "mu = 50")
        + body('joint = { kind = "fixed", position = [5, 0, 0] }')
        + sensor("accelerometer", "at = [5, 0, 0]"), {"s": [50 / 100, 0, 0]})
promise("`name` is any that gives no column twice.",
        body(FREE) + sensor("gyro") + sensor("accelerometer"), "is used by an earlier sensor")
promise("`name` is any that gives no column twice.", body(FREE) + sensor("point", name="a"), None)

# Errors: the truth is (0, 0, 3) rad/s or (0, 18, 0) m/s^2.
SPUN = TURNING + HELD
promise("(1 + \\text{scale})\\, R(-\\text{misalignment})\\, \\text{truth} + \\text{bias}",
        SPUN + sensor("gyro", "misalignment = [0, 0.2, 0]", "scale = 0.5", "bias = 0.25"),
        {"s": [0.25 - 4.5 * math.sin(0.2), 0.25, 0.25 + 4.5 * math.cos(0.2), 0, 0, 3]})
promise("are the readings without errors",
        SPUN + sensor("gyro", "bias = [1, 2, 4]") + solve(1, "output_times = [1]"),
        {"s.true": [0, 0, 3], "json": {"final.sensors.s.true": [0, 0, 3],
                                       "final.sensors.s.value": [1, 2, 7]}})
promise("A single number applies to all three axes.",
        SPUN + sensor("gyro", "bias = 0.5", "scale = 0.25"),
        {"s": [0.5, 0.5, 4.25, 0, 0, 3]})
promise("The numbers of a gyro may be in degrees (`bias_deg`).",
        SPUN + sensor("gyro", "bias_deg = 90"), {"s": [math.pi / 2, math.pi / 2, 3 + math.pi / 2,
                                                       0, 0, 3]})
promise("rotation vector from the nominal to the real axes, rad",
        SPUN + sensor("gyro", "misalignment = [0.1, 0, 0]", "scale = [1, 0.5, 0]",
                      "bias = [0, 0, 2]"),
        {"s": [0, 1.5 * 3 * math.sin(0.1), 3 * math.cos(0.1) + 2, 0, 0, 3]})
promise("relative scale error, a number or three",
        SPUN + sensor("gyro", "scale = [0, 0, -0.5]"), {"s": [0, 0, 1.5, 0, 0, 3]})
promise("rounded to multiples of `resolution` and limited to `range`",
        SPUN + sensor("gyro", "resolution = 0.7") + sensor("accelerometer", "range = 16", name="f"),
        {"s": [0, 0, 2.8, 0, 0, 3], "f": [0, 16, 0, 0, 18, 0]})
promise("above 0; none by default", SPUN + sensor("gyro", "range = 0"), "must be above 0")
PERIOD = "period = 0.3"
promise("Without `output_step` and `output_times` they are the only rows, besides `t_end`.",
        SPUN + sensor("gyro", PERIOD), {"rows": {"t": [0, 0.3, 0.6, 0.9, 1]}})
promise("These times then are rows of the CSV file, too.",
        SPUN + sensor("gyro", PERIOD) + solve(1, "output_step = 0.5"),
        {"rows": {"t": [0, 0.3, 0.5, 0.6, 0.9, 1]}})
ACCELERATING = body(DISC, "force = 2")
promise("In rows between its samples a sensor keeps its reading.",
        ACCELERATING + sensor("gyro", PERIOD) + solve(1, "output_times = [0.5, 1]"),
        lambda found, rows: [] if {row["t"]: round(row["s.z"], 9) for row in rows}.items()
        >= {0.5: 0.6, 1.0: 1.8}.items() else [f"the readings are {[*map(dict, rows)]}"])


def errors(rows, name="s"):
    return [row[f"{name}.{axis}"] - row[f"{name}.true {axis}"] for row in rows for axis in "xyz"]


def deviates(wanted, of=errors):
    """The standard deviation, which itself deviates by 1/sqrt(2 n) of it."""
    def check(found, rows):
        values = of(rows)
        size = math.sqrt(statistics.fmean(x * x for x in values))
        if abs(size / wanted - 1) > 5 / math.sqrt(2 * len(values)):
            yield f"the deviation is {size}, not {wanted}, of {len(values)} values"
    return check


def steps(rows):
    return [row[f"s.{a}"] - last[f"s.{a}"] for last, row in zip(rows, rows[1:]) for a in "xyz"]


SAMPLES = body(FIXED) + solve(100)
promise("so that white noise has the standard deviation N/sqrt(`period`)",
        SAMPLES + sensor("gyro", "noise = 0.5", "period = 0.04"), deviates(0.5 / 0.2))
promise("density K of the steps of a random walk that begins at 0",
        SAMPLES + sensor("gyro", "drift = 0.5", "period = 0.04"), deviates(0.5 * 0.2, steps))
promise("density K of the steps of a random walk that begins at 0",
        SAMPLES + sensor("gyro", "drift = 0.5", "period = 0.04"), {"start": {"s": [0] * 6}})
# An exponentially correlated error changes by sigma sqrt(2 (1 - 1/e)) in its time.
promise("standard deviation, and the time in s after which the correlation is 1/e",
        SAMPLES + sensor("gyro", "correlation = { sigma = 0.5, time = 0.04 }", "period = 0.04"),
        deviates(0.5 * math.sqrt(2 * (1 - math.exp(-1))), steps))
promise('`"0.1 m/s^2/sqrt(Hz)"`', SAMPLES + sensor("accelerometer", 'noise = "0.5 m/s^2/sqrt(Hz)"',
                                                   "period = 0.04"), deviates(0.5 / 0.2))
NOISY = sensor("gyro", "noise = 0.5", "period = 0.25", "%s")


def same_noise(found, rows):
    if errors(rows, "s") == errors(rows, "r"):
        yield "two names have the same noise"
    if errors(rows, "s") == errors(rows, "q"):
        yield "two seeds have the same noise"


promise("Random numbers depend only on the seed, the name of the sensor and the index of the "
        "sample.",
        body(FIXED) + NOISY % "" + NOISY.replace('"s"', '"r"') % ""
        + NOISY.replace('"s"', '"q"') % "seed = 1", same_noise)
SEEN = []


def repeated(found, rows):
    SEEN.append(errors(rows)[:15])
    if any(max(abs(x - y) for x, y in zip(SEEN[0], seen)) > NEAR for seen in SEEN):
        yield "the noise depends on the scene"


for scene in (body(FIXED) + NOISY % "", body(FIXED) + NOISY % "seed = 0",
              body(DISC, "force = 1") + NOISY % "" + solve(2)):
    promise("Random numbers depend only on the seed, the name of the sensor and the index of the "
            "sample.", scene, repeated)
promise("integer, not negative; 0 by default", body(FIXED) + NOISY % "seed = -1",
        "must be a whole number, not below 0")

# Increments: a turn of 3 rad/s about z in 0.3 s, and the force 18 m/s^2 on axes that turn.
INCREMENTS = ("period = 0.25", "increments = true")
promise("They are in the row at the end of the period and 0 in all other rows.",
        SPUN + sensor("gyro", *INCREMENTS) + solve(0.5, "output_step = 0.125"),
        {"rows": {"s.dtheta z": [0, 0, 0.75, 0, 0.75]}})
promise("rotation vector, rad, from the attitude q at the beginning of the period to q "
        "exp(dtheta/2) at its end: coning is included",
        guide("motion", "angles = { yaw = { rate = 3 }, roll = 0.5 }") + body(FIXED)
        + sensor("gyro", *INCREMENTS),
        {"s": [0, 0.75 * math.sin(0.5), 0.75 * math.cos(0.5)]})
# On the axes at the beginning the force turns: the integral of 18 (-sin 3t, cos 3t).
promise("integral of the specific force, m/s, on the axes at the beginning of the period: "
        "sculling is included", SPUN + sensor("accelerometer", *INCREMENTS),
        {"s": [6 * (math.cos(0.75) - 1), 6 * math.sin(0.75), 0]})
promise("gives the integrals of the components on the rotating axes",
        SPUN + sensor("accelerometer", "period = 0.25", 'increments = "uncompensated"'),
        {"s": [0, 18 / 4, 0]})
promise("dtheta is the one nearest to the integral of the angular velocity.",
        SPUN + sensor("gyro", "period = 5", "increments = true") + solve(5), {"s": [0, 0, 15]})
promise("The errors of increments are those of the mean rate.",
        SPUN + sensor("gyro", *INCREMENTS, "bias = [0, 0, 2]", "scale = [0, 0, 1]"),
        {"s.dtheta": [0, 0, (2 * 3 + 2) / 4]})
promise("`resolution` is in rad or m/s, and what rounding leaves out is added to the next "
        "increment.",
        SPUN + sensor("gyro", *INCREMENTS, "resolution = 0.5"),
        {"rows": {"s.dtheta z": [0, 1, 0.5, 1, 0.5]}})  # sums 0.75, 1.5, 2.25, 3 in halves
promise("`final.sensors` of `--json` has the last increment.",
        SPUN + sensor("gyro", *INCREMENTS) + solve(1.1),
        {"json": {"final.sensors.s.dtheta": [0, 0, 0.75]}})
promise("Increments need the model `exact`.",
        body(DISC) + sensor("gyro", *INCREMENTS) + solve(1, 'model = "linear"'),
        "needs the model 'exact'")
promise("makes a `gyro` or an `accelerometer` with a `period` read integrals over each period",
        body(DISC) + sensor("gyro", "increments = true"), "needs 'period'")
promise("`axes` of a `gyro` and an `accelerometer` is a quaternion: the attitude of the sensor's "
        "axes relative to the body's, by default the same axes.",
        TURNING + HELD + sensor("accelerometer") + sensor("accelerometer", TILT, name="u"),
        {"s": [0, 18, 0], "u": [0, 0, -18]})
for bias, wanted in (("2", [2, 2, 5]), ("[1, 2, 3]", [1, 2, 6])):
    promise("| `bias` | a number or three |", SPUN + sensor("gyro", f"bias = {bias}"),
            {"s": [*wanted, 0, 0, 3]})
