#include "game/render/robot_hand.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "game/commands/hand_export.hpp"
#include "game/render/hand_figures.hpp"
#include "systems/rigs/builtin_hand_rig.hpp"
#include "systems/rigs/hand_kinematics.hpp"
#include "systems/rigs/hand_rig_fit.hpp"

namespace handhold::robot_hand_test {
namespace {

double to_segment(const Vec3& point, const Vec3& b) {
    const double t = std::clamp(point.dot(b) / b.squaredNorm(), 0.0, 1.0);
    return (point - t * b).norm();
}

// Every edge occurs once in each direction.
bool is_closed(const Mesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& [a, b, c] : mesh.triangles) {
        ++edges[{a, b}];
        ++edges[{b, c}];
        ++edges[{c, a}];
    }
    return std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
        const auto back = edges.find({edge.first.second, edge.first.first});
        return back != edges.end() && back->second == edge.second;
    });
}

TEST(RobotHand, PartsAreClosedAndOnTheirLinks) {
    const HandRig rig = builtin_hand_rig(HandSide::right);
    const std::vector<HandPart> parts = make_robot_hand(rig);
    std::vector<std::size_t> counts(rig.fingers.size(), 0);
    bool has_palm = false;
    for (const HandPart& part : parts) {
        EXPECT_TRUE(is_closed(part.mesh)) << part.mesh.name;
        if (part.finger == RigJoint::k_palm) {
            has_palm = true;
            continue;
        }
        ++counts[static_cast<std::size_t>(part.finger)];
    }
    EXPECT_TRUE(has_palm);
    for (const std::size_t count : counts) {
        EXPECT_GE(count, 6U);  // shell and joint of three links
    }
}

// The capsules are what is fitted: parts must not protrude from them, and must fill them on the
// contact side.
TEST(RobotHand, FingersFillTheirCapsulesWithoutProtruding) {
    const HandRig rig = builtin_hand_rig(HandSide::right);
    std::vector<std::array<double, 3>> lowest(rig.fingers.size(), {0.0, 0.0, 0.0});
    for (const HandPart& part : make_robot_hand(rig)) {
        if (part.finger == RigJoint::k_palm) {
            continue;
        }
        const FingerRig& finger = rig.fingers[static_cast<std::size_t>(part.finger)];
        const double r = finger.radius_m[part.link];
        const Vec3 end(0.0, 0.0, -finger.length_m[part.link]);
        for (const Vec3& point : part.mesh.positions) {
            const double out_m = point.y() <= 0.0 ? 0.7e-3 : 1.5e-3;  // the back touches nothing
            EXPECT_LT(to_segment(point, end), r + out_m) << part.mesh.name << point.transpose();
        }
        double& low = lowest[static_cast<std::size_t>(part.finger)][part.link];
        for (const Vec3& point : part.mesh.positions) {
            low = std::min(low, point.y() / r);
        }
    }
    for (const std::array<double, 3>& of_links : lowest) {
        for (const double low : of_links) {
            EXPECT_NEAR(low, -1.0, 0.05);
        }
    }
}

TEST(RobotHand, LeftHandMirrorsTheRightOne) {
    const std::vector<HandPart> left = make_robot_hand(builtin_hand_rig(HandSide::left));
    const std::vector<HandPart> right = make_robot_hand(builtin_hand_rig(HandSide::right));
    ASSERT_EQ(left.size(), right.size());
    for (std::size_t i = 0; i < left.size(); ++i) {
        ASSERT_EQ(left[i].mesh.positions.size(), right[i].mesh.positions.size());
        if (left[i].finger != RigJoint::k_palm) {
            continue;
        }
        // A mirror reverses the winding, and vertices are in order of first use.
        for (const Vec3& l : left[i].mesh.positions) {
            double nearest_m = 1.0;
            for (const Vec3& r : right[i].mesh.positions) {
                nearest_m = std::min(nearest_m, (l - Vec3(-r.x(), r.y(), r.z())).norm());
            }
            EXPECT_NEAR(nearest_m, 0.0, 1e-12);
        }
    }
}

TEST(RobotHand, EveryRigGetsAHand) {
    HandRig rig = builtin_hand_rig(HandSide::right);
    rig.fingers = {rig.fingers[1], rig.fingers[4]};  // no thumb, two fingers of two bones
    for (FingerRig& finger : rig.fingers) {
        finger.link_count = 2;
    }
    for (const HandPart& part : make_robot_hand(rig)) {
        EXPECT_TRUE(is_closed(part.mesh)) << part.mesh.name;
        for (const Vec3& point : part.mesh.positions) {
            EXPECT_TRUE(is_finite(point));
        }
    }
}

TEST(ExportRobotHand, ReimportGivesTheSameRig) {
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        const HandRig rig = builtin_hand_rig(side);
        const Result<SkinnedMesh> skin = parse_gltf_skin(export_robot_hand(rig), "robot_hand.glb");
        ASSERT_TRUE(skin.ok()) << skin.error().message();
        const Result<HandRig> found = hand_rig_from_skin(skin.value(), side);
        ASSERT_TRUE(found.ok()) << found.error().message();
        ASSERT_EQ(found.value().fingers.size(), rig.fingers.size());
        for (std::size_t i = 0; i < rig.fingers.size(); ++i) {
            const FingerRig& a = rig.fingers[i];
            const FingerRig& b = found.value().fingers[i];
            for (std::size_t link = 0; link < 3; ++link) {
                EXPECT_NEAR(a.radius_m[link], b.radius_m[link], 1e-12);
                EXPECT_NEAR(a.lower_rad[link], b.lower_rad[link], 1e-6);
                EXPECT_EQ(a.upper_rad[link], b.upper_rad[link]);
            }
            for (const double share : {0.0, 0.5, 1.0}) {
                FingerAngles angles = coupled_angles(a, share);
                angles.opposition_rad = share * a.upper_opposition_rad;
                const auto points_a = finger_points(a, angles);
                const auto points_b = finger_points(b, angles);
                for (std::size_t k = 0; k < points_a.size(); ++k) {
                    EXPECT_NEAR((points_a[k] - points_b[k]).norm(), 0.0, 1e-4)
                        << finger_text(a.name);
                }
            }
        }
        EXPECT_NEAR((found.value().palm_center_hs - rig.palm_center_hs).norm(), 0.0, 1e-12);
        ASSERT_EQ(found.value().palm.size(), rig.palm.size());
        for (std::size_t i = 0; i < rig.palm.size(); ++i) {
            EXPECT_NEAR((found.value().palm[i].a_hs - rig.palm[i].a_hs).norm(), 0.0, 1e-12);
            EXPECT_EQ(found.value().palm[i].radius_m, rig.palm[i].radius_m);
        }
    }
}

TEST(ExportRobotHand, JointsAreChildrenOfTheJointsThatMoveThem) {
    const Result<SkinnedMesh> skin =
        parse_gltf_skin(export_robot_hand(builtin_hand_rig(HandSide::right)), "robot_hand.glb");
    ASSERT_TRUE(skin.ok());
    const auto name_above = [&](const std::string& name) {
        for (const SkinJoint& joint : skin.value().joints) {
            if (joint.name == name && joint.parent >= 0) {
                return skin.value().joints[static_cast<std::size_t>(joint.parent)].name;
            }
        }
        return std::string();
    };
    EXPECT_EQ(name_above("index-finger-tip"), "index-finger-phalanx-distal");
    EXPECT_EQ(name_above("index-finger-phalanx-distal"), "index-finger-phalanx-intermediate");
    EXPECT_EQ(name_above("index-finger-phalanx-proximal"), "index-finger-metacarpal");
    EXPECT_EQ(name_above("index-finger-metacarpal"), "wrist");
    EXPECT_EQ(name_above("thumb-metacarpal"), "wrist");
}

}  // namespace
}  // namespace handhold::robot_hand_test
