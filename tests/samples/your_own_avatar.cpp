// The guide's avatar: a player's sizes, joints of hands and body, and skeletons from glTF files.
// usage: sample_your_own_avatar [HAND.glb [FIGURE.glb]]
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <vector>

#include <handhold/handhold.hpp>

namespace {

double distance_m(const hh::Vec3& a, const hh::Vec3& b) {
    return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

// [file]
// The whole file; the library takes .glb, and .gltf with its data inside.
std::vector<char> bytes_of(const char* path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

bool use_files(hh::World& world, hh::Player player, const char* hand, const char* figure) {
    const std::vector<char> hand_bytes = bytes_of(hand);
    const std::vector<char> figure_bytes = bytes_of(figure);
    const hh::Status hand_read =
        hh_player_set_hand_rig(world.get(), player, HH_RIGHT, hand_bytes.data(), hand_bytes.size());
    const hh::Status figure_read =
        hh_player_set_body_rig(world.get(), player, figure_bytes.data(), figure_bytes.size());
    return hand_read && figure_read;  // else hh_last_error() names what the file lacks
}
// [file]

// [array]
// One joint of the engine's skeleton, in its bind pose (T-pose or A-pose).
struct EngineBone {
    const char* name;
    int parent;  // -1: a root
    hh::Pose bind;
};

bool use_skeleton(hh::World& world, hh::Player player, const std::vector<EngineBone>& bones) {
    std::vector<hh_skeleton_joint> joints;
    for (const EngineBone& bone : bones) {
        joints.push_back({bone.name, bone.parent, HH_IS_BY_NAME, bone.bind});
    }
    // A name that nobody can guess: joints[i].is = HH_IS_BODY + HH_LEFT_UPPER_ARM, or
    // HH_IS_LEFT_HAND + HH_INDEX_PROXIMAL.
    if (!world.set_body_skeleton(player, joints, HH_SPACE_PARENT)) {
        return false;  // hh_last_error() names the joints
    }
    // After each step: the poses of your joints, in the order in which you gave them.
    std::vector<hh::Pose> posed(bones.size());
    return static_cast<bool>(world.skeleton(player, HH_SPACE_PARENT, posed));
}
// [array]

// A figure with the names of Unreal's mannequin.
std::vector<EngineBone> any_bones() {
    const auto at = [](double x, double y) { return hh::pose_at({x, y, 0.0}); };
    std::vector<EngineBone> bones = {{"pelvis", -1, at(0.0, 1.0)}, {"head", 0, at(0.0, 0.65)}};
    for (const double out : {-1.0, 1.0}) {
        const bool is_left = out < 0.0;
        int above = 0;
        const auto add = [&](const char* left, const char* right, hh::Pose bind) {
            bones.push_back({is_left ? left : right, above, bind});
            above = static_cast<int>(bones.size()) - 1;
        };
        add("upperarm_l", "upperarm_r", at(0.2 * out, 0.45));
        add("lowerarm_l", "lowerarm_r", at(0.28 * out, 0.0));
        add("hand_l", "hand_r", at(0.26 * out, 0.0));
        above = 0;
        add("thigh_l", "thigh_r", at(0.1 * out, -0.08));
        add("calf_l", "calf_r", at(0.0, -0.42));
        add("foot_l", "foot_r", at(0.0, -0.42));
    }
    return bones;
}

}  // namespace

int main(int argc, char** argv) {
    hh::World world;
    // [player]
    hh_player_def you = hh::player_def();
    you.name = "you";
    you.measures.eye_height_m = 1.55;
    you.measures.forearm_m = 0.26;
    const hh::Player player = *world.add(you);
    // [player]
    for (int frame = 1; frame <= 30; ++frame) {
        hh::Sample sample = hh::sample();
        sample.time_s = frame / 90.0;
        sample.head.position = {0.0, 1.55, 0.0};
        sample.hands[HH_LEFT].position = {-0.2, 1.2, -0.35};
        sample.hands[HH_RIGHT].position = {0.2, 1.2, -0.35};
        if (!world.step(1.0 / 90.0, hh::input(player, {&sample, 1}))) {
            return 1;
        }
    }
    // [joints]
    // In the parent's frame, as skeletons want it; HH_SPACE_WORLD gives what debug lines want.
    const hh::World::BodyJoints body = *world.body_joints(player, HH_SPACE_PARENT);
    for (std::size_t joint = 0; joint < body.size(); ++joint) {
        std::printf("%-14s (%3.2f %3.2f %3.2f)\n", hh_body_joint_name(joint),
                    body[joint].position.x, body[joint].position.y, body[joint].position.z);
    }
    // 26 joints with the numbers of XR_EXT_hand_tracking: 1 is the wrist, 10 the index finger's
    // tip.
    const hh::World::HandJoints hand = *world.hand_joints(player, HH_RIGHT, HH_SPACE_WORLD);
    // [joints]
    if (argc > 2 && !use_files(world, player, argv[1], argv[2])) {
        std::printf("%s\n", hh_last_error());
        return 1;
    }
    if (!use_skeleton(world, player, any_bones())) {
        std::printf("%s\n", hh_last_error());
        return 1;
    }
    const hh::World::BodyJoints world_joints = *world.body_joints(player, HH_SPACE_WORLD);
    const hh_hand_state shown = *world.hand(player, HH_RIGHT);
    const double forearm_m =
        distance_m(world_joints[HH_RIGHT_LOWER_ARM].position, world_joints[HH_RIGHT_HAND].position);
    const double wrist_m = distance_m(hand[1].pose.position, shown.shown.position);
    const double finger_m = distance_m(hand[1].pose.position, hand[10].pose.position);
    std::printf("forearm %.4f m, wrist off by %.1e m, wrist to index tip %.3f m\n", forearm_m,
                wrist_m, finger_m);
    const bool is_right =
        std::fabs(forearm_m - 0.26) < 1e-6 && wrist_m < 1e-12 && finger_m > 0.08 && finger_m < 0.25;
    return is_right ? 0 : 1;
}
