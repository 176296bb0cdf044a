#include "game/run/session_run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "game/climber/crowd.hpp"

namespace handhold {
namespace {

constexpr double k_seconds_without_recording = 10.0;
constexpr std::uint64_t k_frames_reserved = 10000;

std::size_t count_names(const char* (*name_of)(std::size_t)) {
    std::size_t count = 0;
    while (name_of(count) != nullptr) {
        ++count;
    }
    return count;
}

// The world's bodies, which stay the same during a run.
struct LoggedBodies {
    explicit LoggedBodies(const hh::World& world) : ids(world.bodies()) {
        for (std::size_t i = 0; i < ids.size(); ++i) {
            if (ids[i].index >= index_of_slot.size()) {
                index_of_slot.resize(ids[i].index + std::size_t{1}, -1);
            }
            index_of_slot[ids[i].index] = static_cast<std::int32_t>(i);
            if (*world.kind(ids[i]) != HH_STATIC) {
                moving.push_back(static_cast<std::uint32_t>(i));
            }
        }
    }
    // Index in RunLog::body_names; -1: none.
    std::int32_t of(hh::Body body) const {
        const std::int32_t index =
            body.index < index_of_slot.size() ? index_of_slot[body.index] : -1;
        return index >= 0 && ids[static_cast<std::size_t>(index)] == body ? index : -1;
    }

    std::vector<hh::Body> ids;
    std::vector<std::uint32_t> moving;  // indices of kinematic and dynamic bodies
    std::vector<std::int32_t> index_of_slot;
};

PlayerLog log_player(const hh::World& world, std::uint32_t index, hh::Player player,
                     const LoggedBodies& bodies) {
    const hh_player_pose pose = *world.pose(player);
    PlayerLog log;
    log.player = index;
    log.origin_ws = pose.origin.position;
    log.velocity_mps = pose.velocity_mps;
    log.head_ws = pose.head.position;
    log.push_back_m = *world.push_back_m(player);
    for (const hh::Side side : {HH_LEFT, HH_RIGHT}) {
        const hh_hand_state& now = pose.hands[side];
        HandLog& hand = log.hands[side];
        hand.target_ws = now.tracked.position;
        hand.shown_ws = now.shown.position;
        hand.grip = now.grip;
        hand.body = bodies.of(now.body);
        hand.error_m = now.error_m;
    }
    return log;
}

void log_stats(const hh::World& world, RunStats& log) {
    const hh_world_stats stats = *world.stats();
    std::size_t count = 0;
    hh_world_stage_times(world.get(), log.stage_us.data(), log.stage_us.size(), &count);
    hh_world_fallbacks(world.get(), log.fallbacks.data(), log.fallbacks.size(), &count);
    log.grab_onsets = stats.hands_closed;
    log.grabs_gripped = stats.hands_gripped;
    log.islands = stats.islands;
    log.islands_pushed = stats.islands_pushed;
    log.contacts = stats.contacts;
    log.contact_rounds = stats.contact_rounds;
    log.newton_iterations = stats.newton_iterations;
    log.residual_m = stats.overlap_m;
    log.joint_error_m = stats.joint_error_m;
    log.joint_error_rad = stats.joint_error_rad;
    log.momentum = stats.momentum;
}

// Overwrites `log` with the last frame. Does not allocate if `log` held a frame before.
void log_frame(const hh::World& world, std::span<const hh::Player> players,
               const LoggedBodies& bodies, FrameLog& log) {
    log.players.clear();
    log.bodies.clear();
    log.frame = world.frame();
    log.t_s = world.time_s();
    log_stats(world, log.stats);
    for (std::uint32_t i = 0; i < players.size(); ++i) {
        log.players.push_back(log_player(world, i, players[i], bodies));
    }
    for (const std::uint32_t index : bodies.moving) {
        const hh::Body body = bodies.ids[index];
        const hh::World::Motion motion = *world.motion(body);
        log.bodies.push_back(
            {index, *world.pose(body), motion.velocity_mps, motion.angular_velocity_radps});
    }
}

RunLog begin_log(const Scene& scene, std::span<const hh::Player> players,
                 const LoggedBodies& bodies, const RunSettings& settings) {
    RunLog log;
    log.scene = scene.name;
    log.hz = settings.hz;
    log.threads = settings.threads;
    for (std::size_t i = 0; i < players.size(); ++i) {
        log.player_names.push_back("player" + std::to_string(i));
        log.player_mass_kg.push_back(*scene.host.mass_kg(players[i]));
    }
    log.body_names = scene.body_names;
    for (const hh::Body body : bodies.ids) {
        log.body_mass_kg.push_back(*scene.host.mass_kg(body));
    }
    return log;
}

// One playback for each recording. Those of a world that has run already begin at its time.
std::vector<Playback> begin_playbacks(const hh::World& world, const Recording* recording,
                                      const RunSettings& settings) {
    std::vector<Playback> playbacks;
    if (recording == nullptr) {
        return playbacks;
    }
    playbacks.emplace_back(*recording);
    for (const Recording* const one : settings.more_recordings) {
        playbacks.emplace_back(*one);
    }
    for (Playback& playback : playbacks) {
        if (world.frame() > 0) {
            playback.window(world.time_s());  // skips what was played before the snapshot
        }
    }
    return playbacks;
}

// Number of frames of the session, at least 1.
std::uint64_t frame_count(const hh::World& world, const Recording* recording,
                          const RunSettings& settings) {
    // Tolerance as a share of a frame, because the clock is a sum with rounding errors.
    constexpr double k_rounding = 1e-3;
    const double seconds = session_length_s(recording, settings) - world.time_s();
    return static_cast<std::uint64_t>(
        std::max(1.0, std::floor(seconds * settings.hz + k_rounding)));
}

}  // namespace

RunStats::RunStats()
    : stage_us(count_names(&hh_stage_name)), fallbacks(count_names(&hh_fallback_name)) {}

double session_length_s(const Recording* recording, const RunSettings& settings) {
    if (settings.seconds > 0.0) {
        return settings.seconds;
    }
    if (recording == nullptr) {
        return k_seconds_without_recording;
    }
    const auto length_s = [](const Recording& one) {
        return one.samples.back().t_s - one.samples.front().t_s;
    };
    double longest_s = length_s(*recording);
    for (const Recording* const one : settings.more_recordings) {
        longest_s = std::max(longest_s, length_s(*one));
    }
    return longest_s;
}

RunLog run_session(Scene& scene, std::span<const hh::Player> players, const Recording* recording,
                   const RunSettings& settings, const FrameObserver& observe) {
    hh::World& world = scene.host;
    if (hh_set_thread_count(static_cast<std::uint32_t>(settings.threads)) != HH_OK) {
        throw std::invalid_argument(hh_last_error());
    }
    const double dt_s = 1.0 / settings.hz;
    std::vector<Playback> playbacks = begin_playbacks(world, recording, settings);
    const std::uint64_t frames = frame_count(world, recording, settings);
    const LoggedBodies bodies(world);
    RunLog log = begin_log(scene, players, bodies, settings);
    // Reserves memory for at most k_frames_reserved frames (about two minutes at 90 Hz), because a
    // recording may claim any length.
    log.frames.reserve(settings.keep_frames ? std::min<std::uint64_t>(frames, k_frames_reserved)
                                            : 1);
    const std::size_t recorded = std::min(players.size(), settings.climbers_from);
    Crowd climbers(world, players.subspan(recorded), settings.seed);
    const ClimberSight sight = sight_of(scene);
    std::vector<hh_player_input> inputs(players.size());
    std::vector<std::span<const hh::Sample>> windows(playbacks.size());
    for (std::uint64_t frame = 0; frame < frames; ++frame) {
        const double end_s = world.time_s() + dt_s;
        for (std::size_t i = 0; i < playbacks.size(); ++i) {
            windows[i] = playbacks[i].window(end_s);
        }
        for (std::size_t i = 0; i < recorded; ++i) {
            inputs[i] = hh::input(players[i], {});
            if (!playbacks.empty()) {
                const std::size_t own = i < playbacks.size() ? i : 0;
                inputs[i] = hh::input(players[i], windows[own], playbacks[own].commands());
                inputs[i].repeats_samples = true;
            }
        }
        climbers.drive(sight, end_s, std::span(inputs).subspan(recorded));
        const auto begin = std::chrono::steady_clock::now();
        if (const hh::Status stepped = world.step(dt_s, inputs); !stepped) {
            throw std::runtime_error(std::string(stepped.text()));
        }
        if (scene.arena) {
            scene.arena->step(world, world.frame());
        }
        log.wall_s +=
            std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        if (settings.keep_frames || log.frames.empty()) {
            log.frames.emplace_back();
        }
        log_frame(world, players, bodies, log.frames.back());
        if (observe) {
            observe(scene, log.frames.back());
        }
        if (settings.should_stop != nullptr && settings.should_stop()) {
            break;
        }
    }
    log.state_hash = world.hash();
    return log;
}

}  // namespace handhold
