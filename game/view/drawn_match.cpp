#include "game/view/drawn_match.hpp"

namespace handhold {

void note_drawn(const MatchPeer& peer, const Scene& scene, const hh::Sample* newest,
                DrawnMatch& out) {
    const World& world = scene.world();
    out.players.assign(world.render_pose.size(), std::nullopt);
    out.visuals_ws.clear();
    if (!peer.match().is_valid()) {
        return;
    }
    const std::span<const hh::Player> players = peer.players();
    for (std::size_t slot = 0; slot < players.size(); ++slot) {
        const std::size_t index = world.render_pose.find_index(entity_of(players[slot]));
        const bool is_own = !peer.watches() && slot == peer.slot();
        const auto drawn =
            peer.match().drawn_player(static_cast<std::uint32_t>(slot), is_own ? newest : nullptr);
        if (drawn && index < out.players.size()) {
            out.players[index] = {
                from_host(drawn->head),
                {from_host(drawn->hands[HH_LEFT]), from_host(drawn->hands[HH_RIGHT])}};
        }
    }
    std::vector<hh::Body> bodies;
    for (const SceneVisual& visual : scene.visuals) {
        bodies.push_back(body_id(visual.body));
    }
    std::vector<hh_pose> poses(bodies.size());
    if (peer.match().drawn_bodies(bodies, poses)) {
        for (const hh_pose& pose : poses) {
            out.visuals_ws.push_back(from_host(pose));
        }
    }
}

}  // namespace handhold
