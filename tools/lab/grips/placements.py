"""Random wrists around a surface. near: the palm's centre 0 to 2 cm in front of the surface, facing it within 30 degrees. harsh: 3 cm
behind to 6 cm in front, within 60 degrees: worse than people do. Any roll; uniform over area, height and directions."""
import math

import numpy as np
from scipy.spatial.transform import Rotation

PALM_CENTER_HS_M = (0.0, -0.014, -0.08)
KINDS = {"near": (0.0, 0.02, 30.0), "harsh": (-0.03, 0.06, 60.0)}
MOST_TRIES = 50


def unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def across(n):
    """Unit vectors perpendicular to n."""
    axis = np.eye(3)[np.argmin(np.abs(n), axis=1)]
    return unit(np.cross(n, axis))


def surface_points(surface, count, rng):
    """Points uniform over the area, with outward normals."""
    pick = rng.choice(len(surface.areas), count, p=surface.areas / surface.areas.sum())
    a, b, c = (surface.oriented[pick, side] for side in range(3))
    u, v = rng.random((2, count, 1))
    u, v = np.where(u + v > 1.0, 1.0 - u, u), np.where(u + v > 1.0, 1.0 - v, v)
    return a + u * (b - a) + v * (c - a), unit(np.cross(b - a, c - a))


def quaternions(x, y, z):
    """Quaternions (x y z w) of the frames with these axes."""
    return Rotation.from_matrix(np.stack([x, y, z], 2)).as_quat()


def candidates(surface, kind, count, rng, palm_hs):
    low, high, tilt_deg = KINDS[kind]
    point, normal = surface_points(surface, count, rng)
    palm = point + rng.uniform(low, high, (count, 1)) * normal
    # The back of the hand faces away from the surface: a direction in the cap around the normal.
    cosine = rng.uniform(math.cos(math.radians(tilt_deg)), 1.0, (count, 1))
    turn = rng.uniform(0.0, 2.0 * math.pi, (2, count, 1))
    side = across(normal)
    back = cosine * normal + np.sqrt(1.0 - cosine ** 2) * (np.cos(turn[0]) * side + np.sin(turn[0]) * np.cross(normal, side))
    side = across(back)
    x = np.cos(turn[1]) * side + np.sin(turn[1]) * np.cross(back, side)
    z = np.cross(x, back)
    wrist = palm - (palm_hs[0] * x + palm_hs[1] * back + palm_hs[2] * z)
    return wrist, quaternions(x, back, z), palm


def place(surface, kind, count, seed, palm_hs=PALM_CENTER_HS_M):
    """Positions (count, 3) and quaternions (count, 4). A near palm is never inside: placements at surfaces buried in a solid are drawn
    again."""
    rng = np.random.default_rng([seed, sorted(KINDS).index(kind)])
    positions, rotations = np.zeros((0, 3)), np.zeros((0, 4))
    for _ in range(MOST_TRIES):
        wrist, rotation, palm = candidates(surface, kind, count, rng, palm_hs)
        keep = np.ones(count, bool) if kind != "near" else ~surface.is_inside(palm)
        positions, rotations = np.concatenate([positions, wrist[keep]]), np.concatenate([rotations, rotation[keep]])
        if len(positions) >= count:
            break
    return positions[:count], rotations[:count]
