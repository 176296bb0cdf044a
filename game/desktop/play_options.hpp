#pragma once

#include <string>

#include "game/desktop/play_loop.hpp"
#include "game/view/player_models.hpp"

namespace handhold {

// Options of `handhold play`.
struct PlayOptions {
    std::string scene = "station";
    std::string spawn;  // name of the spawn; empty: the scene's first
    // A match to join, as by open_link; empty: play alone. `scene` empty: the
    // one that its server names.
    std::string join;
    std::string token;     // file with a token for that match; empty: none
    bool watches = false;  // true: `join` takes no slot
    std::string record;    // where the session is saved; empty: nowhere
    std::string picture;   // a PNG of the last picture; empty: none
    PlayerModelFiles models;
    std::string report;  // statistics and costs (.json) at the end; empty: none
    std::string status;  // a line of JSON every tenth of a second (.jsonl); empty: none
    bool xr = false;     // true: in a headset, with a mirror of the left eye if there is a display
    bool xr_headless = false;  // true: in a headset without pictures, for tests
    double eye_scale = 1.0;    // (0, 2]; factor on the XR runtime's recommended picture size
    bool mirror = true;
    bool jets = false;           // the movement keys also use jets
    bool distance_grab = false;  // a hand that closes on nothing pulls the body that it points at
    double seconds = 0.0;        // length of the session; 0: until the window is closed
    int width_px = 1280;
    int height_px = 720;
    PlaySettings settings;
    PlayPanels panels;  // panels that are open at the start
    std::string page;   // the inspector's open page, such as "Tuning"; empty: its first
    GizmoSet gizmos = k_no_gizmos;
    PlayerViewpoint viewpoint = PlayerViewpoint::eyes;
};

}  // namespace handhold
