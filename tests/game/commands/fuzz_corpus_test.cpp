// The fuzzers' seeds and findings, replayed in every build.
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/core/text_file.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/places.hpp"
#include "tests/random.hpp"

namespace handhold::fuzz_corpus_test {
namespace {

struct Target {
    const char* name;
    void (*run)(fuzz::Bytes bytes);
};
void PrintTo(const Target& target, std::ostream* stream) { *stream << target.name; }

class FuzzCorpus : public testing::TestWithParam<Target> {};

TEST_P(FuzzCorpus, EveryFileIsReadOrRefused) {
    const auto folder = source_dir() / "tests/fuzz/corpus" / GetParam().name;
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        SCOPED_TRACE(entry.path().filename().string());
        const std::string bytes = read_file(entry.path()).value();
        EXPECT_NO_THROW(
            GetParam().run({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}));
        ++files;
    }
    EXPECT_GT(files, 0);
}
INSTANTIATE_TEST_SUITE_P(
    Formats, FuzzCorpus,
    testing::Values(Target{"scene", fuzz::run_scene}, Target{"gltf", fuzz::run_gltf},
                    Target{"recording", fuzz::run_recording}, Target{"tuning", fuzz::run_tuning},
                    Target{"shots", fuzz::run_shots}, Target{"snapshot", fuzz::run_snapshot},
                    Target{"station", fuzz::run_station},
                    Target{"controller", fuzz::run_controller}, Target{"csv", fuzz::run_csv},
                    Target{"net", fuzz::run_net}, Target{"match", fuzz::run_match},
                    Target{"peers", fuzz::run_peers}));

// What .ci/run fuzzes of the network, with sanitizers too: changes at random, from fixed seeds.
// tools/fuzz searches on.
TEST(FuzzNetwork, RandomMessagesBreakNoPromise) {
    test::Random random(17);
#ifdef NDEBUG
    constexpr int k_rounds = 6000;
#else
    constexpr int k_rounds = 600;  // a debug build with sanitizers takes ten times as long
#endif
    const auto number = [&](double most) {
        return static_cast<std::uint8_t>(random.between(0.0, most));
    };
    for (int round = 0; round < k_rounds; ++round) {
        // Few changes, most of them: then much of a message is still read.
        std::vector<std::uint8_t> bytes = {number(256.0), number(256.0)};
        const double most = round % 4 == 0 ? 120.0 : 9.0;
        for (auto left = static_cast<int>(random.between(0.0, most)); left > 0; --left) {
            bytes.push_back(number(256.0));
        }
        SCOPED_TRACE(round);
        fuzz::run_match(bytes);
        fuzz::run_net(bytes);
        // A script: commands are small numbers.
        for (auto left = static_cast<int>(random.between(0.0, 60.0)); left > 0; --left) {
            const bool is_small = random.between(0.0, 1.0) < 0.7;
            bytes.push_back(number(is_small ? 80.0 : 256.0));
        }
        ASSERT_NO_THROW(fuzz::run_peers(bytes));
    }
}

}  // namespace
}  // namespace handhold::fuzz_corpus_test
