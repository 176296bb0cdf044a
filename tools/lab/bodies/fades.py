"""Where the corrections begin and end: fades of the networks, chosen by people who were not fitted."""
import numpy as np

from . import choosing, estimator, fitting

HIDDEN = 16
FOLDS = 10
CLOSE = 0.7  # arm lengths: frames that choose the fade at the shoulder
WIDTH = 5.0  # of the fades of familiarity, for smoothness
FAMILIAR = np.arange(1.0, 6.1, 0.5)
EQUAL, EQUAL_CLOSE = 1.001, 1.01  # errors that differ by less count as equal; close hands are a sixth of all
NEAR, WIDTHS = np.arange(0.0, 0.51, 0.1), np.arange(0.2, 0.61, 0.1)  # of the fade at the shoulder, arm lengths


class Fold:
    """Networks fitted on most people of a motion, and the frames of the others."""

    def __init__(self, motion, chest_constants, others, settings):
        own, self.motion = motion.rows(~others), motion.rows(others)
        chest, self.chest = (fitting.Chest(each, chest_constants) for each in (own, self.motion))
        self.chest_network = fitting.fit_chest(chest, HIDDEN, settings.rounds, settings.chest_noise, settings.decay, settings.seed)
        fitted, self.arms = (fitting.Arms(each.motion, *each.corrected(self.chest_network), estimator.FADE_START) for each in (chest, self.chest))
        self.pole = fitting.fit_talked_pole(fitted.circles)
        self.elbow_network, _ = fitting.fit_elbow(fitted, self.pole, HIDDEN, settings.rounds, settings.elbow_noise, settings.decay, settings.seed)
        self.distance = np.stack([each[:, 3] for each in self.arms.inputs])

    def chest_error(self, familiar):
        """Of yaw and shoulders together."""
        yaw, resting = self.chest.corrected(with_familiarity(self.chest_network, familiar))
        shoulders = estimator.shoulders_of(self.motion, yaw, resting)
        error = np.abs(estimator.wrapped(yaw - self.motion.yaw)) / 0.15 + np.linalg.norm(shoulders - self.motion.shoulder_m, axis=-1) / 0.05
        return choosing.mean_over_people(error, self.motion.person)

    def elbow_error(self, familiar, fade, farthest):
        """cm; of hands that are closer to their shoulders than `farthest`, arm lengths."""
        self.arms.fade = fade
        _, error = self.arms.errors(self.pole, with_familiarity(self.elbow_network, familiar))
        return choosing.mean_over_people(np.where(self.distance < farthest, error, np.nan), self.motion.person)


def folds(motion, chest_constants, settings):
    """[Fold], each with other people left out; none if there is only one person."""
    names = np.unique(motion.person)
    count = min(FOLDS, len(names))
    return [Fold(motion, chest_constants, np.isin(motion.person, names[first::count]), settings) for first in range(count) if count > 1]


def cautious(errors, trusts, equal):
    """Place of the least trust among the errors that are nearly the least."""
    errors = np.array(errors)
    return min(np.flatnonzero(errors <= equal * errors.min()), key=lambda place: trusts[place])


def fit_fades(every):
    """(familiarity of the chest's network, of the elbow's, fade at the shoulder), by the people whom the folds leave out. Of nearly equal ones the
    least trust in the network."""
    if not every:
        return 3.0, 3.0, estimator.FADE_START
    mean = lambda error: float(np.mean([error(fold) for fold in every]))
    fades = [{"near_shoulder": round(near, 1), "off_shoulder": round(near + width, 1)} for near in NEAR for width in WIDTHS]
    close = np.concatenate([fold.distance[fold.distance < CLOSE] for fold in every])
    trusts = [np.mean(estimator.smooth_step(close, fade["near_shoulder"], fade["off_shoulder"])) for fade in fades]
    fade = fades[cautious([mean(lambda fold: fold.elbow_error(FAMILIAR[-1], each, CLOSE)) for each in fades], trusts, EQUAL_CLOSE)]
    chest = [mean(lambda fold: fold.chest_error(each)) for each in FAMILIAR]
    elbow = [mean(lambda fold: fold.elbow_error(each, fade, np.inf)) for each in FAMILIAR]
    return *(float(FAMILIAR[cautious(errors, FAMILIAR, EQUAL)]) for errors in (chest, elbow)), fade


def with_familiarity(network, familiar):
    network.familiar, network.foreign = familiar, familiar + WIDTH
    return network
