// Solver, packed: evaluates the constraints, runs the packed solve and stores its results.
#include "engine/solver/packed/triad_system.hpp"

#include <algorithm>
#include <cmath>

namespace handhold {
namespace {

constexpr std::size_t k_lanes = TriadPlan::k_lanes;

}  // namespace

TriadArrays TriadSystem::arrays() {
    return {bodies_,   body_ends_, stiffness_,        links_,    multipliers_,  strands_,
            ends_,     values_,    lambdas_,          is_drive_, blocks_,       inverses_,
            unknowns_, windows_,   &plans_.current(), has_turn_, has_stiffness_};
}

void TriadSystem::store_poses(const IslandView& island) const {
    const std::span<const std::uint32_t> slots = plans_.current().slots();
    for (std::uint32_t place = 0; place < slots.size(); ++place) {
        const Bodies4& bodies = group_of(place);
        const std::size_t lane = place % k_lanes;
        if (bodies.inverse_mass[lane] > 0.0) {
            Pose& pose_ws = island.bodies[body_indices_[slots[place]]].pose_ws;
            get_lane(lane, bodies.position, pose_ws.position);
            get_lane(lane, bodies.rotation, pose_ws.rotation);
        }
    }
}

void TriadSystem::store_velocities(const IslandView& island) const {
    const std::span<const std::uint32_t> slots = plans_.current().slots();
    for (std::uint32_t place = 0; place < slots.size(); ++place) {
        const Bodies4& bodies = group_of(place);
        const std::size_t lane = place % k_lanes;
        if (bodies.inverse_mass[lane] > 0.0) {
            SolverBody& body = island.bodies[body_indices_[slots[place]]];
            get_lane(lane, bodies.velocity, body.velocity_mps);
            get_lane(lane, bodies.spin, body.spin_radps);
        }
    }
    const TriadPlan& plan = plans_.current();
    for (std::size_t i = 0; i < impulses_.size(); ++i) {
        const Triad& triad = triads_[plan.rest()[i]];
        RowBlock& block = island.blocks[triad.block];
        if (triad.is_angular) {
            block.angular_impulse_ws_nms = k_angle_lever_m * to_vec3(impulses_[i].v);
        } else {
            block.impulse_ws_ns = to_vec3(impulses_[i].v);
        }
    }
    for (const TriadPlan::StrandPack& strand_pack : plan.strand_packs()) {
        for (std::size_t k = 0; k < strand_pack.length; ++k) {
            for (std::size_t lane = 0; lane < k_lanes; ++lane) {
                RowBlock& block =
                    island.blocks[triads_[plan.links(strand_pack)[k][lane] / 2].block];
                get_lane(lane, links_[strand_pack.step + k].impulse, block.impulse_ws_ns);
            }
        }
    }
}

Quat TriadSystem::rotation_at(const IslandView& island, std::uint32_t end) const {
    const std::uint32_t slot = nodes_[end / 2].slots[end % 2];
    if (slot != k_no_slot) {
        const std::uint32_t place = plans_.current().places()[slot];
        return quat_in_lane(place % k_lanes, group_of(place).rotation);
    }
    const RowBlock& block = island.blocks[triads_[end / 2].block];
    return island.bodies[end % 2 == 0 ? block.a : block.b].pose_ws.rotation;
}

void TriadSystem::evaluate(const IslandView& island) {
    is_evaluated_ = true;
    for (const Anchor& anchor : anchors_) {
        if (anchor.rest_end == k_no_slot) {
            continue;
        }
        const Vec3 point_ws = transform_point(island.bodies[anchor.body].pose_ws, anchor.point_bs);
        ends_[anchor.rest_end].v = to_double4(Vec3(sign_of(anchor.end) * point_ws));
    }
    kernels_->evaluate(arrays());
    if (!has_turn_) {
        return;
    }
    const std::span<const std::uint32_t> rest = plans_.current().rest();
    for (std::size_t i = 0; i < rest.size(); ++i) {
        const std::uint32_t end = 2 * rest[i];
        if (triads_[rest[i]].is_angular) {
            values_[i].v = to_double4(
                Vec3(k_angle_lever_m * rotation_error(rotation_at(island, end),
                                                      rotation_at(island, end + 1),
                                                      island.blocks[triads_[rest[i]].block])));
        }
    }
}

void TriadSystem::evaluate_if_moved(const IslandView& island) {
    if (!is_evaluated_) {
        evaluate(island);
    }
}

void TriadSystem::evaluate_velocities(const IslandView& island) {
    for (const Anchor& anchor : anchors_) {
        if (anchor.rest_end == k_no_slot) {
            continue;
        }
        const SolverBody& body = island.bodies[anchor.body];
        const Vec3 arm = body.pose_ws.rotation * anchor.point_bs;
        const Vec3 speed = triads_[anchor.end / 2].is_angular
                               ? Vec3(k_angle_lever_m * body.spin_radps)
                               : Vec3(body.velocity_mps + body.spin_radps.cross(arm));
        ends_[anchor.rest_end].v = to_double4(Vec3(sign_of(anchor.end) * speed));
    }
    kernels_->evaluate_velocities(arrays());
    if (!has_drive_rows_) {
        return;
    }
    for (std::size_t i = 0; i < is_drive_.size(); ++i) {
        if (is_drive_[i] != 0) {
            const Triad& triad = triads_[plans_.current().rest()[i]];
            const RowBlock& block = island.blocks[triad.block];
            values_[i].v += triad.is_angular
                                ? k_angle_lever_m * to_double4(block.drive_spin_ws_radps)
                                : to_double4(block.drive_velocity_ws_mps);
        }
    }
}

void TriadSystem::gather_stiffness() {
    has_stiffness_ = true;
    stiffness_.resize(bodies_.size());
    kernels_->gather_stiffness(arrays());
}

double TriadSystem::mean_diagonal() const {
    HarmonicMean mean;
    for (const TriadPlan::Step& step : plans_.current().steps()) {
        const Rows3& block = blocks_[step.own];
        mean.add(3.0, (block.row[0][0] + block.row[1][1]) + block.row[2][2]);
    }
    for (const TriadPlan::StrandPack& strand_pack : plans_.current().strand_packs()) {
        mean.add_inverse(3.0 * k_lanes * strand_pack.length, 0.0);
    }
    for (const Strands4& strands : strands_) {
        const Double4& sum = strands.inverse_sum;
        mean.add_inverse(0.0, (sum[0] + sum[1]) + (sum[2] + sum[3]));
    }
    return mean.value();
}

void TriadSystem::factorise(const Regularisation& regularisation, double factor) {
    kernels_->multiply_out(arrays(), factor * regularisation.joint);
    if (has_drive_rows_ && !is_restricted_) {
        drive_scale_.update(mean_diagonal(), has_stiffness_);
    }
    const double drive_alpha =
        has_drive_rows_ ? factor * regularisation.drive * drive_scale_.value() : 0.0;
    kernels_->factorise(arrays(), drive_alpha, factor * regularisation.joint);
}

void TriadSystem::solve() {
    const LargestMove reach = kernels_->solve(arrays());
    longest_move_ = std::sqrt(reach.move_square);
    largest_rotation_ = std::sqrt(reach.turn_square);
}

double TriadSystem::apply_moves(double scale) {
    is_evaluated_ = false;
    kernels_->apply(arrays(), scale);
    return scale * std::max(longest_move_, k_angle_lever_m * largest_rotation_);
}

void TriadSystem::apply_impulses() {
    kernels_->apply_velocities(arrays());
    for (std::size_t i = 0; i < impulses_.size(); ++i) {
        impulses_[i].v += lambdas_[i].v;
    }
    for (const TriadPlan::StrandPack& strand_pack : plans_.current().strand_packs()) {
        for (std::size_t k = 0; k < strand_pack.length; ++k) {
            Wide3& impulse = links_[strand_pack.step + k].impulse;
            const Wide3& lambda = multipliers_[strand_pack.bound + k + 1];
            impulse.x += lambda.x;
            impulse.y += lambda.y;
            impulse.z += lambda.z;
        }
    }
}

}  // namespace handhold
