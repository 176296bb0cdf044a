#include "game/view/explain_fit.hpp"

#include <algorithm>

#include "systems/hand/fit_hands.hpp"

namespace handhold {
namespace {

struct TermView {
    Color color;
    const char* meaning;
};

// Colours and texts of the terms, in the order of FitTerm. Penalties are red to pink; terms between
// neighbours are green.
constexpr std::array<TermView, k_fit_term_count> k_term_views = {{
    {{0.25F, 0.55F, 1.0F}, "is away from where it is tracked"},
    {{0.1F, 0.85F, 1.0F}, "is off the surface"},
    {{0.5F, 0.95F, 0.95F}, "has its tip off the surface"},
    {{0.1F, 0.65F, 0.6F}, "has its pad turned from the surface"},
    {{1.0F, 0.8F, 0.1F}, "has left the opposition of its rest pose"},
    {{1.0F, 0.95F, 0.55F}, "is spread or turned to its side"},
    {{0.8F, 0.65F, 0.4F}, "has left its rest pose"},
    {{0.3F, 0.9F, 0.2F}, "bends unlike its neighbours"},
    {{0.05F, 0.6F, 0.3F}, "points unlike its neighbours"},
    {{0.7F, 0.45F, 1.0F}, "bends unevenly at knuckle and middle"},
    {{0.45F, 0.2F, 0.85F}, "has its last hinge bent unlike the one before"},
    {{1.0F, 0.1F, 0.1F}, "presses into the surface"},
    {{1.0F, 0.35F, 0.5F}, "presses thumb and finger together"},
    {{0.8F, 0.1F, 0.6F}, "is beyond its joint limits"},
    {{1.0F, 0.45F, 0.1F}, "is folded into itself"},
    {{0.75F, 0.0F, 0.25F}, "is a claw: knuckle stretched, middle bent"},
    {{0.7F, 0.8F, 0.1F}, "is too far from its neighbour, or crosses it"},
    {{1.0F, 0.3F, 0.9F}, "is outside its height or tilt limits"},
}};

const TermView& view_of(FitTerm term) { return k_term_views.at(static_cast<std::size_t>(term)); }

}  // namespace

std::optional<FitTerms> fit_terms_of(const World& world, const FrameCaches& caches,
                                     const Tuning& tuning, Entity hand) {
    const auto& all = caches.hands.surroundings;
    const auto around = std::ranges::find(all, hand, &HandSurroundings::hand);
    if (around == all.end() || !around->is_gripping || around->rig == nullptr ||
        !world.grip_surface.contains(hand)) {
        return std::nullopt;
    }
    return shown_fit_terms(*around, world.grip_surface.at(hand), world.palm_pose.at(hand),
                           world.finger_pose.at(hand), tuning);
}

std::optional<FitTerm> shaping_term(const FitTerms::Costs& cost_m2) {
    const FitTerm term = largest_of(cost_m2);
    return cost_m2[static_cast<std::size_t>(term)] < k_small_cost_m2 ? std::nullopt
                                                                     : std::optional(term);
}

Color color_of(FitTerm term) { return view_of(term).color; }

const char* meaning_of(FitTerm term) { return view_of(term).meaning; }

}  // namespace handhold
