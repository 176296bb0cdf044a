// libFuzzer's entry. One executable a target: HANDHOLD_FUZZ_TARGET is its function.
#include "tests/fuzz/targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    handhold::fuzz::HANDHOLD_FUZZ_TARGET({data, size});
    return 0;
}
