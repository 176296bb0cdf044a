#include "game/scene/scene_shape.hpp"

#include <optional>
#include <string>
#include <utility>

#include "game/mesh/primitives.hpp"
#include "game/scene/scene_ranges.hpp"

namespace handhold {
namespace {

// The limits of ShapeLibrary.
constexpr NumberRange k_size_m = {1e-3, 1e4, false};
constexpr NumberRange k_corner_m = {-1e4, 1e4, false};
constexpr NumberRange k_scale = {1e-3, 1e3, false};
constexpr NumberRange k_part_place_m = {-1e4, 1e4, false};

enum class ShapePlace { body, part };

SceneShape read(const JsonValue& value, const std::filesystem::path& folder, ShapePlace place);

std::filesystem::path read_path(const JsonValue& value, const std::filesystem::path& folder) {
    return (folder / value.text()).lexically_normal();
}

void read_round(const JsonValue& value, SceneShape& shape) {
    value.allow_only({"type", "radius_m", "half_height_m"});
    shape.radius_m = value["radius_m"].number(k_size_m);
    shape.half_height_m = value["half_height_m"].number(k_size_m);
}

void read_hull(const JsonValue& value, const std::filesystem::path& folder, SceneShape& shape) {
    value.allow_only({"type", "points_m", "file", "scale"});
    const JsonValue points = value["points_m"];
    if (!points.exists()) {
        shape.file = read_path(value["file"], folder);
        shape.scale = read_scale(value["scale"]);
        return;
    }
    for (const char* key : {"file", "scale"}) {
        if (const JsonValue other = value[key]; other.exists()) {
            other.refuse("nothing beside \"points_m\"");
        }
    }
    std::vector<Vec3> corners;
    for (const JsonValue& point : points.items()) {
        corners.push_back(point.vector(k_corner_m));
    }
    std::optional<ConvexHull> hull = make_convex_hull(corners);
    if (hull && is_solid(*hull)) {
        shape.hull = std::move(*hull);
    } else {
        points.refuse("4 or more points that no two planes a millimetre apart hold between them");
    }
}

void read_parts(const JsonValue& value, const std::filesystem::path& folder, SceneShape& shape) {
    value.allow_only({"type", "children"});
    const std::vector<JsonValue> children = value["children"].items();
    if (children.empty() || children.size() > k_max_parts) {
        value["children"].refuse("1 to 64 children");
        return;
    }
    const bool weighed = children[0]["mass_kg"].exists();
    for (const JsonValue& child : children) {
        child.allow_only({"shape", "position_m", "rotation_xyzw", "mass_kg"});
        SceneShapePart part;
        part.shape = read(child["shape"], folder, ShapePlace::part);
        part.pose = {child["position_m"].vector_or(Vec3::Zero(), k_part_place_m),
                     child["rotation_xyzw"].rotation_or(Quat::Identity())};
        if (weighed) {
            part.mass_kg = child["mass_kg"].number(k_mass_kg);
        } else if (child["mass_kg"].exists()) {
            child["mass_kg"].refuse("nothing, or a mass of every child");
        }
        shape.parts.push_back(std::move(part));
    }
}

std::optional<ShapeKind> kind_named(const std::string& type, ShapePlace place) {
    constexpr std::array<std::pair<const char*, ShapeKind>, 7> k_kinds = {{
        {"box", ShapeKind::box},
        {"sphere", ShapeKind::sphere},
        {"capsule", ShapeKind::capsule},
        {"cylinder", ShapeKind::cylinder},
        {"hull", ShapeKind::hull},
        {"compound", ShapeKind::compound},
        {"mesh", ShapeKind::mesh},
    }};
    constexpr std::size_t k_convex = 5;  // number of convex kinds, which come first
    for (std::size_t i = 0; i < (place == ShapePlace::part ? k_convex : k_kinds.size()); ++i) {
        if (type == k_kinds[i].first) {
            return k_kinds[i].second;
        }
    }
    return std::nullopt;
}

SceneShape read(const JsonValue& value, const std::filesystem::path& folder, ShapePlace place) {
    SceneShape shape;
    const std::optional<ShapeKind> kind = kind_named(value["type"].text(), place);
    if (!kind) {
        value["type"].refuse(
            place == ShapePlace::part
                ? "\"box\", \"sphere\", \"capsule\", \"cylinder\" or \"hull\" in a compound"
                : "\"box\", \"sphere\", \"capsule\", \"cylinder\", \"hull\", \"compound\" or "
                  "\"mesh\"");
        return shape;
    }
    shape.kind = *kind;
    switch (shape.kind) {
        case ShapeKind::box:
            value.allow_only({"type", "half_m"});
            shape.half_m = value["half_m"].vector(k_size_m);
            break;
        case ShapeKind::sphere:
            value.allow_only({"type", "radius_m"});
            shape.radius_m = value["radius_m"].number(k_size_m);
            break;
        case ShapeKind::capsule:
        case ShapeKind::cylinder:
            read_round(value, shape);
            break;
        case ShapeKind::hull:
            read_hull(value, folder, shape);
            break;
        case ShapeKind::compound:
            read_parts(value, folder, shape);
            break;
        case ShapeKind::mesh:
            value.allow_only({"type", "file", "scale"});
            shape.file = read_path(value["file"], folder);
            shape.scale = read_scale(value["scale"]);
            break;
    }
    return shape;
}

Mesh mesh_of_hull(const ConvexHull& hull) {
    Mesh mesh;
    mesh.positions = hull.corners;
    for (const HullFace& face : hull.faces) {
        for (std::size_t i = 1; i + 1 < face.loop.size(); ++i) {
            mesh.triangles.push_back({face.loop[0], face.loop[i], face.loop[i + 1]});
        }
    }
    return mesh;
}

}  // namespace

SceneShape read_scene_shape(const JsonValue& value, const std::filesystem::path& folder) {
    return read(value, folder, ShapePlace::body);
}

Vec3 read_scale(const JsonValue& value) {
    if (!value.exists()) {
        return Vec3::Ones();
    }
    return value.is_array() ? value.vector(k_scale) : Vec3::Constant(value.number(k_scale));
}

std::shared_ptr<const Mesh> make_shape_mesh(const Shape& shape) {
    const Vec3 end = shape.half_height_m * Vec3::UnitY();
    Mesh mesh;
    switch (shape.kind) {
        case ShapeKind::box:
            mesh = make_box(shape.half_m);
            break;
        case ShapeKind::sphere:
            mesh = make_sphere(shape.radius_m);
            break;
        case ShapeKind::capsule:
            mesh = make_capsule(-end, end, shape.radius_m);
            break;
        case ShapeKind::cylinder:
            mesh = make_cylinder(-end, end, shape.radius_m);
            break;
        case ShapeKind::hull:
            mesh = mesh_of_hull(*shape.hull);
            break;
        case ShapeKind::compound:
            for (const PlacedShape& part : *shape.parts) {
                append(mesh, *make_shape_mesh(part.shape), part.pose);
            }
            break;
        case ShapeKind::mesh:
            if (shape.scale == Vec3::Ones()) {
                return shape.mesh;
            }
            mesh = *shape.mesh;
            stretch(mesh, shape.scale);
            break;
    }
    return std::make_shared<const Mesh>(std::move(mesh));
}

}  // namespace handhold
