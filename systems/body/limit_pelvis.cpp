#include "systems/body/limit_pelvis.hpp"

#include "engine/math/scalar_rotation.hpp"

namespace handhold {
namespace {

// Turns spine and legs about the chest.
void turn_below_chest(const Quat& turn, SpinePose& pose) {
    const Vec3 chest = pose.chest_ws.position;
    const auto turn_bone = [&](Pose& bone) {
        bone = {chest + turn * (bone.position - chest), (turn * bone.rotation).normalized()};
    };
    for (Pose& link : pose.spine_ws) {
        turn_bone(link);
    }
    turn_bone(pose.pelvis_ws);
    for (SpinePose::Leg& leg : pose.legs) {
        turn_bone(leg.thigh_ws);
        turn_bone(leg.shin_ws);
        turn_bone(leg.foot_ws);
    }
}

}  // namespace

void limit_pelvis(const LimitPelvisIo& io) {
    for (std::size_t index = 0; index < io.pose.size(); ++index) {
        const Entity player = io.pose.owners()[index];
        SpinePose& pose = io.pose.elements()[index];
        ShownJoint& pelvis = io.memory.at(player).pelvis;
        const auto& [origin_ws, scale] = io.origin.at(player);
        const Mat3 to_ws = origin_ws.rotation.toRotationMatrix();
        const Vec3 wanted_m =
            to_ws.transpose() * (pose.pelvis_ws.position - pose.chest_ws.position);
        if (!pelvis.known) {
            pelvis = {true, wanted_m, wanted_m, Vec3::Zero()};
            continue;
        }
        const Vec3 limited_m =
            shown_at(wanted_m, limited_mps(wanted_m, k_pelvis_limits, scale, io.dt_s, pelvis),
                     io.dt_s, pelvis);
        Vec3 shown_m = wanted_m;
        const double wanted_length_m = wanted_m.norm();
        const double limited_length_m = limited_m.norm();
        constexpr double k_shortest_m = 1e-6;
        if (limited_m != wanted_m && wanted_length_m > k_shortest_m &&
            limited_length_m > k_shortest_m) {
            shown_m = limited_m * (wanted_length_m / limited_length_m);
            turn_below_chest(rotation_between(to_ws * (wanted_m / wanted_length_m),
                                              to_ws * (limited_m / limited_length_m)),
                             pose);
        }
        pelvis = {true, wanted_m, shown_m, (shown_m - pelvis.shown_m) / io.dt_s};
    }
}

}  // namespace handhold
