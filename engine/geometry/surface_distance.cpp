#include "engine/geometry/surface_distance.hpp"

#include <algorithm>

#include "engine/geometry/closest_point.hpp"

namespace handhold {
namespace {

// Maximum depth of subdivision. Bisecting a triangle of 1 km this often leaves less than 1 mm.
constexpr int k_max_cuts = 40;

class Cover {
  public:
    Cover(const TriangleSurface& target, double limit_m)
        : target_(target), limit_m_(limit_m), squared_limit_(limit_m * limit_m) {}

    bool covers(const Corners& piece, int cuts) {
        if (hint_ < target_.triangles.size() && is_near_to(piece, hint_)) {
            return true;
        }
        const Vec3 middle = (piece[0] + piece[1] + piece[2]) / 3.0;
        const auto hit = target_.bvh.closest_point(middle, limit_m_);
        if (!hit) {
            far_point_ = middle;
            return false;
        }
        hint_ = hit->triangle;
        if (is_near_to(piece, hint_)) {
            return true;
        }
        double radius = 0.0;
        for (const Vec3& corner : piece) {
            radius = std::max(radius, (corner - middle).norm());
        }
        if (hit->distance_m + radius <= limit_m_) {
            return true;
        }
        if (cuts >= k_max_cuts || radius < k_min_piece_share * limit_m_) {
            far_point_ = middle;
            return false;
        }
        return covers_parts(piece, cuts);
    }

    const Vec3& far_point() const { return far_point_; }  // valid after covers() returned false

  private:
    // Splits the piece along the edge of the nearest triangle over which it reaches farthest. The
    // part above that triangle is near it; the other part looks for another triangle.
    bool covers_parts(const Corners& piece, int cuts) {
        const Corners near = corners_of(hint_);
        const Vec3 area = area_vector(near);
        double max_out = 0.0;
        std::array<double, 3> beyond = {};  // distance of each corner beyond that edge
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 outward = (near[(k + 1) % 3] - near[k]).cross(area).normalized();
            std::array<double, 3> out = {};
            for (std::size_t i = 0; i < 3; ++i) {
                out[i] = outward.dot(piece[i] - near[k]);
            }
            const auto [low, high] = std::minmax_element(out.begin(), out.end());
            if (*high > max_out && *low < -k_min_piece_share * limit_m_) {
                max_out = *high;
                beyond = out;
            }
        }
        if (max_out > k_min_piece_share * limit_m_) {
            return covers_clipped(piece, beyond, cuts);
        }
        // If the piece reaches over no edge, bisects its longest edge, which keeps pieces compact.
        std::size_t longest = 0;
        for (std::size_t i = 1; i < 3; ++i) {
            if (squared_edge(piece, i) > squared_edge(piece, longest)) {
                longest = i;
            }
        }
        const Vec3& from = piece[longest];
        const Vec3& to = piece[(longest + 1) % 3];
        const Vec3& apex = piece[(longest + 2) % 3];
        const Vec3 cut = 0.5 * (from + to);
        return covers({from, cut, apex}, cuts + 1) && covers({cut, to, apex}, cuts + 1);
    }
    // Splits the piece along the cut. One corner is alone on its side: its part is one triangle,
    // the other part two.
    bool covers_clipped(const Corners& piece, const std::array<double, 3>& beyond, int cuts) {
        std::size_t lone = 0;  // index of the corner that is alone on its side
        for (std::size_t i = 1; i < 3; ++i) {
            const bool side = beyond[i] > 0.0;
            if (side != (beyond[(i + 1) % 3] > 0.0) && side != (beyond[(i + 2) % 3] > 0.0)) {
                lone = i;
            }
        }
        const auto meet = [&](std::size_t other) -> Vec3 {
            const double share = beyond[lone] / (beyond[lone] - beyond[other]);
            return piece[lone] + share * (piece[other] - piece[lone]);
        };
        const std::size_t next = (lone + 1) % 3;
        const std::size_t last = (lone + 2) % 3;
        const Vec3 on_next = meet(next);
        const Vec3 on_last = meet(last);
        return covers({piece[lone], on_next, on_last}, cuts + 1) &&
               covers({on_next, piece[next], piece[last]}, cuts + 1) &&
               covers({on_next, piece[last], on_last}, cuts + 1);
    }
    Corners corners_of(std::uint32_t triangle) const {
        const auto& [a, b, c] = target_.triangles[triangle];
        return {target_.positions[a], target_.positions[b], target_.positions[c]};
    }
    static double squared_edge(const Corners& piece, std::size_t i) {
        return (piece[(i + 1) % 3] - piece[i]).squaredNorm();
    }
    bool is_near_to(const Corners& piece, std::uint32_t triangle) const {
        const Corners corners = corners_of(triangle);
        return std::all_of(piece.begin(), piece.end(), [&](const Vec3& corner) {
            return (closest_on_triangle(corner, corners) - corner).squaredNorm() <= squared_limit_;
        });
    }

    const TriangleSurface& target_;
    double limit_m_;
    double squared_limit_;
    // The triangle last found near: consecutive queries are near each other.
    std::uint32_t hint_ = ~0U;
    Vec3 far_point_ = Vec3::Zero();
};

}  // namespace

std::vector<Uncovered> find_uncovered(const TriangleSurface& a, const TriangleSurface& b,
                                      double limit_m) {
    Cover cover(b, limit_m);
    std::vector<Uncovered> result;
    for (std::uint32_t t = 0; t < a.triangles.size(); ++t) {
        const auto& [i, j, k] = a.triangles[t];
        if (!cover.covers({a.positions[i], a.positions[j], a.positions[k]}, 0)) {
            result.push_back({t, cover.far_point()});
        }
    }
    return result;
}

}  // namespace handhold
