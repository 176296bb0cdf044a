#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "engine/collision/shape_library.hpp"
#include "engine/io/json.hpp"
#include "engine/math/math.hpp"

// Shapes as a scene's JSON gives them (docs/reference/scene_format.md), and how they are drawn.
namespace handhold {

struct SceneShapePart;

// Only the fields of its kind are meant.
struct SceneShape {
    ShapeKind kind = ShapeKind::box;
    Vec3 half_m = Vec3::Constant(0.5);  // box
    double radius_m = 0.5;              // sphere, capsule, cylinder
    double half_height_m = 0.5;         // capsule, cylinder: along local y, without caps
    ConvexHull hull;                    // hull without a file
    std::filesystem::path file;         // mesh, hull with one: .glb or .gltf, in the shape's frame
    Vec3 scale = Vec3::Ones();          // of what is in the file
    std::vector<SceneShapePart> parts;  // compound
};

struct SceneShapePart {
    SceneShape shape;      // neither mesh nor compound
    Pose pose;             // in the compound's frame
    double mass_kg = 0.0;  // 0, for all: by volume
};

// Numbers are such that a ShapeLibrary takes them. Refused, with JSON pointer and value: all else;
// points of a hull that have no volume or lie within a millimetre; a compound of meshes or
// compounds; masses of some of its parts only. Files are named, not opened; their paths are made
// relative to `folder`.
SceneShape read_scene_shape(const JsonValue& value, const std::filesystem::path& folder);
// "scale": one factor or three; absent: 1.
Vec3 read_scale(const JsonValue& value);

// A picture of the shape in its own frame. Of a mesh at its own scale the mesh itself.
std::shared_ptr<const Mesh> make_shape_mesh(const Shape& shape);

}  // namespace handhold
