// Steps without what hosts draw: the simulated state and the events are those of whole steps.
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "tests/random.hpp"
#include "tests/systems/host/host_scene.hpp"

namespace handhold::host_simulated_test {
namespace {

using test::HostScene;
using test::k_step_s;

struct Heard {
    hh_event_kind kind;
    std::uint32_t body;
    std::int32_t side;
    bool operator==(const Heard&) const = default;
};

// A player who grips wall and crate, lets go, touches and pushes.
struct Script {
    HostScene scene;
    std::vector<Heard> heard;

    Script() {
        scene.add_wall();
        EXPECT_TRUE(scene.world.add(test::crate(scene.world, {-0.2, 1.4, -0.56})));
    }
    void step(bool is_shown) {
        const double t = scene.world.time_s();
        scene.closed = {std::fmod(t, 0.9) > 0.3, std::fmod(t, 0.7) > 0.2};
        scene.hand_at[1] = {0.2 + 0.1 * std::sin(3.0 * t), 1.4, -0.43 + 0.02 * std::sin(2.0 * t)};
        scene.hand_at[0].z = -0.43 + 0.1 * std::sin(1.5 * t);
        const hh::Sample now = scene.sample();
        const hh_player_input input = hh::input(scene.player, {&now, 1});
        ASSERT_TRUE(is_shown ? scene.world.step(k_step_s, input)
                             : scene.world.step_simulated(k_step_s, {&input, 1}));
        for (const hh::Event& event : scene.world.events()) {
            heard.push_back({event.kind, event.body.index, event.side});
        }
    }
};

TEST(HostSimulatedSteps, ChangeNoSimulatedBitAndNoEvent) {
    Script whole;
    Script mixed;
    test::Random random(1);
    int hidden = 0;
    bool differed = false;
    for (int i = 0; i < 360; ++i) {
        whole.step(true);
        const bool is_shown = random.between(0.0, 1.0) < 0.3;
        mixed.step(is_shown);
        hidden += is_shown ? 0 : 1;
        ASSERT_EQ(whole.scene.world.simulated_hash(), mixed.scene.world.simulated_hash()) << i;
        differed = differed || whole.scene.world.hash() != mixed.scene.world.hash();
    }
    EXPECT_GT(hidden, 200);
    EXPECT_TRUE(differed);
    EXPECT_EQ(whole.heard, mixed.heard);
    EXPECT_GT(whole.heard.size(), 10U);
}

}  // namespace
}  // namespace handhold::host_simulated_test
