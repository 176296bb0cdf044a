// What a World takes from its host: every number is checked, and whatever was taken can be saved.
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "components/world.hpp"
#include "engine/core/check.hpp"
#include "systems/frame.hpp"
#include "systems/snapshot.hpp"
#include "tests/random.hpp"

namespace handhold::world_limits_test {
namespace {

using test::Random;

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
constexpr double k_infinity = std::numeric_limits<double>::infinity();

BodyDescription rock(std::string_view name) {
    BodyDescription description;
    description.name = name;
    description.body = {BodyKind::free, 2.0, Vec3(0.1, 0.1, 0.1), 0.3, 0.4};
    description.shape = k_no_shape;
    return description;
}

PlayerDescription player(std::string_view name) {
    PlayerDescription description;
    description.name = name;
    description.head_shape = k_no_shape;
    return description;
}

std::size_t rows_of(const World& world) {
    std::size_t rows = 0;
    visit_columns(world, [&rows](const char*, const auto& column) { rows += column.size(); });
    return rows;
}

// The error names the function and the value, and nothing was added.
template <typename Add>
void expect_refused(World& world, const char* function, Add&& add) {
    const std::size_t rows = rows_of(world);
    const std::size_t alive = world.entities.alive_count();
    try {
        add();
        ADD_FAILURE() << function << " took it";
    } catch (const PreconditionError& error) {
        const std::string what = error.what();
        EXPECT_EQ(what.rfind(std::string(function) + ": ", 0), 0U) << what;
        EXPECT_NE(what.find("(value "), std::string::npos) << what;
    }
    EXPECT_EQ(rows_of(world), rows);
    EXPECT_EQ(world.entities.alive_count(), alive);
}

TEST(WorldLimits, BodiesWithWrongNumbersAreRefused) {
    World world;
    for (const double wrong : {k_nan, k_infinity, -k_infinity, 1e300, -1.0}) {
        const std::vector<std::function<void(BodyDescription&)>> breaches = {
            [&](BodyDescription& b) { b.body.mass_kg = wrong; },
            [&](BodyDescription& b) { b.body.inertia_kgm2.y() = wrong; },
            [&](BodyDescription& b) { b.body.restitution = wrong; },
            [&](BodyDescription& b) { b.body.friction = wrong; },
            [&](BodyDescription& b) { b.pose_ws.position.z() = wrong == -1.0 ? 1e10 : wrong; },
            [&](BodyDescription& b) { b.pose_ws.rotation.w() = wrong * 2.0; },
            [&](BodyDescription& b) { b.velocity.linear_mps.x() = wrong == -1.0 ? 1e7 : wrong; },
            [&](BodyDescription& b) { b.velocity.angular_radps.x() = wrong == -1.0 ? 1e7 : wrong; },
        };
        for (const auto& breach : breaches) {
            BodyDescription description = rock("a");
            breach(description);
            expect_refused(world, "add_body", [&] { add_body(world, description); });
        }
    }
    // What a snapshot refuses of fixed bodies is refused here too.
    BodyDescription fixed = rock("a");
    fixed.body = {BodyKind::fixed, k_nan};
    expect_refused(world, "add_body", [&] { add_body(world, fixed); });
}

TEST(WorldLimits, JointsWithWrongNumbersAreRefused) {
    World world;
    const Entity a = add_body(world, rock("a"));
    const Entity b = add_body(world, rock("b"));
    for (const double wrong : {k_nan, k_infinity, 1e300}) {
        const std::vector<std::function<void(Joint&)>> breaches = {
            [&](Joint& j) { j.frame_a_bs.position.x() = wrong; },
            [&](Joint& j) { j.frame_b_bs.rotation.x() = wrong; },
            [&](Joint& j) { j.upper = wrong; },
            [&](Joint& j) { j.lower = -wrong; },
            [&](Joint& j) { j.friction = wrong; },
            [&](Joint& j) { j.detent_spacing = wrong; },
            [&](Joint& j) { j.detent_strength = wrong; },
            [&](Joint& j) { j.latch.at = wrong; },
            [&](Joint& j) { j.latch.catch_range = wrong; },
            [&](Joint& j) { j.latch.strength = wrong; },
            [&](Joint& j) { j.latch.handle_at = wrong; },
            [&](Joint& j) { j.latch.handle = a; },
        };
        for (const auto& breach : breaches) {
            Joint joint;
            joint.a = a;
            joint.b = b;
            breach(joint);
            expect_refused(world, "add_joint", [&] { add_joint(world, {"joint", joint}); });
        }
    }
}

TEST(WorldLimits, PlayersWithWrongNumbersAreRefused) {
    World world;
    for (const double wrong : {k_nan, k_infinity, 1e300, -1.0}) {
        const std::vector<std::function<void(PlayerDescription&)>> breaches = {
            [&](PlayerDescription& p) { p.body.mass_kg = wrong; },
            [&](PlayerDescription& p) { p.origin_ws.position.x() = wrong == -1.0 ? 1e10 : wrong; },
            [&](PlayerDescription& p) { p.velocity_mps.y() = wrong == -1.0 ? 1e7 : wrong; },
            [&](PlayerDescription& p) { p.measures.eye_height_m = wrong; },
            [&](PlayerDescription& p) { p.measures.forearm_m = wrong; },
        };
        for (const auto& breach : breaches) {
            PlayerDescription description = player("p");
            breach(description);
            expect_refused(world, "add_player", [&] { add_player(world, description); });
        }
    }
}

TEST(WorldLimits, ShapesMustBeKnownAndFit) {
    ShapeLibrary shapes;
    const ShapeId ball = shapes.add_sphere(0.1);
    const ShapeId box = shapes.add_box(Vec3(0.1, 0.1, 0.1));
    auto mesh = std::make_shared<Mesh>();
    mesh->positions = {Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()};
    mesh->triangles = {{0, 1, 2}};
    const ShapeId wall = shapes.add_mesh(mesh);
    World world;
    BodyDescription body = rock("a");
    body.shape = {77};
    expect_refused(world, "add_body", [&] { add_body(world, body, shapes); });
    body.shape = wall;
    expect_refused(world, "add_body", [&] { add_body(world, body, shapes); });
    body.shape = box;
    add_body(world, body, shapes);
    PlayerDescription head = player("p");
    for (const ShapeId wrong : {box, wall, ShapeId{77}}) {
        head.head_shape = wrong;
        expect_refused(world, "add_player", [&] { add_player(world, head, shapes); });
    }
    head.head_shape = ball;
    add_player(world, head, shapes);
}

TEST(WorldLimits, TuningOutOfRangeIsRefusedByName) {
    World world;
    const ShapeLibrary shapes;
    FrameCaches caches(shapes);
    StageStats stats;
    Tuning tuning;
    tuning.hand.reach_m = k_nan;
    try {
        step_frame(world, caches, tuning, {}, stats);
        ADD_FAILURE() << "NaN was taken";
    } catch (const PreconditionError& error) {
        EXPECT_NE(std::string(error.what()).find("hand.reach_m"), std::string::npos)
            << error.what();
    }
    tuning = {};
    tuning.phases.kappa_heavy_kg = tuning.phases.kappa_light_kg;
    EXPECT_THROW(step_frame(world, caches, tuning, {}, stats), PreconditionError);
    world.reference_velocity_mps.x() = 1e300;
    EXPECT_THROW(step_frame(world, caches, {}, {}, stats), PreconditionError);
    EXPECT_EQ(world.clock.frame, 0U);
}

TEST(WorldLimits, CommandsAreClampedToTheirRanges) {
    World world;
    const ShapeLibrary shapes;
    FrameCaches caches(shapes);
    StageStats stats;
    const Entity who = add_player(world, player("p")).player;
    PlayerInput input{who, {}, {}};
    input.commands = {-1e300, 1 << 30, 1e300, Vec3(1e300, -1e300, k_nan), false};
    step_frame(world, caches, {}, {1.0 / 90.0, {&input, 1}}, stats);
    const PlayerCommands& taken = world.player_commands.at(who);
    EXPECT_EQ(taken.smooth_turn, -1.0);
    EXPECT_EQ(taken.brake, 1.0);
    EXPECT_EQ(taken.thrust_ps, Vec3(1.0, -1.0, 0.0));
    std::vector<std::byte> bytes;
    save_snapshot(world, SnapshotAssets(shapes), bytes);
    const auto error = restore_snapshot(bytes, SnapshotAssets(shapes), world);
    EXPECT_FALSE(error) << error->message();
}

TEST(WorldLimits, FastPlayerDoesNotPassAWallInTheFirstFrame) {
    ShapeLibrary shapes;
    BodyDescription wall;
    wall.name = "wall";
    wall.shape = shapes.add_box(Vec3(5.0, 5.0, 0.01));
    wall.pose_ws.position = Vec3(0.0, 1.6, -1.0);
    for (const double speed_mps : {20.0, 60.0, 185.0, 2000.0}) {
        World world;
        add_body(world, wall, shapes);
        PlayerDescription description = player("p");
        description.head_shape = shapes.add_sphere(Tuning().head.radius_m);
        description.velocity_mps = Vec3(0.0, 0.0, -speed_mps);
        const Entity who = add_player(world, description, shapes).player;
        FrameCaches caches(shapes);
        StageStats stats;
        TrackingSample sample;
        sample.head_ps.position = Vec3(0.0, 1.6, 0.0);
        for (ControllerSample& controller : sample.controllers) {
            controller.controller_ps.position = Vec3(0.0, 1.2, -0.2);
        }
        for (int frame = 0; frame < 20; ++frame) {
            sample.t_s = frame / 90.0;
            const PlayerInput input{who, {&sample, 1}, {}};
            step_frame(world, caches, {}, {1.0 / 90.0, {&input, 1}}, stats);
            EXPECT_GT(world.player_origin.at(who).pose_ws.position.z(), -1.0)
                << speed_mps << " m/s, frame " << frame;
        }
    }
}

// --- The caches behind find_by_id and destroy
// -----------------------------------------------------

TEST(WorldIndex, NamesAndJointsAreRightAfterAnyHistory) {
    Random random(5);
    World world;
    std::map<std::string, Entity> bodies;
    std::vector<std::string> names;
    const auto check = [&] {
        for (const std::string& name : names) {
            const auto known = bodies.find(name);
            EXPECT_EQ(find_by_id(world, persistent_id_from_name(name)),
                      known != bodies.end() ? known->second : k_no_entity);
        }
        for (const Joint& joint : world.joint.rows()) {
            EXPECT_TRUE(world.body.contains(joint.b));
            EXPECT_TRUE(is_null(joint.a) || world.body.contains(joint.a));
        }
    };
    int joints = 0;
    for (int step = 0; step < 3000; ++step) {
        const double what = random.between(0.0, 1.0);
        const auto any_body = [&] {
            auto body = bodies.begin();
            std::advance(body, static_cast<int>(random.between(0.0, double(bodies.size()))));
            return body;
        };
        if (what < 0.4 || bodies.size() < 3) {
            const std::string name = "b" + std::to_string(step);
            names.push_back(name);
            bodies[name] = add_body(world, rock(name));
        } else if (what < 0.7) {
            Joint joint;
            joint.b = any_body()->second;
            joint.a = random.between(0.0, 1.0) < 0.2 ? k_no_entity : any_body()->second;
            if (joint.a != joint.b) {
                add_joint(world, {"j" + std::to_string(joints++), joint});
            }
        } else if (what < 0.9 || world.joint.empty()) {
            const auto body = any_body();
            EXPECT_TRUE(destroy(world, body->second));
            bodies.erase(body);
        } else {
            EXPECT_TRUE(destroy(world, world.joint.owners()[0]));
        }
        if (step % 500 == 0) {
            const World copy = world;
            world = copy;
        }
        if (step % 100 == 0) {
            check();
        }
    }
    check();
    while (!bodies.empty()) {
        destroy(world, bodies.begin()->second);
        bodies.erase(bodies.begin());
    }
    EXPECT_TRUE(world.joint.empty());
    check();
}

// --- Whatever was taken can be saved
// --------------------------------------------------------------

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
            BodyDescription body = rock(name);
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
            PlayerDescription description = player(name);
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
                                  Vec3(any_number(random), any_number(random), any_number(random)),
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
}  // namespace handhold::world_limits_test
