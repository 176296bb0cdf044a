#include "game/levels/station_scene.hpp"

#include <map>
#include <system_error>
#include <tuple>
#include <utility>

#include "engine/core/check.hpp"
#include "engine/core/text_file.hpp"
#include "engine/io/file_name.hpp"
#include "engine/io/gltf_writer.hpp"
#include "engine/io/triangle_list.hpp"
#include "game/levels/station_tools.hpp"
#include "game/mesh/shading_mesh.hpp"
#include "game/scene/player_defaults.hpp"
#include "game/scene/scene_file_writer.hpp"

namespace handhold {
namespace {

SceneBody make_tool_body(const StationTool& tool, const ToolModel& model,
                         const std::filesystem::path& visual) {
    SceneBody body;
    body.name = tool.name;
    body.kind = BodyKind::free;
    body.shape = model.shape;
    body.pose = tool.pose;
    body.mass_kg = model.mass_kg;
    body.velocity_mps = tool.velocity_mps;
    body.angular_velocity_radps = tool.angular_velocity_radps;
    body.restitution = 0.3;
    body.visual = visual;
    return body;
}

std::vector<std::uint32_t> indices_of(const Mesh& mesh) {
    std::vector<std::uint32_t> indices;
    indices.reserve(3 * mesh.triangles.size());
    for (const auto& triangle : mesh.triangles) {
        indices.insert(indices.end(), triangle.begin(), triangle.end());
    }
    return indices;
}

// Adds the mesh's triangles, with vertices split at sharp edges.
void add_vertices(const Mesh& mesh, GltfSurface& surface) {
    const ShadingMesh shading = make_shading_mesh(mesh);
    const std::vector<std::uint32_t> corners = indices_of(mesh);
    HH_CHECK(shading.indices.size() == corners.size(), "a triangle has no area",
             shading.indices.size());
    surface.indices = shading.indices;
    surface.vertices.resize(shading.vertices.size() / 6);
    for (std::size_t corner = 0; corner < corners.size(); ++corner) {
        const std::size_t id = shading.indices[corner];
        GltfVertex& vertex = surface.vertices[id];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double coordinate = mesh.positions[corners[corner]][static_cast<int>(axis)];
            vertex.position[axis] = static_cast<float>(coordinate);
            vertex.normal[axis] = shading.vertices[6 * id + 3 + axis];
        }
    }
}

std::string section_of(const std::string& part) { return part.substr(0, part.find('/')); }

}  // namespace

StationScene make_station_scene(const StationDescription& description) {
    StationScene made;
    SceneFile& scene = made.scene;
    scene.name = description.name;
    scene.description = description.description;
    Structure station = make_station(description);
    scene.lamps = station.lamps;
    for (const SpawnPoint& spawn : station.spawns) {
        Pose origin = spawn.pose;  // pose of the head; a scene's spawns are floor points
        origin.position -= origin.rotation * Vec3(0.0, k_eye_height_m, 0.0);
        scene.spawns.push_back({spawn.name, origin});
    }
    const std::filesystem::path level = description.name + ".glb";
    scene.levels.push_back({level, {}});
    made.models.push_back({level, std::move(station)});
    std::map<ToolType, std::filesystem::path> drawn;
    for (const StationTool& tool : description.tools) {
        ToolModel model = make_tool(tool.type);
        const auto [at, is_new] = drawn.try_emplace(
            tool.type, std::string("tools/") + tool_type_name(tool.type) + ".glb");
        scene.bodies.push_back(make_tool_body(tool, model, at->second));
        if (is_new) {
            made.models.push_back({at->second, std::move(model.visual)});
        }
    }
    if (!description.session.empty()) {
        scene.session = SceneSession{{}, description.session};
    }
    return made;
}

GltfLevel level_of(const Structure& structure) {
    GltfLevel level;
    for (std::size_t i = 0; i < structure.parts.size(); ++i) {
        const Mesh& from = structure.parts[i];
        LevelPart part;
        part.mesh.name = from.name;
        part.mesh.color = from.color;
        part.mesh.positions = from.positions;
        level.dropped_triangles +=
            append_triangles(TriangleMode::list, Winding::kept, indices_of(from), 0, part.mesh);
        const Look& look = structure.looks[i];
        part.color_runs.push_back({0, from.color, look.emissive, look.opacity, look.gloss});
        level.parts.push_back(std::move(part));
    }
    return level;
}

std::string write_model_glb(const Structure& structure) {
    std::vector<GltfMaterial> materials;
    std::vector<GltfSurface> surfaces;
    std::map<std::tuple<Color, float, float, float>, std::size_t> known;
    for (std::size_t i = 0; i < structure.parts.size(); ++i) {
        const Mesh& part = structure.parts[i];
        const Look& look = structure.looks[i];
        const auto [at, is_new] = known.try_emplace(
            {part.color, look.emissive, look.opacity, look.gloss}, materials.size());
        if (is_new) {
            materials.push_back({part.name, part.color, look.emissive, look.opacity, look.gloss});
        }
        GltfSurface surface;
        surface.group = section_of(part.name);
        surface.name = part.name;
        surface.material = at->second;
        add_vertices(part, surface);
        surfaces.push_back(std::move(surface));
    }
    return write_glb(materials, surfaces);
}

std::optional<FileError> write_station(const StationScene& station,
                                       const std::filesystem::path& folder) {
    HH_CHECK(is_file_name(station.scene.name), "the name is no file's", station.scene.name.size());
    for (const StationModel& model : station.models) {
        const std::filesystem::path file = folder / model.file;
        std::error_code failure;
        std::filesystem::create_directories(file.parent_path(), failure);
        if (failure) {
            return FileError{file.parent_path().string(), "",
                             "expected a folder that can be made: " + failure.message()};
        }
        if (auto error = write_file_atomically(file, write_model_glb(model.structure))) {
            return error;
        }
    }
    // The scene file comes last: if it exists, so do all files that it names.
    return write_file_atomically(folder / (station.scene.name + ".json"),
                                 write_scene_file(station.scene));
}

}  // namespace handhold
