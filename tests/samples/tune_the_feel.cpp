// The guide's sample of tuning: numbers in code and from JSON, and what a bad value gives.
#include <cstdio>
#include <string>

#include <handhold/ecs.hpp>

using namespace handhold;

int main() {
    // [tuning]
    Tuning tuning;
    tuning.hand.reach_m = 0.12;                       // in code
    const std::string json = tuning_to_json(tuning);  // every number, as a file has it

    const Result<Tuning> from_file =
        parse_tuning(R"({"hand": {"reach_m": 0.2}, "palm": {"rate_mps": 0.4}})", "feel.json");
    const Result<Tuning> refused = parse_tuning(R"({"hand": {"reach_m": -1}})", "feel.json");

    visit_tuning(tuning, [](const TuningInfo& info, const auto&) {
        std::printf("%-36s %-6s [%g, %g] %s\n", info.name, info.unit, info.low, info.high,
                    info.what);
    });
    // [tuning]
    return from_file && !refused && from_file.value().hand.reach_m == 0.2 && !json.empty() ? 0 : 1;
}
