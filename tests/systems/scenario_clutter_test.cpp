// A tool dragged through clutter by a hand that jumps: what contacts cannot all be met, overlaps
// nothing in the end.
#include <gtest/gtest.h>

#include "scenario.hpp"
#include "tests/engine/collision_scene.hpp"

namespace handhold {
namespace {

using test::Random;

struct ClutterResult {
    double worst_overlap_m = 0.0;
    int frames_held = 0;
    std::uint64_t put_back = 0;
};

// Eighty boxes around a tool of 30 cm, and a hand that is somewhere else, up to half a metre away
// and turned by up to 100 degrees, ten times a second.
ClutterResult drag_through_clutter(std::uint64_t seed) {
    Random random(seed);
    Scenario s;
    const Vec3 palm(0.3, 1.2, -0.5);
    const Vec3 half_m(0.02, 0.02, 0.15);
    const Entity tool = s.add_crate("tool", 3.0, palm - Vec3(0.0, half_m.y(), 0.0), half_m);
    for (int i = 0; i < 80; ++i) {
        const Vec3 half(random.between(0.02, 0.12), random.between(0.02, 0.12),
                        random.between(0.02, 0.12));
        const Vec3 center = palm + random.direction() * random.between(0.35, 0.7);
        s.add("thing" + std::to_string(i), {}, s.shapes.add_box(half), {center, random.rotation()});
    }
    // The other hand holds on: the player cannot be pushed out of it all.
    const Vec3 other_palm(-0.3, 1.2, 0.3);
    s.add_wall("bar", Vec3(0.3, 0.02, 0.02), other_palm - Vec3(0.0, 0.025, 0.0));
    s.script.hands[0] = [other = hand_for_palm(s, other_palm)](double) {
        return Pose{other, Quat::Identity()};
    };
    s.script.grabs[0] = [](double t) { return t > 0.05; };
    s.add_player_here();
    const Vec3 hand = hand_for_palm(s, palm);
    std::vector<Pose> jumps;
    for (int i = 0; i < 40; ++i) {
        jumps.push_back({hand + random.vector(0.3), rotation_from_vector(random.vector(1.0))});
    }
    s.script.grabs[1] = [](double t) { return t > 0.05; };
    s.script.hands[1] = [=](double t) {
        const auto jump = static_cast<std::size_t>(std::max(0.0, (t - 0.1) * 10.0));
        return t < 0.2 ? Pose{hand, Quat::Identity()} : jumps[jump % jumps.size()];
    };
    ClutterResult result;
    s.run(4.0, [&] {
        result.worst_overlap_m = std::max(result.worst_overlap_m, s.stats.residual_m);
        result.frames_held += s.grab(HandSide::right).body == tool ? 1 : 0;
        result.put_back += s.fallbacks(Fallback::put_back);
    });
    return result;
}

TEST(Clutter, ToolOfAJumpingHandIsSunkIntoNothing) {
    std::uint64_t put_back = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        const ClutterResult result = drag_through_clutter(seed);
        EXPECT_LT(result.worst_overlap_m, 2e-4) << seed;
        EXPECT_GT(result.frames_held, 20) << seed;
        put_back += result.put_back;
    }
    EXPECT_GT(put_back, 0U);  // in 1 frame of 300
}

}  // namespace
}  // namespace handhold
