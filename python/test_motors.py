"""kreisel.motors: its laws, the names of frames, its stubs."""

import ast
import copy
import pathlib
import pickle
import random
import unittest

import kreisel
from kreisel import motors
from kreisel.motors import (Inertia, Motor, Pose, Rate, Velocity, cross, dyad, equation_of_motion, exp,
                            log, reciprocal)

DRAW = random.Random(5)


def three():
    return [DRAW.uniform(-1, 1) for _ in range(3)]


def motor():
    return Motor(three(), three())


def distance(a, b):
    return max(abs(x) for x in (a - b).resultant + (a - b).moment)


class Motors(unittest.TestCase):
    def test_power_is_the_same_at_every_point(self):
        for _ in range(20):
            a, b, p = motor(), motor(), three()
            self.assertAlmostEqual(reciprocal(a, b), reciprocal(a.reduced_at(p), b.reduced_at(p)), delta=1e-13)

    def test_products_commute_with_the_point(self):
        for _ in range(20):
            a, b, p = motor(), motor(), three()
            there = cross(a.reduced_at(p), b.reduced_at(p))
            self.assertLess(distance(there, cross(a, b).reduced_at(p)), 1e-13)

    def test_jacobi(self):
        a, b, c = motor(), motor(), motor()
        all_three = cross(a, cross(b, c)) + cross(b, cross(c, a)) + cross(c, cross(a, b))
        self.assertLess(distance(all_three, Motor()), 1e-13)

    def test_screw(self):
        axis, pitch = [1, 2, 0], 0.25
        a = Motor([0, 0, 2], [0, 0, 2 * pitch]).reduced_at([-x for x in axis])
        self.assertEqual(a.axis_point, axis)
        self.assertEqual(a.pitch, pitch)
        self.assertEqual(a.length, [0, 0, 2 * pitch])

    def test_displacements(self):
        for _ in range(20):
            a, b = motor(), motor()
            X = exp(a)
            self.assertLess(distance(log(X), a), 1e-13)
            self.assertLess(distance(X.inverse() * (X * b), b), 1e-13)
            self.assertLess(distance(X * cross(a, b), cross(X * a, X * b)), 1e-13)

    def test_are_values(self):
        a = motor()
        self.assertEqual(copy.deepcopy(a), a)
        self.assertEqual(pickle.loads(pickle.dumps(a)), a)
        self.assertEqual(eval(repr(a)), a)


class Tensors(unittest.TestCase):
    def test_dyad(self):
        a, b, x = motor(), motor(), motor()
        self.assertLess(distance(dyad(a, b) * x, reciprocal(b, x) * a), 1e-14)

    def test_transposed(self):
        T = dyad(motor(), motor()) + dyad(motor(), motor())
        a, b = motor(), motor()
        self.assertAlmostEqual(reciprocal(a, T * b), reciprocal(T.transposed * a, b), delta=1e-13)

    def test_congruence(self):
        X, T, a = Pose([0.8, 0.6, 0, 0], [1, 2, 3]), dyad(motor(), motor()), motor()
        self.assertLess(distance((X * T) * (X * a), X * (T * a)), 1e-12)

    def test_inertia(self):
        T = Inertia(2, [0, 0, 0.5], [[0.2, 0, 0], [0, 0.2, 0], [0, 0, 0.01]])
        momentum = T * Motor([0, 3, 0], [0, 0, 0])
        self.assertLess(distance(momentum, Motor([3, 0, 0], [0, 2.1, 0])), 1e-15)
        with self.assertRaises(kreisel.InvalidInput):
            Inertia(-1, [0, 0, 0], [[1, 0, 0], [0, 1, 0], [0, 0, 1]])


class Frames(unittest.TestCase):
    V = Velocity("body", "table", Motor([0, 0, 2], [0, 1, 0]))
    F = Velocity("table", "room", Motor([0, 0, 1], [0, 1, 0]), written_in="body")

    def test_velocities_add_along_a_chain(self):
        total = self.V + self.F
        self.assertEqual((total.of, total.against), ("body", "room"))
        self.assertEqual((total - self.F).motor, self.V.motor)
        with self.assertRaises(kreisel.InvalidInput):
            self.F + self.V
        with self.assertRaises(kreisel.InvalidInput):
            self.V + Velocity("table", "room", self.F.motor)

    def test_another_observer_and_back(self):
        rate = Rate("body", self.V, motor())
        room = rate.seen_from("room", -(self.V + self.F))
        self.assertLess(distance(room.seen_from("body", self.V + self.F).motor, rate.motor), 1e-14)
        with self.assertRaisesRegex(kreisel.InvalidInput, "'room' against 'body'"):
            rate.seen_from("room", -self.V)

    def test_nine_forms_have_one_total(self):
        T = Inertia(1, [0.1, 0, 0.2], [[1, 0, 0], [0, 2, 0], [0, 0, 2.5]])
        dV, dF = Rate("body", self.V, motor()), Rate("table", self.F, motor())
        of_V = [dV, dV.seen_from("table", -self.V), dV.seen_from("room", -(self.V + self.F))]
        of_F = [dF.seen_from("body", self.V), dF, dF.seen_from("room", -self.F)]
        totals = [equation_of_motion(T, self.V, self.F, v, f)["total"] for v in of_V for f in of_F]
        self.assertLess(max(distance(total, totals[0]) for total in totals), 1e-13)
        with self.assertRaises(kreisel.InvalidInput):
            equation_of_motion(T, self.F, self.V, dV, dF)


class Stubs(unittest.TestCase):
    def test_agree_with_the_module(self):
        stub = ast.parse((pathlib.Path(motors.__file__).parent / "motors.pyi").read_text())
        defined = {node.name: node for node in stub.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        self.assertEqual(set(defined), set(motors.__all__))
        for name, node in defined.items():
            if isinstance(node, ast.ClassDef):
                named = {one.name for one in node.body if isinstance(one, ast.FunctionDef)}
                named |= {one.target.id for one in node.body if isinstance(one, ast.AnnAssign)}
                public = {one for one in vars(getattr(motors, name)) if not one.startswith("_")}
                self.assertEqual({one for one in named if not one.startswith("_")}, public, name)


if __name__ == "__main__":
    unittest.main()
