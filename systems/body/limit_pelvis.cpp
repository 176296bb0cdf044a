#include "systems/body/limit_pelvis.hpp"

#include "engine/core/parallel.hpp"
#include "engine/math/scalar_rotation.hpp"

namespace handhold {
namespace {

void turn_bone(const Quat& turn, const Vec3& centre, Pose& bone) {
    bone = {centre + turn * (bone.position - centre), (turn * bone.rotation).normalized()};
}

// Turns pelvis and legs about a point.
void turn_below_spine(const Quat& turn, const Vec3& centre, SpinePose& pose) {
    turn_bone(turn, centre, pose.pelvis_ws);
    for (SpinePose::Leg& leg : pose.legs) {
        turn_bone(turn, centre, leg.thigh_ws);
        turn_bone(turn, centre, leg.shin_ws);
        turn_bone(turn, centre, leg.foot_ws);
    }
}

// Turns spine and legs about the chest.
void turn_below_chest(const Quat& turn, SpinePose& pose) {
    const Vec3 chest = pose.chest_ws.position;
    for (Pose& link : pose.spine_ws) {
        turn_bone(turn, chest, link);
    }
    turn_below_spine(turn, chest, pose);
}

// Turns pelvis and legs about the pelvis' origin until the line from the left to the right hip is
// at most `most_rad` from `before_ws`.
void turn_hips(const Vec3& before_ws, double most_rad, SpinePose& pose) {
    constexpr double k_parallel = 1e-12;
    const Vec3 line = pose.legs[1].thigh_ws.position - pose.legs[0].thigh_ws.position;
    const Vec3 normal = line.cross(before_ws);
    const double length = normal.norm();
    const double angle_rad = arc_tangent2(length, line.dot(before_ws));
    if (angle_rad > most_rad && length > k_parallel) {
        const Quat turn = rotation_about(normal / length, angle_rad - most_rad);
        turn_below_spine(turn, pose.pelvis_ws.position, pose);
    }
}

void limit_pelvis_of(const LimitPelvisIo& io, std::size_t index) {
    const Entity player = io.pose.owners()[index];
    SpinePose& pose = io.pose.elements()[index];
    SpineMemory& memory = io.memory.at(player);
    ShownJoint& pelvis = memory.pelvis;
    const auto& [origin_ws, scale] = io.origin.at(player);
    const Mat3 to_ws = origin_ws.rotation.toRotationMatrix();
    const Vec3 wanted_m = to_ws.transpose() * (pose.pelvis_ws.position - pose.chest_ws.position);
    if (!pelvis.known) {
        pelvis = {true, wanted_m, wanted_m, Vec3::Zero()};
        return;
    }
    const Vec3 limited_m = shown_at(
        wanted_m, limited_mps(wanted_m, k_pelvis_limits, scale, io.dt_s, pelvis), io.dt_s, pelvis);
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
    turn_hips(to_ws * (memory.hips_m[1] - memory.hips_m[0]), k_hips_radps * io.dt_s, pose);
}

}  // namespace

void limit_pelvis(const LimitPelvisIo& io) {
    constexpr std::size_t k_players_per_slice = 32;
    parallel_each(io.pose.size(), k_players_per_slice,
                  [&io](std::size_t index) { limit_pelvis_of(io, index); });
}

}  // namespace handhold
