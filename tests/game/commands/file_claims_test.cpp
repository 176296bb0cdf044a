// A number in a small file must not make the game allocate gigabytes. glTF levels and snapshots are
// tested beside their other tests.
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "game/run/session_run.hpp"
#include "game/scene/scene.hpp"
#include "game/session/recording.hpp"
#include "systems/host/tuning_json.hpp"
#include "tests/engine/allocation_count.hpp"

namespace handhold::file_claims_test {
namespace {

constexpr std::size_t k_megabyte = std::size_t{1} << 20U;

// Bytes that `use` allocates.
template <typename Use>
std::size_t bytes_taken(Use&& use) {
    const std::size_t before = allocated_bytes();
    use();
    return allocated_bytes() - before;
}

class FileClaims : public testing::Test {
  protected:
    void SetUp() override {
        if (!counts_allocations()) {
            GTEST_SKIP() << "a sanitizer's own operator new does not count";
        }
    }
};

TEST_F(FileClaims, ScenesOfHugeNumbersTakeNoMemory) {
    for (
        const char* const body :
        {R"("shape": {"type": "sphere", "radius_m": 1e4})",
         R"("shape": {"type": "capsule", "radius_m": 1e-3, "half_height_m": 1e4})",
         R"("shape": {"type": "box", "half_m": [1e9, 1e9, 1e9]})",
         R"("position_m": [1e6, -1e6, 1e6], "shape": {"type": "sphere", "radius_m": 1073741824})"}) {
        const std::string text =
            std::string(R"({"name": "n", "bodies": [{"name": "b", "kind": "static", )") + body +
            "}]}";
        const std::size_t taken = bytes_taken([&] {
            if (const Result<SceneFile> file = parse_scene_file(text, "claim.json")) {
                EXPECT_TRUE(build_scene(file.value(), "claim.json").ok()) << body;
            }
        });
        EXPECT_LT(taken, k_megabyte) << body;
    }
}

TEST_F(FileClaims, TuningOfHugeNumbersTakesNoMemory) {
    const char* const text = R"({"solver": {"max_iterations": 1073741824}})";
    EXPECT_LT(bytes_taken([&] { EXPECT_FALSE(parse_tuning(text, "claim.json").ok()); }),
              k_megabyte);
}

// Two samples thirty years apart: memory grows only as they are played.
TEST_F(FileClaims, RecordingsOfManyYearsTakeMemoryAsTheyArePlayed) {
    const std::string columns =
        "t,hx,hy,hz,hqx,hqy,hqz,hqw,lx,ly,lz,lqx,lqy,lqz,lqw,lbtn,ltrig,"
        "rx,ry,rz,rqx,rqy,rqz,rqw,rbtn,rtrig\n";
    const std::string pose = ",0,0,0,0,0,0,1";
    const std::string devices = pose + pose + ",0,0" + pose + ",0,0\n";
    Recording recording;
    EXPECT_LT(bytes_taken([&] {
                  Result<Recording> read =
                      parse_recording(columns + "0" + devices + "1e9" + devices, "claim.csv");
                  ASSERT_TRUE(read.ok()) << read.error().message();
                  recording = std::move(read.value());
              }),
              k_megabyte);
    Scene scene;
    const std::size_t taken = bytes_taken([&] {
        EXPECT_THROW(run_session(scene, {}, &recording, {},
                                 [](const Scene&, const FrameLog& frame) {
                                     if (frame.frame > 3) {
                                         throw std::runtime_error("seen enough");
                                     }
                                 }),
                     std::runtime_error);
    });
    EXPECT_LT(taken, 16 * k_megabyte);
}

}  // namespace
}  // namespace handhold::file_claims_test
