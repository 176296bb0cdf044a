"""The runtime's own fit of a hand, called through the Python binding."""
from dataclasses import dataclass

from . import gltf

# Joints of a hand as exported, in the order of hh_hand_joint_name; the palm has none.
JOINTS = [None, "wrist"] + [f"{finger}-{part}" for finger, parts in (
    ("thumb", ("metacarpal", "phalanx-proximal", "phalanx-distal", "tip")),
    *((f"{name}-finger", ("metacarpal", "phalanx-proximal", "phalanx-intermediate", "phalanx-distal", "tip"))
      for name in ("index", "middle", "ring", "pinky"))) for part in parts]
FINGERS = ("thumb", "index", "middle", "ring", "little")  # as grips name them
SIDES = ("left", "right")
STEPS_OPEN, STEPS_CLOSED = 5, 90  # the shown hand turns to a new fit at a bounded speed
STEPS_TO_GRIP = 10  # a hand that grips nothing by then has nothing in reach
DT_S = 1.0 / 90.0
EYES_M = 0.45  # from the hand: within an arm's length


class NothingToGrip(Exception):
    pass


@dataclass
class Fit:
    joints: dict  # name to pose in the object's frame, glTF's axes
    moved_m: float  # from the wrist given to the wrist shown


def binding():
    """The package systems/host/bindings/python; the preferences say where it is."""
    import handhold
    return handhold


class Closer:
    """A world with the object in it, and one hand that closes on it at any wrist. Preparing the object costs more than closing, so dragged hands
    keep it. Closing at one wrist gives the same, whatever was closed on before."""

    def __init__(self, points, triangles, side: str):
        hh = self.hh = binding()
        self.side, self.hand = side, SIDES.index(side)
        self.world = hh.World()
        mesh = hh.Mesh(positions=points, indices=triangles.reshape(-1))
        self.body = self.world.body_add(name="object", shape=self.world.shape_add_mesh(mesh, (1.0, 1.0, 1.0)))
        self.player = self.world.player_add(name="hand")
        self.world.use_wrists(self.player)
        self.begin = self.world.save()

    def close(self, wrist) -> Fit:
        """Closes the open hand at `wrist`, a pose in the object's frame, on the object's surface: what the game shows of a hand that grips there.
        Raises NothingToGrip if no surface is in the hand's reach."""
        hh, world = self.hh, self.world
        world.restore(self.begin)
        x, y, z, *turn = gltf.numbers_of(wrist)
        back = wrist.to_3x3().col[2] * EYES_M  # behind the wrist, where the forearm is
        for step in range(1, STEPS_OPEN + STEPS_CLOSED + 1):
            sample = hh.TrackingSample(time_s=step * DT_S, head=((x + back.x, y + back.y, z + back.z),))
            sample.hands = [((x, y, z), turn)] * 2
            sample.hand_tracked = [self.side == one for one in SIDES]
            sample.grab = [self.side == one and step > STEPS_OPEN for one in SIDES]
            world.step_player(DT_S, self.player, [sample])
            if step in (STEPS_OPEN + STEPS_TO_GRIP, STEPS_OPEN + STEPS_CLOSED) and world.player_hand(self.player, self.hand).body != self.body:
                raise NothingToGrip("no surface of the object is in the hand's reach: move it nearer, palm first")
        joints = {}
        for name, joint in zip(JOINTS, world.player_hand_joints(self.player, self.hand, hh.HH_SPACE_WORLD)):
            if name is not None and joint["is_valid"]:
                at, q = joint["pose"]["position"], joint["pose"]["rotation"]
                joints[name] = gltf.pose_of([at["x"], at["y"], at["z"], q["x"], q["y"], q["z"], q["w"]])
        return Fit(joints, (joints["wrist"].to_translation() - wrist.to_translation()).length)

    def __del__(self):
        if hasattr(self, "world"):
            self.world.close()


def close_hand(points, triangles, wrist, side: str) -> Fit:
    """Closes an empty hand at `wrist` once."""
    return Closer(points, triangles, side).close(wrist)
