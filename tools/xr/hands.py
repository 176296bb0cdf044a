"""The game's own convention of a hand on a grip, written again from OpenXR's words: what tools/xr_e2e feeds must lie on things."""
import math

HANDLE_RAD = math.pi / 3.0  # from the handle's axis to the fingers' roots


def multiply(a: tuple, b: tuple) -> tuple:
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx, aw * bz + ax * by - ay * bx + az * bw,
            aw * bw - ax * bx - ay * by - az * bz)


def about(axis: tuple, angle_rad: float) -> tuple:
    sine = math.sin(0.5 * angle_rad)
    return (axis[0] * sine, axis[1] * sine, axis[2] * sine, math.cos(0.5 * angle_rad))


def conjugate(q: tuple) -> tuple:
    return (-q[0], -q[1], -q[2], q[3])


def rotate(q: tuple, v: tuple) -> tuple:
    return multiply(multiply(q, (*v, 0.0)), conjugate(q))[:3]


def grip_of_flat_hand(side: str) -> tuple:
    """The grip's rotation where the hand points ahead with its palm down: the handle's axis lies across it, to the thumb."""
    outward = 1.0 if side == "right" else -1.0
    hand_in_grip = multiply(about((1.0, 0.0, 0.0), -HANDLE_RAD), about((0.0, 0.0, 1.0), -0.5 * math.pi * outward))
    return conjugate(hand_in_grip)
