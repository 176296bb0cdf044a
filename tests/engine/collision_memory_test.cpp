// A world that remembers pairs against new worlds that cannot: the same contacts, bit for bit.
#include <gtest/gtest.h>

#include "tests/engine/collision_scene.hpp"

namespace handhold::test::collision_memory_test {
namespace {

bool same(const ContactPoint& x, const ContactPoint& y) {
    return x.id_a == y.id_a && x.id_b == y.id_b && x.point_a_bs == y.point_a_bs &&
           x.point_b_bs == y.point_b_bs && x.normal_b_bs == y.normal_b_bs &&
           x.separation_m == y.separation_m && x.feature == y.feature;
}

TEST(PairMemory, GivesBackWhatANewWorldFinds) {
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
    CollisionWorld old(shapes);
    std::vector<ContactPoint> contacts;
    std::size_t met = 0;
    for (int round = 0; round < 150; ++round) {
        // Some move, some come and go, some stay; now and then nothing changes but the question.
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
        old.set_proxies(present);
        old.set_ignored_pairs(ignored);
        old.find_contacts(limits, contacts);
        CollisionWorld fresh(shapes);
        std::vector<ContactPoint> expected;
        fresh.set_proxies(present);
        fresh.set_ignored_pairs(ignored);
        fresh.find_contacts(limits, expected);
        ASSERT_EQ(contacts.size(), expected.size()) << round;
        for (std::size_t i = 0; i < contacts.size(); ++i) {
            ASSERT_TRUE(same(contacts[i], expected[i])) << round << ' ' << i;
        }
        met += contacts.size();
    }
    EXPECT_GT(met, 1000U);
}

}  // namespace
}  // namespace handhold::test::collision_memory_test
