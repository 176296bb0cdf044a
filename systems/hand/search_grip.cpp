#include "systems/hand/search_grip.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "components/authored_grip.hpp"
#include "components/finger_chain.hpp"
#include "components/finger_room.hpp"
#include "components/palm_fit.hpp"
#include "components/surface_search.hpp"
#include "engine/collision/closest_point.hpp"

namespace handhold {
namespace {

constexpr std::uint32_t k_patience = 24;    // pops without a better triangle end the search
constexpr std::uint32_t k_patience_on = 6;  // where it was found a moment ago
constexpr double k_search_again_m = 0.006;  // what was found is followed so far
constexpr std::uint32_t k_most_pushed_at_rest = 24;
constexpr int k_most_pushes_on = 1;       // of a palm that goes on: it settles from frame to frame
constexpr int k_most_pushes_tried = 2;    // of one that is tried, and taken only if it is better
constexpr double k_look_again_m = 0.016;  // a hand goes so far before it looks for room again

PalmPlace palm_in(const Pose& frame, const HandSurroundings& hand) {
    const Pose wrist = inverse(frame) * hand.wrist_bs;
    return {transform_point(wrist, hand.rig->palm_center_hs),
            wrist.rotation * -hand.rig->palm_normal_hs};
}

// The mean of the surface around the point, by area, of what is wound so that it looks towards
// `outward`; unit.
Vec3 mean_normal(const GripMesh& mesh, const Vec3& point, const Vec3& triangle_normal,
                 const Vec3& outward, double radius_m) {
    // A triangle that reaches far out counts no more than the sphere's cut can.
    const double most_m2 = 2.0 * std::numbers::pi * radius_m * radius_m;
    const Vec3 sum = mesh.contact_bvh.areas_in_sphere(point, radius_m, outward, most_m2);
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
        const PalmPlace palm = palm_in(placed.pose, hand_);
        const GripSurface last = surface;
        const std::uint32_t before = last.body == hand_.body ? last.triangle : ~0U;
        surface = {};
        if (search_ == GripSearch::ray_only) {
            if (const auto hit = cast_palm_ray(mesh, palm)) {
                surface = surface_at(placed, palm, {hit->triangle, hit->point, 0.0});
            }
            return;
        }
        SurfaceSearch searcher(mesh.search, palm, tuning_.palm, scratch_);
        searcher.add_seed(before);
        const bool is_known = before < mesh.search.triangles.size();
        const double search_in_m = last.search_in_m - hand_way_m(last.wrist_bs, hand_.wrist_bs);
        // What fails to follow is not held anew: what is taken of it keeps its normal for as long.
        double search_again_m = k_search_again_m;
        if (is_known && search_in_m > 0.0 && !std::isinf(dt_s_)) {
            searcher.run(k_patience_on);
            search_again_m = search_in_m;
            kept_normal_bs_ = last.normal_bs;
            if (goes_on(placed, palm, searcher, last, surface)) {
                surface.search_in_m = search_in_m;
                return;
            }
            kept_normal_bs_.reset();
            surface = {};
        }
        const auto hit = cast_palm_ray(mesh, palm);
        const auto near = mesh.search_bvh.closest_point(palm.center, tuning_.palm.reach_m);
        searcher.add_seed(hit ? hit->triangle : GripSurface::k_none);
        searcher.add_seed(near ? near->triangle : GripSurface::k_none);
        searcher.run(k_patience);
        if (is_known && goes_on(placed, palm, searcher, last, surface)) {
            surface.search_in_m = search_again_m;
            return;
        }
        surface = try_surfaces(placed, palm, searcher, is_known ? last : GripSurface{});
        surface.search_in_m = search_again_m;
    }

    // Under a palm in an authored grip: fingers that close begin there.
    void run_authored(GripSurface& surface) {
        const PlacedMesh& placed = hand_.meshes.front();
        const Pose wrist = inverse(placed.pose) * hand_.authored->wrist_bs;
        const PalmPlace palm = {transform_point(wrist, hand_.rig->palm_center_hs),
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
    using Found = SurfaceSearch::Found;

    std::optional<TriangleHit> cast_palm_ray(const GripMesh& mesh, const PalmPlace& palm) const {
        return mesh.search_bvh.cast_ray(
            palm.center + tuning_.hand.ray_back_m * palm.up,
            palm.center - (tuning_.hand.ray_length_m - tuning_.hand.ray_back_m) * palm.up);
    }

    // On the surface that it had. False where surfaces are to be judged.
    bool goes_on(const PlacedMesh& placed, const PalmPlace& palm, const SurfaceSearch& searcher,
                 const GripSurface& last, GripSurface& surface) {
        if (last.was_judged && !std::isinf(dt_s_) && rest(placed, palm, searcher, last, surface)) {
            return true;
        }
        return last.tried_count == 0 && (stay(placed, palm, searcher, last, surface) ||
                                         keep_room(placed, palm, searcher, last, surface));
    }

    // Time counts as a way too: a hand at rest looks again.
    double still_to_go_m(double left_m, const GripSurface& last) const {
        constexpr double k_time_mps = 0.045;
        constexpr double k_at_once_m = 5e-4;
        const double least_m = std::isinf(dt_s_) ? k_at_once_m : k_time_mps * dt_s_;
        return left_m - std::max(hand_way_m(last.wrist_bs, hand_.wrist_bs), least_m);
    }

    // No surface is judged in two frames in a row: digits have their turn. False where it is gone,
    // or its room is.
    bool rest(const PlacedMesh& placed, const PalmPlace& palm, const SurfaceSearch& searcher,
              const GripSurface& last, GripSurface& surface) {
        constexpr double k_next_m = 1e-9;
        const auto near = near_last(placed, searcher, last);
        if (near) {
            const Held held = keep_at(placed, palm, *near, last);
            if (last.has_room_m > 0.0 && held.sunk_m > k_roomy_m) {
                return false;
            }
            surface = held.surface;
            surface.cost_m = last.cost_m;
            surface.tried = last.tried;
            surface.tried_count = last.tried_count;
            surface.listed_count = last.listed_count;
            surface.goes_through = last.goes_through;
            surface.to_clear = last.to_clear;
            surface.has_room_m = std::max(still_to_go_m(last.has_room_m, last), 0.0);
            surface.look_in_m = last.look_in_m > 0.0
                                    ? std::max(still_to_go_m(last.look_in_m, last), k_next_m)
                                    : 0.0;
        }
        return near.has_value();
    }

    // Looking for room is dear, and what has none mostly has none a little farther on: a hand that
    // looked stays with what it found for a while. False where it is to look now.
    bool stay(const PlacedMesh& placed, const PalmPlace& palm, const SurfaceSearch& searcher,
              const GripSurface& last, GripSurface& surface) {
        const double left_m = still_to_go_m(last.look_in_m, last);
        if (left_m <= 0.0) {
            return false;
        }
        const auto near = near_last(placed, searcher, last);
        if (near) {
            const Held held = keep_at(placed, palm, *near, last);
            if (last.has_room_m > 0.0 && held.sunk_m > k_roomy_m) {
                return false;
            }
            surface = held.surface;
            surface.look_in_m = left_m;
            surface.has_room_m = std::max(still_to_go_m(last.has_room_m, last), 0.0);
        }
        return near.has_value();
    }

    // What had room for fingers mostly has it a little farther on. False where it is to be asked.
    bool keep_room(const PlacedMesh& placed, const PalmPlace& palm, const SurfaceSearch& searcher,
                   const GripSurface& last, GripSurface& surface) {
        const double left_m = still_to_go_m(last.has_room_m, last);
        const auto cheapest = searcher.cheapest_beside({});
        if (left_m <= 0.0 || !cheapest || !is_near_last(placed, *cheapest, last)) {
            return false;
        }
        const Held held = keep_at(placed, palm, *cheapest, last);
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
    static std::optional<Found> near_last(const PlacedMesh& placed, const SurfaceSearch& searcher,
                                          const GripSurface& last) {
        return last.triangle == GripSurface::k_none
                   ? std::nullopt
                   : searcher.cheapest_near(inverse_transform_point(placed.pose, last.point_bs),
                                            last.triangle);
    }

    struct Held {
        GripSurface surface;
        double sunk_m = 0.0;          // how deep the palm is that is held to it
        double fingers_sunk_m = 0.0;  // and the fingers that are held clear with it
        double sync_m = 0.0;          // how far it is moved for that, turning counted as a way
        bool is_kept = false;         // from where it was held a frame ago
    };
    struct Judged {
        GripSurface surface;
        bool has_room = false;
    };
    // Surfaces that were tried for one hand, and the best of them; then those that are to be tried,
    // the cheapest first, once they are listed.
    struct Tries {
        std::array<Found, GripSurface::k_most_tries> tried;
        std::size_t count = 0;
        std::size_t listed = 0;  // with those to be tried; 0: not listed
        Judged best;
        bool has_best = false;
        bool was_judged = false;    // in this frame
        FingerBends to_clear = {};  // at the last of them, which is to be judged so as well
        bool goes_through = false;  // GripSurface::goes_through

        bool is_to_be_cleared() const { return to_clear != FingerBends{}; }
        bool is_full() const { return count == tried.size(); }
        bool is_listed() const { return listed > 0; }
        std::span<const Found> so_far() const { return {tried.data(), count}; }
        void add(const Found& found) { tried[count++] = found; }
        bool is_cheaper(const Found& way) const {
            return !has_best || way.cost_m < best.surface.cost_m;
        }
    };

    // The surface where what it takes to hold the palm there is least, pushes out of what it is
    // sunk in included; where palm or fingers have no room, so is what stays sunk. In the order of
    // their costs in closed form, which are rarely more, until those are. A few in each frame: goes
    // on from where `last` came to, or begins with where that is.
    GripSurface try_surfaces(const PlacedMesh& placed, const PalmPlace& palm,
                             SurfaceSearch& searcher, const GripSurface& last) {
        Tries tries;
        std::size_t left = most_tries();
        const auto near = near_last(placed, searcher, last);
        if (near && last.tried_count > 0) {
            recall(placed, palm, *near, last, tries);
        } else if (near) {
            tries.add(*near);
            const bool is_alone = last.bends == FingerBends{} && last.is_held;
            judge(placed, palm, *near,
                  is_alone ? keep_at(placed, palm, *near, last)
                           : held_at(placed, palm, *near, {}, effort_for(tries)),
                  tries);
            --left;
        }
        bool stays = false;
        if (tries.best.has_room) {
            const auto cheapest = searcher.cheapest_beside({});
            stays = cheapest && is_near_last(placed, *cheapest, tries.best.surface);
        }
        const bool is_over = stays || try_others(placed, palm, searcher, last, left, tries);
        if (!tries.has_best) {
            return {};
        }
        GripSurface surface = tries.best.surface;
        surface.was_judged = tries.was_judged;
        const bool is_cheapest = stays || (tries.count == 1 && tries.best.has_room && !near);
        surface.look_in_m = is_cheapest ? 0.0 : k_look_again_m;
        surface.to_clear = {};
        surface.tried_count = surface.listed_count = 0;
        surface.goes_through = false;
        if (!is_over) {
            note_tries(tries, surface);
        }
        return surface;
    }
    static void note_tries(const Tries& tries, GripSurface& surface) {
        surface.to_clear = tries.to_clear;
        surface.goes_through = tries.goes_through;
        surface.tried_count = static_cast<std::uint32_t>(tries.count);
        surface.listed_count = static_cast<std::uint32_t>(tries.listed);
        for (std::size_t i = 0; i < std::max(tries.count, tries.listed); ++i) {
            surface.tried[i] = tries.tried[i].triangle;
        }
    }

    // What was tried in the frames before, where the hand is now; the best of it is near `last`.
    void recall(const PlacedMesh& placed, const PalmPlace& palm, const Found& near,
                const GripSurface& last, Tries& tries) {
        tries.best.surface = keep_at(placed, palm, near, last).surface;
        tries.best.surface.cost_m = last.cost_m;
        tries.best.surface.has_room_m = last.has_room_m;
        tries.best.has_room = last.has_room_m > 0.0;
        tries.has_best = true;
        tries.count = last.tried_count;
        tries.listed = last.listed_count;
        for (std::size_t i = 0; i < std::max(tries.count, tries.listed); ++i) {
            tries.tried[i] = found_at(placed, palm, last.tried[i]);
        }
        tries.to_clear = last.to_clear;
        tries.goes_through = last.goes_through;
    }

    // The cheapest of those that are left, `left` of them. True where there is none to try any
    // more.
    bool try_others(const PlacedMesh& placed, const PalmPlace& palm, SurfaceSearch& searcher,
                    const GripSurface& last, std::size_t left, Tries& tries) {
        for (;;) {
            if (tries.is_to_be_cleared()) {
                if (left == 0) {
                    return false;
                }
                judge_cleared(placed, palm, last, tries);
                --left;
            }
            const bool is_near = tries.best.has_room && tries.best.surface.cost_m < k_near_enough_m;
            if (tries.count > 0 && !tries.is_listed() && !is_near) {
                if (left == 0) {
                    return false;
                }
                list_others(placed, palm, searcher, tries);
                --left;
            }
            const auto way = pass_to_next(placed, palm, searcher, tries);
            if (!way) {
                return true;
            }
            if (left == 0) {
                return false;
            }
            tries.add(*way);
            judge_next(placed, palm, *way, tries);
            --left;
        }
    }

    // The next one in the list, or else the cheapest that is left, that may be cheaper than the
    // best; those passed over are done with.
    std::optional<Found> pass_to_next(const PlacedMesh& placed, const PalmPlace& palm,
                                      const SurfaceSearch& searcher, Tries& tries) const {
        if (tries.is_listed()) {
            while (tries.count < tries.listed && !tries.is_cheaper(tries.tried[tries.count])) {
                ++tries.count;
            }
            return tries.count < tries.listed ? std::optional(tries.tried[tries.count])
                                              : std::nullopt;
        }
        while (!tries.is_full()) {
            const auto way = searcher.cheapest_beside(tries.so_far());
            if (!way || !tries.is_cheaper(*way)) {
                return std::nullopt;
            }
            if (tries.count == 0 || may_try(placed, palm, *way, tries)) {
                return way;
            }
            tries.add(*way);
        }
        return std::nullopt;
    }

    // No backs, but where the palm may have gone through what it came to first: fingers have room
    // behind walls as well, but no palm goes there for it.
    static bool may_try(const PlacedMesh& placed, const PalmPlace& palm, const Found& way,
                        const Tries& tries) {
        return !is_back(placed, palm, way) || (tries.goes_through && !is_inside(placed, way));
    }

    // All around, what may be cheaper than the best.
    void list_others(const PlacedMesh& placed, const PalmPlace& palm, SurfaceSearch& searcher,
                     Tries& tries) const {
        look_around(*placed.mesh, palm, searcher);
        const std::size_t count = tries.count;
        while (!tries.is_full()) {
            const auto way = searcher.cheapest_beside(tries.so_far());
            if (!way || !tries.is_cheaper(*way)) {
                break;
            }
            tries.add(*way);
        }
        tries.was_judged = true;
        tries.listed = count;
        for (std::size_t i = count; i < tries.count; ++i) {
            const Found& way = tries.tried[i];
            if (may_try(placed, palm, way, tries)) {
                tries.tried[tries.listed++] = way;
            }
        }
        tries.count = count;
    }

    // Where the palm alone costs more than the best its fingers are not asked: they make it no
    // cheaper. Where they have no room they are to be held clear with the palm, in their own turn.
    void judge_next(const PlacedMesh& placed, const PalmPlace& palm, const Found& way,
                    Tries& tries) {
        judge(placed, palm, way, held_at(placed, palm, way, {}, effort_for(tries)), tries);
    }
    void judge(const PlacedMesh& placed, const PalmPlace& palm, const Found& way, const Held& held,
               Tries& tries) {
        if (tries.count == 1) {
            tries.goes_through =
                is_back(placed, palm, way) || held.sunk_m > k_roomy_m || held.sync_m > k_far_m;
        }
        Judged judged = judge_held(placed, palm, way, held, 0.0);
        if (!tries.has_best || judged.surface.cost_m < tries.best.surface.cost_m) {
            const FingerRoom room = find_finger_room(hand_, held.surface.held_bs, scratch_.patch);
            if (room.sunk_m > k_fingers_have_room_m) {
                judged = judge_held(placed, palm, way, held, room.sunk_m);
                tries.to_clear = room.bends;
            }
        }
        take_better(judged, tries);
    }

    // The last that was tried; the others of its fingers had room there, and mostly still have it.
    void judge_cleared(const PlacedMesh& placed, const PalmPlace& palm, const GripSurface& last,
                       Tries& tries) {
        const Found& found = tries.tried[tries.count - 1];
        PalmEffort effort = effort_for(tries);
        if (last.triangle != GripSurface::k_none && is_near_last(placed, found, last)) {
            effort.last = &last;
        }
        const Held held = held_at(placed, palm, found, tries.to_clear, effort);
        take_better(judge_held(placed, palm, found, held, held.fingers_sunk_m), tries);
        tries.to_clear = {};
    }

    static void take_better(const Judged& judged, Tries& tries) {
        if (!tries.has_best || judged.surface.cost_m < tries.best.surface.cost_m) {
            tries.best = judged;
        }
        tries.has_best = true;
        tries.was_judged = true;
    }
    // What stays sunk so deep that it is no better is given up soon.
    PalmEffort effort_for(const Tries& tries) const {
        PalmEffort effort;
        if (!std::isinf(dt_s_)) {
            effort.most_pushes = k_most_pushes_tried;
        }
        if (tries.has_best) {
            effort.most_sunk_m = tries.best.surface.cost_m / k_sunk_cost;
        }
        return effort;
    }

    static bool is_back(const PlacedMesh& placed, const PalmPlace& palm, const Found& found) {
        return placed.mesh->search.normals[found.triangle].dot(palm.up) < 0.0;
    }
    // A palm there would be in something solid: what is over it is seen from inside.
    static bool is_inside(const PlacedMesh& placed, const Found& found) {
        constexpr double k_off_m = 1e-3;
        constexpr double k_ray_m = 1.0;
        const Vec3 out = -placed.mesh->search.normals[found.triangle];
        const auto hit = placed.mesh->search_bvh.cast_ray(found.point + k_off_m * out,
                                                          found.point + k_ray_m * out);
        return hit && placed.mesh->search.normals[hit->triangle].dot(out) > 0.0;
    }

    Judged judge_held(const PlacedMesh& placed, const PalmPlace& palm, const Found& found,
                      const Held& held, double fingers_m) const {
        Judged judged = {held.surface,
                         held.sunk_m <= k_roomy_m && fingers_m <= k_fingers_have_room_m};
        judged.surface.cost_m = held.sync_m;
        if (is_back(placed, palm, found)) {
            judged.surface.cost_m +=
                tuning_.palm.back_cost_m + (is_inside(placed, found) ? k_inside_cost_m : 0.0);
        }
        if (judged.has_room) {
            judged.surface.has_room_m = k_look_again_m;
        } else {
            judged.surface.cost_m += k_sunk_cost * held.sunk_m + k_finger_cost * fingers_m;
        }
        return judged;
    }

    std::size_t most_tries() const {
        return std::isinf(dt_s_)
                   ? 2 * GripSurface::k_most_tries
                   : static_cast<std::size_t>(std::max(1, tuning_.palm.tries_per_frame));
    }

    // What the palm would be held to there now. The triangle may be of an older mesh.
    Found found_at(const PlacedMesh& placed, const PalmPlace& palm, std::uint32_t triangle) const {
        const SurfaceGraph& graph = placed.mesh->search;
        const auto known = std::min<std::size_t>(triangle, graph.triangles.size() - 1);
        triangle = static_cast<std::uint32_t>(known);
        const SurfaceCandidate candidate = cost_of(graph, triangle, palm, tuning_.palm);
        return {triangle, candidate.point, candidate.cost_m};
    }

    // As `last` is held, if it is there and with the same fingers held clear.
    Held keep_at(const PlacedMesh& placed, const PalmPlace& palm, const Found& found,
                 const GripSurface& last) {
        PalmEffort effort{.last = &last};
        if (!std::isinf(dt_s_)) {
            effort.most_pushes = k_most_pushes_on;
        }
        return held_at(placed, palm, found, last.bends, effort);
    }

    // Of the first few that are asked for, which are asked for again, it is known.
    Held held_at(const PlacedMesh& placed, const PalmPlace& palm, const Found& found,
                 const FingerBends& bends, const PalmEffort& effort) {
        for (std::size_t i = 0; i < known_count_; ++i) {
            const GripSurface& known = known_[i].surface;
            if (known.triangle == found.triangle && known.bends == bends &&
                known_[i].is_kept == (effort.last != nullptr)) {
                return known_[i];
            }
        }
        Held held = hold_at(placed, palm, found, bends, effort);
        if (known_count_ < known_.size()) {
            known_[known_count_++] = held;
        }
        return held;
    }

    Held hold_at(const PlacedMesh& placed, const PalmPlace& palm, const Found& found,
                 const FingerBends& bends, const PalmEffort& effort) const {
        Held held;
        held.is_kept = effort.last != nullptr;
        held.surface = surface_at(placed, palm, found);
        held.surface.bends = bends;
        const PalmFit fit = fit_palm(hand_, held.surface, 0.0, tuning_.palm, effort);
        held.surface.held_bs = fit.wrist_bs;
        held.surface.is_held = true;
        held.surface.is_settled = fit.is_settled;
        held.sunk_m = fit.sunk_m;
        held.fingers_sunk_m = fit.fingers_sunk_m;
        const GripSync sync = grip_sync(hand_.wrist_bs, fit.wrist_bs, hand_.rig->palm_center_hs);
        held.sync_m = sync.palm_m + tuning_.palm.tilt_cost_m_per_rad * sync.turn_rad;
        return held;
    }

    // From the nearest triangles to places around the palm, as long as there is anything to see.
    void look_around(const GripMesh& mesh, const PalmPlace& palm, SurfaceSearch& searcher) const {
        const double apart_m = 0.5 * tuning_.palm.reach_m;
        for (int axis = 0; axis < 3; ++axis) {
            for (const double side : {-1.0, 1.0}) {
                const Vec3 place = palm.center + side * apart_m * Vec3::Unit(axis);
                const auto near = mesh.search_bvh.closest_point(place, apart_m);
                searcher.add_seed(near ? near->triangle : GripSurface::k_none);
            }
        }
        searcher.run(SurfaceSearch::k_most_pops);
    }

    GripSurface surface_at(const PlacedMesh& placed, const PalmPlace& palm,
                           const Found& found) const {
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
        const Vec3 own_bs = placed.pose.rotation * Vec3(side * wound);
        constexpr double k_alike = 0.7;
        if (kept_normal_bs_ && kept_normal_bs_->dot(own_bs) > k_alike) {
            surface.normal_bs = *kept_normal_bs_;
        } else {
            surface.normal_bs =
                placed.pose.rotation * Vec3(side * mean_normal(mesh, point, wound, side * palm.up,
                                                               tuning_.palm.normal_radius_m));
        }
        return surface;
    }

    static constexpr double k_roomy_m = 1e-3;
    static constexpr double k_far_m = 0.05;  // of sync: a palm that comes out farther went through
    static constexpr double k_near_enough_m = 0.02;  // with room: nothing farther is looked for
    static constexpr double k_inside_cost_m = 0.05;
    static constexpr double k_sunk_cost = 8.0;    // of a metre that a palm stays sunk
    static constexpr double k_finger_cost = 6.0;  // and a finger

    const HandSurroundings& hand_;
    double dt_s_;
    const Tuning& tuning_;
    GripSearch search_;
    GripSearchScratch& scratch_;
    std::optional<Vec3> kept_normal_bs_;  // of the surface as it was a moment ago
    std::array<Held, 4> known_;
    std::size_t known_count_ = 0;
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
        const bool is_to_push =
            !surface.is_settled && surface.pushed_at_rest < k_most_pushed_at_rest;
        const bool rests = surface.surroundings == hand.signature &&
                           surface.triangle != GripSurface::k_none &&
                           hand_way_m(surface.wrist_bs, hand.wrist_bs) < tuning.finger.stroll_m;
        if (rests && !is_to_look && !is_to_push) {
            surface.was_judged = false;
            continue;
        }
        // While it looks, each is tried with a few pushes: those of the best are still to come.
        const std::uint32_t more = surface.tried_count > 0 ? 0 : 1;
        const std::uint32_t pushed = rests ? surface.pushed_at_rest + more : 0;
        PalmHolder(hand, io.dt_s, tuning, search, io.scratch).run(surface);
        surface.pushed_at_rest = pushed;
        if (surface.triangle == GripSurface::k_none) {
            stats.count(Fallback::palm_no_surface);
        }
    }
}

}  // namespace handhold
