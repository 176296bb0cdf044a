#include "tools/lab/match_film.hpp"

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>

#include "game/levels/load_scene.hpp"
#include "game/mesh/image.hpp"
#include "game/mesh/primitives.hpp"
#include "game/net/match_scene.hpp"
#include "game/net/match_server.hpp"
#include "game/net/peer_hands.hpp"
#include "game/view/drawn_match.hpp"
#include "game/view/player_view.hpp"
#include "tools/lab/exit_status.hpp"
#include "tools/lab/measure.hpp"
#include "tools/lab/simulated_link.hpp"

namespace handhold::lab {
namespace {

constexpr std::size_t k_film_players = 2;
constexpr std::size_t k_viewing_player = 0;
constexpr std::size_t k_shown_player = 1;
constexpr double k_film_look_s = 1.0 / 360.0;
constexpr int k_exit_proves_nothing = 3;

using DrawnHands = std::array<Vec3, k_hand_count>;

// One player's machine, with what it draws.
struct FilmPeer {
    MatchScene scene;
    std::optional<RecordedHands> hands;
    std::unique_ptr<MatchPeer> peer;
    std::optional<PlayerView> view;
    DrawnMatch drawn_now;
    std::map<std::uint64_t, DrawnHands> drawn;  // hands of the player who is shown, by tick
};

class MatchFilm {
  public:
    explicit MatchFilm(const MatchFilmOptions& options)
        : options_(options),
          wire_({.delay_s = 0.0005 * options.rtt_ms,
                 .jitter_s = 0.001 * options.jitter_ms,
                 .loss = options.loss},
                options.seed, k_film_players),
          listener_(wire_) {}

    std::optional<FileError> load() {
        Result<MatchScene> of_server = load_level();
        if (!of_server) {
            return of_server.error();
        }
        scene_ = std::move(of_server.value());
        MatchServerSettings settings;
        settings.offer.scene = scene_.scene.name;
        settings.offer.digests = scene_.digests;
        settings.arena = scene_.scene.arena ? &*scene_.scene.arena : nullptr;
        settings.clock = [this] { return wire_.now_s; };
        settings.today = [] { return std::int64_t{0}; };
        server_ = std::make_unique<MatchServer>(scene_.scene.host, scene_.players,
                                                std::move(settings), listener_);
        for (std::size_t i = 0; i < k_film_players; ++i) {
            if (auto error = add_peer(i)) {
                return error;
            }
        }
        const Pose place =
            from_host(scene_.scene.host.pose(scene_.players[k_shown_player])->origin);
        const auto at = [&place](double right_m, double up_m, double before_m) {
            return transform_point(place, Vec3(right_m, up_m, -before_m));
        };
        const auto& [right_m, up_m, before_m] = options_.from_m;
        const Vec3 eye_ws = at(right_m, up_m, before_m);
        camera_ws_ =
            look_along(eye_ws, at(0.0, options_.height_m, 0.0) - eye_ws, scene_.scene.up_ws);
        return std::nullopt;
    }

    std::optional<FileError> run() {
        const double end_s = options_.from_s + options_.seconds;
        for (int look = 1; wire_.now_s < end_s; ++look) {
            wire_.now_s = k_film_look_s * look;
            server_->poll();
            for (const hh_match_event& event : server_->match().events()) {
                grips_ += event.event.kind == HH_EVENT_GRABBED ? 1U : 0U;
            }
            for (std::size_t i = 0; i < k_film_players; ++i) {
                if (static_cast<std::size_t>(look) % 4 != i) {
                    continue;
                }
                if (auto error = step(i)) {
                    return error;
                }
            }
        }
        return std::nullopt;
    }

    int report() const {
        Series apart_m;
        const FilmPeer& there = peers_[k_shown_player];
        for (const auto& [tick, hands] : peers_[k_viewing_player].drawn) {
            const auto other = there.drawn.find(tick);
            for (std::size_t side = 0; other != there.drawn.end() && side < k_hand_count; ++side) {
                apart_m.add((hands[side] - other->second[side]).norm());
            }
        }
        const hh_match_stats stats = peers_[k_viewing_player].peer->match().stats();
        std::printf(
            "%zu pictures of each machine; %llu rollbacks, deepest %llu; %d packets lost; "
            "%llu grips; hands apart, mm: median %.1f, 95 %% %.1f\n",
            peers_[k_viewing_player].drawn.size(), static_cast<unsigned long long>(stats.rollbacks),
            static_cast<unsigned long long>(stats.deepest), wire_.lost(),
            static_cast<unsigned long long>(grips_), 1000.0 * apart_m.quantile(0.5),
            1000.0 * apart_m.quantile(0.95));
        return apart_m.values.empty() || stats.rollbacks == 0 ? k_exit_proves_nothing : 0;
    }

  private:
    Result<MatchScene> load_level() const {
        Result<Scene> scene = load_scene(options_.scene);
        if (!scene) {
            return scene.error();
        }
        return make_match_scene(std::move(scene.value()), k_film_players, options_.seed);
    }

    std::optional<FileError> add_peer(std::size_t i) {
        FilmPeer& to = peers_[i];
        Result<MatchScene> level = load_level();
        if (!level) {
            return level.error();
        }
        to.scene = std::move(level.value());
        const Result<Recording> recording = load_recording(options_.inputs[i]);
        if (!recording) {
            return recording.error();
        }
        to.hands.emplace(recording.value());
        std::string why_not;
        to.view =
            PlayerView::open(to.scene.scene, {}, options_.width_px, options_.height_px, why_not);
        if (!to.view) {
            return FileError{options_.out.string(), "", "nothing can be drawn: " + why_not};
        }
        to.view->show_hand_lines(false);
        MatchPeerSettings settings;
        settings.digests = to.scene.digests;
        settings.arena = to.scene.scene.arena ? &*to.scene.scene.arena : nullptr;
        settings.person = i + 1;
        settings.clock = [this] { return wire_.now_s; };
        to.peer = std::make_unique<MatchPeer>(to.scene.scene.host, to.scene.players, settings);
        to.peer->connect(std::make_unique<SimulatedLink>(wire_, i));
        return std::nullopt;
    }

    std::optional<FileError> step(std::size_t i) {
        FilmPeer& now = peers_[i];
        const std::uint32_t ticks = now.peer->poll(
            0.0, [&now](double end_s, PeerInput& input) { (*now.hands)(end_s, input); });
        if (ticks == 0) {
            return now.peer->stage() != PeerStage::ended
                       ? std::nullopt
                       : std::optional(FileError{"match", "", now.peer->why()});
        }
        const std::uint64_t tick = now.peer->match().stats().tick;
        const auto each = static_cast<std::uint64_t>(options_.ticks_a_picture);
        if (wire_.now_s < options_.from_s || tick % each != 0) {
            return std::nullopt;
        }
        const Scene& scene = now.scene.scene;
        if (options_.hides_corrections) {
            note_drawn(*now.peer, scene, nullptr, now.drawn_now);
            now.view->show_drawn(&now.drawn_now);
        }
        const Column<RenderPose>& poses = scene.world().render_pose;
        const std::size_t index = poses.find_index(entity_of(now.scene.players[k_shown_player]));
        now.drawn[tick] = hands_at_tick(now, poses.elements()[index]);
        now.view->draw(camera_ws_, options_.fov_deg * k_degree, std::nullopt, picture_);
        std::array<char, 64> name{};
        std::snprintf(name.data(), name.size(), "%s_%06llu.png",
                      i == k_viewing_player ? "here" : "there",
                      static_cast<unsigned long long>(tick));
        return save_png(picture_, (options_.out / name.data()).string());
    }

    // Hands of the player who is shown, at the tick itself: pictures are between two.
    DrawnHands hands_at_tick(const FilmPeer& now, const RenderPose& pose) const {
        DrawnHands hands = {pose.hands[0].shown_ws.position, pose.hands[1].shown_ws.position};
        const auto offsets = now.peer->match().shown_offsets(k_shown_player);
        for (std::size_t side = 0; options_.hides_corrections && offsets && side < 2; ++side) {
            hands[side] += from_host(offsets->hands[side]);
        }
        return hands;
    }

    MatchFilmOptions options_;
    SimulatedWire wire_;
    SimulatedListener listener_;
    MatchScene scene_;
    std::unique_ptr<MatchServer> server_;
    std::array<FilmPeer, k_film_players> peers_;
    Pose camera_ws_;
    Image picture_;
    std::uint64_t grips_ = 0;
};

}  // namespace

int match_film_command(const MatchFilmOptions& options) {
    const auto film = std::make_unique<MatchFilm>(options);
    if (const auto error = film->load()) {
        return refuse(*error);
    }
    if (const auto error = film->run()) {
        return refuse(*error);
    }
    return film->report();
}

}  // namespace handhold::lab
