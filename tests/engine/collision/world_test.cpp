#include <array>
#include <limits>
#include <tuple>

#include <gtest/gtest.h>

#include "engine/core/check.hpp"
#include "engine/core/hash.hpp"
#include "tests/engine/collision/scene.hpp"

// The world as a cache: equal proxies give equal answers, whatever it saw before.
namespace handhold::collision_world_test {
namespace {

using test::at;
using test::Random;
using test::resting;

std::uint64_t hash_of(const std::vector<ContactPoint>& contacts) {
    HashStream hash;
    for (const ContactPoint& c : contacts) {
        hash.add(c.id_a);
        hash.add(c.id_b);
        hash.add(std::uint64_t{c.feature});
        hash.add(c.separation_m);
        for (const Vec3* v : {&c.point_a_bs, &c.point_b_bs, &c.normal_b_bs}) {
            hash.add(v->x());
            hash.add(v->y());
            hash.add(v->z());
        }
    }
    return hash.value();
}

struct Crowd {
    ShapeLibrary shapes;
    std::vector<ShapeId> kinds;
    ShapeId level;

    Crowd() {
        kinds = {shapes.add_box({0.1, 0.05, 0.2}), shapes.add_sphere(0.12),
                 shapes.add_capsule(0.06, 0.15)};
        level = shapes.add_mesh(test::make_wavy_ball(1.2, 24, 40));
    }
    // Everything drifts with `time`; a body is there in some frames and not in others.
    std::vector<ColliderProxy> frame(int time) const {
        std::vector<ColliderProxy> proxies;
        proxies.push_back(
            {1, level, at({0.001 * time, 0.0, 0.0}), at({0.001 * (time + 1), 0.0, 0.0}), false});
        for (std::uint64_t id = 2; id < 60; ++id) {
            Random random(id);
            const Vec3 start = 1.1 * random.direction();
            const Vec3 velocity = random.vector(id % 3 == 0 ? 0.03 : 0.002);
            const Quat rotation = random.rotation();
            const Quat turn = rotation_from_vector(random.vector(0.05));
            if ((static_cast<int>(id) + time) % 7 == 0) {
                continue;
            }
            proxies.push_back({id, kinds[id % 3], at(start + time * velocity, rotation),
                               at(start + (time + 1) * velocity, (turn * rotation).normalized()),
                               id % 5 != 0});
        }
        return proxies;
    }
};

TEST(CollisionWorld, RebuiltWorldAnswersBitForBitAlike) {
    const Crowd crowd;
    CollisionWorld lasting(crowd.shapes);
    std::vector<ContactPoint> contacts;
    std::vector<ContactPoint> afresh;
    std::size_t most = 0;
    for (int time = 0; time < 30; ++time) {
        const auto proxies = crowd.frame(time);
        lasting.set_proxies(proxies);
        lasting.find_contacts({}, contacts);
        CollisionWorld rebuilt(crowd.shapes);
        rebuilt.set_proxies(proxies);
        rebuilt.find_contacts({}, afresh);
        ASSERT_EQ(hash_of(contacts), hash_of(afresh)) << "frame " << time;
        most = std::max(most, contacts.size());
    }
    EXPECT_GT(most, 50U);  // the scene does meet
}

TEST(CollisionWorld, HistoriesInAnyOrderEndAlike) {
    const Crowd crowd;
    Random random(51);
    const auto last = crowd.frame(7);
    std::uint64_t expected = 0;
    for (int history = 0; history < 8; ++history) {
        CollisionWorld world(crowd.shapes);
        for (int i = 0; i < 10; ++i) {
            auto proxies = crowd.frame(static_cast<int>(random.between(0.0, 100.0)));
            std::shuffle(proxies.begin(), proxies.end(), random.engine());
            proxies.resize(proxies.size() / 2);
            std::sort(proxies.begin(), proxies.end(),
                      [](const auto& a, const auto& b) { return a.id < b.id; });
            world.set_proxies(proxies);
        }
        world.set_proxies(last);
        std::vector<ContactPoint> contacts;
        world.find_contacts({}, contacts);
        const std::uint64_t hash = hash_of(contacts);
        expected = history == 0 ? hash : expected;
        ASSERT_EQ(hash, expected);
        world.find_contacts({}, contacts);
        ASSERT_EQ(hash_of(contacts), expected) << "a second call differs";
    }
}

TEST(CollisionWorld, ContactsAreSortedAndRanked) {
    const Crowd crowd;
    CollisionWorld world(crowd.shapes);
    world.set_proxies(crowd.frame(3));
    std::vector<ContactPoint> contacts;
    world.find_contacts({}, contacts);
    const auto free = [&](std::uint64_t id) { return id != 1 && id % 5 != 0; };
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        const ContactPoint& c = contacts[i];
        EXPECT_TRUE(free(c.id_a));
        EXPECT_TRUE(!free(c.id_b) || c.id_a < c.id_b);
        EXPECT_LT(c.separation_m, ContactLimits{}.margin_m);
        const bool same_pair =
            i > 0 && contacts[i - 1].id_a == c.id_a && contacts[i - 1].id_b == c.id_b;
        EXPECT_EQ(c.feature, same_pair ? contacts[i - 1].feature + 1 : 0U);
        if (i > 0 && !same_pair) {
            EXPECT_LT(std::pair(contacts[i - 1].id_a, contacts[i - 1].id_b),
                      std::pair(c.id_a, c.id_b));
        }
    }
}

TEST(CollisionWorld, BroadphaseMissesNoPair) {
    const Crowd crowd;
    CollisionWorld world(crowd.shapes);
    const auto proxies = crowd.frame(5);
    world.set_proxies(proxies);
    std::vector<ContactPoint> all;
    world.find_contacts({}, all);
    // Oracle: each pair in a world of its own.
    std::vector<ContactPoint> paired;
    CollisionWorld pair(crowd.shapes);
    std::vector<ContactPoint> contacts;
    for (const ColliderProxy& a : proxies) {
        for (const ColliderProxy& b : proxies) {
            if (a.id < b.id) {
                pair.set_proxies(std::array{a, b});
                pair.find_contacts({}, contacts);
                paired.insert(paired.end(), contacts.begin(), contacts.end());
            }
        }
    }
    std::sort(paired.begin(), paired.end(), [](const auto& a, const auto& b) {
        return std::tie(a.id_a, a.id_b, a.feature) < std::tie(b.id_a, b.id_b, b.feature);
    });
    EXPECT_EQ(hash_of(all), hash_of(paired));
}

TEST(CollisionWorld, IgnoredAndFixedPairsMakeNoContacts) {
    ShapeLibrary shapes;
    const ShapeId ball = shapes.add_sphere(0.1);
    CollisionWorld world(shapes);
    const std::vector<ColliderProxy> proxies = {
        resting(1, ball, at({0.0, 0.0, 0.0}), true), resting(2, ball, at({0.1, 0.0, 0.0}), true),
        resting(3, ball, at({0.0, 0.1, 0.0}), false), resting(4, ball, at({0.0, 0.1, 0.1}), false)};
    world.set_proxies(proxies);
    std::vector<ContactPoint> contacts;
    world.find_contacts({}, contacts);
    EXPECT_EQ(contacts.size(), 5U);  // six pairs but for 3 and 4, which are both fixed
    const std::array<IgnoredPair, 2> ignored = {IgnoredPair{1, 2}, IgnoredPair{1, 3}};
    world.set_ignored_pairs(ignored);
    world.find_contacts({}, contacts);
    EXPECT_EQ(contacts.size(), 3U);
    for (const ContactPoint& contact : contacts) {
        EXPECT_FALSE(contact.id_a == 1 && contact.id_b != 4);
    }
    world.set_ignored_pairs({});
    world.find_contacts({}, contacts);
    EXPECT_EQ(contacts.size(), 5U);
}

TEST(CollisionWorld, RefusesWhatBreaksItsContract) {
    ShapeLibrary shapes;
    const ShapeId ball = shapes.add_sphere(0.1);
    const ShapeId mesh = shapes.add_mesh(test::make_floor(1.0, 1));
    CollisionWorld world(shapes);
    using List = std::vector<ColliderProxy>;
    EXPECT_THROW(world.set_proxies(List{resting(2, ball, {}, true), resting(1, ball, {}, true)}),
                 PreconditionError);
    EXPECT_THROW(world.set_proxies(List{resting(1, ball, {}, true), resting(1, ball, {}, true)}),
                 PreconditionError);
    EXPECT_THROW(world.set_proxies(List{resting(0, ball, {}, true)}), PreconditionError);
    EXPECT_THROW(world.set_proxies(List{resting(1, ShapeId{9}, {}, true)}), PreconditionError);
    EXPECT_THROW(world.set_proxies(List{resting(1, mesh, {}, true)}), PreconditionError);
    std::vector<ContactPoint> contacts;
    EXPECT_THROW(world.find_contacts({0.0, 0.005}, contacts), PreconditionError);
    EXPECT_THROW(world.find_contacts({0.02, 0.0}, contacts), PreconditionError);
    EXPECT_NO_THROW(world.find_contacts({}, contacts));
}

TEST(CollisionWorld, LeavesOutWhatHasNoPlaceUntilItHasOneAgain) {
    ShapeLibrary shapes;
    const ShapeId ball = shapes.add_sphere(0.1);
    CollisionWorld world(shapes);
    std::vector<ColliderProxy> proxies = {resting(1, ball, {}, false),
                                          resting(2, ball, at({0.15, 0.0, 0.0}), true)};
    std::vector<ContactPoint> contacts;
    world.set_proxies(proxies);
    world.find_contacts({}, contacts);
    EXPECT_EQ(contacts.size(), 1U);
    const ColliderProxy good = proxies[1];
    proxies[1].to_ws.position.x() = std::numeric_limits<double>::quiet_NaN();
    world.set_proxies(proxies);
    world.find_contacts({}, contacts);
    EXPECT_TRUE(contacts.empty());
    EXPECT_EQ(world.closest_point({0.2, 0.0, 0.0}, 1.0)->id, 1U);
    proxies[1] = good;
    world.set_proxies(proxies);
    world.find_contacts({}, contacts);
    EXPECT_EQ(contacts.size(), 1U);
}

}  // namespace
}  // namespace handhold::collision_world_test
