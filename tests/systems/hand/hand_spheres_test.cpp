#include "systems/hand/shared/hand_spheres.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "beam.hpp"
#include "engine/core/check.hpp"
#include "systems/rigs/hand_kinematics.hpp"

namespace handhold::hand_spheres_test {
namespace {

using test::FittedHand;
using test::k_right;
using test::wrist_with_palm_at;

// Over a floor in the plane y = 0, gaps are known in closed form.
struct HandSpheresOnFloor : testing::Test {
    GripMesh floor = build_grip_mesh(test::make_floor_mesh());
    const HandRig rig = builtin_hand_rig(HandSide::right);
    FittedHand hand{floor, wrist_with_palm_at(rig, {0.013, 0.01, 0.007}, Vec3::UnitY())};

    HandSpheresOnFloor() { hand.search(); }
    HandSpheres spheres() { return {hand.hands.front(), hand.surface.at(k_right), {}}; }
    HandPose pose_at(double height_m, double curl) const {
        HandPose pose = {wrist_with_palm_at(rig, {0.013, height_m, 0.007}, Vec3::UnitY()), {}};
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            pose.fingers[f] = coupled_angles(rig.fingers[f], curl);
        }
        return pose;
    }
    void query(HandSpheres& spheres, const HandPose& pose) const {
        spheres.query(pose, link_frames(rig, pose));
    }
};

TEST_F(HandSpheresOnFloor, LargestRigHasASphereAtEveryTip) {
    HandRig large = rig;
    large.palm.resize(k_max_palm_capsules, rig.palm.front());
    for (FingerRig& finger : large.fingers) {
        finger.length_m.fill(0.2);
    }
    HandSurroundings around = hand.hands.front();
    around.rig = &large;
    const HandSpheres all(around, hand.surface.at(k_right), {});
    for (std::size_t f = 0; f < large.fingers.size(); ++f) {
        const std::size_t last = large.fingers[f].link_count - 1;
        EXPECT_TRUE(std::ranges::any_of(all.all(), [&](const HandSphere& sphere) {
            return sphere.finger == static_cast<std::int32_t>(f) && sphere.link == last &&
                   std::abs(sphere.center_ls.z() + 0.2) < 1e-12;
        })) << f;
    }
    large.palm.push_back(rig.palm.front());
    EXPECT_THROW((HandSpheres{around, hand.surface.at(k_right), {}}), PreconditionError);
}

TEST_F(HandSpheresOnFloor, GapIsHeightLessRadius) {
    for (const double height_m : {0.002, 0.015, 0.03}) {
        for (const double curl : {0.0, 0.2, 0.6}) {
            HandSpheres all = spheres();
            query(all, pose_at(height_m, curl));
            int seen = 0;
            for (const HandSphere& sphere : all.all()) {
                const double gap_m = sphere.center.y() - sphere.radius_m;
                const bool is_shallow = sphere.center.y() > -0.02;
                if (sphere.has_gap && is_shallow) {
                    EXPECT_NEAR(sphere.gap_m, gap_m, 1e-9);
                    EXPECT_LT((sphere.away - Vec3::UnitY()).norm(), 1e-6);
                    ++seen;
                } else if (!sphere.is_extra && is_shallow) {
                    EXPECT_GT(gap_m, (sphere.is_tip ? k_tip_reach_m : k_sphere_reach_m) - 1e-9);
                }
            }
            EXPECT_GT(seen, 4);
        }
    }
}

// A sheet's winding alone says that a fingertip below it is outside again, once it faces the other
// way. Its path says that it went through.
TEST_F(HandSpheresOnFloor, CentreThatCrossesASheetIsInside) {
    for (const double winding : {1.0, -1.0}) {
        Mesh sheet = test::make_floor_mesh();
        for (auto& [a, b, c] : sheet.triangles) {
            if (winding < 0.0) {
                std::swap(b, c);
            }
        }
        const GripMesh mesh = build_grip_mesh(sheet);
        FittedHand over(mesh, hand.wrist_bs());
        over.search();
        HandSpheres all(over.hands.front(), over.surface.at(k_right), {});
        query(all, pose_at(0.1, 0.0));
        ASSERT_EQ(all.penetration_m(), 0.0);
        const HandPose low = pose_at(-0.005, 0.0);
        query(all, low);
        for (const HandSphere& sphere : all.all()) {
            if (sphere.has_gap && !sphere.is_extra) {
                EXPECT_NEAR(sphere.gap_m, sphere.center.y() - sphere.radius_m, 1e-9);
            }
        }
        EXPECT_GT(all.penetration_m(), 0.005);
    }
}

// Kept gaps must not hide a digit's nearest sphere, nor one about to touch. The beam's edges turn
// the nearest direction, which kept gaps do not see: a distance is convex along a path beside a
// convex solid, so its linearisation is too small by at most the path's length.
// A thumb that jumps across a beam ends on the side on which a first query finds it.
TEST_F(HandSpheresOnFloor, ThumbsThatJumpAcrossABeamKeepTheirSides) {
    const GripMesh beam = build_grip_mesh(test::make_beam());
    FittedHand over(beam, hand.wrist_bs());
    over.search();
    test::Random random(2512);
    int crossed = 0;
    int compared = 0;
    const auto thumb_at_random = [&] {
        const FingerRig& thumb = rig.fingers[0];
        FingerAngles angles = coupled_angles(thumb, random.between(0.0, 1.0));
        angles.opposition_rad =
            random.between(thumb.lower_opposition_rad, thumb.upper_opposition_rad);
        return angles;
    };
    for (int i = 0; i < 300; ++i) {
        HandPose pose = pose_at(random.between(-0.01, 0.03), 0.2);
        HandSpheres moving(over.hands.front(), over.surface.at(k_right), {});
        pose.fingers[0] = thumb_at_random();
        query(moving, pose);
        if (moving.penetration_m() > 0.0) {
            continue;  // starts inside
        }
        const std::vector<HandSphere> before(moving.all().begin(), moving.all().end());
        pose.fingers[0] = thumb_at_random();
        query(moving, pose);
        HandSpheres fresh(over.hands.front(), over.surface.at(k_right), {});
        query(fresh, pose);
        for (std::size_t k = 0; k < fresh.all().size(); ++k) {
            const HandSphere& now = moving.all()[k];
            if (now.finger != 0 || now.is_extra || !fresh.all()[k].has_gap || !now.has_gap) {
                continue;
            }
            const Pose& beam_bs = over.hands.front().meshes.front().pose;
            const bool meets = beam.contact_bvh
                                   .cast_ray(inverse_transform_point(beam_bs, before[k].center),
                                             inverse_transform_point(beam_bs, now.center))
                                   .has_value();
            crossed += meets && fresh.all()[k].gap_m > 0.0 ? 1 : 0;
            ++compared;
            EXPECT_NEAR(now.gap_m, fresh.all()[k].gap_m, 1.3e-3) << i << ", sphere " << k;
        }
    }
    EXPECT_GT(crossed, 5);
    EXPECT_GT(compared, 300);
}

TEST_F(HandSpheresOnFloor, KeptGapsLeaveTheNearestOnesClose) {
    constexpr double k_kept_path_m = 1.2e-3;
    const GripMesh beam = build_grip_mesh(test::make_beam());
    FittedHand over(beam, hand.wrist_bs());
    over.search();
    const auto all_over = [&] {
        return HandSpheres(over.hands.front(), over.surface.at(k_right), {});
    };
    test::Random random(2504);
    int kept = 0;
    for (int i = 0; i < 30; ++i) {
        const double height_m = random.between(0.015, 0.03);
        HandPose pose = pose_at(height_m, random.between(0.0, 0.4));
        HandSpheres moving = all_over();
        query(moving, pose);
        for (int step = 0; step < 4; ++step) {
            pose.wrist_bs.position += random.vector(0.003);
            for (FingerAngles& angles : pose.fingers) {
                angles.curl_rad[1] += random.between(-0.05, 0.05);
            }
            query(moving, pose);
            HandSpheres fresh = all_over();
            query(fresh, pose);
            for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
                if (moving.gap_m(f) > 0.0 && std::isfinite(fresh.gap_m(f))) {
                    EXPECT_LE(moving.gap_m(f), fresh.gap_m(f) + 1e-12) << i << ", finger " << f;
                    EXPECT_GE(moving.gap_m(f), fresh.gap_m(f) - k_kept_path_m) << i;
                }
            }
            for (std::size_t k = 0; k < fresh.all().size(); ++k) {
                const HandSphere& sphere = moving.all()[k];
                kept += sphere.center != sphere.searched_center ? 1 : 0;
                if (!sphere.is_extra && fresh.all()[k].has_gap && fresh.all()[k].gap_m < 3e-3 &&
                    moving.penetration_m() == 0.0) {
                    EXPECT_NEAR(sphere.gap_m, fresh.all()[k].gap_m, k_kept_path_m) << i;
                }
            }
        }
    }
    EXPECT_GT(kept, 300);
}

TEST_F(HandSpheresOnFloor, FingerGapIsThatOfItsNearestSphere) {
    HandSpheres all = spheres();
    const HandPose pose = pose_at(0.012, 0.1);
    query(all, pose);
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        double gap_m = std::numeric_limits<double>::infinity();
        for (const HandSphere& sphere : all.all()) {
            if (sphere.has_gap && sphere.finger == static_cast<std::int32_t>(f)) {
                gap_m = std::min(gap_m, sphere.gap_m);
            }
        }
        EXPECT_EQ(all.gap_m(f), gap_m);
    }
}

}  // namespace
}  // namespace handhold::hand_spheres_test
