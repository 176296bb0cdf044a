#include "game/commands/exported_objects.hpp"

#include <algorithm>

#include "game/mesh/shading_mesh.hpp"
#include "systems/host/host_columns.hpp"

namespace handhold {
namespace {

void add_pressed(const std::vector<ControlMove>& moves, Control control, const char* key,
                 GltfObject& part) {
    if (std::ranges::find(moves, control, &ControlMove::control) == moves.end()) {
        return;
    }
    ControlValues values = k_controls_at_rest;
    values[static_cast<std::size_t>(control)] = 1.0;
    const Pose pressed = from_host(moved_by(moves, values));
    const Quat& turn = pressed.rotation;
    part.numbers[key] = {pressed.position.x(),
                         pressed.position.y(),
                         pressed.position.z(),
                         turn.x(),
                         turn.y(),
                         turn.z(),
                         turn.w()};
}

}  // namespace

GltfSurface exported_surface(const std::string& name, const Mesh& mesh, const Pose& pose,
                             std::size_t material) {
    Mesh moved = mesh;
    for (Vec3& position : moved.positions) {
        position = transform_point(pose, position);
    }
    const ShadingMesh shading = make_shading_mesh(moved);
    GltfSurface surface;
    surface.name = name;
    surface.material = material;
    for (std::size_t i = 0; i + 5 < shading.vertices.size(); i += 6) {
        const float* const v = shading.vertices.data() + i;
        const Vec3 at = Eigen::Vector3f(v[0], v[1], v[2]).cast<double>() + shading.center;
        const Eigen::Vector3f position = at.cast<float>();
        surface.vertices.push_back(
            {{position.x(), position.y(), position.z()}, {v[3], v[4], v[5]}});
    }
    surface.indices = shading.indices;
    return surface;
}

std::vector<GltfObject> controller_objects(const ControllerModel& model,
                                           std::vector<GltfMaterial>& materials) {
    const Pose model_in_hand = from_host(controller_in_hand(model.fit));
    std::vector<GltfObject> objects = {{"controller", inverse(from_host(model.fit.hand_in_grip))}};
    for (std::size_t i = 0; i < model.meshes.size(); ++i) {
        const LevelMesh& mesh = model.meshes[i];
        const std::string name = "controller-part-" + std::to_string(i);
        GltfSurface surface = exported_surface(name + "-mesh", mesh.mesh, {}, materials.size());
        if (surface.indices.empty()) {
            continue;
        }
        materials.push_back(
            {name, mesh.mesh.color, mesh.look.emissive, mesh.look.opacity, mesh.look.gloss});
        GltfObject part{name, model_in_hand, {std::move(surface)}};
        add_pressed(model.moves[i], Control::trigger, k_pressed_trigger_key, part);
        add_pressed(model.moves[i], Control::squeeze, k_pressed_squeeze_key, part);
        objects.push_back(std::move(part));
    }
    return objects;
}

}  // namespace handhold
