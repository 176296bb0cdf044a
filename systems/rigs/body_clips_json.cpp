#include "systems/rigs/body_clips_json.hpp"

#include <vector>

#include "engine/io/json.hpp"

namespace handhold {
namespace {

constexpr std::array<std::string_view, k_clip_bones> k_bone_names = {
    "spine_0",   "spine_1",     "spine_2",    "left_thigh", "left_shin",
    "left_foot", "right_thigh", "right_shin", "right_foot", "clavicle"};
constexpr std::array<std::string_view, k_body_clip_count> k_clip_names = {
    "idle", "push_off", "look_yaw", "look_pitch", "clavicle"};
constexpr double k_max_turn_deg = 90.0;
constexpr std::size_t k_max_keys = 1000;

// True if the clip's keys in a file are in seconds, as for the first two clips. Those of the others
// are in degrees.
bool is_timed(std::size_t clip) { return clip <= static_cast<std::size_t>(BodyClipName::push_off); }

ClipKey read_key(const JsonValue& value, std::size_t clip) {
    std::vector<std::string_view> names(k_bone_names.begin(), k_bone_names.end());
    names.emplace_back("at");
    value.allow_only(names);
    ClipKey key;
    key.at = is_timed(clip) ? value["at"].number({0.0, 600.0, false})
                            : k_degree * value["at"].number({-180.0, 180.0, false});
    for (std::size_t bone = 0; bone < k_clip_bones; ++bone) {
        if (const JsonValue turn = value[k_bone_names[bone]]; turn.exists()) {
            key.turns[bone] = k_degree * turn.vector({-k_max_turn_deg, k_max_turn_deg, false});
        }
    }
    return key;
}

void read_clip(const JsonValue& value, std::size_t clip, BodyClip& out) {
    const std::vector<JsonValue> keys = value["keys"].items();
    if (keys.empty() || keys.size() > k_max_keys) {
        value.refuse("1 to 1000 keys");
        return;
    }
    for (const JsonValue& key : keys) {
        out.keys.push_back(read_key(key, clip));
        const std::size_t count = out.keys.size();
        if (count > 1 && out.keys[count - 1].at <= out.keys[count - 2].at) {
            key["at"].refuse("more than the key before");
        }
    }
    if (is_timed(clip) && out.keys.front().at != 0.0) {
        value.refuse("a first key at 0");
    }
}

void read_reach(const JsonValue& value, BodyClips& out) {
    for (const JsonValue& row : value.optional_items()) {
        row.allow_only({"distance", "weight"});
        const ClavicleReach reach{row["distance"].number({0.0, 10.0, false}),
                                  row["weight"].number({-10.0, 10.0, false})};
        if (!out.reach.empty() && reach.distance <= out.reach.back().distance) {
            row.refuse("a distance above the one before");
        }
        out.reach.push_back(reach);
    }
}

}  // namespace

Result<BodyClips> parse_body_clips(std::string_view text, const std::string& file) {
    Result<JsonDocument> document = JsonDocument::parse(text, file);
    if (!document) {
        return document.error();
    }
    const JsonValue root = document.value().root();
    root.allow_only(k_clip_names);
    BodyClips clips;
    for (std::size_t i = 0; i < k_body_clip_count; ++i) {
        const JsonValue value = root[k_clip_names[i]];
        if (!value.exists()) {
            continue;
        }
        if (i == static_cast<std::size_t>(BodyClipName::clavicle)) {
            value.allow_only({"keys", "reach"});
            read_reach(value["reach"], clips);
        } else {
            value.allow_only({"keys"});
        }
        read_clip(value, i, clips.clips[i]);
        const std::vector<ClipKey>& keys = clips.clips[i].keys;
        const bool comes_round = i == static_cast<std::size_t>(BodyClipName::idle);
        if (comes_round && !keys.empty() && keys.front().turns != keys.back().turns) {
            value["keys"].refuse("a last key that is the first once more");
        }
    }
    if (document.value().failed()) {
        return document.value().error();
    }
    return clips;
}

}  // namespace handhold
