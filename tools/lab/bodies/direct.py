"""Networks that give chest and elbows directly, without the talk's formulas below them: three tries against the form that the runtime uses.

Axes as in estimator.py. The frame of a network is level and faces along the head's filtered look, or along the facing that a first network gave."""
import typing

import numpy as np

from . import estimator, fitting, mixing
from .network import Network, epochs

TURN, MIDDLE, ROLL, POLE = slice(0, 2), slice(2, 5), 5, slice(6, 9)  # outputs
TURN_SCALE, MIDDLE_SCALE, ROLL_SCALE = (0.5, 0.5), (0.05, 0.05, 0.05), (0.2,)
SIGNS = np.array([-1.0, 1.0, -1.0, 1.0, 1.0, -1.0], np.float32)  # of the left side's outputs, up to the roll
SHOULDER_M = np.array([0.17, -0.22, 0.08])  # a right shoulder from the eyes, for SCALE_EYE_M
ACROSS, AT_SHOULDER = 0.1, 0.45  # arm lengths
BATCH, ROUNDS, DECAY = fitting.BATCH, 16, 1e-4
RARE = 3.0  # weight of a frame of a situation
HIDDEN, NOISE = 24, 0.25  # of the one network
TWO_HIDDEN, TWO_NOISE = (24, 20), (0.2, 0.35)
SITUATIONS = ("crossed", "one hand across", "looking up", "hand at the shoulder")


def situations(motion):
    """{name: mask of frames}, by the true chest."""
    from_eyes = [estimator.to_facing(motion.yaw, motion.reach(side)) for side in (0, 1)]
    crossed = mixing.crossed(motion)
    from_shoulders = [np.linalg.norm(motion.hand_m[side] - motion.shoulder_m[side], axis=-1) / motion.arm_m for side in (0, 1)]
    across = ((from_eyes[0][:, 0] > ACROSS) | (from_eyes[1][:, 0] < -ACROSS)) & ~crossed
    masks = (crossed, across, fitting.looks_up(motion), np.minimum(*from_shoulders) < AT_SHOULDER)
    return dict(zip(SITUATIONS, masks))


def frame_weights(motion, rare):
    """Of people by the root of their frames; a frame of a situation counts `rare` times as much."""
    weights = fitting.person_weights(motion.person) * np.where(np.any(list(situations(motion).values()), 0), rare, 1.0)
    return (weights / weights.mean()).astype(np.float32)


def inputs_of(motion, yaw, side):
    """What one network of everything sees: of the own side's arm, mirrored to the right. yaw: of its frame."""
    mirror, _ = estimator.mirror_of(side)
    hands = estimator.chest_inputs(motion, yaw, side)
    own = estimator.to_facing(yaw, motion.hand_m[side] - motion.eye_m) * mirror - motion.scale[:, None] * SHOULDER_M
    distance = np.linalg.norm(own, axis=-1, keepdims=True)
    axis = own / np.maximum(distance, 1e-6)
    fingers, back = (each * mirror for each in motion.hand_axes(yaw, side))
    line = hands[:, :3] - hands[:, 3:6]
    level = line[:, [0, 2]] / np.maximum(np.linalg.norm(line[:, [0, 2]], axis=-1, keepdims=True), 0.1)
    arm = [axis, distance / motion.arm_m[:, None], estimator.products(axis, fingers), estimator.products(axis, back)]
    return np.concatenate([hands, level, *arm], -1).astype(np.float32)


def in_frame(frame_yaw, chest_yaw, vectors, side):
    """Mirrored vectors in the chest's facing, as the network's frame sees them."""
    mirror, _ = estimator.mirror_of(side)
    return estimator.to_facing(frame_yaw, estimator.from_facing(chest_yaw, vectors * mirror)) * mirror


class Targets(typing.NamedTuple):
    turn: np.ndarray
    middle: np.ndarray
    roll: np.ndarray


class Neck:
    """The geometry of head, neck and shoulders, with the constants of the talk's formulas, for a chest that may face anywhere."""

    def __init__(self, motion, constants):
        self.motion, self.constants = motion, constants
        self.lean = estimator.lean_of(estimator.trunk_view(motion, constants)[1], constants["lean"])

    def chest_of(self, frame_yaw, outputs):
        """(yaw, resting shoulders) for outputs (frames, 6) of both sides together."""
        yaw = frame_yaw + np.arctan2(outputs[:, 0], 1.0 + outputs[:, 1])
        return yaw, estimator.resting_shoulders(self.motion, self.constants, yaw, self.lean, outputs[:, 2:6])

    def targets(self, frame_yaw):
        """Right answers: (sine and cosine of the turn, middle, tangent of the roll)."""
        wanted = fitting.offsets_of(self.motion, self.constants, self.lean)
        turn = estimator.wrapped(self.motion.yaw - frame_yaw)
        return Targets(np.stack([np.sin(turn), np.cos(turn)], -1).astype(np.float32), wanted[:, :3].astype(np.float32), wanted[:, 3].astype(np.float32))


def turn_gradient(outputs, wanted, weights):
    """d / d outputs of sqrt(2 (1 - cosine) + 0.01), about the angle between the answer (s, 1 + c) and the wanted direction."""
    facing = outputs + np.array([0.0, 1.0], np.float32)
    length = np.maximum(np.linalg.norm(facing, axis=-1, keepdims=True), 0.1)
    unit = facing / length
    cosine = np.sum(unit * wanted, -1, keepdims=True)
    slope = -weights / np.sqrt(2.0 * (1.0 - cosine) + 0.01) / length
    return slope * (wanted - cosine * unit) + 0.02 * weights * (length - 1.0) * unit


def chest_gradient(outputs, targets, rows, weights):
    """d loss / d outputs of both sides together, (rows, 6); in units of the scales, as fitting.fit_chest weighs them."""
    turn = turn_gradient(outputs[:, TURN], targets.turn[rows], weights) * 1.5 / 0.15
    error = (outputs[:, MIDDLE] - targets.middle[rows]) / 0.04
    middle = weights * error / np.sqrt(error * error + 0.1) / 0.04
    tilt = (outputs[:, ROLL:ROLL + 1] - targets.roll[rows, None]) / ROLL_SCALE[0]
    return np.concatenate([turn, middle, 0.3 * weights * tilt / np.sqrt(tilt * tilt + 0.1) / ROLL_SCALE[0]], -1)


class Poles:
    """Circles of the elbows at a chest, with the true bends, in the axes of a network's frame; both sides one after the other."""

    def __init__(self, motion, frame_yaw, yaw, shoulders):
        circles = [estimator.Elbows(motion, yaw, shoulders, side) for side in (0, 1)]
        turned = lambda name: np.concatenate([in_frame(frame_yaw, yaw, getattr(each, name), side) for side, each in enumerate(circles)]).astype(np.float32)
        self.first, self.second = turned("first"), turned("second")
        self.bend = np.concatenate([each.true_bend for each in circles]).astype(np.float32)
        self.radius_m = np.concatenate([each.true_radius_m for each in circles]).astype(np.float32)

    def gradient(self, poles, rows, weights):
        first, second = self.first[rows], self.second[rows]
        count = weights * np.where(self.radius_m[rows] > 0.02, np.minimum(self.radius_m[rows] / 0.1, 1.5) ** 0.7, 0.0)
        return fitting.pole_gradient(np.sum(poles * first, -1), np.sum(poles * second, -1), self.bend[rows], count, first, second)


def errors_of(motion, yaw, resting, poles_of):
    """{figure: errors}; poles_of(yaw, shoulders): mirrored poles of both arms in the chest's facing."""
    shoulders = estimator.shoulders_of(motion, yaw, resting)
    pairs = [estimator.Elbows(motion, yaw, shoulders, side).errors(pole) for side, pole in enumerate(poles_of(yaw, shoulders))]
    swivel, elbow = (np.stack(each) for each in zip(*pairs))
    return {"chest yaw, deg": np.degrees(np.abs(estimator.wrapped(yaw - motion.yaw))),
            "shoulder, cm": 100.0 * np.linalg.norm(shoulders - motion.shoulder_m, axis=-1), "elbow, cm": elbow, "swivel, deg": np.abs(swivel)}


class OneNetwork:
    """Chest and poles from one network in the frame of the look."""

    def __init__(self, motion, constants, hidden, noise, seed, with_poles=True):
        random = np.random.default_rng(seed)
        self.constants, self.with_poles = constants, with_poles
        look = motion.looks[0]
        inputs = [self.inputs(motion, side) for side in (0, 1)]
        scale = (*TURN_SCALE, *MIDDLE_SCALE, *ROLL_SCALE, *(fitting.POLE_SCALE if with_poles else ()))
        self.network = Network(np.concatenate(inputs), hidden, scale, random)
        targets = Neck(motion, constants).targets(look)
        z = [self.network.scaled(each) for each in inputs]
        weights, count = frame_weights(motion, RARE), len(look)
        poles = Poles(motion, look, motion.yaw, motion.shoulder_m) if with_poles else None
        for rows, rate, begins in epochs(ROUNDS, count, BATCH, 3e-3, random):
            if begins and with_poles:
                yaw, resting = self.chest(motion)
                poles = Poles(motion, look, yaw, estimator.shoulders_of(motion, yaw, resting))
            own = np.concatenate([z[1][rows], z[0][rows]])
            answers = self.network.scale * self.network.forward(own + noise * random.standard_normal(own.shape, dtype=np.float32))
            together = 0.5 * (answers[:BATCH, :6] + SIGNS * answers[BATCH:, :6])
            gradient = 0.5 * chest_gradient(together, targets, rows, weights[rows, None] / BATCH)
            gradient = np.concatenate([gradient, SIGNS * gradient])
            if with_poles:
                arms = np.concatenate([count + rows, rows])
                gradient = np.concatenate([gradient, 10.0 * poles.gradient(answers[:, POLE], arms, np.tile(weights[rows], 2) / (2 * BATCH))], -1)
            self.network.learn((gradient * self.network.scale).astype(np.float32), rate, DECAY)

    def inputs(self, motion, side):
        every = inputs_of(motion, motion.looks[0], side)
        return every if self.with_poles else every[:, :31]

    def count(self):
        return self.network.count()

    def answers(self, motion):
        return [self.network.outputs(self.inputs(motion, side)) for side in (0, 1)]

    def chest(self, motion):
        left, right = self.answers(motion)
        return Neck(motion, self.constants).chest_of(motion.looks[0], 0.5 * (right[:, :6] + SIGNS * left[:, :6]))

    def errors(self, motion):
        """{figure: errors of all frames}"""
        poles = [each[:, POLE] for each in self.answers(motion)]
        return errors_of(motion, *self.chest(motion), lambda yaw, shoulders: [in_frame(yaw, motion.looks[0], pole, side) for side, pole in enumerate(poles)])


class TwoNetworks:
    """A chest from one network; poles from a second one in the facing that the first gave. chests: what the first learns from."""

    def __init__(self, motion, constants, chests, seed):
        self.first = OneNetwork(chests, constants, TWO_HIDDEN[0], TWO_NOISE[0], seed, with_poles=False)
        random = np.random.default_rng(seed)
        yaw, resting = self.first.chest(motion)
        shoulders = estimator.shoulders_of(motion, yaw, resting)
        inputs = np.concatenate([estimator.elbow_inputs(motion, yaw, shoulders, side) for side in (0, 1)])
        self.second = Network(inputs, TWO_HIDDEN[1], fitting.POLE_SCALE, random)
        poles, z, weights = Poles(motion, yaw, yaw, shoulders), self.second.scaled(inputs), np.tile(frame_weights(motion, RARE), 2)
        for rows, rate, _ in epochs(ROUNDS, len(z), 2 * BATCH, 3e-3, random):
            answers = self.second.scale * self.second.forward(z[rows] + TWO_NOISE[1] * random.standard_normal((len(rows), z.shape[1]), dtype=np.float32))
            self.second.learn((poles.gradient(answers, rows, weights[rows] / len(rows)) * self.second.scale).astype(np.float32), rate, DECAY)

    def count(self):
        return self.first.count() + self.second.count()

    def errors(self, motion):
        return errors_of(motion, *self.first.chest(motion),
                         lambda yaw, shoulders: [self.second.outputs(estimator.elbow_inputs(motion, yaw, shoulders, side)) for side in (0, 1)])


def tries(motion, constants, seed):
    """Yields (name, model). constants: of the neck, from the talk's formulas."""
    yield "one network", OneNetwork(motion, constants, HIDDEN, NOISE, seed)
    yield "two networks", TwoNetworks(motion, constants, motion, seed)
    yield "two networks, mixed frames", TwoNetworks(motion, constants, mixing.mixed(motion, seed), seed)


def report_lines(name, count, errors, motion):
    """Means of the figures over all frames, and of the yaw in the situations."""
    yaw = errors["chest yaw, deg"]
    rare = "; ".join(f"{situation} {np.mean(yaw[rows]):.1f}" if rows.any() else f"{situation} -" for situation, rows in situations(motion).items())
    yield f"{name}, {count} numbers: " + "; ".join(f"{figure} {np.nanmean(values):.2f}" for figure, values in errors.items())
    yield f"  yaw in situations: {rare}"
