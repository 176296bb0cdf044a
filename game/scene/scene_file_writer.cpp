#include "game/scene/scene_file_writer.hpp"

#include <numbers>
#include <utility>

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

Json shape_json(const SceneShape& shape);

Json hull_json(const SceneShape& shape) {
    if (!shape.file.empty()) {
        return {{"type", "hull"},
                {"file", shape.file.generic_string()},
                {"scale", vector_json(shape.scale)}};
    }
    Json points = Json::array();
    for (const Vec3& point : shape.hull.corners) {
        points.push_back(vector_json(point));
    }
    return {{"type", "hull"}, {"points_m", std::move(points)}};
}

Json compound_json(const SceneShape& shape) {
    Json children = Json::array();
    for (const SceneShapePart& part : shape.parts) {
        Json child = {{"shape", shape_json(part.shape)}};
        add_pose(part.pose, child);
        if (part.mass_kg > 0.0) {
            child["mass_kg"] = part.mass_kg;
        }
        children.push_back(std::move(child));
    }
    return {{"type", "compound"}, {"children", std::move(children)}};
}

Json shape_json(const SceneShape& shape) {
    switch (shape.kind) {
        case ShapeKind::box:
            return {{"type", "box"}, {"half_m", vector_json(shape.half_m)}};
        case ShapeKind::sphere:
            return {{"type", "sphere"}, {"radius_m", shape.radius_m}};
        case ShapeKind::capsule:
            return {{"type", "capsule"},
                    {"radius_m", shape.radius_m},
                    {"half_height_m", shape.half_height_m}};
        case ShapeKind::cylinder:
            return {{"type", "cylinder"},
                    {"radius_m", shape.radius_m},
                    {"half_height_m", shape.half_height_m}};
        case ShapeKind::hull:
            return hull_json(shape);
        case ShapeKind::compound:
            return compound_json(shape);
        case ShapeKind::mesh:
            break;
    }
    return {{"type", "mesh"},
            {"file", shape.file.generic_string()},
            {"scale", vector_json(shape.scale)}};
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
    json["friction"] = body.friction;
    for (const SceneGrip& grip : body.grips) {
        json["grips"].push_back(Json::parse(write_scene_grip(grip)));
    }
    return json;
}

const char* name_of(JointKind kind) {
    switch (kind) {
        case JointKind::ball:
            return "ball";
        case JointKind::hinge:
            return "hinge";
        case JointKind::slider:
            return "slider";
        case JointKind::fixed:
            return "fixed";
        case JointKind::distance:
            break;
    }
    return "distance";
}

// Writes limits, resistance and latch, in the file's units.
void add_coordinate(const SceneJoint& joint, Json& json) {
    const Joint& numbers = joint.joint;
    const bool angle = numbers.kind == JointKind::hinge;
    const double unit = angle ? 180.0 / std::numbers::pi : 1.0;
    const auto key = [angle](const char* name) {
        return name + std::string(angle ? "_deg" : "_m");
    };
    const auto force = [angle](const char* name) {
        return name + std::string(angle ? "_nm" : "_n");
    };
    if (numbers.limited) {
        json[key("limits")] = {unit * numbers.lower, unit * numbers.upper};
    }
    json[force("friction")] = numbers.friction;
    if (numbers.detent_spacing > 0.0) {
        json["detent"] = {{key("spacing"), unit * numbers.detent_spacing},
                          {force("strength"), numbers.detent_strength}};
    }
    if (numbers.latch.catch_range <= 0.0) {
        return;
    }
    Json latch = {{key("at"), unit * numbers.latch.at},
                  {key("catch"), unit * numbers.latch.catch_range},
                  {force("strength"), numbers.latch.strength}};
    if (!joint.handle.empty()) {
        latch["handle"] = joint.handle;
        latch[joint.handle_is_angle ? "handle_deg" : "handle_m"] =
            numbers.latch.handle_at * (joint.handle_is_angle ? 180.0 / std::numbers::pi : 1.0);
    }
    json["latch"] = std::move(latch);
}

Json joint_json(const SceneJoint& joint) {
    Json json = {{"name", joint.name}, {"type", name_of(joint.joint.kind)}, {"b", joint.b}};
    if (!joint.a.empty()) {
        json["a"] = joint.a;
    }
    add_pose(joint.pose, json);
    json["collides"] = joint.joint.collides;
    switch (joint.joint.kind) {
        case JointKind::hinge:
        case JointKind::slider:
            add_coordinate(joint, json);
            break;
        case JointKind::ball:
            json["friction_nm"] = joint.joint.friction;
            if (joint.joint.limited) {
                json["cone_deg"] = joint.joint.upper * 180.0 / std::numbers::pi;
            }
            break;
        case JointKind::distance:
            json["position_a_m"] = vector_json(joint.end_a);
            json["limits_m"] = {joint.joint.lower, joint.joint.upper};
            break;
        case JointKind::fixed:
            break;
    }
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
        item["scale"] = vector_json(level.scale);
        json["levels"].push_back(std::move(item));
    }
    json["bodies"] = Json::array();
    for (const SceneBody& body : scene.bodies) {
        json["bodies"].push_back(body_json(body));
    }
    json["joints"] = Json::array();
    for (const SceneJoint& joint : scene.joints) {
        json["joints"].push_back(joint_json(joint));
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
