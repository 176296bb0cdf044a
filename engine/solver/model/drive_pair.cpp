// Sources: swing and twist as in Dobrowolski, Swing-twist decomposition in Clifford algebra (2015).
#include "engine/solver/model/drive_pair.hpp"

namespace handhold {
namespace {

constexpr double k_no_line_m = 1e-6;

}  // namespace

Quat rotation_by_two_hands(const TwoHands& hands, const Quat& near) {
    const Vec3 apart = hands.second.position - hands.first.position;
    const Vec3 apart_bs = hands.second_anchor_bs.position - hands.first_anchor_bs.position;
    if (apart.norm() < k_no_line_m || apart_bs.norm() < k_no_line_m) {
        return near;
    }
    // Direction first, twist second: turning about the line keeps the direction.
    const Vec3 line = apart.normalized();
    const Quat lined = rotation_between((near * apart_bs).normalized(), line) * near;
    double sine = 0.0;
    double cosine = 0.0;
    const auto add = [&](const Quat& hand, const Quat& anchor_bs) {
        const Quat error = hand * (lined * anchor_bs).conjugate();
        const double sign = error.w() < 0.0 ? -1.0 : 1.0;
        sine += sign * error.vec().dot(line);
        cosine += sign * error.w();
    };
    add(hands.first.rotation, hands.first_anchor_bs.rotation);
    add(hands.second.rotation, hands.second_anchor_bs.rotation);
    // Half-angle vectors of equal length: their sum points half way between them.
    return (rotation_about(line, 2.0 * arc_tangent2(sine, cosine)) * lined).normalized();
}

}  // namespace handhold
