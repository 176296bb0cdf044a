"""Fits the constants of systems/body: first the talk's formulas, then the networks that correct it."""
import numpy as np

from . import choosing, estimator, mixing
from .estimator import Elbows
from .network import Network, epochs

CHEST_SCALE = (0.15, 0.04, 0.04, 0.04, 0.2)  # rad; m, m, m; tangent of the roll
CHEST_LATERAL = np.array([-1.0, -1.0, 1.0, 1.0, -1.0], np.float32)  # signs of the left side's outputs
POLE_SCALE = (0.3, 0.3, 0.3)
BATCH = 512
LOOKS_UP_DEG = 15.0


def descend(cost, constants, steps, rounds=4):
    """Coordinate descent: halves the steps `rounds` times. constants: {name: value}."""
    best, constants = cost(constants), dict(constants)
    for halving in range(rounds):
        for name, step in steps.items():
            for change in (step / 2 ** halving, -step / 2 ** halving):
                while True:
                    other = {**constants, name: constants[name] + change}
                    value = cost(other)
                    if not value < best - 1e-6:
                        break
                    best, constants = value, other
    return constants


def soft(values, small):
    """Mean of |values|, rounded off near 0."""
    return np.mean(np.sqrt(values ** 2 + small ** 2))


def fit_talked_chest(motion):
    def cost(constants):
        yaw, lean = estimator.talked_facing(motion, constants)
        shoulders = estimator.shoulders_of(motion, yaw, estimator.resting_shoulders(motion, constants, yaw, lean, np.zeros((len(yaw), 4))))
        off = np.linalg.norm(shoulders - motion.shoulder_m, axis=-1)
        return soft(estimator.wrapped(yaw - motion.yaw), 0.05) / 0.15 + soft(off, 0.01) / 0.05

    steps = {"hand_share": 0.05, "line_share": 0.3, "roll_share": 0.05, "lean": 0.1, "neck_m": 0.02, "shoulders_up_m": 0.02, "shoulders_back_m": 0.02}
    constants = estimator.CHEST_START
    for _ in range(2):
        constants = fit_trunk_view(motion, descend(cost, constants, steps))
    return constants


def looks_up(motion):
    return motion.head[:, 1, 2] < -np.sin(np.radians(LOOKS_UP_DEG))


def shoulders_at_truth(motion, constants):
    """Error of both shoulders in the talk's formulas, cm, if the chest faced where it truly does."""
    lean = estimator.talked_facing(motion, constants)[1]
    resting = estimator.resting_shoulders(motion, constants, motion.yaw, lean, np.zeros((len(motion.yaw), 4)))
    return 100.0 * np.linalg.norm(estimator.shoulders_of(motion, motion.yaw, resting) - motion.shoulder_m, axis=-1)


def fit_trunk_view(motion, constants):
    """The constants of trunk_view, by the frames that look up alone, as long as all frames together do not get worse."""
    rare = motion.rows(looks_up(motion))
    if not len(rare.yaw):
        return constants
    error = lambda frames, now: choosing.mean_over_people(shoulders_at_truth(frames, now), frames.person)
    whole = error(motion, constants)

    def cost(now):
        if now["nod_rad"] < 0.05 or now["ears_below_m"] < 0.0 or now["ears_behind_m"] < 0.0:
            return np.inf
        return error(rare, now)

    fitted = descend(cost, constants, {"nod_rad": 0.2, "ears_below_m": 0.04, "ears_behind_m": 0.04})
    return fitted if error(motion, fitted) <= whole else constants


def fit_talked_pole(circles):
    def cost(constants):
        chord = [np.linalg.norm(estimator.unit(each.on_circle(each.talked_pole(constants))) - each.true_bend, axis=-1) for each in circles]
        return sum(np.sum(np.sqrt(one ** 2 + 0.02) * np.minimum(each.true_radius_m, 0.15)) for one, each in zip(chord, circles))

    return descend(cost, estimator.POLE_START, dict.fromkeys(estimator.POLE_START, 0.1))


def person_weights(person):
    """Frames of people with many frames count less: by the root of their number."""
    names, counts = np.unique(person, return_counts=True)
    weights = 1.0 / np.sqrt(counts[np.searchsorted(names, person)])
    return (weights / weights.mean()).astype(np.float32)


def offsets_of(motion, constants, lean):
    """Displacement of the shoulders' middle and tangent of the roll that would be right in a chest that faces as it truly does: (frames, 4)."""
    shift = estimator.shoulders_of(motion, motion.yaw, motion.shoulder_m) - motion.shoulder_m
    lifted = np.mean([estimator.to_facing(motion.yaw, each) / motion.scale[:, None] for each in shift], (0, 1)) * [0.0, 1.0, 1.0]
    middle, axes = estimator.chest_at(motion, constants, motion.yaw, lean)
    offset = estimator.times_transposed(axes, 0.5 * (motion.shoulder_m[0] + motion.shoulder_m[1]) - middle) / motion.scale[:, None] - lifted
    line = estimator.times_transposed(axes, motion.shoulder_m[1] - motion.shoulder_m[0])
    roll = np.clip(line[:, 1] / np.maximum(np.abs(line[:, 0]), 0.05), -1.0, 1.0)
    return np.concatenate([offset, roll[:, None]], -1)


class Chest:
    """The chest's estimate of all frames: talk's formulas, then the network."""

    def __init__(self, motion, constants):
        self.motion, self.constants = motion, constants
        self.talked, self.lean = estimator.talked_facing(motion, constants)
        self.inputs = [estimator.chest_inputs(motion, self.talked, side) for side in (0, 1)]

    def targets(self):
        """Outputs that would be right: (frames, 5). The clavicles' mean displacement is left to the clavicles."""
        motion = self.motion
        turn = estimator.wrapped(motion.yaw - self.talked)
        return np.concatenate([turn[:, None], offsets_of(motion, self.constants, self.lean)], -1)

    def corrected(self, network):
        """(yaw, resting shoulders)."""
        if network is None:
            offset = np.zeros((len(self.talked), 5))
        else:
            left, right = (network.outputs(each) for each in self.inputs)
            familiar = np.minimum(*(network.familiarity(each) for each in self.inputs))
            offset = 0.5 * familiar[:, None] * (right + CHEST_LATERAL * left)
        yaw = self.talked + offset[:, 0]
        return yaw, estimator.resting_shoulders(self.motion, self.constants, yaw, self.lean, offset[:, 1:])


def fit_chest(chest, hidden, rounds, noise, decay, seed):
    """chest: of recorded frames; the network learns from mixed ones too."""
    chest = Chest(mixing.mixed(chest.motion, seed), chest.constants)
    random = np.random.default_rng(seed)
    network = Network(np.concatenate(chest.inputs), hidden, CHEST_SCALE, random)
    left, right = (network.scaled(each) for each in chest.inputs)
    targets = (chest.targets() / CHEST_SCALE).astype(np.float32)
    weights = person_weights(chest.motion.person)[:, None] * np.array([1.5, 1.0, 1.0, 1.0, 0.3], np.float32) / BATCH
    for rows, rate, _ in epochs(rounds, len(targets), BATCH, 3e-3, random):
        z = np.concatenate([right[rows], left[rows]])
        outputs = network.forward(z + noise * random.standard_normal(z.shape, dtype=np.float32))
        error = 0.5 * (outputs[:BATCH] + CHEST_LATERAL * outputs[BATCH:]) - targets[rows]
        gradient = 0.5 * weights[rows] * error / np.sqrt(error * error + 0.1)
        network.learn(np.concatenate([gradient, CHEST_LATERAL * gradient]), rate, decay)
    return network


class Arms:
    """The elbows' estimate of all frames, given the chest's. fade: of elbow_trust. kind: Circles if there is no truth."""

    def __init__(self, motion, yaw, resting, fade, kind=Elbows):
        self.shoulders_m = estimator.shoulders_of(motion, yaw, resting)
        shoulders, self.motion, self.fade = self.shoulders_m, motion, fade
        self.circles = [kind(motion, yaw, shoulders, side) for side in (0, 1)]
        self.inputs = [estimator.elbow_inputs(motion, yaw, shoulders, side) for side in (0, 1)]

    def poles(self, constants, network):
        poles = [each.talked_pole(constants) for each in self.circles]
        if network is None:
            return poles
        trusts = [estimator.elbow_trust(inputs, self.fade) * network.familiarity(inputs)[:, None] for inputs in self.inputs]
        return [pole + trust * network.outputs(inputs) for pole, trust, inputs in zip(poles, trusts, self.inputs)]

    def errors(self, constants, network):
        """(signed swivel (2, frames), elbow in cm (2, frames))."""
        pairs = [each.errors(pole) for each, pole in zip(self.circles, self.poles(constants, network))]
        return tuple(np.stack(each) for each in zip(*pairs))


def turned_by(bend, angle):
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.stack([cosine * bend[:, 0] - sine * bend[:, 1], sine * bend[:, 0] + cosine * bend[:, 1]], -1).astype(np.float32)


class SourceOffsets:
    """A constant swivel of each source, which the runtime drops. Their mean over the frames is 0."""

    def __init__(self, source):
        self.names, self.of_row = np.unique(source, return_inverse=True)
        self.angle = np.zeros(len(self.names))

    def update(self, residual, weights):
        """residual: angle from the estimate to the truth without the offset, rad."""
        for place in range(len(self.names)):
            rows = self.of_row == place
            self.angle[place] = np.arctan2(np.sum(weights[rows] * np.sin(residual[rows])), np.sum(weights[rows] * np.cos(residual[rows])))
        share = np.bincount(self.of_row, weights, len(self.names)) / weights.sum()
        self.angle -= np.sum(share * self.angle)

    def rows(self):
        return self.angle[self.of_row]


def fit_elbow(arms, constants, hidden, rounds, noise, decay, seed):
    """(network, SourceOffsets)"""
    random = np.random.default_rng(seed)
    network = Network(np.concatenate(arms.inputs), hidden, POLE_SCALE, random)
    both = lambda name: np.concatenate([getattr(each, name) for each in arms.circles]).astype(np.float32)
    first, second, radius = both("first"), both("second"), both("true_radius_m")
    talked = np.concatenate([each.talked_pole(constants) for each in arms.circles]).astype(np.float32)
    true_bend = both("true_bend")
    offsets = SourceOffsets(np.tile(arms.motion.source, 2))
    wanted = true_bend
    z = network.scaled(np.concatenate(arms.inputs))
    scale = network.scale * estimator.elbow_trust(np.concatenate(arms.inputs), arms.fade)
    weights = np.tile(person_weights(arms.motion.person), 2) * np.minimum(radius / 0.1, 1.5) ** 0.7
    bent = np.flatnonzero(radius > 0.02)
    for rows, rate, begins in epochs(rounds, bent, 2 * BATCH, 3e-3, random):
        if begins and len(offsets.names) > 1:
            pole = talked + scale * network.forward(z)
            x, y = np.sum(pole * first, -1), np.sum(pole * second, -1)
            residual = np.arctan2(x * true_bend[:, 1] - y * true_bend[:, 0], x * true_bend[:, 0] + y * true_bend[:, 1])
            offsets.update(residual, weights)
            wanted = turned_by(true_bend, -offsets.rows())
        outputs = network.forward(z[rows] + noise * random.standard_normal((len(rows), z.shape[1]), dtype=np.float32))
        pole = talked[rows] + scale[rows] * outputs
        x, y = np.sum(pole * first[rows], -1), np.sum(pole * second[rows], -1)
        network.learn(pole_gradient(x, y, wanted[rows], weights[rows] / len(rows), first[rows], second[rows]) * scale[rows], rate, decay)
    return network, offsets


def pole_gradient(x, y, wanted, weights, first, second):
    """d loss / d pole. With u = (x, y) / n: loss = sqrt(2 (1 - u . wanted) + 0.02), about the angle between them; the length n of the pole's
    part across the line is kept near 0.5."""
    length = np.sqrt(x * x + y * y) + 1e-4
    x, y = x / length, y / length
    cosine = x * wanted[:, 0] + y * wanted[:, 1]
    slope = -weights / np.sqrt(2.0 * (1.0 - cosine) + 0.02) / length
    keep = 0.02 * (length - 0.5) / len(length)
    along_first = slope * (wanted[:, 0] - x * cosine) + keep * x
    along_second = slope * (wanted[:, 1] - y * cosine) + keep * y
    return along_first[:, None] * first + along_second[:, None] * second
