#include "game/play/play_tally.hpp"

#include <cstdio>

#include <handhold/math.hpp>
#include <nlohmann/json.hpp>

#include "game/report/run_summary.hpp"

namespace handhold {
namespace {

using Json = nlohmann::ordered_json;

Json times(const std::vector<double>& times_us) {
    const TimeFigures figures = summarize_times(times_us);
    return {{"median", figures.median_us},
            {"p99", figures.p99_us},
            {"max", figures.max_us},
            {"count", times_us.size()}};
}

Json numbers(const hh::Vec3& v) { return Json::array({v.x, v.y, v.z}); }

const char* name_of_grip(hh_grip_kind kind) {
    switch (kind) {
        case HH_GRIP_NONE:
            return "none";
        case HH_GRIP_SURFACE:
            return "surface";
        case HH_GRIP_HELD:
            return "held";
        case HH_GRIP_AUTHORED:
            return "authored";
        case HH_GRIP_PLAYER:
            return "player";
        case HH_GRIP_KIND_32_BITS:
            break;
    }
    return "unknown";
}

}  // namespace

// Counts grips and hand changes. In a hand change, one hand grips while the other still holds.
// Flying from grip to grip is not a hand change.
void PlayTally::add_grips(const hh::World& world, hh::Player player) {
    const std::array<bool, 2> before = grips_;
    for (const hh::Side side : {HH_LEFT, HH_RIGHT}) {
        grips_[side] = world.moves_player(player, side);
    }
    for (std::size_t side = 0; side < 2; ++side) {
        if (!grips_[side] || before[side]) {
            continue;
        }
        ++figures_.grips;
        if (before[1 - side] && last_hand_ == 1 - side) {
            ++figures_.hand_changes;
        }
        last_hand_ = side;
    }
}

void PlayTally::add_frame(const hh::World& world, hh::Player player, double runtime_us,
                          double dt_s) {
    const hh::Vec3 origin_ws = world.pose(player)->origin.position;
    if (!start_ws_) {
        start_ws_ = last_ws_ = origin_ws;
    }
    add_grips(world, player);
    const double step_m = hh::length(origin_ws - last_ws_ - dt_s * world.reference_velocity_mps());
    const bool is_first = figures_.frames == 0;
    figures_.path_m += is_first ? 0.0 : step_m;
    figures_.climbed_m += !is_first && (grips_[0] || grips_[1]) ? step_m : 0.0;
    figures_.moved_m = origin_ws - *start_ws_;
    last_ws_ = origin_ws;
    ++figures_.frames;
    figures_.played_s += dt_s;
    const hh_world_stats stats = *world.stats();
    figures_.hands_closed += stats.hands_closed;
    figures_.hands_gripped += stats.hands_gripped;
    const std::vector<std::uint64_t> fallbacks = world.fallbacks();
    figures_.fallbacks.resize(fallbacks.size());
    for (std::size_t i = 0; i < fallbacks.size(); ++i) {
        figures_.fallbacks[i] += fallbacks[i];
    }
    runtime_us_.push_back(runtime_us);
}

void PlayTally::add_picture(double draw_us, double show_us) {
    draw_us_.push_back(draw_us);
    show_us_.push_back(show_us);
}

std::string PlayTally::report_json(const std::string& scene, const std::string& state_hash) const {
    Json report;
    report["scene"] = scene;
    report["played_s"] = figures_.played_s;
    report["frames"] = figures_.frames;
    report["path_m"] = figures_.path_m;
    report["climbed_m"] = figures_.climbed_m;
    report["moved_m"] = numbers(figures_.moved_m);
    report["grips"] = figures_.grips;
    report["hand_changes"] = figures_.hand_changes;
    report["grabs"] = {{"onsets", figures_.hands_closed}, {"gripped", figures_.hands_gripped}};
    report["times_us"] = {{"runtime_frame", times(runtime_us_)},
                          {"draw_picture", times(draw_us_)},
                          {"show_picture", times(show_us_)}};
    Json& fallbacks = report["fallbacks"] = Json::object();
    for (std::size_t i = 0; i < figures_.fallbacks.size(); ++i) {
        if (const std::uint64_t count = figures_.fallbacks[i]; count != 0) {
            fallbacks[hh_fallback_name(i)] = count;
        }
    }
    report["state_hash"] = state_hash;
    return report.dump(1) + "\n";
}

std::string PlayTally::summary() const {
    const TimeFigures runtime = summarize_times(runtime_us_);
    const TimeFigures draw = summarize_times(draw_us_);
    const TimeFigures show = summarize_times(show_us_);
    char text[400];
    std::snprintf(text, sizeof text,
                  "%.1f s played: %.2f m, of which %.2f m climbed, with %llu grips, %llu of them "
                  "hand over hand\n"
                  "cost, median (p99): runtime %.2f (%.2f) ms a frame; drawing %.1f (%.1f) ms and "
                  "showing %.1f (%.1f) ms a picture\n",
                  figures_.played_s, figures_.path_m, figures_.climbed_m,
                  static_cast<unsigned long long>(figures_.grips),
                  static_cast<unsigned long long>(figures_.hand_changes), 1e-3 * runtime.median_us,
                  1e-3 * runtime.p99_us, 1e-3 * draw.median_us, 1e-3 * draw.p99_us,
                  1e-3 * show.median_us, 1e-3 * show.p99_us);
    return text;
}

namespace {

void add_place(const char* name, const std::optional<hh::Pose>& pose, Json& to) {
    to[name] = pose ? numbers(pose->position) : Json();
}

void add_headset(const HeadsetFigures& headset, Json& to) {
    to["focus"] = headset.has_focus;
    to["panel"] = headset.shows_panel;
    to["losses"] = headset.losses;
    to["pictures"] = headset.pictures;
    add_place("head_m", headset.reading.head_ps, to);
    for (std::size_t side = 0; side < 2; ++side) {
        const HandReading& hand = headset.reading.hands[side];
        Json& seen = to[side == 0 ? "left" : "right"];
        add_place("grip_m", hand.grip_ps, seen);
        add_place("aim_m", hand.aim_ps, seen);
        add_place("palm_m", hand.palm_ps, seen);
        add_place("wrist_m", hand.wrist_ps, seen);
        seen["curl"] = hand.curl;
        seen["squeeze"] = hand.squeeze;
        seen["trigger"] = hand.trigger;
        seen["stick"] = {hand.stick[0], hand.stick[1]};
        seen["shakes"] = headset.shakes[side];
    }
}

}  // namespace

std::string status_line(const hh::World& world, hh::Player player, const PlayFigures& figures,
                        bool can_reach, const HeadsetFigures* headset) {
    const hh_player_pose pose = *world.pose(player);
    Json line;
    line["t_s"] = world.time_s();
    line["head_m"] = numbers(pose.head.position);
    line["looks"] = numbers(pose.head.rotation * -hh::k_z);
    line["can_reach"] = can_reach;
    for (const hh::Side side : {HH_LEFT, HH_RIGHT}) {
        line[side == HH_LEFT ? "left" : "right"] = {
            {"grip", name_of_grip(pose.hands[side].grip)},
            {"hand_m", numbers(pose.hands[side].shown.position)}};
    }
    line["climbed_m"] = figures.climbed_m;
    line["hand_changes"] = figures.hand_changes;
    if (headset != nullptr) {
        add_headset(*headset, line["headset"]);
    }
    return line.dump() + "\n";
}

}  // namespace handhold
