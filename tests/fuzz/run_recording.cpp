#include "game/session/playback.hpp"
#include "game/session/recording.hpp"
#include "systems/frame/frame.hpp"
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

    ShapeLibrary shapes;
    World world;
    add_body(world, {"wall", {}, {}, {}, shapes.add_box(Vec3(1.0, 1.0, 0.1))});
    RigidBody rock{BodyKind::free, 2.0, Vec3::Constant(0.01), 0.0};
    add_body(world,
             {"rock", rock, {Vec3(0.0, 1.5, 0.3), Quat::Identity()}, {}, shapes.add_sphere(0.1)});
    const PlayerEntities player =
        add_player(world, {"player", {}, {}, Vec3::Zero(), shapes.add_sphere(0.12)});
    FrameCaches caches(shapes);
    Playback playback(recording.value());
    StageStats stats;
    for (int frame = 0; frame < 20; ++frame) {
        constexpr double k_frame_s = 1.0 / 30.0;
        const PlayerInput input{player.player, playback.window(world.clock.t_s + k_frame_s), {}};
        step_frame(world, caches, {}, {k_frame_s, {&input, 1}}, stats);
        promise(is_valid(world.player_origin.at(player.player).pose_ws), "the player is somewhere");
    }
}

}  // namespace handhold::fuzz
