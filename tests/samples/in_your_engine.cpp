// The samples of docs/guide/in_your_engine.md: a player in an engine with Unreal's axes and units.
// Exit status 0: the rig is where a hand pulled it, and where the engine's own walking put it.
#include <cmath>
#include <cstdio>

#include <handhold/convert.hpp>
#include <handhold/handhold.hpp>

namespace {

constexpr double k_dt_s = 1.0 / 90.0;

// What an engine with X ahead, Y right, Z up and centimetres has.
struct Transform {
    hh_vec3 location;
    hh_quat rotation;
};
struct Devices {
    Transform head;
    Transform controllers[2];
    bool grip_pressed[2];
};

// [feed]
constexpr hh::EngineSpace k_engine{HH_ENGINE_UNREAL};

// Poses relative to the tracking origin, not to the world: the rig is Handhold's to move.
hh::Sample sample_of(const Devices& devices, double time_s) {
    hh::Sample sample = hh::sample();
    sample.time_s = time_s;
    sample.head = k_engine.pose_from({devices.head.location, devices.head.rotation});
    for (int side = HH_LEFT; side <= HH_RIGHT; ++side) {
        const Transform& grip = devices.controllers[side];
        sample.hands[side] = k_engine.pose_from({grip.location, grip.rotation});
        sample.grab[side] = devices.grip_pressed[side];
    }
    return sample;
}

// One frame: devices in, the rig out.
bool step(hh::World& world, hh::Player you, const Devices& devices, Transform& rig) {
    const hh::Sample sample = sample_of(devices, world.time_s() + k_dt_s);
    if (!world.step(k_dt_s, hh::input(you, {&sample, 1}))) {
        return false;
    }
    const hh_pose origin = k_engine.pose_to(world.pose(you)->origin);
    rig = {origin.position, origin.rotation};
    return true;
}
// [feed]

// [walk]
// The engine's character controller moves the player on foot: call it before the step, which
// carries the player along by the velocity.
bool walk(hh::World& world, hh::Player you, const Transform& rig, hh_vec3 velocity_cmps) {
    return static_cast<bool>(world.place(you, k_engine.pose_from({rig.location, rig.rotation}),
                                         k_engine.vector_from(velocity_cmps)));
}
// [walk]

Devices devices_at(double time_s) {
    // The fingers point up, so that the palms face the wall: a pitch of 90 degrees.
    const hh_quat up{0.0, -std::sqrt(0.5), 0.0, std::sqrt(0.5)};
    const double pulled_cm = 40.0 * (std::fmin(std::fmax(time_s, 1.0), 1.5) - 1.0);
    Devices devices{};
    devices.head = {{0.0, 0.0, 160.0}, {0.0, 0.0, 0.0, 1.0}};
    devices.controllers[HH_LEFT] = {{43.0, -20.0, 140.0}, up};
    devices.controllers[HH_RIGHT] = {{43.0 - pulled_cm, 20.0, 140.0}, up};
    devices.grip_pressed[HH_RIGHT] = time_s >= 0.5 && time_s < 2.0;
    return devices;
}

}  // namespace

int main() {
    hh::World world;
    hh_body_def wall = hh::body_def();
    const hh_vec3 half_extents_m = k_engine.scale_from({0.1, 2.0, 2.0});
    wall.shape = *world.add_box(half_extents_m);
    wall.pose = k_engine.pose_from({{60.0, 0.0, 150.0}, {0.0, 0.0, 0.0, 1.0}});
    const hh::Body wall_id = *world.add(wall);
    const hh::Player you = *world.add(hh::player_def());
    if (!world.use_wrists(you)) {
        return 1;
    }
    Transform rig{};
    for (int frame = 1; frame <= 200; ++frame) {
        if (!step(world, you, devices_at(frame * k_dt_s), rig)) {
            return 1;
        }
    }
    const Transform pulled = rig;
    for (int frame = 201; frame <= 290; ++frame) {  // one second backwards at 50 cm/s
        if (!walk(world, you, rig, {-50.0, 0.0, 0.0}) ||
            !step(world, you, devices_at(frame * k_dt_s), rig)) {
            return 1;
        }
    }
    const hh_vec3 walked = rig.location;
    std::printf("pulled to x = %.4f cm, walked to x = %.4f cm\n", pulled.location.x, walked.x);
    const bool is_pulled = std::fabs(pulled.location.x - 20.0) < 0.01;
    const bool is_walked = std::fabs(walked.x - (pulled.location.x - 50.0)) < 0.1;
    return is_pulled && is_walked && world.has(wall_id) ? 0 : 1;
}
