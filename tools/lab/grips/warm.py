"""Costs of hands that move as in recorded grips, then stand."""
import json
import math
import subprocess

import numpy

from pages import files

LISTS = ("moving_us", "stand_us")
COUNTS = ("joint_frames", "jumps", "shown_jumps")


def record(lab, data, out):
    """Writes the wrists of recorded grips, `handhold-lab recorded-grips`. False: there are no recordings or no level."""
    recordings, level = sorted((data / "vr_input").glob("*.csv")), data / "level/station.glb"
    if not recordings or not level.exists():
        return False
    command = [lab, "recorded-grips", "--scene", level, "--out", out, "--input", *recordings]
    try:
        run = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    except OSError as error:
        raise files.FormatError(f"{lab}: {error.strerror}") from None
    if run.returncode != 0:
        raise files.FormatError(f"recorded grips: exit status {run.returncode}: {(run.stderr.strip().splitlines() or ['no message'])[-1]}")
    return True


def played(path, tries=6):
    """Costs of the recorded grips: the frame of the onset, the `tries` frames after it, and later ones. {name: {median, p99}}."""
    frames = {"closing_us": [], "after_us": [], "later_us": []}
    for _, grip in files.read_jsonl(path):
        us = files.member(grip, "us", path)
        for name, part in zip(frames, (us[:1], us[1:1 + tries], us[1 + tries:])):
            frames[name] += part
    return {name: {"median": float(numpy.median(us)), "p99": float(numpy.percentile(us, 99))} for name, us in frames.items() if us}


def read(path):
    """Reads a file of `handhold-lab grip --warm-json`."""
    try:
        value = json.loads(path.read_text())
        return {**{name: numpy.asarray(value[name], float) for name in LISTS}, **{name: int(value[name]) for name in COUNTS}}
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise files.FormatError(f"{path.name}: expected figures of warm hands: {error}") from None


def figures(meshes):
    """meshes: one read file each. Percentiles over all frames; shares of all joint-frames. None if there are none."""
    runs = [run for mesh in meshes for run in mesh]
    moving = [numpy.concatenate([run["moving_us"] for run in mesh]) for mesh in meshes]
    moving = [frames for frames in moving if frames.size]
    if not moving:
        return None
    whole, stand = numpy.concatenate(moving), numpy.concatenate([run["stand_us"] for run in runs])
    joint_frames = sum(run["joint_frames"] for run in runs)
    share = lambda name: sum(run[name] for run in runs) / joint_frames if joint_frames else math.nan
    return {"moving_us": {"median": float(numpy.median(whole)), "p99": float(numpy.percentile(whole, 99)),
                         "p99_of_meshes": float(numpy.mean([numpy.percentile(frames, 99) for frames in moving]))},
            "stand_us": {"median": float(numpy.median(stand)) if stand.size else math.nan},
            "jumps": share("jumps"), "shown_jumps": share("shown_jumps")}
