#include <array>

#include <gtest/gtest.h>

#include "tests/engine/collision/scene.hpp"

// Sweeps of every kind of body against every kind of thing, compounds and spinning included. The
// oracle is the distance at rest (certified in collision_shapes_test.cpp) at small steps of the
// way.
namespace handhold::collision_compound_test {
namespace {

using test::at;
using test::contacts_of;
using test::Random;
using test::resting;

struct Kinds {
    ShapeLibrary shapes;
    std::array<ShapeId, 6> bodies;   // 4 and 5 are compounds
    std::array<ShapeId, 6> grounds;  // 0 and 1 are meshes
};

Kinds make_kinds() {
    Kinds kinds;
    ShapeLibrary& s = kinds.shapes;
    Random random(121);
    std::vector<Vec3> points(24);
    for (Vec3& point : points) {
        point = random.vector(0.12);
    }
    const ShapeId bar = s.add_box({0.25, 0.03, 0.03});
    const ShapeId head = s.add_box({0.05, 0.1, 0.05});
    const ShapeId ball = s.add_sphere(0.06);
    const ShapeId rod = s.add_capsule(0.03, 0.2);
    const std::vector<CompoundChild> hammer = {{bar, {}, 0}, {head, at({0.25, 0.0, 0.0}), 0}};
    const std::vector<CompoundChild> dumbbell = {
        {rod, {}, 0}, {ball, at({0.0, 0.25, 0.0}), 0}, {ball, at({0.0, -0.25, 0.0}), 0}};
    kinds.bodies = {s.add_cylinder(0.08, 0.12),
                    s.add_cylinder(0.2, 0.03),
                    s.add_centred(s.add_hull(points)).shape,
                    s.add_box({0.1, 0.05, 0.15}),
                    s.add_centred(s.add_compound(hammer)).shape,
                    s.add_compound(dumbbell)};
    kinds.grounds = {s.add_mesh(test::make_floor(0.8, 3, test::Winding::mixed)),
                     s.add_mesh(test::make_wavy_ball(0.3, 12, 16), Vec3(1.0, 0.5, 1.5)),
                     s.add_cylinder(0.3, 0.05),
                     s.add_hull(points),
                     s.add_box({0.3, 0.02, 0.3}),
                     kinds.bodies[4]};
    return kinds;
}

struct Way {
    Pose from;
    Pose to;
    Pose at(double fraction) const { return interpolate(from, to, fraction); }
};

class Oracle {
  public:
    static constexpr double k_far_m = 0.05;

    Oracle(const ShapeLibrary& shapes, ShapeId body, ShapeId ground)
        : world_(shapes), body_(body), ground_(ground) {}

    // Least separation of the two at rest; k_far_m where they are farther apart.
    double separation_m(const Pose& pose) {
        world_.set_proxies({{resting(1, ground_, {}, false), resting(2, body_, pose, true)}});
        world_.find_contacts({k_far_m, 0.005}, contacts_);
        return std::min(k_far_m, test::deepest(contacts_));
    }
    // The first fraction in (low, high] at which they overlap by a micrometre; they do at `high`.
    double touch(const Way& way, double low, double high) {
        for (int i = 0; i < 50; ++i) {
            const double middle = 0.5 * (low + high);
            (separation_m(way.at(middle)) < -1e-6 ? high : low) = middle;
        }
        return high;
    }

  private:
    CollisionWorld world_;
    ShapeId body_;
    ShapeId ground_;
    std::vector<ContactPoint> contacts_;
};

TEST(SweepOfAllKinds, StopsWithinAMicrometreOfTheFirstTouchAndMissesNone) {
    Random random(122);
    const Kinds kinds = make_kinds();
    int hits = 0;
    int misses = 0;
    int brushed = 0;
    for (int round = 0; round < 360; ++round) {
        const ShapeId body = kinds.bodies[static_cast<std::size_t>(round % 6)];
        const ShapeId ground = kinds.grounds[static_cast<std::size_t>(round / 6 % 6)];
        Oracle oracle(kinds.shapes, body, ground);
        const Vec3 start = 1.2 * random.direction();
        const Vec3 aside = random.vector(1.0);
        const Quat turn = random.rotation();
        const Quat spun = round % 2 == 0 ? turn : random.rotation();
        const Way way{at(start, turn), at(aside - start, spun)};
        constexpr int k_steps = 200;
        double least = 1e9;
        int first = 0;
        for (int i = 0; i <= k_steps; ++i) {
            const double separation = oracle.separation_m(way.at(i / double{k_steps}));
            if (separation < -1e-6 && first == 0) {
                first = i;
            }
            least = std::min(least, separation);
        }
        const auto contacts = contacts_of(
            kinds.shapes, {resting(1, ground, {}, false), {2, body, way.from, way.to, true}},
            {1e-3, 0.005});
        if (least > 0.02) {  // what turns between two steps is less
            ++misses;
            ASSERT_TRUE(contacts.empty()) << round;
        }
        if (least > -0.01) {
            continue;
        }
        ++hits;
        // A brush that ends clear along its own normal is no stop (collision_world.hpp).
        const double touch =
            oracle.touch(way, (first - 1) / double{k_steps}, first / double{k_steps});
        const Pose there = way.at(touch);
        const bool stopped =
            std::any_of(contacts.begin(), contacts.end(), [&](const ContactPoint& contact) {
                const Vec3 point = transform_point(there, contact.point_a_bs);
                return std::abs(contact.normal_b_bs.dot(point - contact.point_b_bs)) < 5e-6;
            });
        brushed += stopped ? 0 : 1;
    }
    EXPECT_GT(hits, 150);
    EXPECT_GT(misses, 40);
    EXPECT_LE(brushed, hits / 50);
}

TEST(SweepOfAllKinds, FlyingHammersArmIsCaughtThoughItsCentreMissesTheWall) {
    // The head flies over the wall's edge; a bar 0.4 m below it does not.
    ShapeLibrary shapes;
    const ShapeId ball = shapes.add_sphere(0.05);
    const std::vector<CompoundChild> parts = {{ball, {}, 0}, {ball, at({0.0, -0.4, 0.0}), 0}};
    const ShapeId body = shapes.add_compound(parts);
    const ShapeId wall = shapes.add_mesh(test::make_floor(2.0, 5, test::Winding::mixed));
    // The wall stands in the plane x = 0, up to y = 0; the body's centre goes along y = 0.2.
    const Pose standing =
        at({0.0, -1.0, 0.0}, rotation_about(Vec3::UnitZ(), 1.57079632679489661923));
    const auto contacts =
        contacts_of(shapes, {resting(1, wall, standing, false),
                             {2, body, at({-0.5, 0.2, 0.0}), at({0.7, 0.2, 0.0}), true}});
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_NEAR(contacts[0].separation_m, -0.75, 1e-6);
    EXPECT_NEAR(contacts[0].point_a_bs.y(), -0.4, 1e-6);
}

TEST(SweepOfAllKinds, ArmSwungThroughAWallIsCaught) {
    // A ball on an arm of 1 m swings by 1.5 rad; its chord, but not its arc, misses the post.
    ShapeLibrary shapes;
    const ShapeId ball = shapes.add_sphere(0.03);
    const std::vector<CompoundChild> parts = {{ball, {}, 0}, {ball, at({1.0, 0.0, 0.0}), 0}};
    const ShapeId arm = shapes.add_compound(parts);
    const ShapeId post = shapes.add_cylinder(0.03, 0.5);
    double sine = 0.0;
    double cosine = 0.0;
    sin_cos(0.75, sine, cosine);
    const Pose there = at({cosine, 0.0, -sine});  // on the arc's middle
    const auto contacts = contacts_of(
        shapes, {resting(1, post, there, false),
                 {2, arm, {}, at(Vec3::Zero(), rotation_about(Vec3::UnitY(), 1.5)), true}});
    ASSERT_GE(contacts.size(), 1U);
    for (const ContactPoint& contact : contacts) {
        EXPECT_NEAR(contact.point_a_bs.norm(), 1.0, 0.031);
        EXPECT_LT(contact.separation_m, -0.5);
    }
}

// A ball that rolls on after it touched has turned the point that touched away: its depth is still
// that of the ball.
TEST(SweepOfAllKinds, BallThatTurnsAfterTheTouchIsAsDeepAsItIs) {
    ShapeLibrary shapes;
    const ShapeId ball = shapes.add_sphere(0.1);
    const ShapeId floor = shapes.add_mesh(test::make_floor(3.0, 17, test::Winding::mixed));
    const ShapeId slab = shapes.add_box({1.5, 0.5, 1.5});
    for (const auto& ground :
         {resting(1, floor, {}, false), resting(1, slab, at({0.0, -0.5, 0.0}), false)}) {
        for (const double turn : {0.0, 0.8, -2.5}) {
            const Pose from = at({0.1, 0.15, 0.05});
            const Pose to = at({0.4, 0.04, 0.15}, rotation_about(Vec3::UnitZ(), turn));
            double deepest = 0.0;
            for (const ContactPoint& contact :
                 contacts_of(shapes, {ground, {2, ball, from, to, true}})) {
                deepest = std::min(deepest, contact.separation_m);
            }
            EXPECT_NEAR(deepest, 0.04 - 0.1, 1e-6) << turn;
        }
    }
}

TEST(CompoundContacts, AllPartsHoldAndEachOutlineIsOne) {
    // A table of a top and two ends, on a floor: the floor's outline is that of both feet.
    ShapeLibrary shapes;
    const ShapeId foot = shapes.add_box({0.05, 0.1, 0.2});
    const ShapeId top = shapes.add_box({0.5, 0.05, 0.2});
    const std::vector<CompoundChild> parts = {{top, at({0.0, 0.15, 0.0}), 0},
                                              {foot, at({-0.4, 0.0, 0.0}), 0},
                                              {foot, at({0.4, 0.0, 0.0}), 0}};
    const ShapeId table = shapes.add_compound(parts);
    const ShapeId floor = shapes.add_mesh(test::make_floor(3.0, 17, test::Winding::mixed));
    const ShapeId slab = shapes.add_box({1.5, 0.5, 1.5});
    for (const auto& ground :
         {resting(1, floor, {}, false), resting(1, slab, at({0.0, -0.5, 0.0}), false)}) {
        const auto contacts =
            contacts_of(shapes, {ground, resting(2, table, at({0.0, 0.099, 0.0}), true)});
        ASSERT_EQ(contacts.size(), 4U);
        for (const ContactPoint& contact : contacts) {
            EXPECT_NEAR(contact.separation_m, -0.001, 1e-9);
            EXPECT_NEAR(std::abs(contact.point_b_bs.x()), 0.45, 1e-8);
            EXPECT_NEAR(std::abs(contact.point_b_bs.z()), 0.2, 1e-8);
        }
    }
}

TEST(CompoundContacts, ThingInItsHollowTouchesTheWallsNotTheHull) {
    // A ball in a cup of five boxes: convex, the cup would hold it at its rim's height.
    ShapeLibrary shapes;
    const ShapeId side = shapes.add_box({0.01, 0.1, 0.11});
    const std::vector<CompoundChild> parts = {
        {shapes.add_box({0.1, 0.01, 0.1}), at({0.0, -0.1, 0.0}), 0},
        {side, at({0.1, 0.0, 0.0}), 0},
        {side, at({-0.1, 0.0, 0.0}), 0},
        {side, at({0.0, 0.0, 0.1}, rotation_about(Vec3::UnitY(), 1.57079632679489661923)), 0},
        {side, at({0.0, 0.0, -0.1}, rotation_about(Vec3::UnitY(), 1.57079632679489661923)), 0}};
    const ShapeId cup = shapes.add_compound(parts);
    const ShapeId ball = shapes.add_sphere(0.05);
    const auto contacts = contacts_of(
        shapes, {resting(1, cup, {}, true), resting(2, ball, at({0.035, -0.045, 0.0}), true)});
    ASSERT_EQ(contacts.size(), 2U);
    EXPECT_NEAR(test::deepest(contacts), -0.005, 1e-9);
    for (const ContactPoint& contact : contacts) {
        EXPECT_NEAR(contact.separation_m, std::abs(contact.normal_b_bs.y()) > 0.5 ? -0.005 : 0.005,
                    1e-9);
    }
}

}  // namespace
}  // namespace handhold::collision_compound_test
