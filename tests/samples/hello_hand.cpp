// A wall and a player whose right hand grips it and pulls: the guide's first program in C++.
#include <cmath>
#include <cstdio>

#include <handhold/handhold.hpp>

// [devices]
// What the headset says at t_s: the right palm faces the wall, closes at 0.5 s and pulls 0.2 m.
static hh::Sample devices_at(double t_s) {
    hh::Sample sample = hh::sample();
    sample.time_s = t_s;
    sample.head.position.y = 1.6;
    const hh::Quat palm_to_wall{std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)};
    sample.hands[HH_LEFT] = hh::pose_at({-0.2, 1.4, -0.43}, palm_to_wall);
    const double pulled_m = 0.4 * (std::fmin(std::fmax(t_s, 1.0), 1.5) - 1.0);
    sample.hands[HH_RIGHT] = hh::pose_at({0.2, 1.4, -0.43 + pulled_m}, palm_to_wall);
    sample.grab[HH_RIGHT] = t_s >= 0.5;
    return sample;
}
// [devices]

int main() {
    // [hello]
    hh::World world;
    hh_body_def wall = hh::body_def();  // static unless it says otherwise
    wall.shape = *world.add_box({2.0, 2.0, 0.1});
    wall.pose.position = {0.0, 1.5, -0.6};
    const hh::Body wall_id = *world.add(wall);
    const hh::Player you = *world.add(hh::player_def());
    if (!world.use_wrists(you)) {  // our samples are wrists; without this, controllers
        return 1;
    }
    for (int frame = 1; frame <= 180; ++frame) {
        const hh::Sample sample = devices_at(frame / 90.0);
        if (const hh::Status status = world.step(1.0 / 90.0, hh::input(you, {&sample, 1}));
            !status) {
            std::printf("%.*s\n", static_cast<int>(status.text().size()), status.text().data());
            return 1;
        }
        for (const hh::Event& event : world.events()) {
            std::printf("frame %d: event %d\n", frame, static_cast<int>(event.kind));
        }
    }
    const hh_player_pose pose = *world.pose(you);  // what your renderer draws
    const hh_hand_state& hand = pose.hands[HH_RIGHT];
    // [hello]
    std::printf("error %.1e m, %.4f m nearer\n", hand.error_m, -pose.origin.position.z);
    // Closed form: a hand on a wall moves the player by as much as it moves towards the body.
    const bool is_right = hand.grip == HH_GRIP_SURFACE && hand.body == wall_id &&
                          hand.error_m < 1e-6 && std::fabs(pose.origin.position.z + 0.2) < 1e-6;
    return is_right ? 0 : 1;
}
