// The guide's rollback: a client guesses the other player's input, learns better and replays.
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include <handhold/handhold.hpp>

namespace {

constexpr double k_dt_s = 1.0 / 90.0;
constexpr int k_frames = 60;

// The same level and players, made by the same calls with the same names, on every machine.
struct Game {
    hh::World world;
    std::array<hh::Player, 2> players{};

    Game() {
        hh_body_def wall = hh::body_def();
        wall.shape = *world.add_box({2.0, 2.0, 0.1});
        wall.pose.position = {0.0, 1.5, -0.6};
        (void)world.add(wall);
        hh_body_def crate = hh::body_def();
        crate.kind = HH_DYNAMIC;
        crate.shape = *world.add_box({0.1, 0.1, 0.1});
        crate.pose.position = {0.2, 1.4, 0.4};
        crate.velocity_mps = {0.0, 0.0, -0.5};
        (void)world.add(crate);
        for (std::size_t i = 0; i < players.size(); ++i) {
            hh_player_def player = hh::player_def();
            player.origin.position.x = static_cast<double>(i);
            players[i] = *world.add(player);
        }
    }
};

hh::Sample sample_of(int frame, bool closes) {
    hh::Sample sample = hh::sample();
    sample.time_s = frame * k_dt_s;
    sample.head.position.y = 1.6;
    sample.hands[HH_LEFT].position = {-0.2, 1.4, -0.4 + 0.002 * frame};
    sample.hands[HH_RIGHT].position = {0.2, 1.4, -0.4 + 0.003 * frame};
    sample.grab[HH_RIGHT] = closes;
    return sample;
}

void step(Game& game, int frame, bool other_closes) {
    const hh::Sample mine = sample_of(frame, frame > 10);
    const hh::Sample others = sample_of(frame, other_closes);
    const std::array inputs = {hh::input(game.players[0], {&mine, 1}),
                               hh::input(game.players[1], {&others, 1})};
    if (!game.world.step(k_dt_s, inputs)) {
        std::printf("%s\n", hh_last_error());
    }
}

}  // namespace

int main() {
    Game server;
    for (int frame = 1; frame <= k_frames; ++frame) {
        step(server, frame, frame > 20);  // the other player closed a hand in frame 21
    }
    // [rollback]
    Game client;
    std::vector<std::byte> saved;
    for (int frame = 1; frame <= k_frames; ++frame) {
        if (frame == 21 && !client.world.save(saved)) {  // the last frame with both inputs known
            return 1;
        }
        step(client, frame, false);  // a guess
    }
    const std::uint64_t guessed = client.world.hash();
    // The input arrives: back to the last frame that was right, and forward again.
    if (!client.world.restore(saved)) {
        return 1;
    }
    for (int frame = 21; frame <= k_frames; ++frame) {
        step(client, frame, true);
    }
    const bool is_equal = client.world.hash() == server.world.hash();  // bit for bit
    // [rollback]
    std::printf("guess %s, replay %s; a snapshot has %zu bytes\n",
                guessed == server.world.hash() ? "right" : "wrong", is_equal ? "equal" : "differs",
                saved.size());
    return is_equal && guessed != server.world.hash() ? 0 : 1;
}
