#include "systems/snapshot/snapshot.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "systems/snapshot/snapshot_schema.hpp"
#include "tests/engine/allocation_count.hpp"
#include "tests/systems/frame/played_crowd.hpp"

namespace handhold::snapshot_test {
namespace {

using test::Crowd;
using test::played_crowd;
using test::saved;

TEST(Snapshot, RestoresEveryFieldAndTheOrderOfRows) {
    const Crowd crowd = played_crowd();
    World restored;
    ASSERT_FALSE(restore_snapshot(saved(crowd), SnapshotAssets(crowd.shapes), restored));
    EXPECT_TRUE(diff_worlds(crowd.world, restored).empty());
    EXPECT_EQ(hash_state(restored), hash_state(crowd.world));
    visit_columns(crowd.world, [&](const char* name, const auto& column) {
        visit_columns(restored, [&](const char* other_name, const auto& other) {
            if (std::string(name) == other_name) {
                EXPECT_TRUE(std::equal(column.owners().begin(), column.owners().end(),
                                       other.owners().begin(), other.owners().end()))
                    << name;
            }
        });
    });
    // The second save is equal too, which also covers what the comparisons above might miss.
    std::vector<std::byte> again;
    save_snapshot(restored, SnapshotAssets(crowd.shapes), again);
    EXPECT_EQ(again, saved(crowd));
}

TEST(Snapshot, RestoredPoolAllocatesTheSameHandlesNext) {
    Crowd crowd = played_crowd();
    World restored;
    ASSERT_FALSE(restore_snapshot(saved(crowd), SnapshotAssets(crowd.shapes), restored));
    for (int i = 0; i < 4; ++i) {  // two free slots, then new ones
        EXPECT_EQ(restored.entities.create(), crowd.world.entities.create()) << i;
    }
}

TEST(Snapshot, HandlesTakenBeforeAreValidAgain) {
    Crowd crowd = played_crowd();
    const Entity rock = find_by_id(crowd.world, persistent_id_from_name("rock"));
    const std::vector<std::byte> bytes = saved(crowd);
    destroy(crowd.world, rock);
    ASSERT_FALSE(crowd.world.body.contains(rock));
    ASSERT_FALSE(restore_snapshot(bytes, SnapshotAssets(crowd.shapes), crowd.world));
    EXPECT_TRUE(crowd.world.body.contains(rock));
}

// A world that lacks the sphere of a player's head makes it. A refused snapshot makes none.
TEST(Snapshot, MissingHeadsAreMadeForGoodSnapshotsOnly) {
    Crowd there = played_crowd();
    constexpr double k_radius_m = 0.777;
    const Entity player = there.world.player.owners()[0];
    there.world.collider.at(player).shape = there.shapes.add_sphere(k_radius_m);
    const std::vector<std::byte> good = saved(there);
    there.world.body.at(find_by_id(there.world, persistent_id_from_name("rock"))).mass_kg = 0.0;
    const std::vector<std::byte> bad = saved(there);

    Crowd here = played_crowd();
    const SnapshotAssets assets(here.shapes);
    std::vector<double> made_m;
    MissingHeads heads{.smallest_m = 0.1, .largest_m = 1.0, .make = [&](double radius_m) {
                           made_m.push_back(radius_m);
                           return here.shapes.add_sphere(radius_m);
                       }};
    const std::uint64_t before = hash_state(here.world);
    EXPECT_TRUE(restore_snapshot(bad, assets, here.world, heads));
    EXPECT_TRUE(restore_snapshot(good, assets, here.world));
    EXPECT_TRUE(restore_snapshot(good, assets, here.world, {0.1, 0.5, heads.make}));
    EXPECT_EQ(hash_state(here.world), before);
    EXPECT_TRUE(made_m.empty());
    EXPECT_FALSE(restore_snapshot(good, assets, here.world, heads));
    EXPECT_EQ(made_m, std::vector<double>{k_radius_m});
    EXPECT_EQ(here.shapes.at(here.world.collider.at(player).shape).radius_m, k_radius_m);
}

// Extreme values, bit for bit.
TEST(Snapshot, KeepsEveryBitOfNumbers) {
    Crowd crowd;
    const Entity rock = find_by_id(crowd.world, persistent_id_from_name("rock"));
    const Vec3 odd(-0.0, std::numeric_limits<double>::denorm_min(), 0.1 + 0.2);
    crowd.world.body_velocity.at(rock).linear_mps = odd;
    crowd.world.player_commands.elements()[0].snap_turns = std::numeric_limits<std::int32_t>::min();
    crowd.world.clock.frame = std::numeric_limits<std::uint64_t>::max();
    World restored;
    ASSERT_FALSE(restore_snapshot(saved(crowd), SnapshotAssets(crowd.shapes), restored));
    EXPECT_EQ(hash_state(restored), hash_state(crowd.world));
    EXPECT_TRUE(std::signbit(restored.body_velocity.at(rock).linear_mps.x()));
    EXPECT_EQ(restored.player_commands.elements()[0].snap_turns,
              std::numeric_limits<std::int32_t>::min());
}

TEST(Snapshot, SavingIntoWarmBytesAllocatesNothing) {
    if (!counts_allocations()) {
        GTEST_SKIP() << "a sanitizer's own operator new does not count";
    }
    Crowd crowd = played_crowd();
    const SnapshotAssets assets(crowd.shapes);
    std::vector<std::byte> bytes;
    save_snapshot(crowd.world, assets, bytes);
    crowd.run(5);
    const std::size_t before = allocation_count();
    save_snapshot(crowd.world, assets, bytes);
    EXPECT_EQ(allocation_count(), before);
}

TEST(Snapshot, EmptyWorldRoundTrips) {
    const ShapeLibrary shapes;
    std::vector<std::byte> bytes;
    save_snapshot(World{}, SnapshotAssets(shapes), bytes);
    Crowd crowd;
    ASSERT_FALSE(restore_snapshot(bytes, SnapshotAssets(shapes), crowd.world));
    EXPECT_EQ(crowd.world.entities.alive_count(), 0U);
    EXPECT_EQ(hash_state(crowd.world), hash_state(World{}));
}

TEST(Snapshot, FilesRoundTripAndNameThemselvesInErrors) {
    const Crowd crowd = played_crowd();
    const SnapshotAssets assets(crowd.shapes, "crowd");
    const auto path = std::filesystem::path(testing::TempDir()) / "handhold_snapshot_test.hhs";
    ASSERT_FALSE(save_snapshot_file(path, crowd.world, assets));
    World restored;
    ASSERT_FALSE(load_snapshot_file(path, assets, restored));
    EXPECT_EQ(hash_state(restored), hash_state(crowd.world));
    const auto refused =
        load_snapshot_file(path, SnapshotAssets(crowd.shapes, "elsewhere"), restored);
    ASSERT_TRUE(refused);
    EXPECT_EQ(refused->file, path.string());
    std::filesystem::remove(path);
    EXPECT_TRUE(load_snapshot_file(path, assets, restored));
    EXPECT_TRUE(save_snapshot_file(path / "no" / "folder", crowd.world, assets));
}

// Every parameter of every kind of shape changes the hash.
TEST(SnapshotAssets, HashCoversEachShapesContent) {
    const auto mesh = [](double x) {
        Mesh triangle;
        triangle.positions = {Vec3::Zero(), Vec3(x, 0.0, 0.0), Vec3::UnitY()};
        triangle.triangles = {{0, 1, 2}};
        return std::make_shared<const Mesh>(triangle);
    };
    const auto corners = [](double x) {
        return std::vector<Vec3>{Vec3::Zero(), Vec3(x, 0.0, 0.0), Vec3::UnitY(), Vec3::UnitZ()};
    };
    const std::function<void(ShapeLibrary&)> makers[] = {
        [](ShapeLibrary&) {},
        [](ShapeLibrary& s) { s.add_sphere(0.1); },
        [](ShapeLibrary& s) { s.add_sphere(0.2); },
        [](ShapeLibrary& s) { s.add_box(Vec3(0.1, 0.2, 0.3)); },
        [](ShapeLibrary& s) { s.add_box(Vec3(0.3, 0.2, 0.1)); },
        [](ShapeLibrary& s) { s.add_capsule(0.1, 0.2); },
        [](ShapeLibrary& s) { s.add_cylinder(0.1, 0.2); },
        [&](ShapeLibrary& s) { s.add_hull(corners(1.0)); },
        [&](ShapeLibrary& s) { s.add_hull(corners(1.5)); },
        [&](ShapeLibrary& s) { s.add_mesh(mesh(1.0)); },
        [&](ShapeLibrary& s) { s.add_mesh(mesh(1.5)); },
        [&](ShapeLibrary& s) { s.add_mesh(mesh(1.0), Vec3(1.0, 2.0, 1.0)); },
        [](ShapeLibrary& s) {
            const CompoundChild child{s.add_sphere(0.1), {Vec3::UnitX(), Quat::Identity()}};
            s.add_compound({&child, 1});
        },
        [](ShapeLibrary& s) {
            const CompoundChild child{s.add_sphere(0.1), {Vec3::UnitY(), Quat::Identity()}};
            s.add_compound({&child, 1});
        },
    };
    std::set<std::uint64_t> hashes;
    for (const auto& make : makers) {
        ShapeLibrary shapes;
        make(shapes);
        EXPECT_TRUE(hashes.insert(SnapshotAssets(shapes).hash()).second);
        EXPECT_FALSE(hashes.insert(SnapshotAssets(shapes).hash()).second);  // the same shape twice
    }
}

TEST(SnapshotSchema, HasALineForEveryFieldWithItsType) {
    const std::string& schema = snapshot_schema();
    for (const char* const line :
         {"clock.frame u64\n", "clock.t_s f64\n", "reference_velocity_mps vec3\n",
          "body.kind enum(3)\n", "body_pose.pose_ws.rotation quat\n", "collider.shape shape\n",
          "mover.turns_with_body bool\n", "player_commands.snap_turns i32\n",
          "head_ignores.bodies[8] entity\n", "hand_history.entries[32].hand_ps.position vec3\n",
          "early_samples.samples[0].t_s f64\n"}) {
        EXPECT_NE(schema.find(line), std::string::npos) << line;
    }
}

TEST(SnapshotSchema, DifferenceIsTheFirstLineThatDiffersAndPrintable) {
    EXPECT_EQ(schema_difference("a f64\nb f64\n", "a f64\nb f64\n"), "");
    EXPECT_EQ(schema_difference("a f64\nb f64\n", "a f64\nc f64\n"),
              "expected \"b f64\", found \"c f64\"");
    EXPECT_EQ(schema_difference("a f64\n", "a f64\nb f64\n"), "expected the end, found \"b f64\"");
    EXPECT_EQ(schema_difference("a f64\n", ""), "expected \"a f64\", found the end");
    EXPECT_EQ(schema_difference("a\n", "\x1b[2J\n"), "expected \"a\", found \"?[2J\"");
    EXPECT_NE(schema_difference("a\n", "a"), "");
}

}  // namespace
}  // namespace handhold::snapshot_test
