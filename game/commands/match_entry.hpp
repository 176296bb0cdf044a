#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "game/net/match_peer.hpp"
#include "game/net/match_scene.hpp"

// How a program enters a match, and comes back to it.
namespace handhold {

// Where a match is, and what admits this program to it.
struct MatchPlace {
    std::string url;
    std::string scene;       // empty: the built-in scene that the server names
    std::string token_file;  // a token for each peer, one a line; empty: none
};

struct MatchEntry {
    MatchOffer offer;
    std::vector<std::string> tokens;  // one for each peer
};
// Asks the server what it plays, and reads the tokens. Errors: no server, another version, a token
// that is missing.
Result<MatchEntry> ask_for_entry(const MatchPlace& place, std::size_t peers);

// Loads the scene that is played and adds its players. Error: it differs from the server's.
// `place.url` is for errors: a server, or a recording.
Result<MatchScene> load_entry_scene(const MatchPlace& place, const MatchOffer& offer);

// Seconds of a clock that only runs forward.
double match_now_s();
// A peer for the world of `scene`, which must outlive it.
MatchPeerSettings make_peer_settings(MatchScene& scene, const std::string& token);
std::optional<FileError> connect_peer(const MatchPlace& place, MatchPeer& peer);

// Connects again after the connection was lost, every second for a minute.
class MatchReturn {
  public:
    // Call after each poll. False: the match is over for this peer.
    bool goes_on(const MatchPlace& place, MatchPeer& peer);
    // True while the connection is lost.
    bool is_lost() const { return lost_s_.has_value(); }
    // True once the peer has played.
    bool has_played() const { return has_played_; }

  private:
    bool has_played_ = false;
    std::optional<double> lost_s_;
    double next_s_ = 0.0;
};

// Null for an empty path.
Result<std::unique_ptr<MatchRecorder>> open_recorder(const std::string& path,
                                                     const MatchOffer& level);
// Finishes the recording, if there is one, and logs it. Returns the exit status.
int finish_recording(MatchRecorder* recorder, const hh::Match& match);

// Leaves the match, and waits a second at most until the server knows.
void leave_match(MatchPeer& peer);

}  // namespace handhold
