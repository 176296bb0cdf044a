#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/systems/frame/column_scene.hpp"
#include "tests/systems/frame/scenario.hpp"

// A busy scene for determinism tests: players who crawl with one and two hands, wave, shove and
// throw rocks and share a crate, among rolling bodies. The device poses are functions of the
// world's clock, so the world and the caches are all that changes.
namespace handhold::test {

class Crowd {
  public:
    ShapeLibrary shapes;
    World world;
    Tuning tuning;
    StageStats stats;  // of the last frame
    // The kind of frame that runs.
    decltype(&step_frame) kind_of_step = &step_frame;
    bool are_silent = false;  // true: no device sends anything

    // Seed 0: bodies and players are created in the order of the code; other seeds shuffle it.
    explicit Crowd(std::uint64_t order_seed = 0) {
        std::vector<std::function<void()>> makers;
        make_bodies(makers);
        make_players(makers);
        if (order_seed != 0) {
            Random random(order_seed);
            shuffle(makers, random);
        }
        for (const auto& make : makers) {
            make();
        }
        make_joints();
        grip_meshes_ = GripMeshLibrary(shapes);
        drop_caches();
    }

    void drop_caches() { caches_ = std::make_unique<FrameCaches>(shapes, &grip_meshes_); }

    void step() {
        const double start_s = world.clock.t_s;
        std::vector<std::vector<TrackingSample>> samples(cast_.size());
        std::vector<PlayerInput> inputs;
        for (std::size_t i = 0; i < cast_.size(); ++i) {
            auto next = static_cast<std::uint64_t>(std::floor(start_s * k_sample_hz));
            for (double t_s = start_s; t_s <= start_s + k_frame_s; ++next) {
                t_s = static_cast<double>(next) / k_sample_hz;
                if (t_s > start_s || world.clock.frame == 0) {
                    samples[i].push_back(sample_of(cast_[i].script, t_s));
                }
            }
            const Entity player = find_by_id(world, persistent_id_from_name(cast_[i].name));
            inputs.push_back({player, samples[i], {}});
        }
        if (are_silent) {
            inputs.clear();
        }
        kind_of_step(world, *caches_, tuning, {k_frame_s, inputs}, stats);
    }

    // The state hash after each frame.
    std::vector<std::uint64_t> run(
        int frames, const std::function<void(int)>& before_frame = [](int) {}) {
        std::vector<std::uint64_t> hashes;
        for (int frame = 0; frame < frames; ++frame) {
            before_frame(frame);
            step();
            hashes.push_back(hash_state(world));
        }
        return hashes;
    }

    template <typename T>
    static void shuffle(std::vector<T>& items, Random& random) {
        for (std::size_t i = items.size(); i > 1; --i) {
            const auto other =
                static_cast<std::size_t>(random.between(0.0, static_cast<double>(i)));
            std::swap(items[i - 1], items[other]);
        }
    }

    static constexpr int k_frames = 270;  // long enough for every action of every player
    static constexpr double k_frame_s = 1.0 / 90.0;

  private:
    // Not a multiple of the frame rate, as with real devices.
    static constexpr double k_sample_hz = 97.0;

    struct Actor {
        std::string name;
        DeviceScript script;
    };

    void make_bodies(std::vector<std::function<void()>>& makers) {
        const ShapeId floor = shapes.add_box(Vec3(6.0, 0.05, 3.0));
        const ShapeId wall = shapes.add_box(Vec3(6.0, 2.0, 0.05));
        const ShapeId pebble = shapes.add_sphere(0.08);
        const ShapeId crate = shapes.add_box(Vec3(0.2, 0.06, 0.06));
        const auto add = [&](std::string name, BodyKind kind, double mass_kg, ShapeId shape,
                             const Vec3& at, const Vec3& velocity_mps = Vec3::Zero()) {
            makers.emplace_back([=, this] {
                const Vec3 inertia =
                    mass_kg > 0.0 ? solid_inertia(shapes.at(shape), mass_kg) : Vec3(Vec3::Zero());
                add_body(world, {name,
                                 {kind, mass_kg, inertia, 0.2},
                                 {at, Quat::Identity()},
                                 {velocity_mps, Vec3::Zero()},
                                 shape});
            });
        };
        add("floor", BodyKind::fixed, 0.0, floor, Vec3(0.0, 1.0, 0.0));
        add("wall", BodyKind::fixed, 0.0, wall, Vec3(0.0, 1.0, -0.5));
        add("crate", BodyKind::free, 8.0, crate, Vec3(3.0, 1.305, 0.0));
        add("rock", BodyKind::free, 5.0, pebble, Vec3(-0.3, 1.3, 0.0));
        for (int i = 0; i < 24; ++i) {
            const double side = i % 2 == 0 ? 0.4 : -0.4;
            add("pebble" + std::to_string(i), BodyKind::free, 0.5 + 0.3 * i, pebble,
                Vec3(-5.0 + 0.17 * (i % 12), 1.14, 0.9 + 0.5 * (i / 12)), Vec3(side, -0.2, 0.0));
        }
        const RigidBody driven{BodyKind::kinematic, 0.0, Vec3::Zero(), 0.0};
        makers.emplace_back([=, this] {
            const Pose stops[] = {{Vec3(4.8, 1.3, 1.2), Quat::Identity()},
                                  {Vec3(4.8, 1.5, 1.2), rotation_about(Vec3::UnitY(), 0.5)}};
            const Entity train = add_body(world, {"train", driven, stops[0], {}, crate});
            world.path_mover.add(train, {make_pose_path(stops, 2.0)});
        });
        makers.emplace_back([=, this] {
            const Pose start{Vec3(4.8, 1.2, 0.8), Quat::Identity()};
            add_body(world, {"shin", driven, start, {}, pebble});
        });
        makers.emplace_back([=, this] {
            const Vec3 spin(0.0, 0.7, 0.0);
            const Entity rotor = add_body(world, {"rotor",
                                                  driven,
                                                  {Vec3(-4.2, 1.2, 1.2), Quat::Identity()},
                                                  {Vec3::Zero(), spin},
                                                  crate});
            world.mover.add(rotor,
                            {{Vec3(-4.2, 1.2, 1.2), Quat::Identity()}, Vec3::Zero(), spin, false});
        });
    }

    // Joints, created after the bodies: a flail of two pebbles attached to the world, and a leg of
    // the train. Also how the rock is held.
    void make_joints() {
        AuthoredGrips grips;
        grips.count = 1;
        AuthoredHand& left = grips.grips[0].hands[0];
        left.is_there = true;
        left.wrist_bs = {hand_over(Vec3(0.01, 0.082, 0.01)), Quat::Identity()};
        left.is_posed[2] = true;
        left.fingers[2].curl_rad = {0.3, 0.4, 0.2};
        world.authored_grips.add(find_by_id(world, persistent_id_from_name("rock")), grips);
        const auto tie = [this](const char* name, JointKind kind, const char* a, const char* b,
                                const Vec3& at) {
            Joint joint;
            joint.kind = kind;
            joint.a = a == nullptr ? k_no_entity : find_by_id(world, persistent_id_from_name(a));
            joint.b = find_by_id(world, persistent_id_from_name(b));
            joint.friction = 0.01;
            add_joint(world, {name, joint_at(world, joint, {at, Quat::Identity()})});
        };
        LegMover leg;
        leg.torso = find_by_id(world, persistent_id_from_name("train"));
        leg.leg.knee_bs = Vec3::UnitZ();
        world.leg_mover.add(find_by_id(world, persistent_id_from_name("shin")), leg);
        tie("shackle", JointKind::ball, nullptr, "pebble20", Vec3(-3.64, 1.24, 1.4));
        tie("hinge", JointKind::hinge, "pebble20", "pebble21", Vec3(-3.56, 1.14, 1.4));
    }

    void make_players(std::vector<std::function<void()>>& makers) {
        const ShapeId head = shapes.add_sphere(tuning.head.radius_m);
        const auto add = [&](std::string name, const Vec3& origin, double mass_kg,
                             DeviceScript script) {
            cast_.push_back({name, std::move(script)});
            makers.emplace_back([=, this] {
                const PlayerEntities made = add_player(
                    world, {name, {mass_kg}, {origin, Quat::Identity()}, Vec3::Zero(), head});
                for (const Entity hand : made.hands) {
                    world.controller_to_hand.add(hand);  // scripts give hand poses, not controllers
                }
            });
        };
        add("crawler", Vec3(0.0, 0.0, 0.0), 80.0, crawler());
        add("thrower", Vec3(1.5, 0.0, 0.0), 70.0, crawler_with_two_hands());
        add("carrier", Vec3(3.0, 0.0, 0.0), 60.0, carrier());
    }

    Vec3 hand_over(const Vec3& palm) const { return palm - tuning.hand.palm_center_m; }

    // The right hand holds the floor; the left one waves a rock, shoves it into the wall and throws
    // it.
    DeviceScript crawler() const {
        DeviceScript script;
        const Vec3 right = hand_over(Vec3(0.3, 1.06, 0.1));
        const Vec3 left = hand_over(Vec3(-0.3, 1.385, 0.0));
        script.grabs[0] = [](double t) { return t > 0.3 && t < 2.123; };
        script.grabs[1] = [](double t) { return t > 0.05 && t < 1.507; };
        script.hands[1] = [=](double t) {
            return Pose{right + 0.1 * ease(t, 0.2, 0.8) *
                                    Vec3(std::sin(3 * t), 0.2 * std::sin(2 * t), std::sin(4 * t)),
                        rotation_about(Vec3::UnitY(), 0.2 * std::sin(t))};
        };
        script.hands[0] = [=](double t) {
            const Vec3 wave(0.1 * std::sin(3 * t) * ease(t, 0.4, 0.8), 0.0,
                            -0.5 * ease(t, 1.0, 1.4) + 1.0 * ease(t, 1.8, 2.3));
            return Pose{left + wave, rotation_about(Vec3::UnitX(), 0.2 * std::sin(2 * t))};
        };
        script.head = [](double t) {
            return Pose{Vec3(0.05 * std::sin(2 * t), 1.6, 0.6),
                        rotation_about(Vec3::UnitY(), 0.3 * std::sin(t))};
        };
        return script;
    }
    // Both hands hold the floor and are released one after the other.
    DeviceScript crawler_with_two_hands() const {
        DeviceScript script;
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            const double out = side == 0 ? -1.0 : 1.0;
            const Vec3 hand = hand_over(Vec3(0.25 * out, 1.06, 0.1));
            script.grabs[side] = [=](double t) { return t > 0.1 && t < 1.2 + 0.3 * out; };
            script.hands[side] = [=](double t) {
                return Pose{hand + 0.12 * Vec3(std::sin(2 * t), 0.1 * t, out * std::sin(t)),
                            Quat::Identity()};
            };
        }
        return script;
    }
    // A crate in both hands, whose targets do not quite agree.
    DeviceScript carrier() const {
        DeviceScript script;
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            const double out = side == 0 ? -1.0 : 1.0;
            const Vec3 hand = hand_over(Vec3(0.12 * out, 1.38, 0.0));
            script.grabs[side] = [=](double t) { return t > 0.1 && t < 2.0 + 0.2 * out; };
            script.hands[side] = [=](double t) {
                return Pose{hand + Vec3(0.01 * out * std::sin(5 * t), 0.15 * std::sin(2 * t),
                                        -0.5 * ease(t, 0.8, 1.5)),
                            Quat::Identity()};
            };
        }
        return script;
    }

    std::vector<Actor> cast_;
    GripMeshLibrary grip_meshes_;
    std::unique_ptr<FrameCaches> caches_;
};

}  // namespace handhold::test
