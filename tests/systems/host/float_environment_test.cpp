// Calls of the C interface compute the same in every floating-point environment of the host, and
// leave it as it was.
#include <algorithm>
#include <array>
#include <thread>

#include <gtest/gtest.h>
#include <handhold/handhold.h>
#include <rapidcheck/gtest.h>

#include "engine/core/parallel.hpp"

#ifdef __SSE2__
#include <xmmintrin.h>

namespace handhold::host_float_environment_test {
namespace {

constexpr unsigned k_usual = 0x1f80;

// Masks, rounding and denormals at random; sticky flags that are not trapped.
unsigned any_environment() {
    const auto masks = static_cast<unsigned>(*rc::gen::inRange(0, 64));
    const auto rounding = static_cast<unsigned>(*rc::gen::inRange(0, 4));
    const unsigned flush = *rc::gen::element(0U, 0x8000U, 0x40U, 0x8040U);
    const auto flags = static_cast<unsigned>(*rc::gen::inRange(0, 64)) & masks;
    // Inexact results are in everything that the test itself computes.
    return ((masks | 0x20U) << 7U) | (rounding << 13U) | flush | flags;
}

struct Played {
    std::uint64_t hash = 0;
    unsigned left = 0;
};

// Every input is a constant or exact in binary, so that the host computes it alike in every
// environment.
Played play_in(unsigned environment) {
    Played played;
    _mm_setcsr(environment);
    hh_world* world = nullptr;
    hh_result result = hh_world_create(nullptr, &world);
    hh_shape box{};
    hh_body_def def = hh_default_body_def();
    hh_body body{};
    hh_player_def player_def = hh_default_player_def();
    hh_player player{};
    const auto also = [&](hh_result next) { result = result == HH_OK ? next : result; };
    also(hh_world_set_gravity(world, {0.0, -9.81, 0.0}));
    also(hh_shape_add_box(world, {2.0, 2.0, 0.1}, &box));
    def.shape = box;
    def.name = "wall";
    def.pose.position = {0.0, 1.5, -0.6};
    also(hh_body_add(world, &def, &body));
    also(hh_shape_add_box(world, {0.1, 0.1, 0.1}, &def.shape));
    for (const char* const name : {"a", "b", "c"}) {
        def.kind = HH_DYNAMIC;
        def.name = name;
        def.pose.position = {0.3, name[0] == 'a' ? 0.5 : name[0] == 'b' ? 0.71 : 0.92, -0.25};
        also(hh_body_add(world, &def, &body));
    }
    player_def.name = "player";
    also(hh_player_add(world, &player_def, &player));
    const hh_pose identity = hh_identity_pose();
    also(hh_player_set_hand_in_controller(world, player, HH_LEFT, &identity));
    also(hh_player_set_hand_in_controller(world, player, HH_RIGHT, &identity));
    double time_s = 0.0;
    for (int frame = 0; frame < 40; ++frame) {
        hh_tracking_sample sample = hh_default_tracking_sample();
        time_s = 0.0078125 * (frame + 1);  // exact in binary: equal in every rounding
        sample.time_s = time_s;
        sample.head.position = {0.0, 1.6, 0.0};
        sample.hands[0].position = {-0.2, 1.2, -0.3};
        sample.hands[1] = {{0.2, frame < 20 ? 1.4 : 1.39, -0.43},
                           {0.7071067811865476, 0.0, 0.0, 0.7071067811865476}};
        sample.grab[1] = frame > 10 ? 1 : 0;
        hh_player_input input = hh_default_player_input();
        input.player = player;
        input.samples = &sample;
        input.sample_count = 1;
        also(hh_world_step(world, 0.0078125, &input, 1));
    }
    hh_player_pose pose{};
    also(hh_world_player_poses(world, &player, 1, &pose));
    also(hh_world_hash(world, &played.hash));
    hh_world_destroy(world);
    played.left = _mm_getcsr();
    _mm_setcsr(k_usual);
    EXPECT_EQ(result, HH_OK) << hh_last_error();
    EXPECT_EQ(pose.hands[1].grip, HH_GRIP_SURFACE);
    return played;
}

RC_GTEST_PROP(HostFloatEnvironment, HashesDoNotDependOnItAndItStaysAsItWas, ()) {
    const unsigned environment = any_environment();
    const Played usual = play_in(k_usual);
    const Played other = play_in(environment);
    RC_ASSERT(other.hash == usual.hash);
    // The host's own arithmetic here may raise the flag of inexact results, never another one.
    RC_ASSERT((other.left & ~0x20U) == (environment & ~0x20U));
}

// Threads of a host's job system, of the library's pool, and the caller's.
TEST(HostFloatEnvironment, TasksComputeInTheLibrarysOnEveryThread) {
    constexpr unsigned k_hosts = (1U << 12U) | 0x6000U | 0x8040U;  // traps, rounds, flushes
    const auto count_wrong = [] {
        std::array<unsigned, 8> seen{};
        auto look = [&](std::size_t i) { seen.at(i) = _mm_getcsr() & ~0x3fU; };
        _mm_setcsr(k_hosts);
        parallel_for(seen.size(), look);
        const bool is_kept = _mm_getcsr() == k_hosts;
        _mm_setcsr(k_usual);
        return std::ranges::count_if(seen, [](unsigned csr) { return csr != k_usual; }) +
               (is_kept ? 0 : 100);
    };
    set_thread_count(3);
    EXPECT_EQ(count_wrong(), 0);
    set_thread_count(1);
    set_parallel_backend(
        [](void*, std::size_t count, IndexedTask task, void* of_task) {
            std::thread worker([&] {
                _mm_setcsr(k_hosts);
                for (std::size_t i = 0; i < count; ++i) {
                    task(of_task, i);
                }
            });
            worker.join();
        },
        nullptr);
    EXPECT_EQ(count_wrong(), 0);
    set_parallel_backend(nullptr, nullptr);
}

}  // namespace
}  // namespace handhold::host_float_environment_test
#endif
