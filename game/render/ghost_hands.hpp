#pragma once

#include <algorithm>

#include "components/render.hpp"
#include "game/mesh/render_frame.hpp"

// A ghost shows where a player's hand is tracked while the hand is shown elsewhere (talk row 18).
// Rendering only: the simulation does not read it.
namespace handhold {

struct GhostSettings {
    // Distance between tracked and shown wrist at which the ghost starts to show, and at which it
    // is fully shown. A fitted palm is up to 4 cm from the tracked hand.
    double apart_from_m = 0.05;
    double apart_full_m = 0.14;
    // The same two limits for the angle between tracked and shown wrist.
    double turned_from_rad = 0.9;
    double turned_full_rad = 1.4;
    float seen = 0.66F;    // [0, 1]; opacity where visible
    float hidden = 0.55F;  // opacity where geometry hides it
    // In the player's own view, an empty hand inside or behind a wall shines through the wall.
    // This starts at a depth of fade_start_m and is complete at fade_full_m. Rails are thinner,
    // so hands do not shine through them.
    double fade_start_m = 0.045;
    double fade_full_m = 0.09;
    float penetrating = 0.62F;  // opacity of a hand that shines through a wall
    Color tracked = {0.10F, 0.52F, 0.95F};
    // An empty hand near an authored grip shows the grip's hand pose. The hint starts near the
    // grip's zone and is brighter inside it.
    float snap_near = 0.22F;  // maximum opacity outside the zone
    float snap_within = 0.42F;
    Color snap = {0.35F, 1.0F, 0.45F};
    Color lost = {1.0F, 0.55F, 0.15F};  // colour at the last known pose while tracking is lost
};

// Opacity factor of the ghost, [0, 1]; 0 if tracked and shown pose are nearly equal.
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
