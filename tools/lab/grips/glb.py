"""Reads and writes triangles of a binary glTF 2.0 file (Khronos Group, 2021). Applies node transforms. Refuses skins, sparse and
compressed accessors by name."""
import json
import struct

import numpy as np

from pages.files import FormatError, parse_json, read_bytes

MAGIC, JSON_CHUNK, BIN_CHUNK = 0x46546C67, 0x4E4F534A, 0x004E4942
COMPONENTS = {5120: np.int8, 5121: np.uint8, 5122: np.int16, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC3": 3}


def chunks(path):
    data = read_bytes(path)
    if len(data) < 20 or struct.unpack_from("<II", data) != (MAGIC, 2):
        raise FormatError(f"{path}: expected binary glTF 2.0")
    at, found = 12, {}
    while at + 8 <= len(data):
        size, kind = struct.unpack_from("<II", data, at)
        if at + 8 + size > len(data):
            raise FormatError(f"{path}: byte {at}: chunk is longer than the file")
        found.setdefault(kind, data[at + 8:at + 8 + size])
        at += 8 + size
    if JSON_CHUNK not in found:
        raise FormatError(f"{path}: expected a JSON chunk")
    try:
        text = found[JSON_CHUNK].decode("utf-8")
    except UnicodeDecodeError:
        raise FormatError(f"{path}: JSON chunk: expected UTF-8") from None
    return parse_json(text, f"{path}: JSON chunk"), found.get(BIN_CHUNK, b"")


class Document:
    def __init__(self, path):
        self.path = path
        self.json, self.binary = chunks(path)

    def get(self, kind, index):
        try:
            if index < 0:
                raise IndexError
            return self.json[kind][index]
        except (KeyError, IndexError, TypeError):
            raise FormatError(f"{self.path}: /{kind}/{index}: not there") from None

    def accessor(self, index, kind):
        where = f"{self.path}: /accessors/{index}"
        accessor = self.get("accessors", index)
        if accessor.get("type") != kind or accessor.get("componentType") not in COMPONENTS:
            raise FormatError(f"{where}: expected {kind} of a known component type")
        if "sparse" in accessor or "bufferView" not in accessor:
            raise FormatError(f"{where}: sparse and compressed accessors are not supported")
        view = self.get("bufferViews", accessor["bufferView"])
        if view.get("buffer", 0) != 0 or "uri" in self.get("buffers", 0):
            raise FormatError(f"{where}: expected the file's own binary chunk")
        dtype = np.dtype(COMPONENTS[accessor["componentType"]]).newbyteorder("<")
        width = WIDTHS[kind] * dtype.itemsize
        stride, count = view.get("byteStride", width), accessor.get("count", 0)
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        if start < 0 or count < 0 or (count and start + (count - 1) * stride + width > len(self.binary)):
            raise FormatError(f"{where}: reaches past the binary chunk")
        values = np.ndarray((count, WIDTHS[kind]), dtype, self.binary, start, (stride, dtype.itemsize)) if count else np.zeros((0, WIDTHS[kind]), dtype)
        if accessor.get("normalized") and dtype.kind in "iu":
            return np.maximum(values / float(np.iinfo(dtype).max), -1.0)
        return values.copy()


def node_matrix(node):
    if "matrix" in node:
        return np.array(node["matrix"], float).reshape(4, 4).T
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    turn = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    matrix = np.eye(4)
    matrix[:3, :3] = turn * np.array(node.get("scale", (1, 1, 1)), float)
    matrix[:3, 3] = node.get("translation", (0, 0, 0))
    return matrix


def corners(mode, indices, where):
    """Indices of triangles, three per row."""
    if mode == 4 and len(indices) % 3 == 0:
        return indices.reshape(-1, 3)
    if mode == 5:
        rows = np.stack([indices[:-2], indices[1:-1], indices[2:]], 1)
        rows[1::2, 1:] = rows[1::2, :0:-1]
        return rows
    if mode == 6:
        return np.stack([np.full(max(len(indices) - 2, 0), indices[0]), indices[1:-1], indices[2:]], 1)
    raise FormatError(f"{where}: expected triangles")


def mesh_triangles(document, index):
    parts = []
    for place, primitive in enumerate(document.get("meshes", index).get("primitives", ())):
        where = f"{document.path}: /meshes/{index}/primitives/{place}"
        if primitive.get("mode", 4) < 4:
            continue  # points and lines
        if "POSITION" not in primitive.get("attributes", {}):
            raise FormatError(f"{where}: expected POSITION")
        points = document.accessor(primitive["attributes"]["POSITION"], "VEC3").astype(float)
        indices = np.arange(len(points))
        if "indices" in primitive:
            indices = document.accessor(primitive["indices"], "SCALAR").astype(np.int64).ravel()
        if len(indices) and indices.max() >= len(points):
            raise FormatError(f"{where}: index {indices.max()} of {len(points)} vertices")
        parts.append(points[corners(primitive.get("mode", 4), indices, where)])
    return np.concatenate(parts) if parts else np.zeros((0, 3, 3))


def read_triangles(path):
    """(n, 3, 3) corners in the file's frame, counter-clockwise from the front. Omits triangles with a corner that is not finite."""
    document = Document(path)
    nodes = document.json.get("nodes", [])
    children = {child for node in nodes for child in node.get("children", ())}
    roots = [i for i in range(len(nodes)) if i not in children]
    if document.json.get("scenes"):
        roots = document.get("scenes", document.json.get("scene", 0)).get("nodes", roots)
    parts, todo, seen = [], [(root, np.eye(4)) for root in roots], set()
    while todo:
        index, parent = todo.pop()
        if index in seen:
            raise FormatError(f"{path}: /nodes/{index}: is its own ancestor, or has two parents")
        seen.add(index)
        node = document.get("nodes", index)
        matrix = parent @ node_matrix(node)
        todo += [(child, matrix) for child in node.get("children", ())]
        if "mesh" not in node:
            continue
        triangles = mesh_triangles(document, node["mesh"]) @ matrix[:3, :3].T + matrix[:3, 3]
        parts.append(triangles[:, ::-1] if np.linalg.det(matrix[:3, :3]) < 0 else triangles)
    triangles = np.concatenate(parts) if parts else np.zeros((0, 3, 3))
    triangles = triangles[np.isfinite(triangles).all(axis=(1, 2))]
    if not len(triangles):
        raise FormatError(f"{path}: expected at least one triangle")
    return triangles


def write_triangles(path, points, faces):
    """Writes one node with one indexed primitive."""
    points, faces = np.asarray(points, np.float32), np.asarray(faces, np.uint32)
    binary = points.tobytes() + faces.tobytes()
    document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
                "buffers": [{"byteLength": len(binary)}],
                "bufferViews": [{"buffer": 0, "byteLength": points.nbytes}, {"buffer": 0, "byteOffset": points.nbytes, "byteLength": faces.nbytes}],
                "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3",
                               "min": points.min(0).tolist(), "max": points.max(0).tolist()},
                              {"bufferView": 1, "componentType": 5125, "count": faces.size, "type": "SCALAR"}]}
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    size = 12 + 8 + len(text) + 8 + len(binary)
    with open(path, "wb") as out:
        out.write(struct.pack("<III", MAGIC, 2, size) + struct.pack("<II", len(text), JSON_CHUNK) + text)
        out.write(struct.pack("<II", len(binary), BIN_CHUNK) + binary)
