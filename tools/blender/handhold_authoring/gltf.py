"""The few parts of glTF that grips need: names, poses and extras of nodes. Geometry goes through Blender's own importer and exporter."""
import json
import struct
from pathlib import Path

import numpy as np
from mathutils import Matrix, Quaternion

# glTF's axes (+Y up, -Z forward) to Blender's (+Z up, +Y forward).
TO_BLENDER = Matrix(((1, 0, 0, 0), (0, 0, -1, 0), (0, 1, 0, 0), (0, 0, 0, 1)))
TO_GLTF = TO_BLENDER.transposed()


def to_blender(pose: Matrix) -> Matrix:
    return TO_BLENDER @ pose @ TO_GLTF


def to_gltf(pose: Matrix) -> Matrix:
    return TO_GLTF @ pose @ TO_BLENDER


def rigid(matrix: Matrix) -> Matrix:
    """The same place and rotation without scale."""
    place, turn, _ = matrix.decompose()
    return Matrix.Translation(place) @ turn.to_matrix().to_4x4()


def pose_of(numbers) -> Matrix:
    """From x, y, z and a quaternion x, y, z, w."""
    x, y, z, qx, qy, qz, qw = numbers
    return Matrix.Translation((x, y, z)) @ Quaternion((qw, qx, qy, qz)).to_matrix().to_4x4()


def numbers_of(pose: Matrix) -> list:
    place, turn, _ = pose.decompose()
    return [*place, turn.x, turn.y, turn.z, turn.w]


def read_nodes(path) -> dict:
    """The nodes of a .glb by name: {"pose": in the scene, in glTF's axes, "extras": dictionary}."""
    data = Path(path).read_bytes()
    size, = struct.unpack_from("<I", data, 12)
    nodes = json.loads(data[20:20 + size])["nodes"]
    parents = {child: index for index, node in enumerate(nodes) for child in node.get("children", ())}

    def pose(index: int) -> Matrix:
        node = nodes[index]
        own = pose_of([*node.get("translation", (0, 0, 0)), *node.get("rotation", (0, 0, 0, 1))])
        return pose(parents[index]) @ own if index in parents else own
    return {node["name"]: {"pose": pose(index), "extras": node.get("extras", {})} for index, node in enumerate(nodes)}


def write_nodes(path, nodes: dict) -> None:
    """Writes a .gltf of nodes without geometry. `nodes`: as of read_nodes."""
    written = []
    for name, node in nodes.items():
        x, y, z, *turn = numbers_of(node["pose"])
        written.append({"name": name, "translation": [x, y, z], "rotation": turn, **({"extras": node["extras"]} if node.get("extras") else {})})
    whole = {"asset": {"version": "2.0", "generator": "handhold_authoring"}, "scene": 0,
             "scenes": [{"nodes": list(range(len(written)))}], "nodes": written}
    Path(path).write_text(json.dumps(whole), encoding="utf-8")


def import_file(path) -> list:
    """Imports a .glb with Blender's importer. Returns the new objects."""
    import bpy
    if "bool" not in vars(np):
        np.bool = bool  # Blender 3.4's importer uses this name, which NumPy has removed
    before = set(bpy.data.objects)
    bpy.ops.import_scene.gltf(filepath=str(path))
    return [one for one in bpy.data.objects if one not in before]


def triangles_of(gripped, depsgraph) -> tuple:
    """Vertices of an object and its children as evaluated, in the object's frame without scale and in glTF's axes, and triangles: float32 (n, 3),
    uint32 (m, 3)."""
    frame = TO_GLTF @ rigid(gripped.matrix_world).inverted()
    points, triangles, count = [], [], 0
    for one in [gripped, *gripped.children_recursive]:
        if one.type != "MESH":
            continue
        evaluated = one.evaluated_get(depsgraph)
        mesh = evaluated.to_mesh()
        mesh.calc_loop_triangles()
        place = np.array(frame @ one.matrix_world)
        local = np.empty(3 * len(mesh.vertices), dtype=np.float32)
        mesh.vertices.foreach_get("co", local)
        corners = np.empty(3 * len(mesh.loop_triangles), dtype=np.int32)
        mesh.loop_triangles.foreach_get("vertices", corners)
        corners = corners.reshape(-1, 3)
        if np.linalg.det(place[:3, :3]) < 0.0:
            corners = corners[:, ::-1]
        points.append(local.reshape(-1, 3) @ place[:3, :3].T + place[:3, 3])
        triangles.append(corners + count)
        count += len(mesh.vertices)
        evaluated.to_mesh_clear()
    if not count or not sum(map(len, triangles)):
        raise ValueError(f"{gripped.name} has no triangles")
    return np.concatenate(points).astype(np.float32), np.concatenate(triangles).astype(np.uint32)



def write_triangles(path, points, triangles) -> None:
    """Writes a .glb of one mesh without materials."""
    corners, places = triangles.astype("<u4").tobytes(), points.astype("<f4").tobytes()
    size = len(corners) + len(places)
    whole = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"name": "object", "mesh": 0}],
             "meshes": [{"primitives": [{"attributes": {"POSITION": 1}, "indices": 0}]}], "buffers": [{"byteLength": size}],
             "bufferViews": [{"buffer": 0, "byteLength": len(corners)}, {"buffer": 0, "byteOffset": len(corners), "byteLength": len(places)}],
             "accessors": [{"bufferView": 0, "componentType": 5125, "count": triangles.size, "type": "SCALAR"},
                           {"bufferView": 1, "componentType": 5126, "count": len(points), "type": "VEC3",
                            "min": points.min(0).tolist(), "max": points.max(0).tolist()}]}
    text = json.dumps(whole).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", size, b"BIN\0") + corners + places
    Path(path).write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)
