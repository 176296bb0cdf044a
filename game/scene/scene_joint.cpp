#include "game/scene/scene_joint.hpp"

#include <numbers>

#include "game/scene/scene_ranges.hpp"

namespace handhold {
namespace {

constexpr NumberRange k_limit_m = {-1e6, 1e6, false};
constexpr NumberRange k_limit_deg = {-1e6, 1e6, false};
constexpr NumberRange k_force = {0.0, 1e12, false};

bool is_angle(JointKind kind) { return kind == JointKind::hinge || kind == JointKind::ball; }
bool has_coordinate(JointKind kind) {
    return kind == JointKind::hinge || kind == JointKind::slider;
}

// Units of a joint's numbers. The file's keys name the unit; in memory all numbers are SI.
struct Units {
    double scale;  // one unit of the file in SI units
    NumberRange range;
    const char* suffix;        // suffix of keys for coordinates
    const char* force_suffix;  // suffix of keys for forces and torques

    explicit Units(JointKind kind)
        : scale(is_angle(kind) ? std::numbers::pi / 180.0 : 1.0),
          range(is_angle(kind) ? k_limit_deg : k_limit_m),
          suffix(is_angle(kind) ? "_deg" : "_m"),
          force_suffix(is_angle(kind) ? "_nm" : "_n") {}

    std::string key(const char* name) const { return std::string(name) + suffix; }
    std::string force_key(const char* name) const { return std::string(name) + force_suffix; }
    double number(const JsonValue& value) const { return scale * value.number(range); }
    double positive(const JsonValue& value) const {
        return scale * value.number({0.0, range.high, true});
    }
};

JointKind read_joint_kind(const JsonValue& value) {
    const std::string kind = value.text();
    if (kind == "ball") {
        return JointKind::ball;
    }
    if (kind == "hinge") {
        return JointKind::hinge;
    }
    if (kind == "slider") {
        return JointKind::slider;
    }
    if (kind == "distance") {
        return JointKind::distance;
    }
    if (kind != "fixed") {
        value.refuse("\"ball\", \"hinge\", \"slider\", \"fixed\" or \"distance\"");
    }
    return JointKind::fixed;
}

Pose read_frame(const JsonValue& value) {
    Pose pose{value["position_m"].vector_or(Vec3::Zero(), k_coordinate_m),
              value["rotation_xyzw"].rotation_or(Quat::Identity())};
    if (const JsonValue axis = value["axis"]; axis.exists()) {
        const Vec3 direction = axis.vector(k_coordinate_m);
        if (direction.norm() < 1e-6) {
            axis.refuse("a direction: not all 0");
            return pose;
        }
        if (value["rotation_xyzw"].exists()) {
            axis.refuse("nothing beside \"rotation_xyzw\"");
        }
        pose.rotation = rotation_between(Vec3::UnitX(), direction.normalized());
    }
    return pose;
}

void read_limits(const JsonValue& value, const Units& units, Joint& joint) {
    if (joint.kind == JointKind::ball) {
        if (const JsonValue cone = value["cone_deg"]; cone.exists()) {
            joint.limited = true;
            joint.upper = units.positive(cone);
        }
        return;
    }
    const JsonValue limits = value[units.key("limits")];
    if (joint.kind == JointKind::fixed || (!limits.exists() && joint.kind != JointKind::distance)) {
        return;
    }
    const std::vector<JsonValue> ends = limits.items();
    if (ends.size() != 2) {
        limits.refuse("two numbers");
        return;
    }
    joint.limited = true;
    joint.lower = units.number(ends[0]);
    joint.upper = units.number(ends[1]);
    if (joint.lower > joint.upper) {
        limits.refuse("two numbers, the lower first");
    } else if (joint.kind == JointKind::distance && (joint.lower < 0.0 || joint.upper == 0.0)) {
        limits.refuse("distances, the upper one above 0");
    } else if (joint.kind != JointKind::distance && (joint.lower > 0.0 || joint.upper < 0.0)) {
        limits.refuse("limits with 0 between them: where the bodies stand");
    }
}

void read_latch(const JsonValue& value, const Units& units, const SceneJointNames& names,
                SceneJoint& out) {
    const std::string at = units.key("at");
    const std::string catch_range = units.key("catch");
    const std::string strength = units.force_key("strength");
    const std::string_view keys[] = {at, catch_range, strength, "handle", "handle_deg", "handle_m"};
    value.allow_only(keys);
    JointLatch& latch = out.joint.latch;
    latch.at = units.scale * value[at].number_or(0.0, units.range);
    latch.catch_range = units.positive(value[catch_range]);
    latch.strength = value[strength].number_or(0.0, k_force);
    if (!value["handle"].exists()) {
        value.allow_only({std::string_view(at), catch_range, strength});
        return;
    }
    out.handle = value["handle"].text();
    const auto handle = names.joints.find(out.handle);
    if (handle == names.joints.end() || !has_coordinate(handle->second)) {
        value["handle"].refuse("the name of a hinge or slider listed before");
        return;
    }
    const Units handle_units(handle->second);
    out.handle_is_angle = is_angle(handle->second);
    latch.handle_at = handle_units.positive(value[handle_units.key("handle")]);
}

void read_resistance(const JsonValue& value, const Units& units, Joint& joint) {
    joint.friction = value[units.force_key("friction")].number_or(0.0, k_force);
    if (const JsonValue detent = value["detent"]; detent.exists()) {
        const std::string spacing = units.key("spacing");
        const std::string strength = units.force_key("strength");
        const std::string_view keys[] = {spacing, strength};
        detent.allow_only(keys);
        joint.detent_spacing = units.positive(detent[spacing]);
        joint.detent_strength = detent[strength].number({0.0, k_force.high, true});
    }
}

void allow_keys_of(const JsonValue& value, JointKind kind, const Units& units) {
    std::vector<std::string> names = {"name",       "type",          "a",    "b",
                                      "position_m", "rotation_xyzw", "axis", "collides"};
    if (kind == JointKind::ball) {
        names.insert(names.end(), {"cone_deg", units.force_key("friction")});
    } else if (kind == JointKind::distance) {
        names.insert(names.end(), {units.key("limits"), "position_a_m"});
    } else if (has_coordinate(kind)) {
        names.insert(names.end(),
                     {units.key("limits"), units.force_key("friction"), "detent", "latch"});
    }
    const std::vector<std::string_view> keys(names.begin(), names.end());
    value.allow_only(keys);
}

std::string read_body(const JsonValue& value, const SceneJointNames& names, bool& is_free) {
    std::string name = value.text();
    const auto body = names.bodies.find(name);
    if (body == names.bodies.end()) {
        value.refuse("the name of one of the scene's bodies");
    } else {
        is_free = is_free || body->second == BodyKind::free;
    }
    return name;
}

}  // namespace

SceneJoint read_scene_joint(const JsonValue& value, SceneJointNames& names) {
    SceneJoint out;
    out.name = value["name"].text();
    out.joint.kind = read_joint_kind(value["type"]);
    const Units units(out.joint.kind);
    allow_keys_of(value, out.joint.kind, units);
    if (names.bodies.contains(out.name) || !names.joints.emplace(out.name, out.joint.kind).second) {
        value["name"].refuse("a name that nothing else has");
    }
    bool is_free = false;
    out.b = read_body(value["b"], names, is_free);
    if (value["a"].exists()) {
        out.a = read_body(value["a"], names, is_free);
    }
    if (out.a == out.b) {
        value["b"].refuse("another body than \"a\"");
    } else if (!is_free) {
        value["b"].refuse("a free body on one side at least");
    }
    out.pose = read_frame(value);
    if (const JsonValue end = value["position_a_m"]; end.exists()) {
        out.end_a = end.vector(k_coordinate_m);
    } else {
        out.end_a = out.pose.position;
    }
    out.joint.collides = value["collides"].flag_or(false);
    read_limits(value, units, out.joint);
    if (has_coordinate(out.joint.kind) || out.joint.kind == JointKind::ball) {
        read_resistance(value, units, out.joint);
    }
    if (const JsonValue latch = value["latch"]; latch.exists()) {
        read_latch(latch, units, names, out);
    }
    return out;
}

}  // namespace handhold
