// `handhold-lab recorded-grips` on a made-up session, and the motions taken from its grips.
#include "tools/lab/recorded_grips.hpp"

#include <cmath>
#include <cstdio>

#include "lab_files.hpp"
#include "tests/random.hpp"

namespace handhold::lab::recorded_grips_test {
namespace {

constexpr double k_turn_radps = 0.5;
constexpr double k_press_s = 0.3;

// A right hand that turns in place about the axis x, with its grip button down from k_press_s on.
std::string turning_session() {
    std::string text =
        "t,hx,hy,hz,hqx,hqy,hqz,hqw,lx,ly,lz,lqx,lqy,lqz,lqw,lbtn,ltrig,"
        "rx,ry,rz,rqx,rqy,rqz,rqw,rbtn,rtrig\n";
    for (int i = 0; i < 135; ++i) {
        const double t_s = i / k_recorded_hz;
        const double half_rad = 0.5 * k_turn_radps * t_s;
        std::array<char, 240> row{};
        std::snprintf(row.data(), row.size(),
                      "%.9f,0,1.6,0,0,0,0,1,-0.2,1.2,-0.3,0,0,0,1,0,0,"
                      "0.2,1.3,-0.4,%.12f,0,0,%.12f,%d,0\n",
                      t_s, std::sin(half_rad), std::cos(half_rad), t_s < k_press_s ? 0 : 4);
        text += row.data();
    }
    return text;
}

RecordedGrip random_grip(std::size_t frames, test::Random& random) {
    RecordedGrip grip;
    grip.recording = "made up";
    grip.hand = "right";
    for (std::size_t i = 0; i < frames; ++i) {
        grip.wrists.push_back(i == 0 ? Pose{} : random.pose(0.1));
        grip.us.push_back(40.0);
    }
    return grip;
}

using RecordedGrips = LabTest;

// A hand may turn on a fixed box, and its wrist stays at the anchor.
TEST_F(RecordedGrips, WristTurnsAsRecordedAndStaysInPlace) {
    const std::string session = (folder_ / "turning.csv").string();
    const std::string scene = (folder_ / "box.json").string();
    EXPECT_FALSE(write_file_atomically(session, turning_session()));
    EXPECT_FALSE(
        write_file_atomically(scene, R"({"name": "box", "bodies": [{"name": "box", "kind": "static",
                   "shape": {"type": "box", "half_m": [0.4, 0.4, 0.4]}}]})"));
    const RecordedGripsOptions options = {scene, {session}, folder_ / "grips.jsonl"};
    ASSERT_EQ(recorded_grips_command(options), 0);
    const auto grips = load_recorded_grips(options.out);
    ASSERT_TRUE(grips);
    ASSERT_EQ(grips.value().size(), 1U);
    const RecordedGrip& grip = grips.value().front();
    EXPECT_EQ(grip.recording, "turning.csv");
    EXPECT_EQ(grip.hand, "right");
    EXPECT_GT(grip.wrists.size(), 90U);
    EXPECT_EQ(grip.us.size(), grip.wrists.size());
    EXPECT_EQ(grip.out_of_sight.size(), grip.wrists.size());
    for (std::size_t i = 0; i < grip.wrists.size(); ++i) {
        EXPECT_LT(grip.wrists[i].position.norm(), 1e-6) << i;
        EXPECT_NEAR(rotation_to_vector(grip.wrists[i].rotation).norm(),
                    k_turn_radps * static_cast<double>(i) / k_recorded_hz, 0.02)
            << i;
        EXPECT_GT(grip.us[i], 0.0);
    }
}

TEST_F(RecordedGrips, UnreadableInputIsRefused) {
    EXPECT_EQ(recorded_grips_command({"playground", {"none.csv"}, folder_ / "grips.jsonl"}), 2);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "grips.jsonl"));
}

TEST(WristMotions, AreStretchesOfGripsRelativeToTheirFirstWrist) {
    test::Random random(2611);
    for (int i = 0; i < 50; ++i) {
        std::vector<RecordedGrip> grips;
        std::size_t stretches = 0;
        const std::size_t frames = 3 + static_cast<std::size_t>(i) % 5;
        for (int k = 0; k < 6; ++k) {
            const auto length = static_cast<std::size_t>(random.between(1.0, 30.0));
            grips.push_back(random_grip(length, random));
            stretches += (length - 1) / frames;
        }
        const auto motions = wrist_motions(grips, frames, stretches);
        ASSERT_EQ(motions.size(), stretches);
        std::size_t next = 0;  // all stretches, in order, once each
        for (const RecordedGrip& grip : grips) {
            for (std::size_t begin = 0; begin + frames < grip.wrists.size(); begin += frames) {
                const auto& motion = motions[next++];
                ASSERT_EQ(motion.size(), frames);
                for (std::size_t f = 0; f < frames; ++f) {
                    const Pose again = grip.wrists[begin] * motion[f];
                    EXPECT_LT((again.position - grip.wrists[begin + f + 1].position).norm(), 1e-12);
                }
            }
        }
        EXPECT_EQ(wrist_motions(grips, frames, 4).size(), stretches > 0 ? 4U : 0U);
    }
}

}  // namespace
}  // namespace handhold::lab::recorded_grips_test
