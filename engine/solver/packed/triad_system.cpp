// Solver, packed: loading, storing and sequencing of the packed solve.
#include "engine/solver/packed/triad_system.hpp"

#include <algorithm>
#include <cmath>

namespace handhold {
namespace {

// True if all rows of the block are bilateral in every state: none may release, slide, stop or give
// way.
bool always_holds(const RowBlock& block) {
    switch (block.kind) {
        case RowKind::drive_point:
        case RowKind::drive_weld:
        case RowKind::drive_direction:
            return true;
        case RowKind::ball:
        case RowKind::fixed:
            return !block.joint.limited && block.joint.friction_impulse == 0.0;
        default:
            return false;
    }
}

bool holds_point(RowKind kind) { return kind != RowKind::drive_direction; }
bool holds_rotation(RowKind kind) {
    return kind == RowKind::drive_weld || kind == RowKind::fixed ||
           kind == RowKind::drive_direction;
}

constexpr std::size_t k_lanes = TriadPlan::k_lanes;

bool may_turn(const SolverBody& body) {
    return body.inverse_mass > 0.0 && !body.inverse_inertia_bs.isZero(0.0);
}

void pack_velocity(const SolverBody& from, std::size_t lane, Bodies4& to) {
    set_lane(lane, from.velocity_mps, to.velocity);
    set_lane(lane, from.spin_radps, to.spin);
}
void pack(const SolverBody& from, std::size_t lane, Bodies4& to) {
    set_lane(lane, from.pose_ws.position, to.position);
    set_lane(lane, from.pose_ws.rotation, to.rotation);
    to.inverse_mass[lane] = from.inverse_mass;
    set_lane(lane, may_turn(from) ? from.inverse_inertia_bs : Vec3(Vec3::Zero()),
             to.inverse_inertia_bs);
    pack_velocity(from, lane, to);
}
// True if mass and pose are those with which the body was packed or stored.
bool is_as_packed(const SolverBody& from, std::size_t lane, const Bodies4& body) {
    return from.inverse_mass == body.inverse_mass[lane] &&
           is_lane(lane, body.position, from.pose_ws.position) &&
           is_lane(lane, body.rotation, from.pose_ws.rotation) &&
           (is_lane(lane, body.inverse_inertia_bs, from.inverse_inertia_bs) || !may_turn(from));
}

// Replaces an immovable body at one end of a constraint: an immovable body located at the anchor
// point, with the velocity of that point.
SolverBody body_at(const SolverBody& body, const Vec3& point_bs) {
    const Vec3 arm = body.pose_ws.rotation * point_bs;
    SolverBody at;
    at.pose_ws.position = transform_point(body.pose_ws, point_bs);
    at.velocity_mps = body.velocity_mps + body.spin_radps.cross(arm);
    return at;
}

double sign_of(std::uint32_t end) { return end % 2 == 0 ? 1.0 : -1.0; }

}  // namespace

void TriadSystem::read_bodies(const IslandView& island) {
    const std::size_t count = island.island_bodies.size();
    body_indices_.assign(island.island_bodies.begin(), island.island_bodies.end());
    may_turn_.resize(count);
    for (std::size_t slot = 0; slot < count; ++slot) {
        may_turn_[slot] = may_turn(island.bodies[body_indices_[slot]]) ? 1 : 0;
    }
    uses_.assign(count, 0);
}

void TriadSystem::pack_bodies(const IslandView& island) {
    const TriadPlan& plan = plans_.current();
    // bodies_ may hold another island, but every lane that is read is written below
    bodies_.resize(plan.group_count());
    for (std::uint32_t place = 0; place < plan.slots().size(); ++place) {
        const std::uint32_t slot = plan.slots()[place];
        if (slot != k_no_slot) {
            pack(island.bodies[body_indices_[slot]], place % k_lanes, group_of(place));
        }
    }
    for (const Anchor& anchor : anchors_) {
        if (anchor.place != k_no_slot) {
            pack(body_at(island.bodies[anchor.body], anchor.point_bs), anchor.place % k_lanes,
                 group_of(anchor.place));
        }
    }
    for (std::size_t place = plan.slots().size(); place < k_lanes * bodies_.size(); ++place) {
        pack({}, place % k_lanes, bodies_[place / k_lanes]);
    }
}

void TriadSystem::pack_velocities(const IslandView& island) {
    const std::span<const std::uint32_t> slots = plans_.current().slots();
    for (std::uint32_t place = 0; place < slots.size(); ++place) {
        if (slots[place] != k_no_slot) {
            pack_velocity(island.bodies[body_indices_[slots[place]]], place % k_lanes,
                          group_of(place));
        }
    }
    for (const Anchor& anchor : anchors_) {
        if (anchor.place != k_no_slot) {
            pack_velocity(body_at(island.bodies[anchor.body], anchor.point_bs),
                          anchor.place % k_lanes, group_of(anchor.place));
        }
    }
}

// Adds a triad. Returns false if more than k_hub_nodes triads share a body.
bool TriadSystem::add(const IslandView& island, std::uint32_t index, bool is_angular) {
    const RowBlock& block = island.blocks[index];
    const bool is_drive = handhold::is_drive(block);
    const std::size_t triad = triad_count_++;
    if (triad_count_ > triads_.size()) {
        resize(2 * triad_count_);
    }
    triads_[triad] = {index, is_angular, is_drive};
    has_drive_rows_ = has_drive_rows_ || is_drive;
    has_turn_ = has_turn_ || is_angular;
    RowNode& node = nodes_[triad];
    node = {{k_no_slot, k_no_slot}, 3, false, !is_angular && !is_drive};
    bool fits = true;
    for (std::uint32_t side = 0; side < 2; ++side) {
        const std::uint32_t body_index = side == 0 ? block.a : block.b;
        const Vec3& point_bs = side == 0 ? block.point_a_bs : block.point_b_bs;
        const auto end = static_cast<std::uint32_t>(2 * triad + side);
        const double sign = is_angular ? 0.0 : sign_of(end);
        points_[end].v =
            Double4{sign * point_bs.x(), sign * point_bs.y(), sign * point_bs.z(), sign};
        const SolverBody& body = island.bodies[body_index];
        if (body.inverse_mass > 0.0) {
            node.slots[side] = body.slot;
            fits = fits && ++uses_[body.slot] <= k_hub_nodes;
        } else {
            anchors_.push_back({end, body_index, point_bs, k_no_slot, k_no_slot});
        }
    }
    return fits;
}

// Resizes the arrays to `triads` triads and the dummy end.
void TriadSystem::resize(std::size_t triads) {
    triads_.resize(triads);
    nodes_.resize(triads);
    points_.resize(2 * triads + 1);
}

bool TriadSystem::load(const IslandView& island, double touch_m) {
    revision_ = 0;
    read_bodies(island);
    anchors_.clear();
    triad_count_ = 0;
    is_evaluated_ = has_drive_rows_ = has_turn_ = has_stiffness_ = false;
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
    resize(triad_count_);
    plan_nodes();
    pack_bodies(island);
    if (!has_contact && island.filter != BlockFilter::without_drives) {
        revision_ = island.revision;
    }
    return true;
}

bool TriadSystem::matches_loaded_state(const IslandView& island) const {
    if (!std::ranges::equal(body_indices_, island.island_bodies)) {
        return false;
    }
    const std::span<const std::uint32_t> slots = plans_.current().slots();
    for (std::uint32_t place = 0; place < slots.size(); ++place) {
        if (slots[place] != k_no_slot && !is_as_packed(island.bodies[body_indices_[slots[place]]],
                                                       place % k_lanes, group_of(place))) {
            return false;
        }
    }
    return std::ranges::none_of(anchors_, [&](const Anchor& anchor) {
        return island.bodies[anchor.body].inverse_mass > 0.0;
    });
}

bool TriadSystem::resume(const IslandView& island) {
    if (revision_ == 0 || revision_ != island.revision ||
        island.filter == BlockFilter::without_drives || !matches_loaded_state(island)) {
        return false;
    }
    pack_velocities(island);
    has_stiffness_ = false;
    activate_all_rows();
    clear_impulses();
    return true;
}

void TriadSystem::plan_nodes() {
    const TriadPlan& plan = plans_.choose(nodes_, may_turn_);
    const std::span<const std::uint32_t> rest = plan.rest();
    is_drive_.resize(rest.size());
    std::ranges::transform(rest, is_drive_.begin(), [this](std::uint32_t triad) {
        return static_cast<std::uint8_t>(triads_[triad].is_drive ? 1 : 0);
    });
    const std::size_t count = rest.size();
    ends_.resize(2 * count + 1);
    values_.resize(count);
    lambdas_.resize(count + 1);
    lambdas_.back() = {};
    impulses_.resize(count);
    blocks_.resize(plan.block_count() + 1);
    inverses_.resize(count);
    unknowns_.resize(count);
    links_.resize(plan.strand_pack_steps());
    strands_.resize(plan.strand_packs().size());
    multipliers_.resize(plan.strand_pack_steps() + 2 * plan.strand_packs().size());
    activate_all_rows();
    clear_impulses();
    place_anchors();
    load_ends();
}

void TriadSystem::clear_impulses() {
    std::ranges::fill(impulses_, TriadVector{});
    for (Links4& links : links_) {
        assign({zero4(), zero4(), zero4()}, links.impulse);
    }
}

void TriadSystem::place_anchors() {
    const TriadPlan& plan = plans_.current();
    for (Anchor& anchor : anchors_) {
        const std::uint32_t rest = plan.rest_places()[anchor.end / 2];
        if (rest != k_no_slot) {
            anchor.rest_end = 2 * rest + anchor.end % 2;
            continue;
        }
        anchor.place =
            std::ranges::find(plan.anchored_ends(), anchor.end, &TriadPlan::AnchoredEnd::end)
                ->place;
        points_[anchor.end].v = Double4{0.0, 0.0, 0.0, sign_of(anchor.end)};
    }
}

void TriadSystem::load_ends() {
    const std::span<const TriadPlan::Lanes> ends = plans_.current().packed_ends();
    body_ends_.resize(ends.size());
    for (std::size_t i = 0; i < ends.size(); ++i) {
        Ends4& ends4 = body_ends_[i];
        for (std::size_t lane = 0; lane < k_lanes; ++lane) {
            const std::uint32_t end = ends[i][lane];
            const Double4 point = end == k_no_slot ? zero4() : points_[end].v;
            ends4.point_bs.x[lane] = point[0];
            ends4.point_bs.y[lane] = point[1];
            ends4.point_bs.z[lane] = point[2];
            ends4.sign[lane] = point[3];
            const bool is_angular = has_turn_ && end != k_no_slot && triads_[end / 2].is_angular;
            ends4.lever[lane] = is_angular ? k_angle_lever_m * sign_of(end) : 0.0;
        }
    }
}

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

double TriadSystem::drive_scale() const {
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
        drive_scale_ = drive_scale();
    }
    const double drive_alpha = has_drive_rows_ ? factor * regularisation.drive * drive_scale_ : 0.0;
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
