#include "components/hand_rig_fit.hpp"

#include "components/hand_skeleton_fit.hpp"

namespace handhold {
namespace {

// The joints a finger's links carry, so that at the bind angles they stand as in the file.
void add_finger_joints(const SkinnedMesh& skin, const FingerBones& bones, const Pose& to_hand,
                       HandRigFit& fit) {
    const std::size_t place = fit.rig.fingers.size() - 1;
    const std::array<Pose, k_most_links> frames =
        finger_link_frames(fit.rig.fingers[place], fit.bind[place]);
    const auto add = [&](std::size_t joint, std::uint32_t link) {
        fit.rig.joints[joint].finger = static_cast<std::int32_t>(place);
        fit.rig.joints[joint].link = link;
        fit.rig.joints[joint].joint_in_link =
            inverse(frames[link]) * (to_hand * skin.joints[joint].bind_ms);
    };
    for (std::uint32_t link = 0; link < bones.hinges.size(); ++link) {
        add(bones.hinges[link], link);
    }
    add(bones.tip, static_cast<std::uint32_t>(bones.hinges.size()) - 1);
}

// Other joints below a finger's (a nail, a twist) go where those go.
void carry_other_joints(const SkinnedMesh& skin, HandRigFit& fit) {
    std::vector<RigJoint>& joints = fit.rig.joints;
    for (std::size_t i = 0; i < joints.size(); ++i) {
        std::int32_t above = static_cast<std::int32_t>(i);
        while (above != -1 && joints[static_cast<std::size_t>(above)].finger == RigJoint::k_palm) {
            above = skin.joints[static_cast<std::size_t>(above)].parent;
        }
        if (above == -1 || above == static_cast<std::int32_t>(i)) {
            continue;
        }
        const RigJoint& carrier = joints[static_cast<std::size_t>(above)];
        const std::size_t place = static_cast<std::size_t>(carrier.finger);
        joints[i].finger = carrier.finger;
        joints[i].link = carrier.link;
        joints[i].joint_in_link =
            inverse(finger_link_frames(fit.rig.fingers[place], fit.bind[place])[carrier.link]) *
            joints[i].joint_in_link;
    }
}

}  // namespace

Result<HandRigFit> fit_hand_rig(const SkinnedMesh& skin, HandSide side) {
    const Result<HandBones> bones = find_hand_bones(skin);
    if (!bones) {
        return bones.error();
    }
    const Result<Pose> hand = find_hand_frame(skin, bones.value(), side);
    if (!hand) {
        return hand.error();
    }
    HandRigFit fit;
    fit.hand_ms = hand.value();
    fit.rig.side = side;
    const Pose to_hand = inverse(fit.hand_ms);
    for (const SkinJoint& joint : skin.joints) {  // all by the palm at first
        fit.rig.joints.push_back({joint.name, RigJoint::k_palm, 0, to_hand * joint.bind_ms});
    }
    for (const FingerBones& finger : bones.value().fingers) {
        std::vector<Pose> joints_hs;
        for (const std::size_t hinge : finger.hinges) {
            joints_hs.push_back(to_hand * skin.joints[hinge].bind_ms);
        }
        joints_hs.push_back(to_hand * skin.joints[finger.tip].bind_ms);
        fit.rig.fingers.push_back(
            fit_finger(finger, joints_hs, side, fit.bind[fit.rig.fingers.size()]));
        add_finger_joints(skin, finger, to_hand, fit);
    }
    carry_other_joints(skin, fit);
    std::vector<Vec3> positions_hs;
    positions_hs.reserve(skin.positions.size());
    for (const Vec3& position : skin.positions) {
        positions_hs.push_back(transform_point(to_hand, position));
    }
    fit_hand_skin(skin, positions_hs, fit);
    return fit;
}

Result<HandRig> hand_rig_from_skin(const SkinnedMesh& skin, HandSide side) {
    Result<HandRigFit> fit = fit_hand_rig(skin, side);
    if (!fit) {
        return fit.error();
    }
    return std::move(fit.value().rig);
}

}  // namespace handhold
