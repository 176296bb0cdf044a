// Pictures of a match at another rate than the ticks'.
#include "game/view/drawn_match.hpp"

#include <gtest/gtest.h>

#include "tests/game/net/loopback_match.hpp"

namespace handhold::drawn_match_test {
namespace {

struct Pictures {
    std::size_t between_ticks = 0;  // pictures without a tick since the one before
    std::size_t moved = 0;          // of these, those in which another player's hand moved
    std::size_t bodies_missing = 0;
    double largest_step_m = 0.0;  // of that hand, from picture to picture
};

// Pictures of the first peer, as often as it looks for messages.
Pictures look_at_the_other(test::LoopbackMatch& match, double seconds) {
    const test::LoopbackPeer& peer = *match.peers[0];
    const Scene& scene = peer.scene.scene;
    const std::size_t other_slot = match.peers[1]->peer->slot();
    const std::size_t other =
        scene.world().render_pose.find_index(entity_of(peer.scene.players[other_slot]));
    Pictures pictures;
    DrawnMatch drawn;
    std::uint64_t last_tick = 0;
    std::optional<Vec3> last_ws;
    match.others = [&] {
        note_drawn(*peer.peer, scene, nullptr, drawn);
        const std::uint64_t tick = peer.peer->match().stats().tick;
        pictures.bodies_missing += drawn.visuals_ws.size() == scene.visuals.size() ? 0U : 1U;
        const RenderPose& stepped = scene.world().render_pose.elements()[other];
        const Vec3 at_ws = drawn.of(other, stepped).hands[1].shown_ws.position;
        if (last_ws) {
            const double step_m = (at_ws - *last_ws).norm();
            pictures.between_ticks += tick == last_tick ? 1U : 0U;
            pictures.moved += tick == last_tick && step_m > 1e-7 ? 1U : 0U;
            pictures.largest_step_m = std::max(pictures.largest_step_m, step_m);
        }
        last_ws = at_ws;
        last_tick = tick;
    };
    match.run(seconds);
    match.others = nullptr;
    return pictures;
}

TEST(DrawnMatch, MovesBetweenTicksAndChangesNoWorld) {
    test::LoopbackMatch match(2);
    match.add_peer(1);
    match.add_peer(2);
    ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
    match.run(1.0);
    const Pictures pictures = look_at_the_other(match, 3.0);
    EXPECT_GT(pictures.between_ticks, 100U);
    EXPECT_GT(pictures.moved, pictures.between_ticks / 4);
    EXPECT_EQ(pictures.bodies_missing, 0U);
    EXPECT_LT(pictures.largest_step_m, 0.3);
    for (const auto& peer : match.peers) {
        EXPECT_GT(peer->compared, 0U);
        EXPECT_EQ(peer->different, 0U);
    }
}

// Before the first state there is nothing to draw between.
TEST(DrawnMatch, IsEmptyBeforeTheMatch) {
    test::LoopbackMatch match(2);
    const test::LoopbackPeer& peer = match.add_peer(1);
    DrawnMatch drawn;
    note_drawn(*peer.peer, peer.scene.scene, nullptr, drawn);
    EXPECT_TRUE(drawn.visuals_ws.empty());
    for (const auto& place : drawn.players) {
        EXPECT_FALSE(place.has_value());
    }
}

}  // namespace
}  // namespace handhold::drawn_match_test
