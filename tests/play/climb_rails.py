#!/usr/bin/env python3
"""Plays the game as a person at a keyboard would: in a window on a display of its own, with key presses and a mouse that xdotool moves,
he climbs ten metres along a rail, hand over hand. Nothing of the game is called; it says by --status how it stands, as a player sees it.

usage: tests/play/climb_rails.py HANDHOLD SCENE WORK      exit status: 0 he did; 1 he did not; 77 no Xvfb or no xdotool here

How long it takes depends on the machine: what counts is the game's own time, and each step waits for the game.
"""
import json
import math
import os
import select
import shutil
import subprocess
import sys
import time
from pathlib import Path

SKIPPED = 77
GOAL_M = 10.0
MOUSE_RAD_PER_PX = 0.0025  # as the help of `handhold play` has it
LOOK_DOWN_RAD = 0.7854     # at the rail before him; W and E together then go along it
PATIENCE_S = 420.0         # of real time, on a machine that does much else
BUTTONS = {"left": "1", "right": "3"}


class Game:
    def __init__(self, binary: str, scene: str, work: Path, display: str):
        self.status_file = work / "status.jsonl"
        self.report_file = work / "report.json"
        self.env = dict(os.environ, DISPLAY=display, SDL_VIDEODRIVER="x11", LIBGL_ALWAYS_SOFTWARE="1", SDL_AUDIODRIVER="dummy")
        self.ends = time.monotonic() + PATIENCE_S
        self.offset = 0
        self.last = None
        self.process = subprocess.Popen(
            [binary, "play", "--scene", scene, "--spawn", "end", "--width", "320", "--height", "180", "--quality", "plain", "--status", str(self.status_file), "--report",
             str(self.report_file), "--record", str(work / "session.csv"), "--picture", str(work / "last.png")], env=self.env)

    def do(self, *words: str) -> None:
        subprocess.run(["xdotool", *words], env=self.env, check=True, stdout=subprocess.DEVNULL)

    def look(self) -> dict | None:
        """The newest line of the status that is whole."""
        if self.status_file.is_file():
            with self.status_file.open("rb") as file:
                file.seek(self.offset)
                lines = file.read().split(b"\n")
            self.offset += sum(len(line) + 1 for line in lines[:-1])
            if len(lines) > 1:
                self.last = json.loads(lines[-2])
        return self.last

    def wait(self, what: str, is_so, game_s: float = 1e9) -> bool:
        """Until it is so, or so much of the game's time has gone by."""
        begin = None
        while True:
            if time.monotonic() > self.ends:
                raise TimeoutError(f"waited {PATIENCE_S} s; the last was for {what}; {self.last}")
            if self.process.poll() is not None:
                raise RuntimeError(f"the game ended by itself, status {self.process.returncode}")
            now = self.look()
            if now is not None:
                begin = now["t_s"] if begin is None else begin
                if is_so(now):
                    return True
                if now["t_s"] - begin > game_s:
                    return False
            time.sleep(0.02)


def grips(side: str):
    return lambda now: now[side]["grip"] == "surface"


def aim_at_rail(game: Game) -> None:
    """Mouse down until he looks 45 degrees down: in small moves, looking at what came of each."""
    for _ in range(40):
        looks = game.last["looks"]
        down_rad = LOOK_DOWN_RAD + math.asin(looks[1])
        pixels = round(down_rad / MOUSE_RAD_PER_PX)
        if abs(pixels) <= 2:
            return
        game.do("mousemove_relative", "--", "0", str(max(-60, min(60, pixels))))
        seen_s = game.last["t_s"]
        game.wait("the look", lambda now: now["t_s"] > seen_s + 0.15)
    raise RuntimeError(f"the mouse does not turn his head: {game.last}")


def climb(game: Game) -> None:
    game.wait("the first status", lambda now: True)
    window = subprocess.run(["xdotool", "search", "--sync", "--name", "Handhold"], env=game.env, check=True, capture_output=True,
                            text=True).stdout.split()[0]
    game.do("windowfocus", "--sync", window)
    game.do("mousemove", "--window", window, "160", "90")
    game.wait("half a second", lambda now: now["t_s"] > 0.5)
    aim_at_rail(game)
    side, other = "left", "right"
    game.do("mousedown", BUTTONS[side])
    if not game.wait("the first grip", grips(side), 2.0):
        raise RuntimeError(f"his first reach found nothing: {game.last}")
    for key in ("w", "e"):  # his arms end the pull by themselves
        game.do("keydown", key)
    while game.last["climbed_m"] < GOAL_M + 0.5:
        begin_m = game.last["climbed_m"]
        game.wait("the pull", lambda now: now["climbed_m"] > begin_m + 0.35, 1.0)
        game.do("mousedown", BUTTONS[other])
        if not game.wait("the other hand", grips(other), 2.0):
            game.do("mouseup", BUTTONS[other])  # missed: once more
            game.wait("an open hand", lambda now: not grips(other)(now), 1.0)
            continue
        game.do("mouseup", BUTTONS[side])
        game.wait("an open hand", lambda now: not grips(side)(now), 2.0)
        side, other = other, side
    for key in ("w", "e"):
        game.do("keyup", key)
    game.do("mouseup", BUTTONS[side])
    game.do("key", "Escape")
    game.process.wait(timeout=60)


def judge(game: Game) -> list[str]:
    report = json.loads(game.report_file.read_text(encoding="utf-8"))
    print(json.dumps({key: report[key] for key in ("played_s", "climbed_m", "moved_m", "grips", "hand_changes", "times_us")}))
    wrong = []
    if game.process.returncode != 0:
        wrong.append(f"the game's exit status is {game.process.returncode}")
    if report["climbed_m"] < GOAL_M:
        wrong.append(f"climbed {report['climbed_m']:.2f} m of {GOAL_M}")
    if -report["moved_m"][2] < 0.95 * GOAL_M:
        wrong.append(f"came {-report['moved_m'][2]:.2f} m along the rail")
    # An arm pulls 0.8 m at most, so that no ten metres are one pull and a glide.
    if report["hand_changes"] < 12:
        wrong.append(f"changed hands {report['hand_changes']} times")
    if report["fallbacks"].get("grip_stretched", 0) > 0:
        wrong.append("a hand was torn off the rail")
    return wrong


def main() -> int:
    for program in ("Xvfb", "xdotool"):
        if shutil.which(program) is None:
            print(f"skipped: no {program}; tools/install_packages test installs it")
            return SKIPPED
    binary, scene, work = sys.argv[1], sys.argv[2], Path(sys.argv[3])
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    # Xvfb takes a number that is free and says which.
    read_end, write_end = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(write_end), "-screen", "0", "640x480x24", "-nolisten", "tcp"], pass_fds=[write_end],
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    game = None
    try:
        os.close(write_end)
        if not select.select([read_end], [], [], 60)[0]:
            raise RuntimeError("Xvfb does not start")
        game = Game(binary, scene, work, ":" + os.read(read_end, 16).decode().strip())
        climb(game)
        wrong = judge(game)
    except (TimeoutError, RuntimeError, subprocess.SubprocessError) as error:
        wrong = [str(error)]
    finally:
        for process in (game.process if game else None, server):
            if process is not None and process.poll() is None:
                process.terminate()
                process.wait(timeout=20)
    print("\n".join(wrong) if wrong else "he climbed")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
