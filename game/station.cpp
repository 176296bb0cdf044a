#include "game/station.hpp"

#include <array>

#include "game/render/primitives.hpp"
#include "game/station_module.hpp"
#include "game/station_rack.hpp"

namespace handhold {
namespace {

constexpr double k_half_pi = 1.57079632679489661923;
constexpr double k_node_half_m = 1.25;   // from the node's middle to the inside of its walls
constexpr double k_node_plate_m = 0.15;  // thickness of the walls
constexpr double k_node_outside_m = k_node_half_m + k_node_plate_m;

// +Z away from the node's middle, +Y up; 0 faces world +Z, quarters turn to the left.
Pose node_side(int quarters, double distance_m) {
    const Quat turn = rotation_about(Vec3::UnitY(), quarters * k_half_pi);
    return {turn * Vec3(0.0, 0.0, distance_m), turn};
}

void add_node_walls(StationKit& kit) {
    for (int side = 0; side < 4; ++side) {
        kit.add(Material::liner, make_hatch_plate(k_node_outside_m, 0.04, k_node_plate_m),
                node_side(side, k_node_half_m));
        // Inside, +Y of the dressing points to the middle.
        const Pose inside = node_side(side, k_node_half_m) *
                            Pose{Vec3::Zero(), rotation_about(Vec3::UnitX(), -k_half_pi)};
        dress_hatch_plate(kit, inside, std::to_string(side), HatchRails::beside);
        // Corner post between this wall and the next, with a lamp.
        const Quat turn = rotation_about(Vec3::UnitY(), (side + 0.5) * k_half_pi);
        const Pose post{turn * Vec3(0.0, 0.0, 1.66), turn};
        kit.beam(Material::panel, post, Vec3::Zero(), Vec3(0.13, 1.09, 0.05));
        kit.beam(Material::lamp, post, Vec3(0.0, 0.0, -0.050), Vec3(0.028, 0.80, 0.008));
        kit.lamp(turn * Vec3(0.0, 0.35, 1.30), {0.27F, 0.255F, 0.23F}, 3.4);
    }
}

void add_node_decks(StationKit& kit) {
    for (int deck = 0; deck < 2; ++deck) {
        const Pose frame = wall_frame(2 * deck * k_half_pi, k_clear_half_m);
        for (std::size_t rack = 0; rack < 2; ++rack) {
            build_rack(kit, frame, (static_cast<double>(rack) - 1.0) * k_rack_pitch_m,
                       deck == 0 ? WallKind::floor : WallKind::ceiling,
                       900 + 10 * static_cast<std::size_t>(deck) + rack);
        }
        for (const double side : {-1.0, 1.0}) {
            kit.panel(Material::metal, frame, Vec3(side * 1.02, -0.026, 0.0),
                      Vec3(0.215, 0.02, 1.24));
            kit.panel(Material::metal, frame, Vec3(0.0, -0.026, side * 1.15),
                      Vec3(0.80, 0.02, 0.095));
        }
        kit.beam(Material::hull, frame, Vec3(0.0, -0.375, 0.0),
                 Vec3(k_node_outside_m, 0.06, k_node_outside_m));
        kit.handrail(deck == 0 ? "floor" : "ceiling", frame, Vec3(k_track_m, 0.005, -0.7),
                     Vec3(k_track_m, 0.005, 0.7));
    }
}

// A point of the octagon with one flat side down, `radius_m` to its corners.
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

// Eight slanted panes and one ahead, on the node's -Z side.
void add_cupola(StationKit& kit) {
    const Pose pose = node_side(2, k_node_outside_m);
    constexpr double k_base_m = 0.98;   // corner radius where it meets the node
    constexpr double k_front_m = 0.58;  // and around the pane ahead
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
    kit.spawn("cupola", node_side(2, 0.55) *
                            Pose{Vec3::Zero(), rotation_about(Vec3::UnitY(), 2.0 * k_half_pi)});
}

void build_node(Structure& out) {
    StationKit kit(out, "node", {0.16F, 0.24F, 0.05F});
    add_node_walls(kit);
    add_node_decks(kit);
    add_cupola(kit);
    kit.spawn("node", look_along(Vec3(0.0, 0.05, 0.45), Vec3(-1.0, 0.0, 0.05), Vec3::UnitY()));
    kit.finish();
}

// Mast and two wings of solar cells over the node, for the view from outside.
void build_wings(Structure& out) {
    StationKit kit(out, "wings", {0.60F, 0.33F, 0.06F});
    const Pose world;
    kit.beam(Material::metal, world, Vec3(0.0, 2.35, 0.0), Vec3(0.12, 0.92, 0.12));
    kit.beam(Material::accent, world, Vec3(0.0, 1.62, 0.0), Vec3(0.42, 0.10, 0.42));
    kit.add(Material::hull, make_capsule(Vec3(-0.5, 3.3, 0.0), Vec3(0.5, 3.3, 0.0), 0.20, 20),
            world);
    for (const double side : {-1.0, 1.0}) {
        kit.beam(Material::metal, world, Vec3(side * 3.9, 3.3, 0.0), Vec3(3.4, 0.035, 0.035));
        for (int cell = 0; cell < 5; ++cell) {
            const double x = side * (1.35 + 1.30 * cell);
            for (const double half : {-1.0, 1.0}) {
                kit.beam(Material::cable, world, Vec3(x, 3.3, half * 0.72),
                         Vec3(0.62, 0.012, 0.66));
                kit.block(Material::metal, world, Vec3(x, 3.314, half * 0.72),
                          Vec3(0.60, 0.003, 0.006));
                for (const double line : {-0.30, 0.0, 0.30}) {
                    kit.block(Material::metal, world, Vec3(x + line, 3.314, half * 0.72),
                              Vec3(0.006, 0.003, 0.64));
                }
            }
        }
    }
    kit.finish();
}

}  // namespace

Structure make_station() {
    Structure station;
    build_node(station);
    const double start = k_node_outside_m + k_vestibule_length_m;
    const auto side = [start](int quarters) { return node_side(quarters, start); };
    build_module(station, {"hab", side(0), 5, EndKind::door, {0.03F, 0.26F, 0.30F}, 1});
    build_module(station, {"airlock", side(1), 3, EndKind::door, {0.52F, 0.10F, 0.03F}, 2});
    build_module(station, {"lab", side(3), 5, EndKind::window, {0.06F, 0.13F, 0.42F}, 3});
    build_wings(station);
    return station;
}

std::vector<HandrailSpan> station_rails() { return make_station().rails; }

Mesh make_held_rock() {
    Mesh rock = make_rock(0.08, 5);
    rock.name = "rock";
    rock.color = {0.23F, 0.20F, 0.18F};
    return rock;
}

}  // namespace handhold
