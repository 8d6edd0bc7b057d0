"""Rigid bodies, pendulums and gyros seen from moving frames.

    import kreisel
    run = kreisel.Scene("gyrocompass.toml").solve()
    run.times, run.coordinates["ring"], run.report.error_estimate

SI units and radians. Quaternions are (w, x, y, z). Results are arrays of numpy where it is installed,
lists elsewhere.
"""

from ._errors import (ComputationFailed, Error, InvalidInput, SceneMistakes, SceneNotFound,
                      ToleranceMissed)
from ._kreisel import Invariant, Report, Term, version
from ._run import Ensemble, Run
from ._scene import Scene, pendulum_deviation

__version__ = version()
__all__ = ["ComputationFailed", "Ensemble", "Error", "InvalidInput", "Invariant", "Report", "Run",
           "Scene", "SceneMistakes", "SceneNotFound", "Term", "ToleranceMissed",
           "pendulum_deviation"]

# Where users see the classes, and where pickle finds them.
for _name in __all__:
    globals()[_name].__module__ = "kreisel"
