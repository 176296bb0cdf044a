#include <handhold/math.hpp>

#include "game/session/playback.hpp"
#include "game/session/recording.hpp"
#include "tests/fuzz/promise.hpp"

namespace handhold::fuzz {

// A recorded session drives a player beside a wall: no input may make a frame fail.
void run_recording(Bytes bytes) {
    const Result<Recording> recording = parse_recording(text_of(bytes), "fuzz.csv");
    if (!recording) {
        promise(!recording.error().expected.empty(), "a refusal says what was expected");
        return;
    }
    const std::vector<RecordedSample>& samples = recording.value().samples;
    promise(samples.size() >= 2, "a session has two samples");
    for (std::size_t i = 1; i < samples.size(); ++i) {
        promise(samples[i - 1].t_s < samples[i].t_s, "times increase");
    }

    hh::World world;
    hh_body_def wall = hh::body_def();
    wall.shape = *world.add_box({1.0, 1.0, 0.1});
    promise(static_cast<bool>(world.add(wall)), "there is a wall");
    hh_body_def rock = hh::body_def();
    rock.kind = HH_DYNAMIC;
    rock.mass_kg = 2.0;
    rock.pose.position = {0.0, 1.5, 0.3};
    rock.shape = *world.add_sphere(0.1);
    promise(static_cast<bool>(world.add(rock)), "there is a rock");
    const hh::Player player = *world.add(hh::player_def());
    Playback playback(recording.value());
    for (int frame = 0; frame < 20; ++frame) {
        constexpr double k_frame_s = 1.0 / 30.0;
        hh_player_input input = hh::input(player, playback.window(world.time_s() + k_frame_s));
        input.repeats_samples = true;
        promise(static_cast<bool>(world.step(k_frame_s, input)), "any recording can be played");
        promise(hh::is_valid(world.pose(player)->origin), "the player is somewhere");
    }
}

}  // namespace handhold::fuzz
