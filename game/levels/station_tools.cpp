#include "game/levels/station_tools.hpp"

#include <array>

#include "game/levels/station_kit.hpp"
#include "game/mesh/primitives.hpp"

namespace handhold {
namespace {

// A box collider. Colliders are slightly smaller than the visuals.
SceneShape box(const Vec3& half_m) {
    SceneShape shape;
    shape.kind = ShapeKind::box;
    shape.half_m = half_m;
    return shape;
}
SceneShape sphere(double radius_m) {
    SceneShape shape;
    shape.kind = ShapeKind::sphere;
    shape.radius_m = radius_m;
    return shape;
}
SceneShape capsule(double radius_m, double half_height_m) {
    SceneShape shape;
    shape.kind = ShapeKind::capsule;
    shape.radius_m = radius_m;
    shape.half_height_m = half_height_m;
    return shape;
}

Mesh tube(double radius_m, double y0, double y1, int segments = 20) {
    return make_cylinder(Vec3(0.0, y0, 0.0), Vec3(0.0, y1, 0.0), radius_m, segments);
}

// A wrench: an open jaw at each end of a flat bar along X.
void draw_wrench(StationKit& kit) {
    kit.beam(Material::metal, {}, Vec3::Zero(), Vec3(0.085, 0.007, 0.012));
    for (const double end : {-1.0, 1.0}) {
        kit.beam(Material::metal, {}, Vec3(end * 0.092, 0.0, 0.0), Vec3(0.016, 0.009, 0.026));
        for (const double jaw : {-1.0, 1.0}) {
            kit.beam(Material::metal, {}, Vec3(end * 0.118, 0.0, jaw * 0.020),
                     Vec3(0.016, 0.009, 0.008));
        }
    }
    kit.beam(Material::accent, {}, Vec3::Zero(), Vec3(0.040, 0.009, 0.014));
}

void draw_torch(StationKit& kit) {
    kit.add(Material::dark, tube(0.018, -0.085, 0.045), {});
    kit.add(Material::accent, tube(0.0195, -0.030, 0.010), {});
    const std::array<ProfilePoint, 4> head = {
        {{0.018, 0.0}, {0.028, 0.020}, {0.028, 0.048}, {0.024, 0.048}}};
    const Pose up{Vec3(0.0, 0.045, 0.0), rotation_about(Vec3::UnitX(), -1.57079632679489661923)};
    kit.add(Material::metal, make_revolved(head, 20), up);
    kit.add(Material::lamp, tube(0.0235, 0.090, 0.0955), {});
    kit.beam(Material::metal, {}, Vec3(0.0, 0.02, 0.0205), Vec3(0.006, 0.012, 0.004));
}

void draw_tablet(StationKit& kit) {
    kit.beam(Material::dark, {}, Vec3::Zero(), Vec3(0.125, 0.0075, 0.088));
    kit.block(Material::screen, {}, Vec3(0.0, 0.0078, 0.0), Vec3(0.108, 0.0012, 0.072));
    for (const double corner : {-1.0, 1.0}) {
        kit.beam(Material::accent, {}, Vec3(corner * 0.118, 0.0, 0.0), Vec3(0.011, 0.010, 0.092));
    }
}

void draw_bag(StationKit& kit) {
    kit.add(Material::fabric, make_bevelled_box(Vec3(0.24, 0.15, 0.17), 0.04), {});
    for (const double side : {-0.13, 0.13}) {
        kit.beam(Material::accent, {}, Vec3(side, 0.0, 0.0), Vec3(0.018, 0.154, 0.174));
    }
    const std::array<Vec3, 5> handle = {Vec3(-0.13, 0.148, 0.0), Vec3(-0.10, 0.185, 0.0),
                                        Vec3(0.0, 0.20, 0.0), Vec3(0.10, 0.185, 0.0),
                                        Vec3(0.13, 0.148, 0.0)};
    kit.hose(Material::dark, {}, handle, 0.012);
    kit.block(Material::panel, {}, Vec3(0.0, 0.02, 0.1705), Vec3(0.07, 0.045, 0.002));
}

void draw_bottle(StationKit& kit) {
    kit.add(Material::screen, tube(0.036, -0.085, 0.030), {});
    const std::array<ProfilePoint, 4> neck = {
        {{0.036, 0.030}, {0.033, 0.050}, {0.015, 0.072}, {0.015, 0.085}}};
    const Pose up{Vec3::Zero(), rotation_about(Vec3::UnitX(), -1.57079632679489661923)};
    kit.add(Material::panel, make_revolved(neck, 20), up);
    kit.add(Material::accent, tube(0.018, 0.084, 0.105), {});
    kit.add(Material::dark, tube(0.005, 0.104, 0.122, 10), {});
    kit.add(Material::panel, tube(0.037, -0.055, -0.010), {});
}

// A drill: body along Z, grip along -Y.
void draw_drill(StationKit& kit) {
    const Vec3 nose(0.0, 0.055, -0.10);
    kit.add(Material::accent, make_capsule(nose, Vec3(0.0, 0.055, 0.055), 0.036, 20), {});
    kit.add(Material::metal, make_cylinder(nose, nose - Vec3(0.0, 0.0, 0.055), 0.018, 16), {});
    kit.add(Material::dark,
            make_cylinder(nose - Vec3(0.0, 0.0, 0.05), nose - Vec3(0.0, 0.0, 0.10), 0.006, 10), {});
    kit.beam(Material::dark, {}, Vec3(0.0, -0.03, 0.02), Vec3(0.018, 0.065, 0.026));
    kit.beam(Material::accent, {}, Vec3(0.0, -0.10, 0.015), Vec3(0.032, 0.024, 0.055));
    kit.beam(Material::metal, {}, Vec3(0.0, 0.0, -0.013), Vec3(0.007, 0.014, 0.009));
}

void draw_camera(StationKit& kit) {
    kit.beam(Material::dark, {}, Vec3::Zero(), Vec3(0.070, 0.048, 0.032));
    kit.beam(Material::dark, {}, Vec3(0.0, 0.056, 0.0), Vec3(0.026, 0.014, 0.024));
    for (const auto& [radius, from, to] :
         {std::array{0.040, -0.030, -0.075}, std::array{0.043, -0.070, -0.095}}) {
        kit.add(Material::metal, make_cylinder(Vec3(0, 0, from), Vec3(0, 0, to), radius, 24), {});
    }
    kit.add(Material::glass, make_cylinder(Vec3(0, 0, -0.094), Vec3(0, 0, -0.097), 0.036, 24), {});
    kit.beam(Material::accent, {}, Vec3(0.058, 0.0, 0.004), Vec3(0.016, 0.050, 0.034));
    kit.block(Material::screen, {}, Vec3(-0.008, -0.004, 0.0325), Vec3(0.038, 0.028, 0.001));
}

void draw_tape(StationKit& kit) {
    const Pose flat{Vec3::Zero(), rotation_about(Vec3::UnitX(), 1.57079632679489661923)};
    kit.add(Material::foil, make_torus(0.042, 0.016, 32, 10), flat);
    kit.add(Material::panel, make_torus(0.030, 0.010, 32, 8), flat);
}

void draw_canister(StationKit& kit) {
    kit.add(Material::panel, make_capsule(Vec3(0, -0.16, 0), Vec3(0, 0.16, 0), 0.085, 24), {});
    for (const double y : {-0.12, 0.12}) {
        kit.add(Material::accent, tube(0.0875, y - 0.018, y + 0.018, 24), {});
    }
    kit.add(Material::metal, tube(0.022, 0.235, 0.285, 16), {});
    const Pose wheel{Vec3(0.0, 0.285, 0.0), rotation_about(Vec3::UnitX(), 1.57079632679489661923)};
    kit.add(Material::rail, make_torus(0.035, 0.007, 24, 8), wheel);
}

void draw_ball(StationKit& kit) {
    kit.add(Material::accent, make_icosphere(0.07, 3), {});
    kit.add(Material::panel, make_torus(0.0685, 0.005, 32, 8), {});
}

void draw_book(StationKit& kit) {
    kit.block(Material::panel, {}, Vec3(0.002, 0.0, 0.0), Vec3(0.070, 0.011, 0.098));
    for (const double side : {-1.0, 1.0}) {
        kit.block(Material::accent, {}, Vec3(0.0, side * 0.013, 0.0), Vec3(0.076, 0.0018, 0.104));
    }
    kit.block(Material::accent, {}, Vec3(-0.0745, 0.0, 0.0), Vec3(0.0018, 0.012, 0.104));
}

void draw_helmet(StationKit& kit) {
    kit.add(Material::hull, make_icosphere(0.15, 3), {});
    const std::array<ProfilePoint, 4> collar = {
        {{0.095, -0.01}, {0.115, 0.0}, {0.115, 0.030}, {0.095, 0.035}}};
    const Pose down{Vec3(0.0, -0.115, 0.0), rotation_about(Vec3::UnitX(), 1.57079632679489661923)};
    kit.add(Material::metal, make_revolved(collar, 28), down);
    Mesh visor = make_icosphere(0.152, 3);
    stretch(visor, Vec3(0.72, 0.55, 0.80));
    kit.add(Material::foil, visor, Pose{Vec3(0.0, 0.015, -0.042), Quat::Identity()});
    for (const double side : {-1.0, 1.0}) {
        kit.add(
            Material::accent,
            make_cylinder(Vec3(side * 0.135, 0.0, 0.0), Vec3(side * 0.158, 0.0, 0.0), 0.032, 20),
            {});
    }
}

struct ToolKind {
    ToolType type;
    const char* name;
    SceneShape shape;
    double mass_kg;
    Color accent;
    void (*draw)(StationKit&);
};

const std::array<ToolKind, 12>& tool_kinds() {
    static const std::array<ToolKind, 12> kinds = {{
        {ToolType::wrench,
         "wrench",
         box({0.128, 0.009, 0.027}),
         0.45,
         {0.5F, 0.1F, 0.03F},
         draw_wrench},
        {ToolType::torch, "torch", capsule(0.024, 0.066), 0.30, {0.55F, 0.35F, 0.03F}, draw_torch},
        {ToolType::tablet,
         "tablet",
         box({0.125, 0.009, 0.088}),
         0.65,
         {0.05F, 0.2F, 0.3F},
         draw_tablet},
        {ToolType::bag, "bag", box({0.235, 0.148, 0.168}), 9.0, {0.05F, 0.16F, 0.34F}, draw_bag},
        {ToolType::bottle,
         "bottle",
         capsule(0.036, 0.066),
         0.8,
         {0.45F, 0.08F, 0.05F},
         draw_bottle},
        {ToolType::drill,
         "drill",
         box({0.036, 0.112, 0.115}),
         1.9,
         {0.55F, 0.40F, 0.02F},
         draw_drill},
        {ToolType::camera,
         "camera",
         box({0.072, 0.058, 0.062}),
         1.2,
         {0.25F, 0.04F, 0.03F},
         draw_camera},
        {ToolType::tape, "tape", box({0.052, 0.014, 0.052}), 0.25, {0.5F, 0.5F, 0.5F}, draw_tape},
        {ToolType::canister,
         "canister",
         capsule(0.085, 0.17),
         6.5,
         {0.06F, 0.30F, 0.12F},
         draw_canister},
        {ToolType::ball, "ball", sphere(0.07), 0.35, {0.5F, 0.06F, 0.05F}, draw_ball},
        {ToolType::book,
         "book",
         box({0.075, 0.014, 0.103}),
         0.55,
         {0.08F, 0.10F, 0.30F},
         draw_book},
        {ToolType::helmet, "helmet", sphere(0.15), 2.6, {0.5F, 0.16F, 0.03F}, draw_helmet},
    }};
    return kinds;
}

const ToolKind& kind_of(ToolType type) { return tool_kinds()[static_cast<std::size_t>(type)]; }

}  // namespace

ToolModel make_tool(ToolType type) {
    const ToolKind& kind = kind_of(type);
    ToolModel model;
    model.shape = kind.shape;
    model.mass_kg = kind.mass_kg;
    StationKit kit(model.visual, kind.name, kind.accent);
    kind.draw(kit);
    kit.finish();
    return model;
}

const char* tool_type_name(ToolType type) { return kind_of(type).name; }

}  // namespace handhold
