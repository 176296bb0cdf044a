#include "game/mesh/primitives.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "engine/core/check.hpp"
#include "engine/core/hash.hpp"

namespace handhold {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

void add_quad(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
}

// Signs of an axis-aligned box's corner, bit 0 for x.
Vec3 corner_sign(unsigned corner) {
    return {(corner & 1U) != 0U ? 1.0 : -1.0, (corner & 2U) != 0U ? 1.0 : -1.0,
            (corner & 4U) != 0U ? 1.0 : -1.0};
}

// Flips the triangles that face inwards. Precondition: the mesh is convex and contains the origin.
void face_outward(Mesh& mesh) {
    for (Triangle& t : mesh.triangles) {
        const Vec3& a = mesh.positions[t[0]];
        const Vec3 normal = (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a);
        if (normal.dot(a) < 0.0) {
            std::swap(t[1], t[2]);
        }
    }
}

// The pose at `a` whose +Z points to `b`.
Pose along(const Vec3& a, const Vec3& b) {
    return {a, rotation_between(Vec3::UnitZ(), (b - a).normalized())};
}

// Subdivides every triangle of a unit sphere into four; new vertices lie on the sphere.
void quarter_on_sphere(Mesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [at, is_new] =
            middles.try_emplace(std::minmax(a, b), index_of(mesh.positions.size()));
        if (is_new) {
            const Vec3 point = (mesh.positions[a] + mesh.positions[b]).normalized();
            mesh.positions.push_back(point);
        }
        return at->second;
    };
    std::vector<Triangle> finer;
    for (const Triangle& t : mesh.triangles) {
        const std::uint32_t ab = middle(t[0], t[1]);
        const std::uint32_t bc = middle(t[1], t[2]);
        const std::uint32_t ca = middle(t[2], t[0]);
        finer.insert(finer.end(), {{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
}

// Value noise in [-1, 1] with cells of 1 m: random values at lattice points, blended smoothly.
double lattice_noise(const Vec3& point, unsigned seed) {
    const Vec3 cell(std::floor(point.x()), std::floor(point.y()), std::floor(point.z()));
    double sum = 0.0;
    for (unsigned corner = 0; corner < 8; ++corner) {
        const Vec3 at = cell + 0.5 * (corner_sign(corner) + Vec3::Ones());
        double weight = 1.0;
        std::uint64_t hash = seed;
        for (int axis = 0; axis < 3; ++axis) {
            weight *= smooth_step(1.0 - std::abs(point[axis] - at[axis]), 0.0, 1.0);
            hash =
                mix64(hash + 0x9e3779b97f4a7c15ULL + static_cast<std::uint64_t>(at[axis] + 4096.0));
        }
        sum += weight * (static_cast<double>(hash >> 11U) * 0x1p-52 - 1.0);
    }
    return sum;
}

}  // namespace

Mesh make_box(const Vec3& half_m) {
    Mesh mesh;
    for (unsigned corner = 0; corner < 8; ++corner) {
        mesh.positions.emplace_back(corner_sign(corner).cwiseProduct(half_m));
    }
    add_quad(mesh, 0, 2, 3, 1);
    add_quad(mesh, 4, 5, 7, 6);
    add_quad(mesh, 0, 1, 5, 4);
    add_quad(mesh, 2, 6, 7, 3);
    add_quad(mesh, 0, 4, 6, 2);
    add_quad(mesh, 1, 3, 7, 5);
    return mesh;
}

Mesh make_bevelled_box(const Vec3& half_m, double bevel_m) {
    HH_CHECK(bevel_m > 0.0 && bevel_m < half_m.minCoeff(), "bevel out of range", bevel_m);
    Mesh mesh;
    // Vertex 3 * corner + axis is the corner moved inwards along the two other axes. It lies on a
    // face perpendicular to `axis`.
    for (unsigned corner = 0; corner < 8; ++corner) {
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 extent = half_m - Vec3::Constant(bevel_m);
            extent[axis] = half_m[axis];
            mesh.positions.emplace_back(corner_sign(corner).cwiseProduct(extent));
        }
        mesh.triangles.push_back({3 * corner, 3 * corner + 1, 3 * corner + 2});
    }
    for (unsigned axis = 0; axis < 3; ++axis) {
        const unsigned u = 1U << ((axis + 1) % 3);
        const unsigned v = 1U << ((axis + 2) % 3);
        for (const unsigned side : {0U, 1U << axis}) {
            add_quad(mesh, 3 * side + axis, 3 * (side | u) + axis, 3 * (side | u | v) + axis,
                     3 * (side | v) + axis);
        }
        // The four edges along `axis`, each between faces perpendicular to the other two axes.
        const unsigned first = (axis + 1) % 3;
        const unsigned second = (axis + 2) % 3;
        for (const unsigned edge : {0U, u, v, u | v}) {
            const unsigned far_end = edge | (1U << axis);
            add_quad(mesh, 3 * edge + first, 3 * edge + second, 3 * far_end + second,
                     3 * far_end + first);
        }
    }
    face_outward(mesh);
    return mesh;
}

Mesh make_bevelled_slab(const Vec3& half_m, double bevel_m) {
    HH_CHECK(bevel_m > 0.0 && bevel_m < half_m.minCoeff(), "bevel out of range", bevel_m);
    Mesh mesh;
    const auto add_ring = [&](double inset, double y) {
        const double x = half_m.x() - inset;
        const double z = half_m.z() - inset;
        mesh.positions.insert(mesh.positions.end(),
                              {Vec3(-x, y, -z), Vec3(-x, y, z), Vec3(x, y, z), Vec3(x, y, -z)});
    };
    add_ring(0.0, -half_m.y());
    add_ring(0.0, half_m.y() - bevel_m);
    add_ring(bevel_m, half_m.y());
    add_quad(mesh, 3, 2, 1, 0);
    for (std::uint32_t low = 0; low < 8; low += 4) {
        for (std::uint32_t j = 0; j < 4; ++j) {
            const std::uint32_t next = (j + 1) % 4;
            add_quad(mesh, low + j, low + next, low + 4 + next, low + 4 + j);
        }
    }
    add_quad(mesh, 8, 9, 10, 11);
    return mesh;
}

Mesh make_sphere(double radius_m, int segments) {
    std::vector<ProfilePoint> profile;
    const int steps = std::max(segments / 2, 3);
    for (int i = 0; i <= steps; ++i) {
        double sine = 0.0;
        double cosine = 1.0;
        sin_cos(0.5 * k_two_pi * i / steps, sine, cosine);
        const bool is_pole = i == 0 || i == steps;
        profile.push_back({is_pole ? 0.0 : radius_m * sine, -radius_m * cosine});
    }
    return make_revolved(profile, segments);
}

Mesh make_capsule(const Vec3& a, const Vec3& b, double radius_m, int segments) {
    std::vector<ProfilePoint> profile;
    const double length = (b - a).norm();
    const int steps = std::max(segments / 4, 2);
    for (int i = 0; i <= 2 * steps + 1; ++i) {
        const bool is_far = i > steps;
        double sine = 0.0;
        double cosine = 1.0;
        sin_cos(0.25 * k_two_pi * (is_far ? i - 1 : i) / steps, sine, cosine);
        const bool is_pole = i == 0 || i == 2 * steps + 1;
        profile.push_back(
            {is_pole ? 0.0 : radius_m * sine, (is_far ? length : 0.0) - radius_m * cosine});
    }
    Mesh mesh;
    append(mesh, make_revolved(profile, segments), along(a, b));
    return mesh;
}

Mesh make_cylinder(const Vec3& a, const Vec3& b, double radius_m, int segments) {
    const std::array<ProfilePoint, 2> profile = {{{radius_m, 0.0}, {radius_m, (b - a).norm()}}};
    Mesh mesh;
    append(mesh, make_revolved(profile, segments), along(a, b));
    return mesh;
}

Mesh make_tube(std::span<const Vec3> path, double radius_m, int segments) {
    HH_CHECK(path.size() >= 2, "a tube needs two points", path.size());
    std::vector<Ring> rings;
    Vec3 direction = (path[1] - path[0]).normalized();
    // Parallel transport: the shortest rotation from piece to piece, so the bar does not twist.
    Quat frame = rotation_between(Vec3::UnitZ(), direction);
    for (std::size_t i = 0; i < path.size(); ++i) {
        const Vec3 next =
            i + 1 < path.size() ? Vec3((path[i + 1] - path[i]).normalized()) : direction;
        const Vec3 tangent = (direction + next).normalized();
        const Quat tilt = rotation_between(direction, tangent);
        const Vec3 corner_axis = direction.cross(next);
        const double stretch_at_mitre = 1.0 / std::max(direction.dot(tangent), 0.5);
        const Vec3 outward = corner_axis.norm() > 1e-9
                                 ? Vec3(tangent.cross(corner_axis).normalized())
                                 : Vec3(Vec3::Zero());
        Ring ring;
        for (int j = 0; j < segments; ++j) {
            double sine = 0.0;
            double cosine = 1.0;
            sin_cos(k_two_pi * j / segments, sine, cosine);
            Vec3 offset = tilt * (frame * (radius_m * Vec3(cosine, sine, 0.0)));
            offset += (stretch_at_mitre - 1.0) * offset.dot(outward) * outward;
            ring.emplace_back(path[i] + offset);
        }
        rings.push_back(std::move(ring));
        frame = (rotation_between(direction, next) * frame).normalized();
        direction = next;
    }
    return make_loft(rings, LoftEnds::capped);
}

Mesh make_torus(double radius_m, double bar_radius_m, int segments, int bar_segments) {
    std::vector<Ring> rings;
    for (int i = 0; i < bar_segments; ++i) {
        // Backwards around the bar (inner side first, then down and out): the order that
        // LoftEnds::looped needs.
        double sine = 0.0;
        double cosine = 1.0;
        sin_cos(k_two_pi * i / bar_segments, sine, cosine);
        const double radius = radius_m - bar_radius_m * cosine;
        Ring ring;
        for (int j = 0; j < segments; ++j) {
            double sine_about = 0.0;
            double cosine_about = 1.0;
            sin_cos(k_two_pi * j / segments, sine_about, cosine_about);
            ring.emplace_back(radius * cosine_about, radius * sine_about, -bar_radius_m * sine);
        }
        rings.push_back(std::move(ring));
    }
    return make_loft(rings, LoftEnds::looped);
}

Mesh make_icosphere(double radius_m, int levels) {
    Mesh mesh;
    const double golden = 0.5 * (1.0 + std::sqrt(5.0));
    for (int axis = 0; axis < 3; ++axis) {
        for (unsigned corner = 0; corner < 4; ++corner) {
            Vec3 point = Vec3::Zero();
            point[axis] = corner_sign(corner).x();
            point[(axis + 1) % 3] = golden * corner_sign(corner).y();
            mesh.positions.emplace_back(point.normalized());
        }
    }
    // The twenty triangles are the triples of mutually adjacent vertices.
    const double reach = 1.01 * 2.0 / std::sqrt(golden * golden + 1.0);
    const auto is_near = [&](std::uint32_t a, std::uint32_t b) {
        return (mesh.positions[a] - mesh.positions[b]).norm() < reach;
    };
    for (std::uint32_t a = 0; a < 12; ++a) {
        for (std::uint32_t b = a + 1; b < 12; ++b) {
            for (std::uint32_t c = b + 1; c < 12; ++c) {
                if (is_near(a, b) && is_near(b, c) && is_near(a, c)) {
                    mesh.triangles.push_back({a, b, c});
                }
            }
        }
    }
    face_outward(mesh);
    for (int level = 0; level < levels; ++level) {
        quarter_on_sphere(mesh);
    }
    stretch(mesh, Vec3::Constant(radius_m));
    return mesh;
}

Mesh make_rock(double radius_m, unsigned seed) {
    Mesh mesh = make_icosphere(1.0, 3);
    for (Vec3& point : mesh.positions) {
        double swell = 0.30 * lattice_noise(1.3 * point, seed);
        swell += 0.14 * lattice_noise(2.9 * point, seed + 1);
        swell += 0.05 * lattice_noise(7.0 * point, seed + 2);
        point *= radius_m * (0.96 + swell);
    }
    return mesh;
}

Pose look_along(const Vec3& position, const Vec3& forward, const Vec3& up) {
    return {position, look_rotation(forward, up)};
}

}  // namespace handhold
