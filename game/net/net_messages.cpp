#include "game/net/net_messages.hpp"

#include <algorithm>
#include <utility>

#include <handhold/match.h>

namespace handhold {
namespace {

constexpr std::uint32_t k_net_magic = 0x314e4848;  // "HHN1"

class NetWriter {
  public:
    NetWriter(NetKind kind, std::vector<std::byte>& bytes) : bytes_(bytes) {
        bytes_.assign(1, static_cast<std::byte>(kind));
    }
    // The lowest byte first.
    void put(std::uint64_t value, std::size_t size) {
        for (std::size_t i = 0; i < size; ++i) {
            bytes_.push_back(static_cast<std::byte>((value >> (8 * i)) & 0xffU));
        }
    }
    void put_text(std::string_view text) {
        put(text.size(), 2);
        const auto bytes = std::as_bytes(std::span(text.data(), text.size()));
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    }
    void put_digests(const MatchDigests& digests) {
        for (const std::uint64_t digest : digests) {
            put(digest, 8);
        }
    }

  private:
    std::vector<std::byte>& bytes_;
};

class NetReader {
  public:
    NetReader(NetKind kind, std::span<const std::byte> message) : left_(message) {
        has_failed_ = take(1) != static_cast<std::uint64_t>(kind);
    }
    std::uint64_t take(std::size_t size) {
        if (has_failed_ || left_.size() < size) {
            has_failed_ = true;
            return 0;
        }
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < size; ++i) {
            value |= std::to_integer<std::uint64_t>(left_[i]) << (8 * i);
        }
        left_ = left_.subspan(size);
        return value;
    }
    template <typename Integer>
    Integer take_as() {
        return static_cast<Integer>(take(sizeof(Integer)));
    }
    std::string take_text() {
        const auto size = take_as<std::uint16_t>();
        has_failed_ = has_failed_ || size > k_most_text_bytes || size > left_.size();
        if (has_failed_) {
            return {};
        }
        std::string text(size, '\0');
        std::ranges::transform(left_.first(size), text.begin(),
                               [](std::byte byte) { return static_cast<char>(byte); });
        left_ = left_.subspan(size);
        return text;
    }
    void take_digests(MatchDigests& digests) {
        for (std::uint64_t& digest : digests) {
            digest = take_as<std::uint64_t>();
        }
    }
    std::span<const std::byte> take_rest() { return std::exchange(left_, {}); }
    void expect(bool is_right) { has_failed_ = has_failed_ || !is_right; }
    bool is_at_end() const { return !has_failed_ && left_.empty(); }
    bool has_failed() const { return has_failed_; }

  private:
    std::span<const std::byte> left_;
    bool has_failed_ = false;
};

// A number of an enumeration whose values are 1 to `last`.
template <typename Enum>
Enum take_enum(NetReader& in, Enum last) {
    const auto value = in.take_as<std::uint8_t>();
    in.expect(value >= 1 && value <= static_cast<std::uint8_t>(last));
    return static_cast<Enum>(value);
}

bool take_bool(NetReader& in) {
    const auto value = in.take_as<std::uint8_t>();
    in.expect(value <= 1);
    return value == 1;
}

}  // namespace

std::string_view digest_name(std::size_t digest) {
    constexpr std::array<std::string_view, k_match_digests> k_names = {
        "library", "scene", "tick", "tuning", "clips", "bodies", "shapes"};
    return digest < k_names.size() ? k_names[digest] : "something else";
}

std::optional<std::size_t> first_difference(const MatchDigests& a, const MatchDigests& b) {
    for (std::size_t i = 0; i < k_match_digests; ++i) {
        if (a[i] != b[i]) {
            return i;
        }
    }
    return std::nullopt;
}

std::string refusal_text(const MatchRefused& refused) {
    switch (refused.reason) {
        case NetRefusal::version:
            return "other version: the server speaks " + std::to_string(refused.detail) +
                   ", this program " + std::to_string(k_net_version);
        case NetRefusal::level:
            return "other level: \"" + std::string(digest_name(refused.detail)) + "\" differs";
        case NetRefusal::full:
            return "the match is full";
        case NetRefusal::no_token:
            return "the server wants a token (--token)";
        case NetRefusal::bad_token:
            return "the token is not one of this server";
        case NetRefusal::expired_token:
            return "the token has expired";
        case NetRefusal::draining:
            return "the server is shutting down";
        case NetRefusal::busy:
            return "too many join at once: try again";
        case NetRefusal::malformed:
            break;
    }
    return "the server did not understand";
}

std::string_view bye_text(NetBye bye) {
    switch (bye) {
        case NetBye::leaving:
            return "the player has left";
        case NetBye::draining:
            return "the server is shutting down";
        case NetBye::replaced:
            return "the same person has joined from elsewhere";
        case NetBye::silent:
            return "the server has heard no input for long";
        case NetBye::late:
            break;
    }
    return "the state was not restored in time";
}

std::optional<NetKind> kind_of(std::span<const std::byte> message) {
    const auto value = message.empty() ? 0U : std::to_integer<unsigned>(message[0]);
    if ((value >= 1 && value <= 8) || value == 16 || value == 17) {
        return static_cast<NetKind>(value);
    }
    return std::nullopt;
}

void write_packet_message(std::span<const std::byte> packet, std::vector<std::byte>& message) {
    const NetWriter out(NetKind::packet, message);
    message.insert(message.end(), packet.begin(), packet.end());
}

void write_inputs_message(std::span<const std::byte> inputs, std::vector<std::byte>& message) {
    const NetWriter out(NetKind::inputs, message);
    message.insert(message.end(), inputs.begin(), inputs.end());
}

void write_message(const MatchOffer& offer, std::vector<std::byte>& message) {
    NetWriter out(NetKind::offer, message);
    out.put(k_net_magic, 4);
    out.put(offer.version, 2);
    out.put(offer.players, 1);
    out.put(offer.seed, 8);
    out.put(offer.wants_token ? 1 : 0, 1);
    out.put_digests(offer.digests);
    out.put_text(offer.scene);
}

std::optional<MatchOffer> read_offer(std::span<const std::byte> message) {
    NetReader in(NetKind::offer, message);
    in.expect(in.take(4) == k_net_magic);
    MatchOffer offer;
    offer.version = in.take_as<std::uint16_t>();
    if (!in.has_failed() && offer.version != k_net_version) {
        return offer;
    }
    offer.players = in.take_as<std::uint8_t>();
    in.expect(offer.players >= 1 && offer.players <= HH_MATCH_PLAYERS);
    offer.seed = in.take_as<std::uint64_t>();
    offer.wants_token = take_bool(in);
    in.take_digests(offer.digests);
    offer.scene = in.take_text();
    return in.is_at_end() ? std::optional(offer) : std::nullopt;
}

void write_message(const MatchHello& hello, std::vector<std::byte>& message) {
    NetWriter out(NetKind::hello, message);
    out.put(k_net_magic, 4);
    out.put(hello.version, 2);
    out.put(hello.person, 8);
    out.put((hello.watches ? 1U : 0U) + (hello.unpacks ? 2U : 0U), 1);
    out.put_digests(hello.digests);
    out.put_text(hello.token);
}

std::optional<MatchHello> read_hello(std::span<const std::byte> message) {
    NetReader in(NetKind::hello, message);
    in.expect(in.take(4) == k_net_magic);
    MatchHello hello;
    hello.version = in.take_as<std::uint16_t>();
    if (!in.has_failed() && hello.version != k_net_version) {
        return hello;
    }
    hello.person = in.take_as<std::uint64_t>();
    const auto flags = in.take_as<std::uint8_t>();
    in.expect(flags <= 3);
    hello.watches = (flags & 1U) != 0;
    hello.unpacks = (flags & 2U) != 0;
    in.take_digests(hello.digests);
    hello.token = in.take_text();
    return in.is_at_end() ? std::optional(hello) : std::nullopt;
}

void write_message(const MatchRefused& refused, std::vector<std::byte>& message) {
    NetWriter out(NetKind::refused, message);
    out.put(static_cast<std::uint64_t>(refused.reason), 1);
    out.put(refused.detail, 2);
}

std::optional<MatchRefused> read_refused(std::span<const std::byte> message) {
    NetReader in(NetKind::refused, message);
    MatchRefused refused;
    refused.reason = take_enum(in, NetRefusal::busy);
    refused.detail = in.take_as<std::uint16_t>();
    return in.is_at_end() ? std::optional(refused) : std::nullopt;
}

void write_message(const MatchWelcome& welcome, std::vector<std::byte>& message) {
    NetWriter out(NetKind::welcome, message);
    out.put(welcome.slot, 1);
}

std::optional<MatchWelcome> read_welcome(std::span<const std::byte> message) {
    NetReader in(NetKind::welcome, message);
    const MatchWelcome welcome{in.take_as<std::uint8_t>()};
    return in.is_at_end() ? std::optional(welcome) : std::nullopt;
}

void write_message(const StatePiece& piece, std::vector<std::byte>& message) {
    NetWriter out(piece.is_packed ? NetKind::packed : NetKind::state, message);
    out.put(piece.number, 1);
    out.put(piece.total, 4);
    out.put(piece.offset, 4);
    message.insert(message.end(), piece.bytes.begin(), piece.bytes.end());
}

std::optional<StatePiece> read_state_piece(std::span<const std::byte> message) {
    StatePiece piece;
    piece.is_packed = kind_of(message) == NetKind::packed;
    NetReader in(piece.is_packed ? NetKind::packed : NetKind::state, message);
    piece.number = in.take_as<std::uint8_t>();
    piece.total = in.take_as<std::uint32_t>();
    piece.offset = in.take_as<std::uint32_t>();
    piece.bytes = in.take_rest();
    in.expect(!piece.bytes.empty() && piece.bytes.size() <= StatePiece::k_most_bytes &&
              piece.total <= StatePiece::k_most_total && piece.offset <= piece.total &&
              piece.bytes.size() <= piece.total - piece.offset);
    return in.is_at_end() ? std::optional(piece) : std::nullopt;
}

void write_message(NetBye bye, std::vector<std::byte>& message) {
    NetWriter out(NetKind::bye, message);
    out.put(static_cast<std::uint64_t>(bye), 1);
}

std::optional<NetBye> read_bye(std::span<const std::byte> message) {
    NetReader in(NetKind::bye, message);
    const NetBye bye = take_enum(in, NetBye::late);
    return in.is_at_end() ? std::optional(bye) : std::nullopt;
}

void write_joined(std::uint8_t number, std::vector<std::byte>& message) {
    NetWriter out(NetKind::joined, message);
    out.put(number, 1);
}

std::optional<std::uint8_t> read_joined(std::span<const std::byte> message) {
    NetReader in(NetKind::joined, message);
    const auto number = in.take_as<std::uint8_t>();
    return in.is_at_end() ? std::optional(number) : std::nullopt;
}

}  // namespace handhold
