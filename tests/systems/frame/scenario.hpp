#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "components/world.hpp"
#include "engine/geometry/shape_library.hpp"
#include "systems/frame/frame.hpp"

// A small world for scenarios of whole frames: bodies by name, and one player whose devices follow
// functions of time.
namespace handhold {

// Device poses in play space; hands are given directly, not as controllers.
struct DeviceScript {
    std::function<Pose(double t_s)> head = [](double) {
        return Pose{Vec3(0.0, 1.6, 0.6), Quat::Identity()};
    };
    std::function<Pose(double t_s)> hands[k_hand_count] = {
        [](double) {
            return Pose{Vec3(-0.3, 1.2, 0.3), Quat::Identity()};
        },
        [](double) {
            return Pose{Vec3(0.3, 1.2, 0.3), Quat::Identity()};
        }};
    std::function<bool(double t_s)> grabs[k_hand_count] = {[](double) { return false; },
                                                           [](double) { return false; }};
};

// Eases from 0 to 1 between two times with continuous velocity and acceleration.
inline double ease(double t_s, double from_s, double to_s) {
    return smooth_step(t_s, from_s, to_s);
}

inline TrackingSample sample_of(const DeviceScript& script, double t_s) {
    TrackingSample sample;
    sample.t_s = t_s;
    sample.head_ps = script.head(t_s);
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        sample.controllers[side] = {script.hands[side](t_s), script.grabs[side](t_s)};
    }
    return sample;
}

class Scenario {
  public:
    ShapeLibrary shapes;
    World world;
    Tuning tuning;
    DeviceScript script;
    StageStats stats;
    PlayerEntities player;
    double hz = 90.0;
    double sample_hz = 90.0;  // of the devices
    // What runs a frame; hosts with physics of their own replace it.
    std::function<void(World&, FrameCaches&, const Tuning&, const FrameInput&, StageStats&)> frame =
        &step_frame;
    bool fits_hands = true;  // false: hands are shown as tracked, which is several times as fast

    // Applied to everything added, for moved and rotated worlds.
    Pose frame_ws;

    Entity add(const std::string& name, const RigidBody& body, ShapeId shape, const Pose& pose,
               const BodyVelocity& velocity = {}) {
        return add_body(world, {name,
                                body,
                                frame_ws * pose,
                                {frame_ws.rotation * velocity.linear_mps,
                                 frame_ws.rotation * velocity.angular_radps},
                                shape});
    }
    Entity add_wall(const std::string& name, const Vec3& half_m, const Vec3& center) {
        return add(name, {}, shapes.add_box(half_m), {center, Quat::Identity()});
    }
    Entity add_rock(const std::string& name, double mass_kg, const Vec3& center,
                    double radius_m = 0.08) {
        RigidBody body{BodyKind::free, mass_kg, Vec3::Constant(0.4 * mass_kg * radius_m * radius_m),
                       0.0};
        return add(name, body, shapes.add_sphere(radius_m), {center, Quat::Identity()});
    }
    Entity add_crate(const std::string& name, double mass_kg, const Vec3& center,
                     const Vec3& half_m) {
        const ShapeId shape = shapes.add_box(half_m);
        return add(name, {BodyKind::free, mass_kg, solid_inertia(shapes.at(shape), mass_kg), 0.0},
                   shape, {center, Quat::Identity()});
    }
    void set_motion(Entity body, const Vec3& velocity_mps, const Vec3& spin_radps,
                    bool turns = false) {
        world.body.at(body).kind = BodyKind::kinematic;
        const Mover mover{world.body_pose.at(body).pose_ws, frame_ws.rotation * velocity_mps,
                          frame_ws.rotation * spin_radps, turns};
        world.mover.add(body, mover);
        world.body_velocity.at(body) = {mover.velocity_ws_mps, mover.angular_velocity_ws_radps};
    }

    // Call after all bodies were added.
    void add_player_here(const Vec3& origin = Vec3::Zero(),
                         const Vec3& velocity_mps = Vec3::Zero()) {
        PlayerDescription description{"player",
                                      {},
                                      frame_ws * Pose{origin, Quat::Identity()},
                                      frame_ws.rotation * velocity_mps,
                                      shapes.add_sphere(tuning.head.radius_m)};
        player = add_player(world, description);
        for (const Entity hand : player.hands) {
            world.controller_to_hand.add(hand, {});  // scripts give hand poses, not controllers
        }
        if (fits_hands) {
            grip_meshes_ = GripMeshLibrary(shapes);
        }
        drop_caches();
    }
    void drop_caches() { caches_ = std::make_unique<FrameCaches>(shapes, &grip_meshes_); }

    // One frame. Devices are sampled at their own rate, with one sample beyond the frame's end.
    void step() {
        prepare_step();
        take_step();
    }
    // The two halves of step: sampling the devices, and the runtime's frame.
    void prepare_step() {
        const double end_s = world.clock.t_s + 1.0 / hz;
        samples_.clear();
        for (;;) {
            const double t_s = static_cast<double>(next_sample_) / sample_hz;
            samples_.push_back(sample_of(script, t_s));
            if (t_s > end_s) {
                break;
            }
            ++next_sample_;
        }
        inputs_.assign(1, PlayerInput{player.player, samples_, commands});
    }
    // Call after the world's clock was set back: the next sample is the first one after it.
    void rewind_devices() {
        next_sample_ = 0;
        while (world.clock.frame > 0 &&
               static_cast<double>(next_sample_) / sample_hz <= world.clock.t_s) {
            ++next_sample_;
        }
    }
    void take_step() { frame(world, *caches_, tuning, {1.0 / hz, inputs_}, stats); }
    void run(
        double seconds, const std::function<void()>& after_frame = [] {}) {
        const auto frames = static_cast<int>(std::lround(seconds * hz));
        for (int i = 0; i < frames; ++i) {
            step();
            after_frame();
        }
    }

    PlayerCommands commands;

    double t_s() const { return world.clock.t_s; }
    // In the scenario's frame: what a moved or rotated world must not change.
    Vec3 origin() const { return inverse_transform_point(frame_ws, origin_ws()); }
    Vec3 origin_ws() const { return world.player_origin.at(player.player).pose_ws.position; }
    Vec3 velocity() const {
        return frame_ws.rotation.conjugate() * world.player_velocity.at(player.player).linear_mps;
    }
    Pose body(Entity entity) const {
        return inverse(frame_ws) * world.body_pose.at(entity).pose_ws;
    }
    Vec3 body_velocity(Entity entity) const {
        return frame_ws.rotation.conjugate() * world.body_velocity.at(entity).linear_mps;
    }
    Vec3 body_spin(Entity entity) const {
        return frame_ws.rotation.conjugate() * world.body_velocity.at(entity).angular_radps;
    }
    Vec3 head_center() const {
        return inverse_transform_point(frame_ws,
                                       world.render_pose.at(player.player).head_center_ws);
    }
    const Grab& grab(HandSide side) const { return world.grab.at(player.hands[index_of(side)]); }
    std::uint64_t fallbacks(Fallback reason) const {
        return stats.fallbacks[static_cast<std::size_t>(reason)];
    }

  private:
    GripMeshLibrary grip_meshes_;
    std::unique_ptr<FrameCaches> caches_;
    std::vector<TrackingSample> samples_;
    std::vector<PlayerInput> inputs_;
    std::uint64_t next_sample_ = 0;
};

// The hand's position at which the palm is at `palm`, for an unrotated hand (palm facing -Y).
inline Vec3 hand_for_palm(const Scenario& scenario, const Vec3& palm) {
    return palm - scenario.tuning.hand.palm_center_m;
}

}  // namespace handhold
