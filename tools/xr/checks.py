"""The checks of tools/xr_e2e: the game in a headset. Each check returns the figures it measured and holds its own expectations."""
import csv
import math
import re
import signal
import struct
import subprocess
import time
import zlib
from pathlib import Path

from xr.hands import about, conjugate, grip_below_palm, grip_of_flat_hand, rotate
from xr.hub import Eye, Hub
from xr.monado import Failed, Play, Room, Service

RAIL_TOP_M = 1.0675   # of tests/play/rails.json, above the play space's floor
PALM_GAP_M = 0.005
STROKE_M = 0.5
NEAR_Z, FAR_Z = -0.05, -0.55
GOAL_M = 10.0
MOST_ERROR_MM = 1.0   # of the head from where the hands put it
FEED_MM = 0.01        # poses go over the wire as floats


def expect(is_so: bool, what: str) -> None:
    if not is_so:
        raise Failed(what)


def apart_mm(a, b) -> float:
    return 1e3 * math.dist(a, b)


def end(play: Play) -> str:
    play.process.send_signal(signal.SIGINT)
    return play.interrupt_free_end()


def brake(play: Play) -> None:
    """Waits until the head stays in place; without the brake it would drift for ever."""
    rest(play, lambda now: now["head_m"], "the brake does not stop the player")


def rest(play: Play, place_m, otherwise: str) -> tuple:
    """Waits until a place stays the same for two lines, and returns it."""
    for _ in range(100):
        before = place_m(play.next())
        if apart_mm(place_m(play.next()), before) < 0.1:
            return before
    raise Failed(f"poses: {otherwise}")


def check_poses(room: Room) -> str:
    """Head, grips, stick and triggers equal the input; the brake stops; a hand out of sight hangs at its side; fingers are tracked."""
    service = Service(room, "poses")
    play = Play(room, "poses", "--xr-headless", "--scene", "/scenes/xr_eyes.json", "--jets")
    play.wait("focus", lambda now: now["headset"]["focus"])
    head, left, right = (0.31, 1.45, -0.22), (-0.4, 1.1, -0.35), (0.35, 1.6, -0.5)
    service.hub.change(head=head, left={"position": left, "trigger": 0.25}, right={"position": right, "squeeze": 0.4})
    play.next()
    seen = play.next()["headset"]
    worst_mm = max(apart_mm(seen["head_m"], head), apart_mm(seen["left"]["grip_m"], left), apart_mm(seen["right"]["grip_m"], right))
    expect(worst_mm <= FEED_MM, f"poses: {worst_mm} mm from what was fed")
    expect(abs(seen["left"]["trigger"] - 0.25) < 1e-6 and abs(seen["right"]["squeeze"] - 0.4) < 1e-6, f"poses: analog values are {seen}")
    service.hub.change(left={"stick": (0.0, 0.75)})
    before = play.next()["head_m"]
    play.wait("the jets", lambda now: now["head_m"][2] < before[2] - 0.05)
    service.hub.change(left={"stick": (0.0, 0.0)}, right={"a": True})
    brake(play)
    service.hub.change(right={"active": False})
    play.wait("the lost hand", lambda now: now["headset"]["right"]["grip_m"] is None)
    hung = rest(play, lambda now: now["right"]["hand_m"], "a hand out of sight does not come to rest")
    expect(hung[1] < head[1] - 0.3, f"poses: a hand out of sight hangs at {hung}, the head is at {head}")
    service.hub.change(right={"position": (0.1, 1.2, -0.3)})
    strayed_mm = apart_mm(play.next()["right"]["hand_m"], hung)
    expect(strayed_mm < MOST_ERROR_MM, f"poses: a hand that is out of sight moves by {strayed_mm} mm")
    service.hub.change(right={"fingers": True, "curl": (1.0,) * 5})
    curled = play.wait("curled fingers", lambda now: now["headset"]["right"]["curl"] > 0.55)["headset"]["right"]["curl"]
    end(play)
    service.stop()
    return f"poses within {worst_mm:.4f} mm of what was fed; jets, brake, a lost hand, tracked fingers that curl ({curled:.2f})"


def take(play: Play, hub: Hub, side: str, closed: bool) -> None:
    hub.change(**{side: {"squeeze": 1.0 if closed else 0.0}})
    wanted = "surface" if closed else "none"
    play.wait(f"the {side} hand to {'grip' if closed else 'let go'}", lambda now: now[side]["grip"] == wanted)


def on_rail(side: str, z: float) -> tuple:
    return grip_below_palm(side, (0.0, RAIL_TOP_M + PALM_GAP_M, z))


def check_crawl(room: Room) -> str:
    """Ten metres along a rail, hand over hand: in every frame the head is where the gripping hand puts it. The recording replays."""
    service = Service(room, "crawl")
    hub = service.hub
    play = Play(room, "crawl", "--xr-headless", "--scene", "/scenes/rails.json", "--record", "/out/crawl.csv", "--report",
                "/out/crawl.report.json")
    play.wait("focus", lambda now: now["headset"]["focus"])
    for side in ("left", "right"):
        hub.change(**{side: {"rotation": grip_of_flat_hand(side), "position": on_rail(side, FAR_Z)}})
    begin = play.next()["head_m"]
    strokes = round(GOAL_M / STROKE_M)
    holds, other = "left", "right"
    take(play, hub, holds, True)
    for stroke in range(strokes):
        hub.move(holds, on_rail(holds, NEAR_Z), 0.3)
        if stroke + 1 < strokes:
            take(play, hub, other, True)
            take(play, hub, holds, False)
            hub.move(holds, on_rail(holds, FAR_Z), 0.15)
            holds, other = other, holds
    play.next()
    went = play.next()["head_m"]
    text = end(play)
    service.stop()
    live = re.findall(r"state_hash (0x[0-9a-f]{16})", text)[-1]
    replay = re.findall(r"^handhold run .*$", text, re.M)[-1].split()[1:]
    moved_m = begin[2] - went[2]
    error_mm, frames, hash_again = replayed(room, replay, "crawl")
    expect(hash_again == live, f"crawl: replayed, the state hash is {hash_again}, not {live}")
    expect(error_mm <= MOST_ERROR_MM, f"crawl: the head is {error_mm:.3f} mm from where the hands put it")
    expect(abs(moved_m - strokes * STROKE_M) <= 1e-3 * MOST_ERROR_MM,
           f"crawl: the hands put the head {strokes * STROKE_M} m ahead, it went {moved_m:.5f}")
    aside_mm = 1e3 * math.hypot(went[0] - begin[0], went[1] - begin[1])
    expect(aside_mm <= MOST_ERROR_MM, f"crawl: {aside_mm:.3f} mm beside the rail")
    return (f"{moved_m:.4f} m in {strokes} strokes of both hands; head within {error_mm:.4f} mm of where the hands put it in each of {frames} "
            f"frames; replayed to the same state hash")


def replayed(room: Room, words: list[str], name: str) -> tuple[float, int, str]:
    """Replays the recording. Returns the largest distance, over all frames, of the head from where the gripping hand put it."""
    log = room.out / f"{name}.replay.log"
    status = room.start([room.game, *words, "--no-pictures", "--out", f"/out/{name}"], log).wait(300.0)
    text = log.read_text(errors="replace")
    expect(status == 0, f"{name}: the replay ends with status {status}: see {log}")
    with (room.out / f"{name}.csv").open() as file:
        samples = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    with (room.out / name / "frames.csv").open() as file:
        rows = list(csv.DictReader(file))
    at = {round(sample["t"] - samples[0]["t"], 5): sample for sample in samples}
    worst_mm, held, anchor = 0.0, 0, None
    for row in rows:
        sample = at[round(float(row["t"]), 5)]
        grips = [side for side in "lr" if row[f"{side}_grip"] != "0"]
        if len(grips) != 1:
            anchor = None
            continue
        side = grips[0]
        head = [float(row[f"head_{axis}"]) for axis in "xyz"]
        put = [sample[f"h{axis}"] - sample[f"{side}{axis}"] for axis in "xyz"]  # nobody turns
        if anchor is None or anchor[0] != side:
            anchor = (side, [h - p for h, p in zip(head, put)])
        held += 1
        worst_mm = max(worst_mm, apart_mm(head, [a + p for a, p in zip(anchor[1], put)]))
    expect(held > 100, f"{name}: {held} frames with one hand on the rail")
    return worst_mm, held, re.findall(r"state_hash (0x[0-9a-f]{16})", text)[-1]


def check_touch(room: Room) -> str:
    """A palm near the rail causes weak haptics, a grip stronger ones, according to the calls that OpenXR's own layer recorded."""
    service = Service(room, "touch")
    dump = room.out / "touch.calls.txt"
    dump.unlink(missing_ok=True)  # the layer appends
    play = Play(room, "touch", "--xr-headless", "--scene", "/scenes/rails.json", XR_ENABLE_API_LAYERS="XR_APILAYER_LUNARG_api_dump",
                XR_API_DUMP_EXPORT_TYPE="text", XR_API_DUMP_FILE_NAME=f"/out/{dump.name}")
    play.wait("focus", lambda now: now["headset"]["focus"])
    for _ in range(3):
        above = grip_below_palm("right", (0.0, RAIL_TOP_M + 0.12, FAR_Z))
        service.hub.change(right={"rotation": grip_of_flat_hand("right"), "position": above})
        play.next()
        before = play.next()["headset"]["right"]["shakes"]
        service.hub.move("right", on_rail("right", FAR_Z), 0.3)
        play.wait("the touch", lambda now: now["headset"]["right"]["shakes"] == before + 1)
        take(play, service.hub, "right", True)
        play.wait("the grip's shake", lambda now: now["headset"]["right"]["shakes"] == before + 2)
        play.next()
        play.next()  # the hand's speed at its release is that of the last tenth of a second
        take(play, service.hub, "right", False)
    shakes = play.next()["headset"]["right"]["shakes"]
    end(play)
    service.stop()
    calls = dump.read_text(errors="replace")
    felt = len(re.findall(r"^XrResult xrApplyHapticFeedback", calls, re.M))
    amplitudes = sorted({round(float(found), 3) for found in re.findall(r"amplitude = ([0-9.e+-]+)", calls)})
    expect(felt == shakes, f"touch: {shakes} shakes, {felt} calls")
    return f"{shakes} shakes of touches and grips, {felt} calls of the runtime, amplitudes {amplitudes}"


def read_png(path: Path) -> tuple[int, int, list[bytes]]:
    """Returns width, height and rows of RGBA. The game writes eight bits a channel, not interlaced."""
    data = path.read_bytes()
    at, packed, width, height = 8, b"", 0, 0
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, depth, color = struct.unpack_from(">IIBB", body)
            expect((depth, color) == (8, 6), f"{path}: not RGBA of eight bits")
        packed += body if kind == b"IDAT" else b""
        at += size + 12
    raw = zlib.decompress(packed)
    stride, rows, above = 4 * width, [], bytearray(4 * width)
    for y in range(height):
        kind, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            a, b, c = row[i - 4] if i >= 4 else 0, above[i], above[i - 4] if i >= 4 else 0
            nearest = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
            row[i] = (row[i] + (0, a, b, (a + b) // 2, nearest)[kind]) & 255
        rows.append(bytes(row))
        above = row
    return width, height, rows


def middle_of(rows: list[bytes], begin_px: int, end_px: int, channel: int) -> tuple[float, float] | None:
    """Of pixels whose colour is dominated by this channel."""
    found = []
    for y, row in enumerate(rows):
        for x in range(begin_px, end_px):
            color = row[4 * x:4 * x + 3]
            if color[channel] > 60 and all(color[channel] > 2 * color[i] for i in range(3) if i != channel):
                found.append((x - begin_px + 0.5, y + 0.5))
    return tuple(sum(each) / len(found) for each in zip(*found)) if len(found) > 3 else None


BOXES = {"red": (0, (0.1, 1.65, -1.2)), "green": (1, (-0.5, 1.3, -2.5))}  # of tests/play/xr_eyes.json


def check_eyes(room: Room) -> str:
    """Both eyes' pictures as submitted: boxes lie where a pinhole camera with each eye's pose and asymmetric field of view projects them."""
    service = Service(room, "eyes")
    eyes = [Eye((-0.85, 0.65, 0.7, -0.8), (-0.034, 0.0, 0.0)), Eye((-0.65, 0.85, 0.7, -0.8), (0.034, 0.0, 0.0))]
    head, turn = (0.05, 1.5, 0.1), about((0.0, 1.0, 0.0), 0.12)
    service.hub.change(head=head, head_rotation=turn, eyes=eyes, left={"position": (-0.3, 0.9, 0.3)}, right={"position": (0.3, 0.9, 0.3)})
    play = Play(room, "eyes", "--xr", "--scene", "/scenes/xr_eyes.json", "--picture", "/out/eyes.png", "--quality", "plain")
    before = play.wait("pictures", lambda now: now["headset"]["pictures"] > 0, 60.0)["headset"]["pictures"]
    pictures = play.wait("more pictures", lambda now: now["headset"]["pictures"] >= before + 10, 60.0)["headset"]["pictures"]
    end(play)
    service.stop()
    width, height, rows = read_png(room.out / "eyes.png")
    width //= 2
    worst_px = 0.0
    for which, eye in enumerate(eyes):
        left, right, up, down = (math.tan(angle) for angle in eye.fov)
        place = tuple(h + o for h, o in zip(head, rotate(turn, eye.position)))
        for name, (channel, box) in BOXES.items():
            x, y, z = rotate(conjugate(turn), tuple(b - p for b, p in zip(box, place)))
            at = ((x / -z - left) / (right - left) * width, (up - y / -z) / (up - down) * height)
            seen = middle_of(rows, which * width, (which + 1) * width, channel)
            expect(seen is not None, f"eyes: no {name} box in eye {which}: see {room.out / 'eyes.png'}")
            worst_px = max(worst_px, math.dist(at, seen))
    expect(worst_px <= 1.5, f"eyes: a box is {worst_px:.2f} px from where a pinhole has it")
    return f"{pictures} pairs of {width} x {height}; boxes within {worst_px:.2f} px of where a pinhole has them"


def check_panel(room: Room) -> str:
    """The left calibrate button alone toggles the help before both eyes; both buttons together do not."""
    service = Service(room, "panel")
    eyes = [Eye((-0.75, 0.75, 0.7, -0.7), (-0.032, 0.0, 0.0)), Eye((-0.75, 0.75, 0.7, -0.7), (0.032, 0.0, 0.0))]
    service.hub.change(eyes=eyes, left={"position": (-0.3, 0.9, 0.3)}, right={"position": (0.3, 0.9, 0.3)})
    play = Play(room, "panel", "--xr", "--scene", "/scenes/xr_eyes.json", "--picture", "/out/panel.png", "--quality", "plain", "--eye-scale", "2")
    play.wait("focus", lambda now: now["headset"]["focus"], 40.0)

    def press(*sides):
        for down in (True, False):
            for side in sides:
                service.hub.change(**{side: {"b": down}})
            play.next()
            play.next()
        return play.next()["headset"]["panel"]

    shown = [press("left"), press("left"), press("left", "right"), press("right"), press("left")]
    expect(shown == [True, False, False, False, True], f"panel: shown {shown}")
    before = play.next()["headset"]["pictures"]
    play.wait("pictures", lambda now: now["headset"]["pictures"] > before + 2, 60.0)
    end(play)
    service.stop()
    return f"shown, put away, and shown again by the left button alone: {room.out / 'panel.png'}"


def lose(room: Room, name: str, *words: str) -> tuple[float, float]:
    """Returns the seconds until the game finds the restarted runtime, and the player's displacement in millimetres."""
    service = Service(room, name)
    play = Play(room, name, "--scene", "/scenes/xr_eyes.json", "--quality", "plain", *words)
    play.wait("focus", lambda now: now["headset"]["focus"], 40.0)
    before = play.next()
    service.kill()
    time.sleep(1.0)
    service = Service(room, f"{name}_again")
    begin = time.monotonic()
    after = play.wait("the runtime", lambda now: now["headset"]["losses"] == 1 and now["headset"]["focus"], 40.0)
    seconds = time.monotonic() - begin
    moved_mm = apart_mm(before["head_m"], after["head_m"])
    expect(moved_mm < MOST_ERROR_MM, f"{name}: the player moved by {moved_mm:.3f} mm")
    pictures = after["headset"]["pictures"]
    if "--xr" in words:
        play.wait("pictures", lambda now: now["headset"]["pictures"] > pictures + 2, 40.0)
    end(play)
    service.stop()
    return seconds, moved_mm


def check_loss(room: Room) -> str:
    """The runtime is killed and restarted: the game reconnects with the player in place, with and without pictures."""
    blind_s, blind_mm = lose(room, "loss", "--xr-headless")
    seen_s, seen_mm = lose(room, "loss_seen", "--xr")
    return (f"found again {blind_s:.1f} s after it was back, with pictures {seen_s:.1f} s; the player moved by "
            f"{max(blind_mm, seen_mm):.3f} mm")


def check_absent(room: Room) -> str:
    """Without a service: one line on standard error and status 3."""
    log = room.out / "absent.log"
    status = room.start([room.game, "play", "--xr-headless", "--scene", "/scenes/rails.json"], log).wait(60.0)
    said = [line for line in log.read_text(errors="replace").splitlines() if line.startswith("play --xr: ")]
    expect(status == 3 and len(said) == 1, f"absent: status {status}, said {said}")
    return said[0]


CHECKS = {"absent": check_absent, "poses": check_poses, "crawl": check_crawl, "touch": check_touch, "eyes": check_eyes, "panel": check_panel, "loss": check_loss}


def run(room: Room, names: list[str]) -> int:
    """Returns the number of failures. Feeds are in real time and a machine may stall, so a failed check is repeated once and counted."""
    failed = second_tries = 0
    for name in names:
        for is_last in (False, True):
            begin = time.monotonic()
            try:
                words, is_good = CHECKS[name](room), True
            except (Failed, OSError, subprocess.SubprocessError) as error:
                words, is_good = f"{'FAILED' if is_last else 'failed, once more'}: {error}", False
            finally:
                room.end_all()
            print(f"{name}: {words} ({time.monotonic() - begin:.0f} s)", flush=True)
            if is_good:
                break
            second_tries += not is_last
        failed += not is_good
    print(f"xr_e2e: {len(names)} checks, {second_tries} tried twice, {failed} failed", flush=True)
    return failed
