#include "game/climber/climber_session.hpp"

#include <algorithm>
#include <stdexcept>

#include "game/session/interrupt.hpp"

namespace handhold {
namespace {

constexpr double k_hz = 90.0;

ClimberTask task_of(const ClimbPlan& plan, hh::Player player) {
    ClimberTask task;
    task.player = player;
    task.waypoints = plan.waypoints;
    task.cruise_mps = plan.cruise_mps;
    task.may_leap = plan.may_leap;
    task.picks_up_bodies = false;
    task.single_hand = plan.single_hand;
    return task;
}

}  // namespace

Recording record_climb(Scene& scene, const ClimbPlan& plan) {
    hh::World& world = scene.host;
    // Recordings contain no stick input, so the use of jets could not be replayed.
    if (world.frame() != 0 || !world.tune("locomotion.thruster_mps2", 0.0)) {
        throw std::invalid_argument("the scene has been played");
    }
    const ClimberTask task = task_of(plan, add_scene_player(scene, "player0", plan.origin_ws));
    ClimberState state = begin_climber(world, task, plan.seed);
    const ClimberSight sight = sight_of(scene);
    std::vector<hh::Sample> samples;
    Recording recording;
    double end_s = plan.seconds;
    while (world.time_s() < end_s) {
        climb(sight, task, world.time_s() + 1.0 / k_hz, state, samples);
        for (const hh::Sample& sample : samples) {
            if (recording.samples.empty() || sample.time_s > recording.samples.back().t_s) {
                recording.samples.push_back(recorded(sample));
            }
        }
        hh_player_input input = hh::input(task.player, samples);
        input.repeats_samples = true;
        if (const hh::Status stepped = world.step(1.0 / k_hz, input); !stepped) {
            throw std::runtime_error(std::string(stepped.text()));
        }
        if (is_at_target(task, state)) {
            end_s = std::min(end_s, state.waypoint_since_s + plan.linger_s);
        }
        if (is_interrupted()) {
            break;
        }
    }
    return recording;
}

}  // namespace handhold
