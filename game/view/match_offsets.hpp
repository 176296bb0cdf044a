#pragma once

#include <vector>

#include "game/net/match_peer.hpp"
#include "game/scene/scene.hpp"
#include "game/view/shown_offset.hpp"

namespace handhold {

// Displacements that hide corrections of guesses in the peer's match, whose scene this is; indexed
// by player of its world. Zero for a spectator, and before the match.
void note_shown_offsets(const MatchPeer& peer, const Scene& scene, std::vector<ShownOffset>& out);

}  // namespace handhold
