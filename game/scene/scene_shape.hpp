#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "engine/geometry/shape_library.hpp"
#include "engine/io/json.hpp"
#include "engine/math/math.hpp"

// Shapes in a scene's JSON (docs/reference/scene_format.md), and meshes to draw them.
namespace handhold {

struct SceneShapePart;

// Only the fields of `kind` are used.
struct SceneShape {
    ShapeKind kind = ShapeKind::box;
    Vec3 half_m = Vec3::Constant(0.5);  // box: half extents
    double radius_m = 0.5;              // sphere, capsule, cylinder
    double half_height_m = 0.5;         // capsule, cylinder: along local y, without caps
    ConvexHull hull;                    // hull whose points are in the scene file
    std::filesystem::path file;  // mesh, or hull from a model: .glb or .gltf, in the shape's frame
    Vec3 scale = Vec3::Ones();   // scale of the model file
    std::vector<SceneShapePart> parts;  // compound
};

struct SceneShapePart {
    SceneShape shape;      // neither mesh nor compound
    Pose pose;             // pose in the compound's frame
    double mass_kg = 0.0;  // 0 for all parts: the mass is divided by volume
};

// Reads a shape that a ShapeLibrary accepts. Errors name the JSON pointer and the value: numbers
// out of range, hull points without volume or within a millimetre of a plane, compounds of meshes
// or compounds, masses of only some parts. Files are named, not opened; their paths are resolved
// against `folder`.
SceneShape read_scene_shape(const JsonValue& value, const std::filesystem::path& folder);
// "scale": one factor or three; absent: 1.
Vec3 read_scale(const JsonValue& value);

// A mesh to draw the shape, in the shape's frame. A mesh shape at scale 1 gives its own mesh.
std::shared_ptr<const Mesh> make_shape_mesh(const Shape& shape);

}  // namespace handhold
