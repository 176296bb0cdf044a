// Solver, model: the rotation that two drives give one body.
// Source: swing-twist decomposition as in Dobrowolski, Swing-twist decomposition in Clifford
// algebra (2015).
#include "engine/solver/model/drive_pair.hpp"

namespace handhold {
namespace {

constexpr double k_min_line_m = 1e-6;

}  // namespace

Quat rotation_from_drive_pair(const DrivePair& drives, const Quat& near) {
    const Vec3 apart = drives.second.position - drives.first.position;
    const Vec3 apart_bs = drives.second_anchor_bs.position - drives.first_anchor_bs.position;
    if (apart.norm() < k_min_line_m || apart_bs.norm() < k_min_line_m) {
        return near;
    }
    // Aligns the direction first, then the twist: a rotation about the line does not change the
    // direction.
    const Vec3 line = apart.normalized();
    const Quat lined = rotation_between((near * apart_bs).normalized(), line) * near;
    double sine = 0.0;
    double cosine = 0.0;
    const auto add = [&](const Quat& drive, const Quat& anchor_bs) {
        const Quat error = drive * (lined * anchor_bs).conjugate();
        const double sign = error.w() < 0.0 ? -1.0 : 1.0;
        sine += sign * error.vec().dot(line);
        cosine += sign * error.w();
    };
    add(drives.first.rotation, drives.first_anchor_bs.rotation);
    add(drives.second.rotation, drives.second_anchor_bs.rotation);
    // The two sums are the sine and cosine of half the twist of each drive, weighted by the cosine
    // of half the drive's swing. Their angle is half of the mean twist: closer to the drive that
    // swings less.
    return (rotation_about(line, 2.0 * arc_tangent2(sine, cosine)) * lined).normalized();
}

}  // namespace handhold
