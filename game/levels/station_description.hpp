#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/math/math.hpp"
#include "game/levels/station_kit.hpp"
#include "game/levels/station_rack.hpp"
#include "game/mesh/render_frame.hpp"

// A station as data (docs/reference/station_format.md). Lengths in metres. The frame of a section
// has its origin in the middle of the section's near end, +Z along the section, +Y up. Nodes and
// cupolas have other origins: see the format.
namespace handhold {

enum class SectionType : std::uint8_t { node, module, cupola, truss };

// How a module's far end is closed. `open`: the door stands open, outside. `hatch`: another section
// can be attached.
enum class EndKind : std::uint8_t { hatch, door, window, open };

enum class WallSide : std::uint8_t { floor, right, ceiling, left };
inline constexpr std::size_t k_wall_count = 4;

// Where a rail is mounted: on a wall, or on the strip along the top of a module. The two strips of
// a truss are `left` and `right`.
struct RailLine {
    std::string name;
    WallSide wall = WallSide::floor;
    bool outside = false;   // true: on the strip along the top; `wall` is unused
    double across_m = 0.0;  // distance along the wall's X from its middle
    double from_m = 0.0;    // distance along the section's Z
    double to_m = 1.0;
};

// A cable or hose: a circle swept along a smooth curve through the points.
struct HoseLine {
    Material material = Material::cable;
    double radius_m = 0.02;
    std::vector<Vec3> points;  // two or more, in the section's frame
};

struct StationSection {
    std::string name;
    SectionType type = SectionType::module;
    std::string attached_to;  // name of an earlier section; empty: placed by `pose`
    // Attached to a node: port, in quarter turns from the node's +Z to the left; to a module:
    // unused.
    int port = 0;
    Pose pose;
    std::size_t racks = 5;  // module: length in racks; truss: bays
    EndKind far_end = EndKind::door;
    Color accent = {0.5F, 0.5F, 0.5F};
    std::size_t seed = 1;
    // module: one for each rack, by WallSide.
    std::array<std::vector<RackKind>, k_wall_count> walls;
    std::vector<RailLine> rails;
    std::vector<HoseLine> hoses;
    std::vector<Lamp> lamps;  // lamps in the section's frame, in addition to the section's own
};

enum class ToolType : std::uint8_t {
    wrench,
    torch,
    tablet,
    bag,
    bottle,
    drill,
    camera,
    tape,
    canister,
    ball,
    book,
    helmet
};

// A free body that floats in the station.
struct StationTool {
    std::string name;
    ToolType type = ToolType::wrench;
    Pose pose;
    Vec3 velocity_mps = Vec3::Zero();
    Vec3 angular_velocity_radps = Vec3::Zero();
};

// A spawn, given by the position and the view direction of the eyes.
struct StationSpawn {
    std::string name;
    Vec3 eyes = Vec3::Zero();
    Vec3 ahead = -Vec3::UnitZ();
};

struct StationDescription {
    std::string name;
    std::string description;
    std::string session;  // name of a built-in session that shows the station; may be empty
    std::vector<StationSection> sections;
    std::vector<StationTool> tools;
    std::vector<StationSpawn> spawns;
};

// Errors name the JSON pointer and the value: values out of range or of the wrong type, unknown
// keys, names that are taken or are no file names, and sections attached to a later section, to no
// port, or to a port that is taken.
Result<StationDescription> parse_station_description(std::string_view text,
                                                     const std::filesystem::path& path);
Result<StationDescription> load_station_description(const std::filesystem::path& path);
// game/assets/station.json, which is compiled into the program.
const StationDescription& own_station_description();

}  // namespace handhold
