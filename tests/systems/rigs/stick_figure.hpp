#pragma once

#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "components/render.hpp"
#include "engine/io/gltf_skin.hpp"
#include "tests/random.hpp"

// A stick figure with named joints, and poses to draw it in.
namespace handhold::test {

// A stick figure in T-pose, scaled and turned about Y, with random joint axes.
struct StickFigure {
    SkinnedMesh figure;

    explicit StickFigure(double scale = 1.0, double yaw_rad = 0.0, unsigned seed = 1) {
        Random random(seed);
        const Pose stand{Vec3(3.0, 0.0, -2.0), rotation_about(Vec3::UnitY(), yaw_rad)};
        const auto add = [&](const char* name, std::int32_t parent, const Vec3& at) {
            figure.joints.push_back(
                {name, parent, {transform_point(stand, scale * at), random.rotation()}, {}});
            figure.positions.push_back(figure.joints.back().bind_ms.position);
            figure.weights.push_back(
                {{static_cast<std::uint16_t>(figure.joints.size() - 1), 0, 0, 0}, {1, 0, 0, 0}});
            return static_cast<std::int32_t>(figure.joints.size()) - 1;
        };
        figure.file = "sticks.glb";
        const auto root = add("root", -1, Vec3::Zero());
        const auto hips = add("Hips", root, Vec3(0, 0.95, 0));
        const auto spine = add("Spine", hips, Vec3(0, 1.2, 0));
        const auto neck = add("Neck", spine, Vec3(0, 1.5, 0));
        const auto head = add("Head", neck, Vec3(0, 1.6, 0));
        add("LeftEye", head, Vec3(-0.03, 1.68, -0.08));
        add("RightEye", head, Vec3(0.03, 1.68, -0.08));
        for (const double x : {-1.0, 1.0}) {
            const std::string side = x < 0.0 ? "Left" : "Right";
            const auto name = [&](const char* bone) { return side + bone; };
            const auto collar = add(name("Shoulder").c_str(), spine, Vec3(x * 0.04, 1.45, 0));
            const auto arm = add(name("Arm").c_str(), collar, Vec3(x * 0.2, 1.45, 0));
            const auto elbow = add(name("ForeArm").c_str(), arm, Vec3(x * 0.5, 1.45, 0));
            const auto hand = add(name("Hand").c_str(), elbow, Vec3(x * 0.8, 1.45, 0));
            add(name("HandMiddle1").c_str(), hand, Vec3(x * 0.9, 1.45, 0));
            const auto thigh = add(name("UpLeg").c_str(), hips, Vec3(x * 0.1, 0.9, 0));
            const auto shin = add(name("Leg").c_str(), thigh, Vec3(x * 0.1, 0.5, 0));
            const auto foot = add(name("Foot").c_str(), shin, Vec3(x * 0.1, 0.1, 0));
            add(name("ToeBase").c_str(), foot, Vec3(x * 0.1, 0.0, -0.1));
        }
    }
    std::size_t joint(const std::string& name) const {
        for (std::size_t i = 0; i < figure.joints.size(); ++i) {
            if (figure.joints[i].name == name) {
                return i;
            }
        }
        ADD_FAILURE() << name;
        return 0;
    }
};

// A random pose; the bones need not be connected.
inline RenderPose any_pose(unsigned seed) {
    Random random(seed);
    RenderPose render;
    render.head_ws = random.pose(2.0);
    render.spine.chest_ws = random.pose(2.0);
    render.spine.pelvis_ws = random.pose(2.0);
    for (Pose& link : render.spine.spine_ws) {
        link = random.pose(2.0);
    }
    for (SpinePose::Leg& leg : render.spine.legs) {
        leg = {random.pose(2.0), random.pose(2.0), random.pose(2.0)};
    }
    for (ArmPose::Arm& arm : render.arms.arms) {
        arm = {random.pose(2.0), random.pose(2.0), random.pose(2.0), random.pose(2.0)};
    }
    return render;
}

inline void expect_at(const Vec3& found, const Vec3& wanted, const char* what) {
    EXPECT_NEAR((found - wanted).norm(), 0.0, 1e-9) << what;
}

}  // namespace handhold::test
