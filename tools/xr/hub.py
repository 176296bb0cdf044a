"""The remote hub of Monado's service: head, hands and buttons over TCP, as its r_remote_data has them (Monado 21 to 25, "mndrmt3").

Each message is the whole state, 376 bytes, little endian: the header, two eyes (field of view and pose), the head, whether the eyes
count, and for each hand its pose, velocities, finger curls, analog values and buttons. Poses are x, y, z, w and then metres.
"""
import copy
import socket
import struct
import threading
import time
from dataclasses import dataclass, field

PORT = 4242
HEADER = b"mndrmt3\0"
SIZE = 376
EYE = struct.Struct("<4f7f4x")
HEAD = struct.Struct("<7f4B")
HAND = struct.Struct("<7f3f3f5f3f2f1f2f2B11B3x")
PERIOD_S = 0.004
NO_TURN = (0.0, 0.0, 0.0, 1.0)


@dataclass
class Hand:
    position: tuple = (0.0, 1.2, -0.4)
    rotation: tuple = NO_TURN
    squeeze: float = 0.0
    trigger: float = 0.0
    stick: tuple = (0.0, 0.0)
    active: bool = True
    fingers: bool = False           # seen by finger tracking
    curl: tuple = (0.0,) * 5
    a: bool = False
    b: bool = False

    def pack(self) -> bytes:
        buttons = [False, False, self.a, self.a, self.b, self.b, self.trigger > 0.9, self.trigger > 0.1, False, False, False]
        return HAND.pack(*self.rotation, *self.position, *(0.0,) * 6, *self.curl, self.trigger, self.squeeze, self.squeeze, *self.stick,
                         0.0, 0.0, 0.0, self.fingers, self.active, *buttons)


@dataclass
class Eye:
    fov: tuple = (-0.8, 0.8, 0.8, -0.8)  # left, right, up, down; radians
    position: tuple = (0.0, 0.0, 0.0)    # in the head


@dataclass
class State:
    head: tuple = (0.0, 1.6, 0.0)
    head_rotation: tuple = NO_TURN
    eyes: list | None = None
    left: Hand = field(default_factory=lambda: Hand((-0.2, 1.2, -0.4)))
    right: Hand = field(default_factory=lambda: Hand((0.2, 1.2, -0.4)))

    def pack(self) -> bytes:
        eyes = self.eyes or [Eye((0.0,) * 4), Eye((0.0,) * 4)]
        data = HEADER + b"".join(EYE.pack(*eye.fov, *NO_TURN, *eye.position) for eye in eyes)
        data += HEAD.pack(*self.head_rotation, *self.head, self.eyes is not None, 0, 0, 0) + self.left.pack() + self.right.pack()
        assert len(data) == SIZE
        return data


class Hub:
    """Sends the poses of head and hands to the service until it is closed. In real time: callers wait for the effect."""

    def __init__(self, patience_s: float = 20.0):
        self.state = State()
        self.lock = threading.Lock()
        self.socket = self._connect(patience_s)
        self.open = True
        self.thread = threading.Thread(target=self._run, daemon=True)
        self.thread.start()

    @staticmethod
    def _connect(patience_s: float) -> socket.socket:
        end = time.monotonic() + patience_s
        while True:
            try:
                made = socket.create_connection(("127.0.0.1", PORT), timeout=2.0)
                made.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                return made
            except OSError:
                if time.monotonic() > end:
                    raise
                time.sleep(0.05)

    def _run(self) -> None:
        while self.open:
            with self.lock:
                data = self.state.pack()
            try:
                self.socket.sendall(data)
            except OSError:
                return
            time.sleep(PERIOD_S)

    def change(self, **what) -> None:
        """Parts of the state by name: head=(x, y, z), left={"squeeze": 1.0}."""
        with self.lock:
            state = copy.deepcopy(self.state)
            for name, value in what.items():
                if isinstance(value, dict):
                    for part, number in value.items():
                        setattr(getattr(state, name), part, number)
                else:
                    setattr(state, name, value)
            self.state = state

    def move(self, side: str, to: tuple, seconds: float) -> None:
        """Moves a hand along a straight line, at rest at both ends."""
        begin_s = time.monotonic()
        start = getattr(self.state, side).position
        while True:
            share = min(1.0, (time.monotonic() - begin_s) / seconds)
            eased = share * share * (3.0 - 2.0 * share)
            self.change(**{side: {"position": tuple(a + (b - a) * eased for a, b in zip(start, to))}})
            if share == 1.0:
                return
            time.sleep(PERIOD_S)

    def close(self) -> None:
        self.open = False
        self.thread.join()
        self.socket.close()
