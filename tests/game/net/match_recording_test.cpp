// Recorded matches: played again with equal hashes, and refused in one line where they are damaged.
#include "game/net/match_recording.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "game/net/match_replay.hpp"
#include "tests/game/net/loopback_match.hpp"
#include "tests/random.hpp"

namespace handhold::match_recording_test {
namespace {

using test::LoopbackMatch;
using test::LoopbackPeer;
using Hashes = std::map<std::uint64_t, std::uint64_t>;

class RecordedMatch : public testing::Test {
  protected:
    void SetUp() override {
        if (!has_network()) {
            GTEST_SKIP() << "built without a network";
        }
        std::filesystem::create_directories(folder);
    }
    void TearDown() override { std::filesystem::remove_all(folder); }

    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() /
        ("handhold_match_" + std::to_string(static_cast<unsigned>(::getpid())));
};

MatchOffer level_of(const MatchScene& scene, std::size_t players) {
    MatchOffer level;
    level.players = static_cast<std::uint8_t>(players);
    level.digests = scene.digests;
    level.scene = scene.scene.name;
    return level;
}

std::unique_ptr<MatchRecorder> recorder_for(const std::filesystem::path& path,
                                            std::size_t players) {
    return std::move(
        MatchRecorder::open(path, level_of(test::tunnel_match(players), players)).value());
}

// Plays a recording again. Returns the hash of each tick; `error`: what stopped it, or empty.
Hashes play_again(const MatchRecording& recording, std::string& error) {
    MatchScene scene = test::tunnel_match(recording.level.players);
    Hashes hashes;
    MatchReplay replay(scene.scene.host, scene.players, nullptr, recording, 1.0 / 90.0);
    for (;;) {
        const Result<bool> stepped = replay.step(false);
        error = stepped ? "" : stepped.error().message();
        if (!stepped || !stepped.value()) {
            return hashes;
        }
        hashes[replay.tick()] = *replay.match().hash(replay.tick());
    }
}

// How many ticks of `played` are in `of_server`; all must be equal.
std::size_t equal_ticks(const Hashes& played, const Hashes& of_server) {
    std::size_t equal = 0;
    for (const auto& [tick, hash] : of_server) {
        const auto found = played.find(tick);
        if (found != played.end()) {
            EXPECT_EQ(found->second, hash) << tick;
            ++equal;
        }
    }
    return equal;
}

TEST_F(RecordedMatch, OfServerPlayerAndSpectatorPlayAgainWithEqualHashesAtEveryTick) {
    const std::unique_ptr<MatchRecorder> of_server = recorder_for(folder / "server.hhm", 3);
    const std::unique_ptr<MatchRecorder> of_player = recorder_for(folder / "player.hhm", 3);
    const std::unique_ptr<MatchRecorder> of_watcher = recorder_for(folder / "watcher.hhm", 3);
    Hashes hashes;
    {
        LoopbackMatch match(
            3, [&](MatchServerSettings& settings) { settings.recorder = of_server.get(); });
        match.add_peer(1);
        const auto add = [&](std::uint64_t number, bool watches, MatchRecorder* recorder) {
            auto peer = std::make_unique<LoopbackPeer>(3, number);
            peer->settings.watches = watches;
            peer->settings.recorder = recorder;
            peer->connect(match.link());
            match.peers.push_back(std::move(peer));
        };
        ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
        match.run(0.5);
        add(2, false, of_player.get());
        add(3, true, of_watcher.get());
        ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
        match.run(4.0);
        for (const auto& peer : match.peers) {
            EXPECT_EQ(peer->different, 0U);
            EXPECT_GT(peer->compared, 100U);
        }
        EXPECT_EQ(match.server->seats().taken(), 2U);
        EXPECT_EQ(match.server->seats().watching(), 1U);
        hashes = match.hashes();
        ASSERT_FALSE(of_player->finish(match.peers[1]->peer->match()));
        ASSERT_FALSE(of_watcher->finish(match.peers[2]->peer->match()));
        ASSERT_FALSE(of_server->finish(match.server->match()));
    }
    ASSERT_GT(hashes.size(), 200U);
    for (const char* const name : {"server.hhm", "player.hhm", "watcher.hhm"}) {
        SCOPED_TRACE(name);
        EXPECT_FALSE(std::filesystem::exists((folder / name).string() + ".part"));
        Result<MatchRecording> recording = load_match_recording(folder / name);
        ASSERT_TRUE(recording.ok()) << recording.error().message();
        std::string error;
        const Hashes played = play_again(recording.value(), error);
        EXPECT_EQ(error, "");
        const bool from_start = std::string(name) == "server.hhm";
        EXPECT_EQ(played.rbegin()->first, recording.value().last_tick);
        const std::size_t equal = equal_ticks(played, hashes);
        EXPECT_GT(equal, 150U);
        if (from_start) {
            EXPECT_EQ(equal, hashes.size());
            EXPECT_EQ(played.size(), recording.value().last_tick);
        }
        RecordProperty(std::string(name) + "_bytes",
                       static_cast<int>(recording.value().bytes.size()));
        RecordProperty(std::string(name) + "_ticks", static_cast<int>(played.size()));
    }
}

// A short recording of a server whose players do nothing, for tests of damage.
std::vector<std::byte> short_recording(const std::filesystem::path& path) {
    MatchScene scene = test::tunnel_match(2);
    std::unique_ptr<MatchRecorder> recorder =
        std::move(MatchRecorder::open(path, level_of(scene, 2)).value());
    hh_match_def def = hh::match_def();
    def.role = HH_MATCH_SERVER;
    hh::Match match(scene.scene.host, scene.players, def);
    recorder->begin(0, {});
    for (int i = 0; i < 200; ++i) {
        (void)match.confirm(i / 90.0);
        recorder->follow(match);
    }
    EXPECT_FALSE(recorder->finish(match));
    const std::string text = read_file(path).value();
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

TEST_F(RecordedMatch, CutOrFlippedAnywhereIsRefusedInOneLine) {
    const std::vector<std::byte> whole = short_recording(folder / "short.hhm");
    ASSERT_TRUE(parse_match_recording(whole, "short.hhm").ok());
    for (std::size_t size = 0; size < whole.size(); ++size) {
        const auto read = parse_match_recording(
            {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}, "short.hhm");
        ASSERT_FALSE(read.ok()) << size;
        ASSERT_EQ(read.error().message().find('\n'), std::string::npos);
        ASSERT_EQ(read.error().message().rfind("short.hhm: byte ", 0), 0U);
    }
    for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
        std::vector<std::byte> flipped = whole;
        flipped[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
        ASSERT_FALSE(parse_match_recording(std::move(flipped), "short.hhm").ok()) << bit;
    }
}

std::uint64_t fnv(std::span<const std::byte> bytes, std::uint64_t hash) {
    for (const std::byte byte : bytes) {
        hash = (hash ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3ULL;
    }
    return hash;
}

// Parts that were changed by somebody who also fixed their checksums.
TEST_F(RecordedMatch, ForgedPartsNeverCrash) {
    const std::vector<std::byte> whole = short_recording(folder / "short.hhm");
    const Result<MatchRecording> first = parse_match_recording(whole, "short.hhm");
    ASSERT_TRUE(first.ok());
    test::Random random(3);
    std::size_t refused = 0;
    std::size_t played = 0;
    for (int round = 0; round < 60; ++round) {
        std::vector<std::byte> forged = whole;
        const auto which = static_cast<std::size_t>(
            random.between(0.0, static_cast<double>(first.value().parts.size())));
        const RecordedPart& part = first.value().parts[which];
        const std::size_t content = part.place + 13;
        for (int change = 0; change < 3; ++change) {
            const auto at = content + static_cast<std::size_t>(random.between(
                                          0.0, static_cast<double>(part.bytes.size())));
            forged[at] = static_cast<std::byte>(random.between(0.0, 256.0));
        }
        const std::span<const std::byte> all = forged;
        const std::uint64_t sum = fnv(all.subspan(content, part.bytes.size()),
                                      fnv(all.subspan(part.place, 5), 0xcbf29ce484222325ULL));
        for (std::size_t i = 0; i < 8; ++i) {
            forged[part.place + 5 + i] = static_cast<std::byte>((sum >> (8 * i)) & 0xffU);
        }
        Result<MatchRecording> read = parse_match_recording(std::move(forged), "forged.hhm");
        ASSERT_TRUE(read.ok()) << read.error().message();
        std::string error;
        (void)play_again(read.value(), error);
        (error.empty() ? played : refused) += 1;
    }
    EXPECT_GT(refused, 50U);  // the packets have a checksum of their own
    RecordProperty("played", static_cast<int>(played));
}

TEST_F(RecordedMatch, AnotherHashInTheEndIsFound) {
    std::vector<std::byte> bytes = short_recording(folder / "short.hhm");
    Result<MatchRecording> recording = parse_match_recording(std::move(bytes), "short.hhm");
    ASSERT_TRUE(recording.ok());
    recording.value().last_hash ^= 1U;
    std::string error;
    (void)play_again(recording.value(), error);
    EXPECT_NE(error.find("expected the hash of the last tick"), std::string::npos) << error;
}

TEST_F(RecordedMatch, ARecordingThatNeverBeganLeavesNoFile) {
    ASSERT_TRUE(MatchRecorder::open(folder / "none.hhm", {}).ok());
    EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST_F(RecordedMatch, AFolderOrAMissingPlaceIsNoFileToWrite) {
    EXPECT_FALSE(MatchRecorder::open(folder, {}).ok());
    EXPECT_FALSE(MatchRecorder::open(folder / "none" / "x.hhm", {}).ok());
}

}  // namespace
}  // namespace handhold::match_recording_test
