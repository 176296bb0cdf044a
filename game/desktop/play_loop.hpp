#pragma once

#include <array>
#include <cstdio>
#include <string>

#include "game/desktop/desktop_session.hpp"
#include "game/desktop/play_settings.hpp"
#include "game/desktop/play_tally.hpp"
#include "game/desktop/window.hpp"
#include "game/session/session_history.hpp"
#include "game/ui/overlay.hpp"
#include "game/view/gizmos.hpp"
#include "game/view/outside_camera.hpp"
#include "game/view/player_view.hpp"

namespace handhold {

struct PlayPanels {
    bool help = true;
    bool inspector = false;
    bool menu = false;
};

// One scene, played in a window until the user leaves it.
struct PlayStage {
    DesktopSession& session;
    Window& window;
    PlayerView& view;
    const PlayerModels& models;
    Overlay& overlay;
    PlaySettings& settings;
    PlayPanels& panels;
    PlayTally& tally;
    Image& picture;                                     // the last one
    std::array<int, 2> picture_size;                    // width and height in pixels
    GizmoSet gizmos;                                    // on at the start
    std::string page;                                   // page of the inspector; empty: its first
    PlayerViewpoint viewpoint = PlayerViewpoint::eyes;  // at the start; not free
    double end_s = 0.0;                                 // of the scene's clock; 0: never
    std::FILE* status = nullptr;  // gets a line every tenth of a second; may be null
};

// How the session ended.
struct PlayEnd {
    bool leaves = true;  // else `scene` is played next
    std::string scene;   // may be the same scene
};

// Plays in real time. If a picture takes longer than a tenth of a second, simulated time runs
// slower, so the result does not depend on the frame rate of the pictures.
PlayEnd play(PlayStage& stage);

}  // namespace handhold
