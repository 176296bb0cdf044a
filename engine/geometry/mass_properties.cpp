// Sources: polyhedra: Blow and Binstock, How to Find the Inertia Tensor, 2004. Principal axes:
// Jacobi rotations, 1846. Eigen's closed form is not used: it calls the C library's trigonometry,
// which differs between platforms, and body poses are part of the state.
#include "engine/geometry/mass_properties.hpp"

#include <array>
#include <cmath>

#include "engine/core/check.hpp"

namespace handhold {
namespace {

// Inertia tensor from the matrix C of second moments (covariance): I = tr(C) 1 - C.
Mat3 inertia_of_covariance(const Mat3& covariance) {
    return covariance.trace() * Mat3::Identity() - covariance;
}

// Inertia tensor of 1 kg at `offset` (the term of Steiner's parallel axis theorem).
Mat3 offset_inertia(const Vec3& offset) {
    return inertia_of_covariance(offset * offset.transpose());
}

MassProperties of_box(const Vec3& half) {
    const Vec3 squared = half.cwiseAbs2();
    const Vec3 moments = (Vec3::Constant(squared.sum()) - squared) / 3.0;
    return {8.0 * half.prod(), Vec3::Zero(), moments.asDiagonal()};
}

MassProperties of_sphere(double radius) {
    return {4.0 / 3.0 * k_pi * radius * radius * radius, Vec3::Zero(),
            0.4 * radius * radius * Mat3::Identity()};
}

MassProperties of_cylinder(double radius, double half_height) {
    const double along = radius * radius / 2.0;
    const double across = radius * radius / 4.0 + half_height * half_height / 3.0;
    return {2.0 * k_pi * radius * radius * half_height, Vec3::Zero(),
            Vec3(across, along, across).asDiagonal()};
}

// Cylinder plus two half spheres. A half sphere has transverse inertia 83/320 m r^2 about its own
// centre of mass, which lies at h + 3/8 r; their sum is the closed form below.
MassProperties of_capsule(double radius, double half_height) {
    const double r2 = radius * radius;
    const double h = half_height;
    // Both volumes are divided by 2 pi r^2, which cancels in the mass fractions.
    const double sphere_fraction = (2.0 / 3.0 * radius) / (2.0 / 3.0 * radius + h);
    const double cylinder_fraction = 1.0 - sphere_fraction;
    const double along = cylinder_fraction * r2 / 2.0 + sphere_fraction * 0.4 * r2;
    const double across = cylinder_fraction * (r2 / 4.0 + h * h / 3.0) +
                          sphere_fraction * (0.4 * r2 + h * h + 0.75 * h * radius);
    return {2.0 * k_pi * r2 * (h + 2.0 / 3.0 * radius), Vec3::Zero(),
            Vec3(across, along, across).asDiagonal()};
}

// Sum over tetrahedra from an inner point to the faces' triangles. For edges u, v, w from that
// point and det = u . (v x w): volume = det / 6, integral of x x^T = det / 120 (u u^T + v v^T + w
// w^T + s s^T) with s = u + v + w.
MassProperties of_hull(const ConvexHull& hull) {
    Vec3 inside = Vec3::Zero();
    for (const Vec3& corner : hull.corners) {
        inside += corner / static_cast<double>(hull.corners.size());
    }
    double volume = 0.0;
    Vec3 first = Vec3::Zero();
    Mat3 second = Mat3::Zero();
    for (const HullFace& face : hull.faces) {
        const Vec3 u = hull.corners[face.loop[0]] - inside;
        for (std::size_t i = 1; i + 1 < face.loop.size(); ++i) {
            const Vec3 v = hull.corners[face.loop[i]] - inside;
            const Vec3 w = hull.corners[face.loop[i + 1]] - inside;
            const double determinant = u.dot(v.cross(w));
            const Vec3 sum = u + v + w;
            volume += determinant / 6.0;
            first += determinant / 24.0 * sum;
            second +=
                determinant / 120.0 *
                (u * u.transpose() + v * v.transpose() + w * w.transpose() + sum * sum.transpose());
        }
    }
    const Vec3 offset = first / volume;
    const Mat3 covariance = second / volume - offset * offset.transpose();
    return {volume, inside + offset, inertia_of_covariance(covariance)};
}

MassProperties of_compound(const std::vector<PlacedShape>& parts) {
    MassProperties total;
    double mass = 0.0;
    Mat3 inertia = Mat3::Zero();  // inertia about the shape's origin
    for (const PlacedShape& part : parts) {
        const MassProperties own = mass_properties(part.shape);
        const double weight = part.mass_kg > 0.0 ? part.mass_kg : own.volume_m3;
        const Mat3 rotation = part.pose.rotation.toRotationMatrix();
        const Vec3 centre = transform_point(part.pose, own.centre_m);
        total.volume_m3 += own.volume_m3;
        total.centre_m += weight * centre;
        inertia += weight * (rotation * own.inertia_per_kg_m2 * rotation.transpose() +
                             offset_inertia(centre));
        mass += weight;
    }
    total.centre_m /= mass;
    total.inertia_per_kg_m2 = inertia / mass - offset_inertia(total.centre_m);
    return total;
}

// Jacobi rotation of axes p and q that zeroes the matrix entry (p, q).
void rotate_away(Eigen::Index p, Eigen::Index q, Mat3& matrix, Mat3& axes) {
    const double theta = (matrix(q, q) - matrix(p, p)) / (2.0 * matrix(p, q));
    const double tangent =
        std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
    const double cosine = 1.0 / std::sqrt(tangent * tangent + 1.0);
    Mat3 rotation = Mat3::Identity();
    rotation(p, p) = rotation(q, q) = cosine;
    rotation(p, q) = tangent * cosine;
    rotation(q, p) = -tangent * cosine;
    matrix = rotation.transpose() * matrix * rotation;
    axes = axes * rotation;
}

// Eigenvectors of a symmetric matrix as columns, unsorted.
Mat3 eigenvectors(Mat3 matrix) {
    constexpr int k_rounds = 12;  // converges quadratically; at most 5 have been observed
    constexpr double k_rounding = 1e-15;
    constexpr std::array<std::array<Eigen::Index, 2>, 3> k_pairs = {{{0, 1}, {0, 2}, {1, 2}}};
    Mat3 axes = Mat3::Identity();
    const double scale = matrix.cwiseAbs().maxCoeff();
    for (int round = 0; round < k_rounds; ++round) {
        for (const auto& [p, q] : k_pairs) {
            if (std::abs(matrix(p, q)) > k_rounding * scale) {
                rotate_away(p, q, matrix, axes);
            }
        }
    }
    return axes;
}

// Reorders and flips the axes so that they are close to the identity. Greedy, largest entry first.
Mat3 nearest_to_identity(const Mat3& axes) {
    Mat3 left = axes.cwiseAbs();
    Mat3 result = Mat3::Identity();
    for (int i = 0; i < 3; ++i) {
        Eigen::Index row = 0;
        Eigen::Index column = 0;
        left.maxCoeff(&row, &column);
        result.col(row) = axes(row, column) < 0.0 ? Vec3(-axes.col(column)) : axes.col(column);
        left.row(row).setConstant(-1.0);
        left.col(column).setConstant(-1.0);
    }
    if (result.determinant() < 0.0) {
        Eigen::Index least = 0;
        result.diagonal().minCoeff(&least);
        result.col(least) = -result.col(least);
    }
    return result;
}

}  // namespace

MassProperties mass_properties(const Shape& shape) {
    switch (shape.kind) {
        case ShapeKind::box:
            return of_box(shape.half_m);
        case ShapeKind::sphere:
            return of_sphere(shape.radius_m);
        case ShapeKind::capsule:
            return of_capsule(shape.radius_m, shape.half_height_m);
        case ShapeKind::cylinder:
            return of_cylinder(shape.radius_m, shape.half_height_m);
        case ShapeKind::hull:
            return of_hull(*shape.hull);
        case ShapeKind::compound:
            return of_compound(*shape.parts);
        case ShapeKind::mesh:
            break;
    }
    fail_precondition(__func__, "a mesh has no inside", "mesh");
}

Pose principal_frame(const MassProperties& properties) {
    const Mat3 axes = nearest_to_identity(eigenvectors(properties.inertia_per_kg_m2));
    return {properties.centre_m, Quat(axes).normalized()};
}

}  // namespace handhold
