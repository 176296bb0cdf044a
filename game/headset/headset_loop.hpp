#pragma once

#include <csignal>
#include <cstdio>
#include <memory>
#include <string>

#include "game/desktop/play_options.hpp"
#include "game/desktop/window.hpp"
#include "game/headset/headset_clock.hpp"
#include "game/headset/headset_session.hpp"
#include "game/play/play_tally.hpp"
#include "game/view/player_view.hpp"
#include "game/xr/headset.hpp"

namespace handhold {

// One scene, played in a headset until it is left.
struct HeadsetStage {
    const PlayOptions& options;
    HeadsetSession& session;
    PlayerView* view = nullptr;  // null: headless
    Window* mirror = nullptr;    // null: no mirror window
    EyeSize eye_size;
    PlayTally& tally;
    Image& picture;               // both eyes side by side, if options ask for a picture
    std::FILE* status = nullptr;  // gets a line every 0.1 s; null: none
    // The session ends when the value is not 0; may be null.
    const volatile std::sig_atomic_t* asked_to_end = nullptr;
    double hz = 90.0;  // out: frames per second of the session
};

// Simulates one frame per refresh of the display and draws it for its display time. If the runtime
// is lost, tries for about half a minute to reopen it; this time is not simulated. Returns false,
// with the reason in `why_not`, if the session cannot be started or reopened.
bool play_in_headset(HeadsetStage& stage, std::unique_ptr<Headset> headset, std::string& why_not);

}  // namespace handhold
