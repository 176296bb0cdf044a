#include "game/view/hand_gizmos.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <span>

#include "engine/geometry/disc_trace.hpp"
#include "game/view/explain_fit.hpp"
#include "systems/hand/search_grip.hpp"
#include "systems/hand/shared/finger_chain.hpp"
#include "systems/rigs/hand_kinematics.hpp"

namespace handhold {
namespace {

constexpr Color k_first_visited = {1.0F, 1.0F, 0.3F};
constexpr Color k_last_visited = {0.55F, 0.05F, 0.35F};
constexpr Color k_chosen = {0.2F, 1.0F, 0.35F};
constexpr Color k_limit = {0.3F, 0.7F, 1.0F};
constexpr Color k_disc = {0.75F, 0.75F, 0.8F};
constexpr Color k_touches = {0.2F, 1.0F, 0.35F};
constexpr Color k_touches_not = {1.0F, 0.55F, 0.1F};
constexpr int k_circle_sides = 32;

Color blend(const Color& a, const Color& b, float share) {
    Color color{};
    for (std::size_t i = 0; i < color.size(); ++i) {
        color[i] = a[i] + share * (b[i] - a[i]);
    }
    return color;
}

// An arc from `x` towards `y`. The length of both vectors is the radius.
void add_arc(const Vec3& center_ws, const Vec3& x, const Vec3& y, double angle_rad,
             const Color& color, std::vector<Line>& out) {
    const auto point = [&](int i) {
        double s = 0.0;
        double c = 1.0;
        sin_cos(angle_rad * i / k_circle_sides, s, c);
        return Vec3(center_ws + c * x + s * y);
    };
    for (int i = 0; i < k_circle_sides; ++i) {
        out.push_back({point(i), point(i + 1), color, 1.5});
    }
}

// Draws the triangles that the search visited, from bright to dark; the chosen one is green.
void add_search(const HandSurroundings& hand, const GripSurface& chosen, const Tuning& tuning,
                std::vector<Line>& out) {
    constexpr double k_shown_m = 1e-3;  // offset from the surface
    if (hand.meshes.empty()) {
        return;
    }
    GripSearchScratch scratch;
    Column<GripSurface> surface;
    surface.add(hand.hand);
    StageStats stats;
    search_grip({.hands = std::span(&hand, 1), .surface = surface, .scratch = scratch}, tuning,
                stats);
    const SurfaceGraph& graph = hand.meshes.front().mesh->search;
    const Pose mesh_ws = hand.body_ws * hand.meshes.front().pose;
    const auto outline = [&](std::uint32_t triangle, const Color& color, double width_px) {
        const Vec3 off = k_shown_m * graph.normals[triangle];
        for (std::size_t i = 0; i < 3; ++i) {
            const auto& corners = graph.triangles[triangle];
            out.push_back({transform_point(mesh_ws, graph.positions[corners[i]] + off),
                           transform_point(mesh_ws, graph.positions[corners[(i + 1) % 3]] + off),
                           color, width_px});
        }
    };
    const std::size_t count = scratch.found.size();
    for (std::size_t i = count; i-- > 0;) {  // triangles visited first are drawn on top
        const float share =
            static_cast<float>(i) / static_cast<float>(std::max<std::size_t>(count, 2) - 1);
        outline(scratch.found[i].triangle, blend(k_first_visited, k_last_visited, share), 1.5);
    }
    if (chosen.triangle < graph.triangles.size()) {
        outline(chosen.triangle, k_chosen, 3.0);
    }
}

// Draws the palm's allowed height above the surface, and its allowed tilt.
void add_palm_limits(const HandSurroundings& hand, const GripSurface& surface, const Pose& palm_ws,
                     const PalmTuning& tuning, std::vector<Line>& out) {
    constexpr double k_cone_m = 0.06;
    const Vec3 point_ws = transform_point(hand.body_ws, surface.point_bs);
    const Vec3 normal = hand.body_ws.rotation * surface.normal_bs;
    const Vec3 x = normal.unitOrthogonal();
    const Vec3 y = normal.cross(x);
    for (const double height_m : {tuning.min_height_m, tuning.max_height_m}) {
        add_arc(point_ws + height_m * normal, 0.02 * x, 0.02 * y, k_two_pi, k_limit, out);
    }
    double lean_sine = 0.0;
    double lean_cosine = 1.0;
    sin_cos(tuning.max_angle_rad, lean_sine, lean_cosine);
    const Vec3 palm_center_ws = transform_point(palm_ws, hand.rig->palm_center_hs);
    add_arc(palm_center_ws + k_cone_m * lean_cosine * normal, k_cone_m * lean_sine * x,
            k_cone_m * lean_sine * y, k_two_pi, k_limit, out);
    const Vec3 back = palm_ws.rotation * -hand.rig->palm_normal_hs;
    out.push_back({palm_center_ws, palm_center_ws + k_cone_m * back, k_chosen, 2.5});
    out.push_back({point_ws, palm_center_ws, k_limit, 1.5});
}

// Returns the point of the hand's surroundings nearest to `point_ws`, within `within_m`.
std::optional<Vec3> nearest_ws(const HandSurroundings& hand, const Vec3& point_ws,
                               double within_m) {
    std::optional<Vec3> nearest;
    for (const PlacedMesh& placed : hand.meshes) {
        const Pose mesh_ws = hand.body_ws * placed.pose;
        const auto near = placed.mesh->contact_bvh.closest_point(
            inverse_transform_point(mesh_ws, point_ws), within_m);
        if (near) {
            within_m = near->distance_m;
            nearest = transform_point(mesh_ws, near->point);
        }
    }
    return nearest;
}

// Draws where the finger's disc cuts the surface, and a line from the search's start point to the
// cut. The stage may have reused the last frame's result, so this function searches again, with the
// disc in the open finger's middle plane and on the search detail of the gripped body's mesh.
void add_cut(const HandSurroundings& hand, const GripSurface& surface, const FingerRig& finger,
             const Pose& palm_ws, TraceScratch& scratch, std::vector<Line>& out) {
    constexpr double k_shown_m = 1.5e-3;  // offset from the surface
    const PlacedMesh& placed = hand.meshes.front();
    const SurfaceGraph& graph = placed.mesh->search;
    const Pose mesh_ws = hand.body_ws * placed.pose;
    const Pose base =
        inverse(mesh_ws) * palm_ws * finger_link_frames(finger, coupled_angles(finger, 0.0))[0];
    Disc disc;
    disc.center = base.position;
    disc.x_axis = base.rotation * -Vec3::UnitZ();
    disc.y_axis = base.rotation * -Vec3::UnitY();
    disc.normal = disc.x_axis.cross(disc.y_axis);
    disc.radius_m = 0.0;
    for (std::uint32_t link = 0; link < finger.link_count; ++link) {
        disc.radius_m += finger.length_m[link];
    }
    const ChainSeed starts =
        chain_seed(hand, surface, finger_chain(finger, 0.0, inverse(hand.body_ws) * palm_ws));
    const CrossingSearch found = find_crossing(graph, disc, starts, scratch);
    if (found.triangle == k_no_triangle) {
        return;
    }
    const auto distance_m = [&](const GraphPoint& start) {
        return start.triangle == k_no_triangle ? std::numeric_limits<double>::infinity()
                                               : (start.point - found.point).norm();
    };
    const Vec3& from = starts[distance_m(starts[0]) <= distance_m(starts[1]) ? 0 : 1].point;
    const Vec3 off = k_shown_m * graph.normals[found.triangle];
    out.push_back({transform_point(mesh_ws, from + off),
                   transform_point(mesh_ws, found.point + off), k_first_visited, 2.5});
    std::vector<DiscSegment> segments;
    walk_crossing(graph, disc, found.triangle, scratch, segments);
    for (const DiscSegment& segment : segments) {
        const auto point = [&](const Vec2& at) {
            return transform_point(mesh_ws,
                                   disc.center + at.x() * disc.x_axis + at.y() * disc.y_axis);
        };
        out.push_back({point(segment.a_ds), point(segment.b_ds), k_chosen, 3.5});
    }
}

// For each authored grip, draws a sphere of the zone's radius around the palm of the authored pose.
void add_snap_zones(const World& world, const Tuning& tuning, std::vector<Line>& out) {
    for (std::size_t index = 0; index < world.authored_grips.size(); ++index) {
        const AuthoredGrips& grips = world.authored_grips.elements()[index];
        const Pose& body_ws = world.body_pose.at(world.authored_grips.owners()[index]).pose_ws;
        for (std::size_t i = 0; i < grips.count; ++i) {
            for (const HandSide side : {HandSide::left, HandSide::right}) {
                const AuthoredHand& hand = grips.grips[i].hands[index_of(side)];
                Vec3 palm_hs = tuning.hand.palm_center_m;
                palm_hs.x() *= side == HandSide::right ? 1.0 : -1.0;
                const Vec3 center_ws = transform_point(body_ws * hand.wrist_bs, palm_hs);
                for (int axis = 0; axis < 3 && hand.is_there; ++axis) {
                    const double radius_m = grips.grips[i].snap_radius_m;
                    add_arc(center_ws, radius_m * Vec3::Unit(axis),
                            radius_m * Vec3::Unit((axis + 1) % 3), k_two_pi, k_limit, out);
                }
            }
        }
    }
}

// Draws the sector in which a finger flexes, from open to closed, its links, and lines to the
// points that the links touch.
void add_finger(const HandSurroundings& hand, const FingerRig& finger, const FingerAngles& angles,
                const Pose& palm_ws, std::vector<Line>& out) {
    constexpr double k_touch_m = 1.5e-3;
    FingerAngles open = coupled_angles(finger, 0.0);
    open.opposition_rad = angles.opposition_rad;
    const Pose base_ws = palm_ws * finger_link_frames(finger, open)[0];
    double reach_m = 0.0;
    double curl_rad = 0.0;
    for (std::uint32_t link = 0; link < finger.link_count; ++link) {
        reach_m += finger.length_m[link];
        curl_rad += finger.upper_rad[link] - finger.lower_rad[link];
    }
    const Vec3 along = base_ws.rotation * Vec3(0.0, 0.0, -reach_m);
    const Vec3 down = base_ws.rotation * Vec3(0.0, -reach_m, 0.0);
    add_arc(base_ws.position, along, down, std::min(curl_rad, k_two_pi), k_disc, out);
    out.push_back({base_ws.position, base_ws.position + along, k_disc, 1.5});
    const auto points = finger_points(finger, angles);
    for (std::uint32_t link = 0; link < finger.link_count; ++link) {
        const Vec3 from_ws = transform_point(palm_ws, points[link]);
        const Vec3 to_ws = transform_point(palm_ws, points[link + 1]);
        bool touches = false;
        for (const double share : {0.25, 0.5, 0.75, 1.0}) {
            const Vec3 at_ws = from_ws + share * (to_ws - from_ws);
            const auto near = nearest_ws(hand, at_ws, finger.radius_m[link] + k_touch_m);
            if (near) {
                out.push_back({at_ws, *near, k_touches, 3.0});
                touches = true;
            }
        }
        out.push_back({from_ws, to_ws, touches ? k_touches : k_touches_not, 3.0});
    }
}

// Draws a capsule's outline, a little outside it.
void add_capsule(const Vec3& a_ws, const Vec3& b_ws, double radius_m, const Color& color,
                 std::vector<Line>& out) {
    constexpr double k_shown_m = 1e-3;
    const Vec3 axis = b_ws - a_ws;
    if (axis.norm() < 1e-6) {
        return;
    }
    const Vec3 x = (radius_m + k_shown_m) * axis.unitOrthogonal();
    const Vec3 y = axis.normalized().cross(x);
    for (const double share : {0.0, 0.5, 1.0}) {
        add_arc(a_ws + share * axis, x, y, k_two_pi, color, out);
    }
    for (const Vec3& side : {x, y, Vec3(-x), Vec3(-y)}) {
        out.push_back({a_ws + side, b_ws + side, color, 2.5});
    }
}

// Draws each digit and the palm in the colour of the term that most shapes it, and a line from the
// tracked palm to the shown one.
void add_fit(const HandSurroundings& hand, const FitTerms& terms, const Pose& palm_ws,
             const FingerPose& pose, std::vector<Line>& out) {
    const auto color = [&](std::size_t part) {
        const auto term = shaping_term(terms.cost_m2[part]);
        return term ? color_of(*term) : k_at_ease;
    };
    const HandRig& rig = *hand.rig;
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        const auto points = finger_points(rig.fingers[f], pose.shown[f]);
        for (std::uint32_t link = 0; link < rig.fingers[f].link_count; ++link) {
            add_capsule(transform_point(palm_ws, points[link]),
                        transform_point(palm_ws, points[link + 1]), rig.fingers[f].radius_m[link],
                        color(f), out);
        }
    }
    for (const PalmCapsule& capsule : rig.palm) {
        add_capsule(transform_point(palm_ws, capsule.a_hs), transform_point(palm_ws, capsule.b_hs),
                    capsule.radius_m, color(FitTerms::k_palm), out);
    }
    out.push_back({transform_point(hand.body_ws * hand.wrist_bs, rig.palm_center_hs),
                   transform_point(palm_ws, rig.palm_center_hs), color_of(FitTerm::sync), 4.0});
}

}  // namespace

void add_hand_gizmos(const World& world, const FrameCaches& caches, const Tuning& tuning,
                     const GizmoSet& on, std::vector<Line>& out) {
    const auto shows = [&](Gizmo gizmo) { return on[static_cast<std::size_t>(gizmo)]; };
    if (shows(Gizmo::snap_zones)) {
        add_snap_zones(world, tuning, out);
    }
    TraceScratch scratch;
    for (const HandSurroundings& hand : caches.hands.surroundings) {
        const GripSurface* const surface = world.grip_surface.find(hand.hand);
        if (!hand.is_gripping || hand.rig == nullptr || surface == nullptr ||
            surface->triangle == GripSurface::k_none) {
            continue;
        }
        const Pose& palm_ws = world.palm_pose.at(hand.hand).pose_ws;
        if (shows(Gizmo::search)) {
            add_search(hand, *surface, tuning, out);
        }
        if (shows(Gizmo::palm_limits)) {
            add_palm_limits(hand, *surface, palm_ws, tuning.palm, out);
        }
        for (std::size_t i = 0; shows(Gizmo::cuts) && i < hand.rig->fingers.size(); ++i) {
            add_cut(hand, *surface, hand.rig->fingers[i], palm_ws, scratch, out);
        }
        for (std::size_t i = 0; shows(Gizmo::fingers) && i < hand.rig->fingers.size(); ++i) {
            add_finger(hand, hand.rig->fingers[i], world.finger_pose.at(hand.hand).shown[i],
                       palm_ws, out);
        }
        if (shows(Gizmo::fit)) {
            if (const auto terms = fit_terms_of(world, caches, tuning, hand.hand)) {
                add_fit(hand, *terms, palm_ws, world.finger_pose.at(hand.hand), out);
            }
        }
    }
}

}  // namespace handhold
