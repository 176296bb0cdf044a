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

// The content of a scene's JSON, checked but not built: docs/reference/scene_format.md. All poses
// are in the scene's frame, which world_transform places in the world. Mesh files and sessions are
// named, not opened; their paths are relative to the scene file's folder in the file and resolved
// here.
namespace handhold {

struct SceneLevel {
    std::filesystem::path file;  // .glb or .gltf
    Pose pose;                   // of the file's frame in the scene
    Vec3 scale = Vec3::Ones();   // along the file's axes
};

// A closed path, as PathMover. The body starts at the first pose.
struct ScenePath {
    double period_s = 1.0;    // > 0
    std::vector<Pose> poses;  // 2 to 16, in the scene's frame, equally spaced in time
};

// Motion of a kinematic body: a constant twist, as Mover, or a path, which makes the other fields
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
    Pose pose;  // of the shape's frame. For a free body, except hulls and compounds, the centre of
                // mass with principal axes
    double mass_kg = 1.0;              // free: > 0; else unused
    std::optional<Vec3> inertia_kgm2;  // free: principal moments, > 0, the largest at most the sum
                                       // of the others; absent: those of the solid shape
    Vec3 velocity_mps = Vec3::Zero();  // free: at time 0
    Vec3 angular_velocity_radps = Vec3::Zero();  // free: at time 0
    SceneMotion motion;                          // kinematic; all zero: at rest
    std::optional<std::array<float, 3>>
        color;  // linear RGB in [0, 1]; absent: the mesh's own, or grey
    std::filesystem::path
        visual;  // .glb or .gltf in the body's frame, drawn instead of its shape; empty: the shape
    double restitution = 0.0;      // [0, 1]; of two bodies the larger counts
    double friction = 0.4;         // Coulomb coefficient; of two bodies the geometric mean counts
    std::vector<SceneGrip> grips;  // at most k_max_authored_grips
};

struct SceneSpawn {
    std::string name;  // unique among the spawns
    Pose pose;         // of a play space: its floor point; it faces -Z
};

struct ScenePlayer {
    std::string name;       // unique among players and bodies
    std::string spawn;      // name of a spawn of this scene
    double mass_kg = 80.0;  // > 0
};

// The recorded session that shows the scene.
struct SceneSession {
    std::filesystem::path file;  // .csv; empty: see built_in
    std::string built_in;        // name of one of the game's sessions; empty: see file
};

struct SceneFile {
    std::string name;                            // not empty
    std::string description;                     // what the scene shows; absent: empty
    Vec3 reference_velocity_mps = Vec3::Zero();  // reference velocity until something is gripped
    std::vector<SceneLevel> levels;
    std::vector<SceneBody> bodies;
    std::vector<SceneJoint> joints;
    std::vector<Lamp> lamps;
    std::vector<SceneSpawn> spawns;
    std::vector<ScenePlayer> players;
    std::optional<SceneSession> session;
    Pose world_transform;            // of the scene's frame in the world; velocities turn with it
    std::string tuning_json = "{}";  // the object "tuning" as JSON text; parse_tuning reads it
};

// Limits: coordinates 1e6 m, sizes of shapes [1e-3, 1e4] m, speeds 1e5 m/s and 1e3 rad/s, masses
// [1e-6, 1e12] kg. Refused, with JSON pointer and value: values out of range or of the wrong type,
// unknown keys and keys that do not fit the body's kind, names that are taken, free bodies shaped
// by a mesh, players without a spawn.
Result<SceneFile> load_scene_file(const std::filesystem::path& path);
// The same for text in memory. `path` is for messages, and its folder is that of relative paths.
Result<SceneFile> parse_scene_file(std::string_view text, const std::filesystem::path& path);

}  // namespace handhold
