// Colliders at rest cost nothing, and changes sent one by one give the contacts of a new world.
#include <algorithm>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "engine/core/check.hpp"
#include "tests/engine/collision/scene.hpp"

namespace handhold::test::collision_still_colliders_test {
namespace {

bool same(const ContactPoint& x, const ContactPoint& y) {
    return x.id_a == y.id_a && x.id_b == y.id_b && x.point_a_bs == y.point_a_bs &&
           x.point_b_bs == y.point_b_bs && x.normal_b_bs == y.normal_b_bs &&
           x.separation_m == y.separation_m && x.feature == y.feature;
}

// Balls and boxes on a floor, close enough to touch.
struct Clutter {
    ShapeLibrary shapes;
    ShapeId ball = shapes.add_sphere(0.12);
    ShapeId box = shapes.add_box(Vec3(0.15, 0.1, 0.2));
    ShapeId floor = shapes.add_mesh(make_floor(6.0, 12));
    std::vector<ColliderProxy> proxies;

    explicit Clutter(Random& random) {
        proxies.push_back(resting(1, floor, at(Vec3::Zero()), false));
        for (std::uint64_t id = 2; id < 50; ++id) {
            const Vec3 place = random.vector(1.0);
            const Quat turn = random.rotation();
            proxies.push_back(resting(id, id % 2 == 0 ? ball : box, at(place, turn), id % 5 != 0));
        }
    }
};

// Changes a few colliders; returns what changed, in random order.
std::vector<ColliderProxy> move_some(Clutter& clutter, Random& random) {
    std::vector<ColliderProxy> changed;
    for (ColliderProxy& proxy : clutter.proxies) {
        if (proxy.id == 1 || random.between(0.0, 1.0) > 0.1) {
            continue;
        }
        const double kind = random.between(0.0, 1.0);
        proxy.from_ws = proxy.to_ws;
        if (kind < 0.7) {
            proxy.to_ws.position += random.vector(0.3);
            proxy.to_ws.rotation = random.rotation();
        } else if (kind < 0.8) {
            proxy.to_ws = random.pose(1.0);  // from anywhere
        } else if (kind < 0.9) {
            proxy.mask ^= 1U;
        } else {
            proxy.to_ws.position.x() = std::numeric_limits<double>::quiet_NaN();
        }
        changed.push_back(proxy);
        if (kind >= 0.9) {
            proxy.to_ws = proxy.from_ws;  // valid again when it changes next
        }
    }
    std::ranges::shuffle(changed, random.engine());
    return changed;
}

TEST(StillColliders, ChangesSentOneByOneGiveTheContactsOfANewWorld) {
    Random random(5);
    Clutter clutter(random);
    CollisionWorld warm(clutter.shapes);
    warm.set_proxies(clutter.proxies);
    std::vector<ColliderProxy> sent = clutter.proxies;
    std::vector<IgnoredPair> ignored;
    std::size_t total = 0;
    for (int round = 0; round < 300; ++round) {
        const std::vector<ColliderProxy> changed = move_some(clutter, random);
        warm.update_proxies(changed);
        for (const ColliderProxy& proxy : changed) {
            sent[proxy.id - 1] = proxy;
        }
        if (round % 5 == 2) {
            ignored.clear();
            for (std::uint64_t id = 2; id < 49; ++id) {
                if (random.between(0.0, 1.0) < 0.3) {
                    ignored.push_back({id, id + 1});
                }
            }
        }
        // Other margins now and then: nothing that was cached for one holds for another.
        const ContactLimits limits{round % 11 == 7 ? 0.05 : 0.02, 0.005};
        CollisionWorld fresh(clutter.shapes);
        fresh.set_proxies(sent);
        std::vector<ContactPoint> expected;
        std::vector<ContactPoint> found;
        fresh.set_ignored_pairs(ignored);
        fresh.find_contacts(limits, expected);
        warm.set_ignored_pairs(ignored);
        warm.find_contacts(limits, found);
        ASSERT_TRUE(std::ranges::equal(found, expected, same)) << "round " << round;
        total += found.size();
    }
    EXPECT_GT(total, 3000U);
}

TEST(StillColliders, CostNoSearchNoUpdateAndNoNarrowphase) {
    ShapeLibrary shapes;
    const ShapeId box = shapes.add_box(Vec3::Constant(0.1));
    std::vector<ColliderProxy> proxies;
    for (std::uint64_t i = 0; i < 2000; ++i) {
        const Vec3 cell(static_cast<double>(i % 20), static_cast<double>(i / 20 % 10),
                        static_cast<double>(i / 200));
        // Rows of touching boxes, and boxes far from each other.
        const Vec3 place = i < 1000 ? Vec3(0.2 * cell) : Vec3(cell + 10.0 * Vec3::UnitX());
        proxies.push_back(resting(i + 1, box, at(place), i % 3 != 0));
    }
    CollisionWorld world(shapes);
    world.set_proxies(proxies);
    std::vector<ContactPoint> contacts;
    world.find_contacts({}, contacts);
    world.find_contacts({}, contacts);
    const std::size_t count = contacts.size();
    EXPECT_GT(count, 1000U);
    (void)world.take_work();

    world.update_proxies({});
    world.find_contacts({}, contacts);
    const CollisionWork still = world.take_work();
    EXPECT_EQ(still.narrowphase_calls, 0U);
    EXPECT_EQ(still.bounds_updates, 0U);
    EXPECT_EQ(still.tree_queries, 0U);
    EXPECT_EQ(contacts.size(), count);

    // One box moves: it and its few neighbours are searched. Its first move after the spawn also
    // renews the lists of neighbours, with one query for each of the 1,333 free boxes.
    const auto move_one = [&] {
        proxies[4].to_ws.position.y() += 0.001;
        world.update_proxies(std::span(proxies).subspan(4, 1));
        world.find_contacts({}, contacts);
        return world.take_work();
    };
    EXPECT_LE(move_one().tree_queries, 1333U + 60U);
    const CollisionWork moved = move_one();
    EXPECT_EQ(moved.bounds_updates, 1U);
    EXPECT_LE(moved.tree_queries, 60U);
    EXPECT_LE(moved.narrowphase_calls, 26U);
    EXPECT_GE(moved.narrowphase_calls, 2U);
}

TEST(StillColliders, UpdatesOfUnknownCollidersAreRefused) {
    ShapeLibrary shapes;
    const ShapeId box = shapes.add_box(Vec3::Constant(0.1));
    CollisionWorld world(shapes);
    const ColliderProxy known = resting(1, box, at(Vec3::Zero()), true);
    world.set_proxies(std::span(&known, 1));
    const ColliderProxy unknown = resting(2, box, at(Vec3::Zero()), true);
    EXPECT_THROW(world.update_proxies(std::span(&unknown, 1)), PreconditionError);
    const ColliderProxy shapeless = resting(1, k_no_shape, at(Vec3::Zero()), true);
    EXPECT_THROW(world.update_proxies(std::span(&shapeless, 1)), PreconditionError);
    const ColliderProxy neither = resting(2, k_no_shape, at(Vec3::Zero()), true);
    EXPECT_NO_THROW(world.update_proxies(std::span(&neither, 1)));
}

TEST(StillColliders, NearIdsAreThoseWhoseBoundsOverlapTheBox) {
    Random random(9);
    Clutter clutter(random);
    CollisionWorld world(clutter.shapes);
    world.set_proxies(clutter.proxies);
    for (int round = 0; round < 100; ++round) {
        const Vec3 low = random.vector(1.2);
        const Vec3 high = low + random.vector(0.4).cwiseAbs();
        const std::span<const std::uint64_t> near = world.find_near(low, high);
        EXPECT_TRUE(std::ranges::is_sorted(near));
        const std::vector<std::uint64_t> found(near.begin(), near.end());
        for (const ColliderProxy& proxy : clutter.proxies) {
            const bool is_inside = (proxy.to_ws.position.array() >= low.array()).all() &&
                                   (proxy.to_ws.position.array() <= high.array()).all();
            const bool is_far = proxy.id > 1 && ((low - proxy.to_ws.position).maxCoeff() > 0.3 ||
                                                 (proxy.to_ws.position - high).maxCoeff() > 0.3);
            const bool is_found = std::ranges::binary_search(found, proxy.id);
            EXPECT_TRUE(!is_inside || is_found) << proxy.id;
            EXPECT_FALSE(is_far && is_found) << proxy.id;
        }
    }
}

}  // namespace
}  // namespace handhold::test::collision_still_colliders_test
