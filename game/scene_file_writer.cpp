#include "game/scene_file_writer.hpp"

#include <nlohmann/json.hpp>

namespace handhold {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Json rotation_json(const Quat& q) { return {q.x(), q.y(), q.z(), q.w()}; }
Json color_json(const Color& color) { return {color[0], color[1], color[2]}; }

void add_pose(const Pose& pose, Json& json) {
    json["position_m"] = vector_json(pose.position);
    json["rotation_xyzw"] = rotation_json(pose.rotation);
}

Json shape_json(const SceneShape& shape) {
    switch (shape.type) {
        case SceneShapeType::box:
            return {{"type", "box"}, {"half_m", vector_json(shape.half_m)}};
        case SceneShapeType::sphere:
            return {{"type", "sphere"}, {"radius_m", shape.radius_m}};
        case SceneShapeType::capsule:
            return {{"type", "capsule"},
                    {"radius_m", shape.radius_m},
                    {"half_height_m", shape.half_height_m}};
        case SceneShapeType::mesh:
            break;
    }
    return {{"type", "mesh"}, {"file", shape.file.generic_string()}};
}

Json motion_json(const SceneMotion& motion) {
    if (!motion.path) {
        return {{"velocity_mps", vector_json(motion.velocity_mps)},
                {"angular_velocity_radps", vector_json(motion.angular_velocity_radps)},
                {"turns_with_body", motion.turns_with_body}};
    }
    Json poses = Json::array();
    for (const Pose& pose : motion.path->poses) {
        Json json;
        add_pose(pose, json);
        poses.push_back(std::move(json));
    }
    return {{"path", {{"period_s", motion.path->period_s}, {"poses", std::move(poses)}}}};
}

Json body_json(const SceneBody& body) {
    Json json;
    json["name"] = body.name;
    json["kind"] = body.kind == BodyKind::fixed       ? "static"
                   : body.kind == BodyKind::kinematic ? "kinematic"
                                                      : "free";
    json["shape"] = shape_json(body.shape);
    if (!body.motion.path) {
        add_pose(body.pose, json);
    }
    if (body.kind == BodyKind::free) {
        json["mass_kg"] = body.mass_kg;
        if (body.inertia_kgm2) {
            json["inertia_kgm2"] = vector_json(*body.inertia_kgm2);
        }
        json["velocity_mps"] = vector_json(body.velocity_mps);
        json["angular_velocity_radps"] = vector_json(body.angular_velocity_radps);
    } else if (body.kind == BodyKind::kinematic) {
        json["motion"] = motion_json(body.motion);
    }
    if (body.color) {
        json["color"] = color_json(*body.color);
    }
    if (!body.visual.empty()) {
        json["visual"] = body.visual.generic_string();
    }
    json["restitution"] = body.restitution;
    return json;
}

}  // namespace

std::string write_scene_file(const SceneFile& scene) {
    Json json;
    json["name"] = scene.name;
    json["description"] = scene.description;
    json["reference_velocity_mps"] = vector_json(scene.reference_velocity_mps);
    json["levels"] = Json::array();
    for (const SceneLevel& level : scene.levels) {
        Json item = {{"file", level.file.generic_string()}};
        add_pose(level.pose, item);
        json["levels"].push_back(std::move(item));
    }
    json["bodies"] = Json::array();
    for (const SceneBody& body : scene.bodies) {
        json["bodies"].push_back(body_json(body));
    }
    json["lamps"] = Json::array();
    for (const Lamp& lamp : scene.lamps) {
        json["lamps"].push_back({{"position_m", vector_json(lamp.position_ws)},
                                 {"color", color_json(lamp.color)},
                                 {"reach_m", lamp.reach_m}});
    }
    json["spawns"] = Json::array();
    for (const SceneSpawn& spawn : scene.spawns) {
        Json item = {{"name", spawn.name}};
        add_pose(spawn.pose, item);
        json["spawns"].push_back(std::move(item));
    }
    json["players"] = Json::array();
    for (const ScenePlayer& player : scene.players) {
        json["players"].push_back(
            {{"name", player.name}, {"spawn", player.spawn}, {"mass_kg", player.mass_kg}});
    }
    if (scene.session && !scene.session->built_in.empty()) {
        json["session"] = scene.session->built_in;
    } else if (scene.session) {
        json["session"] = {{"file", scene.session->file.generic_string()}};
    }
    Json transform;
    add_pose(scene.world_transform, transform);
    json["world_transform"] = std::move(transform);
    json["tuning"] = Json::parse(scene.tuning_json);
    return json.dump(1) + "\n";
}

}  // namespace handhold
