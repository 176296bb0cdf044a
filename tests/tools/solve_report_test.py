"""solve_report's figures, without running anything."""
import importlib.machinery
import importlib.util
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "tools" / "lab" / "solve_report"
loader = importlib.machinery.SourceFileLoader("solve_report", str(SCRIPT))
spec = importlib.util.spec_from_loader("solve_report", loader)
solve_report = importlib.util.module_from_spec(spec)
loader.exec_module(solve_report)


class SolveReport(unittest.TestCase):
    def test_growth_is_the_exponent_of_a_power(self):
        for power in (1.0, 1.5, 3.0):
            points = [(n, 7.0 * n ** power) for n in (8, 64, 128, 256)]
            self.assertAlmostEqual(solve_report.growth_exponent(points), power)

    def test_growth_uses_long_chains_only(self):
        points = [(8, 1000.0), (64, 64.0), (128, 128.0), (256, 256.0)]
        self.assertAlmostEqual(solve_report.growth_exponent(points), 1.0)

    def test_goal_is_met_at_its_limit_and_missed_above(self):
        self.assertEqual(solve_report.at_most("x", 50.0, 50, "us").verdict(), "pass")
        self.assertEqual(solve_report.at_most("x", 50.1, 50, "us").verdict(), "MISS")

    def test_plot_is_well_formed_and_has_every_point_above_zero(self):
        drawing = solve_report.plot("a < b", "n", "mm", {"direct": [(8, 1e-4), (16, 0.0), (32, 1e-3)], "plain": [(8, 2.0)]})
        tree = ElementTree.fromstring(drawing)
        self.assertEqual(len(tree.findall(".//circle")), 3)
        self.assertEqual(len(tree.findall(".//polyline")), 2)

    def test_goals_of_a_missing_length_are_not_run(self):
        self.assertEqual(solve_report.Goal("chain 1024", "-", "x", None).verdict(), "not run")


if __name__ == "__main__":
    unittest.main()
