#include "systems/physics/find_contacts.hpp"

#include <algorithm>

namespace handhold {
namespace {

bool is_held_by(const FindContactsIo& io, Entity player, Entity body) {
    for (std::size_t row = 0; row < io.grab.size(); ++row) {
        const Grab& grab = io.grab.rows()[row];
        if (grab.kind == GripKind::held && grab.body == body &&
            io.owner.at(io.grab.owners()[row]).player == player) {
            return true;
        }
    }
    return false;
}

IgnoredPair pair_of(std::uint64_t x, std::uint64_t y) { return {std::min(x, y), std::max(x, y)}; }

bool touches(const std::vector<ContactPoint>& contacts, const IgnoredPair& pair) {
    return std::any_of(contacts.begin(), contacts.end(), [&pair](const ContactPoint& contact) {
        return pair_of(contact.id_a, contact.id_b) == pair;
    });
}

// Drops what is apart; what stays is listed in frame.ignored.
void update_ignores(const FindContactsIo& io) {
    io.frame.ignored.clear();
    for (std::size_t row = 0; row < io.head_ignores.size(); ++row) {
        const Entity player = io.head_ignores.owners()[row];
        const std::uint64_t player_id = io.persistent_id.at(player).value;
        for (Entity& body : io.head_ignores.rows()[row].bodies) {
            const PersistentId* const id = io.persistent_id.find(body);
            if (id == nullptr) {
                body = k_no_entity;
                continue;
            }
            const IgnoredPair pair = pair_of(player_id, id->value);
            if (is_held_by(io, player, body) || touches(io.frame.contacts, pair)) {
                io.frame.ignored.push_back(pair);
            } else {
                body = k_no_entity;
            }
        }
    }
    std::sort(io.frame.ignored.begin(), io.frame.ignored.end());
}

}  // namespace

void find_contacts(const FindContactsIo& io, const ContactTuning& tuning) {
    io.collision.set_ignored_pairs({});
    io.collision.find_contacts({tuning.margin_m, tuning.sweep_m}, io.frame.contacts);
    update_ignores(io);
    io.collision.set_ignored_pairs(io.frame.ignored);
    std::erase_if(io.frame.contacts, [&io](const ContactPoint& contact) {
        return std::binary_search(io.frame.ignored.begin(), io.frame.ignored.end(),
                                  pair_of(contact.id_a, contact.id_b));
    });
}

}  // namespace handhold
