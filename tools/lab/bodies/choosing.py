"""Chooses between fitted models by people who were not fitted."""
import numpy as np


def by_person(values, person):
    """{person: mean of the finite values}; values: (..., frames)."""
    return {name: float(np.nanmean(values[..., person == name])) for name in np.unique(person)}


def without_one(values, person):
    """(pooled mean, lowest and highest pooled mean with one person left out)."""
    left = [float(np.nanmean(values[..., person != name])) for name in np.unique(person)]
    return float(np.nanmean(values)), min(left), max(left)


class Candidate:
    """name, count (numbers of the model), model, and scores: {figure: (errors of all frames, goal)}."""

    def __init__(self, name, count, model, scores, person):
        self.name, self.count, self.model = name, count, model
        self.figures = {figure: without_one(errors, person) for figure, (errors, _) in scores.items()}
        relative = [{name: value / goal for name, value in by_person(errors, person).items()} for errors, goal in scores.values()]
        self.score = np.array([np.mean([each[name] for each in relative]) for name in np.unique(person)])

    def line(self):
        figures = "; ".join(f"{figure} {mean:.2f} ({low:.2f} to {high:.2f})" for figure, (mean, low, high) in self.figures.items())
        return f"{self.name}, {self.count} numbers: {figures}"


def choose(candidates):
    """The candidate with the best mean over people; of equals the smallest."""
    return min(candidates, key=lambda each: (round(float(each.score.mean()), 3), each.count))
