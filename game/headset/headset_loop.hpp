#pragma once

#include <csignal>
#include <cstdio>
#include <memory>
#include <string>

#include "game/commands/play_command.hpp"
#include "game/desktop/play_tally.hpp"
#include "game/desktop/window.hpp"
#include "game/headset/headset_clock.hpp"
#include "game/headset/headset_session.hpp"
#include "game/view/player_view.hpp"
#include "game/xr/headset.hpp"

namespace handhold {

// Inputs and outputs of a session that is played in a headset.
struct HeadsetStage {
    const PlayOptions& options;
    HeadsetSession& session;
    PlayerView* view = nullptr;  // null: headless
    Window* mirror = nullptr;    // null: no mirror window
    EyeSize eye_size;
    PlayTally& tally;
    Image& picture;               // out: both eyes side by side, if `options` ask for a picture
    std::FILE* status = nullptr;  // gets a line every tenth of a second; null: none
    const volatile std::sig_atomic_t* asked_to_end = nullptr;  // not 0: leave
    double hz = 90.0;  // out: frames a second of the session
};

// Plays the session until somebody ends it. Simulates one frame per display refresh, and draws it
// as predicted for the time of its display. If the runtime is lost, tries for half a minute to
// reopen it; simulated time stands still meanwhile. Returns false, with the reason, if the session
// cannot begin or the runtime does not come back.
bool play_in_headset(HeadsetStage& stage, std::unique_ptr<Headset> headset, std::string& why_not);

}  // namespace handhold
