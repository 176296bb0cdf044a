// Poses that the devices' runtime infers: they show hands, and neither grip nor move a player.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <handhold/handhold.hpp>
#include <rapidcheck/gtest.h>

#include "tests/random.hpp"
#include "tests/systems/host/host_scene.hpp"

namespace handhold::host_inferred_test {
namespace {

using test::distance_m;
using test::HostScene;
using test::Random;

hh::Vec3 vec(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
hh::Quat quat(const Quat& q) { return {q.x(), q.y(), q.z(), q.w()}; }

hh::Vec3 origin_of(const HostScene& scene) {
    return scene.world.pose(scene.player)->origin.position;
}

// Steps with the scene's sample, changed by `change`.
template <typename Change>
void step_with(HostScene& scene, Change&& change) {
    hh::Sample now = scene.sample();
    change(now);
    RC_ASSERT(
        static_cast<bool>(scene.world.step(test::k_step_s, hh::input(scene.player, {&now, 1}))));
}

void guess_hand(Random& random, std::size_t side, hh::Sample& sample) {
    sample.hand_inferred[side] = 1;
    sample.hand_tracked[side] =
        random.between(0.0, 1.0) < 0.5 ? 1 : 0;  // counts as inferred anyhow
    const Vec3 place = Vec3(0.0, 1.2, 0.0) + random.arm(0.05, 0.9);
    sample.hands[side] = hh::pose_at(vec(place), quat(random.rotation()));
}

// A hand holds a wall; then it is inferred, at random places for up to 2 s, and so may be the head
// and the other hand. The player does not move, the grip goes on, and once the hand is measured
// again where it is, it still does.
RC_GTEST_PROP(HostInferred, GuessesNeverMoveAPlayerWhoGrips, ()) {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    HostScene scene;
    scene.add_wall();
    scene.step(20);
    scene.closed[1] = true;
    scene.step(20);
    RC_ASSERT(scene.hand(HH_RIGHT).grip == HH_GRIP_SURFACE);
    const hh::Vec3 before = origin_of(scene);
    const bool guesses_head = *rc::gen::arbitrary<bool>();
    const bool guesses_left = *rc::gen::arbitrary<bool>();
    const int steps = static_cast<int>(random.between(1.0, 180.0));
    for (int i = 0; i < steps; ++i) {
        step_with(scene, [&](hh::Sample& sample) {
            guess_hand(random, 1, sample);
            if (guesses_left) {
                guess_hand(random, 0, sample);
            }
            if (guesses_head) {
                sample.head_inferred = 1;
                sample.head.position = vec(Vec3(0.0, 1.6, 0.0) + random.vector(1.0));
            }
        });
        RC_ASSERT(distance_m(origin_of(scene), before) < 1e-6);
        RC_ASSERT(scene.hand(HH_RIGHT).grip == HH_GRIP_SURFACE);
        RC_ASSERT(scene.hand(HH_RIGHT).is_inferred == 1);
        RC_ASSERT(scene.hand(HH_RIGHT).is_tracked == 0);
    }
    scene.step(30);
    RC_ASSERT(scene.is_good);
    RC_ASSERT(scene.hand(HH_RIGHT).grip == HH_GRIP_SURFACE);
    RC_ASSERT(scene.hand(HH_RIGHT).is_tracked == 1);
    RC_ASSERT(distance_m(origin_of(scene), before) < 1e-6);
}

// An empty inferred hand is shown where the runtime guesses it, to the step, and does not grip the
// wall before it. Measured again, it grips when it closes again.
RC_GTEST_PROP(HostInferred, GuessesShowTheEmptyHandAndDoNotGrip, ()) {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    HostScene scene;
    scene.add_wall();
    scene.step(20);
    const int steps = static_cast<int>(random.between(1.0, 100.0));
    for (int i = 0; i < steps; ++i) {
        const double x = random.between(-0.3, 0.3);
        step_with(scene, [&](hh::Sample& sample) {
            sample.hand_inferred[1] = 1;
            sample.hands[1].position.x = x;
            sample.grab[1] = 1;
        });
        RC_ASSERT(scene.hand(HH_RIGHT).grip == HH_GRIP_NONE);
        RC_ASSERT(std::abs(scene.hand(HH_RIGHT).shown.position.x - x) < 1e-9);
        RC_ASSERT(std::abs(scene.hand(HH_RIGHT).tracked.position.x - x) < 1e-9);
    }
    scene.step(30);  // open and measured
    scene.closed[1] = true;
    scene.step(5);
    RC_ASSERT(scene.hand(HH_RIGHT).grip == HH_GRIP_SURFACE);
}

// Opening the button lets go, and throws nobody.
TEST(HostInferred, TheButtonLetsGoWithoutAThrow) {
    HostScene scene;
    scene.add_wall();
    scene.step(20);
    scene.closed[1] = true;
    scene.step(20);
    Random random(4);
    for (int i = 0; i < 20; ++i) {
        hh::Sample now = scene.sample();
        guess_hand(random, 1, now);
        now.grab[1] = i < 10 ? 1 : 0;
        ASSERT_TRUE(scene.world.step(test::k_step_s, hh::input(scene.player, {&now, 1})));
    }
    EXPECT_EQ(scene.hand(HH_RIGHT).grip, HH_GRIP_NONE);
    const hh::Vec3 velocity = scene.world.pose(scene.player)->velocity_mps;
    EXPECT_LT(distance_m(velocity, {}), 1e-6);
}

// Samples that are kept ahead and worlds that are restored keep the flags and curls.
TEST(HostInferred, FlagsAndCurlsArePartOfTheState) {
    HostScene scene;
    scene.add_wall();
    scene.step(20);
    std::array<hh::Sample, 5> ahead{};
    for (std::size_t i = 0; i < ahead.size(); ++i) {
        ahead[i] = scene.sample();
        ahead[i].time_s += 0.02 * static_cast<double>(i + 1);
        ahead[i].hand_inferred[1] = 1;
        ahead[i].head_inferred = 1;
        ahead[i].hands[1].position.x = 0.25;
        ahead[i].curls[1] = {{0.1, 0.2, std::numeric_limits<double>::quiet_NaN(), -3.0, 7.0}};
    }
    ASSERT_TRUE(scene.world.step(test::k_step_s, hh::input(scene.player, {ahead.data(), 5})));
    std::vector<std::byte> saved;
    ASSERT_TRUE(scene.world.save(saved));
    std::array<std::uint64_t, 2> hashes{};
    for (std::uint64_t& hash : hashes) {
        ASSERT_EQ(hh_world_restore(scene.world.get(), saved.data(), saved.size()), HH_OK);
        for (int i = 0; i < 8; ++i) {
            ASSERT_TRUE(scene.world.step(test::k_step_s, hh::input(scene.player, {})));
        }
        EXPECT_EQ(scene.hand(HH_RIGHT).is_inferred, 1);
        EXPECT_NEAR(scene.hand(HH_RIGHT).tracked.position.x, 0.25, 1e-12);
        ASSERT_EQ(hh_world_hash(scene.world.get(), &hash), HH_OK);
    }
    EXPECT_EQ(hashes[0], hashes[1]);
}

}  // namespace
}  // namespace handhold::host_inferred_test
