"""match_report's rows and simulated networks, without running anything but one stand-in."""
import json
import math
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools" / "lab"))
from matches import programs, rows, soak
from pages.files import FormatError

FIGURES = {"hashes_compared": 100, "hashes_different": 0, "stalls": 0, "grips": 5, "throws": 2, "shared_holds": 50, "player_holds": 9,
           "rollback": {"ticks": {"max": 20.0}}, "confirmed_ticks": 5400}
FLAGS = {"seed": 3, "peers": 2, "first-pair": 0}


class Rows(unittest.TestCase):
    def test_limits_are_met_at_their_value_and_missed_beyond(self):
        self.assertEqual(rows.bounded("x", [18.0, 95.0], [18, 95], "mm", "").verdict(), "met")
        self.assertEqual(rows.bounded("x", [18.0, 95.01], [18, 95], "mm", "").verdict(), "MISSED")
        self.assertEqual(rows.bounded("x", [math.nan, 95], [18, 95], "mm", "").verdict(), "not run")

    def test_a_missing_counter_is_not_run(self):
        self.assertEqual(rows.rollback({}, 24, 5, "")[0].verdict(), "not run")
        self.assertEqual(rows.server_tick({"tick_us_median": 250.0, "tick_us_p99": 501.0}, "")[0].verdict(), "MISSED")

    def test_own_hands_may_only_differ_where_the_server_filled(self):
        def verdict(unexplained, share, ticks=10):
            return rows.own_hand({"own_hand": {"ticks": ticks, "unexplained": unexplained}, "filled_share": share}, "")[0].verdict()

        self.assertEqual([verdict(0, 0.005), verdict(1, 0.0), verdict(0, 0.0051), verdict(0, 0.0, 0)], ["met", "MISSED", "MISSED", "MISSED"])

    def test_sixteen_servers_fit_two_cores_at_an_eighth_of_a_core_each(self):
        verdicts = [rows.server_process({"cpu_share": share, "ticks_per_s": ticks}, "")[0].verdict()
                    for share, ticks in ((0.125, 90.0), (0.126, 90.0), (0.1, 80.0))]
        self.assertEqual(verdicts, ["met", "MISSED", "MISSED"])

    def test_fewer_matches_than_wanted_are_not_run_unless_one_is_faulty(self):
        run = (FLAGS, FIGURES)  # a minute
        self.assertEqual(rows.matches([run], 1, 1, "")[0].verdict(), "met")
        self.assertEqual(rows.matches([run], 2, 1, "")[0].verdict(), "not run")
        faulty = (FLAGS, {**FIGURES, "hashes_different": 1})
        self.assertEqual(rows.matches([run, faulty], 1000, 1, "")[0].verdict(), "MISSED")
        self.assertEqual(rows.matches([], 1000, 200, "")[0].verdict(), "MISSED")

    def test_fuzzing_is_met_by_ten_million_inputs_without_a_finding(self):
        printed = "net        9000000 runs, nothing found\nmatch      1000000 runs, nothing found\n"
        self.assertEqual(rows.hostile(programs.fuzz_runs(printed), "")[0].verdict(), "met")
        self.assertEqual(rows.hostile(programs.fuzz_runs(printed.replace("1000000 runs", "999999 runs")), "")[0].verdict(), "not run")
        self.assertEqual(rows.hostile(programs.fuzz_runs(printed + "peers      FAILED: build/fuzz/found/peers-*\n"), "")[0].verdict(), "MISSED")

    def test_page_and_table_have_every_row_and_its_command(self):
        table = [rows.bounded("a < b", [1.0], [2], "mm", "run --x 1"), rows.not_run("c | d", "0", "run | tee")]
        tree = ElementTree.fromstring(rows.page(table, "").split("<!doctype html>")[1].replace('<meta charset="utf-8">', "").replace("<br>", "<br/>"))
        self.assertEqual([code.text for code in tree.iter("code")], ["run --x 1", "run | tee"])
        lines = rows.markdown(table).splitlines()
        self.assertEqual(len(lines), 4)
        self.assertEqual({line.replace("\\|", "").count("|") for line in lines}, {6})


class Soak(unittest.TestCase):
    def test_networks_follow_from_seeds_and_cover_every_task(self):
        flags = [soak.network_of(seed) for seed in range(1, 201)]
        self.assertEqual(flags, [soak.network_of(seed) for seed in range(1, 201)])
        self.assertEqual(set().union(*(soak.tasks_of(one) for one in flags)), {0, 1, 2, 3})
        self.assertEqual({one["peers"] for one in flags}, {2, 4, 8})
        for name in ("loss", "burst-loss", "duplicate"):
            used = sum(one[name] > 0 for one in flags)
            self.assertTrue(50 < used < 150, name)
        self.assertTrue(30 < sum("kbps" in one for one in flags) < 90)

    def test_a_run_that_proves_nothing_is_a_fault(self):
        self.assertEqual(soak.faults_of(FLAGS, FIGURES), [])
        for name in ("grips", "throws", "shared_holds", "hashes_compared"):
            self.assertEqual(soak.faults_of(FLAGS, {**FIGURES, name: 0}), [f"no {name}"])
        self.assertEqual(soak.faults_of(FLAGS, {**FIGURES, "rollback": {"ticks": {"max": 0.0}}}), ["no rollbacks"])
        self.assertEqual(soak.faults_of(FLAGS, {**FIGURES, "stalls": 2}), ["2 stalls"])
        holders = {**FLAGS, "first-pair": 3}
        self.assertEqual(soak.faults_of(holders, {**FIGURES, "shared_holds": 0}), [])
        self.assertEqual(soak.faults_of(holders, {**FIGURES, "player_holds": 0}), ["no player_holds"])
        self.assertEqual(soak.faults_of(FLAGS, {**FIGURES, "player_holds": 0}), [])

    def test_a_log_is_continued(self):
        class StandIn:
            def __init__(self):
                self.seeds = []

            def match(self, flags, may_fail):
                self.seeds.append(flags["seed"])
                return FIGURES

        with tempfile.TemporaryDirectory() as folder:
            log = Path(folder) / "log.jsonl"
            first, second = StandIn(), StandIn()
            soak.run(first, 2, 2, log=log)
            runs = soak.run(second, 4, 4, log=log)
        self.assertEqual((first.seeds, second.seeds), ([1, 2], [3, 4]))
        total = soak.summary(runs)
        self.assertEqual((total["seeds"], total["minutes"], total["throws"], total["faulty"]), (4, 4.0, 8, []))


class Programs(unittest.TestCase):
    def test_lists_are_repeated_flags(self):
        self.assertEqual(programs.words_of({"input": ["a", "b"], "peers": 2}), ["--input", "a", "--input", "b", "--peers", "2"])
        self.assertEqual(programs.command_line("lab", {"input": ["a b"], "peers": 2}), "lab --input 'a b' --peers 2")

    def test_metrics_and_addresses_are_read(self):
        self.assertEqual(programs.metric_in("# TYPE handhold_tick gauge\nhandhold_tick 12\nhandhold_tick_late_seconds 0.5\n", "tick"), 12.0)
        with self.assertRaises(FormatError):
            programs.metric_in("handhold_tick_late_seconds 1\n", "tick")
        self.assertEqual(programs.address_in('event=serves url="ws://127.0.0.1:4711"'), "ws://127.0.0.1:4711")
        self.assertIsNone(programs.address_in("event=loads"))


if __name__ == "__main__":
    unittest.main()
