#include "game/commands/shot_list.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "engine/core/text_file.hpp"
#include "engine/io/json.hpp"
#include "game/levels/built_in_scenes.hpp"

namespace handhold {
namespace {

constexpr std::array<std::pair<std::string_view, ShotView>, 10> k_views = {
    {{"eyes", ShotView::eyes},
     {"gaze", ShotView::gaze},
     {"behind", ShotView::behind},
     {"before", ShotView::before},
     {"hand", ShotView::hand},
     {"chest", ShotView::chest},
     {"pelvis", ShotView::pelvis},
     {"player", ShotView::player},
     {"body", ShotView::body},
     {"place", ShotView::place}}};

ShotView read_view(const JsonValue& value) {
    const std::string name = value.text();
    const auto* const found = std::ranges::find(
        k_views, name, [](const auto& known) { return std::string(known.first); });
    if (found == k_views.end()) {
        value.refuse("eyes, behind, before, hand, chest, pelvis, player, body or place");
        return ShotView::eyes;
    }
    return found->second;
}

// Reads names of gizmos, as in the inspector, or "all".
void read_gizmos(const JsonValue& list, GizmoSet& gizmos) {
    for (const JsonValue& item : list.optional_items()) {
        const std::string name = item.text();
        bool is_known = name == "all";
        for (std::size_t i = 0; i < gizmos.size(); ++i) {
            const bool is_it = name == info_of(static_cast<Gizmo>(i)).name;
            gizmos[i] = gizmos[i] || is_it || name == "all";
            is_known = is_known || is_it;
        }
        if (!is_known) {
            item.refuse("a gizmo's name, or all");
        }
    }
}

// True if the name has only lower-case letters, digits and underscores.
bool is_plain_name(const std::string& name) {
    return std::ranges::all_of(name, [](char letter) {
        return (letter >= 'a' && letter <= 'z') || (letter >= '0' && letter <= '9') ||
               letter == '_';
    });
}

Shot read_shot(const JsonValue& value) {
    value.allow_only({"name", "scene", "caption", "at_s", "until_s", "view", "side", "body",
                      "from_m", "target_m", "free", "fov_deg", "marks", "through", "gizmos"});
    Shot shot;
    shot.name = value["name"].text();
    if (!is_plain_name(shot.name)) {
        value["name"].refuse("small letters, digits and _");
    }
    shot.scene = value["scene"].text();
    shot.caption = value["caption"].text_or("");
    shot.at_s = value["at_s"].number({0.0, 1e5});
    shot.until_s = value["until_s"].number_or(shot.at_s, {shot.at_s, 1e5});
    shot.view = value["view"].exists() ? read_view(value["view"]) : ShotView::eyes;
    const std::string side = value["side"].text_or("right");
    if (side != "right" && side != "left") {
        value["side"].refuse("right or left");
    }
    shot.side = side == "left" ? HandSide::left : HandSide::right;
    shot.body = value["body"].text_or("");
    if (shot.body.empty() && (shot.view == ShotView::body || shot.view == ShotView::player)) {
        value.refuse("a \"body\" that the view looks at");
    }
    shot.from_m = value["from_m"].vector_or(shot.from_m, {-1e4, 1e4});
    shot.target_m = value["target_m"].vector_or(shot.target_m, {-1e4, 1e4});
    shot.free = value["free"].flag_or(shot.free);
    shot.fov_deg = value["fov_deg"].number_or(shot.fov_deg, {5.0, 130.0});
    shot.marks = value["marks"].flag_or(shot.marks);
    shot.through = value["through"].number_or(shot.through, k_unit_interval);
    read_gizmos(value["gizmos"], shot.gizmos);
    return shot;
}

// True if two clips of one scene overlap: only one clip is drawn at a time.
bool overlap(const Shot& a, const Shot& b) {
    return a.scene == b.scene && a.at_s < b.until_s && b.at_s < a.until_s;
}

// True if the scene exists. A list covers many scenes, so nobody would notice that the shots of a
// misspelt scene are missing.
bool is_scene(const std::string& scene) {
    const std::vector<std::string_view> built_in = built_in_scenes();
    std::error_code ignored;
    return std::ranges::find(built_in, scene) != built_in.end() ||
           std::filesystem::is_regular_file(scene, ignored);
}

}  // namespace

Result<std::vector<Shot>> parse_shots(std::string_view text, const std::string& file) {
    const Result<JsonDocument> document = JsonDocument::parse(text, file);
    if (!document) {
        return document.error();
    }
    const JsonValue root = document.value().root();
    root.allow_only({"shots"});
    std::vector<Shot> shots;
    std::set<std::string> names;
    for (const JsonValue& value : root["shots"].items()) {
        const Shot shot = read_shot(value);
        if (std::ranges::any_of(shots, [&](const Shot& other) { return overlap(shot, other); })) {
            value["at_s"].refuse("a time outside the scene's other clips");
        }
        shots.push_back(shot);
        shots.back().number = shots.size() - 1;
        if (!names.insert(shots.back().name).second) {
            value["name"].refuse("a name that no other shot has");
        }
    }
    if (document.value().failed()) {
        return document.value().error();
    }
    return shots;
}

Result<std::vector<Shot>> load_shots(const std::filesystem::path& file) {
    const Result<std::string> text = read_file(file);
    if (!text) {
        return text.error();
    }
    Result<std::vector<Shot>> shots = parse_shots(text.value(), file.string());
    if (shots) {
        const auto lost = std::ranges::find_if_not(shots.value(), is_scene, &Shot::scene);
        if (lost != shots.value().end()) {
            return FileError{
                file.string(), "/shots/" + std::to_string(lost->number) + "/scene",
                "expected a built-in scene or a file that is there, found \"" + lost->scene + "\""};
        }
    }
    return shots;
}

}  // namespace handhold
