#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/math/math.hpp"

// Bodies and constraints as the solver sees them: packed, without entities, in an order that
// depends on persistent ids only.
namespace handhold {

enum class BodyRole : std::uint8_t {
    fixed,  // static or kinematic: moved by nothing here
    heavy,  // free, but unmoved by the forward phase
    free,
    translating,  // three degrees of freedom: never turns
};

struct SolverBody {
    std::uint64_t id = 0;  // persistent
    BodyRole role = BodyRole::fixed;
    Pose pose_ws;                      // in/out of every solve
    Vec3 velocity_mps = Vec3::Zero();  // in/out of solve_velocities
    Vec3 spin_radps = Vec3::Zero();
    double mass_kg = 0.0;
    Vec3 inertia_kgm2 = Vec3::Zero();  // principal, body axes; zero for players and fixed bodies
    double restitution = 0.0;          // [0, 1]; the larger of two bodies' counts
    double friction = 0.0;             // Coulomb's coefficient; of two bodies the geometric mean
    Vec3 collider_offset_bs = Vec3::Zero();  // its collider's centre: a player's is his head's

    // The phase's share of motion: 1/mass, or 0 for what the phase holds still. Written by the
    // phases.
    double inverse_mass = 0.0;
    Vec3 inverse_inertia_bs = Vec3::Zero();
    std::uint32_t slot = 0;  // place in its island; written by build_islands
};

// What a block of rows holds together. "a's frame" and "b's frame" are point and rotation of the
// block in each body; a joint's axis is the local x of its frames.
enum class RowKind : std::uint8_t {
    drive_point,  // 3 rows: a's point on b's point
    drive_weld,   // 6 rows: and a's rotation on b's
    // 3 rows: a's rotation on b's. The second of two hands on one body: the direction of the line
    // between the hands and the twist about it, both turned by the body alone; its points take part
    // in no row, they may slide along the line. See two_hands.hpp.
    drive_direction,
    contact,   // 1 row, >= 0: separation along b's normal
    ball,      // 3 rows: a's point on b's point
    hinge,     // 5 rows: and the axes along each other
    slider,    // 5 rows: b's point on a's axis, and a's rotation on b's
    fixed,     // 6 rows: as drive_weld
    distance,  // no row of its own: only limits
};

// A joint's one degree of freedom, in its own unit: a hinge's angle about the axis (rad), a
// slider's way along it, a distance joint's length (m), a ball's angle between the axes (rad).
struct JointRows {
    // The coordinate stays in [lower, upper]; equal: locked there.
    bool limited = false;
    double lower = 0.0;
    double upper = 0.0;
    double previous =
        0.0;  // hinge: of all angles whole turns apart the one nearest to this is meant
    // Velocity only: rows that give way. Friction about (ball: all axes) or along the free
    // coordinate, at most this impulse, N s or N m s; a pull towards a coordinate, as fast as gets
    // there in a time, by at most that impulse; and what a lock takes before it gives way, 0: all.
    double friction_impulse = 0.0;
    double motor_target = 0.0;  // m or rad
    double motor_time_s = 0.0;  // > 0 where it is driven
    double motor_max_impulse = 0.0;
    double lock_limit_impulse = 0.0;

    double lock_impulse = 0.0;  // out of solve_velocities: what held a locked coordinate
};

// One constraint between two bodies. Hands: a is the player, b what is held. Contacts: a is the
// free collider, b holds the normal.
struct RowBlock {
    RowKind kind = RowKind::contact;
    std::uint32_t a = 0;  // into ConstraintGraph::bodies
    std::uint32_t b = 0;
    std::uint64_t key = 0;  // orders the blocks of one kind between the same bodies: the hand's or
                            // joint's id, the contact's feature
    std::uint32_t source = 0;  // hands, joints: the row of the column that the block was made from
    Vec3 point_a_bs = Vec3::Zero();
    Vec3 point_b_bs = Vec3::Zero();
    Quat rotation_a_bs =
        Quat::Identity();  // weld, joints: the two that shall be equal in the world
    Quat rotation_b_bs = Quat::Identity();
    Vec3 normal_b_bs = Vec3::UnitY();           // contact: from b towards a
    Vec3 drive_velocity_ws_mps = Vec3::Zero();  // hands: the tracked hand's own motion against a
    Vec3 drive_spin_ws_radps = Vec3::Zero();
    double restitution = 0.0;  // contact
    double friction = 0.0;     // contact: Coulomb's coefficient
    JointRows joint;

    Vec3 impulse_ws_ns =
        Vec3::Zero();  // out of solve_velocities: on a at its point; b gets the opposite
    Vec3 angular_impulse_ws_nms = Vec3::Zero();  // out: on a; b gets the opposite
};
inline bool is_drive(RowKind kind) {
    return kind == RowKind::drive_point || kind == RowKind::drive_weld ||
           kind == RowKind::drive_direction;
}
inline bool is_drive(const RowBlock& block) { return is_drive(block.kind); }
inline bool is_contact(const RowBlock& block) { return block.kind == RowKind::contact; }
inline bool is_joint(const RowBlock& block) { return !is_drive(block) && !is_contact(block); }

// Angular errors count as lengths at this lever, metres.
inline constexpr double k_angle_lever_m = 0.1;

// How a row gives way where not all can be met.
enum class RowGroup : std::uint8_t { drive, joint, limit, contact };

// One scalar equation: value + J dx = 0, or >= 0. J as the parts that belong to a's and b's
// translation and rotation.
struct Row {
    Vec3 linear_a = Vec3::Zero();  // b's linear part is its negative
    Vec3 angular_a = Vec3::Zero();
    Vec3 angular_b = Vec3::Zero();
    double residual = 0.0;
    std::uint32_t block = 0;  // into the graph's blocks
    std::uint32_t a = 0;      // into the graph's bodies
    std::uint32_t b = 0;
    RowGroup group = RowGroup::contact;
    bool unilateral = false;  // value >= 0 is fine
    // Rows of one error, from this one on: only together they say the same however the world is
    // turned. 0: belongs to an earlier row.
    std::uint8_t width = 1;
};

// True where a joint's coordinate is an angle.
bool is_angular(RowKind kind);

// Appends the block's rows at the bodies' present poses. Limits farther away than reach_m (angles
// at their lever) are left out.
void append_rows(std::span<const SolverBody> bodies, const RowBlock& block,
                 std::uint32_t block_index, std::vector<Row>& rows,
                 double reach_m = std::numeric_limits<double>::infinity());

// From b's point to a's in the world: the values of the rows that hold one on the other.
Vec3 point_error(std::span<const SolverBody> bodies, const RowBlock& block);
// From b's rotation to a's in the world, radians: the values, at their lever, of the rows that hold
// one on the other.
Vec3 rotation_error(const Quat& rotation_a_ws, const Quat& rotation_b_ws, const RowBlock& block);
// True for the first of three rows that hold a's point on b's, one a world axis.
inline bool starts_point_rows(const Row& row) {
    return row.width == 3 && row.linear_a == Vec3::UnitX();
}

// Rows that only velocities have: a contact's two directions along the surface, a joint's free
// directions. Value 0. Returns how many.
std::size_t append_sliding_rows(std::span<const SolverBody> bodies, const RowBlock& block,
                                std::uint32_t block_index, std::vector<Row>& rows);

// The block's error at the present poses, metres: length of the point error or of the angular one
// times k_angle_lever_m, whichever is larger; how far a limit is passed; a contact's overlap, 0
// where it is apart.
double block_error_m(std::span<const SolverBody> bodies, const RowBlock& block);
// Its two parts where they matter apart, of joints: metres, and radians.
struct JointError {
    double point_m = 0.0;
    double angle_rad = 0.0;
};
JointError joint_error(std::span<const SolverBody> bodies, const RowBlock& block);
// A contact's separation at the present poses; negative: overlap.
double contact_separation_m(std::span<const SolverBody> bodies, const RowBlock& block);
// A joint's free coordinate at the present poses (JointRows); 0 for fixed.
double joint_coordinate(std::span<const SolverBody> bodies, const RowBlock& block);
// Its rate of change, m/s or rad/s.
double joint_speed(std::span<const SolverBody> bodies, const RowBlock& block);

// Inverse inertia about the world's axes.
Mat3 inverse_inertia_ws(const SolverBody& body);

}  // namespace handhold
