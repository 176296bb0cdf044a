#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "components/hand.hpp"
#include "components/tuning.hpp"
#include "systems/hand/shared/palm_fitter.hpp"
#include "systems/hand/shared/surface_search.hpp"

namespace handhold {

// A hand goes so far before it looks again for room, or for another surface.
inline constexpr double k_way_between_looks_m = 0.016;

// Tries surfaces for one palm, a few in each frame: search_grip's choice among what it found.
//
// The surface is the one where what it takes to hold the palm there is least, pushes out of what it
// is sunk in included; where palm or fingers have no room, so is what stays sunk. They are tried in
// the order of their costs in closed form, which are rarely more, until those are. Refers to all
// that it is made of; the patch is only worked in.
class SurfaceTries {
  public:
    SurfaceTries(PalmHolder& holder, SurfaceSearch& searcher, const PalmTuning& tuning,
                 ChainPatch& patch);

    // Once. Goes on from where `last` came to, or begins with where that is; the state of the
    // search is in what it returns. No triangle: nothing was found. Precondition: a `last` that has
    // a triangle has one of this mesh.
    GripSurface run(const GripSurface& last);

  private:
    using Found = SurfaceSearch::Found;
    struct Judged {
        GripSurface surface;
        bool has_room = false;
    };

    std::size_t most_turns() const;
    void recall(const Found& near, const GripSurface& last);
    void judge_first(const Found& near, const GripSurface& last);
    bool try_others(const GripSurface& last);
    bool take_turn();
    std::optional<Found> pass_to_next();
    bool may_try(const Found& way) const;
    void list_others();
    void look_around();
    void judge(const Found& way, HeldPalm held);
    void judge_cleared(const GripSurface& last);
    void look_for_crossed(double there_m, HeldPalm& held) const;
    double place_cost_m(const Found& found, const HeldPalm& held) const;
    static Judged judged(const HeldPalm& held, double place_cost_m, double fingers_m);
    void take_better(const Judged& judged);
    PalmEffort effort() const;
    void note(GripSurface& surface) const;

    bool is_to_be_cleared() const { return to_clear_ != FingerBends{}; }
    bool is_full() const { return count_ == tried_.size(); }
    bool is_listed() const { return listed_ > 0; }
    std::span<const Found> so_far() const { return {tried_.data(), count_}; }
    bool is_cheaper(double cost_m) const { return !has_best_ || cost_m < best_.surface.cost_m; }

    PalmHolder& holder_;
    SurfaceSearch& searcher_;
    const PalmTuning& tuning_;
    ChainPatch& patch_;

    // Those that were tried or passed over, then those that are to be tried, the cheapest first,
    // once they are listed.
    std::array<Found, GripSurface::k_most_tries> tried_;
    std::size_t count_ = 0;
    std::size_t listed_ = 0;  // with those to be tried; 0: not listed
    Judged best_;
    bool has_best_ = false;
    bool was_judged_ = false;     // in this frame
    FingerBends to_clear_ = {};   // at the last of those tried, which is to be judged so as well
    bool goes_through_ = false;   // GripSurface::goes_through
    std::size_t turns_left_ = 0;  // in this frame
};

}  // namespace handhold
