#include "game/scene/scene_file.hpp"

#include <initializer_list>
#include <numbers>
#include <set>
#include <utility>

#include "engine/core/text_file.hpp"
#include "engine/io/json.hpp"
#include "game/scene/scene_chain.hpp"
#include "game/scene/scene_ranges.hpp"

namespace handhold {

namespace {

constexpr NumberRange k_speed_mps = {-1e5, 1e5, false};
constexpr NumberRange k_turn_rate_radps = {-1e3, 1e3, false};
constexpr NumberRange k_inertia_kgm2 = {1e-12, 1e18, false};
constexpr NumberRange k_friction = {0.0, 10.0, false};
constexpr NumberRange k_period_s = {1e-3, 1e6, false};
constexpr NumberRange k_reach_m = {0.0, 1e6, true};
constexpr NumberRange k_angle_deg = {-360.0, 360.0, false};

// Reads the sections of one document. The document keeps the first error.
class SceneReader {
  public:
    SceneReader(const JsonValue& root, std::filesystem::path folder)
        : root_(root), folder_(std::move(folder)) {}

    SceneFile read();

  private:
    SceneLevel read_level(const JsonValue& value) const;
    SceneBody read_body(const JsonValue& value);
    static void read_free_body(const JsonValue& value, SceneBody& body);
    static void read_grips(const JsonValue& value, SceneBody& body);
    static SceneMotion read_motion(const JsonValue& value);
    static ScenePath read_path_of_poses(const JsonValue& value);
    static Lamp read_lamp(const JsonValue& value);
    SceneSpawn read_spawn(const JsonValue& value);
    ScenePlayer read_player(const JsonValue& value);
    SceneSession read_session(const JsonValue& value) const;
    static Pose read_pose(const JsonValue& value);
    std::filesystem::path read_path(const JsonValue& value) const;

    JsonValue root_;
    std::filesystem::path folder_;
    // Names of bodies, joints and players. All must differ, because they give the persistent ids.
    std::set<std::string> entity_names_;
    SceneJointNames joint_names_;
    std::set<std::string> spawn_names_;
};

std::string read_new_name(const JsonValue& value, std::set<std::string>& taken) {
    std::string name = value.text();
    if (!taken.insert(name).second) {
        value.refuse("a name that nothing else has");
    }
    return name;
}

void refuse_keys(const JsonValue& object, std::initializer_list<const char*> keys,
                 const std::string& reason) {
    for (const char* key : keys) {
        if (const JsonValue value = object[key]; value.exists()) {
            value.refuse("nothing: " + reason);
        }
    }
}

BodyKind read_kind(const JsonValue& value) {
    const std::string kind = value.text();
    if (kind == "static") {
        return BodyKind::fixed;
    }
    if (kind == "kinematic") {
        return BodyKind::kinematic;
    }
    if (kind != "free") {
        value.refuse("\"static\", \"kinematic\" or \"free\"");
    }
    return BodyKind::free;
}

Pose SceneReader::read_pose(const JsonValue& value) {
    return {value["position_m"].vector_or(Vec3::Zero(), k_coordinate_m),
            value["rotation_xyzw"].rotation_or(Quat::Identity())};
}

std::filesystem::path SceneReader::read_path(const JsonValue& value) const {
    return (folder_ / value.text()).lexically_normal();
}

SceneLevel SceneReader::read_level(const JsonValue& value) const {
    value.allow_only({"file", "position_m", "rotation_xyzw", "scale"});
    return {read_path(value["file"]), read_pose(value), read_scale(value["scale"])};
}

SceneMotion SceneReader::read_motion(const JsonValue& value) {
    if (const JsonValue path = value["path"]; path.exists()) {
        value.allow_only({"path"});
        SceneMotion motion;
        motion.path = read_path_of_poses(path);
        return motion;
    }
    value.allow_only({"velocity_mps", "angular_velocity_radps", "turns_with_body"});
    return {value["velocity_mps"].vector_or(Vec3::Zero(), k_speed_mps),
            value["angular_velocity_radps"].vector_or(Vec3::Zero(), k_turn_rate_radps),
            value["turns_with_body"].flag_or(false), std::nullopt};
}

ScenePath SceneReader::read_path_of_poses(const JsonValue& value) {
    value.allow_only({"period_s", "poses"});
    ScenePath path;
    path.period_s = value["period_s"].number(k_period_s);
    const std::vector<JsonValue> poses = value["poses"].items();
    if (poses.size() < 2 || poses.size() > k_max_path_keys) {
        value["poses"].refuse("2 to " + std::to_string(k_max_path_keys) + " poses");
        return path;
    }
    for (const JsonValue& pose : poses) {
        pose.allow_only({"position_m", "rotation_xyzw"});
        path.poses.push_back(read_pose(pose));
    }
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const Quat& from = path.poses[i].rotation;
        const Quat& to = path.poses[(i + 1) % poses.size()].rotation;
        if (rotation_to_vector(from.conjugate() * to).norm() > k_max_path_turn_rad - 1e-6) {
            poses[i].refuse("a turn of at most 120 degrees to the next pose");
        }
    }
    return path;
}

void SceneReader::read_free_body(const JsonValue& value, SceneBody& body) {
    body.mass_kg = value["mass_kg"].number(k_mass_kg);
    body.velocity_mps = value["velocity_mps"].vector_or(Vec3::Zero(), k_speed_mps);
    body.angular_velocity_radps =
        value["angular_velocity_radps"].vector_or(Vec3::Zero(), k_turn_rate_radps);
    if (body.shape.kind == ShapeKind::mesh) {
        value["shape"]["type"].refuse("a shape with an inside for a free body");
    }
    if (const JsonValue inertia = value["inertia_kgm2"]; inertia.exists()) {
        body.inertia_kgm2 = inertia.vector(k_inertia_kgm2);
        // No mass distribution has a moment of inertia above the sum of the other two, since int
        // (y^2 + z^2) <= int (x^2 + z^2) + int (x^2 + y^2). A thin plate reaches equality; the
        // factor allows for rounding.
        const double largest = body.inertia_kgm2->maxCoeff();
        if (largest > (body.inertia_kgm2->sum() - largest) * (1.0 + 1e-6)) {
            inertia.refuse("moments of which none is above the sum of the others");
        }
    }
}

SceneBody SceneReader::read_body(const JsonValue& value) {
    value.allow_only({"name", "kind", "shape", "position_m", "rotation_xyzw", "mass_kg",
                      "inertia_kgm2", "velocity_mps", "angular_velocity_radps", "motion", "color",
                      "visual", "restitution", "friction", "grips"});
    SceneBody body;
    body.name = read_new_name(value["name"], entity_names_);
    body.kind = read_kind(value["kind"]);
    body.shape = read_scene_shape(value["shape"], folder_);
    body.pose = read_pose(value);
    if (body.kind == BodyKind::free) {
        read_free_body(value, body);
    } else {
        refuse_keys(value, {"mass_kg", "inertia_kgm2", "velocity_mps", "angular_velocity_radps"},
                    "only free bodies have it; a kinematic one has \"motion\"");
    }
    if (body.kind != BodyKind::kinematic) {
        refuse_keys(value, {"motion"}, "only kinematic bodies have it");
    } else if (const JsonValue motion = value["motion"]; motion.exists()) {
        body.motion = read_motion(motion);
        if (body.motion.path) {
            refuse_keys(value, {"position_m", "rotation_xyzw"}, "the path's first pose is its");
            body.pose = body.motion.path->poses.empty() ? Pose{} : body.motion.path->poses.front();
        }
    }
    if (const JsonValue color = value["color"]; color.exists()) {
        body.color = read_color(color, k_unit_interval);
    }
    if (const JsonValue visual = value["visual"]; visual.exists()) {
        body.visual = read_path(visual);
    }
    body.restitution = value["restitution"].number_or(body.restitution, k_unit_interval);
    body.friction = value["friction"].number_or(body.friction, k_friction);
    read_grips(value["grips"], body);
    joint_names_.bodies.emplace(body.name, body.kind);
    return body;
}

void SceneReader::read_grips(const JsonValue& value, SceneBody& body) {
    const std::vector<JsonValue> grips = value.optional_items();
    if (grips.size() > k_max_authored_grips) {
        value.refuse("at most " + std::to_string(k_max_authored_grips) + " grips");
    }
    std::set<std::string> names;
    for (const JsonValue& grip : grips) {
        body.grips.push_back(read_scene_grip(grip, names));
    }
}

Lamp SceneReader::read_lamp(const JsonValue& value) {
    value.allow_only({"position_m", "color", "reach_m"});
    return {value["position_m"].vector(k_coordinate_m), read_color(value["color"], k_brightness),
            value["reach_m"].number(k_reach_m)};
}

SceneSpawn SceneReader::read_spawn(const JsonValue& value) {
    value.allow_only({"name", "position_m", "rotation_xyzw", "yaw_deg"});
    SceneSpawn spawn = {read_new_name(value["name"], spawn_names_), read_pose(value)};
    if (const JsonValue yaw = value["yaw_deg"]; yaw.exists()) {
        if (value["rotation_xyzw"].exists()) {
            yaw.refuse("nothing beside \"rotation_xyzw\"");
        }
        const double yaw_rad = yaw.number(k_angle_deg) * std::numbers::pi / 180.0;
        spawn.pose.rotation = rotation_about(Vec3::UnitY(), yaw_rad);
    }
    return spawn;
}

ScenePlayer SceneReader::read_player(const JsonValue& value) {
    value.allow_only({"name", "spawn", "mass_kg"});
    ScenePlayer player;
    player.name = read_new_name(value["name"], entity_names_);
    player.spawn = value["spawn"].text();
    if (!spawn_names_.contains(player.spawn)) {
        value["spawn"].refuse("the name of one of the scene's spawns");
    }
    player.mass_kg = value["mass_kg"].number_or(player.mass_kg, k_mass_kg);
    return player;
}

SceneSession SceneReader::read_session(const JsonValue& value) const {
    if (value.is_text()) {
        return {{}, value.text()};
    }
    if (!value.is_object()) {
        value.refuse("the name of a built-in session or an object with a \"file\"");
        return {};
    }
    value.allow_only({"file"});
    return {read_path(value["file"]), {}};
}

SceneFile SceneReader::read() {
    root_.allow_only({"name", "description", "reference_velocity_mps", "levels", "bodies", "joints",
                      "chains", "lamps", "spawns", "players", "session", "world_transform",
                      "tuning"});
    SceneFile scene;
    scene.name = root_["name"].text();
    scene.description = root_["description"].text_or({});
    scene.reference_velocity_mps =
        root_["reference_velocity_mps"].vector_or(Vec3::Zero(), k_speed_mps);
    for (const JsonValue& level : root_["levels"].optional_items()) {
        scene.levels.push_back(read_level(level));
    }
    for (const JsonValue& body : root_["bodies"].optional_items()) {
        scene.bodies.push_back(read_body(body));
    }
    for (const JsonValue& joint : root_["joints"].optional_items()) {
        scene.joints.push_back(read_scene_joint(joint, joint_names_));
        entity_names_.insert(scene.joints.back().name);
    }
    for (const JsonValue& chain : root_["chains"].optional_items()) {
        const std::string name = read_new_name(chain["name"], entity_names_);
        read_scene_chain(chain, name, joint_names_, scene);
    }
    for (const JsonValue& lamp : root_["lamps"].optional_items()) {
        scene.lamps.push_back(read_lamp(lamp));
    }
    for (const JsonValue& spawn : root_["spawns"].optional_items()) {
        scene.spawns.push_back(read_spawn(spawn));
    }
    for (const JsonValue& player : root_["players"].optional_items()) {
        scene.players.push_back(read_player(player));
    }
    if (const JsonValue session = root_["session"]; session.exists()) {
        scene.session = read_session(session);
    }
    if (const JsonValue transform = root_["world_transform"]; transform.exists()) {
        transform.allow_only({"position_m", "rotation_xyzw"});
        scene.world_transform = read_pose(transform);
    }
    if (const JsonValue tuning = root_["tuning"]; tuning.exists()) {
        if (!tuning.is_object()) {
            tuning.refuse("an object");
        }
        scene.tuning_json = tuning.dump_without({});
    }
    return scene;
}

}  // namespace

Result<SceneFile> parse_scene_file(std::string_view text, const std::filesystem::path& path) {
    const Result<JsonDocument> document = JsonDocument::parse(text, path.string());
    if (!document) {
        return document.error();
    }
    SceneFile scene = SceneReader(document.value().root(), path.parent_path()).read();
    if (document.value().failed()) {
        return document.value().error();
    }
    return scene;
}

Result<SceneFile> load_scene_file(const std::filesystem::path& path) {
    const Result<std::string> text = read_file(path);
    if (!text) {
        return text.error();
    }
    return parse_scene_file(text.value(), path);
}

}  // namespace handhold
