#include "game/view/match_offsets.hpp"

namespace handhold {

void note_shown_offsets(const MatchPeer& peer, const Scene& scene, std::vector<ShownOffset>& out) {
    const World& world = scene.world();
    out.assign(world.render_pose.size(), {});
    const std::span<const hh::Player> players = peer.players();
    for (std::size_t slot = 0; slot < players.size() && peer.match().is_valid(); ++slot) {
        const std::size_t index = world.render_pose.find_index(entity_of(players[slot]));
        const auto offsets = peer.match().shown_offsets(static_cast<std::uint32_t>(slot));
        if (offsets && index < out.size()) {
            out[index] = {
                from_host(offsets->head),
                {from_host(offsets->hands[HH_LEFT]), from_host(offsets->hands[HH_RIGHT])}};
        }
    }
}

}  // namespace handhold
