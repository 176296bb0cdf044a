#include "engine/geometry/surface_distance.hpp"

#include <algorithm>

#include "engine/collision/closest_point.hpp"

namespace handhold {
namespace {

constexpr int k_most_cuts = 40;  // in a row: halves of the halves of a triangle of 1 km are below
                                 // a millimetre by then

class Cover {
  public:
    Cover(const TriangleSet& target, double limit_m)
        : target_(target), limit_m_(limit_m), squared_limit_(limit_m * limit_m) {}

    // `hint`: a triangle that may be near, and then the one that was.
    bool covers(const Corners& piece, std::uint32_t& hint, int cuts) const {
        if (hint < target_.triangles.size() && is_near_to(piece, hint)) {
            return true;
        }
        const Vec3 middle = (piece[0] + piece[1] + piece[2]) / 3.0;
        const auto hit = target_.bvh.closest_point(middle, limit_m_);
        if (!hit) {
            return false;
        }
        hint = hit->triangle;
        if (is_near_to(piece, hint)) {
            return true;
        }
        double radius = 0.0;
        for (const Vec3& corner : piece) {
            radius = std::max(radius, (corner - middle).norm());
        }
        if (hit->distance_m + radius <= limit_m_) {
            return true;
        }
        if (cuts >= k_most_cuts || radius < 1e-3 * limit_m_) {
            return false;
        }
        // Cut across the longest edge: pieces stay round.
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
        return covers({from, cut, apex}, hint, cuts + 1) && covers({cut, to, apex}, hint, cuts + 1);
    }

  private:
    static double squared_edge(const Corners& piece, std::size_t i) {
        return (piece[(i + 1) % 3] - piece[i]).squaredNorm();
    }
    bool is_near_to(const Corners& piece, std::uint32_t triangle) const {
        const auto& [a, b, c] = target_.triangles[triangle];
        const Corners corners = {target_.positions[a], target_.positions[b], target_.positions[c]};
        return std::all_of(piece.begin(), piece.end(), [&](const Vec3& corner) {
            return (closest_on_triangle(corner, corners) - corner).squaredNorm() <= squared_limit_;
        });
    }

    const TriangleSet& target_;
    double limit_m_;
    double squared_limit_;
};

}  // namespace

bool is_covered(const TriangleSet& a, const TriangleSet& b, double limit_m) {
    const Cover cover(b, limit_m);
    std::uint32_t hint = ~0U;  // neighbours often come one after another
    return std::all_of(a.triangles.begin(), a.triangles.end(), [&](const auto& triangle) {
        return cover.covers(
            {a.positions[triangle[0]], a.positions[triangle[1]], a.positions[triangle[2]]}, hint,
            0);
    });
}

}  // namespace handhold
