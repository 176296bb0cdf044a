#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "components/tracking.hpp"
#include "engine/core/result.hpp"
#include "game/view/gizmos.hpp"

// Pictures and film clips of a scene's session, requested in a file. All pictures in the
// documentation are made this way (docs/reference/shots.md).
namespace handhold {

// Where a shot's camera is.
enum class ShotView : std::uint8_t {
    eyes,    // camera at the first player's eyes
    gaze,    // camera at the first player's eyes, turned to the palm of a hand
    behind,  // camera behind and above the first player, as far as walls allow
    before,  // camera in front of the first player, looking back
    hand,    // camera at `from_m` from the palm of a hand of the first player, looking at it
    chest,   // camera at `from_m` from the first player's chest
    pelvis,  // camera at `from_m` from the first player's pelvis
    player,  // camera at `from_m` from another player's head
    body,    // camera at `from_m` from a body of the scene
    place    // camera at `from_m` in the world, looking at `target_m`
};

struct Shot {
    std::size_t number = 0;  // index in the list, from 0
    std::string name;        // file name, without folder and extension
    std::string scene;       // scene whose session is drawn
    std::string caption;     // one line over a clip; may be empty
    double at_s = 0.0;       // session time
    double until_s = 0.0;    // later than at_s: a clip that ends here; else: a picture
    ShotView view = ShotView::eyes;
    HandSide side = HandSide::right;  // hand of ShotView::hand and gaze
    // ShotView::body: the body's name; ShotView::player: the player's name
    std::string body;
    // The camera's position relative to the palm, chest or other point that `view` names: right, up
    // and back in the first player's play space. ShotView::place: the position in the world.
    Vec3 from_m = Vec3(0.3, 0.2, 0.3);
    // Offset of the point that the camera looks at from the point that `view` names, in the same
    // axes. ShotView::place: the point itself, in the world.
    Vec3 target_m = Vec3::Zero();
    // For views with `from_m`: a camera that surfaces separate from its target moves around the
    // target to the nearest side that is free, or as near to the target as they allow.
    bool free = false;
    double fov_deg = 60.0;  // vertical
    bool marks = true;      // lines of palms, grips and heads
    double through = 0.22;  // [0, 1]; opacity of lines behind geometry
    GizmoSet gizmos = k_no_gizmos;
};

// Errors name the file, the JSON pointer, and what was expected.
Result<std::vector<Shot>> parse_shots(std::string_view text, const std::string& file);
// Loads a file of shots. Every scene must be built in or an existing file.
Result<std::vector<Shot>> load_shots(const std::filesystem::path& file);

}  // namespace handhold
