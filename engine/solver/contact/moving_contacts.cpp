// Solver, contact: refreshes contacts at the poses a solve ended with.
#include "engine/solver/contact/moving_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <tuple>

#include "engine/solver/contact/contact_rows.hpp"
#include "engine/solver/model/collider_pose.hpp"
#include "engine/solver/newton/settings.hpp"

namespace handhold {
namespace {

constexpr double k_moved_m = 1e-5;  // colliders that moved less keep their contacts
// k_moved_m for bodies in a heap, whose pairs were all found within the margin before the solve.
constexpr double k_heap_moved_m = 1e-3;
// An old contact point is dropped if the bodies have slid farther than this at it.
constexpr double k_max_slide_m = 5e-3;
constexpr double k_same_point_m = 1e-3;
constexpr double k_same_normal = 0.99;
constexpr double k_touch_m = VelocitySettings{}.touch_m;

// True if a collider moved farther than its contacts stay valid.
bool exceeds_contact_motion(const Pose& from, const Pose& to, double limit_m) {
    const double square = (to.position - from.position).squaredNorm();
    if (square > limit_m * limit_m) {
        return true;
    }
    const double translation_m = std::sqrt(square);
    const double rotation_rad = 2.0 * (to.rotation.conjugate() * from.rotation).vec().norm();
    return translation_m + rotation_rad * 0.5 > limit_m;
}

// Moves a body's proxy to the body's pose if the body has moved too far for its contacts to stay
// valid. Skips bodies without a collider.
void move_proxy(const MovingContacts& moving, std::uint32_t i) {
    const SolverBody& body = moving.graph.bodies[i];
    if (body.role == BodyRole::fixed || !body.is_searched ||
        moving.proxies[i].shape == k_no_shape) {
        return;
    }
    ColliderProxy& proxy = moving.proxies[i];
    const Pose now = collider_pose(body);
    const double limit_m = body.in_heap ? k_heap_moved_m : k_moved_m;
    if (exceeds_contact_motion(proxy.to_ws, now, limit_m)) {
        proxy.to_ws = now;
        moving.updates.push_back(proxy);
    }
}

// Moves the proxies of all bodies that may have moved. True if any moved; they are in
// moving.updates.
bool move_proxies(const MovingContacts& moving) {
    moving.updates.clear();
    for (const std::uint32_t i : moving.graph.island_bodies) {
        move_proxy(moving, i);
    }
    for (const std::uint32_t i : moving.also_moved) {
        move_proxy(moving, i);
    }
    return !moving.updates.empty();
}

auto order_of(const ContactPoint& contact) {
    return std::tie(contact.id_a, contact.id_b, contact.feature);
}
bool is_pair_before(const ContactPoint& x, const ContactPoint& y) {
    return std::tie(x.id_a, x.id_b) < std::tie(y.id_a, y.id_b);
}

// The distance between a contact's two points at the bodies' current poses.
struct PointOffset {
    double normal_m = 0.0;   // component along the normal; negative: penetrating
    double tangent_m = 0.0;  // component across the normal
};

// The bodies of a contact, with their colliders' poses.
struct PairPoses {
    const SolverBody& a;
    const SolverBody& b;
    Pose a_ws = collider_pose(a);
    Pose b_ws = collider_pose(b);

    PairPoses(const ConstraintGraph& graph, const ContactPoint& contact)
        : a(graph.bodies[find_body(graph, contact.id_a)]),
          b(graph.bodies[find_body(graph, contact.id_b)]) {}

    PointOffset offset_of(const ContactPoint& contact) const {
        const Vec3 offset =
            transform_point(a_ws, contact.point_a_bs) - transform_point(b_ws, contact.point_b_bs);
        const Vec3 normal = b_ws.rotation * contact.normal_b_bs;
        const double normal_m = normal.dot(offset);
        return {normal_m, (offset - normal * normal_m).norm()};
    }
};

bool has_slid_apart(const PointOffset& offset) { return offset.tangent_m > k_max_slide_m; }

// True if the contact's separation is 0 after the solve (within k_touch_m): it limited the motion.
bool limited_motion(const PointOffset& offset) { return std::abs(offset.normal_m) < k_touch_m; }

// True if the bodies approach each other at the contact, with their velocities before the frame's
// impacts, and the solve has slid the contact's two points apart: a sweep found the contact where
// the bodies met on their way.
bool is_impact(const PairPoses& pair, const PointOffset& offset, const ContactPoint& contact) {
    constexpr double k_slid_m = 1e-3;
    constexpr double k_slow_mps = 0.05;
    const auto velocity_of = [](const SolverBody& body, const Vec3& point_bs) {
        const Vec3 arm = body.pose_ws.rotation * (point_bs + body.collider_offset_bs);
        return Vec3(body.velocity_mps + body.spin_radps.cross(arm));
    };
    if (offset.tangent_m <= k_slid_m) {
        return false;
    }
    const Vec3 normal = pair.b_ws.rotation * contact.normal_b_bs;
    const Vec3 approach_mps =
        velocity_of(pair.b, contact.point_b_bs) - velocity_of(pair.a, contact.point_a_bs);
    return normal.dot(approach_mps) > k_slow_mps;
}

bool any_touches(std::span<const ContactPoint> points) {
    return std::ranges::any_of(
        points, [](const ContactPoint& point) { return point.separation_m < k_touch_m; });
}

bool has_same_point(const ContactPoint& contact, std::span<const ContactPoint> points) {
    return std::ranges::any_of(points, [&contact](const ContactPoint& point) {
        return (point.point_a_bs - contact.point_a_bs).norm() < k_same_point_m &&
               point.normal_b_bs.dot(contact.normal_b_bs) > k_same_normal;
    });
}

// Merges two sorted lists into `into`, from the back, so that no other memory is needed.
void merge_sorted(std::span<const ContactPoint> list, std::vector<ContactPoint>& into) {
    std::size_t left = into.size();
    std::size_t right = list.size();
    into.resize(left + right);
    while (right > 0) {
        const bool from_list = left == 0 || order_of(into[left - 1]) < order_of(list[right - 1]);
        into[left + right - 1] = from_list ? list[right - 1] : into[left - 1];
        --(from_list ? right : left);
    }
}

// Merges old and new contacts; both lists are sorted. New contacts replace the old ones of their
// pair, or join them (OldPoints). Pairs that are no longer found keep their old contacts, because
// those keep the pair apart. If none of a pair's new contacts touches, the old contacts that
// limited the motion stay too: a ball that a rail deflects slides along the contact's plane and
// ends slightly off the rail, but the impact at the old point must still change its velocity.
void merge_contacts(const MovingContacts& moving, OldPoints old_points) {
    const std::vector<ContactPoint>& fresh = moving.scratch;
    const std::size_t new_count = fresh.size();
    std::size_t kept = 0;   // old contacts that stay, moved to the front of moving.contacts
    std::size_t first = 0;  // range of new contacts of the same pair as `old`
    std::size_t end = 0;
    std::uint32_t feature = 0;      // highest feature id of the pair
    std::optional<PairPoses> pair;  // poses of the last old contact
    for (std::size_t i = 0; i < moving.contacts.size(); ++i) {
        ContactPoint old = moving.contacts[i];
        if (!pair || pair->a.id != old.id_a || pair->b.id != old.id_b) {
            pair.emplace(moving.graph, old);
            first = end;
            while (first < new_count && is_pair_before(fresh[first], old)) {
                ++first;
            }
            end = first;
            while (end < new_count && !is_pair_before(old, fresh[end])) {
                feature = fresh[end++].feature;
            }
        }
        const auto found = std::span(fresh).subspan(first, end - first);
        if (found.empty()) {
            moving.contacts[kept++] = old;
            continue;
        }
        const PointOffset offset = pair->offset_of(old);
        const bool limited = !any_touches(found) && limited_motion(offset);
        const bool stays =
            old_points == OldPoints::kept && !has_slid_apart(offset) && !has_same_point(old, found);
        if (limited || stays) {
            old.feature = ++feature;
            moving.contacts[kept++] = old;
        } else if (moving.impacts != nullptr && !has_same_point(old, found) &&
                   limited_motion(offset) && is_impact(*pair, offset, old)) {
            moving.impacts->push_back(old);
        }
    }
    moving.contacts.resize(kept);
    merge_sorted(moving.contacts, moving.scratch);
    std::swap(moving.contacts, moving.scratch);
}

}  // namespace

void restore_impacts(const MovingContacts& moving, std::span<const ContactPoint> impacts) {
    if (impacts.empty()) {
        return;
    }
    for (ContactPoint impact : impacts) {
        std::uint32_t feature = 0;
        for (const ContactPoint& contact : moving.contacts) {
            if (contact.id_a == impact.id_a && contact.id_b == impact.id_b) {
                feature = std::max(feature, contact.feature + 1);
            }
        }
        impact.feature = feature;
        const PointOffset offset = PairPoses(moving.graph, impact).offset_of(impact);
        impact.point_b_bs += offset.normal_m * impact.normal_b_bs;
        impact.separation_m = 0.0;
        moving.contacts.push_back(impact);
    }
    std::ranges::sort(moving.contacts, {}, order_of);
    replace_contact_rows(moving.contacts, moving.graph);
}

FoundContacts refresh_contacts(const MovingContacts& moving, const ContactLimits& limits,
                               OldPoints old_points) {
    if (!move_proxies(moving) && moving.also_moved.empty()) {
        return FoundContacts::unchanged;
    }
    moving.collision.update_proxies(moving.updates);
    moving.collision.find_contacts(limits, moving.scratch);
    const bool overlaps = std::ranges::any_of(moving.scratch, [](const ContactPoint& contact) {
        return contact.separation_m < -k_new_overlap_m;
    });
    merge_contacts(moving, old_points);
    replace_contact_rows(moving.contacts, moving.graph);
    return overlaps ? FoundContacts::overlapping : FoundContacts::clear;
}

}  // namespace handhold
