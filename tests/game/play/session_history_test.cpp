// Pause and rewind restore past frames bit for bit.
#include "game/play/session_history.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "tests/game/climber/climber_scene.hpp"

namespace handhold::session_history_test {
namespace {

constexpr hh::Pose k_origin_ws = hh::pose_at({-0.45, 0.35 - 1.6, 2.0});

// A player who looks around, grips the rail and pulls; the input differs in every frame.
DesktopInput input_of(int frame) {
    DesktopInput input;
    input.turn_left_rad = frame < 30 ? 0.03 : 0.002 * (frame % 7 - 3);
    input.look_up_rad = frame < 30 ? -0.006 : 0.0;
    input.grip[0] = frame > 35 && frame % 90 < 70;
    input.grip[1] = frame > 80 && frame % 60 < 40;
    input.move = {0.1 * (frame % 5), 0.0, -0.5};
    return input;
}

std::uint64_t hash_of(const DesktopSession& session) { return session.world().hash(); }

TEST(SessionHistory, RewindsToAnyFrameBitForBitAndContinuesEqually) {
    DesktopSession session(make_tunnel(6.0), k_origin_ws);
    session.record();
    SessionHistory history;
    std::vector<std::uint64_t> hashes = {hash_of(session)};
    for (int frame = 0; frame < 137; ++frame) {
        history.step(session, input_of(frame));
        hashes.push_back(hash_of(session));
    }
    int frame = 137;
    for (const int back : {1, 1, 9, 10, 23, 40}) {
        ASSERT_EQ(history.rewind(session, static_cast<std::size_t>(back)),
                  static_cast<std::size_t>(back));
        frame -= back;
        ASSERT_EQ(hash_of(session), hashes[static_cast<std::size_t>(frame)]) << frame;
        // One of the recording's samples is from before the first frame.
        EXPECT_EQ(session.recording().samples.size(), static_cast<std::size_t>(frame) + 1);
    }
    while (frame < 137) {
        history.step(session, input_of(frame++));
        ASSERT_EQ(hash_of(session), hashes[static_cast<std::size_t>(frame)]) << frame;
    }
}

TEST(SessionHistory, RewindsNoFartherThanItsRecords) {
    DesktopSession session(make_tunnel(6.0), k_origin_ws);
    const std::uint64_t start = hash_of(session);
    SessionHistory history;
    for (int frame = 0; frame < 25; ++frame) {
        history.step(session, input_of(frame));
    }
    EXPECT_EQ(history.frames(), 25U);
    EXPECT_EQ(history.rewind(session, 1000), 25U);
    EXPECT_EQ(hash_of(session), start);
    EXPECT_EQ(history.rewind(session, 1), 0U);
}

TEST(SessionHistory, StaysWithinItsMemoryAndDropsTheOldest) {
    DesktopSession session(make_tunnel(6.0), k_origin_ws);
    SessionHistory probe;
    probe.step(session, input_of(0));
    const std::size_t one = probe.bytes();
    ASSERT_GT(one, 0U);
    const std::size_t most = 5 * one + one / 2;
    SessionHistory history(most);
    std::vector<std::uint64_t> hashes;
    for (int frame = 0; frame < 200; ++frame) {
        hashes.push_back(hash_of(session));
        history.step(session, input_of(frame));
        ASSERT_LE(history.bytes(), most + one / 4);  // state of hands varies in size
    }
    const std::size_t frames = history.frames();
    EXPECT_GE(frames, 4 * SessionHistory::k_frames_a_snapshot);
    EXPECT_LE(frames, 6 * SessionHistory::k_frames_a_snapshot);
    ASSERT_EQ(history.rewind(session, frames), frames);
    EXPECT_EQ(hash_of(session), hashes[200 - frames]);
}

TEST(SessionHistory, ReplayedFramesUseTheTuningTheyHad) {
    DesktopSession session(make_tunnel(6.0), k_origin_ws);
    SessionHistory history;
    std::vector<std::uint64_t> hashes = {hash_of(session)};
    for (int frame = 0; frame < 120; ++frame) {
        if (frame == 63) {
            session.scene().tuning().locomotion.drift_drag_per_s = 2.0;
        }
        history.step(session, input_of(frame));
        hashes.push_back(hash_of(session));
    }
    for (int frame = 115; frame > 45; frame -= 5) {
        ASSERT_EQ(history.rewind(session, 5), 5U);
        EXPECT_EQ(hash_of(session), hashes[static_cast<std::size_t>(frame)]) << frame;
        EXPECT_EQ(session.scene().tuning().locomotion.drift_drag_per_s,
                  2.0);  // the present setting stays
    }
}

}  // namespace
}  // namespace handhold::session_history_test
