#include <array>

#include "game/levels/station.hpp"
#include "game/levels/station_module.hpp"
#include "game/levels/station_rack.hpp"
#include "game/mesh/primitives.hpp"

namespace handhold {
namespace {

constexpr double k_deck_y_m = -1.28;  // y of the deck's face
constexpr double k_roof_y_m = 1.22;   // y of the roof's face, which looks down
constexpr double k_wall_x_m = -1.66;  // x of the wall's face
constexpr double k_half_length_m = 4.0;
constexpr double k_half_width_m = 2.0;

void add_deck(StationKit& kit) {
    const Pose frame{Vec3(0.0, k_deck_y_m, 0.0), Quat::Identity()};
    kit.beam(Material::hull, frame, Vec3(0.0, -0.13, 0.0),
             Vec3(k_half_width_m, 0.09, k_half_length_m));
    for (int row = 0; row < 8; ++row) {
        for (int column = 0; column < 3; ++column) {
            const auto place = 3 * static_cast<std::size_t>(row) + static_cast<std::size_t>(column);
            const double drop = 0.012 * chance(place, 1, 77);
            const bool is_accent = chance(place, 2, 77) < 0.12;
            kit.panel(is_accent ? Material::accent : Material::metal, frame,
                      Vec3(-1.02 + 1.24 * column, -0.03 - drop, -3.45 + 0.985 * row),
                      Vec3(0.612, 0.03, 0.485));
        }
    }
    // A kerb along the open side and the front.
    kit.panel(Material::accent, frame, Vec3(1.90, 0.04, 0.0), Vec3(0.09, 0.09, 3.95));
    kit.panel(Material::accent, frame, Vec3(0.0, 0.04, -3.90), Vec3(1.80, 0.09, 0.09));
    kit.handrail("deck", frame, Vec3(0.2, 0.0, -3.0), Vec3(0.2, 0.0, 3.0));
    const Pose kerb = frame * Pose{Vec3(1.90, 0.13, 0.0), Quat::Identity()};
    kit.handrail("kerb", kerb, Vec3(0.0, 0.0, -3.5), Vec3(0.0, 0.0, 0.0));
}

void add_wall(StationKit& kit) {
    const double middle = 0.5 * (k_deck_y_m + k_roof_y_m);
    const Pose frame{Vec3(k_wall_x_m, middle, 0.0), rotation_about(Vec3::UnitZ(), -k_half_pi)};
    constexpr std::size_t k_racks = 7;
    const double start = -0.5 * k_rack_pitch_m * k_racks;
    for (std::size_t rack = 0; rack < k_racks; ++rack) {
        build_rack(kit, frame, start + static_cast<double>(rack) * k_rack_pitch_m,
                   RackKind::equipment, 500 + rack);
    }
    kit.beam(Material::hull, frame, Vec3(0.0, -0.325, 0.0), Vec3(1.24, 0.014, 3.96));
    for (const double side : {-1.0, 1.0}) {
        kit.beam(Material::panel, frame, Vec3(side * 1.02, -0.16, 0.0), Vec3(0.215, 0.155, 3.95));
        kit.beam(Material::hull, frame, Vec3(0.0, -0.16, side * 3.82), Vec3(0.80, 0.158, 0.135));
    }
    kit.handrail("wall_upper", frame, Vec3(-k_track_m, 0.005, -3.4), Vec3(-k_track_m, 0.005, 3.4));
    kit.handrail("wall_lower", frame, Vec3(k_track_m, 0.005, -3.4), Vec3(k_track_m, 0.005, 3.4));
}

// A roof over the rear half, supported by the wall and two posts.
void add_roof(StationKit& kit) {
    const Pose frame{Vec3(0.0, k_roof_y_m, 0.0), rotation_about(Vec3::UnitZ(), 2.0 * k_half_pi)};
    kit.beam(Material::hull, frame, Vec3(0.0, -0.215, 2.0), Vec3(k_half_width_m, 0.065, 2.0));
    for (int row = 0; row < 4; ++row) {
        for (const double side : {-1.0, 1.0}) {
            kit.panel(Material::panel, frame, Vec3(side * 1.12, -0.08, 0.52 + 0.985 * row),
                      Vec3(0.82, 0.08, 0.485));
        }
        kit.panel(Material::metal, frame, Vec3(0.0, -0.08, 0.52 + 0.985 * row),
                  Vec3(0.28, 0.075, 0.485));
        kit.panel(Material::lamp, frame, Vec3(0.0, 0.000, 0.52 + 0.985 * row),
                  Vec3(0.11, 0.008, 0.38));
        kit.lamp(transform_point(frame, Vec3(0.0, 0.45, 0.52 + 0.985 * row)), {0.50F, 0.47F, 0.42F},
                 4.0);
    }
    // The roof's X points left, so the rail on its open side is at negative X.
    kit.handrail("roof", frame, Vec3(-1.2, 0.0, 0.3), Vec3(-1.2, 0.0, 3.7));
    kit.handrail("roof_edge", frame, Vec3(-1.5, 0.0, 0.22), Vec3(-1.5, 0.0, 1.9));
    for (const double z : {0.25, 3.75}) {
        kit.beam(Material::metal, Pose{}, Vec3(1.82, 0.0, z), Vec3(0.09, 1.30, 0.09));
    }
}

void add_engines(StationKit& kit) {
    for (const double y : {-0.55, 0.55}) {
        const Pose pose{Vec3(-1.83, y, 3.86), Quat::Identity()};
        const std::array<ProfilePoint, 6> bell = {
            {{0.05, -0.02}, {0.07, 0.02}, {0.10, 0.07}, {0.14, 0.14}, {0.12, 0.14}, {0.05, 0.04}}};
        kit.add(Material::dark, make_revolved(bell, 24), pose);
    }
    // Ribs and tanks on the wall's outside, within the ship's width of 4 m.
    for (int rib = 0; rib < 5; ++rib) {
        kit.beam(Material::metal, Pose{}, Vec3(-1.985, -0.02, -3.4 + 1.7 * rib),
                 Vec3(0.03, 1.22, 0.07));
    }
    for (const double z : {-2.55, -0.85, 0.85, 2.55}) {
        kit.add(Material::accent,
                make_capsule(Vec3(-1.95, 0.35, z - 0.4), Vec3(-1.95, 0.35, z + 0.4), 0.13, 16), {});
    }
    kit.beam(Material::lamp, Pose{}, Vec3(0.0, k_deck_y_m - 0.10, -3.985), Vec3(0.5, 0.03, 0.015));
}

}  // namespace

Structure make_ship() {
    Structure ship;
    StationKit kit(ship, "ship", {0.62F, 0.20F, 0.03F});
    add_deck(kit);
    add_wall(kit);
    add_roof(kit);
    add_engines(kit);
    kit.spawn("deck", look_along(Vec3(0.6, -0.1, 2.6), Vec3(-0.15, -0.05, -1.0), Vec3::UnitY()));
    kit.spawn("bow", look_along(Vec3(0.6, -0.3, -2.6), Vec3(-0.3, 0.0, 1.0), Vec3::UnitY()));
    kit.finish();
    return ship;
}

}  // namespace handhold
