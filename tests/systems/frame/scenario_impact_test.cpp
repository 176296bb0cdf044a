// Free balls hit posts and rails off their centre, through whole frames. Expected values are the
// closed form of an impact without friction: at the time of impact, the velocity's part along the
// normal is reversed by the restitution, the other part is kept.
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/random.hpp"
#include "tests/systems/frame/scenario.hpp"

namespace handhold::scenario_impact_test {
namespace {

using test::Random;

enum class RailKind : std::uint8_t { capsule, cylinder, box };

struct Ball {
    Entity entity;
    Vec3 axis;      // of its rail
    Vec3 center;    // of its rail
    Vec3 velocity;  // before
    Vec3 expected;  // after
    Vec3 normal;    // at the time of impact
    double restitution;
};

// A rail along `axis` that a ball passes at `offset_m` from the line about which its surface is
// round: a rail's middle, or a box's edge.
Ball add_ball_and_rail(Scenario& s, Random& random, int i, RailKind kind) {
    const Vec3 at = Vec3(4.0 * i, 20.0, 0.0);
    const Quat turn = random.rotation();
    const double ball_m = random.between(0.03, 0.15);
    const double round_m = kind == RailKind::box ? 0.0 : random.between(0.01, 0.06);
    const double reach_m = ball_m + round_m;
    // Local frame: the rail along Y, the ball comes along -Z and passes at +X.
    const double share = random.between(0.0, 0.95);
    const double speed = random.between(1.0, 10.0);
    const double slant = random.between(-0.7, 0.7);  // along the rail, per speed
    const double half_m = 1.5;
    const RigidBody still;
    const std::string name = std::to_string(i);
    Vec3 round_line = Vec3::Zero();
    if (kind == RailKind::capsule) {
        s.add("post" + name, still, s.shapes.add_capsule(round_m, half_m), {at, turn});
    } else if (kind == RailKind::cylinder) {
        s.add("post" + name, still, s.shapes.add_cylinder(round_m, half_m), {at, turn});
    } else {
        const Vec3 box{random.between(0.02, 0.3), half_m, random.between(0.05, 0.3)};
        s.add("post" + name, still, s.shapes.add_box(box), {at, turn});
        round_line = Vec3(box.x(), 0.0, box.z());
    }
    const Vec3 velocity(0.0, speed * slant, -speed);
    const double offset_m = share * reach_m;
    const double before_m = std::sqrt(reach_m * reach_m - offset_m * offset_m);
    const Vec3 normal(share, 0.0, before_m / reach_m);
    const double flight_s = random.between(0.05, 0.1);
    const Vec3 start = round_line + Vec3(offset_m, 0.0, before_m) - flight_s * velocity;
    Ball ball;
    ball.restitution = random.between(0.0, 1.0);
    ball.axis = turn * Vec3::UnitY();
    ball.center = at + turn * round_line;
    ball.velocity = turn * velocity;
    ball.normal = turn * normal;
    ball.expected =
        ball.velocity - (1.0 + ball.restitution) * ball.normal.dot(ball.velocity) * ball.normal;
    const double mass_kg = random.between(0.1, 3.0);
    ball.entity = s.add_rock("ball" + name, mass_kg, at + turn * start, ball_m);
    RigidBody& body = s.world.body.at(ball.entity);
    body.restitution = ball.restitution;
    body.friction = 0.0;
    s.world.body_velocity.at(ball.entity).linear_mps = ball.velocity;
    return ball;
}

class Impact : public testing::TestWithParam<RailKind> {};

TEST_P(Impact, OffTheCentreReversesTheNormalPartAndKeepsTheOther) {
    for (const double hz : {60.0, 90.0, 144.0}) {
        Random random(41 + static_cast<std::uint64_t>(hz));
        Scenario s;
        s.hz = s.sample_hz = hz;
        s.fits_hands = false;
        s.tuning.contact.restitution_speed_mps = 0.0;
        std::vector<Ball> balls;
        for (int i = 0; i < 200; ++i) {
            balls.push_back(add_ball_and_rail(s, random, i, GetParam()));
        }
        s.add_player_here();
        s.run(0.15);
        for (std::size_t i = 0; i < balls.size(); ++i) {
            const Ball& ball = balls[i];
            SCOPED_TRACE(std::to_string(hz) + " Hz, ball " + std::to_string(i));
            const Vec3 after = s.body_velocity(ball.entity);
            const double hit_mps = -ball.normal.dot(ball.velocity);
            const Vec3 tangential = ball.velocity + hit_mps * ball.normal;
            const double along = ball.normal.dot(after);
            EXPECT_NEAR(along, ball.restitution * hit_mps, 0.05 * hit_mps);
            EXPECT_LT((after - along * ball.normal - tangential).norm(),
                      0.05 * hit_mps + 0.01 * tangential.norm());
            const Vec3 from_rail = s.body(ball.entity).position - ball.center;
            const Vec3 across = from_rail - ball.axis.dot(from_rail) * ball.axis;
            EXPECT_GE(across.dot(after), -1e-9 * after.norm());  // no ball approaches its rail
        }
    }
}

std::string name_of_rail(const testing::TestParamInfo<RailKind>& info) {
    return info.param == RailKind::capsule    ? "Capsule"
           : info.param == RailKind::cylinder ? "Cylinder"
                                              : "Box";
}
INSTANTIATE_TEST_SUITE_P(Rails, Impact,
                         testing::Values(RailKind::capsule, RailKind::cylinder, RailKind::box),
                         name_of_rail);

}  // namespace
}  // namespace handhold::scenario_impact_test
