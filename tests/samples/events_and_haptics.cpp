// The guide's events: what a hand did, and how hard the controller should shake.
#include <cmath>
#include <cstdio>
#include <string>

#include <handhold/handhold.hpp>

namespace {

// [loop]
// Your game's reactions, after each step.
void react(const hh::World& world, std::string& log) {
    for (const hh::Event& event : world.events()) {
        switch (event.kind) {
            case HH_EVENT_GRABBED:
                log += "grabbed;";  // a short click in controller `event.side`
                break;
            case HH_EVENT_RELEASED:
                log += event.reason == HH_REASON_BY_HOST ? "taken away;" : "released;";
                break;
            case HH_EVENT_REFUSED:
                log += event.reason == HH_REASON_NO_SURFACE ? "nothing there;" : "refused;";
                break;
            case HH_EVENT_SLIPPED:
                log += "slipped;";
                break;
            case HH_EVENT_CONTACT_BEGAN:  // impulse_ns, N s: the strength of a knock
                log += event.side >= 0 ? "knock;" : "head;";
                break;
            default:
                break;
        }
    }
}

// A hand that pulls hard shakes: from the force between it and what it grips.
double rumble(const hh::World& world, hh::Player player, hh::Side side, double dt_s) {
    const hh::Vec3 impulse = world.hand(player, side)->force_impulse_ns;
    const double force_n = std::hypot(impulse.x, impulse.y, impulse.z) / dt_s;
    return std::fmin(1.0, force_n / 300.0);
}
// [loop]

}  // namespace

int main() {
    hh::World world;
    hh_body_def crate = hh::body_def();
    crate.kind = HH_DYNAMIC;
    crate.mass_kg = 2.0;
    crate.shape = *world.add_box({0.1, 0.1, 0.1});
    crate.pose.position = {0.2, 1.4, -0.6};
    const hh::Body crate_id = *world.add(crate);
    hh_body_def wall = hh::body_def();
    wall.shape = *world.add_box({0.1, 2.0, 2.0});
    wall.pose.position = {1.0, 1.4, 0.0};
    (void)world.add(wall);
    const hh::Player you = *world.add(hh::player_def());
    if (!world.use_wrists(you)) {
        return 1;
    }
    std::string log;
    double strongest = 0.0;
    constexpr double k_dt_s = 1.0 / 90.0;
    for (int frame = 1; frame <= 220; ++frame) {
        hh::Sample sample = hh::sample();
        sample.time_s = frame * k_dt_s;
        sample.head.position.y = 1.6;
        const hh::Quat palm_ahead{std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)};
        sample.hands[HH_LEFT] = hh::pose_at({-0.3, 1.2, -0.3}, palm_ahead);
        // The right hand carries the crate towards the wall and knocks.
        const double carried_m = 0.8 * std::fmin(std::fmax(sample.time_s - 1.0, 0.0), 0.8);
        sample.hands[HH_RIGHT] = hh::pose_at({0.2 + carried_m, 1.4, -0.43}, palm_ahead);
        sample.grab[HH_RIGHT] = frame > 45;
        sample.grab[HH_LEFT] = frame > 45;  // closes on nothing
        if (frame == 200 && !world.release(you, HH_RIGHT)) {
            return 1;
        }
        if (!world.step(k_dt_s, hh::input(you, {&sample, 1}))) {
            return 1;
        }
        react(world, log);
        strongest = std::fmax(strongest, rumble(world, you, HH_RIGHT, k_dt_s));
    }
    std::printf("%s strongest rumble %.2f\n", log.c_str(), strongest);
    const bool is_right =
        log == "grabbed;nothing there;knock;taken away;" && strongest > 0.0 && world.has(crate_id);
    return is_right ? 0 : 1;
}
