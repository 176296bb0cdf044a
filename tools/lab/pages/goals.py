"""Goals with their measured values, and figures as HTML tables."""
import html
import math

STYLE = """body{font:15px/1.5 system-ui,sans-serif;max-width:1340px;margin:2rem auto;padding:0 1rem;color:#1c1c1e;background:#fff}
h1,h2{font-weight:600}table{border-collapse:collapse;font-variant-numeric:tabular-nums;margin:.7rem 0}td,th{padding:.15rem .55rem;text-align:left;
border-bottom:1px solid #e3e3e6}td.n,th.n{text-align:right}td.n{white-space:nowrap}.miss{color:#b3261e;font-weight:600}.pass{color:#0b6e4f}
.plots{display:flex;flex-wrap:wrap;gap:1.5rem}figure{margin:0;width:640px;max-width:100%}.title{font:600 14px system-ui}
.tick{font:12px system-ui;fill:#555}.grid{stroke:#e3e3e6}.mark{stroke:#888;stroke-dasharray:4 3}figcaption span{margin-right:1rem;font-size:13px}
figcaption i{display:inline-block;width:10px;height:10px;border-radius:5px;margin-right:.4rem}.sheet{display:flex;flex-wrap:wrap;gap:.7rem}
.sheet figure{width:420px}.sheet img{width:100%}.wide{overflow-x:auto}"""


class Goal:
    def __init__(self, bar, measured, goal, passed):
        self.bar, self.measured, self.goal, self.passed = bar, measured, goal, passed

    def verdict(self):
        return {True: "met", False: "MISSED", None: "not run"}[self.passed]


def limit_goal(bar, value, limit, unit, at_least=False):
    """A goal with an upper limit, or with at_least a lower one. A value of NaN or None: not run."""
    goal = f"{'>=' if at_least else '<='} {limit:g} {unit}".strip()
    if value is None or not math.isfinite(value):
        return Goal(bar, "-", goal, None)
    return Goal(bar, f"{value:.3g} {unit}".strip(), goal, value >= limit if at_least else value <= limit)


def percent(value):
    return math.nan if value is None else 100.0 * value


def figure(figures, *path):
    for key in path:
        if figures is None or key not in figures:
            return math.nan
        figures = figures[key]
    return figures


def triple(values, *keys):
    return " / ".join(text(figure(values, key)) for key in keys)


def text(value):
    if isinstance(value, str):
        return value
    if isinstance(value, int):
        return str(value)
    if not math.isfinite(value):
        return "-"
    return "0" if value == 0 else f"{value:.2g}" if abs(value) < 10 else f"{value:.0f}"


def table_html(head, rows):
    cells = "".join(f'<th class="{"n" if i else ""}">{html.escape(cell)}</th>' for i, cell in enumerate(head))
    body = ""
    for row in rows:
        body += "<tr>" + "".join(f'<td class="{"n" if i else ""}">{html.escape(str(cell))}</td>' for i, cell in enumerate(row)) + "</tr>"
    return f'<div class="wide"><table><tr>{cells}</tr>{body}</table></div>'


def goals_html(table):
    rows = ""
    for goal in table:
        style = {"met": "pass", "MISSED": "miss"}.get(goal.verdict(), "")
        rows += (f"<tr><td>{html.escape(goal.bar)}</td><td class=n>{html.escape(goal.measured)}</td><td class=n>{html.escape(goal.goal)}</td>"
                 f'<td class="{style}">{goal.verdict()}</td></tr>')
    return f"<table><tr><th>bar</th><th class=n>measured</th><th class=n>goal</th><th></th></tr>{rows}</table>"
