"""Costs of hands that slide over a surface, then stand."""
import json
import math

import numpy

from pages import files

SPEED_MPS = 0.3
LISTS = ("slide_us", "stand_us")
COUNTS = ("joint_frames", "jumps", "shown_jumps")


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
    slides = [numpy.concatenate([run["slide_us"] for run in mesh]) for mesh in meshes]
    slides = [slide for slide in slides if slide.size]
    if not slides:
        return None
    whole, stand = numpy.concatenate(slides), numpy.concatenate([run["stand_us"] for run in runs])
    joint_frames = sum(run["joint_frames"] for run in runs)
    share = lambda name: sum(run[name] for run in runs) / joint_frames if joint_frames else math.nan
    return {"slide_us": {"median": float(numpy.median(whole)), "p99": float(numpy.percentile(whole, 99)),
                         "p99_of_meshes": float(numpy.mean([numpy.percentile(slide, 99) for slide in slides]))},
            "stand_us": {"median": float(numpy.median(stand)) if stand.size else math.nan},
            "jumps": share("jumps"), "shown_jumps": share("shown_jumps")}
