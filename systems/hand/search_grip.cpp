#include "systems/hand/search_grip.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "systems/hand/shared/finger_chain.hpp"
#include "systems/hand/shared/palm_fitter.hpp"
#include "systems/hand/shared/surface_candidates.hpp"
#include "systems/hand/shared/surface_search.hpp"

namespace handhold {
namespace {

constexpr std::uint32_t k_patience = 24;    // pops without a better triangle end the search
constexpr std::uint32_t k_patience_on = 6;  // where it was found a moment ago
constexpr double k_search_again_m = 0.006;  // what was found is followed so far
constexpr std::uint32_t k_most_pushed_at_rest = 24;

// Under a palm in an authored grip: fingers that close begin there.
GripSurface surface_in_grip(const HandSurroundings& hand, double dt_s, const PalmTuning& tuning) {
    const PalmHolder holder(hand, hand.authored->wrist_bs, dt_s, tuning);
    const auto near =
        holder.placed().mesh->search_bvh.closest_point(holder.palm().center, tuning.reach_m);
    GripSurface surface;
    if (near) {
        surface = holder.surface_at({near->triangle, near->point, 0.0});
    }
    surface.wrist_bs = hand.authored->wrist_bs;
    surface.surroundings = 0;  // out of the grip the surface is searched for
    return surface;
}

std::optional<TriangleHit> cast_palm_ray(const PalmHolder& holder, const HandTuning& tuning) {
    const PalmPlace& palm = holder.palm();
    return holder.placed().mesh->search_bvh.cast_ray(
        palm.center + tuning.ray_back_m * palm.up,
        palm.center - (tuning.ray_length_m - tuning.ray_back_m) * palm.up);
}

// Of one hand, over where it was a frame ago: `last`, whose triangle is of this mesh or none.
class GripSearcher {
  public:
    GripSearcher(const HandSurroundings& hand, double dt_s, const Tuning& tuning,
                 const GripSurface& last, GripSearchScratch& scratch)
        : dt_s_(dt_s),
          tuning_(tuning),
          last_(last),
          scratch_(scratch),
          way_m_(hand_way_m(last.wrist_bs, hand.wrist_bs)),
          holder_(hand, hand.wrist_bs, dt_s, tuning.palm),
          searcher_(holder_.placed().mesh->search, holder_.palm(), tuning.palm, scratch) {
        searcher_.add_seed(last.triangle);
    }

    GripSurface run() {
        const bool is_known = last_.triangle != GripSurface::k_none;
        const double search_in_m = last_.search_in_m - way_m_;
        // What fails to follow is not held anew: what is taken of it keeps its normal for as long.
        double search_again_m = k_search_again_m;
        if (is_known && search_in_m > 0.0 && !holder_.is_at_once()) {
            searcher_.run(k_patience_on);
            search_again_m = search_in_m;
            holder_.keep_normal(last_.normal_bs);
            if (auto surface = go_on()) {
                surface->search_in_m = search_in_m;
                return *surface;
            }
            holder_.keep_normal(std::nullopt);
        }
        search_all_around();
        std::optional<GripSurface> surface = is_known ? go_on() : std::nullopt;
        if (!surface) {
            surface = SurfaceTries(holder_, searcher_, tuning_.palm, scratch_.patch).run(last_);
        }
        surface->search_in_m = search_again_m;
        return *surface;
    }

  private:
    using Found = SurfaceSearch::Found;

    void search_all_around() {
        const auto hit = cast_palm_ray(holder_, tuning_.hand);
        const auto near = holder_.placed().mesh->search_bvh.closest_point(holder_.palm().center,
                                                                          tuning_.palm.reach_m);
        searcher_.add_seed(hit ? hit->triangle : GripSurface::k_none);
        searcher_.add_seed(near ? near->triangle : GripSurface::k_none);
        searcher_.run(k_patience);
    }

    // On the surface that it had. None where surfaces are to be judged.
    std::optional<GripSurface> go_on() {
        std::optional<GripSurface> surface;
        if (last_.was_judged && !holder_.is_at_once()) {
            surface = rest();
        }
        if (!surface && last_.tried_count == 0) {
            surface = stay();
        }
        if (!surface && last_.tried_count == 0) {
            surface = keep_room();
        }
        return surface;
    }

    // Time counts as a way too: a hand at rest looks again.
    double still_to_go_m(double left_m) const {
        constexpr double k_time_mps = 0.045;
        constexpr double k_at_once_m = 5e-4;
        const double least_m = holder_.is_at_once() ? k_at_once_m : k_time_mps * dt_s_;
        return left_m - std::max(way_m_, least_m);
    }

    // As it is held. None where it is gone, or had room and has it no more.
    std::optional<GripSurface> held_still() {
        const auto near = holder_.near_last(searcher_, last_);
        if (!near) {
            return std::nullopt;
        }
        const HeldPalm held = holder_.keep_at(*near, last_);
        if (last_.has_room_m > 0.0 && held.sunk_m > k_palm_has_room_m) {
            return std::nullopt;
        }
        GripSurface surface = held.surface;
        surface.has_room_m = std::max(still_to_go_m(last_.has_room_m), 0.0);
        return surface;
    }

    // No surface is judged in two frames in a row: digits have their turn. None where it is gone,
    // or its room is.
    std::optional<GripSurface> rest() {
        constexpr double k_next_m = 1e-9;
        std::optional<GripSurface> surface = held_still();
        if (surface) {
            surface->cost_m = last_.cost_m;
            surface->tried = last_.tried;
            surface->tried_count = last_.tried_count;
            surface->listed_count = last_.listed_count;
            surface->goes_through = last_.goes_through;
            surface->to_clear = last_.to_clear;
            surface->look_in_m =
                last_.look_in_m > 0.0 ? std::max(still_to_go_m(last_.look_in_m), k_next_m) : 0.0;
        }
        return surface;
    }

    // Looking for room is dear, and what has none mostly has none a little farther on: a hand that
    // looked stays with what it found for a while. None where it is to look now.
    std::optional<GripSurface> stay() {
        const double left_m = still_to_go_m(last_.look_in_m);
        std::optional<GripSurface> surface;
        if (left_m > 0.0) {
            surface = held_still();
        }
        if (surface) {
            surface->look_in_m = left_m;
        }
        return surface;
    }

    // What had room for fingers mostly has it a little farther on. None where it is to be asked.
    std::optional<GripSurface> keep_room() {
        const double left_m = still_to_go_m(last_.has_room_m);
        const auto cheapest = searcher_.cheapest_beside({});
        if (left_m <= 0.0 || !cheapest || !holder_.is_near_last(*cheapest, last_)) {
            return std::nullopt;
        }
        const HeldPalm held = holder_.keep_at(*cheapest, last_);
        if (held.sunk_m > k_palm_has_room_m) {
            return std::nullopt;
        }
        GripSurface surface = held.surface;
        surface.has_room_m = left_m;
        return surface;
    }

    double dt_s_;
    const Tuning& tuning_;
    const GripSurface& last_;
    GripSearchScratch& scratch_;
    double way_m_;  // of the hand since then
    PalmHolder holder_;
    SurfaceSearch searcher_;
};

// Where the hand was a frame ago; nothing where that was on another body, or on a mesh that was
// larger.
GripSurface known_surface(const HandSurroundings& hand, const GripSurface& surface) {
    const std::size_t triangles = hand.meshes.front().mesh->search.triangles.size();
    return surface.body == hand.body && surface.triangle < triangles ? surface : GripSurface{};
}

GripSurface surface_of_ray(const HandSurroundings& hand, double dt_s, const Tuning& tuning) {
    const PalmHolder holder(hand, hand.wrist_bs, dt_s, tuning.palm);
    const auto hit = cast_palm_ray(holder, tuning.hand);
    return hit ? holder.surface_at({hit->triangle, hit->point, 0.0}) : GripSurface{};
}

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
                surface = surface_in_grip(hand, io.dt_s, tuning.palm);
            }
            continue;
        }
        const bool is_to_look =
            surface.tried_count > 0 ||
            (surface.look_in_m > 0.0 && surface.look_in_m < k_way_between_looks_m);
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
        const GripSurface last = known_surface(hand, surface);
        surface = search == GripSearch::ray_only
                      ? surface_of_ray(hand, io.dt_s, tuning)
                      : GripSearcher(hand, io.dt_s, tuning, last, io.scratch).run();
        surface.pushed_at_rest = pushed;
        if (surface.triangle == GripSurface::k_none) {
            stats.count(Fallback::palm_no_surface);
        }
    }
}

}  // namespace handhold
