"""Plots of tests/bench/history.csv for docs/reference/figures.md: one SVG file per plot, for light and dark pages."""
import csv
import html
import re

from .svg import nice_ticks

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 720, 300, 60, 20, 34, 66
GREEN, BLUE, RED = "#0b8f64", "#3b7fd4", "#c8553d"
UNITS_US = {"us": 1.0, "ms": 1e3}

# file: (title, [(key, color, pattern of the scene, pattern of the metric)]). A row's point is its value, also if the machine was
# under load. Variants are left out by the patterns.
PLOTS = {
    "figures_chain.svg": ("Chain of 128 links: median of a whole frame, microseconds", [
        ("Handhold", GREEN, r"bench_peers chain of 128 links: Handhold", r"us_per_frame_median"),
        ("Bullet", BLUE, r"bench_peers chain of 128 links: Bullet", r"us_per_frame_median")]),
    "figures_heap.svg": ("Heaps: worst whole frame, milliseconds", [
        ("64 crates", GREEN, r"handhold-lab solve heap 64: worst frame(; machine under load)?|bench_peers heap of 64 crates: Handhold",
         r"max|us_per_frame_max"),
        ("512 crates", RED, r"handhold-lab solve heap 512: worst frame(; machine under load)?|bench_peers heap of 512 crates: Handhold",
         r"max|us_per_frame_max"),
        ("64 crates, Bullet", BLUE, r"handhold-lab solve heap 64 --solver bullet: worst frame|bench_peers heap of 64 crates: Bullet",
         r"max|us_per_frame_max")]),
    "figures_boxes.svg": ("1,000 drifting boxes: median of a whole frame, milliseconds", [
        ("Handhold", GREEN, r"bench_peers 1,000 drifting boxes: Handhold", r"us_per_frame_median"),
        ("Bullet", BLUE, r"bench_peers 1,000 drifting boxes: Bullet", r"us_per_frame_median")]),
}


def read_series(path, plots):
    """{file: {key: [(label, value)]}} in the order of the table."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    found = {}
    for name, (_, series) in plots.items():
        found[name] = {}
        for key, _, scene, metric in series:
            found[name][key] = [(f"{row['date'][5:]} {row['commit'][:7]}", UNITS_US.get(row["unit"], 1.0) * float(row["value"])) for row in rows
                                if re.fullmatch(scene, row["scene"]) and re.fullmatch(metric, row["metric"])]
    return found


def plot(title, series, factor):
    """`series`: {key: (color, [(label, value)])}. From 0 up; a point for each label, in the order in which labels first appear."""
    labels = list(dict.fromkeys(label for _, points in series.values() for label, _ in points))
    labels.sort(key=lambda label: label.split()[0])
    most = max(factor * value for _, points in series.values() for _, value in points)
    px = lambda label: LEFT + (labels.index(label) + 0.5) / len(labels) * (WIDTH - LEFT - RIGHT)
    py = lambda value: HEIGHT - BOTTOM - value / (1.08 * most) * (HEIGHT - TOP - BOTTOM)
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="12" fill="#808488">',
             f'<title>{html.escape(title)}</title><text x="{LEFT}" y="18" font-size="14">{html.escape(title)}</text>']
    for value in nice_ticks(most):
        parts.append(f'<line x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{py(value):.1f}" y2="{py(value):.1f}" stroke="#80848840"/>'
                     f'<text x="{LEFT - 6}" y="{py(value) + 4:.1f}" text-anchor="end">{value:g}</text>')
    for i, label in enumerate(labels):
        if i % max(1, len(labels) // 12) == 0:
            parts.append(f'<text transform="translate({px(label):.1f} {HEIGHT - BOTTOM + 14}) rotate(30)" font-size="10">{label.split()[0]}</text>')
    for i, (key, (color, points)) in enumerate(series.items()):
        path = " ".join(f"{px(label):.1f},{py(factor * value):.1f}" for label, value in points)
        parts.append(f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="2"/>')
        parts += [f'<circle cx="{px(label):.1f}" cy="{py(factor * value):.1f}" r="3" fill="{color}"><title>{html.escape(f"{key}, {label}")}: '
                  f'{factor * value:.3g}</title></circle>' for label, value in points]
        parts.append(f'<text x="{LEFT + 170 * i}" y="{HEIGHT - 8}" fill="{color}">{html.escape(key)}</text>')
    return "".join(parts) + "</svg>\n"


def write_plots(history, folder):
    for name, series in read_series(history, PLOTS).items():
        title, kinds = PLOTS[name]
        factor = 1e-3 if "milliseconds" in title else 1.0
        colors = {key: color for key, color, _, _ in kinds}
        shown = {key: (colors[key], points) for key, points in series.items() if points}
        if shown:
            (folder / name).write_text(plot(title, shown, factor), encoding="utf-8")
