"""Shuffled sheets of hands of several variants, to be labelled by a person who does not know which is which."""
import csv
import io
import json
import pathlib
import random

from pages import files
from . import critic, glb, scoring
from .grasps import read_grasps
from .surface import Surface

HANDS, COLUMNS = 6, 2  # of one sheet
FIELDS = ("sheet", "row", "column", "label", "reason")


def choose(variants, count, seed):
    """The key: one entry per hand, in the order of the sheets. variants: [{mesh name: [ids]}]; `count` hands of each are drawn. All hands
    of a sheet are on one mesh."""
    rng = random.Random(seed)
    by_mesh = {}
    for variant, ids in enumerate(variants):
        every = [(name, one) for name in sorted(ids) for one in sorted(ids[name])]
        for name, one in rng.sample(every, min(count, len(every))):
            by_mesh.setdefault(name, []).append((variant, one))
    sheets = []
    for name in sorted(by_mesh):
        hands = rng.sample(by_mesh[name], len(by_mesh[name]))
        sheets += [(name, hands[i:i + HANDS]) for i in range(0, len(hands), HANDS)]
    rng.shuffle(sheets)
    return [{"sheet": sheet, "row": place // COLUMNS, "column": place % COLUMNS, "mesh": name, "variant": variant, "id": one}
            for sheet, (name, hands) in enumerate(sheets) for place, (variant, one) in enumerate(hands)]


def sheets_of(key):
    """Entries by sheet."""
    sheets = {}
    for entry in key:
        sheets.setdefault(entry["sheet"], []).append(entry)
    return sheets


def form(key):
    """The table to be filled in."""
    return ",".join(FIELDS) + "\n" + "".join(f"{one['sheet']},{one['row']},{one['column']},,\n" for one in key)


def read_labels(path, key):
    """[(label, reason)] in the order of the key."""
    rows = list(csv.DictReader(files.read_text(path).splitlines()))
    for line, row in enumerate(rows, 2):
        critic.check_label(row.get("label"), f"{path}: line {line}")
    found = {tuple(row.get(name) for name in FIELDS[:3]): row for row in rows}
    places = [tuple(str(one[name]) for name in FIELDS[:3]) for one in key]
    missing = [place for place in places if place not in found]
    if missing:
        raise files.FormatError(f"{path}: expected a row of sheet {missing[0][0]}, row {missing[0][1]}, column {missing[0][2]}")
    return [(found[place]["label"], found[place].get("reason") or "") for place in places]


def feature_rows(cases, key):
    """Features of every hand of the key. cases: [{mesh name: (mesh, grasps)}] by variant."""
    measured, rows = {}, []
    for name in {one["mesh"] for one in key}:
        surface = Surface(glb.read_triangles(next(variant[name][0] for variant in cases if name in variant)))
        for variant in {one["variant"] for one in key if one["mesh"] == name}:
            grasps, capsules = read_grasps(cases[variant][name][1])
            values = critic.features(surface, grasps, capsules, scoring.part_gaps_mm(surface, grasps, capsules))
            measured[name, variant] = {grasp.id: row for grasp, row in zip(grasps, values)}
    for one in key:
        rows.append(measured[one["mesh"], one["variant"]][one["id"]])
    return rows


def labels_csv(labels, key, values):
    """Text of a file for grip_critic."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(("label", "reason", "group", *critic.FEATURES))
    for (label, reason), one, row in zip(labels, key, values):
        if label == critic.HIDDEN:
            continue
        writer.writerow((critic.LABELS.index(label), reason, one["mesh"], *(f"{value:.6g}" for value in row)))
    return out.getvalue()


def write_hands(path, source, entries):
    """Writes a sheet's hands as one file with their places as ids. source: {(variant, mesh): file}."""
    lines = []
    for place, one in enumerate(entries):
        line = next(value for _, value in files.read_jsonl(source[one["variant"], one["mesh"]]) if value["id"] == one["id"])
        lines.append(json.dumps({**line, "id": place}))
    pathlib.Path(path).write_text("\n".join(lines) + "\n", encoding="utf-8")
