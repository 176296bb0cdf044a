"""Writes the fitted constants as the header that the runtime compiles in, and reads it."""
import re
import textwrap
import typing

import numpy as np

from . import estimator
from .estimator import LOOK_LAGS_S
from .network import Network

COLUMNS = 96


def number(value):
    text = f"{value:.4g}"
    return text if any(mark in text for mark in ".e") else text + ".0"


def wrapped_list(values, suffix, indent):
    lines, line = [], ""
    for value in values:
        cell = number(value) + suffix + ","
        if line and len(indent) + len(line) + 1 + len(cell) > COLUMNS:
            lines.append(indent + line)
            line = ""
        line = f"{line} {cell}" if line else cell
    return "\n".join(lines + [indent + line])


def network_text(name, network):
    """Outputs are scaled here, so that the runtime need not."""
    parts = [network.mean, 1.0 / network.deviation, network.weights[0].ravel(), network.bias[0], (network.weights[1] * network.scale).ravel(),
             network.bias[1] * network.scale]
    lists = ",\n".join(["    {{\n" + wrapped_list(part, "F", "        ") + "\n    }}" for part in parts] + [f"    {number(network.familiar)}, {number(network.foreign)}"])
    inputs, hidden, outputs = network.weights[0].shape[0], network.weights[0].shape[1], network.weights[1].shape[1]
    return (f"inline constexpr std::size_t k_{name}_inputs = {inputs};\n"
            f"inline constexpr std::size_t k_{name}_outputs = {outputs};\n"
            f"inline constexpr BodyNetwork<k_{name}_inputs, {hidden}, k_{name}_outputs> k_{name}_network = {{\n{lists}}};\n")


def comment(lines):
    """Wrapped; what a line continues is indented by two more than the line."""
    wrapped = []
    for line in lines:
        indent = line[:len(line) - len(line.lstrip())]
        wrapped += textwrap.wrap(line, COLUMNS, initial_indent="", subsequent_indent=indent + "  ")
    return "".join(f"// {line}\n" for line in wrapped)


def scalars(values):
    return "".join(f"inline constexpr double k_{name} = {number(value)};\n" for name, value in values.items())


def header(notes, chest, pole, fade, chest_network, elbow_network):
    """notes: lines of the leading comment. The others: {name: value} or network."""
    rest = ", ".join(number(pole[name]) for name in ("rest_x", "rest_y", "rest_z"))
    wrist = "".join(f"inline constexpr double k_pole_{name} = {number(pole[name])};\n" for name in ("fingers", "back", "thumb"))
    lags = ", ".join(number(lag) for lag in LOOK_LAGS_S)
    return f"""#pragma once

#include <array>
#include <cstddef>

#include "components/arm.hpp"
#include "systems/body/shared/body_network.hpp"

{comment(notes)}
// clang-format off
namespace handhold::body_constants {{

// Time constants of ArmMemory::looks_ps. The talk's formulas use the first.
inline constexpr std::array<double, k_look_filters> k_look_lags_s = {{{lags}}};

// The talk's formulas: chest_facing, chest_lean, chest_pose; trunk_view (nod, ears). Lengths: for an
// eye height of k_scale_eye_m.
{scalars(chest)}
// The talk's formulas: elbow_pole. The rest direction is that of a right arm, in torso axes.
inline constexpr std::array<double, 3> k_pole_rest = {{{rest}}};
{wrist}
// Distances of a hand from its shoulder, arm lengths, between which the elbow's network fades in.
{scalars(fade)}
// Inputs: chest_inputs in estimate_chest.cpp. Outputs: turn to the left (rad), middle of the
// shoulders (m), tangent of the roll.
{network_text("chest", chest_network)}
// Inputs: elbow_correction in elbow_direction.cpp. Outputs: added to elbow_pole.
{network_text("elbow", elbow_network)}
}}  // namespace handhold::body_constants
// clang-format on
"""


def rounded(network):
    """The network with the digits that the header keeps, so that scores are those of the runtime."""
    keep = lambda values: np.array([float(number(value)) for value in np.ravel(values)]).reshape(np.shape(values))
    network.mean, network.deviation = keep(network.mean), 1.0 / keep(1.0 / network.deviation)
    network.weights = [keep(network.weights[0]).astype(np.float32), (keep(network.weights[1] * network.scale) / network.scale).astype(np.float32)]
    network.bias = [keep(network.bias[0]).astype(np.float32), (keep(network.bias[1] * network.scale) / network.scale).astype(np.float32)]
    return network


class Form(typing.NamedTuple):
    """What a header holds."""

    talked: dict  # of the chest
    pole: dict
    fade: dict
    chest: Network
    elbow: Network


def read(text):
    """The Form of a header's text."""
    scalar = lambda name: float(re.search(rf"k_{name} = (\S+);", text).group(1))
    rest = re.search(r"k_pole_rest = \{(.*)\};", text).group(1).split(",")
    pole = dict(zip(("rest_x", "rest_y", "rest_z"), map(float, rest))) | {name: scalar(f"pole_{name}") for name in ("fingers", "back", "thumb")}
    return Form({name: scalar(name) for name in estimator.CHEST_START}, pole, {name: scalar(name) for name in estimator.FADE_START},
                read_network(text, "chest"), read_network(text, "elbow"))


def read_network(text, name):
    inputs, hidden, outputs = (int(each) for each in re.search(rf"k_{name}_inputs = (\d+);.*k_{name}_outputs = (\d+);.*?k_{name}_inputs, (\d+),", text, re.S)
                               .group(1, 3, 2))
    body = text[text.index(f"k_{name}_network = "):]
    body = body[:body.index(";")]
    lists = [np.array(re.findall(r"(-?[\d.]+(?:e[-+]?\d+)?)F", part), np.float32) for part in body.split("{\n")[2:8]]
    result = Network(np.zeros((2, inputs)), hidden, np.ones(outputs), np.random.default_rng(0))
    result.familiar, result.foreign = (float(each) for each in body[body.rindex("}},") + 3:body.rindex("}")].split(","))
    result.mean, result.deviation = lists[0], 1.0 / lists[1]
    result.weights, result.bias = [lists[2].reshape(inputs, hidden), lists[4].reshape(hidden, outputs)], [lists[3], lists[5]]
    return result
