#include "game/levels/station_fitting.hpp"

#include <array>
#include <vector>

#include "game/mesh/primitives.hpp"

namespace handhold {
namespace {

constexpr double k_bay_depth_m = 0.27;
constexpr double k_half_z_m = 0.5 * k_rack_pitch_m - 0.03;

// An open bay: a back and four thin sides with visible edges.
void add_box_bay(StationKit& kit, const Pose& frame, double z, double half_z, Material material) {
    const double half_x = k_bay_half_m - 0.006;
    kit.block(material, frame, Vec3(0.0, -k_bay_depth_m, z), Vec3(half_x, 0.010, half_z));
    const double middle = -0.5 * k_bay_depth_m - 0.004;
    const double half_y = 0.5 * k_bay_depth_m;
    for (const double side : {-1.0, 1.0}) {
        kit.block(material, frame, Vec3(side * (half_x - 0.004), middle, z),
                  Vec3(0.004, half_y, half_z));
        kit.block(material, frame, Vec3(0.0, middle, z + side * (half_z - 0.004)),
                  Vec3(half_x - 0.009, half_y, 0.004));
    }
}

// A leaf: a thin blade from `root`, folded along its rib.
void add_leaf(StationKit& kit, const Pose& frame, const Vec3& root, const Vec3& tip,
              double half_width) {
    const Vec3 along = (tip - root).normalized();
    const Vec3 across = along.cross(Vec3(0.31, 0.87, 0.38)).normalized();
    const Vec3 up = across.cross(along);
    const Vec3 middle = root + 0.55 * (tip - root);
    const Vec3 thick = 0.0025 * up;
    const std::array<Ring, 3> rings = {
        Ring{root},
        Ring{middle + half_width * across + 0.2 * half_width * up, middle - thick,
             middle - half_width * across + 0.2 * half_width * up, middle + thick},
        Ring{tip}};
    kit.add(Material::leaf, make_loft(rings, LoftEnds::capped), frame);
}

void add_plant(StationKit& kit, const Pose& frame, const Vec3& foot, double height,
               std::size_t seed) {
    const int leaves = 4 + static_cast<int>(3.0 * chance(seed, 1, 1));
    for (int leaf = 0; leaf < leaves; ++leaf) {
        const auto salt = static_cast<std::size_t>(leaf);
        double sine = 0.0;
        double cosine = 1.0;
        sin_cos(2.4 * leaf + 6.0 * chance(seed, 2, 0), sine, cosine);
        const double lean = 0.045 + 0.055 * chance(seed, 3, salt);
        const double rise = height * (0.65 + 0.35 * chance(seed, 4, salt));
        const Vec3 root = foot + 0.12 * lean * Vec3(cosine, 0.0, sine);
        add_leaf(kit, frame, root, foot + Vec3(lean * cosine, rise, lean * sine),
                 0.022 + 0.014 * chance(seed, 5, salt));
    }
}

// Two trays of plants under light strips, in a bay.
void add_garden(StationKit& kit, const Pose& frame, double z0, std::size_t seed) {
    const double middle = z0 + 0.5 * k_rack_pitch_m;
    for (std::size_t tray = 0; tray < 2; ++tray) {
        const double half_z = 0.5 * k_half_z_m;
        const double z = tray == 0 ? middle - half_z : middle + half_z;
        add_box_bay(kit, frame, z, half_z - 0.004, Material::panel);
        kit.panel(Material::metal, frame, Vec3(0.0, -0.235, z), Vec3(0.43, 0.026, half_z - 0.03));
        kit.block(Material::soil, frame, Vec3(0.0, -0.209, z), Vec3(0.415, 0.008, half_z - 0.045));
        for (std::size_t row = 0; row < 3; ++row) {
            for (std::size_t column = 0; column < 5; ++column) {
                const std::size_t salt = 15 * tray + 5 * row + column;
                if (chance(seed, 31, salt) < 0.18) {
                    continue;  // plant was harvested
                }
                const Vec3 foot(-0.33 + 0.165 * static_cast<double>(column), -0.202,
                                z + (static_cast<double>(row) - 1.0) * 0.125);
                add_plant(kit, frame, foot, 0.11 + 0.08 * chance(seed, 32, salt), 64 * seed + salt);
            }
        }
        // The lamps light the tray from both ends.
        for (const double side : {-1.0, 1.0}) {
            kit.block(Material::grow, frame, Vec3(0.0, -0.028, z + side * (half_z - 0.018)),
                      Vec3(0.42, 0.010, 0.006));
        }
    }
    kit.lamp(transform_point(frame, Vec3(0.0, 0.22, middle)), {0.16F, 0.085F, 0.14F}, 2.2);
}

// A sleeping bag in a bay with a pillow, a reading lamp, and a fan behind a grille.
void add_bunk(StationKit& kit, const Pose& frame, double z0, std::size_t seed) {
    const double middle = z0 + 0.5 * k_rack_pitch_m;
    add_box_bay(kit, frame, middle, k_half_z_m, Material::liner);
    kit.add(Material::fabric, make_bevelled_box(Vec3(0.24, 0.07, 0.36), 0.035),
            frame * Pose{Vec3(-0.12, -0.17, middle + 0.05), Quat::Identity()});
    kit.add(Material::accent, make_bevelled_box(Vec3(0.225, 0.055, 0.22), 0.03),
            frame * Pose{Vec3(-0.12, -0.135, middle + 0.14), Quat::Identity()});
    kit.add(Material::panel, make_bevelled_box(Vec3(0.16, 0.04, 0.075), 0.025),
            frame * Pose{Vec3(-0.12, -0.20, middle - 0.40), Quat::Identity()});
    for (const double z : {-0.18, 0.32}) {
        kit.panel(Material::dark, frame, Vec3(-0.12, -0.155, middle + z),
                  Vec3(0.246, 0.092, 0.018));
    }
    // A shelf with a book and a small lamp, and the fan's grille.
    kit.block(Material::metal, frame, Vec3(0.30, -0.10, middle - 0.14), Vec3(0.14, 0.004, 0.30));
    for (const double z : {-0.36, 0.08}) {
        kit.bracket(Material::metal, frame, Vec3(0.36, -0.144, middle + z), 0.03);
    }
    kit.beam(chance(seed, 1, 0) < 0.5 ? Material::accent : Material::screen, frame,
             Vec3(0.30, -0.084, middle - 0.05), Vec3(0.055, 0.012, 0.08));
    kit.beam(Material::lamp, frame, Vec3(0.30, -0.085, middle - 0.33), Vec3(0.035, 0.011, 0.055));
    for (int slat = 0; slat < 9; ++slat) {
        kit.block(Material::metal, frame, Vec3(0.30, -0.20, middle + 0.24 + 0.022 * slat),
                  Vec3(0.11, 0.030, 0.0012));
    }
    kit.rim(Material::panel, frame, {0.30, middle + 0.328, 0.13, 0.125, 0.018, -0.235, -0.165});
    kit.lamp(transform_point(frame, Vec3(0.30, 0.02, middle - 0.33)), {0.10F, 0.085F, 0.06F}, 1.2);
}

// A glove box: a window over a lit chamber with two ports, screens and switches beside it.
void add_bench(StationKit& kit, const Pose& frame, double z0, std::size_t seed) {
    const double middle = z0 + 0.5 * k_rack_pitch_m;
    add_box_bay(kit, frame, middle, k_half_z_m, Material::panel);
    const double chamber = middle - 0.12;
    kit.rim(Material::metal, frame, {0.0, chamber, 0.42, 0.35, 0.03, -0.26, -0.012});
    kit.block(Material::glass, frame, Vec3(0.0, -0.032, chamber), Vec3(0.392, 0.004, 0.322));
    kit.block(Material::lamp, frame, Vec3(0.0, -0.06, chamber - 0.29), Vec3(0.34, 0.008, 0.012));
    for (const double side : {-1.0, 1.0}) {
        const Pose port = frame * Pose{Vec3(side * 0.19, -0.014, chamber + 0.16),
                                       rotation_about(Vec3::UnitX(), 1.57079632679489661923)};
        kit.add(Material::accent, make_torus(0.085, 0.014, 16, 6), port);
        kit.add(Material::dark, make_cylinder(Vec3(0, 0, 0.0), Vec3(0, 0, 0.02), 0.082, 16), port);
        // The glove inside the chamber.
        const std::array<Vec3, 4> glove = {
            Vec3(side * 0.19, -0.05, chamber + 0.16), Vec3(side * 0.17, -0.10, chamber + 0.11),
            Vec3(side * 0.13, -0.15, chamber + 0.03), Vec3(side * 0.10, -0.17, chamber - 0.03)};
        kit.hose(Material::fabric, frame, glove, 0.045);
    }
    for (int sample = 0; sample < 3; ++sample) {
        const Vec3 foot(-0.12 + 0.12 * sample, -0.245, chamber - 0.16);
        kit.add(
            sample == 1 ? Material::screen : Material::foil,
            make_cylinder(foot, foot + Vec3(0.0, 0.05 + 0.03 * chance(seed, 2, 1), 0.0), 0.028, 12),
            frame);
    }
    const double console = middle + 0.36;
    kit.panel(Material::metal, frame, Vec3(0.0, -0.028, console), Vec3(0.42, 0.02, 0.10));
    for (int key = 0; key < 8; ++key) {
        const auto salt = static_cast<std::size_t>(key);
        kit.panel(chance(seed, 3, salt) < 0.4 ? Material::screen : Material::dark, frame,
                  Vec3(-0.35 + 0.1 * key, -0.004, console + 0.05), Vec3(0.030, 0.005, 0.018));
    }
    kit.panel(Material::screen, frame, Vec3(-0.16, -0.006, console - 0.035),
              Vec3(0.18, 0.003, 0.035));
    for (const double x : {0.14, 0.24, 0.34}) {
        kit.add(Material::dark,
                make_cylinder(Vec3(x, -0.012, console - 0.035), Vec3(x, 0.012, console - 0.035),
                              0.024, 10),
                frame);
    }
}

// Soft bags of different sizes under a net of straps.
void add_stowage(StationKit& kit, const Pose& frame, double z0, std::size_t seed) {
    const double middle = z0 + 0.5 * k_rack_pitch_m;
    add_box_bay(kit, frame, middle, k_half_z_m, Material::liner);
    const int rows = 2 + static_cast<int>(2.0 * chance(seed, 1, 0));
    const double half_z = k_half_z_m / rows;
    for (int row = 0; row < rows; ++row) {
        const auto salt = static_cast<std::size_t>(row);
        const double z = middle - k_half_z_m + (2 * row + 1) * half_z;
        const double split = -0.2 + 0.4 * chance(seed, 2, salt);
        for (const double side : {-1.0, 1.0}) {
            const double inner = split;
            const double outer = side * (k_bay_half_m - 0.025);
            const double half_x = 0.5 * (side * (outer - inner)) - 0.008;
            const double height = 0.085 + 0.025 * chance(seed, 3, 2 * salt + (side > 0.0 ? 1 : 0));
            const bool is_accent = chance(seed, 4, 2 * salt + (side > 0.0 ? 1 : 0)) < 0.18;
            const Vec3 center(0.5 * (inner + outer), -0.255 + height, z);
            kit.add(is_accent ? Material::accent : Material::fabric,
                    make_bevelled_box(Vec3(half_x, height, half_z - 0.018), 0.028),
                    frame * Pose{center, Quat::Identity()});
            kit.block(Material::panel, frame, center + Vec3(0.0, height, 0.0),
                      Vec3(0.4 * half_x, 0.0015, 0.016));
        }
    }
    for (int strap = 0; strap < 4; ++strap) {
        const double across = -0.33 + 0.22 * strap;
        kit.block(Material::dark, frame, Vec3(across, -0.022, middle),
                  Vec3(0.012, 0.0015, k_half_z_m - 0.010));
        kit.block(Material::dark, frame, Vec3(0.0, -0.026, middle - 0.36 + 0.24 * strap),
                  Vec3(k_bay_half_m - 0.020, 0.0015, 0.012));
    }
}

}  // namespace

void build_fitting(StationKit& kit, const Pose& frame, double z0, RackKind kind, std::size_t seed) {
    switch (kind) {
        case RackKind::garden:
            return add_garden(kit, frame, z0, seed);
        case RackKind::bunk:
            return add_bunk(kit, frame, z0, seed);
        case RackKind::bench:
            return add_bench(kit, frame, z0, seed);
        default:
            return add_stowage(kit, frame, z0, seed);
    }
}

}  // namespace handhold
