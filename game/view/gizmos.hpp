#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "game/mesh/render_frame.hpp"
#include "game/scene/scene.hpp"
#include "systems/frame/frame.hpp"

// Debug lines over the picture: what the stages of a frame found and did.
namespace handhold {

// Kinds of debug lines, each with the stage whose work it shows.
enum class Gizmo : std::uint8_t {
    tracked_hands,  // read_tracking
    palm_rays,      // update_grabs
    grips,          // anchor_grabs
    velocities,     // predict_bodies
    contacts,       // find_contacts
    joints,         // build_constraints
    islands,        // build_constraints
    residuals,      // solve_phases
    search,         // search_grip
    palm_limits,    // constrain_palms
    cuts,           // sweep_fingers
    fingers,        // sweep_fingers, fit_hands
    fit,            // fit_hands
    snap_zones,     // update_grabs
    arms,           // pose_arms
    spine,          // propagate_spine
    count
};
using GizmoSet = std::array<bool, static_cast<std::size_t>(Gizmo::count)>;
inline constexpr GizmoSet k_no_gizmos = {};

struct GizmoInfo {
    const char* name;
    const char* stage;
    const char* what;  // description of the lines
};
GizmoInfo info_of(Gizmo gizmo);

// Appends the lines of the gizmos that are on, for the last frame. Contacts, joints, islands,
// residuals and the hands' surroundings exist only in the caches, so gizmos that show these are
// empty right after a restore.
void add_gizmos(const World& world, const FrameCaches& caches, const Tuning& tuning,
                const GizmoSet& on, std::vector<Line>& out);

}  // namespace handhold
