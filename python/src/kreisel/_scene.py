"""Scenes: mechanical systems on a guide frame, and what can be computed of them."""

import json
import os
import pathlib
import re
import warnings
from collections.abc import Mapping

from . import _kreisel, _toml
from ._errors import InvalidInput, SceneMistakes, SceneNotFound, ToleranceMissed
from ._run import Ensemble, Run, matrix

KEYWORDS = "scene"  # the path of scenes that are built from keywords, which have no file


class Scene:
    """A mechanical system on a guide frame, described as in a scene file.

    Scene("top.toml")              reads a scene file
    Scene({"gravity": ..})         takes the tables of a scene file as dicts and lists
    Scene(gravity=.., body=[..])   the same as keyword arguments: title, guide, gravity, body, element,
                                   constraint, sensor, controller, solve, output, report
    Scene.from_text("..")          takes the text of a scene file

    numpy arrays, tuples and generators are lists; a symmetric 3x3 matrix is an inertia.

        Scene(gravity={"kind": "uniform", "vector": [0, 0, -9.81]},
              body=[{"name": "rod", "joint": {"kind": "revolute", "axis": [0, 1, 0]},
                     "mass": 1, "centre": [0, 0, -1], "inertia": [0.1, 0.1, 0.1]}])

    Scenes do not change. They can be compared, copied and pickled. Units are SI and radian,
    quaternions are (w, x, y, z).

    Raises SceneMistakes with all mistakes, SceneNotFound (also a FileNotFoundError), or TypeError for
    a value that a scene cannot have.
    """

    __slots__ = ("_text", "_path", "_values", "_title", "_bodies")

    def __init__(self, source=None, /, **keywords):
        if isinstance(source, Mapping):
            source, keywords = None, {**source, **keywords}
        if source is None:
            self._set(_toml.scene(keywords), KEYWORDS, ())
            return
        if keywords:
            raise TypeError("a scene is a path or keyword arguments, not both")
        path = os.fspath(source)
        self._set(_read(path), path, ())

    @classmethod
    def from_text(cls, text, path="scene.toml"):
        """Builds a scene from the text of a scene file.

        path is its name in messages; its logs are searched beside path.
        """
        scene = cls.__new__(cls)
        scene._set(text, os.fspath(path), ())
        return scene

    def _set(self, text, path, values):
        self._text, self._path, self._values = text, path, values
        self._title, self._bodies = _told(path, lambda: _kreisel.examine(self._native()))

    def _native(self):
        settings = [_kreisel.Setting(key, value, f"{key} = {value}") for key, value in self._values]
        return _kreisel.SceneText(self._text, self._path, settings)

    @property
    def text(self):
        """The scene as the text of a scene file, without the values of with_values()."""
        return self._text

    @property
    def path(self):
        """The path in messages; logs are searched beside it."""
        return pathlib.Path(self._path)

    @property
    def title(self):
        """The title in the scene."""
        return self._title

    @property
    def bodies(self):
        """The names of the bodies."""
        return list(self._bodies)

    @property
    def values(self):
        """The values of with_values(), as the text of TOML."""
        return dict(self._values)

    def with_values(self, values):
        """The scene with other values at some keys, as simulate --set has them.

            scene.with_values({"body.rotor.mass": 2, "gravity.vector[2]": -9.8, "solve.method": "taylor"})

        A value replaces that of the scene, or is added where the scene has its default.
        """
        new = {**dict(self._values),
               **{key: _toml.value_of(key, value) for key, value in values.items()}}
        scene = type(self).__new__(type(self))
        scene._set(self._text, self._path, tuple(new.items()))
        return scene

    def solve(self, *, t_end=None, tolerance=None, method=None, times=None, reactions=False,
              elements=False, constraints=False, terms=False, progress=None):
        """Computes the motion; returns a Run.

        t_end        s, instead of the scene's
        tolerance    of the global error, instead of the scene's, see Report.error_estimate
        method       auto, closed form, verner98, gauss16, radau13, splitting, taylor
        times        s, increasing, instead of the scene's output times
        reactions    return the load of every joint
        elements     return the force of every element
        constraints  return the reaction of every constraint
        terms        return relative, guide and Coriolis part of the law for every body
        progress     called ten times a second with the share that is done, in [0, 1]; an exception
                     ends the run

        Python's lock is released during the run, and Ctrl-C ends it. A missed tolerance is a
        ToleranceMissed warning. Raises InvalidInput and ComputationFailed.
        """
        options = _options(t_end, tolerance, method, times)
        options.reactions, options.elements = reactions, elements
        options.constraints, options.terms = constraints, terms
        motion = _told(self._path, lambda: _kreisel.solve(self._native(), options, progress))
        report = motion.report
        if not report.tolerance_kept:
            _warn(f"the tolerance {report.tolerance:.3g} was not reached, the error is about "
                  f"{report.error_estimate:.3g}")
        return Run(motion)

    def ensemble(self, vary, *, members=1000, seed=1, threads=0, t_end=None, tolerance=None,
                 progress=None):
        """Runs the scene many times with some numbers varied; returns an Ensemble.

        vary       texts as "body.rotor.mass*=normal(1,0.01)", or a dict of keys and distributions as
                   {"body.rotor.mass": "normal(2,0.01)"}. A drawn number replaces (=) the scene's, is
                   added (+=) or multiplies it (*=). Distributions: normal(MEAN,DEVIATION),
                   uniform(FROM,TO) and, in equal steps, linear(FROM,TO)
        members    number of runs
        seed       of all that is drawn
        threads    0: as many as the machine runs at once; results do not depend on it
        t_end, tolerance, progress   as in solve()

        Members that fail have a message. Members that missed the tolerance are a ToleranceMissed
        warning. Raises InvalidInput.
        """
        if isinstance(vary, str):
            vary = [vary]
        if isinstance(vary, Mapping):
            vary = [f"{key}={value}" for key, value in vary.items()]
        options = _options(t_end, tolerance, None, None)
        found = _told(self._path, lambda: _kreisel.ensemble(
            self._native(), list(vary), members, seed, threads, options, progress))
        if found.missed:
            _warn(f"{found.missed} of {members} members did not reach the tolerance")
        return Ensemble(found)

    def analyze(self, *, campbell=None, speeds=None, orders=(1,), period=None, response=None,
                to=None, frequencies=None, progress=None):
        """Equilibria, steady motion, roots and stability; returns the object of analyze --json.

        campbell, speeds           a rotor and its speeds, rad/s against its carrier
        orders                     of critical speeds: frequency/speed
        period                     s, of the coefficients: Floquet multipliers
        response, to, frequencies  an input, an output and frequencies, rad/s, rising
        progress                   as in solve()

        Keys: equilibria, steady, linear, precession, notes; on request campbell, floquet, response.
        Frequencies and growth rates are in rad/s and 1/s. Ctrl-C ends it. Raises InvalidInput and ComputationFailed.
        """
        sweep = _together("campbell", "speeds", campbell, speeds)
        if sweep is not None:
            sweep += ([float(n) for n in orders],)
        if len({response is None, to is None, frequencies is None}) > 1:
            raise InvalidInput("response, to and frequencies go together")
        asked = None if response is None else (response, to, [float(w) for w in frequencies])
        found = _told(self._path, lambda: _kreisel.analyze(
            self._native(), sweep, asked, period, progress))
        return json.loads(found)

    def state_space(self):
        """The linear plant about the steady motion: the object of analyze --state-space.

        Keys: A, B, C, D (arrays), states, inputs, outputs with names and units, frame, and dt in s of
        sampled loops. Raises ComputationFailed without a steady motion.
        """
        plant = json.loads(_told(self._path, lambda: _kreisel.state_space(self._native())))
        return {**plant, **{name: matrix(plant[name]) for name in "ABCD"}}

    def __repr__(self):
        what = repr(self._title) if self._title else "without title"
        values = f", {len(self._values)} values set" if self._values else ""
        return f"<kreisel.Scene {what}, bodies: {', '.join(self._bodies)}{values}>"

    def __eq__(self, other):
        return isinstance(other, Scene) and self._key() == other._key()

    def __hash__(self):
        return hash(self._key())

    def _key(self):
        return (self._text, self._path, self._values)

    def __reduce__(self):
        return _restored, self._key()


def pendulum_deviation(*, latitude, azimuth=90, height=0, rotation_rate=None, gravity=None,
                       gravity_gradient=False, reduced_length=None, rod=None, mass=None, arm=None,
                       theta_a=None, theta_b=None, theta_c=None, phi_a=None, phi_b=None, phi_c=None,
                       amplitude=None):
    """Deviation of a pendulum from the vertical; returns the object of pendulum_deviation --json.

    latitude, azimuth  degrees: north positive; of the pendulum's axis from north through east
    height             m above the ellipsoid
    rotation_rate      rad/s, of the earth
    gravity            m/s^2; None: normal gravity (WGS84) at the site
    gravity_gradient   takes in the gradient of normal gravitation over the body
    reduced_length, rod or arm with theta_a, theta_b, theta_c (phi_a, phi_b, phi_c), and mass
                       the pendulum in m, kg, kg m^2; default: a reduced length of 0.5 m, 1 kg
    amplitude          rad, of the finite oscillation

    Numbers count by their decimals. Angles of the result are in rad. For many sites call it in a loop.
    An error without a bound is None. Raises InvalidInput and ComputationFailed.
    """
    given = {name: value for name, value in locals().items()
             if value is not None and name != "gravity_gradient"}
    options = {name: repr(float(value)) if not isinstance(value, str) else value
               for name, value in given.items()}
    if gravity_gradient:
        options["gravity_gradient"] = ""
    return json.loads(_kreisel.pendulum_deviation(options))


def _restored(text, path, values):
    scene = Scene.__new__(Scene)
    scene._set(text, path, values)
    return scene


def _read(path):
    try:
        with open(path, encoding="utf-8", newline="") as file:
            return file.read()
    except FileNotFoundError as error:
        raise SceneNotFound(f"{path}: cannot be read: {error.strerror}") from None
    except OSError as error:
        raise InvalidInput(f"{path}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise InvalidInput(f"{path}: is no UTF-8: {error.reason} at byte {error.start}") from None


def _options(t_end, tolerance, method, times):
    options = _kreisel.RunOptions()
    options.t_end, options.tolerance, options.method = t_end, tolerance, method
    options.times = None if times is None else [float(t) for t in times]
    return options


def _together(one, other, first, second):
    if (first is None) != (second is None):
        raise InvalidInput(f"{one} and {other} go together")
    return None if first is None else (first, [float(x) for x in second])


def _told(path, compute):
    """The result of compute(). A scene without a file has no lines to name in its mistakes."""
    try:
        return compute()
    except SceneMistakes as error:
        if path != KEYWORDS:
            raise
        text = re.sub(rf"^{KEYWORDS}:\d+:\d+: ", "", str(error), flags=re.MULTILINE)
        raise SceneMistakes(text) from None


def _warn(text):
    warnings.warn(text, ToleranceMissed, stacklevel=3)
