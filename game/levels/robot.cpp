#include "game/levels/robot.hpp"

#include <vector>

#include "game/levels/station_kit.hpp"
#include "game/mesh/primitives.hpp"

namespace handhold {
namespace {

constexpr Color k_accent = {0.55F, 0.22F, 0.02F};

constexpr double k_back_m = 0.25;  // height of the back above the torso's frame

// The robot's path: half the length of a straight, and the radius of the bends.
constexpr double k_straight_half_m = 4.0;
constexpr double k_bend_m = 3.6;
constexpr double k_robot_mps = 0.45;

Ring torso_ring(double half_x, double y0, double y1, double z) {
    const double middle = 0.5 * (y0 + y1);
    Ring ring = make_outline({half_x, 0.5 * (y1 - y0), 0.12, 3, 1}, z);
    for (Vec3& point : ring) {
        point.y() += middle;
    }
    return ring;
}

void add_shell(StationKit& kit) {
    const std::array<Ring, 6> shell = {
        torso_ring(0.34, -0.16, 0.16, -1.50),     torso_ring(0.46, -0.22, 0.20, -1.30),
        torso_ring(0.50, -0.25, k_back_m, -1.05), torso_ring(0.50, -0.25, k_back_m, 1.15),
        torso_ring(0.44, -0.22, 0.22, 1.38),      torso_ring(0.34, -0.14, 0.16, 1.46)};
    kit.add(Material::hull, make_loft(shell, LoftEnds::capped), {});
    // Plates on the back between the rails, on the sides, and under the belly.
    for (int row = 0; row < 5; ++row) {
        const double z = -0.84 + 0.44 * row;
        kit.panel(row == 2 ? Material::accent : Material::panel, {}, Vec3(0.0, k_back_m - 0.006, z),
                  Vec3(0.185, 0.012, 0.205));
    }
    for (const double side : {-1.0, 1.0}) {
        const Pose flank{Vec3(side * 0.50, 0.0, 0.0),
                         rotation_about(Vec3::UnitZ(), -side * k_half_pi)};
        for (int plate = 0; plate < 4; ++plate) {
            const double z = -0.81 + 0.56 * plate;
            kit.panel(plate == 1 ? Material::accent : Material::panel, flank,
                      Vec3(side * 0.03, -0.004, z), Vec3(0.095, 0.014, 0.19));
            kit.block(Material::dark, flank, Vec3(side * 0.03, 0.010, z), Vec3(0.045, 0.002, 0.09));
        }
    }
}

void add_head(StationKit& kit) {
    kit.beam(Material::dark, {}, Vec3(0.0, 0.02, -1.53), Vec3(0.28, 0.10, 0.05));
    for (const double x : {-0.16, 0.0, 0.16}) {
        kit.add(Material::screen,
                make_cylinder(Vec3(x, 0.03, -1.57), Vec3(x, 0.03, -1.60), 0.045, 20), {});
        kit.add(Material::metal,
                make_cylinder(Vec3(x, 0.03, -1.55), Vec3(x, 0.03, -1.585), 0.058, 20), {});
    }
    for (const double side : {-1.0, 1.0}) {
        kit.beam(Material::lamp, {}, Vec3(side * 0.24, -0.09, -1.545), Vec3(0.05, 0.02, 0.03));
        const std::array<Vec3, 4> feeler = {
            Vec3(side * 0.22, 0.12, -1.42), Vec3(side * 0.27, 0.22, -1.50),
            Vec3(side * 0.30, 0.36, -1.62), Vec3(side * 0.31, 0.50, -1.80)};
        kit.hose(Material::dark, {}, feeler, 0.010);
        kit.add(Material::accent, make_icosphere(0.025, 1), Pose{feeler.back(), Quat::Identity()});
        kit.lamp(Vec3(side * 0.3, 0.0, -2.1), {0.35F, 0.33F, 0.30F}, 4.0);
    }
}

void add_tail(StationKit& kit) {
    for (const double side : {-1.0, 1.0}) {
        kit.add(
            Material::foil,
            make_capsule(Vec3(side * 0.19, -0.02, 1.40), Vec3(side * 0.19, -0.02, 1.60), 0.15, 20),
            {});
        kit.beam(Material::metal, {}, Vec3(side * 0.19, -0.02, 1.50), Vec3(0.158, 0.158, 0.02));
        const std::array<Vec3, 5> hose = {
            Vec3(side * 0.30, 0.10, 1.52), Vec3(side * 0.40, 0.18, 1.42),
            Vec3(side * 0.47, 0.16, 1.20), Vec3(side * 0.515, 0.10, 0.9),
            Vec3(side * 0.49, 0.05, 0.62)};
        kit.hose(Material::cable, {}, hose, 0.016);
    }
}

void add_hips(StationKit& kit) {
    for (const CrawlerLeg& leg : robot_legs()) {
        const double side = leg.hip_bs.x() < 0.0 ? -1.0 : 1.0;
        kit.add(Material::dark, make_icosphere(0.12, 2), Pose{leg.hip_bs, Quat::Identity()});
        kit.add(Material::metal,
                make_cylinder(leg.hip_bs - Vec3(side * 0.14, 0.0, 0.0),
                              leg.hip_bs - Vec3(side * 0.02, 0.0, 0.0), 0.15, 20),
                {});
    }
}

void add_back_rails(StationKit& kit) {
    const Pose back{Vec3(0.0, k_back_m, 0.0), Quat::Identity()};
    kit.handrail("left", back, Vec3(-0.28, 0.0, -1.02), Vec3(-0.28, 0.0, 1.12));
    kit.handrail("right", back, Vec3(0.28, 0.0, -1.02), Vec3(0.28, 0.0, 1.12));
    for (int rung = 0; rung < 4; ++rung) {
        const double z = -0.62 + 0.44 * rung;
        kit.handrail("rung_" + std::to_string(rung), back, Vec3(-0.16, 0.0, z), Vec3(0.16, 0.0, z));
    }
}

// The pose at arc length `along_m` on the robot's path; 0 is the middle of the straight at +X.
Pose way_at(double along_m) {
    const double bend = 2.0 * k_half_pi * k_bend_m;
    const double lap = 4.0 * k_straight_half_m + 2.0 * bend;
    double rest = along_m < 0.0 ? along_m + lap : along_m;
    double half_turns = 0.0;
    if (rest >= k_straight_half_m) {
        rest -= k_straight_half_m;
        half_turns = 1.0;
        if (rest >= bend + 2.0 * k_straight_half_m) {
            rest -= bend + 2.0 * k_straight_half_m;
            half_turns = 2.0;
        }
    } else {
        rest += k_straight_half_m + bend;
    }
    // From here on, `rest` is the distance from the start of a bend. The first bend is at -Z and
    // turns left.
    const Quat lap_turn = rotation_about(Vec3::UnitY(), 2.0 * k_half_pi * (half_turns - 1.0));
    const double angle = rest < bend ? rest / k_bend_m : 2.0 * k_half_pi;
    double sine = 0.0;
    double cosine = 1.0;
    sin_cos(angle, sine, cosine);
    Vec3 place(k_bend_m * cosine, k_robot_height_m, -k_straight_half_m - k_bend_m * sine);
    if (rest > bend) {
        place.z() += rest - bend;
    }
    return {lap_turn * place, lap_turn * rotation_about(Vec3::UnitY(), angle)};
}

// Equipment on the hull inside the robot's path, low enough for the swinging legs.
void add_island(StationKit& kit) {
    // Along the middle: two tanks, and between them a box with a mast and a dish. Beside them: two
    // rails.
    for (const double z : {-2.2, 2.2}) {
        kit.add(Material::foil,
                make_capsule(Vec3(0.0, 0.38, z - 1.0), Vec3(0.0, 0.38, z + 1.0), 0.42, 28), {});
        for (const double at : {-0.7, 0.7}) {
            kit.beam(Material::metal, {}, Vec3(0.0, 0.22, z + at), Vec3(0.50, 0.22, 0.05));
        }
    }
    kit.beam(Material::hull, {}, Vec3(0.0, 0.30, 0.0), Vec3(0.55, 0.30, 0.55));
    kit.add(Material::metal, make_cylinder(Vec3(0, 0.6, 0), Vec3(0, 2.0, 0), 0.06, 16), {});
    const std::array<ProfilePoint, 7> bowl = {{{0.05, -0.05},
                                               {0.45, 0.03},
                                               {0.80, 0.20},
                                               {1.05, 0.40},
                                               {1.04, 0.42},
                                               {0.42, 0.07},
                                               {0.04, 0.0}}};
    kit.add(Material::hull, make_revolved(bowl, 32),
            Pose{Vec3(0.0, 2.0, 0.0), rotation_about(Vec3::UnitX(), -1.0)});
    for (const double side : {-1.0, 1.0}) {
        const Pose strip{Vec3(side * 1.25, 0.08, 0.0), Quat::Identity()};
        kit.panel(Material::metal, strip, Vec3(0.0, -0.05, 0.0), Vec3(0.06, 0.05, 3.4));
        kit.handrail(side < 0.0 ? "left" : "right", strip, Vec3(0.0, 0.0, -3.2),
                     Vec3(0.0, 0.0, 3.2));
    }
}

// Adds bolts to a plate's corners and, on some plates, a stripe or a grille. They rise
// at most 6 mm, because feet may land anywhere.
void add_plate_marks(StationKit& kit, const Vec3& center, std::size_t salt) {
    const Vec3 top = center + Vec3(0.0, 0.075, 0.0);
    for (int corner = 0; corner < 4; ++corner) {
        const Vec3 at = top + Vec3((corner % 2 == 0 ? -1.0 : 1.0) * 0.74, 0.0,
                                   (corner < 2 ? -1.0 : 1.0) * 0.73);
        kit.add(Material::metal,
                make_cylinder(at - Vec3(0.0, 0.01, 0.0), at + Vec3(0.0, 0.006, 0.0), 0.025, 8), {});
    }
    const double pick = chance(41, salt, 5);
    if (pick < 0.18) {
        kit.block(Material::dark, {}, top, Vec3(0.40, 0.002, 0.30));
        for (int slat = 0; slat < 9; ++slat) {
            kit.block(Material::metal, {}, top + Vec3(-0.36 + 0.09 * slat, 0.0, 0.0),
                      Vec3(0.012, 0.006, 0.30));
        }
    } else if (pick < 0.34) {
        kit.block(Material::accent, {}, top + Vec3(0.0, 0.0, -0.55), Vec3(0.60, 0.0025, 0.04));
        kit.block(Material::dark, {}, top + Vec3(-0.45, 0.0, -0.42), Vec3(0.15, 0.0025, 0.03));
    }
}

void add_plates(StationKit& kit) {
    kit.beam(Material::dark, {}, Vec3(0.0, -0.30, 0.0), Vec3(10.0, 0.18, 13.0));
    for (std::size_t row = 0; row < 16; ++row) {
        for (std::size_t column = 0; column < 12; ++column) {
            const std::size_t salt = 16 * column + row;
            const double pick = chance(41, salt, 3);
            const Material material = pick < 0.06   ? Material::accent
                                      : pick < 0.30 ? Material::panel
                                                    : Material::hull;
            const Vec3 center(-9.08 + 1.65 * static_cast<double>(column), -0.075,
                              -12.2 + 1.625 * static_cast<double>(row));
            if (chance(41, salt, 4) < 0.65) {
                kit.panel(material, {}, center, Vec3(0.815, 0.075, 0.803));
                add_plate_marks(kit, center, salt);
                continue;
            }
            for (int quarter = 0; quarter < 4; ++quarter) {
                const Vec3 offset((quarter % 2 == 0 ? -1.0 : 1.0) * 0.41, 0.0,
                                  (quarter < 2 ? -1.0 : 1.0) * 0.404);
                const bool is_dull = chance(41, salt, 10 + static_cast<std::size_t>(quarter)) < 0.4;
                kit.panel(is_dull ? Material::metal : material, {}, center + offset,
                          Vec3(0.405, 0.075, 0.399));
            }
        }
    }
}

// Boxes and radiators on the hull outside the path.
void add_outskirts(StationKit& kit) {
    for (int i = 0; i < 14; ++i) {
        const auto salt = static_cast<std::size_t>(i);
        const double side = i % 2 == 0 ? -1.0 : 1.0;
        const double z = -10.5 + 1.6 * i;
        const double height = 0.12 + 0.5 * chance(43, salt, 1);
        const Vec3 half(0.35 + 0.3 * chance(43, salt, 2), height, 0.3 + 0.3 * chance(43, salt, 3));
        const Vec3 center(side * (7.4 + 1.2 * chance(43, salt, 4)), height, z);
        kit.beam(chance(43, salt, 5) < 0.4 ? Material::foil : Material::panel, {}, center, half);
        kit.block(Material::accent, {}, center + Vec3(0.0, height + 0.002, 0.0),
                  Vec3(0.6 * half.x(), 0.004, 0.05));
        const std::array<Vec3, 4> hose = {center + Vec3(0.0, 0.0, half.z() - 0.02),
                                          Vec3(center.x() - side * 0.2, 0.06, z + half.z() + 0.2),
                                          Vec3(center.x() + side * 0.1, 0.03, z + 1.0),
                                          Vec3(center.x(), -0.02, z + 1.25)};
        kit.hose(Material::cable, {}, hose, 0.03);
    }
}

}  // namespace

Structure make_robot_torso() {
    Structure robot;
    StationKit kit(robot, "robot", k_accent);
    add_shell(kit);
    add_head(kit);
    add_tail(kit);
    add_hips(kit);
    add_back_rails(kit);
    kit.spawn("back", look_along(Vec3(0.0, 0.85, 1.5), Vec3(0.0, -0.3, -1.0), Vec3::UnitY()));
    kit.finish();
    return robot;
}

std::array<CrawlerLeg, k_robot_legs> robot_legs() {
    std::array<CrawlerLeg, k_robot_legs> legs;
    for (std::size_t i = 0; i < k_robot_legs; ++i) {
        const double side = i < k_robot_legs / 2 ? -1.0 : 1.0;
        const std::size_t place = i % (k_robot_legs / 2);
        const double along = static_cast<double>(place) - 1.0;
        CrawlerLeg& leg = legs[i];
        leg.hip_bs = Vec3(side * 0.58, -0.05, along * 0.90);
        leg.foot_bs = Vec3(side * 1.35, -k_robot_height_m, along * 1.15);
        leg.knee_bs = Vec3(side * 0.5, 1.0, 0.0);
        leg.upper_m = 0.75;
        leg.lower_m = 1.00;
        leg.phase = (place + (side < 0.0 ? 0U : 1U)) % 2 == 0 ? 0.0 : 0.5;
    }
    return legs;
}

CrawlerGait robot_gait() { return {1.6, 0.6, 0.30}; }

Structure make_robot_bone(const CrawlerLeg& leg, LegBone bone) {
    Structure made;
    const bool is_upper = bone == LegBone::upper;
    StationKit kit(made, is_upper ? "upper" : "lower", k_accent);
    const double half = 0.5 * (is_upper ? leg.upper_m : leg.lower_m);
    const double radius = is_upper ? k_robot_upper_radius_m : k_robot_lower_radius_m;
    const auto bar = [&](Material material, double y0, double y1, double r) {
        kit.add(material, make_cylinder(Vec3(0.0, y0, 0.0), Vec3(0.0, y1, 0.0), r, 20), {});
    };
    bar(Material::hull, -0.82 * half, 0.78 * half, radius);
    bar(Material::accent, -0.10 * half, 0.10 * half, radius + 0.006);
    bar(Material::metal, 0.72 * half, half, 0.8 * radius);
    // A piston beside the bone, and the knee's drum.
    kit.add(Material::metal,
            make_cylinder(Vec3(radius + 0.02, -0.6 * half, 0.0),
                          Vec3(radius + 0.02, 0.6 * half, 0.0), 0.018, 10),
            {});
    for (const double end : {-0.6, 0.6}) {
        kit.beam(Material::dark, {}, Vec3(radius, end * half, 0.0), Vec3(0.045, 0.022, 0.026));
    }
    if (is_upper) {
        kit.add(Material::dark,
                make_cylinder(Vec3(0.0, -half, -0.10), Vec3(0.0, -half, 0.10), 0.10, 20), {});
    } else {
        bar(Material::metal, -0.94 * half, -0.80 * half, 0.05);
        bar(Material::dark, -half - 0.0, -0.93 * half, 0.11);
    }
    kit.finish();
    return made;
}

Structure make_robot_hull() {
    Structure hull;
    StationKit kit(hull, "hull", k_accent);
    add_plates(kit);
    add_island(kit);
    add_outskirts(kit);
    kit.spawn("hull", look_along(Vec3(6.4, 1.3, -3.2), Vec3(-1.0, -0.2, 0.9), Vec3::UnitY()));
    kit.spawn("island", look_along(Vec3(0.9, 1.4, 0.9), Vec3(1.0, -0.25, -0.2), Vec3::UnitY()));
    kit.spawn("far", look_along(Vec3(9.0, 4.0, 9.0), Vec3(-1.0, -0.45, -1.0), Vec3::UnitY()));
    kit.finish();
    return hull;
}

PosePath make_robot_path() {
    const double lap = 4.0 * k_straight_half_m + 4.0 * k_half_pi * k_bend_m;
    std::array<Pose, k_max_path_keys> poses;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        poses[i] = way_at(lap * static_cast<double>(i) / static_cast<double>(poses.size()));
    }
    return make_pose_path(poses, lap / k_robot_mps);
}

}  // namespace handhold
