"""Small networks as systems/body/shared/body_network.hpp evaluates them, and their training."""
import numpy as np

from .estimator import smooth_step

LIMIT = 4.0  # standard deviations


def activation(z):
    """(value, derivative) of z / sqrt(1 + z^2)."""
    by = 1.0 / np.sqrt(1.0 + z * z)
    return z * by, by * by * by


class Network:
    """One hidden layer. scale: of the outputs, for the training. familiar, foreign: mean squares of the inputs, in standard deviations, between
    which the answers fade out."""

    def __init__(self, inputs, hidden, scale, random):
        self.mean, self.deviation = inputs.mean(0), np.maximum(inputs.std(0), 0.05)
        self.scale = np.asarray(scale, np.float32)
        sizes = (inputs.shape[1], hidden, len(scale))
        self.weights = [(random.standard_normal((a, b)) * np.sqrt(1.5 / a)).astype(np.float32) for a, b in zip(sizes[:-1], sizes[1:])]
        self.weights[-1] *= 0.3
        self.bias = [np.zeros(size, np.float32) for size in sizes[1:]]
        self.first = [np.zeros_like(each) for each in self.weights + self.bias]
        self.second = [np.zeros_like(each) for each in self.weights + self.bias]
        self.steps = 0
        self.familiar, self.foreign = 3.0, 8.0

    def count(self):
        return sum(each.size for each in self.weights + self.bias) + 2 * len(self.mean)

    def scaled(self, inputs):
        return np.clip((inputs - self.mean) / self.deviation, -LIMIT, LIMIT).astype(np.float32)

    def familiarity(self, inputs):
        return 1.0 - smooth_step(self.mean_square(inputs), self.familiar, self.foreign)

    def mean_square(self, inputs):
        return np.mean(((inputs - self.mean) / self.deviation) ** 2, -1)

    def outputs(self, inputs):
        return self.scale * self.forward(self.scaled(inputs))

    def forward(self, z):
        self.layers = []
        for weights, bias in zip(self.weights, self.bias):
            self.layers.append((z, None if not self.layers else slope))
            z = z @ weights + bias
            if len(self.layers) < len(self.weights):
                z, slope = activation(z)
        return z

    def learn(self, gradient, rate, decay):
        """One step of Adam (Kingma and Ba 2015) for d loss / d outputs of the last forward()."""
        of_weights, of_bias = [], []
        for place in reversed(range(len(self.weights))):
            z, slope = self.layers[place]
            of_weights.insert(0, z.T @ gradient + decay * self.weights[place])
            of_bias.insert(0, gradient.sum(0))
            if place:
                gradient = (gradient @ self.weights[place].T) * slope
        self.steps += 1
        for value, slope, first, second in zip(self.weights + self.bias, of_weights + of_bias, self.first, self.second):
            first += 0.1 * (slope - first)
            second += 0.002 * (slope * slope - second)
            value -= rate * (first / (1.0 - 0.9 ** self.steps)) / (np.sqrt(second / (1.0 - 0.998 ** self.steps)) + 1e-8)


def epochs(count, rows, batch, rate, random):
    """Yields (rows of a batch, learning rate), `count` times over all rows; the rate falls as a cosine."""
    for epoch in range(count):
        order = random.permutation(rows)
        now = 0.5 * rate * (1.0 + np.cos(np.pi * epoch / count)) + 1e-5
        for start in range(0, len(order) - batch + 1, batch):
            yield order[start:start + batch], now, start == 0
