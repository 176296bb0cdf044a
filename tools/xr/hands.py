"""The game's convention of a hand on a grip pose, implemented a second time from the OpenXR specification, so that tools/xr_e2e can place
hands on surfaces."""
import math

SLANT_RAD = 0.55   # of the handle's thumb end towards the fingers
RADIUS_M = 0.017   # of the handle: from its axis to the palm
ALONG_M = 0.018    # of the grip along it, to the thumb, from the middle of the palm


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
    """The grip's rotation if the hand points ahead with its palm down: the handle's axis lies across the palm, towards the thumb."""
    outward = 1.0 if side == "right" else -1.0
    hand_in_grip = multiply(about((1.0, 0.0, 0.0), SLANT_RAD - 0.5 * math.pi), about((0.0, 0.0, 1.0), -0.5 * math.pi * outward))
    return conjugate(hand_in_grip)


def grip_below_palm(side: str, palm: tuple) -> tuple:
    """The grip's position of such a hand, given its palm's centre."""
    to_thumb = -1.0 if side == "right" else 1.0
    return (palm[0] + to_thumb * ALONG_M * math.cos(SLANT_RAD), palm[1] - RADIUS_M, palm[2] - ALONG_M * math.sin(SLANT_RAD))
