"""Monado's service and the game inside the folder, with a loopback network only, without a headset or display."""
import fcntl
import json
import os
import shutil
import signal
import socket
import struct
import subprocess
import time
from pathlib import Path

from xr import folder as xr_folder
from xr.hub import Hub

RUNTIME_DIR = "run/xr"
START_S = 30.0
SIOCSIFFLAGS = 0x8914
IFF_UP_RUNNING = 0x41


def raise_loopback() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as control:
        fcntl.ioctl(control, SIOCSIFFLAGS, struct.pack("16sh14x", b"lo", IFF_UP_RUNNING))


def mount(*words: str) -> None:
    subprocess.run(["mount", *words], check=True)


class Room:
    """The folder with the mounts it shares with this machine. For a mount namespace of its own only: nothing is unmounted."""

    def __init__(self, folder: Path, game: Path, scenes: Path, out: Path):
        self.folder = folder
        self.out = out
        self.started: list[subprocess.Popen] = []
        raise_loopback()
        mount("-t", "proc", "proc", str(folder / "proc"))
        mount("--rbind", "/dev", str(folder / "dev"))
        mount("--bind", str(game.parent), str(folder / "game"))
        mount("--bind", str(scenes), str(folder / "scenes"))
        mount("--bind", str(out), str(folder / "out"))
        mount("-t", "tmpfs", "tmpfs", str(folder / "run"))
        (folder / RUNTIME_DIR).mkdir(mode=0o700)
        self.game = f"/game/{game.name}"
        self.env = {"PATH": "/usr/bin:/bin", "HOME": "/root", "XDG_RUNTIME_DIR": f"/{RUNTIME_DIR}", "LIBGL_ALWAYS_SOFTWARE": "1",
                    "LD_LIBRARY_PATH": f"/{xr_folder.LIBRARIES}"}

    def start(self, words: list[str], log: Path, **env: str) -> subprocess.Popen:
        with log.open("w") as out:
            started = subprocess.Popen([shutil.which("chroot") or "/usr/sbin/chroot", str(self.folder), *words], env=self.env | env,
                                       stdout=out, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)
        self.started.append(started)
        return started

    def end_all(self) -> None:
        """Ends processes that a failed check left running."""
        for process in self.started:
            if process.poll() is None:
                process.kill()
                process.wait()
        self.started.clear()
        for left in (self.folder / RUNTIME_DIR).iterdir():
            left.unlink()


class Failed(Exception):
    """The expectation and the result, in one line."""


class Service:
    """Monado with the remote hub as its headset and without a window. Connected once the constructor returns."""

    def __init__(self, room: Room, name: str):
        self.room = room
        self.process = room.start(["monado-service"], room.out / f"{name}.monado.log", P_OVERRIDE_ACTIVE_CONFIG="remote",
                                  XRT_COMPOSITOR_NULL="1", XRT_NO_STDIN="1")
        self._wait_for_door()
        self.hub = Hub(START_S)

    def _wait_for_door(self) -> None:
        end = time.monotonic() + START_S
        while not (self.room.folder / RUNTIME_DIR / "monado_comp_ipc").exists():
            if time.monotonic() > end or self.process.poll() is not None:
                raise Failed("monado-service does not start: see its log")
            time.sleep(0.05)

    def kill(self) -> None:
        self.hub.open = False
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()
        for left in (self.room.folder / RUNTIME_DIR).iterdir():
            left.unlink()

    def stop(self) -> None:
        self.hub.close()
        self.process.terminate()
        try:
            self.process.wait(5.0)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        for left in (self.room.folder / RUNTIME_DIR).iterdir():
            left.unlink()


class Play:
    """`handhold play` in a headset, observed through the lines of its --status."""

    def __init__(self, room: Room, name: str, *words: str, **env: str):
        self.room = room
        self.name = name
        self.status = room.out / f"{name}.status.jsonl"
        self.log = room.out / f"{name}.game.log"
        self.status.unlink(missing_ok=True)
        self.offset = 0
        self.last = None
        self.process = room.start([room.game, "play", "--no-mirror", "--status", f"/out/{self.status.name}", *words], self.log, **env)

    def look(self) -> dict | None:
        if self.status.is_file():
            with self.status.open("rb") as file:
                file.seek(self.offset)
                lines = file.read().split(b"\n")
            self.offset += sum(len(line) + 1 for line in lines[:-1])
            if len(lines) > 1:
                self.last = json.loads(lines[-2])
        return self.last

    def wait(self, what: str, is_so, patience_s: float = 20.0) -> dict:
        end = time.monotonic() + patience_s
        while True:
            now = self.look()
            if now is not None and is_so(now):
                return now
            if self.process.poll() is not None:
                raise Failed(f"{self.name}: the game ended, status {self.process.returncode}, while waiting for {what}: see {self.log}")
            if time.monotonic() > end:
                raise Failed(f"{self.name}: waited {patience_s:.0f} s for {what}; the last was {json.dumps(self.last)}")
            time.sleep(0.01)

    def next(self) -> dict:
        """Waits for two further lines: hands have been still for at least a tenth of a second."""
        for _ in range(2):
            seen = self.look()
            before = seen["t_s"] if seen else -1.0
            self.wait("the next line", lambda now: now["t_s"] > before)
        return self.last

    def interrupt_free_end(self, patience_s: float = 60.0) -> str:
        """Waits for the game to end by itself and returns its output."""
        try:
            status = self.process.wait(patience_s)
        except subprocess.TimeoutExpired:
            self.process.kill()
            raise Failed(f"{self.name}: does not end within {patience_s:.0f} s: see {self.log}") from None
        text = self.log.read_text(errors="replace")
        if status != 0:
            raise Failed(f"{self.name}: status {status}: {text.strip().splitlines()[-1] if text.strip() else 'no word'}")
        return text


UNSHARE = ["unshare", "--net", "--mount", "--pid", "--fork", "--kill-child"]


def may_enter() -> bool:
    return subprocess.run([*UNSHARE, "true"], capture_output=True, check=False).returncode == 0


def enter(script: list[str]) -> int:
    """Runs the script again in namespaces of its own; its children end with it."""
    return subprocess.run([*UNSHARE, *script], env=dict(os.environ, HANDHOLD_XR_INSIDE="1"), check=False).returncode
