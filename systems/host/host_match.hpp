#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <handhold/match.h>

#include "systems/host/host_world.hpp"
#include "systems/match/client_session.hpp"
#include "systems/match/drawn_poses.hpp"
#include "systems/match/server_session.hpp"
#include "systems/match/spectator_session.hpp"
#include "systems/match/sync_test.hpp"

// The object behind hh_match, and what it adds to the ticks of a session.
namespace handhold {

// What the events of the next step depend on besides the world. It goes back with the world.
struct EventReports {
    Column<HandReport> hands;
    Column<JointReport> joints;
    Column<SpaceReport> spaces;
    std::vector<HostContact> contacts;
};
void keep_reports(const hh_world& host, EventReports& kept);
void restore_reports(const EventReports& kept, hh_world& host);

// The part of the reports that does not follow from the world's state, for joining players.
void write_reports(const hh_world& host, std::vector<std::byte>& bytes);
// What write_reports wrote, by the ids of the world that it is of.
struct JoinedReports {
    std::vector<std::array<Entity, 2>> touched;  // hand, what its palm touches
    std::vector<Entity> at_limit;                // joints
    std::vector<HostContact> contacts;           // impulses and points are not set
};
// Empty for other bytes.
std::optional<JoinedReports> read_reports(std::span<const std::byte> bytes);
// Call after finish_restore. Ids of entities that are not there are skipped.
void add_reports(const JoinedReports& joined, hh_world& host);

// The events of one tick as the host knows them.
struct TickEvents {
    MatchTick tick = 0;
    bool is_known = false;  // the host has been told of these
    std::vector<hh_event> events;
};

}  // namespace handhold

// NOLINTNEXTLINE(readability-identifier-naming): the name of the C interface
struct hh_match {
    // Servers and spectators step each tick once.
    bool goes_back() const { return client != nullptr || sync != nullptr; }

    hh_match(hh_world& of_world, const hh_match_def& wanted, const hh_match_game& of_game);
    ~hh_match();
    hh_match(const hh_match&) = delete;
    hh_match& operator=(const hh_match&) = delete;

    hh_world& host;
    hh_match_def def;
    hh_match_game game;
    std::unique_ptr<handhold::ClientSession> client;  // one of these four, by the role
    std::unique_ptr<handhold::ServerSession> server;
    std::unique_ptr<handhold::SpectatorSession> spectator;
    std::unique_ptr<handhold::SyncTest> sync;

    std::array<handhold::TickSampler, handhold::k_most_match_players> samplers;  // index: slot
    std::vector<handhold::EventReports> reports;     // index: place; empty if it never goes back
    std::vector<handhold::TickEvents> told;          // index: place; what the host was told of
    handhold::MatchTick confirmed_events = 0;        // events up to this tick were confirmed
    std::optional<handhold::JoinedReports> joining;  // set between MatchHost::read and joined
    std::vector<hh_match_event> events;
    handhold::DrawnPoses drawn;
    std::vector<std::byte> state;       // scratch
    std::vector<std::uint8_t> matched;  // scratch
    bool is_in_game = false;            // a function of the game runs
};

namespace handhold {

// The match; throws unless it has this role and no function of its game runs.
hh_match& match_of(hh_match* match);
const hh_match& match_of(const hh_match* match);
ClientSession& client_of(hh_match* match);
ServerSession& server_of(hh_match* match);

// What the session calls.
MatchHost host_of(hh_match& match);
// Tells the host of the world's events after a tick was stepped, perhaps again.
void tell_events(hh_match& match);
// Tells the host that all events up to this tick are final.
void confirm_events(hh_match& match, MatchTick until);
// Retracts all events that are not final: the world was replaced.
void retract_events(hh_match& match);
// Call after each tick that is shown.
void note_drawn(hh_match& match);

}  // namespace handhold
