"""Expects check_draws to find arguments and operands that draw in an order left to the compiler, and nothing in ordered expressions."""
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
import check_draws  # noqa: E402


def found(code: str) -> int:
    return len(list(check_draws.breaches(code)))


class CheckDraws(unittest.TestCase):
    def test_two_arguments_that_draw_are_found(self):
        for call in ("Vec3(random.between(0, 1), 0.0, random.between(0, 1))", "at(place_in(mesh, random), random.rotation())",
                     "Vec3 half(random.between(0, 1), 1.0, 2 * random.between(0, 1));",
                     "turn({random.vector(1), 0.0}, other(1, random.vector(2)))",
                     "at(random.vector(3.0), odd ? Quat::Identity() : random.rotation())",
                     "f(c ? random.unit() : 0.0, random.unit())", "f(random.unit() < 1 && ok, random.unit())",
                     "f(Pose{{random.unit(), 0, 0}, q}, random.unit())", "at({{random.unit(), 0.0}, 1.0}, random.unit())"):
            with self.subTest(call=call):
                self.assertEqual(found(call), 1)

    def test_two_operands_that_draw_are_found(self):
        for code in ("x = random.between(0, 1) * random.direction();", "x = a + f(random) * (b + random.vector(1));",
                     "if (random.unit() < random.unit()) {", "x = random.engine()() + random.engine()();"):
            with self.subTest(code=code):
                self.assertEqual(found(code), 1)

    def test_generators_of_any_name_are_found(self):
        self.assertEqual(found("void f(Random& noise) { g(noise.vector(1.0), noise.vector(1.0)); }"), 1)

    def test_ordered_draws_are_clean(self):
        for code in ("Vec3{random.between(0, 1), 0.0, random.between(0, 1)}", "f(random.vector(1.0), 2.0, 3.0);",
                     "const Pose pose{random.vector(1.0), rotation(1, random)};",
                     "for (int i = f(random.engine()()); random.unit() < 1; i += 1) {}",
                     "random.vector(random.between(0, 1));", "x = random.unit() < 1 ? random.unit() : random.unit();",
                     "a = random.unit(), b = random.unit();", "if (random.unit() < 1) { a = f(random); } b = f(random);",
                     "void f(Random& random, int a) { g(random); } void h(Random& random, int a) { g(random); }",
                     "all([&] { a = random.unit(); }, random.unit());"):
            with self.subTest(code=code):
                self.assertEqual(found(code), 0)


if __name__ == "__main__":
    unittest.main()
