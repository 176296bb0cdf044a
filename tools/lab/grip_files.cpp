#include "tools/lab/grip_files.hpp"

#include <string_view>

#include <nlohmann/json.hpp>

#include "engine/core/text_file.hpp"
#include "systems/rigs/hand_kinematics.hpp"

namespace handhold::lab {
namespace {

using Json = nlohmann::ordered_json;

constexpr double k_deg_per_rad = 57.29577951308232;

Json json_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

Json json_of(const Pose& pose) {
    const Quat& q = pose.rotation;
    return {{"position_m", json_of(pose.position)},
            {"rotation_xyzw", {q.x(), q.y(), q.z(), q.w()}}};
}

Json json_of(const std::array<double, k_max_links>& values, std::size_t count) {
    return std::vector<double>(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count));
}

const char* fallback_text(ChainFallback fallback) {
    switch (fallback) {
        case ChainFallback::none:
            return "none";
        case ChainFallback::all_cuts:
            return "bvh";
        case ChainFallback::sample_pose:
        case ChainFallback::opened:
            return "open";
        case ChainFallback::rest_pose:
            return "relaxed";
    }
    return "none";
}

Json capsule_json(std::string_view finger, std::size_t link, const Vec3& a, const Vec3& b,
                  double radius_m) {
    return {{"finger", finger},
            {"link", link},
            {"a_m", json_of(a)},
            {"b_m", json_of(b)},
            {"radius_m", radius_m}};
}

Json capsules_json(const HandRig& rig, const PosedHand& posed) {
    Json capsules = Json::array();
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        const FingerRig& finger = rig.fingers[f];
        const auto points = finger_points(finger, posed.angles[f]);
        for (std::size_t i = 0; i < finger.link_count; ++i) {
            capsules.push_back(
                capsule_json(finger_text(finger.name), i, transform_point(posed.wrist, points[i]),
                             transform_point(posed.wrist, points[i + 1]), finger.radius_m[i]));
        }
    }
    for (std::size_t i = 0; i < rig.palm.size(); ++i) {
        capsules.push_back(capsule_json("palm", i, transform_point(posed.wrist, rig.palm[i].a_hs),
                                        transform_point(posed.wrist, rig.palm[i].b_hs),
                                        rig.palm[i].radius_m));
    }
    return capsules;
}

Json fingers_json(const HandRig& rig, const PosedHand& posed) {
    Json fingers = Json::array();
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        const FingerTrace& trace = posed.traces[f];
        fingers.push_back(
            {{"name", finger_text(rig.fingers[f].name)},
             {"discs", trace.discs},
             {"visited", trace.pops},
             {"walked", trace.walked},
             {"contact_link", trace.contact_link},
             {"fallback", fallback_text(trace.fallback)},
             {"depth_mm", k_mm_per_m * trace.depth_m},
             {"curl_rad", json_of(posed.angles[f].curl_rad, rig.fingers[f].link_count)},
             {"opposition_rad", posed.angles[f].opposition_rad}});
    }
    return fingers;
}

}  // namespace

std::optional<FileError> read_json_lines(const std::filesystem::path& path,
                                         const std::function<void(const JsonValue&)>& read) {
    const Result<std::string> text = read_file(path);
    if (!text) {
        return text.error();
    }
    std::string_view rest = text.value();
    for (std::size_t line = 1; !rest.empty(); ++line) {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        const std::string_view content = rest.substr(0, end);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        if (content.find_first_not_of(" \t\r") == std::string_view::npos) {
            continue;
        }
        const std::string place = "line " + std::to_string(line);
        const Result<JsonDocument> document = JsonDocument::parse(content, path.string());
        if (!document) {
            return FileError{path.string(), place, document.error().expected};
        }
        read(document.value().root());
        if (document.value().failed()) {
            const FileError& error = document.value().error();
            return FileError{path.string(), place + error.place, error.expected};
        }
    }
    return std::nullopt;
}

Result<std::vector<Placement>> load_placements(const std::filesystem::path& path) {
    std::vector<Placement> placements;
    const auto error = read_json_lines(path, [&](const JsonValue& root) {
        Placement& placement = placements.emplace_back();
        placement.id = root["id"].integer(-(1LL << 53), 1LL << 53);
        constexpr NumberRange k_range = {-1e7, 1e7, false};
        placement.wrist.position = root["wrist"]["position_m"].vector(k_range);
        placement.wrist.rotation = root["wrist"]["rotation_xyzw"].rotation();
    });
    if (error) {
        return *error;
    }
    return placements;
}

std::string posed_hand_line(std::int64_t id, const HandRig& rig, const PosedHand& posed) {
    Json line = {{"id", id},
                 {"gripped", posed.gripped},
                 {"reason", posed.reason},
                 {"wrist", json_of(posed.wrist)},
                 {"sync_mm", k_mm_per_m * posed.sync_m},
                 {"sync_deg", k_deg_per_rad * posed.sync_rad}};
    line["surface"] = posed.gripped ? Json{{"triangle", posed.triangle},
                                           {"point_m", json_of(posed.point)},
                                           {"normal", json_of(posed.normal)}}
                                    : Json(nullptr);
    line["capsules"] = capsules_json(rig, posed);
    line["fingers"] = fingers_json(rig, posed);
    line["us"] = {{"search", posed.us.search_us},   {"palm", posed.us.palm_us},
                  {"fingers", posed.us.fingers_us}, {"fit", posed.us.fit_us},
                  {"later", posed.us.later_us},     {"total", posed.us.total_us()}};
    return line.dump() + "\n";
}

std::string warm_hands_json(const WarmHand& all) {
    const Json json = {{"moving_us", all.moving_us}, {"stand_us", all.stand_us},
                       {"pops_a_disc", all.pops},    {"joint_frames", all.joint_frames},
                       {"jumps", all.jumps},         {"shown_jumps", all.shown_jumps}};
    return json.dump() + "\n";
}

std::string hand_rig_json(const HandRig& rig) {
    Json fingers = Json::array();
    for (const FingerRig& finger : rig.fingers) {
        const std::size_t count = finger.link_count;
        fingers.push_back({{"name", finger_text(finger.name)},
                           {"link_count", count},
                           {"base_hs", json_of(finger.base_hs)},
                           {"length_m", json_of(finger.length_m, count)},
                           {"radius_m", json_of(finger.radius_m, count)},
                           {"lower_rad", json_of(finger.lower_rad, count)},
                           {"upper_rad", json_of(finger.upper_rad, count)},
                           {"relaxed_rad", json_of(finger.rest_rad, count)},
                           {"opposition_axis_hs", json_of(finger.opposition_axis_hs)},
                           {"lower_opposition_rad", finger.lower_opposition_rad},
                           {"upper_opposition_rad", finger.upper_opposition_rad}});
    }
    Json palm = Json::array();
    for (const PalmCapsule& capsule : rig.palm) {
        palm.push_back({{"a_hs", json_of(capsule.a_hs)},
                        {"b_hs", json_of(capsule.b_hs)},
                        {"radius_m", capsule.radius_m}});
    }
    const Json json = {{"side", rig.side == HandSide::left ? "left" : "right"},
                       {"palm_center_hs", json_of(rig.palm_center_hs)},
                       {"palm_normal_hs", json_of(rig.palm_normal_hs)},
                       {"fingers", fingers},
                       {"palm", palm}};
    return json.dump(1) + "\n";
}

}  // namespace handhold::lab
