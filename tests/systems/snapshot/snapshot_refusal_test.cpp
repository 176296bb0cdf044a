#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "systems/snapshot/snapshot.hpp"
#include "tests/engine/allocation_count.hpp"
#include "tests/random.hpp"
#include "tests/systems/frame/played_crowd.hpp"
#include "tests/systems/snapshot/snapshot_bytes.hpp"

namespace handhold::snapshot_refusal_test {
namespace {

using test::Crowd;
using test::played_crowd;
using test::Random;
using test::saved;
using test::SnapshotBytes;

class SnapshotRefuses : public testing::Test {
  protected:
    SnapshotRefuses() : crowd_(played_crowd()), assets_(crowd_.shapes), bytes_(saved(crowd_)) {}

    // The error message; empty if the bytes were restored. A refusal must change nothing.
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

TEST_F(SnapshotRefuses, BytesThatAreNoSnapshot) {
    expect_refused(std::span<const std::byte>{}, "first bytes");
    const std::vector<std::byte> zeros(1000);
    expect_refused(std::span(zeros), "first bytes");
}

TEST_F(SnapshotRefuses, TruncatedBytes) {
    for (std::size_t size = 0; size < bytes_.size(); size += size < 200 ? 1 : 251) {
        ASSERT_NE(refusal(std::span(bytes_).first(size)), "") << size;
    }
    std::vector<std::byte> longer = bytes_;
    longer.push_back(std::byte{0});
    expect_refused(std::span(longer), "bytes as the header says");
}

TEST_F(SnapshotRefuses, AnyDamagedByte) {
    Random random(5);
    for (int i = 0; i < 400; ++i) {
        std::vector<std::byte> damaged = bytes_;
        const auto at =
            static_cast<std::size_t>(random.between(0.0, static_cast<double>(bytes_.size())));
        damaged[at] ^= std::byte{static_cast<unsigned char>(1U << (i % 8))};
        ASSERT_NE(refusal(damaged), "") << at;
    }
}

TEST_F(SnapshotRefuses, AnotherFormatVersion) {
    for (const std::uint32_t version : {1U, 2U, 3U, 4U, 5U, 6U, 7U, 8U, 9U, 10U, 11U, 12U,
                                        14U}) {  // earlier field names; a later build
        SnapshotBytes other(bytes_);
        other.put(8, version);
        expect_refused(other,
                       "byte 8: expected format version 13, found " + std::to_string(version));
    }
}

TEST_F(SnapshotRefuses, AnotherSceneOrOtherShapes) {
    ShapeLibrary other;
    other.add_sphere(0.1);
    World world;
    EXPECT_TRUE(restore_snapshot(bytes_, SnapshotAssets(other), world));
    EXPECT_TRUE(restore_snapshot(bytes_, SnapshotAssets(crowd_.shapes, "other"), world));
    EXPECT_FALSE(restore_snapshot(bytes_, assets_, world));
}

TEST_F(SnapshotRefuses, AnotherSchemaAndNamesTheFirstDifferentField) {
    SnapshotBytes other(bytes_);
    other.replace_in_schema("grab.error_m f64", "grab.error_q f64");
    expect_refused(other, "schema: expected \"grab.error_m f64\", found \"grab.error_q f64\"");
}

TEST_F(SnapshotRefuses, CountsBeyondTheBytesWithoutAllocating) {
    const std::size_t pool = SnapshotBytes(bytes_).payload_begin();
    const std::size_t slots = crowd_.world.entities.generations().size();
    const std::size_t globals = pool + 4 * (2 + slots + crowd_.world.entities.free_slots().size());
    const std::size_t first_column = globals + 8 + 8 + 24 + 24;
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

TEST_F(SnapshotRefuses, FieldsOutOfTheirRange) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto break_world = [&](const char* part, auto&& change) {
        Crowd broken = played_crowd();
        change(broken.world);
        expect_refused(saved(broken), part);
    };
    break_world("body_pose[",
                [&](World& w) { w.body_pose.elements()[1].pose_ws.position.y() = nan; });
    break_world("body_velocity[2].linear_mps.x",
                [&](World& w) { w.body_velocity.elements()[2].linear_mps.x() = 2e18; });
    break_world("head_tracking[0].pose_ps.rotation: expected a rotation of length 1",
                [](World& w) { w.head_tracking.elements()[0].pose_ps.rotation.coeffs() *= 1.01; });
    break_world("clock.t_s", [](World& w) { w.clock.t_s = 2e9; });
    break_world("body[0].kind: expected a value below 3, found 7",
                [](World& w) { w.body.elements()[0].kind = static_cast<BodyKind>(7); });
    break_world("grab[1].body: expected a handle of an entity", [](World& w) {
        w.grab.elements()[1].body = {9999, 1};
    });
    break_world("grab[1].body", [](World& w) {
        w.grab.elements()[1].body = {0, 2};
    });  // never existed
    break_world("grab[1].body", [](World& w) { w.grab.elements()[1].body = {3, 0}; });
}

TEST_F(SnapshotRefuses, FlagsThatAreNeitherTrueNorFalse) {
    // `mover` is the only column with one element and a flag at its end.
    SnapshotBytes snapshot(bytes_);
    const std::size_t flag = snapshot.find_end_of(crowd_.world.mover.elements()[0].start_ws) + 48;
    ASSERT_EQ(snapshot.bytes[flag], std::byte{0});
    snapshot.put(flag, std::uint8_t{2});
    expect_refused(snapshot, "mover[0].turns_with_body: expected a value below 2, found 2");
}

TEST_F(SnapshotRefuses, InconsistentEntityPools) {
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

TEST_F(SnapshotRefuses, ElementsWithoutTheirCounterparts) {
    const auto break_world = [&](const char* part, auto&& change) {
        Crowd broken = played_crowd();
        change(broken.world);
        expect_refused(saved(broken), part);
    };
    const auto by_name = [](World& w, const char* name) {
        return find_by_id(w, persistent_id_from_name(name));
    };
    break_world("expected an element in body_pose of the same owner",
                [&](World& w) { w.body_pose.remove(by_name(w, "rock")); });
    break_world("expected an element in body of the same owner",
                [&](World& w) { w.body.remove(by_name(w, "rock")); });
    break_world("expected an element in persistent_id of the same owner",
                [&](World& w) { w.persistent_id.remove(by_name(w, "rock")); });
    break_world("unique ids",
                [](World& w) { w.persistent_id.elements()[1] = w.persistent_id.elements()[2]; });
    break_world("ids above 0", [](World& w) { w.persistent_id.elements()[1].value = 0; });
    break_world("below 2^64 - 1", [](World& w) { w.persistent_id.elements()[1].value = ~0ULL; });
    break_world(".player: expected a player",
                [&](World& w) { w.hand_owner.elements()[0].player = by_name(w, "rock"); });
    break_world(".side: expected one hand per side", [](World& w) {
        w.hand_owner.elements()[1].side = w.hand_owner.elements()[0].side;
    });
    break_world(".mass_kg", [&](World& w) { w.body.at(by_name(w, "rock")).mass_kg = 0.0; });
    break_world(".inertia_kgm2",
                [&](World& w) { w.body.at(by_name(w, "rock")).inertia_kgm2.y() = -1.0; });
    break_world("path_mover[", [](World& w) { w.path_mover.elements()[0].path.count = 17; });
    break_world("path_mover[", [](World& w) { w.path_mover.elements()[0].path.period_s = 0.0; });
    break_world("].count: expected at most 8 moves", [&](World& w) {
        w.move_target.add(by_name(w, "train")).count = MoveTarget::k_capacity + 1;
    });
    break_world("].moves: expected times of 1e-6 s or more", [&](World& w) {
        w.move_target.add(by_name(w, "train")).count = 1;  // its move has no time
    });
    break_world("expected an element in body of the same owner",
                [&](World& w) { w.move_target.add(by_name(w, "crawler")); });
    break_world("].scale: expected a number in [0.01, 100]",
                [](World& w) { w.player_origin.elements()[0].scale = 101.0; });
    break_world("].scale: expected a number in [0.01, 100]",
                [](World& w) { w.player_origin.elements()[0].scale = 0.0099; });
    break_world("lengths of 0.05 to 5 m times the player's scale",
                [](World& w) { w.player_origin.elements()[0].scale = 0.01; });
    break_world("leg_mover[", [](World& w) { w.leg_mover.elements()[0].gait.standing = 1.0; });
    break_world("leg_mover[", [](World& w) { w.leg_mover.elements()[0].leg.upper_m = 1e-6; });
    break_world("expected an element in joint_state of the same owner",
                [&](World& w) { w.joint_state.remove(by_name(w, "hinge")); });
    break_world(".lower", [](World& w) { w.joint.elements()[0].lower = 1.0; });
    break_world(">= 0", [](World& w) { w.joint.elements()[1].latch.strength = -1.0; });
    break_world(".friction", [](World& w) { w.body.elements()[1].friction = -0.1; });
    break_world(".restitution", [](World& w) { w.body.elements()[0].restitution = 1.5; });
    break_world("arm_memory[", [](World& w) {
        w.arm_memory.elements()[0].known = true;
        w.arm_memory.elements()[0].looks_ps[1] = Vec3::Zero();
    });
    break_world("arm_memory[",
                [](World& w) { w.arm_memory.elements()[0].arms[1].rest.share = 1.5; });
    break_world("size_estimate[",
                [](World& w) { w.size_estimate.elements()[0].eyes.time_s[3] = -1.0; });
    break_world("calibration[", [](World& w) { w.calibration.elements()[0].held_s = 0.5; });
    break_world("squeeze and trigger in [0, 1]",
                [](World& w) { w.hand_tracking.elements()[0].trigger = 2.0; });
    break_world("].push_off_weight",
                [](World& w) { w.body_clip_state.elements()[0].push_off_weight = 2.0; });
    break_world(".mass_kg", [](World& w) { w.player.elements()[0].mass_kg = -1.0; });
    break_world(".next", [](World& w) { w.head_ignores.elements()[0].next = 8; });
    break_world("hand_history", [](World& w) { w.hand_history.elements()[0].count = 33; });
    break_world(".phase", [](World& w) { w.grab.elements()[0].kind = GripKind::none; });
    break_world("].count", [](World& w) {
        w.early_samples.add(w.player.owners()[0]).count = EarlySamples::k_capacity + 1;
    });
    break_world("early_samples: expected at most 0 elements",
                [](World& w) { w.early_samples.add(w.player.owners()[0]); });
    break_world(".shape: expected a shape of this world",
                [](World& w) { w.collider.elements()[0].shape.index = 1000; });
    break_world("expected an element in last_valid of the same owner",
                [&](World& w) { w.last_valid.remove(by_name(w, "rock")); });
    break_world("expected a body or a player",
                [&](World& w) { w.collider.add(by_name(w, "crawler/left_hand")); });
    break_world("an entity that is not a player too", [&](World& w) {
        const Entity player = by_name(w, "crawler");
        w.body.add(player);
        w.body_pose.add(player);
        w.body_start.add(player);
        w.body_velocity.add(player);
    });
}

}  // namespace
}  // namespace handhold::snapshot_refusal_test
