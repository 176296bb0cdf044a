#include "game/levels/station_node.hpp"

#include <string>

#include "game/levels/station_module.hpp"
#include "game/levels/station_rack.hpp"
#include "game/mesh/primitives.hpp"

namespace handhold {
namespace {

// Distance from the node's middle to the inside of its walls.
constexpr double k_node_half_m = 1.25;
constexpr double k_node_plate_m = 0.15;  // thickness of the walls
constexpr double k_node_outside_m = k_node_half_m + k_node_plate_m;

// The frame of one side of a node, `distance_m` from the node's middle: +Z outward, +Y up. The side
// is given in quarter turns from the node's +Z to the left.
Pose node_side(const Pose& node, int quarters, double distance_m) {
    const Quat turn = rotation_about(Vec3::UnitY(), quarters * k_half_pi);
    return node * Pose{turn * Vec3(0.0, 0.0, distance_m), turn};
}

void add_node_walls(StationKit& kit, const Pose& node,
                    const std::array<PortUse, k_port_count>& ports) {
    for (int side = 0; side < 4; ++side) {
        kit.add(Material::liner, make_hatch_plate(k_node_outside_m, 0.04, k_node_plate_m),
                node_side(node, side, k_node_half_m));
        // In `inside`, +Y points to the node's middle.
        const Pose inside = node_side(node, side, k_node_half_m) *
                            Pose{Vec3::Zero(), rotation_about(Vec3::UnitX(), -k_half_pi)};
        dress_hatch_plate(kit, inside, std::to_string(side), HatchRails::beside);
        if (ports[static_cast<std::size_t>(side)] == PortUse::closed) {
            add_door(kit, inside);
        }
        // The corner post between this wall and the next, with a lamp.
        const Quat turn = rotation_about(Vec3::UnitY(), (side + 0.5) * k_half_pi);
        const Pose post = node * Pose{turn * Vec3(0.0, 0.0, 1.66), turn};
        kit.beam(Material::panel, post, Vec3::Zero(), Vec3(0.13, 1.09, 0.05));
        kit.beam(Material::lamp, post, Vec3(0.0, 0.0, -0.050), Vec3(0.028, 0.80, 0.008));
        kit.lamp(transform_point(node, turn * Vec3(0.0, 0.35, 1.30)), {0.27F, 0.255F, 0.23F}, 3.4);
    }
}

void add_node_decks(StationKit& kit, const Pose& node, std::size_t seed) {
    for (int deck = 0; deck < 2; ++deck) {
        const Pose frame = node * wall_frame(2 * deck * k_half_pi, k_clear_half_m);
        for (std::size_t rack = 0; rack < 2; ++rack) {
            build_rack(kit, frame, (static_cast<double>(rack) - 1.0) * k_rack_pitch_m,
                       deck == 0 ? RackKind::deck : RackKind::lights,
                       seed + 10 * static_cast<std::size_t>(deck) + rack);
        }
        for (const double side : {-1.0, 1.0}) {
            kit.panel(Material::metal, frame, Vec3(side * 1.02, -0.026, 0.0),
                      Vec3(0.215, 0.02, 1.24));
            kit.panel(Material::metal, frame, Vec3(0.0, -0.026, side * 1.15),
                      Vec3(0.80, 0.02, 0.095));
        }
        kit.beam(Material::hull, frame, Vec3(0.0, -0.375, 0.0),
                 Vec3(k_node_outside_m, 0.06, k_node_outside_m));
    }
}

// A corner of an octagon with a flat side at the bottom and circumradius `radius_m`.
Vec3 octagon(int corner, double radius_m, double z) {
    double sine = 0.0;
    double cosine = 1.0;
    sin_cos((corner + 0.5) * 0.5 * k_half_pi, sine, cosine);
    return {radius_m * cosine, radius_m * sine, z};
}

Ring octagon_ring(double radius_m, double z) {
    Ring ring;
    for (int corner = 0; corner < 8; ++corner) {
        ring.push_back(octagon(corner, radius_m, z));
    }
    return ring;
}

void add_cupola(StationKit& kit, const Pose& pose) {
    constexpr double k_base_m = 0.98;   // circumradius of the slanted panes at the node
    constexpr double k_front_m = 0.58;  // circumradius of the slanted panes at the front
    constexpr double k_start_m = 0.14;
    constexpr double k_end_m = 0.72;
    const std::array<Ring, 4> base = {octagon_ring(0.88, -0.02), octagon_ring(1.08, -0.02),
                                      octagon_ring(1.05, k_start_m), octagon_ring(0.90, k_start_m)};
    kit.add(Material::hull, make_loft(base, LoftEnds::looped), pose);
    const std::array<Ring, 4> front = {
        octagon_ring(0.50, k_end_m - 0.04), octagon_ring(0.64, k_end_m - 0.05),
        octagon_ring(0.62, k_end_m + 0.04), octagon_ring(0.51, k_end_m + 0.04)};
    kit.add(Material::metal, make_loft(front, LoftEnds::looped), pose);
    const std::array<Ring, 2> pane = {octagon_ring(0.54, k_end_m - 0.005),
                                      octagon_ring(0.54, k_end_m + 0.020)};
    kit.add(Material::glass, make_loft(pane, LoftEnds::capped), pose);
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 a = octagon(corner, k_base_m, k_start_m - 0.03);
        const Vec3 b = octagon(corner, k_front_m, k_end_m);
        kit.add(Material::metal, make_cylinder(a, b, 0.034, 10), pose);
        const Vec3 next_a = octagon(corner + 1, k_base_m, k_start_m - 0.03);
        const Vec3 next_b = octagon(corner + 1, k_front_m, k_end_m);
        const Vec3 out = 0.012 * (next_a - a).cross(b - a).normalized();
        const std::array<Ring, 2> slab = {Ring{a - out, next_a - out, next_b - out, b - out},
                                          Ring{a + out, next_a + out, next_b + out, b + out}};
        kit.add(Material::glass, make_loft(slab, LoftEnds::capped), pose);
    }
}

}  // namespace

double node_half_m() { return k_node_outside_m; }

Pose node_port(const Pose& node, int port) { return node_side(node, port, k_node_outside_m); }

void build_node(Structure& out, const StationSection& section, const Pose& pose,
                const std::array<PortUse, k_port_count>& ports) {
    StationKit kit(out, section.name, section.accent);
    add_node_walls(kit, pose, ports);
    add_node_decks(kit, pose, section.seed);
    if (!section.attached_to.empty()) {
        // The passage between a module and a node belongs to the node.
        add_vestibule(kit, pose * Pose{Vec3(0.0, 0.0, -k_node_outside_m), Quat::Identity()});
    }
    add_described_parts(kit, section, pose);
    kit.finish();
}

void build_cupola(Structure& out, const StationSection& section, const Pose& pose) {
    StationKit kit(out, section.name, section.accent);
    add_cupola(kit, pose);
    add_described_parts(kit, section, pose);
    kit.finish();
}

}  // namespace handhold
