#include "systems/hand/search_grip.hpp"

#include <optional>

#include "systems/hand/shared/finger_chain.hpp"
#include "systems/hand/shared/palm_fitter.hpp"
#include "systems/hand/shared/surface_candidates.hpp"
#include "systems/hand/shared/surface_search.hpp"

namespace handhold {
namespace {

// Returns the surface nearest to a palm in an authored grip. It seeds the searches of the closing
// fingers.
GripSurface authored_grip_surface(const HandSurroundings& hand, const PalmTuning& tuning) {
    const PalmFitter fitter(hand, hand.authored_wrist_bs(), tuning);
    const auto near =
        fitter.placed().mesh->search_bvh.closest_point(fitter.palm().center, tuning.reach_m);
    GripSurface surface;
    if (near) {
        surface = fitter.surface_at({near->triangle, near->point, 0.0});
    }
    surface.wrist_bs = hand.authored_wrist_bs();
    // Invalid key: forces a search once the hand leaves the grip.
    surface.surroundings_signature = 0;
    return surface;
}

std::optional<TriangleHit> cast_palm_ray(const PalmFitter& fitter, const HandTuning& tuning) {
    const PalmFrame& palm = fitter.palm();
    return fitter.placed().mesh->search_bvh.cast_ray(
        palm.center + tuning.ray_back_m * palm.up,
        palm.center - (tuning.ray_length_m - tuning.ray_back_m) * palm.up);
}

// `last`: the result of the last search; its triangle is k_none or belongs to the gripped body's
// mesh.
GripSurface surface_of_smallest_sync(const HandSurroundings& hand, const Tuning& tuning,
                                     const GripSurface& last, GripSearchScratch& scratch) {
    const PalmFitter fitter(hand, hand.wrist_bs, tuning.palm);
    SurfaceSearch search(fitter.placed().mesh->search, fitter.palm(), tuning.palm, scratch);
    const auto hit = cast_palm_ray(fitter, tuning.hand);
    const auto near =
        fitter.placed().mesh->search_bvh.closest_point(fitter.palm().center, tuning.palm.reach_m);
    search.add_seed(last.triangle);
    search.add_seed(hit ? hit->triangle : GripSurface::k_none);
    search.add_seed(near ? near->triangle : GripSurface::k_none);
    return SurfaceCandidates(fitter, search, tuning.palm).best(last);
}

// True if the last search found a surface of this body's mesh.
bool has_surface(const HandSurroundings& hand, const GripSurface& surface) {
    return surface.body == hand.body &&
           surface.triangle < hand.meshes.front().mesh->search.triangles.size();
}

}  // namespace

void search_grip(const SearchGripIo& io, const Tuning& tuning, StageStats& stats) {
    for (const HandSurroundings& hand : io.hands) {
        GripSurface& surface = io.surface.at(hand.hand);
        if (is_null(hand.body) || hand.meshes.empty()) {
            surface = {};
            continue;
        }
        const bool has_last = has_surface(hand, surface);
        const bool is_searched =
            has_last || (surface.body == hand.body && surface.triangle == GripSurface::k_none);
        if (hand.authored != nullptr) {
            const bool is_known = is_searched && surface.surroundings_signature == 0 &&
                                  hand_travel_m(surface.wrist_bs, hand.authored_wrist_bs()) == 0.0;
            if (!is_known) {
                surface = authored_grip_surface(hand, tuning.palm);
            }
            continue;
        }
        if (is_searched && surface.surroundings_signature == hand.search_signature &&
            hand_travel_m(surface.wrist_bs, hand.wrist_bs) < k_search_again_m) {
            continue;
        }
        const GripSurface last = has_last ? surface : GripSurface{};
        surface = surface_of_smallest_sync(hand, tuning, last, io.scratch);
        if (surface.triangle == GripSurface::k_none) {
            surface.body = hand.body;
            surface.wrist_bs = hand.wrist_bs;
            surface.surroundings_signature = hand.search_signature;
            stats.count(Fallback::palm_no_surface);
        }
    }
}

}  // namespace handhold
