// A body in a still hand overlaps the level all at once: its layers are given back within a wall, a
// wall is placed on it, or one of the two grows. The player is pushed out by the overlap, and
// hardly farther.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "components/world_edit.hpp"
#include "tests/random.hpp"
#include "tests/systems/frame/scenario.hpp"

namespace handhold::scenario_new_overlap_test {
namespace {

using test::Random;

const Vec3 k_body_m(0.3, 1.0, 0.0);

enum class Way : std::uint8_t { layers, wall_placed, body_grows, wall_grows };

// A crate or rock in the right hand, and a wall beside it.
struct Grip {
    Scenario scene;
    Entity body;
    Entity wall;
    Way way = Way::layers;
    double half_m = 0.0;   // of the body, before it grows
    double depth_m = 0.0;  // of the overlap to come
    Vec3 outward;          // from the wall to the body
    Vec3 wall_half_m;
    bool is_round = false;

    explicit Grip(Random& random) {
        scene.fits_hands = false;
        scene.hz = random.between(30.0, 240.0);
        scene.tuning.locomotion.drift_drag_per_s = 0.0;
        way = static_cast<Way>(random.engine()() % 4);
        is_round = random.engine()() % 2 == 0;
        half_m = random.between(0.05, 0.1);
        depth_m = random.between(0.01, 0.9 * half_m);
        const double angle = random.between(-k_pi, k_pi);
        outward = rotation_about(Vec3::UnitY(), angle) * Vec3::UnitX();
        wall_half_m = Vec3(random.between(0.2, 0.5), 0.3, 0.4);
        const double mass_kg = std::exp(random.between(std::log(0.1), std::log(50.0)));
        body = is_round ? scene.add_rock("body", mass_kg, k_body_m, half_m)
                        : scene.add_crate("body", mass_kg, k_body_m, Vec3::Constant(half_m));
        add_wall(random);
        if (way == Way::layers) {
            scene.world.filter.add(body, {0, 0});
        }
        scene.add_player_here();
        const Vec3 hand = hand_for_palm(scene, k_body_m + Vec3(0.0, half_m + 0.01, 0.0));
        scene.script.hands[1] = [hand](double) { return Pose{hand, Quat::Identity()}; };
        scene.script.grabs[1] = [](double t_s) { return t_s > 0.05; };
    }
    // The body's extent towards the wall.
    double extent_m() const {
        return is_round ? half_m : half_m * (std::abs(outward.x()) + std::abs(outward.z()));
    }
    // The wall that overlaps the body by `depth`.
    Pose wall_at(double depth) const {
        const double away_m = extent_m() + wall_half_m.x() - depth;
        return {k_body_m - away_m * outward, rotation_between(Vec3::UnitX(), outward)};
    }
    void add_wall(Random& random) {
        constexpr double k_gap_m = 0.05;
        const bool is_apart = way != Way::layers;
        const ShapeId shape = scene.shapes.add_box(wall_half_m);
        RigidBody kind;
        switch (random.engine()() % 3) {
            case 0:
                kind.kind = BodyKind::kinematic;
                break;
            case 1:
                kind = {BodyKind::free, 1e5, solid_inertia(scene.shapes.at(shape), 1e5), 0.0};
                break;
            default:
                break;
        }
        const double depth = way == Way::wall_placed ? -k_gap_m : is_apart ? -0.01 : depth_m;
        wall = scene.add("wall", kind, shape, wall_at(depth));
    }
    void overlap() {
        World& world = scene.world;
        switch (way) {
            case Way::layers:
                world.filter.at(body) = {};
                break;
            case Way::wall_placed:
                teleport_body(world, wall, wall_at(depth_m));
                break;
            case Way::body_grows: {
                const double grown = half_m * (1.0 + (depth_m + 0.01) / extent_m());
                change_shape(world, body,
                             is_round ? scene.shapes.add_sphere(grown)
                                      : scene.shapes.add_box(Vec3::Constant(grown)),
                             {});
                break;
            }
            case Way::wall_grows:
                change_shape(world, wall,
                             scene.shapes.add_box(wall_half_m + Vec3(depth_m + 0.01, 0.0, 0.0)),
                             {});
                break;
        }
    }
    bool is_held() const { return scene.grab(HandSide::right).kind == GripKind::held; }
};

// What the frames after the overlap showed.
struct PushedOut {
    double way_m = 0.0;   // largest distance of the player's origin from its start
    double left_m = 0.0;  // the hand's error at the end
};

PushedOut watch(Grip& grip) {
    PushedOut seen;
    const Vec3 start_m = grip.scene.origin();
    grip.scene.run(
        0.5, [&] { seen.way_m = std::max(seen.way_m, (grip.scene.origin() - start_m).norm()); });
    seen.left_m = grip.scene.grab(HandSide::right).error_m;
    return seen;
}

RC_GTEST_PROP(NewOverlap, PushesThePlayerHardlyFartherThanItIsDeep, (std::uint64_t seed)) {
    Random random(seed);
    Grip grip(random);
    grip.scene.run(0.3);
    RC_ASSERT(grip.is_held());
    RC_ASSERT(grip.scene.origin().norm() < 1e-9);
    grip.overlap();
    const PushedOut seen = watch(grip);
    RC_ASSERT(grip.is_held());
    // A heavy wall turns while it gives way, so that the way out is not straight.
    const bool is_heavy = grip.scene.world.body.at(grip.wall).kind == BodyKind::free;
    RC_ASSERT(seen.way_m <= grip.depth_m + (is_heavy ? 0.05 : 1e-3));
    RC_ASSERT(seen.way_m + seen.left_m >= 0.5 * grip.depth_m);
}

}  // namespace
}  // namespace handhold::scenario_new_overlap_test
