#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "components/tuning.hpp"
#include "components/world.hpp"
#include "engine/collision/shape_library.hpp"
#include "engine/geometry/grip_mesh_library.hpp"
#include "engine/geometry/mesh.hpp"
#include "engine/io/gltf.hpp"
#include "engine/io/result.hpp"
#include "game/render/render_frame.hpp"
#include "game/scene/scene_file.hpp"

// A scene ready to be played: the world without its players, the shapes and tuning it runs with,
// and what to draw.
namespace handhold {

// A mesh that is drawn at a body's pose. The body's collider may be something simpler.
struct SceneVisual {
    Entity body;
    std::shared_ptr<const Mesh> mesh;
    std::optional<Color> color;  // the mesh's own where empty
    Look look;
};

struct SceneSpawnPoint {
    std::string name;
    Pose pose_ws;  // of the play space: its floor point
};

// The axis of a straight bar that hands like, in a body's frame: for scripts that climb.
struct SceneRail {
    Entity body;
    Vec3 start_bs = Vec3::Zero();
    Vec3 end_bs = Vec3::Zero();
};

// A player before he is in the world.
struct ScenePlayerStart {
    std::string name;
    Pose origin_ws;
    double mass_kg = 80.0;
};

struct Scene {
    std::string name;
    std::string description;
    World world;
    std::unique_ptr<ShapeLibrary> shapes =
        std::make_unique<ShapeLibrary>();  // its address stays: caches refer to it
    // What hands are fitted to: of every body's shape; its address stays as well.
    std::unique_ptr<GripMeshLibrary> grip_meshes = std::make_unique<GripMeshLibrary>();
    Tuning tuning;
    ShapeId head_shape;  // a sphere of the tuning's head radius
    std::vector<SceneVisual> visuals;
    std::vector<Lamp> lamps;
    Entity lamps_body = k_no_entity;  // in whose frame the lamps are; the world's where null
    KeyLight key;                     // the sun, or what stands for it in a room
    Vec3 up_ws = Vec3::UnitY();
    std::vector<SceneRail> rails;           // may be empty
    std::vector<SceneSpawnPoint> spawns;    // the first is the default; may be empty
    std::vector<ScenePlayerStart> players;  // that the scene asks for; may be empty
    std::vector<std::string> body_names;    // by world.body's rows at load
    // Of a scene file's bodies by name: authored grips, in the frame that the file gives them in,
    // and that frame, seen backwards: of the body in it, where they differ.
    std::map<std::string, std::vector<SceneGrip>> grips;
    std::map<std::string, Pose> body_in_file;
    std::optional<SceneSession> session;  // what shows it
    std::vector<std::string> notes;       // about the loaded files; see GltfLevel::notes
    int climbers = 0;  // scripted ones beside the first player, where nobody says how many
};

// A built-in scene's name, a scene file (.json), or any level (.glb, .gltf: every mesh node a
// static body). Nothing half loaded.
Result<Scene> load_scene(const std::string& name_or_file);
// Gives the levels and meshes that a scene file names.
using LevelSource = std::function<Result<GltfLevel>(const std::filesystem::path&)>;
// From a checked scene file.
Result<Scene> build_scene(const SceneFile& file, const std::filesystem::path& path,
                          const LevelSource& levels = load_gltf_level);

// Gives hands the surfaces of all bodies that have none yet: whoever adds bodies to a scene calls
// it when he is done. A body without is gripped all the same, but hands are shown on it as tracked.
void add_grip_meshes(Scene& scene);

// `wanted`, with as many primes behind it as it takes until it and its hands' names are free: a
// scene's bodies may have any names.
std::string free_player_name(const World& world, std::string wanted);
// Adds a player who moves with the scene's reference velocity.
PlayerEntities add_scene_player(Scene& scene, const ScenePlayerStart& start);

// A static body that is drawn as it collides.
Entity add_static_mesh(Scene& scene, const std::string& name, std::shared_ptr<const Mesh> mesh,
                       const Pose& pose_ws = {}, const Look& look = {});

}  // namespace handhold
