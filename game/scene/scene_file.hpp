#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "components/body.hpp"
#include "engine/io/result.hpp"
#include "engine/math/math.hpp"
#include "game/render/render_frame.hpp"
#include "game/scene/scene_grip.hpp"
#include "game/scene/scene_joint.hpp"
#include "game/scene/scene_shape.hpp"

// What a scene's JSON says, checked but not built: docs/reference/scene_format.md. World space is
// written _ws in code; in the file, everything is in the scene's frame, which world_transform puts
// into the world. Mesh files and sessions are named here, not opened: their paths are those of the
// file, made relative to the scene file's folder.
namespace handhold {

struct SceneLevel {
    std::filesystem::path file;  // .glb or .gltf
    Pose pose;                   // of the file's frame in the scene
    Vec3 scale = Vec3::Ones();   // along the file's axes
};

// A closed path; as PathMover. The body's own pose is that of its first one.
struct ScenePath {
    double period_s = 1.0;    // > 0
    std::vector<Pose> poses;  // 2 to 16, in the scene's frame, at equal steps of the period
};

// Of a kinematic body: a constant twist, as Mover, or a path, beside which the other fields are
// unused.
struct SceneMotion {
    Vec3 velocity_mps = Vec3::Zero();  // at time 0
    Vec3 angular_velocity_radps = Vec3::Zero();
    bool turns_with_body = false;  // the velocity keeps its direction in the body's frame
    std::optional<ScenePath> path;
};

struct SceneBody {
    std::string name;  // unique among the bodies: gives the persistent id
    BodyKind kind = BodyKind::fixed;
    SceneShape shape;
    Pose pose;                         // of the shape's frame; of a free body, save a hull or
                                       // compound, that is its centre of mass, axes principal
    double mass_kg = 1.0;              // free: > 0; else unused
    std::optional<Vec3> inertia_kgm2;  // free: principal moments, > 0 each, the largest at most the
                                       // sum of the others; absent: that of the solid shape
    Vec3 velocity_mps = Vec3::Zero();  // free: at time 0
    Vec3 angular_velocity_radps = Vec3::Zero();  // free: at time 0
    SceneMotion motion;                          // kinematic; all zero: it stands still
    std::optional<std::array<float, 3>>
        color;                     // linear RGB in [0, 1]; absent: the mesh's own, or grey
    std::filesystem::path visual;  // .glb or .gltf in the body's frame, drawn instead of its shape;
                                   // empty: the shape
    double restitution = 0.0;      // [0, 1]; the larger of two bodies' counts
    double friction = 0.4;         // Coulomb's coefficient; of two bodies the geometric mean
    std::vector<SceneGrip> grips;  // at most k_max_authored_grips
};

struct SceneSpawn {
    std::string name;  // unique among the spawns
    Pose pose;         // of a play space: its floor point and where it faces (-Z)
};

struct ScenePlayer {
    std::string name;       // unique among players and bodies
    std::string spawn;      // name of a spawn of this scene
    double mass_kg = 80.0;  // > 0
};

// The recorded session that shows the scene.
struct SceneSession {
    std::filesystem::path file;  // .csv; empty: see built_in
    std::string built_in;        // name of a session of the game's own; empty: see file
};

struct SceneFile {
    std::string name;         // not empty
    std::string description;  // what there is to see; absent: empty
    Vec3 reference_velocity_mps =
        Vec3::Zero();  // what counts as standing still before anything was gripped
    std::vector<SceneLevel> levels;
    std::vector<SceneBody> bodies;
    std::vector<SceneJoint> joints;
    std::vector<Lamp> lamps;
    std::vector<SceneSpawn> spawns;
    std::vector<ScenePlayer> players;
    std::optional<SceneSession> session;
    Pose world_transform;  // of the scene's frame in the world; velocities turn with it
    std::string tuning_json =
        "{}";  // the object "tuning" as JSON text: its parser is the tuning's own
};

// Coordinates up to 1e6 m, sizes of shapes in [1e-3, 1e4] m, speeds up to 1e5 m/s and 1e3 rad/s,
// masses in [1e-6, 1e12] kg. Refused, with JSON pointer and value: what is out of range or of the
// wrong type, a key that is unknown or does not fit the body's kind, a name that is taken, a free
// body shaped by a mesh, a player without his spawn.
Result<SceneFile> load_scene_file(const std::filesystem::path& path);
// The same for text in memory; `path` is for messages and gives the folder for the paths in it.
Result<SceneFile> parse_scene_file(std::string_view text, const std::filesystem::path& path);

}  // namespace handhold
