// Invariances: position and rotation of the world, and the sample rate. determinism_test.cpp has
// those that hold bitwise.
#include <gtest/gtest.h>

#include "tests/systems/frame/scenario.hpp"

namespace handhold::scenario_invariance_test {
namespace {

// Crawls along a wall, waves a rock, shoves it into the wall, releases, drifts: every stage takes
// part.
struct Play {
    Scenario s;
    Entity rock;

    explicit Play(const Pose& frame_ws = {}) {
        s.frame_ws = frame_ws;
        s.add_wall("floor", Vec3(2.0, 0.05, 2.0), Vec3(0.0, 1.0, 0.0));
        s.add_wall("wall", Vec3(2.0, 2.0, 0.05), Vec3(0.0, 1.0, -0.5));
        rock = s.add_rock("rock", 5.0, Vec3(-0.3, 1.3, 0.0));
        s.add_player_here();
        const Vec3 right = hand_for_palm(s, Vec3(0.3, 1.06, 0.1));
        const Vec3 left = hand_for_palm(s, Vec3(-0.3, 1.385, 0.0));
        s.script.grabs[0] = [](double t) { return t > 0.3; };
        s.script.grabs[1] = [](double t) { return t > 0.05 && t < 1.507; };
        s.script.hands[1] = [=](double t) {
            return Pose{right + 0.1 * ease(t, 0.2, 0.8) *
                                    Vec3(std::sin(3 * t), 0.2 * std::sin(2 * t), std::sin(4 * t)),
                        rotation_about(Vec3::UnitY(), 0.2 * std::sin(t))};
        };
        s.script.hands[0] = [=](double t) {
            return Pose{left + Vec3(0.1 * std::sin(3 * t) * ease(t, 0.4, 0.8), 0.0,
                                    -0.5 * ease(t, 1.0, 1.4)),
                        rotation_about(Vec3::UnitX(), 0.2 * std::sin(2 * t) * ease(t, 0.4, 0.8))};
        };
        s.script.head = [](double t) {
            return Pose{Vec3(0.05 * std::sin(2 * t), 1.6, 0.6),
                        rotation_about(Vec3::UnitY(), 0.3 * std::sin(t))};
        };
    }
};

std::vector<Vec3> path_of(Play& play) {
    std::vector<Vec3> path;
    play.s.run(2.5, [&] {
        path.push_back(play.s.origin());
        path.push_back(play.s.body(play.rock).position);
    });
    return path;
}

class Placed : public testing::TestWithParam<int> {};

TEST_P(Placed, MovedWorldGivesTheSamePath) {
    const Vec3 far(10000.0, -3000.0, 7000.0);
    const Quat turned = rotation_from_vector(Vec3(0.7, -1.9, 0.4));
    const Pose places[] = {{far, Quat::Identity()}, {Vec3::Zero(), turned}, {far, turned}};
    Play here;
    Play there(places[GetParam()]);
    const std::vector<Vec3> expected = path_of(here);
    const std::vector<Vec3> found = path_of(there);
    for (std::size_t i = 0; i < expected.size(); ++i) {
        ASSERT_LE((expected[i] - found[i]).norm(), 1e-6) << "frame " << i / 2;
    }
}
INSTANTIATE_TEST_SUITE_P(TenKilometresAndTurned, Placed, testing::Range(0, 3));

TEST(StateHash, ChangesWithTheInput) {
    Play a;
    Play b;
    b.s.script.head = [](double) { return Pose{Vec3(0.0, 1.6, 0.6000001), Quat::Identity()}; };
    a.s.run(0.2);
    b.s.run(0.2);
    EXPECT_NE(hash_state(a.s.world), hash_state(b.s.world));
}

// A single support without contacts: the path depends on the hands, not on the rates.
class Rates : public testing::TestWithParam<double> {};

TEST_P(Rates, SingleSupportPathDoesNotDependOnTheRate) {
    const auto crawl = [](double hz) {
        Scenario s;
        s.hz = hz;
        s.sample_hz = 89.0;
        s.tuning.locomotion.drift_drag_per_s = 0.0;
        s.add_wall("floor", Vec3(2.0, 0.05, 2.0), Vec3(0.0, 1.0, 0.0));
        s.add_player_here();
        const Vec3 hand = hand_for_palm(s, Vec3(0.3, 1.06, 0.1));
        s.script.grabs[1] = [](double t) { return t > 0.103 && t < 1.507; };
        s.script.hands[1] = [=](double t) {
            return Pose{hand - 0.25 * Vec3(std::sin(3 * t), 0.4 * t, std::sin(2 * t)),
                        Quat::Identity()};
        };
        s.run(2.0);
        return s.origin();
    };
    const Vec3 expected = crawl(360.0);
    EXPECT_LE((crawl(GetParam()) - expected).norm(),
              0.005 + 0.01 * 0.5);  // 5 mm plus 1 % of the half metre drifted
}
INSTANTIATE_TEST_SUITE_P(Hz, Rates, testing::Values(60.0, 72.0, 90.0, 120.0, 144.0));

}  // namespace
}  // namespace handhold::scenario_invariance_test
