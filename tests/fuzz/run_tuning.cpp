#include "systems/host/tuning_json.hpp"
#include "systems/rigs/body_rig_fit.hpp"
#include "tests/fuzz/promise.hpp"

namespace handhold::fuzz {
namespace {

// The same bytes as a map of a body's joint names.
void run_body_map(Bytes bytes) {
    const Result<BodyMap> map = parse_body_map(text_of(bytes), "fuzz.json");
    promise(map.ok() || !map.error().expected.empty(), "a refusal says what was expected");
}

}  // namespace

void run_tuning(Bytes bytes) {
    run_body_map(bytes);
    const Result<Tuning> tuning = parse_tuning(text_of(bytes), "fuzz.json");
    if (!tuning) {
        promise(!tuning.error().expected.empty(), "a refusal says what was expected");
        return;
    }
    const std::string written = tuning_to_json(tuning.value());
    const Result<Tuning> again = parse_tuning(written, "again.json");
    promise(again.ok(), "what was read can be written and read again");
    promise(tuning_to_json(again.value()) == written, "and is the same");
}

}  // namespace handhold::fuzz
