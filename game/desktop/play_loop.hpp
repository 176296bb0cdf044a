#pragma once

#include <array>
#include <cstdio>
#include <functional>
#include <string>

#include "game/desktop/window.hpp"
#include "game/devices/play_settings.hpp"
#include "game/net/match_peer.hpp"
#include "game/play/desktop_session.hpp"
#include "game/play/play_tally.hpp"
#include "game/play/session_history.hpp"
#include "game/ui/first_hint.hpp"
#include "game/ui/overlay.hpp"
#include "game/view/gizmos.hpp"
#include "game/view/outside_camera.hpp"
#include "game/view/player_view.hpp"

namespace handhold {

struct PlayPanels {
    bool help = false;
    bool inspector = false;
    bool menu = false;
    FirstHint hint;  // is gone once somebody has pulled, in later scenes too
};

// The match that steps the scene's world, if somebody else's is played.
struct PlayedMatch {
    MatchPeer& peer;
    std::function<bool()> goes_on;  // called after each poll of `peer`; false: it is over
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
    Image& picture;                   // the last picture drawn
    std::array<int, 2> picture_size;  // width and height in pixels
    GizmoSet gizmos;                  // gizmos that are on at the start
    std::string page;                 // page of the inspector; empty: its first
    PlayerViewpoint viewpoint =
        PlayerViewpoint::eyes;  // first viewpoint; `free` begins at the eyes
    // End of the session on the scene's clock; 0: never.
    double end_s = 0.0;
    std::FILE* status = nullptr;  // gets a line every tenth of a second; may be null
    // Null: played alone. In a match there is no pause, no rewinding and no inspector, whose tuning
    // would differ from the others'.
    PlayedMatch* match = nullptr;
};

// How the session ended.
struct PlayEnd {
    bool leaves = true;  // false: `scene` is played next
    std::string scene;   // may be the scene just played
};

// Plays in real time with steps of constant length, so the result does not depend on the pictures'
// frame rate. If a picture takes longer than a tenth of a second, simulated time runs slower.
PlayEnd play(PlayStage& stage);

}  // namespace handhold
