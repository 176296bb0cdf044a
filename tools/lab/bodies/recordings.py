"""Files of `handhold-lab body` and the ground truth: columns by name, in any order; other columns are ignored."""
import gzip
import pathlib

import numpy as np

from pages.files import FormatError, read_bytes, read_text

SIDES = ("l", "r")
XYZ = ("x", "y", "z")


def found(folder, name):
    """folder/name, or folder/name.gz if only that exists."""
    path = pathlib.Path(folder) / name
    packed = path.with_name(name + ".gz")
    return packed if packed.exists() and not path.exists() else path


def text_of(path):
    """The text of a file that may be compressed with gzip (.gz)."""
    if pathlib.Path(path).suffix != ".gz":
        return read_text(path)
    try:
        return gzip.decompress(read_bytes(path)).decode("utf-8")
    except (OSError, EOFError, UnicodeDecodeError) as error:
        raise FormatError(f"{path}: expected UTF-8 compressed with gzip: {error}") from None


def has_column(path, name):
    return name in text_of(path).split("\n", 1)[0].strip().split(",")


def read_rows(path, wanted, optional=()):
    """{column: values} of a CSV with one header row, for the wanted columns, and for those of the optional ones that exist."""
    lines = text_of(path).splitlines()
    head = lines[0].split(",") if lines else []
    missing = [name for name in wanted if name not in head]
    if missing:
        raise FormatError(f"{path}: line 1: expected a column {missing[0]}")
    if len(lines) < 2:
        raise FormatError(f"{path}: expected rows below the header")
    rows = []
    for number, line in enumerate(lines[1:], 2):
        cells = line.split(",")
        if len(cells) != len(head):
            raise FormatError(f"{path}: line {number}: expected {len(head)} cells, found {len(cells)}")
        rows.append(cells)
    names = [*wanted, *(name for name in optional if name in head)]
    return {name: [row[head.index(name)] for row in rows] for name in names}


def read_numbers(path, wanted):
    columns = {}
    for name, cells in read_rows(path, wanted).items():
        try:
            columns[name] = np.array(cells, float)
        except ValueError:
            columns[name] = np.array([number_or_nan(cell) for cell in cells])
        bad = np.flatnonzero(~np.isfinite(columns[name]))
        if len(bad):
            raise FormatError(f"{path}: line {bad[0] + 2}: expected a finite number in column {name}")
    return columns


def number_or_nan(cell):
    try:
        return float(cell)
    except ValueError:
        return np.nan


def vectors(columns, name, axes=XYZ):
    return np.stack([columns[name + axis] for axis in axes], -1)


class Recording:
    """IN.csv: clip, t_s, head_m (rows, 3), head_xyzw (rows, 4), hand_m (2, rows, 3), left first; hand_xyzw (2, rows, 4)."""

    def __init__(self, path):
        names = ["clip", "t"] + ["h" + axis for axis in XYZ] + ["hq" + axis for axis in "xyzw"] + [side + axis for side in SIDES for axis in XYZ]
        names += [side + "q" + axis for side in SIDES for axis in "xyzw"]
        columns = read_numbers(path, names)
        self.clip, self.t_s = columns["clip"], columns["t"]
        self.head_m, self.head_xyzw = vectors(columns, "h"), vectors(columns, "hq", "xyzw")
        self.hand_m = np.stack([vectors(columns, side) for side in SIDES])
        self.hand_xyzw = np.stack([vectors(columns, side + "q", "xyzw") for side in SIDES])
        step = np.diff(self.t_s)[self.clip[1:] == self.clip[:-1]]
        if not len(step) or np.median(step) <= 0.0:
            raise FormatError(f"{path}: expected times that increase within a clip")
        self.hz = 1.0 / np.median(step)


class Bodies:
    """TRUTH.csv or OUT.csv: yaw_deg (rows), shoulder_m and elbow_m (2, rows, 3), left first; for the truth also valid (rows)."""

    def __init__(self, path, recording, is_truth=False):
        names = ["clip", "t", "chest_yaw_deg"] + [side + part + axis for part in ("sh", "el") for side in SIDES for axis in XYZ]
        columns = read_numbers(path, names + ["valid"] * is_truth)
        if len(columns["t"]) != len(recording.t_s):
            raise FormatError(f"{path}: expected {len(recording.t_s)} rows, found {len(columns['t'])}")
        other = np.flatnonzero((columns["clip"] != recording.clip) | (np.abs(columns["t"] - recording.t_s) > 1e-3))
        if len(other):
            raise FormatError(f"{path}: line {other[0] + 2}: expected the clip and time of the recording's line {other[0] + 2}")
        self.yaw_deg = columns["chest_yaw_deg"]
        self.shoulder_m = np.stack([vectors(columns, side + "sh") for side in SIDES])
        self.elbow_m = np.stack([vectors(columns, side + "el") for side in SIDES])
        self.valid = columns["valid"] > 0 if is_truth else None


class Clips:
    """CALIB.csv: by clip its name, person, source (column dataset, if there is one), and measures (empty if
    the file has none): eye height, upper arm, forearm, shoulder width."""

    SIZES = ("eye_height", "upper_arm", "forearm", "shoulder_width")

    def __init__(self, path, recording):
        columns = read_rows(path, ["clip", "name", "subject"], ["dataset", *self.SIZES])
        numbers = [number_or_nan(cell) for cell in columns["clip"]]
        self.name, self.person = dict(zip(numbers, columns["name"])), dict(zip(numbers, columns["subject"]))
        self.source = dict(zip(numbers, columns.get("dataset", ["unknown"] * len(numbers))))
        sizes = [[number_or_nan(cell) for cell in columns.get(size, [])] for size in self.SIZES]
        self.measures = dict(zip(numbers, zip(*sizes)))
        unknown = sorted(set(recording.clip) - set(numbers))
        if unknown:
            raise FormatError(f"{path}: expected a row for clip {unknown[0]:g}")
        self.people = sorted({self.person[clip] for clip in set(recording.clip)})

    def sources(self, recording):
        """The source of each row."""
        return np.array([self.source[clip] for clip in recording.clip])

    def rows_of(self, recording, person):
        return np.isin(recording.clip, [clip for clip, owner in self.person.items() if owner == person])
