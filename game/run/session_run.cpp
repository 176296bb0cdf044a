#include "game/run/session_run.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/parallel.hpp"
#include "engine/core/profile.hpp"
#include "game/climber/crowd.hpp"

namespace handhold {
namespace {

constexpr double k_seconds_without_recording = 10.0;
constexpr std::uint64_t k_frames_reserved = 10000;

// Index of an entity in RunLog::body_names; -1: none.
class BodyIndex {
  public:
    explicit BodyIndex(const World& world) {
        for (std::size_t row = 0; row < world.body.size(); ++row) {
            index_.add(world.body.owners()[row], static_cast<std::int32_t>(row));
        }
    }
    std::int32_t of(Entity body) const {
        const std::int32_t* const found = index_.find(body);
        return found != nullptr ? *found : -1;
    }

  private:
    Column<std::int32_t> index_;
};

PlayerLog log_player(const World& world, std::uint32_t index, const PlayerEntities& player,
                     const BodyIndex& bodies) {
    const RenderPose& render = world.render_pose.at(player.player);
    PlayerLog log;
    log.player = index;
    log.origin_ws = world.player_origin.at(player.player).pose_ws.position;
    log.velocity_mps = world.player_velocity.at(player.player).linear_mps;
    log.head_ws = render.head_ws.position;
    log.push_back_m = render.push_back_m;
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        const Grab& grab = world.grab.at(player.hands[side]);
        HandLog& hand = log.hands[side];
        hand.target_ws = render.hands[side].tracked_ws.position;
        hand.shown_ws = render.hands[side].shown_ws.position;
        hand.grip = static_cast<int>(render.hands[side].grip);
        hand.body = bodies.of(grab.body);
        hand.error_m = grab.kind != GripKind::none ? grab.error_m : 0.0;
    }
    return log;
}

// Writes one frame to a log, which is overwritten. A log that was used before needs no allocation.
void log_frame(const Scene& scene, const std::vector<PlayerEntities>& players,
               const BodyIndex& bodies, const StageStats& stats, FrameLog& log) {
    const World& world = scene.world;
    log.players.clear();
    log.bodies.clear();
    log.frame = world.clock.frame;
    log.t_s = world.clock.t_s;
    log.stats = stats;
    for (std::uint32_t i = 0; i < players.size(); ++i) {
        log.players.push_back(log_player(world, i, players[i], bodies));
    }
    for (std::size_t row = 0; row < world.body.size(); ++row) {
        if (world.body.rows()[row].kind == BodyKind::fixed) {
            continue;
        }
        const Entity body = world.body.owners()[row];
        const BodyVelocity& velocity = world.body_velocity.at(body);
        log.bodies.push_back({static_cast<std::uint32_t>(row), world.body_pose.at(body).pose_ws,
                              velocity.linear_mps, velocity.angular_radps});
    }
}

// Bytes of a player and of their hands in all columns, including owners and indices.
std::size_t state_bytes(const World& world, const PlayerEntities& player) {
    std::size_t bytes = 0;
    visit_columns(world, [&](const char*, const auto& column) {
        using Row = typename std::decay_t<decltype(column)>::Row;
        constexpr std::size_t k_place = sizeof(Entity) + sizeof(std::uint32_t);
        for (const Entity entity : {player.player, player.hands[0], player.hands[1]}) {
            bytes += column.contains(entity) ? sizeof(Row) + k_place : 0;
        }
    });
    return bytes;
}

RunLog begin_log(const Scene& scene, const std::vector<PlayerEntities>& players,
                 const RunSettings& settings) {
    RunLog log;
    log.scene = scene.name;
    log.hz = settings.hz;
    log.threads = settings.threads;
    for (std::size_t i = 0; i < players.size(); ++i) {
        log.player_names.push_back("player" + std::to_string(i));
        log.player_mass_kg.push_back(scene.world.player.at(players[i].player).mass_kg);
    }
    log.bytes_per_player = players.empty() ? 0 : state_bytes(scene.world, players.front());
    log.body_names = scene.body_names;
    for (const RigidBody& body : scene.world.body.rows()) {
        log.body_mass_kg.push_back(body.kind == BodyKind::free ? body.mass_kg : 0.0);
    }
    return log;
}

}  // namespace

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

RunLog run_session(Scene& scene, FrameCaches& caches, const std::vector<PlayerEntities>& players,
                   const Recording* recording, const RunSettings& settings,
                   const FrameObserver& observe) {
    set_thread_count(settings.threads);
    const double dt_s = 1.0 / settings.hz;
    std::vector<Playback> playbacks;
    if (recording != nullptr) {
        playbacks.emplace_back(*recording);
        for (const Recording* const one : settings.more_recordings) {
            playbacks.emplace_back(*one);
        }
    }
    const double begin_s = scene.world.clock.t_s;
    const double seconds = session_length_s(recording, settings) - begin_s;
    constexpr double k_rounding =
        1e-3;  // share of a frame; the clock is a sum with rounding errors
    const auto frames =
        static_cast<std::uint64_t>(std::max(1.0, std::floor(seconds * settings.hz + k_rounding)));
    if (scene.world.clock.frame > 0) {
        for (Playback& playback : playbacks) {
            playback.window(begin_s);  // skip what was played before the snapshot
        }
    }

    RunLog log = begin_log(scene, players, settings);
    // Enough for minutes. A file may claim any length, which must not decide how much memory is
    // reserved.
    log.frames.reserve(settings.keep_frames ? std::min<std::uint64_t>(frames, k_frames_reserved)
                                            : 1);
    const BodyIndex bodies(scene.world);
    const std::size_t recorded = std::min(players.size(), settings.climbers_from);
    Crowd climbers(scene, std::span(players).subspan(recorded), settings.seed);
    std::vector<PlayerInput> inputs(players.size());
    std::vector<std::span<const TrackingSample>> windows(playbacks.size());
    StageStats stats;
    for (std::uint64_t frame = 0; frame < frames; ++frame) {
        const double end_s = scene.world.clock.t_s + dt_s;
        for (std::size_t i = 0; i < playbacks.size(); ++i) {
            windows[i] = playbacks[i].window(end_s);
        }
        for (std::size_t i = 0; i < recorded; ++i) {
            inputs[i] = {players[i].player, {}, {}};
            if (!playbacks.empty()) {
                const std::size_t own = i < playbacks.size() ? i : 0;
                inputs[i].samples = windows[own];
                inputs[i].commands = playbacks[own].commands();
            }
        }
        climbers.drive(scene, caches, end_s, std::span(inputs).subspan(recorded));
        const std::int64_t begin_ns = now_ns();
        step_frame(scene.world, caches, scene.tuning, {dt_s, inputs}, stats);
        log.wall_s += 1e-9 * static_cast<double>(now_ns() - begin_ns);
        if (settings.keep_frames || log.frames.empty()) {
            log.frames.emplace_back();
        }
        log_frame(scene, players, bodies, stats, log.frames.back());
        if (observe) {
            observe(scene, log.frames.back());
        }
        if (settings.should_stop != nullptr && settings.should_stop()) {
            break;
        }
    }
    log.state_hash = hash_state(scene.world);
    return log;
}

}  // namespace handhold
