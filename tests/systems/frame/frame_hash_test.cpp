#include <array>
#include <cstdint>
#include <limits>
#include <set>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include "components/fields.hpp"
#include "engine/core/check.hpp"
#include "systems/frame/frame.hpp"
#include "tests/systems/frame/column_scene.hpp"

namespace handhold::frame_hash_test {
namespace {

using test::Random;

BodyDescription rock(std::string_view name, std::uint64_t seed) {
    Random random(seed);
    BodyDescription description;
    description.name = name;
    description.body = {BodyKind::free, random.between(1.0, 5.0), Vec3(0.1, 0.2, 0.3), 0.4};
    description.pose_ws = random.pose();
    description.velocity = {random.vector(1.0), random.vector(1.0)};
    return description;
}

PlayerDescription player() {
    PlayerDescription description;
    description.name = "player";
    return description;
}

// A world with an element in every column.
World full_world() {
    World world;
    const Entity ship = add_body(world, rock("ship", 1));
    world.mover.add(ship, {Pose{}, Vec3::UnitX(), Vec3::UnitY(), true});
    const std::array<Pose, 2> poses = {Pose{}, Pose{Vec3::UnitX(), Quat::Identity()}};
    world.path_mover.add(ship, {make_pose_path(poses, 4.0)});
    world.leg_mover.add(ship);
    const Entity other = add_body(world, rock("rock", 2));
    Joint joint;
    joint.a = ship;
    joint.b = other;
    add_joint(world, {"joint", joint});
    const PlayerEntities made = add_player(world, player());
    world.controller_to_hand.add(made.hands[0]);
    world.authored_grips.add(ship);
    world.authored_hold.add(made.hands[0]);
    world.body_hold.add(made.hands[0]);
    world.hand_pull.add(made.hands[0]);
    world.move_target.add(ship).count = 1;
    world.gravity_scale.add(other);
    world.filter.add(other);
    world.grab_rule.add(other);
    world.early_samples.add(made.player).count = 1;
    world.recenter_guess.add(made.player);
    world.grab_layers.add(made.player);
    world.grab_order.add(made.hands[0]);
    world.hand_rig.add(made.hands[0]);
    return world;
}

// --- Changing any field --------------------------------------------------------------------------

// Changes one number of a field to another valid value. Fields are visited as const, but the world
// is not.
class FieldChanger {
  public:
    explicit FieldChanger(World& world) : world_(world) {}

    template <typename T>
    void change(const T& field) {
        change_in_place(const_cast<T&>(field));  // NOLINT(cppcoreguidelines-pro-type-const-cast)
    }

  private:
    void change_in_place(double& value) { value += 1.0; }
    void change_in_place(bool& value) { value = !value; }
    void change_in_place(Vec3& v) { v.z() += 1.0; }
    void change_in_place(Quat& q) { q = q * rotation_about(Vec3::UnitX(), 0.5); }
    void change_in_place(Pose& pose) {
        pose.rotation = pose.rotation * rotation_about(Vec3::UnitX(), 0.5);
    }
    void change_in_place(ShapeId& shape) { ++shape.index; }
    void change_in_place(Entity& entity) {
        const Entity rock = find_by_id(world_, persistent_id_from_name("rock"));
        entity = entity == rock ? k_no_entity : rock;
    }
    template <typename T, std::size_t N>
    void change_in_place(std::array<T, N>& values) {
        change_in_place(values.back());
    }
    template <typename T>
    void change_in_place(std::span<const T>& values) {
        change(values.back());
    }
    template <typename T>
    void change_in_place(T& value) {
        if constexpr (std::is_enum_v<T>) {
            value = static_cast<T>(static_cast<int>(value) ^ 1);
        } else if constexpr (std::is_integral_v<T>) {
            ++value;
        } else {
            bool is_first = true;  // a component within a component
            visit_fields(value, [&](const char*, const auto& field) {
                if (is_first) {
                    change(field);
                }
                is_first = false;
            });
        }
    }

    World& world_;
};

// Calls change(world) for every field of every column, each on a fresh world with only that field
// changed.
template <typename Check>
void for_every_field(Check&& check) {
    for (int wanted = 0;; ++wanted) {
        World world = full_world();
        int index = 0;
        std::string changed;
        visit_columns(world, [&](const char* column_name, auto& column) {
            ASSERT_FALSE(column.empty()) << column_name;
            visit_fields(column.elements()[0], [&](const char* field_name, const auto& field) {
                if (index++ == wanted) {
                    changed = std::string(column_name) + "." + field_name;
                    FieldChanger(world).change(field);
                }
            });
        });
        if (changed.empty()) {
            return;
        }
        check(world, changed);
    }
}

// Except shape ids, which depend on loading order.
TEST(HashState, EveryFieldOfEveryColumnIsHashed) {
    const std::uint64_t before = hash_state(full_world());
    std::set<std::uint64_t> seen = {before};
    std::size_t fields = 0;
    for_every_field([&](const World& world, const std::string& changed) {
        ++fields;
        if (changed == "collider.shape") {
            EXPECT_EQ(hash_state(world), before);
            return;
        }
        EXPECT_TRUE(seen.insert(hash_state(world)).second) << changed;
    });
    EXPECT_GE(fields, 60U);
}

TEST(HashState, ClockAndTheScenesReferenceVelocityAreHashed) {
    std::set<std::uint64_t> seen = {hash_state(full_world())};
    World later = full_world();
    later.clock.frame = 1;
    EXPECT_TRUE(seen.insert(hash_state(later)).second);
    World shifted = full_world();
    shifted.clock.t_s = 0.01;
    EXPECT_TRUE(seen.insert(hash_state(shifted)).second);
    World drifting = full_world();
    drifting.reference_velocity_mps.y() = 0.01;
    EXPECT_TRUE(seen.insert(hash_state(drifting)).second);
}

// --- Must not be hashed --------------------------------------------------------------------------

TEST(HashState, DoesNotDependOnCreationOrder) {
    World forth;
    add_body(forth, rock("a", 1));
    add_body(forth, rock("b", 2));
    add_player(forth, player());
    World back;
    add_player(back, player());
    add_body(back, rock("b", 2));
    add_body(back, rock("a", 1));
    EXPECT_EQ(hash_state(forth), hash_state(back));
}

TEST(HashState, DoesNotDependOnSlotsAndGenerations) {
    const auto gripping_world = [](int destroyed_before) {
        World world;
        for (int i = 0; i < destroyed_before; ++i) {
            const Entity first = add_body(world, rock("gone", 3));
            const Entity second = add_body(world, rock("gone too", 4));
            destroy(world, first);
            destroy(world, second);
        }
        const PlayerEntities made = add_player(world, player());
        const Entity body = add_body(world, rock("a", 1));
        world.grab.at(made.hands[1]).kind = GripKind::held;
        world.grab.at(made.hands[1]).body = body;
        world.head_ignores.at(made.player).bodies[0] = body;
        return world;
    };
    const std::uint64_t expected = hash_state(gripping_world(0));
    EXPECT_EQ(hash_state(gripping_world(1)), expected);
    EXPECT_EQ(hash_state(gripping_world(3)), expected);
}

TEST(HashState, CopiesAreEqual) {
    const World world = full_world();
    const World copy = world;
    EXPECT_EQ(hash_state(copy), hash_state(world));
}

// --- Ownership of elements -----------------------------------------------------------------------

// Hashes of elements are summed; the owner must still show.
TEST(HashState, ChangesIfTwoBodiesSwapPoses) {
    World world;
    const Entity a = add_body(world, rock("a", 1));
    const Entity b = add_body(world, rock("b", 2));
    const std::uint64_t before = hash_state(world);
    std::swap(world.body_pose.at(a), world.body_pose.at(b));
    EXPECT_NE(hash_state(world), before);
}

// BodyPose and BodyStart have equal fields: the column's name must be hashed too.
TEST(HashState, ChangesIfABodySwapsTwoColumns) {
    World world;
    const Entity a = add_body(world, rock("a", 1));
    world.body_start.at(a).pose_ws.position.x() += 1.0;
    const std::uint64_t before = hash_state(world);
    std::swap(world.body_start.at(a).pose_ws, world.body_pose.at(a).pose_ws);
    EXPECT_NE(hash_state(world), before);
}

TEST(HashState, IsRestoredByDestroyingAnAddedBody) {
    World world = full_world();
    const std::uint64_t before = hash_state(world);
    const Entity extra = add_body(world, rock("extra", 9));
    EXPECT_NE(hash_state(world), before);
    destroy(world, extra);
    EXPECT_EQ(hash_state(world), before);
}

// --- step_frame ----------------------------------------------------------------------------------

TEST(StepFrame, InvalidDtIsRefusedAndChangesNothing) {
    for (const double dt_s : {0.0, -0.01, std::numeric_limits<double>::quiet_NaN()}) {
        const ShapeLibrary shapes;
        FrameCaches caches(shapes);
        World world;
        StageStats stats;
        const std::uint64_t before = hash_state(world);
        EXPECT_THROW(step_frame(world, caches, {}, {dt_s, {}}, stats), PreconditionError);
        EXPECT_EQ(hash_state(world), before);
    }
}

TEST(StepFrame, EmptyWorldOnlyAdvancesItsClock) {
    const ShapeLibrary shapes;
    FrameCaches caches(shapes);
    World world;
    StageStats stats;
    stats.grab_onsets = 7;  // stats are cleared
    step_frame(world, caches, {}, {0.25, {}}, stats);
    step_frame(world, caches, {}, {0.5, {}}, stats);
    EXPECT_EQ(world.clock.frame, 2U);
    EXPECT_EQ(world.clock.t_s, 0.75);
    EXPECT_EQ(stats.grab_onsets, 0U);
    EXPECT_EQ(test::count_of_all(stats), 0U);
}

// A frame that cannot run changes nothing, whatever part of the world is wrong.
TEST(StepFrame, ChecksEverythingBeforeItChangesAnything) {
    ShapeLibrary shapes;
    World world;
    BodyDescription body;
    body.name = "drifting";
    body.body = {BodyKind::free, 1.0, Vec3::Ones(), 0.0, 0.4};
    body.velocity.linear_mps = Vec3(1.0, 0.0, 0.0);
    body.shape = shapes.add_sphere(0.1);
    const Entity drifting = add_body(world, body);
    FrameCaches caches(shapes);
    StageStats stats;
    step_frame(world, caches, {}, {}, stats);
    const std::uint64_t before = hash_state(world);
    world.collider.at(drifting).shape = {7};  // no such shape
    EXPECT_THROW(step_frame(world, caches, {}, {}, stats), PreconditionError);
    auto triangle = std::make_shared<Mesh>();
    triangle->positions = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
    triangle->triangles = {{0, 1, 2}};
    world.collider.at(drifting).shape = shapes.add_mesh(triangle);  // a mesh cannot be free
    EXPECT_THROW(step_frame(world, caches, {}, {}, stats), PreconditionError);
    world.collider.at(drifting).shape = body.shape;
    world.gravity_mps2.y() = std::nan("");
    EXPECT_THROW(step_frame(world, caches, {}, {}, stats), PreconditionError);
    world.gravity_mps2.setZero();
    EXPECT_EQ(hash_state(world), before);
    step_frame(world, caches, {}, {}, stats);
    EXPECT_NEAR(world.body_pose.at(drifting).pose_ws.position.x(), 2.0 / 90.0, 1e-12);
}

}  // namespace
}  // namespace handhold::frame_hash_test
