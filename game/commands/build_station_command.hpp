#pragma once

#include <string>

namespace handhold {

struct BuildStationOptions {
    std::string description;  // path of a file; empty: the game's station
    std::string out;          // folder
};

// `handhold build-station`: writes a station's scene file and models. Returns the exit status.
int build_station_command(const BuildStationOptions& options);

}  // namespace handhold
