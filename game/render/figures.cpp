#include "game/render/figures.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <utility>

#include "game/render/primitives.hpp"

namespace handhold {
namespace {

constexpr std::array<float, 3> k_shell_color = {0.78F, 0.77F, 0.74F};
constexpr std::array<float, 3> k_joint_color = {0.045F, 0.048F, 0.055F};
constexpr std::array<float, 3> k_accent_color = {0.85F, 0.24F, 0.04F};

// The three meshes of a figure while it is built.
struct FigureParts {
    Mesh shell, joints, accent;
};

std::vector<Mesh> finish(FigureParts parts, const std::string& name) {
    std::vector<Mesh> meshes;
    const auto add = [&](Mesh& mesh, const char* part, const std::array<float, 3>& color) {
        if (!mesh.triangles.empty()) {
            weld(mesh);
            mesh.name = name + "/" + part;
            mesh.color = color;
            meshes.push_back(std::move(mesh));
        }
    };
    add(parts.shell, "shell", k_shell_color);
    add(parts.joints, "joints", k_joint_color);
    add(parts.accent, "accent", k_accent_color);
    return meshes;
}

// One step of a loft along +Z: a rounded rectangle about (x, y).
struct Section {
    double z_m, half_x_m, half_y_m, corner_m, x_m, y_m;
};

Mesh loft_sections(std::span<const Section> sections) {
    std::vector<Ring> rings;
    for (const Section& s : sections) {
        Ring ring = make_outline({s.half_x_m, s.half_y_m, s.corner_m, 5, 1}, s.z_m);
        for (Vec3& point : ring) {
            point += Vec3(s.x_m, s.y_m, 0.0);
        }
        rings.push_back(std::move(ring));
    }
    return make_loft(rings, LoftEnds::capped);
}

// The hand is built with the fingers along +Z and the thumb at +X; half a turn about Y gives a
// right hand.
const Pose& to_hand() {
    static const Pose pose{Vec3::Zero(), Quat(0.0, 0.0, 1.0, 0.0)};
    return pose;
}

void mirror(FigureParts& parts) {
    mirror_x(parts.shell);
    mirror_x(parts.joints);
    mirror_x(parts.accent);
}

// A link from a to b: a bulged shell over the bone, the joint's ball at a.
void add_link(FigureParts& parts, const Vec3& a, const Vec3& b, double radius_m) {
    const double length = (b - a).norm();
    const double r = radius_m;
    const std::array<ProfilePoint, 9> profile = {{{0.0, 0.10 * length},
                                                  {0.72 * r, 0.10 * length},
                                                  {0.96 * r, 0.17 * length},
                                                  {1.04 * r, 0.35 * length},
                                                  {1.00 * r, 0.60 * length},
                                                  {0.92 * r, 0.84 * length},
                                                  {0.72 * r, 0.96 * length},
                                                  {0.40 * r, length + 0.10 * r},
                                                  {0.0, length + 0.18 * r}}};
    const Quat turn = rotation_between(Vec3::UnitZ(), (b - a) / length);
    append(parts.shell, make_revolved(profile, 14), {a, turn});
    append(parts.joints, make_sphere(0.86 * r, 12), {a, Quat::Identity()});
}

void add_finger_tip(FigureParts& parts, const Vec3& at, double radius_m) {
    append(parts.joints, make_sphere(0.90 * radius_m, 12), {at, Quat::Identity()});
}

struct Finger {
    Vec3 base;
    std::array<double, 3> links_m;
    double radius_m;
    double spread_rad;  // about +Y, towards the thumb
};
const std::array<Finger, 4>& fingers() {
    static const std::array<Finger, 4> list = {
        {{Vec3(0.0300, 0.000, 0.089), {0.038, 0.024, 0.019}, 0.0095, 0.07},
         {Vec3(0.0098, 0.002, 0.092), {0.042, 0.027, 0.020}, 0.0098, 0.01},
         {Vec3(-0.0104, 0.001, 0.089), {0.039, 0.025, 0.019}, 0.0094, -0.04},
         {Vec3(-0.0296, -0.002, 0.082), {0.031, 0.019, 0.017}, 0.0085, -0.10}}};
    return list;
}

// The bar that HandShape::grip holds, in the plane that the fingers bend in.
constexpr double k_bar_radius_m = 0.0175;
const Vec3 k_bar_center(0.0, -0.034, 0.080);

// How far a link can bend before it touches the bar. The link starts at `joint`, turned by
// `turned_rad` already.
double bend_onto_bar(const Vec3& joint, double turned_rad, double length_m, double radius_m) {
    constexpr double k_step_rad = 0.01;
    constexpr double k_most_rad = 1.75;
    const Vec3 to_bar(0.0, k_bar_center.y() - joint.y(), k_bar_center.z() - joint.z());
    double bend = 0.0;
    while (bend < k_most_rad) {
        const Vec3 along = rotation_about(Vec3::UnitX(), turned_rad + bend + k_step_rad) *
                           Vec3(0.0, 0.0, length_m);
        const double t = std::clamp(to_bar.dot(along) / (length_m * length_m), 0.0, 1.0);
        if ((to_bar - t * along).norm() < k_bar_radius_m + 1.05 * radius_m) {
            break;
        }
        bend += k_step_rad;
    }
    return bend;
}

void add_finger(FigureParts& parts, const Finger& finger, HandShape shape, double relaxed_more) {
    constexpr std::array<double, 3> k_relaxed_rad = {0.22, 0.34, 0.20};
    const bool is_open = shape == HandShape::open;
    const Quat spread = rotation_about(Vec3::UnitY(), is_open ? finger.spread_rad : 0.0);
    double turned = 0.0;
    Vec3 joint = finger.base;
    for (std::size_t link = 0; link < 3; ++link) {
        const double length = finger.links_m[link];
        const double radius = finger.radius_m * (1.0 - 0.08 * static_cast<double>(link));
        turned += is_open ? relaxed_more * k_relaxed_rad[link]
                          : bend_onto_bar(joint, turned, length, radius);
        const Vec3 next =
            joint + spread * (rotation_about(Vec3::UnitX(), turned) * Vec3(0.0, 0.0, length));
        add_link(parts, joint, next, radius);
        joint = next;
    }
    add_finger_tip(parts, joint, 0.8 * finger.radius_m);
}

void add_fingers(FigureParts& parts, HandShape shape) {
    double more = 1.0;  // fingers towards the little one curl a little more in a relaxed hand
    for (const Finger& finger : fingers()) {
        add_finger(parts, finger, shape, more);
        more += 0.16;
    }
    const std::array<Vec3, 4> open_thumb = {Vec3(0.030, -0.006, 0.028), Vec3(0.052, -0.018, 0.058),
                                            Vec3(0.062, -0.026, 0.087), Vec3(0.066, -0.031, 0.110)};
    const std::array<Vec3, 4> grip_thumb = {Vec3(0.030, -0.008, 0.028), Vec3(0.051, -0.036, 0.046),
                                            Vec3(0.053, -0.063, 0.061), Vec3(0.051, -0.068, 0.083)};
    const std::array<Vec3, 4>& thumb = shape == HandShape::open ? open_thumb : grip_thumb;
    for (std::size_t link = 0; link < 3; ++link) {
        add_link(parts, thumb[link], thumb[link + 1], 0.0118 - 0.0010 * static_cast<double>(link));
    }
    add_finger_tip(parts, thumb[3], 0.0088);
}

FigureParts build_palm() {
    constexpr std::array<Section, 7> k_palm = {{{0.006, 0.024, 0.0150, 0.0140, 0.000, 0.000},
                                                {0.012, 0.029, 0.0175, 0.0150, 0.000, 0.000},
                                                {0.030, 0.037, 0.0165, 0.0140, 0.001, 0.000},
                                                {0.055, 0.042, 0.0145, 0.0120, 0.001, 0.000},
                                                {0.076, 0.042, 0.0125, 0.0105, 0.000, 0.001},
                                                {0.084, 0.040, 0.0110, 0.0095, 0.000, 0.001},
                                                {0.087, 0.036, 0.0080, 0.0070, 0.000, 0.001}}};
    FigureParts parts;
    append(parts.shell, loft_sections(k_palm));
    for (const Finger& finger : fingers()) {
        const Vec3 half_axle(0.0085, 0.0, 0.0);
        append(parts.joints,
               make_cylinder(finger.base - half_axle, finger.base + half_axle, 0.0088, 16));
    }
    // Plate on the back, pad in the palm, cuff at the wrist.
    constexpr std::array<Section, 4> k_plate = {{{0.022, 0.016, 0.0040, 0.0030, 0.0, 0.0150},
                                                 {0.026, 0.019, 0.0050, 0.0035, 0.0, 0.0155},
                                                 {0.066, 0.028, 0.0045, 0.0035, 0.0, 0.0120},
                                                 {0.070, 0.026, 0.0035, 0.0028, 0.0, 0.0115}}};
    append(parts.accent, loft_sections(k_plate));
    constexpr std::array<Section, 4> k_pad = {{{0.030, 0.022, 0.004, 0.0035, 0.0, -0.0150},
                                               {0.036, 0.028, 0.005, 0.0045, 0.0, -0.0140},
                                               {0.072, 0.030, 0.005, 0.0045, 0.0, -0.0100},
                                               {0.078, 0.026, 0.004, 0.0035, 0.0, -0.0090}}};
    append(parts.joints, loft_sections(k_pad));
    append(parts.joints, make_sphere(0.020, 18), {Vec3(0.0, 0.0, 0.002), Quat::Identity()});
    const std::array<ProfilePoint, 6> cuff = {{{0.026, -0.034},
                                               {0.030, -0.031},
                                               {0.031, -0.016},
                                               {0.030, -0.008},
                                               {0.027, -0.004},
                                               {0.020, -0.004}}};
    append(parts.shell, make_revolved(cuff, 24));
    append(parts.accent, make_torus(0.0305, 0.0022, 32, 8),
           {Vec3(0.0, 0.0, -0.022), Quat::Identity()});
    return parts;
}

std::vector<Mesh> finish_hand(const FigureParts& parts, FigureSide side) {
    FigureParts turned;
    append(turned.shell, parts.shell, to_hand());
    append(turned.joints, parts.joints, to_hand());
    append(turned.accent, parts.accent, to_hand());
    if (side == FigureSide::left) {
        mirror(turned);
    }
    return finish(std::move(turned), side == FigureSide::left ? "hand_left" : "hand_right");
}

}  // namespace

std::vector<Mesh> make_hand(FigureSide side, HandShape shape) {
    FigureParts parts = build_palm();
    add_fingers(parts, shape);
    return finish_hand(parts, side);
}

std::vector<Mesh> make_palm(FigureSide side) { return finish_hand(build_palm(), side); }

std::vector<Mesh> make_finger_link(double length_m, double radius_m) {
    FigureParts parts;
    add_link(parts, Vec3::Zero(), Vec3(0.0, 0.0, -length_m), radius_m);
    return finish(std::move(parts), "finger_link");
}

std::vector<Mesh> make_head() {
    FigureParts parts;
    Mesh helmet = make_sphere(1.0, 40);
    stretch(helmet, Vec3(0.118, 0.140, 0.142));
    append(parts.shell, helmet, {Vec3(0.0, 0.020, 0.062), Quat::Identity()});
    Mesh visor = make_sphere(1.0, 40);
    stretch(visor, Vec3(0.100, 0.072, 0.105));
    append(parts.joints, visor, {Vec3(0.0, 0.012, 0.012), Quat::Identity()});
    Mesh brow = make_torus(0.092, 0.0065, 40, 10);
    stretch(brow, Vec3(1.06, 0.78, 1.0));
    append(parts.shell, brow, {Vec3(0.0, 0.013, -0.026), Quat::Identity()});
    for (const double side : {-1.0, 1.0}) {
        const Vec3 ear(side * 0.105, 0.005, 0.066);
        const Vec3 out(side * 0.024, 0.0, 0.0);
        append(parts.joints, make_cylinder(ear, ear + out, 0.040, 28));
        append(parts.accent, make_cylinder(ear + out, ear + 1.25 * out, 0.030, 28));
    }
    append(parts.accent, make_bevelled_box(Vec3(0.012, 0.008, 0.052), 0.004),
           {Vec3(0.0, 0.155, 0.062), Quat::Identity()});
    const Pose level{Vec3(0.0, -0.108, 0.066), rotation_about(Vec3::UnitX(), 1.5707963267948966)};
    append(parts.joints, make_torus(0.072, 0.017, 32, 12), level);
    return finish(std::move(parts), "head");
}

std::vector<Mesh> make_limb(double length_m, double radius_m) {
    const double r = radius_m;
    const std::array<ProfilePoint, 8> shell = {{{0.55 * r, 0.10 * length_m},
                                                {0.85 * r, 0.12 * length_m},
                                                {1.00 * r, 0.22 * length_m},
                                                {1.05 * r, 0.45 * length_m},
                                                {0.92 * r, 0.75 * length_m},
                                                {0.82 * r, 0.88 * length_m},
                                                {0.70 * r, 0.91 * length_m},
                                                {0.50 * r, 0.91 * length_m}}};
    FigureParts parts;
    const Pose forward{Vec3::Zero(), Quat(0.0, 1.0, 0.0, 0.0)};
    append(parts.shell, make_revolved(shell, 20), forward);
    append(parts.joints, make_capsule(Vec3::Zero(), Vec3(0.0, 0.0, -length_m), 0.62 * r, 16));
    append(parts.accent, make_torus(0.84 * r, 0.10 * r, 28, 8),
           {Vec3(0.0, 0.0, -0.86 * length_m), Quat::Identity()});
    return finish(std::move(parts), "limb");
}

std::vector<Mesh> make_chest() {
    // Sections from the waist up; turned so that their +Z becomes +Y and their +Y the front.
    constexpr std::array<Section, 7> k_torso = {{{-0.330, 0.085, 0.070, 0.050, 0.0, 0.000},
                                                 {-0.310, 0.105, 0.085, 0.060, 0.0, 0.000},
                                                 {-0.220, 0.135, 0.105, 0.075, 0.0, 0.004},
                                                 {-0.120, 0.165, 0.120, 0.085, 0.0, 0.006},
                                                 {-0.055, 0.165, 0.108, 0.080, 0.0, 0.002},
                                                 {-0.020, 0.120, 0.080, 0.060, 0.0, 0.000},
                                                 {-0.008, 0.080, 0.060, 0.045, 0.0, 0.000}}};
    FigureParts parts;
    const Pose upright{Vec3::Zero(), rotation_about(Vec3::UnitX(), -1.5707963267948966)};
    append(parts.shell, loft_sections(k_torso), upright);
    append(parts.joints, make_capsule(Vec3(0.0, -0.03, 0.0), Vec3(0.0, 0.05, 0.0), 0.050, 20));
    for (const double side : {-1.0, 1.0}) {
        append(parts.joints, make_sphere(0.058, 20),
               {Vec3(side * 0.175, -0.062, 0.0), {1, 0, 0, 0}});
        append(parts.accent, make_bevelled_box(Vec3(0.040, 0.012, 0.004), 0.0035),
               {Vec3(side * 0.060, -0.120, -0.124), Quat::Identity()});
    }
    append(parts.shell, make_bevelled_box(Vec3(0.110, 0.130, 0.050), 0.022),
           {Vec3(0.0, -0.150, 0.135), Quat::Identity()});
    return finish(std::move(parts), "chest");
}

std::vector<Mesh> make_controller() {
    constexpr std::array<Section, 7> k_handle = {{{-0.062, 0.012, 0.012, 0.010, 0.0, -0.010},
                                                  {-0.058, 0.016, 0.017, 0.014, 0.0, -0.010},
                                                  {-0.010, 0.017, 0.018, 0.015, 0.0, -0.004},
                                                  {0.035, 0.020, 0.017, 0.014, 0.0, 0.002},
                                                  {0.070, 0.024, 0.015, 0.012, 0.0, 0.005},
                                                  {0.092, 0.022, 0.012, 0.010, 0.0, 0.005},
                                                  {0.100, 0.016, 0.008, 0.007, 0.0, 0.005}}};
    FigureParts parts;
    const Pose& forward = to_hand();
    append(parts.joints, loft_sections(k_handle), forward);
    append(parts.shell, make_torus(0.047, 0.0085, 40, 12),
           {Vec3(0.0, 0.004, -0.125), rotation_about(Vec3::UnitX(), 1.05)});
    const Vec3 pad(0.0, 0.0175, -0.058);
    append(parts.shell, make_cylinder(pad, pad + Vec3(0.0, 0.0042, -0.0005), 0.0175, 32));
    append(parts.accent,
           make_cylinder(pad + Vec3(0.0, 0.004, 0.0), pad + Vec3(0.0, 0.0052, 0.0), 0.0050, 20));
    append(parts.accent, make_bevelled_box(Vec3(0.007, 0.012, 0.006), 0.003),
           {Vec3(0.0, -0.016, -0.062), rotation_about(Vec3::UnitX(), 0.35)});
    return finish(std::move(parts), "controller");
}

}  // namespace handhold
