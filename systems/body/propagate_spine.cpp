// Sources: dynamic follow-the-leader, after Mueller, Kim and Chentanez 2012 ("Fast simulation of
// inextensible hair and fur"): joint by joint from the top, what a joint is corrected by goes into
// its velocity, and half of it is taken from its parent's.
#include "systems/body/propagate_spine.hpp"

#include <algorithm>
#include <cmath>

#include "engine/ecs/join.hpp"

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

// Chest and links as they stand at one time, in play space's axes from the chest.
struct Chain {
    Quat chest;
    std::array<Quat, k_body_links> frame;
};

const Quat& parent_frame(const Chain& chain, const Link& link) {
    return link.parent == k_chest ? chain.chest : chain.frame[link.parent];
}

Vec3 base_of(const Chain& chain, const BodyLinkVectors& offset_m, const Link& link, double scale) {
    if (link.parent == k_chest) {
        return scale * (chain.chest * link.base_m);
    }
    return offset_m[link.parent] + scale * (chain.frame[link.parent] * link.base_m);
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
Vec3 within_knee(const Vec3& towards, const Quat& thigh, const Range& range, double& angle_rad) {
    const Vec3 straight = thigh * -Vec3::UnitY();
    const Vec3 back = thigh * Vec3::UnitZ();
    angle_rad = nearing(range, angle_rad, arc_tangent2(towards.dot(back), towards.dot(straight)));
    double sine = 0.0;
    double cosine = 1.0;
    sin_cos(angle_rad, sine, cosine);
    return cosine * straight + sine * back;
}

// How far `towards` is bent against the link above, as the limits measure it.
double angle_of(const Vec3& towards, const Link& link, const Quat& above) {
    if (link.kind == LinkKind::shin) {
        return arc_tangent2(towards.dot(above * Vec3::UnitZ()),
                            -towards.dot(above * Vec3::UnitY()));
    }
    const Vec3 rest = above * link.rest;
    return arc_tangent2(rest.cross(towards).norm(), rest.dot(towards));
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

// The frame of a link that points along `towards`: the one above, turned by the least, twisted.
Quat frame_of(const Vec3& towards, const Quat& above, double twist_rad) {
    const Quat bent = rotation_between(above * -Vec3::UnitY(), towards) * above;
    return twist_rad == 0.0 ? bent.normalized()
                            : (bent * rotation_about(Vec3::UnitY(), twist_rad)).normalized();
}

double twist_of(const SpineMemory& memory, std::size_t i) {
    return i < k_spine_links ? memory.twist_rad[i] : 0.0;
}

Quat between(const Quat& a, const Quat& b, double share) {
    const double sign = a.dot(b) < 0.0 ? -1.0 : 1.0;
    return Quat((1.0 - share) * a.coeffs() + (share * sign) * b.coeffs()).normalized();
}

void rest_at(const Quat& chest, double scale, double t_s, SpineMemory& memory) {
    Chain chain{chest, {}};
    memory.velocity_mps.fill(Vec3::Zero());
    memory.twist_rad.fill(0.0);
    memory.moved_m = Vec3::Zero();
    memory.since_tick_s = std::fmod(t_s, k_tick_s);
    memory.tick_chest_ps = chest;
    for (std::size_t i = 0; i < k_body_links; ++i) {
        const Link& link = links()[i];
        const Quat& above = parent_frame(chain, link);
        const Vec3 towards = above * link.rest;
        memory.offset_m[i] =
            base_of(chain, memory.offset_m, link, scale) + scale * link.length_m * towards;
        memory.angle_rad[i] = angle_of(towards, link, above);
        chain.frame[i] = frame_of(towards, above, 0.0);
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

void tick(const Quat& chest, const Vec3& moved_m, double scale, const SpineTuning& tuning,
          SpineMemory& memory) {
    pass_twist(memory.tick_chest_ps, chest, tuning, memory);
    memory.tick_chest_ps = chest;
    memory.before_m = memory.offset_m;
    Chain chain{chest, {}};
    const double back = std::min(1.0, tuning.return_per_s * k_tick_s);
    const double drag = 1.0 / (1.0 + tuning.drag_per_s * k_tick_s);
    for (std::size_t i = 0; i < k_body_links; ++i) {
        const Link& link = links()[i];
        const Quat& above = parent_frame(chain, link);
        const Vec3 base = base_of(chain, memory.offset_m, link, scale);
        const double length = scale * link.length_m;
        const Vec3 predicted = memory.offset_m[i] + k_tick_s * memory.velocity_mps[i] - moved_m;
        Vec3 towards = predicted - base;
        const double distance = towards.norm();
        const Vec3 rest = above * link.rest;
        towards = distance > 1e-6 ? Vec3(towards / distance) : rest;
        const Vec3 returned = ((1.0 - back) * towards + back * rest).normalized();
        const Range range = range_of(link.kind, tuning);
        const Vec3 allowed = link.kind == LinkKind::shin
                                 ? within_knee(returned, above, range, memory.angle_rad[i])
                                 : within_cone(returned, rest, range, memory.angle_rad[i]);
        memory.offset_m[i] = base + length * allowed;
        // With the return in it the velocity swings past the rest; what is handed back damps that.
        const Vec3 correction = memory.offset_m[i] - predicted;
        memory.velocity_mps[i] += correction / k_tick_s;
        if (link.parent != k_chest) {
            const double share = link.kind == LinkKind::thigh ? 0.5 : 1.0;  // there are two
            memory.velocity_mps[link.parent] -= (share * tuning.hand_back / k_tick_s) * correction;
        }
        chain.frame[i] = frame_of(allowed, above, twist_of(memory, i));
    }
    for (Vec3& velocity : memory.velocity_mps) {
        velocity *= drag;
        const double speed = velocity.norm();
        if (speed > tuning.speed_max_mps) {
            velocity *= tuning.speed_max_mps / speed;
        }
    }
}

// Between the last two ticks, with lengths made good again.
void show(const Pose& chest_ws, const SpineMemory& memory, const Pose& chest_ps, double scale,
          SpinePose& out) {
    const double share = memory.since_tick_s / k_tick_s;
    Chain chain{chest_ps.rotation, {}};
    BodyLinkVectors offset_m;
    std::array<Pose, k_body_links> bones;
    // Play space's axes to the world's.
    const Quat to_ws = chest_ws.rotation * chest_ps.rotation.conjugate();
    for (std::size_t i = 0; i < k_body_links; ++i) {
        const Link& link = links()[i];
        const Quat& above = parent_frame(chain, link);
        const Vec3 base = base_of(chain, offset_m, link, scale);
        Vec3 towards =
            memory.before_m[i] + share * (memory.offset_m[i] - memory.before_m[i]) - base;
        const double distance = towards.norm();
        towards = distance > 1e-6 ? Vec3(towards / distance) : Vec3(above * link.rest);
        offset_m[i] = base + scale * link.length_m * towards;
        chain.frame[i] = frame_of(towards, above, twist_of(memory, i));
        bones[i] = {chest_ws.position + to_ws * base, (to_ws * chain.frame[i]).normalized()};
    }
    const auto end_of = [&](std::size_t i) {
        return Vec3(chest_ws.position + to_ws * offset_m[i]);
    };
    out.chest_ws = chest_ws;
    std::copy_n(bones.begin(), k_spine_links, out.spine_ws.begin());
    out.pelvis_ws = {end_of(k_spine_links - 1), bones[k_spine_links - 1].rotation};
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        const std::size_t thigh = k_spine_links + 2 * side;
        SpinePose::Leg& leg = out.legs[side];
        leg.thigh_ws = bones[thigh];
        leg.shin_ws = bones[thigh + 1];
        leg.foot_ws = {end_of(thigh + 1),
                       (bones[thigh + 1].rotation * rotation_about(Vec3::UnitX(), -k_toes_down_rad))
                           .normalized()};
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
