#include "game/scene/scene_grip.hpp"

#include <array>
#include <optional>

#include <nlohmann/json.hpp>

#include "systems/rigs/authored_hand.hpp"
#include "systems/rigs/hand_kinematics.hpp"

namespace handhold {
namespace {

constexpr NumberRange k_wrist_m = {-1e3, 1e3, false};
constexpr NumberRange k_curl_deg = {-30.0, 130.0, false};
constexpr NumberRange k_opposition_deg = {-180.0, 180.0, false};
constexpr NumberRange k_spread_deg = {-30.0, 30.0, false};
constexpr NumberRange k_snap_radius_m = {0.0, 1.0, true};
constexpr NumberRange k_snap_angle_deg = {0.0, 180.0, true};
constexpr std::int64_t k_max_priority = 100;

// Indexed by HandSide.
constexpr std::array<const char*, k_hand_count> k_side_keys = {"left", "right"};
constexpr std::array<const char*, 3> k_axes = {"x", "y", "z"};

// Keys of a digit's angles.
struct AngleKeys {
    const char* curl;
    const char* opposition;  // thumb
    const char* spread;      // fingers

    const char* sideways(FingerName name) const {
        return name == FingerName::thumb ? opposition : spread;
    }
};
constexpr AngleKeys k_released_keys = {"curl_deg", "opposition_deg", "spread_deg"};
constexpr AngleKeys k_pressed_keys = {"pressed_curl_deg", "pressed_opposition_deg",
                                      "pressed_spread_deg"};

void read_angles(const JsonValue& value, const AngleKeys& keys, FingerName name,
                 FingerAngles& angles) {
    const JsonValue sideways = value[keys.sideways(name)];
    if (name == FingerName::thumb) {
        angles.opposition_rad = k_degree * sideways.number(k_opposition_deg);
    } else if (sideways.exists()) {
        angles.opposition_rad = k_degree * sideways.number(k_spread_deg);
    }
    const std::vector<JsonValue> curls = value[keys.curl].items();
    if (curls.size() < 2 || curls.size() > k_max_links) {
        value[keys.curl].refuse("2 or 3 angles, the knuckle's first");
        return;
    }
    for (std::size_t i = 0; i < curls.size(); ++i) {
        angles.curl_rad[i] = k_degree * curls[i].number(k_curl_deg);
    }
}

void read_finger(const JsonValue& value, std::size_t finger, AuthoredHand& hand) {
    const auto name = static_cast<FingerName>(finger);
    value.allow_only({k_released_keys.curl, k_released_keys.sideways(name), k_pressed_keys.curl,
                      k_pressed_keys.sideways(name)});
    hand.is_posed[finger] = true;
    read_angles(value, k_released_keys, name, hand.fingers[finger]);
    if (value[k_pressed_keys.curl].exists() || value[k_pressed_keys.sideways(name)].exists()) {
        hand.follows_trigger[finger] = true;
        read_angles(value, k_pressed_keys, name, hand.pressed[finger]);
    }
}

void read_fingers(const JsonValue& value, AuthoredHand& hand) {
    if (!value.exists()) {
        return;
    }
    if (value.is_text()) {
        if (value.text() != "fit") {
            value.refuse("\"fit\" or an object of fingers");
        }
        return;
    }
    if (!value.is_object()) {
        value.refuse("\"fit\" or an object of fingers");
        return;
    }
    value.allow_only({"thumb", "index", "middle", "ring", "little"});
    for (std::size_t f = 0; f < k_finger_count; ++f) {
        const auto name = static_cast<FingerName>(f);
        if (const JsonValue finger = value[finger_text(name)]; finger.exists()) {
            read_finger(finger, f, hand);
        }
    }
}

AuthoredHand read_hand(const JsonValue& value) {
    AuthoredHand hand;
    if (!value.exists()) {
        return hand;
    }
    value.allow_only({"position_m", "rotation_xyzw", "fingers"});
    hand.is_there = true;
    hand.wrist_bs = {value["position_m"].vector(k_wrist_m), value["rotation_xyzw"].rotation()};
    read_fingers(value["fingers"], hand);
    return hand;
}

std::optional<int> read_axis(const JsonValue& value) {
    const std::string name = value.text();
    for (std::size_t axis = 0; axis < k_axes.size(); ++axis) {
        if (name == k_axes[axis]) {
            return static_cast<int>(axis);
        }
    }
    value.refuse("\"x\", \"y\" or \"z\"");
    return std::nullopt;
}

using GripJson = nlohmann::ordered_json;

void write_angles(const FingerAngles& angles, const AngleKeys& keys, FingerName name,
                  GripJson& finger) {
    GripJson curls = GripJson::array();
    for (const double curl_rad : angles.curl_rad) {
        curls.push_back(curl_rad / k_degree);
    }
    finger[keys.curl] = std::move(curls);
    if (name == FingerName::thumb || angles.opposition_rad != 0.0) {
        finger[keys.sideways(name)] = angles.opposition_rad / k_degree;
    }
}

GripJson hand_json(const AuthoredHand& hand) {
    const Vec3& at = hand.wrist_bs.position;
    const Quat& turn = hand.wrist_bs.rotation;
    GripJson json = {{"position_m", {at.x(), at.y(), at.z()}},
                     {"rotation_xyzw", {turn.x(), turn.y(), turn.z(), turn.w()}}};
    GripJson fingers = GripJson::object();
    for (std::size_t f = 0; f < k_finger_count; ++f) {
        const auto name = static_cast<FingerName>(f);
        if (!hand.is_posed[f]) {
            continue;
        }
        GripJson& finger = fingers[finger_text(name)];
        write_angles(hand.fingers[f], k_released_keys, name, finger);
        if (hand.follows_trigger[f]) {
            write_angles(hand.pressed[f], k_pressed_keys, name, finger);
        }
    }
    if (fingers.empty()) {
        json["fingers"] = "fit";
    } else {
        json["fingers"] = std::move(fingers);
    }
    return json;
}

}  // namespace

SceneGrip read_scene_grip(const JsonValue& value, std::set<std::string>& taken) {
    value.allow_only(
        {"name", "right", "left", "mirror", "priority", "snap_radius_m", "snap_angle_deg"});
    SceneGrip scene_grip;
    AuthoredGrip& grip = scene_grip.grip;
    scene_grip.name = value["name"].text();
    if (!taken.insert(scene_grip.name).second) {
        value["name"].refuse("a name that no other grip of the body has");
    }
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        grip.hands[side] = read_hand(value[k_side_keys[side]]);
    }
    const bool has_left = grip.hands[0].is_there;
    const bool has_right = grip.hands[1].is_there;
    if (!has_left && !has_right) {
        value.refuse("a grip with a \"right\" or a \"left\" hand");
    }
    if (const JsonValue mirror = value["mirror"]; mirror.exists()) {
        const std::optional<int> axis = read_axis(mirror);
        if (has_left && has_right) {
            mirror.refuse("nothing beside two hands");
        } else if (axis) {
            const std::size_t from = has_right ? 1 : 0;
            grip.hands[1 - from] = mirror_authored_hand(grip.hands[from], *axis);
            scene_grip.mirror_axis = *axis;
        }
    }
    if (const JsonValue priority = value["priority"]; priority.exists()) {
        grip.priority =
            static_cast<std::int32_t>(priority.integer(-k_max_priority, k_max_priority));
    }
    grip.snap_radius_m = value["snap_radius_m"].number_or(grip.snap_radius_m, k_snap_radius_m);
    grip.snap_angle_rad = k_degree * value["snap_angle_deg"].number_or(
                                         grip.snap_angle_rad / k_degree, k_snap_angle_deg);
    return scene_grip;
}

std::string write_scene_grip(const SceneGrip& grip) {
    GripJson json = {{"name", grip.name}};
    for (const std::size_t side : {std::size_t{1}, std::size_t{0}}) {
        const bool is_image = side == 0 && grip.mirror_axis != SceneGrip::k_no_mirror;
        if (grip.grip.hands[side].is_there && !is_image) {
            json[k_side_keys[side]] = hand_json(grip.grip.hands[side]);
        }
    }
    if (grip.mirror_axis != SceneGrip::k_no_mirror) {
        json["mirror"] = k_axes[static_cast<std::size_t>(grip.mirror_axis)];
    }
    json["priority"] = grip.grip.priority;
    json["snap_radius_m"] = grip.grip.snap_radius_m;
    json["snap_angle_deg"] = grip.grip.snap_angle_rad / k_degree;
    return json.dump(1) + "\n";
}

AuthoredGrip in_body_frame(const AuthoredGrip& grip, const Pose& frame) {
    AuthoredGrip placed = grip;
    for (AuthoredHand& hand : placed.hands) {
        hand.wrist_bs = inverse(frame) * hand.wrist_bs;
    }
    return placed;
}

}  // namespace handhold
