#include "systems/body/limit_feet.hpp"

#include <array>
#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "systems/body/shared/fold_body.hpp"
#include "tests/random.hpp"
#include "tests/systems/frame/column_scene.hpp"

namespace handhold::limit_feet_test {
namespace {

using test::k_player;
using test::Random;

constexpr double k_thigh_m = 0.41;
constexpr double k_shin_m = 0.40;
constexpr double k_rounding = 1e-6;

// Legs below a chest at rest; the joints are placed by angles.
struct Legs {
    Column<PlayerOrigin> origin;
    Column<SpineMemory> memory;
    Column<SpinePose> pose;
    double scale;

    Legs(const Pose& origin_ws, double scale_) : scale(scale_) {
        origin.add(k_player, {origin_ws, scale});
        memory.add(k_player);
        pose.add(k_player);
    }
    // swing_rad: the thigh ahead; knee_rad: the knee's bend; aside_rad: the thigh to the side.
    void put(double swing_rad, double knee_rad, double aside_rad) {
        const Pose& origin_ws = origin.at(k_player).pose_ws;
        SpinePose& out = pose.at(k_player);
        out.chest_ws = origin_ws;
        out.pelvis_ws = origin_ws;
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            const double sign = side == 0 ? -1.0 : 1.0;
            const Quat thigh = rotation_about(Vec3::UnitZ(), sign * aside_rad) *
                               rotation_about(Vec3::UnitX(), swing_rad);
            const Quat shin = thigh * rotation_about(Vec3::UnitX(), -knee_rad);
            const Vec3 hip = scale * Vec3(0.09 * sign, -0.5, 0.0);
            const Vec3 knee = hip - thigh * Vec3(0.0, scale * k_thigh_m, 0.0);
            const Vec3 ankle = knee - shin * Vec3(0.0, scale * k_shin_m, 0.0);
            out.legs[side] = {origin_ws * Pose{hip, thigh}, origin_ws * Pose{knee, shin},
                              origin_ws * Pose{ankle, shin}};
        }
    }
    void step(double dt_s) {
        limit_feet({.dt_s = dt_s, .origin = origin, .memory = memory, .pose = pose});
    }
    const SpinePose::Leg& leg(std::size_t side) const { return pose.at(k_player).legs[side]; }
    // In the player's metres.
    Vec3 foot(std::size_t side) const {
        return inverse_transform_point(origin.at(k_player).pose_ws, leg(side).foot_ws.position) /
               scale;
    }
};

// From hip to ankle of a leg whose knee is bent least.
double longest_leg_m() {
    return std::sqrt(k_thigh_m * k_thigh_m + k_shin_m * k_shin_m +
                     2.0 * k_thigh_m * k_shin_m * std::cos(k_least_knee_rad));
}

// Sums over all sessions, in frames of a foot.
struct Counts {
    std::size_t limited = 0;
    std::size_t stopped = 0;  // its leg became straight, or as short as it may
};

// Legs that are thrown about: their bones keep their lengths. Their feet stay within the limits;
// only a leg that becomes straight, or as short as it may, stops its foot at once.
void throw_legs_about(Counts& counts) {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    const double scale = std::pow(10.0, random.between(-1.0, 1.0));
    Legs legs(random.pose(), scale);
    const double hz = random.between(30.0, 144.0);
    const double wild = random.between(0.0, 1.0);
    Vec3 angles(0.3, 0.5, 0.05);
    std::array<Vec3, k_hand_count> before{};
    std::array<Vec3, k_hand_count> before_mps{};
    for (int frame = 0; frame < 600; ++frame) {
        if (random.between(0.0, 1.0) < 0.03 * wild) {
            const double swing = random.between(-0.4, 1.5);
            const double knee = random.between(0.2, 2.0);
            angles = Vec3(swing, knee, random.between(0.0, 0.4));
        }
        angles += random.vector(0.02 * wild);
        angles.y() = std::clamp(angles.y(), 0.2, 2.2);
        angles.z() = std::max(angles.z(), 0.0);  // legs apart are not turned
        legs.put(angles.x(), angles.y(), angles.z());
        const std::array<Vec3, k_hand_count> wanted = {legs.foot(0), legs.foot(1)};
        legs.step(1.0 / hz);
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            const SpinePose::Leg& leg = legs.leg(side);
            RC_ASSERT(is_finite(leg.foot_ws.position));
            const auto length_of = [scale](const Pose& a, const Pose& b) {
                return (a.position - b.position).norm() / scale;
            };
            RC_ASSERT(std::abs(length_of(leg.thigh_ws, leg.shin_ws) - k_thigh_m) < 1e-9);
            RC_ASSERT(std::abs(length_of(leg.shin_ws, leg.foot_ws) - k_shin_m) < 1e-9);
            const Vec3 along = leg.thigh_ws.rotation * -Vec3::UnitY();
            const Vec3 bone = (leg.shin_ws.position - leg.thigh_ws.position).normalized();
            RC_ASSERT((along - bone).norm() < 1e-6);
            const Vec3 now = legs.foot(side);
            counts.limited += (now - wanted[side]).norm() > 1e-6 ? std::size_t{1} : std::size_t{0};
            const Vec3 mps = hz * (now - before[side]);
            if (frame > 0) {
                RC_ASSERT(mps.norm() < k_foot_limits.speed_mps + k_rounding);
            }
            if (frame > 1) {
                const double leg_m = length_of(leg.thigh_ws, leg.foot_ws);
                const bool is_at_end = leg_m > (1.0 - k_rounding) * longest_leg_m() ||
                                       leg_m < 0.05 * (k_thigh_m + k_shin_m) + k_rounding;
                const bool is_stopped =
                    (mps - before_mps[side]).norm() > k_foot_limits.step_mps + k_rounding;
                RC_ASSERT(is_at_end || !is_stopped);
                counts.stopped += is_stopped ? std::size_t{1} : std::size_t{0};
            }
            before[side] = now;
            before_mps[side] = frame > 0 ? mps : Vec3(Vec3::Zero());
        }
    }
    // Once the legs rest, every foot is exactly at its target.
    for (int frame = 0; frame < static_cast<int>(2.0 * hz); ++frame) {
        legs.put(angles.x(), angles.y(), angles.z());
        legs.step(1.0 / hz);
    }
    legs.put(angles.x(), angles.y(), angles.z());
    const std::array<Vec3, k_hand_count> wanted = {legs.leg(0).foot_ws.position,
                                                   legs.leg(1).foot_ws.position};
    legs.step(1.0 / hz);
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        RC_ASSERT(legs.leg(side).foot_ws.position == wanted[side]);
    }
}

TEST(LimitFeet, FeetKeepTheirSpeedAndChangeItSlowly) {
    Counts counts;
    EXPECT_TRUE(rc::check([&counts] { throw_legs_about(counts); }));
    EXPECT_GT(counts.limited, 1000U);
    EXPECT_LT(100 * counts.stopped, counts.limited);
}

// A leg that swings as people's do is not changed in one bit.
TEST(LimitFeet, SlowFeetAreLeftAlone) {
    Legs legs({}, 1.0);
    for (int frame = 0; frame < 900; ++frame) {
        const double t_s = frame / 90.0;
        legs.put(0.3 + 0.3 * std::sin(2.0 * t_s), 0.6 + 0.3 * std::sin(3.0 * t_s), 0.05);
        const SpinePose before = legs.pose.at(k_player);
        legs.step(1.0 / 90.0);
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            const SpinePose::Leg& a = before.legs[side];
            const SpinePose::Leg& b = legs.leg(side);
            ASSERT_EQ(a.shin_ws.position, b.shin_ws.position);
            ASSERT_EQ(a.foot_ws.position, b.foot_ws.position);
            ASSERT_EQ(a.foot_ws.rotation.coeffs(), b.foot_ws.rotation.coeffs());
        }
    }
}

}  // namespace
}  // namespace handhold::limit_feet_test
