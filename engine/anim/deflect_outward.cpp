#include "engine/anim/deflect_outward.hpp"

#include <algorithm>
#include <cmath>

namespace handhold {

Vec3 deflect_outward(const Vec3& towards, const Vec3& normal, double min_out, double max_lift) {
    const double out = towards.dot(normal);
    if (out >= min_out) {
        return towards;
    }
    const double wanted = std::clamp(std::min(min_out, out + max_lift), -1.0, 1.0);
    const Vec3 aside = towards - out * normal;
    const double length = aside.norm();
    if (length < 1e-9 || wanted >= 1.0) {
        return wanted >= 1.0 ? normal : towards;
    }
    return wanted * normal + aside * (std::sqrt(1.0 - wanted * wanted) / length);
}

}  // namespace handhold
