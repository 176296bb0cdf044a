// Every part is built in its bone's frame: arms from their joint along -Z with +Y towards the
// elbow's side, legs along -Z with +Y to the front, trunk and head upright.
#include "game/render/robot_body.hpp"

#include <array>

#include "components/tracking.hpp"
#include "engine/core/check.hpp"
#include "engine/io/gltf_skin_writer.hpp"
#include "game/mesh/primitives.hpp"
#include "game/render/figure_skin.hpp"
#include "game/render/figures.hpp"

namespace handhold {
namespace {

using enum FigureMaterial;

// Joint positions, right side; metres, origin on the floor below the pelvis.
const Vec3 k_hip_ms(0.09, 0.90, 0.0);
const Vec3 k_knee_ms(0.09, 0.50, 0.0);
const Vec3 k_ankle_ms(0.09, 0.11, 0.0);
const Vec3 k_pelvis_ms(0.0, 0.93, 0.0);
const Vec3 k_waist_ms(0.0, 1.06, 0.0);
const Vec3 k_belly_ms(0.0, 1.18, 0.0);
const Vec3 k_chest_ms(0.0, 1.30, 0.0);
const Vec3 k_neck_ms(0.0, 1.435, 0.005);
const Vec3 k_head_ms(0.0, 1.530, 0.0);
const Vec3 k_eyes_ms(0.0, 1.641, -0.07);
const Vec3 k_clavicle_ms(0.023, 1.42, 0.0);
const Vec3 k_shoulder_ms(0.19, 1.42, 0.0);
const Vec3 k_elbow_ms(0.49, 1.42, 0.0);
const Vec3 k_wrist_ms(0.77, 1.42, 0.0);

const Quat& upright() {  // rotates sections along +Z upright, their +Y to the front
    static const Quat turn = rotation_about(Vec3::UnitX(), -k_half_pi);
    return turn;
}

// A drum across a knee or elbow, with a bolt's head on either side.
void add_drum(FigureKit& kit, const Vec3& at, double half_m, double radius_m) {
    const Vec3 out(half_m, 0.0, 0.0);
    kit.add(joint, make_cylinder(at - out, at + out, radius_m, 28));
    for (const double side : {-1.0, 1.0}) {
        kit.add(metal, make_cylinder(at + side * out, at + side * 1.16 * out, 0.62 * radius_m, 24));
        kit.add(accent,
                make_cylinder(at + side * 1.16 * out, at + side * 1.22 * out, 0.30 * radius_m, 20));
    }
}

FigureKit build_pelvis() {
    constexpr std::array<LoftSection, 7> k_block = {{{-0.085, 0.045, 0.048, 0.035, 0.0, 0.000},
                                                     {-0.075, 0.075, 0.066, 0.045, 0.0, 0.000},
                                                     {-0.030, 0.112, 0.086, 0.060, 0.0, 0.000},
                                                     {0.020, 0.118, 0.090, 0.065, 0.0, 0.000},
                                                     {0.060, 0.108, 0.084, 0.062, 0.0, 0.000},
                                                     {0.078, 0.092, 0.072, 0.055, 0.0, 0.000},
                                                     {0.084, 0.070, 0.055, 0.045, 0.0, 0.000}}};
    FigureKit kit;
    kit.add(shell, loft_sections(k_block), {Vec3::Zero(), upright()});
    kit.add(accent, make_bevelled_box(Vec3(0.030, 0.010, 0.004), 0.0035),
            {Vec3(0.0, 0.036, -0.089), Quat::Identity()});
    kit.add(metal, make_torus(0.078, 0.008, 36, 10), {Vec3(0.0, 0.088, 0.0), upright()});
    return kit;
}

// Rubber rings around a core; they may overlap as the trunk bends.
FigureKit build_bellows(double height_m, double half_x_m, double half_y_m) {
    FigureKit kit;
    constexpr int k_rings = 3;
    for (int i = 0; i < k_rings; ++i) {
        const double y = height_m * (static_cast<double>(i) + 0.5) / k_rings;
        Mesh ring = make_torus(1.0, 0.22, 40, 12);
        stretch(ring, Vec3(0.86 * half_x_m, 0.86 * half_y_m, 0.42 * height_m));
        kit.add(joint, ring, {Vec3(0.0, y, 0.0), upright()});
    }
    Mesh core = make_cylinder(Vec3::Zero(), Vec3(0.0, height_m, 0.0), 1.0, 32);
    stretch(core, Vec3(0.80 * half_x_m, 1.0, 0.80 * half_y_m));
    kit.add(joint, core);
    return kit;
}

FigureKit build_chest() {
    // Sections of the chest, from the lowest rib to the collar.
    constexpr std::array<LoftSection, 9> k_ribs = {{{-0.105, 0.080, 0.066, 0.050, 0.0, 0.000},
                                                    {-0.098, 0.104, 0.082, 0.060, 0.0, 0.000},
                                                    {-0.050, 0.128, 0.100, 0.072, 0.0, 0.004},
                                                    {0.010, 0.146, 0.114, 0.080, 0.0, 0.008},
                                                    {0.065, 0.148, 0.114, 0.080, 0.0, 0.006},
                                                    {0.105, 0.138, 0.100, 0.072, 0.0, 0.000},
                                                    {0.132, 0.112, 0.080, 0.060, 0.0, -0.004},
                                                    {0.146, 0.080, 0.062, 0.046, 0.0, -0.006},
                                                    {0.150, 0.062, 0.050, 0.040, 0.0, -0.006}}};
    FigureKit kit;
    kit.add(shell, loft_sections(k_ribs), {Vec3::Zero(), upright()});
    kit.add(metal, make_torus(0.060, 0.009, 36, 10), {Vec3(0.0, 0.150, 0.005), upright()});
    // A lamp in the chest with seams beside it.
    kit.add(joint, make_cylinder(Vec3(0.0, 0.030, -0.105), Vec3(0.0, 0.030, -0.126), 0.034, 32));
    kit.add(accent, make_cylinder(Vec3(0.0, 0.030, -0.126), Vec3(0.0, 0.030, -0.129), 0.025, 32));
    for (const double side : {-1.0, 1.0}) {
        kit.add(joint, make_bevelled_box(Vec3(0.030, 0.006, 0.006), 0.003),
                {Vec3(side * 0.082, 0.010, -0.112), rotation_about(Vec3::UnitY(), -side * 0.22)});
        kit.add(joint, make_bevelled_box(Vec3(0.030, 0.006, 0.006), 0.003),
                {Vec3(side * 0.082, -0.014, -0.110), rotation_about(Vec3::UnitY(), -side * 0.22)});
    }
    // The backpack with two nozzles.
    kit.add(shell, make_bevelled_box(Vec3(0.098, 0.105, 0.042), 0.020),
            {Vec3(0.0, 0.010, 0.128), Quat::Identity()});
    kit.add(accent, make_bevelled_box(Vec3(0.060, 0.006, 0.004), 0.003),
            {Vec3(0.0, 0.060, 0.170), Quat::Identity()});
    for (const double side : {-1.0, 1.0}) {
        const Vec3 from(side * 0.060, -0.090, 0.128);
        kit.add(metal, make_cylinder(from, from + Vec3(0.0, -0.035, 0.0), 0.020, 24));
    }
    return kit;
}

FigureKit build_neck(double length_m) {
    FigureKit kit;
    for (int i = 0; i < 4; ++i) {
        const double y = length_m * (static_cast<double>(i) + 0.2) / 4.0;
        kit.add(joint, make_torus(0.052, 0.014, 32, 10), {Vec3(0.0, y, 0.0), upright()});
    }
    kit.add(metal, make_cylinder(Vec3::Zero(), Vec3(0.0, length_m, 0.0), 0.046, 24));
    return kit;
}

FigureKit build_clavicle(double length_m) {
    FigureKit kit;
    kit.add(joint, make_capsule(Vec3(0.0, 0.0, -0.10 * length_m), Vec3(0.0, 0.0, -0.9 * length_m),
                                0.047, 20));
    // The shoulder's cap over the ball joint of the arm.
    Mesh cap = make_sphere(1.0, 32);
    stretch(cap, Vec3(0.060, 0.056, 0.062));
    kit.add(shell, cap, {Vec3(0.0, 0.016, -length_m), Quat::Identity()});
    return kit;
}

// A limb's shell between two hinges. `waist`: how much it narrows towards its end.
Mesh limb_shell(double from_m, double to_m, double half_m, double deep_m, double waist) {
    const double length = to_m - from_m;
    const std::array<LoftSection, 7> sections = {
        {{from_m, 0.66 * half_m, 0.66 * deep_m, 0.45 * half_m, 0.0, 0.0},
         {from_m + 0.05 * length, 0.90 * half_m, 0.90 * deep_m, 0.62 * half_m, 0.0, 0.0},
         {from_m + 0.25 * length, half_m, deep_m, 0.70 * half_m, 0.0, 0.05 * deep_m},
         {from_m + 0.60 * length, (1.0 - 0.55 * waist) * half_m, (1.0 - 0.55 * waist) * deep_m,
          0.60 * (1.0 - 0.55 * waist) * half_m, 0.0, 0.04 * deep_m},
         {from_m + 0.90 * length, (1.0 - waist) * half_m, (1.0 - waist) * deep_m,
          0.60 * (1.0 - waist) * half_m, 0.0, 0.0},
         {from_m + 0.97 * length, (0.95 - waist) * half_m, (0.95 - waist) * deep_m,
          0.55 * (0.95 - waist) * half_m, 0.0, 0.0},
         {to_m, (0.75 - waist) * half_m, (0.75 - waist) * deep_m, 0.50 * (0.75 - waist) * half_m,
          0.0, 0.0}}};
    return loft_sections(sections);
}

Mesh limb_band(double at_m, double half_m, double deep_m) {
    const std::array<LoftSection, 4> band = {
        {{at_m - 0.008, 0.97 * half_m, 0.97 * deep_m, 0.66 * half_m, 0.0, 0.0},
         {at_m - 0.006, half_m, deep_m, 0.68 * half_m, 0.0, 0.0},
         {at_m + 0.006, half_m, deep_m, 0.68 * half_m, 0.0, 0.0},
         {at_m + 0.008, 0.97 * half_m, 0.97 * deep_m, 0.66 * half_m, 0.0, 0.0}}};
    return loft_sections(band);
}

FigureKit build_upper_arm(double length_m) {
    FigureKit kit;
    const Pose& forward = figure_forward();
    kit.add(joint, make_sphere(0.044, 28));
    kit.add(metal, make_capsule(Vec3::Zero(), Vec3(0.0, 0.0, -length_m), 0.021, 20));
    kit.add(shell, limb_shell(0.046, length_m - 0.034, 0.040, 0.041, 0.14), forward);
    kit.add(accent, limb_band(0.66 * length_m, 0.0372, 0.0382), forward);
    add_drum(kit, Vec3(0.0, 0.0, -length_m), 0.025, 0.030);
    return kit;
}

FigureKit build_forearm(double length_m) {
    FigureKit kit;
    const Pose& forward = figure_forward();
    kit.add(metal, make_capsule(Vec3::Zero(), Vec3(0.0, 0.0, -length_m), 0.018, 20));
    kit.add(shell, limb_shell(0.028, length_m - 0.034, 0.037, 0.036, 0.24), forward);
    kit.add(shell, make_bevelled_box(Vec3(0.016, 0.008, 0.052), 0.006),
            {Vec3(0.0, 0.036, -0.36 * length_m), Quat::Identity()});
    kit.add(accent, make_bevelled_box(Vec3(0.004, 0.003, 0.036), 0.002),
            {Vec3(0.0, 0.044, -0.36 * length_m), Quat::Identity()});
    kit.add(joint, make_cylinder(Vec3(0.0, 0.0, -(length_m - 0.040)),
                                 Vec3(0.0, 0.0, -(length_m - 0.010)), 0.028, 28));
    return kit;
}

FigureKit build_thigh(double length_m) {
    FigureKit kit;
    const Pose& forward = figure_forward();
    kit.add(joint, make_sphere(0.066, 28));
    kit.add(metal, make_capsule(Vec3::Zero(), Vec3(0.0, 0.0, -length_m), 0.030, 20));
    kit.add(shell, limb_shell(0.050, length_m - 0.046, 0.072, 0.076, 0.22), forward);
    kit.add(accent, limb_band(0.70 * length_m, 0.0645, 0.068), forward);
    add_drum(kit, Vec3(0.0, 0.0, -length_m), 0.042, 0.046);
    kit.add(shell, make_bevelled_box(Vec3(0.030, 0.012, 0.034), 0.010),  // knee guard
            {Vec3(0.0, 0.048, -length_m), Quat::Identity()});
    return kit;
}

FigureKit build_shin(double length_m) {
    FigureKit kit;
    const Pose& forward = figure_forward();
    kit.add(metal, make_capsule(Vec3::Zero(), Vec3(0.0, 0.0, -length_m), 0.026, 20));
    kit.add(shell, limb_shell(0.046, length_m - 0.040, 0.056, 0.062, 0.34), forward);
    kit.add(shell, make_bevelled_box(Vec3(0.014, 0.008, 0.090), 0.006),
            {Vec3(0.0, 0.058, -0.45 * length_m), Quat::Identity()});
    add_drum(kit, Vec3(0.0, 0.0, -length_m), 0.030, 0.034);
    return kit;
}

// The foot. Its frame is at the ankle: +Y up, -Z towards the toes.
FigureKit build_foot() {
    constexpr std::array<LoftSection, 8> k_boot = {{{-0.085, 0.024, 0.026, 0.018, 0.0, -0.070},
                                                    {-0.078, 0.034, 0.038, 0.026, 0.0, -0.066},
                                                    {-0.040, 0.042, 0.050, 0.034, 0.0, -0.054},
                                                    {0.010, 0.044, 0.052, 0.036, 0.0, -0.052},
                                                    {0.070, 0.047, 0.038, 0.030, 0.0, -0.066},
                                                    {0.125, 0.046, 0.028, 0.024, 0.0, -0.076},
                                                    {0.155, 0.036, 0.022, 0.018, 0.0, -0.080},
                                                    {0.165, 0.022, 0.014, 0.010, 0.0, -0.082}}};
    FigureKit kit;
    kit.add(shell, loft_sections(k_boot), figure_forward());
    kit.add(joint, make_bevelled_box(Vec3(0.044, 0.008, 0.118), 0.006),
            {Vec3(0.0, -0.106, -0.036), Quat::Identity()});
    kit.add(joint, make_cylinder(Vec3(0.0, -0.030, 0.0), Vec3(0.0, 0.012, 0.0), 0.034, 28));
    kit.add(accent, make_bevelled_box(Vec3(0.020, 0.003, 0.012), 0.0025),
            {Vec3(0.0, -0.022, -0.075), rotation_about(Vec3::UnitX(), -0.28)});
    return kit;
}

Vec3 on_side(HandSide side, const Vec3& right) {
    return side == HandSide::right ? right : Vec3(-right.x(), right.y(), right.z());
}

// Builds the figure's joints and the parts on each joint.
class BodyBuilder {
  public:
    std::string build() {
        const std::int32_t pelvis =
            add("pelvis", -1, {k_pelvis_ms, Quat::Identity()}, build_pelvis());
        const std::int32_t waist = add_upright("spine_1", pelvis, k_waist_ms - Vec3(0, 0.05, 0),
                                               build_bellows(0.110, 0.098, 0.078));
        const std::int32_t belly = add_upright("spine_2", waist, k_belly_ms - Vec3(0, 0.06, 0),
                                               build_bellows(0.110, 0.100, 0.080));
        const std::int32_t chest = add_upright("chest", belly, k_chest_ms, build_chest());
        const std::int32_t neck =
            add_upright("neck", chest, k_neck_ms, build_neck((k_head_ms - k_neck_ms).norm()));
        const std::int32_t head =
            add_upright("head", neck, k_head_ms,
                        build_head().placed({k_eyes_ms - k_head_ms, Quat::Identity()}));
        add_upright("eyes", head, k_eyes_ms, {});
        for (const HandSide side : {HandSide::left, HandSide::right}) {
            add_arm(side, chest);
            add_leg(side, pelvis);
        }
        return finish();
    }

  private:
    std::int32_t add(const std::string& name, std::int32_t parent, const Pose& at,
                     const FigureKit& kit) {
        joints_.push_back({name, parent, at, {}});
        kits_.push_back(kit);
        return static_cast<std::int32_t>(joints_.size()) - 1;
    }
    std::int32_t add_upright(const std::string& name, std::int32_t parent, const Vec3& at,
                             const FigureKit& kit) {
        return add(name, parent, {at, Quat::Identity()}, kit);
    }

    void add_arm(HandSide side, std::int32_t chest) {
        const std::string of = side == HandSide::left ? "_left" : "_right";
        const Vec3 clavicle = on_side(side, k_clavicle_ms);
        const Vec3 shoulder = on_side(side, k_shoulder_ms);
        const Vec3 elbow = on_side(side, k_elbow_ms);
        const Vec3 wrist = on_side(side, k_wrist_ms);
        const Vec3 back = Vec3::UnitZ();
        const Vec3 out = (wrist - shoulder).normalized();
        const std::int32_t collar =
            add("clavicle" + of, chest, look_along(clavicle, out, Vec3::UnitY()),
                build_clavicle((shoulder - clavicle).norm()));
        const std::int32_t upper = add("upper_arm" + of, collar, look_along(shoulder, out, back),
                                       build_upper_arm((elbow - shoulder).norm()));
        const std::int32_t lower = add("forearm" + of, upper, look_along(elbow, out, back),
                                       build_forearm((wrist - elbow).norm()));
        add("hand" + of, lower, look_along(wrist, out, Vec3::UnitY()), {});
    }

    void add_leg(HandSide side, std::int32_t pelvis) {
        const std::string of = side == HandSide::left ? "_left" : "_right";
        const Vec3 hip = on_side(side, k_hip_ms);
        const Vec3 knee = on_side(side, k_knee_ms);
        const Vec3 ankle = on_side(side, k_ankle_ms);
        // The bone's frame is upright; its parts are built along -Z and rotated downwards.
        const Pose down{Vec3::Zero(),
                        look_along(Vec3::Zero(), -Vec3::UnitY(), -Vec3::UnitZ()).rotation};
        const std::int32_t thigh =
            add_upright("thigh" + of, pelvis, hip, build_thigh((knee - hip).norm()).placed(down));
        const std::int32_t shin =
            add_upright("shin" + of, thigh, knee, build_shin((ankle - knee).norm()).placed(down));
        add_upright("foot" + of, shin, ankle, build_foot());
    }

    std::string finish() {
        FigureSkin skin("robot_body");
        for (std::size_t i = 0; i < joints_.size(); ++i) {
            skin.add(kits_[i], joints_[i].bind_ms, static_cast<std::uint16_t>(i), joints_[i].name);
        }
        return write_skinned_glb(FigureSkin::materials(), skin.finish(joints_));
    }

    std::vector<SkinJoint> joints_;
    std::vector<FigureKit> kits_;
};

}  // namespace

std::string make_robot_body_glb() { return BodyBuilder().build(); }

SkinnedMesh make_robot_body() {
    Result<SkinnedMesh> body = parse_gltf_figure(make_robot_body_glb(), "robot_body.glb");
    HH_CHECK(body.ok(), "the robot's own file is valid", body.ok());
    return std::move(body.value());
}

}  // namespace handhold
