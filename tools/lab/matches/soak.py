"""Simulated matches over random networks: `handhold-lab match` with a seed each, all of which must grip, throw, share and roll back."""
import json
import random

PAIR_TASKS = 4  # of scene "together": bar, door, tool, each other
HOLD_EACH_OTHER = 3


def network_of(seed):
    """Flags of `handhold-lab match` for a seed: the network, the players and what their pairs do."""
    draw = random.Random(seed)
    peers = 8 if seed % 25 == 0 else 4 if seed % 5 == 0 else 2
    flags = {"scene": "together", "peers": peers, "first-pair": seed % PAIR_TASKS, "rtt-ms": round(draw.uniform(10, 250)),
             "jitter-ms": round(draw.uniform(0, 60)), "loss": round(draw.choice((0, draw.uniform(0, 0.1))), 3),
             "burst-loss": round(draw.choice((0, draw.uniform(0, 0.01))), 4), "duplicate": round(draw.choice((0, draw.uniform(0, 0.1))), 3),
             "packets": draw.choice((1, 0.5)), "seed": seed}
    if draw.random() < 0.3:  # about 1.3 to 4 times what a match of so many needs
        flags["kbps"] = round(draw.uniform(1.3, 4) * (60 + 20 * peers))
    return flags


def tasks_of(flags):
    return {(flags["first-pair"] + pair) % PAIR_TASKS for pair in range(flags["peers"] // 2)}


def faults_of(flags, figures):
    """What a run did not do, or did wrong; an empty list: it proves what it should."""
    tasks = tasks_of(flags)
    missing = [name for name in ("grips", "throws", "hashes_compared") if figures[name] == 0]
    missing += ["rollbacks"] if figures["rollback"]["ticks"]["max"] == 0 else []
    missing += ["shared_holds"] if tasks - {HOLD_EACH_OTHER} and figures["shared_holds"] == 0 else []
    missing += ["player_holds"] if HOLD_EACH_OTHER in tasks and figures["player_holds"] == 0 else []
    return [f"no {name}" for name in missing] + [f"{figures[name]} {name}" for name in ("hashes_different", "stalls") if figures[name] > 0]


def summary(runs):
    """Totals of [(flags, figures)]."""
    names = ("hashes_compared", "hashes_different", "stalls", "grips", "throws", "shared_holds", "player_holds")
    total = {name: sum(figures[name] for _, figures in runs) for name in names}
    total["minutes"] = sum(figures["confirmed_ticks"] for _, figures in runs) / 90 / 60
    total["seeds"] = len({flags["seed"] for flags, _ in runs})
    total["faulty"] = [(flags["seed"], faults_of(flags, figures)) for flags, figures in runs if faults_of(flags, figures)]
    return total


def run(lab, minutes, seeds, first_seed=1, log=None):
    """Runs seeds that the log, a file of JSON lines, does not have yet. Returns [(flags, figures)] of all."""
    runs = []
    if log is not None and log.exists():
        runs = [(one["flags"], one["figures"]) for one in map(json.loads, log.read_text(encoding="utf-8").splitlines())]
    known = {flags["seed"] for flags, _ in runs}
    for seed in range(first_seed, first_seed + seeds):
        if seed in known:
            continue
        flags = network_of(seed)
        flags["seconds"] = max(12.0, 60.0 * minutes / seeds)
        figures = lab.match(flags, may_fail=True)
        runs.append((flags, figures))
        if log is not None:
            with log.open("a", encoding="utf-8") as file:
                file.write(json.dumps({"flags": flags, "figures": figures}) + "\n")
    return runs
