// Sources: as row_system.cpp and newton.cpp.
#include "engine/solver/triad_system.hpp"

#include <algorithm>
#include <cmath>

namespace handhold {
namespace {

// True where the block's rows hold in every state: none may let go, slide, stop or give way.
bool always_holds(const RowBlock& block) {
    switch (block.kind) {
        case RowKind::hand_point:
        case RowKind::hand_weld:
        case RowKind::hand_direction:
            return true;
        case RowKind::ball:
        case RowKind::fixed:
            return !block.joint.limited && block.joint.friction_impulse == 0.0;
        default:
            return false;
    }
}

bool holds_point(RowKind kind) { return kind != RowKind::hand_direction; }
bool holds_rotation(RowKind kind) {
    return kind == RowKind::hand_weld || kind == RowKind::fixed || kind == RowKind::hand_direction;
}

Rows3 to_rows(const Mat3& m) {
    return {{to_four(Vec3(m.row(0))), to_four(Vec3(m.row(1))), to_four(Vec3(m.row(2)))}};
}

void pack(const SolverBody& from, std::uint32_t index, TriadBody& body) {
    body.index = index;
    body.position = to_four(from.pose_ws.position);
    body.rotation = to_four(from.pose_ws.rotation);
    body.velocity = to_four(from.velocity_mps);
    body.spin = to_four(from.spin_radps);
    body.inverse_mass = from.inverse_mass;
    body.inverse_inertia_bs = to_four(from.inverse_inertia_bs);
    body.may_turn = from.inverse_mass > 0.0 && !from.inverse_inertia_bs.isZero(0.0);
    if (!body.may_turn) {
        body.inverse_inertia = {};
    }
}

bool are_equal(const Four& a, const Four& b) {
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2] && a[3] == b[3];
}
// True where it has the mass and the pose that it was packed with, or stored with.
bool is_as_packed(const SolverBody& from, const TriadBody& body) {
    return from.inverse_mass == body.inverse_mass &&
           are_equal(to_four(from.inverse_inertia_bs), body.inverse_inertia_bs) &&
           are_equal(to_four(from.pose_ws.position), body.position) &&
           are_equal(to_four(from.pose_ws.rotation), body.rotation);
}

}  // namespace

void TriadSystem::load_bodies(const IslandView& island) {
    moving_ = island.island_bodies.size();
    bodies_.resize(moving_);  // of other islands: all that counts is written
    may_turn_.resize(moving_);
    for (std::size_t slot = 0; slot < moving_; ++slot) {
        const std::uint32_t index = island.island_bodies[slot];
        pack(island.bodies[index], index, bodies_[slot]);
        may_turn_[slot] = bodies_[slot].may_turn ? 1 : 0;
    }
    uses_.assign(moving_, 0);
}

// False where more meet in one body than are served.
bool TriadSystem::add(const IslandView& island, std::uint32_t index, bool turns) {
    const RowBlock& block = island.blocks[index];
    Triad& triad = triads_.emplace_back();
    RowNode& node = nodes_.emplace_back();
    node.width = 3;
    triad.block = index;
    triad.turns = turns;
    triad.is_hand = is_hand(block);
    has_hand_ = has_hand_ || triad.is_hand;
    has_turn_ = has_turn_ || turns;
    bool fits = true;
    for (std::size_t side = 0; side < 2; ++side) {
        const std::uint32_t body_index = side == 0 ? block.a : block.b;
        const SolverBody& body = island.bodies[body_index];
        triad.points[side] = to_four(side == 0 ? block.point_a_bs : block.point_b_bs);
        if (body.inverse_mass > 0.0) {
            triad.bodies[side] = node.slots[side] = body.slot;
            fits = fits && ++uses_[body.slot] <= k_hub_nodes;
            continue;
        }
        // What nothing moves is beside the others, once for each that it holds.
        triad.bodies[side] = static_cast<std::uint32_t>(bodies_.size());
        pack(body, body_index, bodies_.emplace_back());
        bodies_.back().axes = to_rows(body.pose_ws.rotation.conjugate().toRotationMatrix());
    }
    return fits;
}

bool TriadSystem::load(const IslandView& island, double touch_m) {
    revision_ = 0;
    load_bodies(island);
    triads_.clear();
    nodes_.clear();
    has_hand_ = has_turn_ = is_stiff_ = false;
    bool has_contact = false;
    for (const std::uint32_t index : island.island_blocks) {
        const RowBlock& block = island.blocks[index];
        if (is_contact(block)) {
            has_contact = true;
            if (takes_part(island, block) && contact_separation_m(island.bodies, block) < touch_m) {
                return false;
            }
            continue;
        }
        if (!takes_part(island, block)) {
            continue;
        }
        if (!always_holds(block) || (holds_point(block.kind) && !add(island, index, false)) ||
            (holds_rotation(block.kind) && !add(island, index, true))) {
            return false;
        }
    }
    plan_nodes();
    if (!has_contact && island.filter != BlockFilter::without_hands) {
        revision_ = island.revision;
    }
    return true;
}

bool TriadSystem::resume(const IslandView& island) {
    if (revision_ == 0 || revision_ != island.revision ||
        island.filter == BlockFilter::without_hands || moving_ != island.island_bodies.size()) {
        return false;
    }
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        TriadBody& body = bodies_[i];
        const SolverBody& from = island.bodies[body.index];
        const bool is_same = i >= moving_ || body.index == island.island_bodies[i];
        if (!is_same || !is_as_packed(from, body)) {
            return false;
        }
        body.velocity = to_four(from.velocity_mps);
        body.spin = to_four(from.spin_radps);
    }
    is_stiff_ = false;
    return true;
}

void TriadSystem::plan_nodes() {
    const TriadPlan& plan = plans_.choose(nodes_, may_turn_);
    arms_.resize(2 * triads_.size());
    values_.resize(triads_.size());
    lambdas_.resize(triads_.size());
    sides_.resize(2 * triads_.size());
    blocks_.resize(plan.block_count());
    pivots_.resize(triads_.size());
    unknowns_.resize(triads_.size());
    share_masses(plan);
}

// What points that meet in a body share of its 1/mass: the translations' part of J W J^T.
void TriadSystem::share_masses(const TriadPlan& plan) {
    masses_.clear();
    std::uint32_t begin = 0;
    for (const TriadPlan::Sum& sum : plan.sums()) {
        double mass = 0.0;
        for (; begin < sum.end; ++begin) {
            const TriadPlan::Coupling& coupling = plan.couplings()[begin];
            const Triad& row = triads_[coupling.row_end / 2];
            if (!row.turns && !triads_[coupling.column_end / 2].turns) {
                const std::uint32_t side = coupling.row_end % 2;
                const double share = bodies_[row.bodies[side]].inverse_mass;
                mass += side == coupling.column_end % 2 ? share : -share;
            }
        }
        masses_.push_back(mass);
    }
}

TriadArrays TriadSystem::arrays() {
    return {bodies_, moving_, triads_, arms_,     values_, lambdas_,          stiffness_,
            sides_,  blocks_, pivots_, unknowns_, masses_, &plans_.current(), has_turn_};
}

void TriadSystem::store_poses(const IslandView& island) const {
    for (const TriadBody& body : moving()) {
        if (body.inverse_mass > 0.0) {
            island.bodies[body.index].pose_ws = {to_vec3(body.position), to_quat(body.rotation)};
        }
    }
}

void TriadSystem::store_velocities(const IslandView& island) const {
    for (const TriadBody& body : moving()) {
        if (body.inverse_mass > 0.0) {
            island.bodies[body.index].velocity_mps = to_vec3(body.velocity);
            island.bodies[body.index].spin_radps = to_vec3(body.spin);
        }
    }
}

void TriadSystem::evaluate(const IslandView& island) {
    kernels_->evaluate(arrays());
    if (!has_turn_) {
        return;
    }
    for (std::size_t i = 0; i < triads_.size(); ++i) {
        const Triad& triad = triads_[i];
        if (triad.turns) {
            const RowBlock& block = island.blocks[triad.block];
            values_[i].v = to_four(Vec3(
                k_angle_m * rotation_error(to_quat(bodies_[triad.bodies[0]].rotation),
                                           to_quat(bodies_[triad.bodies[1]].rotation), block)));
        }
    }
}

void TriadSystem::evaluate_velocities(const IslandView& island) {
    kernels_->evaluate_velocities(arrays());
    if (!has_hand_) {
        return;
    }
    for (std::size_t i = 0; i < triads_.size(); ++i) {
        const Triad& triad = triads_[i];
        if (triad.is_hand) {
            const RowBlock& block = island.blocks[triad.block];
            values_[i].v += triad.turns ? k_angle_m * to_four(block.drive_spin_ws_radps)
                                        : to_four(block.drive_velocity_ws_mps);
        }
    }
}

double TriadSystem::worst_value() const {
    double square = 0.0;
    for (const TriadVector& value : values_) {
        square = std::max(square, dot3(value.v, value.v));
    }
    return std::sqrt(square);
}

void TriadSystem::gather_stiffness() {
    is_stiff_ = true;
    stiffness_.resize(moving_);
    kernels_->gather_stiffness(arrays());
}

// The harmonic mean of the diagonal, by triads: what one hand holds weighs as much as the other's.
double TriadSystem::hand_size() const {
    double inverse_sum = 0.0;
    double count = 0.0;
    for (const TriadPlan::Step& step : plans_.current().steps()) {
        const Rows3& block = blocks_[step.own];
        const double sum = (block.row[0][0] + block.row[1][1]) + block.row[2][2];
        if (sum > 0.0) {
            inverse_sum += 9.0 / sum;
            count += 3.0;
        }
    }
    return inverse_sum > 0.0 ? count / inverse_sum : 0.0;
}

void TriadSystem::factorise(const Softness& softness, double factor) {
    (is_stiff_ ? kernels_->write_stiff_inertia : kernels_->write_inertia)(arrays());
    kernels_->multiply_out(arrays());
    const double hand_alpha = has_hand_ ? factor * softness.hand * hand_size() : 0.0;
    kernels_->factorise(arrays(), hand_alpha, factor * softness.joint);
}

void TriadSystem::solve() {
    kernels_->solve(arrays());
    double move = 0.0;
    double turn = 0.0;
    for (const TriadBody& body : moving()) {
        move = std::max(move, dot3(body.move, body.move));
        turn = std::max(turn, dot3(body.turn, body.turn));
    }
    longest_move_ = std::sqrt(move);
    longest_turn_ = std::sqrt(turn);
}

double TriadSystem::apply_moves(double scale) {
    kernels_->apply(arrays(), scale);
    return scale * std::max(longest_move_, k_angle_m * longest_turn_);
}

void TriadSystem::apply_impulses(const IslandView& island) {
    for (TriadBody& body : std::span(bodies_).first(moving_)) {
        body.velocity += body.move;
        body.spin += body.turn;
    }
    for (std::size_t i = 0; i < triads_.size(); ++i) {
        RowBlock& block = island.blocks[triads_[i].block];
        if (triads_[i].turns) {
            block.couple_ws_nms += k_angle_m * to_vec3(lambdas_[i].v);
        } else {
            block.impulse_ws_ns += to_vec3(lambdas_[i].v);
        }
    }
}

}  // namespace handhold
