// Contacts of a world with a warm pair cache must equal, bit for bit, those of a new world.
#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/collision/scene.hpp"

namespace handhold::test::collision_pair_cache_test {
namespace {

bool same(const ContactPoint& x, const ContactPoint& y) {
    return x.id_a == y.id_a && x.id_b == y.id_b && x.point_a_bs == y.point_a_bs &&
           x.point_b_bs == y.point_b_bs && x.normal_b_bs == y.normal_b_bs &&
           x.separation_m == y.separation_m && x.feature == y.feature;
}

using Contacts = std::vector<ContactPoint>;

bool all_same(const Contacts& found, const Contacts& expected) {
    return std::ranges::equal(found, expected, same);
}

Contacts contacts_with(CollisionWorld& world, const std::vector<ColliderProxy>& proxies,
                       const ContactLimits& limits, const std::vector<IgnoredPair>& ignored = {}) {
    Contacts contacts;
    world.set_proxies(proxies);
    world.set_ignored_pairs(ignored);
    world.find_contacts(limits, contacts);
    return contacts;
}

TEST(PairCache, ContactsEqualThoseOfANewWorld) {
    Random random(11);
    ShapeLibrary shapes;
    const ShapeId ball = shapes.add_sphere(0.12);
    const ShapeId box = shapes.add_box(Vec3(0.15, 0.1, 0.2));
    const ShapeId floor = shapes.add_mesh(make_floor(4.0, 12));
    std::vector<ColliderProxy> proxies;
    proxies.push_back(resting(1, floor, at(Vec3::Zero()), false));
    for (std::uint64_t id = 2; id < 30; ++id) {
        const Vec3 place = random.vector(0.8);
        const Quat turn = random.rotation();
        proxies.push_back(resting(id, id % 2 == 0 ? ball : box, at(place, turn), id % 5 != 0));
    }
    CollisionWorld warm(shapes);
    std::size_t contact_count = 0;
    for (int round = 0; round < 150; ++round) {
        // Some bodies move, some appear or disappear, some stay. In some rounds only the limits or
        // ignored pairs change.
        const bool still = round % 7 == 3;
        std::vector<ColliderProxy> present;
        for (ColliderProxy& proxy : proxies) {
            if (!still && proxy.id > 1 && random.between(0.0, 1.0) < 0.2) {
                proxy.from_ws = proxy.to_ws;
                proxy.to_ws.position += random.vector(0.1);
                if (random.between(0.0, 1.0) < 0.5) {
                    proxy.to_ws.rotation = random.rotation();
                    proxy.from_ws = proxy.to_ws;
                }
            }
            if (random.between(0.0, 1.0) < 0.95) {
                present.push_back(proxy);
            }
        }
        const ContactLimits limits = {round % 11 == 5 ? 0.05 : 0.02, 0.005};
        std::vector<IgnoredPair> ignored;
        if (round % 3 == 0) {
            ignored = {{2, 3}, {4, 9}};
        }
        const Contacts contacts = contacts_with(warm, present, limits, ignored);
        CollisionWorld fresh(shapes);
        ASSERT_TRUE(all_same(contacts, contacts_with(fresh, present, limits, ignored))) << round;
        contact_count += contacts.size();
    }
    EXPECT_GT(contact_count, 1000U);
}

// A floor and a ceiling, rotated, and bodies drifting and tumbling between them. For many rounds
// nothing is near, then the ceiling comes down on all of them.
TEST(PairCache, DropsAClearRegionOnceABodyEntersIt) {
    Random random(12);
    ShapeLibrary shapes;
    const ShapeId box = shapes.add_box(Vec3(0.15, 0.1, 0.2));
    const ShapeId floor = shapes.add_mesh(make_floor(4.0, 12));
    const Quat turn = rotation_from_vector(Vec3(0.3, -0.5, 0.2));
    const Vec3 up = turn * Vec3::UnitY();
    std::vector<ColliderProxy> proxies = {resting(1, floor, at(Vec3::Zero(), turn), false),
                                          resting(2, floor, at(1.6 * up, turn), false)};
    std::vector<Vec3> velocities;
    for (std::uint64_t id = 3; id < 13; ++id) {
        const Vec3 place = turn * Vec3{random.between(-1.5, 1.5), 0.8, random.between(-1.5, 1.5)};
        proxies.push_back(resting(id, box, at(place, random.rotation()), true));
        velocities.push_back(random.vector(0.0015));
    }
    CollisionWorld warm(shapes);
    std::size_t rounds_without_contact = 0;
    std::size_t contact_count = 0;
    for (int round = 0; round < 400; ++round) {
        for (std::size_t i = 2; i < proxies.size(); ++i) {
            ColliderProxy& proxy = proxies[i];
            proxy.from_ws = proxy.to_ws;
            proxy.to_ws.position += velocities[i - 2];
            proxy.to_ws.rotation =
                rotation_from_vector(3.0 * velocities[i - 2]) * proxy.to_ws.rotation;
        }
        ColliderProxy& ceiling = proxies[1];
        ceiling.from_ws = ceiling.to_ws;
        if (round >= 250 && round % 5 == 0) {
            ceiling.to_ws.position -= 0.08 * up;
            ceiling.from_ws = ceiling.to_ws;  // teleported: no sweep
        }
        const Contacts contacts = contacts_with(warm, proxies, {});
        CollisionWorld fresh(shapes);
        ASSERT_TRUE(all_same(contacts, contacts_with(fresh, proxies, {}))) << round;
        const auto with_walls = std::ranges::count_if(
            contacts, [](const ContactPoint& contact) { return contact.id_b <= 2; });
        rounds_without_contact += with_walls == 0 ? 1U : 0U;
        contact_count += static_cast<std::size_t>(with_walls);
    }
    EXPECT_GT(rounds_without_contact, 20U);
    EXPECT_GT(contact_count, 200U);
}

// More moving bodies than are compared one by one, and every change a proxy can undergo: free flags
// and shapes change, poses become invalid and valid again, bodies appear and disappear.
TEST(PairCache, ContactsEqualThoseOfANewWorldWhenManyBodiesChange) {
    Random random(13);
    ShapeLibrary shapes;
    const std::array shape = {shapes.add_sphere(0.1), shapes.add_box(Vec3(0.15, 0.1, 0.2))};
    const ShapeId floor = shapes.add_mesh(make_floor(16.0, 24));
    std::vector<ColliderProxy> proxies = {resting(1, floor, at(Vec3::Zero()), false)};
    std::vector<Vec3> places;
    for (std::uint64_t id = 2; id < 202; ++id) {
        const auto column = static_cast<double>((id - 2) % 15);
        const auto row = static_cast<double>((id - 2) / 15);
        places.emplace_back(column - 7.0, random.between(0.0, 1.2), row - 7.0);
        proxies.push_back(resting(id, shape[id % 2], at(places.back()), true));
    }
    CollisionWorld warm(shapes);
    std::size_t contact_count = 0;
    for (int round = 0; round < 60; ++round) {
        std::vector<ColliderProxy> present = {proxies.front()};
        for (std::size_t i = 1; i < proxies.size(); ++i) {
            ColliderProxy& proxy = proxies[i];
            const double what = random.between(0.0, 1.0);
            proxy.from_ws = proxy.to_ws;
            if (what < 0.01) {
                proxy.free = !proxy.free;
            } else if (what < 0.02) {
                proxy.shape = shape[proxy.shape == shape[0] ? 1 : 0];
            } else if (what < 0.03) {
                proxy.to_ws.position.setConstant(std::numeric_limits<double>::quiet_NaN());
            } else if (what < 0.95) {
                proxy.to_ws.position = places[i - 1] += random.vector(0.01);
            }
            if (!is_valid(proxy.from_ws)) {
                proxy.from_ws = proxy.to_ws;
            }
            if (what < 0.98) {
                present.push_back(proxy);
            }
        }
        const Contacts contacts = contacts_with(warm, present, {});
        CollisionWorld fresh(shapes);
        ASSERT_TRUE(all_same(contacts, contacts_with(fresh, present, {}))) << round;
        contact_count += contacts.size();
    }
    EXPECT_GT(contact_count, 1000U);
}

}  // namespace
}  // namespace handhold::test::collision_pair_cache_test
