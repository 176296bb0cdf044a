#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "systems/snapshot/snapshot.hpp"
#include "tests/systems/frame/crowd.hpp"

namespace handhold::world_diff_test {
namespace {

using test::Crowd;

TEST(WorldDiff, NamesColumnEntityAndField) {
    const Crowd a;
    Crowd b;
    const std::vector<std::string> names = {"crawler", "rock"};
    const WorldDiffSettings settings{20, names};
    const auto by_name = [&](const char* name) {
        return find_by_id(b.world, persistent_id_from_name(name));
    };
    EXPECT_TRUE(diff_worlds(a.world, b.world, settings).empty());
    b.world.head_tracking.at(by_name("crawler")).pose_ps.position.x() = 0.25;
    b.world.head_ignores.at(by_name("crawler")).bodies[2] = by_name("rock");
    b.world.player_commands.at(by_name("crawler")).snap_turns = -3;
    b.world.clock.frame = 4;
    b.world.reference_velocity_mps.z() = 1e-9;
    const std::vector<std::string> expected = {
        "clock.frame: a 0, b 4",
        "reference_velocity_mps.z: a 0, b 1e-09",
        "player_commands[crawler].snap_turns: a 0, b -3",
        "head_tracking[crawler].pose_ps.position.x: a 0, b 0.25",
        "head_ignores[crawler].bodies[2]: a none, b rock",
    };
    EXPECT_EQ(diff_worlds(a.world, b.world, settings), expected);
    EXPECT_EQ(diff_worlds(a.world, b.world, {2, names}).size(), 2U);
}

TEST(WorldDiff, ListsEntitiesThatOnlyOneWorldHas) {
    const Crowd a;
    Crowd b;
    const Entity rotor = find_by_id(b.world, persistent_id_from_name("rotor"));
    b.world.mover.remove(rotor);
    const std::vector<std::string> names = {"rotor"};
    EXPECT_EQ(diff_worlds(a.world, b.world, {20, names}),
              std::vector<std::string>{"mover[rotor]: only in a"});
    EXPECT_EQ(diff_worlds(b.world, a.world, {20, names}),
              std::vector<std::string>{"mover[rotor]: only in b"});
    const std::string unnamed = diff_worlds(a.world, b.world).at(0);
    EXPECT_EQ(unnamed.substr(0, 8), "mover[0x") << unnamed;
}

TEST(WorldDiff, IgnoresSlotsAndElementOrder) {
    Crowd a;
    Crowd b(3);
    EXPECT_TRUE(diff_worlds(a.world, b.world).empty());
    a.run(30);
    b.run(30);
    EXPECT_TRUE(diff_worlds(a.world, b.world).empty());
}

}  // namespace
}  // namespace handhold::world_diff_test
