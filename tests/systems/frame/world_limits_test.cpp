// What a World takes from its host: every number is checked.
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "components/world.hpp"
#include "engine/core/check.hpp"
#include "systems/frame/frame.hpp"
#include "systems/snapshot/snapshot.hpp"
#include "tests/components/shapeless.hpp"

namespace handhold::world_limits_test {
namespace {

using test::shapeless_player;
using test::shapeless_rock;

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
constexpr double k_infinity = std::numeric_limits<double>::infinity();

std::size_t elements_of(const World& world) {
    std::size_t elements = 0;
    visit_columns(world,
                  [&elements](const char*, const auto& column) { elements += column.size(); });
    return elements;
}

// The error names the function and the value, and nothing was added.
template <typename Add>
void expect_refused(World& world, const char* function, Add&& add) {
    const std::size_t elements = elements_of(world);
    const std::size_t alive = world.entities.alive_count();
    try {
        add();
        ADD_FAILURE() << function << " took it";
    } catch (const PreconditionError& error) {
        const std::string what = error.what();
        EXPECT_EQ(what.rfind(std::string(function) + ": ", 0), 0U) << what;
        EXPECT_NE(what.find("(value "), std::string::npos) << what;
    }
    EXPECT_EQ(elements_of(world), elements);
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
            BodyDescription description = shapeless_rock("a");
            breach(description);
            expect_refused(world, "add_body", [&] { add_body(world, description); });
        }
    }
    // What a snapshot refuses of fixed bodies is refused here too.
    BodyDescription fixed = shapeless_rock("a");
    fixed.body = {BodyKind::fixed, k_nan};
    expect_refused(world, "add_body", [&] { add_body(world, fixed); });
}

TEST(WorldLimits, JointsWithWrongNumbersAreRefused) {
    World world;
    const Entity a = add_body(world, shapeless_rock("a"));
    const Entity b = add_body(world, shapeless_rock("b"));
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
            PlayerDescription description = shapeless_player("p");
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
    BodyDescription body = shapeless_rock("a");
    body.shape = {77};
    expect_refused(world, "add_body", [&] { add_body(world, body, shapes); });
    body.shape = wall;
    expect_refused(world, "add_body", [&] { add_body(world, body, shapes); });
    body.shape = box;
    add_body(world, body, shapes);
    PlayerDescription head = shapeless_player("p");
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
    const Entity who = add_player(world, shapeless_player("p")).player;
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
        PlayerDescription description = shapeless_player("p");
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

}  // namespace
}  // namespace handhold::world_limits_test
