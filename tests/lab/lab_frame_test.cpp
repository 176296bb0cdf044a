// The lab's frame takes its position solver as an argument. All its other stages are the runtime's.
#include "tools/lab/lab_frame.hpp"

#include <gtest/gtest.h>

#include "tools/lab/gauss_seidel.hpp"
#include "tools/lab/lab_scene.hpp"
#include "tools/lab/runtime_run.hpp"

namespace handhold::lab::lab_frame_test {
namespace {

constexpr double k_hz = 90.0;

LabScene scene_of(std::string_view name) {
    return make_scene(std::string(name), {6, "uniform", 1.0, k_hz, Holder::player});
}

// The world after some frames, in which hands hold and bodies move.
World moving_world(RuntimeRun& run) {
    FrameRecord record;
    for (int frame = 0; frame < 20; ++frame) {
        run.step(record);
    }
    return run.world();
}

// Hashes of five frames more, without new samples.
template <typename Step>
std::vector<std::uint64_t> hashes_of(World world, const ShapeLibrary& shapes, const Step& step) {
    FrameCaches caches(shapes);
    StageStats stats;
    std::vector<std::uint64_t> hashes;
    for (int frame = 0; frame < 5; ++frame) {
        step(world, caches, stats);
        hashes.push_back(hash_state(world));
    }
    return hashes;
}

TEST(LabFrame, WithTheRuntimesSolverEqualsStepFrameBitForBit) {
    for (const std::string_view name : scene_names()) {
        SCOPED_TRACE(std::string(name));
        const LabScene scene = scene_of(name);
        RuntimeRun run(scene, Holder::player, k_hz, &solve_positions);
        const World start = moving_world(run);
        const FrameInput input{1.0 / k_hz, {}};
        const auto product = [&](World& world, FrameCaches& caches, StageStats& stats) {
            step_frame(world, caches, scene.tuning, input, stats);
        };
        const auto lab = [&](World& world, FrameCaches& caches, StageStats& stats) {
            step_frame_with(&solve_positions, world, caches, scene.tuning, input, stats);
        };
        const auto expected = hashes_of(start, run.shapes(), product);
        EXPECT_EQ(hashes_of(start, run.shapes(), lab), expected);
        EXPECT_NE(expected.front(), expected.back());
    }
}

TEST(LabFrame, AnotherSolverGivesAnotherChain) {
    const LabScene scene = scene_of("chain");
    RuntimeRun direct(scene, Holder::player, k_hz, &solve_positions);
    RuntimeRun sweep(scene, Holder::player, k_hz, &solve_sweep);
    EXPECT_NE(hash_state(moving_world(direct)), hash_state(moving_world(sweep)));
}

}  // namespace
}  // namespace handhold::lab::lab_frame_test
