"""Plots as inline SVG."""
import html
import math

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 640, 380, 60, 20, 40, 50


def nice_ticks(high):
    step = 10.0 ** math.floor(math.log10(high / 4.0))
    step *= next(factor for factor in (1, 2, 5, 10) if high / (step * factor) <= 6)
    return [i * step for i in range(int(high / step) + 1)]


def share_above(values, count=200):
    """Points (x, share of values above x) at the values' quantiles."""
    values = sorted(values)
    places = sorted({min(len(values) - 1, round(i * len(values) / count)) for i in range(count + 1)})
    return [(values[i], (len(values) - 1 - i) / len(values)) for i in places]


def keys_html(colors):
    keys = "".join(f'<span><i style="background:{color}"></i>{html.escape(name)}</span>' for name, color in colors.items())
    return f"<figcaption>{keys}</figcaption>"


def tail_plot(title, x_title, series, x_max, marks=()):
    """Share of values above x, for {name: (color, values)}; dashed lines at marks."""
    series = {name: (color, share_above(values)) for name, (color, values) in series.items() if len(values)}
    px = lambda x: LEFT + min(x, x_max) / x_max * (WIDTH - LEFT - RIGHT)
    py = lambda y: HEIGHT - BOTTOM - y * (HEIGHT - TOP - BOTTOM)
    parts = [f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="{html.escape(title)}">',
             f'<text x="{LEFT}" y="20" class="title">{html.escape(title)}</text>']
    for percent in (0, 20, 40, 60, 80, 100):
        y = py(percent / 100)
        parts.append(f'<line x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{y:.1f}" y2="{y:.1f}" class="grid"/>'
                     f'<text x="{LEFT - 8}" y="{y + 4:.1f}" class="tick" text-anchor="end">{percent} %</text>')
    for x in nice_ticks(x_max):
        parts.append(f'<text x="{px(x):.1f}" y="{HEIGHT - BOTTOM + 18}" class="tick" text-anchor="middle">{x:g}</text>')
    for x in marks:
        parts.append(f'<line x1="{px(x):.1f}" x2="{px(x):.1f}" y1="{TOP}" y2="{HEIGHT - BOTTOM}" class="mark"/>')
    parts.append(f'<text x="{(LEFT + WIDTH - RIGHT) / 2}" y="{HEIGHT - 10}" class="tick" text-anchor="middle">{html.escape(x_title)}</text>')
    for name, (color, points) in series.items():
        points = [(0.0, 1.0 if points[0][0] > 0 else points[0][1])] + [point for point in points if point[0] <= x_max]
        path = " ".join(f"{px(x):.1f},{py(y):.1f}" for x, y in points)
        parts.append(f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="2"><title>{html.escape(name)}</title></polyline>')
    return f'<figure>{"".join(parts)}</svg>{keys_html({name: color for name, (color, _) in series.items()})}</figure>'


def bars(title, rows, unit, goal=None):
    """One bar per row (name, value)."""
    most = max([value for _, value in rows if math.isfinite(value)] + [goal or 0.0, 1e-9])
    left, height = 230, 20 * len(rows) + 50
    px = lambda x: left + x / most * (WIDTH - left - 70)
    parts = [f'<svg viewBox="0 0 {WIDTH} {height}" role="img" aria-label="{html.escape(title)}">',
             f'<text x="10" y="20" class="title">{html.escape(title)}</text>']
    for i, (name, value) in enumerate(rows):
        y, value = 36 + 20 * i, value if math.isfinite(value) else 0.0
        color = "#c8553d" if goal is not None and value > goal else "#0b6e4f"
        parts.append(f'<text x="{left - 8}" y="{y + 11}" class="tick" text-anchor="end">{html.escape(name)}</text>'
                     f'<rect x="{left}" y="{y}" width="{px(value) - left:.1f}" height="14" fill="{color}"/>'
                     f'<text x="{px(value) + 6:.1f}" y="{y + 11}" class="tick">{value:.3g} {html.escape(unit)}</text>')
    if goal is not None:
        parts.append(f'<line x1="{px(goal):.1f}" x2="{px(goal):.1f}" y1="30" y2="{height - 10}" class="mark"/>')
    return f'<figure>{"".join(parts)}</svg></figure>'


def unbroken(points):
    """Runs of consecutive finite points."""
    runs, run = [], []
    for x, y in points:
        if math.isfinite(y):
            run.append((x, y))
        elif run:
            runs.append(run)
            run = []
    return runs + [run] if run else runs


def ticks_between(low, high):
    return [tick for sign in (-1.0, 1.0) for tick in [sign * t for t in nice_ticks(max(high, -low, 1e-9))] if low <= tick <= high and (sign > 0.0 or tick)]


def lines(title, x_title, y_title, series, low=None):
    """y over x for {name: (color, points)}, in drawing order; a line breaks where y is not finite. low: lower end of the y axis;
    default: the minimum."""
    points = [point for _, row in series.values() for point in row if math.isfinite(point[1])] or [(0.0, 0.0), (1.0, 1.0)]
    x_min, x_max = min(x for x, _ in points), max(x for x, _ in points)
    y_min, y_max = min(y for _, y in points) if low is None else low, max(y for _, y in points)
    px = lambda x: LEFT + (x - x_min) / max(x_max - x_min, 1e-9) * (WIDTH - LEFT - RIGHT)
    py = lambda y: HEIGHT - BOTTOM - (y - y_min) / max(y_max - y_min, 1e-9) * (HEIGHT - TOP - BOTTOM)
    parts = [f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="{html.escape(title)}">',
             f'<text x="{LEFT}" y="20" class="title">{html.escape(title)}</text>']
    for y in ticks_between(y_min, y_max):
        parts.append(f'<line x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{py(y):.1f}" y2="{py(y):.1f}" class="grid"/>'
                     f'<text x="{LEFT - 8}" y="{py(y) + 4:.1f}" class="tick" text-anchor="end">{y:g}</text>')
    for x in ticks_between(x_min, x_max):
        parts.append(f'<text x="{px(x):.1f}" y="{HEIGHT - BOTTOM + 18}" class="tick" text-anchor="middle">{x:g}</text>')
    parts.append(f'<text x="{(LEFT + WIDTH - RIGHT) / 2}" y="{HEIGHT - 10}" class="tick" text-anchor="middle">{html.escape(x_title)}</text>'
                 f'<text x="{LEFT - 8}" y="{TOP - 8}" class="tick" text-anchor="end">{html.escape(y_title)}</text>')
    for name, (color, row) in series.items():
        for run in unbroken(row):
            path = " ".join(f"{px(x):.1f},{py(y):.1f}" for x, y in run)
            parts.append(f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="1.6"><title>{html.escape(name)}</title></polyline>')
    return f'<figure>{"".join(parts)}</svg>{keys_html({name: color for name, (color, _) in series.items()})}</figure>'
