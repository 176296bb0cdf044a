// A warm frame allocates nothing, neither by malloc nor by Bullet's allocator.
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/collision/collision_world.hpp"
#include "engine/solver/packed/triad_kernels.hpp"
#include "systems/snapshot/simulated_state.hpp"
#include "tests/engine/allocation_count.hpp"
#include "tests/systems/frame/scenario.hpp"

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define HH_SANITIZED 1
#endif
#endif

#ifndef HH_SANITIZED
namespace {
std::atomic<std::uint64_t> allocations{0};
}

// These replace the C library's: all allocations of this program pass through here.
extern "C" {
void* __libc_malloc(std::size_t);               // NOLINT(bugprone-reserved-identifier)
void* __libc_calloc(std::size_t, std::size_t);  // NOLINT(bugprone-reserved-identifier)
void* __libc_realloc(void*, std::size_t);       // NOLINT(bugprone-reserved-identifier)
// NOLINTNEXTLINE(bugprone-reserved-identifier)
void* __libc_memalign(std::size_t, std::size_t);
void* malloc(std::size_t size) {
    allocations.fetch_add(1, std::memory_order_relaxed);
    return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
    allocations.fetch_add(1, std::memory_order_relaxed);
    return __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) {
    allocations.fetch_add(1, std::memory_order_relaxed);
    return __libc_realloc(old, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
    allocations.fetch_add(1, std::memory_order_relaxed);
    return __libc_memalign(alignment, size);
}
}
#endif

namespace handhold::scenario_allocation_test {
namespace {

#ifndef HH_SANITIZED
std::uint64_t allocations_in_a_frame(Scenario& s) {
    s.prepare_step();
    const std::uint64_t before = allocations.load();
    s.take_step();
    return allocations.load() - before;
}
#endif

// A rope of 64 links, long enough for strands, and one with limits, each with a hand that grips and
// releases its end: islands of both kinds, whose structure changes (a limit near, a grip more). The
// first island of a new size may allocate.
TEST(WarmFrame, WithHeldRopesAllocatesNothing) {
#ifdef HH_SANITIZED
    GTEST_SKIP() << "the sanitizer has the allocator";
#else
    constexpr int k_links = 64;
    constexpr double k_link_m = 0.05;
    Scenario s;
    for (const std::size_t side : {0U, 1U}) {
        const double x = side == 0 ? -0.3 : 0.3;
        Entity last = k_no_entity;
        for (int i = 0; i < k_links; ++i) {
            const std::string name = (side == 0 ? "left" : "right") + std::to_string(i);
            const Vec3 center(x, 1.175, -k_link_m * (k_links - 1 - i));
            const Entity link = s.add_crate(name, 0.2, center, Vec3(0.02, 0.02, 0.5 * k_link_m));
            Joint joint;
            joint.kind = side == 0 || i % 8 != 0 ? JointKind::ball : JointKind::hinge;
            joint.limited = joint.kind == JointKind::hinge;
            joint.lower = -0.3;
            joint.upper = 0.3;
            joint.a = last;
            joint.b = link;
            const Pose frame{center - Vec3(0.0, 0.0, 0.5 * k_link_m), Quat::Identity()};
            add_joint(s.world, {name + "_joint", joint_at(s.world, joint, frame)});
            last = link;
        }
        const Vec3 palm_to_hand =
            Vec3(x > 0.0 ? 1.0 : -1.0, 1.0, 1.0).cwiseProduct(s.tuning.hand.palm_center_m);
        const Vec3 rest = Vec3(x, 1.2, 0.0) - palm_to_hand;
        s.script.hands[side] = [=](double t) {
            const double w = 0.05 * std::sin(3.0 * t);
            return Pose{rest + Vec3(w, 0.5 * w, -0.04 + 0.04 * std::cos(4.0 * t)),
                        Quat::Identity()};
        };
        s.script.grabs[side] = [](double t) { return std::fmod(t, 1.5) > 0.1; };
    }
    s.add_player_here();
    s.run(6.0);  // warm
    std::uint64_t held = 0;
    std::uint64_t in_frames = 0;
    for (int i = 0; i < 270; ++i) {
        in_frames += allocations_in_a_frame(s);
        const bool both = s.grab(HandSide::left).kind == GripKind::held &&
                          s.grab(HandSide::right).kind == GripKind::held;
        held += both ? 1U : 0U;
    }
    EXPECT_EQ(in_frames, 0U);
    EXPECT_GT(held, 60U);
#endif
}

TEST(WarmFrame, AllocatesNothing) {
#ifdef HH_SANITIZED
    GTEST_SKIP() << "the sanitizer has the allocator";
#else
    const std::uint64_t at_start = allocations.load();
    const auto* const probe = new std::uint64_t(at_start);  // the hook works
    ASSERT_GT(allocations.load(), at_start);
    delete probe;
    const std::uint64_t before_aligned = allocations.load();
    const std::vector<Bodies4> aligned(1);
    ASSERT_GT(allocations.load(), before_aligned);

    Scenario s;
    s.add_wall("floor", Vec3(2.0, 0.05, 2.0), Vec3(0.0, 1.0, 0.0));
    s.add_wall("wall", Vec3(2.0, 2.0, 0.05), Vec3(0.0, 1.0, -0.5));
    s.add_rock("rock", 5.0, Vec3(-0.3, 1.3, 0.0));
    for (int i = 0; i < 6; ++i) {
        s.add_rock("loose" + std::to_string(i), 2.0, Vec3(-0.9 + 0.15 * i, 1.14, 0.5));
    }
    s.add_player_here();
    const Vec3 right = hand_for_palm(s, Vec3(0.3, 1.06, 0.1));
    const Vec3 left = hand_for_palm(s, Vec3(-0.3, 1.385, 0.0));
    // Both hands release and grip continually; the left one knocks its rock against the wall.
    s.script.grabs[0] = [](double t) { return std::fmod(t, 1.5) > 0.1; };
    s.script.grabs[1] = [](double t) { return std::fmod(t, 0.7) > 0.1; };
    s.script.hands[1] = [=](double t) {
        return Pose{right + 0.05 * Vec3(std::sin(3 * t), 0.2 * std::sin(2 * t), std::sin(4 * t)),
                    Quat::Identity()};
    };
    s.script.hands[0] = [=](double t) {
        return Pose{left - Vec3(0.0, 0.0, 0.25 + 0.25 * std::sin(4.0 * t)), Quat::Identity()};
    };
    s.run(6.0);  // warm
    const std::uint64_t collision_before = collision_allocation_count();
    std::uint64_t in_frames = 0;
    std::uint64_t contacts = 0;
    for (int frame = 0; frame < 540; ++frame) {
        in_frames += allocations_in_a_frame(s);
        contacts += s.stats.contacts;
    }
    EXPECT_EQ(in_frames, 0U);
    EXPECT_EQ(collision_allocation_count(), collision_before);
    EXPECT_GT(contacts, 100U);
#endif
}

// Each frame goes back by up to 15 ticks and steps them again, only the last one shown, while a
// hand grips and lets go of a wall and a rock.
TEST(WarmFrame, WithRollbackAllocatesNothing) {
#ifdef HH_SANITIZED
    GTEST_SKIP() << "the sanitizer has the allocator";
#else
    constexpr std::uint64_t k_window = 16;
    Scenario s;
    s.add_wall("floor", Vec3(2.0, 0.05, 2.0), Vec3(0.0, 1.0, 0.0));
    s.add_rock("rock", 5.0, Vec3(-0.3, 1.3, 0.0));
    s.add_player_here();
    const Vec3 right = hand_for_palm(s, Vec3(0.3, 1.06, 0.1));
    const Vec3 left = hand_for_palm(s, Vec3(-0.3, 1.385, 0.0));
    s.script.grabs[0] = [](double t) { return std::fmod(t, 1.5) > 0.1; };
    s.script.grabs[1] = [](double t) { return std::fmod(t, 0.7) > 0.1; };
    s.script.hands[1] = [=](double t) {
        return Pose{right + 0.05 * Vec3(std::sin(3 * t), 0.2 * std::sin(2 * t), std::sin(4 * t)),
                    Quat::Identity()};
    };
    s.script.hands[0] = [=](double t) {
        return Pose{left - Vec3(0.0, 0.0, 0.25 + 0.25 * std::sin(4.0 * t)), Quat::Identity()};
    };
    std::vector<SimulatedState> states(k_window);
    std::uint64_t in_frames = 0;
    std::uint64_t in_copies = 0;
    std::uint64_t steps_again = 0;
    const auto play_frame = [&](std::uint64_t depth) {
        const std::uint64_t present = s.world.clock.frame;
        const std::uint64_t before = allocations.load();
        states[(present - depth) % k_window].restore(s.world);
        in_copies += allocations.load() - before;
        s.rewind_devices();
        while (s.world.clock.frame <= present) {
            s.frame = s.world.clock.frame == present ? &step_frame : &step_simulated;
            in_frames += allocations_in_a_frame(s);
            const std::uint64_t before_keep = allocations.load();
            states[s.world.clock.frame % k_window].keep(s.world);
            in_copies += allocations.load() - before_keep;
            ++steps_again;
        }
    };
    states[0].keep(s.world);
    for (int frame = 0; frame < 16; ++frame) {
        play_frame(0);
    }
    for (int frame = 0; frame < 1080; ++frame) {  // warm
        play_frame(static_cast<std::uint64_t>(frame % 15));
    }
    in_frames = in_copies = 0;
    steps_again = 0;
    std::uint64_t gripping = 0;
    for (int frame = 0; frame < 270; ++frame) {
        play_frame(static_cast<std::uint64_t>(frame % 15));
        gripping += s.grab(HandSide::right).kind == GripKind::surface ? 1U : 0U;
    }
    EXPECT_EQ(in_copies, 0U);
    EXPECT_EQ(in_frames, 0U);
    EXPECT_GT(steps_again, 2000U);
    EXPECT_GT(gripping, 100U);
#endif
}

}  // namespace
}  // namespace handhold::scenario_allocation_test
