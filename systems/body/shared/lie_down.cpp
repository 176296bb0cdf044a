#include "systems/body/shared/lie_down.hpp"

#include <algorithm>

namespace handhold {

double lying_share(double eyes_m, const Vec3& up_ps, const Vec3& ahead_ps) {
    // The eyes of a trunk that leans by an angle r from hips on the floor are at k_hips_m +
    // k_hips_to_eyes_m cos r, if the head's up axis leans alike.
    constexpr double k_hips_m = 0.10;
    constexpr double k_hips_to_eyes_m = 0.70;
    constexpr double k_bent_neck = 0.14;  // cosines by which a neck may be bent back upright
    // Heights between which a player lies down, on the back or side and on the front: who bends
    // forward to see the floor before the feet has the eyes higher than who lies on it.
    constexpr double k_lies_m = 0.45;
    constexpr double k_sits_m = 0.70;
    constexpr double k_prone_m = 0.18;
    constexpr double k_crawls_m = 0.38;
    if (eyes_m >= k_sits_m) {
        return 0.0;
    }
    const double reclined = (eyes_m - k_hips_m) / k_hips_to_eyes_m;  // cos r
    const double tilted = 1.0 - smooth_step(up_ps.y() - reclined, 0.0, k_bent_neck);
    const double ahead = smooth_step(-ahead_ps.y(), 0.3, 0.8);
    const double low_m = k_lies_m + ahead * (k_prone_m - k_lies_m);
    const double high_m = k_sits_m + ahead * (k_crawls_m - k_sits_m);
    return tilted * (1.0 - smooth_step(eyes_m, low_m, high_m));
}

}  // namespace handhold
