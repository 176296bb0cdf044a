#include "systems/snapshot.hpp"

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

#include "systems/snapshot_schema.hpp"
#include "tests/engine/allocation_count.hpp"
#include "tests/systems/crowd.hpp"
#include "tests/systems/snapshot_bytes.hpp"

namespace handhold::snapshot_test {
namespace {

using test::Crowd;
using test::Random;
using test::SnapshotBytes;

// Everybody grips, somebody was destroyed, and a slot was used again.
Crowd played_crowd() {
    Crowd crowd;
    destroy(crowd.world, find_by_id(crowd.world, persistent_id_from_name("pebble3")));
    destroy(crowd.world, find_by_id(crowd.world, persistent_id_from_name("pebble5")));
    destroy(crowd.world, find_by_id(crowd.world, persistent_id_from_name("pebble4")));
    const ShapeId shape = crowd.shapes.add_sphere(0.1);
    add_body(crowd.world, {"late", {}, {Vec3(0.0, 5.0, 0.0), Quat::Identity()}, {}, shape});
    crowd.drop_caches();
    crowd.run(60);
    return crowd;
}

std::vector<std::byte> saved(const Crowd& crowd) {
    std::vector<std::byte> bytes;
    save_snapshot(crowd.world, SnapshotAssets(crowd.shapes), bytes);
    return bytes;
}

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
    // The same bytes again: what the comparisons above cannot see, they would not hide either.
    std::vector<std::byte> again;
    save_snapshot(restored, SnapshotAssets(crowd.shapes), again);
    EXPECT_EQ(again, saved(crowd));
}

TEST(Snapshot, RestoredPoolGivesOutTheSameHandlesNext) {
    Crowd crowd = played_crowd();
    World restored;
    ASSERT_FALSE(restore_snapshot(saved(crowd), SnapshotAssets(crowd.shapes), restored));
    for (int i = 0; i < 4; ++i) {  // two free slots, then new ones
        EXPECT_EQ(restored.entities.create(), crowd.world.entities.create()) << i;
    }
}

TEST(Snapshot, HandlesTakenBeforeAreGoodAgain) {
    Crowd crowd = played_crowd();
    const Entity rock = find_by_id(crowd.world, persistent_id_from_name("rock"));
    const std::vector<std::byte> bytes = saved(crowd);
    destroy(crowd.world, rock);
    ASSERT_FALSE(crowd.world.body.contains(rock));
    ASSERT_FALSE(restore_snapshot(bytes, SnapshotAssets(crowd.shapes), crowd.world));
    EXPECT_TRUE(crowd.world.body.contains(rock));
}

// Extremes of what fields may hold, bit for bit.
TEST(Snapshot, KeepsEveryBitOfNumbers) {
    Crowd crowd;
    const Entity rock = find_by_id(crowd.world, persistent_id_from_name("rock"));
    const Vec3 odd(-0.0, std::numeric_limits<double>::denorm_min(), 0.1 + 0.2);
    crowd.world.body_velocity.at(rock).linear_mps = odd;
    crowd.world.player_commands.rows()[0].snap_turns = std::numeric_limits<std::int32_t>::min();
    crowd.world.clock.frame = std::numeric_limits<std::uint64_t>::max();
    World restored;
    ASSERT_FALSE(restore_snapshot(saved(crowd), SnapshotAssets(crowd.shapes), restored));
    EXPECT_EQ(hash_state(restored), hash_state(crowd.world));
    EXPECT_TRUE(std::signbit(restored.body_velocity.at(rock).linear_mps.x()));
    EXPECT_EQ(restored.player_commands.rows()[0].snap_turns,
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

// --- Refused -------------------------------------------------------------------------------------

class RefusedSnapshot : public testing::Test {
  protected:
    RefusedSnapshot() : crowd_(played_crowd()), assets_(crowd_.shapes), bytes_(saved(crowd_)) {}

    // The message; empty where it was restored. Refusing must change nothing.
    std::string refusal(std::span<const std::byte> bytes) {
        World world = crowd_.world;
        const auto error = restore_snapshot(bytes, assets_, world);
        if (!error) {
            return {};
        }
        EXPECT_TRUE(diff_worlds(world, crowd_.world).empty());
        EXPECT_FALSE(error->expected.empty());
        return error->message();
    }
    void expect_refused(std::span<const std::byte> bytes, const std::string& part) {
        const std::string message = refusal(bytes);
        EXPECT_NE(message.find(part), std::string::npos) << "\"" << message << "\"";
    }
    void expect_refused(const SnapshotBytes& snapshot, const std::string& part) {
        expect_refused(std::span<const std::byte>(snapshot.bytes), part);
    }

    Crowd crowd_;
    SnapshotAssets assets_;
    std::vector<std::byte> bytes_;
};

TEST_F(RefusedSnapshot, WhatIsNoSnapshot) {
    expect_refused(std::span<const std::byte>{}, "first bytes");
    const std::vector<std::byte> zeros(1000);
    expect_refused(std::span(zeros), "first bytes");
}

TEST_F(RefusedSnapshot, CutShortAtAnyLength) {
    for (std::size_t size = 0; size < bytes_.size(); size += size < 200 ? 1 : 251) {
        ASSERT_NE(refusal(std::span(bytes_).first(size)), "") << size;
    }
    std::vector<std::byte> longer = bytes_;
    longer.push_back(std::byte{0});
    expect_refused(std::span(longer), "bytes as the header says");
}

TEST_F(RefusedSnapshot, AnyByteDamaged) {
    Random random(5);
    for (int i = 0; i < 400; ++i) {
        std::vector<std::byte> damaged = bytes_;
        const auto at =
            static_cast<std::size_t>(random.between(0.0, static_cast<double>(bytes_.size())));
        damaged[at] ^= std::byte{static_cast<unsigned char>(1U << (i % 8))};
        ASSERT_NE(refusal(damaged), "") << at;
    }
}

TEST_F(RefusedSnapshot, OfAnotherFormatVersion) {
    SnapshotBytes later(bytes_);
    later.put(8, std::uint32_t{2});
    expect_refused(later, "byte 8: expected format version 1, found 2");
}

TEST_F(RefusedSnapshot, OfAnotherSceneOrOtherShapes) {
    ShapeLibrary other;
    other.add_sphere(0.1);
    World world;
    EXPECT_TRUE(restore_snapshot(bytes_, SnapshotAssets(other), world));
    EXPECT_TRUE(restore_snapshot(bytes_, SnapshotAssets(crowd_.shapes, "other"), world));
    EXPECT_FALSE(restore_snapshot(bytes_, assets_, world));
}

// Every number of every kind of shape tells libraries apart.
TEST(SnapshotAssets, EachShapesContentCounts) {
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
        EXPECT_FALSE(hashes.insert(SnapshotAssets(shapes).hash()).second);  // twice the same
    }
}

TEST_F(RefusedSnapshot, OfAnotherSchemaNamesTheFirstFieldThatDiffers) {
    SnapshotBytes other(bytes_);
    other.replace_in_schema("grab.error_m f64", "grab.error_q f64");
    expect_refused(other, "schema: expected \"grab.error_m f64\", found \"grab.error_q f64\"");
}

TEST_F(RefusedSnapshot, CountsThatTheBytesCannotHoldAllocateNothing) {
    const std::size_t pool = SnapshotBytes(bytes_).payload_begin();
    const std::size_t slots = crowd_.world.entities.generations().size();
    const std::size_t globals = pool + 4 * (2 + slots + crowd_.world.entities.free_slots().size());
    const std::size_t first_column = globals + 8 + 8 + 24;
    for (const std::size_t count_at : {std::size_t{12}, pool, pool + 4 + 4 * slots, first_column}) {
        for (const std::uint32_t claim : {1U << 30U, ~0U}) {
            SnapshotBytes claiming(bytes_);
            claiming.put(count_at, claim);
            World world;
            const std::size_t before = allocated_bytes();
            const auto error = restore_snapshot(claiming.bytes, assets_, world);
            EXPECT_TRUE(error) << count_at;
            EXPECT_LT(allocated_bytes() - before, 65536U) << count_at;
        }
    }
}

TEST_F(RefusedSnapshot, FieldsOutOfTheirRange) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto break_world = [&](const char* part, auto&& change) {
        Crowd broken = played_crowd();
        change(broken.world);
        expect_refused(saved(broken), part);
    };
    break_world("body_pose[", [&](World& w) { w.body_pose.rows()[1].pose_ws.position.y() = nan; });
    break_world("body_velocity[2].linear_mps.x",
                [&](World& w) { w.body_velocity.rows()[2].linear_mps.x() = 2e18; });
    break_world("head_tracking[0].pose_ps.rotation: expected a rotation of length 1",
                [](World& w) { w.head_tracking.rows()[0].pose_ps.rotation.coeffs() *= 1.01; });
    break_world("clock.t_s", [](World& w) { w.clock.t_s = 2e9; });
    break_world("body[0].kind: expected a value below 3, found 7",
                [](World& w) { w.body.rows()[0].kind = static_cast<BodyKind>(7); });
    break_world("grab[1].body: expected a handle of somebody", [](World& w) {
        w.grab.rows()[1].body = {9999, 1};
    });
    break_world("grab[1].body", [](World& w) { w.grab.rows()[1].body = {0, 2}; });  // yet to come
    break_world("grab[1].body", [](World& w) { w.grab.rows()[1].body = {3, 0}; });
}

TEST_F(RefusedSnapshot, FlagsThatAreNeitherTrueNorFalse) {
    // The only column of one row with a flag at its end: the rotor's.
    SnapshotBytes snapshot(bytes_);
    const std::size_t flag = snapshot.find_end_of(crowd_.world.mover.rows()[0].start_ws) + 48;
    ASSERT_EQ(snapshot.bytes[flag], std::byte{0});
    snapshot.put(flag, std::uint8_t{2});
    expect_refused(snapshot, "mover[0].turns_with_body: expected a value below 2, found 2");
}

TEST_F(RefusedSnapshot, PoolsThatContradictThemselves) {
    const std::size_t pool = SnapshotBytes(bytes_).payload_begin();
    const std::size_t free_list = pool + 4 + 4 * crowd_.world.entities.generations().size();
    ASSERT_GE(crowd_.world.entities.free_slots().size(), 2U);
    SnapshotBytes twice(bytes_);
    twice.put(free_list + 4, crowd_.world.entities.free_slots()[1]);
    expect_refused(twice, "entities: expected slots that exist, each free once");
    SnapshotBytes absent(bytes_);
    absent.put(free_list + 4, std::uint32_t{100000});
    expect_refused(absent, "found 100000");
    SnapshotBytes unborn(bytes_);
    unborn.put(pool + 4, std::uint32_t{0});
    expect_refused(unborn, "found 0 of slot 0");
}

// --- What step_frame relies on -------------------------------------------------------------------

TEST_F(RefusedSnapshot, RowsThatBelongTogetherAndAreNot) {
    const auto break_world = [&](const char* part, auto&& change) {
        Crowd broken = played_crowd();
        change(broken.world);
        expect_refused(saved(broken), part);
    };
    const auto by_name = [](World& w, const char* name) {
        return find_by_id(w, persistent_id_from_name(name));
    };
    break_world("expected a row in body_pose beside it",
                [&](World& w) { w.body_pose.remove(by_name(w, "rock")); });
    break_world("expected a row in body beside it",
                [&](World& w) { w.body.remove(by_name(w, "rock")); });
    break_world("expected a row in persistent_id beside it",
                [&](World& w) { w.persistent_id.remove(by_name(w, "rock")); });
    break_world("ids that nothing else has",
                [](World& w) { w.persistent_id.rows()[1] = w.persistent_id.rows()[2]; });
    break_world("ids above 0", [](World& w) { w.persistent_id.rows()[1].value = 0; });
    break_world("below 2^64 - 1", [](World& w) { w.persistent_id.rows()[1].value = ~0ULL; });
    break_world(".player: expected a player",
                [&](World& w) { w.hand_owner.rows()[0].player = by_name(w, "rock"); });
    break_world(".side: expected one hand a side",
                [](World& w) { w.hand_owner.rows()[1].side = w.hand_owner.rows()[0].side; });
    break_world(".mass_kg", [&](World& w) { w.body.at(by_name(w, "rock")).mass_kg = 0.0; });
    break_world(".inertia_kgm2",
                [&](World& w) { w.body.at(by_name(w, "rock")).inertia_kgm2.y() = -1.0; });
    break_world("path_mover[", [](World& w) { w.path_mover.rows()[0].path.count = 17; });
    break_world("path_mover[", [](World& w) { w.path_mover.rows()[0].path.period_s = 0.0; });
    break_world("leg_mover[", [](World& w) { w.leg_mover.rows()[0].gait.standing = 1.0; });
    break_world("leg_mover[", [](World& w) { w.leg_mover.rows()[0].leg.upper_m = 1e-6; });
    break_world("expected a row in joint_state beside it",
                [&](World& w) { w.joint_state.remove(by_name(w, "hinge")); });
    break_world(".lower", [](World& w) { w.joint.rows()[0].lower = 1.0; });
    break_world("not below 0", [](World& w) { w.joint.rows()[1].latch.strength = -1.0; });
    break_world(".friction", [](World& w) { w.body.rows()[1].friction = -0.1; });
    break_world(".restitution", [](World& w) { w.body.rows()[0].restitution = 1.5; });
    break_world(".mass_kg", [](World& w) { w.player.rows()[0].mass_kg = -1.0; });
    break_world(".next", [](World& w) { w.head_ignores.rows()[0].next = 8; });
    break_world("hand_history", [](World& w) { w.hand_history.rows()[0].count = 33; });
    break_world(".phase", [](World& w) { w.grab.rows()[0].kind = GripKind::none; });
    break_world(".shape: expected a shape that exists",
                [](World& w) { w.collider.rows()[0].shape.index = 1000; });
    break_world("expected a row in last_valid beside it",
                [&](World& w) { w.last_valid.remove(by_name(w, "rock")); });
    break_world("expected a body or a player",
                [&](World& w) { w.collider.add(by_name(w, "crawler/left_hand")); });
    break_world("no player in the same place", [&](World& w) {
        const Entity player = by_name(w, "crawler");
        w.body.add(player);
        w.body_pose.add(player);
        w.body_start.add(player);
        w.body_velocity.add(player);
    });
}

// --- Differences ---------------------------------------------------------------------------------

TEST(WorldDiff, NamesColumnEntityAndField) {
    const Crowd a;
    Crowd b;
    const std::vector<std::string> names = {"crawler", "rock"};
    const WorldDiffSettings settings{20, names};
    const auto by_name = [&](const char* name) {
        return find_by_id(b.world, persistent_id_from_name(name));
    };
    EXPECT_TRUE(diff_worlds(a.world, b.world, settings).empty());
    b.world.head_tracking.at(by_name("crawler")).pose_ps.position.x() = 0.25;
    b.world.head_ignores.at(by_name("crawler")).bodies[2] = by_name("rock");
    b.world.player_commands.at(by_name("crawler")).snap_turns = -3;
    b.world.clock.frame = 4;
    b.world.reference_velocity_mps.z() = 1e-9;
    const std::vector<std::string> expected = {
        "clock.frame: a 0, b 4",
        "reference_velocity_mps.z: a 0, b 1e-09",
        "player_commands[crawler].snap_turns: a 0, b -3",
        "head_tracking[crawler].pose_ps.position.x: a 0, b 0.25",
        "head_ignores[crawler].bodies[2]: a nobody, b rock",
    };
    EXPECT_EQ(diff_worlds(a.world, b.world, settings), expected);
    EXPECT_EQ(diff_worlds(a.world, b.world, {2, names}).size(), 2U);
}

TEST(WorldDiff, TellsWhoIsOnlyInOne) {
    const Crowd a;
    Crowd b;
    const Entity rotor = find_by_id(b.world, persistent_id_from_name("rotor"));
    b.world.mover.remove(rotor);
    const std::vector<std::string> names = {"rotor"};
    EXPECT_EQ(diff_worlds(a.world, b.world, {20, names}),
              std::vector<std::string>{"mover[rotor]: only in a"});
    EXPECT_EQ(diff_worlds(b.world, a.world, {20, names}),
              std::vector<std::string>{"mover[rotor]: only in b"});
    const std::string unnamed = diff_worlds(a.world, b.world).at(0);
    EXPECT_EQ(unnamed.substr(0, 8), "mover[0x") << unnamed;
}

TEST(WorldDiff, SlotsAndOrdersDoNotCount) {
    Crowd a;
    Crowd b(3);
    EXPECT_TRUE(diff_worlds(a.world, b.world).empty());
    a.run(30);
    b.run(30);
    EXPECT_TRUE(diff_worlds(a.world, b.world).empty());
}

// --- The schema ----------------------------------------------------------------------------------

TEST(SnapshotSchema, HasALineForEveryFieldWithItsType) {
    const std::string& schema = snapshot_schema();
    for (const char* const line :
         {"clock.frame u64\n", "clock.t_s f64\n", "reference_velocity_mps vec3\n",
          "body.kind enum(3)\n", "body_pose.pose_ws.rotation quat\n", "collider.shape shape\n",
          "mover.turns_with_body bool\n", "player_commands.snap_turns i32\n",
          "head_ignores.bodies[8] entity\n", "hand_history.entries[32].hand_ps.position vec3\n"}) {
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
