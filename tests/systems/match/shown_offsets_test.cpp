// What hides a client's corrections from the eye.
#include <algorithm>

#include <gtest/gtest.h>

#include "tests/systems/match/match_play.hpp"

namespace handhold::match_test {
namespace {

constexpr std::size_t k_moved = 3;

// A correction that moves a player by `shift_ws`.
void correct(MatchScene& scene, ShownOffsets& shown, const Vec3& shift_ws) {
    shown.begin_correction(scene.match());
    const Entity player = find_by_id(scene.world, scene.match().players[k_moved]);
    scene.world.player_origin.at(player).pose_ws.position += shift_ws;
    shown.end_correction(scene.match());
}

TEST(ShownOffsets, DrawnPositionsDoNotJumpWhenAGuessIsCorrected) {
    MatchScene scene;
    ShownOffsets shown;
    const Vec3 shift_ws(0.1, -0.04, 0.2);
    PointsOfAll before;
    note_points(scene.match(), before);
    correct(scene, shown, shift_ws);
    PointsOfAll after;
    note_points(scene.match(), after);
    for (std::size_t slot = 0; slot < k_people; ++slot) {
        const PlayerPoints& offset = shown.offsets()[slot];
        EXPECT_LT((after[slot].head + offset.head - before[slot].head).norm(), 1e-12);
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            EXPECT_LT(
                (after[slot].hands[side] + offset.hands[side] - before[slot].hands[side]).norm(),
                1e-12);
        }
        EXPECT_EQ(offset.head.norm() > 0.0, slot == k_moved);
    }
}

TEST(ShownOffsets, ACorrectionIsShownButForATwentiethAfterItsTime) {
    MatchScene scene;
    ShownOffsets shown;
    const Vec3 shift_ws(0.0, 0.02, 0.0);
    correct(scene, shown, shift_ws);
    double last_m = shift_ws.norm();
    for (double t_s = 0.0; t_s < ShownOffsets::k_shown_correction_s; t_s += k_tick_s) {
        shown.advance(k_tick_s);
        const double now_m = shown.offsets()[k_moved].head.norm();
        EXPECT_LT(now_m, last_m);
        last_m = now_m;
    }
    EXPECT_LE(last_m, 0.05 * shift_ws.norm());
    EXPECT_GT(last_m, 0.01 * shift_ws.norm());
}

TEST(ShownOffsets, ALargeCorrectionMovesAtALimitedSpeed) {
    MatchScene scene;
    ShownOffsets shown;
    const Vec3 shift_ws(0.3, 0.0, 0.1);
    correct(scene, shown, shift_ws);
    Vec3 last = shown.offsets()[k_moved].head;
    double fastest_mps = 0.0;
    int ticks = 0;
    for (; last.norm() > 0.05 * shift_ws.norm() && ticks < 90; ++ticks) {
        shown.advance(k_tick_s);
        const Vec3 now = shown.offsets()[k_moved].head;
        EXPECT_LT(now.cross(shift_ws).norm(), 1e-12);  // straight back
        fastest_mps = std::max(fastest_mps, (now - last).norm() / k_tick_s);
        last = now;
    }
    EXPECT_NEAR(fastest_mps, ShownOffsets::k_most_mps, 1e-9);
    EXPECT_LT(ticks * k_tick_s, shift_ws.norm() / ShownOffsets::k_most_mps +
                                    2.0 * ShownOffsets::k_shown_correction_s);
}

// Two persons, the first with both hands, hold one bar, which the correction moves and turns.
TEST(ShownOffsets, HandsOnOneBodyHaveOneOffset) {
    MatchScene scene;
    const Entity bar = find_by_id(scene.world, persistent_id_from_name("bar"));
    std::size_t holding = 0;
    for (std::size_t i = 0; i < scene.world.hand_owner.size(); ++i) {
        const HandOwner& owner = scene.world.hand_owner.elements()[i];
        const bool is_second = owner.player == find_by_id(scene.world, scene.match().players[1]);
        if (is_second ? owner.side == HandSide::right
                      : owner.player == find_by_id(scene.world, scene.match().players[0])) {
            Grab& grab = scene.world.grab.at(scene.world.hand_owner.owners()[i]);
            grab.kind = GripKind::held;
            grab.body = bar;
            grab.anchor_bs.position = Vec3(0.0, 0.0, 0.2 * static_cast<double>(holding));
            ++holding;
        }
    }
    ASSERT_EQ(holding, 3U);
    ShownOffsets shown;
    for (int correction = 0; correction < 2; ++correction) {
        shown.begin_correction(scene.match());
        Pose& pose_ws = scene.world.body_pose.at(bar).pose_ws;
        pose_ws.position += Vec3(0.02, 0.0, 0.01);
        pose_ws.rotation = rotation_about(Vec3::UnitY(), 0.3) * pose_ws.rotation;
        shown.end_correction(scene.match());
        for (int tick = 0; tick < 3; ++tick) {
            const PointsOfAll& offsets = shown.offsets();
            const Vec3 first = offsets[0].hands[index_of(HandSide::left)];
            EXPECT_GT(first.norm(), 1e-3);
            EXPECT_EQ(offsets[0].hands[index_of(HandSide::right)], first);
            EXPECT_EQ(offsets[1].hands[index_of(HandSide::right)], first);
            EXPECT_EQ(offsets[1].hands[index_of(HandSide::left)], Vec3::Zero());
            shown.advance(k_tick_s);
        }
    }
}

TEST(ShownOffsets, TeleportsAreShownAtOnce) {
    MatchScene scene;
    ShownOffsets shown;
    correct(scene, shown, Vec3(ShownOffsets::k_most_m + 0.01, 0.0, 0.0));
    EXPECT_EQ(shown.offsets()[k_moved].head, Vec3::Zero());
}

// The largest motion of drawn hands in a tick is smaller than that of stepped ones, and the world
// is the same.
TEST(ShownOffsets, HandsOfOthersJumpLessOverALossyNetwork) {
    MatchPlay match({.delay_s = 0.075, .jitter_s = 0.04, .loss = 0.05}, 11);
    match.play(2.0);
    PointsOfAll stepped_before;
    PointsOfAll drawn_before;
    double stepped_m = 0.0;
    double drawn_m = 0.0;
    for (int i = 0; i < 300; ++i) {
        match.play(k_tick_s);
        auto& machine = *match.machines[0];
        PointsOfAll stepped;
        note_points(machine.scene.match(), stepped);
        const PointsOfAll& offsets = machine.session.shown_offsets();
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            const Vec3 hand = stepped[k_moved].hands[side];
            const Vec3 drawn = hand + offsets[k_moved].hands[side];
            if (i > 0) {
                stepped_m =
                    std::max(stepped_m, (hand - stepped_before[k_moved].hands[side]).norm());
                drawn_m = std::max(drawn_m, (drawn - drawn_before[k_moved].hands[side]).norm());
            }
            drawn_before[k_moved].hands[side] = drawn;
        }
        stepped_before = stepped;
    }
    EXPECT_LT(drawn_m, stepped_m);
    match.play(1.0);
    match.expect_it_happened();
}

}  // namespace
}  // namespace handhold::match_test
