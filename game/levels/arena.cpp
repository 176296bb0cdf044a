#include "game/levels/arena.hpp"

#include <array>
#include <cmath>

#include "game/arena/arena_game.hpp"
#include "game/levels/station_kit.hpp"
#include "game/mesh/mesh_edit.hpp"
#include "game/mesh/primitives.hpp"

namespace handhold {
namespace {

constexpr int k_hall_sides = 16;
constexpr double k_bay_m = 4.0;
constexpr int k_bays = 10;

// On the wall at one of its sides; +Y points to the axis, Z along it.
Pose wall_frame(int side, double z_m) {
    const Quat turn = rotation_about(Vec3::UnitZ(), k_two_pi * side / k_hall_sides);
    return {turn * Vec3(0.0, -k_arena_radius_m, 0.0) + Vec3(0.0, 0.0, z_m), turn};
}

void add_bay(StationKit& kit, int bay) {
    const double z_m = -k_arena_half_length_m + (bay + 0.5) * k_bay_m;
    double sine = 0.0;
    double cosine = 1.0;
    sin_cos(0.5 * k_two_pi / k_hall_sides, sine, cosine);
    const double half_width_m = (k_arena_radius_m + 0.12) * sine / cosine;
    for (int side = 0; side < k_hall_sides; ++side) {
        const Pose frame = wall_frame(side, z_m);
        const bool is_window = side % 4 == 2 && bay % 2 == 1;
        const bool is_lamp = side % 4 == 0;
        const Material material = is_window               ? Material::glass
                                  : (side + bay) % 3 == 0 ? Material::hull
                                                          : Material::panel;
        kit.panel(material, frame, Vec3(0.0, -0.1, 0.0), Vec3(half_width_m, 0.1, 0.5 * k_bay_m));
        // A stripe of the half's team colour at each bay's end.
        kit.block(Material::accent, frame, Vec3(0.0, 0.02, 0.5 * k_bay_m - 0.12),
                  Vec3(half_width_m - 0.02, 0.025, 0.10));
        if (is_lamp) {
            kit.panel(Material::lamp, frame, Vec3(0.55, 0.01, 0.0), Vec3(0.12, 0.03, 1.5));
        }
        if (side % 2 == 1 || is_lamp) {
            kit.handrail("wall_" + std::to_string(bay) + "_" + std::to_string(side), frame,
                         Vec3(0.0, 0.0, -1.3), Vec3(0.0, 0.0, 1.2));
        }
    }
}

// The end of the hall behind a goal, with the goal's ring on four struts.
void add_end(StationKit& kit, double sign) {
    kit.add(Material::liner,
            make_cylinder(Vec3(0.0, 0.0, sign * k_arena_half_length_m),
                          Vec3(0.0, 0.0, sign * (k_arena_half_length_m + 0.2)),
                          k_arena_radius_m + 0.4, 32),
            {});
    const Pose at{Vec3(0.0, 0.0, sign * k_goal_z_m), Quat::Identity()};
    kit.add(Material::accent, make_torus(k_goal_radius_m + 0.15, 0.13, 40, 10), at);
    kit.add(
        Material::accent,
        make_cylinder(Vec3(0.0, 0.0, sign * (k_arena_half_length_m - 0.05)),
                      Vec3(0.0, 0.0, sign * (k_arena_half_length_m + 0.05)), k_goal_radius_m, 32),
        {});
    for (int i = 0; i < 4; ++i) {
        const Quat turn = rotation_about(Vec3::UnitZ(), k_two_pi * (i + 0.5) / 4.0);
        const Vec3 out = turn * Vec3(k_goal_radius_m + 0.15, 0.0, 0.0);
        const Vec3 wall = turn * Vec3(k_goal_radius_m + 0.9, 0.0, 0.0);
        kit.add(Material::metal,
                make_cylinder(out + Vec3(0.0, 0.0, sign * k_goal_z_m),
                              wall + Vec3(0.0, 0.0, sign * k_arena_half_length_m), 0.06, 10),
                {});
    }
}

// A block in the middle of the hall, with a rail on each of four faces.
void add_block(StationKit& kit, const std::string& name, const Vec3& center, double turn_rad) {
    const Pose at{center, rotation_about(Vec3::UnitZ(), turn_rad)};
    kit.beam(Material::panel, at, Vec3::Zero(), Vec3(0.6, 0.6, 0.9));
    for (int face = 0; face < 4; ++face) {
        const Quat turn = rotation_about(Vec3::UnitZ(), k_half_pi * face);
        const Pose frame = at * Pose{turn * Vec3(0.0, 0.6, 0.0), turn};
        kit.block(Material::accent, frame, Vec3(0.35, 0.0, 0.0), Vec3(0.06, 0.012, 0.8));
        kit.handrail(name + "_" + std::to_string(face), frame, Vec3(0.0, 0.0, -0.6),
                     Vec3(0.0, 0.0, 0.6));
    }
}

void add_half(Structure& hall, const std::string& name, double sign, const Color& color) {
    StationKit kit(hall, name, color);
    for (int bay = 0; bay < k_bays; ++bay) {
        const double z_m = -k_arena_half_length_m + (bay + 0.5) * k_bay_m;
        if (z_m * sign > 0.0) {
            add_bay(kit, bay);
        }
    }
    add_end(kit, sign);
    add_block(kit, "block_a", Vec3(sign * 2.6, 1.4, sign * 9.0), 0.4);
    add_block(kit, "block_b", Vec3(sign * -2.4, -1.8, sign * 11.5), 0.9);
    add_block(kit, "block_c", Vec3(sign * 0.4, 3.2, sign * 4.0), 0.2);
    kit.finish();
}

// The bars of a digit, as on a seven-segment display: top, upper left and right, middle, lower left
// and right, bottom.
constexpr std::array<std::uint8_t, 10> k_bars = {0b1110111, 0b0100100, 0b1011101, 0b1101101,
                                                 0b0101110, 0b1101011, 0b1111011, 0b0100101,
                                                 0b1111111, 0b1101111};
struct Bar {
    double x, y, half_x, half_y;
};
constexpr double k_half_w = 0.21;
constexpr double k_half_h = 0.19;
constexpr double k_half_bar = 0.045;
constexpr std::array<Bar, 7> k_bar_places = {{{0.0, 2 * k_half_h, k_half_w, k_half_bar},
                                              {-k_half_w, k_half_h, k_half_bar, k_half_h},
                                              {k_half_w, k_half_h, k_half_bar, k_half_h},
                                              {0.0, 0.0, k_half_w, k_half_bar},
                                              {-k_half_w, -k_half_h, k_half_bar, k_half_h},
                                              {k_half_w, -k_half_h, k_half_bar, k_half_h},
                                              {0.0, -2 * k_half_h, k_half_w, k_half_bar}}};

}  // namespace

Structure make_arena_hall() {
    Structure hall;
    add_half(hall, "blue", 1.0, k_blue_team);
    add_half(hall, "orange", -1.0, k_orange_team);
    for (std::size_t i = 0; i < hall.parts.size(); ++i) {
        if (hall.parts[i].name.ends_with("/accents")) {
            hall.looks[i].emissive = 0.3F;
        }
    }
    for (int i = 0; i < 6; ++i) {
        const double z_m = -17.0 + 34.0 * i / 5.0;
        const Color white = {7.0F, 6.9F, 6.7F};
        const Color blue = {4.5F, 5.5F, 9.0F};
        const Color orange = {9.0F, 6.0F, 4.2F};
        const Color& color = i == 0 ? orange : i == 5 ? blue : white;
        for (const double side : {-1.0, 1.0}) {
            const double up = i % 2 == 0 ? side : 0.3 * side;
            const double across = i % 2 == 0 ? 0.3 * side : side;
            hall.lamps.push_back({Vec3(3.0 * across, 3.0 * up, z_m), color, 13.0});
        }
    }
    return hall;
}

Structure make_arena_platform() {
    Structure platform;
    StationKit kit(platform, "platform", {0.75F, 0.70F, 0.10F});
    kit.beam(Material::hull, {}, Vec3::Zero(), Vec3(1.2, 0.12, 0.8));
    for (const double side : {-1.0, 1.0}) {
        const Quat turn = side > 0.0 ? Quat::Identity() : rotation_about(Vec3::UnitX(), k_pi);
        const Pose face{Vec3(0.0, side * 0.12, 0.0), turn};
        kit.handrail(side > 0.0 ? "top" : "bottom", face, Vec3(0.0, 0.0, -0.6),
                     Vec3(0.0, 0.0, 0.6));
        kit.block(Material::accent, face, Vec3(1.0, 0.0, 0.0), Vec3(0.12, 0.012, 0.78));
        kit.block(Material::accent, face, Vec3(-1.0, 0.0, 0.0), Vec3(0.12, 0.012, 0.78));
    }
    kit.finish();
    return platform;
}

Structure make_arena_disc() {
    Structure disc;
    const Quat upright = rotation_about(Vec3::UnitX(), -k_half_pi);
    const std::array<ProfilePoint, 8> profile = {{{0.0, -0.018},
                                                  {0.10, -0.020},
                                                  {0.14, -0.022},
                                                  {k_disc_radius_m, -0.010},
                                                  {k_disc_radius_m, 0.010},
                                                  {0.14, 0.022},
                                                  {0.10, 0.020},
                                                  {0.0, 0.018}}};
    Mesh body;
    body.name = "disc/body";
    body.color = {0.85F, 0.85F, 0.88F};
    append(body, make_revolved(profile, 32), Pose{Vec3::Zero(), upright});
    Mesh ring;
    ring.name = "disc/ring";
    ring.color = {0.25F, 1.0F, 0.35F};
    for (const double side : {-1.0, 1.0}) {
        append(ring, make_torus(0.115, 0.012, 32, 8), Pose{Vec3(0.0, side * 0.016, 0.0), upright});
    }
    disc.parts = {std::move(body), std::move(ring)};
    disc.looks = {{0.15F, 1.0F, 0.5F}, {1.6F, 1.0F, 0.2F}};
    return disc;
}

Structure make_score_drum(const Color& color) {
    Structure drum;
    Mesh body;
    body.name = "drum/body";
    body.color = {0.02F, 0.022F, 0.026F};
    Mesh digits;
    digits.name = "drum/digits";
    digits.color = color;
    for (int digit = 0; digit < 10; ++digit) {
        const Quat turn = rotation_about(Vec3::UnitX(), -k_two_pi * digit / 10.0);
        const Pose face{turn * Vec3(0.0, 0.0, k_drum_face_m), turn};
        append(body, make_box(Vec3(0.38, 0.52, 0.03)), face);
        for (std::size_t bar = 0; bar < k_bar_places.size(); ++bar) {
            if ((k_bars[static_cast<std::size_t>(digit)] >> bar & 1U) != 0) {
                const Bar& place = k_bar_places[bar];
                append(digits, make_box(Vec3(place.half_x + 0.02, place.half_y + 0.02, 0.02)),
                       face * Pose{Vec3(place.x, place.y, 0.03), Quat::Identity()});
            }
        }
    }
    drum.parts = {std::move(body), std::move(digits)};
    drum.looks = {{0.0F, 1.0F, 0.2F}, {1.1F, 1.0F, 0.1F}};
    return drum;
}

}  // namespace handhold
