#include "systems/physics/find_contacts.hpp"

#include <algorithm>

namespace handhold {
namespace {

// True if the player holds the body, or a body that joints connect to it.
bool is_held_by(const FindContactsIo& io, Entity player, Entity body) {
    const std::size_t body_index = io.body.find_index(body);
    for (std::size_t index = 0; index < io.grab.size(); ++index) {
        const Grab& grab = io.grab.elements()[index];
        if (grab.kind != GripKind::held || io.owner.at(io.grab.owners()[index]).player != player) {
            continue;
        }
        const std::size_t held_index = io.body.find_index(grab.body);
        if (held_index != Column<RigidBody>::k_npos && body_index != Column<RigidBody>::k_npos &&
            io.frame.joint_groups.share_group(body_index, held_index)) {
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

// Adds the pairs of a player's head with a body and with all bodies that joints connect to it.
void ignore_group(const FindContactsIo& io, std::uint64_t player_id, Entity body) {
    const JointGroups& groups = io.frame.joint_groups;
    if (groups.of_body.empty()) {
        io.frame.ignored.push_back(pair_of(player_id, io.persistent_id.at(body).value));
        return;
    }
    const std::size_t index = io.body.find_index(body);
    for (std::size_t other = 0; other < io.body.size(); ++other) {
        if (groups.share_group(index, other)) {
            const Entity entity = io.body.owners()[other];
            io.frame.ignored.push_back(pair_of(player_id, io.persistent_id.at(entity).value));
        }
    }
}

bool touches_group(const FindContactsIo& io, std::uint64_t player_id, Entity body) {
    const std::size_t before = io.frame.ignored.size();
    ignore_group(io, player_id, body);
    bool touched = false;
    for (std::size_t i = before; i < io.frame.ignored.size() && !touched; ++i) {
        touched = touches(io.frame.contacts, io.frame.ignored[i]);
    }
    io.frame.ignored.resize(before);
    return touched;
}

// Removes bodies that are released and clear of the head; the others' pairs are added to
// frame.ignored.
void update_ignores(const FindContactsIo& io) {
    for (std::size_t index = 0; index < io.head_ignores.size(); ++index) {
        const Entity player = io.head_ignores.owners()[index];
        const std::uint64_t player_id = io.persistent_id.at(player).value;
        for (Entity& body : io.head_ignores.elements()[index].bodies) {
            if (!io.body.contains(body)) {
                body = k_no_entity;
                continue;
            }
            if (is_held_by(io, player, body) || touches_group(io, player_id, body)) {
                ignore_group(io, player_id, body);
            } else {
                body = k_no_entity;
            }
        }
    }
    std::sort(io.frame.ignored.begin(), io.frame.ignored.end());
}

// Jointed bodies do not touch each other, unless Joint::collides.
void ignore_jointed(const FindContactsIo& io) {
    io.frame.ignored.clear();
    for (const Joint& joint : io.joint.elements()) {
        const PersistentId* const a = io.persistent_id.find(joint.a);
        const PersistentId* const b = io.persistent_id.find(joint.b);
        if (!joint.collides && a != nullptr && b != nullptr) {
            io.frame.ignored.push_back(pair_of(a->value, b->value));
        }
    }
    std::sort(io.frame.ignored.begin(), io.frame.ignored.end());
}

}  // namespace

void find_contacts(const FindContactsIo& io, const ContactTuning& tuning) {
    ignore_jointed(io);
    io.collision.set_ignored_pairs(io.frame.ignored);
    io.collision.find_contacts({tuning.margin_m, tuning.sweep_m}, io.frame.contacts);
    update_ignores(io);
    io.collision.set_ignored_pairs(io.frame.ignored);
    std::erase_if(io.frame.contacts, [&io](const ContactPoint& contact) {
        return std::binary_search(io.frame.ignored.begin(), io.frame.ignored.end(),
                                  pair_of(contact.id_a, contact.id_b));
    });
}

}  // namespace handhold
