"""Sentences on gravity."""

import math

from promises.table import (
    BALL, FIXED, FREE, WEIGHT, Near, body, cross, guide, log, part, promise, quaternion, report,
    sensor, solve
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
    "Without `[gravity]` the field is `gravity` of an `earth`, `course` or `rates` guide, or "
    "`none`.",
    guide("earth", "latitude_deg = 0", "height = 0", "azimuth_deg = 0", "gravity = 9") + STILL,
    {"s": [-9, 0, 0]},
)
promise(
    "Without `[gravity]` the field is `gravity` of an `earth`, `course` or `rates` guide, or "
    "`none`.",
    FALLING, {"s.acceleration": [0, 0, 0]},
)
LOG = log("t,wx,wy,wz,ax,ay,az", [(k / 4, 0, 0, 0, 0, 0, 9.75) for k in range(9)])
STRAPPED = guide("rates", 'file = "log.csv"', "gravity = [0, 0, -9.75]", "sigma = 0")
for field, wanted in (("", -9.75), (gravity("none"), 0)):
    promise(
        "Without `[gravity]` the field is `gravity` of an `earth`, `course` or `rates` guide, or "
        "`none`.",
        STRAPPED + field + FALLING, {"s.acceleration": [0, 0, wanted]}, files={"log.csv": LOG},
    )
for lines in ('kind = "uniform"', "vector = [0, 0, 1]"), ('kind = "earth"',), ('kind = "none"',), (
        'kind = "point"', "mu = 1"):
    promise(
        "A number there excludes any `[gravity]`.",
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
    "Gravity `point` beside a guide of kind `orbit` is the same field, but keeps eight digits of "
    "the tide.",
    guide("orbit", "semi_major_axis = 7e6") + gravity("point", f"mu = {MU}")
    + body(FREE, "inertia = [1e-9, 1e-9, 1e-9]", "initial = { position = [0, 0, 1] }")
    + solve(1000, "output_times = [1000]", "tolerance = 1e-8"),
    {"a.z": Near(math.cos(1000 * N), 1e-8)},
)


# A light mass at 1 m and a heavy one behind the centre of mass, 100 m from the field's centre. The
# greatest torque of third order has dP3/d(angle) = 2.066. Along the line P3 is 1.
def dumbbell(angle):
    masses = [(1.0, 1.0), (99.0, -1 / 99)]
    place = [100 * math.cos(angle), 100 * math.sin(angle), 0]
    force, torque = [0.0] * 3, 0.0
    for mass, x in masses:
        p = [place[0] + x, place[1], 0]
        pull = [-mass * y / math.hypot(*p) ** 3 for y in p]
        force = [a + b for a, b in zip(force, pull)]
        torque += x * pull[1]
    inertia = sum(mass * x * x for mass, x in masses)
    scene = (
        gravity("point", "mu = 1", "gradient = true")
        + body(f'joint = {{ kind = "fixed", position = {place} }}', "mass = 100",
               f"inertia = [0, {inertia}, {inertia}]") + report("reactions")
    )

    def check(found, rows):
        moment = sum(mass * abs(x) ** 3 for mass, x in masses)
        held = [rows[0][f"a.force {axis}"] for axis in "xyz"]
        left = [abs(rows[0]["a.torque z"] + torque) * 1e8 / moment,
                math.hypot(*(a + b for a, b in zip(held, force))) * 1e10 / moment]
        wanted = [2.066 * (angle > 0), 4 if angle == 0 else left[1]]
        # The next order adds a hundredth of 3.
        if any(abs(a - b) > 0.1 for a, b in zip(left, wanted)) or left[1] > 4.1:
            yield f"torque and force neglect {left}, not {wanted}"

    return scene, check


for angle in (0, math.acos(math.sqrt(11 / 15))):
    promise("The first neglected torque is at most 2.07 mu M3/r^4, the first neglected force 4 mu "
            "M3/r^5. M3 is the integral of |x|^3 dm.", *dumbbell(angle))
# -3 mu/(2 r^4) ((tr I - 5 e.I e) e + 2 I e), and -mu m/r^2 e; e.I e = 3.28.
E0, IE = [0.6, 0, 0.8], [1.2, 0, 3.2]
FORCE = [-50 / 25 * e - 1.5 * 50 / 625 * ((9 - 5 * 3.28) * e + 2 * i) for e, i in zip(E0, IE)]
promise("`gradient` adds the terms of second order in a body's size, force and torque.",
        gravity("point", "mu = 50", "gradient = true") + HELD, {"a.force": [-x for x in FORCE]})
promise("Both vanish for a body that is symmetric about its centre of mass.",
        gravity("point", "mu = 50", "gradient = true") + HELD.replace("[2, 3, 4]", "[3, 3, 3]"),
        {"a.force": [50 / 25 * e for e in E0], "a.torque": [0, 0, 0]})
