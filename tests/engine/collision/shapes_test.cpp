#include <cmath>

#include <gtest/gtest.h>

#include "engine/core/check.hpp"
#include "tests/engine/collision/oracle.hpp"

// Cylinders, hulls and compounds. Distances are certified (distance_test.cpp), and boxes built as
// hulls or compounds behave as boxes.
namespace handhold::collision_shapes_test {
namespace {

using test::at;
using test::contacts_of;
using test::Random;
using test::resting;

enum class Kind { sphere, capsule, box, cylinder, hull };
constexpr std::array<Kind, 5> k_kinds = {Kind::sphere, Kind::capsule, Kind::box, Kind::cylinder,
                                         Kind::hull};

ShapeId random_shape(Random& random, ShapeLibrary& shapes, Kind kind) {
    const double x = random.between(0.02, 0.4);
    const double y = random.between(0.02, 0.4);
    switch (kind) {
        case Kind::sphere:
            return shapes.add_sphere(x);
        case Kind::capsule:
            return shapes.add_capsule(x, y);
        case Kind::box:
            return shapes.add_box({x, y, random.between(0.02, 0.4)});
        case Kind::cylinder:
            return shapes.add_cylinder(x, y);
        case Kind::hull:
            break;
    }
    std::vector<Vec3> points;
    const Vec3 middle = random.vector(0.2);  // a hull's origin may lie outside it
    points.resize(static_cast<std::size_t>(random.between(8.0, 60.0)));
    for (Vec3& point : points) {
        point = middle + random.vector(0.05 + y);
    }
    return shapes.add_hull(points);
}

ContactPoint nearest(const std::vector<ContactPoint>& contacts) {
    return *std::min_element(contacts.begin(), contacts.end(), [](const auto& a, const auto& b) {
        return a.separation_m < b.separation_m;
    });
}

// Hill climbing: improves a direction to one along which the gap is larger.
double climb(Random& random, const test::Core& a, const test::Core& b, Vec3 direction) {
    double best = gap_along(a, b, direction);
    for (double step = 0.3; step > 1e-7;) {
        bool up = false;
        for (int i = 0; i < 12; ++i) {
            const Vec3 other = (direction + step * random.direction()).normalized();
            if (const double gap = gap_along(a, b, other); gap > best) {
                best = gap;
                direction = other;
                up = true;
            }
        }
        step *= up ? 1.0 : 0.6;
    }
    return best;
}

TEST(ShapeSeparation, IsCertifiedForAllPairsOfKinds) {
    Random random(91);
    int apart = 0;
    int deep = 0;
    for (int round = 0; round < 4000; ++round) {
        ShapeLibrary shapes;
        const auto kind_a = k_kinds[static_cast<std::size_t>(round % 5)];
        const auto kind_b = k_kinds[static_cast<std::size_t>(round / 5 % 5)];
        const ShapeId a = random_shape(random, shapes, kind_a);
        const ShapeId b = random_shape(random, shapes, kind_b);
        const Vec3 place = random.vector(round % 2 == 0 ? 1.0 : 0.3);
        const Pose pose = at(place, random.rotation());
        const ContactPoint c = nearest(contacts_of(
            shapes, {resting(1, b, {}, false), resting(2, a, pose, true)}, {10.0, 0.005}));
        const test::Core core_a = test::make_core(shapes.at(a), pose);
        const test::Core core_b = test::make_core(shapes.at(b), {});
        const double gap = gap_along(core_a, core_b, c.normal_b_bs);
        const Vec3 point_a = transform_point(pose, c.point_a_bs);
        ASSERT_NEAR((point_a - c.point_b_bs).dot(c.normal_b_bs), c.separation_m, 1e-9);
        if (c.separation_m > 0.0) {
            ++apart;
            ASSERT_NEAR(gap, c.separation_m, 1e-6) << round;
        } else {
            ++deep;
            ASSERT_NEAR(gap, c.separation_m, 2e-6) << round;
            ASSERT_LE(climb(random, core_a, core_b, c.normal_b_bs), c.separation_m + 2e-6);
            for (int i = 0; i < 50; ++i) {
                ASSERT_LE(gap_along(core_a, core_b, random.direction()), c.separation_m + 2e-6);
            }
        }
    }
    EXPECT_GT(apart, 1500);
    EXPECT_GT(deep, 800);
}

std::vector<Vec3> corners_of_box(const Vec3& half) { return test::make_box_mesh(half)->positions; }

// The floor y = 0 as the face of a box, as a mesh, and as the face of a hull.
struct Ground {
    ShapeLibrary shapes;
    ShapeId shape;
    Pose pose;
};

std::vector<Ground> make_grounds() {
    std::vector<Ground> grounds(3);
    grounds[0].shape = grounds[0].shapes.add_box({2.0, 0.5, 2.0});
    grounds[0].pose = at({0.0, -0.5, 0.0});
    grounds[1].shape = grounds[1].shapes.add_mesh(test::make_floor(4.0, 23, test::Winding::mixed));
    std::vector<Vec3> corners;
    for (const Vec3& corner : corners_of_box({2.0, 0.5, 2.0})) {
        corners.push_back(corner - 0.5 * Vec3::UnitY());
    }
    grounds[2].shape = grounds[2].shapes.add_hull(corners);
    return grounds;
}

TEST(CylinderContacts, FlatEndTouchesAllAroundItsRim) {
    for (Ground& ground : make_grounds()) {
        const ShapeId cylinder = ground.shapes.add_cylinder(0.2, 0.3);
        for (const double gap : {0.004, 0.0, -0.002}) {
            const Pose pose = at({0.1, 0.3 + gap, 0.07}, rotation_about(Vec3::UnitY(), 0.4));
            const auto contacts = contacts_of(
                ground.shapes,
                {resting(1, ground.shape, ground.pose, false), resting(2, cylinder, pose, true)});
            ASSERT_EQ(contacts.size(), 8U);
            std::vector<double> angles;
            for (const ContactPoint& contact : contacts) {
                EXPECT_NEAR(contact.separation_m, gap, 1e-9);
                EXPECT_NEAR(contact.normal_b_bs.y(), 1.0, 1e-12);
                EXPECT_NEAR(contact.point_a_bs.y(), -0.3, 1e-9);
                EXPECT_NEAR(std::hypot(contact.point_a_bs.x(), contact.point_a_bs.z()), 0.2, 1e-9);
                angles.push_back(std::atan2(contact.point_a_bs.z(), contact.point_a_bs.x()));
            }
            std::sort(angles.begin(), angles.end());
            for (std::size_t i = 1; i < angles.size();
                 ++i) {  // no gap above an eighth of the circle
                EXPECT_LT(angles[i] - angles[i - 1], 0.8);
            }
        }
    }
}

TEST(CylinderContacts, SideTouchesAtTwoPointsAtEveryRollAngle) {
    for (Ground& ground : make_grounds()) {
        const ShapeId cylinder = ground.shapes.add_cylinder(0.2, 0.3);
        const Quat lying = rotation_about(Vec3::UnitY(), 0.3) *
                           rotation_about(Vec3::UnitX(), 1.57079632679489661923);
        for (int i = 0; i < 200; ++i) {
            const double gap = i % 2 == 0 ? 0.003 : -0.001;
            const Quat roll = rotation_about(Vec3::UnitY(), 0.0317 * i);
            const auto contacts =
                contacts_of(ground.shapes,
                            {resting(1, ground.shape, ground.pose, false),
                             resting(2, cylinder, at({0.1, 0.2 + gap, 0.0}, lying * roll), true)});
            ASSERT_EQ(contacts.size(), 2U) << i;
            for (const ContactPoint& contact : contacts) {
                ASSERT_NEAR(contact.separation_m, gap, 1e-9);  // round, not faceted
                ASSERT_NEAR(std::abs(contact.point_a_bs.y()), 0.3, 1e-9);
            }
        }
    }
}

TEST(CylinderContacts, TiltedCylinderTouchesAtTheDeepestPointOfItsRim) {
    for (Ground& ground : make_grounds()) {
        const ShapeId cylinder = ground.shapes.add_cylinder(0.2, 0.3);
        for (const double tilt : {0.001, 0.05, 0.3, 0.9, 1.4}) {
            for (int i = 0; i < 20; ++i) {
                const Quat turn =
                    rotation_about(Vec3::UnitZ(), tilt) * rotation_about(Vec3::UnitY(), 0.31 * i);
                const double height = 0.3 * std::cos(tilt) + 0.2 * std::sin(tilt) - 0.001;
                const auto contacts = contacts_of(
                    ground.shapes, {resting(1, ground.shape, ground.pose, false),
                                    resting(2, cylinder, at({0, height, 0}, turn), true)});
                // A point that is deeper than the rest by less than a micrometre is left out.
                ASSERT_NEAR(test::deepest(contacts), -0.001, 1.1e-6) << tilt << " " << i;
            }
        }
    }
}

TEST(CylinderContacts, OverhangingCylinderTouchesOnlyTheCommonPart) {
    ShapeLibrary shapes;
    const ShapeId ledge = shapes.add_box({0.5, 0.5, 0.5});
    const ShapeId cylinder = shapes.add_cylinder(0.2, 0.3);
    const auto contacts = contacts_of(
        shapes, {resting(1, ledge, {}, false), resting(2, cylinder, at({0.55, 0.799, 0.0}), true)});
    ASSERT_GE(contacts.size(), 4U);
    double farthest_x = -1.0;
    for (const ContactPoint& contact : contacts) {
        EXPECT_NEAR(contact.separation_m, -0.001, 1e-9);
        EXPECT_LE(contact.point_b_bs.x(), 0.5 + 2e-9);
        farthest_x = std::max(farthest_x, contact.point_b_bs.x());
    }
    EXPECT_NEAR(farthest_x, 0.5, 2e-9);
}

// The same solid in another representation; `frame`: its own frame in the body's.
struct Alias {
    ShapeId shape;
    Pose frame;
};

std::vector<Alias> same_box(ShapeLibrary& shapes, const Vec3& half) {
    const Pose aside = at({0.3, -0.2, 0.1}, rotation_about(Vec3::UnitZ(), 0.7));
    std::vector<Vec3> moved;
    for (const Vec3& corner : corners_of_box(half)) {
        moved.push_back(transform_point(aside, corner));
    }
    const ShapeId box = shapes.add_box(half);
    const std::vector<CompoundChild> single = {{box, aside, 0.0}};
    const CentredShape centred = shapes.add_centred(shapes.add_hull(moved));
    return {{shapes.add_hull(corners_of_box(half)), {}},
            {shapes.add_hull(moved), aside},
            {shapes.add_compound(single), aside},
            {centred.shape, inverse(centred.frame) * aside}};
}

void expect_same_contacts(const std::vector<ContactPoint>& expected, const Alias& alias,
                          const std::vector<ContactPoint>& contacts, double tolerance_m) {
    ASSERT_EQ(contacts.size(), expected.size());
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        EXPECT_NEAR(contacts[i].separation_m, expected[i].separation_m, tolerance_m);
        EXPECT_LT((contacts[i].normal_b_bs - expected[i].normal_b_bs).norm(), 1e-6);
        EXPECT_LT((contacts[i].point_b_bs - expected[i].point_b_bs).norm(), 1e-5);
        EXPECT_LT(
            (inverse_transform_point(alias.frame, contacts[i].point_a_bs) - expected[i].point_a_bs)
                .norm(),
            1e-5);
    }
}

TEST(Alias, HullAndCompoundBoxesMakeTheContactsOfABox) {
    Random random(92);
    const Vec3 half(0.2, 0.1, 0.3);
    int met = 0;
    for (Ground& ground : make_grounds()) {
        const ShapeId box = ground.shapes.add_box(half);
        const std::vector<Alias> aliases = same_box(ground.shapes, half);
        for (int round = 0; round < 60; ++round) {
            const Vec3 place{random.between(-1.0, 1.0), random.between(0.05, 0.3), 0.1};
            const Quat turn =
                round % 2 == 0 ? rotation_about(Vec3::UnitY(), 0.1 * round) : random.rotation();
            const Pose to = at(place, turn);
            const Pose from = at(place + Vec3(0.0, 0.5, 0.0), round % 3 == 0 ? turn : to.rotation);
            for (const bool swept : {false, true}) {
                const auto proxies = [&](ShapeId shape, const Pose& frame) {
                    const Pose back = inverse(frame);
                    return std::vector<ColliderProxy>{
                        resting(1, ground.shape, ground.pose, false),
                        {2, shape, (swept ? from : to) * back, to * back, true}};
                };
                const auto expected = contacts_of(ground.shapes, proxies(box, {}));
                met += expected.empty() ? 0 : 1;
                for (const Alias& alias : aliases) {
                    SCOPED_TRACE(testing::Message() << round << " swept " << swept);
                    expect_same_contacts(
                        expected, alias,
                        contacts_of(ground.shapes, proxies(alias.shape, alias.frame)), 2e-6);
                }
            }
        }
    }
    EXPECT_GT(met, 100);
}

TEST(Alias, HullAndCompoundBoxesAreHitByTheSameRays) {
    Random random(93);
    ShapeLibrary shapes;
    const Vec3 half(0.2, 0.1, 0.3);
    const ShapeId box = shapes.add_box(half);
    const std::vector<Alias> aliases = same_box(shapes, half);
    const std::vector<CompoundChild> halves = {
        {shapes.add_box({0.1, 0.1, 0.3}), at({-0.1, 0, 0}), 0},
        {shapes.add_box({0.1, 0.1, 0.3}), at({0.1, 0, 0}), 0},
        {shapes.add_sphere(0.05), {}, 0}};
    const Shape cut = shapes.at(shapes.add_compound(halves));
    CollisionWorld world(shapes);
    int hits = 0;
    for (int round = 0; round < 500; ++round) {
        const Pose pose = random.pose(1.0);
        const Vec3 from = pose.position + random.vector(round % 2 == 0 ? 0.2 : 1.0);
        const Vec3 to = pose.position + random.vector(1.0);
        const auto answer = [&](ShapeId shape, const Pose& frame) {
            world.set_proxies({{resting(1, shape, pose * inverse(frame), false)}});
            return std::pair(world.cast_ray(from, to), world.closest_point(from, 3.0));
        };
        const auto [hit, near] = answer(box, {});
        hits += hit ? 1 : 0;
        std::vector<Alias> all = aliases;
        all.push_back({{static_cast<std::uint32_t>(shapes.size() - 1)}, {}});
        for (const Alias& alias : all) {
            const auto [other_hit, other_near] = answer(alias.shape, alias.frame);
            ASSERT_EQ(other_hit.has_value(), hit.has_value()) << round;
            if (hit) {
                ASSERT_LT((other_hit->point_ws - hit->point_ws).norm(), 1e-9);
                ASSERT_LT((other_hit->normal_ws - hit->normal_ws).norm(), 1e-9);
            }
            ASSERT_NEAR(other_near->distance_m, near->distance_m, 1e-9);
            if (near->distance_m > 1e-6) {
                ASSERT_LT((other_near->point_ws - near->point_ws).norm(), 1e-9);
            }
        }
    }
    EXPECT_GT(hits, 150);
}

TEST(CylinderQueries, RaysAndClosestPointsMatchTheClosedForms) {
    ShapeLibrary shapes;
    const ShapeId cylinder = shapes.add_cylinder(0.2, 0.3);
    CollisionWorld world(shapes);
    world.set_proxies({{resting(1, cylinder, {}, false)}});
    const auto side = world.cast_ray({1.0, 0.1, 0.12}, {-1.0, 0.1, 0.12});
    ASSERT_TRUE(side.has_value());
    EXPECT_NEAR(side->point_ws.x(), 0.16, 1e-12);  // 0.12, 0.16, 0.2
    EXPECT_NEAR(side->normal_ws.z(), 0.6, 1e-12);
    const auto end = world.cast_ray({0.1, 1.0, 0.1}, {0.1, -1.0, 0.1});
    ASSERT_TRUE(end.has_value());
    EXPECT_NEAR(end->point_ws.y(), 0.3, 1e-12);
    EXPECT_FALSE(world.cast_ray({0.15, 1.0, 0.15}, {0.15, -1.0, 0.15}));  // 0.212 from the axis
    const auto out = world.cast_ray({0.0, 0.0, 0.0}, {0.0, 1.0, 0.1});
    ASSERT_TRUE(out.has_value());
    EXPECT_NEAR(out->point_ws.y(), 0.3, 1e-12);
    const auto rim = world.closest_point({0.5, 0.7, 0.0}, 2.0);
    ASSERT_TRUE(rim.has_value());
    EXPECT_NEAR(rim->distance_m, 0.5, 1e-12);  // 0.3 beside and 0.4 above the rim
    EXPECT_LT((rim->normal_ws - Vec3(0.6, 0.8, 0.0)).norm(), 1e-12);
}

TEST(CompoundQueries, RaysFromInsideExitTheUnionOfOverlappingParts) {
    ShapeLibrary shapes;
    const ShapeId ball = shapes.add_sphere(0.1);
    const std::vector<CompoundChild> row = {{ball, at({0.0, 0.0, 0.0}), 0},
                                            {ball, at({0.15, 0.0, 0.0}), 0},
                                            {ball, at({0.3, 0.0, 0.0}), 0},
                                            {ball, at({0.6, 0.0, 0.0}), 0}};
    const ShapeId chain = shapes.add_compound(row);
    CollisionWorld world(shapes);
    world.set_proxies({{resting(1, chain, {}, false)}});
    const auto out = world.cast_ray({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0});
    ASSERT_TRUE(out.has_value());
    EXPECT_NEAR(out->distance_m, 0.4, 1e-12);  // end of the third ball
    const auto in = world.cast_ray({0.45, 0.0, 0.0}, {1.0, 0.0, 0.0});
    ASSERT_TRUE(in.has_value());
    EXPECT_NEAR(in->point_ws.x(), 0.5, 1e-12);
}

TEST(Shapes, InvalidShapesAreRefused) {
    ShapeLibrary shapes;
    const ShapeId ball = shapes.add_sphere(0.1);
    const ShapeId mesh = shapes.add_mesh(test::make_floor(1.0, 1));
    EXPECT_THROW(shapes.add_cylinder(0.0, 1.0), PreconditionError);
    EXPECT_THROW(shapes.add_cylinder(1.0, std::nan("")), PreconditionError);
    EXPECT_THROW(shapes.add_hull(std::vector<Vec3>(5, Vec3::Zero())), PreconditionError);
    EXPECT_THROW(shapes.add_compound({}), PreconditionError);
    const std::vector<CompoundChild> of_mesh = {{mesh, {}, 0}};
    EXPECT_THROW(shapes.add_compound(of_mesh), PreconditionError);
    const std::vector<CompoundChild> mixed = {{ball, {}, 1.0}, {ball, {}, 0.0}};
    EXPECT_THROW(shapes.add_compound(mixed), PreconditionError);
    const std::vector<CompoundChild> many(k_max_parts + 1, CompoundChild{ball, {}, 0.0});
    EXPECT_THROW(shapes.add_compound(many), PreconditionError);
    const auto floor = test::make_floor(1.0, 1);
    EXPECT_THROW(shapes.add_mesh(floor, Vec3(1.0, 0.0, 1.0)), PreconditionError);
    EXPECT_THROW(shapes.add_mesh(floor, Vec3(1.0, -1e-4, 1.0)), PreconditionError);
    EXPECT_THROW(shapes.add_centred(mesh), PreconditionError);
}

}  // namespace
}  // namespace handhold::collision_shapes_test
