#include "engine/solver/rows.hpp"

#include <algorithm>

namespace handhold {
namespace {

Vec3 angular_error(const SolverBody& a, const SolverBody& b, const RowBlock& block) {
    const Quat wanted = a.pose_ws.rotation * block.rotation_a_bs;
    const Quat present = b.pose_ws.rotation * block.rotation_b_bs;
    return rotation_to_vector(wanted * present.conjugate());
}

void append_point_rows(const Vec3& arm_a, const Vec3& arm_b, const Vec3& error, Row row,
                       std::vector<Row>& rows) {
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 unit = Vec3::Unit(axis);
        row.linear_a = unit;
        row.angular_a = arm_a.cross(unit);
        row.angular_b = -arm_b.cross(unit);
        row.value_m = error[axis];
        rows.push_back(row);
    }
}

}  // namespace

void append_rows(std::span<const SolverBody> bodies, const RowBlock& block,
                 std::uint32_t block_index, std::vector<Row>& rows) {
    const SolverBody& a = bodies[block.a];
    const SolverBody& b = bodies[block.b];
    const Vec3 arm_a = a.pose_ws.rotation * block.point_a_bs;
    const Vec3 arm_b = b.pose_ws.rotation * block.point_b_bs;
    const Vec3 error = (a.pose_ws.position - b.pose_ws.position) + (arm_a - arm_b);
    Row row;
    row.block = block_index;
    row.a = block.a;
    row.b = block.b;
    row.hand = is_hand(block);
    if (block.kind == RowKind::contact) {
        const Vec3 normal = b.pose_ws.rotation * block.normal_b_bs;
        row.unilateral = true;
        row.linear_a = normal;
        row.angular_a = arm_a.cross(normal);
        // The normal turns with b: b's arm reaches to a's point, not to its own.
        row.angular_b = -(arm_b + error).cross(normal);
        row.value_m = normal.dot(error);
        rows.push_back(row);
        return;
    }
    append_point_rows(arm_a, arm_b, error, row, rows);
    if (block.kind == RowKind::hand_weld) {
        const Vec3 angle = angular_error(a, b, block);
        for (int axis = 0; axis < 3; ++axis) {
            row.linear_a = Vec3::Zero();
            row.angular_a = k_angle_m * Vec3::Unit(axis);
            row.angular_b = -row.angular_a;
            row.value_m = k_angle_m * angle[axis];
            rows.push_back(row);
        }
    }
}

double contact_separation_m(std::span<const SolverBody> bodies, const RowBlock& block) {
    const Pose& a = bodies[block.a].pose_ws;
    const Pose& b = bodies[block.b].pose_ws;
    const Vec3 apart =
        (a.position - b.position) + (a.rotation * block.point_a_bs - b.rotation * block.point_b_bs);
    return (b.rotation * block.normal_b_bs).dot(apart);
}

double block_error_m(std::span<const SolverBody> bodies, const RowBlock& block) {
    if (block.kind == RowKind::contact) {
        return std::max(0.0, -contact_separation_m(bodies, block));
    }
    const SolverBody& a = bodies[block.a];
    const SolverBody& b = bodies[block.b];
    const Vec3 apart =
        (a.pose_ws.position - b.pose_ws.position) +
        (a.pose_ws.rotation * block.point_a_bs - b.pose_ws.rotation * block.point_b_bs);
    if (block.kind == RowKind::hand_point) {
        return apart.norm();
    }
    return std::max(apart.norm(), k_angle_m * angular_error(a, b, block).norm());
}

Mat3 inverse_inertia_ws(const SolverBody& body) {
    const Mat3 axes = body.pose_ws.rotation.toRotationMatrix();
    return axes * body.inverse_inertia_bs.asDiagonal() * axes.transpose();
}

}  // namespace handhold
