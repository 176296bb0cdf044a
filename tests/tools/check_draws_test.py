"""Expects check_draws to find calls whose arguments draw in an order left to the compiler, and nothing in ordered lists."""
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
                     "turn({random.vector(1), 0.0}, other(1, random.vector(2)))"):
            with self.subTest(call=call):
                self.assertEqual(found(call), 1)

    def test_generators_of_any_name_are_found(self):
        self.assertEqual(found("void f(Random& noise) { g(noise.vector(1.0), noise.vector(1.0)); }"), 1)

    def test_ordered_draws_are_clean(self):
        for code in ("Vec3{random.between(0, 1), 0.0, random.between(0, 1)}", "f(random.vector(1.0), 2.0, 3.0);",
                     "const Pose pose{random.vector(1.0), rotation(1, random)};",
                     "for (int i = f(random.engine()()); i < 2, random.unit() < 1; i += 1) {}"):
            with self.subTest(code=code):
                self.assertEqual(found(code), 0)


if __name__ == "__main__":
    unittest.main()
