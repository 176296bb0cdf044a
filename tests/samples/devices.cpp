// The guide's devices: a hand of a sample from what a runtime of devices says. Then a hand on a
// wall is guessed to be elsewhere, and its player does not move.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>

#include <handhold/handhold.hpp>

namespace {

// What a runtime says of a wrist or a joint. OpenXR: the VALID and TRACKED bits of locationFlags.
struct Located {
    hh::Pose pose;
    bool is_valid = false;
    bool is_tracked = false;
};
using Joints = std::array<Located, HH_HAND_JOINT_COUNT>;

// [read]
// One hand of a sample: the location of its wrist, and the 26 joints of hand tracking.
void read_hand(const Located& wrist, const Joints& joints, hh_side side, hh::Sample& sample) {
    sample.hand_tracked[side] = wrist.is_valid && wrist.is_tracked;
    sample.hand_inferred[side] = wrist.is_valid && !wrist.is_tracked;
    sample.hands[side] = wrist.pose;

    std::array<hh_hand_joint, HH_HAND_JOINT_COUNT> seen = {};
    for (std::size_t i = 0; i < joints.size(); ++i) {
        seen[i].is_valid = joints[i].is_valid;
        seen[i].pose = joints[i].pose;
    }
    hh_finger_curls_of(seen.data(), &sample.curls[side]);
}
// [read]

}  // namespace

int main() {
    constexpr double k_dt_s = 1.0 / 90.0;
    hh::World world;
    hh_body_def wall = hh::body_def();
    wall.shape = *world.add_box({2.0, 2.0, 0.5});
    wall.pose.position = {0.0, 1.4, -1.0};
    (void)world.add(wall);
    const hh::Player you = *world.add(hh::player_def());
    if (!world.use_wrists(you)) {
        return 1;
    }
    Located wrist{
        hh::pose_at({0.2, 1.4, -0.43}, {0.7071067811865476, 0.0, 0.0, 0.7071067811865476}), true,
        true};
    const auto step = [&](bool grabs) {
        hh::Sample sample = hh::sample();
        sample.time_s = world.time_s() + k_dt_s;
        sample.head = hh::pose_at({0.0, 1.62, 0.0});
        sample.head_tracked = 1;
        read_hand(wrist, Joints{}, HH_RIGHT, sample);
        sample.grab[HH_RIGHT] = grabs;
        return static_cast<bool>(world.step(k_dt_s, hh::input(you, {&sample, 1})));
    };
    bool is_fine = step(false);
    for (int frame = 0; frame < 10; ++frame) {
        is_fine = step(true) && is_fine;
    }
    const bool grips = world.hand(you, HH_RIGHT)->grip == HH_GRIP_SURFACE;
    const hh::Vec3 before = world.pose(you)->origin.position;
    wrist.is_tracked = false;
    for (int frame = 0; frame < 90; ++frame) {
        wrist.pose.position.x += 0.01;
        is_fine = step(true) && is_fine;
    }
    const hh::Vec3 after = world.pose(you)->origin.position;
    const double moved_m = std::hypot(after.x - before.x, after.y - before.y, after.z - before.z);
    std::printf("grips: %d; moved by a guess: %.6f m\n", grips, moved_m);
    return is_fine && grips && moved_m < 1e-9 ? 0 : 1;
}
