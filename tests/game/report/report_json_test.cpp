#include "game/report/report_json.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <rapidcheck/gtest.h>

#include "components/stats.hpp"
#include "engine/core/check.hpp"
#include "game/report/run_summary.hpp"
#include "tests/game/report/report_log.hpp"

namespace handhold::report_json_test {
namespace {

using Json = nlohmann::json;

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

Json report_of(const RunLog& log) { return Json::parse(format_report_json(log)); }

TEST(ReportJson, NamesSceneAndInput) {
    const Json report = report_of(make_small_run());
    EXPECT_EQ(report["scene"], "shaft <7>");
    EXPECT_EQ(report["input"], "climb & drift.csv");
    EXPECT_EQ(report["spawn"], "auto: 1 2 3, yaw 90");
    EXPECT_EQ(report["hz"], 2.0);
    EXPECT_EQ(report["threads"], 3);
    EXPECT_EQ(report["frames"], 4);
    EXPECT_EQ(report["duration_s"], 2.0);
    EXPECT_EQ(report["frames_per_second"], 8.0);  // 4 frames in 0.5 s
    EXPECT_EQ(report["state_hash"], "0x00abcdef01234567");
}

TEST(ReportJson, StageTimesAreByNearestRank) {
    const Json report = report_of(make_small_run());
    constexpr auto k_stages = static_cast<std::size_t>(Stage::count);
    ASSERT_EQ(report["stage_us"].size(), k_stages);
    double all = 0.0;
    for (std::size_t s = 0; s < k_stages; ++s) {
        // Of 1, 2, 3 and 4 times `unit`: the second smallest, the fourth, the fourth.
        const double unit = static_cast<double>(s + 1);
        const Json& stage = report["stage_us"][name_of(static_cast<Stage>(s))];
        EXPECT_EQ(stage["median"], 2.0 * unit);
        EXPECT_EQ(stage["p99"], 4.0 * unit);
        EXPECT_EQ(stage["max"], 4.0 * unit);
        all += unit;
    }
    EXPECT_EQ(report["frame_us"]["median"], 2.0 * all);
    EXPECT_EQ(report["frame_us"]["p99"], 4.0 * all);
    EXPECT_EQ(report["frame_us"]["max"], 4.0 * all);
}

TEST(ReportJson, CountsEveryFallbackByItsReason) {
    RunLog log = make_small_run();
    constexpr auto k_fallbacks = static_cast<std::size_t>(Fallback::count);
    for (std::size_t i = 0; i < k_fallbacks; ++i) {
        log.frames[0].stats.fallbacks[i] = i;
        log.frames[3].stats.fallbacks[i] = 100;
    }
    const Json report = report_of(log);
    ASSERT_EQ(report["counters"]["fallbacks"].size(), k_fallbacks);
    for (std::size_t i = 0; i < k_fallbacks; ++i) {
        EXPECT_EQ(report["counters"]["fallbacks"][name_of(static_cast<Fallback>(i))], 100 + i);
    }
}

TEST(ReportJson, CountersAreTotals) {
    RunLog log = make_small_run();
    for (FrameLog& frame : log.frames) {
        frame.stats.islands = frame.frame;
        frame.stats.islands_pushed = 2 * frame.frame;
        frame.stats.contacts = 3 * frame.frame;
        frame.stats.contact_rounds = 4 * frame.frame;
        frame.stats.newton_iterations = 5 * frame.frame;
        frame.stats.grab_onsets = 6 * frame.frame;
        frame.stats.grabs_gripped = 7 * frame.frame;
    }
    const Json report = report_of(log);
    const Json& counters = report["counters"];
    constexpr int k_sum = 1 + 2 + 3 + 4;
    EXPECT_EQ(counters["islands"], k_sum);
    EXPECT_EQ(counters["islands_pushed"], 2 * k_sum);
    EXPECT_EQ(counters["contacts"], 3 * k_sum);
    EXPECT_EQ(counters["contact_rounds"], 4 * k_sum);
    EXPECT_EQ(counters["newton_iterations"], 5 * k_sum);
    EXPECT_EQ(report["grabs"]["onsets"], 6 * k_sum);
    EXPECT_EQ(report["grabs"]["gripped"], 7 * k_sum);
}

TEST(ReportJson, SplitsHandErrorByWhatElseHolds) {
    RunLog log = make_gripping_run();
    log.frames[1].players[0].hands[0] = log.frames[0].players[0].hands[0];
    log.frames[1].players[0].hands[1].error_m = 1.0 / 512;
    const Json report = report_of(log);
    const Json& error = report["hand_error_mm"];
    EXPECT_EQ(error["one_hand_free"],
              1000.0 / 1024);  // not the larger ones with contacts, or pushed
    // From the frame in which the right hand releases: it held until that frame's end.
    EXPECT_EQ(error["two_hands"], 1000.0 / 32);
    EXPECT_EQ(error["any"], 1000.0 / 32);
}

TEST(ReportJson, HandThatGripsNothingHasNoError) {
    RunLog log = make_small_run();
    log.frames[1].players[0].hands[0].error_m = 1.0;
    EXPECT_EQ(report_of(log)["hand_error_mm"]["any"], 0.0);
}

TEST(ReportJson, WorstOfAFrameIsKept) {
    RunLog log = make_gripping_run();
    log.frames[1].stats.residual_m = 1.0 / 512;
    log.frames[2].stats.residual_m = 1.0 / 2048;
    log.frames[0].stats.joint_error_m = 1.0 / 1024;
    log.frames[3].stats.joint_error_rad = 1.0 / 4096;
    const Json report = report_of(log);
    EXPECT_EQ(report["residual_mm"], 1000.0 / 512);
    EXPECT_EQ(report["joint_error"]["mm"], 1000.0 / 1024);
    EXPECT_EQ(report["joint_error"]["rad"], 1.0 / 4096);
    EXPECT_EQ(report["push_back_mm"], 125.0);
    EXPECT_EQ(report["players"][0]["push_back_mm"], 125.0);
    EXPECT_EQ(report["players"][1]["push_back_mm"], 0.0);
}

TEST(ReportJson, PathIsThatOfTheOrigin) {
    const Json report = report_of(make_small_run());
    EXPECT_EQ(report["path_m"], 17.0);  // 5 by (3, 4, 0), 0, 12
    ASSERT_EQ(report["players"].size(), 2U);
    EXPECT_EQ(report["players"][0]["name"], "ann");
    EXPECT_EQ(report["players"][0]["mass_kg"], 80.0);
    EXPECT_EQ(report["players"][0]["path_m"], 17.0);
    EXPECT_EQ(report["players"][1]["path_m"], 0.0);
}

TEST(ReportJson, MomentumThatIsMissingInOneFrameIsNotCancelledByAnother) {
    RunLog log = make_small_run();
    const auto linear = [&](std::size_t frame) -> auto& {
        return log.frames[frame].stats.momentum.linear_kgmps;
    };
    linear(0)[HH_MOMENTUM_BODIES] = {3.0, 0.0, 0.0};
    linear(0)[HH_MOMENTUM_DISCARDED] = {-3.0, 0.0, 0.0};
    linear(1)[HH_MOMENTUM_BODIES] = {0.0, 4.0, 0.0};
    linear(1)[HH_MOMENTUM_PLAYERS] = {0.0, -3.0, 0.0};
    linear(2)[HH_MOMENTUM_BODIES] = {0.0, -4.0, 0.0};
    linear(2)[HH_MOMENTUM_STATICS] = {0.0, 3.0, 0.0};
    const Json report = report_of(log);
    const Json& ledger = report["momentum_ledger"];
    EXPECT_EQ(ledger["linear_kgmps"]["objects"], Json({3.0, 0.0, 0.0}));
    EXPECT_EQ(ledger["linear_kgmps"]["virtual_player"], Json({-3.0, 0.0, 0.0}));
    EXPECT_EQ(ledger["linear_kgmps"]["players"], Json({0.0, -3.0, 0.0}));
    EXPECT_EQ(ledger["linear_kgmps"]["statics"], Json({0.0, 3.0, 0.0}));
    EXPECT_EQ(ledger["relative_residual"]["linear"], 2.0 / 20.0);  // 0, 1 and 1 of 6, 7 and 7
    EXPECT_EQ(ledger["relative_residual"]["angular"], 0.0);
}

TEST(ReportJson, BrokenRunIsNull) {
    RunLog log = make_gripping_run();
    log.frames[1].stats.residual_m = k_nan;
    log.frames[2].players[0].hands[1].error_m = k_nan;
    log.frames[2].players[0].push_back_m = k_nan;
    const Json report = report_of(log);
    EXPECT_TRUE(report["residual_mm"].is_null());
    EXPECT_TRUE(report["hand_error_mm"]["two_hands"].is_null());
    EXPECT_TRUE(report["hand_error_mm"]["any"].is_null());
    EXPECT_TRUE(report["push_back_mm"].is_null());
}

TEST(ReportJson, EmptyRunHasAllFieldsAndZeros) {
    const Json empty = report_of(RunLog());
    const Json full = report_of(make_small_run());
    for (const auto& [key, value] : full.items()) {
        EXPECT_TRUE(empty.contains(key)) << key;
    }
    EXPECT_EQ(empty["frames"], 0);
    EXPECT_EQ(empty["frames_per_second"], 0.0);
    EXPECT_EQ(empty["frame_us"]["max"], 0.0);
    EXPECT_EQ(empty["path_m"], 0.0);
}

TEST(ReportJson, NameThatIsNotUtf8DoesNotStopTheReport) {
    RunLog log = make_small_run();
    log.scene = "a\xff";
    EXPECT_EQ(report_of(log)["scene"], "a\uFFFD");
}

TEST(ReportJson, PlayersNeedNamesAndMasses) {
    RunLog log = make_small_run();
    log.player_mass_kg.pop_back();
    EXPECT_THROW(format_report_json(log), PreconditionError);
    log = make_small_run();
    log.frames[0].players[0].player = 2;
    EXPECT_THROW(format_report_json(log), PreconditionError);
}

TEST(SummarizeTimes, PercentilesOfOneToHundredAreThemselves) {
    std::vector<double> times_us(100);
    std::iota(times_us.rbegin(), times_us.rend(), 1.0);
    const TimeFigures figures = summarize_times(times_us);
    EXPECT_EQ(figures.median_us, 50.0);
    EXPECT_EQ(figures.p99_us, 99.0);
    EXPECT_EQ(figures.max_us, 100.0);
    EXPECT_EQ(figures.total_us, 5050.0);
}

// Definition of the nearest rank: the smallest value that at least a fraction p of all do not
// exceed.
RC_GTEST_PROP(SummarizeTimes, AtLeastTheGivenShareIsNotAbove, ()) {
    const auto counts =
        *rc::gen::nonEmpty(rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 50)));
    const std::vector<double> times_us(counts.begin(), counts.end());
    const TimeFigures figures = summarize_times(times_us);
    const auto share_of = [&](const auto& counts_time) {
        return 100 * std::count_if(times_us.begin(), times_us.end(), counts_time);
    };
    const auto n = static_cast<std::ptrdiff_t>(times_us.size());
    RC_ASSERT(share_of([&](double t) { return t <= figures.median_us; }) >= 50 * n);
    RC_ASSERT(share_of([&](double t) { return t < figures.median_us; }) < 50 * n);
    RC_ASSERT(share_of([&](double t) { return t <= figures.p99_us; }) >= 99 * n);
    RC_ASSERT(share_of([&](double t) { return t < figures.p99_us; }) < 99 * n);
}

}  // namespace
}  // namespace handhold::report_json_test
