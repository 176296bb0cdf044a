"""grip_films' choice of grips for stills."""
import argparse
import importlib.machinery
import importlib.util
import json
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools" / "lab"))


def load_script():
    loader = importlib.machinery.SourceFileLoader("grip_films", str(ROOT / "tools" / "lab" / "grip_films"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("grip_films", loader))
    loader.exec_module(module)
    return module


class Stills(unittest.TestCase):
    def test_each_lasting_grip_is_drawn_once_in_its_middle(self):
        films = load_script()
        grips = {"l": ((5, 20), (30, 90)), "r": ((100, 150),)}  # first frame, frame after the last
        rows = ["player,l_grip,l_body,r_grip,r_body"]
        for frame in range(160):
            held = ["1,rail" if any(first <= frame < end for first, end in grips[side]) else "0," for side in "lr"]
            rows.append(f"0,{held[0]},{held[1]}")
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            game = folder / "game"
            game.write_text("#!/bin/sh\n")
            game.chmod(0o700)
            (folder / "frames.csv").write_text("\n".join(rows) + "\n")
            arguments = argparse.Namespace(game=[game], scene="station", climbers=None, limit=[], count=5, fov=26.0, width=60, height=50)
            stills = films.draw_stills(arguments, game, None, folder, 7)
            shots = json.loads((folder / "shots.json").read_text())["shots"]
        self.assertEqual([(shot["name"], shot["side"], round(shot["at_s"] * films.HZ)) for shot in shots], [("drawn7", "left", 61), ("drawn8", "right", 126)])
        self.assertEqual([(still["side"], still["mesh"], still["frame"]) for still in stills], [("left", "rail", 60), ("right", "rail", 125)])


if __name__ == "__main__":
    unittest.main()
