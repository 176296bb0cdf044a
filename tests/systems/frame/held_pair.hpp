#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "systems/grab/shared/body_parts.hpp"
#include "tests/random.hpp"
#include "tests/systems/frame/scenario.hpp"

// Two players, of whom one grips a part of the other's body.
namespace handhold::scenario_body_grip_test {

using test::Random;

constexpr double k_step_s = 1.0 / 90.0;
constexpr double k_reach_from_s = 1.0;  // the bodies hang still by then
constexpr double k_grab_s = 2.0;
constexpr std::size_t k_holder = 0;
constexpr std::size_t k_held = 1;
constexpr std::size_t k_left = index_of(HandSide::left);
constexpr std::size_t k_right = index_of(HandSide::right);
constexpr double k_half_turn_rad = 3.14159265358979323846;
inline const Vec3 k_held_head(0.0, 1.6, 0.0);

// A hand whose palm's centre is at `palm` and looks along `palm_way`.
inline Pose hand_with_palm(const Vec3& palm, const Vec3& palm_way, const HandTuning& tuning) {
    const Quat rotation = Quat::FromTwoVectors(-Vec3::UnitY(), palm_way);
    return {palm - rotation * tuning.palm_center_m, rotation};
}

// The holder's right hand moves to a part of the other's body and closes on it.
struct Pair {
    ShapeLibrary shapes;
    World world;
    Tuning tuning;
    StageStats stats;
    std::array<DeviceScript, 2> scripts;
    std::array<PlayerEntities, 2> players;
    std::array<PlayerCommands, 2> commands;
    std::unique_ptr<FrameCaches> caches;
    double release_s = 1e9;
    Pose touch;  // the holder's right hand, in his play space, when it closes
    std::function<Vec3(double)> way = [](double) { return Vec3(Vec3::Zero()); };

    explicit Pair(double holder_kg = 80.0, double held_kg = 80.0) {
        tuning.locomotion.drift_drag_per_s = 0.0;
        for (std::size_t i = 0; i < players.size(); ++i) {
            PlayerDescription description;
            description.name = i == k_holder ? "holder" : "held";
            description.body.mass_kg = i == k_holder ? holder_kg : held_kg;
            description.head_shape = shapes.add_sphere(tuning.head.radius_m);
            players[i] = add_player(world, description);
            for (const Entity hand : players[i].hands) {
                world.controller_to_hand.add(hand, {});
            }
        }
        scripts[k_held].head = [](double) { return Pose{k_held_head, Quat::Identity()}; };
        scripts[k_holder].head = [](double) {
            return Pose{Vec3(0.0, 1.6, 3.0), Quat::Identity()};  // far off until it is placed
        };
        scripts[k_holder].grabs[k_right] = [this](double t) {
            return t > k_grab_s && t < release_s;
        };
        drop_caches();
    }
    Pair(const Pair&) = delete;
    Pair& operator=(const Pair&) = delete;

    void drop_caches() { caches = std::make_unique<FrameCaches>(shapes); }

    const RenderPose& shown(std::size_t i) const { return world.render_pose.at(players[i].player); }
    PartCapsule capsule(BodyPart part) const {
        return part_capsule(shown(k_held), world.body_measures.at(players[k_held].player), part);
    }

    // Lets the bodies come to rest, and plans the holder's reach for a point on the part: a share
    // of its length, in a direction across it.
    void plan(BodyPart part, double along, const Vec3& direction) {
        run(k_reach_from_s);
        const PartCapsule target = capsule(part);
        const Vec3 axis = (target.frame_ws.rotation * target.end_bs).normalized();
        Vec3 out = direction - axis * axis.dot(direction);
        out.normalize();
        const Vec3 on_axis = transform_point(target.frame_ws, along * target.end_bs);
        if (out.dot(on_axis - k_held_head) < 0.0) {
            out = -out;  // away from the other's head
        }
        touch = hand_with_palm(on_axis + (target.radius_m + 0.004) * out, -out, tuning.hand);
        const Vec3 head = on_axis + 0.8 * out + Vec3(0.0, 0.15, 0.0);
        const Vec3 far = touch.position + 0.2 * out;
        const Vec3 start_head = scripts[k_holder].head(0.0).position;
        // Around the other: a head that meets legs on its way leaves them swinging.
        const Vec3 aside = std::copysign(1.5, head.x()) * Vec3::UnitX();
        scripts[k_holder].head = [=](double t) {
            const double share = ease(t, k_reach_from_s, 1.5);
            const Vec3 arc = std::sin(k_half_turn_rad * share) * aside;
            return Pose{start_head + share * (head - start_head) + arc, Quat::Identity()};
        };
        const Vec3 start_hand = scripts[k_holder].hands[k_right](0.0).position;
        scripts[k_holder].hands[k_right] = [=, this](double t) {
            const double first = ease(t, k_reach_from_s, 1.5);
            const double second = ease(t, 1.5, 1.9);
            return Pose{
                start_hand + first * (far - start_hand) + second * (touch.position - far) + way(t),
                touch.rotation};
        };
        tuning.tracking.max_hand_speed_mps = 100.0;
    }

    std::uint64_t step() {
        const double end_s = world.clock.t_s + k_step_s;
        std::array<std::array<TrackingSample, 2>, 2> samples;
        std::vector<PlayerInput> inputs;
        for (std::size_t p = 0; p < players.size(); ++p) {
            samples[p] = {sample_of(scripts[p], world.clock.t_s), sample_of(scripts[p], end_s)};
            inputs.push_back({players[p].player, samples[p], commands[p]});
        }
        step_frame(world, *caches, tuning, {k_step_s, inputs}, stats);
        return hash_state(world);
    }
    void run(
        double seconds, const std::function<void()>& after_frame = [] {}) {
        for (int i = 0; i < static_cast<int>(std::lround(seconds / k_step_s)); ++i) {
            step();
            after_frame();
        }
    }
    void run_until(
        double end_s, const std::function<void()>& after_frame = [] {}) {
        run(end_s - t_s(), after_frame);
    }

    double t_s() const { return world.clock.t_s; }
    const Grab& grab() const { return world.grab.at(players[k_holder].hands[k_right]); }
    const BodyHold* hold() const { return world.body_hold.find(players[k_holder].hands[k_right]); }
    bool holds_body() const { return grab().kind == GripKind::player && hold() != nullptr; }
    Vec3 origin(std::size_t i) const {
        return world.player_origin.at(players[i].player).pose_ws.position;
    }
    Vec3& velocity(std::size_t i) { return world.player_velocity.at(players[i].player).linear_mps; }
    double mass_kg(std::size_t i) const { return world.player.at(players[i].player).mass_kg; }
    double share(std::size_t i) const { return mass_kg(1 - i) / (mass_kg(0) + mass_kg(1)); }
    Vec3 momentum() { return mass_kg(0) * velocity(0) + mass_kg(1) * velocity(1); }
    Vec3 center() const {
        return (mass_kg(0) * origin(0) + mass_kg(1) * origin(1)) / (mass_kg(0) + mass_kg(1));
    }
};

// A held player whose hands are at a random place in front of him, and a part to grip.
struct Draw {
    std::array<double, 2> mass_kg{};
    std::array<Vec3, 2> hands;
    BodyPart part = BodyPart::left_forearm;
    double along = 0.5;
    Vec3 direction;
};
inline Draw draw(std::uint64_t seed) {
    Random random(seed);
    Draw out;
    out.mass_kg = {random.between(40.0, 140.0), random.between(40.0, 140.0)};
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        const double across = side == k_left ? -1.0 : 1.0;
        out.hands[side] = k_held_head + Vec3{across * random.between(0.15, 0.5),
                                             random.between(-0.6, 0.0), -random.between(0.2, 0.5)};
    }
    out.part = static_cast<BodyPart>(seed % k_gripped_parts);
    out.along = random.between(0.3, 0.7);
    out.direction = random.direction();
    return out;
}
inline std::unique_ptr<Pair> prepare(const Draw& draw) {
    auto pair = std::make_unique<Pair>(draw.mass_kg[k_holder], draw.mass_kg[k_held]);
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        pair->scripts[k_held].hands[side] = [at = draw.hands[side]](double) {
            return Pose{at, Quat::Identity()};
        };
    }
    pair->plan(draw.part, draw.along, draw.direction);
    return pair;
}

}  // namespace handhold::scenario_body_grip_test
