#include "engine/collision/bullet_box_separation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/collision/box_polygon.hpp"

namespace handhold {
namespace {

// An axis across two edges must be better than every face by this much: a face gives a manifold.
constexpr double k_edge_gain_m = 1e-9;
// Edges with a smaller squared sine of their angle count as parallel. Leaving their axis out errs
// by at most the sine times the boxes' size.
constexpr double k_parallel_sine2 = 1e-14;

constexpr int next_axis(int axis) { return axis == 2 ? 0 : axis + 1; }
constexpr int last_axis(int axis) { return axis == 0 ? 2 : axis - 1; }
double sign_of(double x) { return x >= 0.0 ? 1.0 : -1.0; }

struct Box {
    Mat3 axes_ns;  // columns
    Vec3 centre_ns;
    Vec3 half_m;

    explicit Box(const Convex& convex)
        : centre_ns(from_bullet(convex.pose_ns.getOrigin())), half_m(*convex.box_half_m) {
        const btMatrix3x3& basis = convex.pose_ns.getBasis();
        for (int row = 0; row < 3; ++row) {
            axes_ns.row(row) = from_bullet(basis[row]);
        }
    }
    Vec3 at(const Vec3& point_bs) const { return centre_ns + axes_ns * point_bs; }
};

// Two boxes in each other's axes.
struct Boxes {
    Box a;
    Box b;
    Mat3 turn;    // turn(i, j): cosine between axis i of a and axis j of b
    Mat3 cosine;  // absolute values of `turn`
    Vec3 in_a;    // a's centre minus b's centre, in a's axes
    Vec3 in_b;    // the same in b's axes

    Boxes(const Convex& convex_a, const Convex& convex_b)
        : a(convex_a),
          b(convex_b),
          turn(a.axes_ns.transpose() * b.axes_ns),
          cosine(turn.cwiseAbs()),
          in_a(a.axes_ns.transpose() * (a.centre_ns - b.centre_ns)),
          in_b(b.axes_ns.transpose() * (a.centre_ns - b.centre_ns)) {}
};

enum class Feature { face_a, face_b, edges };

struct Axis {
    Feature feature = Feature::face_a;
    int i = 0;  // axis of a
    int j = 0;  // axis of b
    double separation_m = -std::numeric_limits<double>::infinity();
};

// Calls visit(axis) for the six faces, then for the nine pairs of edges, until it returns false.
template <typename Visit>
void visit_axes(const Boxes& boxes, const Visit& visit) {
    const Vec3& half_a = boxes.a.half_m;
    const Vec3& half_b = boxes.b.half_m;
    for (int j = 0; j < 3; ++j) {
        const double reach = half_b[j] + boxes.cosine.col(j).dot(half_a);
        if (!visit(Axis{Feature::face_b, 0, j, std::abs(boxes.in_b[j]) - reach})) {
            return;
        }
    }
    for (int i = 0; i < 3; ++i) {
        const double reach = half_a[i] + boxes.cosine.row(i).dot(half_b);
        if (!visit(Axis{Feature::face_a, i, 0, std::abs(boxes.in_a[i]) - reach})) {
            return;
        }
    }
    for (int i = 0; i < 3; ++i) {
        const int i1 = next_axis(i);
        const int i2 = last_axis(i);
        for (int j = 0; j < 3; ++j) {
            const int j1 = next_axis(j);
            const int j2 = last_axis(j);
            const double sine2 =
                boxes.turn(i1, j) * boxes.turn(i1, j) + boxes.turn(i2, j) * boxes.turn(i2, j);
            if (sine2 < k_parallel_sine2) {
                continue;
            }
            const double along =
                std::abs(boxes.in_a[i2] * boxes.turn(i1, j) - boxes.in_a[i1] * boxes.turn(i2, j));
            const double reach =
                half_a[i1] * boxes.cosine(i2, j) + half_a[i2] * boxes.cosine(i1, j) +
                half_b[j1] * boxes.cosine(i, j2) + half_b[j2] * boxes.cosine(i, j1);
            if (!visit(Axis{Feature::edges, i, j, (along - reach) / std::sqrt(sine2)})) {
                return;
            }
        }
    }
}

Axis best_axis(const Boxes& boxes, double enough_m) {
    Axis best;
    visit_axes(boxes, [&](const Axis& axis) {
        const double gain_m = axis.feature == Feature::edges ? k_edge_gain_m : 0.0;
        if (axis.separation_m > best.separation_m + gain_m) {
            best = axis;
        }
        return best.separation_m <= enough_m;
    });
    return best;
}

// Unit, from b towards a.
Vec3 normal_of(const Boxes& boxes, const Axis& axis) {
    switch (axis.feature) {
        case Feature::face_a:
            return sign_of(boxes.in_a[axis.i]) * boxes.a.axes_ns.col(axis.i);
        case Feature::face_b:
            return sign_of(boxes.in_b[axis.j]) * boxes.b.axes_ns.col(axis.j);
        case Feature::edges:
            break;
    }
    // In a's axes, so that nearly parallel edges lose no digits.
    const int i1 = next_axis(axis.i);
    const int i2 = last_axis(axis.i);
    const double u = boxes.turn(i1, axis.j);
    const double v = boxes.turn(i2, axis.j);
    const double side = sign_of(boxes.in_a[i2] * u - boxes.in_a[i1] * v) / std::sqrt(u * u + v * v);
    return side * u * boxes.a.axes_ns.col(i2) - side * v * boxes.a.axes_ns.col(i1);
}

// The corner farthest along `direction_bs`, in the box's axes.
Vec3 corner_along(const Box& box, const Vec3& direction_bs) {
    return {sign_of(direction_bs.x()) * box.half_m.x(), sign_of(direction_bs.y()) * box.half_m.y(),
            sign_of(direction_bs.z()) * box.half_m.z()};
}

// Two edges, by their middles, that are parallel to axis i of a and axis j of b.
struct EdgePair {
    Vec3 middle_a_ns;
    Vec3 middle_b_ns;
    int i = 0;
    int j = 0;
};

// The middle of the edge parallel to `axis` that is farthest along `direction_bs`. Bit 0 and bit 1
// of `other` choose the opposite side along the two other axes.
Vec3 edge_middle(const Box& box, int axis, const Vec3& direction_bs, unsigned other) {
    Vec3 middle = corner_along(box, direction_bs);
    middle[axis] = 0.0;
    middle[next_axis(axis)] *= (other & 1U) != 0 ? -1.0 : 1.0;
    middle[last_axis(axis)] *= (other & 2U) != 0 ? -1.0 : 1.0;
    return box.at(middle);
}

// The closest points of the two edges' lines, clamped to the edges. Returns false if either is
// clamped.
bool closest_on_edges(const Boxes& boxes, const EdgePair& edges, CoreSeparation& result) {
    const Vec3 along_a = boxes.a.axes_ns.col(edges.i);
    const Vec3 along_b = boxes.b.axes_ns.col(edges.j);
    const Vec3 offset = edges.middle_a_ns - edges.middle_b_ns;
    const double cosine = boxes.turn(edges.i, edges.j);
    const double u = boxes.turn(next_axis(edges.i), edges.j);
    const double v = boxes.turn(last_axis(edges.i), edges.j);
    const double sine2 = u * u + v * v;
    const double on_a = (cosine * offset.dot(along_b) - offset.dot(along_a)) / sine2;
    const double on_b = (offset.dot(along_b) - cosine * offset.dot(along_a)) / sine2;
    const double half_a = boxes.a.half_m[edges.i];
    const double half_b = boxes.b.half_m[edges.j];
    result.point_a_ns = edges.middle_a_ns + std::clamp(on_a, -half_a, half_a) * along_a;
    result.point_b_ns = edges.middle_b_ns + std::clamp(on_b, -half_b, half_b) * along_b;
    return std::abs(on_a) <= half_a && std::abs(on_b) <= half_b;
}

// `body` as seen from a face of `ground`: its axes (as columns) and centre in ground's axes.
struct OverFace {
    const Box& ground;
    const Box& body;
    Mat3 axes;
    Vec3 centre;
    int axis = 0;  // the face's axis
    double side = 1.0;
};

// The point of the face that the body's deepest point is over, in near space. Where several corners
// of the overlap are equally deep, their mean: which of them is deepest is then rounding, and a
// corner of the body may be beside the face.
Vec3 foot_of_deepest(const OverFace& over) {
    constexpr double k_same_height_m = 1e-9;
    constexpr double k_parallel = 1e-4;
    const Vec3 into_body = -over.side * over.axes.row(over.axis).transpose();
    const auto foot = [&over](const Vec3& point) {
        Vec3 on_face = point.cwiseMin(over.ground.half_m).cwiseMax(-over.ground.half_m);
        on_face[over.axis] = over.side * over.ground.half_m[over.axis];
        return over.ground.at(on_face);
    };
    const Vec3 corner = over.centre + over.axes * corner_along(over.body, into_body);
    if (into_body.cwiseAbs().minCoeff() > k_parallel) {
        return foot(corner);
    }
    int incident = 0;
    into_body.cwiseAbs().maxCoeff(&incident);
    BoxPolygon polygon;
    for (const Vec3& point : box_face(over.body.half_m, incident, sign_of(into_body[incident]))) {
        polygon.add(over.centre + over.axes * point);
    }
    polygon.clip_to_face(over.ground.half_m, over.axis);
    if (polygon.count == 0) {  // rounding: they meet in one corner
        polygon.add(corner);
    }
    double lowest_m = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < polygon.count; ++k) {
        lowest_m = std::min(lowest_m, over.side * polygon.corners[k][over.axis]);
    }
    Vec3 sum = Vec3::Zero();
    double count = 0.0;
    for (std::size_t k = 0; k < polygon.count; ++k) {
        if (over.side * polygon.corners[k][over.axis] < lowest_m + k_same_height_m) {
            sum += polygon.corners[k];
            count += 1.0;
        }
    }
    return foot(sum / count);
}

CoreSeparation overlap_along(const Boxes& boxes, const Axis& axis) {
    CoreSeparation result;
    result.normal = normal_of(boxes, axis);
    result.separation_m = axis.separation_m;
    result.overlap = true;
    const Vec3 into_a = -(boxes.a.axes_ns.transpose() * result.normal);
    const Vec3 into_b = boxes.b.axes_ns.transpose() * result.normal;
    const Vec3 through = axis.separation_m * result.normal;
    switch (axis.feature) {
        case Feature::face_b:
            result.point_b_ns = foot_of_deepest({boxes.b, boxes.a, boxes.turn.transpose(),
                                                 boxes.in_b, axis.j, sign_of(boxes.in_b[axis.j])});
            result.point_a_ns = result.point_b_ns + through;
            break;
        case Feature::face_a:
            result.point_a_ns = foot_of_deepest(
                {boxes.a, boxes.b, boxes.turn, -boxes.in_a, axis.i, -sign_of(boxes.in_a[axis.i])});
            result.point_b_ns = result.point_a_ns - through;
            break;
        case Feature::edges:
            closest_on_edges(boxes,
                             {edge_middle(boxes.a, axis.i, into_a, 0),
                              edge_middle(boxes.b, axis.j, into_b, 0), axis.i, axis.j},
                             result);
            break;
    }
    return result;
}

// A corner of one box and the point of the other that is nearest to it.
struct CornerGap {
    double square = std::numeric_limits<double>::infinity();
    Vec3 corner;  // position in its own box's axes
    Vec3 point;   // position in the other box's axes
};

// The smallest distance of a corner of `box` to the box with half extents `other_half_m`.
// `axes`: axes of `box` in the other's axes, as columns; `centre`: its centre there.
CornerGap nearest_corner(const Vec3& half_m, const Mat3& axes, const Vec3& centre,
                         const Vec3& other_half_m) {
    CornerGap best;
    for (unsigned k = 0; k < 8; ++k) {
        const Vec3 corner((k & 1U) != 0 ? half_m.x() : -half_m.x(),
                          (k & 2U) != 0 ? half_m.y() : -half_m.y(),
                          (k & 4U) != 0 ? half_m.z() : -half_m.z());
        const Vec3 there = centre + axes * corner;
        const Vec3 point = there.cwiseMin(other_half_m).cwiseMax(-other_half_m);
        const double square = (there - point).squaredNorm();
        if (square < best.square) {
            best = {square, corner, point};
        }
    }
    return best;
}

// The closest pair of points of which one is a corner.
CoreSeparation nearest_by_corners(const Boxes& boxes) {
    const CornerGap of_a =
        nearest_corner(boxes.a.half_m, boxes.turn.transpose(), boxes.in_b, boxes.b.half_m);
    const CornerGap of_b = nearest_corner(boxes.b.half_m, boxes.turn, -boxes.in_a, boxes.a.half_m);
    CoreSeparation result;
    if (of_a.square <= of_b.square) {
        result.point_a_ns = boxes.a.at(of_a.corner);
        result.point_b_ns = boxes.b.at(of_a.point);
    } else {
        result.point_a_ns = boxes.a.at(of_b.point);
        result.point_b_ns = boxes.b.at(of_b.corner);
    }
    result.separation_m = std::sqrt(std::min(of_a.square, of_b.square));
    return result;
}

// Replaces `result` by a pair of points within two edges if these are nearer. Two edges are the
// closest features only if their axis has the largest separation. If faces are parallel to it, each
// box has several edges that are farthest along the axis, and all are tested.
void compare_edges(const Boxes& boxes, double largest_m, CoreSeparation& result) {
    visit_axes(boxes, [&](const Axis& axis) {
        if (axis.feature != Feature::edges || axis.separation_m < largest_m - k_edge_gain_m) {
            return true;
        }
        constexpr double k_parallel_face = 1e-6;
        const Vec3 normal = normal_of(boxes, axis);
        const Vec3 into_a = -(boxes.a.axes_ns.transpose() * normal);
        const Vec3 into_b = boxes.b.axes_ns.transpose() * normal;
        const auto is_tested = [&](const Vec3& into, int along, unsigned other) {
            return ((other & 1U) == 0 || std::abs(into[next_axis(along)]) < k_parallel_face) &&
                   ((other & 2U) == 0 || std::abs(into[last_axis(along)]) < k_parallel_face);
        };
        for (unsigned of_a = 0; of_a < 4; ++of_a) {
            for (unsigned of_b = 0; of_b < 4; ++of_b) {
                CoreSeparation found;
                if (is_tested(into_a, axis.i, of_a) && is_tested(into_b, axis.j, of_b) &&
                    closest_on_edges(boxes,
                                     {edge_middle(boxes.a, axis.i, into_a, of_a),
                                      edge_middle(boxes.b, axis.j, into_b, of_b), axis.i, axis.j},
                                     found)) {
                    found.separation_m = (found.point_a_ns - found.point_b_ns).norm();
                    if (found.separation_m < result.separation_m) {
                        result = found;
                    }
                }
            }
        }
        return true;
    });
}

}  // namespace

BoxAxis find_box_axis(const Convex& a, const Convex& b, double enough_m) {
    const Boxes boxes(a, b);
    const Axis axis = best_axis(boxes, enough_m);
    return {normal_of(boxes, axis), axis.separation_m};
}

std::optional<CoreSeparation> separate_boxes(const Convex& a, const Convex& b, double limit_m) {
    const Boxes boxes(a, b);
    const Axis axis = best_axis(boxes, limit_m);
    if (axis.separation_m > limit_m) {
        return std::nullopt;
    }
    if (axis.separation_m <= 0.0) {
        return overlap_along(boxes, axis);
    }
    // The axis gives a lower bound of the distance, any pair of points an upper bound.
    CoreSeparation result = nearest_by_corners(boxes);
    if (result.separation_m > axis.separation_m + k_edge_gain_m) {
        compare_edges(boxes, axis.separation_m, result);
    }
    if (result.separation_m <= axis.separation_m + k_edge_gain_m) {
        result.normal = normal_of(boxes, axis);
        result.separation_m = axis.separation_m;
    } else {
        result.normal = (result.point_a_ns - result.point_b_ns) / result.separation_m;
    }
    return result;
}

}  // namespace handhold
