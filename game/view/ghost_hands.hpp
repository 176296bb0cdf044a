#pragma once

#include <algorithm>

#include "components/render.hpp"
#include "game/render/render_frame.hpp"

// Where a player's hand is when it is not where it is shown (talk row 18): a ghost of it. A matter
// of pictures only: nothing here is read by the simulation.
namespace handhold {

struct GhostSettings {
    // Tracked hand and shown hand apart: the ghost begins to be seen at the first and is all there
    // at the second. Fitted palms are up to 4 cm away from where hands are tracked.
    double apart_from_m = 0.05;
    double apart_full_m = 0.14;
    // The same of the angle between them.
    double turned_from_rad = 0.9;
    double turned_full_rad = 1.4;
    float seen = 0.66F;    // [0, 1]; how much of the picture it covers there,
    float hidden = 0.55F;  // and where a wall hides it
    // An empty hand that is in a wall, or behind one, shines through it in its own player's eyes:
    // from so deep on along the view, wholly from the second. Rails are not that thick.
    double fade_start_m = 0.045;
    double fade_full_m = 0.09;
    float sunk = 0.62F;
    Color tracked = {0.10F, 0.52F, 0.95F};
    // An empty hand near an authored grip: how it would sit there, where the grip's zone begins to
    // matter to where it closes; brighter within the zone.
    float snap_near = 0.22F;  // at most
    float snap_within = 0.42F;
    Color snap = {0.35F, 1.0F, 0.45F};
    Color lost = {1.0F, 0.55F, 0.15F};  // the tracking has lost the hand: where it was last
};

// [0, 1]; 0 where both agree.
inline double ghost_share(const RenderPose::Hand& hand, const GhostSettings& settings) {
    const auto ramp = [](double x, double from, double full) {
        return std::clamp((x - from) / (full - from), 0.0, 1.0);
    };
    const double apart_m = (hand.tracked_ws.position - hand.shown_ws.position).norm();
    const double turned_rad =
        rotation_to_vector(
            (hand.tracked_ws.rotation.conjugate() * hand.shown_ws.rotation).normalized())
            .norm();
    return std::max(ramp(apart_m, settings.apart_from_m, settings.apart_full_m),
                    ramp(turned_rad, settings.turned_from_rad, settings.turned_full_rad));
}

}  // namespace handhold
