#include "systems/physics/find_contacts.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "tests/systems/frame/column_scene.hpp"

namespace handhold::find_contacts_test {
namespace {

using test::entity;

constexpr Entity k_player = entity(0);
constexpr Entity k_left = entity(1);
constexpr Entity k_right = entity(2);
constexpr Entity k_rock = entity(3);
constexpr Entity k_wall = entity(4);
constexpr double k_head_radius_m = 0.11;
constexpr double k_rock_radius_m = 0.08;

std::uint64_t id_of(Entity entity) { return 100 + std::uint64_t{entity.slot}; }

// A head at the origin, a rock and a wall; the frame's proxies are written directly.
struct Contacts {
    ShapeLibrary shapes;
    ShapeId head_shape = shapes.add_sphere(k_head_radius_m);
    ShapeId rock_shape = shapes.add_sphere(k_rock_radius_m);
    ShapeId wall_shape = shapes.add_box(Vec3(1.0, 1.0, 0.1));
    Column<PersistentId> persistent_id;
    Column<RigidBody> body;
    Column<Joint> joint;
    Column<HandOwner> owner;
    Column<Grab> grab;
    Column<HeadIgnores> head_ignores;
    CollisionWorld collision{shapes};
    FrameGraph frame;
    std::vector<ColliderProxy> proxies;

    explicit Contacts(std::initializer_list<Entity> order = {k_player, k_left, k_right, k_rock,
                                                             k_wall}) {
        for (const Entity entity : order) {
            persistent_id.add(entity, {id_of(entity)});
            if (entity == k_rock || entity == k_wall) {
                body.add(entity, {entity == k_rock ? BodyKind::free : BodyKind::fixed});
            }
            if (entity == k_left || entity == k_right) {
                owner.add(entity, {k_player, entity == k_left ? HandSide::left : HandSide::right});
                grab.add(entity);
            }
        }
        head_ignores.add(k_player);
        place(k_player, head_shape, Vec3::Zero(), true);
    }
    void place(Entity entity, ShapeId shape, const Vec3& center, bool free) {
        std::erase_if(proxies,
                      [entity](const ColliderProxy& proxy) { return proxy.id == id_of(entity); });
        const Pose pose{center, Quat::Identity()};
        proxies.push_back({id_of(entity), shape, pose, pose, free});
        std::sort(proxies.begin(), proxies.end(),
                  [](const auto& a, const auto& b) { return a.id < b.id; });
    }
    // Places the rock at this gap from the head; negative: overlap.
    void place_rock(double gap_m) {
        place(k_rock, rock_shape, Vec3(k_head_radius_m + k_rock_radius_m + gap_m, 0.0, 0.0), true);
    }
    // Places the wall in front of the head (-z) at this gap.
    void place_wall(double gap_m) {
        place(k_wall, wall_shape, Vec3(0.0, 0.0, -(k_head_radius_m + 0.1 + gap_m)), false);
    }
    void hold(Entity hand, Entity held) {
        grab.at(hand).kind = GripKind::held;
        grab.at(hand).body = held;
        head_ignores.at(k_player).bodies[0] = held;
    }
    void run() {
        collision.set_proxies(proxies);
        find_contacts({.persistent_id = persistent_id,
                       .body = body,
                       .joint = joint,
                       .owner = owner,
                       .grab = grab,
                       .collision = collision,
                       .head_ignores = head_ignores,
                       .frame = frame},
                      ContactTuning{});
    }
    std::size_t count_between(Entity x, Entity y) const {
        return static_cast<std::size_t>(
            std::ranges::count_if(frame.contacts, [=](const ContactPoint& contact) {
                return std::minmax(contact.id_a, contact.id_b) == std::minmax(id_of(x), id_of(y));
            }));
    }
    bool ignores(Entity who) const {
        return std::ranges::count(head_ignores.at(k_player).bodies, who) > 0;
    }
};

TEST(FindContacts, HeadAndWallTouchWithTheirGapAsSeparation) {
    for (const double gap_m : {-0.003, 0.0, 0.01}) {
        Contacts scene;
        scene.place_wall(gap_m);
        scene.run();
        ASSERT_EQ(scene.count_between(k_player, k_wall), 1U);
        EXPECT_NEAR(scene.frame.contacts[0].separation_m, gap_m, 1e-9);
        EXPECT_LT((scene.frame.contacts[0].normal_b_bs - Vec3::UnitZ()).norm(), 1e-9);
    }
}

TEST(FindContacts, BodiesBeyondTheMarginMakeNoContacts) {
    Contacts scene;
    scene.place_wall(1.01 * ContactTuning{}.margin_m);
    scene.run();
    EXPECT_TRUE(scene.frame.contacts.empty());
}

TEST(FindContacts, HeldRockTouchesWallsButNotItsHoldersHead) {
    Contacts scene;
    scene.place_rock(-0.01);
    scene.place(k_wall, scene.wall_shape, Vec3(0.19, 0.0, -0.18), false);
    scene.run();
    EXPECT_EQ(scene.count_between(k_player, k_rock), 1U);
    scene.hold(k_right, k_rock);
    scene.run();
    EXPECT_EQ(scene.count_between(k_player, k_rock), 0U);
    EXPECT_EQ(scene.count_between(k_rock, k_wall), 1U);
    ASSERT_EQ(scene.frame.ignored.size(), 1U);
    EXPECT_EQ(scene.frame.ignored[0], (IgnoredPair{id_of(k_player), id_of(k_rock)}));
}

TEST(FindContacts, HeldRockIsIgnoredAtAnyDistance) {
    Contacts scene;
    scene.place_rock(0.5);
    scene.hold(k_right, k_rock);
    scene.run();
    EXPECT_TRUE(scene.ignores(k_rock));
    EXPECT_EQ(scene.frame.ignored.size(), 1U);
}

TEST(FindContacts, ReleasedRockIsIgnoredUntilItIsClearOfTheHead) {
    Contacts scene;
    scene.hold(k_right, k_rock);
    scene.place_rock(-0.05);
    scene.run();
    scene.grab.at(k_right) = {};
    for (const double gap_m : {-0.05, -0.01, 0.01}) {
        scene.place_rock(gap_m);
        scene.run();
        EXPECT_TRUE(scene.ignores(k_rock)) << gap_m;
        EXPECT_EQ(scene.count_between(k_player, k_rock), 0U) << gap_m;
    }
    scene.place_rock(0.05);
    scene.run();
    EXPECT_FALSE(scene.ignores(k_rock));
    EXPECT_TRUE(scene.frame.ignored.empty());
    scene.place_rock(-0.01);
    scene.run();
    EXPECT_EQ(scene.count_between(k_player, k_rock), 1U);
}

TEST(FindContacts, DestroyedBodyIsRemovedFromHeadIgnores) {
    Contacts scene;
    scene.head_ignores.at(k_player).bodies[3] = entity(50);
    scene.run();
    EXPECT_FALSE(scene.ignores(entity(50)));
    EXPECT_TRUE(scene.frame.ignored.empty());
}

TEST(FindContacts, HeldRockTouchesAnotherPlayersHead) {
    constexpr Entity k_other = entity(9);
    Contacts scene;
    scene.persistent_id.add(k_other, {id_of(k_other)});
    scene.head_ignores.add(k_other);
    scene.place_rock(-0.01);
    scene.place(k_other, scene.head_shape,
                Vec3(2.0 * (k_head_radius_m + k_rock_radius_m) - 0.02, 0.0, 0.0), true);
    scene.hold(k_right, k_rock);
    scene.run();
    EXPECT_EQ(scene.count_between(k_player, k_rock), 0U);
    EXPECT_EQ(scene.count_between(k_other, k_rock), 1U);
}

TEST(FindContacts, SecondRunIsBitwiseEqual) {
    Contacts scene;
    scene.place_rock(-0.01);
    scene.place_wall(0.005);
    scene.run();
    const std::vector<ContactPoint> first = scene.frame.contacts;
    scene.run();
    ASSERT_EQ(scene.frame.contacts.size(), first.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
        EXPECT_EQ(scene.frame.contacts[i].id_a, first[i].id_a);
        EXPECT_EQ(scene.frame.contacts[i].point_a_bs, first[i].point_a_bs);
        EXPECT_EQ(scene.frame.contacts[i].separation_m, first[i].separation_m);
    }
}

TEST(FindContacts, ResultDoesNotDependOnTheOrderOfRows) {
    Contacts forth;
    Contacts back({k_wall, k_rock, k_right, k_left, k_player});
    for (Contacts* const scene : {&forth, &back}) {
        scene->place_rock(-0.01);
        scene->place_wall(0.005);
        scene->hold(k_left, k_rock);
        scene->run();
    }
    ASSERT_EQ(forth.frame.contacts.size(), back.frame.contacts.size());
    for (std::size_t i = 0; i < forth.frame.contacts.size(); ++i) {
        EXPECT_EQ(forth.frame.contacts[i].id_a, back.frame.contacts[i].id_a);
        EXPECT_EQ(forth.frame.contacts[i].id_b, back.frame.contacts[i].id_b);
    }
    EXPECT_EQ(forth.frame.ignored, back.frame.ignored);
}

}  // namespace
}  // namespace handhold::find_contacts_test
