#include "systems/hand/search_grip.hpp"

#include <gtest/gtest.h>

#include "components/authored_grip.hpp"
#include "engine/collision/closest_point.hpp"
#include "engine/geometry/chain_fit.hpp"
#include "fitted_hand.hpp"
#include "systems/hand/shared/finger_chain.hpp"
#include "systems/hand/shared/finger_clearance.hpp"
#include "systems/hand/shared/palm_fit.hpp"
#include "systems/rigs/authored_hand.hpp"
#include "tests/engine/geometry/surface_cuts.hpp"

namespace handhold::search_grip_test {
namespace {

using test::FittedHand;
using test::k_right;
using test::Random;
using test::wrist_with_palm_at;

// How deep the palm is that search_grip holds, by find_penetration, which has its own tests.
double palm_sunk_m(FittedHand& hand) {
    const Pose& wrist_bs = hand.surface.at(k_right).fitted_wrist_bs;
    double deepest_m = 0.0;
    for (const PalmCapsule& palm : hand.rig.palm) {
        const Capsule capsule = {
            {transform_point(wrist_bs, palm.a_hs), transform_point(wrist_bs, palm.b_hs)},
            palm.radius_m};
        deepest_m =
            std::max(deepest_m, find_penetration(capsule, hand.hands.front().meshes).depth_m);
    }
    return deepest_m;
}

// Whether a surface goes through the middle of a finger that is held clear with the palm.
bool is_finger_crossed(FittedHand& hand) {
    const GripSurface& surface = hand.surface.at(k_right);
    for (std::size_t f = 0; f < hand.rig.fingers.size(); ++f) {
        const FingerRig& finger = hand.rig.fingers[f];
        const auto bent = sample_pose_angles(finger, surface.finger_samples[f]);
        if (!bent) {
            continue;
        }
        const HingeChain chain =
            finger_chain(finger, bent->opposition_rad, surface.fitted_wrist_bs);
        const auto links = chain_capsules(chain, bent->curl_rad);
        for (std::size_t i = 0; i < chain.link_count; ++i) {
            if (find_penetration(links[i], hand.hands.front().meshes).crossed_at) {
                return true;
            }
        }
    }
    return false;
}

// A slab with a top and a bottom, wound outwards: a hand that went into it is no nearer to what
// there is to grip inside of it.
TEST(SearchGrip, HoldsNoPalmInsideASolid) {
    constexpr double k_thick_m = 0.05;
    Mesh slab = test::make_floor_mesh();
    const auto top = static_cast<std::uint32_t>(slab.positions.size());
    for (std::uint32_t i = 0; i < top; ++i) {
        slab.positions.push_back(slab.positions[i] - k_thick_m * Vec3::UnitY());
    }
    for (std::size_t i = slab.triangles.size(); i-- > 0;) {
        const auto [a, b, c] = slab.triangles[i];
        slab.triangles.push_back({top + a, top + c, top + b});
    }
    const GripMesh mesh = build_grip_mesh(slab);
    const HandRig rig = builtin_hand_rig(HandSide::right);
    for (const double deep_m : {0.01, 0.02, 0.03, 0.04}) {
        FittedHand hand(mesh, wrist_with_palm_at(rig, {0.013, -deep_m, 0.007}, Vec3::UnitY()));
        hand.search();
        hand.constrain(test::k_at_once_s);
        EXPECT_GE(hand.palm_center_bs().y(), hand.tuning.palm.min_height_m - 1e-9) << deep_m;
        EXPECT_GT(hand.palm_up_bs().y(), 0.9) << deep_m;
    }
}

// Four walls around a hole along y, wound outwards, with a groove around their outside.
constexpr double k_hole_x_m = 0.05;
constexpr double k_hole_z_m = 0.07;
constexpr double k_wall_m = 0.047;
constexpr double k_groove_m = 0.014;
constexpr double k_groove_y_m = 0.068;
constexpr double k_frame_y_m = 0.1;

bool is_in_frame(const Vec3& point) {
    const Vec3 at = point.cwiseAbs();
    const double wall_m = at.y() < k_groove_y_m ? k_wall_m - k_groove_m : k_wall_m;
    const bool is_beyond =
        at.x() > k_hole_x_m + wall_m || at.z() > k_hole_z_m + wall_m || at.y() > k_frame_y_m;
    const bool is_in_hole = at.x() < k_hole_x_m && at.z() < k_hole_z_m;
    return !is_beyond && !is_in_hole;
}

// A ring of walls at a height, so thick there.
struct Ring {
    double y;
    double wall_m;
};

// Walls around a rectangular hole along y: the rings down through the hole and up along the
// outside.
GripMesh make_frame(double half_x_m, double half_z_m, std::span<const Ring> rings) {
    Mesh mesh;
    for (const auto& [y, wall_m] : rings) {
        const double x = half_x_m + wall_m;
        const double z = half_z_m + wall_m;
        mesh.positions.insert(mesh.positions.end(),
                              {{-x, y, -z}, {-x, y, z}, {x, y, z}, {x, y, -z}});
    }
    const auto corners = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t ring = 0; ring < corners; ring += 4) {
        for (std::uint32_t i = 0; i < 4; ++i) {
            const std::uint32_t a = ring + i;
            const std::uint32_t b = ring + (i + 1) % 4;
            const std::uint32_t c = (b + 4) % corners;
            mesh.triangles.push_back({a, b, c});
            mesh.triangles.push_back({a, c, (a + 4) % corners});
        }
    }
    return build_grip_mesh(mesh);
}

GripMesh make_grooved_frame() {
    constexpr std::array<Ring, 8> k_rings = {{{k_frame_y_m, 0.0},
                                              {-k_frame_y_m, 0.0},
                                              {-k_frame_y_m, k_wall_m},
                                              {-k_groove_y_m, k_wall_m},
                                              {-k_groove_y_m, k_wall_m - k_groove_m},
                                              {k_groove_y_m, k_wall_m - k_groove_m},
                                              {k_groove_y_m, k_wall_m},
                                              {k_frame_y_m, k_wall_m}}};
    return make_frame(k_hole_x_m, k_hole_z_m, k_rings);
}

// A palm before one of the inner walls of a frame, at random.
Pose random_wrist_before_wall(const HandRig& rig, double half_x_m, double half_z_m, double high_m,
                              Random& random) {
    const double side = random.between(0.0, 1.0) < 0.5 ? -1.0 : 1.0;
    const bool is_x = random.between(0.0, 1.0) < 0.5;
    const Vec3 inwards = is_x ? Vec3(side * -Vec3::UnitX()) : Vec3(side * -Vec3::UnitZ());
    const double half_m = (is_x ? half_x_m : half_z_m) - random.between(0.002, 0.02);
    const Vec3 along_wall =
        is_x ? Vec3(0.0, high_m, half_z_m - 0.02) : Vec3(half_x_m - 0.02, high_m, 0.0);
    const Vec3 palm = random.vector(1.0).cwiseProduct(along_wall) - half_m * inwards;
    const Vec3 up = (inwards + random.vector(0.3)).normalized();
    Pose wrist = wrist_with_palm_at(rig, Vec3::Zero(), up);
    wrist.rotation = rotation_about(up, random.between(-3.14, 3.14)) * wrist.rotation;
    wrist.position = palm - wrist.rotation * rig.palm_center_hs;
    return wrist;
}

// A hole too narrow for fingers that are straight: whatever a palm before its walls is held to, it
// is hardly ever held inside of one.
TEST(SearchGrip, HoldsHardlyAPalmInTheWallsAroundAHole) {
    const GripMesh mesh = make_grooved_frame();
    const HandRig rig = builtin_hand_rig(HandSide::right);
    Random random(2215);
    int inside = 0;
    for (int i = 0; i < 300; ++i) {
        const Pose wrist = random_wrist_before_wall(rig, k_hole_x_m, k_hole_z_m, 0.06, random);
        FittedHand hand(mesh, wrist);
        hand.search();
        hand.constrain(test::k_at_once_s);
        const Vec3 center = hand.palm_center_bs();
        inside += is_in_frame(center) ? 1 : 0;
    }
    EXPECT_LE(inside, 3);  // 13 where the way is not asked
}

// A box without a floor, its walls so thin that they lie between the spheres that a palm is held
// by, hands in it: whatever their palms are held to, walls hardly ever go through them, nor through
// fingers that they are held clear with.
TEST(SearchGrip, HoldsHardlyAHandThroughAThinWall) {
    constexpr double k_half_m = 0.06;
    constexpr double k_high_m = 0.04;
    constexpr double k_thin_m = 0.003;
    constexpr double k_through_m = 0.008;
    constexpr std::array<Ring, 4> k_rings = {
        {{k_high_m, 0.0}, {-k_high_m, 0.0}, {-k_high_m, k_thin_m}, {k_high_m, k_thin_m}}};
    const GripMesh mesh = make_frame(k_half_m, k_half_m, k_rings);
    const HandRig rig = builtin_hand_rig(HandSide::right);
    Random random(2216);
    int palms_through = 0;
    int fingers_through = 0;
    for (int i = 0; i < 300; ++i) {
        FittedHand hand(mesh, random_wrist_before_wall(rig, k_half_m, k_half_m, k_high_m, random));
        hand.search();
        palms_through += palm_sunk_m(hand) > k_through_m ? 1 : 0;
        fingers_through += is_finger_crossed(hand) ? 1 : 0;
    }
    EXPECT_LE(palms_through, 3);    // 23 where they are not asked
    EXPECT_LE(fingers_through, 3);  // 86
}

// A floor with a block on it before the fingers, which are sunk in it wherever they bend.
GripMesh make_floor_and_block() {
    constexpr double k_front_m = -0.05;
    constexpr double k_back_m = -0.25;
    constexpr double k_top_m = 0.12;
    Mesh mesh = test::make_floor_mesh();
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const double y : {-0.01, k_top_m}) {
        for (const auto& [x, z] : {std::array{-0.2, k_front_m}, std::array{0.2, k_front_m},
                                   std::array{0.2, k_back_m}, std::array{-0.2, k_back_m}}) {
            mesh.positions.emplace_back(x, y, z);
        }
    }
    for (std::uint32_t side = 0; side < 4; ++side) {
        const std::uint32_t a = first + side;
        const std::uint32_t b = first + (side + 1) % 4;
        mesh.triangles.push_back({a, b, b + 4});
        mesh.triangles.push_back({a, b + 4, a + 4});
    }
    mesh.triangles.push_back({first + 4, first + 5, first + 6});
    mesh.triangles.push_back({first + 4, first + 6, first + 7});
    return build_grip_mesh(mesh);
}

struct FingerClearance {
    const GripMesh mesh = make_floor_and_block();
    const HandRig rig = builtin_hand_rig(HandSide::right);
    const Pose before_block = wrist_with_palm_at(rig, {0.0, 0.02, 0.0}, Vec3::UnitY());
    ChainPatch patch;

    double penetration_m(FittedHand& hand) {
        return find_finger_clearance(hand.hands.front(), hand.surface.at(k_right).fitted_wrist_bs,
                                     patch)
            .penetration_m;
    }
};

TEST(SearchGrip, LeavesFingersRoom) {
    FingerClearance room;
    FittedHand hand(room.mesh, room.before_block);
    // Under the palm there is none.
    GripSurface under;
    under.normal_bs = Vec3::UnitY();
    const auto near = room.mesh.search_bvh.closest_point({0.0, 0.0, 0.0}, 0.1);
    ASSERT_TRUE(near);
    under.triangle = near->triangle;
    const Pose fitted_wrist_bs =
        fit_palm(hand.hands.front(), under, 0.0, hand.tuning.palm).wrist_bs;
    ASSERT_GT(find_finger_clearance(hand.hands.front(), fitted_wrist_bs, room.patch).penetration_m,
              0.005);
    hand.search();
    EXPECT_LE(room.penetration_m(hand), k_finger_penetration_tolerance_m);
}

// A gripping hand that is thrown farther than its room was known to reach, in the frame after its
// surface was judged, sees the block that it is thrown into in that frame: only small gaps are
// looked for where nothing can have come near.
TEST(SearchGrip, SeesWhatItIsThrownIntoInTheSameFrame) {
    constexpr double k_dt_s = 1.0 / 90.0;
    constexpr double k_beside_x_m = -0.27;
    FingerClearance room;
    for (const double thrown_m : {0.03, 0.04, 0.05, 0.06}) {
        const auto beside_block = [&](double x_m) {
            return wrist_with_palm_at(room.rig, {x_m, 0.02, -0.15}, Vec3::UnitY());
        };
        FittedHand hand(room.mesh, beside_block(k_beside_x_m));
        hand.search(k_dt_s);
        ASSERT_TRUE(hand.surface.at(k_right).evaluated_this_frame) << thrown_m;
        ASSERT_GT(hand.surface.at(k_right).clearance_recheck_in_m, 0.0) << thrown_m;
        ASSERT_LE(palm_sunk_m(hand), 1e-4) << thrown_m;
        hand.wrist_bs() = beside_block(k_beside_x_m + thrown_m);
        hand.search(k_dt_s);
        EXPECT_LE(palm_sunk_m(hand), 2e-3) << thrown_m;
    }
}

// So does a hand at rest that something is moved into.
TEST(SearchGrip, SeesWhatIsMovedIntoIt) {
    constexpr double k_dt_s = 1.0 / 90.0;
    const GripMesh floor = build_grip_mesh(test::make_floor_mesh());
    const GripMesh block = build_grip_mesh(*test::make_box_mesh({0.1, 0.06, 0.1}));
    const HandRig rig = builtin_hand_rig(HandSide::right);
    for (const double way_m : {0.03, 0.04, 0.05}) {
        FittedHand hand(floor, wrist_with_palm_at(rig, {0.013, 0.02, 0.007}, Vec3::UnitY()));
        HandSurroundings& around = hand.hands.front();
        around.meshes.push_back({&block, {Vec3(-0.16, 0.06, 0.0), Quat::Identity()}});
        hand.search(k_dt_s);
        ASSERT_GT(hand.surface.at(k_right).clearance_recheck_in_m, 0.0);
        ASSERT_LE(palm_sunk_m(hand), 1e-4);
        around.meshes.back().pose.position.x() += way_m;
        ++around.signature;
        for (int frame = 0; frame < 4; ++frame) {
            hand.search(k_dt_s);
        }
        EXPECT_LE(palm_sunk_m(hand), 1e-3) << way_m;
    }
}

// On a floor without end there is no other surface for fingers that point into it: the palm that
// would be clear alone is turned and moved until they are too, at once and from frame to frame.
TEST(SearchGrip, HoldsFingersClearWithThePalm) {
    constexpr double k_dt_s = 1.0 / 90.0;
    const GripMesh floor = build_grip_mesh(test::make_floor_mesh());
    const HandRig rig = builtin_hand_rig(HandSide::right);
    // The fingers point down into the floor, past what the palm's own capsules need.
    const Vec3 up = rotation_about(Vec3::UnitX(), -0.4) * Vec3::UnitY();
    const Pose wrist_bs = wrist_with_palm_at(rig, {0.013, 0.012, 0.007}, up);
    ChainPatch patch;
    const auto finger_penetration_m = [&](const FittedHand& hand) {
        return find_finger_clearance(hand.hands.front(), hand.surface.at(k_right).fitted_wrist_bs,
                                     patch)
            .penetration_m;
    };
    FittedHand at_once(floor, wrist_bs);
    GripSurface palm_alone;
    palm_alone.triangle = floor.search_bvh.closest_point({0.013, 0.0, 0.007}, 0.1)->triangle;
    const Pose alone_bs =
        fit_palm(at_once.hands.front(), palm_alone, 0.0, at_once.tuning.palm).wrist_bs;
    ASSERT_GT(find_finger_clearance(at_once.hands.front(), alone_bs, patch).penetration_m, 0.003);
    at_once.search();
    EXPECT_LE(finger_penetration_m(at_once), k_finger_penetration_tolerance_m);
    // In frames the palm alone is judged first, then with its fingers.
    FittedHand hand(floor, wrist_bs);
    hand.search(k_dt_s);
    EXPECT_TRUE(hand.surface.at(k_right).pending_finger_samples != FingerSamplePoses{});
    constexpr int k_soon = 2;
    for (int frame = 1; frame < 60; ++frame) {
        hand.search(k_dt_s);
        if (frame >= k_soon) {
            EXPECT_LE(finger_penetration_m(hand), k_finger_penetration_tolerance_m) << frame;
            EXPECT_TRUE(hand.surface.at(k_right).pending_finger_samples == FingerSamplePoses{})
                << frame;
        }
    }
}

// What is cheap and has room is taken in the first frame: nothing else is looked for, then or
// later.
TEST(SearchGrip, IsOverAtOnceOnAPlainFloor) {
    constexpr double k_dt_s = 1.0 / 90.0;
    const GripMesh floor = build_grip_mesh(test::make_floor_mesh());
    const HandRig rig = builtin_hand_rig(HandSide::right);
    FittedHand hand(floor, wrist_with_palm_at(rig, {0.013, 0.01, 0.007}, Vec3::UnitY()));
    for (int frame = 0; frame < 3; ++frame) {
        hand.search(k_dt_s);
        EXPECT_EQ(hand.surface.at(k_right).evaluated_count, 0U) << frame;
        EXPECT_EQ(hand.surface.at(k_right).candidate_recheck_in_m, 0.0) << frame;
        EXPECT_GT(hand.surface.at(k_right).clearance_recheck_in_m, 0.0) << frame;
    }
}

// In frames, a surface or two in each, a hand at rest comes to what it finds at once, and rests.
TEST(SearchGrip, LooksForRoomAFewSurfacesAFrame) {
    constexpr double k_dt_s = 1.0 / 90.0;
    FingerClearance room;
    FittedHand at_once(room.mesh, room.before_block);
    at_once.search();
    // The first surface, it with its fingers, the list of the others, the second.
    constexpr std::int32_t k_enough = 4;
    for (const std::int32_t tries : {1, 2, 3, k_enough}) {
        FittedHand hand(room.mesh, room.before_block);
        hand.tuning.palm.evaluations_per_frame = tries;
        hand.search(k_dt_s);
        EXPECT_EQ(room.penetration_m(hand) <= k_finger_penetration_tolerance_m, tries >= k_enough)
            << tries;
        for (int frame = 0; frame < 60; ++frame) {
            hand.constrain(test::k_at_once_s);
            hand.search(k_dt_s);
        }
        const GripSurface found = hand.surface.at(k_right);
        hand.constrain(test::k_at_once_s);
        EXPECT_LT((hand.shown_bs().position - found.fitted_wrist_bs.position).norm(), 1e-9);
        EXPECT_EQ(found.evaluated_count, 0U);
        EXPECT_LE(room.penetration_m(hand), k_finger_penetration_tolerance_m);
        EXPECT_LT(
            (found.fitted_wrist_bs.position - at_once.surface.at(k_right).fitted_wrist_bs.position)
                .norm(),
            5e-3);
        hand.search(k_dt_s);
        EXPECT_EQ(hand.surface.at(k_right).fitted_wrist_bs.position,
                  found.fitted_wrist_bs.position);
    }
}

// All around is looked at once, and what is to be tried is listed then, also where the hand goes on
// meanwhile; the list is gone through once.
TEST(SearchGrip, ListsWhatItIsToTryOnce) {
    constexpr double k_dt_s = 1.0 / 90.0;
    FingerClearance room;
    FittedHand hand(room.mesh, room.before_block);
    const GripSurface& surface = hand.surface.at(k_right);
    std::vector<std::uint32_t> listed;
    std::uint32_t tried = 0;
    int frames = 0;
    for (int frame = 0; frame < 60 && (frame < 2 || surface.evaluated_count > 0); ++frame) {
        hand.wrist_bs().position.x() += 2e-4;
        hand.search(k_dt_s);
        if (surface.evaluated_count > 0 && surface.candidate_count > 0) {
            const std::vector<std::uint32_t> now(
                surface.candidates.begin(), surface.candidates.begin() + surface.candidate_count);
            listed = listed.empty() ? now : listed;
            EXPECT_EQ(now, listed) << frame;
            EXPECT_GE(surface.evaluated_count, tried) << frame;
            EXPECT_LE(surface.evaluated_count, surface.candidate_count) << frame;
            tried = surface.evaluated_count;
            ++frames;
        }
    }
    EXPECT_EQ(surface.evaluated_count, 0U);
    EXPECT_EQ(surface.candidate_count, 0U);
    EXPECT_GT(listed.size(), 1U);
    EXPECT_GT(frames, 1);
}

// Along a ring the surface that is followed, searched for all around every few frames only, takes
// hardly more to be held to than the one that a search from the beginning finds.
TEST(SearchGrip, FollowsASurfaceAsWellAsItSearchesForOne) {
    constexpr double k_dt_s = 1.0 / 90.0;
    const GripMesh ring = build_grip_mesh(test::make_torus(0.12, 0.02, 60, 24));
    const HandRig rig = builtin_hand_rig(HandSide::right);
    const auto on_ring = [&](double turn_rad) {
        const Quat turn = rotation_about(Vec3::UnitY(), turn_rad);
        return Pose{Vec3::Zero(), turn} *
               wrist_with_palm_at(rig, {0.0, 0.028, 0.12}, Vec3::UnitY());
    };
    FittedHand hand(ring, on_ring(0.0));
    int followed = 0;
    for (int frame = 0; frame < 150; ++frame) {
        hand.wrist_bs() = on_ring(0.018 * frame);
        const double full_search_in_m = hand.surface.at(k_right).full_search_in_m;
        hand.search(k_dt_s);
        const GripSurface& surface = hand.surface.at(k_right);
        ASSERT_NE(surface.triangle, GripSurface::k_none) << frame;
        followed += surface.full_search_in_m < full_search_in_m ? 1 : 0;
        FittedHand afresh(ring, hand.wrist_bs());
        afresh.search();
        const auto sync_m = [&](const GripSurface& found) {
            return grip_sync(hand.wrist_bs(), found.fitted_wrist_bs, rig.palm_center_hs).palm_m;
        };
        EXPECT_LE(sync_m(surface), sync_m(afresh.surface.at(k_right)) + 3e-3) << frame;
    }
    EXPECT_GT(followed, 30);
    EXPECT_LT(followed, 120);  // and all around was searched in between
}

// A palm that goes on from where it was is pushed once a frame; at rest it is pushed on until it is
// as clear as one that is held afresh, and then it rests. Depths are find_penetration's.
TEST(SearchGrip, PalmThatComesToRestSettles) {
    constexpr double k_dt_s = 1.0 / 90.0;
    const GripMesh ring = build_grip_mesh(test::make_torus(0.12, 0.02, 60, 24));
    const HandRig rig = builtin_hand_rig(HandSide::right);
    test::Random random(7);
    int compared = 0;
    for (int i = 0; i < 60; ++i) {
        const double around_rad = random.between(0.0, 6.2);
        const double about_rad = random.between(0.0, 3.0);
        const Vec3 out(std::cos(around_rad), 0.0, std::sin(around_rad));
        const Vec3 up = std::cos(about_rad) * out + std::sin(about_rad) * Vec3::UnitY();
        FittedHand hand(ring, wrist_with_palm_at(rig, 0.12 * out + 0.035 * up, up));
        for (int frame = 0; frame < 60; ++frame) {
            hand.search(k_dt_s);
        }
        hand.wrist_bs().position += random.vector(0.01);
        for (int frame = 0; frame < 60; ++frame) {
            hand.search(k_dt_s);
        }
        FittedHand afresh(ring, hand.wrist_bs());
        afresh.search();
        if (hand.surface.at(k_right).triangle == GripSurface::k_none ||
            palm_sunk_m(afresh) > 1e-4) {
            continue;
        }
        ++compared;
        EXPECT_LE(palm_sunk_m(hand), 2e-4) << i;
        const Vec3 held = hand.surface.at(k_right).fitted_wrist_bs.position;
        hand.search(k_dt_s);
        EXPECT_EQ(hand.surface.at(k_right).fitted_wrist_bs.position, held) << i;
    }
    EXPECT_GT(compared, 30);
}

TEST(SearchGrip, PrefersTheOuterSideOfAPlate) {
    // Two sheets 6 mm apart: an upper side that looks up and an under side that looks down. A palm
    // over the plate is as near to either, but for the plate's thickness.
    Mesh plate = test::make_floor_mesh();
    const auto count = static_cast<std::uint32_t>(plate.positions.size());
    const std::size_t triangles = plate.triangles.size();
    for (std::uint32_t v = 0; v < count; ++v) {
        plate.positions.push_back(plate.positions[v] - Vec3(0.0, 0.006, 0.0));
    }
    for (std::size_t t = 0; t < triangles; ++t) {
        const auto [a, b, c] = plate.triangles[t];
        plate.triangles.push_back({count + a, count + c, count + b});
    }
    const GripMesh mesh = build_grip_mesh(plate);
    const HandRig rig = builtin_hand_rig(HandSide::right);
    for (const double height_m : {-0.004, 0.001, 0.01, 0.05}) {
        FittedHand hand(mesh, wrist_with_palm_at(rig, {0.011, height_m, 0.004}, Vec3::UnitY()));
        hand.search();
        const GripSurface& surface = hand.surface.at(k_right);
        EXPECT_NEAR(surface.point_bs.y(), 0.0, 1e-9) << height_m;
        EXPECT_GT(surface.normal_bs.y(), 0.99);
    }
}

TEST(SearchGrip, LeavesHandsOutOfReachWithoutASurfaceAndCountsThem) {
    const GripMesh mesh = build_grip_mesh(test::make_floor_mesh());
    const HandRig rig = builtin_hand_rig(HandSide::right);
    FittedHand hand(mesh, wrist_with_palm_at(rig, {0.0, 0.4, 0.0}, Vec3::UnitY()));
    hand.search();
    EXPECT_EQ(hand.surface.at(k_right).triangle, GripSurface::k_none);
    EXPECT_EQ(test::count_of(hand.stats, Fallback::palm_no_surface), 1U);
    hand.hands.front().body = k_no_entity;
    hand.hands.front().meshes.clear();
    hand.search();
    EXPECT_EQ(test::count_of(hand.stats, Fallback::palm_no_surface), 1U);  // empty: not a failure
}

}  // namespace
}  // namespace handhold::search_grip_test
