#include "game/view/gizmos.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "game/view/hand_gizmos.hpp"

namespace handhold {
namespace {

constexpr Color k_tracked = {0.9F, 0.9F, 0.95F};
constexpr Color k_ray = {0.1F, 0.75F, 1.0F};
constexpr Color k_grip = {0.2F, 1.0F, 0.35F};
constexpr Color k_velocity = {0.85F, 0.3F, 1.0F};
constexpr Color k_apart = {1.0F, 0.85F, 0.1F};
constexpr Color k_overlaps = {1.0F, 0.05F, 0.05F};
constexpr Color k_joint = {0.1F, 0.9F, 0.8F};
constexpr Color k_bone = {1.0F, 0.6F, 0.15F};
constexpr Color k_pole = {0.3F, 0.6F, 1.0F};
constexpr Color k_residual = {1.0F, 0.1F, 0.3F};
// Scale of drawn residuals: a millimetre is drawn as a metre.
constexpr double k_residual_scale = 1000.0;
constexpr double k_longest_residual_m = 0.5;  // maximum drawn length

void add_cross(const Vec3& at_ws, double size_m, const Color& color, std::vector<Line>& out) {
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 half = 0.5 * size_m * Vec3::Unit(axis);
        out.push_back({at_ws - half, at_ws + half, color, 2.0});
    }
}

void add_axes(const Pose& pose_ws, double size_m, std::vector<Line>& out) {
    for (int axis = 0; axis < 3; ++axis) {
        Color color = {0.08F, 0.08F, 0.08F};
        color[static_cast<std::size_t>(axis)] = 1.0F;
        out.push_back({pose_ws.position,
                       pose_ws.position + size_m * (pose_ws.rotation * Vec3::Unit(axis)), color,
                       2.0});
    }
}

// A distinct colour for each island, for any number of islands (golden ratio hues).
Color island_color(std::size_t island) {
    const auto part = [&](double shift) {
        const double turn = 0.618034 * static_cast<double>(island) + shift;
        return static_cast<float>(0.5 + 0.5 * std::cos(6.2831853 * turn));
    };
    return {part(0.0), part(1.0 / 3.0), part(2.0 / 3.0)};
}

void add_hands(const World& world, const GizmoSet& on, std::vector<Line>& out) {
    const auto shows = [&](Gizmo gizmo) { return on[static_cast<std::size_t>(gizmo)]; };
    for (const RenderPose& render : world.render_pose.elements()) {
        for (const RenderPose::Hand& hand : render.hands) {
            const bool grips = hand.grip != GripKind::none;
            if (shows(Gizmo::tracked_hands)) {
                add_axes(hand.tracked_ws, 0.08, out);
                out.push_back({hand.tracked_ws.position, hand.shown_ws.position, k_tracked, 3.0});
            }
            if (shows(Gizmo::palm_rays)) {
                out.push_back({hand.ray_from_ws, hand.ray_to_ws, grips ? k_grip : k_ray, 2.5});
            }
            if (shows(Gizmo::grips) && grips) {
                out.push_back({render.head_ws.position, hand.shown_ws.position, k_grip, 1.5});
            }
        }
    }
    if (!shows(Gizmo::grips)) {
        return;
    }
    for (const Grab& grab : world.grab.elements()) {
        if (grab.kind == GripKind::surface || grab.kind == GripKind::held) {
            const Pose& body_ws = world.body_pose.at(grab.body).pose_ws;
            const Vec3 hit_ws = transform_point(body_ws, grab.hit_bs);
            add_cross(hit_ws, 0.03, k_grip, out);
            out.push_back(
                {hit_ws, hit_ws + 0.08 * (body_ws.rotation * grab.hit_normal_bs), k_grip, 2.5});
        }
    }
}

// Draws a line from `from_ws` through all joints in turn.
void add_bones(const Vec3& from_ws, std::span<const Pose> joints_ws, const Color& color,
               std::vector<Line>& out) {
    Vec3 last = from_ws;
    for (const Pose& joint_ws : joints_ws) {
        out.push_back({last, joint_ws.position, color, 3.0});
        last = joint_ws.position;
    }
}

void add_arms(const ArmPose& pose, std::vector<Line>& out) {
    for (const ArmPose::Arm& arm : pose.arms) {
        const std::array<Pose, 4> joints = {arm.clavicle_ws, arm.upper_ws, arm.forearm_ws,
                                            arm.hand_ws};
        add_bones(pose.chest_ws.position, joints, k_bone, out);
        const Pose& elbow = arm.forearm_ws;
        out.push_back({elbow.position, elbow.position + 0.15 * (elbow.rotation * Vec3::UnitY()),
                       k_pole, 2.5});
    }
}

void add_spine(const SpinePose& pose, std::vector<Line>& out) {
    const std::array<Pose, 3> spine = {pose.spine_ws[1], pose.spine_ws[2], pose.pelvis_ws};
    add_bones(pose.chest_ws.position, spine, k_bone, out);
    for (const SpinePose::Leg& leg : pose.legs) {
        const std::array<Pose, 3> joints = {leg.thigh_ws, leg.shin_ws, leg.foot_ws};
        add_bones(pose.pelvis_ws.position, joints, k_bone, out);
        add_axes(leg.foot_ws, 0.1, out);
    }
    add_axes(pose.chest_ws, 0.15, out);
    add_axes(pose.pelvis_ws, 0.15, out);
}

void add_velocities(const World& world, std::vector<Line>& out) {
    constexpr double k_shown_s = 0.25;  // velocities are drawn as the path of this time
    constexpr double k_min_mps = 1e-3;
    for (std::size_t index = 0; index < world.body_velocity.size(); ++index) {
        const BodyVelocity& velocity = world.body_velocity.elements()[index];
        const Entity body = world.body_velocity.owners()[index];
        if (velocity.linear_mps.norm() > k_min_mps) {
            const Vec3 from_ws = world.body_pose.at(body).pose_ws.position;
            out.push_back({from_ws, from_ws + k_shown_s * velocity.linear_mps, k_velocity, 2.0});
        }
    }
}

void add_contact(const FrameGraph& graph, const RowBlock& block, std::vector<Line>& out) {
    const auto& bodies = graph.graph.bodies;
    const SolverBody& b = bodies[block.b];
    const Vec3 point_ws = transform_point(b.pose_ws, block.point_b_bs);
    const double separation_m = contact_separation_m(bodies, block);
    constexpr double k_penetration_slop_m = -1e-4;
    const Color& color = separation_m < k_penetration_slop_m ? k_overlaps : k_apart;
    add_cross(point_ws, 0.02, color, out);
    out.push_back(
        {point_ws, point_ws + 0.1 * (b.pose_ws.rotation * block.normal_b_bs), color, 2.0});
}

void add_joint(const FrameGraph& graph, const RowBlock& block, std::vector<Line>& out) {
    const SolverBody& a = graph.graph.bodies[block.a];
    const SolverBody& b = graph.graph.bodies[block.b];
    const Vec3 point_ws = transform_point(b.pose_ws, block.point_b_bs);
    if (a.role != BodyRole::fixed) {
        out.push_back({a.pose_ws.position, point_ws, k_joint, 1.5});
    }
    if (b.role != BodyRole::fixed) {
        out.push_back({b.pose_ws.position, point_ws, k_joint, 1.5});
    }
    if (block.kind == RowKind::hinge || block.kind == RowKind::slider) {
        const Vec3 axis = 0.08 * (b.pose_ws.rotation * (block.rotation_b_bs * Vec3::UnitX()));
        out.push_back({point_ws - axis, point_ws + axis, k_joint, 4.0});
    } else {
        add_cross(point_ws, 0.02, k_joint, out);
    }
}

// Draws the residual of a block, a thousand times as long.
void add_residual(const FrameGraph& graph, const RowBlock& block, std::vector<Line>& out) {
    const Vec3 point_ws = transform_point(graph.graph.bodies[block.b].pose_ws, block.point_b_bs);
    // Uses the block's error, not the distance of its points: a slider's points may be apart
    // without any error.
    const double error_m = block_error_m(graph.graph.bodies, block);
    const Vec3 towards =
        is_contact(block) ? Vec3(graph.graph.bodies[block.b].pose_ws.rotation * block.normal_b_bs)
                          : point_error(graph.graph.bodies, block);
    const double shown_m = std::min(k_residual_scale * error_m, k_longest_residual_m);
    if (shown_m > 1e-3 && towards.norm() > 0.0) {
        out.push_back({point_ws, point_ws + shown_m * towards.normalized(), k_residual, 4.0});
    }
}

void add_islands(const ConstraintGraph& graph, std::vector<Line>& out) {
    for (std::size_t i = 0; i < graph.islands.size(); ++i) {
        const Color color = island_color(i);
        for (const std::uint32_t index : graph.blocks_of(graph.islands[i])) {
            const RowBlock& block = graph.blocks[index];
            const SolverBody& a = graph.bodies[block.a];
            const SolverBody& b = graph.bodies[block.b];
            const Vec3 point_ws = transform_point(b.pose_ws, block.point_b_bs);
            for (const SolverBody* const body : {&a, &b}) {
                if (body->role != BodyRole::fixed) {
                    const Vec3 center_ws = transform_point(body->pose_ws, body->collider_offset_bs);
                    out.push_back({center_ws, point_ws, color, 3.0});
                }
            }
        }
    }
}

}  // namespace

GizmoInfo info_of(Gizmo gizmo) {
    switch (gizmo) {
        case Gizmo::tracked_hands:
            return {"tracked hands", "read_tracking", "where the controllers report the hands"};
        case Gizmo::palm_rays:
            return {"palm rays", "update_grabs", "where each palm searches; green while it grips"};
        case Gizmo::grips:
            return {"grips", "anchor_grabs", "anchor point and normal of each grip"};
        case Gizmo::velocities:
            return {"velocities", "predict_bodies", "where bodies will be in 0.25 s"};
        case Gizmo::contacts:
            return {"contacts", "find_contacts", "points and normals; red where they overlap"};
        case Gizmo::joints:
            return {"joints", "build_constraints", "bodies to joints; axes of hinges and sliders"};
        case Gizmo::islands:
            return {"islands", "build_constraints", "bodies solved together, one colour each"};
        case Gizmo::residuals:
            return {"residuals", "solve_phases",
                    "remaining constraint errors, drawn 1000 times as long"};
        case Gizmo::search:
            return {"search", "search_grip",
                    "visited triangles, first ones brightest; green: the palm's"};
        case Gizmo::palm_limits:
            return {"palm limits", "constrain_palms", "allowed height and tilt of the palm"};
        case Gizmo::cuts:
            return {"cuts", "sweep_fingers",
                    "from the palm to each finger disc's cut through the surface, and the cut"};
        case Gizmo::snap_zones:
            return {"snap zones", "update_grabs", "where a closing hand snaps to an authored grip"};
        case Gizmo::fingers:
            return {"fingers", "sweep_fingers", "disc of each finger; green where it touches"};
        case Gizmo::fit:
            return {"fit", "fit_hands",
                    "each digit in the colour of its costliest term (page Hands); grey: none"};
        case Gizmo::arms:
            return {"arms", "pose_arms", "arm bones, and the direction of each elbow"};
        case Gizmo::spine:
            return {"spine and legs", "propagate_spine", "the trailing chain; chest and pelvis"};
        case Gizmo::count:
            break;
    }
    return {"", "", ""};
}

void add_gizmos(const World& world, const FrameCaches& caches, const Tuning& tuning,
                const GizmoSet& on, std::vector<Line>& out) {
    const FrameGraph& graph = caches.graph;
    const auto shows = [&](Gizmo gizmo) { return on[static_cast<std::size_t>(gizmo)]; };
    add_hands(world, on, out);
    add_hand_gizmos(world, caches, tuning, on, out);
    for (const RenderPose& render : world.render_pose.elements()) {
        if (shows(Gizmo::arms)) {
            add_arms(render.arms, out);
        }
        if (shows(Gizmo::spine)) {
            add_spine(render.spine, out);
        }
    }
    if (shows(Gizmo::velocities)) {
        add_velocities(world, out);
    }
    for (const RowBlock& block : graph.graph.blocks) {
        if (is_contact(block) && shows(Gizmo::contacts)) {
            add_contact(graph, block, out);
        }
        if (is_joint(block) && shows(Gizmo::joints)) {
            add_joint(graph, block, out);
        }
        if (shows(Gizmo::residuals)) {
            add_residual(graph, block, out);
        }
    }
    if (shows(Gizmo::islands)) {
        add_islands(graph.graph, out);
    }
}

}  // namespace handhold
