#include "game/levels/station_rack.hpp"

#include <array>

#include "game/levels/station_fitting.hpp"
#include "game/mesh/primitives.hpp"

namespace handhold {
namespace {

constexpr double k_depth_m = 0.31;  // depth of a rack behind its face
constexpr double k_gap_m = 0.006;   // gap between two fronts

// A rectangle of a rack's front: centre and half sizes, across (x) and along (z).
struct Cell {
    double x, z, half_x, half_z;
};

Vec3 on_face(const Cell& cell, double across, double height, double along) {
    return {cell.x + across * cell.half_x, height, cell.z + along * cell.half_z};
}

// A solid front, 40 mm thick. Its face stands `proud` metres above the wall.
void add_front(StationKit& kit, Material material, const Pose& frame, const Cell& cell,
               double proud) {
    kit.panel(material, frame, Vec3(cell.x, proud - 0.02, cell.z),
              Vec3(cell.half_x - k_gap_m, 0.02, cell.half_z - k_gap_m));
}

void add_drawer(StationKit& kit, const Pose& frame, const Cell& cell, std::size_t seed) {
    const bool is_accent = chance(seed, 1, 0) < 0.22;
    add_front(kit, is_accent ? Material::accent : Material::panel, frame, cell, 0.0);
    // A recessed handle plate with a bar above it, a latch at one end, and a label.
    kit.block(Material::dark, frame, on_face(cell, 0.0, 0.0, 0.0), Vec3(0.075, 0.003, 0.020));
    const std::array<Vec3, 4> bar = {on_face(cell, 0.0, 0.0, 0.0) + Vec3(-0.062, -0.004, 0.0),
                                     on_face(cell, 0.0, 0.0, 0.0) + Vec3(-0.056, 0.017, 0.0),
                                     on_face(cell, 0.0, 0.0, 0.0) + Vec3(0.056, 0.017, 0.0),
                                     on_face(cell, 0.0, 0.0, 0.0) + Vec3(0.062, -0.004, 0.0)};
    kit.add(Material::metal, make_tube(bar, 0.0055, 4), frame);
    kit.block(Material::metal, frame, on_face(cell, 0.86, 0.0, 0.0), Vec3(0.010, 0.005, 0.016));
    kit.block(is_accent ? Material::panel : Material::accent, frame,
              on_face(cell, -0.58, 0.0, 0.55), Vec3(0.045, 0.0015, 0.009));
}

void add_vent(StationKit& kit, const Pose& frame, const Cell& cell) {
    add_front(kit, Material::dark, frame, cell, -0.045);
    const double rim = 0.040;
    kit.rim(Material::panel, frame,
            {cell.x, cell.z, cell.half_x - k_gap_m, cell.half_z - k_gap_m, rim, -0.055, 0.0});
    const int slats = static_cast<int>(cell.half_x * 2.0 / 0.095);
    for (int i = 0; i < slats; ++i) {
        const double across = -1.0 + (2.0 * i + 1.0) / slats;
        const Vec3 place(cell.x + across * (cell.half_x - rim), -0.028, cell.z);
        const Pose tilted = frame * Pose{place, rotation_about(Vec3::UnitZ(), 0.6)};
        kit.block(Material::metal, tilted, Vec3::Zero(), Vec3(0.0045, 0.019, cell.half_z - rim));
    }
}

void add_screen(StationKit& kit, const Pose& frame, const Cell& cell, std::size_t seed) {
    add_front(kit, Material::dark, frame, cell, -0.012);
    const double rim = 0.028;
    kit.rim(
        Material::metal, frame,
        {cell.x, cell.z, cell.half_x - k_gap_m, cell.half_z - k_gap_m, 2.0 * rim, -0.03, 0.004});
    // The screen's content: bars of different lengths.
    const int rows = static_cast<int>((2.0 * cell.half_z - 4.0 * rim) / 0.028);
    for (int row = 0; row < rows; ++row) {
        const double half = (0.15 + 0.75 * chance(seed, 7, static_cast<std::size_t>(row))) *
                            (cell.half_x - 3.0 * rim);
        const double left = cell.x - cell.half_x + 2.6 * rim;
        kit.block(Material::screen, frame,
                  Vec3(left + half, -0.012, cell.z - cell.half_z + 2.6 * rim + 0.028 * row),
                  Vec3(half, 0.002, 0.008));
    }
}

void add_bay(StationKit& kit, const Pose& frame, const Cell& cell, std::size_t seed) {
    kit.block(Material::liner, frame, Vec3(cell.x, -0.27, cell.z),
              Vec3(cell.half_x - k_gap_m, 0.02, cell.half_z - k_gap_m));
    // Two or three soft bags in a row along Z, each with two straps.
    const int count = cell.half_z > 0.3 ? 3 : 2;
    for (int i = 0; i < count; ++i) {
        const auto salt = static_cast<std::size_t>(i);
        const double half_z = cell.half_z / count - 0.016;
        const double z = cell.z - cell.half_z + (2 * i + 1) * cell.half_z / count;
        const double height = 0.085 + 0.035 * chance(seed, 3, salt);
        const Vec3 center(cell.x + 0.03 * (chance(seed, 4, salt) - 0.5), -0.255 + height, z);
        kit.add(Material::fabric,
                make_bevelled_box(Vec3(cell.half_x - 0.05, height, half_z), 0.030),
                frame * Pose{center, Quat::Identity()});
        for (const double side : {-0.45, 0.45}) {
            kit.panel(Material::accent, frame, center + Vec3(side * cell.half_x, 0.0, 0.0),
                      Vec3(0.016, height + 0.004, half_z + 0.004));
        }
    }
}

void add_dials(StationKit& kit, const Pose& frame, const Cell& cell, std::size_t seed) {
    add_front(kit, Material::metal, frame, cell, -0.008);
    for (int i = 0; i < 4; ++i) {
        const double across = -0.72 + 0.48 * i;
        const auto salt = static_cast<std::size_t>(i);
        const Vec3 foot = on_face(cell, across, -0.012, 0.30);
        kit.add(Material::dark, make_cylinder(foot, foot + Vec3(0.0, 0.030, 0.0), 0.024, 6), frame);
        const bool is_lit = chance(seed, 5, salt) < 0.7;
        kit.panel(is_lit ? Material::screen : Material::accent, frame,
                  on_face(cell, across, -0.006, -0.45), Vec3(0.022, 0.006, 0.011));
    }
}

void add_light(StationKit& kit, const Pose& frame, const Cell& cell) {
    add_front(kit, Material::metal, frame, cell, -0.002);
    kit.panel(Material::lamp, frame, Vec3(cell.x, -0.001, cell.z),
              Vec3(0.60 * cell.half_x, 0.006, cell.half_z - 0.045));
}

void add_cell(StationKit& kit, const Pose& frame, const Cell& cell, RackKind kind,
              std::size_t seed) {
    const double pick = chance(seed, 11, 2);
    if (kind == RackKind::deck) {
        return pick < 0.75 ? add_drawer(kit, frame, cell, seed) : add_vent(kit, frame, cell);
    }
    if (pick < 0.38) {
        return add_drawer(kit, frame, cell, seed);
    }
    if (pick < 0.55) {
        return add_bay(kit, frame, cell, seed);
    }
    if (pick < 0.70) {
        return add_screen(kit, frame, cell, seed);
    }
    return pick < 0.85 ? add_vent(kit, frame, cell) : add_dials(kit, frame, cell, seed);
}

void add_bones(StationKit& kit, const Pose& frame, double z0) {
    const double middle = z0 + 0.5 * k_rack_pitch_m;
    const double half_z = 0.5 * k_rack_pitch_m;
    kit.block(Material::liner, frame, Vec3(0.0, -k_depth_m, middle),
              Vec3(k_wall_half_m - 0.004, 0.012, half_z - 0.004));
    for (const double end : {z0 + 0.016, z0 + k_rack_pitch_m - 0.016}) {
        kit.block(Material::liner, frame, Vec3(0.0, -0.5 * k_depth_m - 0.012, end),
                  Vec3(k_wall_half_m - 0.002, 0.5 * k_depth_m, 0.014));
    }
    for (const double side : {-1.0, 1.0}) {
        kit.panel(Material::metal, frame, Vec3(side * k_track_m, -0.5 * k_depth_m, middle),
                  Vec3(0.072, 0.5 * k_depth_m, half_z - 0.003));
        // The track's two lips.
        for (const double lip : {-0.020, 0.020}) {
            kit.block(Material::dark, frame, Vec3(side * k_track_m + lip, 0.001, middle),
                      Vec3(0.006, 0.004, half_z - 0.003));
        }
    }
}

}  // namespace

void build_rack(StationKit& kit, const Pose& frame, double z0, RackKind kind, std::size_t seed) {
    add_bones(kit, frame, z0);
    // Outer strips between track and stand-off: two panels, some in the section's colour.
    for (const double side : {-1.0, 1.0}) {
        for (int i = 0; i < 2; ++i) {
            const auto salt = 2 * static_cast<std::size_t>(i) + (side > 0.0 ? 1U : 0U);
            const double half_z = k_rack_pitch_m / 4.0;
            const Cell cell{side * 0.718, z0 + (2 * i + 1) * half_z, 0.082, half_z};
            const bool is_accent = chance(seed, 21, salt) < 0.16;
            add_front(kit, is_accent ? Material::accent : Material::panel, frame, cell,
                      -0.010 * chance(seed, 22, salt));
        }
    }
    if (kind == RackKind::lights) {
        add_light(kit, frame, {0.0, z0 + 0.5 * k_rack_pitch_m, 0.16, 0.5 * k_rack_pitch_m});
        for (const double side : {-1.0, 1.0}) {
            const Cell cell{side * 0.318, z0 + 0.5 * k_rack_pitch_m, 0.155, 0.5 * k_rack_pitch_m};
            chance(seed, 23, side > 0.0 ? 1 : 0) < 0.6
                ? add_front(kit, Material::panel, frame, cell, -0.004)
                : add_vent(kit, frame, cell);
        }
        return;
    }
    if (kind == RackKind::garden || kind == RackKind::bunk || kind == RackKind::bench ||
        kind == RackKind::stowage) {
        build_fitting(kit, frame, z0, kind, seed);
        return;
    }
    const int rows = 2 + (chance(seed, 24, 0) < 0.5 ? 1 : 0);
    for (int row = 0; row < rows; ++row) {
        const auto salt = static_cast<std::size_t>(row);
        const double half_z = 0.5 * (k_rack_pitch_m - 0.06) / rows;
        const double z = z0 + 0.03 + (2 * row + 1) * half_z;
        if (chance(seed, 25, salt) < 0.45) {
            const double half_x = 0.5 * k_bay_half_m;
            add_cell(kit, frame, {-half_x, z, half_x, half_z}, kind, 16 * seed + 2 * salt);
            add_cell(kit, frame, {half_x, z, half_x, half_z}, kind, 16 * seed + 2 * salt + 1);
        } else {
            add_cell(kit, frame, {0.0, z, k_bay_half_m, half_z}, kind, 16 * seed + 2 * salt);
        }
    }
}

}  // namespace handhold
