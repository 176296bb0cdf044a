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

// One scene, played in a window from its beginning until somebody leaves it.
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
    GizmoSet gizmos;                                    // that are on when it begins
    std::string page;                                   // of the inspector; empty: its first
    PlayerViewpoint viewpoint = PlayerViewpoint::eyes;  // when it begins; not free
    double end_s = 0.0;                                 // of the scene's clock; 0: never
    std::FILE* status = nullptr;  // a line every tenth of a second; none: null
};

// How it ended.
struct PlayEnd {
    bool leaves = true;  // else: plays `scene` next
    std::string scene;   // may be the same again
};

// Real time into steps of the simulation; where a picture takes longer than a tenth of a second,
// time goes slower: what is played does not depend on how fast pictures come.
PlayEnd play(PlayStage& stage);

}  // namespace handhold
