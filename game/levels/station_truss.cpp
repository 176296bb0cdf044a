#include "game/levels/station_truss.hpp"

#include <array>

#include "game/mesh/primitives.hpp"

namespace handhold {
namespace {

constexpr double k_half_m = 0.40;    // half the truss's width, to the axes of its chords
constexpr double k_chord_m = 0.035;  // radius of a chord
constexpr double k_batten_m = 0.020;

const std::array<Vec3, 4> k_corners = {
    Vec3(k_half_m, k_half_m, 0.0), Vec3(-k_half_m, k_half_m, 0.0), Vec3(-k_half_m, -k_half_m, 0.0),
    Vec3(k_half_m, -k_half_m, 0.0)};

Vec3 corner_at(std::size_t corner, double z) { return k_corners[corner % 4] + Vec3(0.0, 0.0, z); }

void add_lattice(StationKit& kit, const Pose& pose, std::size_t bays) {
    const double length = k_truss_bay_m * static_cast<double>(bays);
    for (std::size_t corner = 0; corner < 4; ++corner) {
        kit.add(Material::metal,
                make_cylinder(corner_at(corner, 0.0), corner_at(corner, length), k_chord_m, 10),
                pose);
    }
    for (std::size_t joint = 0; joint <= bays; ++joint) {
        const double z = k_truss_bay_m * static_cast<double>(joint);
        for (std::size_t corner = 0; corner < 4; ++corner) {
            kit.block(Material::panel, pose, corner_at(corner, z), Vec3(0.052, 0.052, 0.045));
            kit.add(Material::metal,
                    make_cylinder(corner_at(corner, z), corner_at(corner + 1, z), k_batten_m, 6),
                    pose);
            if (joint < bays) {
                // The diagonals of neighbouring bays meet, in a zigzag along each side.
                const std::size_t from = corner + (joint + corner) % 2;
                const std::size_t to = corner + 1 - (joint + corner) % 2;
                kit.add(Material::metal,
                        make_cylinder(corner_at(from, z), corner_at(to, z + k_truss_bay_m),
                                      k_batten_m, 6),
                        pose);
            }
        }
    }
}

// Strips along both upper chords, under the rails.
void add_strips(StationKit& kit, const Pose& pose, std::size_t bays) {
    const double length = k_truss_bay_m * static_cast<double>(bays);
    for (const double side : {-1.0, 1.0}) {
        kit.panel(Material::panel, pose,
                  Vec3(side * k_half_m, k_truss_strip_m - 0.035, 0.5 * length),
                  Vec3(0.05, 0.035, 0.5 * length - 0.02));
    }
}

// Boxes and tanks between the chords of some bays.
void add_loads(StationKit& kit, const Pose& pose, const StationSection& section) {
    for (std::size_t bay = 1; bay + 1 < section.racks; ++bay) {
        const double z = k_truss_bay_m * (static_cast<double>(bay) + 0.5);
        const double pick = chance(section.seed, bay, 1);
        if (pick < 0.30) {
            kit.beam(pick < 0.15 ? Material::foil : Material::hull, pose, Vec3(0.0, -0.05, z),
                     Vec3(0.27, 0.24, 0.34));
            for (const double side : {-1.0, 1.0}) {
                kit.beam(Material::metal, pose, Vec3(0.0, -0.30, z + side * 0.22),
                         Vec3(0.38, 0.015, 0.03));
                kit.bracket(Material::metal, pose, Vec3(side * 0.2, 0.19, z), 0.10);
            }
            kit.panel(Material::accent, pose, Vec3(0.0, 0.19, z), Vec3(0.12, 0.010, 0.07));
        } else if (pick < 0.50) {
            for (const double side : {-1.0, 1.0}) {
                kit.add(Material::foil,
                        make_capsule(Vec3(side * 0.17, -0.05, z - 0.22),
                                     Vec3(side * 0.17, -0.05, z + 0.22), 0.14, 12),
                        pose);
                kit.beam(Material::metal, pose, Vec3(side * 0.17, -0.05, z),
                         Vec3(0.148, 0.148, 0.02));
            }
            kit.beam(Material::metal, pose, Vec3(0.0, -0.05, z), Vec3(0.36, 0.02, 0.02));
        }
    }
    // A bundle of lines along one lower chord, clamped at every joint.
    const double length = k_truss_bay_m * static_cast<double>(section.racks);
    for (int line = 0; line < 3; ++line) {
        std::vector<Vec3> points;
        for (std::size_t i = 0; i <= 2 * section.racks; ++i) {
            const double sag = i % 2 == 1 ? 0.015 + 0.02 * chance(section.seed, i, 7) : 0.0;
            points.emplace_back(-k_half_m + 0.07 + 0.045 * line, -k_half_m + 0.05 - sag,
                                0.02 + (length - 0.04) * static_cast<double>(i) /
                                           (2.0 * static_cast<double>(section.racks)));
        }
        kit.add(line == 1 ? Material::accent : Material::cable, make_tube(points, 0.014, 6), pose);
    }
}

// A solar wing along +Z: an arm and ten panels of solar cells in the XZ plane.
void add_wing(StationKit& kit, const Pose& pose) {
    kit.beam(Material::metal, pose, Vec3(0.0, 0.0, 3.65), Vec3(0.035, 0.035, 3.65));
    kit.add(Material::hull, make_cylinder(Vec3(0, 0, 0.0), Vec3(0, 0, 0.5), 0.16, 16), pose);
    for (int cell = 0; cell < 5; ++cell) {
        const double z = 1.30 + 1.30 * cell;
        for (const double half : {-1.0, 1.0}) {
            const double x = half * 0.72;
            kit.beam(Material::solar, pose, Vec3(x, 0.0, z), Vec3(0.66, 0.012, 0.62));
            kit.rim(Material::metal, pose, {x, z, 0.675, 0.635, 0.018, -0.016, 0.016});
            for (const double line : {-0.25, 0.25}) {
                kit.block(Material::metal, pose, Vec3(x, 0.0125, z + line),
                          Vec3(0.64, 0.0025, 0.004));
            }
        }
    }
}

// A radiator along +Z: white panels with coolant lines.
void add_radiator(StationKit& kit, const Pose& pose) {
    kit.beam(Material::metal, pose, Vec3(0.0, 0.0, 0.30), Vec3(0.04, 0.04, 0.30));
    for (int panel = 0; panel < 3; ++panel) {
        const double z = 1.05 + 0.94 * panel;
        kit.beam(Material::hull, pose, Vec3(0.0, 0.0, z), Vec3(0.55, 0.018, 0.45));
        for (int line = 0; line < 5; ++line) {
            kit.block(Material::panel, pose, Vec3(-0.44 + 0.22 * line, 0.019, z),
                      Vec3(0.012, 0.006, 0.43));
        }
        kit.beam(Material::metal, pose, Vec3(0.0, 0.0, z + 0.47), Vec3(0.30, 0.022, 0.03));
    }
}

void add_dish(StationKit& kit, const Pose& pose) {
    kit.add(Material::metal, make_cylinder(Vec3(0, 0, 0), Vec3(0, 0, 1.20), 0.035, 12), pose);
    const Pose bowl = pose * Pose{Vec3(0.0, 0.0, 1.20), rotation_about(Vec3(0.8, 0.6, 0.0), 0.6)};
    const std::array<ProfilePoint, 7> profile = {{{0.05, -0.04},
                                                  {0.30, 0.02},
                                                  {0.55, 0.14},
                                                  {0.70, 0.26},
                                                  {0.69, 0.275},
                                                  {0.28, 0.05},
                                                  {0.04, 0.0}}};
    kit.add(Material::hull, make_revolved(profile, 24), bowl);
    for (int strut = 0; strut < 3; ++strut) {
        const Quat turn = rotation_about(Vec3::UnitZ(), strut * 4.0 / 3.0 * k_half_pi);
        kit.add(Material::metal,
                make_cylinder(turn * Vec3(0.5, 0.0, 0.12), Vec3(0.0, 0.0, 0.55), 0.010, 8), bowl);
    }
    kit.add(Material::dark, make_cylinder(Vec3(0, 0, 0.47), Vec3(0, 0, 0.60), 0.045, 10), bowl);
}

}  // namespace

void build_truss(Structure& out, const StationSection& section, const Pose& pose) {
    StationKit kit(out, section.name, section.accent);
    const double length = k_truss_bay_m * static_cast<double>(section.racks);
    add_lattice(kit, pose, section.racks);
    add_strips(kit, pose, section.racks);
    add_loads(kit, pose, section);
    const auto turned = [&](double z, double angle, const Vec3& axis) {
        return pose * Pose{Vec3(0.0, 0.0, z), rotation_about(axis, angle)};
    };
    for (const double z : {0.5, length - 0.5}) {
        add_wing(kit, turned(z, k_half_pi, Vec3::UnitY()));
        add_wing(kit, turned(z, -k_half_pi, Vec3::UnitY()));
    }
    add_radiator(kit, turned(0.3 * length, k_half_pi, Vec3::UnitY()));
    add_radiator(kit, turned(0.7 * length, -k_half_pi, Vec3::UnitY()));
    add_dish(kit, turned(0.86 * length, -k_half_pi, Vec3::UnitX()));
    for (const RailLine& rail : section.rails) {
        const double side = rail.wall == WallSide::left ? -1.0 : 1.0;
        const Pose strip =
            pose * Pose{Vec3(side * k_half_m, k_truss_strip_m, 0.0), Quat::Identity()};
        kit.handrail(rail.name, strip, Vec3(rail.across_m, 0.0, rail.from_m),
                     Vec3(rail.across_m, 0.0, rail.to_m));
    }
    for (const HoseLine& hose : section.hoses) {
        kit.hose(hose.material, pose, hose.points, hose.radius_m);
    }
    kit.finish();
}

}  // namespace handhold
