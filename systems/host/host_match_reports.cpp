// What the events of the next step depend on besides the world: kept for rollback, and sent to
// players who join a match.
#include <bit>
#include <cstring>

#include "systems/host/host_match.hpp"

namespace handhold {
namespace {

constexpr std::uint32_t k_most_reported = 1U << 20U;

void put_number(std::uint32_t value, std::vector<std::byte>& bytes) {
    for (unsigned i = 0; i < 4; ++i) {
        bytes.push_back(static_cast<std::byte>((value >> (8 * i)) & 0xffU));
    }
}
void put_entity(Entity entity, std::vector<std::byte>& bytes) {
    put_number(entity.slot, bytes);
    put_number(entity.generation, bytes);
}

// Reads numbers; zeros, and is_bad, beyond the end.
class NumberReader {
  public:
    explicit NumberReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

    std::uint32_t take() {
        if (bytes_.size() < 4) {
            is_bad_ = true;
            return 0;
        }
        std::uint32_t value = 0;
        for (unsigned i = 0; i < 4; ++i) {
            value |= std::to_integer<std::uint32_t>(bytes_[i]) << (8 * i);
        }
        bytes_ = bytes_.subspan(4);
        return value;
    }
    Entity take_entity() {
        const std::uint32_t slot = take();
        return {slot, take()};
    }
    // The length of a list whose elements have so many bytes, which are there.
    std::size_t take_count(std::size_t element_bytes) {
        const std::uint32_t count = take();
        if (count > k_most_reported || count * element_bytes > bytes_.size()) {
            is_bad_ = true;
            return 0;
        }
        return count;
    }
    bool is_good_at_end() const { return !is_bad_ && bytes_.empty(); }

  private:
    std::span<const std::byte> bytes_;
    bool is_bad_ = false;
};

}  // namespace

void keep_reports(const hh_world& host, EventReports& kept) {
    kept.hands = host.hands;
    kept.joints = host.joints;
    kept.spaces = host.spaces;
    kept.contacts = host.contacts;
}

void restore_reports(const EventReports& kept, hh_world& host) {
    host.hands = kept.hands;
    host.joints = kept.joints;
    host.spaces = kept.spaces;
    host.contacts = kept.contacts;
}

void write_reports(const hh_world& host, std::vector<std::byte>& bytes) {
    put_number(static_cast<std::uint32_t>(host.hands.size()), bytes);
    for (std::size_t i = 0; i < host.hands.size(); ++i) {
        put_entity(host.hands.owners()[i], bytes);
        put_entity(host.hands.elements()[i].touched, bytes);
    }
    std::vector<Entity> at_limit;
    for (std::size_t i = 0; i < host.joints.size(); ++i) {
        if (host.joints.elements()[i].at_limit) {
            at_limit.push_back(host.joints.owners()[i]);
        }
    }
    put_number(static_cast<std::uint32_t>(at_limit.size()), bytes);
    for (const Entity joint : at_limit) {
        put_entity(joint, bytes);
    }
    put_number(static_cast<std::uint32_t>(host.contacts.size()), bytes);
    for (const HostContact& contact : host.contacts) {
        put_entity(contact.player, bytes);
        put_number(std::bit_cast<std::uint32_t>(contact.side), bytes);
        put_entity(contact.held, bytes);
        put_entity(contact.other, bytes);
    }
}

std::optional<JoinedReports> read_reports(std::span<const std::byte> bytes) {
    constexpr std::size_t k_entity_bytes = 8;
    NumberReader in(bytes);
    JoinedReports out;
    for (std::size_t left = in.take_count(2 * k_entity_bytes); left > 0; --left) {
        const Entity hand = in.take_entity();
        out.touched.push_back({hand, in.take_entity()});
    }
    for (std::size_t left = in.take_count(k_entity_bytes); left > 0; --left) {
        out.at_limit.push_back(in.take_entity());
    }
    for (std::size_t left = in.take_count(3 * k_entity_bytes + 4); left > 0; --left) {
        HostContact contact;
        contact.player = in.take_entity();
        contact.side = std::bit_cast<std::int32_t>(in.take());
        contact.held = in.take_entity();
        contact.other = in.take_entity();
        out.contacts.push_back(contact);
    }
    return in.is_good_at_end() ? std::optional(std::move(out)) : std::nullopt;
}

void add_reports(const JoinedReports& joined, hh_world& host) {
    for (const auto& [hand, touched] : joined.touched) {
        if (HandReport* const report = host.hands.find(hand)) {
            report->touched = host.world.entities.is_alive(touched) ? touched : k_no_entity;
        }
    }
    for (JointReport& report : host.joints.elements()) {
        report.at_limit = false;
    }
    for (const Entity joint : joined.at_limit) {
        if (JointReport* const report = host.joints.find(joint)) {
            report->at_limit = true;
        }
    }
    for (const HostContact& contact : joined.contacts) {
        if (host.world.player.contains(contact.player) && contact.side >= -1 && contact.side <= 1) {
            host.contacts.push_back(contact);
        }
    }
}

}  // namespace handhold
