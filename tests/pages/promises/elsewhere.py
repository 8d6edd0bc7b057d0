"""Sentences that other tests execute, and those that no run could show."""

FILE = "tests/dynamics/file/"
PAGE = FILE + "scene_page.cpp: "
SCENE = FILE + "scene_file.cpp: "
SIGNAL = FILE + "scene_signal.cpp: "
COURSE = FILE + "scene_course.cpp: "
LOGS = FILE + "log_options.cpp: "
GUIDE = "tests/dynamics/guide/"
PROGRAMS = "tests/programs/"
ORBIT = "tests/dynamics/load/orbit_gravitation.cpp: "
LOOPS = "tests/dynamics/control/loops.cpp: "
MODELS = FILE + "models.cpp: "
PYTHON = "python/test_kreisel.py: "

ELSEWHERE = [
    ("It is TOML 1.0, in SI units and radians.", SCENE + "have_line_column_key_and_reason"),
    ("A key of an angle or an angular rate may end in `_deg` instead",
     PAGE + "angles_and_their_rates_in_degrees"),
    ("Nothing is computed then.", PROGRAMS + "simulate.cpp: "
                                             "bad_input_exits_with_2_and_writes_nothing"),
    ("and the Python module read scene files", PYTHON + "test_to_the_last_bit"),
    ("Examples are in `examples/scenes/`.", PROGRAMS + "simulate.cpp: every_example_runs"),
    ("| length | m, mm,", PAGE + "every_unit_of_the_page_is_read"),
    ("| time | s, ms,", PAGE + "every_unit_of_the_page_is_read"),
    ("| mass | kg, g,", PAGE + "every_unit_of_the_page_is_read"),
    ("| angle | rad, mrad,", PAGE + "every_unit_of_the_page_is_read"),
    ("| angular rate | rpm, Hz |", PAGE + "every_unit_of_the_page_is_read"),
    ("| others | kn (knot),", PAGE + "every_unit_of_the_page_is_read"),
    ("a log: attitude guide to inertial, position on inertial axes",
     PAGE + "logs_give_the_guide_on_inertial_axes"),
    ("twice differentiable between samples, an error outside",
     GUIDE + "tabulated.cpp: is_not_continued_beyond_its_ends"),
    ("a log of angular rates and accelerations on the guide's own axes, integrated",
     SCENE + "integrate_logged_rates"),
    ("each link moves relative to the previous one: earth, ship, device",
     PAGE + "links_start_on_the_link_before"),
    ("A `harmonic` guide needs a `t_begin` not below 0.", SCENE + "are_found_in_every_section"),
    ("A heave given as an acceleration a sin(w t) needs `origin_velocity` = -a/w. Otherwise the "
     "guide climbs by a/w each second.", PAGE + "heave_with_its_velocity_does_not_drift"),
    ("Neither position and angles nor their rates may jump, because a jump of the velocity is an "
     "impact. Therefore `steps` and `points` are refused here.", SIGNAL + "mistakes_are_reported"),
    ("`semi_major_axis` is required.", SCENE + "are_found_in_every_section"),
    ("the vertical is the ellipsoid's normal", GUIDE + "course.cpp: without_turning_is_a_geodesic"),
    ("`latitude`, `longitude` and `heading` (from north through east) at t = 0 are in radian, or "
     "in degrees as `latitude_deg`.", COURSE + "has_defaults_and_angles_in_radian"),
    ("`latitude`, `heading` and `speed` are required", COURSE + "has_line_column_key_and_reason"),
    ("all else is 0 by default", COURSE + "has_defaults_and_angles_in_radian"),
    ("`turn_rate`, `acceleration` and `climb` may be [functions of time]",
     COURSE + "is_that_of_the_library"),
    ("Its heading then changes with the convergence of the meridians.",
     GUIDE + "course.cpp: without_turning_is_a_geodesic"),
    ('`bank` is `"none"`, an angle, or `"coordinated"`.', COURSE +
        "has_defaults_and_angles_in_radian"),
    ("It refers to WGS84 normal gravity, or to the number in `gravity`.",
     COURSE + "coordinated_has_no_lateral_force"),
    ("`gravity` is as on the `earth`.", COURSE + "at_rest_is_a_site_on_the_earth"),
    ("Inertial axes are at the earth's centre, z to the north pole, x through longitude 0 at t = "
     "0.",
     COURSE + "is_seen_from_the_earths_centre"),
    ("The position has an error below 1e-8 m after 3e7 m.",
     GUIDE + "course.cpp: without_turning_is_a_geodesic"),
    ("The height must stay from -11 km to 10,000 km.", COURSE + "has_line_column_key_and_reason"),
    ("An angle of bank may have neither.", COURSE + "has_line_column_key_and_reason"),
    ("the columns of the log are `wx, wy, wz` in rad/s and, if the origin is accelerated",
     SCENE + "integrate_logged_rates"),
    ("The spline of the rates is integrated with an error of the order of rounding.",
     GUIDE + "rates.cpp: give_many_turns_to_rounding"),
    ("`earth`, `course`, `orbit` and `rates` must be the first link.",
     SCENE + "are_found_in_every_section"),
    ("A value is a number, or `[x, y, z]` for a vector.", SIGNAL + "mistakes_are_reported"),
    ("Its path is relative to the folder of the scene.", SCENE + "follow_a_log_beside_the_scene"),
    ("The columns of a function of time are the time `t` and `value`",
     SIGNAL + "log_is_a_function_of_time"),
    ("The columns of a `table` are the time `t`, the attitude `qw, qx, qy, qz`",
     FILE + "log_file.cpp: usual_spellings_need_no_option"),
    ("| `file` | | the path of the log |", LOGS + "each_key_reads_its_logs"),
    ("the header's name of a column, or its number from 1",
     FILE + "log_file.cpp: columns_are_given_by_name_or_number"),
    ("| `separator` |", LOGS + "each_key_reads_its_logs"),
    ("| `decimal` |", FILE + "log_file.cpp: a_declared_decimal_comma_is_read"),
    ("| `header` |", LOGS + "each_key_reads_its_logs"),
    ("| `sigma` | estimated from the log", PAGE + "sigma_is_for_attitude_and_position"),
    ("the last line above the rows that names all columns",
     FILE + "log_file.cpp: headers_that_do_not_fit_are_refused"),
    ("`time_zero` in decimals keeps the digits of nanoseconds since 1970.",
     FILE + "log_file.cpp: nanoseconds_since_1970_keep_their_digits"),
    ("Give it as an integer, or as a text", PAGE + "time_zero_keeps_nanoseconds_as_a_text"),
    ("Rows far outside the run are not read. At least 64 on each side are kept for the spline, or "
     "fewer if a gap comes first.", FILE + "log_file.cpp: rows_far_from_the_run_are_not_read"),
    ("**Noise** and rounded decimals are smoothed by a spline of degree 5 with knots at every m-th "
     "row. The number m is chosen so that the remaining distances from the rows are as large as "
     "`sigma`.", PAGE + "sigma_is_for_attitude_and_position"),
    ("A log that is exact to its last digit is interpolated", GUIDE + "tabulated.cpp: "
     "passes_through_its_samples"),
    ("noise, rounding and the motion between the rows change the result",
     PROGRAMS + "simulate.cpp: reports_the_effect_of_log_errors"),
    ("`simulate` estimates this effect as `error_of_log`",
     PROGRAMS + "simulate.cpp: reports_the_effect_of_log_errors"),
    ("In `--json` it is `error.log`", PROGRAMS + "simulate.cpp: reports_the_effect_of_log_errors"),
    ("The estimate is about twice the standard deviation.",
     GUIDE + "log_noise.cpp: has_the_estimated_effect_on_the_end"),
    ("`tolerance_kept` refers to the integration alone, `error_estimate` is the sum.",
     PROGRAMS + "simulate.cpp: reports_the_effect_of_log_errors"),
    ("of the planet that a guide of kind `orbit` orbits", SCENE + "on_an_orbit_is_the_planets"),
    ("With gravity `orbit` the equations use a frame that moves with the orbit's origin and does "
     "not rotate.", ORBIT + "has_its_tide_to_the_last_digits"),
    ("On a Kepler orbit the origin falls freely.", GUIDE + "orbit.cpp: falls_freely"),
    ("With `j2 = true` the mean orbit does not: its acceleration differs from gravity by some "
     "1e-3 of gravity. This difference acts on all bodies, so that they move as under J2.",
     ORBIT + "moves_bodies_as_j2_does"),
    ("Bodies form a tree: a parent comes before its children.", SCENE +
        "are_found_in_every_section"),
    ("At zero coordinates all axes are parallel to those of the guide, unless a joint rotates "
     "them.",
     PAGE + "bodies_are_placed_on_their_parent"),
    ("No step has to resolve a rotor's angle.", PAGE + "fast_rotors_need_no_more_steps"),
    ("A drag must not drive the body", FILE + "scene_loads.cpp: mistakes_in_loads_are_reported"),
    ("force and torque by displacement and rotation, below",
     FILE + "scene_elements.cpp: reads_every_key_of_a_mount"),
    ('`between` are two bodies, or `"guide"` and a body.',
     FILE + "scene_elements.cpp: refuses_wrong_elements"),
    ("Stiffness is the joint force of a per unit of q_a.",
     FILE + "scene_elements.cpp: a_gear_joins_two_wheels"),
    ("Other numbers of elements do not change with time.",
     FILE + "scene_elements.cpp: refuses_wrong_elements"),
    ("The first body may turn at will.",
     "tests/dynamics/tree/elements.cpp: the_carrying_body_may_turn_at_will"),
    ("`between`, `at` and `joints` are as for [elements](#element).",
     FILE + "scene_constraints.cpp: wrong_keys_are_told"),
    ("The wheel of `rolling` has its centre at `at`",
     "tests/dynamics/tree/rolling.cpp: steady_circles"),
    ("`analyze` gives its equilibria, and the roots of the directions that constraints leave free",
     PROGRAMS + "analyze.cpp: linkage"),
    ("They are columns of the CSV file, `final.sensors` of `--json` and `run.sensors` in Python.",
     PYTHON + "test_sensors_by_name"),
    ("An `azimuth` is the direction from one turning point to the next, also between turning "
     "points.",
     "tests/dynamics/sensor/sensors.cpp: azimuth_of_a_plane_swing"),
    ("The vertical is the plumb line from the pivot, on which the point hangs at rest. The pivot "
     "is the joint of the pendulum's first body on the guide.",
     "tests/dynamics/sensor/sensors.cpp: azimuth_about_the_plumb_line"),
    ("Allan deviation N/sqrt(tau)",
     "tests/dynamics/sensor/errors.cpp: white_noise_by_its_allan_deviation"),
    ("Samples are taken at the output times, or with `period = 0.01` at `t_begin` and at multiples "
     "of the period after it.", FILE + "scene_sensors.cpp: samples_are_rows"),
    ("Samples, steps of the reference", LOOPS + "reference_steps_are_met"),
    ("the limits of continuous laws are met exactly: steps end there",
     LOOPS + "a_limited_pid_is_in_pieces_closed"),
    ("In a continuous law its growth fades out within a millionth of the limit beyond, so that an "
     "output may stay there.", LOOPS + "outputs_may_stay_at_their_limit"),
    ("`analyze` closes the loops.", PROGRAMS + "analyze.cpp: servo_has_roots_response_and_margins"),
    ("Roots of sampled loops follow from the exact transition over the common period of all "
     "controllers.", LOOPS + "sampled_transition_is_exact"),
    ("so that `--resume` continues a loop to the last bit",
     PROGRAMS + "resume.cpp: continues_controllers_exactly"),
    ("`--resume` needs all columns.", PROGRAMS + "sensors.cpp: columns_that_are_chosen"),
    ("| `model` | `exact` |", PAGE + "defaults_agree_with_the_page"),
    ("With `auto` some scenes use a closed form, and a year costs as much as a second.",
     PAGE + "closed_forms_cost_the_same_for_a_year"),
    ("The time itself is rounded. After a year this causes an error of 1.3e-8 in a pendulum with a "
     "period of 3.4 s, more than the default tolerance.",
     PAGE + "closed_forms_cost_the_same_for_a_year"),
    ("The reported error is a bound of the model's own", MODELS + "bounds_of_random_scenes"),
    ("(50) of the paper with the masses of the rings, and (48)",
     PROGRAMS + "simulate.cpp: foeppls_equations_report_their_error"),
    ("`foeppl` and `fuchs-weigand` err by the third order in the angles on a guide at rest",
     "tests/dynamics/gimbal/gyro_small_oscillations.cpp: err_in_the_stated_order"),
    ("Otherwise the error is of second order: weight, unbalance, products of inertia",
     MODELS + "gyros_with_masses_off_the_axes"),
    ("Its deviations eta should be small against 1 rad: its error is of second order.",
     MODELS + "half_the_amplitude_has_a_quarter_of_the_error"),
    ("A spin about the axis of a `spherical` or `free` joint is resolved",
     "tests/dynamics/study/small_motion.cpp: spins_are_part_of_the_nominal_motion"),
]

# Headings of what follows, advice, and comparisons with programs that are not here.
REMARKS = [
    "A scene file describes one mechanical system on one guide frame.",
    "motion of the guide frame |",
    "the field at the bodies",
    "a force between two bodies, the guide and a body, or two joints",
    "a condition between the motions of two bodies, the guide and a body, or two joints",
    "an instrument on a body",
    "a law from readings to joint forces",
    "columns of the CSV file |",
    "end, tolerance, method, model, output",
    "The motion of the guide frame relative to the inertial frame.",
    "A ship that heaves and rolls without drift is easier as a `motion`.",
    "The pieces of a spline are as short as the steps of its log.",
    "Noise that is as smooth as the motion cannot be found.",
    "{ kind, axis, second_axis, pitch, position, orientation }",
    "A spring, a rope, a mount or an elastic gear.",
    "The mount exerts on the second body",
    "A condition between the motions of two bodies: it closes a loop, joins two joints",
    "The readings of an instrument on a body.",
    "`gyro` and `accelerometer` may have errors.",
    "They read",
    "A law that reads sensors and drives joints, loads and winches.",
    "what the outputs act on, see below",
    "`pid` or `state-space`, see below",
    "On a guide at rest the scene is",
    "For a satellite of three bodies at 1e-10 the series take 1/3.7 of the time",
    "Long chains gain little.",
    "Schuler's equations, which neglect more, are a class of the library alone",
    "`small` costs no steps of fast spins or nutations",
]
