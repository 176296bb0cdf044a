#pragma once

#include <algorithm>
#include <limits>

#include "tests/random.hpp"
#include "tests/systems/frame/scenario.hpp"

namespace handhold::tracking_errors_test {

using test::Random;

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
constexpr double k_sample_rates_hz[] = {30.0, 60.0, 72.0, 90.0, 120.0, 144.0, 500.0, 1000.0};

inline double pick_rate(Random& random) {
    return k_sample_rates_hz[static_cast<std::size_t>(random.between(0.0, 7.999))];
}

inline Pose lost() { return {Vec3::Constant(k_nan), Quat::Identity()}; }

inline Vec3 view(const Scenario& scenario) {
    return scenario.world.render_pose.at(scenario.player.player).head_ws.position;
}

// Right hand on a wall of which it grips the front; the palm faces it.
struct Climb {
    Scenario scenario;
    Pose hand;  // at rest

    explicit Climb(Random& random) {
        scenario.fits_hands = false;
        scenario.hz = random.between(30.0, 144.0);
        scenario.sample_hz = pick_rate(random);
        scenario.add_wall("wall", Vec3(3.0, 3.0, 0.2), Vec3(0.0, 1.2, -0.7));
        const Quat to_wall = rotation_about(Vec3::UnitX(), k_half_pi);  // the palm looks to -Z
        const Vec3 palm(0.2, 1.2, -0.49);
        hand = {palm - to_wall * scenario.tuning.hand.palm_center_m, to_wall};
        scenario.script.head = [](double) { return Pose{Vec3(0.0, 1.6, 0.0), Quat::Identity()}; };
        scenario.script.hands[1] = [this](double) { return hand; };
        scenario.script.grabs[1] = [](double t_s) { return t_s > 0.1; };
        scenario.add_player_here();
    }
    Climb(const Climb&) = delete;
    Climb& operator=(const Climb&) = delete;

    bool grips() const { return scenario.grab(HandSide::right).kind == GripKind::surface; }
    // The farthest that the view moved in any frame.
    double run_and_measure(double seconds) {
        if (scenario.world.clock.frame == 0) {
            scenario.step();
        }
        double farthest_m = 0.0;
        Vec3 before = view(scenario);
        scenario.run(seconds, [&] {
            farthest_m = std::max(farthest_m, (view(scenario) - before).norm());
            before = view(scenario);
        });
        return farthest_m;
    }
};

}  // namespace handhold::tracking_errors_test
