#include "systems/physics/record_valid_poses.hpp"

#include <gtest/gtest.h>

#include "tests/engine/solver/scene.hpp"
#include "tests/systems/frame/column_scene.hpp"

namespace handhold::record_valid_poses_test {
namespace {

using test::Random;

using test::entity;
using test::k_player;
using test::k_wall;

constexpr Entity k_rock = entity(4);

// A player, a wall and a rock that overlaps the wall by `depth_m`.
struct Poses {
    Column<HeadTracking> head;
    Column<LastValidPose> last_valid;
    FrameGraph frame;
    Pose before_ws;

    Poses(Random& random, double depth_m) : before_ws(random.pose()) {
        frame.entities = {k_player, k_wall, k_rock};
        frame.graph.bodies = {test::translating_body(1, 70.0, random.pose()), test::fixed_body(2),
                              test::ball(3, 1.0, 0.1, random.pose())};
        frame.graph.bodies[0].collider_offset_bs = random.vector(1.0);
        frame.graph.bodies[1].pose_ws = random.pose();
        frame.proxies.resize(3);
        frame.proxies[1].from_ws = frame.proxies[1].to_ws = frame.graph.bodies[1].pose_ws;
        RowBlock touch = test::random_block(RowKind::contact, 2, 1, random);
        test::meet(frame.graph.bodies, touch);
        touch.point_b_bs += depth_m * touch.normal_b_bs;
        frame.graph.blocks = {touch};
        frame.active.start_frame(3);
        head.add(k_player).state = TrackingState::tracked;
        last_valid.add(k_player);
        last_valid.add(k_rock, {before_ws});
    }
    void run() { record_valid_poses({.head = head, .frame = frame, .last_valid = last_valid}); }
    const Pose& rock_ws() const { return last_valid.at(k_rock).pose_ws; }
};

void expect_near(const Pose& a, const Pose& b) {
    EXPECT_LT((a.position - b.position).norm(), 1e-12);
    EXPECT_LT(a.rotation.angularDistance(b.rotation), 1e-7);
}

TEST(RecordValidPoses, OverlapAboveTheLimitKeepsThePoseBefore) {
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        Random random(seed);
        Poses clear(random, random.between(-0.01, 0.99 * k_valid_overlap_m));
        clear.run();
        expect_near(clear.rock_ws(), clear.frame.graph.bodies[2].pose_ws);
        Poses deep(random, random.between(1.01 * k_valid_overlap_m, 0.01));
        deep.run();
        expect_near(deep.rock_ws(), deep.before_ws);
    }
}

TEST(RecordValidPoses, MovingObstacleCarriesThePoseAlong) {
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        Random random(seed);
        Poses scene(random, 1e-3);
        const Pose motion = random.pose();
        ColliderProxy& wall = scene.frame.proxies[1];
        wall.from_ws = inverse(motion) * wall.to_ws;
        scene.run();
        expect_near(scene.rock_ws(), motion * scene.before_ws);
    }
}

TEST(RecordValidPoses, PlayersRecordTheHeadsColliderOnceTheHeadWasTracked) {
    for (const TrackingState state : {TrackingState::never, TrackingState::tracked}) {
        Random random(7);
        Poses scene(random, 0.0);
        scene.head.at(k_player).state = state;
        scene.run();
        const LastValidPose& valid = scene.last_valid.at(k_player);
        const SolverBody& player = scene.frame.graph.bodies[0];
        EXPECT_EQ(valid.known, state == TrackingState::tracked);
        expect_near(valid.pose_ws, {transform_point(player.pose_ws, player.collider_offset_bs),
                                    player.pose_ws.rotation});
    }
}

}  // namespace
}  // namespace handhold::record_valid_poses_test
