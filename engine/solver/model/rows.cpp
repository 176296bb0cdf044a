// Solver, model: Jacobians and residuals of every block kind. Every Jacobian is checked against
// central differences in tests/engine/solver/model/rows_test.cpp and joint_rows_test.cpp.
#include "engine/solver/model/rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace handhold {
namespace {

// Eigen's product to the bit, but always inlined: rows are evaluated many times in a frame.
[[gnu::always_inline]] inline Vec3 rotated(const Quat& rotation, const Vec3& v) {
    const Vec3 half = rotation.vec().cross(v);
    const Vec3 twice = half + half;
    return v + rotation.w() * twice + rotation.vec().cross(twice);
}

// The two ends of a block, in world axes.
struct Ends {
    Vec3 arm_a;  // vector from each body's centre to its anchor point
    Vec3 arm_b;
    Vec3 error;  // vector from b's point to a's point

    Ends(std::span<const SolverBody> bodies, const RowBlock& block) {
        const Pose& a = bodies[block.a].pose_ws;
        const Pose& b = bodies[block.b].pose_ws;
        arm_a = rotated(a.rotation, block.point_a_bs);
        arm_b = rotated(b.rotation, block.point_b_bs);
        error = (a.position - b.position) + (arm_a - arm_b);
    }
};

// World rotations of the two frames of a block.
Quat frame_a(std::span<const SolverBody> bodies, const RowBlock& block) {
    return bodies[block.a].pose_ws.rotation * block.rotation_a_bs;
}
Quat frame_b(std::span<const SolverBody> bodies, const RowBlock& block) {
    return bodies[block.b].pose_ws.rotation * block.rotation_b_bs;
}

// The joint axis (local x of each frame) in world axes.
Vec3 axis_a(std::span<const SolverBody> bodies, const RowBlock& block) {
    return frame_a(bodies, block) * Vec3::UnitX();
}
Vec3 axis_b(std::span<const SolverBody> bodies, const RowBlock& block) {
    return frame_b(bodies, block) * Vec3::UnitX();
}

Vec3 rotation_error(std::span<const SolverBody> bodies, const RowBlock& block) {
    return rotation_error(bodies[block.a].pose_ws.rotation, bodies[block.b].pose_ws.rotation,
                          block);
}

double angle_between(const Vec3& x, const Vec3& y) {
    return arc_tangent2(x.cross(y).norm(), x.dot(y));
}

Row empty_row(const RowBlock& block, std::uint32_t block_index, RowGroup group) {
    Row row;
    row.block = block_index;
    row.a = block.a;
    row.b = block.b;
    row.group = group;
    return row;
}

// Residual: p_a - p_b, one row per world axis (p: anchor point). J: linear +-1, angular arm x axis.
void append_point_rows(const Ends& ends, Row row, std::vector<Row>& rows) {
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 unit = Vec3::Unit(axis);
        row.linear_a = unit;
        row.angular_a = ends.arm_a.cross(unit);
        row.angular_b = -ends.arm_b.cross(unit);
        row.residual = ends.error[axis];
        row.width = axis == 0 ? 3 : 0;
        rows.push_back(row);
    }
}

// Residual: k_angle_lever_m times the rotation vector from b's frame to a's. J: +-k_angle_lever_m
// along each world axis.
void append_weld_rows(const Vec3& error_rad, Row row, std::vector<Row>& rows) {
    row.linear_a.setZero();
    for (int axis = 0; axis < 3; ++axis) {
        row.angular_a = k_angle_lever_m * Vec3::Unit(axis);
        row.angular_b = -row.angular_a;
        row.residual = k_angle_lever_m * error_rad[axis];
        row.width = axis == 0 ? 3 : 0;
        rows.push_back(row);
    }
}

// Keeps b's axis parallel to a's. Residuals: components of b's axis along a's two other axes, times
// angle / sine of the angle between both axes. The factor makes opposed axes (half a turn) the
// largest error; without it, their error would be 0.
void append_axis_rows(const Quat& frame_a_ws, const Vec3& axis_b_ws, Row row,
                      std::vector<Row>& rows) {
    const Vec3 axis_a_ws = frame_a_ws * Vec3::UnitX();
    const double sine = axis_a_ws.cross(axis_b_ws).norm();
    const double angle = arc_tangent2(sine, axis_a_ws.dot(axis_b_ws));
    const double stretch = sine > 1e-9 ? angle / sine : 1.0;
    const bool is_opposed = sine <= 1e-9 && angle > 1.0;  // every rotation back is equally short
    row.linear_a.setZero();
    for (int axis = 1; axis < 3; ++axis) {
        const Vec3 side = frame_a_ws * Vec3::Unit(axis);
        row.angular_a = (k_angle_lever_m * stretch) * side.cross(axis_b_ws);
        row.angular_b = -row.angular_a;
        row.residual = k_angle_lever_m * stretch * side.dot(axis_b_ws);
        if (is_opposed) {
            row.residual = axis == 1 ? k_angle_lever_m * angle : 0.0;
        }
        row.width = axis == 1 ? 2 : 0;
        rows.push_back(row);
    }
}

// Keeps b's point on a's axis. The axis rotates with a, so a's lever arm reaches to b's point.
void append_line_rows(const Quat& frame_a_ws, const Ends& ends, Row row, std::vector<Row>& rows) {
    for (int axis = 1; axis < 3; ++axis) {
        row.linear_a = frame_a_ws * Vec3::Unit(axis);
        row.angular_a = (ends.arm_a - ends.error).cross(row.linear_a);
        row.angular_b = -ends.arm_b.cross(row.linear_a);
        row.residual = row.linear_a.dot(ends.error);
        row.width = axis == 1 ? 2 : 0;
        rows.push_back(row);
    }
}

// Returns b's lever arm. The normal rotates with b, so the arm ends at a's point instead of b's
// own. After an impact it ends at b's own point: a's point has slid on since the impact, and the
// longer arm would spin a ball that is hit centrally.
Vec3 contact_arm_b(const RowBlock& block, const Ends& ends) {
    return block.is_impact ? ends.arm_b : Vec3(ends.arm_b + ends.error);
}

void append_contact_row(std::span<const SolverBody> bodies, const RowBlock& block, const Ends& ends,
                        Row row, std::vector<Row>& rows) {
    const Vec3 normal = rotated(bodies[block.b].pose_ws.rotation, block.normal_b_bs);
    row.unilateral = true;
    row.linear_a = normal;
    row.angular_a = ends.arm_a.cross(normal);
    row.angular_b = -contact_arm_b(block, ends).cross(normal);
    row.residual = normal.dot(ends.error);
    rows.push_back(row);
}

// J of the joint coordinate: its rate per unit of relative motion.
void set_rate(std::span<const SolverBody> bodies, const RowBlock& block, Row& row) {
    switch (block.kind) {
        case RowKind::hinge:
            row.angular_b = axis_a(bodies, block);
            break;
        case RowKind::ball:
            row.angular_b = axis_a(bodies, block).cross(axis_b(bodies, block)).normalized();
            break;
        case RowKind::slider: {
            const Ends ends(bodies, block);
            row.linear_a = -axis_a(bodies, block);
            row.angular_a = (ends.arm_a - ends.error).cross(row.linear_a);
            row.angular_b = -ends.arm_b.cross(row.linear_a);
            return;
        }
        case RowKind::distance: {
            const Ends ends(bodies, block);
            row.linear_a = ends.error.normalized();
            row.angular_a = ends.arm_a.cross(row.linear_a);
            row.angular_b = -ends.arm_b.cross(row.linear_a);
            return;
        }
        default:
            return;
    }
    row.angular_a = -row.angular_b;
}

void scale(Row& row, double factor) {
    row.linear_a *= factor;
    row.angular_a *= factor;
    row.angular_b *= factor;
}

void append_limit_rows(std::span<const SolverBody> bodies, const RowBlock& block,
                       std::uint32_t block_index, double reach_m, std::vector<Row>& rows) {
    const JointRows& joint = block.joint;
    if (!joint.limited) {
        return;
    }
    const double lever = is_angular(block.kind) ? k_angle_lever_m : 1.0;
    const double coordinate = joint_coordinate(bodies, block);
    // A cone's angle and a distance cannot be negative. A lower limit of 0 gets no row, because it
    // would stop a body that passes through the middle.
    const bool has_lower =
        joint.lower > 0.0 || block.kind == RowKind::hinge || block.kind == RowKind::slider;
    const double above =
        has_lower ? lever * (coordinate - joint.lower) : std::numeric_limits<double>::infinity();
    const double below = lever * (joint.upper - coordinate);
    const bool locked = joint.lower == joint.upper;
    if (!locked && above >= reach_m && below >= reach_m) {
        return;
    }
    Row row = empty_row(block, block_index, RowGroup::limit);
    set_rate(bodies, block, row);
    scale(row, lever);
    row.unilateral = !locked;
    row.residual = above;
    if (locked || above < reach_m) {
        rows.push_back(row);
    }
    if (!locked && below < reach_m) {
        scale(row, -1.0);
        row.residual = below;
        rows.push_back(row);
    }
}

// How far the coordinate is outside its limits, in its own unit (m or rad).
double limit_excess(std::span<const SolverBody> bodies, const RowBlock& block) {
    if (!block.joint.limited || block.kind == RowKind::fixed) {
        return 0.0;
    }
    const double coordinate = joint_coordinate(bodies, block);
    return std::max({0.0, block.joint.lower - coordinate, coordinate - block.joint.upper});
}

}  // namespace

bool is_angular(RowKind kind) { return kind == RowKind::hinge || kind == RowKind::ball; }

void append_rows(std::span<const SolverBody> bodies, const RowBlock& block,
                 std::uint32_t block_index, std::vector<Row>& rows, double reach_m) {
    const Ends ends(bodies, block);
    const Row drive = empty_row(block, block_index, RowGroup::drive);
    const Row joint = empty_row(block, block_index, RowGroup::joint);
    switch (block.kind) {
        case RowKind::drive_point:
            append_point_rows(ends, drive, rows);
            return;
        case RowKind::drive_weld:
            append_point_rows(ends, drive, rows);
            append_weld_rows(rotation_error(bodies, block), drive, rows);
            return;
        case RowKind::drive_direction:
            append_weld_rows(rotation_error(bodies, block), drive, rows);
            return;
        case RowKind::contact:
            append_contact_row(bodies, block, ends,
                               empty_row(block, block_index, RowGroup::contact), rows);
            return;
        case RowKind::ball:
            append_point_rows(ends, joint, rows);
            break;
        case RowKind::hinge:
            append_point_rows(ends, joint, rows);
            append_axis_rows(frame_a(bodies, block), axis_b(bodies, block), joint, rows);
            break;
        case RowKind::slider:
            append_line_rows(frame_a(bodies, block), ends, joint, rows);
            append_weld_rows(rotation_error(bodies, block), joint, rows);
            break;
        case RowKind::fixed:
            append_point_rows(ends, joint, rows);
            append_weld_rows(rotation_error(bodies, block), joint, rows);
            return;
        case RowKind::distance:
            break;
    }
    append_limit_rows(bodies, block, block_index, reach_m, rows);
}

std::size_t append_sliding_rows(std::span<const SolverBody> bodies, const RowBlock& block,
                                std::uint32_t block_index, std::vector<Row>& rows) {
    const std::size_t before = rows.size();
    if (is_contact(block)) {
        const Ends ends(bodies, block);
        const Vec3 normal = rotated(bodies[block.b].pose_ws.rotation, block.normal_b_bs);
        const Quat around = rotation_between(Vec3::UnitX(), normal);
        Row row = empty_row(block, block_index, RowGroup::contact);
        for (int axis = 1; axis < 3; ++axis) {
            row.linear_a = around * Vec3::Unit(axis);
            row.angular_a = ends.arm_a.cross(row.linear_a);
            row.angular_b = -contact_arm_b(block, ends).cross(row.linear_a);
            row.width = axis == 1 ? 2 : 0;
            rows.push_back(row);
        }
    } else if (block.kind == RowKind::ball) {
        Row row = empty_row(block, block_index, RowGroup::joint);
        for (int axis = 0; axis < 3; ++axis) {
            row.angular_b = Vec3::Unit(axis);
            row.angular_a = -row.angular_b;
            row.width = axis == 0 ? 3 : 0;
            rows.push_back(row);
        }
    } else if (block.kind == RowKind::hinge || block.kind == RowKind::slider) {
        Row row = empty_row(block, block_index, RowGroup::joint);
        set_rate(bodies, block, row);
        rows.push_back(row);
    }
    return rows.size() - before;
}

Vec3 point_error(std::span<const SolverBody> bodies, const RowBlock& block) {
    return Ends(bodies, block).error;
}

Vec3 rotation_error(const Quat& rotation_a_ws, const Quat& rotation_b_ws, const RowBlock& block) {
    return rotation_to_vector((rotation_a_ws * block.rotation_a_bs) *
                              (rotation_b_ws * block.rotation_b_bs).conjugate());
}

double contact_separation_m(std::span<const SolverBody> bodies, const RowBlock& block) {
    return (rotated(bodies[block.b].pose_ws.rotation, block.normal_b_bs))
        .dot(Ends(bodies, block).error);
}

JointError joint_error(std::span<const SolverBody> bodies, const RowBlock& block) {
    const Vec3 separation = Ends(bodies, block).error;
    JointError error;
    switch (block.kind) {
        case RowKind::drive_weld:
        case RowKind::fixed:
            error = {separation.norm(), rotation_error(bodies, block).norm()};
            break;
        case RowKind::hinge:
            error = {separation.norm(),
                     angle_between(axis_a(bodies, block), axis_b(bodies, block))};
            break;
        case RowKind::slider: {
            const Vec3 axis = axis_a(bodies, block);
            error = {Vec3(separation - axis * axis.dot(separation)).norm(),
                     rotation_error(bodies, block).norm()};
            break;
        }
        case RowKind::drive_direction:
            error.angle_rad = rotation_error(bodies, block).norm();
            break;
        case RowKind::drive_point:
        case RowKind::ball:
            error.point_m = separation.norm();
            break;
        case RowKind::distance:
        case RowKind::contact:
            break;
    }
    double& limited = is_angular(block.kind) ? error.angle_rad : error.point_m;
    limited = std::max(limited, limit_excess(bodies, block));
    return error;
}

double block_error_m(std::span<const SolverBody> bodies, const RowBlock& block) {
    if (is_contact(block)) {
        return std::max(0.0, -contact_separation_m(bodies, block));
    }
    const JointError error = joint_error(bodies, block);
    return std::max(error.point_m, k_angle_lever_m * error.angle_rad);
}

double joint_coordinate(std::span<const SolverBody> bodies, const RowBlock& block) {
    switch (block.kind) {
        case RowKind::hinge: {
            const Quat turn = frame_a(bodies, block).conjugate() * frame_b(bodies, block);
            const double angle = 2.0 * arc_tangent2(turn.x(), turn.w());
            return angle + 2.0 * k_pi * std::round((block.joint.previous - angle) / (2.0 * k_pi));
        }
        case RowKind::ball:
            return angle_between(axis_a(bodies, block), axis_b(bodies, block));
        case RowKind::slider:
            return -(axis_a(bodies, block)).dot(Ends(bodies, block).error);
        case RowKind::distance:
            return Ends(bodies, block).error.norm();
        default:
            return 0.0;
    }
}

double joint_speed(std::span<const SolverBody> bodies, const RowBlock& block) {
    Row row;
    set_rate(bodies, block, row);
    const SolverBody& a = bodies[block.a];
    const SolverBody& b = bodies[block.b];
    return row.linear_a.dot(a.velocity_mps - b.velocity_mps) + row.angular_a.dot(a.spin_radps) +
           row.angular_b.dot(b.spin_radps);
}

Mat3 inverse_inertia_ws(const SolverBody& body) {
    const Mat3 axes = body.pose_ws.rotation.toRotationMatrix();
    return axes * body.inverse_inertia_bs.asDiagonal() * axes.transpose();
}

}  // namespace handhold
