// The fuzzers' seeds and findings, replayed in every build.
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "engine/core/text_file.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/places.hpp"

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
                    Target{"net", fuzz::run_net}));

}  // namespace
}  // namespace handhold::fuzz_corpus_test
