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

// One scene, played in a headset until somebody leaves it.
struct HeadsetStage {
    const PlayOptions& options;
    HeadsetSession& session;
    PlayerView* view = nullptr;  // null: headless
    Window* mirror = nullptr;    // null: none
    EyeSize eye_size;
    PlayTally& tally;
    Image& picture;               // both eyes beside each other, where options ask for a picture
    std::FILE* status = nullptr;  // a line every tenth of a second; none: null
    const volatile std::sig_atomic_t* asked_to_end = nullptr;  // not 0: leave
    double hz = 90.0;  // out: frames a second of the session
};

// One frame of the simulation for each refresh of the display, drawn for when it will be seen. A
// runtime that is lost is looked for again for half a minute; meanwhile no time passes. False, with
// the reason, where it does not come back.
bool play_in_headset(HeadsetStage& stage, std::unique_ptr<Headset> headset, std::string& why_not);

}  // namespace handhold
