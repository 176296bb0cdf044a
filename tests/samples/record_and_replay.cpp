// The guide's recording: a host keeps the input of every step with the state's hash, plays it again
// and finds the first step that differs.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <vector>

#include <handhold/handhold.hpp>

namespace {

constexpr double k_dt_s = 1.0 / 90.0;
constexpr int k_frames = 120;

// The same calls with the same names, whenever the level is loaded.
struct Game {
    hh::World world;
    hh::Player player{};

    Game() {
        hh_body_def wall = hh::body_def();
        wall.name = "wall";
        wall.shape = *world.add_box({2.0, 2.0, 0.1});
        wall.pose.position = {0.0, 1.5, -0.6};
        (void)world.add(wall);
        hh_player_def you = hh::player_def();
        you.name = "you";
        player = *world.add(you);
        (void)world.use_wrists(player);
    }
};

// A hand that closes on the wall at 0.5 s and pulls; it trembles, as real ones do.
hh::Sample devices_at(int frame) {
    hh::Sample sample = hh::sample();
    sample.time_s = frame * k_dt_s;
    sample.head.position.y = 1.6;
    const hh::Quat palm_to_wall{std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)};
    const double tremor_m = 0.001 * std::sin(12.0 * sample.time_s);
    sample.hands[HH_LEFT] = hh::pose_at({-0.2, 1.4, -0.43}, palm_to_wall);
    sample.hands[HH_RIGHT] = hh::pose_at({0.2 + tremor_m, 1.4, -0.43}, palm_to_wall);
    sample.grab[HH_RIGHT] = sample.time_s >= 0.5;
    return sample;
}

// [record]
// What a step depends on besides the state, and the hash of the state that it led to. Write these
// to a file as they are: the same build reads them again.
struct RecordedStep {
    double dt_s;
    hh_tracking_sample sample;
    hh_commands commands;
    std::uint64_t hash;
};

bool step(Game& game, const RecordedStep& recorded) {
    return static_cast<bool>(game.world.step(
        recorded.dt_s, hh::input(game.player, {&recorded.sample, 1}, recorded.commands)));
}
// [record]

// [replay]
// Number of the first step whose state differs from the recorded one; 0: none.
int first_difference(const std::vector<RecordedStep>& recording) {
    Game game;  // the same level again
    int number = 0;
    for (const RecordedStep& recorded : recording) {
        ++number;
        if (!step(game, recorded) || game.world.hash() != recorded.hash) {
            return number;
        }
    }
    return 0;
}
// [replay]

}  // namespace

int main() {
    Game game;
    std::vector<RecordedStep> recording;
    for (int frame = 1; frame <= k_frames; ++frame) {
        RecordedStep recorded{k_dt_s, devices_at(frame), {}, 0};
        if (!step(game, recorded)) {
            return 1;
        }
        recorded.hash = game.world.hash();
        recording.push_back(recorded);
    }
    const int same = first_difference(recording);
    std::vector<RecordedStep> edited = recording;
    edited[69].sample.hands[HH_RIGHT].position.x += 1e-6;  // step 70
    const int changed = first_difference(edited);
    std::printf("%d steps: replay differs at %d, edited input at %d\n", k_frames, same, changed);
    return same == 0 && changed == 70 ? 0 : 1;
}
