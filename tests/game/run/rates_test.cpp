// One session at several frame rates: paths on a single support without contacts depend neither on
// the frame rate nor on dropped frames. Expected values come from a much higher rate; the limits
// are the design's: 5 mm and 1 % of the distance drifted.
#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "game/climber/climber_session.hpp"
#include "game/scene/random.hpp"
#include "game/session/playback.hpp"
#include "tests/game/climber/climber_scene.hpp"

namespace handhold::rates_test {
namespace {

constexpr double k_compare_hz = 6.0;  // divides every rate
constexpr double k_seconds = 20.0;
constexpr hh::Pose k_start = hh::pose_at({-0.3, -1.4, 4.0});

struct Path {
    std::vector<std::optional<Vec3>>
        origins_ws;  // by k_compare_hz; empty where the frame was dropped
    std::vector<double> drifted_m;
    bool collided = false;
};

// drop(frame) leaves that frame out; the next one is longer.
Path play(const Recording& recording, double hz, const std::function<bool(int)>& drop) {
    Scene scene = make_tunnel(6.0);
    const hh::Player player = add_scene_player(scene, "player0", k_start);
    Playback playback(recording);
    Path path;
    Vec3 before = from_host(k_start.position);
    double drifted_m = 0.0;
    const int stride = static_cast<int>(hz / k_compare_hz + 0.5);
    for (int frame = 1; frame <= static_cast<int>(k_seconds * hz); ++frame) {
        const bool dropped = drop(frame);
        if (!dropped) {
            const double end_s = frame / hz;
            const double dt_s = end_s - scene.host.time_s();
            hh_player_input input = hh::input(player, playback.window(end_s));
            input.repeats_samples = true;
            EXPECT_TRUE(scene.host.step(dt_s, input));
            const StageStats& stats = scene.stats();
            path.collided = path.collided || stats.contacts > 0;
        }
        const Vec3 origin_ws = scene.world().player_origin.at(entity_of(player)).pose_ws.position;
        const RenderPose& render = scene.world().render_pose.at(entity_of(player));
        const bool grips =
            render.hands[0].grip != GripKind::none || render.hands[1].grip != GripKind::none;
        drifted_m += grips ? 0.0 : (origin_ws - before).norm();
        before = origin_ws;
        if (frame % stride == 0) {
            path.origins_ws.push_back(dropped ? std::nullopt : std::optional(origin_ws));
            path.drifted_m.push_back(drifted_m);
        }
    }
    return path;
}

Recording record(std::uint64_t seed) {
    Scene scene = make_tunnel(6.0);
    ClimbPlan plan;
    plan.origin_ws = k_start;
    plan.seconds = k_seconds + 0.5;
    plan.single_hand = true;
    plan.seed = seed;
    return record_climb(scene, plan);
}

// Fails if a path leaves the expected one. Returns the largest distance, metres.
double compare(const Path& path, const Path& expected, const std::string& what) {
    EXPECT_FALSE(path.collided) << what;
    double worst_m = 0.0;
    for (std::size_t i = 0; i < expected.origins_ws.size(); ++i) {
        if (!path.origins_ws[i]) {
            continue;
        }
        const double off_m = (*path.origins_ws[i] - *expected.origins_ws[i]).norm();
        worst_m = std::max(worst_m, off_m);
        EXPECT_LE(off_m, 0.005 + 0.01 * expected.drifted_m[i])
            << what << " at " << static_cast<double>(i + 1) / k_compare_hz << " s";
    }
    return worst_m;
}

TEST(SessionRates, SingleSupportPathsAgree) {
    const auto keep_all = [](int) { return false; };
    int sessions = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const Recording recording = record(seed);
        const Path expected = play(recording, 720.0, keep_all);
        if (expected.collided) {
            continue;  // contacts of the head are excluded
        }
        ++sessions;
        double worst_m = 0.0;
        for (const double hz : {60.0, 72.0, 90.0, 120.0, 144.0}) {
            const std::string what =
                "climber " + std::to_string(seed) + " at " + std::to_string(hz) + " Hz";
            worst_m = std::max(worst_m, compare(play(recording, hz, keep_all), expected, what));
            Random chance(seed);
            const Path dropped = play(recording, hz, [&chance](int) { return chance.chance(0.1); });
            worst_m = std::max(worst_m, compare(dropped, expected, what + ", a tenth dropped"));
        }
        std::printf("climber %d: at most %.2f mm off after %.2f m of drift\n",
                    static_cast<int>(seed), 1e3 * worst_m, expected.drifted_m.back());
    }
    EXPECT_GE(sessions, 4);
}

}  // namespace
}  // namespace handhold::rates_test
