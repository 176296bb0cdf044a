"""Chooses between fitted models by people who were not fitted."""
import numpy as np


def by_person(values, person):
    """{person: mean of the finite values}; values: (..., frames)."""
    return {name: float(np.nanmean(values[..., person == name])) for name in np.unique(person)}


def mean_over_people(values, person):
    """Mean over the people who have finite values, each with equal weight; inf if nobody has."""
    means = [np.nanmean(own) for own in (values[..., person == name] for name in np.unique(person)) if np.isfinite(own).any()]
    return float(np.mean(means)) if means else np.inf


def without_one(values, person):
    """(pooled mean, lowest and highest pooled mean with one person left out)."""
    left = [float(np.nanmean(values[..., person != name])) for name in np.unique(person)]
    return float(np.nanmean(values)), min(left), max(left)


def bounds_text(figure, values, person):
    """values may be NaN in the frames that do not count."""
    known = np.isin(person, [name for name in np.unique(person) if np.isfinite(values[..., person == name]).any()])
    if len(np.unique(person[known])) == 1:
        return f"{figure} {np.nanmean(values[..., known]):.2f} (one person)"
    mean, low, high = without_one(values[..., known], person[known])
    return f"{figure} {mean:.2f} ({low:.2f} to {high:.2f})"


class Candidate:
    """name, count (numbers of the model), model, and scores: {figure: (errors of all frames, goal)}."""

    def __init__(self, name, count, model, scores, person):
        self.name, self.count, self.model = name, count, model
        self.figures = "; ".join(bounds_text(figure, errors, person) for figure, (errors, _) in scores.items())
        relative = [{name: value / goal for name, value in by_person(errors, person).items()} for errors, goal in scores.values()]
        self.score = np.array([np.mean([each[name] for each in relative]) for name in np.unique(person)])

    def line(self):
        return f"{self.name}, {self.count} numbers: {self.figures}"


def choose(candidates, equal=0.001):
    """Of the candidates whose mean over people, relative to the goals, is within `equal` of the best: the smallest, of these the best."""
    least = min(each.score.mean() for each in candidates)
    return min((each for each in candidates if each.score.mean() <= least + equal), key=lambda each: (each.count, each.score.mean()))
