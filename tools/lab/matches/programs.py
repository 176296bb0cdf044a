"""The programs whose figures a match report has."""
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import time

from pages.files import FormatError

DIFFERS = 3  # exit status of `handhold-lab match`: figures are written, but prove nothing or differ


def command_line(program, flags):
    """One line for people: lists are repeated flags."""
    return f"{program} " + " ".join(shlex.join(words_of({name: value})) for name, value in flags.items())


def words_of(flags):
    words = []
    for name, value in flags.items():
        for one in value if isinstance(value, (list, tuple)) else [value]:
            words += [f"--{name}", str(one)]
    return words


class Lab:
    def __init__(self, folder, scratch):
        self.folder, self.scratch = pathlib.Path(folder), pathlib.Path(scratch)

    def match(self, flags, may_fail=False):
        """Figures of one match, with `exit` and `said`. Fails unless its exit status is 0, or DIFFERS and it may fail."""
        out = self.scratch / "match.json"
        out.unlink(missing_ok=True)
        said = self.run("handhold-lab", ["match", *words_of(flags), "--json", str(out)], (0, DIFFERS) if may_fail else (0,))
        figures = json.loads(out.read_text())
        return {**figures, "exit": said.returncode, "said": said.stderr.strip()}

    def bench(self, name):
        """Counters of one benchmark."""
        said = self.run("handhold-bench", [f"--benchmark_filter={name}", "--benchmark_format=json"])
        found = json.loads(said.stdout)["benchmarks"]
        if not found:
            raise FormatError(f"handhold-bench: no {name}")
        return found[0]

    def run(self, program, words, statuses=(0,)):
        print(f"  {program} {' '.join(words)}", file=sys.stderr, flush=True)
        try:
            said = subprocess.run([str(self.folder / program), *words], capture_output=True, text=True)
        except OSError as error:
            raise FormatError(f"{self.folder / program}: {error.strerror}") from None
        if said.returncode not in statuses:
            raise FormatError(f"{program} {' '.join(words)}: exit status {said.returncode}: {said.stderr.strip()}")
        return said


def cpu_s(process):
    """Processor seconds that a process has used."""
    fields = pathlib.Path(f"/proc/{process}/stat").read_text().rsplit(") ", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def address_in(line):
    """The WebSocket address in a server's log line, or None."""
    found = re.search(r"ws://127\.0\.0\.1:\d+", line)
    return found and found[0]


def ended(process):
    """Ends a process of ours in order, or at once after ten seconds."""
    process.terminate()
    try:
        process.wait(10)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def serve(folder, players, seconds):
    """`handhold serve` with so many climbers in the arena: processor seconds a second, and confirmed ticks a second, after 5 s."""
    program = str(pathlib.Path(folder) / "handhold")
    server = subprocess.Popen([program, "serve", "--scene", "arena", "--players", str(players), "--port", "0", "--seconds", str(seconds + 60)],
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    bots = None
    try:
        url = next(filter(None, map(address_in, server.stdout)), None)
        if url is None:
            raise FormatError("handhold serve: no address")
        bots = subprocess.Popen([program, "bots", str(players), "--join", url, "--seconds", str(seconds + 30)],
                                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for _ in range(300):
            if metric(url, "players") == players:
                break
            time.sleep(0.2)
        else:
            raise FormatError(f"handhold bots: {players} climbers did not join")
        time.sleep(5)
        begin_s, cpu_begin_s, tick = time.monotonic(), cpu_s(server.pid), metric(url, "tick")
        time.sleep(seconds)
        spent_s = time.monotonic() - begin_s
        return {"cpu_share": (cpu_s(server.pid) - cpu_begin_s) / spent_s, "ticks_per_s": (metric(url, "tick") - tick) / spent_s}
    finally:
        for process in (bots, server):
            if process is not None:
                ended(process)


def metric(url, name):
    from urllib.request import urlopen

    with urlopen(url.replace("ws:", "http:") + "/metrics", timeout=10) as answer:
        return metric_in(answer.read().decode(), name)


def metric_in(text, name):
    found = re.search(rf"^handhold_{name} (\S+)$", text, re.MULTILINE)
    if found is None:
        raise FormatError(f"/metrics: expected handhold_{name}")
    return float(found[1])


def fuzz_runs(text):
    """Reads the output of tools/fuzz: {target: number of inputs}. The number is None if the target failed."""
    runs = {name: int(count) for name, count in re.findall(r"^(\w+) +(\d+) runs, nothing found$", text, re.MULTILINE)}
    return {**runs, **{name: None for name in re.findall(r"^(\w+) +FAILED", text, re.MULTILINE)}}
