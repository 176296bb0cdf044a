"""A mesh as a surface with an inside, if it has one: signed distance, negative in solids.

Only the sign needs repairs; distances are always to the triangles as in the file. Inside means a generalised winding number above 0.5
(Jacobson, Kavan, Sorkine-Hornung, "Robust inside-outside segmentation using generalized winding numbers", 2013) of
- solids: connected parts that nearly close and face outward. Each counts separately, so that an object in a room has an inside in spite
  of the room;
- everything else together: soups of patches, open parts, rooms. A room that faces inward has no solid, nor has a single sheet.
Before that, for the sign only: vertices are welded, duplicate triangles are removed, windings are made consistent across edges of two
triangles (the larger area wins), and inward-facing parts smaller than a room are flipped."""
import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from .tree import TriangleTree, dot

WELD_M = 1e-4  # tolerance between edges of a soup
ROOM_M = 0.5  # smallest width of a room that a body fits into; crew quarters on a station are 0.8 m
CLOSES = 0.25  # a part nearly closes if its area vector is below this share of its area


def weld(triangles):
    """Vertex numbers, (n, 3): corners nearer than WELD_M share one, transitively."""
    points, number = np.unique(triangles.reshape(-1, 3), axis=0, return_inverse=True)
    pairs = cKDTree(points).query_pairs(WELD_M, output_type="ndarray")
    graph = coo_matrix((np.ones(len(pairs), bool), (pairs[:, 0], pairs[:, 1])), (len(points), len(points)))
    return connected_components(graph, directed=False)[1][number.ravel()].reshape(-1, 3)


def first_copies(faces):
    """One of each set of triangles with the same three vertices, without triangles that welding made degenerate."""
    ordered = np.sort(faces, axis=1)
    proper = (ordered[:, 0] != ordered[:, 1]) & (ordered[:, 1] != ordered[:, 2])
    keep = ~proper
    places = np.nonzero(proper)[0]
    keep[places[np.unique(ordered[places], axis=0, return_index=True)[1]]] = True
    return keep


class Edges:
    """Pairs of triangles that share an edge, and whether both traverse it in the same direction (then one of them is flipped)."""

    def __init__(self, faces):
        start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
        face = np.repeat(np.arange(len(faces)), 3)
        real = start != end
        start, end, face = start[real], end[real], face[real]
        low, high = np.minimum(start, end), np.maximum(start, end)
        rank = np.lexsort((high, low))
        self.face, self.forward = face[rank], (start == low)[rank]
        _, first, self.count = np.unique(np.stack([low, high], 1)[rank], axis=0, return_index=True, return_counts=True)
        self.first = first

    def neighbours(self):
        """Pairs every triangle of an edge with the edge's first."""
        owner = np.repeat(self.first, self.count)
        return self.face[owner], self.face

    def manifold(self):
        first = self.first[self.count == 2]
        return self.face[first], self.face[first + 1], self.forward[first] == self.forward[first + 1]


def labels(count, a, b):
    return connected_components(coo_matrix((np.ones(len(a), bool), (a, b)), (count, count)), directed=False)[1]


def turned_faces(edges, areas):
    """Which triangles to flip so that windings agree: components of the graph's double cover are the two sides of a patch."""
    count = len(areas)
    a, b, same = edges.manifold()
    sides = labels(2 * count, np.concatenate([a, a + count]), np.concatenate([b + count * same, b + count * ~same]))
    front, back = sides[:count], sides[count:]
    turned = front > back  # equal: a one-sided patch, left unchanged
    patch = np.minimum(front, back)
    turned_area = np.bincount(patch, areas * turned, 2 * count)
    most = turned_area[patch] > 0.5 * np.bincount(patch, areas, 2 * count)[patch]
    return (turned ^ most) & (front != back)


class Surface:
    def __init__(self, triangles):
        self.triangles = triangles
        self.tree = TriangleTree(triangles)
        faces = weld(triangles)
        kept = np.nonzero(first_copies(faces))[0]
        edges = Edges(faces[kept])
        oriented = triangles[kept]
        doubled = np.cross(oriented[:, 1] - oriented[:, 0], oriented[:, 2] - oriented[:, 0])
        areas = 0.5 * np.sqrt(dot(doubled, doubled))
        turned = turned_faces(edges, areas)
        part = labels(len(kept), *edges.neighbours())
        vectors = 0.5 * np.where(turned[:, None], -doubled, doubled)
        solid, flips = self._solids(oriented, vectors, areas, part)
        turned ^= flips
        self.is_closed = bool((edges.count % 2 == 0).all())
        self.oriented = np.where(turned[:, None, None], oriented[:, ::-1], oriented)
        self.areas = areas
        self.solids = TriangleTree(self.oriented[solid]) if solid.any() else None
        self.rest = TriangleTree(self.oriented[~solid]) if not solid.all() else None

    @staticmethod
    def _volume(corners, vectors, group, groups):
        """Volume of each group: the sum of the cones from its centre to each triangle."""
        middle = corners.mean(1)
        count = np.maximum(np.bincount(group, minlength=groups), 1)
        center = np.stack([np.bincount(group, middle[:, axis], groups) / count for axis in range(3)], 1)
        return np.bincount(group, dot(middle - center[group], vectors), groups) / 3.0

    def _solids(self, corners, vectors, areas, part):
        """Which triangles belong to solid parts, and which must be flipped so that their part faces outward."""
        parts = part.max() + 1
        total = np.stack([np.bincount(part, vectors[:, axis], parts) for axis in range(3)], 1)
        closes = np.sqrt(dot(total, total)) < CLOSES * np.bincount(part, areas, parts)
        low, high = np.full((parts, 3), np.inf), np.full((parts, 3), -np.inf)
        np.minimum.at(low, part, corners.min(1))
        np.maximum.at(high, part, corners.max(1))
        volume = self._volume(corners, vectors, part, parts)
        flip_part = closes & (volume < 0) & ((high - low).min(1) < ROOM_M)
        solid = (closes & ((volume > 0) | flip_part))[part]
        flips = flip_part[part]
        rest = np.nonzero(~solid)[0]
        if len(rest) and np.ptp(corners[rest].reshape(-1, 3), axis=0).min() < ROOM_M:
            if self._volume(corners[rest], vectors[rest], np.zeros(len(rest), int), 1)[0] < 0:
                flips[rest] = True
        return solid, flips

    def is_inside(self, points):
        inside = np.zeros(len(points), bool)
        for tree in (self.solids, self.rest):
            if tree is not None:
                inside |= tree.winding(points) > 0.5
        return inside

    def distance(self, points):
        return self.tree.closest(points)[0]

    def signed_distance(self, points):
        return np.where(self.is_inside(points), -1.0, 1.0) * self.distance(points)

    def as_sheet(self):
        """The same surface without an inside."""
        return Sheet(self.tree)


class Sheet:
    is_closed = True  # no query needed: no side is inside

    def __init__(self, tree):
        self.tree = tree

    def distance(self, points):
        return self.tree.closest(points)[0]

    @staticmethod
    def is_inside(points):
        return np.zeros(len(points), bool)
