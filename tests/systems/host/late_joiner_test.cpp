// A client that joins late knows today's shapes, not those that came and went before: it restores a
// server's snapshot and continues bit for bit.
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <handhold/handhold.hpp>
#include <rapidcheck/gtest.h>

namespace handhold::host_late_joiner_test {
namespace {

constexpr double k_dt_s = 1.0 / 90.0;

// Shape `i` of all that either side may have; all differ.
hh::Shape add_shape(hh::World& world, int i) {
    const double size_m = 0.1 + 0.01 * i;
    switch (i % 4) {
        case 0:
            return *world.add_box({size_m, 0.1, 0.1});
        case 1:
            return *world.add_cylinder(size_m, 0.2);
        case 2:
            return *world.add_hull(std::vector<hh::Vec3>{{0.0, 0.0, 0.0},
                                                         {size_m, 0.0, 0.0},
                                                         {0.0, 0.2, 0.0},
                                                         {0.0, 0.0, 0.3},
                                                         {size_m, 0.2, 0.3}});
        default:
            return *world.add_sphere(size_m);
    }
}

hh::World make_world() {
    hh_world_def def = hh::world_def();
    def.fits_hands = false;
    return hh::World(def);
}

RC_GTEST_PROP(HostLateJoiner, RestoresWithEqualShapesOfOtherIds, ()) {
    hh::World server = make_world();
    hh::World client = make_world();
    const auto present = *rc::gen::unique<std::vector<int>>(rc::gen::inRange(0, 12));
    const auto gone = *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 40));
    std::vector<hh::Shape> removed;
    for (const int i : gone) {
        removed.push_back(add_shape(server, 12 + i));
    }
    std::vector<hh_body> bodies;
    for (const int i : present) {
        const std::string name = "body" + std::to_string(i);
        hh_body_def def = hh::body_def();
        def.name = name.c_str();
        def.kind = HH_DYNAMIC;
        def.shape = add_shape(server, i);
        def.pose.position = {2.0 * i, 0.0, 0.0};
        def.velocity_mps = {0.1, 0.0, 0.0};
        bodies.push_back(*server.add(def));
    }
    for (const hh::Shape& shape : removed) {
        RC_ASSERT(static_cast<bool>(server.remove(shape)));
    }
    for (int frame = 0; frame < 5; ++frame) {
        RC_ASSERT(static_cast<bool>(server.step(k_dt_s)));
    }
    std::vector<std::byte> bytes;
    RC_ASSERT(static_cast<bool>(server.save(bytes)));
    // The other way round, among shapes of the client's own; one missing is refused by its kind.
    std::vector<int> order(present.rbegin(), present.rend());
    (void)add_shape(client, 99);
    for (std::size_t n = 0; n < order.size(); ++n) {
        const hh::Status early = client.restore(bytes);
        RC_ASSERT(early.result() == HH_ERROR_DATA);
        RC_ASSERT(early.text().find("none of its shapes equals") != std::string_view::npos);
        (void)add_shape(client, order[n]);
    }
    RC_ASSERT(static_cast<bool>(client.restore(bytes)));
    for (int frame = 0; frame < 5; ++frame) {
        RC_ASSERT(client.hash() == server.hash());
        RC_ASSERT(static_cast<bool>(server.step(k_dt_s)));
        RC_ASSERT(static_cast<bool>(client.step(k_dt_s)));
        for (const hh_body body : bodies) {
            const hh::Vec3 a = server.pose(body)->position;
            const hh::Vec3 b = client.pose(body)->position;
            RC_ASSERT(a.x == b.x && a.y == b.y && a.z == b.z);
        }
    }
}

hh_shape add_hull(hh::World& world, double pivot_m) {
    return *world.add_hull(std::vector<hh::Vec3>{{pivot_m, 0.0, 0.0},
                                                 {pivot_m + 0.5, 0.0, 0.0},
                                                 {pivot_m, 0.25, 0.0},
                                                 {pivot_m, 0.0, 0.25},
                                                 {pivot_m + 0.5, 0.25, 0.25}});
}

hh_body add_body(hh::World& world, hh_shape shape) {
    hh_body_def def = hh::body_def();
    def.name = "body";
    def.kind = HH_DYNAMIC;
    def.shape = shape;
    def.pose.position = {1.0, 2.0, 3.0};
    return *world.add(def);
}

// Hulls that differ only in where the host put their pivot are different shapes: poses that the
// host reads are those of the pivot.
RC_GTEST_PROP(HostLateJoiner, TellsHullsApartByTheirPivot, ()) {
    const auto pivots = *rc::gen::unique<std::vector<int>>(3, rc::gen::inRange(-8, 8));
    const auto pivot_m = [&pivots](std::size_t i) { return 0.25 * pivots[i]; };
    hh::World server = make_world();
    hh::World client = make_world();
    const hh_body body = add_body(server, add_hull(server, pivot_m(0)));
    std::vector<std::byte> bytes;
    RC_ASSERT(static_cast<bool>(server.save(bytes)));
    add_hull(client, pivot_m(1));
    add_hull(client, pivot_m(2));
    RC_ASSERT(client.restore(bytes).result() == HH_ERROR_DATA);
    add_hull(client, pivot_m(0));
    RC_ASSERT(static_cast<bool>(client.restore(bytes)));
    const hh::Vec3 at = client.pose(body)->position;
    RC_ASSERT(std::abs(at.x - 1.0) < 1e-12);
    RC_ASSERT(std::abs(at.y - 2.0) < 1e-12);
    RC_ASSERT(std::abs(at.z - 3.0) < 1e-12);
}

// A player's head and a body's ball of the same radius are different shapes: neither takes the
// other's, and heads of any size come with the snapshot.
RC_GTEST_PROP(HostLateJoiner, TellsHeadsFromBalls, ()) {
    const double scale = 0.25 * *rc::gen::inRange(1, 12);
    hh::World server = make_world();
    hh::World client = make_world();
    const double radius_m = *server.tuning("head.radius_m") * scale;
    hh_player_def def = hh::player_def();
    def.scale = scale;
    (void)*server.add(def);
    std::vector<std::byte> bytes;
    RC_ASSERT(static_cast<bool>(server.save(bytes)));
    const hh::Shape ball = *client.add_sphere(radius_m);
    RC_ASSERT(static_cast<bool>(client.restore(bytes)));
    RC_ASSERT(client.hash() == server.hash());
    RC_ASSERT(static_cast<bool>(client.remove(ball)));  // no head has it

    (void)add_body(server, *server.add_sphere(radius_m));
    RC_ASSERT(static_cast<bool>(server.save(bytes)));
    RC_ASSERT(client.restore(bytes).result() == HH_ERROR_DATA);
    (void)*client.add_sphere(radius_m);
    RC_ASSERT(static_cast<bool>(client.restore(bytes)));
    RC_ASSERT(client.hash() == server.hash());
}

}  // namespace
}  // namespace handhold::host_late_joiner_test
