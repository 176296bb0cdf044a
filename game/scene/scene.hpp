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

// A scene ready to play: the world without players, its shapes and tuning, and its visuals.
namespace handhold {

// A mesh drawn at a body's pose. The body's collider may be simpler.
struct SceneVisual {
    Entity body;
    std::shared_ptr<const Mesh> mesh;
    std::optional<Color> color;  // absent: the mesh's own
    Look look;
};

struct SceneSpawnPoint {
    std::string name;
    Pose pose_ws;  // of the play space: its floor point
};

// The axis of a graspable straight bar in a body's frame, for scripted climbers.
struct SceneRail {
    Entity body;
    Vec3 start_bs = Vec3::Zero();
    Vec3 end_bs = Vec3::Zero();
};

// A player who is not in the world yet.
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
        std::make_unique<ShapeLibrary>();  // the address is stable: caches refer to it
    // Surfaces that hands are fitted to, for every body's shape. The address is stable.
    std::unique_ptr<GripMeshLibrary> grip_meshes = std::make_unique<GripMeshLibrary>();
    Tuning tuning;
    ShapeId head_shape;  // a sphere with the tuning's head radius
    std::vector<SceneVisual> visuals;
    std::vector<Lamp> lamps;
    Entity lamps_body = k_no_entity;  // the body whose frame the lamps are in; null: the world
    KeyLight key;                     // the sun, or the main light of a room
    Vec3 up_ws = Vec3::UnitY();
    std::vector<SceneRail> rails;           // may be empty
    std::vector<SceneSpawnPoint> spawns;    // the first is the default; may be empty
    std::vector<ScenePlayerStart> players;  // the scene's own players; may be empty
    std::vector<std::string> body_names;    // by row of world.body at load
    // By name of a scene file's body: its authored grips in the file's frame, and that frame in the
    // body's frame (they differ for hulls and compounds).
    std::map<std::string, std::vector<SceneGrip>> grips;
    std::map<std::string, Pose> body_in_file;
    std::optional<SceneSession> session;  // the session that shows the scene
    std::vector<std::string> notes;       // about the loaded files; see GltfLevel::notes
    int climbers = 0;  // scripted climbers beside the first player, unless --players says otherwise
};

// Loads a built-in scene by name, a scene file (.json), or a level (.glb, .gltf: each mesh node
// becomes a static body). Loads all or nothing.
Result<Scene> load_scene(const std::string& name_or_file);
// Loads the levels and meshes that a scene file names.
using LevelSource = std::function<Result<GltfLevel>(const std::filesystem::path&)>;
// Builds a checked scene file.
Result<Scene> build_scene(const SceneFile& file, const std::filesystem::path& path,
                          const LevelSource& levels = load_gltf_level);

// Builds the missing surfaces that hands are fitted to. Call it after adding bodies to a scene. A
// body without such a surface can be gripped, but hands are shown on it as tracked.
void add_grip_meshes(Scene& scene);

// `wanted` with as many primes appended as it takes for it and its hands' names to be free.
std::string free_player_name(const World& world, std::string wanted);
// Adds a player who moves with the scene's reference velocity.
PlayerEntities add_scene_player(Scene& scene, const ScenePlayerStart& start);

// A static body whose visual is its collision mesh.
Entity add_static_mesh(Scene& scene, const std::string& name, std::shared_ptr<const Mesh> mesh,
                       const Pose& pose_ws = {}, const Look& look = {});

}  // namespace handhold
