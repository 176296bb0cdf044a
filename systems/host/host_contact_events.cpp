// Makes the C interface's events of contacts: those of players' heads and of held bodies.
#include <algorithm>
#include <tuple>

#include "engine/solver/newton/velocities.hpp"
#include "systems/host/host_events.hpp"
#include "systems/host/host_impulses.hpp"

namespace handhold {
namespace {

// Adds one contact for each receiver: if `a` is a head, that head; if hands hold `a`, each of these
// hands.
void add_contact(hh_world& host, Entity a, Entity b, double impulse_ns, const Vec3& point_ws) {
    HostContact contact;
    contact.other = b;
    contact.impulse_ns = impulse_ns;
    contact.point_ws = point_ws;
    if (host.world.player.contains(a)) {
        contact.player = a;
        host.contacts.push_back(contact);
        return;
    }
    for (std::size_t index = 0; index < host.world.grab.size(); ++index) {
        const Grab& grab = host.world.grab.elements()[index];
        if (grab.kind == GripKind::held && grab.body == a) {
            const HandOwner& owner = host.world.hand_owner.at(host.world.grab.owners()[index]);
            contact.player = owner.player;
            contact.side = owner.side == HandSide::left ? HH_LEFT : HH_RIGHT;
            contact.held = a;
            host.contacts.push_back(contact);
        }
    }
}

bool was_in_contact(const hh_world& host, Entity a, Entity b) {
    return std::ranges::any_of(host.last_contacts, [&](const HostContact& contact) {
        const Entity own = is_null(contact.held) ? contact.player : contact.held;
        return (own == a && contact.other == b) || (own == b && contact.other == a);
    });
}

// Adds one contact to the list of all contacts.
void list_contact(hh_world& host, const RowBlock& block, double impulse_ns) {
    const FrameGraph& frame = host.caches.graph;
    const auto name = [&](std::uint32_t index, hh_body& body, hh_player& player) {
        const Entity entity = frame.entities[index];
        if (host.world.player.contains(entity)) {
            player = id_of<hh_player>(entity);
        } else {
            body = id_of<hh_body>(entity);
        }
    };
    hh_contact contact{};
    name(block.a, contact.body_a, contact.player_a);
    name(block.b, contact.body_b, contact.player_b);
    const std::vector<SolverBody>& bodies = frame.graph.bodies;
    contact.point = to_c(transform_point(bodies[block.a].pose_ws, block.point_a_bs));
    contact.normal = to_c(bodies[block.b].pose_ws.rotation * block.normal_b_bs);
    contact.depth_m = -contact_separation_m(bodies, block);
    contact.impulse_ns = impulse_ns;
    host.contact_list.push_back(contact);
}

}  // namespace

void gather_contacts(hh_world& host) {
    constexpr double k_begin_m = 1e-4;  // a contact begins when bodies are closer than this
    constexpr double k_end_m = 2e-3;    // a contact ends when bodies are farther apart than this
    constexpr double k_least_impulse_ns = 1e-9;
    const FrameGraph& frame = host.caches.graph;
    host.last_contacts.swap(host.contacts);
    host.contacts.clear();
    host.contact_list.clear();
    for (std::size_t i = 0; i < frame.graph.blocks.size(); ++i) {
        const RowBlock& block = frame.graph.blocks[i];
        if (!is_contact(block) || block.a >= frame.entities.size() ||
            block.b >= frame.entities.size()) {
            continue;
        }
        const Entity a = frame.entities[block.a];
        const Entity b = frame.entities[block.b];
        const double impulse_ns = reported_impulse_ns(host, i).norm();
        const double separation_m = contact_separation_m(frame.graph.bodies, block);
        if (impulse_ns >= k_least_impulse_ns || separation_m <= k_begin_m) {
            list_contact(host, block, impulse_ns);
        }
        const double near_m = was_in_contact(host, a, b) ? k_end_m : k_begin_m;
        if (impulse_ns < k_least_impulse_ns && separation_m > near_m) {
            continue;
        }
        const Vec3 point_ws =
            transform_point(frame.graph.bodies[block.a].pose_ws, block.point_a_bs);
        add_contact(host, a, b, impulse_ns, point_ws);
        add_contact(host, b, a, impulse_ns, point_ws);
    }
    const auto key = [](const HostContact& c) {
        return std::tuple(c.player.slot, c.side, c.held.slot, c.other.slot);
    };
    // A stable sort that allocates nothing: contacts of heads and held bodies are few.
    for (auto next = host.contacts.begin(); next != host.contacts.end(); ++next) {
        const auto place = std::upper_bound(
            host.contacts.begin(), next, *next,
            [&key](const HostContact& a, const HostContact& b) { return key(a) < key(b); });
        std::rotate(place, next, next + 1);
    }
    // Merges the points of one pair into one contact: the first point, with the sum of the
    // impulses.
    std::size_t kept = 0;
    for (const HostContact& contact : host.contacts) {
        if (kept > 0 && host.contacts[kept - 1].is_same(contact)) {
            host.contacts[kept - 1].impulse_ns += contact.impulse_ns;
        } else {
            host.contacts[kept++] = contact;
        }
    }
    host.contacts.resize(kept);
}

void add_contact_events(hh_world& host, hh_event_kind kind,
                        const std::vector<HostContact>& contacts,
                        const std::vector<HostContact>& others) {
    for (const HostContact& contact : contacts) {
        if (std::ranges::any_of(others, [&](const HostContact& c) { return c.is_same(contact); })) {
            continue;
        }
        hh_event event{};
        event.kind = kind;
        event.player = id_of<hh_player>(contact.player);
        event.side = contact.side;
        event.held = id_of<hh_body>(contact.held);
        if (host.world.player.contains(contact.other)) {
            event.other = id_of<hh_player>(contact.other);
        } else {
            event.body = id_of<hh_body>(contact.other);
        }
        event.position = to_c(contact.point_ws);
        event.impulse_ns = kind == HH_EVENT_CONTACT_BEGAN ? contact.impulse_ns : 0.0;
        host.events.push_back(event);
    }
}

}  // namespace handhold

hh_result hh_world_contacts(const hh_world* world, hh_contact* contacts, size_t capacity,
                            size_t* count) {
    using namespace handhold;
    return call([&] {
        const hh_world& host = world_of(world);
        write_list(host.contact_list.size(), contacts, capacity, count,
                   [&](std::size_t i) { return host.contact_list[i]; });
    });
}
