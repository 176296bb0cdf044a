// Solver, packed: chooses the constraints of an island to pack, and loads them into lanes.
#include <algorithm>

#include "engine/solver/packed/triad_system.hpp"

namespace handhold {
namespace {

// True if all rows of the block are equations in every state: none may release, slide, stop or
// yield.
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
// True if the body's mass, inertia and pose equal the values that were packed or stored.
bool is_as_packed(const SolverBody& from, std::size_t lane, const Bodies4& body) {
    return from.inverse_mass == body.inverse_mass[lane] &&
           is_lane(lane, body.position, from.pose_ws.position) &&
           is_lane(lane, body.rotation, from.pose_ws.rotation) &&
           (is_lane(lane, body.inverse_inertia_bs, from.inverse_inertia_bs) || !may_turn(from));
}

// Returns a substitute for an immovable body at one end of a constraint: an immovable body located
// at the anchor point, with the velocity of that point.
SolverBody body_at(const SolverBody& body, const Vec3& point_bs) {
    const Vec3 arm = body.pose_ws.rotation * point_bs;
    SolverBody at;
    at.pose_ws.position = transform_point(body.pose_ws, point_bs);
    at.velocity_mps = body.velocity_mps + body.spin_radps.cross(arm);
    return at;
}

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
    // No need to clear bodies_, which may still hold another island: every lane that is read is
    // written below.
    bodies_.resize(plan.group_count());
    for (std::uint32_t place = 0; place < plan.slots().size(); ++place) {
        const std::uint32_t slot = plan.slots()[place];
        if (slot != k_no_slot) {
            pack(island.bodies[body_indices_[slot]], place % TriadPlan::k_lanes, group_of(place));
        }
    }
    for (const Anchor& anchor : anchors_) {
        if (anchor.place != k_no_slot) {
            pack(body_at(island.bodies[anchor.body], anchor.point_bs),
                 anchor.place % TriadPlan::k_lanes, group_of(anchor.place));
        }
    }
    for (std::size_t place = plan.slots().size(); place < TriadPlan::k_lanes * bodies_.size();
         ++place) {
        pack({}, place % TriadPlan::k_lanes, bodies_[place / TriadPlan::k_lanes]);
    }
}

void TriadSystem::pack_velocities(const IslandView& island) {
    const std::span<const std::uint32_t> slots = plans_.current().slots();
    for (std::uint32_t place = 0; place < slots.size(); ++place) {
        if (slots[place] != k_no_slot) {
            pack_velocity(island.bodies[body_indices_[slots[place]]], place % TriadPlan::k_lanes,
                          group_of(place));
        }
    }
    for (const Anchor& anchor : anchors_) {
        if (anchor.place != k_no_slot) {
            pack_velocity(body_at(island.bodies[anchor.body], anchor.point_bs),
                          anchor.place % TriadPlan::k_lanes, group_of(anchor.place));
        }
    }
}

// Adds a triad. Returns false if one of its bodies then has more than k_hub_nodes triads.
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

// Resizes the arrays to `triads` triads. points_ has one more element, for the dummy end.
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
        if (slots[place] != k_no_slot &&
            !is_as_packed(island.bodies[body_indices_[slots[place]]], place % TriadPlan::k_lanes,
                          group_of(place))) {
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
        for (std::size_t lane = 0; lane < TriadPlan::k_lanes; ++lane) {
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

}  // namespace handhold
