#include "engine/geometry/surface_crossings.hpp"

namespace handhold {

bool crosses_oddly(const TriangleBvh& surface, Vec3 from, const Vec3& to) {
    constexpr double k_layer_m = 1e-6;
    constexpr int k_most = 16;
    bool is_odd = false;
    for (int i = 0; i < k_most; ++i) {
        const auto hit = surface.cast_ray(from, to);
        if (!hit) {
            break;
        }
        is_odd = !is_odd;
        const double left_m = (to - hit->point).norm();
        if (left_m <= k_layer_m) {
            break;
        }
        from = hit->point + k_layer_m / left_m * (to - hit->point);
    }
    return is_odd;
}

}  // namespace handhold
