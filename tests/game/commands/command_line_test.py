"""Runs the game as a process and ends it in every way there is: one line, an exit status, and no part of a file is left.

usage: command_line_test.py GAME [unittest's flags]
"""
import fcntl
import json
import os
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

GAME = Path(sys.argv.pop(1)).resolve()
CONTROL = re.compile(r"[\x00-\x09\x0b-\x1f\x7f-\x9f]")
SANITIZED = b"__asan_init" in GAME.read_bytes()


class CommandLine(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name).resolve() / "inside"
        self.folder.mkdir()

    def run_game(self, *words, **options) -> subprocess.CompletedProcess:
        ended = subprocess.run([str(GAME), *map(str, words)], capture_output=True, timeout=300, check=False, cwd=self.folder, **options)
        ended.out = ended.stdout.decode(errors="replace")
        ended.err = ended.stderr.decode(errors="replace")
        self.assertGreaterEqual(ended.returncode, 0, f"ended by a signal: {ended.err}")
        self.assertNotRegex(ended.out + ended.err, CONTROL)
        return ended

    def files(self) -> set[str]:
        root = self.folder.parent
        return {str(path.relative_to(root)) for path in root.rglob("*") if not path.is_dir()}

    def assert_one_line(self, ended, status: int):
        self.assertEqual(ended.returncode, status, ended.err)
        self.assertEqual(ended.err.count("\n"), 1, ended.err)

    # Flags

    def test_numbers_that_are_none_are_wrong_flags(self):
        for words in (["--hz", "nan"], ["--hz", "-nan"], ["--hz", "inf"], ["--seconds", "nan"], ["--seconds", "-1"], ["--seed", "-1"],
                      ["--seed", "1e30"], ["--seed", ""], ["--players", "nan"], ["--threads", "-1"], ["--hz", "\x1b[31m"]):
            with self.subTest(words=words):
                ended = self.run_game("run", "--scene", "reach", *words)
                self.assertEqual(ended.returncode, 1, ended.err)
                self.assertIn("Usage", ended.err)
        for words in (["--yaw", "nan"], ["--pitch", "inf"], ["--seconds", "nan"]):
            with self.subTest(words=words):
                self.assertEqual(self.run_game("pictures", "--scene", "reach", "--out", "o", *words).returncode, 1)
        self.assertEqual(self.files(), set())

    def test_help_shows_choices_as_words(self):
        shown = {}
        for command in ("run", "play", "pictures", "climb", "serve", "bots", "export-grip", "build-station"):
            shown[command] = self.run_game(command, "--help").out
            self.assertNotRegex(shown[command], r"[{}]|->")
        for words in ("--turn smooth|snap", "--view behind|eyes|mirror", "--page Frame|Hands|Bodies|Tuning|Entities|Gizmos"):
            self.assertIn(words, shown["play"])
        for words in (["pictures", "--scene", "reach", "--out", "o", "--hands", "flat"], ["play", "--turn", "0"]):
            ended = self.run_game(*words)
            self.assertEqual(ended.returncode, 1, ended.err)
            self.assertIn("expected ", ended.err)

    def test_largest_seed_is_taken(self):
        self.assertEqual(self.run_game("run", "--scene", "reach", "--seconds", "0.1", "--seed", 2**64 - 1).returncode, 0)

    # Names from files

    def test_messages_quote_files_briefly_and_without_controls(self):
        name = "\x1b]0;owned\x07" + 5000 * "y"
        for text in ({"name": name, "bodies": [{"name": name}]}, {"name": "s", name: 1}, {"name": "s", "spawns": [{"name": name}], "joints": [{}]}):
            (self.folder / "s.json").write_text(json.dumps(text))
            ended = self.run_game("run", "--scene", "s.json")
            self.assert_one_line(ended, 2)
            self.assertLessEqual(ended.err.count("y"), 200, ended.err)

    def test_station_names_never_lead_out_of_the_folder(self):
        section = {"name": "a", "type": "node", "accent": [1, 1, 1], "seed": 1}
        for name in ("../../x", "/tmp/handhold_escape", "a/b", "..", ".", "a\nb", "-x", ".hidden", 200 * "n"):
            for text in ({"name": name, "sections": [section]}, {"name": "s", "sections": [section | {"name": name}]},
                         {"name": "s", "sections": [section], "spawns": [{"name": name, "eyes_m": [0, 0, 0], "ahead": [0, 0, 1]}]}):
                (self.folder / "d.json").write_text(json.dumps(text))
                with self.subTest(text=text):
                    self.assert_one_line(self.run_game("build-station", "d.json", "--out", "out"), 2)
        self.assertEqual(self.files(), {"inside/d.json"})

    def test_pictures_of_any_spawn_stay_in_the_folder(self):
        names = ["../../x", "/tmp/handhold_escape", "a\nb", "module 1/hatch", ".", "é"]
        scene = {"name": "s", "spawns": [{"name": name} for name in names]}
        (self.folder / "s.json").write_text(json.dumps(scene))
        ended = self.run_game("pictures", "--scene", "s.json", "--out", "out", "--width", "16", "--height", "16")
        if "no pictures" in ended.err:
            self.skipTest(ended.err)
        self.assertEqual(ended.returncode, 0, ended.err)
        self.assertEqual({Path(file).parent.as_posix() for file in self.files()}, {"inside", "inside/out"})
        self.assertEqual(len(self.files()), len(names) + 1)

    # Places to write to

    def test_full_disk_is_named(self):
        for words in (["run", "--scene", "reach", "--seconds", "0.1", "--trace", "/dev/full"], ["export-body", "--out", "/dev/full"]):
            ended = self.run_game(*words)
            self.assertEqual(ended.returncode, 2, ended.err)
            self.assertIn("No space left on device", ended.err)
        with open("/dev/full", "wb") as full:
            ended = subprocess.run([str(GAME), "--help"], stdout=full, stderr=subprocess.PIPE, check=False, timeout=60)
        self.assertEqual(ended.returncode, 2)
        self.assertIn(b"No space left on device", ended.stderr)

    def test_limit_on_file_sizes_is_an_error_and_leaves_nothing(self):
        ended = self.run_game("run", "--scene", "ship", "--seconds", "2", "--no-pictures", "--out", "out",
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096)))
        self.assert_one_line(ended, 2)
        self.assertIn("File too large", ended.err)
        self.assertEqual([file for file in self.files() if "tmp" in Path(file).name or "part" in Path(file).name], [])

    def test_pipes_and_links_are_not_replaced(self):
        os.mkfifo(self.folder / "pipe")
        self.assert_one_line(self.run_game("export-body", "--out", "pipe"), 2)
        self.assertTrue((self.folder / "pipe").is_fifo())
        (self.folder / "link").symlink_to("target.glb")
        self.assert_one_line(self.run_game("export-body", "--out", "link"), 2)
        (self.folder / "target.glb").write_bytes(b"")
        self.assertEqual(self.run_game("export-body", "--out", "link").returncode, 0)
        self.assertTrue((self.folder / "link").is_symlink())
        self.assertGreater((self.folder / "target.glb").stat().st_size, 1000)

    def test_folder_in_use_is_refused(self):
        (self.folder / "out").mkdir()
        holder = os.open(self.folder / "out", os.O_RDONLY)
        fcntl.flock(holder, fcntl.LOCK_EX)
        self.assert_one_line(self.run_game("run", "--scene", "reach", "--seconds", "0.1", "--out", "out", "--no-pictures"), 2)
        os.close(holder)
        self.assertEqual(self.run_game("run", "--scene", "reach", "--seconds", "0.1", "--out", "out", "--no-pictures").returncode, 0)

    # Ends from outside

    def test_interrupted_run_leaves_whole_files(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(signal=number):
                game = subprocess.Popen([str(GAME), "run", "--scene", "ship", "--seconds", "100000", "--out", "out"], cwd=self.folder,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE)
                time.sleep(3.0)
                game.send_signal(number)
                out, err = game.communicate(timeout=120)
                self.assertEqual(game.returncode, 130, err)
                self.assertIn(b"interrupted", out)
                self.assertRegex(out.splitlines()[-1], rb"^state_hash 0x[0-9a-f]{16}$")
                report = json.loads((self.folder / "out/report.json").read_text())
                rows = (self.folder / "out/frames.csv").read_text().splitlines()
                self.assertEqual(len(rows), report["frames"] * len(report.get("players", [1])) + 1)
                self.assertEqual([file for file in self.files() if ".part" in file or ".tmp" in file], [])

    @unittest.skipIf(SANITIZED, "a sanitizer takes the whole address space")
    def test_too_little_memory_is_one_line(self):
        met = 0
        for megabytes in (60, 80, 100, 140, 200, 280):
            limit = megabytes << 20
            ended = self.run_game("run", "--scene", "station", "--seconds", "0.1",
                                  preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
            if ended.returncode == 127:
                continue  # too little for the loader of programs
            self.assertIn(ended.returncode, (0, 4), ended.err)
            if ended.returncode == 4:
                met += 1
                self.assertEqual(ended.err.count("\n"), 1, ended.err)
        self.assertGreater(met, 0)


if __name__ == "__main__":
    unittest.main()
