#include "systems/hand/shared/surface_candidates.hpp"

#include <algorithm>

#include "systems/hand/shared/finger_clearance.hpp"

namespace handhold {
namespace {

constexpr int k_most_pushes_tried = 2;     // of a palm that is taken only if it is better
constexpr double k_far_m = 0.05;           // of sync: a palm that comes out farther went through
constexpr double k_near_enough_m = 0.02;   // with room: nothing farther is looked for
constexpr double k_inside_cost_m = 0.05;   // of a back that is seen from inside
constexpr double k_entering_cost_m = 0.3;  // as of a palm that is sunk 25 mm
constexpr double k_sunk_cost = 12.0;       // of a metre that a palm stays sunk
constexpr double k_finger_cost = 9.0;      // and a finger

}  // namespace

SurfaceTries::SurfaceTries(PalmHolder& holder, SurfaceSearch& searcher, const PalmTuning& tuning,
                           ChainPatch& patch)
    : holder_(holder), searcher_(searcher), tuning_(tuning), patch_(patch) {}

GripSurface SurfaceTries::run(const GripSurface& last) {
    turns_left_ = most_turns();
    const auto near = holder_.near_last(searcher_, last);
    if (near && last.tried_count > 0) {
        recall(*near, last);
    } else if (near) {
        judge_first(*near, last);
    }
    bool stays = false;
    if (best_.has_room) {
        const auto cheapest = searcher_.cheapest_beside({});
        stays = cheapest && holder_.is_near_last(*cheapest, best_.surface);
    }
    const bool is_over = stays || try_others(last);
    if (!has_best_) {
        return {};
    }
    GripSurface surface = best_.surface;
    surface.was_judged = was_judged_;
    const bool is_cheapest = stays || (count_ == 1 && best_.has_room && !near);
    surface.look_in_m = is_cheapest ? 0.0 : k_way_between_looks_m;
    surface.to_clear = {};
    surface.tried_count = surface.listed_count = 0;
    surface.goes_through = false;
    if (!is_over) {
        note(surface);
    }
    return surface;
}

std::size_t SurfaceTries::most_turns() const {
    return holder_.is_at_once() ? 2 * GripSurface::k_most_tries
                                : static_cast<std::size_t>(std::max(1, tuning_.tries_per_frame));
}

void SurfaceTries::note(GripSurface& surface) const {
    surface.to_clear = to_clear_;
    surface.goes_through = goes_through_;
    surface.tried_count = static_cast<std::uint32_t>(count_);
    surface.listed_count = static_cast<std::uint32_t>(listed_);
    for (std::size_t i = 0; i < std::max(count_, listed_); ++i) {
        surface.tried[i] = tried_[i].triangle;
    }
}

// What was tried in the frames before, where the hand is now; the best of it is near `last`.
void SurfaceTries::recall(const Found& near, const GripSurface& last) {
    best_.surface = holder_.carry_on(near, last);
    best_.surface.cost_m = last.cost_m;
    best_.surface.has_room_m = last.has_room_m;
    best_.has_room = last.has_room_m > 0.0;
    has_best_ = true;
    count_ = last.tried_count;
    listed_ = last.listed_count;
    for (std::size_t i = 0; i < std::max(count_, listed_); ++i) {
        tried_[i] = holder_.found_at(last.tried[i]);
    }
    to_clear_ = last.to_clear;
    goes_through_ = last.goes_through;
}

// Where the palm is, by the fit that it has, if that is the palm's alone.
void SurfaceTries::judge_first(const Found& near, const GripSurface& last) {
    tried_[count_++] = near;
    const bool is_alone = last.bends == FingerBends{} && last.is_held;
    judge(near, is_alone ? holder_.keep_at(near, last) : holder_.hold_at(near, {}, effort()));
    --turns_left_;
}

// False where the frame has none left.
bool SurfaceTries::take_turn() {
    if (turns_left_ == 0) {
        return false;
    }
    --turns_left_;
    return true;
}

// As many as there are turns. True where there is none to try any more.
bool SurfaceTries::try_others(const GripSurface& last) {
    for (;;) {
        if (is_to_be_cleared()) {
            if (!take_turn()) {
                return false;
            }
            judge_cleared(last);
        }
        const bool is_near = best_.has_room && best_.surface.cost_m < k_near_enough_m;
        if (count_ > 0 && !is_listed() && !is_near) {
            if (!take_turn()) {
                return false;
            }
            list_others();
        }
        const auto way = pass_to_next();
        if (!way) {
            return true;
        }
        if (!take_turn()) {
            return false;
        }
        tried_[count_++] = *way;
        judge(*way, holder_.hold_at(*way, {}, effort()));
    }
}

// The next one in the list, or else the cheapest that is left, that may be cheaper than the best;
// those passed over are done with.
std::optional<SurfaceTries::Found> SurfaceTries::pass_to_next() {
    if (is_listed()) {
        while (count_ < listed_ && !is_cheaper(tried_[count_].cost_m)) {
            ++count_;
        }
        return count_ < listed_ ? std::optional(tried_[count_]) : std::nullopt;
    }
    while (!is_full()) {
        auto way = searcher_.cheapest_beside(so_far());
        if (!way || !is_cheaper(way->cost_m)) {
            return std::nullopt;
        }
        if (count_ == 0 || may_try(*way)) {
            return way;
        }
        tried_[count_++] = *way;
    }
    return std::nullopt;
}

// No backs, but where the palm may have gone through what it came to first: fingers have room
// behind walls as well, but no palm goes there for it.
bool SurfaceTries::may_try(const Found& way) const {
    return !holder_.is_back(way) || (goes_through_ && !holder_.is_inside(way));
}

// All around, what may be cheaper than the best.
void SurfaceTries::list_others() {
    look_around();
    const std::size_t count = searcher_.add_cheapest_beside(tried_, count_, best_.surface.cost_m);
    was_judged_ = true;
    listed_ = count_;
    for (std::size_t i = count_; i < count; ++i) {
        const Found& way = tried_[i];
        if (may_try(way)) {
            tried_[listed_++] = way;
        }
    }
}

// From the nearest triangles to places around the palm, as long as there is anything to see.
void SurfaceTries::look_around() {
    const double apart_m = 0.5 * tuning_.reach_m;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
            const Vec3 place = holder_.palm().center + side * apart_m * Vec3::Unit(axis);
            const auto near = holder_.placed().mesh->search_bvh.closest_point(place, apart_m);
            searcher_.add_seed(near ? near->triangle : GripSurface::k_none);
        }
    }
    searcher_.run(SurfaceSearch::k_most_pops);
}

// Where the palm alone costs more than the best its fingers are not asked: they make it no cheaper.
// Where they have no room they are to be held clear with the palm, in their own turn.
void SurfaceTries::judge(const Found& way, HeldPalm held) {
    const double there_m = place_cost_m(way, held);
    look_for_crossed(there_m, held);
    if (count_ == 1) {
        goes_through_ =
            holder_.is_back(way) || held.sunk_m > k_palm_has_room_m || held.sync_m > k_far_m;
    }
    Judged result = judged(held, there_m, 0.0);
    if (is_cheaper(result.surface.cost_m)) {
        const FingerRoom room = find_finger_room(holder_.hand(), held.surface.held_bs, patch_);
        if (room.sunk_m > k_fingers_have_room_m) {
            result = judged(held, there_m, room.sunk_m);
            to_clear_ = room.bends;
        }
    }
    take_better(result);
}

// The last that was tried; the others of its fingers had room there, and mostly still have it.
void SurfaceTries::judge_cleared(const GripSurface& last) {
    const Found& found = tried_[count_ - 1];
    PalmEffort from_last = effort();
    if (last.triangle != GripSurface::k_none && holder_.is_near_last(found, last)) {
        from_last.last = &last;
    }
    HeldPalm held = holder_.hold_at(found, to_clear_, from_last);
    const double there_m = place_cost_m(found, held);
    look_for_crossed(there_m, held);
    Judged result = judged(held, there_m, held.fingers_sunk_m);
    if (is_cheaper(result.surface.cost_m)) {
        const double bent_m = bent_depth_m(holder_.hand(), to_clear_, held.surface.held_bs, patch_);
        result = judged(held, there_m, std::max(held.fingers_sunk_m, bent_m));
    }
    take_better(result);
    to_clear_ = {};
}

// The spheres that a palm is held by see no thin wall, no rod and no rim between them. Where it
// costs more than the best already it is not asked.
void SurfaceTries::look_for_crossed(double there_m, HeldPalm& held) const {
    if (is_cheaper(judged(held, there_m, held.fingers_sunk_m).surface.cost_m)) {
        held.sunk_m = std::max(held.sunk_m, holder_.crossed_m(held));
    }
}

// What stays sunk so deep that it is no better is given up soon.
PalmEffort SurfaceTries::effort() const {
    PalmEffort effort;
    if (!holder_.is_at_once()) {
        effort.most_pushes = k_most_pushes_tried;
    }
    if (has_best_) {
        effort.most_sunk_m = best_.surface.cost_m / k_sunk_cost;
    }
    return effort;
}

// What the place costs, wherever the fingers are; less where that is dearer than the best already.
double SurfaceTries::place_cost_m(const Found& found, const HeldPalm& held) const {
    double cost_m = 0.0;
    if (holder_.is_back(found)) {
        cost_m += tuning_.back_cost_m + (holder_.is_inside(found) ? k_inside_cost_m : 0.0);
    }
    if (is_cheaper(held.sync_m + cost_m) && holder_.is_entering(held)) {
        cost_m += k_entering_cost_m;
    }
    return cost_m;
}

SurfaceTries::Judged SurfaceTries::judged(const HeldPalm& held, double place_cost_m,
                                          double fingers_m) {
    Judged result = {held.surface,
                     held.sunk_m <= k_palm_has_room_m && fingers_m <= k_fingers_have_room_m};
    result.surface.cost_m = held.sync_m + place_cost_m;
    if (result.has_room) {
        result.surface.has_room_m = k_way_between_looks_m;
    } else {
        result.surface.cost_m += k_sunk_cost * held.sunk_m + k_finger_cost * fingers_m;
    }
    return result;
}

void SurfaceTries::take_better(const Judged& judged) {
    if (is_cheaper(judged.surface.cost_m)) {
        best_ = judged;
    }
    has_best_ = true;
    was_judged_ = true;
}

}  // namespace handhold
