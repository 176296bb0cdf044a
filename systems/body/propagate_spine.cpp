// Sources: dynamic follow-the-leader, after Mueller, Kim and Chentanez 2012 ("Fast simulation of
// inextensible hair and fur"): joint by joint from the top, what a joint is corrected by goes into
// its velocity, and half of it is taken from its parent's.
#include "systems/body/propagate_spine.hpp"

#include <algorithm>
#include <cmath>

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

// A link nears the end of its range by at most a share of what is left a tick. A stop within one
// tick would whip what hangs below, differently for each place in the tick at which it comes.
struct Range {
    double low_rad, high_rad, share;
};
double nearing(const Range& range, double before_rad, double now_rad) {
    const double before = std::clamp(before_rad, range.low_rad, range.high_rad);
    return std::clamp(now_rad, before + range.share * (range.low_rad - before),
                      before + range.share * (range.high_rad - before));
}

// In the frame of the link above, as all that follows.
// Spine and hips: a cone about `rest`. `angle_rad` is the angle to it, of the last tick, then of
// this one.
Vec3 within_cone(const Vec3& towards, const Vec3& rest, const Range& range, double& angle_rad) {
    const double along = towards.dot(rest);
    const Vec3 aside = towards - along * rest;
    const double length = aside.norm();
    const double wanted = arc_tangent2(length, along);
    // From the rest there is no way below.
    angle_rad = std::min(wanted, nearing(range, angle_rad, std::max(wanted, angle_rad)));
    if (angle_rad >= wanted) {
        return towards;
    }
    if (length < 1e-9) {
        return rest;
    }
    double sine = 0.0;
    double cosine = 1.0;
    sin_cos(angle_rad, sine, cosine);
    return cosine * rest + aside * (sine / length);
}

// A knee: in the plane of its hinge, which is the thigh's X, from straight back to its limit.
Vec3 within_knee(const Vec3& towards, const Range& range, double& angle_rad) {
    angle_rad = nearing(range, angle_rad, arc_tangent2(towards.z(), -towards.y()));
    double sine = 0.0;
    double cosine = 1.0;
    sin_cos(angle_rad, sine, cosine);
    return {0.0, -cosine, sine};
}

// How far a link is bent where it points to its rest, as the limits measure it.
double rest_angle(const Link& link) {
    return link.kind == LinkKind::shin ? arc_tangent2(link.rest.z(), -link.rest.y()) : 0.0;
}

Range range_of(LinkKind kind, const SpineTuning& tuning) {
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
    std::array<Range, 3> range;  // by LinkKind
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

void tick(const Quat& chest, const Vec3& moved_m, double scale, const SpineTuning& tuning,
          SpineMemory& memory) {
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
        const Vec3 predicted = memory.offset_m[i] + k_tick_s * memory.velocity_mps[i] - moved_m;
        Vec3 towards = above.axes.transpose() * (predicted - base);
        const double distance = towards.norm();
        towards = distance > 1e-6 ? Vec3(towards * (1.0 / distance)) : link.rest;
        const Vec3 blend = (1.0 - shares.back) * towards + shares.back * link.rest;
        const Vec3 returned = blend * (1.0 / blend.norm());
        const Range& range = shares.range[static_cast<std::size_t>(link.kind)];
        const Vec3 allowed = link.kind == LinkKind::shin
                                 ? within_knee(returned, range, memory.angle_rad[i])
                                 : within_cone(returned, link.rest, range, memory.angle_rad[i]);
        memory.offset_m[i] = base + above.axes * ((scale * link.length_m) * allowed);
        // With the return in it the velocity swings past the rest; what is handed back damps that.
        const Vec3 correction_mps = (memory.offset_m[i] - predicted) * k_ticks_per_s;
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

// The chest's way in one frame, against the reference, in play space's axes: through where it was
// at both ends of the last frame and is now, so that a steady acceleration looks the same at any
// frame rate. Never back past either end.
class Way {
  public:
    Way(const Vec3& moved_m, double span_s, const SpineMemory& memory)
        : span_s_(span_s), rate_mps_(moved_m / span_s) {
        const Vec3 change = rate_mps_ - memory.rate_mps;
        bend_ = change / (span_s + memory.rate_span_s);
        // Twice what the way leaves the straight line at its ends must not exceed the line.
        const double most = rate_mps_.norm();
        const double ends = bend_.norm() * span_s;
        if (ends > most) {
            bend_ *= most / ends;
        }
    }
    Vec3 at(double t_s) const { return t_s * rate_mps_ + (t_s * (t_s - span_s_)) * bend_; }
    const Vec3& rate_mps() const { return rate_mps_; }

  private:
    double span_s_;
    Vec3 rate_mps_;
    Vec3 bend_;  // half the acceleration
};

struct Motion {
    double dt_s;
    double t_s;  // of the world's clock, at the end
    Pose chest_ps;
    Vec3 moved_m;  // by the chest in this frame, against the reference, in play space's axes
};

void play(const Motion& motion, double scale, const SpineTuning& tuning, SpineMemory& memory) {
    const double span_s = std::min(motion.dt_s, k_longest_s);
    const Way way(motion.moved_m, span_s, memory);
    const Quat from = memory.chest_ps.rotation;
    double played_s = 0.0;
    while (memory.since_tick_s + (span_s - played_s) >= k_tick_s) {
        const double until_s = played_s + (k_tick_s - memory.since_tick_s);
        const Vec3 moved_m = memory.moved_m + (way.at(until_s) - way.at(played_s));
        played_s = until_s;
        tick(between(from, motion.chest_ps.rotation, played_s / span_s), moved_m, scale, tuning,
             memory);
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
            play({io.dt_s, io.t_s, chest_ps, own_m + io.dt_s * relative}, scale, tuning, memory);
        }
        memory.reference_ws_mps = reference_ws;
        memory.chest_ps = chest_ps;
        show(origin_ws * chest_ps, memory, chest_ps, scale, io.pose.at(player));
    }
}

}  // namespace handhold
