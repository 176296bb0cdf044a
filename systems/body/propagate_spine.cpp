// Sources: dynamic follow-the-leader, after Mueller, Kim and Chentanez 2012 ("Fast simulation of
// inextensible hair and fur"): joint by joint from the top, what a joint is corrected by goes into
// its velocity, and half of it is taken from its parent's.
#include "systems/body/propagate_spine.hpp"

#include <algorithm>
#include <cmath>

#include "engine/anim/deflect_outward.hpp"
#include "engine/anim/joint_range.hpp"
#include "engine/anim/quadratic_path.hpp"
#include "engine/collision/collision_world.hpp"
#include "engine/ecs/join.hpp"
#include "engine/math/scalar_rotation.hpp"

namespace handhold {
namespace {

constexpr double k_tick_s = 1.0 / 120.0;
constexpr double k_longest_s = 0.5;

constexpr std::size_t k_chest = k_body_links;  // as a parent
enum class LinkKind { spine, thigh, shin };

// In the frame of the link above; lengths of a player whose eyes are at k_scale_eye_m.
struct Link {
    LinkKind kind;
    std::size_t parent;
    double length_m;
    Vec3 base_m;  // from the parent's lower end
    Vec3 rest;    // unit: where the link points when nothing moves
};

// How one floats at rest: hips and knees a little bent.
const std::array<Link, k_body_links>& links() {
    const auto leg_down = [](double x, double forward) {
        return Vec3(x, -1.0, -forward).normalized();
    };
    static const std::array<Link, k_body_links> list = {{
        {LinkKind::spine, k_chest, 0.20, Vec3::Zero(), -Vec3::UnitY()},
        {LinkKind::spine, 0, 0.16, Vec3::Zero(), -Vec3::UnitY()},
        {LinkKind::spine, 1, 0.13, Vec3::Zero(), -Vec3::UnitY()},
        {LinkKind::thigh, 2, 0.40, Vec3(-0.09, -0.03, 0.0), leg_down(-0.05, 0.25)},
        {LinkKind::shin, 3, 0.39, Vec3::Zero(), leg_down(0.0, -0.40)},
        {LinkKind::thigh, 2, 0.40, Vec3(0.09, -0.03, 0.0), leg_down(0.05, 0.25)},
        {LinkKind::shin, 5, 0.39, Vec3::Zero(), leg_down(0.0, -0.40)},
    }};
    return list;
}

// The ankle lets the toes hang.
constexpr double k_toes_down_rad = 0.6;

// A frame as a rotation and as its axes: what hangs on a link asks for both.
struct Frame {
    Quat rotation;
    Mat3 axes;
};
Frame frame_at(const Quat& rotation) { return {rotation, rotation.toRotationMatrix()}; }

// Chest and links as they stand at one time, from the chest; in play space's axes or the world's.
struct Chain {
    Frame chest;
    std::array<Frame, k_body_links> links;
};

const Frame& parent_frame(const Chain& chain, const Link& link) {
    return link.parent == k_chest ? chain.chest : chain.links[link.parent];
}

Vec3 base_of(const Frame& above, const BodyLinkVectors& offset_m, const Link& link, double scale) {
    switch (link.kind) {
        case LinkKind::spine:
            return link.parent == k_chest ? Vec3(Vec3::Zero()) : offset_m[link.parent];
        case LinkKind::thigh:
            return offset_m[link.parent] + above.axes * (scale * link.base_m);
        case LinkKind::shin:
            break;
    }
    return offset_m[link.parent];
}

// How far a link is bent where it points to its rest, as the limits measure it.
double rest_angle(const Link& link) {
    return link.kind == LinkKind::shin ? arc_tangent2(link.rest.z(), -link.rest.y()) : 0.0;
}

JointRange range_of(LinkKind kind, const SpineTuning& tuning) {
    const double share = k_tick_s / (k_tick_s + tuning.limit_lag_s);
    switch (kind) {
        case LinkKind::spine:
            return {0.0, tuning.spine_limit_rad, share};
        case LinkKind::thigh:
            return {0.0, tuning.hip_limit_rad, share};
        case LinkKind::shin:
            break;
    }
    return {0.0, tuning.knee_limit_rad, share};
}

// The frame of a link that points along `towards` in that of the one above: turned by the least,
// then about itself.
Quat frame_of(const Quat& above, const Vec3& towards, double twist_rad) {
    // From -Y: the half angle's cosine and axis are as 1 - y to (-z, 0, x).
    const double cosine = 1.0 - towards.y();
    if (cosine < 0.5) {
        const Quat bent = above * rotation_between(-Vec3::UnitY(), towards);
        return (bent * rotation_about(Vec3::UnitY(), twist_rad)).normalized();
    }
    const double by =
        1.0 / std::sqrt(cosine * cosine + towards.x() * towards.x() + towards.z() * towards.z());
    const double w = cosine * by;
    const double x = -towards.z() * by;
    const double z = towards.x() * by;
    if (twist_rad == 0.0) {
        return product(above, Quat(w, x, 0.0, z));
    }
    double sine = 0.0;
    double turn = 1.0;
    sin_cos(0.5 * twist_rad, sine, turn);
    return product(above, Quat(w * turn, x * turn - z * sine, w * sine, z * turn + x * sine));
}

double twist_of(const SpineMemory& memory, std::size_t i) {
    return i < k_spine_links ? memory.twist_rad[i] : 0.0;
}

Quat between(const Quat& a, const Quat& b, double share) {
    const double sign = a.dot(b) < 0.0 ? -1.0 : 1.0;
    const double of_b = sign * share;
    const double of_a = 1.0 - share;
    return unit_quat(of_a * a.w() + of_b * b.w(), of_a * a.x() + of_b * b.x(),
                     of_a * a.y() + of_b * b.y(), of_a * a.z() + of_b * b.z());
}

void rest_at(const Quat& chest, double scale, double t_s, SpineMemory& memory) {
    Chain chain{frame_at(chest), {}};
    memory.velocity_mps.fill(Vec3::Zero());
    memory.twist_rad.fill(0.0);
    memory.moved_m = Vec3::Zero();
    memory.since_tick_s = std::fmod(t_s, k_tick_s);
    memory.tick_chest_ps = chest;
    memory.contacts = {};
    for (std::size_t i = 0; i < k_body_links; ++i) {
        const Link& link = links()[i];
        const Frame& above = parent_frame(chain, link);
        memory.offset_m[i] = base_of(above, memory.offset_m, link, scale) +
                             above.axes * ((scale * link.length_m) * link.rest);
        memory.angle_rad[i] = rest_angle(link);
        chain.links[i] = frame_at(frame_of(above.rotation, link.rest, 0.0));
    }
    memory.before_m = memory.offset_m;
}

// The chest has turned; each link keeps its heading at first and follows the one above with a lag.
void pass_twist(const Quat& from, const Quat& to, const SpineTuning& tuning, SpineMemory& memory) {
    const Quat turn = from.conjugate() * to;
    double passed = 2.0 * arc_tangent2(turn.w() < 0.0 ? -turn.y() : turn.y(), std::abs(turn.w()));
    const double share = k_tick_s / (k_tick_s + tuning.twist_lag_s);
    for (double& twist : memory.twist_rad) {
        const double wanted = twist - passed;
        const double now =
            std::clamp((1.0 - share) * wanted, -tuning.twist_limit_rad, tuning.twist_limit_rad);
        passed = now - wanted;  // by how much this link turns in the world: the next one lags
        twist = now;
    }
}

// What of a tick does not depend on the player.
struct TickShares {
    double back, drag;
    std::array<JointRange, 3> range;  // by LinkKind
};
TickShares tick_shares(const SpineTuning& tuning) {
    return {std::min(1.0, tuning.return_per_s * k_tick_s),
            1.0 / (1.0 + tuning.drag_per_s * k_tick_s),
            {range_of(LinkKind::spine, tuning), range_of(LinkKind::thigh, tuning),
             range_of(LinkKind::shin, tuning)}};
}

// Drag, then what no joint is faster than.
void slow_down(double drag, double speed_max_mps, BodyLinkVectors& velocity_mps) {
    for (Vec3& velocity : velocity_mps) {
        velocity *= drag;
        const double speed2 = velocity.squaredNorm();
        if (speed2 > speed_max_mps * speed_max_mps) {
            velocity *= speed_max_mps / std::sqrt(speed2);
        }
    }
}

// Of the leg that a link is in; nothing for the spine and where the leg touches nothing.
const LegContact* contact_of(const SpineMemory& memory, std::size_t i) {
    const LegContact* const contact =
        i < k_spine_links ? nullptr : &memory.contacts[(i - k_spine_links) / 2];
    return contact != nullptr && contact->touches ? contact : nullptr;
}

// The link's direction, in the frame of the one above, turned out of what its end has gone into.
// No faster than a leg is drawn up: who is put into a wall comes out of it without a jump.
Vec3 before_surface(const Vec3& towards, const Vec3& base_m, const Link& link, double scale,
                    const Frame& above, const LegContact& contact) {
    constexpr double k_out_mps = 3.0;
    const double length_m = scale * link.length_m;
    const double place_m = link.kind == LinkKind::shin ? contact.ankle_m : contact.surface_m;
    const double least_m = place_m - contact.normal_ps.dot(base_m);
    return deflect_outward(towards, above.axes.transpose() * contact.normal_ps, least_m / length_m,
                           k_out_mps * k_tick_s / length_m);
}

// What of a correction would throw a joint off the surface faster than it goes already.
Vec3 rebound_mps(const Vec3& normal, const Vec3& velocity_mps, const Vec3& correction_mps) {
    const double before = normal.dot(velocity_mps);
    const double after = before + normal.dot(correction_mps);
    return std::max(0.0, after - std::max(0.0, before)) * normal;
}

struct Ticked {
    Quat chest;
    Vec3 moved_m;  // by the chest since the last tick
    Vec3 ahead_m;  // what it still goes until the frame's end
};

void tick(const Ticked& now, double scale, const SpineTuning& tuning, SpineMemory& memory) {
    const Quat& chest = now.chest;
    pass_twist(memory.tick_chest_ps, chest, tuning, memory);
    memory.tick_chest_ps = chest;
    memory.before_m = memory.offset_m;
    Chain chain{frame_at(chest), {}};
    const TickShares shares = tick_shares(tuning);
    constexpr double k_ticks_per_s = 1.0 / k_tick_s;
    for (std::size_t i = 0; i < k_body_links; ++i) {
        const Link& link = links()[i];
        const Frame& above = parent_frame(chain, link);
        const Vec3 base = base_of(above, memory.offset_m, link, scale);
        const Vec3 predicted = memory.offset_m[i] + k_tick_s * memory.velocity_mps[i] - now.moved_m;
        Vec3 towards = above.axes.transpose() * (predicted - base);
        const double distance = towards.norm();
        towards = distance > 1e-6 ? Vec3(towards * (1.0 / distance)) : link.rest;
        const Vec3 blend = (1.0 - shares.back) * towards + shares.back * link.rest;
        Vec3 returned = blend * (1.0 / blend.norm());
        const LegContact* const contact = contact_of(memory, i);
        if (contact != nullptr) {
            returned = before_surface(returned, base - now.ahead_m, link, scale, above, *contact);
        }
        const JointRange& range = shares.range[static_cast<std::size_t>(link.kind)];
        const Vec3 allowed = link.kind == LinkKind::shin
                                 ? clamp_to_hinge(returned, range, memory.angle_rad[i])
                                 : clamp_to_cone(returned, link.rest, range, memory.angle_rad[i]);
        memory.offset_m[i] = base + above.axes * ((scale * link.length_m) * allowed);
        // With the return in it the velocity swings past the rest; what is handed back damps that.
        Vec3 correction_mps = (memory.offset_m[i] - predicted) * k_ticks_per_s;
        if (contact != nullptr) {
            correction_mps -=
                rebound_mps(contact->normal_ps, memory.velocity_mps[i], correction_mps);
        }
        memory.velocity_mps[i] += correction_mps;
        if (link.parent != k_chest) {
            const double share = link.kind == LinkKind::thigh ? 0.5 : 1.0;  // there are two
            memory.velocity_mps[link.parent] -= (share * tuning.hand_back) * correction_mps;
        }
        if (link.kind != LinkKind::shin) {  // nothing hangs on it
            chain.links[i] = frame_at(frame_of(above.rotation, allowed, twist_of(memory, i)));
        }
    }
    slow_down(shares.drag, tuning.speed_max_mps, memory.velocity_mps);
}

// Between the last two ticks, with lengths made good again.
void show(const Pose& chest_ws, const SpineMemory& memory, const Pose& chest_ps, double scale,
          SpinePose& out) {
    const double share = memory.since_tick_s / k_tick_s;
    Chain chain{frame_at(chest_ws.rotation), {}};
    BodyLinkVectors offset_m;  // in the world's axes
    std::array<Pose, k_body_links> bones;
    // Play space's axes to the world's.
    const Mat3 to_ws = chain.chest.axes * chest_ps.rotation.toRotationMatrix().transpose();
    for (std::size_t i = 0; i < k_body_links; ++i) {
        const Link& link = links()[i];
        const Frame& above = parent_frame(chain, link);
        const Vec3 base = base_of(above, offset_m, link, scale);
        const Vec3 end =
            to_ws * (memory.before_m[i] + share * (memory.offset_m[i] - memory.before_m[i]));
        Vec3 towards = above.axes.transpose() * (end - base);
        const double distance = towards.norm();
        towards = distance > 1e-6 ? Vec3(towards * (1.0 / distance)) : link.rest;
        offset_m[i] = base + above.axes * ((scale * link.length_m) * towards);
        chain.links[i] = frame_at(frame_of(above.rotation, towards, twist_of(memory, i)));
        bones[i] = {chest_ws.position + base, chain.links[i].rotation};
    }
    const auto end_of = [&](std::size_t i) { return Vec3(chest_ws.position + offset_m[i]); };
    static const Quat k_toes_down = rotation_about(Vec3::UnitX(), -k_toes_down_rad);
    out.chest_ws = chest_ws;
    std::copy_n(bones.begin(), k_spine_links, out.spine_ws.begin());
    out.pelvis_ws = {end_of(k_spine_links - 1), bones[k_spine_links - 1].rotation};
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        const std::size_t thigh = k_spine_links + 2 * side;
        SpinePose::Leg& leg = out.legs[side];
        leg.thigh_ws = bones[thigh];
        leg.shin_ws = bones[thigh + 1];
        leg.foot_ws = {end_of(thigh + 1), product(bones[thigh + 1].rotation, k_toes_down)};
    }
}

struct Motion {
    double dt_s;
    double t_s;  // of the world's clock, at the end
    Pose chest_ps;
    Vec3 moved_m;  // by the chest in this frame, against the reference, in play space's axes
};

void play(const Motion& motion, double scale, const SpineTuning& tuning, SpineMemory& memory) {
    const double span_s = std::min(motion.dt_s, k_longest_s);
    const QuadraticPath way(motion.moved_m, span_s, memory.rate_mps, memory.rate_span_s);
    const Quat from = memory.chest_ps.rotation;
    double played_s = 0.0;
    while (memory.since_tick_s + (span_s - played_s) >= k_tick_s) {
        const double until_s = played_s + (k_tick_s - memory.since_tick_s);
        const Vec3 moved_m = memory.moved_m + (way.at(until_s) - way.at(played_s));
        played_s = until_s;
        const Quat chest = between(from, motion.chest_ps.rotation, played_s / span_s);
        tick({chest, moved_m, way.at(span_s) - way.at(until_s)}, scale, tuning, memory);
        memory.moved_m = Vec3::Zero();
        memory.since_tick_s = 0.0;
    }
    memory.since_tick_s = span_s < motion.dt_s
                              ? std::fmod(motion.t_s, k_tick_s)
                              : std::max(0.0, memory.since_tick_s + (span_s - played_s));
    memory.moved_m += way.at(span_s) - way.at(played_s);
    memory.rate_mps = way.rate_mps();
    memory.rate_span_s = span_s;
}

// Whether it is this player's and leg's turn to look for surfaces: 15 times a second of the world's
// clock, each at times of their own.
bool looks_now(const PropagateSpineIo& io, std::uint64_t player, std::size_t side) {
    constexpr double k_looks_per_s = 15.0;
    constexpr std::uint64_t k_phases = 8;
    const double phase = static_cast<double>(player % k_phases) / static_cast<double>(k_phases) +
                         0.5 * static_cast<double>(side);
    return std::floor(io.t_s * k_looks_per_s + phase) !=
           std::floor((io.t_s - io.dt_s) * k_looks_per_s + phase);
}

// First surface on the line from the head to the sole, as the leg hung at the last tick: the head
// is before all surfaces, hips need not be.
LegContact look_down(const PropagateSpineIo& io, Entity player, const Pose& chest_ps,
                     const Vec3& ankle_m, double scale) {
    constexpr double k_ahead_m = 0.2;  // for what comes until the next look
    const double sole_m = 0.11 * scale;
    const Pose& origin_ws = io.origin.at(player).pose_ws;
    // Well inside the head: eyes are at its rim, which may touch.
    const Vec3 in_head_m(0.0, 0.0, 0.08);
    const Vec3 head_ps = transform_point(io.head->at(player).pose_ps, in_head_m);
    const Vec3 way = chest_ps.position + ankle_m - head_ps;
    const double length = way.norm();
    if (!(length > sole_m)) {
        return {};
    }
    const Vec3 along = way * (1.0 / length);
    const std::array<std::uint64_t, 1> skip = {io.persistent_id->at(player).value};
    const auto hit = io.collision->cast_ray(
        transform_point(origin_ws, head_ps),
        transform_point(origin_ws, head_ps + (length + sole_m + k_ahead_m) * along), skip);
    if (!hit) {
        return {};
    }
    const Vec3 normal_ps = origin_ws.rotation.conjugate() * hit->normal_ws;
    const double surface_m =
        normal_ps.dot(inverse_transform_point(origin_ws, hit->point_ws) - chest_ps.position);
    return {true, normal_ps, surface_m, surface_m - sole_m * normal_ps.dot(along)};
}

void touch_surfaces(const PropagateSpineIo& io, Entity player, const Motion& motion, double scale,
                    SpineMemory& memory) {
    if (io.collision == nullptr) {
        return;
    }
    const std::uint64_t id = io.persistent_id->at(player).value;
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        LegContact& contact = memory.contacts[side];
        if (looks_now(io, id, side)) {
            const Vec3& ankle_m = memory.offset_m[k_spine_links + 2 * side + 1];
            contact = look_down(io, player, motion.chest_ps, ankle_m, scale);
        } else {
            const double nearer_m = contact.normal_ps.dot(motion.moved_m);
            contact.surface_m -= nearer_m;
            contact.ankle_m -= nearer_m;
        }
    }
}

}  // namespace

void propagate_spine(const PropagateSpineIo& io, const SpineTuning& tuning) {
    for (std::size_t row = 0; row < io.pose.size(); ++row) {
        const Entity player = io.pose.owners()[row];
        SpineMemory& memory = io.memory.at(player);
        const Pose& origin_ws = io.origin.at(player).pose_ws;
        const double scale = io.measures.at(player).eye_height_m / k_scale_eye_m;
        const Pose& chest_ps = io.estimate.at(player).chest_ps;
        const Vec3& reference_ws = io.reference.at(player).linear_mps;
        const Vec3 own_m = chest_ps.position - memory.chest_ps.position;
        const Quat to_ps = origin_ws.rotation.conjugate();
        const Vec3 relative = to_ps * (io.velocity.at(player).linear_mps - reference_ws);
        if (!memory.known || is_jump(own_m.norm(), io.dt_s)) {
            rest_at(chest_ps.rotation, scale, io.t_s, memory);
            memory.known = true;
            memory.rate_mps = relative;
            memory.rate_span_s = io.dt_s;
        } else {
            // What counts as standing still has changed: nothing that moves has.
            const Vec3 shift = to_ps * (memory.reference_ws_mps - reference_ws);
            for (Vec3& velocity : memory.velocity_mps) {
                velocity += shift;
            }
            memory.rate_mps += shift;
            const Motion motion{io.dt_s, io.t_s, chest_ps, own_m + io.dt_s * relative};
            touch_surfaces(io, player, motion, scale, memory);
            play(motion, scale, tuning, memory);
        }
        memory.reference_ws_mps = reference_ws;
        memory.chest_ps = chest_ps;
        show(origin_ws * chest_ps, memory, chest_ps, scale, io.pose.at(player));
    }
}

}  // namespace handhold
