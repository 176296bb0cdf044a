#include "game/play/play_tally.hpp"

#include <cstdio>

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

Json numbers(const Vec3& v) { return Json::array({v.x(), v.y(), v.z()}); }

const char* name_of_grip(GripKind kind) {
    switch (kind) {
        case GripKind::none:
            return "none";
        case GripKind::surface:
            return "surface";
        case GripKind::held:
            return "held";
        case GripKind::authored:
            return "authored";
        case GripKind::player:
            return "player";
    }
    return "unknown";
}

}  // namespace

// Counts grips and hand changes. In a hand change, one hand grips while the other still holds.
// Flying from grip to grip is not a hand change.
void PlayTally::add_grips(const World& world, const PlayerEntities& player) {
    const std::array<bool, k_hand_count> before = grips_;
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        grips_[side] = world.grab.at(player.hands[side]).kind == GripKind::surface;
    }
    for (std::size_t side = 0; side < k_hand_count; ++side) {
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

void PlayTally::add_frame(const World& world, const PlayerEntities& player, const StageStats& stats,
                          double runtime_us, double dt_s) {
    const Vec3 origin_ws = world.player_origin.at(player.player).pose_ws.position;
    if (!start_ws_) {
        start_ws_ = last_ws_ = origin_ws;
    }
    add_grips(world, player);
    const double step_m = (origin_ws - last_ws_ - dt_s * world.reference_velocity_mps).norm();
    const bool is_first = figures_.frames == 0;
    figures_.path_m += is_first ? 0.0 : step_m;
    figures_.climbed_m += !is_first && (grips_[0] || grips_[1]) ? step_m : 0.0;
    figures_.moved_m = origin_ws - *start_ws_;
    last_ws_ = origin_ws;
    ++figures_.frames;
    figures_.played_s += dt_s;
    figures_.totals.grab_onsets += stats.grab_onsets;
    figures_.totals.grabs_gripped += stats.grabs_gripped;
    for (std::size_t i = 0; i < stats.fallbacks.size(); ++i) {
        figures_.totals.fallbacks[i] += stats.fallbacks[i];
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
    report["grabs"] = {{"onsets", figures_.totals.grab_onsets},
                       {"gripped", figures_.totals.grabs_gripped}};
    report["times_us"] = {{"runtime_frame", times(runtime_us_)},
                          {"draw_picture", times(draw_us_)},
                          {"show_picture", times(show_us_)}};
    Json& fallbacks = report["fallbacks"] = Json::object();
    for (std::size_t i = 0; i < figures_.totals.fallbacks.size(); ++i) {
        if (const std::uint64_t count = figures_.totals.fallbacks[i]; count != 0) {
            fallbacks[name_of(static_cast<Fallback>(i))] = count;
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

void add_place(const char* name, const std::optional<Pose>& pose, Json& to) {
    to[name] = pose ? numbers(pose->position) : Json();
}

void add_headset(const HeadsetFigures& headset, Json& to) {
    to["focus"] = headset.has_focus;
    to["panel"] = headset.shows_panel;
    to["losses"] = headset.losses;
    to["pictures"] = headset.pictures;
    add_place("head_m", headset.reading.head_ps, to);
    for (std::size_t side = 0; side < k_hand_count; ++side) {
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

std::string status_line(const World& world, const PlayerEntities& player,
                        const PlayFigures& figures, bool can_reach, const HeadsetFigures* headset) {
    const RenderPose& render = world.render_pose.at(player.player);
    Json line;
    line["t_s"] = world.clock.t_s;
    line["head_m"] = numbers(render.head_ws.position);
    line["looks"] = numbers(render.head_ws.rotation * -Vec3::UnitZ());
    line["can_reach"] = can_reach;
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        const RenderPose::Hand& hand = render.hands[side];
        line[side == 0 ? "left" : "right"] = {{"grip", name_of_grip(hand.grip)},
                                              {"hand_m", numbers(hand.shown_ws.position)}};
    }
    line["climbed_m"] = figures.climbed_m;
    line["hand_changes"] = figures.hand_changes;
    if (headset != nullptr) {
        add_headset(*headset, line["headset"]);
    }
    return line.dump() + "\n";
}

}  // namespace handhold
