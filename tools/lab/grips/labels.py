"""Shares of hands that people called convincing and ugly."""
import csv
import math

from pages import files
from . import critic


def wilson(successes, count):
    """95 % bounds of a share (Wilson 1927)."""
    z, share = 1.959964, successes / count
    middle, half = share + z * z / (2 * count), z * math.sqrt(share * (1 - share) / count + z * z / (4 * count * count))
    return (middle - half) / (1 + z * z / count), (middle + half) / (1 + z * z / count)


def shares(path):
    """{label: {value, low, high}} of a filled labels.csv of `grip_gallery --sheets`, among the hands that can be seen."""
    rows = list(csv.DictReader(files.read_text(path).splitlines()))
    for line, row in enumerate(rows, 2):
        critic.check_label(row.get("label"), f"{path}: line {line}")
    rows = [row for row in rows if row["label"] != critic.HIDDEN]
    if not rows:
        raise files.FormatError(f"{path}: expected at least one label")
    found = {}
    for word in critic.LABELS:
        count = sum(row["label"] == word for row in rows)
        low, high = wilson(count, len(rows))
        found[word] = {"value": count / len(rows), "low": low, "high": high}
    return found
