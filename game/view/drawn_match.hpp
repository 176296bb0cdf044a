#pragma once

#include <optional>
#include <vector>

#include "game/net/match_peer.hpp"
#include "game/scene/scene.hpp"
#include "game/view/drawn_place.hpp"

namespace handhold {

// Players and bodies of a scene as a match draws them: between the last two ticks, with corrections
// of guesses hidden. Empty: all are drawn as the last tick left them.
struct DrawnMatch {
    std::vector<std::optional<DrawnPlace>> players;  // indexed by player of the world
    std::vector<Pose> visuals_ws;                    // bodies of Scene::visuals, in their order

    // The player at `index` as drawn.
    RenderPose of(std::size_t index, const RenderPose& stepped) const {
        const bool is_elsewhere = index < players.size() && players[index].has_value();
        return is_elsewhere ? drawn_at(stepped, *players[index]) : stepped;
    }
};

// As the peer's match, whose scene this is, is drawn now. `newest`: the own devices now; null: the
// own head and hands are drawn between ticks too (hh_match_drawn_player). Empty before the match.
void note_drawn(const MatchPeer& peer, const Scene& scene, const hh::Sample* newest,
                DrawnMatch& out);

}  // namespace handhold
