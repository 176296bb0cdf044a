#include "engine/collision/near_triangles.hpp"

namespace handhold {

void NearTriangles::clear() {
    triangles_.clear();
    boxes_.clear();
    levels_.clear();
}

void NearTriangles::add(const Corners& corners_ns) {
    const Vec3 area = area_vector(corners_ns);
    const double length = area.norm();
    if (!(length > 0.0)) {
        return;
    }
    const auto& [a, b, c] = corners_ns;
    triangles_.push_back(
        {corners_ns, area / length, {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)}});
}

void NearTriangles::build() {
    boxes_.clear();
    levels_.clear();
    for (std::size_t i = 0; triangles_.size() > k_run && i < triangles_.size(); ++i) {
        if (i == 0) {
            levels_.push_back(0);
        }
        if (i % k_run == 0) {
            boxes_.push_back(triangles_[i].box_ns);
        } else {
            boxes_.back() = boxes_.back().joined(triangles_[i].box_ns);
        }
    }
    while (!levels_.empty() && top_count() > k_run) {
        const std::size_t below = levels_.back();
        const std::size_t end = boxes_.size();
        levels_.push_back(end);
        for (std::size_t i = below; i < end; ++i) {
            const Bounds box = boxes_[i];  // copied, since push_back may reallocate
            if ((i - below) % k_run == 0) {
                boxes_.push_back(box);
            } else {
                boxes_.back() = boxes_.back().joined(box);
            }
        }
    }
}

}  // namespace handhold
