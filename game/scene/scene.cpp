#include "game/scene/scene.hpp"

#include <string>

#include "game/scene/scene_builder.hpp"
#include "systems/host/tuning_json.hpp"

namespace handhold {
namespace {

std::filesystem::path& grip_mesh_cache() {
    static std::filesystem::path directory;
    return directory;
}

}  // namespace

Entity add_static_mesh(Scene& scene, const std::string& name, std::shared_ptr<const Mesh> mesh,
                       const Pose& pose_ws, const Look& look) {
    const Entity entity = add_static_body(scene, name, mesh, pose_ws);
    scene.visuals.push_back({entity, std::move(mesh), std::nullopt, look});
    return entity;
}

Result<Scene> build_scene(const SceneFile& file, const std::filesystem::path& path,
                          const LevelSource& levels) {
    Result<Tuning> tuning = parse_tuning(file.tuning_json, path.string());
    if (!tuning) {
        return tuning.error();
    }
    Scene scene;
    scene.name = file.name;
    scene.description = file.description;
    scene.tuning = tuning.value();
    scene.session = file.session;
    scene.up_ws = file.world_transform.rotation * Vec3::UnitY();
    scene.world.reference_velocity_mps =
        file.world_transform.rotation * file.reference_velocity_mps;
    scene.head_shape = scene.shapes->add_sphere(scene.tuning.head.radius_m);
    if (std::optional<FileError> error = add_scene_parts(file, path, levels, scene)) {
        return *error;
    }
    add_grip_meshes(scene);
    return scene;
}

void add_grip_meshes(Scene& scene) {
    std::vector<ShapeId> of_bodies;
    for (const Collider& collider : scene.world.collider.rows()) {
        of_bodies.push_back(collider.shape);
    }
    scene.grip_meshes->add(*scene.shapes, of_bodies, {}, grip_mesh_cache());
}

void set_grip_mesh_cache(const std::filesystem::path& directory) { grip_mesh_cache() = directory; }

std::string free_player_name(const World& world, std::string wanted) {
    const auto is_taken = [&world](const std::string& name) {
        return !is_null(find_by_id(world, persistent_id_from_name(name)));
    };
    while (is_taken(wanted) || is_taken(wanted + "/left_hand") ||
           is_taken(wanted + "/right_hand")) {
        wanted += "'";
    }
    return wanted;
}

PlayerEntities add_scene_player(Scene& scene, const ScenePlayerStart& start) {
    PlayerDescription description;
    description.name = start.name;
    description.body.mass_kg = start.mass_kg;
    description.origin_ws = start.origin_ws;
    description.velocity_mps = scene.world.reference_velocity_mps;
    description.head_shape = scene.head_shape;
    return add_player(scene.world, description, *scene.shapes);
}

}  // namespace handhold
