#include "systems/hand/search_grip.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "components/finger_chain.hpp"
#include "components/finger_room.hpp"
#include "components/palm_fit.hpp"
#include "engine/collision/closest_point.hpp"
#include "engine/geometry/triangle_set.hpp"

namespace handhold {
namespace {

constexpr std::uint32_t k_most_search_pops = 300;
constexpr std::uint32_t k_patience = 24;  // pops without a better triangle end the search
constexpr double k_look_again_m = 0.016;  // a hand goes so far before it looks for room again

// Of two places on a surface: hardly another one.
bool is_beside(const Vec3& point, const Vec3& normal, const Vec3& other, const Vec3& other_normal) {
    constexpr double k_near_m = 0.025;
    constexpr double k_alike = 0.7;
    return (point - other).squaredNorm() < k_near_m * k_near_m &&
           normal.dot(other_normal) > k_alike;
}

struct Palm {
    Vec3 center;
    Vec3 up;  // unit: towards the back of the hand
};

Palm palm_in(const Pose& frame, const HandSurroundings& hand) {
    const Pose wrist = inverse(frame) * hand.wrist_bs;
    return {transform_point(wrist, hand.rig->palm_center_hs),
            wrist.rotation * -hand.rig->palm_normal_hs};
}

struct Candidate {
    double cost_m = std::numeric_limits<double>::infinity();
    Vec3 point = Vec3::Zero();
};

// What it takes to hold the palm to one triangle, in closed form: along the triangle's normal into
// the range of heights, then about the palm's own centre, which keeps its height, into the range of
// angles.
Candidate cost_of(const SurfaceGraph& graph, std::uint32_t triangle, const Palm& palm,
                  const PalmTuning& tuning) {
    const auto& [a, b, c] = graph.triangles[triangle];
    const Corners corners = {graph.positions[a], graph.positions[b], graph.positions[c]};
    const bool turned_away = graph.normals[triangle].dot(palm.up) < 0.0;
    const Vec3 normal = turned_away ? Vec3(-graph.normals[triangle]) : graph.normals[triangle];
    const double height_m = (palm.center - corners[0]).dot(normal);
    const Vec3 point = closest_on_triangle(palm.center - height_m * normal, corners);
    const Vec3 moved = point + std::clamp(height_m, tuning.min_height_m,
                                          std::max(tuning.min_height_m, tuning.max_height_m)) *
                                   normal;
    const double angle_rad = arc_tangent2(palm.up.cross(normal).norm(), palm.up.dot(normal));
    return {(moved - palm.center).norm() +
                tuning.tilt_cost_m_per_rad * std::max(0.0, angle_rad - tuning.max_angle_rad) +
                (turned_away ? tuning.back_cost_m : 0.0),
            point};
}

class GripSearcher {
  public:
    GripSearcher(const SurfaceGraph& graph, const Palm& palm, const PalmTuning& tuning,
                 GripSearchScratch& scratch)
        : graph_(graph),
          palm_(palm),
          tuning_(tuning),
          open_(scratch.open),
          seen_(scratch.seen),
          found_(scratch.found) {
        open_.clear();
        open_.reserve(3 * k_most_search_pops + 16);
        found_.clear();
        found_.reserve(k_most_search_pops);
    }

    void add_seed(std::uint32_t triangle) {
        if (triangle < graph_.triangles.size()) {
            push(triangle);
        }
    }

    using Found = GripSearchScratch::Found;
    // Goes on until `patience` pops in a row found nothing cheaper; may be called again.
    void run(std::uint32_t patience) {
        std::uint32_t idle = 0;
        while (pops_ < k_most_search_pops && idle < patience && !open_.empty()) {
            ++pops_;
            std::pop_heap(open_.begin(), open_.end(), later);
            const GripSearchScratch::Node node = open_.back();
            open_.pop_back();
            ++idle;
            if (found_.empty() || node.cost_m < best_m_) {
                best_m_ = node.cost_m;
                idle = 0;
            }
            found_.push_back({node.triangle, node.point, node.cost_m});
            for (const std::uint32_t next : graph_.neighbours[node.triangle]) {
                if (next != k_no_triangle) {
                    push(next);
                }
            }
        }
    }

    // The cheapest of those found that is not near any of `tried` and alike; none where there is
    // none.
    std::optional<Found> cheapest_beside(std::span<const Found> tried) const {
        std::optional<Found> best;
        for (const Found& found : found_) {
            const bool is_new = std::none_of(tried.begin(), tried.end(), [&](const Found& other) {
                return is_beside(found.point, graph_.normals[found.triangle], other.point,
                                 graph_.normals[other.triangle]);
            });
            if (is_new && (!best || found.cost_m < best->cost_m)) {
                best = found;
            }
        }
        return best;
    }

    // The cheapest of those found that is near `other` and alike.
    std::optional<Found> cheapest_near(const Vec3& other, std::uint32_t other_triangle) const {
        std::optional<Found> best;
        for (const Found& found : found_) {
            if (is_beside(found.point, graph_.normals[found.triangle], other,
                          graph_.normals[other_triangle]) &&
                (!best || found.cost_m < best->cost_m)) {
                best = found;
            }
        }
        return best;
    }

  private:
    static bool later(const GripSearchScratch::Node& a, const GripSearchScratch::Node& b) {
        return a.cost_m != b.cost_m ? a.cost_m > b.cost_m : a.order > b.order;
    }

    void push(std::uint32_t triangle) {
        if (!seen_.insert(triangle)) {
            return;
        }
        const Candidate candidate = cost_of(graph_, triangle, palm_, tuning_);
        if ((candidate.point - palm_.center).squaredNorm() > tuning_.reach_m * tuning_.reach_m) {
            return;
        }
        open_.push_back({candidate.cost_m, triangle, pushed_++, candidate.point});
        std::push_heap(open_.begin(), open_.end(), later);
    }

    const SurfaceGraph& graph_;
    const Palm& palm_;
    const PalmTuning& tuning_;
    std::vector<GripSearchScratch::Node>& open_;
    TriangleSet<2048> seen_;
    std::uint32_t pushed_ = 0;
    std::vector<Found>& found_;
    double best_m_ = 0.0;
    std::uint32_t pops_ = 0;
};

// The mean of the surface around the point, by area, of what is wound so that it looks towards
// `outward`; unit.
Vec3 mean_normal(const GripMesh& mesh, const Vec3& point, const Vec3& triangle_normal,
                 const Vec3& outward, double radius_m) {
    Vec3 sum = Vec3::Zero();
    const SurfaceGraph& surface = mesh.contact;
    mesh.contact_bvh.visit_in_sphere(point, radius_m, [&](std::uint32_t triangle) {
        const auto& [a, b, c] = surface.triangles[triangle];
        const Corners corners = {surface.positions[a], surface.positions[b], surface.positions[c]};
        const Vec3 area = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        if (area.dot(outward) > 0.0) {
            // A triangle that reaches far out counts no more than the sphere's cut can.
            const double most = 2.0 * std::numbers::pi * radius_m * radius_m;
            const double squared = area.squaredNorm();
            sum += squared > most * most ? Vec3(most / std::sqrt(squared) * area) : area;
        }
    });
    const double length = sum.norm();
    return length > 1e-12 ? Vec3(sum / length) : triangle_normal;
}

class PalmHolder {
  public:
    PalmHolder(const HandSurroundings& hand, double dt_s, const Tuning& tuning, GripSearch search,
               GripSearchScratch& scratch)
        : hand_(hand), dt_s_(dt_s), tuning_(tuning), search_(search), scratch_(scratch) {}

    void run(GripSurface& surface) {
        const PlacedMesh& placed = hand_.meshes.front();
        const GripMesh& mesh = *placed.mesh;
        const Palm palm = palm_in(placed.pose, hand_);
        const auto hit = mesh.search_bvh.cast_ray(
            palm.center + tuning_.hand.ray_back_m * palm.up,
            palm.center - (tuning_.hand.ray_length_m - tuning_.hand.ray_back_m) * palm.up);
        const auto near = mesh.search_bvh.closest_point(palm.center, tuning_.palm.reach_m);
        const GripSurface last = surface;
        const std::uint32_t before = last.body == hand_.body ? last.triangle : ~0U;
        surface = {};
        if (search_ == GripSearch::ray_only) {
            if (hit) {
                surface = surface_at(placed, palm, {hit->triangle, hit->point, 0.0});
            }
            return;
        }
        GripSearcher searcher(mesh.search, palm, tuning_.palm, scratch_);
        searcher.add_seed(hit ? hit->triangle : GripSurface::k_none);
        searcher.add_seed(near ? near->triangle : GripSurface::k_none);
        searcher.add_seed(before);
        searcher.run(k_patience);
        const bool is_known = before < mesh.search.triangles.size();
        if (is_known && last.was_judged && !std::isinf(dt_s_) &&
            rest(placed, palm, searcher, last, surface)) {
            return;
        }
        if (is_known && last.tried_count == 0 &&
            (stay(placed, palm, searcher, last, surface) ||
             keep_room(placed, palm, searcher, last, surface))) {
            return;
        }
        surface = try_surfaces(placed, palm, searcher, is_known ? last : GripSurface{});
    }

    // Under a palm in an authored grip: fingers that close begin there.
    void run_authored(GripSurface& surface) {
        const PlacedMesh& placed = hand_.meshes.front();
        const Pose wrist = inverse(placed.pose) * hand_.authored->wrist_bs;
        const Palm palm = {transform_point(wrist, hand_.rig->palm_center_hs),
                           wrist.rotation * -hand_.rig->palm_normal_hs};
        const auto near = placed.mesh->search_bvh.closest_point(palm.center, tuning_.palm.reach_m);
        surface = {};
        if (near) {
            surface = surface_at(placed, palm, {near->triangle, near->point, 0.0});
        }
        surface.wrist_bs = hand_.authored->wrist_bs;
        surface.surroundings = 0;  // out of the grip the surface is searched for
    }

  private:
    using Found = GripSearcher::Found;

    // Time counts as a way too: a hand at rest looks again.
    double still_to_go_m(double left_m, const GripSurface& last) const {
        constexpr double k_time_mps = 0.045;
        constexpr double k_at_once_m = 5e-4;
        const double least_m = std::isinf(dt_s_) ? k_at_once_m : k_time_mps * dt_s_;
        return left_m - std::max(hand_way_m(last.wrist_bs, hand_.wrist_bs), least_m);
    }

    // No surface is judged in two frames in a row: digits have their turn. False where it is gone,
    // or its room is.
    bool rest(const PlacedMesh& placed, const Palm& palm, const GripSearcher& searcher,
              const GripSurface& last, GripSurface& surface) const {
        constexpr double k_next_m = 1e-9;
        const auto near = near_last(placed, searcher, last);
        if (near) {
            const Held held = held_at(placed, palm, *near);
            if (last.has_room_m > 0.0 && held.sunk_m > k_roomy_m) {
                return false;
            }
            surface = held.surface;
            surface.cost_m = last.cost_m;
            surface.tried = last.tried;
            surface.tried_count = last.tried_count;
            surface.has_room_m = std::max(still_to_go_m(last.has_room_m, last), 0.0);
            surface.look_in_m = last.look_in_m > 0.0
                                    ? std::max(still_to_go_m(last.look_in_m, last), k_next_m)
                                    : 0.0;
        }
        return near.has_value();
    }

    // Looking for room is dear, and what has none mostly has none a little farther on: a hand that
    // looked stays with what it found for a while. False where it is to look now.
    bool stay(const PlacedMesh& placed, const Palm& palm, const GripSearcher& searcher,
              const GripSurface& last, GripSurface& surface) const {
        const double left_m = still_to_go_m(last.look_in_m, last);
        if (left_m <= 0.0) {
            return false;
        }
        const auto near = near_last(placed, searcher, last);
        if (near) {
            surface = held_at(placed, palm, *near).surface;
            surface.look_in_m = left_m;
        }
        return near.has_value();
    }

    // What had room for fingers mostly has it a little farther on. False where it is to be asked.
    bool keep_room(const PlacedMesh& placed, const Palm& palm, const GripSearcher& searcher,
                   const GripSurface& last, GripSurface& surface) const {
        const double left_m = still_to_go_m(last.has_room_m, last);
        const auto cheapest = searcher.cheapest_beside({});
        if (left_m <= 0.0 || !cheapest || !is_near_last(placed, *cheapest, last)) {
            return false;
        }
        const Held held = held_at(placed, palm, *cheapest);
        surface = held.surface;
        surface.has_room_m = left_m;
        return held.sunk_m <= k_roomy_m;
    }

    static bool is_near_last(const PlacedMesh& placed, const Found& found,
                             const GripSurface& last) {
        const SurfaceGraph& graph = placed.mesh->search;
        return is_beside(found.point, graph.normals[found.triangle],
                         inverse_transform_point(placed.pose, last.point_bs),
                         graph.normals[last.triangle]);
    }
    static std::optional<Found> near_last(const PlacedMesh& placed, const GripSearcher& searcher,
                                          const GripSurface& last) {
        return last.triangle == GripSurface::k_none
                   ? std::nullopt
                   : searcher.cheapest_near(inverse_transform_point(placed.pose, last.point_bs),
                                            last.triangle);
    }

    // The cheapest surface, if it leaves room for palm and fingers. Else the first that does, of
    // those that are found by looking farther; else the one where cost and what stays sunk are
    // least. A few in each frame: goes on from where `last` came to, or begins with where that is.
    GripSurface try_surfaces(const PlacedMesh& placed, const Palm& palm, GripSearcher& searcher,
                             const GripSurface& last) const {
        std::array<Found, GripSurface::k_most_tries> tried;
        std::size_t count = 0;
        std::size_t left = most_tries();
        Judged best;
        bool was_judged = false;
        const auto near = near_last(placed, searcher, last);
        if (near && last.tried_count > 0) {
            best.surface = held_at(placed, palm, *near).surface;
            best.surface.cost_m = last.cost_m;
            best.surface.has_room_m = last.has_room_m;
            for (; count < last.tried_count; ++count) {
                tried[count] = found_at(placed, palm, last.tried[count]);
            }
        } else if (near) {
            best = judge(placed, palm, *near);
            was_judged = true;
            tried[count++] = *near;
            --left;
            const auto cheapest = searcher.cheapest_beside({});
            if (best.has_room && cheapest && is_near_last(placed, *cheapest, best.surface)) {
                best.surface.was_judged = true;
                return best.surface;
            }
        }
        bool has_looked_around = false;
        bool is_over = count >= tried.size();
        for (; left > 0 && !is_over; --left) {
            if (count > 0 && !has_looked_around) {
                look_around(*placed.mesh, palm, searcher);
                has_looked_around = true;
            }
            const auto way = searcher.cheapest_beside({tried.data(), count});
            if (!way || (count > 0 && way->cost_m >= best.surface.cost_m)) {
                is_over = true;
                break;
            }
            if (count > 0 && is_back(placed, palm, *way) &&
                !may_try_backs(placed, palm, tried.front())) {
                tried[count++] = *way;
                is_over = count == tried.size();
                continue;
            }
            const Judged next = judge(placed, palm, *way);
            was_judged = true;
            if (count == 0 || next.has_room || next.surface.cost_m < best.surface.cost_m) {
                best = next;
            }
            tried[count++] = *way;
            is_over = next.has_room || count == tried.size();
        }
        if (count == 0) {
            return {};
        }
        best.surface.was_judged = was_judged;
        const bool is_cheapest = count == 1 && best.has_room && !near;
        best.surface.look_in_m = is_cheapest ? 0.0 : k_look_again_m;
        best.surface.tried_count = is_over ? 0 : static_cast<std::uint32_t>(count);
        for (std::size_t i = 0; i < best.surface.tried_count; ++i) {
            best.surface.tried[i] = tried[i].triangle;
        }
        return best.surface;
    }

    static bool is_back(const PlacedMesh& placed, const Palm& palm, const Found& found) {
        return placed.mesh->search.normals[found.triangle].dot(palm.up) < 0.0;
    }
    // Fingers have room in a hollow solid too: for their sake alone no palm goes there.
    bool may_try_backs(const PlacedMesh& placed, const Palm& palm, const Found& first) const {
        return is_back(placed, palm, first) || held_at(placed, palm, first).sunk_m > k_roomy_m;
    }

    struct Judged {
        GripSurface surface;
        bool has_room = false;
    };
    Judged judge(const PlacedMesh& placed, const Palm& palm, const Found& found) const {
        const Held held = held_at(placed, palm, found);
        const double fingers_m = fingers_sunk_m(hand_, held.surface.held_bs, scratch_.patch);
        Judged judged = {held.surface,
                         held.sunk_m <= k_roomy_m && fingers_m <= k_fingers_have_room_m};
        judged.surface.cost_m = found.cost_m;
        if (judged.has_room) {
            judged.surface.has_room_m = k_look_again_m;
        } else {
            judged.surface.cost_m += k_sunk_cost * held.sunk_m + k_finger_cost * fingers_m;
        }
        return judged;
    }

    std::size_t most_tries() const {
        return std::isinf(dt_s_)
                   ? GripSurface::k_most_tries
                   : static_cast<std::size_t>(std::max(1, tuning_.palm.tries_per_frame));
    }

    // What the palm would be held to there now. The triangle may be of an older mesh.
    Found found_at(const PlacedMesh& placed, const Palm& palm, std::uint32_t triangle) const {
        const SurfaceGraph& graph = placed.mesh->search;
        const auto known = std::min<std::size_t>(triangle, graph.triangles.size() - 1);
        triangle = static_cast<std::uint32_t>(known);
        const Candidate candidate = cost_of(graph, triangle, palm, tuning_.palm);
        return {triangle, candidate.point, candidate.cost_m};
    }

    struct Held {
        GripSurface surface;
        double sunk_m = 0.0;  // how deep the palm is that is held to it
    };
    Held held_at(const PlacedMesh& placed, const Palm& palm, const Found& found) const {
        Held held = {surface_at(placed, palm, found), 0.0};
        const PalmFit fit = fit_palm(hand_, held.surface, 0.0, tuning_.palm);
        held.surface.held_bs = fit.wrist_bs;
        held.surface.is_held = true;
        held.sunk_m = fit.sunk_m;
        return held;
    }

    // From the nearest triangles to places around the palm, as long as there is anything to see.
    void look_around(const GripMesh& mesh, const Palm& palm, GripSearcher& searcher) const {
        const double apart_m = 0.5 * tuning_.palm.reach_m;
        for (int axis = 0; axis < 3; ++axis) {
            for (const double side : {-1.0, 1.0}) {
                const Vec3 place = palm.center + side * apart_m * Vec3::Unit(axis);
                const auto near = mesh.search_bvh.closest_point(place, apart_m);
                searcher.add_seed(near ? near->triangle : GripSurface::k_none);
            }
        }
        searcher.run(k_most_search_pops);
    }

    GripSurface surface_at(const PlacedMesh& placed, const Palm& palm, const Found& found) const {
        const GripMesh& mesh = *placed.mesh;
        const auto on_contact = mesh.contact_bvh.closest_point(found.point, tuning_.palm.reach_m);
        const Vec3 point = on_contact ? on_contact->point : found.point;
        // Where the triangle is wound the other way, so is what counts around it.
        const Vec3 wound = mesh.search.normals[found.triangle];
        const double side = wound.dot(palm.up) < 0.0 ? -1.0 : 1.0;
        GripSurface surface;
        surface.body = hand_.body;
        surface.wrist_bs = hand_.wrist_bs;
        surface.surroundings = hand_.signature;
        surface.triangle = found.triangle;
        surface.point_bs = transform_point(placed.pose, point);
        surface.normal_bs =
            placed.pose.rotation * Vec3(side * mean_normal(mesh, point, wound, side * palm.up,
                                                           tuning_.palm.normal_radius_m));
        return surface;
    }

    static constexpr double k_roomy_m = 1e-3;
    static constexpr double k_sunk_cost = 8.0;    // of a metre that a palm stays sunk
    static constexpr double k_finger_cost = 4.0;  // and a finger

    const HandSurroundings& hand_;
    double dt_s_;
    const Tuning& tuning_;
    GripSearch search_;
    GripSearchScratch& scratch_;
};

}  // namespace

void search_grip(const SearchGripIo& io, const Tuning& tuning, StageStats& stats,
                 GripSearch search) {
    for (const HandSurroundings& hand : io.hands) {
        GripSurface& surface = io.surface.at(hand.hand);
        if (is_null(hand.body) || hand.meshes.empty()) {
            surface = {};
            continue;
        }
        if (hand.authored != nullptr) {
            const bool is_known = surface.body == hand.body && surface.surroundings == 0 &&
                                  hand_way_m(surface.wrist_bs, hand.authored->wrist_bs) == 0.0;
            if (!is_known) {
                PalmHolder(hand, io.dt_s, tuning, search, io.scratch).run_authored(surface);
            }
            continue;
        }
        const bool is_to_look = surface.tried_count > 0 ||
                                (surface.look_in_m > 0.0 && surface.look_in_m < k_look_again_m);
        if (surface.surroundings == hand.signature && surface.triangle != GripSurface::k_none &&
            !is_to_look && hand_way_m(surface.wrist_bs, hand.wrist_bs) < tuning.finger.stroll_m) {
            surface.was_judged = false;
            continue;
        }
        PalmHolder(hand, io.dt_s, tuning, search, io.scratch).run(surface);
        if (surface.triangle == GripSurface::k_none) {
            stats.count(Fallback::palm_no_surface);
        }
    }
}

}  // namespace handhold
