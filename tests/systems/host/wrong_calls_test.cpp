// What the C interface says about wrong calls, and that they change nothing.
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <handhold/handhold.hpp>

#include "tests/random.hpp"
#include "tests/systems/host/host_scene.hpp"

namespace handhold::host_wrong_calls_test {
namespace {

using namespace test;

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

// What the library says about a call that has just been refused.
std::string said(hh_result result, hh_result expected) {
    EXPECT_EQ(result, expected) << hh_last_error();
    return result == HH_OK ? "" : hh_last_error();
}
bool has(std::string_view text, std::string_view part) {
    return text.find(part) != std::string_view::npos;
}

TEST(HostMessages, StructsOfAnotherSizeAreNamed) {
    HostScene scene;
    hh_world* const world = scene.world.get();
    hh_body body{};
    hh_player player{};
    const hh_body_def no_body{};
    const hh_player_def no_player{};
    const hh_match_def no_match{};
    hh_match_stats no_stats{};
    hh_match* match = nullptr;
    const auto expect_named = [](const std::string& text, std::string_view name, std::size_t size) {
        EXPECT_TRUE(text.starts_with("hh_" + std::string(name) + " of 0 bytes")) << text;
        EXPECT_TRUE(has(text, "hh_default_" + std::string(name) + ",")) << text;
        EXPECT_TRUE(has(text, "knows " + std::to_string(size) + " bytes")) << text;
    };
    expect_named(said(hh_body_add(world, &no_body, &body), HH_ERROR_VERSION), "body_def",
                 sizeof(hh_body_def));
    expect_named(said(hh_player_add(world, &no_player, &player), HH_ERROR_VERSION), "player_def",
                 sizeof(hh_player_def));
    expect_named(said(hh_match_create(world, &no_match, nullptr, &match), HH_ERROR_VERSION),
                 "match_def", sizeof(hh_match_def));
    hh_match_def def = hh_default_match_def();
    def.players = &scene.player;
    def.player_count = 1;
    ASSERT_EQ(hh_match_create(world, &def, nullptr, &match), HH_OK);
    expect_named(said(hh_match_get_stats(match, &no_stats), HH_ERROR_VERSION), "match_stats",
                 sizeof(hh_match_stats));
    hh_match_destroy(match);
    // Structs without a struct_size have no function that fills them.
    const hh_event* events = nullptr;
    std::size_t count = 0;
    const std::string text =
        said(hh_world_events_sized(world, &events, &count, 8), HH_ERROR_VERSION);
    EXPECT_TRUE(text.starts_with("hh_event of 8 bytes")) << text;
    EXPECT_FALSE(has(text, "hh_default")) << text;
}

TEST(HostMessages, TheWrongElementOfAnArrayIsNamed) {
    HostScene scene;
    std::array<hh_tracking_sample, 3> samples = {scene.sample(), scene.sample(), {}};
    hh_player_input input = hh::input(scene.player, {samples.data(), 3});
    const std::string text =
        said(hh_world_step(scene.world.get(), k_step_s, &input, 1), HH_ERROR_VERSION);
    EXPECT_TRUE(has(text, "element 2 of an array of hh_tracking_sample")) << text;
    EXPECT_TRUE(has(text, "hh_default_tracking_sample")) << text;
}

TEST(HostMessages, FunctionsAndNumbersAreNamed) {
    HostScene scene;
    hh_world* const world = scene.world.get();
    hh_shape shape{};
    EXPECT_TRUE(has(said(hh_shape_add_sphere(world, 1e-9, &shape), HH_ERROR_VALUE),
                    "add_sphere: radius outside of [1e-3, 1e4] m (value 1e-09)"));
    EXPECT_TRUE(has(said(hh_shape_add_capsule(world, 0.1, -1.5, &shape), HH_ERROR_VALUE),
                    "add_capsule: half_height_m outside of [1e-3, 1e4] m (value -1.5)"));
    EXPECT_TRUE(has(said(hh_shape_add_cylinder(world, 1e30, 1.0, &shape), HH_ERROR_VALUE),
                    "add_cylinder: radius outside of [1e-3, 1e4] m (value 1e+30)"));
    EXPECT_TRUE(has(said(hh_shape_add_hull(world, nullptr, 0, &shape), HH_ERROR_VALUE),
                    "no points: a hull needs 4"));
    EXPECT_TRUE(has(said(hh_shape_add_compound(world, nullptr, 0, &shape), HH_ERROR_VALUE),
                    "no parts: a compound has 1"));
    EXPECT_TRUE(has(said(hh_shape_add_hull(world, nullptr, 4, &shape), HH_ERROR_NULL), "points"));
    const double reach_m = -5.0;
    const std::string text =
        said(hh_world_set_tuning(world, "pull.reach_m", &reach_m, 1), HH_ERROR_VALUE);
    EXPECT_TRUE(text.starts_with("pull.reach_m must lie in [0, ") && text.ends_with(" -5")) << text;
}

TEST(HostMessages, TheWrongMeasureIsNamed) {
    HostScene scene;
    constexpr std::array k_fields = {&hh_measures::eye_height_m, &hh_measures::shoulder_width_m,
                                     &hh_measures::upper_arm_m, &hh_measures::forearm_m};
    constexpr std::array k_names = {"eye_height_m", "shoulder_width_m", "upper_arm_m", "forearm_m"};
    hh_player_def giant = hh::player_def();
    giant.scale = 2.0;
    const hh::Player large = *scene.world.add(giant);
    for (std::size_t i = 0; i < k_fields.size(); ++i) {
        for (const double wrong : {160.0, 0.0, k_nan}) {
            hh_player_def def = hh::player_def();
            def.measures.*k_fields[i] = wrong;
            hh_player player{};
            const std::string name = std::string("measures.") + k_names[i] + " is ";
            const std::string text =
                said(hh_player_add(scene.world.get(), &def, &player), HH_ERROR_VALUE);
            EXPECT_TRUE(text.starts_with(name)) << text;
            EXPECT_FALSE(has(text, "scale")) << text;
            const std::string of_large = said(
                hh_player_set_measures(scene.world.get(), large, &def.measures), HH_ERROR_VALUE);
            EXPECT_TRUE(of_large.starts_with(name) && has(of_large, "scale, 2")) << of_large;
        }
    }
}

TEST(HostMessages, SkeletonsOfArraysNameTheFieldOfTheArray) {
    HostScene scene;
    const hh_skeleton_joint head{"head", -1, 0, {{0.0, 1.6, 0.0}, {0.0, 0.0, 0.0, 1.0}}};
    const std::string text =
        said(hh_player_set_body_skeleton(scene.world.get(), scene.player, &head, 1, HH_SPACE_WORLD),
             HH_ERROR_DATA);
    EXPECT_TRUE(has(text, "hh_skeleton_joint.is can name")) << text;
    EXPECT_FALSE(has(text, "map")) << text;
}

// The arrays have one element: a call that read a second one would crash or find rubbish.
TEST(HostMessages, CountsBeyondWhatIsThereAreRefusedUnread) {
    HostScene scene;
    hh_world* const world = scene.world.get();
    const hh::Body wall = scene.add_wall();
    const hh::Sample sample = scene.sample();
    const hh_player_input input = hh::input(scene.player, {&sample, 1});
    const hh_body_motion motion{wall, *scene.world.pose(wall), {}, {}};
    const hh_solved_player solved{scene.player, {}, {}};
    for (const std::size_t count :
         {std::size_t{2}, std::size_t{1} << 40U, std::numeric_limits<std::size_t>::max()}) {
        const std::string number = std::to_string(count);
        for (const auto step : {&hh_world_step, &hh_world_step_simulated, &hh_world_step_pose_only,
                                &hh_world_step_hands, &hh_world_begin_step}) {
            const std::string text = said(step(world, k_step_s, &input, count), HH_ERROR_VALUE);
            EXPECT_EQ(text, number + " inputs are more than the world's players (1)");
        }
        EXPECT_EQ(said(hh_world_place_bodies(world, &motion, count), HH_ERROR_VALUE),
                  number + " motions are more than the world's bodies (1)");
        ASSERT_EQ(hh_world_begin_step(world, k_step_s, &input, 1), HH_OK);
        EXPECT_EQ(said(hh_world_end_step(world, &solved, count), HH_ERROR_VALUE),
                  number + " solved players are more than the world's players (1)");
        ASSERT_EQ(hh_world_end_step(world, &solved, 1), HH_OK);
    }
    EXPECT_EQ(scene.world.time_s(), 3.0 * k_step_s);
}

// Ways in which one element of a list may be wrong.
enum class Wrong : std::uint8_t { no, twice, stale, not_a_number };

// Chooses one of `count`.
std::size_t one_of(Random& random, std::size_t count) {
    return static_cast<std::size_t>(random.between(0.0, static_cast<double>(count)));
}

// Some of the elements in any order. Two of three lists have one wrong element, which replaces
// another.
template <typename Element, typename Spoil>
Wrong make_list(Random& random, std::vector<Element>& list, const Spoil& spoil) {
    for (std::size_t i = list.size(); i > 1; --i) {
        std::swap(list[i - 1], list[one_of(random, i)]);
    }
    list.resize(1 + one_of(random, list.size()));
    const std::array kinds = {
        Wrong::no,    Wrong::not_a_number, list.size() > 1 ? Wrong::twice : Wrong::no,
        Wrong::stale, Wrong::no,           Wrong::not_a_number};
    const Wrong wrong = kinds[one_of(random, kinds.size())];
    const std::size_t at = one_of(random, list.size());
    if (wrong == Wrong::twice) {
        list[at] = list[(at + 1) % list.size()];
    } else if (wrong != Wrong::no) {
        spoil(list[at], wrong);
    }
    return wrong;
}

TEST(HostMessages, RandomWrongListsAreRefusedAsAWhole) {
    constexpr std::size_t k_count = 5;
    std::array<int, 4> refused{};  // by Wrong; [0]: lists that are right
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        Random random(seed);
        hh::World world;
        std::vector<hh_body_motion> motions;
        std::vector<hh_solved_player> solved;
        for (std::size_t i = 0; i < k_count; ++i) {
            const double x = 3.0 * static_cast<double>(i);
            const hh::Body body = *world.add(crate(world, {x, 5.0, 0.0}));
            motions.push_back({body, hh::pose_at({x, 6.0, 0.0}), {0.0, 1.0, 0.0}, {}});
            hh_player_def def = hh::player_def();
            def.origin.position.x = x;
            solved.push_back({*world.add(def), {x, 0.5, 0.0}, {}});
        }
        const hh::Body gone = *world.add(crate(world, {0.0, 9.0, 0.0}));
        const hh::Player left = *world.add(hh::player_def());
        ASSERT_EQ(hh_body_remove(world.get(), gone), HH_OK);
        ASSERT_EQ(hh_player_remove(world.get(), left), HH_OK);
        const Wrong of_motions =
            make_list(random, motions, [&](hh_body_motion& motion, Wrong wrong) {
                wrong == Wrong::stale ? void(motion.body = gone)
                                      : void(motion.angular_velocity_radps.z = k_nan);
            });
        const Wrong of_solved =
            make_list(random, solved, [&](hh_solved_player& player, Wrong wrong) {
                wrong == Wrong::stale ? void(player.player = left) : void(player.origin.y = k_nan);
            });
        const auto expect = [&](hh_result result, Wrong wrong, std::uint64_t before) {
            ++refused[static_cast<std::size_t>(wrong)];
            EXPECT_EQ(result, wrong == Wrong::no      ? HH_OK
                              : wrong == Wrong::stale ? HH_ERROR_HANDLE
                                                      : HH_ERROR_VALUE)
                << "seed " << seed << ": " << hh_last_error();
            EXPECT_EQ(world.hash() == before, wrong != Wrong::no) << "seed " << seed;
            EXPECT_EQ(has(hh_last_error(), "there twice"), wrong == Wrong::twice)
                << "seed " << seed << ": " << hh_last_error();
        };
        (void)hh_world_create(nullptr, nullptr);  // another last error
        std::uint64_t before = world.hash();
        expect(hh_world_place_bodies(world.get(), motions.data(), motions.size()), of_motions,
               before);
        ASSERT_EQ(hh_world_begin_step(world.get(), k_step_s, nullptr, 0), HH_OK);
        (void)hh_world_create(nullptr, nullptr);
        before = world.hash();
        expect(hh_world_end_step(world.get(), solved.data(), solved.size()), of_solved, before);
    }
    for (const int times : refused) {
        EXPECT_GT(times, 50);
    }
}

}  // namespace
}  // namespace handhold::host_wrong_calls_test
