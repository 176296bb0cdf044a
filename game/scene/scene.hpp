#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <handhold/handhold.hpp>

#include "engine/io/gltf.hpp"
#include "game/arena/arena_game.hpp"
#include "game/mesh/render_frame.hpp"
#include "game/scene/scene_file.hpp"
#include "systems/host/host_columns.hpp"

// A scene ready to play: a world of the C interface, and what is drawn of it. Sessions step and
// query `host`; levels, pictures and reports use the columns behind it.
namespace handhold {

// A mesh drawn at a body's pose. The body's collider may be simpler.
struct SceneVisual {
    Entity body;
    std::shared_ptr<const Mesh> mesh;
    std::optional<Color> color;  // nullopt: the mesh's own
    Look look;
};

struct SceneSpawnPoint {
    std::string name;
    hh::Pose pose_ws = hh::k_origin;  // play space; its position is the floor point
};

// The axis of a graspable straight bar in a body's frame, for scripted climbers.
struct SceneRail {
    hh::Body body{};
    hh::Vec3 start_bs{};
    hh::Vec3 end_bs{};
};

// A player who is to be added to the world.
struct ScenePlayerStart {
    std::string name;
    Pose origin_ws;
    double mass_kg = 80.0;
};

struct Scene {
    Scene();  // nothing in it; the world reports no touches

    std::string name;
    std::string description;
    hh::World host;  // has no players until they are added
    // The columns behind `host`. Change them only between frames.
    World& world() { return columns_of(host.get()).world; }
    const World& world() const { return columns_of(host.get()).world; }
    Tuning& tuning() { return columns_of(host.get()).tuning; }
    const Tuning& tuning() const { return columns_of(host.get()).tuning; }
    ShapeLibrary& shapes() { return columns_of(host.get()).shapes; }
    const ShapeLibrary& shapes() const { return columns_of(host.get()).shapes; }
    // For every body's shape, the surfaces that hands are fitted to.
    GripMeshLibrary& grip_meshes() { return columns_of(host.get()).grip_meshes; }
    const GripMeshLibrary& grip_meshes() const { return columns_of(host.get()).grip_meshes; }
    FrameCaches& caches() { return columns_of(host.get()).caches; }
    const FrameCaches& caches() const { return columns_of(host.get()).caches; }
    const StageStats& stats() const { return columns_of(std::as_const(host).get()).stats; }

    std::vector<SceneVisual> visuals;
    std::vector<Lamp> lamps;
    Entity lamps_body = k_no_entity;  // body whose frame the lamps are in; null: the world
    KeyLight key;                     // sun, or the main light of a room
    Vec3 up_ws = Vec3::UnitY();
    std::vector<SceneRail> rails;           // may be empty
    std::vector<SceneSpawnPoint> spawns;    // the first is the default; may be empty
    std::vector<ScenePlayerStart> players;  // the scene's own players; may be empty
    // Names of the bodies when the scene was loaded, in the order of World::body.
    std::vector<std::string> body_names;
    // Both maps have a body's name in the scene file as key. Values: the body's authored grips in
    // the file's frame; the pose of the body's frame in the file's frame (not the identity for
    // hulls and compounds).
    std::map<std::string, std::vector<SceneGrip>> grips;
    std::map<std::string, Pose> body_in_file;
    std::optional<SceneSession> session;  // recording that demonstrates the scene
    std::vector<std::string> notes;       // remarks about the loaded files; see GltfLevel::notes
    std::optional<ArenaGame> arena;       // rules of the game that is played here
    int climbers = 0;  // scripted climbers besides the first player; --players overrides it
};

// A function that loads the levels and meshes that a scene file names.
using LevelSource = std::function<Result<GltfLevel>(const std::filesystem::path&)>;
// Builds a scene from a scene file that was read and checked. `path`: the file, for error messages.
Result<Scene> build_scene(const SceneFile& file, const std::filesystem::path& path,
                          const LevelSource& levels = load_gltf_level);

// Builds the grip meshes that are missing; call it after adding bodies to a scene. A body without a
// grip mesh can be gripped, but hands are shown on it as tracked.
void add_grip_meshes(Scene& scene);
// Sets the folder in which add_grip_meshes keeps finished meshes between runs
// (engine/geometry/grip_mesh_cache.hpp). Empty, the default: meshes are not kept. The setting holds
// for the whole process. Call it before scenes are loaded.
void set_grip_mesh_cache(const std::filesystem::path& directory);

// Returns `wanted` with primes (') appended until its name and those of its hands are free.
std::string free_player_name(const World& world, std::string wanted);
// Adds a player to the world, at the start pose and with the scene's reference velocity.
PlayerEntities add_scene_player(Scene& scene, const ScenePlayerStart& start);
// Like the overload above, but appends primes to a name that is taken (free_player_name).
hh::Player add_scene_player(Scene& scene, const std::string& name, const hh::Pose& origin,
                            double mass_kg = 80.0);
// Ids of players, for calls of the interface.
std::vector<hh::Player> player_ids(std::span<const PlayerEntities> players);

// A static body whose visual is its collision mesh.
Entity add_static_mesh(Scene& scene, const std::string& name, std::shared_ptr<const Mesh> mesh,
                       const Pose& pose_ws = {}, const Look& look = {});

}  // namespace handhold
