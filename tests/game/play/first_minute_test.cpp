// A stranger's first seconds at a desktop: they look about, press a hand's button where the mark is
// green, and pull. Played with the game's own input emulation, from where the game begins.
#include <cstdio>

#include <gtest/gtest.h>

#include "game/commands/play_files.hpp"
#include "game/play/desktop_session.hpp"
#include "game/ui/first_hint.hpp"
#include "tests/random.hpp"

namespace handhold::first_minute_test {
namespace {

using test::Random;

constexpr int k_strangers = 24;
constexpr int k_needed = 20;
constexpr double k_seconds = 15.0;
constexpr double k_look_radps = 2.0;   // how fast they turn the view
constexpr double k_reaction_s = 0.3;   // from the green mark to the pressed button; they still turn
constexpr double k_hold_s = 1.5;       // how long they hold a button that does nothing
constexpr double k_same_keys_s = 0.7;  // how long they try the same keys while they hold on
constexpr double k_pulled_m = 0.2;

// What a stranger does, from a seed. Knows what is on the screen: whether the mark is green,
// whether the hand holds something, and whether the view moves.
class Stranger {
  public:
    explicit Stranger(std::uint64_t seed) : random_(seed) {}

    DesktopInput next(bool can_reach, bool grips, double dt_s) {
        DesktopInput input;
        if (pressed_s_ > 0.0) {
            pressed_s_ = grips ? k_hold_s : pressed_s_ - dt_s;
            input.grip[side_] = pressed_s_ > 0.0;
            input.opened[side_] = !input.grip[side_];
            if (grips) {  // other keys every now and then
                pulls_s_ += dt_s;
                if (pulls_s_ > k_same_keys_s) {
                    pull_ = to_host(random_.direction());
                    pulls_s_ = 0.0;
                }
                input.move = pull_;
            }
            return input;
        }
        green_s_ = can_reach ? green_s_ + dt_s : 0.0;
        if (green_s_ > k_reaction_s) {
            side_ = random_.between(0.0, 1.0) < 0.5 ? 0 : 1;
            pull_ = to_host(random_.direction());
            pressed_s_ = k_hold_s;
            green_s_ = 0.0;
            return input;
        }
        if (to_turn_rad_ == 0.0 && to_look_rad_ == 0.0) {
            to_turn_rad_ = random_.between(-k_pi, k_pi);
            const double wanted_rad = random_.between(-1.0, 1.0);
            to_look_rad_ = wanted_rad - looks_up_rad_;
        }
        const auto part = [&](double& left) {
            const double now = std::clamp(left, -k_look_radps * dt_s, k_look_radps * dt_s);
            left -= now;
            return now;
        };
        input.turn_left_rad = part(to_turn_rad_);
        input.look_up_rad = part(to_look_rad_);
        looks_up_rad_ += input.look_up_rad;
        return input;
    }

  private:
    Random random_;
    std::size_t side_ = 0;
    hh::Vec3 pull_{};
    double pressed_s_ = 0.0, green_s_ = 0.0, pulls_s_ = 0.0;
    double to_turn_rad_ = 0.0, to_look_rad_ = 0.0, looks_up_rad_ = 0.0;
};

struct Minute {
    double grips_s = -1.0;   // of the first grip on which they can pull; negative: none
    double pulled_m = 0.0;   // farthest from the start while gripping
    int hints = 0;           // how often the hint changed
    bool hint_gone = false;  // once the last line's time is over
};

constexpr double k_last_line_s = 10.0;  // longer than the last line is shown

Minute play(DesktopSession& session, const DesktopState& start, std::uint64_t seed) {
    session.restore(start);
    Stranger stranger(seed);
    FirstHint hint;
    Minute minute;
    const hh::Vec3 from = session.world().pose(session.player())->origin.position;
    hh::Vec3 last = from;
    std::string hinted = hint.text();
    while (session.world().time_s() < k_seconds) {
        const bool grips = session.world().moves_player(session.player(), HH_LEFT) ||
                           session.world().moves_player(session.player(), HH_RIGHT);
        session.step(stranger.next(session.body().can_reach(), grips, DesktopSession::k_dt_s));
        const hh::Vec3 at = session.world().pose(session.player())->origin.position;
        hint.advance({session.body().can_reach(), grips, hh::length(at - last)},
                     DesktopSession::k_dt_s);
        last = at;
        minute.hints += hint.text() != hinted ? 1 : 0;
        hinted = hint.text();
        if (grips) {
            minute.grips_s = minute.grips_s < 0.0 ? session.world().time_s() : minute.grips_s;
            minute.pulled_m = std::max(minute.pulled_m, hh::length(at - from));
        }
    }
    hint.advance({}, k_last_line_s);
    hint.advance({}, k_last_line_s);
    minute.hint_gone = hint.text()[0] == '\0';
    return minute;
}

struct Counts {
    int grip = 0;          // who grip and pull themselves
    int hints_gone = 0;    // who need no hint any more
    int hints_follow = 0;  // whose hint went through its lines: look, press, pull, let go
};

// Prints one line for each who does not grip and pull.
Counts play_strangers(DesktopSession& session, const std::string& scene) {
    const DesktopState start = session.save();
    Counts counts;
    std::vector<double> times_s;
    for (std::uint64_t seed = 0; seed < k_strangers; ++seed) {
        const Minute minute = play(session, start, 5300 + seed);
        const bool pulls = minute.grips_s >= 0.0 && minute.pulled_m > k_pulled_m;
        counts.grip += pulls ? 1 : 0;
        counts.hints_gone += minute.hint_gone ? 1 : 0;
        counts.hints_follow += minute.hints >= 3 ? 1 : 0;
        if (pulls) {
            times_s.push_back(minute.grips_s);
        } else {
            std::printf("%s: stranger %d: first grip %.1f s, pulled %.2f m\n", scene.c_str(),
                        static_cast<int>(seed), minute.grips_s, minute.pulled_m);
        }
    }
    std::ranges::sort(times_s);
    std::printf(
        "%s: %d of %d strangers grip and pull within %.0f s, half of them after %.1f s; the "
        "hint is gone for %d\n",
        scene.c_str(), counts.grip, k_strangers, k_seconds,
        times_s.empty() ? 0.0 : times_s[times_s.size() / 2], counts.hints_gone);
    return counts;
}

DesktopSession begin(const std::string& scene) {
    PlayOptions options;
    options.scene = scene;
    Result<PlayedScene> loaded = load_played_scene(options);
    EXPECT_TRUE(loaded.ok());
    DesktopSession session(std::move(loaded.value().scene), loaded.value().place.pose_ws);
    session.face_nearest_surface();
    return session;
}

class FirstMinute : public testing::TestWithParam<const char*> {};

TEST_P(FirstMinute, BeginsBeforeSomethingWithinReach) {
    DesktopSession session = begin(GetParam());
    session.step({});
    EXPECT_TRUE(session.body().can_reach());
}

TEST_P(FirstMinute, TwentyOfTwentyFourStrangersGripAndPull) {
    DesktopSession session = begin(GetParam());
    const Counts counts = play_strangers(session, GetParam());
    EXPECT_GE(counts.grip, k_needed);
    EXPECT_GE(counts.hints_gone, k_needed);
    EXPECT_GE(counts.hints_follow, k_needed);
}

INSTANTIATE_TEST_SUITE_P(Scenes, FirstMinute, testing::Values("station", "playground"));

// The measure can fail: far from everything nobody grips, and the hint stays as it is.
TEST(FirstMinuteMeasure, NobodyGripsFarFromEverything) {
    PlayOptions options;
    Result<PlayedScene> loaded = load_played_scene(options);
    ASSERT_TRUE(loaded.ok());
    hh::Pose far_ws = loaded.value().place.pose_ws;
    far_ws.position.y += 60.0;
    DesktopSession session(std::move(loaded.value().scene), far_ws);
    const Counts counts = play_strangers(session, "far away");
    EXPECT_EQ(counts.grip, 0);
    EXPECT_EQ(counts.hints_gone, 0);
    EXPECT_EQ(counts.hints_follow, 0);
}

}  // namespace
}  // namespace handhold::first_minute_test
