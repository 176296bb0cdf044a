#include <optional>
#include <string>

#include "game/arena/arena_match.hpp"
#include "game/net/match_recording.hpp"
#include "game/net/match_replay.hpp"
#include "systems/match/match_messages.hpp"
#include "tests/fuzz/match_bed.hpp"

namespace handhold::fuzz {
namespace {

// A changed packet gets the checksum that it should have, so that its content is read.
void seal_packet(FuzzBytes& packet) {
    constexpr std::size_t k_sum_bytes = 4;
    if (packet.size() < k_sum_bytes) {
        return;
    }
    const std::size_t content = packet.size() - k_sum_bytes;
    const std::uint32_t sum = match_checksum(std::span(packet).first(content));
    for (std::size_t i = 0; i < k_sum_bytes; ++i) {
        packet[content + i] = static_cast<std::byte>((sum >> (8 * i)) & 0xffU);
    }
}

// The checksum of a join state covers its inputs, whose size is in it.
void seal_state(FuzzBytes& state) {
    constexpr std::size_t k_header = 24;
    if (state.size() < k_header) {
        return;
    }
    const auto number_at = [&](std::size_t at) {
        std::size_t value = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            value |= std::to_integer<std::size_t>(state[at + i]) << (8 * i);
        }
        return value;
    };
    const std::size_t inputs = number_at(4) + number_at(20);
    if (inputs > state.size() - k_header) {
        return;
    }
    const std::uint32_t sum = match_checksum(std::span(state).subspan(16, k_header - 16 + inputs));
    for (std::size_t i = 0; i < 4; ++i) {
        state[12 + i] = static_cast<std::byte>((sum >> (8 * i)) & 0xffU);
    }
}

// Machines live for some inputs, then new ones take their place.
class Machines {
  public:
    void count() {
        constexpr int k_most_uses = 64;
        if (++uses_ > k_most_uses) {
            uses_ = 0;
            server_.reset();
            client_.reset();
            watcher_.reset();
        }
    }
    hh::Match& server() {
        if (!server_) {
            server_.emplace(HH_MATCH_SERVER);
            for (std::uint32_t slot = 0; slot < k_bed_players; ++slot) {
                (void)server_->match.connect(slot);
            }
            (void)server_->match.confirm(0.5);
            (void)server_->match.confirm(1.0);
        }
        return server_->match;
    }
    hh::Match& client() { return get(client_, HH_MATCH_CLIENT); }
    hh::Match& watcher() { return get(watcher_, HH_MATCH_SPECTATOR); }

  private:
    static hh::Match& get(std::optional<BedMachine>& machine, hh_match_role role) {
        if (!machine) {
            machine.emplace(role);
        }
        return machine->match;
    }
    int uses_ = 0;
    std::optional<BedMachine> server_;
    std::optional<BedMachine> client_;
    std::optional<BedMachine> watcher_;
};

void play_on(hh::Match& match, int ticks) {
    for (int i = 0; i < ticks; ++i) {
        hh_match_input input = hh::match_input({});
        input.is_hidden = 1;
        (void)match.advance(input);
    }
}

void put_at(FuzzBytes& bytes, std::size_t at, std::uint64_t value, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) {
        bytes[at + i] = static_cast<std::byte>((value >> (8 * i)) & 0xffU);
    }
}

constexpr std::size_t k_file_begin = 8;   // magic and version
constexpr std::size_t k_part_begin = 13;  // kind, size, checksum

// Fixes the checksum of each part of a recording.
void seal_recording(FuzzBytes& file) {
    std::size_t at = k_file_begin;
    while (at + k_part_begin <= file.size()) {
        std::size_t size = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            size |= std::to_integer<std::size_t>(file[at + 1 + i]) << (8 * i);
        }
        if (size > file.size() - at - k_part_begin) {
            return;
        }
        std::uint64_t sum = 0xcbf29ce484222325ULL;
        for (std::size_t i = 0; i < 5 + size; ++i) {
            const std::byte byte = file[at + (i < 5 ? i : i + 8)];
            sum = (sum ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3ULL;
        }
        put_at(file, at + 5, sum, 8);
        at += k_part_begin + size;
    }
}

void add_part(RecordedKind kind, const FuzzBytes& bytes, FuzzBytes& file) {
    const std::size_t at = file.size();
    file.resize(at + k_part_begin);
    file[at] = static_cast<std::byte>(kind);
    put_at(file, at + 1, bytes.size(), 4);
    file.insert(file.end(), bytes.begin(), bytes.end());
}

FuzzBytes make_recording(const BedMessages& bed) {
    FuzzBytes file(k_file_begin);
    std::ranges::copy(std::as_bytes(std::span("HHMR", 4)), file.begin());
    put_at(file, 4, 1, 4);
    FuzzBytes level;
    write_message(MatchOffer{.players = k_bed_players, .digests = {}, .scene = "bed"}, level);
    add_part(RecordedKind::level, level, file);
    for (const FuzzBytes& inputs : bed.of_watched) {
        add_part(RecordedKind::inputs, inputs, file);
    }
    add_part(RecordedKind::state, bed.states[1], file);
    add_part(RecordedKind::end, FuzzBytes(16), file);
    seal_recording(file);
    promise(parse_match_recording(file, "bed").ok(), "the bed's recording is one");
    return file;
}

void play_recording(FuzzBytes bytes) {
    const Result<MatchRecording> recording = parse_match_recording(std::move(bytes), "fuzz");
    if (!recording) {
        promise(!recording.error().message().empty(), "a refusal says why");
        return;
    }
    BedWorld bed;
    MatchReplay replay(bed.world, bed.players, nullptr, recording.value(), 1.0 / 90.0);
    for (int i = 0; i < 200; ++i) {
        const Result<bool> stepped = replay.step(false);
        if (!stepped || !stepped.value()) {
            return;
        }
    }
}

// Rules of any numbers are read as they were written, and refused with a byte changed.
void try_rules(Bytes bytes) {
    (void)split_join_state(std::as_bytes(bytes), true);
    const auto number_at = [&](std::size_t at, std::size_t size) {
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < size && at + i < bytes.size(); ++i) {
            value |= static_cast<std::uint64_t>(bytes[at + i]) << (8 * i);
        }
        return value;
    };
    ArenaState rules;
    rules.score = {static_cast<std::uint32_t>(number_at(0, 4)),
                   static_cast<std::uint32_t>(number_at(4, 4))};
    rules.goal_tick = number_at(8, 8);
    rules.reset_tick = number_at(16, 8);
    FuzzBytes written;
    write_arena_state(rules, written);
    promise(read_arena_state(written) == rules, "rules are read as they were written");
    const auto change = static_cast<std::byte>(number_at(25, 1));
    written[number_at(24, 1) % written.size()] ^= change;
    promise(change == std::byte{} || !read_arena_state(written), "changed rules are refused");
}

}  // namespace

// The first byte says what the rest is, the second one which example is changed; 255: none, the
// rest is the message.
void run_match(Bytes bytes) {
    if (bytes.size() < 2) {
        return;
    }
    static Machines machines;
    const BedMessages& bed = BedMessages::get();
    const Bytes rest = bytes.subspan(2);
    const auto changed = [&](const std::vector<FuzzBytes>& examples) {
        const auto raw = std::as_bytes(rest);
        return bytes[1] == 255 ? FuzzBytes(raw.begin(), raw.end())
                               : patched_bytes(BedMessages::pick(examples, bytes[1]), rest);
    };
    machines.count();
    const int kind = bytes[0] % 6;
    if (kind == 0) {
        FuzzBytes packet = changed(bed.of_clients);
        seal_packet(packet);
        (void)machines.server().receive_from(bytes[1] % k_bed_players, 1.0, packet);
        (void)machines.server().confirm(1.05);
    } else if (kind == 1) {
        FuzzBytes packet = changed(bed.of_server);
        seal_packet(packet);
        (void)machines.client().receive(packet);
        play_on(machines.client(), 2);
    } else if (kind == 2) {
        FuzzBytes packet = changed(bed.of_watched);
        seal_packet(packet);
        (void)machines.watcher().receive(packet);
        play_on(machines.watcher(), 4);
    } else if (kind == 3) {
        FuzzBytes state = changed(bed.states);
        seal_state(state);
        hh::Match& joins = bytes[1] % 2 == 0 ? machines.client() : machines.watcher();
        (void)joins.join(state);
        play_on(joins, 2);
    } else if (kind == 4) {
        static const std::vector<FuzzBytes> k_recordings = {make_recording(bed)};
        FuzzBytes file = changed(k_recordings);
        seal_recording(file);
        play_recording(std::move(file));
    } else {
        try_rules(rest);
    }
}

}  // namespace handhold::fuzz
