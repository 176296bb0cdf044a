#include "game/commands/match_entry.hpp"

#include <algorithm>
#include <chrono>
#include <sstream>
#include <utility>

#include "game/levels/built_in_scenes.hpp"
#include "game/net/hmac.hpp"
#include "game/net/net_log.hpp"
#include "game/play/exit_status.hpp"
#include "game/play/loading.hpp"

namespace handhold {
namespace {

constexpr double k_offer_within_s = 5.0;
constexpr double k_return_within_s = 60.0;
constexpr double k_return_every_s = 1.0;
constexpr double k_leave_within_s = 1.0;

Result<std::vector<std::string>> load_tokens(const MatchPlace& place, const MatchOffer& offer,
                                             std::size_t peers) {
    std::vector<std::string> tokens;
    if (place.token_file.empty()) {
        if (offer.wants_token) {
            return FileError{place.url, "", refusal_text({NetRefusal::no_token})};
        }
        tokens.resize(peers);
        return tokens;
    }
    const Result<std::string> text = read_file(place.token_file, peers * (k_most_text_bytes + 1));
    if (!text) {
        return text.error();
    }
    std::istringstream lines(text.value());
    for (std::string line; std::getline(lines, line);) {
        tokens.push_back(line);
    }
    if (tokens.size() < peers) {
        return FileError{place.token_file, "",
                         "expected " + std::to_string(peers) + " tokens, one a line, found " +
                             std::to_string(tokens.size())};
    }
    return tokens;
}

// A server must not choose which file is opened here.
Result<Scene> load_named_scene(const MatchPlace& place, const MatchOffer& offer) {
    if (!place.scene.empty()) {
        return load_scene_with_progress(place.scene);
    }
    const std::vector<std::string_view> names = built_in_scenes();
    if (std::ranges::find(names, offer.scene) == names.end()) {
        return FileError{place.url, "",
                         "the match is in \"" + offer.scene +
                             "\", which is not built in: give its file by --scene"};
    }
    return load_scene_with_progress(offer.scene);
}

}  // namespace

Result<MatchEntry> ask_for_entry(const MatchPlace& place, std::size_t peers) {
    Result<MatchOffer> offer = fetch_offer(place.url, k_offer_within_s);
    if (!offer) {
        return offer.error();
    }
    Result<std::vector<std::string>> tokens = load_tokens(place, offer.value(), peers);
    if (!tokens) {
        return tokens.error();
    }
    return MatchEntry{std::move(offer.value()), std::move(tokens.value())};
}

Result<MatchScene> load_entry_scene(const MatchPlace& place, const MatchOffer& offer) {
    Result<Scene> scene = load_named_scene(place, offer);
    if (!scene) {
        return scene.error();
    }
    Result<MatchScene> made = make_match_scene(std::move(scene.value()), offer.players, offer.seed);
    if (made) {
        if (const auto digest = first_difference(offer.digests, made.value().digests)) {
            return FileError{
                place.url, "",
                refusal_text({NetRefusal::level, static_cast<std::uint16_t>(*digest)})};
        }
    }
    return made;
}

double match_now_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

MatchPeerSettings make_peer_settings(MatchScene& scene, const std::string& token) {
    MatchPeerSettings settings;
    settings.digests = scene.digests;
    settings.person = secret_number();
    settings.token = token;
    settings.tick_s = k_match_tick_s;
    settings.clock = match_now_s;
    settings.arena = scene.scene.arena ? &*scene.scene.arena : nullptr;
    return settings;
}

std::optional<FileError> connect_peer(const MatchPlace& place, MatchPeer& peer) {
    Result<std::unique_ptr<Link>> link = open_link(place.url);
    if (!link) {
        return link.error();
    }
    peer.connect(std::move(link.value()));
    return std::nullopt;
}

bool MatchReturn::goes_on(const MatchPlace& place, MatchPeer& peer) {
    if (peer.stage() == PeerStage::playing) {
        has_played_ = true;
        lost_s_.reset();
    }
    if (peer.stage() != PeerStage::ended) {
        return true;
    }
    if (!has_played_ || !peer.may_return()) {
        return false;
    }
    const double now_s = match_now_s();
    lost_s_ = lost_s_.value_or(now_s);
    if (now_s - *lost_s_ > k_return_within_s) {
        return false;
    }
    if (now_s >= next_s_) {
        next_s_ = now_s + k_return_every_s;
        return !connect_peer(place, peer).has_value();
    }
    return true;
}

Result<std::unique_ptr<MatchRecorder>> open_recorder(const std::string& path,
                                                     const MatchOffer& level) {
    if (path.empty()) {
        return std::unique_ptr<MatchRecorder>();
    }
    return MatchRecorder::open(path, level);
}

int finish_recording(MatchRecorder* recorder, const hh::Match& match) {
    if (recorder == nullptr) {
        return 0;
    }
    if (const auto error = recorder->finish(match)) {
        return refuse(*error);
    }
    print_log_line(log_line("recorded", {{"bytes", std::to_string(recorder->bytes())}}));
    return 0;
}

void leave_match(MatchPeer& peer) {
    peer.leave();
    const double end_s = match_now_s() + k_leave_within_s;
    while (peer.is_linked() && match_now_s() < end_s) {
        constexpr double k_look_s = 0.002;
        peer.poll(k_look_s, {});
    }
}

}  // namespace handhold
