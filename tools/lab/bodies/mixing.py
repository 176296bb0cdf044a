"""More frames to fit on: the arms of one frame on the head and chest of another.

Head and hands of few people move together in ways that are theirs alone. Mixed frames leave what a head says of its chest, and what hands say of theirs."""
import copy

import numpy as np

from . import estimator

MIXED = 1.0  # mixed frames for each recorded one
CROSSED = 0.25  # the same, with crossed hands only, which are rare


def taken(motion, rows):
    """The frames at these places, which may repeat."""
    result = copy.copy(motion)
    for name, values in vars(motion).items():
        setattr(result, name, values[rows] if len(values) == len(motion.yaw) else values[:, rows])
    return result


def joined(first, second):
    result = copy.copy(first)
    for name, values in vars(first).items():
        setattr(result, name, np.concatenate([values, getattr(second, name)], 0 if len(values) == len(first.yaw) else 1))
    return result


def crossed(motion):
    """Mask of frames with the left hand to the right of the right one, as the true chest faces."""
    return estimator.to_facing(motion.yaw, motion.hand_m[1] - motion.hand_m[0])[:, 0] < 0.0


def with_arms_of(bodies, arms):
    """Heads and chests of `bodies`; elbows and hands of `arms`, where they are from their shoulders in the facing of the chest, in arm lengths."""
    result = copy.copy(bodies)
    carried = lambda points, shoulder, to: to + estimator.from_facing(bodies.yaw, estimator.to_facing(arms.yaw, points - shoulder) * (bodies.arm_m / arms.arm_m)[:, None])
    for name in ("elbow_m", "hand_m"):
        setattr(result, name, np.stack([carried(*each) for each in zip(getattr(arms, name), arms.shoulder_m, bodies.shoulder_m)]))
    turn = bodies.yaw - arms.yaw
    cosine, sine, zero, one = np.cos(turn), np.sin(turn), np.zeros_like(turn), np.ones_like(turn)
    about_up = np.moveaxis(np.array([[cosine, zero, sine], [zero, one, zero], [-sine, zero, cosine]]), (0, 1), (-2, -1))
    result.hand, result.source = about_up @ arms.hand, arms.source
    return result


def mixed(motion, seed):
    """The motion, and after it mixed frames. Each person with crossed hands gives equally many of those."""
    random, count = np.random.default_rng(seed), len(motion.yaw)
    donors = [random.choice(count, int(MIXED * count))]
    rare = np.flatnonzero(crossed(motion))
    if len(rare):
        people = np.unique(motion.person[rare])
        of_person = [rare[motion.person[rare] == each] for each in people]
        donors.append(np.array([random.choice(of_person[random.integers(len(people))]) for _ in range(int(CROSSED * count))], int))
    hands = np.concatenate(donors)
    return joined(motion, with_arms_of(taken(motion, random.choice(count, len(hands))), taken(motion, hands)))
