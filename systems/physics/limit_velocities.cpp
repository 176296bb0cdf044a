#include "systems/physics/limit_velocities.hpp"

#include <algorithm>
#include <optional>

#include "systems/physics/shared/speed_limits.hpp"

namespace handhold {
namespace {

bool is_slower(const Vec3& velocity_mps, double limit_mps) {
    return velocity_mps.squaredNorm() < limit_mps * limit_mps;
}

// Limits the speed relative to the reference. Returns true if the limit was exceeded.
bool clamp_speed(const Vec3& reference_mps, double limit_mps, Vec3& velocity_mps) {
    const Vec3 relative = velocity_mps - reference_mps;
    const double speed = relative.norm();
    if (speed <= limit_mps) {
        return false;
    }
    velocity_mps = reference_mps + relative * (limit_mps / speed);
    return true;
}

// Limits the velocities of players that were pushed or that grip a surface. A tracking jump may
// have caused the motion. It must not launch the player, now or when the grip breaks in the next
// frame. The limit is never below the player's speed before the frame, or the speed of a driven or
// heavy body in the player's island. Poses do not change.
void clamp_players(const LimitVelocitiesIo& io, const LocomotionTuning& tuning, StageStats& stats) {
    for (const Island& island : io.frame.graph.islands) {
        for (const std::uint32_t i : io.frame.graph.bodies_of(island)) {
            const FrameGraph::PhaseBody& info = io.frame.phase[i];
            if (io.frame.graph.bodies[i].role != BodyRole::translating ||
                !(info.pushed || info.grips_surface)) {
                continue;
            }
            const Entity player = io.frame.entities[i];
            const Vec3& reference = io.reference.at(player).linear_mps;
            const double limit =
                std::max({io.origin.at(player).scale * tuning.release_speed_max_mps,
                          (info.velocity_before_mps - reference).norm(),
                          driven_speed(io.frame, island, reference)});
            if (clamp_speed(reference, limit, io.player_velocity.at(player).linear_mps) &&
                info.pushed) {
                stats.count(Fallback::release_speed_clamped);
            }
        }
    }
}

// Limits the velocities of held and pushed bodies. A tracking jump may tear a body from the hand in
// the next frame, and the body must not leave at the speed of the jump. Poses do not change: a held
// body still follows its hand.
void clamp_handled_bodies(const LimitVelocitiesIo& io, const LocomotionTuning& tuning,
                          StageStats& stats) {
    const FrameGraph& frame = io.frame;
    for (const Island& island : frame.graph.islands) {
        const std::optional<ObjectSpeedLimit> limits =
            object_speed_limit(frame, island, io.reference, io.origin, tuning);
        if (!limits) {
            continue;
        }
        const auto& [reference, max_mps] = *limits;
        std::optional<double> driven;  // computed once, and only if a body is fast
        for (const std::uint32_t i : frame.graph.bodies_of(island)) {
            if (frame.graph.bodies[i].role != BodyRole::free) {
                continue;
            }
            Vec3& velocity_mps = io.body_velocity.at(frame.entities[i]).linear_mps;
            if (is_slower(velocity_mps - reference, max_mps)) {
                continue;  // most bodies are slow enough
            }
            const double before = (frame.phase[i].velocity_before_mps - reference).norm();
            if (!driven) {
                driven = driven_speed(frame, island, reference);
            }
            const double limit = std::max({max_mps, before, *driven});
            if (clamp_speed(reference, limit, velocity_mps)) {
                stats.count(Fallback::object_speed_clamped);
            }
        }
    }
}

void finish_releases(const LimitVelocitiesIo& io, const LocomotionTuning& tuning,
                     StageStats& stats) {
    for (std::size_t index = 0; index < io.grab.size(); ++index) {
        Grab& grab = io.grab.elements()[index];
        const Entity player = io.owner.at(io.grab.owners()[index]).player;
        const Vec3& reference = io.reference.at(player).linear_mps;
        const double scale = io.origin.at(player).scale;
        if (grab.phase != GrabPhase::releasing) {
            continue;
        }
        bool clamped = false;
        if (grab.kind != GripKind::held) {
            clamped = clamp_speed(reference, scale * tuning.release_speed_max_mps,
                                  io.player_velocity.at(player).linear_mps);
        } else if (!grab.jointed) {
            // Jointed bodies may be on a moving ship. clamp_handled_bodies allows for the ship's
            // speed.
            clamped = clamp_speed(reference, scale * tuning.object_speed_max_mps,
                                  io.body_velocity.at(grab.body).linear_mps);
        }
        if (clamped) {
            stats.count(Fallback::release_speed_clamped);
        }
        grab = {};
    }
}

}  // namespace

void limit_velocities(const LimitVelocitiesIo& io, const LocomotionTuning& tuning,
                      StageStats& stats) {
    clamp_handled_bodies(io, tuning, stats);
    finish_releases(io, tuning, stats);
    clamp_players(io, tuning, stats);
}

}  // namespace handhold
