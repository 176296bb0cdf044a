#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "systems/match/client_session.hpp"
#include "systems/match/server_session.hpp"
#include "tests/systems/frame/scenario.hpp"
#include "tests/systems/match/simulated_network.hpp"

// A match of four players on one machine: a server and a client for each player, each with a world
// of its own, and a simulated network between them.
namespace handhold::match_test {

inline constexpr double k_tick_s = 1.0 / 90.0;
inline constexpr std::size_t k_people = 4;
inline constexpr std::size_t k_server = k_people;  // its place in the network

inline std::string name_of_person(std::size_t i) { return "person" + std::to_string(i); }

// Persons 0 and 1 pull one loose bar. Person 2 holds the hand of person 1. Person 3 crawls on the
// floor, gripping and letting go. Built alike on every machine.
struct MatchScene {
    ShapeLibrary shapes;
    World world;
    Tuning tuning;
    std::unique_ptr<FrameCaches> caches;

    MatchScene() {
        add_body(world, {"floor",
                         {},
                         {Vec3(0.0, 0.0, 0.0), Quat::Identity()},
                         {},
                         shapes.add_box(Vec3(10.0, 0.05, 10.0))});
        const Vec3 half(0.03, 0.03, 0.4);
        const ShapeId bar = shapes.add_box(half);
        add_body(world, {"bar",
                         {BodyKind::free, 4.0, solid_inertia(shapes.at(bar), 4.0), 0.2},
                         {Vec3(0.0, 1.2, 0.0), Quat::Identity()},
                         {},
                         bar});
        for (int i = 0; i < 6; ++i) {
            RigidBody rock{BodyKind::free, 1.0, Vec3::Constant(0.01), 0.2};
            add_body(world, {"rock" + std::to_string(i),
                             rock,
                             {Vec3(5.0 + 0.2 * i, 0.3, -0.2 + 0.1 * (i % 2)), Quat::Identity()},
                             {},
                             shapes.add_sphere(0.08)});
        }
        const ShapeId head = shapes.add_sphere(tuning.head.radius_m);
        const std::array<Vec3, k_people> origins = {Vec3(0.0, 0.0, 0.9), Vec3(0.0, 0.0, -0.9),
                                                    Vec3(-0.9, 0.0, -0.9), Vec3(5.0, 0.0, 0.6)};
        for (std::size_t i = 0; i < k_people; ++i) {
            PlayerDescription description;
            const std::string name = name_of_person(i);
            description.name = name;
            description.origin_ws.position = origins[i];
            description.head_shape = head;
            const PlayerEntities made = add_player(world, description);
            for (const Entity hand : made.hands) {
                world.controller_to_hand.add(hand, {});
            }
        }
        caches = std::make_unique<FrameCaches>(shapes);
    }
    MatchScene(const MatchScene&) = delete;
    MatchScene& operator=(const MatchScene&) = delete;

    MatchWorld match() {
        MatchWorld out{.world = world, .caches = *caches, .tuning = tuning, .dt_s = k_tick_s};
        out.player_count = k_people;
        for (std::size_t i = 0; i < k_people; ++i) {
            out.players[i] = persistent_id_from_name(name_of_person(i));
        }
        return out;
    }
};

// The devices of a person, as functions of the ticks' time.
inline DeviceScript script_of(std::size_t person) {
    const Tuning tuning;
    const Vec3 palm = tuning.hand.palm_center_m;  // of a right hand
    const Vec3 left_palm(-palm.x(), palm.y(), palm.z());
    DeviceScript script;
    const double facing = person == 1 ? -1.0 : 1.0;
    script.head = [=](double t) {
        return Pose{Vec3(0.03 * std::sin(1.3 * t), 1.6, 0.1 * facing),
                    rotation_about(Vec3::UnitY(), 0.2 * std::sin(0.9 * t))};
    };
    if (person <= 1) {                                // the right palm lies on the bar's top
        const double end = person == 0 ? -0.6 : 0.6;  // of the bar, from the player
        const Vec3 rest = Vec3(0.0, 1.2 + 0.035, end) - palm;
        const double phase = person == 0 ? 0.0 : 1.1;
        script.hands[1] = [=](double t) {
            const double on = ease(t, 0.8, 1.2);
            return Pose{rest + 0.12 * on *
                                   Vec3(std::sin(3.0 * t + phase), 0.4 * std::sin(2.0 * t),
                                        std::sin(4.0 * t + phase)),
                        Quat::Identity()};
        };
        script.grabs[1] = [](double t) { return t > 0.3; };
        script.hands[0] = [=](double t) {
            return Pose{Vec3(-0.45, 1.25 + 0.04 * std::sin(2.2 * t), 0.15), Quat::Identity()};
        };
    }
    if (person == 2) {  // the right palm lies on the back of the left hand of person 1
        const Vec3 other = Vec3(0.9 - 0.45, 1.25, 0.15);
        const Vec3 rest = other + Vec3(0.0, 0.034, -0.06) - palm;
        // Twice: on a bad network the first grip may come before the players have found their lead.
        const auto begin_of = [](double t) { return t < 2.3 ? 0.0 : 2.3; };
        script.hands[1] = [=](double t) {
            const double begin = begin_of(t);
            const double off = 0.04 * std::sin(2.2 * std::min(t, begin + 0.45));
            const double pull = 0.1 * ease(t - begin, 1.0, 1.5);
            return Pose{
                rest + Vec3(0.0, off, 0.0) + pull * Vec3(std::sin(2.5 * (t - begin)), 0.0, 0.0),
                Quat::Identity()};
        };
        script.grabs[1] = [=](double t) { return t - begin_of(t) > 0.45 && t - begin_of(t) < 2.1; };
    }
    if (person == 3) {
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            const double out = side == 0 ? -1.0 : 1.0;
            const Vec3 rest = Vec3(0.25 * out, 0.055, -0.3) - (side == 0 ? left_palm : palm);
            script.head = [](double t) {
                return Pose{Vec3(0.02 * std::sin(t), 0.7, 0.0), Quat::Identity()};
            };
            script.hands[side] = [=](double t) {
                return Pose{rest + 0.1 * Vec3(std::sin(2.0 * t), 0.0, out * std::sin(3.0 * t)),
                            Quat::Identity()};
            };
            script.grabs[side] = [=](double t) {
                return std::fmod(t + 0.35 * static_cast<double>(side), 0.9) > 0.3;
            };
        }
    }
    return script;
}

// One person's machine.
struct Machine {
    MatchScene scene;
    ClientSession session;
    DeviceScript script;
    TickSampler devices;
    double next_sample_s = 0.0;
    double phase_s = 0.0;  // of the frames
    int frames = 0;
    bool is_frozen = false;
    bool is_here = true;
    bool is_compared = true;
    std::vector<MatchInput> sent;  // own input of each tick
    MatchTick checked_until = 0;
    MatchTick own_since = 0;  // inputs up to this tick are those of an earlier connection

    explicit Machine(std::size_t person)
        : session(scene.match(), person),
          script(script_of(person)),
          phase_s(0.0021 * static_cast<double>(person)) {}

    // Devices of 97 Hz.
    MatchInput own_input() {
        constexpr double k_device_s = 1.0 / 97.0;
        const double start_s = static_cast<double>(session.now()) * k_tick_s;
        while (next_sample_s <= start_s + k_tick_s) {
            devices.add(sample_of(script, next_sample_s));
            next_sample_s += k_device_s;
        }
        return devices.take(start_s, start_s + k_tick_s, {});
    }
    void advance(int ticks) {
        for (int i = 0; i < ticks; ++i) {
            const MatchTick tick = session.now() + 1;
            const MatchInput own = own_input();
            if (session.advance(own, i + 1 == ticks) && session.now() == tick) {
                sent.resize(std::max<std::size_t>(sent.size(), tick + 1));
                sent[tick] = own;
            }
        }
    }
};

// What proves that a run tests something.
struct MatchCounts {
    int parts_held = 0;    // ticks in which somebody's arm, trunk or leg is held
    int shared_holds = 0;  // ticks in which two players hold one loose body
    int surface_grips = 0;
    std::uint64_t compared = 0;  // hashes of confirmed ticks
    std::uint64_t own_equal = 0;
};

class MatchPlay {
  public:
    MatchPlay(const NetworkTraits& traits, std::uint64_t seed,
              std::size_t people_at_start = k_people)
        : network(traits, seed_of(seed)), server(server_scene_.match(), 0.0) {
        server_hashes_.push_back(hash_simulated(server_scene_.world));
        for (std::size_t i = 0; i < k_people; ++i) {
            machines.push_back(std::make_unique<Machine>(i));
            machines[i]->is_here = i < people_at_start;
            if (machines[i]->is_here) {
                server.connect(i);
            }
        }
    }

    // Plays on for a time. The server looks at its packets 360 times a second and sends 90 times.
    void play(double seconds) {
        constexpr double k_look_s = 1.0 / 360.0;
        const auto looks = static_cast<int>(std::lround(seconds / k_look_s));
        for (int i = 0; i < looks; ++i) {
            now_s += k_look_s;
            network.deliver(
                now_s, [&](std::size_t from, std::size_t to, std::span<const std::byte> bytes) {
                    if (to == k_server) {
                        server.receive(from, bytes, now_s);
                    } else if (machines[to]->is_here && !machines[to]->is_frozen) {
                        machines[to]->session.receive(bytes);
                    }
                });
            step_server();
            if (++looks_ % 4 == 0) {
                for (std::size_t to = 0; to < k_people; ++to) {
                    if (server.is_connected(to)) {
                        send(k_server, to, [&](std::span<std::byte> out) {
                            return server.write_packet(to, out);
                        });
                    }
                }
            }
            for (std::size_t person = 0; person < k_people; ++person) {
                step_machine(person);
            }
        }
    }

    // The server's state for a machine, and its arrival there over a reliable stream.
    std::vector<std::byte> send_state(std::size_t person) {
        std::vector<std::byte> state;
        server.write_state(person, SnapshotAssets(server_scene_.shapes), state);
        return state;
    }
    void take_state(std::size_t person, std::span<const std::byte> state) {
        Machine& machine = *machines[person];
        const auto error = machine.session.join(state, SnapshotAssets(machine.scene.shapes));
        ASSERT_FALSE(error) << error->message();
        machine.checked_until = machine.session.now();
        machine.own_since = machine.session.inputs_of(person).final_until();
        machine.is_compared = true;
        machine.next_sample_s = static_cast<double>(machine.session.now()) * k_tick_s;
        machine.devices = {};
    }
    void bring_state(std::size_t person) { take_state(person, send_state(person)); }
    const World& server_world() const { return server_scene_.world; }
    std::uint64_t server_hash(MatchTick tick) const { return server_hashes_[tick]; }

    // Fails unless the run did what it is about.
    void expect_it_happened() const {
        EXPECT_GT(counts.parts_held, 60);
        EXPECT_GT(counts.shared_holds, 120);
        EXPECT_GT(counts.surface_grips, 120);
        EXPECT_GT(counts.compared, 600U);
        EXPECT_GT(counts.own_equal, 600U);
        for (const auto& machine : machines) {
            if (machine->is_here) {
                EXPECT_GT(machine->session.counts().rollbacks, 50U);
            }
        }
    }

    SimulatedNetwork network;

  private:
    MatchScene server_scene_;

  public:
    ServerSession server;
    std::vector<std::unique_ptr<Machine>> machines;
    MatchCounts counts;
    double now_s = 0.0;
    int frames_a_packet = 1;                       // of the machines; 1 or 2
    std::vector<std::vector<std::byte>> recorded;  // packets, while records is set
    bool records = false;

  private:
    template <typename Write>
    void send(std::size_t from, std::size_t to, const Write& write) {
        std::array<std::byte, k_most_packet_bytes> packet{};
        const std::size_t size = write(std::span(packet));
        const std::span<const std::byte> bytes = std::span(packet).first(size);
        if (records) {
            recorded.emplace_back(bytes.begin(), bytes.end());
        }
        network.send(from, to, bytes, now_s);
    }

    void step_server() {
        for (;;) {
            const MatchTick before = server.confirmed();
            server.advance(now_s, 1);
            if (server.confirmed() == before) {
                return;
            }
            server_hashes_.push_back(hash_simulated(server_scene_.world));
            count_grips(server_scene_.world);
        }
    }

    void step_machine(std::size_t person) {
        Machine& machine = *machines[person];
        if (!machine.is_here || machine.is_frozen) {
            return;
        }
        machine.phase_s += 1.0 / 360.0;
        if (machine.phase_s < k_tick_s) {
            return;
        }
        machine.phase_s -= k_tick_s;
        machine.advance(machine.session.ticks_due(k_tick_s));
        check(person);
        if (++machine.frames % frames_a_packet == 0) {
            send(person, k_server,
                 [&](std::span<std::byte> out) { return machine.session.write_packet(out); });
        }
    }

    // Confirmed ticks are equal to the server's, bit for bit, and so are own inputs that it did not
    // fill.
    void check(std::size_t person) {
        Machine& machine = *machines[person];
        const ClientSession& session = machine.session;
        if (!machine.is_compared) {
            return;
        }
        const MatchTick until = session.final_state();
        for (MatchTick tick = machine.checked_until + 1; tick <= until; ++tick) {
            if (tick + ClientSession::k_window <= session.now()) {
                continue;
            }
            ASSERT_LT(tick, server_hashes_.size());
            ASSERT_EQ(session.hash_at(tick), server_hashes_[tick])
                << "person " << person << ", tick " << tick;
            ++counts.compared;
            if (session.inputs_of(person).kind_at(tick) == InputKind::real &&
                tick > machine.own_since && tick < machine.sent.size()) {
                ASSERT_EQ(normalised(machine.sent[tick]), server.inputs_of(person).at(tick));
                ++counts.own_equal;
            }
        }
        machine.checked_until = std::max(machine.checked_until, until);
    }

    void count_grips(const World& world) {
        counts.parts_held += world.body_hold.empty() ? 0 : 1;
        const Entity bar = find_by_id(world, persistent_id_from_name("bar"));
        int on_bar = 0;
        for (const Grab& grab : world.grab.elements()) {
            on_bar += grab.body == bar && grab.kind == GripKind::held ? 1 : 0;
            counts.surface_grips += grab.kind == GripKind::surface ? 1 : 0;
        }
        counts.shared_holds += on_bar >= 2 ? 1 : 0;
    }

    std::vector<std::uint64_t> server_hashes_;
    int looks_ = 0;
};

}  // namespace handhold::match_test
