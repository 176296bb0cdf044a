#pragma once

#include <string>
#include <vector>

#include "game/desktop/play_loop.hpp"
#include "game/render/player_models.hpp"

namespace handhold {

// `handhold play`, as given on the command line.
struct PlayOptions {
    std::string scene = "station";
    std::string spawn;    // empty: the scene's first
    std::string record;   // where the session is saved; empty: nowhere
    std::string picture;  // a PNG of the last picture; empty: none
    PlayerModelFiles models;
    std::string report;  // figures and costs (.json) when it ends; empty: none
    std::string status;  // a line of JSON every tenth of a second (.jsonl); empty: none
    bool xr = false;     // in a headset, with a mirror of the left eye where there is a display
    bool xr_headless = false;  // the same without pictures, for tests
    double eye_scale = 1.0;    // (0, 2]; of the size that the headset recommends for its pictures
    bool mirror = true;
    bool jets = false;           // the keys push as well as pull
    bool distance_grab = false;  // a hand that closes on nothing pulls what it points at
    double seconds = 0.0;        // 0: until the window is closed
    int width_px = 1280;
    int height_px = 720;
    PlaySettings settings;
    PlayPanels panels;  // that are open when it begins
    std::string page;   // of the inspector: "Tuning"; empty: its first
    GizmoSet gizmos = k_no_gizmos;
    PlayerViewpoint viewpoint = PlayerViewpoint::eyes;
};

// Opens a window in which scenes are played with keyboard, mouse and gamepad, in real time: where a
// picture takes longer than the session allows it to fall behind, time goes slower. What is kept
// is of the scene that was played last. Returns the exit status: 0; 2 after one line on standard
// error where a file is refused or cannot be written, 3 where there is nothing to draw or show
// with. The last line is "state_hash 0x<16 hex digits>".
int play_command(PlayOptions options);

}  // namespace handhold
