"""The estimator of systems/body in numpy, for all frames at once, without its low-pass filters: what tools/lab/fit_body fits.

Arrays are (frames, ...); per arm (2, frames, ...), left first. Axes as in the runtime: +Y up, -Z forward, yaw positive to the left."""
import copy

import numpy as np

from .scoring import across, turned, unit, wrapped_deg

LOOK_LAGS_S = (0.15, 0.35, 1.0)  # body_constants::k_look_lags_s; the talk's formulas use the first
CHEST_LIMIT_RAD = 1.3962634015954636  # ArmTuning, as are the next four, and the cone
REACH, FOLLOW_M, CLAVICLE_LIFT, CLAVICLE_SHARE = 0.995, 0.06, 0.35, 0.8
CLAVICLE_CURVE = ((0.0, 0.7, 0.85, 1.05, 1.2), (0.006, 0.010, 0.018, 0.032, 0.070))
SCALE_EYE_M = 1.6
MIRROR = np.array([-1.0, 1.0, 1.0])
CONE, CONE_COSINE = np.array([0.54, -0.64, -0.54]), -0.087
LINE_FADES = (-0.05, 0.25)  # k_line_fades, k_line_full of estimate_chest.cpp, arm lengths
STEP_S = 1.0 / 90.0  # the runtime subdivides longer frames


def wrapped(angle_rad):
    return np.radians(wrapped_deg(np.degrees(angle_rad)))


def smooth_step(x, low, high):
    t = np.clip((x - low) / (high - low), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def matrices(xyzw):
    x, y, z, w = np.moveaxis(unit(xyzw), -1, 0)
    rows = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)], [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))


def times(m, v):
    return np.einsum("...ij,...j->...i", m, v)


def times_transposed(m, v):
    return np.einsum("...ji,...j->...i", m, v)


def level(yaw):
    return np.stack([-np.sin(yaw), 0.0 * yaw, -np.cos(yaw)], -1)


def to_facing(yaw, v):
    f = level(yaw)
    return np.stack([f[..., 0] * v[..., 2] - f[..., 2] * v[..., 0], v[..., 1], -(f[..., 0] * v[..., 0] + f[..., 2] * v[..., 2])], -1)


def from_facing(yaw, v):
    f = level(yaw)
    return np.stack([-(f[..., 2] * v[..., 0] + f[..., 0] * v[..., 2]), v[..., 1], f[..., 0] * v[..., 0] - f[..., 2] * v[..., 2]], -1)


def look_yaw(head):
    """Yaw of the head's look direction; beyond 45 degrees of pitch the up axis blends in."""
    up, ahead = head[..., 1], -head[..., 2]
    blend = smooth_step(np.abs(ahead[..., 1]), np.sqrt(0.5), 1.0)[..., None]
    look = (1.0 - blend) * ahead + np.where(ahead[..., 1:2] > 0.0, -blend, blend) * up
    return np.arctan2(-look[..., 0], -look[..., 2])


def low_passed(yaw, clip, hz, lag_s):
    """The runtime's filter: gain dt / (dt + lag) in steps of about STEP_S, between frames linear."""
    steps = max(1, int(1.0 / (hz * STEP_S) + 0.3))
    share = 1.0 / (1.0 + lag_s * hz * steps)
    result = np.empty_like(yaw)
    for each in np.unique(clip):
        rows = np.flatnonzero(clip == each)
        own = np.unwrap(yaw[rows])
        value = own[0]
        for place, row in enumerate(rows):
            for step in range(steps if place else 0):
                value += share * (own[place - 1] + (own[place] - own[place - 1]) * (step + 1) / steps - value)
            result[row] = value
    return result


class Tracked:
    """Heads and hands, and sizes of bodies."""

    def reach(self, side):
        """A hand from the eyes, in arm lengths."""
        return (self.hand_m[side] - self.eye_m) / self.arm_m[:, None]

    def hand_axes(self, yaw, side):
        """Fingers and back of a hand in the axes of a facing."""
        return to_facing(yaw, -self.hand[side][..., 2]), to_facing(yaw, self.hand[side][..., 1])

    def rows(self, mask):
        """The frames of a mask."""
        result = copy.copy(self)
        for name, values in vars(self).items():
            setattr(result, name, values[mask] if len(values) == len(mask) else values[:, mask])
        return result

    def size(self, eye_height_m, upper_m, forearm_m, width_m):
        self.scale, self.upper_m, self.forearm_m, self.width_m = eye_height_m / SCALE_EYE_M, upper_m, forearm_m, width_m
        self.arm_m = upper_m + forearm_m


class Motion(Tracked):
    """Recorded frames with their truth: those that are valid, `hz` of them a second."""

    def __init__(self, recording, truth, clips, hz):
        head = matrices(recording.head_xyzw)
        look = look_yaw(head)
        looks = np.stack([low_passed(look, recording.clip, recording.hz, lag) for lag in LOOK_LAGS_S])
        every = max(1, int(round(recording.hz / hz)))
        rows = np.concatenate([np.flatnonzero(recording.clip == each)[::every] for each in np.unique(recording.clip)])
        rows = rows[truth.valid[rows]]
        self.head, self.look, self.looks = head[rows], look[rows], looks[:, rows]
        self.eye_m, self.hand_m, self.hand = recording.head_m[rows], recording.hand_m[:, rows], matrices(recording.hand_xyzw[:, rows])
        self.yaw, self.shoulder_m, self.elbow_m = np.radians(truth.yaw_deg[rows]), truth.shoulder_m[:, rows], truth.elbow_m[:, rows]
        self.size(*np.array([clips.measures[each] for each in recording.clip[rows]]).T)
        self.person = np.array([clips.person[each] for each in recording.clip[rows]])
        self.source = np.array([clips.source[each] for each in recording.clip[rows]])


# ---- the talk's formulas

CHEST_START = {"hand_share": 0.15, "line_share": 1.35, "roll_share": 0.1, "lean": 0.5, "neck_m": 0.16, "shoulders_up_m": -0.061,
               "shoulders_back_m": 0.07, "nod_rad": 0.4, "ears_below_m": 0.05, "ears_behind_m": 0.08}
FADE_START = {"near_shoulder": 0.3, "off_shoulder": 0.7}
POLE_START = {"rest_x": 0.2, "rest_y": -0.29, "rest_z": 0.3, "fingers": -0.55, "back": 0.14, "thumb": -0.34}


def trunk_view(motion, constants):
    """(eyes, up) of the head as the trunk follows it: a head that looks up turns about its ears alone."""
    up, ahead = motion.head[..., 1], -motion.head[..., 2]
    pitch = np.arcsin(np.clip(ahead[:, 1:2], 0.0, 1.0))
    turn = pitch ** 2 / (pitch + constants["nod_rad"])
    up_then, ahead_then = np.cos(turn) * up + np.sin(turn) * ahead, np.cos(turn) * ahead - np.sin(turn) * up
    from_ears = constants["ears_below_m"] * (up_then - up) + constants["ears_behind_m"] * (ahead_then - ahead)
    return motion.eye_m + motion.scale[:, None] * from_ears, up_then


def lean_of(head_up, share):
    """Shortest rotation from +Y to the leaning up axis."""
    up = (1.0 - share) * np.array([0.0, 1.0, 0.0]) + share * head_up
    length = np.linalg.norm(up, axis=-1, keepdims=True)
    up = np.where(length > 0.1, up / np.maximum(length, 1e-9), [0.0, 1.0, 0.0])
    c, x, z = up[:, 1], up[:, 2], -up[:, 0]
    k = 1.0 / np.maximum(1.0 + c, 1e-9)
    rows = [[c + x * x * k, -z, x * z * k], [z, c, -x], [x * z * k, x, c + z * z * k]]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))


def talked_facing(motion, constants):
    """(yaw, lean) of the talk's formulas; the lean is that of the chest."""
    lean, look = lean_of(motion.head[..., 1], constants["lean"]), motion.looks[0]
    left, right = (to_facing(look, times_transposed(lean, motion.reach(side))) for side in (0, 1))
    line = right - left
    rolled = np.sum(lean[..., 1] * (motion.hand[1][..., 1] - motion.hand[0][..., 1]), -1)
    line_z = smooth_step(line[:, 0], *LINE_FADES) * line[:, 2]  # of crossed hands the line says nothing
    across_x = constants["hand_share"] * (left + right)[:, 0] + constants["line_share"] * line_z + constants["roll_share"] * rolled
    ahead = 1.0 - constants["hand_share"] * (left + right)[:, 2] + constants["line_share"] * np.maximum(line[:, 0], 0.0)
    return look + np.clip(np.arctan2(-across_x, ahead), -CHEST_LIMIT_RAD, CHEST_LIMIT_RAD), lean_of(trunk_view(motion, constants)[1], constants["lean"])


def chest_at(motion, constants, yaw, lean):
    """(middle of the shoulders, axes) of the chest without the network's offset."""
    f = level(yaw)
    flat = np.stack([np.stack([-f[:, 2], 0.0 * yaw, f[:, 0]], -1), np.tile([0.0, 1.0, 0.0], (len(yaw), 1)), -f], -1)
    axes = np.einsum("nij,njk->nik", lean, flat)
    from_neck = axes @ np.array([0.0, constants["shoulders_up_m"], constants["shoulders_back_m"]])
    eyes, up = trunk_view(motion, constants)
    return eyes + motion.scale[:, None] * (from_neck - constants["neck_m"] * up), axes


def resting_shoulders(motion, constants, yaw, lean, offset):
    """offset: (frames, 4), metres of the middle in chest axes at SCALE_EYE_M, and the tangent of the roll."""
    middle, axes = chest_at(motion, constants, yaw, lean)
    middle = middle + motion.scale[:, None] * times(axes, offset[:, :3])
    right = unit(axes[..., 0] + offset[:, 3:4] * axes[..., 1])
    half = 0.5 * motion.width_m[:, None] * right
    return np.stack([middle - half, middle + half])


# ---- the networks' inputs; the order is that of estimate_chest.cpp and elbow_direction.cpp

def mirror_of(side):
    return (MIRROR, -1.0) if side == 0 else (np.ones(3), 1.0)


def chest_inputs(motion, yaw, side):
    mirror, sign = mirror_of(side)
    own, other = (to_facing(yaw, motion.reach(each)) * mirror for each in (side, 1 - side))
    directions = [axis * mirror for each in (side, 1 - side) for axis in motion.hand_axes(yaw, each)]
    up, ahead = (to_facing(yaw, axis) * mirror for axis in (motion.head[..., 1], -motion.head[..., 2]))
    sines = sign * np.stack([np.sin(motion.look - yaw)] + [np.sin(motion.look - slow) for slow in motion.looks[1:]], -1)
    lengths = [np.linalg.norm(each, axis=-1, keepdims=True) for each in (own, other)]
    return np.concatenate([own, other, *directions, up, ahead, sines, *lengths], -1).astype(np.float32)


def products(a, b):
    return (a[:, :, None] * b[:, None, :]).reshape(len(a), -1)


def elbow_inputs(motion, yaw, shoulders, side):
    mirror, sign = mirror_of(side)
    own, other = (to_facing(yaw, motion.hand_m[each] - shoulders[each]) * mirror for each in (side, 1 - side))
    distance = np.linalg.norm(own, axis=-1, keepdims=True)
    axis, arm = own / np.maximum(distance, 1e-6), motion.arm_m[:, None]
    fingers, back = (each * mirror for each in motion.hand_axes(yaw, side))
    up = to_facing(yaw, motion.head[..., 1]) * mirror
    turn = sign * np.sin(motion.look - yaw)[:, None]
    return np.concatenate([axis, distance / arm, fingers, back, products(axis, fingers), products(axis, back), up, turn, other / arm], -1).astype(np.float32)


def elbow_trust(inputs, fade):
    """Weight of the elbow network's outputs: 0 for a hand at the shoulder. inputs: of elbow_inputs. fade: distances in arm lengths, see FADE_START."""
    return smooth_step(inputs[:, 3:4], fade["near_shoulder"], fade["off_shoulder"])


def shoulders_of(motion, yaw, resting):
    """Shoulders after the clavicles' curve and the reach for far hands."""
    result = []
    for side in (0, 1):
        hand = to_facing(yaw, motion.hand_m[side] - resting[side])
        near = hand / motion.arm_m[:, None]
        distance = np.linalg.norm(near, axis=-1)
        share = CLAVICLE_SHARE * np.interp(distance, *CLAVICLE_CURVE) / np.maximum(distance, 0.3)
        shift = np.stack([0.0 * share, near[:, 1] + CLAVICLE_LIFT, near[:, 2]], -1) * share[:, None]
        rest = hand - shift
        length = np.linalg.norm(rest, axis=-1, keepdims=True)
        follow = np.maximum(0.0, FOLLOW_M - np.linalg.norm(shift, axis=-1, keepdims=True))
        shift = shift + rest * np.clip(length - REACH * motion.arm_m[:, None], 0.0, follow) / np.maximum(length, 1e-9)
        result.append(resting[side] + from_facing(yaw, shift))
    return np.stack(result)


class Circles:
    """Circles on which the elbows of one side lie; mirrored to the right arm, in the axes of the chest's facing, from the shoulder."""

    def __init__(self, motion, yaw, shoulders, side):
        self.mirror, _ = mirror_of(side)
        self.yaw, self.shoulder_m = yaw, shoulders[side]
        reach = self.view(motion.hand_m[side] - self.shoulder_m)
        distance = np.linalg.norm(reach, axis=-1)
        self.axis = reach / np.maximum(distance, 1e-6)[:, None]
        stretch = np.maximum(1.0, distance / (REACH * motion.arm_m))
        upper, forearm = stretch * motion.upper_m, stretch * motion.forearm_m
        along = np.clip(0.5 * (distance + (upper - forearm) * (upper + forearm) / np.maximum(distance, 1e-9)), -upper, upper)
        self.radius_m = np.sqrt(np.maximum((upper - along) * (upper + along), 0.0))
        self.middle_m = along[:, None] * self.axis
        fingers, back = (each * self.mirror for each in motion.hand_axes(yaw, side))
        self.hand = np.stack([fingers, back, np.cross(back, fingers)], 1)

    def view(self, points):
        return to_facing(self.yaw, points) * self.mirror

    def talked_pole(self, constants):
        rest = np.array([constants["rest_x"], constants["rest_y"], constants["rest_z"]])
        return rest + np.einsum("nkj,k->nj", self.hand, [constants["fingers"], constants["back"], constants["thumb"]])

    def bend(self, pole):
        """Unit vectors from the circles' middles towards the elbows: the pole's direction, turned into the shoulder's cone."""
        bend = unit(across(pole, self.axis))
        upper = np.sqrt(np.sum(self.middle_m ** 2, -1) + self.radius_m ** 2)
        needs = upper * np.linalg.norm(CONE) * CONE_COSINE - self.middle_m @ CONE
        aside = CONE - self.axis * (self.axis @ CONE)[:, None]
        length = np.linalg.norm(aside, axis=-1)
        best = aside / np.maximum(length, 1e-9)[:, None]
        cosine = np.clip(needs / np.maximum(self.radius_m * length, 1e-9), -1.0, 1.0)[:, None]
        square = np.cross(self.axis, best)
        sine = np.sqrt(1.0 - cosine ** 2) * np.where(np.sum(square * bend, -1) < 0.0, -1.0, 1.0)[:, None]
        stays = (self.radius_m * (bend @ CONE) >= needs) | (length < 1e-6)
        return np.where(stays[:, None], bend, cosine * best + sine * square)

    def elbow_m(self, bend):
        """Elbows in play space."""
        return self.shoulder_m + from_facing(self.yaw, (self.middle_m + self.radius_m[:, None] * bend) * self.mirror)


class Elbows(Circles):
    """Circles, and the truth in them."""

    def __init__(self, motion, yaw, shoulders, side):
        super().__init__(motion, yaw, shoulders, side)
        # The true elbow's direction, carried from the true line to the estimated one.
        line = unit(self.view(motion.hand_m[side] - motion.shoulder_m[side]))
        aside = across(self.view(motion.elbow_m[side] - motion.shoulder_m[side]), line)
        self.true_m, self.true_radius_m = motion.elbow_m[side], np.linalg.norm(aside, axis=-1)
        level_axis = np.cross(self.axis, [0.0, 1.0, 0.0])
        steep = np.linalg.norm(level_axis, axis=-1) < 0.3
        level_axis[steep] = np.cross(self.axis[steep], [0.0, 0.0, 1.0])
        self.first = unit(level_axis)
        self.second = np.cross(self.axis, self.first)
        self.true_bend = unit(self.on_circle(turned(aside, line, self.axis)))

    def on_circle(self, direction):
        return np.stack([np.sum(direction * self.first, -1), np.sum(direction * self.second, -1)], -1)

    def errors(self, pole):
        """(signed swivel in degrees or NaN, elbow in cm)."""
        direction = self.bend(pole)
        bend = self.on_circle(direction)
        sine = bend[:, 0] * self.true_bend[:, 1] - bend[:, 1] * self.true_bend[:, 0]
        swivel = np.degrees(np.arctan2(sine, np.sum(bend * self.true_bend, -1)))
        elbow_cm = 100.0 * np.linalg.norm(self.elbow_m(direction) - self.true_m, axis=-1)
        return np.where(self.true_radius_m > 0.04, swivel, np.nan), elbow_cm
