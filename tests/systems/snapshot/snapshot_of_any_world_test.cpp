// Whatever a World has taken from its host can be saved and restored.
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "components/world.hpp"
#include "systems/frame/frame.hpp"
#include "systems/snapshot/snapshot.hpp"
#include "tests/components/shapeless.hpp"
#include "tests/random.hpp"

namespace handhold::snapshot_of_any_world_test {
namespace {

using test::Random;
using test::shapeless_player;
using test::shapeless_rock;

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
constexpr double k_infinity = std::numeric_limits<double>::infinity();

// 10^(low..high), either sign if asked.
double magnitude(Random& random, double low, double high) {
    return std::pow(10.0, random.between(low, high));
}

struct AnyWorld {
    ShapeLibrary shapes;
    World world;
    std::vector<Entity> players;

    explicit AnyWorld(Random& random) {
        std::vector<ShapeId> known = {k_no_shape};
        for (int i = 0; i < 4; ++i) {
            const double size_m = magnitude(random, -2.9, 2.0);
            known.push_back(shapes.add_sphere(size_m));
            known.push_back(shapes.add_box(Vec3(size_m, 2.0 * size_m, size_m)));
            known.push_back(shapes.add_capsule(size_m, size_m));
        }
        const ShapeId head = shapes.add_sphere(Tuning().head.radius_m);
        const auto any = [&](std::size_t count) {
            return static_cast<std::size_t>(random.between(0.0, double(count)));
        };
        const auto spread_m = magnitude(random, -1.0, 9.0);
        std::vector<Entity> bodies;
        for (std::size_t i = any(12); i-- > 0;) {
            const std::string name = "body" + std::to_string(i);
            BodyDescription body = shapeless_rock(name);
            body.body.kind = static_cast<BodyKind>(any(3));
            body.body.mass_kg = magnitude(random, -12.0, 15.0);
            const double moment = magnitude(random, -24.0, 18.0);
            body.body.inertia_kgm2 = Vec3(moment, moment, moment);
            body.body.restitution = random.between(0.0, 1.0);
            body.body.friction = magnitude(random, -3.0, 6.0);
            body.pose_ws = random.pose(std::min(spread_m, world_limits::k_max_coordinate_m));
            body.velocity.linear_mps = random.vector(magnitude(random, -2.0, 6.0));
            body.velocity.angular_radps = random.vector(magnitude(random, -2.0, 4.0));
            body.shape = known[any(known.size())];
            bodies.push_back(add_body(world, body, shapes));
        }
        for (std::size_t i = any(bodies.size() + 1); i-- > 0;) {
            Joint joint;
            joint.kind = static_cast<JointKind>(any(5));
            joint.b = bodies[any(bodies.size())];
            joint.a = any(4) == 0 ? k_no_entity : bodies[any(bodies.size())];
            if (joint.a == joint.b) {
                continue;
            }
            joint.frame_a_bs = random.pose(magnitude(random, -2.0, 3.0));
            joint.frame_b_bs = random.pose(magnitude(random, -2.0, 3.0));
            joint.limited = any(2) == 0;
            joint.upper = magnitude(random, -3.0, 9.0);
            joint.lower = joint.kind == JointKind::distance ? 0.0 : -joint.upper;
            joint.friction = magnitude(random, -3.0, 15.0);
            const std::string name = "joint" + std::to_string(i);
            add_joint(world, {name, joint});
        }
        for (std::size_t i = any(3); i-- > 0;) {
            const std::string name = "player" + std::to_string(i);
            PlayerDescription description = shapeless_player(name);
            description.body.mass_kg = magnitude(random, -12.0, 15.0);
            description.origin_ws =
                random.pose(std::min(spread_m, world_limits::k_max_coordinate_m));
            description.velocity_mps = random.vector(magnitude(random, -2.0, 6.0));
            description.head_shape = any(4) == 0 ? k_no_shape : head;
            players.push_back(add_player(world, description, shapes).player);
        }
    }
};

double any_number(Random& random) {
    constexpr double k_hostile[] = {k_nan, k_infinity, -k_infinity, 1e300,  -1e300, 1e18,
                                    -1e12, 1e9,        0.0,         1e-300, 3.0,    -0.5};
    return random.between(0.0, 1.0) < 0.5
               ? random.between(-2.0, 2.0)
               : k_hostile[static_cast<std::size_t>(random.between(0.0, std::size(k_hostile)))];
}

Pose any_pose(Random& random) {
    Pose pose = random.pose(1.0);
    if (random.between(0.0, 1.0) < 0.2) {
        pose.position[static_cast<int>(random.between(0.0, 3.0))] = any_number(random);
    }
    if (random.between(0.0, 1.0) < 0.1) {
        pose.rotation.x() = any_number(random);
    }
    return pose;
}

TEST(SnapshotOfAnyWorld, IsNeverRefused) {
    constexpr int k_worlds = 200;
    constexpr int k_frames = 12;
    for (int seed = 0; seed < k_worlds; ++seed) {
        Random random(static_cast<std::uint64_t>(seed) + 1);
        AnyWorld made(random);
        FrameCaches caches(made.shapes);
        StageStats stats;
        const SnapshotAssets assets(made.shapes);
        const double dt_s = magnitude(random, -4.0, 0.5);
        for (int frame = 0; frame < k_frames; ++frame) {
            std::vector<std::vector<TrackingSample>> samples(made.players.size());
            std::vector<PlayerInput> inputs;
            for (std::size_t i = 0; i < made.players.size(); ++i) {
                for (int s = 0; s < 2; ++s) {
                    TrackingSample sample;
                    sample.t_s = random.between(0.0, 1.0) < 0.2
                                     ? any_number(random)
                                     : made.world.clock.t_s + 0.5 * s * dt_s;
                    sample.head_ps = any_pose(random);
                    for (ControllerSample& controller : sample.controllers) {
                        controller = {any_pose(random), random.between(0.0, 1.0) < 0.5};
                    }
                    samples[i].push_back(sample);
                }
                PlayerInput input{made.players[i], samples[i], {}};
                input.commands = {any_number(random), static_cast<std::int32_t>(random.engine()()),
                                  any_number(random),
                                  Vec3{any_number(random), any_number(random), any_number(random)},
                                  random.between(0.0, 1.0) < 0.1};
                inputs.push_back(input);
            }
            step_frame(made.world, caches, {}, {dt_s, inputs}, stats);
            std::vector<std::byte> bytes;
            save_snapshot(made.world, assets, bytes);
            World restored;
            const auto error = restore_snapshot(bytes, assets, restored);
            ASSERT_FALSE(error) << "world " << seed << ", frame " << frame << ": "
                                << error->message();
            ASSERT_EQ(hash_state(restored), hash_state(made.world));
        }
    }
}

}  // namespace
}  // namespace handhold::snapshot_of_any_world_test
