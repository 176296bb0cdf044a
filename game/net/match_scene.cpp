#include "game/net/match_scene.hpp"

#include <bit>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <handhold/version.h>

#include "game/assets/assets.hpp"
#include "game/assets/body_clips_asset.hpp"
#include "game/climber/crowd.hpp"
#include "game/scene/player_defaults.hpp"

namespace handhold {
namespace {

// FNV-1a, 64 bits.
class Digest {
  public:
    void add(std::uint64_t value) {
        for (unsigned shift = 0; shift < 64; shift += 8) {
            value_ = (value_ ^ ((value >> shift) & 0xffU)) * 0x100000001b3ULL;
        }
    }
    void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
    void add(std::span<const std::byte> bytes) {
        for (const std::byte byte : bytes) {
            value_ = (value_ ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3ULL;
        }
    }
    void add(std::string_view text) { add(std::as_bytes(std::span(text.data(), text.size()))); }
    std::uint64_t value() const { return value_; }

  private:
    std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

template <typename Value>
std::uint64_t digest_of(const Value& value) {
    Digest digest;
    digest.add(value);
    return digest.value();
}

std::uint64_t digest_of_tuning(const hh::World& world) {
    Digest digest;
    for (const double number : world.tuning_numbers()) {
        digest.add(number);
    }
    return digest.value();
}

// Of the whole state. Its snapshot names shapes by their content.
std::uint64_t digest_of_snapshot(hh::World& world) {
    std::vector<std::byte> snapshot;
    if (const hh::Status saved = world.save(snapshot); !saved) {
        throw std::runtime_error(std::string(saved.text()));
    }
    Digest digest;
    digest.add(std::span<const std::byte>(snapshot));
    return digest.value();
}

MatchDigests digests_of(Scene& scene) {
    MatchDigests digests{};
    const auto set = [&digests](MatchDigest which, std::uint64_t value) {
        digests[static_cast<std::size_t>(which)] = value;
    };
    set(MatchDigest::library, digest_of(std::string_view(HANDHOLD_VERSION_TEXT)));
    set(MatchDigest::scene, digest_of(std::string_view(scene.name)));
    set(MatchDigest::tick, digest_of(k_match_tick_s));
    set(MatchDigest::tuning, digest_of_tuning(scene.host));
    set(MatchDigest::clips, digest_of(game_asset("body_clips.json")));
    set(MatchDigest::bodies, scene.host.simulated_hash());
    set(MatchDigest::shapes, digest_of_snapshot(scene.host));
    return digests;
}

}  // namespace

Result<MatchScene> make_match_scene(Scene scene, std::size_t count, std::uint64_t seed) {
    MatchScene out;
    out.scene = std::move(scene);
    hh::World& world = out.scene.host;
    load_game_body_clips(world);
    constexpr const char* k_jets = "locomotion.thruster_mps2";
    if (world.tuning(k_jets).value_or(0.0) == 0.0) {
        (void)world.tune(k_jets, k_jets_mps2);
    }
    const hh::Pose first_ws =
        out.scene.spawns.empty() ? hh::k_origin : out.scene.spawns.front().pose_ws;
    // Teams begin at their own goals.
    const bool has_teams = out.scene.arena && count <= out.scene.spawns.size();
    std::vector<hh::Pose> places;
    for (std::size_t i = 0; has_teams && i < count; ++i) {
        places.push_back(out.scene.spawns[i].pose_ws);
    }
    if (!has_teams) {
        places = spread_players(out.scene, first_ws, count, seed);
    }
    for (const hh::Pose& origin_ws : places) {
        const std::string name = "player" + std::to_string(out.players.size());
        out.players.push_back(add_scene_player(out.scene, name, origin_ws));
    }
    if (out.players.size() < count) {
        return FileError{out.scene.name, "",
                         "expected space for " + std::to_string(count) + " players, found it for " +
                             std::to_string(out.players.size())};
    }
    out.digests = digests_of(out.scene);
    return out;
}

}  // namespace handhold
