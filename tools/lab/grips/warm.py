"""Costs of hands that move as in recorded grips, then stand."""
import json
import math
import subprocess

import numpy

from pages import files

DRAWS = 500  # of the bootstrap
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
    """Costs of the recorded grips: the frame of the onset, the `tries` frames after it, and later ones. {name: {median, p99}}, each with
    95 % bounds of a bootstrap that draws whole grips."""
    parts = {"closing_us": slice(0, 1), "after_us": slice(1, 1 + tries), "later_us": slice(1 + tries, None)}
    grips = [numpy.asarray(files.member(grip, "us", path), float) for _, grip in files.read_jsonl(path)]
    found = {}
    for name, part in parts.items():
        frames = [us[part] for us in grips if us[part].size]
        if frames:
            found[name] = {title: bounded_percentile(frames, share) for title, share in (("median", 50), ("p99", 99))}
    return found


def bounded_percentile(grips, share):
    """Percentile of all values of several arrays, with its bounds."""
    rng = numpy.random.default_rng(1)
    draws = [numpy.percentile(numpy.concatenate([grips[i] for i in rng.integers(0, len(grips), len(grips))]), share) for _ in range(DRAWS)]
    low, high = numpy.percentile(draws, (2.5, 97.5))
    return {"value": float(numpy.percentile(numpy.concatenate(grips), share)), "low": float(low), "high": float(high)}


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
