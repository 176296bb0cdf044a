#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "components/body.hpp"
#include "engine/core/result.hpp"
#include "engine/math/math.hpp"
#include "game/mesh/render_frame.hpp"
#include "game/scene/scene_grip.hpp"
#include "game/scene/scene_joint.hpp"
#include "game/scene/scene_shape.hpp"

// The content of a scene's JSON, checked but not built: docs/reference/scene_format.md. All poses
// are in the scene's frame, which world_transform places in the world. Mesh files and sessions are
// named, not opened. Their paths in the file are relative to its folder; here they are resolved.
namespace handhold {

struct SceneLevel {
    std::filesystem::path file;  // .glb or .gltf
    Pose pose;                   // pose of the file's frame in the scene
    Vec3 scale = Vec3::Ones();   // scale along the file's axes
};

// A closed path (see PathMover). The body starts at the first pose.
struct ScenePath {
    double period_s = 1.0;    // > 0
    std::vector<Pose> poses;  // 2 to 16, in the scene's frame, equally spaced in time
};

// Motion of a kinematic body: a constant twist (see Mover), or a path. With a path, the other
// fields are unused.
struct SceneMotion {
    Vec3 velocity_mps = Vec3::Zero();  // velocity at time 0
    Vec3 angular_velocity_radps = Vec3::Zero();
    bool turns_with_body = false;  // the velocity keeps its direction in the body's frame
    std::optional<ScenePath> path;
};

struct SceneBody {
    std::string name;  // unique among the bodies: gives the persistent id
    BodyKind kind = BodyKind::fixed;
    SceneShape shape;
    // Pose of the shape's frame. Free bodies except hulls and compounds: its origin is the centre
    // of mass and its axes are the principal axes.
    Pose pose;
    double mass_kg = 1.0;  // free: > 0; else unused
    // Free: principal moments, > 0, the largest at most the sum of the others; nullopt: those of
    // the solid shape.
    std::optional<Vec3> inertia_kgm2;
    Vec3 velocity_mps = Vec3::Zero();            // free: at time 0
    Vec3 angular_velocity_radps = Vec3::Zero();  // free: at time 0
    SceneMotion motion;                          // kinematic; all zero: the body rests
    // Linear RGB in [0, 1]; nullopt: the mesh's own, or grey.
    std::optional<std::array<float, 3>> color;
    // .glb or .gltf in the body's frame, drawn instead of its shape; empty: the shape.
    std::filesystem::path visual;
    // [0, 1]; in a contact, the larger of the two bodies' values applies.
    double restitution = 0.0;
    // Coulomb coefficient; in a contact, the geometric mean of the two bodies' values applies.
    double friction = 0.4;
    std::vector<SceneGrip> grips;  // k_max_authored_grips at most
};

struct SceneSpawn {
    std::string name;  // unique among the spawns
    Pose pose;         // play space's pose at its floor point; the player faces -Z
};

struct ScenePlayer {
    std::string name;       // unique among players and bodies
    std::string spawn;      // name of a spawn of this scene
    double mass_kg = 80.0;  // > 0
};

// The session that shows the scene.
struct SceneSession {
    std::filesystem::path file;  // .csv; empty: see built_in
    std::string built_in;        // name of one of the game's sessions; empty: see file
};

struct SceneFile {
    std::string name;                            // not empty
    std::string description;                     // what the scene shows; may be empty
    Vec3 reference_velocity_mps = Vec3::Zero();  // applies until a player grips something
    std::vector<SceneLevel> levels;
    std::vector<SceneBody> bodies;
    std::vector<SceneJoint> joints;
    std::vector<Lamp> lamps;
    std::vector<SceneSpawn> spawns;
    std::vector<ScenePlayer> players;
    std::optional<SceneSession> session;
    Pose world_transform;  // pose of the scene's frame in the world; also rotates velocities
    std::string tuning_json = "{}";  // object "tuning" as JSON text; parse_tuning reads it
};

// Limits: coordinates 1e6 m, sizes of shapes [1e-3, 1e4] m, speeds 1e5 m/s and 1e3 rad/s, masses
// [1e-6, 1e12] kg. Errors name the JSON pointer and the value: values out of range or of the wrong
// type, unknown keys and keys that do not fit the body's kind, names that are taken, free bodies
// shaped by a mesh, players without a spawn.
Result<SceneFile> load_scene_file(const std::filesystem::path& path);
// Like load_scene_file, for text in memory. `path`: for messages; relative paths start at its
// folder.
Result<SceneFile> parse_scene_file(std::string_view text, const std::filesystem::path& path);

}  // namespace handhold
