"""The package kreisel against the programs: test_package.py FOLDER_OF_PROGRAMS SOURCES."""

import ast
import copy
import csv
import inspect
import json
import math
import pathlib
import pickle
import re
import subprocess
import sys
import time
import tempfile
import unittest
import warnings

import kreisel

PROGRAMS, SOURCES = map(pathlib.Path, sys.argv[1:3])
SCENES = SOURCES / "examples/scenes"
BOWL = {"name": "rod", "joint": {"kind": "revolute", "axis": [0, 1, 0]}, "mass": 1,
        "centre": [0, 0, -1], "inertia": [0.1, 0.1, 0.1], "initial": {"angle": 0.5}}
WEIGHT = {"kind": "uniform", "vector": [0, 0, -9.81]}


def scene(**rest):
    return kreisel.Scene(**{"gravity": WEIGHT, "body": [BOWL], "solve": {"t_end": 1}, **rest})


def program(name, *arguments):
    return subprocess.run([PROGRAMS / name, *map(str, arguments)], capture_output=True, text=True)


def without_time(found):
    return {key: value for key, value in found.items() if key != "run_time_s"}


class AsPrograms(unittest.TestCase):
    def test_analyze(self):
        path = SCENES / "gyrocompass.toml"
        wanted = program("analyze", path, "--json", "--campbell", "rotor", "--speeds", "1000:2000:3")
        found = kreisel.Scene(path).analyze(campbell="rotor", speeds=[1000, 1500, 2000])
        self.assertEqual(found, json.loads(wanted.stdout))

    def test_response(self):
        path = SCENES / "gyrocompass.toml"
        plant = kreisel.Scene(path).state_space()
        inputs, outputs = [[one["name"] for one in plant[key]] for key in ("inputs", "outputs")]
        wanted = program("analyze", path, "--json", "--response", inputs[0], "--to", outputs[0],
                         "--frequencies", "0.1:10:2")
        found = kreisel.Scene(path).analyze(response=inputs[0], to=outputs[0], frequencies=[0.1, 10])
        self.assertEqual(found["response"], json.loads(wanted.stdout)["response"])
        self.assertEqual(len(plant["A"]), len(plant["states"]))

    def test_ensemble(self):
        path = SCENES / "gyrocompass.toml"
        vary = ["body.rotor.rotor.speed*=normal(1,0.01)", "body.ring.initial.angle=uniform(0.1,0.3)"]
        with tempfile.TemporaryDirectory() as folder:
            table = pathlib.Path(folder) / "out.csv"
            program("ensemble", path, "--members", 5, "--seed", 3, "--t-end", 1, "--csv", table,
                    "--vary", *vary)
            names, *rows = csv.reader(table.read_text().splitlines())
        found = kreisel.Scene(path).ensemble(vary, members=5, seed=3, t_end=1, threads=2)
        self.assertEqual(names[1:-2], found.keys + found.columns)
        for row, varied, end, error in zip(rows, found.varied, found.ends, found.errors):
            self.assertEqual([float(x) for x in row[1:-1]], [*varied, *end, error])
        self.assertEqual((len(found), found.failed, found.missed), (5, 0, 0))

    def test_members_that_fail(self):
        path = SCENES / "damped_slide.toml"
        found = kreisel.Scene(path).ensemble({"body.slide.initial.rate": "linear(0,1.7e308)"},
                                             members=2)
        self.assertEqual(found.failed, 1)
        self.assertEqual(found.messages[0], "")
        self.assertTrue(math.isnan(found.ends[1][0]))

    def test_pendulum_deviation(self):
        wanted = json.loads(program("pendulum_deviation", "--latitude", 48.1, "--rod", 0.3, "--height",
                                    500, "--gravity-gradient", "--json").stdout)
        found = kreisel.pendulum_deviation(latitude=48.1, rod=0.3, height=500, gravity_gradient=True)
        self.assertEqual(without_time(found), without_time(wanted))
        with self.assertRaisesRegex(kreisel.InvalidInput, "latitude = 'north' is not a finite number"):
            kreisel.pendulum_deviation(latitude="north")

    def test_values_as_set(self):
        path = SCENES / "gyrocompass.toml"
        values = {"body.rotor.mass": 2, "solve.tolerance": 1e-8, "body.ring.damping": 0.5}
        words = [word for key, value in values.items() for word in ("--set", f"{key}={value}")]
        wanted = json.loads(program("simulate", path, "--json", "--t-end", 1, *words).stdout)
        run = kreisel.Scene(path).with_values(values).solve(t_end=1)
        self.assertEqual(run.report.tolerance, 1e-8)
        for key in ("steps", "evaluations", "error_estimate"):
            self.assertEqual(getattr(run.report, key), wanted[key])

    def test_parts_of_the_law(self):
        path = SCENES / "tumbling_body.toml"
        wanted = json.loads(program("simulate", path, "--json", "--terms", "--t-end", 1).stdout)
        parts = kreisel.Scene(path).solve(t_end=1, terms=True).parts
        for body, by_part in wanted["final"]["terms"].items():
            for part, force in by_part.items():
                numbers = list(parts[body][part][-1])
                for found, shown in zip(numbers, force["force"] + force["torque"]):
                    self.assertAlmostEqual(found, shown, delta=1e-11 * max(map(abs, numbers)))


class Options(unittest.TestCase):
    """Every option of the programs has its parameter, or a reason why it needs none."""

    ELSEWHERE = {
        "--help": "help()", "--version": "__version__", "--json": "results are objects",
        "--csv": "Run.rows, Ensemble.ends", "--plot": "no pictures", "--set": "Scene.with_values",
        "--resume": "no files", "--state-space": "Scene.state_space",
        "--sites": "a loop", "--sweep": "a loop"}

    def test_all_are_reachable(self):
        functions = {"simulate": kreisel.Scene.solve, "analyze": kreisel.Scene.analyze,
                     "ensemble": kreisel.Scene.ensemble,
                     "pendulum_deviation": kreisel.pendulum_deviation}
        for name, function in functions.items():
            options = re.findall(r"^ *(?:-h,)?(--[a-z-]+)", program(name, "--help").stdout, re.MULTILINE)
            self.assertGreater(len(options), 8)
            for option in options:
                reachable = option[2:].replace("-", "_") in inspect.signature(function).parameters
                self.assertNotEqual(reachable, option in self.ELSEWHERE, f"{name} {option}")


class Stubs(unittest.TestCase):
    def test_agree_with_the_package(self):
        stub = ast.parse((pathlib.Path(kreisel.__file__).parent / "__init__.pyi").read_text())
        found = {}
        for node in stub.body:
            if isinstance(node, ast.FunctionDef):
                found[node.name] = node
            if isinstance(node, ast.ClassDef):
                found[node.name] = {one.name: one for one in node.body
                                    if isinstance(one, ast.FunctionDef)}
        self.assertEqual(set(found), set(kreisel.__all__))
        for name, node in found.items():
            thing = getattr(kreisel, name)
            if isinstance(node, ast.FunctionDef):
                self.compare(node, thing)
                continue
            public = {one for one in vars(thing) if not one.startswith("_")}
            self.assertEqual({one for one in node if not one.startswith("_")}, public, name)
            for method in public:
                if inspect.isfunction(getattr(thing, method)):
                    self.compare(node[method], getattr(thing, method))

    def compare(self, node, function):
        stated = [arg.arg for arg in node.args.posonlyargs + node.args.args + node.args.kwonlyargs]
        self.assertEqual(stated, list(inspect.signature(function).parameters), node.name)


class Scenes(unittest.TestCase):
    def test_are_values(self):
        one = scene(title="a rod").with_values({"body.rod.mass": 2})
        for other in (pickle.loads(pickle.dumps(one)), copy.copy(one), copy.deepcopy(one)):
            self.assertEqual(one, other)
            self.assertEqual(hash(one), hash(other))
            self.assertEqual(list(one.solve().rows[-1]), list(other.solve().rows[-1]))
        self.assertNotEqual(one, scene(title="a rod"))
        self.assertEqual(repr(one), "<kreisel.Scene 'a rod', bodies: rod, 1 values set>")

    def test_runs_say_what_they_are(self):
        self.assertRegex(repr(scene(title="x").solve()), r"<kreisel.Run 'x', 501 rows to t = 1 s, .*, error .*e-1")
        self.assertRegex(repr(scene().ensemble("body.rod.mass=normal(1,0.1)", members=2)),
                         "of 2 members, 0 failed, 0 missed the tolerance, varied: body.rod.mass>")

    def test_t_end_is_wanted_once(self):
        free = scene(solve={})
        self.assertEqual(free.solve(t_end=0.5).times[-1], 0.5)
        with self.assertRaisesRegex(kreisel.SceneMistakes, r"solve\.t_end: is missing"):
            free.solve()

    def test_dicts_and_generators(self):
        whole = {"gravity": WEIGHT, "body": (one for one in [BOWL]), "solve": {"t_end": 1}}
        run = kreisel.Scene(whole).solve(times=(0.5 * i for i in range(3)))
        self.assertEqual(list(run.times), [0, 0.5, 1])

    def test_matrices_of_inertia(self):
        body = {**BOWL, "inertia": [[0.1, 0.01, 0], [0.01, 0.2, 0], [0, 0, 0.2]]}
        six = {**BOWL, "inertia": [0.1, 0.2, 0.2, 0.01, 0, 0]}
        self.assertEqual(scene(body=[body]), scene(body=[six]))
        body["inertia"][0][1] = 0.02
        with self.assertRaisesRegex(ValueError, r"body\[0\]\.inertia: .* must be symmetric"):
            scene(body=[body])


class Errors(unittest.TestCase):
    def test_are_also_pythons(self):
        with self.assertRaises(FileNotFoundError) as caught:
            kreisel.Scene("no.toml")
        self.assertIsInstance(caught.exception, kreisel.InvalidInput)
        with self.assertRaises(ValueError):
            scene().solve(tolerance=1)
        with self.assertRaises(ValueError):
            kreisel.Scene(str(SCENES))  # a folder

    def test_name_no_lines_of_a_text_nobody_saw(self):
        with self.assertRaises(kreisel.SceneMistakes) as caught:
            scene(body=[{**BOWL, "mass": -1, "centre": "low"}])
        self.assertEqual([one.split(":")[0] for one in caught.exception.mistakes],
                         ["body 'rod'.mass", "body 'rod'.centre"])

    def test_name_the_key_of_a_value(self):
        with self.assertRaisesRegex(kreisel.SceneMistakes, r"body\.rod\.mass = -1: body 'rod'\.mass: -1"):
            scene().with_values({"body.rod.mass": -1})
        with self.assertRaisesRegex(kreisel.SceneMistakes, r"body\.rud\.mass.*did you mean 'rod'"):
            scene().with_values({"body.rud.mass": 1})
        with self.assertRaisesRegex(kreisel.SceneMistakes, "is no key"):
            scene().with_values({"": 1})

    def test_a_missed_tolerance_is_a_warning(self):
        with self.assertWarns(kreisel.ToleranceMissed):
            scene(solve={"t_end": 1, "model": "linear"}).solve()
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            scene().solve()


class Progress(unittest.TestCase):
    def test_is_told(self):
        shares = []
        scene().solve(t_end=1e4, method="verner98", progress=shares.append)
        self.assertGreater(len(shares), 0)
        self.assertTrue(all(0 <= share <= 1 for share in shares))

    def test_an_exception_ends_the_run(self):
        def stop(share):
            raise StopIteration(share)
        with self.assertRaises(StopIteration):
            scene().solve(t_end=1e7, method="verner98", progress=stop)

    def test_of_an_analysis(self):
        """A sweep of ten thousand speeds takes minutes; a stop ends it within a second or two."""
        rotor = kreisel.Scene(SCENES / "overhung_rotor.toml")
        speeds, shares = [0.1 * i for i in range(10_000)], []

        def stop(share):
            shares.append(share)
            if share > 0.1:
                raise StopIteration(share)
        begin = time.monotonic()
        with self.assertRaises(StopIteration):
            rotor.analyze(campbell="disc", speeds=speeds, progress=stop)
        self.assertLess(time.monotonic() - begin, 30)
        self.assertTrue(all(0 <= share <= 1 for share in shares))


class WithoutNumpy(unittest.TestCase):
    def test_results_are_lists(self):
        code = ("import sys; sys.modules['numpy'] = None\n"
                "import kreisel\n"
                f"run = kreisel.Scene({str(SCENES / 'satellite.toml')!r}).solve(times=[0, 1])\n"
                "assert run.times == [0, 1] and isinstance(run.rows[1], list)\n"
                "assert len(run.coordinates['satellite'][1]) == 7 and len(run.errors) == 2\n")
        subprocess.run([sys.executable, "-c", code], check=True)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
