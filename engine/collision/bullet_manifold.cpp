// Face-face contacts of hulls come from Bullet's polygon clipping, those of two boxes from clipping
// in the boxes' own axes, at a quarter of the cost. This file also adds two points for nearly
// parallel edges (Bullet gives one, and its perturbed manifolds are off by up to 0.7 mm) and the
// curved sides of cylinders.
#include "engine/collision/bullet_manifold.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <BulletCollision/NarrowPhaseCollision/btPolyhedralContactClipping.h>

#include "engine/collision/box_polygon.hpp"
#include "engine/collision/contact_outline.hpp"

namespace handhold {
namespace {

// A face counts as the supporting feature if its normal is within 5 degrees of the contact normal;
// the contact points still lie on both surfaces.
constexpr double k_face_cosine = 0.996;
constexpr double k_edge_sine = 0.09;
constexpr double k_no_limit_m = 1e30;

// Calls visit(from, to) for every edge of the core. A round core has one: the line on its side that
// is farthest along `direction`.
template <typename Visit>
void visit_edges(const Convex& convex, const Vec3& direction, const Visit& visit) {
    if (convex.faces == nullptr || convex.barrel != nullptr) {
        const auto [from, to] = convex.side_line(direction);
        visit(from, to);
        return;
    }
    const auto corner = [&](int index) {
        return from_bullet(convex.pose_ns * convex.faces->m_vertices[index]);
    };
    for (int i = 0; i < convex.faces->m_faces.size(); ++i) {
        const auto& loop = convex.faces->m_faces[i].m_indices;
        for (int k = 0; k < loop.size(); ++k) {
            visit(corner(loop[k]), corner(loop[(k + 1) % loop.size()]));
        }
    }
}

Vec3 to_local(const Convex& convex, const Vec3& direction) {
    return from_bullet(to_bullet(direction) * convex.pose_ns.getBasis());
}

// The axis of the box face that is nearest to `local`, a direction in the box's axes, and the side
// on which it is.
struct BoxFace {
    int axis = 0;
    double side = 1.0;

    explicit BoxFace(const Vec3& local) {
        local.cwiseAbs().maxCoeff(&axis);
        side = local[axis] >= 0.0 ? 1.0 : -1.0;
    }
};

double facing_cosine(const Convex& convex, const Vec3& direction) {
    if (convex.box_half_m != nullptr) {
        return to_local(convex, direction).cwiseAbs().maxCoeff();
    }
    return convex.faces == nullptr ? 0.0
                                   : convex.face_normal(convex.facing(direction)).dot(direction);
}

// Finds the core's farthest feature along `direction`: a face, else a segment if it is within 30
// degrees of perpendicular to `direction`, else a point. Writes a point twice, because Bullet
// cannot clip a polygon with one corner.
void supporting_feature(const Convex& convex, const Vec3& direction,
                        btAlignedObjectArray<btVector3>& polygon) {
    polygon.resizeNoInitialize(0);
    const bool on_end =
        convex.barrel != nullptr && facing_cosine(convex, direction) > k_face_cosine;
    if (convex.faces == nullptr || (convex.barrel != nullptr && !on_end)) {
        auto [from, to] = convex.side_line(direction);
        if (std::abs((to - from).dot(direction)) > 0.5 * (to - from).norm()) {
            from = to = convex.support(direction);
        }
        polygon.push_back(to_bullet(from));
        polygon.push_back(to_bullet(to));
        return;
    }
    const auto& loop = convex.faces->m_faces[convex.facing(direction)].m_indices;
    for (int k = 0; k < loop.size(); ++k) {
        polygon.push_back(convex.pose_ns * convex.faces->m_vertices[loop[k]]);
    }
}

struct Pair {
    const Convex& a;
    const Convex& b;
    Vec3 normal;
    double margin_m;
    ClipScratch& scratch;
    std::vector<NearContact>& contacts;

    // `core_a` and `core_b` are points of the cores; the radii are added here.
    void add(const Vec3& core_a, const Vec3& core_b) const {
        const double separation = normal.dot(core_a - core_b) - a.radius_m - b.radius_m;
        if (separation < margin_m) {
            contacts.push_back(
                {core_a - a.radius_m * normal, core_b + b.radius_m * normal, normal, separation});
        }
    }
};

// clip() for two boxes.
template <typename Visit>
void clip_boxes(const Convex& ground, const Convex& body, const Vec3& up, const Visit& visit) {
    constexpr double k_inside_m = 1e-9;  // offset of the sides, as in Convex::prisms
    const BoxFace face(to_local(ground, up));
    const BoxFace incident(to_local(body, -up));
    const btTransform to_ground = ground.pose_ns.inverseTimes(body.pose_ns);
    BoxPolygon polygon;
    for (const Vec3& corner : box_face(*body.box_half_m, incident.axis, incident.side)) {
        polygon.add(from_bullet(to_ground * to_bullet(corner)));
    }
    polygon.clip_to_face(*ground.box_half_m + Vec3::Constant(k_inside_m), face.axis);
    for (std::size_t k = 0; k < polygon.count; ++k) {
        Vec3 foot = polygon.corners[k];
        foot[face.axis] = face.side * (*ground.box_half_m)[face.axis];
        visit(from_bullet(ground.pose_ns * to_bullet(polygon.corners[k])),
              from_bullet(ground.pose_ns * to_bullet(foot)));
    }
}

// Clips the supporting feature of `body` against the face of `ground`. Calls visit(point, foot) for
// each remaining corner; `foot` is its projection onto the face. `up` points from ground to body.
template <typename Visit>
void clip(const Convex& ground, const Convex& body, const Vec3& up, ClipScratch& scratch,
          const Visit& visit) {
    if (ground.box_half_m != nullptr && body.box_half_m != nullptr) {
        clip_boxes(ground, body, up, visit);
        return;
    }
    struct Collector final : btDiscreteCollisionDetectorInterface::Result {
        Collector(const Vec3& normal, const Visit& take) : face_normal(normal), visit(take) {}
        void setShapeIdentifiersA(int /*part*/, int /*index*/) override {}
        void setShapeIdentifiersB(int /*part*/, int /*index*/) override {}
        void addContactPoint(const btVector3& /*normal*/, const btVector3& point,
                             btScalar height) override {
            visit(from_bullet(point), Vec3(from_bullet(point) - height * face_normal));
        }
        Vec3 face_normal;
        const Visit& visit;
    };
    supporting_feature(body, -up, scratch.polygon);
    Collector collector(ground.face_normal(ground.facing(up)), visit);
    btPolyhedralContactClipping::clipFaceAgainstHull(
        to_bullet(Vec3(-up)), *ground.prisms, ground.pose_ns, scratch.polygon, scratch.clipped,
        -k_no_limit_m, k_no_limit_m, collector);
}

bool add_faces(const Pair& pair) {
    const double cosine_a = facing_cosine(pair.a, -pair.normal);
    const double cosine_b = facing_cosine(pair.b, pair.normal);
    if (cosine_b > k_face_cosine && cosine_b + 1e-9 >= cosine_a) {
        clip(pair.b, pair.a, pair.normal, pair.scratch,
             [&](const Vec3& point, const Vec3& foot) { pair.add(point, foot); });
        return true;
    }
    if (cosine_a > k_face_cosine) {
        clip(pair.a, pair.b, -pair.normal, pair.scratch,
             [&](const Vec3& point, const Vec3& foot) { pair.add(foot, point); });
        return true;
    }
    return false;
}

std::optional<std::array<Vec3, 2>> supporting_box_edge(const Convex& box, const Vec3& direction) {
    const Vec3 local = to_local(box, direction);
    int axis = 0;
    if (local.cwiseAbs().minCoeff(&axis) >= k_edge_sine) {
        return std::nullopt;
    }
    Vec3 from = box.box_half_m->array() *
                (local.array() >= 0.0).select(Vec3::Ones(), -Vec3::Ones()).array();
    Vec3 to = from;
    from[axis] = -(*box.box_half_m)[axis];
    to[axis] = (*box.box_half_m)[axis];
    return std::array{from_bullet(box.pose_ns * to_bullet(from)),
                      from_bullet(box.pose_ns * to_bullet(to))};
}

// The edge at the support vertex that is most nearly perpendicular to `direction`. nullopt if the
// sine of each edge's deviation is above k_edge_sine.
std::optional<std::array<Vec3, 2>> supporting_edge(const Convex& convex, const Vec3& direction) {
    if (convex.box_half_m != nullptr) {
        return supporting_box_edge(convex, direction);
    }
    const Vec3 outermost = convex.support(direction);
    std::optional<std::array<Vec3, 2>> best;
    double lowest = k_edge_sine;
    visit_edges(convex, direction, [&](const Vec3& from, const Vec3& to) {
        const double sine = std::abs((to - from).normalized().dot(direction));
        const bool is_outermost =
            std::min((from - outermost).norm(), (to - outermost).norm()) < k_same_place_m;
        if (is_outermost && from != to && sine < lowest) {
            lowest = sine;
            best = {from, to};
        }
    });
    return best;
}

// Adds a contact at each end of the common part of two nearly parallel edges.
void add_edges(const Pair& pair) {
    const auto edge_a = supporting_edge(pair.a, -pair.normal);
    const auto edge_b = supporting_edge(pair.b, pair.normal);
    if (!edge_a || !edge_b) {
        return;
    }
    const Vec3 along_b = (*edge_b)[1] - (*edge_b)[0];
    const Vec3 along_a = (*edge_a)[1] - (*edge_a)[0];
    if (std::abs(along_a.normalized().dot(along_b.normalized())) < k_face_cosine) {
        return;
    }
    for (const Vec3& end : *edge_b) {
        const Vec3 on_a = closest_on_segment(end, (*edge_a)[0], (*edge_a)[1]);
        pair.add(on_a, closest_on_segment(on_a, (*edge_b)[0], (*edge_b)[1]));
    }
}

}  // namespace

void add_manifold(const Convex& a, const Convex& b, const CoreSeparation& separation,
                  double margin_m, ClipScratch& scratch, std::vector<NearContact>& contacts) {
    const std::size_t first = contacts.size();
    const Pair pair{a, b, separation.normal, margin_m, scratch, contacts};
    if (!add_faces(pair)) {
        add_edges(pair);
    }
    double lowest = std::numeric_limits<double>::infinity();
    for (std::size_t i = first; i < contacts.size(); ++i) {
        lowest = std::min(lowest, contacts[i].separation_m);
    }
    if (separation.separation_m - a.radius_m - b.radius_m < lowest - k_same_place_m) {
        pair.add(separation.point_a_ns, separation.point_b_ns);
    }
}

void add_face_manifold(const Convex& a, const Convex& b, const Vec3& normal, double margin_m,
                       ClipScratch& scratch, std::vector<NearContact>& contacts) {
    const Pair pair{a, b, normal, margin_m, scratch, contacts};
    clip(b, a, normal, scratch,
         [&](const Vec3& point, const Vec3& foot) { pair.add(point, foot); });
}

}  // namespace handhold
