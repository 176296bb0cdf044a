// Source: clipping an incident against a reference polygon after Sutherland and Hodgman 1974, as
// all rigid body engines do it.
#include "engine/collision/manifold.hpp"

#include <algorithm>
#include <cmath>

namespace handhold {
namespace {

// A face counts as facing along the normal up to 5 degrees: the points are then those of the faces,
// still on both surfaces.
constexpr double k_face_cosine = 0.996;
constexpr double k_edge_sine = 0.09;
constexpr double k_inside_m = 1e-9;  // points on a side plane are inside

// A quad clipped by four planes has 8 corners at most; a segment counts as a polygon of two.
struct Polygon {
    std::array<Vec3, 12> points;
    std::size_t count = 0;

    void add(const Vec3& point) {
        if (count < points.size()) {
            points[count++] = point;
        }
    }
};

struct Face {
    Polygon polygon;
    Vec3 normal = Vec3::Zero();  // zero: the core has no faces
};

// The face that looks most along `direction`.
Face supporting_face(const ConvexCore& core, const Vec3& direction) {
    Face face;
    if (core.kind == CoreKind::triangle) {
        face.normal = core.axes.col(0).dot(direction) >= 0.0 ? Vec3(core.axes.col(0))
                                                             : Vec3(-core.axes.col(0));
        for (const Vec3& vertex : core.vertices()) {
            face.polygon.add(vertex);
        }
    } else if (core.kind == CoreKind::box) {
        const Vec3 local = core.axes.transpose() * direction;
        Eigen::Index axis = 0;
        local.cwiseAbs().maxCoeff(&axis);
        const bool positive = local[axis] >= 0.0;
        face.normal = positive ? Vec3(core.axes.col(axis)) : Vec3(-core.axes.col(axis));
        const unsigned bit = 1U << axis;
        const unsigned first = 1U << ((axis + 1) % 3);
        const unsigned second = 1U << ((axis + 2) % 3);
        const unsigned base = positive ? bit : 0U;
        for (const unsigned corner : {base, base | first, base | first | second, base | second}) {
            face.polygon.add(core.vertices_ns[corner]);
        }
    }
    return face;
}

// What a core turns towards `direction`: its face, else its segment where that lies across the
// direction, else a vertex.
Polygon supporting_feature(const ConvexCore& core, const Vec3& direction) {
    Polygon polygon = supporting_face(core, direction).polygon;
    if (polygon.count > 0) {
        return polygon;
    }
    if (core.kind == CoreKind::segment && std::abs(core.axes.col(0).dot(direction)) < 0.5) {
        polygon.add(core.vertices_ns[0]);
        polygon.add(core.vertices_ns[1]);
    } else {
        polygon.add(support_vertex(core, direction));
    }
    return polygon;
}

// The part of `subject` on the inner side of the plane through `point` with outward normal
// `outward`.
Polygon clip(const Polygon& subject, const Vec3& point, const Vec3& outward) {
    Polygon result;
    for (std::size_t i = 0; i < subject.count; ++i) {
        const Vec3& from = subject.points[i];
        const Vec3& to = subject.points[(i + 1) % subject.count];
        const double before = (from - point).dot(outward) - k_inside_m;
        const double after = (to - point).dot(outward) - k_inside_m;
        if (before <= 0.0) {
            result.add(from);
        }
        if ((before < 0.0 && after > 0.0) || (before > 0.0 && after < 0.0)) {
            result.add(from + before / (before - after) * (to - from));
        }
    }
    return result;
}

// Clips by the prism over a face: its side planes stand on its edges, along its normal.
Polygon clip_by_prism(Polygon subject, const Face& face) {
    const Polygon& base = face.polygon;
    Vec3 middle = Vec3::Zero();
    for (std::size_t i = 0; i < base.count; ++i) {
        middle += base.points[i] / static_cast<double>(base.count);
    }
    for (std::size_t i = 0; i < base.count; ++i) {
        const Vec3& corner = base.points[i];
        const Vec3 edge = base.points[(i + 1) % base.count] - corner;
        Vec3 outward = edge.cross(face.normal);
        const double length = outward.norm();
        if (length > 0.0) {
            outward *= ((middle - corner).dot(outward) > 0.0 ? -1.0 : 1.0) / length;
            subject = clip(subject, corner, outward);
        }
    }
    return subject;
}

struct Pair {
    const ConvexCore& a;
    const ConvexCore& b;
    Vec3 normal;
    double margin_m;
    std::vector<NearContact>& contacts;

    // Points of the cores: the radii are added here.
    void add(const Vec3& core_a, const Vec3& core_b) const {
        const double separation = normal.dot(core_a - core_b) - a.radius_m - b.radius_m;
        if (separation < margin_m) {
            contacts.push_back(
                {core_a - a.radius_m * normal, core_b + b.radius_m * normal, normal, separation});
        }
    }
};

// Where the line through `point` along `direction` meets the plane of a face.
Vec3 onto_plane(const Vec3& point, const Vec3& direction, const Face& face) {
    const double height = (point - face.polygon.points[0]).dot(face.normal);
    return point - height / direction.dot(face.normal) * direction;
}

bool add_faces(const Pair& pair) {
    const Face face_a = supporting_face(pair.a, -pair.normal);
    const Face face_b = supporting_face(pair.b, pair.normal);
    const double cosine_a = -face_a.normal.dot(pair.normal);
    const double cosine_b = face_b.normal.dot(pair.normal);
    if (cosine_b > k_face_cosine && cosine_b + 1e-9 >= cosine_a) {
        const Polygon points = clip_by_prism(supporting_feature(pair.a, -pair.normal), face_b);
        for (std::size_t i = 0; i < points.count; ++i) {
            pair.add(points.points[i], onto_plane(points.points[i], pair.normal, face_b));
        }
        return true;
    }
    if (cosine_a > k_face_cosine) {
        const Polygon points = clip_by_prism(supporting_feature(pair.b, pair.normal), face_a);
        for (std::size_t i = 0; i < points.count; ++i) {
            pair.add(onto_plane(points.points[i], pair.normal, face_a), points.points[i]);
        }
        return true;
    }
    return false;
}

// The edge at the outermost vertex that lies most across `direction`; nullopt where none lies
// across it.
std::optional<std::array<Vec3, 2>> supporting_edge(const ConvexCore& core, const Vec3& direction) {
    const Vec3 outermost = support_vertex(core, direction);
    std::optional<std::array<Vec3, 2>> best;
    double least = k_edge_sine;
    for (const auto& edge : core_edges(core.kind)) {
        const Vec3& from = core.vertices_ns[edge[0]];
        const Vec3& to = core.vertices_ns[edge[1]];
        const double sine = std::abs((to - from).normalized().dot(direction));
        if ((from == outermost || to == outermost) && sine < least) {
            least = sine;
            best = {from, to};
        }
    }
    return best;
}

// Two edges side by side hold each other at both ends of their common part.
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

bool place_less(const NearContact& a, const NearContact& b) {
    const auto key = [](const NearContact& c) {
        return std::array<double, 7>{c.point_b_ns.x(), c.point_b_ns.y(), c.point_b_ns.z(),
                                     c.separation_m,   c.normal_ns.x(),  c.normal_ns.y(),
                                     c.normal_ns.z()};
    };
    return key(a) < key(b);
}

constexpr double k_same_normal_cosine = 1.0 - 1e-7;
constexpr double k_same_place_m = 1e-6;

// How far `point` lies to the left of the line from `from` to `to`, seen against the normal.
double height_over_line(const NearContact& from, const NearContact& to, const NearContact& point) {
    const Vec3 line = to.point_b_ns - from.point_b_ns;
    const double length = line.norm();
    return length > 0.0
               ? from.normal_ns.dot(line.cross(point.point_b_ns - from.point_b_ns)) / length
               : 0.0;
}

double distance_between(const NearContact& a, const NearContact& b) {
    return (a.point_b_ns - b.point_b_ns).norm();
}

// The corner of the group's outline that follows `from` counter-clockwise: nothing lies to the
// right of the way to it. Points along one line leave the farthest.
const NearContact& next_corner(std::span<const NearContact> group, const NearContact& from) {
    const NearContact* best = &from;
    for (const NearContact& other : group) {
        if (distance_between(from, other) <= k_same_place_m) {
            continue;
        }
        const double height = height_over_line(from, *best, other);
        const bool farther = distance_between(from, other) > distance_between(from, *best);
        if (best == &from || height < -k_same_place_m || (height <= k_same_place_m && farther)) {
            best = &other;
        }
    }
    return *best;
}

// Leaves out the flattest corners until 8 are left.
void limit_corners(std::vector<NearContact>& outline, std::size_t first) {
    constexpr std::size_t k_most = 8;
    while (outline.size() - first > k_most) {
        const std::size_t count = outline.size() - first;
        std::size_t flattest = 0;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < count; ++i) {
            const double height =
                std::abs(height_over_line(outline[first + (i + count - 1) % count],
                                          outline[first + (i + 1) % count], outline[first + i]));
            if (height < least) {
                least = height;
                flattest = i;
            }
        }
        outline.erase(outline.begin() + static_cast<std::ptrdiff_t>(first + flattest));
    }
}

// Appends what bounds one group of contacts with equal normals: its outline by gift wrapping
// (Jarvis 1973), and its deepest.
void add_outline(std::span<const NearContact> group, std::vector<NearContact>& result) {
    const Vec3 along = group.front().normal_ns.unitOrthogonal();
    const auto deeper = [](const NearContact& a, const NearContact& b) {
        return a.separation_m < b.separation_m;
    };
    const NearContact& deepest = *std::min_element(group.begin(), group.end(), deeper);
    const NearContact& start = *std::min_element(
        group.begin(), group.end(), [&](const NearContact& a, const NearContact& b) {
            return along.dot(a.point_b_ns) < along.dot(b.point_b_ns);
        });
    const std::size_t first = result.size();
    const NearContact* corner = &start;
    for (std::size_t i = 0; i < group.size(); ++i) {
        result.push_back(*corner);
        corner = &next_corner(group, *corner);
        if (distance_between(*corner, start) <= k_same_place_m) {
            break;
        }
    }
    limit_corners(result, first);
    const auto outline = std::span<const NearContact>(result).subspan(first);
    const double least = std::min_element(outline.begin(), outline.end(), deeper)->separation_m;
    if (deepest.separation_m < least - k_same_place_m) {
        result.push_back(deepest);
    }
}

}  // namespace

void add_manifold(const ConvexCore& a, const ConvexCore& b, const CoreSeparation& separation,
                  double margin_m, std::vector<NearContact>& contacts) {
    const std::size_t first = contacts.size();
    const Pair pair{a, b, separation.normal, margin_m, contacts};
    if (!add_faces(pair)) {
        add_edges(pair);
    }
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = first; i < contacts.size(); ++i) {
        least = std::min(least, contacts[i].separation_m);
    }
    if (separation.separation_m - a.radius_m - b.radius_m < least - k_same_place_m) {
        pair.add(separation.point_a_ns, separation.point_b_ns);
    }
}

void add_face_manifold(const ConvexCore& a, const ConvexCore& b, const Vec3& normal,
                       double margin_m, std::vector<NearContact>& contacts) {
    const Pair pair{a, b, normal, margin_m, contacts};
    const Face face = supporting_face(b, normal);
    const Polygon points = clip_by_prism(supporting_feature(a, -normal), face);
    for (std::size_t i = 0; i < points.count; ++i) {
        pair.add(points.points[i], onto_plane(points.points[i], normal, face));
    }
}

void reduce_contacts(std::vector<NearContact>& contacts, std::vector<NearContact>& scratch) {
    std::sort(contacts.begin(), contacts.end(), place_less);
    scratch.clear();
    // Groups are taken out one after another, each by the first normal left: small numbers, and no
    // order but that of the places decides.
    std::span<NearContact> rest = contacts;
    while (!rest.empty()) {
        const Vec3 normal = rest.front().normal_ns;
        const auto end = std::partition(rest.begin(), rest.end(), [&](const NearContact& c) {
            return c.normal_ns.dot(normal) > k_same_normal_cosine;
        });
        const auto count = static_cast<std::size_t>(end - rest.begin());
        add_outline(rest.first(count), scratch);
        rest = rest.subspan(count);
    }
    contacts.swap(scratch);
    std::sort(contacts.begin(), contacts.end(), place_less);
}

}  // namespace handhold
