// Figures accumulated frame by frame equal those of the whole log.
#include <gtest/gtest.h>

#include "game/report/run_summary.hpp"
#include "game/scene/random.hpp"
#include "tests/game/report/report_log.hpp"

namespace handhold::run_tally_test {
namespace {

TEST(RunTally, GivesTheFiguresOfTheWholeLog) {
    RunLog log = make_gripping_run();
    log.frames[1].stats.fallbacks[3] = 5;
    log.frames[2].stats.residual_m = 0.25;
    log.frames[0].stats.momentum.linear_kgmps[HH_MOMENTUM_BODIES] = {1.0, 2.0, 0.0};
    const RunSummary expected = summarize_run(log);
    RunTally tally;
    for (const FrameLog& frame : log.frames) {
        tally.add(frame);
    }
    const RunSummary summary = tally.finish(log);
    EXPECT_EQ(summary.frames, log.frames.size());
    EXPECT_EQ(summary.duration_s, expected.duration_s);
    EXPECT_EQ(summary.frames_per_s, expected.frames_per_s);
    EXPECT_EQ(summary.totals.fallbacks, expected.totals.fallbacks);
    EXPECT_EQ(summary.residual_m, 0.25);
    EXPECT_EQ(summary.hand_error.one_hand_free_m, expected.hand_error.one_hand_free_m);
    EXPECT_EQ(summary.hand_error.two_hands_m, expected.hand_error.two_hands_m);
    EXPECT_EQ(summary.push_back_m, expected.push_back_m);
    EXPECT_EQ(summary.momentum.linear_residual, expected.momentum.linear_residual);
    ASSERT_EQ(summary.players.size(), expected.players.size());
    for (std::size_t i = 0; i < summary.players.size(); ++i) {
        EXPECT_EQ(summary.players[i].name, expected.players[i].name);
        EXPECT_EQ(summary.players[i].path_m, expected.players[i].path_m);
    }
}

TEST(RunTally, KnowsPercentilesWithinOnePerCent) {
    Random random(1);
    RunLog log;
    RunTally tally;
    for (int i = 0; i < 5000; ++i) {
        FrameLog frame;
        for (double& time_us : frame.stats.stage_us) {
            const double u = random.unit();
            time_us = 0.05 + 3000.0 * u * u * u;
        }
        tally.add(frame);
        log.frames.push_back(frame);
    }
    const RunSummary expected = summarize_run(log);
    const RunSummary summary = tally.finish(log);
    const auto agree = [](const TimeFigures& a, const TimeFigures& b) {
        EXPECT_NEAR(a.median_us, b.median_us, 0.01 * b.median_us);
        EXPECT_NEAR(a.p99_us, b.p99_us, 0.01 * b.p99_us);
        EXPECT_EQ(a.max_us, b.max_us);
        EXPECT_NEAR(a.total_us, b.total_us, 1e-9 * b.total_us);
    };
    agree(summary.frame, expected.frame);
    for (std::size_t stage = 0; stage < summary.stages.size(); ++stage) {
        agree(summary.stages[stage], expected.stages[stage]);
    }
}

TEST(RunTally, OfNoFramesIsAllZero) {
    const RunSummary summary = RunTally().finish({});
    EXPECT_EQ(summary.frames, 0U);
    EXPECT_EQ(summary.frame.median_us, 0.0);
    EXPECT_EQ(summary.frame.p99_us, 0.0);
}

}  // namespace
}  // namespace handhold::run_tally_test
