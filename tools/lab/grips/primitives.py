"""Closed surfaces triangulated with edges of about a given length: (points, faces), metres, centred at the origin."""
import math

import numpy as np


def grid(origin, u, v, nu, nv):
    """A parallelogram of nu x nv cells that faces along u x v."""
    i, j = np.meshgrid(np.arange(nu + 1), np.arange(nv + 1), indexing="ij")
    points = np.asarray(origin) + (i / nu).reshape(-1, 1) * np.asarray(u) + (j / nv).reshape(-1, 1) * np.asarray(v)
    a = (np.arange(nu)[:, None] * (nv + 1) + np.arange(nv)).ravel()
    b, c, d = a + nv + 1, a + nv + 2, a + 1
    return points, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])


def joined(parts):
    """One mesh in which vertices at the same position are merged."""
    points, faces, base = [], [], 0
    for part_points, part_faces in parts:
        points.append(part_points)
        faces.append(part_faces + base)
        base += len(part_points)
    points = np.concatenate(points)
    _, first, number = np.unique(np.round(points, 7), axis=0, return_index=True, return_inverse=True)
    faces = number.ravel()[np.concatenate(faces)]
    proper = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    return points[first], faces[proper]


def box(size_m, edge_m):
    half = 0.5 * np.asarray(size_m, float)
    sides = []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            u, v = np.eye(3)[(axis + 1) % 3], np.eye(3)[(axis + 2) % 3]
            if sign < 0:
                u, v = v, u
            origin = sign * half * np.eye(3)[axis] - half * u - half * v
            cells = [max(1, math.ceil(2.0 * half @ w / edge_m)) for w in (u, v)]
            sides.append(grid(origin, 2 * half * u, 2 * half * v, *cells))
    return joined(sides)


def cylinder(radius_m, length_m, edge_m):
    """Along y, with caps."""
    around = max(8, math.ceil(2 * math.pi * radius_m / edge_m))
    side, side_faces = grid((0, 0, 0), (1, 0, 0), (0, 1, 0), around, max(1, math.ceil(length_m / edge_m)))
    cap, cap_faces = grid((0, 0, 0), (1, 0, 0), (0, 1, 0), around, max(1, math.ceil(radius_m / edge_m)))

    def bent(angle, radius, height):
        return np.stack([radius * np.sin(angle), height, radius * np.cos(angle)], 1)

    turn = 2 * math.pi * (side[:, 0] % 1.0)
    parts = [(bent(turn, radius_m, (side[:, 1] - 0.5) * length_m), side_faces)]
    turn = 2 * math.pi * (cap[:, 0] % 1.0)
    level = np.full(len(cap), 0.5 * length_m)
    parts.append((bent(turn, radius_m * (1 - cap[:, 1]), level), cap_faces))
    parts.append((bent(turn, radius_m * cap[:, 1], -level), cap_faces))
    return joined(parts)


def sphere(radius_m, edge_m):
    """A box's grid projected onto a sphere, so there is no pole."""
    cells = max(2, math.ceil(0.5 * math.pi * radius_m / edge_m))
    points, faces = box((2.0, 2.0, 2.0), 2.0 / cells)
    points = np.tan(points * (math.pi / 4))
    return radius_m * points / np.linalg.norm(points, axis=1)[:, None], faces


def moved(mesh, offset, swap=None):
    points, faces = mesh
    return (points if swap is None else points[:, swap]) + np.asarray(offset), faces


def rail(diameter_m, edge_m, length_m=0.8, height_m=0.09):
    """A bar along x on two posts along z down to its feet: intersecting solids, as in levels."""
    bar = moved(cylinder(0.5 * diameter_m, length_m, edge_m), (0, 0, 0), [1, 2, 0])
    post = cylinder(0.3 * diameter_m, height_m, edge_m)
    posts = [moved(post, (side * 0.42 * length_m, 0, -0.5 * height_m), [2, 0, 1]) for side in (-1, 1)]
    points, faces, base = [], [], 0
    for part_points, part_faces in (bar, *posts):
        points.append(part_points)
        faces.append(part_faces + base)
        base += len(part_points)
    return np.concatenate(points), np.concatenate(faces)


MAKERS = {
    "wall": lambda edge: box((1.0, 1.0, 0.1), edge),
    "plate": lambda edge: box((0.4, 0.4, 0.012), edge),
    "box": lambda edge: box((0.3, 0.2, 0.15), edge),
    "rail": lambda edge: rail(0.035, edge),
    "sphere": lambda edge: sphere(0.06, edge),
    "cylinder": lambda edge: cylinder(0.03, 0.25, edge),
}


def make(name, edge_m):
    return MAKERS[name](edge_m)
