#include <algorithm>
#include <vector>

#include "game/net/net_messages.hpp"
#include "tests/fuzz/promise.hpp"

namespace handhold::fuzz {
namespace {

// What was read is written as the same bytes again; of another version only that is known.
template <typename Message>
int promise_round_trip(const std::optional<Message>& read, std::span<const std::byte> message) {
    if (!read) {
        return 0;
    }
    if constexpr (requires { read->version; }) {
        if (read->version != k_net_version) {
            return 1;
        }
    }
    std::vector<std::byte> again;
    write_message(*read, again);
    promise(std::ranges::equal(again, message), "a message is written as it was read");
    return 1;
}

}  // namespace

// A message between servers and peers of a match.
void run_net(Bytes bytes) {
    const std::span<const std::byte> message = std::as_bytes(bytes);
    int kinds = promise_round_trip(read_offer(message), message);
    kinds += promise_round_trip(read_hello(message), message);
    kinds += promise_round_trip(read_welcome(message), message);
    kinds += promise_round_trip(read_state_piece(message), message);
    kinds += promise_round_trip(read_bye(message), message);
    const std::optional<MatchRefused> refused = read_refused(message);
    kinds += promise_round_trip(refused, message);
    kinds += read_joined(message) ? 1 : 0;
    promise(kinds <= 1, "a message has one kind");
    promise(kinds == 0 || kind_of(message).has_value(), "what is read has a kind");
    promise(!refused || !refusal_text(*refused).empty(), "a refusal says why");
}

}  // namespace handhold::fuzz
