#include "systems/hand/gather_surroundings.hpp"

#include <gtest/gtest.h>

#include "engine/geometry/shape_library.hpp"
#include "systems/rigs/builtin_hand_rig.hpp"
#include "tests/systems/frame/column_scene.hpp"

namespace handhold::gather_surroundings_test {
namespace {

using test::k_player;
using test::k_right;
using test::k_wall;

// A right hand on a box with edges of one metre.
struct OneHand {
    ShapeLibrary shapes;
    ShapeId box = shapes.add_box(Vec3(0.5, 0.5, 0.5));
    std::array<HandRig, k_hand_count> rigs = {builtin_hand_rig(HandSide::left),
                                              builtin_hand_rig(HandSide::right)};
    std::vector<Entity> bodies;
    Column<PersistentId> persistent_id;
    Column<HandOwner> owner;
    Column<HandTracking> hand;
    Column<Grab> grab;
    Column<PlayerOrigin> origin;
    Column<HeadTracking> head;
    Column<BodyPose> body_pose;
    Column<Collider> collider;
    Column<AuthoredHold> authored_hold;
    Column<BodySurface> own_surfaces;
    Column<HandRigChoice> rig_choice;
    Column<BodyHold> body_hold;
    Column<RenderPose> shown;
    Column<BodyMeasures> measures;
    PartMeshes part_meshes;
    ResizedMeshes resized_meshes;
    std::vector<HandSurroundings> surroundings;
    StageStats stats;

    OneHand() {
        owner.add(k_right) = {k_player, HandSide::right};
        hand.add(k_right);
        origin.add(k_player);
        head.add(k_player);
        persistent_id.add(k_wall).value = 7;
        body_pose.add(k_wall);
        collider.add(k_wall).shape = box;
        Grab& on_wall = grab.add(k_right);
        on_wall.kind = GripKind::surface;
        on_wall.body = k_wall;
        on_wall.anchor_bs.position = Vec3(0.0, 0.5, 0.0);
    }

    // Puts another box at `pose_ws` beside the hand, from then on.
    void place_other(const Pose& pose_ws) {
        const Entity other = test::entity(9);
        if (!body_pose.contains(other)) {
            persistent_id.add(other).value = 8;
            body_pose.add(other);
            collider.add(other).shape = box;
            bodies = {k_wall, other};
        }
        body_pose.at(other).pose_ws = pose_ws;
    }

    const HandSurroundings& gather(const GripMeshLibrary* meshes) {
        gather_surroundings({.meshes = {.of_shapes = meshes,
                                        .of_bodies = own_surfaces,
                                        .of_parts = part_meshes,
                                        .resized = resized_meshes},
                             .rigs = rigs,
                             .more_rigs = {},
                             .rig_choice = rig_choice,
                             .near = {.bodies = bodies},
                             .persistent_id = persistent_id,
                             .owner = owner,
                             .hand = hand,
                             .grab = grab,
                             .body_hold = body_hold,
                             .origin = origin,
                             .head = head,
                             .shown = shown,
                             .measures = measures,
                             .body_pose = body_pose,
                             .collider = collider,
                             .authored_hold = authored_hold,
                             .surroundings = surroundings},
                            stats);
        return surroundings.front();
    }
    std::uint64_t counted() const { return test::count_of(stats, Fallback::body_no_surface); }
};

TEST(GatherSurroundings, ListsGrippedBodysMeshFirst) {
    OneHand scene;
    const GripMeshLibrary meshes(scene.shapes);
    const HandSurroundings& hand = scene.gather(&meshes);
    EXPECT_EQ(hand.body, k_wall);
    ASSERT_EQ(hand.meshes.size(), 1U);
    EXPECT_EQ(hand.meshes.front().mesh, &meshes.at(scene.box));
    EXPECT_EQ(scene.counted(), 0U);
}

TEST(GatherSurroundings, EyeIsInTheBodysFrameAndInTheHandsMetres) {
    OneHand scene;
    const GripMeshLibrary meshes(scene.shapes);
    const Pose body_ws{Vec3(1.0, 2.0, 3.0), rotation_about(Vec3::UnitY(), 0.7)};
    const Vec3 eye_bs(0.1, 0.9, -0.2);
    scene.body_pose.at(k_wall).pose_ws = body_ws;
    for (const double scale : {1.0, 0.5}) {
        scene.origin.at(k_player).scale = scale;
        scene.head.at(k_player).pose_ps.position = transform_point(body_ws, eye_bs);
        scene.head.at(k_player).state = TrackingState::never;
        EXPECT_FALSE(scene.gather(&meshes).eye_bs);
        scene.head.at(k_player).state = TrackingState::tracked;
        const HandSurroundings& hand = scene.gather(&meshes);
        ASSERT_TRUE(hand.eye_bs);
        EXPECT_LT((*hand.eye_bs - eye_bs / scale).norm(), 1e-12);
    }
}

TEST(GatherSurroundings, CountsGrippedBodyWithoutGripMesh) {
    OneHand scene;
    const GripMeshLibrary none;
    const HandSurroundings& hand = scene.gather(&none);
    EXPECT_EQ(hand.body, k_no_entity);
    EXPECT_TRUE(hand.is_gripping);
    EXPECT_EQ(scene.counted(), 1U);
}

TEST(GatherSurroundings, CountsNothingIfHandsAreNotFitted) {
    OneHand scene;
    scene.gather(nullptr);
    EXPECT_EQ(scene.counted(), 0U);
}

TEST(GatherSurroundings, CountsNothingForEmptyHandsAndDestroyedBodies) {
    OneHand scene;
    const GripMeshLibrary none;
    scene.grab.at(k_right) = {};
    scene.gather(&none);
    scene.grab.at(k_right).kind = GripKind::surface;
    scene.grab.at(k_right).body = test::entity(77);
    scene.gather(&none);
    EXPECT_EQ(scene.counted(), 0U);
}

// A body beside the hand moves by 40 mm and turns by 0.2 rad in 100 frames, as a link of a cable
// does. Each change of search_signature costs a search for a surface.
TEST(GatherSurroundings, BodiesThatMoveBesideTheHandRarelyChangeTheSearchSignature) {
    constexpr int k_frames = 100;
    const Vec3 move_m(0.03, 0.02, 0.017);
    constexpr double k_turn_rad = 0.2;
    OneHand scene;
    const GripMeshLibrary meshes(scene.shapes);
    int changes = 0;
    int search_changes = 0;
    std::uint64_t last = 0;
    std::uint64_t last_search = 0;
    for (int frame = 0; frame < k_frames; ++frame) {
        const double share = static_cast<double>(frame) / k_frames;
        scene.place_other({Vec3(0.6, 0.55, 0.0) + share * move_m,
                           rotation_about(Vec3::UnitZ(), share * k_turn_rad)});
        const HandSurroundings& hand = scene.gather(&meshes);
        ASSERT_EQ(hand.meshes.size(), 2U);
        changes += hand.signature != last ? 1 : 0;
        search_changes += hand.search_signature != last_search ? 1 : 0;
        last = hand.signature;
        last_search = hand.search_signature;
    }
    EXPECT_EQ(changes, k_frames);
    // The box's corners move by up to 2.5 mm in a frame, and a change needs about 5 mm.
    EXPECT_LE(search_changes, k_frames / 2);
    EXPECT_GE(search_changes, 6);  // the largest coordinate alone
}

// A body beside the hand moves and turns, and a point as far from its frame as its corners moves by
// more than four steps: then the surface is searched again. (Six coordinates may each change by
// almost a step without another rounded value.)
TEST(GatherSurroundings, BodiesThatMoveFarChangeTheSearchSignature) {
    test::Random random(4);
    int far = 0;
    for (int i = 0; i < 300; ++i) {
        OneHand scene;
        const GripMeshLibrary meshes(scene.shapes);
        const Pose from{Vec3(0.6, 0.55, 0.0), random.rotation()};
        const double corner_m = meshes.at(scene.box).contact_bvh.farthest_m();
        const Vec3 move_m = random.vector(0.02);
        const Vec3 axis_ws = random.direction();
        const Pose by{move_m, rotation_about(axis_ws, random.between(0.0, 0.05))};
        const Pose to{from.position + by.position, by.rotation * from.rotation};
        double moved_m = 0.0;
        for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
            for (const double sign : {-1.0, 1.0}) {
                const Vec3 point = sign * corner_m * axis;
                moved_m = std::max(
                    moved_m, (transform_point(to, point) - transform_point(from, point)).norm());
            }
        }
        scene.place_other(from);
        const std::uint64_t before = scene.gather(&meshes).search_signature;
        scene.place_other(to);
        const std::uint64_t after = scene.gather(&meshes).search_signature;
        if (moved_m > 4.0 * k_search_step_m) {
            ++far;
            EXPECT_NE(before, after) << i;
        }
    }
    EXPECT_GT(far, 100);
}

}  // namespace
}  // namespace handhold::gather_surroundings_test
