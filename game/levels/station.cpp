#include "game/levels/station.hpp"

#include <algorithm>
#include <utility>

#include "game/levels/station_module.hpp"
#include "game/levels/station_node.hpp"
#include "game/levels/station_truss.hpp"
#include "game/mesh/primitives.hpp"

namespace handhold {
namespace {

using Sections = std::vector<StationSection>;

// The pose of each section in the station's frame, by index.
std::vector<Pose> place_sections(const Sections& sections) {
    const Pose passage{Vec3(0.0, 0.0, k_vestibule_length_m), Quat::Identity()};
    std::vector<Pose> poses;
    for (const StationSection& section : sections) {
        if (section.attached_to.empty()) {
            poses.push_back(section.pose);
            continue;
        }
        const auto owner = std::find_if(
            sections.begin(), sections.end(),
            [&](const StationSection& other) { return other.name == section.attached_to; });
        Pose end = poses[static_cast<std::size_t>(owner - sections.begin())];
        if (owner->type == SectionType::node) {
            end = node_port(end, section.port);
        } else {
            end = end * Pose{Vec3(0.0, 0.0, module_length_m(*owner)), Quat::Identity()};
        }
        if (section.type == SectionType::module) {
            end = end * passage;
        } else if (section.type == SectionType::node) {
            end = end * passage * Pose{Vec3(0.0, 0.0, node_half_m()), Quat::Identity()};
        }
        poses.push_back(end);
    }
    return poses;
}

std::array<PortUse, k_port_count> ports_of(const StationSection& node, const Sections& sections) {
    std::array<PortUse, k_port_count> ports = {};
    if (!node.attached_to.empty()) {
        ports[2] = PortUse::open;
    }
    for (const StationSection& section : sections) {
        if (section.attached_to == node.name) {
            ports[static_cast<std::size_t>(section.port)] = PortUse::open;
        }
    }
    return ports;
}

}  // namespace

Structure make_station(const StationDescription& description) {
    Structure station;
    const Sections& sections = description.sections;
    const std::vector<Pose> poses = place_sections(sections);
    for (std::size_t i = 0; i < sections.size(); ++i) {
        switch (sections[i].type) {
            case SectionType::node:
                build_node(station, sections[i], poses[i], ports_of(sections[i], sections));
                break;
            case SectionType::module:
                build_module(station, sections[i], poses[i]);
                break;
            case SectionType::cupola:
                build_cupola(station, sections[i], poses[i]);
                break;
            case SectionType::truss:
                build_truss(station, sections[i], poses[i]);
                break;
        }
    }
    for (const StationSpawn& spawn : description.spawns) {
        station.spawns.push_back({spawn.name, look_along(spawn.eyes, spawn.ahead, Vec3::UnitY())});
    }
    return station;
}

Structure make_station() { return make_station(own_station_description()); }

std::vector<HandrailSpan> station_rails() { return make_station().rails; }

Mesh make_held_rock() {
    Mesh rock = make_rock(0.08, 5);
    rock.name = "rock";
    rock.color = {0.23F, 0.20F, 0.18F};
    return rock;
}

}  // namespace handhold
