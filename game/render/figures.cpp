#include "game/render/figures.hpp"

#include <array>

#include "game/render/figure_kit.hpp"
#include "game/render/primitives.hpp"

namespace handhold {

using enum FigureMaterial;

std::vector<Mesh> make_head() {
    FigureKit kit;
    Mesh helmet = make_sphere(1.0, 40);
    stretch(helmet, Vec3(0.118, 0.140, 0.142));
    kit.add(shell, helmet, {Vec3(0.0, 0.020, 0.062), Quat::Identity()});
    Mesh visor = make_sphere(1.0, 40);
    stretch(visor, Vec3(0.100, 0.072, 0.105));
    kit.add(joint, visor, {Vec3(0.0, 0.012, 0.012), Quat::Identity()});
    Mesh brow = make_torus(0.092, 0.0065, 40, 10);
    stretch(brow, Vec3(1.06, 0.78, 1.0));
    kit.add(shell, brow, {Vec3(0.0, 0.013, -0.026), Quat::Identity()});
    for (const double side : {-1.0, 1.0}) {
        const Vec3 ear(side * 0.105, 0.005, 0.066);
        const Vec3 out(side * 0.024, 0.0, 0.0);
        kit.add(joint, make_cylinder(ear, ear + out, 0.040, 28));
        kit.add(accent, make_cylinder(ear + out, ear + 1.25 * out, 0.030, 28));
    }
    kit.add(accent, make_bevelled_box(Vec3(0.012, 0.008, 0.052), 0.004),
            {Vec3(0.0, 0.155, 0.062), Quat::Identity()});
    const Pose level{Vec3(0.0, -0.108, 0.066), rotation_about(Vec3::UnitX(), 1.5707963267948966)};
    kit.add(joint, make_torus(0.072, 0.017, 32, 12), level);
    return kit.finish("head");
}

std::vector<Mesh> make_limb(double length_m, double radius_m) {
    const double r = radius_m;
    const std::array<ProfilePoint, 8> profile = {{{0.55 * r, 0.10 * length_m},
                                                  {0.85 * r, 0.12 * length_m},
                                                  {1.00 * r, 0.22 * length_m},
                                                  {1.05 * r, 0.45 * length_m},
                                                  {0.92 * r, 0.75 * length_m},
                                                  {0.82 * r, 0.88 * length_m},
                                                  {0.70 * r, 0.91 * length_m},
                                                  {0.50 * r, 0.91 * length_m}}};
    FigureKit kit;
    const Pose forward{Vec3::Zero(), Quat(0.0, 1.0, 0.0, 0.0)};
    kit.add(shell, make_revolved(profile, 20), forward);
    kit.add(joint, make_capsule(Vec3::Zero(), Vec3(0.0, 0.0, -length_m), 0.62 * r, 16));
    kit.add(accent, make_torus(0.84 * r, 0.10 * r, 28, 8),
            {Vec3(0.0, 0.0, -0.86 * length_m), Quat::Identity()});
    return kit.finish("limb");
}

std::vector<Mesh> make_chest() {
    // Sections from the waist up; turned so that their +Z becomes +Y and their +Y the front.
    constexpr std::array<LoftSection, 7> k_torso = {{{-0.330, 0.085, 0.070, 0.050, 0.0, 0.000},
                                                     {-0.310, 0.105, 0.085, 0.060, 0.0, 0.000},
                                                     {-0.220, 0.135, 0.105, 0.075, 0.0, 0.004},
                                                     {-0.120, 0.165, 0.120, 0.085, 0.0, 0.006},
                                                     {-0.055, 0.165, 0.108, 0.080, 0.0, 0.002},
                                                     {-0.020, 0.120, 0.080, 0.060, 0.0, 0.000},
                                                     {-0.008, 0.080, 0.060, 0.045, 0.0, 0.000}}};
    FigureKit kit;
    const Pose upright{Vec3::Zero(), rotation_about(Vec3::UnitX(), -1.5707963267948966)};
    kit.add(shell, loft_sections(k_torso), upright);
    kit.add(joint, make_capsule(Vec3(0.0, -0.03, 0.0), Vec3(0.0, 0.05, 0.0), 0.050, 20));
    for (const double side : {-1.0, 1.0}) {
        kit.add(joint, make_sphere(0.058, 20), {Vec3(side * 0.175, -0.062, 0.0), {1, 0, 0, 0}});
        kit.add(accent, make_bevelled_box(Vec3(0.040, 0.012, 0.004), 0.0035),
                {Vec3(side * 0.060, -0.120, -0.124), Quat::Identity()});
    }
    kit.add(shell, make_bevelled_box(Vec3(0.110, 0.130, 0.050), 0.022),
            {Vec3(0.0, -0.150, 0.135), Quat::Identity()});
    return kit.finish("chest");
}

std::vector<Mesh> make_controller() {
    constexpr std::array<LoftSection, 7> k_handle = {{{-0.062, 0.012, 0.012, 0.010, 0.0, -0.010},
                                                      {-0.058, 0.016, 0.017, 0.014, 0.0, -0.010},
                                                      {-0.010, 0.017, 0.018, 0.015, 0.0, -0.004},
                                                      {0.035, 0.020, 0.017, 0.014, 0.0, 0.002},
                                                      {0.070, 0.024, 0.015, 0.012, 0.0, 0.005},
                                                      {0.092, 0.022, 0.012, 0.010, 0.0, 0.005},
                                                      {0.100, 0.016, 0.008, 0.007, 0.0, 0.005}}};
    FigureKit kit;
    const Pose& forward = figure_forward();
    kit.add(joint, loft_sections(k_handle), forward);
    kit.add(shell, make_torus(0.047, 0.0085, 40, 12),
            {Vec3(0.0, 0.004, -0.125), rotation_about(Vec3::UnitX(), 1.05)});
    const Vec3 pad(0.0, 0.0175, -0.058);
    kit.add(shell, make_cylinder(pad, pad + Vec3(0.0, 0.0042, -0.0005), 0.0175, 32));
    kit.add(accent,
            make_cylinder(pad + Vec3(0.0, 0.004, 0.0), pad + Vec3(0.0, 0.0052, 0.0), 0.0050, 20));
    kit.add(accent, make_bevelled_box(Vec3(0.007, 0.012, 0.006), 0.003),
            {Vec3(0.0, -0.016, -0.062), rotation_about(Vec3::UnitX(), 0.35)});
    return kit.finish("controller");
}

}  // namespace handhold
