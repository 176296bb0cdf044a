#include "game/commands/build_station_command.hpp"

#include <cstdio>
#include <filesystem>

#include "engine/core/printable.hpp"
#include "game/commands/output_folder.hpp"
#include "game/levels/built_in_scenes.hpp"
#include "game/levels/station_description.hpp"
#include "game/levels/station_scene.hpp"
#include "game/play/exit_status.hpp"
#include "game/session/interrupt.hpp"

namespace handhold {

int build_station_command(const BuildStationOptions& options) {
    const InterruptGuard interrupts;  // a signal does not end the program in the middle of a file
    StationDescription description;
    if (options.description.empty()) {
        description = own_station_description();
    } else {
        Result<StationDescription> read = load_station_description(options.description);
        if (!read) {
            return refuse(read.error());
        }
        description = std::move(read.value());
    }
    StationScene station = make_station_scene(description);
    add_session_spawn(station.scene);
    const Result<OutputFolder> folder = OutputFolder::open(options.out);
    if (!folder) {
        return refuse(folder.error());
    }
    if (const auto error = write_station(station, options.out)) {
        return refuse(*error);
    }
    std::size_t triangles = 0;
    const Structure& structure = station.models.front().structure;
    for (const Mesh& part : structure.parts) {
        triangles += part.triangles.size();
    }
    std::printf(
        "%s: %zu sections, %zu parts, %zu triangles, %zu rails, %zu tools\n",
        printable((std::filesystem::path(options.out) / (station.scene.name + ".json")).string())
            .c_str(),
        description.sections.size(), structure.parts.size(), triangles, structure.rails.size(),
        description.tools.size());
    return is_interrupted() ? k_exit_interrupted : 0;
}

}  // namespace handhold
