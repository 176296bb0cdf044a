"""bench_peers' figures, without running an engine."""
import importlib.machinery
import importlib.util
import math
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
loader = importlib.machinery.SourceFileLoader("bench_peers", str(ROOT / "tools" / "bench_peers"))
spec = importlib.util.spec_from_loader("bench_peers", loader)
bench_peers = importlib.util.module_from_spec(spec)
loader.exec_module(bench_peers)
from pages import history_plots  # noqa: E402

HEAD = "date,commit,scene,metric,value,unit\n"


class BenchPeers(unittest.TestCase):
    def test_driven_body_has_its_anchor_at_the_hand(self):
        half = math.sqrt(0.5)
        anchor = {"position_m": [0.3, 0.0, 0.0], "rotation_xyzw": [0.0, 0.0, half, half]}
        target = [1.0, 2.0, 3.0, 0.0, 0.0, half, half]  # the same turn as the anchor's: the body is not turned
        for value, expected in zip(bench_peers.driven_pose(target, anchor), [0.7, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0]):
            self.assertAlmostEqual(value, expected)
        upright = {"position_m": [0.3, 0.0, 0.0], "rotation_xyzw": [0.0, 0.0, 0.0, 1.0]}  # turned by 90 degrees about z: x becomes y
        for value, expected in zip(bench_peers.driven_pose(target, upright), [1.0, 1.7, 3.0, 0.0, 0.0, half, half]):
            self.assertAlmostEqual(value, expected)

    def test_time_is_the_median_with_least_and_most(self):
        self.assertEqual(bench_peers.time_text([30.0, 10.0, 20.0]), "20 (10 to 30) µs")
        self.assertEqual(bench_peers.time_text([1500.0, 2500.0, 2000.0]), "2 (1.5 to 2.5) ms")

    def test_table_has_an_engine_that_runs_some_rows(self):
        name = "1,000 drifting boxes"
        results = {name: {"times": {"handhold": [10.0], "bullet": [20.0], "box3d": [5.0]}, "errors": {"overlap, mm": {"handhold": 0.0, "bullet": 12.0}}}}
        table = bench_peers.table(results, ["handhold", "bullet", "box3d"])
        self.assertIn("| 0.50 |", table)
        self.assertIn("overlap, mm: 0; 12", table)
        self.assertEqual({line.count("|") for line in table.splitlines()}, {8})

    def test_every_plot_is_well_formed_and_finds_rows_that_the_tool_appends(self):
        with tempfile.TemporaryDirectory() as folder:
            history = Path(folder) / "history.csv"
            rows = "".join(f'2026-01-0{day},abc,"bench_peers {row.name}: {engine}",us_per_frame_{row.time},{1000 * day},us\n'
                           for day in (1, 2) for row in bench_peers.ROWS for engine in ("Handhold", "Bullet"))
            history.write_text(HEAD + rows)
            history_plots.write_plots(history, Path(folder))
            for name in history_plots.PLOTS:
                tree = ElementTree.fromstring((Path(folder) / name).read_text())
                self.assertTrue(tree.findall(".//{*}circle"), name)


if __name__ == "__main__":
    unittest.main()
