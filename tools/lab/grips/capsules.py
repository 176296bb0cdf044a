"""Clearance of capsules to a surface.

The clearance of a capsule is the minimum signed distance along its axis minus its radius: the gap to the surface if positive, the
negated penetration depth of its deepest point if negative. Signed distance changes by at most the length travelled along the axis. An
interval of the axis with end values s0 and s1 is therefore at least (s0 + s1 - length) / 2 everywhere. Intervals are halved while this
bound can still change the result."""
import numpy as np

SPACING_M = 4e-3  # spacing of the first samples
TOLERANCE_M = 2e-5


def axis_samples(a, b, spacing_m):
    """First samples: capsule number and fraction of the axis, including both ends."""
    length = np.linalg.norm(b - a, axis=1)
    pieces = np.maximum(1, np.ceil(length / spacing_m)).astype(int)
    owner = np.repeat(np.arange(len(a)), pieces + 1)
    place = np.arange(len(owner)) - np.repeat(np.cumsum(pieces + 1) - pieces - 1, pieces + 1)
    return owner, place / pieces[owner]


def signed_on_axes(surface, points, owner, spacing):
    """Signed distances of samples in order along their axes. If two neighbours are closer to each other than one is to a closed surface,
    they are on the same side, so only one of them is queried for its sign."""
    distance = surface.distance(points)
    asked = np.ones(len(points), bool)
    if surface.is_closed:
        asked[1:] = (owner[1:] != owner[:-1]) | (np.maximum(distance[1:], distance[:-1]) <= spacing[owner[1:]])
    inside = surface.is_inside(points[asked])
    return np.where(inside[np.cumsum(asked) - 1], -distance, distance)


def signed_between(surface, points, length, v0, v1):
    """Signed distances at the middles of intervals with end values v0 and v1. If both ends together are farther from the surface than
    from each other, no surface is between them. Both then have one sign, except at the hole of an open surface."""
    distance = surface.distance(points)
    sign = np.where(np.abs(v0) >= np.abs(v1), np.sign(v0), np.sign(v1))
    asked = (np.abs(v0) + np.abs(v1) <= length) | (np.sign(v0) != np.sign(v1))
    sign[asked] = np.where(surface.is_inside(points[asked]), -1.0, 1.0)
    return sign * distance


def least_signed_distance(surface, a, b, radius, spacing_m, tolerance_m, relative):
    """Minimum on each axis, too high by at most tolerance_m and a relative share of the gap. a, b: (n, 3), finite."""
    owner, t = axis_samples(a, b, spacing_m)
    length = np.linalg.norm(b - a, axis=1)
    spacing = length / np.maximum(1, np.ceil(length / spacing_m))
    value = signed_on_axes(surface, a[owner] + t[:, None] * (b - a)[owner], owner, spacing)
    best = np.full(len(a), np.inf)
    np.minimum.at(best, owner, value)
    same = owner[1:] == owner[:-1]
    who, t0, t1, v0, v1 = owner[1:][same], t[:-1][same], t[1:][same], value[:-1][same], value[1:][same]
    while len(who):
        least = 0.5 * (v0 + v1 - (t1 - t0) * length[who])
        open_ = least < best[who] - tolerance_m - relative * np.maximum(0.0, best[who] - radius[who])
        who, t0, t1, v0, v1 = who[open_], t0[open_], t1[open_], v0[open_], v1[open_]
        middle = 0.5 * (t0 + t1)
        value = signed_between(surface, a[who] + middle[:, None] * (b - a)[who], (t1 - t0) * length[who], v0, v1)
        np.minimum.at(best, who, value)
        longer = (t1 - t0) * length[who] > tolerance_m  # a jump of the sign at a hole must not keep an interval open for ever
        who = np.concatenate([who, who])
        t0, t1 = np.concatenate([t0, middle]), np.concatenate([middle, t1])
        v0, v1 = np.concatenate([v0, value]), np.concatenate([value, v1])
        longer = np.concatenate([longer, longer])
        who, t0, t1, v0, v1 = who[longer], t0[longer], t1[longer], v0[longer], v1[longer]
    return best


def clearance(surface, a, b, radius, spacing_m=SPACING_M, tolerance_m=TOLERANCE_M, relative=0.0):
    """Metres; NaN for capsules that are not finite. relative: allowed relative excess of a gap; depths are exact to the tolerance."""
    a, b, radius = np.asarray(a, float).reshape(-1, 3), np.asarray(b, float).reshape(-1, 3), np.asarray(radius, float).ravel()
    result = np.full(len(a), np.nan)
    good = np.isfinite(a).all(1) & np.isfinite(b).all(1) & np.isfinite(radius)
    if good.any():
        result[good] = least_signed_distance(surface, a[good], b[good], radius[good], spacing_m, tolerance_m, relative) - radius[good]
    return result
