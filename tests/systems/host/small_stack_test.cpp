// Every kind of call runs on a thread with the stack that handhold/base.h promises.
#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>
#include <handhold/handhold.hpp>

#include "tests/systems/host/host_scene.hpp"
#include "tests/systems/host/match_table.hpp"

// Frames of unoptimised code are larger.
#if defined(__linux__) && defined(__OPTIMIZE__)
#include <pthread.h>

namespace handhold::host_small_stack_test {
namespace {

using namespace test;

constexpr std::size_t k_stack_bytes = std::size_t{112} * 1024;

std::vector<hh::Shape> every_shape(hh::World& world) {
    std::vector<hh::Vec3> points;
    for (int i = 0; i < 64; ++i) {
        const double turn = 2.4 * i;
        const double height = -0.98 + 0.03 * i;
        const double radius = 0.15 * std::sqrt(1.0 - height * height);
        points.push_back({radius * std::cos(turn), 0.15 * height, radius * std::sin(turn)});
    }
    std::vector<hh::Shape> shapes = {*world.add_box({0.2, 0.2, 0.1}), *world.add_sphere(0.12),
                                     *world.add_capsule(0.05, 0.2), *world.add_cylinder(0.05, 0.2),
                                     *world.add_hull(points)};
    std::vector<hh_compound_part> parts;
    for (std::size_t i = 0; i < 3; ++i) {
        parts.push_back({shapes[i], hh::pose_at({0.2 * static_cast<double>(i), 0.0, 0.0}), 0.0});
    }
    shapes.push_back(*world.add_compound(parts));
    return shapes;
}

// Both hands close on a body of the shape, pull it against a crate and let go.
void play(const hh::Shape& shape, HostScene& scene, bool is_held) {
    hh_body_def def = hh::body_def();
    def.kind = is_held ? HH_DYNAMIC : HH_STATIC;
    def.mass_kg = 3.0;
    def.shape = shape;
    def.pose.position = {0.0, 1.4, -0.6};
    const hh::Body body = *scene.world.add(def);
    scene.hand_at = {hh::Vec3{-0.05, 1.4, -0.4}, hh::Vec3{0.05, 1.4, -0.4}};
    scene.closed = {};
    scene.step(5);
    scene.closed = {true, true};
    for (int i = 0; i < 25; ++i) {
        scene.hand_at[0].x -= 0.004;
        scene.hand_at[1].z += 0.002;
        scene.step();
    }
    scene.closed = {};
    scene.step(3);
    std::vector<std::byte> bytes;
    scene.is_good = scene.is_good && scene.world.save(bytes) && scene.world.restore(bytes) &&
                    scene.world.remove(body);
}

void* play_everything(void* is_good) {
    HostScene scene;
    (void)scene.world.add(crate(scene.world, {-0.4, 1.4, -0.5}));
    for (const hh::Shape& shape : every_shape(scene.world)) {
        for (const bool is_held : {false, true}) {
            play(shape, scene, is_held);
        }
    }
    *static_cast<bool*>(is_good) = scene.is_good;
    return nullptr;
}

// A server and two clients play, one joins again, and a sync test steps.
void* play_match(void* is_good) {
    lab::NetworkTraits traits;
    traits.delay_s = 0.03;
    TableMatch table(traits, 71);
    table.play(1.5);
    table.join(1, 0.05);
    table.play(0.5);
    TableMachine alone(HH_MATCH_SYNC_TEST);
    bool is_equal = true;
    for (int i = 0; i < 30; ++i) {
        const hh::Sample sample = table_sample(0, alone.scene.world.time_s() + k_step_s);
        std::array<hh_match_input, k_seats> inputs;
        inputs.fill(hh::match_input({&sample, 1}, 0));
        const hh::Maybe<hh_match_difference> found = alone.match.sync_test(inputs);
        is_equal = is_equal && found && found->tick == 0;
    }
    *static_cast<bool*>(is_good) = is_equal && table.compared > 90 &&
                                   table.server.game.state.score > 0 &&
                                   table.clients[0]->match.stats().rollbacks > 0;
    return nullptr;
}

void expect_good_in_112_kib(void* (*play)(void*)) {
    bool is_good = false;
    pthread_attr_t attributes;
    ASSERT_EQ(pthread_attr_init(&attributes), 0);
    ASSERT_EQ(pthread_attr_setstacksize(&attributes, k_stack_bytes), 0);
    pthread_t thread{};
    ASSERT_EQ(pthread_create(&thread, &attributes, play, &is_good), 0);
    pthread_join(thread, nullptr);
    pthread_attr_destroy(&attributes);
    EXPECT_TRUE(is_good);
}

TEST(HostSmallStack, EveryShapeIsMadeGrippedAndHeldIn112KiB) {
    expect_good_in_112_kib(&play_everything);
}

TEST(HostSmallStack, MatchesArePlayedAndJoinedIn112KiB) { expect_good_in_112_kib(&play_match); }

}  // namespace
}  // namespace handhold::host_small_stack_test
#endif
