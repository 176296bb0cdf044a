#include "game/scene/scene.hpp"

#include <stdexcept>
#include <string>

#include "game/scene/scene_builder.hpp"
#include "systems/host/tuning_json.hpp"

namespace handhold {
namespace {

std::filesystem::path& grip_mesh_cache() {
    static std::filesystem::path directory;
    return directory;
}

hh_world_def def_of_scene() {
    hh_world_def def = hh::world_def();
    def.reports_touches = false;
    return def;
}

}  // namespace

Scene::Scene() : host(def_of_scene()) {}

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
    scene.tuning() = tuning.value();
    scene.session = file.session;
    scene.up_ws = file.world_transform.rotation * Vec3::UnitY();
    scene.world().reference_velocity_mps =
        file.world_transform.rotation * file.reference_velocity_mps;
    if (std::optional<FileError> error = add_scene_parts(file, path, levels, scene)) {
        return *error;
    }
    add_grip_meshes(scene);
    return scene;
}

void add_grip_meshes(Scene& scene) {
    std::vector<ShapeId> of_bodies;
    for (const Collider& collider : scene.world().collider.elements()) {
        of_bodies.push_back(collider.shape);
    }
    scene.grip_meshes().add(scene.shapes(), of_bodies, {}, grip_mesh_cache());
    scene.caches().collision.update_shapes();  // here rather than in the first frame
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
    hh_player_def def = hh::player_def();
    def.name = start.name.c_str();
    def.mass_kg = start.mass_kg;
    def.origin = to_host(start.origin_ws);
    def.velocity_mps = scene.host.reference_velocity_mps();
    const auto player = scene.host.add(def);
    if (!player) {
        throw std::invalid_argument(std::string(player.status().text()));
    }
    return player_entities(std::as_const(scene).world(), *player);
}

hh::Player add_scene_player(Scene& scene, const std::string& name, const hh::Pose& origin,
                            double mass_kg) {
    const std::string free_name = free_player_name(std::as_const(scene).world(), name);
    return player_id(add_scene_player(scene, {free_name, from_host(origin), mass_kg}).player);
}

std::vector<hh::Player> player_ids(std::span<const PlayerEntities> players) {
    std::vector<hh::Player> ids;
    for (const PlayerEntities& player : players) {
        ids.push_back(player_id(player.player));
    }
    return ids;
}

}  // namespace handhold
