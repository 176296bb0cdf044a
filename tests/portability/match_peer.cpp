// A player of a match without sockets: the test on the other side of the pipes carries its messages
// (game/web/test/cross_match.test.mjs). For targets that an emulator runs.
//
// usage: handhold-match-peer PERSON     a number that no other player of the match has
//
// Requests on standard input; numbers are little-endian, `now` is a clock in seconds, 8 bytes:
//   L size (4) offer     loads the level; the answer is a text, its size (4) first: why it cannot
//   C now                begins to connect
//   M size (4) message   takes a message of the server
//   P now                steps what is due; the answer is the number of messages to the server (4),
//                        each with its size (4) first, and a PeerReport
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <utility>
#include <vector>

#include <handhold/handhold.hpp>

#include "game/web/page_match.hpp"

#ifdef _WIN32
#include <fcntl.h>
#include <io.h>
#endif

namespace handhold {
namespace {

struct PeerReport {
    std::uint64_t stage = 0;
    std::uint64_t ticks = 0;
    std::uint64_t rollbacks = 0;
    std::uint64_t states = 0;
    std::uint64_t gripping = 0;   // looks at which a hand gripped
    std::uint64_t hash_tick = 0;  // the last confirmed tick that is a multiple of k_hash_ticks
    std::uint64_t hash = 0;       // of that tick; 0: too old
};
constexpr std::uint64_t k_hash_ticks = 180;

template <typename T>
bool read_as(T& value) {
    return std::fread(&value, sizeof(value), 1, stdin) == 1;
}
bool read_bytes(std::vector<char>& bytes) {
    std::uint32_t size = 0;
    if (!read_as(size)) {
        return false;
    }
    bytes.resize(size);
    return std::fread(bytes.data(), 1, size, stdin) == size;
}
template <typename T>
void write_as(const T& value) {
    std::fwrite(&value, sizeof(value), 1, stdout);
}
void write_bytes(std::string_view bytes) {
    write_as(static_cast<std::uint32_t>(bytes.size()));
    std::fwrite(bytes.data(), 1, bytes.size(), stdout);
}

// Of a player who lies on a wall by jets, with the head down: both hands are before it, where they
// close and open again and again.
hh_tracking_sample hands_at(double t_s) {
    hh_tracking_sample sample = hh::sample();
    sample.head.position = {0.0, 1.6, 0.0};
    const double phase = t_s - static_cast<double>(static_cast<long long>(t_s));
    const double wave = 0.1 * (phase < 0.5 ? phase : 1.0 - phase);
    for (const hh_side side : {HH_LEFT, HH_RIGHT}) {
        const double out = side == HH_LEFT ? -0.25 : 0.25;
        sample.hands[side].position = {out, 1.4 + wave, -0.35 + wave};
        sample.grab[side] = phase > 0.3 ? 1 : 0;
    }
    return sample;
}

PeerReport report(std::uint64_t gripping) {
    PeerReport out;
    out.stage = page_stage();
    out.states = page_states();
    out.gripping = gripping;
    if (page_match() == nullptr) {
        return out;
    }
    hh_match_stats stats = hh_default_match_stats();
    hh_match_get_stats(page_match(), &stats);
    out.ticks = stats.ticks;
    out.rollbacks = stats.rollbacks;
    out.hash_tick = stats.confirmed / k_hash_ticks * k_hash_ticks;
    if (hh_match_hash(page_match(), out.hash_tick, &out.hash) != HH_OK) {
        out.hash = 0;
    }
    return out;
}

bool grips() {
    hh_player player{};
    page_player(page_slot(), &player);
    hh_player_pose pose{};
    hh_world_player_poses(page_world(), &player, 1, &pose);
    return pose.hands[0].grip != HH_GRIP_NONE || pose.hands[1].grip != HH_GRIP_NONE;
}

void poll(double now_s, std::uint64_t& gripping) {
    static const double begin_s = now_s;
    const hh_tracking_sample sample = hands_at(now_s - begin_s);
    hh_match_input input = hh_default_match_input();
    input.samples = &sample;
    input.sample_count = 1;
    input.commands.thrust.y = -1.0;
    if (page_poll(now_s, &input, 0) < 0) {
        std::fprintf(stderr, "%s\n", page_why());
        std::exit(1);
    }
    constexpr std::uint32_t k_playing = 3;
    gripping += page_stage() == k_playing && grips() ? 1U : 0U;
    constexpr std::uint32_t k_ended = 4;
    static bool is_told = false;
    if (page_stage() == k_ended && !std::exchange(is_told, true)) {
        std::fprintf(stderr, "%s\n", page_why());
    }
    std::vector<std::vector<char>> kept;
    const void* message = nullptr;
    for (std::size_t size = page_next_message(&message); size > 0;
         size = page_next_message(&message)) {
        const char* const bytes = static_cast<const char*>(message);
        kept.emplace_back(bytes, bytes + size);
    }
    write_as(static_cast<std::uint32_t>(kept.size()));
    for (const std::vector<char>& one : kept) {
        write_bytes({one.data(), one.size()});
    }
    write_as(report(gripping));
}

}  // namespace
}  // namespace handhold

int main(int count, char** words) {
    using namespace handhold;
    if (count != 2) {
        std::fprintf(stderr, "usage: handhold-match-peer PERSON\n");
        return 2;
    }
    const std::uint64_t person = std::strtoull(words[1], nullptr, 10);
#ifdef _WIN32
    _setmode(_fileno(stdin), _O_BINARY);
    _setmode(_fileno(stdout), _O_BINARY);
#endif
    std::uint64_t gripping = 0;
    std::vector<char> bytes;
    double now_s = 0.0;
    for (char request = 0; read_as(request);) {
        if (request == 'L' && read_bytes(bytes)) {
            const char* const why = page_load(bytes.data(), bytes.size());
            write_bytes(why == nullptr ? "" : why);
        } else if (request == 'C' && read_as(now_s)) {
            page_connect(person, "", now_s);
        } else if (request == 'M' && read_bytes(bytes)) {
            page_receive(bytes.data(), bytes.size());
        } else if (request == 'P' && read_as(now_s)) {
            poll(now_s, gripping);
        } else {
            return 1;
        }
        std::fflush(stdout);
    }
    return 0;
}
