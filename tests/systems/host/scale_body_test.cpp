// Shown bodies of players of every size: scaled worlds and samples give scaled joints.
#include <array>
#include <cmath>

#include <gtest/gtest.h>
#include <handhold/handhold.hpp>
#include <rapidcheck/gtest.h>

#include "tests/random.hpp"

namespace handhold::host_scale_body_test {
namespace {

using test::Random;

using Joints = std::array<hh_pose, HH_BODY_JOINT_COUNT>;

hh::Vec3 times(double scale, const Vec3& v) {
    return {scale * v.x(), scale * v.y(), scale * v.z()};
}
Vec3 seen(const hh::Vec3& v, double scale) { return Vec3(v.x, v.y, v.z) / scale; }

struct Scene {
    double scale;
    hh::World world;
    hh::Player player{};

    explicit Scene(double s) : scale(s) {
        hh_player_def you = hh::player_def();
        you.scale = scale;
        player = *world.add(you);
        (void)world.use_wrists(player);
    }
    Joints joints() const {
        Joints list;
        EXPECT_EQ(hh_player_body_joints(world.get(), player, HH_SPACE_WORLD, list.data()), HH_OK);
        return list;
    }
};

// Head and hands sway, crouch and turn; hands are lost now and then.
struct Plan {
    explicit Plan(Random& random)
        : head(random.vector(0.1)),
          hands{random.vector(0.25), random.vector(0.25)},
          rate_hz(random.between(0.1, 0.5)),
          crouch_m(random.between(0.0, 0.9)),
          turn_rad(random.between(0.0, 1.0)),
          lost_s(random.between(0.5, 3.0)) {}

    hh::Sample sample(double t_s, double scale) const {
        const double wave = std::sin(2.0 * k_pi * rate_hz * t_s);
        const double low_m = crouch_m * 0.5 * (1.0 - std::cos(2.0 * k_pi * rate_hz * t_s));
        hh::Sample made = hh::sample();
        made.time_s = t_s;
        const Quat turn = rotation_about(Vec3::UnitY(), turn_rad * wave) *
                          rotation_about(Vec3::UnitX(), -0.4 * low_m);
        made.head = hh::pose_at(times(scale, Vec3(0.0, 1.6 - low_m, 0.0) + wave * head),
                                {turn.x(), turn.y(), turn.z(), turn.w()});
        for (std::size_t side = 0; side < 2; ++side) {
            const Vec3 middle(side == 0 ? -0.25 : 0.25, 1.2 - 0.8 * low_m, -0.25);
            made.hands[side] =
                hh::pose_at(times(scale, middle + wave * hands[side]), {0.0, 0.0, 0.0, 1.0});
            const double phase = std::fmod(t_s + 2.0 * static_cast<double>(side), 4.0);
            made.hand_tracked[side] = phase > lost_s ? 1 : 0;
        }
        return made;
    }

    Vec3 head;
    std::array<Vec3, 2> hands;
    double rate_hz;
    double crouch_m;
    double turn_rad;
    double lost_s;
};

// All joints of the body, also of a player whom nobody measured, who crouches or loses hands. Not
// beside surfaces: distances at which casts find a surface again do not scale, so a part leaves one
// earlier or later.
RC_GTEST_PROP(HostScale, BodiesAreShownInTheirPlayersSize, ()) {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    const double scale = std::pow(10.0, random.between(-1.0, std::log10(20.0)));
    const Plan plan(random);
    Scene one(1.0);
    Scene other(scale);
    for (int frame = 1; frame <= 450; ++frame) {
        const double t_s = frame / 90.0;
        for (Scene* const scene : {&one, &other}) {
            const hh::Sample sample = plan.sample(t_s, scene->scale);
            RC_ASSERT(static_cast<bool>(
                scene->world.step(1.0 / 90.0, hh::input(scene->player, {&sample, 1}))));
        }
        const Joints a = one.joints();
        const Joints b = other.joints();
        for (std::size_t joint = 0; joint < a.size(); ++joint) {
            const Vec3 apart = seen(a[joint].position, 1.0) - seen(b[joint].position, scale);
            constexpr double k_same_m = 1e-3;
            RC_ASSERT(apart.norm() < k_same_m);
        }
    }
}

}  // namespace
}  // namespace handhold::host_scale_body_test
