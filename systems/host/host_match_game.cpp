// What a match of the C interface adds to the ticks of its session: the world's events, and the
// host's game.
#include <algorithm>

#include "systems/host/host_match.hpp"
#include "systems/host/host_step.hpp"

namespace handhold {
namespace {

// While it exists, a function of the game runs: the match takes no calls.
class InGame {
  public:
    explicit InGame(hh_match& match) : match_(match) { match.is_in_game = true; }
    ~InGame() { match_.is_in_game = false; }
    InGame(const InGame&) = delete;
    InGame& operator=(const InGame&) = delete;

  private:
    hh_match& match_;
};

hh_match& match_in(void* context) { return *static_cast<hh_match*>(context); }

void step_of_game(void* context, const FrameInput& input, const TickInputs& inputs, bool is_shown) {
    hh_match& match = match_in(context);
    hh_world& host = match.host;
    // shows_hands: false, so that events have the same positions on all machines.
    run_step(host, input, {.run = is_shown ? &step_frame : &step_simulated, .shows_hands = false});
    host.has_placed_colliders = false;
    if (match.game.step != nullptr) {
        std::array<std::uint32_t, k_most_match_players> buttons{};
        for (std::size_t slot = 0; slot < match.def.player_count; ++slot) {
            buttons[slot] = inputs.now[slot]->buttons;
        }
        const InGame in_game(match);
        match.game.step(match.game.context, host.world.clock.frame, buttons.data(),
                        match.def.player_count);
    }
    tell_events(match);
}

void keep_of_game(void* context, std::size_t place) {
    hh_match& match = match_in(context);
    keep_reports(match.host, match.reports[place]);
    if (match.game.save != nullptr) {
        const InGame in_game(match);
        match.game.save(match.game.context, static_cast<std::uint32_t>(place));
    }
}

void restore_of_game(void* context, std::size_t place) {
    hh_match& match = match_in(context);
    restore_reports(match.reports[place], match.host);
    match.host.has_placed_colliders = false;
    if (match.game.restore != nullptr) {
        const InGame in_game(match);
        match.game.restore(match.game.context, static_cast<std::uint32_t>(place));
    }
}

std::uint64_t hash_of_game(void* context) {
    hh_match& match = match_in(context);
    const InGame in_game(match);
    return match.game.hash(match.game.context);
}

void write_of_game(void* context, std::vector<std::byte>& bytes) {
    write_reports(match_in(context).host, bytes);
}

bool read_of_game(void* context, std::span<const std::byte> bytes) {
    hh_match& match = match_in(context);
    match.joining = read_reports(bytes);
    return match.joining.has_value();
}

void joined_of_game(void* context) {
    hh_match& match = match_in(context);
    finish_restore(match.host);
    add_reports(*match.joining, match.host);
    match.joining.reset();
    for (TickSampler& sampler : match.samplers) {
        sampler.forget();
    }
    match.events.clear();
    retract_events(match);
    match.confirmed_events = match.host.world.clock.frame;
}

bool is_same_event(const hh_event& a, const hh_event& b) {
    const auto same = [](const auto& x, const auto& y) {
        return x.index == y.index && x.generation == y.generation;
    };
    return a.kind == b.kind && a.reason == b.reason && a.side == b.side &&
           same(a.player, b.player) && same(a.body, b.body) && same(a.other, b.other) &&
           same(a.held, b.held) && same(a.joint, b.joint);
}

void tell(hh_match& match, MatchTick tick, hh_match_event_state state, const hh_event& event) {
    match.events.push_back({tick, state, event});
}

}  // namespace

MatchHost host_of(hh_match& match) {
    MatchHost host{.context = &match,
                   .step = &step_of_game,
                   .hash = match.game.hash != nullptr ? &hash_of_game : nullptr,
                   .write = &write_of_game,
                   .read = &read_of_game,
                   .joined = &joined_of_game};
    if (match.def.role == HH_MATCH_CLIENT || match.def.role == HH_MATCH_SYNC_TEST) {
        host.keep = &keep_of_game;
        host.restore = &restore_of_game;
    }
    return host;
}

void tell_events(hh_match& match) {
    const MatchTick tick = match.host.world.clock.frame;
    const std::vector<hh_event>& now = match.host.events;
    if (match.client == nullptr) {
        for (const hh_event& event : now) {
            if (tick > match.confirmed_events) {
                tell(match, tick, HH_MATCH_CONFIRMED, event);
            }
        }
        match.confirmed_events = std::max(match.confirmed_events, tick);
        return;
    }
    TickEvents& before = match.told[tick % k_match_window];
    if (before.tick != tick || !before.is_known) {
        before.events.clear();
    }
    match.matched.assign(now.size(), 0);
    for (const hh_event& old : before.events) {
        std::size_t i = 0;
        while (i < now.size() && (match.matched[i] != 0 || !is_same_event(old, now[i]))) {
            ++i;
        }
        if (i < now.size()) {
            match.matched[i] = 1;
        } else {
            tell(match, tick, HH_MATCH_RETRACTED, old);
        }
    }
    for (std::size_t i = 0; i < now.size(); ++i) {
        if (match.matched[i] == 0) {
            tell(match, tick, HH_MATCH_PREDICTED, now[i]);
        }
    }
    before.tick = tick;
    before.is_known = true;
    before.events = now;
}

void confirm_events(hh_match& match, MatchTick until) {
    for (MatchTick tick = match.confirmed_events + 1; tick <= until; ++tick) {
        const TickEvents& told = match.told[tick % k_match_window];
        if (told.tick == tick && told.is_known) {
            for (const hh_event& event : told.events) {
                tell(match, tick, HH_MATCH_CONFIRMED, event);
            }
        }
    }
    match.confirmed_events = std::max(match.confirmed_events, until);
}

void retract_events(hh_match& match) {
    for (TickEvents& told : match.told) {
        if (told.is_known && told.tick > match.confirmed_events) {
            for (const hh_event& event : told.events) {
                tell(match, told.tick, HH_MATCH_RETRACTED, event);
            }
        }
        told.is_known = false;
    }
}

}  // namespace handhold
