#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "engine/collision/shape_library.hpp"
#include "engine/io/json.hpp"
#include "engine/math/math.hpp"

// Shapes in a scene's JSON (docs/reference/scene_format.md), and meshes to draw them.
namespace handhold {

struct SceneShapePart;

// Only the fields of its kind are used.
struct SceneShape {
    ShapeKind kind = ShapeKind::box;
    Vec3 half_m = Vec3::Constant(0.5);  // box
    double radius_m = 0.5;              // sphere, capsule, cylinder
    double half_height_m = 0.5;         // capsule, cylinder: along local y, without caps
    ConvexHull hull;                    // hull without a file
    std::filesystem::path file;  // mesh, or hull from a file: .glb or .gltf, in the shape's frame
    Vec3 scale = Vec3::Ones();   // of the file's content
    std::vector<SceneShapePart> parts;  // compound
};

struct SceneShapePart {
    SceneShape shape;      // neither mesh nor compound
    Pose pose;             // in the compound's frame
    double mass_kg = 0.0;  // 0 for all parts: by volume
};

// Reads numbers that a ShapeLibrary accepts. Refused, with JSON pointer and value: everything else;
// hull points without volume or within a millimetre of a plane; compounds of meshes or compounds;
// masses of only some parts. Files are named, not opened; their paths are made relative to
// `folder`.
SceneShape read_scene_shape(const JsonValue& value, const std::filesystem::path& folder);
// "scale": one factor or three; absent: 1.
Vec3 read_scale(const JsonValue& value);

// A mesh of the shape in its own frame, to draw it. A mesh at scale 1 is returned itself.
std::shared_ptr<const Mesh> make_shape_mesh(const Shape& shape);

}  // namespace handhold
