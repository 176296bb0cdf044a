#include "game/devices/controller_profile.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include "game/session/hand_pose.hpp"

namespace handhold {
namespace {

constexpr std::array<const char*, 2> k_controller_sides = {"left", "right"};

constexpr double k_near_m = 1.0;

// The palm's centre by the default tuning.
hh::Vec3 default_palm_center_m() { return hand_shape(hh::World()).palm_center_m; }

hh::Pose read_joint(const JsonValue& value, hh::Side side) {
    const JsonValue hand = value["hand"];
    const JsonValue handle = value["handle"];
    if (hand.exists() == handle.exists()) {
        value.refuse("either \"hand\" or \"handle\"");
    }
    if (hand.exists()) {
        return read_pose(hand, k_near_m);
    }
    handle.allow_only({"radius_m", "slant_rad", "along_m"});
    HandleGrip grip;
    grip.radius_m = handle["radius_m"].number_or(grip.radius_m, {0.0, 0.1, false});
    grip.slant_rad = handle["slant_rad"].number_or(grip.slant_rad, {-1.6, 1.6, false});
    grip.along_m = handle["along_m"].number_or(grip.along_m, {-0.2, 0.2, false});
    return hh::inverse(handle_in_hand(side, grip, default_palm_center_m()));
}

constexpr std::array<const char*, k_control_count> k_control_names = {
    "trigger", "squeeze", "stick_x", "stick_y", "lower_button", "upper_button"};

ControlledNode read_control(const JsonValue& value) {
    value.allow_only({"control", "node", "from", "to"});
    const std::string name = value["control"].text();
    const auto* const known = std::ranges::find(k_control_names, name);
    if (known == k_control_names.end()) {
        value["control"].refuse("trigger, squeeze, stick_x, stick_y, lower_button or upper_button");
        return {};
    }
    return {static_cast<Control>(known - k_control_names.begin()), value["node"].text(),
            value["from"].text(), value["to"].text()};
}

ControllerSide read_own_side(const JsonValue& value, hh::Side side,
                             const std::filesystem::path& folder) {
    value.allow_only({"model", "grip", "aim", "hand", "handle", "controls"});
    ControllerSide made;
    made.model = folder / value["model"].text();
    made.fit.grip_ms = read_pose(value["grip"], k_near_m);
    made.fit.aim_ms = value["aim"].exists() ? read_pose(value["aim"], k_near_m) : made.fit.grip_ms;
    made.fit.hand_in_grip = read_joint(value, side);
    for (const JsonValue& control : value["controls"].optional_items()) {
        made.controls.push_back(read_control(control));
    }
    return made;
}

// True if the layout `key` of a WebXR profile is for `side`. Keys are "left", "right", "none", or
// several of them joined by hyphens.
bool is_layout_of(std::string_view key, std::string_view side) {
    while (!key.empty()) {
        const std::size_t end = std::min(key.find('-'), key.size());
        if (key.substr(0, end) == side) {
            return true;
        }
        key.remove_prefix(std::min(end + 1, key.size()));
    }
    return false;
}

// The control of a component's property. None for properties without a reading: touches, stick
// clicks.
std::optional<Control> webxr_control(const std::string& component, const std::string& property,
                                     bool has_stick) {
    const bool is_stick = component == "xr-standard-thumbstick";
    const bool is_pad = component == "xr-standard-touchpad";
    if (is_stick || (is_pad && !has_stick)) {
        if (property == "xAxis") {
            return Control::stick_x;
        }
        if (property == "yAxis") {
            return Control::stick_y;
        }
    }
    constexpr std::array<std::pair<const char*, Control>, 8> k_buttons = {
        {{"xr-standard-trigger", Control::trigger},
         {"xr-standard-squeeze", Control::squeeze},
         {"xr-standard-touchpad", Control::lower_button},
         {"x-button", Control::lower_button},
         {"a-button", Control::lower_button},
         {"y-button", Control::upper_button},
         {"b-button", Control::upper_button},
         {"menu", Control::upper_button}}};
    for (const auto& [name, control] : k_buttons) {
        const bool is_menu_of_its_own =
            component == "menu" && has_stick;  // a controller with a stick has Y or B
        if (property == "button" && component == name && !is_menu_of_its_own) {
            return control;
        }
    }
    return std::nullopt;
}

std::vector<ControlledNode> read_webxr_controls(const JsonValue& components) {
    std::vector<ControlledNode> controls;
    const bool has_stick = components.exists() && components["xr-standard-thumbstick"].exists();
    for (const auto& [component, value] : components.optional_members()) {
        for (const auto& [name, response] : value["visualResponses"].optional_members()) {
            const std::optional<Control> control =
                webxr_control(component, response["componentProperty"].text_or(""), has_stick);
            if (control && response["valueNodeProperty"].text_or("") == "transform") {
                controls.push_back({*control, response["valueNodeName"].text(),
                                    response["minNodeName"].text(),
                                    response["maxNodeName"].text()});
            }
        }
    }
    return controls;
}

ControllerSide read_webxr_side(const JsonValue& layouts, hh::Side side,
                               const std::filesystem::path& folder) {
    constexpr std::array<const char*, 5> k_keys = {"left", "right", "left-right", "right-left",
                                                   "left-right-none"};
    const char* const name = k_controller_sides[side];
    ControllerSide made;
    made.fit.hand_in_grip = hh::inverse(handle_in_hand(side, {}, default_palm_center_m()));
    for (const char* key : k_keys) {
        if (is_layout_of(key, name) && layouts[key].exists()) {
            made.model = folder / layouts[key]["assetPath"].text();
            made.controls = read_webxr_controls(layouts[key]["components"]);
            return made;
        }
    }
    layouts.refuse("a layout for the " + std::string(name) + " hand");
    return made;
}

}  // namespace

hh::Pose controller_in_hand(const ControllerFit& fit) {
    return hh::inverse(fit.grip_ms * fit.hand_in_grip);
}

hh::Pose handle_in_hand(hh::Side side, const HandleGrip& handle, hh::Vec3 palm_center_m) {
    // Right hand: the palm faces down, the thumb is on the left.
    double sine = 0.0;
    double cosine = 1.0;
    hh_sin_cos(handle.slant_rad, &sine, &cosine);
    const hh::Vec3 to_thumb = -cosine * hh::k_x - sine * hh::k_z;
    const hh::Vec3 z = -to_thumb;
    const hh::Quat rotation =
        hh::normalized(hh::rotation_from_axes(hh::k_y, hh::cross(z, hh::k_y), z));
    const hh::Vec3 at = palm_center_m - handle.radius_m * hh::k_y + handle.along_m * to_thumb;
    if (side == HH_RIGHT) {
        return {at, rotation};
    }
    return {{-at.x, at.y, at.z}, {rotation.x, -rotation.y, -rotation.z, rotation.w}};
}

Result<ControllerProfile> parse_controller_profile(std::string_view text,
                                                   const std::filesystem::path& file) {
    const Result<JsonDocument> document = JsonDocument::parse(text, file.string());
    if (!document) {
        return document.error();
    }
    const JsonValue root = document.value().root();
    const std::filesystem::path folder = file.parent_path();
    const bool is_webxr = root["profileId"].exists();
    ControllerProfile profile;
    profile.name = root[is_webxr ? "profileId" : "name"].text();
    if (!is_webxr) {
        root.allow_only({"name", "left", "right"});
    }
    for (const hh::Side side : {HH_LEFT, HH_RIGHT}) {
        profile.sides[side] = is_webxr
                                  ? read_webxr_side(root["layouts"], side, folder)
                                  : read_own_side(root[k_controller_sides[side]], side, folder);
    }
    if (document.value().failed()) {
        return document.value().error();
    }
    return profile;
}

void set_controller_joints(const std::array<hh::Pose, 2>& hand_in_grip, hh::World& world) {
    for (const hh::Player player : world.players()) {
        for (const hh::Side side : {HH_LEFT, HH_RIGHT}) {
            if (!world.set_hand_in_controller(player, side, hand_in_grip[side])) {
                throw std::invalid_argument("a controller's joint is no pose near it");
            }
        }
    }
}

}  // namespace handhold
