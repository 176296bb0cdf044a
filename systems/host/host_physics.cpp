// C interface for hosts with their own physics (handhold/your_physics.h): surfaces, poses of bodies
// and players, and what hands hold. host_solver.cpp has the step around a host's solver.
#include <algorithm>
#include <iterator>
#include <vector>

#include "components/play_space.hpp"
#include "components/scaled_tuning.hpp"
#include "components/world_edit.hpp"
#include "systems/grab/shared/grip_kind.hpp"
#include "systems/host/host_step.hpp"

namespace handhold {
namespace {

constexpr const char* k_motion_text = "a velocity beyond 1e6 m/s or 1e4 rad/s, or NaN";

struct ToldMotion {
    Entity body;
    Pose pose_ws;
    BodyVelocity velocity;
};

ToldMotion read_motion(const hh_world& host, const hh_body_motion& motion) {
    const Entity body = body_of(host, motion.body);
    return {
        body,
        library_pose(host, body, checked(motion.pose)),
        {checked(motion.velocity_mps, world_limits::k_max_speed_mps, k_motion_text),
         checked(motion.angular_velocity_radps, world_limits::k_max_spin_radps, k_motion_text)}};
}

void place(World& world, const ToldMotion& motion) {
    const BodyKind kind = world.body.at(motion.body).kind;
    world.body_pose.at(motion.body).pose_ws = motion.pose_ws;
    if (kind == BodyKind::fixed) {
        world.body_start.at(motion.body).pose_ws = motion.pose_ws;
        return;
    }
    world.body_velocity.at(motion.body) = motion.velocity;
    if (LastValidPose* const valid = world.last_valid.find(motion.body)) {
        *valid = {motion.pose_ws, true};
    }
    if (kind == BodyKind::kinematic) {  // stays there unless the host says where it goes
        if (MoveTarget* const target = world.move_target.find(motion.body)) {
            target->pose_ws = motion.pose_ws;
        } else {
            world.move_target.add(motion.body, {.pose_ws = motion.pose_ws});
        }
    }
}

}  // namespace
}  // namespace handhold

using namespace handhold;

hh_result hh_default_surface_query_sized(hh_surface_query* filled, size_t size) {
    hh_surface_query query{};
    return write_default(filled, size, query);
}

hh_result hh_world_set_surface_query(hh_world* world, const hh_surface_query* query) {
    return call([&] {
        hh_world& host = world_of(world);
        require_idle(host);
        if (query == nullptr) {
            host.caches.host_surfaces = {};
            return;
        }
        host.surfaces.set(read_def(query, hh_default_surface_query()));
        host.caches.host_surfaces = SurfaceQuery(host.surfaces);
    });
}

hh_result hh_body_set_surface(hh_world* world, hh_body body, const hh_mesh* mesh) {
    return call([&] {
        hh_world& host = world_of(world);
        const Entity entity = body_of(host, body);
        if (mesh == nullptr) {
            host.caches.body_surfaces.remove(entity);
            return;
        }
        require(!host.world.collider.contains(entity), HH_ERROR_STATE, "the body has a shape");
        require(host.settings.fits_hands && mesh->grip != nullptr, HH_ERROR_STATE,
                "the mesh or the world was made without fits_hands");
        host.caches.body_surfaces.remove(entity);
        host.caches.body_surfaces.add(entity, {mesh->grip});
        forget_surface(host.world, entity);
    });
}

hh_result hh_world_place_bodies(hh_world* world, const hh_body_motion* motions, size_t count) {
    return call([&] {
        hh_world& host = world_of(world);
        require(count == 0 || motions != nullptr, HH_ERROR_NULL, "the motions are null");
        require_at_most(count, host.world.body.size(), "motions", "bodies");
        host.is_there.assign(host.world.body.size(), 0);
        for (std::size_t i = 0; i < count; ++i) {
            std::uint8_t& is_there =
                host.is_there[host.world.body.find_index(read_motion(host, motions[i]).body)];
            require(is_there == 0, HH_ERROR_VALUE,
                    [&] { return "motion " + std::to_string(i) + ": its body is there twice"; });
            is_there = 1;
        }
        for (std::size_t i = 0; i < count; ++i) {
            const ToldMotion motion = read_motion(host, motions[i]);
            place(host.world, motion);
            if (host.is_stepping) {
                host.are_placed[host.world.body.find_index(motion.body)] = 1;
            }
        }
    });
}

hh_result hh_player_place(hh_world* world, hh_player player, hh_pose origin, hh_vec3 velocity_mps) {
    return call([&] {
        hh_world& host = world_of(world);
        require_idle(host);
        const Entity entity = player_of(host, player);
        const Pose origin_ws = play_space_ws(host, entity, checked(origin));
        const Vec3 velocity = checked(velocity_mps, world_limits::k_max_speed_mps,
                                      "a velocity beyond 1e6 m/s, or NaN");
        host.world.player_origin.at(entity).pose_ws = origin_ws;
        host.world.player_start.at(entity).pose_ws = origin_ws;
        host.world.player_velocity.at(entity).linear_mps = velocity;
        // Forgets the last valid pose: no sweep over the distance from there.
        host.world.last_valid.at(entity).known = false;
    });
}

hh_result hh_hand_hold(hh_world* world, hh_player player, hh_side side, hh_body body,
                       const hh_pose* anchor) {
    return call([&] {
        hh_world& host = world_of(world);
        require_idle(host);
        const Entity owner = player_of(host, player);
        const Entity hand = hand_of(host.world, owner, side_of(side));
        if (body.generation == 0) {
            host.world.grab.at(hand) = {};
            return;
        }
        const Entity held = body_of(host, body);
        const HandTracking& tracking = host.world.hand_tracking.at(hand);
        Pose anchor_bs;
        if (anchor != nullptr) {
            anchor_bs = from_host_bs(host, held, checked(*anchor));
        } else {
            require(tracking.state != TrackingState::never, HH_ERROR_STATE,
                    "the hand was never tracked (a pose at exactly (0, 0, 0) is ignored)");
            anchor_bs = inverse(host.world.body_pose.at(held).pose_ws) *
                        (host.world.player_origin.at(owner).pose_ws * tracking.pose_ps);
        }
        Grab& grab = host.world.grab.at(hand);
        grab = {};
        grab.kind = grip_kind_of(host.world.body.at(held), host.tuning.phases.heavy_body_kg);
        grab.phase = GrabPhase::holding;
        grab.body = held;
        grab.anchor_bs = anchor_bs;
        grab.target_ps = tracking.pose_ps;
        grab.since_s = host.world.clock.t_s;
    });
}

hh_result hh_hand_find_grip(hh_world* world, hh_player player, hh_side side, hh_surface_hit* hit) {
    return call([&] {
        hh_world& host = world_of(world);
        require_idle(host);
        require(hit != nullptr, HH_ERROR_NULL, "the output is null");
        const Entity owner = player_of(host, player);
        const HandSide which = side_of(side);
        const Entity hand = hand_of(host.world, owner, which);
        const HandTracking& tracking = host.world.hand_tracking.at(hand);
        require(tracking.state != TrackingState::never, HH_ERROR_STATE,
                "the hand was never tracked (a pose at exactly (0, 0, 0) is ignored)");
        const auto target =
            find_grip(host.world, host.caches, host.tuning, hand, host.search_stats);
        hh_surface_hit found{};
        if (target && host.world.body.contains(target->body)) {
            const PlayerOrigin& origin = host.world.player_origin.at(owner);
            TuningOfPlayers tunings(host.tuning);
            const Vec3 palm_ws =
                palm_ray(origin.pose_ws * tracking.pose_ps, which, tunings.of(origin).hand).palm_ws;
            found = {id_of<hh_body>(target->body), to_c(target->point_ws), to_c(target->normal_ws),
                     (target->point_ws - palm_ws).norm()};
        }
        *hit = found;
    });
}

hh_result hh_world_step_hands(hh_world* world, double dt_s, const hh_player_input* inputs,
                              size_t input_count) {
    return step_with(world, dt_s, inputs, input_count,
                     {.run = &show_host_frame, .moves_bodies = false});
}

hh_result hh_world_held_bodies(const hh_world* world, hh_body* bodies, size_t capacity,
                               size_t* count) {
    return call([&] {
        const hh_world& host = world_of(world);
        std::vector<Entity> held;  // bodies that still exist
        std::ranges::copy_if(host.held_bodies, std::back_inserter(held),
                             [&](Entity body) { return host.world.body.contains(body); });
        write_list(held.size(), bodies, capacity, count,
                   [&](std::size_t i) { return id_of<hh_body>(held[i]); });
    });
}
