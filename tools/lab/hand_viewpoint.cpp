// The candidate directions are points of a golden spiral on the sphere. The ray test is that of
// Moeller and Trumbore 1997.
#include "tools/lab/hand_viewpoint.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace handhold::lab {
namespace {

constexpr int k_directions = 96;
// Weight of a view from beside the hand, relative to the visible share of the fingers.
constexpr double k_beside_weight = 0.25;
constexpr double k_above_weight = 0.08;  // prefers views from above

bool hits_triangle(const Vec3& from, const Vec3& ray, const Triangle& triangle) {
    const Vec3 e1 = triangle[1] - triangle[0];
    const Vec3 e2 = triangle[2] - triangle[0];
    const Vec3 p = ray.cross(e2);
    const double det = e1.dot(p);
    if (std::abs(det) < 1e-18) {
        return false;
    }
    const Vec3 s = from - triangle[0];
    const double u = s.dot(p) / det;
    const Vec3 q = s.cross(e1);
    const double v = ray.dot(q) / det;
    const double t = e2.dot(q) / det;
    return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 && t < 1.0;
}

// Squared distance of two segments, each given by its start and its direction vector.
double segment_distance2(const Vec3& p, const Vec3& d, const Vec3& q, const Vec3& e) {
    const Vec3 r = p - q;
    const double a = d.squaredNorm();
    const double b = d.dot(e);
    const double c = e.squaredNorm();
    const double f = e.dot(r);
    const double g = d.dot(r);
    const double det = a * c - b * b;
    double s = det > 1e-18 ? std::clamp((b * f - c * g) / det, 0.0, 1.0) : 0.0;
    const double t = c > 1e-18 ? std::clamp((b * s + f) / c, 0.0, 1.0) : 0.0;
    s = a > 1e-18 ? std::clamp((b * t - g) / a, 0.0, 1.0) : 0.0;
    return (r + s * d - t * e).squaredNorm();
}

Vec3 spiral_direction(int i) {
    const double height = 1.0 - 2.0 * (i + 0.5) / k_directions;
    const double around = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
    const double wide = std::sqrt(1.0 - height * height);
    return {wide * std::cos(around), height, wide * std::sin(around)};
}

// True if the eye sees the middle of capsule `own`, on the side that faces the eye.
bool is_seen(std::span<const HandCapsule> capsules, std::size_t own, const Vec3& towards,
             std::span<const Triangle> around, double distance_m) {
    const HandCapsule& capsule = capsules[own];
    const Vec3 from = 0.5 * (capsule.a_m + capsule.b_m) + (capsule.radius_m + 1e-4) * towards;
    const Vec3 ray = distance_m * towards;
    for (std::size_t i = 0; i < capsules.size(); ++i) {
        const HandCapsule& other = capsules[i];
        if (i != own && segment_distance2(from, ray, other.a_m, other.b_m - other.a_m) <
                            other.radius_m * other.radius_m) {
            return false;
        }
    }
    return std::none_of(around.begin(), around.end(), [&](const Triangle& triangle) {
        return hits_triangle(from, ray, triangle);
    });
}

}  // namespace

std::vector<Triangle> triangles_near(std::span<const Mesh> meshes, const Vec3& point,
                                     double reach_m) {
    std::vector<Triangle> near;
    for (const Mesh& mesh : meshes) {
        for (const auto& [a, b, c] : mesh.triangles) {
            const Triangle triangle = {mesh.positions[a], mesh.positions[b], mesh.positions[c]};
            const Vec3 low = triangle[0].cwiseMin(triangle[1]).cwiseMin(triangle[2]);
            const Vec3 high = triangle[0].cwiseMax(triangle[1]).cwiseMax(triangle[2]);
            if ((point.cwiseMax(low).cwiseMin(high) - point).norm() <= reach_m) {
                near.push_back(triangle);
            }
        }
    }
    return near;
}

HandView hand_bounds(std::span<const HandCapsule> capsules) {
    HandView view;
    Vec3 low = Vec3::Constant(HUGE_VAL);
    Vec3 high = -low;
    for (const HandCapsule& capsule : capsules) {
        low = low.cwiseMin(capsule.a_m).cwiseMin(capsule.b_m);
        high = high.cwiseMax(capsule.a_m).cwiseMax(capsule.b_m);
    }
    if (!capsules.empty()) {
        view.center = 0.5 * (low + high);
        view.radius_m = 0.0;
    }
    for (const HandCapsule& capsule : capsules) {
        view.radius_m = std::max({view.radius_m, (capsule.a_m - view.center).norm(),
                                  (capsule.b_m - view.center).norm()});
    }
    return view;
}

HandView choose_hand_view(std::span<const HandCapsule> capsules, const Quat& wrist,
                          std::span<const Triangle> around, double distance_m,
                          const HandView* other) {
    constexpr double k_max_cosine = 0.342;  // cosine of 70 degrees
    HandView view = hand_bounds(capsules);
    const Vec3 back = wrist * Vec3::UnitY();
    double best = -1.0;
    for (int i = 0; i < k_directions; ++i) {
        const Vec3 towards = spiral_direction(i);
        if (other != nullptr && towards.dot(other->towards) > k_max_cosine) {
            continue;
        }
        double seen = 0.0;
        double all = 0.0;
        for (std::size_t k = 0; k < capsules.size(); ++k) {
            if (capsules[k].finger == "palm") {
                continue;
            }
            const double weight = 1.0 + capsules[k].link;  // fingertips have the largest weight
            all += weight;
            seen += is_seen(capsules, k, towards, around, distance_m) ? weight : 0.0;
        }
        const double score = (all > 0.0 ? seen / all : 0.0) +
                             k_beside_weight * (1.0 - std::abs(towards.dot(back))) +
                             k_above_weight * towards.y();
        if (score > best) {
            best = score;
            view.towards = towards;
        }
    }
    return view;
}

}  // namespace handhold::lab
