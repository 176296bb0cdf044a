#include "systems/body/shared/fold_body.hpp"

#include <algorithm>
#include <cmath>

namespace handhold {
namespace {

// Lean of each link / lean of the trunk, from the top down.
constexpr std::array<double, k_spine_links> k_lean_share = {0.5, 0.85, 1.0};
constexpr double k_max_lean_rad = 2.0;

// Height of the ankle above a flat sole.
constexpr double k_ankle_m = 0.085;
// Legs start to fold when the hip is this high above the ankle, and are fully folded at a height
// lower by the width.
constexpr double k_fold_from_m = 0.76;
constexpr double k_fold_width_m = 0.10;
constexpr double k_squat_shin_rad = 0.87;  // a squatting shin leans forward by at most this
constexpr double k_toes_kneeling_rad = -1.3;

// Maximum of x and `floor`. A parabola replaces the corner, `width` to either side, so that the
// slope is continuous.
double smooth_max(double x, double floor, double width) {
    const double over = x - floor + width;
    if (over <= 0.0) {
        return floor;
    }
    return over >= 2.0 * width ? x : floor + over * over / (4.0 * width);
}

// Height of the chest above the pelvis if link i, of length L_i, leans by a_i = k_lean_share[i] *
// lean_rad relative to the chest: the sum of L_i (up_y cos a_i - up_z sin a_i). (up_y, up_z): the
// floor's normal in the chest's axes.
double trunk_drop_m(double up_y, double up_z, double lean_rad) {
    double drop_m = 0.0;
    for (std::size_t i = 0; i < k_spine_links; ++i) {
        double sine = 0.0;
        double cosine = 1.0;
        sin_cos(k_lean_share[i] * lean_rad, sine, cosine);
        drop_m += k_spine_link_m[i] * (up_y * cosine - up_z * sine);
    }
    return drop_m;
}

double arc_cosine(double cosine) {
    const double c = std::clamp(cosine, -1.0, 1.0);
    return arc_tangent2(std::sqrt(1.0 - c * c), c);
}

double hip_to_ankle_m(double pelvis_m, double up_y, double ankle_m) {
    return pelvis_m - k_hip_below_m * up_y - ankle_m;
}

}  // namespace

TrunkFold fold_trunk(double chest_m, const Vec3& up_cs) {
    constexpr int k_halvings = 30;
    // A chest that leans back counts as upright here; back_rad accounts for its lean below.
    const double up_z = std::max(up_cs.z(), 0.0);
    const double up_y = std::max(up_cs.y(), 0.2);
    const double straight_m = chest_m - trunk_drop_m(up_y, up_z, 0.0);
    const double pelvis_m = smooth_max(straight_m, k_seat_m, k_seat_width_m);
    TrunkFold fold;
    if (pelvis_m == straight_m) {
        return fold;
    }
    double low = 0.0;
    double high = k_max_lean_rad;
    for (int i = 0; i < k_halvings; ++i) {
        const double middle = 0.5 * (low + high);
        (chest_m - trunk_drop_m(up_y, up_z, middle) < pelvis_m ? low : high) = middle;
    }
    const double back_rad = arc_tangent2(std::max(-up_cs.z(), 0.0), up_y);
    fold.lean_rad = low + back_rad * smooth_step(low, 0.0, 0.5);
    double above = 0.0;
    for (std::size_t i = 0; i < k_spine_links; ++i) {
        fold.bend_rad[i] = (k_lean_share[i] - above) * fold.lean_rad;
        above = k_lean_share[i];
    }
    return fold;
}

// E = k_thigh_m cos t + k_shin_m cos s, where E is the height of the hip above the ankle, t the
// thigh's angle forward of the vertical, and s the shin's backward angle. A kneeling leg has t = s.
// The shin of a squatting leg leans less, so that the feet stay flat below the body. `kneel` blends
// between squatting and kneeling.
LegFold fold_legs(double pelvis_m, const Vec3& up_pelvis, double lean_rad) {
    const double kneel = smooth_step(lean_rad, 1.35, 1.85);
    // Between squatting and kneeling the toes pass below the ankle, so the ankle is raised.
    const double ankle_m = k_ankle_m + 0.36 * kneel * (1.0 - kneel) * 0.25;
    const double height_m = hip_to_ankle_m(pelvis_m, up_pelvis.y(), ankle_m);
    const double fold = smooth_step(k_fold_from_m - height_m, 0.0, k_fold_width_m);
    if (!(fold > 0.0)) {
        return {};
    }
    const double cosine = std::clamp(height_m / (k_thigh_m + k_shin_m), 0.0, 1.0);
    const double squat_rad = k_squat_shin_rad * std::sqrt(1.0 - cosine * cosine);
    const double shin_rad = squat_rad + kneel * (arc_cosine(cosine) - squat_rad);
    double sine_shin = 0.0;
    double cosine_shin = 1.0;
    sin_cos(shin_rad, sine_shin, cosine_shin);
    const double thigh_rad = arc_cosine((height_m - k_shin_m * cosine_shin) / k_thigh_m);
    static const double k_thigh_rest_rad = arc_tangent2(k_thigh_rest_forward, 1.0);
    static const double k_knee_rest_rad = arc_tangent2(k_shin_rest_back, 1.0);
    const double pelvis_lean_rad = arc_tangent2(up_pelvis.z(), up_pelvis.y());
    const double toes_rad = shin_rad + kneel * (k_toes_kneeling_rad - shin_rad);
    return {fold * (thigh_rad + pelvis_lean_rad - k_thigh_rest_rad),
            fold * (thigh_rad + shin_rad - k_knee_rest_rad), fold * (toes_rad - k_toes_rest_rad)};
}

bool legs_fold(double pelvis_m) { return hip_to_ankle_m(pelvis_m, 1.0, k_ankle_m) < k_fold_from_m; }

}  // namespace handhold
