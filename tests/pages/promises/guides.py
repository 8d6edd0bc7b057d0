"""Sentences on guides and functions of time."""

import math

from promises.table import (
    FIXED, HINGE, NEAR, Near, body, cross, guide, log, part, promise, quaternion, sensor, solve,
    turned
)

# An instrument of each kind at the guide's origin.
STRAPPED = (
    body(FIXED) + sensor("gyro", name="w") + sensor("accelerometer", name="f")
    + sensor("point", 'against = "inertial"', name="p")
    + sensor("attitude", 'against = "inertial"', 'as = "yaw pitch roll"', name="q")
)
EARTH = 7.292115e-5  # rad/s
A, E2 = 6378137.0, 0.00669437999014  # of WGS84
J2 = 0.484166774985e-3 * math.sqrt(5)
MU = 3.986004418e14
S, C = math.sin(50 * math.pi / 180), math.cos(50 * math.pi / 180)
N50 = A / math.sqrt(1 - E2 * S * S)
SITE = ["latitude_deg = 50", "height = 0"]


promise(
    "Without `[guide]` the frame is at rest.", STRAPPED,
    {"w": [0, 0, 0], "f": [0, 0, 0],
     "p.position": [0, 0, 0], "q.yaw": 0},
)
promise("| `inertial` | | none |", guide("inertial") + STRAPPED,
        {"w": [0, 0, 0], "f": [0, 0, 0], "p.position": [0, 0, 0]})
promise(
    "both constant on guide axes; the acceleration of the origin is inertial",
    guide("rotating", "angular_velocity = [0, 0, 2]", "origin_acceleration = [3, 4, 5]") + STRAPPED,
    {"rows": {"w.z": lambda t: 2, "f.x": lambda t: 3, "f.y": lambda t: 4, "f.z": lambda t: 5}},
)
# The origin goes straight on, and the attitude of 0.5 rad is that at t = 0, not that at t_begin.
promise(
    "the start is `attitude`, `origin_position` and `origin_velocity` at t = 0, relative to the "
    "previous frame and on its axes, whatever `t_begin` is",
    guide("rotating", "angular_velocity = [0, 0, 0.25]", f"attitude = {quaternion('z', 0.5)}",
          "origin_position = [1, 2, 3]", "origin_velocity = [4, 5, 6]")
    + STRAPPED + solve(3, "t_begin = 2"),
    {"rows": {"q.yaw": lambda t: 0.5 + 0.25 * t, "p.position x": lambda t: 1 + 4 * t,
              "p.position y": lambda t: 2 + 5 * t, "p.position z": lambda t: 3 + 6 * t}},
)
promise(
    "All are 0 by default.",
    guide("rotating", "angular_velocity = [0, 0, 0]") + STRAPPED,
    {"q.yaw": 0, "p.position": [0, 0, 0],
     "p.velocity": [0, 0, 0]},
)
promise(
    "constant + sum of amplitude sin(w t + p), on guide axes",
    guide("harmonic", "origin_acceleration = { constant = [1, 0, 0], terms = ["
          "{ amplitude = [2, 0, 0], frequency = 3, phase = 0.4 }, "
          "{ amplitude = [0, 5, 0], frequency = 6 }] }",
          "angular_velocity = { constant = [0, 0, 1], terms = ["
          "{ amplitude = [0, 0, 7], frequency = 8, phase = 0.9 }] }") + STRAPPED,
    {"rows": {"f.x": lambda t: 1 + 2 * math.sin(3 * t + 0.4), "f.y": lambda t: 5 * math.sin(6 * t),
              "w.z": lambda t: 1 + 7 * math.sin(8 * t + 0.9)}},
)


# A vector on the body's axes, seen from outside: turned by roll, then pitch, then yaw.
def motion_turns(found, rows):
    for row in rows:
        yaw, pitch, roll = 0.3 + 0.2 * row["t"], -0.4, 0.5 * math.sin(2 * row["t"])
        tip = [0.1, 0.2, 0.3]
        for axis, angle in (("x", roll), ("y", pitch), ("z", yaw)):
            tip = turned(axis, angle, tip)
        seen = [row[f"p.position {axis}"] for axis in "xyz"]
        if math.dist(seen, [tip[0] + 1, tip[1], tip[2] + 2 * row["t"]]) > NEAR:
            yield f"the tip is at {seen}, not at {tip}, at t = {row['t']}"


promise(
    "rotated about z by yaw, about the new y by pitch, about the new x by roll",
    guide("motion", "position = { constant = [1, 0, 0], rate = [0, 0, 2] }",
          "angles = { yaw = { constant = 0.3, rate = 0.2 }, pitch = -0.4,"
          " roll = { terms = [{ amplitude = 0.5, frequency = 2 }] } }")
    + body(FIXED) + sensor("point", 'against = "inertial"', "at = [0.1, 0.2, 0.3]", name="p"),
    motion_turns,
)
promise(
    "`position` is on the axes of the previous frame.",
    guide("chain", f"links = [{{ kind = \"rotating\", angular_velocity = [0, 0, 0], "
          f"attitude = {quaternion('z', math.pi / 2)} }}, "
          "{ kind = \"motion\", position = [1, 0, 0], angles = { yaw = 2 } }]") + STRAPPED,
    {"p.position": [0, 1, 0], "q.yaw": 2 + math.pi / 2 - 2 * math.pi},
)

# Clockwise from north: z = north cos + east sin, and y = z times down.
for azimuth in (0, 0.5, -1.5):
    promise(
        "local level at a site of the rotating earth: x down, z horizontal at the azimuth, "
        "counted from north through east; y completes them",
        guide("earth", *SITE, f"azimuth_deg = {azimuth * 180 / math.pi!r}") + STRAPPED,
        {"w": Near([-EARTH * S, EARTH * C * math.sin(azimuth),
                                  EARTH * C * math.cos(azimuth)], 1e-18)},
    )
# Without gravitation an accelerometer reads the way around the earth's axis.
promise(
    '`gravity` is `"normal"`, a number in m/s^2, or `"none"`, the default.',
    guide("earth", *SITE, "azimuth_deg = 0") + STRAPPED,
    {"f": [EARTH**2 * N50 * C * C, 0, EARTH**2 * N50 * C * S]},
)
promise(
    "`rate` is the earth's rate of rotation by default.",
    guide("earth", *SITE, "azimuth_deg = 90", "rate = 0") + STRAPPED,
    {"w": [0, 0, 0], "f": [0, 0, 0]},
)
# Somigliana's formula for the gravity on the ellipsoid; its constants have 11 digits.
promise(
    '`"normal"` is the gravitation of the WGS84 ellipsoid at every body; the centrifugal part '
    "comes from the guide's motion.",
    guide("earth", *SITE, "azimuth_deg = 0", 'gravity = "normal"') + STRAPPED,
    {"f": Near([-9.7803253359 * (1 + 0.00193185265241 * S * S)
                              / math.sqrt(1 - E2 * S * S), 0, 0], 1e-9)},
)
# The centrifugal part is that at the origin; another place differs by W x (W x r).
PLACE = [-1e5, 2e5, 3e5]
SPIN = [-EARTH * S, 0, EARTH * C]
promise(
    "A number includes the centrifugal part at the origin. The gravitation without it is the same "
    "for all bodies.",
    guide("earth", *SITE, "azimuth_deg = 0", "gravity = 9.75") + STRAPPED
    + body(f'joint = {{ kind = "fixed", position = {PLACE} }}', name="b")
    + sensor("accelerometer", name="g", on="b"),
    {"f": [-9.75, 0, 0],
     "g": [x + y for x, y in zip([-9.75, 0, 0], cross(SPIN, cross(SPIN, PLACE)))]},
)
promise(
    "The latitude is then that of the plumb line.",
    guide("earth", *SITE, "azimuth_deg = 0", "gravity = 9.75")
    + body(HINGE, "centre = [1, 0, 0]") + sensor("accelerometer", "at = [1, 0, 0]"),
    {"a.angle": Near(0, 1e-8), "s": Near([-9.75, 0, 0], 1e-7)},  # 1 m of W^2
)


# A Kepler orbit from its elements.
def on_orbit(along, node=0.4, inclination=1.1, perigee=0.7):
    for axis, angle in (("z", perigee), ("x", inclination), ("z", node)):
        along = turned(axis, angle, along)
    return along


ELEMENTS = ["semi_major_axis = 8e6", "eccentricity = 0.1"]
PLANE = ["inclination = 1.1", "node = 0.4", "perigee = 0.7", "anomaly = 0.9"]
RADIUS = 8e6 * (1 - 0.01) / (1 + 0.1 * math.cos(0.9))
SPEED = math.sqrt(MU / (8e6 * (1 - 0.01)))
promise(
    "the elements refer to inertial axes at the planet's centre, z to its pole",
    guide("orbit", *ELEMENTS, *PLANE) + STRAPPED,
    {"start": {"p.position": on_orbit([RADIUS * math.cos(0.9), RADIUS * math.sin(0.9), 0]),
               "p.velocity": on_orbit([-SPEED * math.sin(0.9), SPEED * (0.1 + math.cos(0.9)), 0])}},
)
promise(
    "x outwards along the radius, z along the orbit's normal, y completes them",
    guide("orbit", *ELEMENTS, *PLANE) + body(FIXED)
    + "".join(sensor("point", f"at = {at}", 'against = "inertial"', name=name)
              for name, at in (("x", [1e6, 0, 0]), ("y", [0, 1e6, 0]), ("z", [0, 0, 1e6]))),
    {"start": {f"{name}.position": on_orbit(
        [x * math.cos(0.9) - y * math.sin(0.9), x * math.sin(0.9) + y * math.cos(0.9), z])
        for name, x, y, z in (("x", RADIUS + 1e6, 0, 0), ("y", RADIUS, 1e6, 0),
                              ("z", RADIUS, 0, 1e6))}},
)
MEAN = math.sqrt(MU / 8e6**3)  # rad/s
promise(
    "`mu` is the earth's by default, 3.986004418e14 m^3/s^2; all other elements are 0.",
    guide("orbit", "semi_major_axis = 8e6") + STRAPPED,
    {"p.position": [8e6 * math.cos(MEAN), 8e6 * math.sin(MEAN), 0]},
)
promise(
    "`anomaly` is the true anomaly at t = 0.",
    guide("orbit", *ELEMENTS, "anomaly = 0.9") + STRAPPED,
    {"start": {"p.position": [RADIUS * math.cos(0.9), RADIUS * math.sin(0.9), 0]}},
)
promise(
    "Angles may end in `_deg`.",
    guide("orbit", *ELEMENTS, "anomaly_deg = 90", "inclination_deg = 90", "node_deg = 90")
    + STRAPPED,
    {"start": {"p.position": [0, 0, 8e6 * 0.99]}},
)
# The mean rates of a circle.
DRIFT = 1.5 * MEAN * J2 * (A / 8e6) ** 2
LATER = 20000.0
ANGLE = LATER * (MEAN + DRIFT * (2 - 2.5 * math.sin(1.1) ** 2))
promise(
    "`j2 = true` rotates node and perigee at the mean rates due to the earth's J2 and radius of "
    "WGS84. The mean anomaly keeps its rate.",
    guide("orbit", "semi_major_axis = 8e6", "inclination = 1.1", "node = 0.4", "j2 = true")
    + STRAPPED + solve(LATER, f"output_times = [{LATER}]"),
    {"p.position": Near([8e6 * x for x in on_orbit(
        [math.cos(ANGLE), math.sin(ANGLE), 0], 0.4 - DRIFT * math.cos(1.1) * LATER, 1.1, 0)],
        1e-3)},  # a drift of 80 km, with ten digits of J2
)

PARKED = ["latitude_deg = 50", "heading = 0.8", "speed = 0"]
promise(
    "x down, z horizontal along the heading, y to the left; turned about z by the bank",
    guide("course", *PARKED, "gravity = 9.75") + STRAPPED,
    {"w": [-EARTH * S, EARTH * C * math.sin(0.8), EARTH * C * math.cos(0.8)],
     "f": [-9.75, 0, 0]},
)
promise(
    "The x axis is the plumb line at the site.",
    guide("earth", "latitude_deg = 50", "azimuth_deg = 0", "height = 10000",
          'gravity = "normal"') + STRAPPED,
    {"f.y": Near(0, 1e-13), "f.z": Near(0, 1e-13)},
)
for quote in ("At a height it is not the ellipsoid's normal: at 10 km and 50 degrees it lies 8e-6 rad "
              "from it.", "On a `course` x is the normal."):
    promise(
        quote,
        guide("course", "latitude_deg = 50", "heading = 0", "speed = 0", "height = 10000",
              'gravity = "normal"') + STRAPPED,
        lambda found, rows: [] if 7.5e-6 < abs(rows[0]["f.z"] / rows[0]["f.x"]) < 8.5e-6
        else [f"the apparent gravity is {rows[0]}"],
    )
promise(
    "A positive angle lowers the right side.",
    guide("course", *PARKED, "gravity = 9.75", "bank = 0.2") + STRAPPED,
    {"f": [-9.75 * math.cos(0.2), 9.75 * math.sin(0.2), 0]},
)
promise(
    "A number is along the vertical, and the same on the whole way. The centrifugal part in it "
    "is that at the origin.",
    guide("course", *PARKED, "gravity = 9.75") + STRAPPED
    + body('joint = { kind = "fixed", position = [-1e5, 0, 0] }', name="b")
    + sensor("accelerometer", name="g", on="b"),
    {"f": [-9.75, 0, 0], "g.x": -9.75 + EARTH**2 * C * C * 1e5},
)
promise(
    "`turn_rate` is about the vertical, positive to the right, relative to the geodesic.",
    guide("course", *PARKED, "turn_rate = 0.3") + STRAPPED,
    {"w.x": 0.3 - EARTH * S, "w.z": EARTH * C * math.cos(0.8 + 0.3)},
)
FAR = solve(3600, "output_step = 600")
HIGH = 1000
promise(
    "`turn_rate` = -v tan(latitude)/(N + height) due east keeps the latitude; N is the radius of "
    "curvature of the prime vertical.",
    guide("course", "latitude_deg = 50", "heading_deg = 90", "speed = 200", f"height = {HIGH}",
          f"turn_rate = {-200 * S / C / (N50 + HIGH)!r}") + STRAPPED + FAR,
    {"rows": {"p.position z": lambda t: (N50 * (1 - E2) + HIGH) * S}},
)


def eastward(row):
    """Distance from the earth's axis, times the velocity to the east over ground."""
    x, y, u, v = (row[f"p.{what}"] for what in
                  ("position x", "position y", "velocity x", "velocity y"))
    return x * v - y * u - EARTH * (x * x + y * y)


# Clairaut: the momentum about the earth's axis is constant on a geodesic of an ellipsoid.
def clairaut(found, rows):
    wanted = N50 * C * 200 * math.sin(0.8)
    for row in rows:
        if abs(eastward(row) - wanted) > NEAR * wanted:
            yield f"r cos(latitude) v sin(heading) is {eastward(row)}, not {wanted}: {row}"


promise(
    "A vehicle with 0 follows a geodesic, as on a great circle.",
    guide("course", "latitude_deg = 50", "heading = 0.8", "speed = 200") + STRAPPED + FAR,
    clairaut,
)


def along_equator(found, rows):
    for row in rows:
        t, r = row["t"], math.hypot(row["p.position x"], row["p.position y"])
        if abs(r - (A + 500 + 3 * t)) > NEAR * A or abs(eastward(row) / r - 100 - 2 * t) > 1e-8:
            yield f"{r - A} m above the ground with {eastward(row) / r} m/s at t = {t}"


promise(
    "`speed` is that over ground, along the heading at the vehicle's height. `acceleration` is its "
    "rate, `climb` the rate of the height.",
    guide("course", "latitude = 0", "heading_deg = 90", "speed = 100", "height = 500",
          "acceleration = 2", "climb = 3") + STRAPPED,
    along_equator,
)
# Over the pole with a radius of curvature of a/sqrt(1 - e^2); 15 km before it to 15 km behind it.
COLATITUDE = 15000 / A * math.sqrt(1 - E2)
promise(
    "Poles are points like others.",
    guide("course", f"latitude = {math.pi / 2 - COLATITUDE!r}", "heading = 0", "speed = 250")
    + STRAPPED + solve(120, "output_times = [0, 60, 120]"),
    lambda found, rows: [
        f"{row['p.position x']} m, {row['p.position y']} m" for row in rows
        if abs(math.hypot(row["p.position x"], row["p.position y"])
               - A / math.sqrt(1 - E2) * math.sin(abs(row["t"] - 60) / 60 * COLATITUDE)) > 0.01],
)
for keys, reason in (
    (["acceleration = { points = [[0.1, 0], [0.2, 1]] }"], None),
    (["climb = { points = [[0.1, 0], [0.2, 1]] }"], "guide.climb: jumps, or its rate does"),
    (["turn_rate = { points = [[0.1, 0], [0.2, 1]] }"], "guide.turn_rate: jumps, or its rate"),
):
    promise(
        'Beside `"coordinated"` only `acceleration` may have `points`, because the bank follows '
        "the turn without delay.",
        guide("course", "latitude = 0", "heading = 0", "speed = 100", 'bank = "coordinated"',
              "turn_rate = 0.01" if "turn" not in keys[0] else "", *keys) + STRAPPED,
        reason,
    )
    promise(
        "`turn_rate` and `climb` must not jump, because bodies would get an impact: give `points` "
        "instead of `steps`.",
        guide("course", "latitude = 0", "heading = 0", "speed = 100", *keys) + STRAPPED,
        None,
    )
promise(
    "tan(bank) = v w/g in a level turn",
    guide("course", "latitude = 0", "heading = 0", "speed = 100", "turn_rate = 0.05",
          'bank = "coordinated"', "gravity = 9.5") + STRAPPED,
    # The earth's rotation adds 2 v W and 4e-5 of the turn to the forces.
    lambda found, rows: [] if abs(math.hypot(rows[0]["f.x"], rows[0]["f.y"]) - math.hypot(9.5, 5))
    < 0.02 and abs(rows[0]["f.y"]) < NEAR else [f"the apparent gravity is {rows[0]}"],
)
# A spline of a constant rate, and a specific force that holds the origin against gravity.
RATES = log("t,wx,wy,wz,ax,ay,az", [[k / 10, 0, 0, 0.5, 0, 0, 9.75] for k in range(11)])
promise(
    '`acceleration` is `"specific force"`, the default, as accelerometers read it, or '
    '`"kinematic"`.',
    guide("rates", 'file = "log.csv"', "gravity = [0, 0, -9.75]", "sigma = 0") + STRAPPED,
    {"p.position": [0, 0, 0], "w": [0, 0, 0.5], "q.yaw": 0.5},
    files={"log.csv": RATES},
)
promise(
    "`attitude` and `origin_velocity` are those at the log's first time",
    guide("rates", 'file = "log.csv"', 'acceleration = "kinematic"', "sigma = 0",
          "origin_velocity = [1, 2, 3]", f"attitude = {quaternion('z', 0.25)}") + STRAPPED,
    {"p.position": [1, 2, 3 + 9.75 / 2], "q.yaw": 0.75},
    files={"log.csv": RATES},
)
promise(
    "A specific force needs `gravity` in m/s^2 on inertial axes, here or by "
    '`[gravity] kind = "inertial"`.',
    guide("rates", 'file = "log.csv"', "sigma = 0") + STRAPPED,
    "gravity",
    files={"log.csv": RATES},
)
promise(
    "A specific force needs `gravity` in m/s^2 on inertial axes, here or by "
    '`[gravity] kind = "inertial"`.',
    guide("rates", 'file = "log.csv"', "sigma = 0")
    + part("[gravity]", 'kind = "inertial"', "vector = [0, 0, -9.75]") + STRAPPED,
    {"p.position": [0, 0, 0], "f": [0, 0, 9.75]},
    files={"log.csv": RATES},
)
promise(
    "Without `ax, ay, az` the key is refused.",
    guide("rates", 'file = "log.csv"', "sigma = 0", "gravity = [0, 0, -9.75]") + STRAPPED,
    "guide.gravity",
    files={"log.csv": log("t,wx,wy,wz", [[k / 10, 0, 0, 0.5] for k in range(11)])},
)
NESTED = '{ kind = "rotating", angular_velocity = [0, 0, 0.125] }'
for depth in range(7):
    NESTED = f'{{ kind = "chain", links = [{NESTED}] }}'
promise(
    "A chain may contain chains, up to eight levels deep.",
    guide("chain", f"links = [{NESTED}, {NESTED}]") + STRAPPED, {"w": [0, 0, 0.25]},
)
