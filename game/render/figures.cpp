#include "game/render/figures.hpp"

#include <array>

#include "game/mesh/primitives.hpp"

namespace handhold {

using enum FigureMaterial;

FigureKit build_head() {
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
    const Pose level{Vec3(0.0, -0.108, 0.066), rotation_about(Vec3::UnitX(), k_half_pi)};
    kit.add(joint, make_torus(0.072, 0.017, 32, 12), level);
    return kit;
}

WandMeshes make_wand() {
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
    FigureKit pad;
    pad.add(shell,
            make_cylinder(k_wand_pad_m, k_wand_pad_m + Vec3(0.0, 0.0042, -0.0005), 0.0175, 32));
    pad.add(accent, make_cylinder(k_wand_pad_m + Vec3(0.0, 0.004, 0.0),
                                  k_wand_pad_m + Vec3(0.0, 0.0052, 0.0), 0.0050, 20));
    FigureKit trigger;
    trigger.add(accent, make_bevelled_box(Vec3(0.007, 0.012, 0.006), 0.003),
                {Vec3(0.0, -0.016, -0.062), rotation_about(Vec3::UnitX(), 0.35)});
    FigureKit squeeze;
    squeeze.add(shell, make_bevelled_box(Vec3(0.008, 0.004, 0.014), 0.002),
                {Vec3(0.0, -0.0205, 0.003), Quat::Identity()});
    return {kit.finish("wand"), trigger.finish("wand trigger"), squeeze.finish("wand squeeze"),
            pad.finish("wand pad")};
}

}  // namespace handhold
