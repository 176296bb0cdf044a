#include "game/levels/station_description.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "engine/core/check.hpp"
#include "engine/core/text_file.hpp"
#include "engine/io/file_name.hpp"
#include "engine/io/json.hpp"
#include "game/assets/assets.hpp"
#include "game/scene/scene_ranges.hpp"

namespace handhold {
namespace {

constexpr NumberRange k_place_m = {-1e3, 1e3, false};
constexpr NumberRange k_radius_m = {0.002, 0.5, false};
constexpr NumberRange k_drift_mps = {-2.0, 2.0, false};
constexpr NumberRange k_spin_radps = {-6.0, 6.0, false};
constexpr std::int64_t k_max_racks = 64;
constexpr std::size_t k_max_points = 256;

template <typename T>
struct Word {
    std::string_view text;
    T value;
};

constexpr std::array<Word<SectionType>, 8> k_section_types = {{
    {"node", SectionType::node},
    {"habitat", SectionType::module},
    {"laboratory", SectionType::module},
    {"airlock", SectionType::module},
    {"storage", SectionType::module},
    {"greenhouse", SectionType::module},
    {"cupola", SectionType::cupola},
    {"truss", SectionType::truss},
}};
constexpr std::array<Word<EndKind>, 4> k_end_kinds = {{{"hatch", EndKind::hatch},
                                                       {"door", EndKind::door},
                                                       {"window", EndKind::window},
                                                       {"open", EndKind::open}}};
constexpr std::array<Word<RackKind>, 7> k_rack_kinds = {{{"deck", RackKind::deck},
                                                         {"equipment", RackKind::equipment},
                                                         {"lights", RackKind::lights},
                                                         {"stowage", RackKind::stowage},
                                                         {"garden", RackKind::garden},
                                                         {"bunk", RackKind::bunk},
                                                         {"bench", RackKind::bench}}};
constexpr std::array<Word<WallSide>, k_wall_count> k_walls = {{{"floor", WallSide::floor},
                                                               {"right", WallSide::right},
                                                               {"ceiling", WallSide::ceiling},
                                                               {"left", WallSide::left}}};
constexpr std::array<Word<int>, 4> k_ports = {{{"+z", 0}, {"+x", 1}, {"-z", 2}, {"-x", 3}}};
constexpr std::array<Word<Material>, 4> k_hose_materials = {{{"cable", Material::cable},
                                                             {"accent", Material::accent},
                                                             {"metal", Material::metal},
                                                             {"fabric", Material::fabric}}};
constexpr std::array<Word<ToolType>, 12> k_tool_types = {{{"wrench", ToolType::wrench},
                                                          {"torch", ToolType::torch},
                                                          {"tablet", ToolType::tablet},
                                                          {"bag", ToolType::bag},
                                                          {"bottle", ToolType::bottle},
                                                          {"drill", ToolType::drill},
                                                          {"camera", ToolType::camera},
                                                          {"tape", ToolType::tape},
                                                          {"canister", ToolType::canister},
                                                          {"ball", ToolType::ball},
                                                          {"book", ToolType::book},
                                                          {"helmet", ToolType::helmet}}};

// Reads a word and returns its value. An unknown word is kept as the document's error and gives the
// first value.
template <typename T, std::size_t N>
T read_word(const JsonValue& value, const std::array<Word<T>, N>& words) {
    const std::string text = value.text();
    std::string all;
    for (const Word<T>& word : words) {
        if (word.text == text) {
            return word.value;
        }
        all += (all.empty() ? "" : ", ") + std::string(word.text);
    }
    value.refuse("one of " + all);
    return words.front().value;
}

// Names are used as file names and as components of paths such as "hab/rail_0".
std::string read_file_name(const JsonValue& value) {
    std::string name = value.text();
    if (!is_file_name(name)) {
        value.refuse(
            "a name that can be a file's: at most 100 bytes of letters, digits, _, - and "
            "spaces, without a dot at the start");
    }
    return name;
}

std::string read_part_name(const JsonValue& value, std::set<std::string>& taken) {
    std::string name = read_file_name(value);
    if (!taken.insert(name).second) {
        value.refuse("a name that nothing else of its kind has");
    }
    return name;
}

class DescriptionReader {
  public:
    explicit DescriptionReader(const JsonValue& root) : root_(root) {}
    StationDescription read();

  private:
    void read_section(const JsonValue& value);
    void read_place(const JsonValue& value, StationSection& section);
    static void read_walls(const JsonValue& value, StationSection& section);
    static RailLine read_rail(const JsonValue& value, std::set<std::string>& names);
    static HoseLine read_hose(const JsonValue& value);
    static Lamp read_lamp(const JsonValue& value);
    StationTool read_tool(const JsonValue& value);
    StationSpawn read_spawn(const JsonValue& value);

    JsonValue root_;
    StationDescription made_;
    std::set<std::string> section_names_, tool_names_, spawn_names_;
    std::set<std::pair<std::string, int>> taken_ports_;
};

RailLine DescriptionReader::read_rail(const JsonValue& value, std::set<std::string>& names) {
    value.allow_only({"name", "wall", "across_m", "from_m", "to_m"});
    RailLine rail;
    rail.name = read_part_name(value["name"], names);
    rail.outside = value["wall"].is_text() && value["wall"].text() == "outside";
    if (!rail.outside) {
        rail.wall = read_word(value["wall"], k_walls);
    }
    rail.across_m = value["across_m"].number_or(0.0, k_place_m);
    rail.from_m = value["from_m"].number(k_place_m);
    rail.to_m = value["to_m"].number({rail.from_m + 0.2, 1e3, false});
    return rail;
}

HoseLine DescriptionReader::read_hose(const JsonValue& value) {
    value.allow_only({"material", "radius_m", "points_m"});
    HoseLine hose;
    hose.material = read_word(value["material"], k_hose_materials);
    hose.radius_m = value["radius_m"].number(k_radius_m);
    const std::vector<JsonValue> points = value["points_m"].items();
    if (points.size() < 2 || points.size() > k_max_points) {
        value["points_m"].refuse("2 to 256 points");
    }
    for (const JsonValue& point : points) {
        hose.points.push_back(point.vector(k_place_m));
        if (hose.points.size() > 1 &&
            (hose.points.back() - hose.points[hose.points.size() - 2]).norm() < 0.01) {
            point.refuse("a point at least 1 cm from the one before");
        }
    }
    return hose;
}

Lamp DescriptionReader::read_lamp(const JsonValue& value) {
    value.allow_only({"position_m", "color", "reach_m"});
    return {value["position_m"].vector(k_place_m), read_color(value["color"], k_brightness),
            value["reach_m"].number({0.1, 100.0, false})};
}

void DescriptionReader::read_place(const JsonValue& value, StationSection& section) {
    const JsonValue attach = value["attach"];
    if (!attach.exists()) {
        section.pose = {value["position_m"].vector_or(Vec3::Zero(), k_place_m),
                        value["rotation_xyzw"].rotation_or(Quat::Identity())};
        return;
    }
    attach.allow_only({"to", "port"});
    section.attached_to = attach["to"].text();
    for (const char* key : {"position_m", "rotation_xyzw"}) {
        if (value[key].exists()) {
            value[key].refuse("nothing beside \"attach\"");
        }
    }
    const auto owner = std::find_if(
        made_.sections.begin(), made_.sections.end(),
        [&](const StationSection& other) { return other.name == section.attached_to; });
    const bool is_end = owner != made_.sections.end() && owner->type == SectionType::module &&
                        owner->far_end == EndKind::hatch;
    const bool is_node = owner != made_.sections.end() && owner->type == SectionType::node;
    if (!is_end && !is_node) {
        attach["to"].refuse("an earlier node, or a module whose far end is a hatch");
        return;
    }
    if (is_node) {
        section.port = read_word(attach["port"], k_ports);
    } else if (section.type != SectionType::node) {
        attach["to"].refuse("an earlier node: only a node can be attached to a module");
    } else if (attach["port"].exists()) {
        attach["port"].refuse("nothing: a module has one");
    }
    if (section.type == SectionType::truss) {
        attach.refuse("nothing: a truss is placed by \"position_m\"");
    }
    if (section.type == SectionType::node) {
        taken_ports_.insert({section.name, 2});  // the node is attached by its -Z port
    }
    if (!taken_ports_.insert({section.attached_to, section.port}).second) {
        attach["port"].refuse("a port that nothing else is attached to");
    }
}

void DescriptionReader::read_walls(const JsonValue& value, StationSection& section) {
    constexpr std::array<RackKind, k_wall_count> k_usual = {RackKind::deck, RackKind::equipment,
                                                            RackKind::lights, RackKind::equipment};
    const JsonValue walls = value["walls"];
    if (walls.exists()) {
        walls.allow_only({"floor", "right", "ceiling", "left"});
    }
    for (std::size_t wall = 0; wall < k_wall_count; ++wall) {
        std::vector<RackKind>& kinds = section.walls[wall];
        const JsonValue given = walls.exists() ? walls[k_walls[wall].text] : walls;
        if (!given.exists() || given.is_text()) {
            const RackKind kind = given.exists() ? read_word(given, k_rack_kinds) : k_usual[wall];
            kinds.assign(section.racks, kind);
            continue;
        }
        const std::vector<JsonValue> items = given.items();
        if (items.size() != section.racks) {
            given.refuse("one kind, or " + std::to_string(section.racks) + ": one a rack");
        }
        for (const JsonValue& item : items) {
            kinds.push_back(read_word(item, k_rack_kinds));
        }
    }
}

void DescriptionReader::read_section(const JsonValue& value) {
    value.allow_only({"name", "type", "attach", "position_m", "rotation_xyzw", "racks", "bays",
                      "far_end", "accent", "seed", "walls", "rails", "hoses", "lamps"});
    StationSection section;
    section.name = read_part_name(value["name"], section_names_);
    section.type = read_word(value["type"], k_section_types);
    const bool is_module = section.type == SectionType::module;
    if (is_module) {
        section.racks = static_cast<std::size_t>(value["racks"].integer(1, k_max_racks));
        section.far_end = read_word(value["far_end"], k_end_kinds);
    } else if (section.type == SectionType::truss) {
        section.racks = static_cast<std::size_t>(value["bays"].integer(2, k_max_racks));
    }
    for (const char* key : {"racks", "far_end", "walls"}) {
        if (!is_module && value[key].exists()) {
            value[key].refuse("nothing: only modules have it");
        }
    }
    read_place(value, section);
    section.accent = read_color(value["accent"], k_unit_interval);
    section.seed = static_cast<std::size_t>(value["seed"].integer(1, 1000000));
    if (is_module) {
        read_walls(value, section);
    }
    std::set<std::string> rail_names;
    for (const JsonValue& rail : value["rails"].optional_items()) {
        section.rails.push_back(read_rail(rail, rail_names));
    }
    for (const JsonValue& hose : value["hoses"].optional_items()) {
        section.hoses.push_back(read_hose(hose));
    }
    for (const JsonValue& lamp : value["lamps"].optional_items()) {
        section.lamps.push_back(read_lamp(lamp));
    }
    made_.sections.push_back(std::move(section));
}

StationTool DescriptionReader::read_tool(const JsonValue& value) {
    value.allow_only(
        {"name", "type", "position_m", "rotation_xyzw", "velocity_mps", "angular_velocity_radps"});
    return {read_part_name(value["name"], tool_names_),
            read_word(value["type"], k_tool_types),
            {value["position_m"].vector(k_place_m),
             value["rotation_xyzw"].rotation_or(Quat::Identity())},
            value["velocity_mps"].vector_or(Vec3::Zero(), k_drift_mps),
            value["angular_velocity_radps"].vector_or(Vec3::Zero(), k_spin_radps)};
}

StationSpawn DescriptionReader::read_spawn(const JsonValue& value) {
    value.allow_only({"name", "eyes_m", "ahead"});
    StationSpawn spawn = {read_part_name(value["name"], spawn_names_),
                          value["eyes_m"].vector(k_place_m), value["ahead"].vector(k_place_m)};
    if (spawn.ahead.cross(Vec3::UnitY()).norm() < 1e-3) {
        value["ahead"].refuse("a direction that is not straight up or down");
    }
    return spawn;
}

StationDescription DescriptionReader::read() {
    root_.allow_only({"name", "description", "session", "sections", "tools", "spawns"});
    made_.name = read_file_name(root_["name"]);
    made_.description = root_["description"].text_or({});
    made_.session = root_["session"].text_or({});
    for (const JsonValue& section : root_["sections"].items()) {
        read_section(section);
    }
    for (const JsonValue& tool : root_["tools"].optional_items()) {
        made_.tools.push_back(read_tool(tool));
    }
    for (const JsonValue& spawn : root_["spawns"].optional_items()) {
        made_.spawns.push_back(read_spawn(spawn));
    }
    return std::move(made_);
}

}  // namespace

Result<StationDescription> parse_station_description(std::string_view text,
                                                     const std::filesystem::path& path) {
    const Result<JsonDocument> document = JsonDocument::parse(text, path.string());
    if (!document) {
        return document.error();
    }
    StationDescription made = DescriptionReader(document.value().root()).read();
    if (document.value().failed()) {
        return document.value().error();
    }
    return made;
}

Result<StationDescription> load_station_description(const std::filesystem::path& path) {
    const Result<std::string> text = read_file(path);
    if (!text) {
        return text.error();
    }
    return parse_station_description(text.value(), path);
}

const StationDescription& own_station_description() {
    static const StationDescription own = [] {
        Result<StationDescription> read =
            parse_station_description(game_asset("station.json"), "game/assets/station.json");
        if (!read) {
            fail_precondition("own_station_description", "the game's own station is refused",
                              read.error().message());
        }
        return std::move(read.value());
    }();
    return own;
}

}  // namespace handhold
