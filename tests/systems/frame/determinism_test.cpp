// The columns are the whole state: frames are equal for any number of threads, in any run, without
// caches, after a rollback, and in any order of creation.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "engine/core/parallel.hpp"
#include "systems/snapshot/snapshot.hpp"
#include "tests/systems/frame/crowd.hpp"

namespace handhold::determinism_test {
namespace {

using test::Crowd;
using test::Random;
using Hashes = std::vector<std::uint64_t>;

// The scene compared below does exercise the runtime.
TEST(Crowd, GripsThrowsPushesAndTouches) {
    Crowd crowd;
    std::uint64_t contacts = 0;
    std::uint64_t pushed = 0;
    std::uint64_t two_hands = 0;
    std::uint64_t grips = 0;
    std::uint64_t islands = 0;
    crowd.run(Crowd::k_frames, [&](int) {
        contacts += crowd.stats.contacts;
        pushed += crowd.stats.islands_pushed;
        two_hands += crowd.stats.fallbacks[static_cast<std::size_t>(Fallback::two_hand_grip_ended)];
        grips += crowd.stats.grabs_gripped;
        islands = std::max(islands, crowd.stats.islands);
    });
    EXPECT_EQ(grips, 6U);  // three players, two hands each
    EXPECT_GT(contacts, 200U);
    EXPECT_GT(pushed, 10U);
    EXPECT_GE(two_hands, 2U);
    EXPECT_GE(islands, 8U);  // enough islands for eight threads
    const Entity rock = find_by_id(crowd.world, persistent_id_from_name("rock"));
    EXPECT_GT(crowd.world.body_velocity.at(rock).linear_mps.norm(), 0.5);
}

TEST(Determinism, ThreeRunsGiveTheSameFrames) {
    const Hashes expected = Crowd().run(Crowd::k_frames);
    EXPECT_EQ(Crowd().run(Crowd::k_frames), expected);
    EXPECT_EQ(Crowd().run(Crowd::k_frames), expected);
}

TEST(DeterminismThreaded, OneToSixteenThreadsGiveTheSameFrames) {
    set_thread_count(1);
    const Hashes expected = Crowd().run(Crowd::k_frames);
    for (const int threads : {2, 3, 4, 8, 16}) {
        set_thread_count(threads);
        EXPECT_EQ(Crowd().run(Crowd::k_frames), expected) << threads;
    }
    set_thread_count(1);
}

TEST(Determinism, DroppingCachesChangesNoFrame) {
    const Hashes expected = Crowd().run(Crowd::k_frames);
    Crowd always;
    EXPECT_EQ(always.run(Crowd::k_frames, [&](int) { always.drop_caches(); }), expected);
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        Random random(seed);
        Crowd sometimes;
        const auto drop_sometimes = [&](int) {
            if (random.between(0.0, 1.0) < 0.2) {
                sometimes.drop_caches();
            }
        };
        EXPECT_EQ(sometimes.run(Crowd::k_frames, drop_sometimes), expected) << seed;
    }
}

// Sixty frames are rolled back and repeated, from several frames, also with caches that have seen
// the later frames.
TEST(Determinism, RolledBackFramesAreRepeatedBitwise) {
    constexpr int k_rollback_frames = 60;
    Crowd crowd;
    const SnapshotAssets assets(crowd.shapes);
    std::vector<std::byte> saved;
    for (int i = 0; i < 4; ++i) {
        save_snapshot(crowd.world, assets, saved);
        const Hashes expected = crowd.run(k_rollback_frames);
        const auto error = restore_snapshot(saved, assets, crowd.world);
        ASSERT_FALSE(error) << error->message();
        EXPECT_EQ(crowd.run(k_rollback_frames), expected) << "rollback " << i;
    }
}

TEST(Determinism, OtherWorldsContinueIdenticallyFromASnapshot) {
    Crowd here;
    here.run(100);
    const SnapshotAssets assets(here.shapes);
    std::vector<std::byte> saved;
    save_snapshot(here.world, assets, saved);
    Crowd there;
    there.run(7);
    ASSERT_FALSE(restore_snapshot(saved, SnapshotAssets(there.shapes), there.world));
    EXPECT_EQ(there.run(120), here.run(120));
}

TEST(Determinism, CreationOrderChangesNoFrame) {
    const Hashes expected = Crowd().run(Crowd::k_frames);
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
        EXPECT_EQ(Crowd(seed).run(Crowd::k_frames), expected) << seed;
    }
}

// Destroying and adding leaves elements in any order: hands before their players, each column
// differently.
TEST(Determinism, ElementOrderChangesNoFrame) {
    const Hashes expected = Crowd().run(Crowd::k_frames);
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        Crowd crowd;
        Random random(seed);
        visit_columns(crowd.world, [&random](const char*, auto& column) {
            const auto copy = column;
            std::vector<Entity> owners(copy.owners().begin(), copy.owners().end());
            Crowd::shuffle(owners, random);
            column.clear();
            for (const Entity owner : owners) {
                column.add(owner, copy.at(owner));
            }
        });
        EXPECT_EQ(crowd.run(Crowd::k_frames), expected) << seed;
    }
}

}  // namespace
}  // namespace handhold::determinism_test
