#include <cmath>

#include "game/levels/station_description.hpp"
#include "tests/fuzz/promise.hpp"

namespace handhold::fuzz {

void run_station(Bytes bytes) {
    const Result<StationDescription> station =
        parse_station_description(text_of(bytes), "fuzz.json");
    if (!station) {
        promise(!station.error().expected.empty(), "a refusal says what was expected");
        return;
    }
    for (const StationSection& section : station.value().sections) {
        promise(section.name.find_first_of("/\\\n") == std::string::npos,
                "a section's name is a file name");
    }
    for (const StationSpawn& spawn : station.value().spawns) {
        promise(is_finite(spawn.eyes) && is_finite(spawn.ahead), "a spawn has finite numbers");
    }
}

}  // namespace handhold::fuzz
