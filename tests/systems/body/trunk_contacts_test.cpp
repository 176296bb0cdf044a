// Trunk and legs keep in front of surfaces while the body hangs, and clips leave them there.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "systems/body/layer_additives.hpp"
#include "tests/random.hpp"
#include "tests/systems/body/hanging_body.hpp"

namespace handhold::trunk_contacts_test {
namespace {

using test::HangingBody;
using test::joints_of;
using test::k_player;
using test::Random;

// A wall whose face is at `face_z_m` and whose outside is towards -Z: behind a player who faces -Z.
void put_wall_behind(HangingBody& body, double face_z_m) {
    body.put_box(Vec3(5.0, 5.0, 0.5), test::pose_at(Vec3(0.0, 1.0, face_z_m + 0.5)));
}
double deepest_m(const SpinePose& pose, double face_z_m) {
    double z = -1e9;
    for (const Vec3& joint : joints_of(pose)) {
        z = std::max(z, joint.z());
    }
    return z - face_z_m;
}

TEST(TrunkContacts, HangingTrunkAndLegsStayInFrontOfAWallBehind) {
    for (const double hz : {36.0, 90.0}) {
        HangingBody free;
        HangingBody body;
        constexpr double k_face_m = 0.24;
        put_wall_behind(body, k_face_m);
        for (HangingBody* one : {&free, &body}) {
            for (const HandSide side : {HandSide::left, HandSide::right}) {
                one->put_hand(side, Vec3(side == HandSide::left ? -0.1 : 0.1, 0.1, -0.55));
                one->grip(side, true);
            }
        }
        double deepest = -1.0;
        double settled = -1.0;
        for (int i = 0; i < static_cast<int>(5.0 * hz); ++i) {
            free.step(1.0 / hz);
            const double depth = deepest_m(body.step(1.0 / hz), k_face_m);
            deepest = std::max(deepest, depth);
            settled = i > 3.0 * hz ? std::max(settled, depth) : settled;
        }
        EXPECT_GT(deepest_m(free.pose.at(k_player), k_face_m), 0.15);
        EXPECT_LT(settled, -0.015) << hz;  // the axis of a limb, which has a thickness
        EXPECT_LT(deepest, 0.06) << hz;    // a swinging foot arrives between two searches
        EXPECT_LT(body.pose.at(k_player).pelvis_ws.position.z(), k_face_m - 0.08);
    }
}

// Turns play space, player and wall together.
TEST(TrunkContacts, TurnedWorldsGiveTurnedBodies) {
    Random random(23);
    HangingBody body;
    HangingBody turned;
    const Pose world = random.pose();
    const Pose wall = test::pose_at(Vec3(0.0, 1.0, 0.74));
    body.put_box(Vec3(5.0, 5.0, 0.5), wall);
    turned.put_box(Vec3(5.0, 5.0, 0.5), world * wall);
    turned.origin.at(k_player).pose_ws = world;
    for (int i = 0; i < 200; ++i) {
        for (HangingBody* one : {&body, &turned}) {
            one->put_hand(HandSide::left, Vec3(-0.1, 0.1, -0.55));
            one->grip(HandSide::left, true);
        }
        const std::vector<Vec3> a = joints_of(body.step(1.0 / 90.0));
        const std::vector<Vec3> b = joints_of(turned.step(1.0 / 90.0));
        for (std::size_t k = 0; k < a.size(); ++k) {
            EXPECT_LT((transform_point(world, a[k]) - b[k]).norm(), 1e-6) << i;
        }
    }
}

// A player's body with a clip that kicks backwards.
struct ClippedBody : HangingBody {
    Column<BodyClipState> state;
    BodyClips clips;

    ClippedBody() {
        state.add(k_player);
        ClipTurns kick = no_turns();
        kick[k_clip_legs] = Vec3(-0.6, 0.0, 0.0);
        kick[k_clip_legs + k_leg_bones] = Vec3(-0.6, 0.0, 0.0);
        clips.clips[static_cast<std::size_t>(BodyClipName::idle)].keys = {
            {0.0, no_turns()}, {1.0, kick}, {2.0, no_turns()}};
    }
    SpinePose clipped(double dt_s) {
        step(dt_s);
        layer_additives({.dt_s = dt_s,
                         .clips = clips,
                         .head = head,
                         .origin = origin,
                         .velocity = velocity,
                         .reference = reference,
                         .owner = owner,
                         .grab = grab,
                         .estimate = estimate,
                         .memory = memory,
                         .state = state,
                         .pose = pose},
                        {1.0, 0.0, 1.5, 0.0, 0.0});
        return pose.at(k_player);
    }
};

TEST(TrunkContacts, ClipsMoveNoJointIntoAWall) {
    constexpr double k_face_m = 0.25;
    ClippedBody free;
    ClippedBody body;
    put_wall_behind(body, k_face_m);
    double deepest = -1.0;
    double free_deepest = -1.0;
    std::vector<Vec3> before = joints_of(body.clipped(1.0 / 90.0));
    for (int i = 0; i < 720; ++i) {
        const SpinePose shown = body.clipped(1.0 / 90.0);
        free_deepest = std::max(free_deepest, deepest_m(free.clipped(1.0 / 90.0), k_face_m));
        if (i > 30) {
            deepest = std::max(deepest, deepest_m(shown, k_face_m));
        }
        const std::vector<Vec3> now = joints_of(shown);
        for (std::size_t k = 0; k < now.size(); ++k) {
            EXPECT_LT(90.0 * (now[k] - before[k]).norm(), 2.5) << i;
        }
        before = now;
    }
    EXPECT_GT(free_deepest, 0.05);
    EXPECT_LT(deepest, 0.06);
    EXPECT_LT(deepest, free_deepest - 0.08);
}

TEST(TrunkContacts, ClipsInEmptySpaceAreUnchanged) {
    ClippedBody with_surfaces;
    ClippedBody without;
    put_wall_behind(with_surfaces, 30.0);
    for (int i = 0; i < 200; ++i) {
        EXPECT_EQ(joints_of(with_surfaces.clipped(1.0 / 90.0)),
                  joints_of(without.clipped(1.0 / 90.0)));
    }
}

}  // namespace
}  // namespace handhold::trunk_contacts_test
