// What a host writes to give its players Handhold's hands: queries, poses in and out, and one joint
// a gripping hand.
#include <chrono>
#include <cmath>

#include "ode_engine.hpp"

namespace host {
namespace {

bool is_skipped(const Box& box, std::span<const hh_body> skip) {
    for (const hh_body id : skip) {
        if (id == box.id) {
            return true;
        }
    }
    return false;
}

hh::Vec3 vec(const dReal* v) { return {v[0], v[1], v[2]}; }

// Adds the time of a call. True if it succeeded.
template <typename Call>
bool timed(double& us, const Call& call) {
    const auto begin = std::chrono::steady_clock::now();
    const hh_result result = call();
    us +=
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count();
    return result == HH_OK;
}

}  // namespace

const Box* Engine::find(hh::Body id) const {
    for (const Box& box : boxes_) {
        if (box.id == id) {
            return &box;
        }
    }
    return nullptr;
}

// [queries]
bool Engine::cast_ray(hh::Vec3 from, hh::Vec3 to, std::span<const hh_body> skip,
                      hh_surface_hit& hit) const {
    double nearest = 1.0;
    bool is_found = false;
    for (const Box& box : boxes_) {
        hh::Vec3 normal{};
        const double fraction =
            is_skipped(box, skip) ? 2.0 : cast_on_box(box.pose(), box.half_m, from, to, normal);
        if (fraction <= nearest) {
            nearest = fraction;
            hit = {box.id, from + fraction * (to - from), normal, 0.0};
            is_found = true;
        }
    }
    return is_found;
}

bool Engine::closest_point(hh::Vec3 point, double max_m, std::span<const hh_body> skip,
                           hh_surface_hit& hit) const {
    bool is_found = false;
    for (const Box& box : boxes_) {
        hh_surface_hit here{box.id, {}, {}, 0.0};
        here.distance_m = closest_on_box(box.pose(), box.half_m, point, here.point, here.normal);
        if (!is_skipped(box, skip) && here.distance_m <= max_m) {
            max_m = here.distance_m;
            hit = here;
            is_found = true;
        }
    }
    return is_found;
}

hh_surface_query Engine::queries_for_hands() {
    hh_surface_query query = hh_default_surface_query();
    query.context = this;
    query.cast_ray = [](void* context, hh_vec3 from, hh_vec3 to, const hh_body* skip, size_t count,
                        hh_surface_hit* hit) -> std::uint8_t {
        ++static_cast<Engine*>(context)->queries_;
        return static_cast<Engine*>(context)->cast_ray(from, to, {skip, count}, *hit);
    };
    query.closest_point = [](void* context, hh_vec3 point, double max_m, const hh_body* skip,
                             size_t count, hh_surface_hit* hit) -> std::uint8_t {
        ++static_cast<Engine*>(context)->queries_;
        return static_cast<Engine*>(context)->closest_point(point, max_m, {skip, count}, *hit);
    };
    query.closest_point_on = [](void* context, hh_body body, hh_vec3 point,
                                hh_surface_hit* hit) -> std::uint8_t {
        ++static_cast<Engine*>(context)->queries_;
        const Box* const box = static_cast<Engine*>(context)->find(body);
        if (box == nullptr) {
            return false;
        }
        hit->distance_m = closest_on_box(box->pose(), box->half_m, point, hit->point, hit->normal);
        return true;
    };
    return query;
}
// [queries]

// [register]
void Engine::register_for_hands(hh::World& world) {
    const hh_surface_query query = queries_for_hands();
    hh_world_set_surface_query(world.get(), &query);
    for (Box& box : boxes_) {
        hh_body_def def = hh::body_def();  // no shape
        def.kind = box.kind == Kind::fixed    ? HH_STATIC
                   : box.kind == Kind::driven ? HH_KINEMATIC
                                              : HH_DYNAMIC;
        def.pose = box.pose();
        if (box.kind == Kind::dynamic) {
            dMass mass;
            dBodyGetMass(box.body, &mass);
            def.mass_kg = mass.mass;
            def.inertia_kgm2 = {mass.I[0], mass.I[5], mass.I[10]};
        }
        box.id = world.add(def).value_or({});
    }
}
// [register]

void Engine::add_player_for_hands(hh::Player id) {
    const dBodyID body = dBodyCreate(world_);
    players_.push_back({id, body});
}

dBodyID Engine::player_body(hh::Player id) const {
    for (const PlayerBody& player : players_) {
        if (player.id == id) {
            return player.body;
        }
    }
    return nullptr;
}

void Engine::place_for_hands(hh::World& world) {
    motions_.clear();
    for (const Box& box : boxes_) {
        if (box.kind == Kind::dynamic) {
            motions_.push_back({box.id, box.pose(), vec(dBodyGetLinearVel(box.body)),
                                vec(dBodyGetAngularVel(box.body))});
        }
    }
    for (const Driven& driven : driven_) {
        (void)world.move_kinematic(boxes_[driven.box].id, driven.end);
    }
    hh_world_place_bodies(world.get(), motions_.data(), motions_.size());
}

// [player]
// A player is a mass that cannot turn.
void Engine::set_player(const hh_player_motion& motion) {
    const dBodyID body = player_body(motion.player);
    constexpr double k_never_turns = 1e9;  // kg m^2 for each kg
    dMass mass;
    dMassSetSphereTotal(&mass, motion.mass_kg, 1.0);
    mass.I[0] = mass.I[5] = mass.I[10] = k_never_turns * motion.mass_kg;
    dBodySetMass(body, &mass);
    const dQuaternion upright = {1.0, 0.0, 0.0, 0.0};
    dBodySetQuaternion(body, upright);
    dBodySetAngularVel(body, 0.0, 0.0, 0.0);
    dBodySetPosition(body, motion.origin.x, motion.origin.y, motion.origin.z);
    dBodySetLinearVel(body, motion.velocity_mps.x, motion.velocity_mps.y, motion.velocity_mps.z);
}
// [player]

// [hand]
// One joint a hand. ODE takes a joint's frames from where its bodies are, so the player (or, for a
// weld, the body) is moved to where the step shall end while the joint is made.
void Engine::add_hand(const hh_hand_constraint& hand) {
    const dBodyID player = player_body(hand.player);
    const Box& box = *find(hand.body);
    if (hand.rows == HH_ROWS_DIRECTION) {
        add_direction(box, hand);
        return;
    }
    const hh::Vec3 origin = vec(dBodyGetPosition(player));
    const bool is_welded = hand.rows == HH_ROWS_WELD;
    const dJointID joint =
        is_welded ? dJointCreateFixed(world_, nullptr) : dJointCreateBall(world_, nullptr);
    if (is_welded) {
        const hh::Pose now = box.pose();
        const hh::Vec3 v = vec(dBodyGetLinearVel(box.body));
        const hh::Vec3 w = vec(dBodyGetAngularVel(box.body));
        const hh::Vec3 arm = rotate(hand.body_rotation, hand.anchor.position);
        const std::size_t index = static_cast<std::size_t>(&box - boxes_.data());
        set_motion(index, {origin + hand.target.position - arm, hand.body_rotation}, v, w);
        dJointAttach(joint, player, box.body);
        dJointSetFixed(joint);
        set_motion(index, now, v, w);
        dJointSetFixedParam(joint, dParamERP, 1.0);
        dJointSetFixedParam(joint, dParamCFM, 0.0);
    } else {
        const bool moves_freely = box.kind == Kind::dynamic;
        const hh::Vec3 point =
            moves_freely ? at(box.pose(), hand.anchor.position) : hand.anchor_end.position;
        const hh::Vec3 there = point - hand.target.position;
        dBodySetPosition(player, there.x, there.y, there.z);
        dJointAttach(joint, player, moves_freely ? box.body : nullptr);
        dJointSetBallAnchor(joint, point.x, point.y, point.z);
        dBodySetPosition(player, origin.x, origin.y, origin.z);
        dJointSetBallParam(joint, dParamERP, 1.0);
        dJointSetBallParam(joint, dParamCFM, 0.0);
    }
    hands_.push_back(joint);
}
// [hand]

// The second of two hands on one body: a motor that turns it in this step to where it shall be.
void Engine::add_direction(const Box& box, const hh_hand_constraint& hand) {
    hh::Quat turn = multiply(hand.body_rotation, conjugate(box.pose().rotation));
    if (turn.w < 0.0) {
        turn = {-turn.x, -turn.y, -turn.z, -turn.w};
    }
    const hh::Vec3 axis{turn.x, turn.y, turn.z};
    const double sine = length(axis);
    const double per_sine = sine > 0.0 ? 2.0 * std::atan2(sine, turn.w) / (sine * step_s_) : 0.0;
    const hh::Vec3 spin = per_sine * axis;
    const dJointID joint = dJointCreateAMotor(world_, nullptr);
    dJointAttach(joint, box.body, nullptr);
    dJointSetAMotorMode(joint, dAMotorUser);
    dJointSetAMotorNumAxes(joint, 3);
    dJointSetAMotorAxis(joint, 0, 0, 1.0, 0.0, 0.0);
    dJointSetAMotorAxis(joint, 1, 0, 0.0, 1.0, 0.0);
    dJointSetAMotorAxis(joint, 2, 0, 0.0, 0.0, 1.0);
    dJointSetAMotorParam(joint, dParamVel1, spin.x);
    dJointSetAMotorParam(joint, dParamVel2, spin.y);
    dJointSetAMotorParam(joint, dParamVel3, spin.z);
    for (const int force : {dParamFMax1, dParamFMax2, dParamFMax3}) {
        dJointSetAMotorParam(joint, force, dInfinity);
    }
    hands_.push_back(joint);
}

// [step]
bool Engine::step_for_hands(hh::World& world, double dt_s,
                            std::span<const hh_player_input> inputs) {
    step_s_ = dt_s;
    place_for_hands(world);
    if (!timed(hands_us_, [&] {
            return hh_world_begin_step(world.get(), dt_s, inputs.data(), inputs.size());
        })) {
        return false;
    }
    const hh_player_motion* players = nullptr;
    const hh_hand_constraint* hands = nullptr;
    size_t player_count = 0;
    size_t hand_count = 0;
    hh_world_player_motions(world.get(), &players, &player_count);
    hh_world_hand_constraints(world.get(), &hands, &hand_count);
    for (size_t i = 0; i < player_count; ++i) {
        set_player(players[i]);
    }
    for (size_t i = 0; i < hand_count; ++i) {
        add_hand(hands[i]);
    }

    step(dt_s);  // the engine's own

    for (const dJointID joint : hands_) {
        dJointDestroy(joint);
    }
    hands_.clear();
    solved_.clear();
    for (const PlayerBody& player : players_) {
        solved_.push_back(
            {player.id, vec(dBodyGetPosition(player.body)), vec(dBodyGetLinearVel(player.body))});
    }
    place_for_hands(world);
    if (!timed(hands_us_,
               [&] { return hh_world_end_step(world.get(), solved_.data(), solved_.size()); })) {
        return false;
    }
    const hh_velocity_change* changes = nullptr;
    size_t change_count = 0;
    hh_world_velocity_changes(world.get(), &changes, &change_count);
    for (size_t i = 0; i < change_count; ++i) {
        const hh_velocity_change& change = changes[i];
        const Box& box = *find(change.body);
        set_motion(static_cast<std::size_t>(&box - boxes_.data()), box.pose(), change.velocity_mps,
                   change.angular_velocity_radps);
    }
    return true;
}
// [step]

}  // namespace host
