#include <array>
#include <thread>

#include <gtest/gtest.h>

#include "engine/core/parallel.hpp"
#include "tests/engine/collision/scene.hpp"

// Four threads ask one world at the same time; preset tsan runs what is called Threaded.
namespace handhold::collision_threaded_test {
namespace {

using test::at;
using test::Random;
using test::resting;

struct Crowd {
    ShapeLibrary shapes;
    std::vector<ColliderProxy> proxies;
};

// A wavy room with things of every kind in it.
Crowd make_crowd() {
    Crowd crowd;
    ShapeLibrary& shapes = crowd.shapes;
    const auto room = test::make_wavy_ball(1.2, 24, 40);
    Random random(111);
    std::vector<Vec3> points(30);
    for (Vec3& point : points) {
        point = random.vector(0.1);
    }
    const ShapeId ball = shapes.add_sphere(0.06);
    const std::vector<CompoundChild> pair = {{ball, at({-0.1, 0.0, 0.0}), 0},
                                             {ball, at({0.1, 0.0, 0.0}), 0}};
    const std::array<ShapeId, 6> kinds = {shapes.add_box({0.1, 0.05, 0.2}),
                                          ball,
                                          shapes.add_capsule(0.06, 0.15),
                                          shapes.add_cylinder(0.06, 0.1),
                                          shapes.add_centred(shapes.add_hull(points)).shape,
                                          shapes.add_compound(pair)};
    crowd.proxies.push_back(resting(1, shapes.add_mesh(room), {}, false));
    crowd.proxies.push_back(
        resting(2, shapes.add_mesh(room, Vec3(0.1, 0.2, 0.1)), at({0.3, 0.2, 0.1}), false));
    for (std::uint64_t id = 3; id < 60; ++id) {
        const Vec3 place = random.vector(0.8);
        crowd.proxies.push_back(resting(id, kinds[id % 6], at(place, random.rotation()), true));
    }
    return crowd;
}

// The answers to one row of questions, as numbers.
std::vector<double> ask(const CollisionWorld& world, std::uint64_t seed) {
    Random random(seed);
    std::vector<double> answers;
    for (int i = 0; i < 300; ++i) {
        const Vec3 from = random.vector(1.0);
        const Vec3 to = random.vector(2.0);
        const auto ray = world.cast_ray(from, to);
        answers.push_back(ray ? ray->distance_m : -1.0);
        const auto sphere = world.cast_sphere(0.01 + 0.0001 * i, from, to);
        answers.push_back(sphere ? sphere->distance_m : -1.0);
        const auto near = world.closest_point(to, 2.0);
        answers.push_back(near ? near->distance_m : -1.0);
    }
    return answers;
}

TEST(CollisionThreaded, QueriesFromFourThreadsAnswerAsFromOne) {
    const Crowd crowd = make_crowd();
    CollisionWorld world(crowd.shapes);
    world.set_proxies(crowd.proxies);
    std::array<std::vector<double>, 4> expected;
    std::array<std::vector<double>, 4> found;
    for (std::size_t i = 0; i < 4; ++i) {
        expected[i] = ask(world, i);
    }
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < 4; ++i) {
        threads.emplace_back([&, i] { found[i] = ask(world, i); });
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(found[i], expected[i]);
        EXPECT_NE(std::count(found[i].begin(), found[i].end(), -1.0), 900);  // something was hit
    }
}

TEST(CollisionThreaded, ContactsDoNotDependOnTheNumberOfThreads) {
    const Crowd crowd = make_crowd();
    CollisionWorld world(crowd.shapes);
    std::vector<ColliderProxy> proxies = crowd.proxies;
    const auto contacts_with = [&](int threads) {
        const int before = thread_count();
        set_thread_count(threads);
        std::vector<ContactPoint> contacts;
        world.find_contacts({}, contacts);
        set_thread_count(before);
        return contacts;
    };
    Random random(112);
    std::size_t most = 0;
    for (int round = 0; round < 5; ++round) {
        for (ColliderProxy& proxy : proxies) {
            proxy.to_ws.position += random.vector(0.05);
        }
        world.set_proxies(proxies);
        const auto expected = contacts_with(1);
        most = std::max(most, expected.size());
        for (const int threads : {2, 4, 7}) {
            const auto found = contacts_with(threads);
            ASSERT_EQ(found.size(), expected.size());
            for (std::size_t i = 0; i < found.size(); ++i) {
                ASSERT_EQ(found[i].id_a, expected[i].id_a);
                ASSERT_EQ(found[i].id_b, expected[i].id_b);
                ASSERT_EQ(found[i].feature, expected[i].feature);
                ASSERT_EQ(found[i].separation_m, expected[i].separation_m);
                ASSERT_EQ(found[i].point_a_bs, expected[i].point_a_bs);
                ASSERT_EQ(found[i].point_b_bs, expected[i].point_b_bs);
                ASSERT_EQ(found[i].normal_b_bs, expected[i].normal_b_bs);
            }
        }
    }
    EXPECT_GT(most, 50U);
}

}  // namespace
}  // namespace handhold::collision_threaded_test
