#include <array>
#include <cstddef>
#include <limits>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include "components/fields.hpp"
#include "components/stats.hpp"
#include "components/world.hpp"
#include "engine/core/check.hpp"
#include "tests/components/member_count.hpp"

namespace handhold::components_test {
namespace {

using test::member_count;

template <typename T>
std::vector<std::string> field_names() {
    std::vector<std::string> names;
    visit_fields(T{}, [&names](const char* name, const auto&) { names.emplace_back(name); });
    return names;
}

template <typename T>
void expect_all_fields_visited(const char* name) {
    const std::vector<std::string> names = field_names<T>();
    EXPECT_EQ(names.size(), member_count<T>()) << name;
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size()) << name;
}

TEST(Fields, EveryMemberOfEveryComponentIsVisitedOnce) {
    World world;
    visit_columns(world, [](const char* name, auto& column) {
        expect_all_fields_visited<std::remove_cvref_t<decltype(column.elements()[0])>>(name);
    });
    expect_all_fields_visited<RenderPose::Hand>("RenderPose::Hand");
    expect_all_fields_visited<FingerAngles>("FingerAngles");
    expect_all_fields_visited<AuthoredHand>("AuthoredHand");
    expect_all_fields_visited<AuthoredGrip>("AuthoredGrip");
    expect_all_fields_visited<HandHistory::Entry>("HandHistory::Entry");
    expect_all_fields_visited<ChestOffset>("ChestOffset");
    expect_all_fields_visited<ArmMemory::Arm>("ArmMemory::Arm");
    expect_all_fields_visited<ArmEstimate::Arm>("ArmEstimate::Arm");
    expect_all_fields_visited<ArmPose::Arm>("ArmPose::Arm");
    expect_all_fields_visited<SpinePose::Leg>("SpinePose::Leg");
}

TEST(Columns, EveryColumnOfTheWorldIsVisitedOnce) {
    // entities, clock, reference_velocity_mps, gravity_mps2, name_of_id; the caches entity_by_id,
    // joints_by_body
    constexpr std::size_t k_others = 7;
    World world;
    std::set<std::string> names;
    std::set<const void*> columns;
    visit_columns(world, [&](const char* name, auto& column) {
        names.insert(name);
        columns.insert(&column);
    });
    EXPECT_EQ(columns.size(), member_count<World>() - k_others);
    EXPECT_EQ(names.size(), columns.size());
}

// --- Adding and destroying -----------------------------------------------------------------------

BodyDescription rock(std::string_view name) {
    BodyDescription description;
    description.name = name;
    description.body = {BodyKind::free, 2.0, Vec3(0.1, 0.2, 0.3), 0.0};
    return description;
}
PlayerDescription player(std::string_view name) {
    PlayerDescription description;
    description.name = name;
    return description;
}

std::size_t row_count(const World& world) {
    std::size_t rows = 0;
    visit_columns(world, [&rows](const char*, const auto& column) { rows += column.size(); });
    return rows;
}
std::size_t row_count(const World& world, Entity entity) {
    std::size_t rows = 0;
    visit_columns(
        world, [&](const char*, const auto& column) { rows += column.contains(entity) ? 1U : 0U; });
    return rows;
}

TEST(World, DestroyedBodyIsGoneFromEveryColumn) {
    World world;
    const Entity a = add_body(world, rock("a"));
    const Entity b = add_body(world, rock("b"));
    world.mover.add(a);
    const std::size_t rows_of_b = row_count(world, b);
    EXPECT_TRUE(destroy(world, a));
    EXPECT_EQ(row_count(world, a), 0U);
    EXPECT_EQ(row_count(world), rows_of_b);
    EXPECT_FALSE(world.entities.is_alive(a));
    EXPECT_FALSE(destroy(world, a));
    EXPECT_FALSE(destroy(world, k_no_entity));
    EXPECT_TRUE(world.entities.is_alive(b));
}

TEST(World, DestroyingAPlayerDestroysOnlyTheirHands) {
    World world;
    const PlayerEntities first = add_player(world, player("first"));
    const PlayerEntities second = add_player(world, player("second"));
    const std::size_t rows_of_one = row_count(world) / 2;
    EXPECT_TRUE(destroy(world, first.player));
    EXPECT_EQ(row_count(world), rows_of_one);
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        EXPECT_FALSE(world.entities.is_alive(first.hands[index_of(side)]));
        const Entity hand = second.hands[index_of(side)];
        EXPECT_EQ(world.hand_owner.at(hand).player, second.player);
        EXPECT_EQ(world.hand_owner.at(hand).side, side);
    }
}

TEST(World, NamesGiveTheIdsAndCanBeReusedAfterDestroying) {
    World world;
    const Entity a = add_body(world, rock("a"));
    EXPECT_EQ(find_by_id(world, persistent_id_from_name("a")), a);
    EXPECT_EQ(find_by_id(world, persistent_id_from_name("b")), k_no_entity);
    destroy(world, a);
    EXPECT_EQ(find_by_id(world, persistent_id_from_name("a")), k_no_entity);
    const Entity again = add_body(world, rock("a"));
    EXPECT_NE(again, a);
    EXPECT_EQ(find_by_id(world, persistent_id_from_name("a")), again);
}

TEST(World, DuplicateNamesAreRefusedAndChangeNothing) {
    World world;
    add_body(world, rock("rock"));
    add_player(world, player("player"));
    add_body(world, rock("other/right_hand"));
    const std::size_t rows = row_count(world);
    EXPECT_THROW(add_body(world, rock("rock")), PreconditionError);
    EXPECT_THROW(add_body(world, rock("player/left_hand")), PreconditionError);
    EXPECT_THROW(add_player(world, player("rock")), PreconditionError);
    EXPECT_THROW(add_player(world, player("player")), PreconditionError);
    EXPECT_THROW(add_player(world, player("other")),
                 PreconditionError);  // the name of its right hand exists already
    EXPECT_EQ(row_count(world), rows);
    EXPECT_EQ(world.entities.alive_count(), 5U);
}

TEST(World, InvalidBodiesAreRefused) {
    World world;
    BodyDescription weightless = rock("a");
    weightless.body.mass_kg = 0.0;
    EXPECT_THROW(add_body(world, weightless), PreconditionError);
    BodyDescription thin = rock("a");
    thin.body.inertia_kgm2.y() = 0.0;
    EXPECT_THROW(add_body(world, thin), PreconditionError);
    BodyDescription nowhere = rock("a");
    nowhere.pose_ws.position.x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(add_body(world, nowhere), PreconditionError);
    PlayerDescription massless = player("p");
    massless.body.mass_kg = 0.0;
    EXPECT_THROW(add_player(world, massless), PreconditionError);
    PlayerDescription skewed = player("p");
    skewed.origin_ws.rotation.coeffs() *= 2.0;
    EXPECT_THROW(add_player(world, skewed), PreconditionError);
    EXPECT_EQ(row_count(world), 0U);
}

TEST(World, OnlyFreeBodiesAndPlayersHaveALastValidPose) {
    World world;
    BodyDescription wall;
    wall.name = "wall";
    EXPECT_FALSE(world.last_valid.contains(add_body(world, wall)));
    const Entity body = add_body(world, rock("rock"));
    EXPECT_TRUE(world.last_valid.at(body).known);
    const PlayerEntities made = add_player(world, player("player"));
    EXPECT_FALSE(world.last_valid.at(made.player).known);  // the head was not tracked yet
}

// --- Names of counters ---------------------------------------------------------------------------

template <typename Enum>
void expect_names_distinct() {
    std::set<std::string> names = {"unknown"};
    for (std::size_t i = 0; i < static_cast<std::size_t>(Enum::count); ++i) {
        EXPECT_TRUE(names.insert(name_of(static_cast<Enum>(i))).second) << i;
    }
    EXPECT_STREQ(name_of(Enum::count), "unknown");
}

TEST(Stats, EveryStageAndFallbackHasAUniqueName) {
    expect_names_distinct<Stage>();
    expect_names_distinct<Fallback>();
}

}  // namespace
}  // namespace handhold::components_test
