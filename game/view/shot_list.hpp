#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "components/tracking.hpp"
#include "engine/io/result.hpp"
#include "game/view/gizmos.hpp"

// Pictures and pieces of film of a scene's session, asked for in a file: what documents show is
// made by the game and never by hand (docs/reference/shots.md).
namespace handhold {

// Where a shot's camera is.
enum class ShotView : std::uint8_t {
    eyes,    // the first player's
    behind,  // behind and above him, as walls allow
    before,  // before him, looking back
    hand,    // `from_m` from the palm of one of his hands, looking at it
    chest,   // the same of his chest,
    pelvis,  // and of his pelvis
    player,  // of another player's head
    body,    // of a body of the scene
    place    // at `from_m` in the world, looking at `target_m`
};

struct Shot {
    std::size_t number = 0;  // in the list, from 0
    std::string name;        // of the file, without folder and extension
    std::string scene;       // whose session it is of
    std::string caption;     // over a piece of film, one line; may be empty
    double at_s = 0.0;       // of the session
    double until_s = 0.0;    // a piece of film where later than at_s, else a picture
    ShotView view = ShotView::eyes;
    HandSide side = HandSide::right;  // ShotView::hand
    std::string body;                 // ShotView::body; ShotView::player: a player's name
    // To the right, up and back, as the first player's play space stands; of a place in the world's
    // axes.
    Vec3 from_m = Vec3(0.3, 0.2, 0.3);
    Vec3 target_m = Vec3::Zero();  // what is looked at, beside what the view names; the same axes
    double fov_deg = 60.0;         // vertical
    bool marks = true;             // the lines of palms, grips and heads
    double through = 0.22;         // how much of lines is seen through what hides them
    GizmoSet gizmos = k_no_gizmos;
};

// Errors name the file, the JSON pointer, and what was expected.
Result<std::vector<Shot>> parse_shots(std::string_view text, const std::string& file);
// The same; every scene is one that is built in, or a file that is there.
Result<std::vector<Shot>> load_shots(const std::filesystem::path& file);

}  // namespace handhold
