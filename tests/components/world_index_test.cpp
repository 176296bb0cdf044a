// The indices behind find_by_id and destroy.
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "components/world.hpp"
#include "components/world_edit.hpp"
#include "tests/components/shapeless.hpp"
#include "tests/random.hpp"

namespace handhold::world_index_test {
namespace {

using test::Random;
using test::shapeless_rock;

TEST(WorldIndex, NamesAndJointsAreRightAfterAnyHistory) {
    Random random(5);
    World world;
    std::map<std::string, Entity> bodies;
    std::vector<std::string> names;
    const auto check = [&] {
        for (const std::string& name : names) {
            const auto known = bodies.find(name);
            EXPECT_EQ(find_by_id(world, persistent_id_from_name(name)),
                      known != bodies.end() ? known->second : k_no_entity);
        }
        for (const Joint& joint : world.joint.elements()) {
            EXPECT_TRUE(world.body.contains(joint.b));
            EXPECT_TRUE(is_null(joint.a) || world.body.contains(joint.a));
        }
    };
    int joints = 0;
    for (int step = 0; step < 3000; ++step) {
        const double what = random.between(0.0, 1.0);
        const auto any_body = [&] {
            auto body = bodies.begin();
            std::advance(body, static_cast<int>(random.between(0.0, double(bodies.size()))));
            return body;
        };
        if (what < 0.4 || bodies.size() < 3) {
            const std::string name = "b" + std::to_string(step);
            names.push_back(name);
            bodies[name] = add_body(world, shapeless_rock(name));
        } else if (what < 0.7) {
            Joint joint;
            joint.b = any_body()->second;
            joint.a = random.between(0.0, 1.0) < 0.2 ? k_no_entity : any_body()->second;
            if (joint.a != joint.b) {
                add_joint(world, {"j" + std::to_string(joints++), joint});
            }
        } else if (what < 0.9 || world.joint.empty()) {
            const auto body = any_body();
            EXPECT_TRUE(destroy(world, body->second));
            bodies.erase(body);
        } else {
            EXPECT_TRUE(destroy(world, world.joint.owners()[0]));
        }
        if (step % 500 == 0) {
            const World copy = world;
            world = copy;
        }
        if (step % 100 == 0) {
            check();
        }
    }
    check();
    while (!bodies.empty()) {
        destroy(world, bodies.begin()->second);
        bodies.erase(bodies.begin());
    }
    EXPECT_TRUE(world.joint.empty());
    check();
}

TEST(WorldIndex, HandsAreFoundAfterAnyHistory) {
    Random random(7);
    World world;
    std::vector<PlayerEntities> players;
    for (int step = 0; step < 400; ++step) {
        if (players.size() < 2 || random.between(0.0, 1.0) < 0.55) {
            PlayerDescription description;
            const std::string name = "p" + std::to_string(step);
            description.name = name;
            players.push_back(add_player(world, description));
        } else {
            const auto gone = players.begin() + static_cast<std::ptrdiff_t>(random.between(
                                                    0.0, static_cast<double>(players.size())));
            EXPECT_TRUE(destroy(world, gone->player));
            players.erase(gone);
        }
        for (const PlayerEntities& one : players) {
            for (const HandSide side : {HandSide::left, HandSide::right}) {
                ASSERT_EQ(hand_of(world, one.player, side), one.hands[index_of(side)]);
            }
        }
    }
}

}  // namespace
}  // namespace handhold::world_index_test
