#include "game/levels/station_module.hpp"

#include <array>
#include <vector>

#include "game/levels/station_rack.hpp"
#include "game/mesh/primitives.hpp"

namespace handhold {
namespace {

constexpr double k_liner_half_m = 1.42;
constexpr double k_hull_radius_m = 1.90;
constexpr double k_plate_m = 0.12;           // thickness of an end plate
constexpr double k_recess_m = 0.015;         // depth of an end plate behind the hull's rim
constexpr double k_end_clearance_m = 0.17;   // distance from the hull's rim to the first rack
constexpr double k_module_corner_m = 1.365;  // distance from the axis to a stand-off's face
constexpr double k_hatch_corner_m = 0.22;

// The frame of the strip that carries the outer rail, above the hull's bands and shields.
const Pose k_top{Vec3(0.0, k_hull_radius_m + 0.06, 0.0), Quat::Identity()};

struct Module {
    const StationSection& section;
    Pose pose;
};

// The frame on the inside of an end plate: +Y into the module, X to the right.
Pose end_frame(double z, bool is_far) {
    const double turn = is_far ? -k_half_pi : k_half_pi;
    return {Vec3(0.0, 0.0, z), rotation_about(Vec3::UnitX(), turn)};
}

Ring hatch_outline(double half_m, double z) {
    return make_outline({half_m, half_m, k_hatch_corner_m * half_m / k_hatch_half_m, 4, 2}, z);
}

// The hull: octagonal inside and round outside, with raised bands.
void add_hull(StationKit& kit, const Pose& pose, double length) {
    const Ring inner = make_outline({k_liner_half_m, k_liner_half_m, 0.45, 1, 4}, 0.0);
    const auto outer = [&](double radius, double z) {
        return at_height(round_outline(inner, radius), z);
    };
    std::vector<Ring> rings = {inner, outer(k_hull_radius_m, 0.0)};
    constexpr int k_bands = 4;
    for (int band = 0; band < k_bands; ++band) {
        const double z = length * (band + 0.5) / k_bands;
        rings.push_back(outer(k_hull_radius_m, z - 0.12));
        rings.push_back(outer(k_hull_radius_m + 0.05, z - 0.09));
        rings.push_back(outer(k_hull_radius_m + 0.05, z + 0.09));
        rings.push_back(outer(k_hull_radius_m, z + 0.12));
    }
    rings.push_back(outer(k_hull_radius_m, length));
    rings.push_back(at_height(inner, length));
    kit.add(Material::hull, make_loft(rings, LoftEnds::looped), pose);
}

void add_window(StationKit& kit, const Pose& frame) {
    const Pose out = frame * Pose{Vec3::Zero(), rotation_about(Vec3::UnitX(), -k_half_pi)};
    const Ring edge = hatch_outline(0.67, 0.0);
    const auto circle = [&](double radius, double z) {
        return at_height(round_outline(edge, radius), z);
    };
    const std::array<Ring, 6> frame_rings = {circle(0.50, -0.10),    at_height(edge, -0.10),
                                             at_height(edge, -0.03), circle(0.56, 0.0),
                                             circle(0.52, 0.0),      circle(0.50, -0.02)};
    kit.add(Material::metal, make_loft(frame_rings, LoftEnds::looped), out);
    const std::array<Ring, 2> pane = {circle(0.51, -0.075), circle(0.51, -0.050)};
    kit.add(Material::glass, make_loft(pane, LoftEnds::capped), out);
    for (int bolt = 0; bolt < 12; ++bolt) {
        const Quat turn = rotation_about(Vec3::UnitZ(), (bolt + 0.5) * k_half_pi / 3.0);
        const Vec3 foot = turn * Vec3(0.54, 0.0, -0.01);
        kit.add(Material::dark, make_cylinder(foot, foot + Vec3(0.0, 0.0, 0.016), 0.011, 6), out);
    }
}

void add_end(StationKit& kit, const Module& module, EndKind kind, bool is_far) {
    const double length = module_length_m(module.section);
    const double outside = is_far ? length - k_plate_m - k_recess_m : k_recess_m;
    const double inside = is_far ? outside : outside + k_plate_m;
    kit.add(Material::liner, make_hatch_plate(1.50, 0.47, k_plate_m),
            module.pose * Pose{Vec3(0.0, 0.0, outside), Quat::Identity()});
    const Pose frame = module.pose * end_frame(inside, is_far);
    dress_hatch_plate(kit, frame, is_far ? "far" : "near", HatchRails::around);
    if (kind == EndKind::door) {
        add_door(kit, frame);
    } else if (kind == EndKind::window) {
        add_window(kit, frame);
    } else if (kind == EndKind::open) {
        // In the frame of the end's outside, +Y points out of the module. The open door is turned
        // by 100 degrees about the hinge at the hatchway's edge.
        const Pose outer = module.pose * end_frame(length - k_recess_m, false);
        dress_hatch_plate(kit, outer, "outer", HatchRails::beside);
        const double hinge_m = 0.80;
        const Pose hinge{Vec3(0.0, 0.05, -hinge_m), rotation_about(Vec3::UnitX(), -1.75)};
        add_door(kit, outer * hinge * Pose{Vec3(0.0, 0.0, hinge_m), Quat::Identity()});
        for (const double x : {-0.42, 0.42}) {
            kit.add(Material::metal,
                    make_cylinder(Vec3(x - 0.09, 0.05, -hinge_m), Vec3(x + 0.09, 0.05, -hinge_m),
                                  0.028, 16),
                    outer);
        }
    }
}

// Cables that sag between clamps along a lower stand-off.
void add_cables(StationKit& kit, const Pose& frame, const Module& module, std::size_t corner) {
    const double from = k_end_clearance_m + 0.02;
    const double to = module_length_m(module.section) - from;
    for (std::size_t cable = 0; cable < 3; ++cable) {
        std::vector<Vec3> path;
        const int steps = 2 * static_cast<int>(module.section.racks);
        for (int i = 0; i <= steps; ++i) {
            const auto salt = static_cast<std::size_t>(i) + 97 * cable;
            const bool is_clamped = i % 2 == 1;
            const double sway =
                is_clamped ? 0.0 : 0.022 * (chance(module.section.seed, salt, corner) - 0.5);
            path.emplace_back(
                -0.09 + 0.09 * static_cast<double>(cable) + sway,
                is_clamped ? 0.018 : 0.018 + 0.010 * chance(module.section.seed, corner, salt),
                from + (to - from) * i / steps);
        }
        const double radius = 0.011 + 0.004 * chance(module.section.seed, cable, corner);
        const Material material = cable == 1 ? Material::accent : Material::cable;
        kit.add(material, make_tube(path, radius, 4), frame);
    }
}

void add_standoffs(StationKit& kit, const Module& module) {
    for (std::size_t corner = 0; corner < 4; ++corner) {
        const double angle = (static_cast<double>(corner) + 0.5) * k_half_pi;
        const Pose frame = module.pose * wall_frame(angle, k_module_corner_m);
        const bool is_upper = corner == 1 || corner == 2;
        for (std::size_t rack = 0; rack < module.section.racks; ++rack) {
            const double z = k_end_clearance_m + (static_cast<double>(rack) + 0.5) * k_rack_pitch_m;
            const double half_z = 0.5 * k_rack_pitch_m;
            kit.panel(is_upper ? Material::panel : Material::liner, frame, Vec3(0.0, -0.03, z),
                      Vec3(0.186, 0.03, half_z - 0.005));
            if (is_upper) {
                kit.panel(Material::metal, frame, Vec3(0.0, 0.004, z),
                          Vec3(0.085, 0.012, half_z - 0.06));
                kit.panel(Material::lamp, frame, Vec3(0.0, 0.014, z),
                          Vec3(0.055, 0.012, half_z - 0.09));
                const Vec3 shines = transform_point(frame, Vec3(0.0, 0.30, z));
                kit.lamp(shines, {0.20F, 0.187F, 0.165F}, 3.6);
            } else {
                kit.block(Material::metal, frame, Vec3(0.0, 0.020, z), Vec3(0.135, 0.014, 0.022));
            }
        }
        if (!is_upper) {
            add_cables(kit, frame, module, corner);
        }
    }
}

// Adds the outside: shields between the hull's bands, and a strip for rails along the top.
void add_outside(StationKit& kit, const Module& module) {
    const double length = module_length_m(module.section);
    constexpr std::size_t k_around = 10;
    for (std::size_t step = 0; step < k_around; ++step) {
        const double angle = 4.0 * k_half_pi * (static_cast<double>(step) + 0.5) / k_around;
        const Quat turn = rotation_about(Vec3::UnitZ(), angle);
        const Pose frame = module.pose * Pose{turn * Vec3(0.0, k_hull_radius_m, 0.0), turn};
        for (int band = 0; band < 4; ++band) {
            const double z = length * (band + 1) / 4.0;
            if (band == 3 ||
                chance(module.section.seed, step, static_cast<std::size_t>(band)) < 0.42) {
                continue;
            }
            const bool is_accent =
                chance(module.section.seed + 9, step, static_cast<std::size_t>(band)) < 0.10;
            kit.panel(is_accent ? Material::accent : Material::hull, frame, Vec3(0.0, -0.01, z),
                      Vec3(0.40, 0.045, 0.125 * length - 0.16));
        }
    }
    // The strip is above the bands and the shields. add_described_parts mounts rails on it.
    const Pose top = module.pose * k_top;
    kit.panel(Material::metal, top, Vec3(0.0, -0.04, 0.5 * length),
              Vec3(0.045, 0.04, 0.5 * length - 0.3));
}

}  // namespace

void add_vestibule(StationKit& kit, const Pose& pose) {
    const double near_z = -k_vestibule_length_m - 0.02;
    const std::array<Ring, 4> skin = {hatch_outline(0.70, near_z), hatch_outline(0.80, near_z),
                                      hatch_outline(0.80, 0.02), hatch_outline(0.70, 0.02)};
    kit.add(Material::liner, make_loft(skin, LoftEnds::looped), pose);
    for (const double z : {-0.22, -0.08}) {
        const std::array<Ring, 4> hoop = {
            hatch_outline(0.675, z - 0.02), hatch_outline(0.71, z - 0.025),
            hatch_outline(0.71, z + 0.025), hatch_outline(0.675, z + 0.02)};
        kit.add(Material::accent, make_loft(hoop, LoftEnds::looped), pose);
    }
}

void add_door(StationKit& kit, const Pose& frame) {
    // In the end's frame, Y points into the module. The door is lofted along Z, so it is turned by
    // 90 degrees.
    const Pose out = frame * Pose{Vec3::Zero(), rotation_about(Vec3::UnitX(), -k_half_pi)};
    const std::array<Ring, 5> door = {hatch_outline(0.67, -0.09), hatch_outline(0.67, -0.03),
                                      hatch_outline(0.60, -0.005), hatch_outline(0.46, -0.005),
                                      hatch_outline(0.42, -0.03)};
    kit.add(Material::panel, make_loft(door, LoftEnds::capped), out);
    kit.add(Material::metal, make_cylinder(Vec3(0, 0, -0.05), Vec3(0, 0, 0.06), 0.055, 24), out);
    kit.add(Material::rail, make_torus(0.20, k_rail_radius_m, 20, 8),
            out * Pose{Vec3(0.0, 0.0, 0.055), Quat::Identity()});
    for (int spoke = 0; spoke < 3; ++spoke) {
        const Quat turn = rotation_about(Vec3::UnitZ(), spoke * k_half_pi * 4.0 / 3.0);
        kit.add(Material::metal,
                make_cylinder(Vec3(0.03, 0.0, 0.045), Vec3(0.20, 0.0, 0.055), 0.010, 10),
                out * Pose{Vec3::Zero(), turn});
    }
    for (const double side : {-1.0, 1.0}) {
        for (const double y : {-0.30, 0.30}) {
            kit.beam(Material::metal, out, Vec3(side * 0.57, y, 0.0), Vec3(0.060, 0.035, 0.022));
        }
        kit.beam(Material::accent, out, Vec3(0.0, side * 0.53, -0.004), Vec3(0.22, 0.022, 0.006));
    }
}

double module_length_m(const StationSection& section) {
    return 2.0 * k_end_clearance_m + static_cast<double>(section.racks) * k_rack_pitch_m;
}

Pose wall_frame(double angle_rad, double distance_m) {
    const Quat turn = rotation_about(Vec3::UnitZ(), angle_rad);
    return {turn * Vec3(0.0, -distance_m, 0.0), turn};
}

Mesh make_hatch_plate(double half_m, double corner_m, double thickness_m) {
    const Ring outside = make_outline({half_m, half_m, corner_m, 4, 2}, 0.0);
    const double lip = 0.02;
    const std::array<Ring, 6> rings = {hatch_outline(k_hatch_half_m + lip, 0.0),
                                       outside,
                                       at_height(outside, thickness_m),
                                       hatch_outline(k_hatch_half_m + lip, thickness_m),
                                       hatch_outline(k_hatch_half_m, thickness_m - lip),
                                       hatch_outline(k_hatch_half_m, lip)};
    return make_loft(rings, LoftEnds::looped);
}

void dress_hatch_plate(StationKit& kit, const Pose& frame, const std::string& name,
                       HatchRails rails) {
    const Pose out = frame * Pose{Vec3::Zero(), rotation_about(Vec3::UnitX(), -k_half_pi)};
    const std::array<Ring, 5> collar = {hatch_outline(0.648, -0.03), hatch_outline(0.735, -0.03),
                                        hatch_outline(0.735, 0.008), hatch_outline(0.715, 0.024),
                                        hatch_outline(0.662, 0.024)};
    kit.add(Material::accent, make_loft(collar, LoftEnds::looped), out);
    for (int side = 0; side < 4; ++side) {
        // In `turned`, Y points away from the plate, X along this side, and +Z outward.
        const Pose turned =
            frame * Pose{Vec3::Zero(), rotation_about(Vec3::UnitY(), side * k_half_pi)};
        // Two panels on each side with a stiffener between them.
        for (const double half : {-1.0, 1.0}) {
            kit.panel(Material::panel, turned, Vec3(half * 0.40, -0.008, 0.915),
                      Vec3(0.335, 0.018, 0.155));
        }
        kit.panel(Material::metal, turned, Vec3(0.0, -0.008, 0.915), Vec3(0.055, 0.020, 0.165));
        kit.block(Material::accent, turned, Vec3(0.40, 0.010, 1.00), Vec3(0.070, 0.0015, 0.010));
        if (rails == HatchRails::beside && side % 2 == 0) {
            continue;
        }
        kit.handrail("hatch_" + name + "_" + std::to_string(side), turned,
                     Vec3(-0.34, 0.010, 0.885), Vec3(0.34, 0.010, 0.885));
    }
}

void add_described_parts(StationKit& kit, const StationSection& section, const Pose& pose) {
    for (const RailLine& rail : section.rails) {
        const double angle = static_cast<double>(rail.wall) * k_half_pi;
        const Pose frame = pose * (rail.outside ? k_top : wall_frame(angle, k_clear_half_m));
        const double height = rail.outside ? 0.0 : 0.005;
        kit.handrail(rail.name, frame, Vec3(rail.across_m, height, rail.from_m),
                     Vec3(rail.across_m, height, rail.to_m));
    }
    for (const HoseLine& hose : section.hoses) {
        kit.hose(hose.material, pose, hose.points, hose.radius_m);
    }
    for (const Lamp& lamp : section.lamps) {
        kit.lamp(transform_point(pose, lamp.position_ws), lamp.color, lamp.reach_m);
    }
}

void build_module(Structure& out, const StationSection& section, const Pose& pose) {
    StationKit kit(out, section.name, section.accent);
    const Module module{section, pose};
    add_hull(kit, pose, module_length_m(section));
    add_vestibule(kit, pose);
    add_end(kit, module, EndKind::hatch, false);
    add_end(kit, module, section.far_end, true);
    for (std::size_t wall = 0; wall < k_wall_count; ++wall) {
        const Pose frame = pose * wall_frame(static_cast<double>(wall) * k_half_pi, k_clear_half_m);
        for (std::size_t rack = 0; rack < section.racks; ++rack) {
            build_rack(kit, frame, k_end_clearance_m + static_cast<double>(rack) * k_rack_pitch_m,
                       section.walls[wall][rack], section.seed * 64 + wall * 8 + rack);
        }
    }
    add_standoffs(kit, module);
    add_outside(kit, module);
    add_described_parts(kit, section, pose);
    kit.finish();
}

}  // namespace handhold
