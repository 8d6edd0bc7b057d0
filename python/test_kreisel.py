"""The module against the program simulate: test_kreisel.py SIMULATE SCENES."""

import csv
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import warnings

import numpy as np

import kreisel

SIMULATE, SCENES = sys.argv[1], pathlib.Path(sys.argv[2])

ROD = """
[gravity]
kind = "uniform"
vector = [0, 0, -9.81]
[[body]]
name = "rod"
joint = { kind = "revolute", axis = [0, 1, 0] }
mass = 1
centre = [0, 0, -1]
inertia = [0.1, 0.1, 0.1]
initial = { angle = 0.5 }
[solve]
t_end = 2
output_step = 0.5
"""


def simulate(scene, *arguments):
    """The summary, the names of the columns and the rows."""
    with tempfile.TemporaryDirectory() as folder:
        table = os.path.join(folder, "out.csv")
        answer = subprocess.run([SIMULATE, scene, "--json", "--csv", table, *arguments],
                                capture_output=True, text=True)
        if answer.returncode not in (0, 4):  # 4: the tolerance was not reached
            raise RuntimeError(answer.stderr)
        with open(table, newline="") as file:
            names, *rows = csv.reader(file)
    return json.loads(answer.stdout), names, np.array(rows, dtype=float)


class AsSimulate(unittest.TestCase):
    def test_to_the_last_bit(self):
        for name in ["cardan_gyro_springs", "crane_on_ship", "satellite", "tumbling_body",
                     "imu_on_ship"]:
            with self.subTest(name):
                path = SCENES / (name + ".toml")
                summary, names, rows = simulate(path, "--t-end", "2", "--reactions")
                run = kreisel.Scene(path).solve(t_end=2, reactions=True)
                self.assertEqual(run.columns, names)
                np.testing.assert_array_equal(run.rows, rows)
                np.testing.assert_array_equal(run.times, rows[:, 0])
                self.assertEqual(run.title, summary["title"])
                for key in ["method", "steps", "rejected", "evaluations", "error_estimate",
                            "tolerance", "tolerance_kept"]:
                    self.assertEqual(getattr(run.report, key), summary[key], key)
                for found, wanted in zip(run.report.invariants, summary["invariants"]):
                    self.assertEqual(found.name, wanted["name"])
                    self.assertEqual(found.largest_drift, wanted["largest_drift"])
                joints = summary["final"]["joints"]
                for body, forces in run.reactions.items():
                    wanted = summary["final"]["reactions"][body]
                    self.assertEqual(forces["force"][-1].tolist(), wanted["force"])
                    self.assertEqual(forces["torque"][-1].tolist(), wanted["torque"])
                    if "coordinate" in joints[body]:
                        self.assertEqual(run.coordinates[body][-1].tolist(),
                                         joints[body]["coordinate"])
                        self.assertEqual(run.rates[body][-1].tolist(), joints[body]["rate"])

    def test_shapes(self):
        run = kreisel.Scene(SCENES / "satellite.toml").solve(times=np.array([0, 0.5, 1]))
        self.assertEqual(run.coordinates["satellite"].shape, (3, 7))
        self.assertEqual(run.rates["satellite"].shape, (3, 6))
        self.assertEqual(run.coordinates["wheel"].shape, (3,))
        self.assertEqual(run.reactions, {})

    def test_what_is_set_against_the_scene(self):
        scene = kreisel.Scene.from_text(ROD)
        self.assertEqual(scene.solve().times.tolist(), [0, 0.5, 1, 1.5, 2])
        run = scene.solve(times=[0.25, 1.25], tolerance=1e-6, method="radau13")
        self.assertEqual(run.times.tolist(), [0.25, 1.25])
        self.assertEqual((run.report.tolerance, run.report.method), (1e-6, "radau13"))

    def test_elements_by_name(self):
        path = SCENES / "engine_on_mounts.toml"
        summary, names, rows = simulate(path, "--t-end", "0.1")
        run = kreisel.Scene(path).solve(t_end=0.1, elements=True)
        self.assertEqual(run.columns, names)
        np.testing.assert_array_equal(run.rows, rows)
        for name, force in run.elements.items():
            wanted = summary["final"]["elements"][name]
            self.assertEqual(force["force"][-1].tolist(), wanted["force"])
            self.assertEqual(force["torque"][-1].tolist(), wanted["torque"])
        self.assertEqual(len(run.elements), 4)
        self.assertEqual(kreisel.Scene(path).solve(t_end=0.1).elements, {})

    def test_sensors_by_name(self):
        run = kreisel.Scene(SCENES / "imu_on_ship.toml").solve(t_end=0.2)
        for name, part, column in [("gyro", "value", "gyro.x"),
                                   ("antenna", "velocity", "antenna.velocity x"),
                                   ("cheap gyro", "true", "cheap gyro.true x")]:
            at = run.columns.index(column)
            np.testing.assert_array_equal(run.sensors[name][part], run.rows[:, at:at + 3])
        self.assertEqual(set(run.sensors["antenna"]), {"position", "velocity", "acceleration"})


class OfKeywords(unittest.TestCase):
    BODY = {"name": "rod \"1\"\t\N{GREEK SMALL LETTER PHI}", "mass": np.int64(1),
            "joint": {"kind": "revolute", "axis": np.array([0, 1, 0])},
            "centre": (0, 0, -1.0), "inertia": [np.float64(0.1)] * 3, "hold": False,
            "initial": {"angle": 0.5}}

    def scene(self, **rest):
        rest.setdefault("body", [self.BODY])
        return kreisel.Scene(title="rod", gravity={"kind": "uniform", "vector": [0, 0, -9.81]},
                             solve={"t_end": 2, "output_step": 0.5}, **rest)

    def test_as_of_a_file(self):
        run = self.scene().solve()
        self.assertEqual(run.title, "rod")
        self.assertEqual(list(run.coordinates), [self.BODY["name"]])
        np.testing.assert_array_equal(run.rows, kreisel.Scene.from_text(ROD).solve().rows)
        again = kreisel.Scene.from_text(self.scene().text)
        np.testing.assert_array_equal(run.rows, again.solve().rows)

    def test_elements(self):
        mount = {"name": "m", "kind": "mount", "between": ["guide", self.BODY["name"]],
                 "turning_stiffness": np.diag([1, 2, 3]), "preload": [0, 0, 0, 0, 1, 0]}
        run = self.scene(element=[mount]).solve(elements=True)
        np.testing.assert_allclose(run.elements["m"]["torque"][0], [0, 0, 0], atol=1e-15)

    def test_constraints(self):
        point = {"name": "p", "kind": "point", "between": ["guide", "rod"], "at": [[0, 0, 0]] * 2}
        rod = {"name": "rod", "mass": 2, "inertia": [1, 1, 1], "joint": {"kind": "free"},
               "centre": [0, 0, -0.5]}
        pull = {"name": "pull", "kind": "reaction", "constraint": "p"}
        scene = kreisel.Scene(body=[rod], constraint=[point], sensor=[pull],
                              report={"constraints": True}, solve={"t_end": 0.1},
                              gravity={"kind": "uniform", "vector": [0, 0, -10]})
        for run in (scene.solve(), scene.solve(constraints=True)):
            np.testing.assert_allclose(run.sensors["pull"]["force"][:, 2], 20, rtol=1e-9)
            self.assertEqual(run.rows.shape[1], len(run.columns))
        np.testing.assert_allclose(run.constraints["p"]["force"][:, 2], 20, rtol=1e-9)

    def test_increments_are_sampled(self):
        gyro = {"name": "gyro", "kind": "gyro", "body": "unit", "period": 0.25, "increments": True}
        unit = {"name": "unit", "mass": "2 kg", "inertia": [1, 1, 1], "joint": {"kind": "fixed"}}
        scene = kreisel.Scene(guide={"kind": "rotating", "angular_velocity": [0, 0, 2]},
                              body=[unit], sensor=[gyro], solve={"t_end": 1, "output_step": 0.5})
        for run in scene.solve(), scene.solve(times=[0, 0.5, 1]):
            self.assertEqual(run.times.tolist(), [0, 0.25, 0.5, 0.75, 1])
            angles = run.sensors["gyro"]["dtheta"][:, 2]
            np.testing.assert_allclose(angles, [0, 0.5, 0.5, 0.5, 0.5], atol=1e-15)

    def test_numbers_keep_their_digits(self):
        angle = np.nextafter(0.1, 1)
        run = self.scene(body=[self.BODY | {"initial": {"angle": angle}}]).solve()
        self.assertEqual(run.coordinates[self.BODY["name"]][0], angle)

    def test_a_table_beside_the_program(self):
        run = self.scene(guide={"kind": "table", "file": SCENES.resolve() / "ship_roll.csv"}).solve()
        self.assertGreater(abs(run.coordinates[self.BODY["name"]][-1]), 0)

    def test_mistakes(self):
        with self.assertRaisesRegex(kreisel.SceneMistakes, r"body 'a'\.mass: is missing"):
            self.scene(body=[{"name": "a"}])
        with self.assertRaisesRegex(kreisel.SceneMistakes, "did you mean 'guide'"):
            self.scene(gude={})
        with self.assertRaisesRegex(kreisel.SceneMistakes, "is NaN, not a finite number"):
            self.scene(body=[self.BODY | {"mass": float("nan")}])
        with self.assertRaisesRegex(TypeError, r"body\[0\]\.mass: .* NoneType"):
            self.scene(body=[self.BODY | {"mass": None}])
        with self.assertRaisesRegex(TypeError, "guide: keys must be text"):
            self.scene(guide={1: 2})
        with self.assertRaises(kreisel.SceneMistakes):
            kreisel.Scene()


class Page(unittest.TestCase):
    def test_runs(self):
        root = SCENES.resolve().parent.parent
        page = (root / "docs/site/programs.md").read_text().replace('"examples/', f'"{root}/examples/')
        code = page.split("```python\n")[1].split("```")[0]
        names = {}
        exec(code, names)
        self.assertEqual(names["run"].model, "linear")


class Reports(unittest.TestCase):
    def test_errors_by_output_time(self):
        run = kreisel.Scene.from_text(ROD).solve()
        self.assertEqual(run.errors.shape, run.times.shape)
        self.assertEqual(run.errors.max(), run.report.error_estimate)
        self.assertGreater(run.report.truncation + run.report.rounding, 0)
        self.assertAlmostEqual(run.report.truncation + run.report.rounding,
                               run.report.error_estimate, delta=1e-12 * run.report.error_estimate)
        self.assertTrue((run.errors >= 0).all())

    def test_of_an_approximation(self):
        text = ROD + 'model = "linear"\n'
        exact, linear = (kreisel.Scene.from_text(t).solve() for t in [ROD, text])
        self.assertEqual((exact.model, linear.model), ("exact", "linear"))
        off = np.abs(exact.coordinates["rod"] - linear.coordinates["rod"])
        self.assertTrue((off <= 1.0001 * linear.errors * 0.5 + 1e-15).all())

    def test_terms(self):
        terms = kreisel.Scene.from_text(ROD).solve().terms
        guide = [term for term in terms if term.part == "guide"]
        self.assertEqual([(term.kept, term.why) for term in guide], [(False, "the guide rests")])

    def test_all_are_documented(self):
        for kind in [kreisel.Scene, kreisel.Run, kreisel.Report, kreisel.Invariant, kreisel.Term]:
            self.assertTrue(kind.__doc__)
            for name in vars(kind):
                if not name.startswith("_"):
                    self.assertTrue(getattr(kind, name).__doc__, f"{kind.__name__}.{name}")


class Errors(unittest.TestCase):
    def test_derive_from_one(self):
        self.assertTrue(issubclass(kreisel.SceneMistakes, kreisel.InvalidInput))
        self.assertTrue(issubclass(kreisel.InvalidInput, kreisel.Error))
        self.assertTrue(issubclass(kreisel.ComputationFailed, kreisel.Error))

    def test_say_what_is_wrong(self):
        with self.assertRaisesRegex(kreisel.SceneMistakes, r"my\.toml:1:1: titel"):
            kreisel.Scene.from_text("titel = ''\n" + ROD, path="my.toml")
        with self.assertRaisesRegex(kreisel.InvalidInput, "no.toml: cannot be read"):
            kreisel.Scene("no.toml")
        scene = kreisel.Scene.from_text(ROD)
        for wrong in [{"tolerance": 1}, {"t_end": -1}, {"t_end": float("nan")}, {"times": []},
                      {"times": [2, 1]}, {"times": [1], "t_end": 1}, {"method": "euler"},
                      {"times": [1, float("inf")]}, {"times": [-1, 1]}]:
            with self.subTest(wrong), self.assertRaises(kreisel.InvalidInput):
                scene.solve(**wrong)

    def test_a_missed_tolerance_is_a_warning(self):
        linear = kreisel.Scene.from_text(ROD + 'model = "linear"\n')
        with self.assertWarnsRegex(RuntimeWarning, "was not reached"):
            run = linear.solve()
        self.assertFalse(run.report.tolerance_kept)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.assertTrue(kreisel.Scene.from_text(ROD).solve().report.tolerance_kept)

    def test_ctrl_c_ends_a_run(self):
        """The signal's thread needs Python's lock, so the run must have released it."""
        scene = kreisel.Scene.from_text(ROD)
        threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
        begin = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            scene.solve(t_end=1e5)
        self.assertLess(time.monotonic() - begin, 30)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
