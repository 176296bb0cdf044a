#include "game/render/robot_hand.hpp"

#include "game/mesh/mesh_edit.hpp"
#include "game/mesh/primitives.hpp"
#include "systems/rigs/hand_kinematics.hpp"

namespace handhold {
namespace {

using enum FigureMaterial;

// A drum across the finger with a bolt's head on either side.
void add_hinge(FigureKit& kit, double r) {
    const Vec3 drum(0.66 * r, 0.0, 0.0);
    const Vec3 bolt(0.90 * r, 0.0, 0.0);
    kit.add(joint, make_cylinder(-drum, drum, 0.80 * r, 20));
    kit.add(metal, make_cylinder(drum, bolt, 0.42 * r, 16));
    kit.add(metal, make_cylinder(-bolt, -drum, 0.42 * r, 16));
}

// A shell over the back and sides, from this hinge's drum to the next one.
void add_shell(FigureKit& kit, double length, double r) {
    const double from = 0.62 * r;
    const double to = length - 0.66 * r;
    const std::array<LoftSection, 6> sections = {
        {{from, 0.68 * r, 0.44 * r, 0.36 * r, 0.0, 0.30 * r},
         {from + 0.16 * r, 0.92 * r, 0.66 * r, 0.50 * r, 0.0, 0.26 * r},
         {from + 0.5 * (to - from), 0.90 * r, 0.66 * r, 0.52 * r, 0.0, 0.24 * r},
         {to - 0.22 * r, 0.86 * r, 0.62 * r, 0.48 * r, 0.0, 0.22 * r},
         {to - 0.06 * r, 0.80 * r, 0.54 * r, 0.42 * r, 0.0, 0.22 * r},
         {to, 0.66 * r, 0.40 * r, 0.34 * r, 0.0, 0.22 * r}}};
    kit.add(shell, loft_sections(sections));
}

// The contact side: rubber below the shell, flush with the capsule.
void add_pad(FigureKit& kit, double length, double r) {
    const double from = 0.58 * r;
    const double to = length - 0.60 * r;
    const std::array<LoftSection, 5> sections = {
        {{from, 0.50 * r, 0.34 * r, 0.30 * r, 0.0, -0.46 * r},
         {from + 0.22 * r, 0.70 * r, 0.50 * r, 0.44 * r, 0.0, -0.49 * r},
         {0.5 * (from + to), 0.72 * r, 0.51 * r, 0.46 * r, 0.0, -0.49 * r},
         {to - 0.22 * r, 0.66 * r, 0.48 * r, 0.42 * r, 0.0, -0.49 * r},
         {to, 0.46 * r, 0.32 * r, 0.28 * r, 0.0, -0.46 * r}}};
    kit.add(joint, loft_sections(sections));
}

// The rounded end: a rubber tip, covered by a shell from above.
void add_tip(FigureKit& kit, double length, double r) {
    const double from = 0.62 * r;
    const std::array<LoftSection, 7> cap = {
        {{from, 0.68 * r, 0.44 * r, 0.36 * r, 0.0, 0.30 * r},
         {from + 0.16 * r, 0.92 * r, 0.66 * r, 0.50 * r, 0.0, 0.26 * r},
         {0.55 * length, 0.89 * r, 0.64 * r, 0.52 * r, 0.0, 0.25 * r},
         {length, 0.82 * r, 0.56 * r, 0.50 * r, 0.0, 0.24 * r},
         {length + 0.40 * r, 0.66 * r, 0.42 * r, 0.38 * r, 0.0, 0.22 * r},
         {length + 0.66 * r, 0.44 * r, 0.27 * r, 0.24 * r, 0.0, 0.20 * r},
         {length + 0.78 * r, 0.22 * r, 0.13 * r, 0.11 * r, 0.0, 0.18 * r}}};
    kit.add(shell, loft_sections(cap));
    const std::array<LoftSection, 7> pad = {
        {{0.58 * r, 0.50 * r, 0.34 * r, 0.30 * r, 0.0, -0.46 * r},
         {0.80 * r, 0.72 * r, 0.52 * r, 0.46 * r, 0.0, -0.48 * r},
         {length, 0.80 * r, 0.62 * r, 0.56 * r, 0.0, -0.38 * r},
         {length + 0.40 * r, 0.74 * r, 0.58 * r, 0.52 * r, 0.0, -0.30 * r},
         {length + 0.70 * r, 0.52 * r, 0.42 * r, 0.38 * r, 0.0, -0.22 * r},
         {length + 0.88 * r, 0.30 * r, 0.25 * r, 0.22 * r, 0.0, -0.16 * r},
         {length + 0.96 * r, 0.12 * r, 0.10 * r, 0.09 * r, 0.0, -0.12 * r}}};
    kit.add(joint, loft_sections(pad));
}

// A coloured band around a finger's first link.
void add_band(FigureKit& kit, double length, double r) {
    const double z = 0.5 * length;
    const double half = 0.10 * r;
    const std::array<LoftSection, 4> band = {
        {{z - 1.4 * half, 0.90 * r, 0.66 * r, 0.52 * r, 0.0, 0.24 * r},
         {z - half, 0.945 * r, 0.705 * r, 0.56 * r, 0.0, 0.24 * r},
         {z + half, 0.945 * r, 0.705 * r, 0.56 * r, 0.0, 0.24 * r},
         {z + 1.4 * half, 0.90 * r, 0.66 * r, 0.52 * r, 0.0, 0.24 * r}}};
    kit.add(accent, loft_sections(band));
}

void add_parts(const FigureKit& kit, std::int32_t finger, std::uint32_t link,
               const std::string& name, std::vector<HandPart>& parts) {
    for (std::size_t i = 0; i < k_figure_material_count; ++i) {
        const auto material = static_cast<FigureMaterial>(i);
        Mesh mesh = kit.finish(material, name);
        if (!mesh.triangles.empty()) {
            parts.push_back({finger, link, material, std::move(mesh), false});
        }
    }
}

}  // namespace

FigureKit build_robot_link(double length_m, double radius_m, bool is_first, bool is_last) {
    FigureKit kit;
    const double r = radius_m;
    add_hinge(kit, r);
    const double bone_end = length_m - (is_last ? 0.0 : 0.3 * r);
    kit.add(metal, make_capsule(Vec3::Zero(), Vec3(0.0, 0.0, bone_end), 0.40 * r, 12));
    if (is_last) {
        add_tip(kit, length_m, r);
    } else {
        add_shell(kit, length_m, r);
        add_pad(kit, length_m, r);
    }
    if (is_first) {
        add_band(kit, length_m, r);
    }
    return kit.placed(figure_forward());
}

std::vector<HandPart> make_robot_hand(const HandRig& rig) {
    const bool is_left = rig.side == HandSide::left;
    std::vector<HandPart> parts;
    const std::string side = is_left ? "hand_left" : "hand_right";
    FigureKit palm = build_robot_palm(is_left ? mirror_hand_rig(rig) : rig);
    if (is_left) {
        palm.mirror();
    }
    add_parts(palm, RigJoint::k_palm, 0, side + "/palm", parts);
    const std::size_t first_of_cuff = parts.size();
    add_parts(build_robot_cuff(), RigJoint::k_palm, 0, side + "/cuff", parts);
    for (std::size_t i = first_of_cuff; i < parts.size(); ++i) {
        parts[i].is_cuff = true;
    }
    for (std::size_t i = 0; i < rig.fingers.size(); ++i) {
        const FingerRig& finger = rig.fingers[i];
        for (std::uint32_t link = 0; link < finger.link_count; ++link) {
            const FigureKit kit = build_robot_link(finger.length_m[link], finger.radius_m[link],
                                                   link == 0, link + 1 == finger.link_count);
            add_parts(kit, static_cast<std::int32_t>(i), link,
                      side + "/" + finger_text(finger.name) + std::to_string(link), parts);
        }
    }
    return parts;
}

}  // namespace handhold
