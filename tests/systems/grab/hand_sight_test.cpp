#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/random.hpp"
#include "tests/systems/frame/scenario.hpp"

// Grips past walls, edges and rails, through the whole frame.
namespace handhold::hand_sight_test {
namespace {

using test::Random;

// The right palm moves along straight lines and closes at their end.
struct Reach {
    Scenario scenario;
    std::vector<Vec3> palm_path;
    Quat rotation = rotation_about(Vec3::UnitX(), k_half_pi);  // the palm faces -Z
    double leg_s = 0.5;

    explicit Reach(Random& random) {
        scenario.fits_hands = false;
        scenario.hz = random.between(30.0, 144.0);
        scenario.script.head = [](double) { return Pose{Vec3(0.0, 1.6, 0.0), Quat::Identity()}; };
        scenario.script.hands[1] = [this](double t_s) {
            const double leg = std::max(0.0, t_s / leg_s - 0.2);
            const auto last = palm_path.size() - 1;
            const auto i = std::min(static_cast<std::size_t>(leg), last);
            const auto next = std::min(i + 1, last);
            const double share = std::min(1.0, leg - static_cast<double>(i));
            const Vec3 palm = palm_path[i] + share * (palm_path[next] - palm_path[i]);
            return Pose{palm - rotation * scenario.tuning.hand.palm_center_m, rotation};
        };
        scenario.script.grabs[1] = [this](double t_s) { return t_s > moving_s() + 0.05; };
    }
    Reach(const Reach&) = delete;
    Reach& operator=(const Reach&) = delete;

    double moving_s() const { return leg_s * (0.2 + static_cast<double>(palm_path.size() - 1)); }
    Entity add_mug(const Vec3& center) {
        return scenario.add_crate("mug", 0.4, center, Vec3(0.04, 0.05, 0.04));
    }
    const Grab& close() {
        scenario.add_player_here();
        scenario.run(moving_s() + 0.1);
        return scenario.grab(HandSide::right);
    }
};

RC_GTEST_PROP(HandSight, NothingIsGrippedThroughAWall, (std::uint64_t seed)) {
    Random random(seed);
    Reach reach(random);
    const double half_m = random.between(0.0025, 0.05);
    const double front_z = -0.5;
    const double back_z = front_z - 2.0 * half_m;
    reach.scenario.add_wall("wall", Vec3(1.0, 1.0, half_m), Vec3(0.0, 1.2, front_z - half_m));
    const Vec3 start{random.between(-0.2, 0.3), random.between(1.0, 1.4), -0.3};
    const Vec3 end{random.between(-0.2, 0.3), random.between(1.0, 1.4),
                   back_z - random.between(0.01, 0.3)};
    reach.palm_path = {start, end};
    const Entity mug = reach.add_mug(end - Vec3(0.0, 0.0, random.between(0.05, 0.15)));
    RC_ASSERT(reach.close().body != mug);
}

RC_GTEST_PROP(HandSight, PalmPushedIntoASurfaceGripsIt, (std::uint64_t seed)) {
    Random random(seed);
    Reach reach(random);
    const double half_m = random.between(0.005, 0.3);
    const Entity wall =
        reach.scenario.add_wall("wall", Vec3(1.0, 1.0, half_m), Vec3(0.0, 1.2, -0.5 - half_m));
    const Vec3 axis = random.direction();
    reach.rotation = rotation_about(axis, random.between(0.0, 0.6)) * reach.rotation;
    const Vec3 end{random.between(-0.2, 0.3), random.between(1.0, 1.4),
                   -0.5 - random.between(0.0, 0.03)};
    reach.palm_path = {end + Vec3{random.between(-0.1, 0.1), random.between(-0.1, 0.1), 0.2}, end};
    reach.add_mug(end - Vec3(0.0, 0.0, 0.3 + 2.0 * half_m));
    const Grab& grab = reach.close();
    RC_ASSERT(grab.body == wall);
    RC_ASSERT(grab.kind == GripKind::surface);
}

// The palm may look anywhere, and the place where it went in is out of reach.
RC_GTEST_PROP(HandSight, PalmThatSlidInsideAWallGripsItsFront, (std::uint64_t seed)) {
    Random random(seed);
    Reach reach(random);
    const double half_m = random.between(0.04, 0.3);
    const Entity wall =
        reach.scenario.add_wall("wall", Vec3(1.5, 1.5, half_m), Vec3(0.0, 1.2, -0.5 - half_m));
    const double depth_m = random.between(0.005, std::min(0.09, 2.0 * half_m - 0.005));
    reach.rotation = random.rotation();
    const Vec3 in(random.between(-0.2, 0.2), 0.9, -0.5 - depth_m);
    reach.palm_path = {in + Vec3(0.0, 0.0, depth_m + 0.1), in,
                       in + Vec3{random.between(-0.2, 0.2), random.between(0.35, 0.8), 0.0}};
    const Grab& grab = reach.close();
    RC_ASSERT(grab.body == wall);
    RC_ASSERT(std::abs(grab.hit_bs.z() - half_m) < 1e-6);
}

// The head does not see the mug: the hand's path decides.
RC_GTEST_PROP(HandSight, HandThatWentRoundAnEdgeGripsWhatIsBehind, (std::uint64_t seed)) {
    Random random(seed);
    Reach reach(random);
    reach.scenario.add_wall("wall", Vec3(0.6, 1.0, 0.01), Vec3(-0.3, 1.2, -0.5));
    const double y = random.between(1.1, 1.3);
    const double beside_x = 0.3 + random.between(0.06, 0.2);
    const Vec3 end(random.between(-0.2, 0.2), y, -0.6);
    reach.palm_path = {Vec3(0.2, y, -0.35), Vec3(beside_x, y, -0.4), Vec3(beside_x, y, -0.62), end};
    const Entity mug = reach.add_mug(end - Vec3(0.0, 0.0, 0.1));
    RC_ASSERT(reach.close().body == mug);
}

RC_GTEST_PROP(HandSight, HandInAShelfGripsWhatStandsThere, (std::uint64_t seed)) {
    Random random(seed);
    Reach reach(random);
    Scenario& scenario = reach.scenario;
    scenario.add_wall("bottom", Vec3(0.5, 0.01, 0.2), Vec3(0.0, 1.0, -0.6));
    scenario.add_wall("top", Vec3(0.5, 0.01, 0.2), Vec3(0.0, 1.3, -0.6));
    scenario.add_wall("back", Vec3(0.5, 0.16, 0.01), Vec3(0.0, 1.15, -0.8));
    scenario.add_wall("lip", Vec3(0.5, 0.02, 0.01), Vec3(0.0, 1.03, -0.4));
    const double x = random.between(-0.4, 0.4);
    const Vec3 end{x, random.between(1.06, 1.12), random.between(-0.7, -0.55)};
    reach.palm_path = {Vec3(x, 1.2, -0.3), Vec3(x, 1.18, -0.5), end};
    const Entity mug = reach.add_mug(end - Vec3(0.0, 0.0, 0.07));
    RC_ASSERT(reach.close().body == mug);
}

// A hand can go round a rail, even if it is tracked straight through.
RC_GTEST_PROP(HandSight, RailInTheWayHidesNothing, (std::uint64_t seed)) {
    Random random(seed);
    Reach reach(random);
    const double radius_m = random.between(0.01, 0.025);
    reach.scenario.add(
        "rail", {}, reach.scenario.shapes.add_capsule(radius_m, 1.0),
        {Vec3(0.1, 1.2, -0.5), rotation_about(Vec3::UnitZ(), random.between(0.0, 3.0))});
    const Vec3 end(0.1, 1.2, -0.5 - random.between(0.15, 0.3));
    reach.palm_path = {Vec3(0.1, 1.2, -0.3), end};
    const Entity mug = reach.add_mug(end - Vec3(0.0, 0.0, 0.09));
    RC_ASSERT(reach.close().body == mug);
}

// A bar behind the lower rim of a wall: neither palm nor bar is in sight there, but the hand can
// come from below and touch the bar.
RC_GTEST_PROP(HandSight, BarBehindARimIsGripped, (std::uint64_t seed)) {
    Random random(seed);
    Reach reach(random);
    const double rim_y = 1.1;
    reach.scenario.add_wall("wall", Vec3(1.0, 1.0, 0.01), Vec3(0.0, rim_y + 1.0, -0.51));
    const double x = random.between(-0.05, 0.05);
    const Vec3 end{x, rim_y - random.between(0.02, 0.04), -0.5 - random.between(0.05, 0.08)};
    reach.rotation = Quat::Identity();  // the palm faces down
    reach.palm_path = {Vec3(x, 1.3, -0.3), end};
    const Entity bar =
        reach.scenario.add_wall("bar", Vec3(0.3, 0.02, 0.05), end - Vec3(0.0, 0.01 + 0.02, 0.0));
    RC_ASSERT(reach.close().body == bar);
}

TEST(HandSight, RefusedGrabIsCountedAndTheHandThatComesBackGripsAgain) {
    Random random(1);
    Reach reach(random);
    reach.scenario.add_wall("wall", Vec3(1.0, 1.0, 0.005), Vec3(0.0, 1.2, -0.505));
    reach.palm_path = {Vec3(0.2, 1.2, -0.3), Vec3(0.2, 1.2, -0.7), Vec3(0.2, 1.2, -0.3)};
    const Entity behind = reach.add_mug(Vec3(0.2, 1.2, -0.8));
    const Entity before =
        reach.scenario.add_crate("cup", 0.4, Vec3(0.2, 1.2, -0.4), Vec3(0.04, 0.05, 0.04));
    const double behind_s = 1.2 * reach.leg_s;
    reach.scenario.script.grabs[1] = [&](double t_s) {
        return std::abs(t_s - behind_s) < 0.05 || t_s > reach.moving_s() + 0.02;
    };
    reach.scenario.add_player_here();
    std::uint64_t refused = 0;
    reach.scenario.run(reach.moving_s() + 0.1, [&] {
        refused += reach.scenario.fallbacks(Fallback::grab_out_of_sight);
        EXPECT_NE(reach.scenario.grab(HandSide::right).body, behind);
    });
    EXPECT_EQ(refused, 1U);
    EXPECT_EQ(reach.scenario.grab(HandSide::right).body, before);
}

}  // namespace
}  // namespace handhold::hand_sight_test
