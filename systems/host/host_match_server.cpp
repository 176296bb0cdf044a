// Servers of matches (handhold/match.h).
#include <cmath>
#include <cstring>

#include "systems/host/host_match_packets.hpp"
#include "systems/host/host_step.hpp"

namespace handhold {
namespace {

double clock_of(double now_s) {
    require(std::isfinite(now_s), HH_ERROR_VALUE, "now_s is not a number");
    return now_s;
}

}  // namespace

const char* refusal_text(MatchRefusal refusal) {
    switch (refusal) {
        case MatchRefusal::size:
            return "the packet is shorter than any, or longer";
        case MatchRefusal::checksum:
            return "the packet is damaged";
        case MatchRefusal::version:
            return "the packet is of another version, or of another kind";
        case MatchRefusal::sender:
            return "the packet is of another slot, or of one that is not connected";
        default:
            return "the packet has fields that are out of range";
    }
}

}  // namespace handhold

using namespace handhold;

hh_result hh_match_connect(hh_match* match, uint32_t slot) {
    return call([&] { server_of(match).connect(slot_of(*match, slot)); });
}

hh_result hh_match_disconnect(hh_match* match, uint32_t slot) {
    return call([&] { server_of(match).disconnect(slot_of(*match, slot)); });
}

hh_result hh_match_receive_from(hh_match* match, uint32_t slot, double now_s, const void* packet,
                                size_t size) {
    return call([&] {
        ServerSession& server = server_of(match);
        const std::size_t from = slot_of(*match, slot);
        const double at_s = clock_of(now_s);
        take_packet(packet, size, [&](std::span<const std::byte> bytes) {
            return server.receive(from, bytes, at_s);
        });
    });
}

hh_result hh_match_confirm(hh_match* match, double now_s, uint32_t* ticks) {
    return call([&] {
        ServerSession& server = server_of(match);
        const double at_s = clock_of(now_s);
        const MatchTick before = server.confirmed();
        match->events.clear();
        server.advance(at_s);
        if (ticks != nullptr) {
            *ticks = static_cast<std::uint32_t>(server.confirmed() - before);
        }
    });
}

hh_result hh_match_packet_to(hh_match* match, uint32_t slot, void* buffer, size_t capacity,
                             size_t* size) {
    return call([&] {
        ServerSession& server = server_of(match);
        const std::size_t to = slot_of(*match, slot);
        give_packet(buffer, capacity, size,
                    [&](std::span<std::byte> bytes) { return server.write_packet(to, bytes); });
    });
}

hh_result hh_match_state(hh_match* match, uint32_t slot, void* buffer, size_t capacity,
                         size_t* size) {
    return call([&] {
        ServerSession& server = server_of(match);
        const bool has_slot = slot != HH_MATCH_NO_SLOT;
        const std::size_t to = has_slot ? slot_of(*match, slot) : 0;
        require(size != nullptr, HH_ERROR_NULL, "the size is null");
        const SnapshotAssets& assets = assets_of(match->host);
        if (has_slot) {
            server.preview_state(to, assets, match->state);
        } else {
            server.write_state_to_watch(assets, match->state);
        }
        *size = match->state.size();
        if (buffer != nullptr) {
            require(match->state.size() <= capacity, HH_ERROR_CAPACITY, "the buffer is too small");
            if (has_slot) {
                server.write_state(to, assets, match->state);
            }
            std::memcpy(buffer, match->state.data(), match->state.size());
        }
    });
}

hh_result hh_match_confirmed_inputs(const hh_match* match, uint64_t after, void* buffer,
                                    size_t capacity, size_t* size, uint64_t* until) {
    return call([&] {
        const hh_match& of_host = match_of(match);
        require(of_host.sync == nullptr, HH_ERROR_STATE, "a sync test confirms nothing");
        require(size != nullptr && until != nullptr, HH_ERROR_NULL, "an output is null");
        *size = HH_MATCH_INPUTS_BYTES;
        if (buffer == nullptr) {
            return;
        }
        const auto write = [&](const auto& session) {
            require(session.can_write_after(after), HH_ERROR_VALUE,
                    "the inputs after this tick are not kept");
            require(capacity >= HH_MATCH_INPUTS_BYTES, HH_ERROR_CAPACITY,
                    "the buffer is too small");
            MatchTick last = after;
            *size = session.write_watched(
                after, last,
                std::span(static_cast<std::byte*>(buffer), std::size_t{HH_MATCH_INPUTS_BYTES}));
            *until = last;
        };
        if (of_host.server != nullptr) {
            write(*of_host.server);
        } else if (of_host.client != nullptr) {
            write(*of_host.client);
        } else {
            write(*of_host.spectator);
        }
    });
}
