#include "systems/body/shared/spine_chain.hpp"

#include <cmath>

namespace handhold {

const std::array<SpineLink, k_body_links>& spine_links() {
    const auto leg_down = [](double x, double forward) {
        return Vec3(x, -1.0, -forward).normalized();
    };
    const Vec3 left_hip(-k_hip_aside_m, -k_hip_below_m, 0.0);
    const Vec3 right_hip(k_hip_aside_m, -k_hip_below_m, 0.0);
    const Vec3 shin_rest = leg_down(0.0, -k_shin_rest_back);
    static const std::array<SpineLink, k_body_links> list = {{
        {SpineLinkKind::spine, k_chest_link, k_spine_link_m[0], Vec3::Zero(), -Vec3::UnitY()},
        {SpineLinkKind::spine, 0, k_spine_link_m[1], Vec3::Zero(), -Vec3::UnitY()},
        {SpineLinkKind::spine, 1, k_spine_link_m[2], Vec3::Zero(), -Vec3::UnitY()},
        {SpineLinkKind::thigh, 2, k_thigh_m, left_hip, leg_down(-0.05, k_thigh_rest_forward)},
        {SpineLinkKind::shin, 3, k_shin_m, Vec3::Zero(), shin_rest},
        {SpineLinkKind::thigh, 2, k_thigh_m, right_hip, leg_down(0.05, k_thigh_rest_forward)},
        {SpineLinkKind::shin, 5, k_shin_m, Vec3::Zero(), shin_rest},
    }};
    return list;
}

Vec3 link_base(const SpineFrame& above, const BodyLinkVectors& offset_m, const SpineLink& link,
               double scale) {
    switch (link.kind) {
        case SpineLinkKind::spine:
            return link.parent == k_chest_link ? Vec3(Vec3::Zero()) : offset_m[link.parent];
        case SpineLinkKind::thigh:
            return offset_m[link.parent] + above.axes * (scale * link.base_m);
        case SpineLinkKind::shin:
            break;
    }
    return offset_m[link.parent];
}

Quat link_frame(const Quat& above, const Vec3& towards, double twist_rad) {
    // Half-angle formula from -Y: cos(a / 2) : axis sin(a / 2) = 1 - y : (-z, 0, x).
    const double cosine = 1.0 - towards.y();
    if (cosine < 0.5) {
        const Quat bent = above * rotation_between(-Vec3::UnitY(), towards);
        return (bent * rotation_about(Vec3::UnitY(), twist_rad)).normalized();
    }
    const double by =
        1.0 / std::sqrt(cosine * cosine + towards.x() * towards.x() + towards.z() * towards.z());
    const double w = cosine * by;
    const double x = -towards.z() * by;
    const double z = towards.x() * by;
    if (twist_rad == 0.0) {
        return product(above, Quat(w, x, 0.0, z));
    }
    double sine = 0.0;
    double turn = 1.0;
    sin_cos(0.5 * twist_rad, sine, turn);
    return product(above, Quat(w * turn, x * turn - z * sine, w * sine, z * turn + x * sine));
}

}  // namespace handhold
