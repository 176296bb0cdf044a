// Solver, model: bodies and constraints as the solver sees them. Packed arrays without entities, in
// an order that depends on persistent ids only. docs/reference/solver.md has the derivation.

#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/math/math.hpp"

namespace handhold {

enum class BodyRole : std::uint8_t {
    fixed,  // static or kinematic: never moved by the solver
    heavy,  // free, but held still by the forward phase
    free,
    translating,  // translation only (3 degrees of freedom): the solver never rotates it
};

struct SolverBody {
    std::uint64_t id = 0;  // persistent
    BodyRole role = BodyRole::fixed;
    Pose pose_ws;                      // in/out: every solve
    Vec3 velocity_mps = Vec3::Zero();  // in/out: solve_island_velocities; world axes
    Vec3 spin_radps = Vec3::Zero();    // angular velocity; world axes
    double mass_kg = 0.0;
    // Principal moments, body axes; zero for translating and fixed bodies.
    Vec3 inertia_kgm2 = Vec3::Zero();
    double restitution = 0.0;  // [0, 1]; a contact takes the larger of its bodies'
    // Coulomb coefficient; a contact takes the geometric mean of its bodies'
    double friction = 0.0;
    // The collider's centre in the body's frame; non-zero if the collider moves relative to the
    // body.
    Vec3 collider_offset_bs = Vec3::Zero();

    // Effective inverse mass in the current phase: 1/mass, a share of it, or 0 for bodies that the
    // phase holds still. Written before each solve.
    double inverse_mass = 0.0;
    Vec3 inverse_inertia_bs = Vec3::Zero();
    std::uint32_t slot = 0;  // index within its island; written by build_islands
    // only contacts hold it, and its island is a heap; written by build_islands
    bool in_heap = false;
    // False if the body's island has used up the contact searches of this frame. The body's
    // collider then stays at the pose of the last search.
    bool is_searched = true;
};

// What a block constrains. A block has a frame (point and rotation) in each of its bodies a and b.
// A joint's axis is the local x axis of its frames. Row counts include no limit rows.
enum class RowKind : std::uint8_t {
    drive_point,  // 3 rows: a's point on b's point
    drive_weld,   // 6 rows: drive_point, and a's rotation on b's
    // 3 rows: a's rotation on b's. Used for the second of two drives on one body: the rotation sets
    // the direction of the line between the drives and the twist about it (drive_pair.hpp). The
    // block's points have no rows; they may slide along the line.
    drive_direction,
    contact,   // 1 row, >= 0: separation along b's normal
    ball,      // 3 rows: a's point on b's point
    hinge,     // 5 rows: ball, and parallel axes
    slider,    // 5 rows: b's point on a's axis, and a's rotation on b's
    fixed,     // 6 rows: a's point on b's, and a's rotation on b's
    distance,  // no rows except limits on the distance of the points
};

// Limits, friction and motor of a joint's coordinate q. Unit of q: hinge, angle about the axis
// (rad); slider, travel along the axis (m); distance, length (m); ball, angle between the axes
// (rad).
struct JointRows {
    // q is kept in [lower, upper]; lower == upper: locked.
    bool limited = false;
    double lower = 0.0;
    double upper = 0.0;
    // q as expected from the last frame's q and speed. Hinge: q is known only up to whole turns;
    // the value closest to `previous` is taken.
    double previous = 0.0;
    // The fields below apply to the velocity solve only; impulses are in N s or N m s per frame.
    // Largest friction impulse about the axis (ball: about all axes) or along it.
    double friction_impulse = 0.0;
    // Motor: moves q at `motor_speed`, or towards `motor_target` at the speed that reaches it
    // within `motor_time_s`, with an impulse of at most `motor_max_impulse` (0: no motor).
    double motor_target = 0.0;  // m or rad
    double motor_time_s = 0.0;  // s; 0: the motor has a speed, not a target
    double motor_speed = 0.0;   // m/s or rad/s
    // Duration of the frame, s: adds the speed that forces such as gravity took from q since the
    // last frame, (previous - q) / motor_frame_s. 0: adds nothing.
    double motor_frame_s = 0.0;
    double motor_max_impulse = 0.0;
    // Impulse at which a lock gives way; 0: it never does.
    double lock_limit_impulse = 0.0;

    double lock_impulse = 0.0;  // out of solve_island_velocities: impulse that held the lock
};

// One constraint between two bodies. Drives: a is the driving body (BodyRole::translating), and b
// is the driven body. Contacts: a is the body with a free collider (if both have one, the body with
// the lower id). The normal is given in b's frame.
struct RowBlock {
    RowKind kind = RowKind::contact;
    std::uint32_t a = 0;  // index into ConstraintGraph::bodies
    std::uint32_t b = 0;
    // Orders blocks of one kind between the same bodies: id of the drive's source or of the joint,
    // feature id of the contact.
    std::uint64_t key = 0;
    // drives, joints: index of the drive or joint in its component column
    std::uint32_t source = 0;
    Vec3 point_a_bs = Vec3::Zero();
    Vec3 point_b_bs = Vec3::Zero();
    // Weld, joints: frame rotations; the constraint makes the two equal in the world.
    Quat rotation_a_bs = Quat::Identity();
    Quat rotation_b_bs = Quat::Identity();
    Vec3 normal_b_bs = Vec3::UnitY();  // contact: unit normal from b towards a
    // Drives: velocity and spin of the target relative to a, world axes.
    Vec3 drive_velocity_ws_mps = Vec3::Zero();
    Vec3 drive_spin_ws_radps = Vec3::Zero();
    // Contact: a sweep found it. Its two points coincide at the impact, but not at the end of the
    // frame. Each body's lever arm therefore ends at its own point, and the normal does not rotate
    // with b.
    bool is_impact = false;
    double restitution = 0.0;  // contact
    double friction = 0.0;     // contact: Coulomb coefficient
    JointRows joint;

    // Out of solve_island_velocities: linear impulse on a at its point; b gets the opposite.
    Vec3 impulse_ws_ns = Vec3::Zero();
    // Out of solve_island_velocities: angular impulse on a; b gets the opposite.
    Vec3 angular_impulse_ws_nms = Vec3::Zero();
};
inline bool is_drive(RowKind kind) {
    return kind == RowKind::drive_point || kind == RowKind::drive_weld ||
           kind == RowKind::drive_direction;
}
inline bool is_drive(const RowBlock& block) { return is_drive(block.kind); }
inline bool is_contact(const RowBlock& block) { return block.kind == RowKind::contact; }
inline bool is_joint(const RowBlock& block) { return !is_drive(block) && !is_contact(block); }

// Lever that converts angles to lengths, metres. Angular rows are multiplied by it, so that all
// residuals of a solve have one unit: for example, 0.01 rad counts as 1 mm.
inline constexpr double k_angle_lever_m = 0.1;

// Selects a row's regularisation (model/regularisation.hpp).
enum class RowGroup : std::uint8_t { drive, joint, limit, contact };

// One scalar equation of Newton's method: residual + J dx = 0 (bilateral) or >= 0 (unilateral),
// where dx stacks the translations and rotation vectors of bodies a and b in world axes and
//   J dx = linear_a . (dx_a - dx_b) + angular_a . dr_a + angular_b . dr_b
struct Row {
    Vec3 linear_a = Vec3::Zero();  // b's linear part is -linear_a
    Vec3 angular_a = Vec3::Zero();
    Vec3 angular_b = Vec3::Zero();
    // Position solve, metres: the error C at the current poses. Point rows: offset along an axis.
    // Angular rows: angle times k_angle_lever_m. Contacts: separation (negative: overlap). Limits:
    // distance to the limit, angles times k_angle_lever_m.
    //
    // Velocity solve, m/s: relative velocity along the row plus its bias (restitution, motor or
    // drive velocity). Angular rows of drives, joints and limits: rad/s times k_angle_lever_m.
    // Friction and motor rows of angular joints (append_sliding_rows): rad/s, without the lever.
    double residual = 0.0;
    std::uint32_t block = 0;  // index into ConstraintGraph::blocks
    std::uint32_t a = 0;      // index into ConstraintGraph::bodies
    std::uint32_t b = 0;
    RowGroup group = RowGroup::contact;
    bool unilateral = false;  // true: satisfied if residual >= 0
    // Number of rows of the vector-valued error that starts with this row; 0: the row belongs to
    // the error of an earlier row. Norms are taken over all rows of an error, so that they do not
    // depend on the world's orientation.
    std::uint8_t width = 1;
};

// True if the joint coordinate of this kind is an angle.
bool is_angular(RowKind kind);

// Appends the block's rows at the current poses; residuals are in metres (see Row::residual).
// Limits farther away than reach_m (angles times k_angle_lever_m) are omitted.
void append_rows(std::span<const SolverBody> bodies, const RowBlock& block,
                 std::uint32_t block_index, std::vector<Row>& rows,
                 double reach_m = std::numeric_limits<double>::infinity());

// p_a - p_b in world axes, metres: the residuals of the point rows.
Vec3 point_error(std::span<const SolverBody> bodies, const RowBlock& block);
// Rotation vector from b's frame to a's in world axes, radians; times k_angle_lever_m it is the
// residuals of the weld rows.
Vec3 rotation_error(const Quat& rotation_a_ws, const Quat& rotation_b_ws, const RowBlock& block);
// True for the first of three rows that keep a's point on b's, one row per world axis.
inline bool starts_point_rows(const Row& row) {
    return row.width == 3 && row.linear_a == Vec3::UnitX();
}

// Appends the rows that only the velocity solve has: the two tangents of a contact, the free
// directions of a joint. Residual 0. Returns their number.
std::size_t append_sliding_rows(std::span<const SolverBody> bodies, const RowBlock& block,
                                std::uint32_t block_index, std::vector<Row>& rows);

// The block's error at the current poses, metres: the larger of point error and angle times
// k_angle_lever_m, including exceeded limits; for a contact its penetration depth (0 if separated).
double block_error_m(std::span<const SolverBody> bodies, const RowBlock& block);
// A joint's error in its own units.
struct JointError {
    double point_m = 0.0;
    double angle_rad = 0.0;
};
JointError joint_error(std::span<const SolverBody> bodies, const RowBlock& block);
// Separation of a contact at the current poses, metres; negative: overlap.
double contact_separation_m(std::span<const SolverBody> bodies, const RowBlock& block);
// The joint's coordinate q (JointRows) at the current poses; 0 for fixed.
double joint_coordinate(std::span<const SolverBody> bodies, const RowBlock& block);
// Rate of change of q, m/s or rad/s.
double joint_speed(std::span<const SolverBody> bodies, const RowBlock& block);

// Inverse inertia tensor in world axes, 1/(kg m^2).
Mat3 inverse_inertia_ws(const SolverBody& body);

}  // namespace handhold
