#include "game/commands/play_command.hpp"

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "game/commands/headset_command.hpp"
#include "game/commands/match_entry.hpp"
#include "game/commands/play_files.hpp"
#include "game/desktop/play_loop.hpp"
#include "game/play/exit_status.hpp"
#include "game/report/run_summary.hpp"
#include "game/ui/hud.hpp"

namespace handhold {
namespace {

int refuse_window(const std::string& why_not) {
    std::fprintf(stderr, "no window: %s\n", why_not.c_str());
    return k_exit_no_window;
}

// State that is kept when the user changes to another scene.
struct PlayProgram {
    PlayOptions options;
    PlayerModels models;
    OpenFile status;
    PlayPanels panels;
    Overlay overlay;
    std::unique_ptr<Window> window;
};

// Opens the view of the session, and the window if it is not open yet. If graphics are not
// available, returns nullopt and sets `why_not`.
std::optional<PlayerView> open_view(PlayProgram& program, DesktopSession& session,
                                    std::string& why_not) {
    const PlayOptions& options = program.options;
    auto view = PlayerView::open(session.scene(), program.models, options.width_px,
                                 options.height_px, why_not, options.settings.quality);
    if (view && program.window == nullptr) {
        program.window = Window::open("", options.width_px, options.height_px, why_not);
        if (program.window == nullptr) {
            return {};
        }
        std::printf("%s\n", help_text());
    }
    return view;
}

// Plays a session until the user leaves it, alone (`match` null) or in a match. Returns the exit
// status, or nullopt if options.scene names the next scene to play.
std::optional<int> play_session(PlayProgram& program, DesktopSession& session,
                                const std::string& place, PlayedMatch* match) {
    PlayOptions& options = program.options;
    if (!options.record.empty()) {
        session.record();
    }
    std::string why_not;
    auto view = open_view(program, session, why_not);
    if (!view) {
        return refuse_window(why_not);
    }
    program.window->set_title("Handhold: " + session.scene().name);
    Image picture;
    PlayTally tally;
    PlayStage stage{session,
                    *program.window,
                    *view,
                    program.models,
                    program.overlay,
                    options.settings,
                    program.panels,
                    tally,
                    picture,
                    {options.width_px, options.height_px},
                    options.gizmos,
                    options.page,
                    options.viewpoint,
                    options.seconds,
                    program.status.get(),
                    match};
    const PlayEnd end = play(stage);
    std::printf("%s", tally.summary().c_str());
    if (const auto error = save_play(options,
                                     {session.scene(), place, session.recording(),
                                      session.used_sticks(), 1.0 / DesktopSession::k_dt_s},
                                     tally, picture)) {
        return refuse(*error);
    }
    if (end.leaves) {
        std::printf("state_hash %s\n", format_hash(session.world().hash()).c_str());
        return 0;
    }
    options.scene = end.scene;
    options.spawn.clear();
    options.join.clear();
    return {};
}

// Plays the scene that the options name.
std::optional<int> play_scene(PlayProgram& program) {
    Result<PlayedScene> loaded = load_played_scene(program.options);
    if (!loaded) {
        return refuse(loaded.error());
    }
    print_notes(loaded.value().scene.notes);
    const std::string place = loaded.value().place.name;
    DesktopSession session(std::move(loaded.value().scene), loaded.value().place.pose_ws);
    if (program.options.spawn.empty()) {  // a named place has its own direction
        session.face_nearest_surface();
    }
    if (const auto joints = program.models.controller_joints()) {
        session.set_controller_joints(*joints);
    }
    return play_session(program, session, place, nullptr);
}

// Plays in the match that the options name. Controllers' own joints would be another level.
std::optional<int> play_match(PlayProgram& program) {
    const PlayOptions& options = program.options;
    const MatchPlace place{options.join, options.scene, options.token};
    const Result<MatchEntry> entry = ask_for_entry(place, 1);
    if (!entry) {
        return refuse(entry.error());
    }
    Result<MatchScene> loaded = load_entry_scene(place, entry.value().offer);
    if (!loaded) {
        return refuse(loaded.error());
    }
    MatchPeerSettings settings = make_peer_settings(loaded.value(), entry.value().tokens.front());
    const std::vector<hh::Player> players = loaded.value().players;
    DesktopSession session(std::move(loaded.value().scene), players.front());
    settings.watches = options.watches;
    settings.arena = session.scene().arena ? &*session.scene().arena : nullptr;
    MatchPeer peer(session.world(), players, settings);
    MatchReturn returns;
    if (const auto error = connect_peer(place, peer)) {
        return refuse(*error);
    }
    PlayedMatch match{peer, [&] {
                          if (!peer.watches()) {
                              session.play_as(players[peer.slot()]);
                          }
                          return returns.goes_on(place, peer);
                      }};
    program.panels.inspector = false;
    while (peer.stage() != PeerStage::playing) {  // the window shows the match from its first tick
        constexpr double k_look_s = 0.01;
        peer.poll(k_look_s, [](double /*end_s*/, PeerInput& /*input*/) {});
        if (!match.goes_on()) {
            return refuse({place.url, "", peer.why()});
        }
    }
    if (peer.watches()) {
        program.options.viewpoint = PlayerViewpoint::free;
    }
    const std::string seat = peer.watches() ? "watching" : "slot " + std::to_string(peer.slot());
    const std::optional<int> status = play_session(program, session, seat, &match);
    const bool is_cut_off = peer.stage() == PeerStage::ended && peer.bye() != NetBye::draining;
    const std::string why = peer.why();
    leave_match(peer);
    return status == 0 && is_cut_off ? refuse({place.url, "", why}) : status;
}

}  // namespace

int play_command(const PlayOptions& options) {
    if (options.xr || options.xr_headless) {
        return headset_command(options);
    }
    if (const auto error = check_play_files(options)) {
        return refuse(*error);
    }
    Result<PlayerModels> models = choose_player_models(options.models);
    if (!models) {
        return refuse(models.error());
    }
    print_notes(models.value().notes);
    Result<OpenFile> status = open_status(options);
    if (!status) {
        return refuse(status.error());
    }
    PlayProgram program{options,
                        std::move(models.value()),
                        std::move(status.value()),
                        options.panels,
                        Overlay(options.width_px, options.height_px),
                        nullptr};
    for (;;) {
        const bool is_match = !program.options.join.empty();
        if (const auto exit_status = is_match ? play_match(program) : play_scene(program)) {
            return *exit_status;
        }
    }
}

}  // namespace handhold
