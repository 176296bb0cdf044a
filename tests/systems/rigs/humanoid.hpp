#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/io/gltf_skin_writer.hpp"
#include "engine/math/scalar_rotation.hpp"
#include "systems/rigs/body_joint_names.hpp"
#include "tests/systems/rigs/humanoid_conventions.hpp"

// Humanoid figures whose joints follow a convention.
namespace handhold::test {

struct Humanoid {
    SkinnedMesh figure;
    std::map<std::string, std::size_t> joints;    // by name
    std::map<std::string, std::size_t> expected;  // by body_joint_text
};

struct HumanoidOptions {
    double arms_down_rad = 0.0;  // 0: T-pose
    double scale = 1.0;
    double yaw_rad = 0.0;  // 0: faces +Z
    bool is_named = true;
};

// Makes a figure of 1.75 m and gives every part of its skin to the convention's joints.
class HumanoidMaker {
  public:
    HumanoidMaker(const HumanoidConvention& convention, const HumanoidOptions& options)
        : convention_(convention), options_(options) {}

    Humanoid make() {
        made_.figure.file = std::string(convention_.name) + ".glb";
        for (const HumanoidJoint& joint : convention_.joints) {
            if (std::string(joint.name).find('*') == std::string::npos) {
                add_joint(joint, 0.0);
                continue;
            }
            add_joint(joint, 1.0);
            add_joint(joint, -1.0);
        }
        find_parents();
        if (!options_.is_named) {
            for (std::size_t i = 0; i < made_.figure.joints.size(); ++i) {
                made_.figure.joints[i].name = "n" + std::to_string(i);
            }
        }
        add_body();
        made_.figure.color_runs = {{0, {0.55F, 0.58F, 0.62F}}};
        finish_normals();
        return std::move(made_);
    }

  private:
    struct Placed {
        std::string bone;
        double along = 0.0;
        double side = 0.0;
    };

    std::string with_side(std::string text, double side) const {
        const std::size_t star = text.find('*');
        if (star != std::string::npos) {
            text.replace(star, 1, side > 0.0 ? convention_.left : convention_.right);
        }
        return text;
    }

    // Joints of the left half (+X is the figure's left), facing +Z, arms level.
    static Vec3 base_place(const std::string& bone) {
        static const std::map<std::string, Vec3> k_places = {{"ground", {0, 0, 0}},
                                                             {"pelvis", {0, 0.98, 0}},
                                                             {"spine", {0, 1.10, 0.01}},
                                                             {"chest", {0, 1.32, 0}},
                                                             {"neck", {0, 1.49, -0.01}},
                                                             {"head", {0, 1.58, 0.01}},
                                                             {"top", {0, 1.75, 0.01}},
                                                             {"eye", {0.03, 1.64, 0.09}},
                                                             {"clavicle", {0.03, 1.45, 0}},
                                                             {"upper_arm", {0.18, 1.44, -0.01}},
                                                             {"forearm", {0.46, 1.44, -0.02}},
                                                             {"hand", {0.71, 1.44, 0}},
                                                             {"index", {0.80, 1.44, 0.03}},
                                                             {"finger_end", {0.88, 1.44, 0.03}},
                                                             {"thumb", {0.74, 1.42, 0.03}},
                                                             {"thumb_end", {0.80, 1.40, 0.09}},
                                                             {"thigh", {0.095, 0.93, 0.01}},
                                                             {"shin", {0.095, 0.51, 0.02}},
                                                             {"foot", {0.095, 0.085, -0.02}},
                                                             {"toe", {0.095, 0.02, 0.10}},
                                                             {"toe_end", {0.095, 0.02, 0.17}}};
        return k_places.at(bone);
    }
    static std::string end_of(const std::string& bone) {
        static const std::map<std::string, std::string> k_ends = {
            {"pelvis", "spine"},      {"spine", "chest"},     {"chest", "neck"},
            {"neck", "head"},         {"head", "top"},        {"clavicle", "upper_arm"},
            {"upper_arm", "forearm"}, {"forearm", "hand"},    {"hand", "index"},
            {"index", "finger_end"},  {"thumb", "thumb_end"}, {"thigh", "shin"},
            {"shin", "foot"},         {"foot", "toe"},        {"toe", "toe_end"}};
        const auto end = k_ends.find(bone);
        return end == k_ends.end() ? bone : end->second;
    }
    static bool is_of_arm(const std::string& bone) {
        return bone == "upper_arm" || bone == "forearm" || bone == "hand" || bone == "index" ||
               bone == "thumb" || bone == "finger_end" || bone == "thumb_end";
    }
    Pose stand() const { return {Vec3::Zero(), rotation_about(Vec3::UnitY(), options_.yaw_rad)}; }
    // Position of the joint of `bone` on that side, posed and scaled.
    Vec3 place(const std::string& bone, double side) const {
        Vec3 at = base_place(bone);
        if (is_of_arm(bone)) {
            const Vec3 shoulder = base_place("upper_arm");
            at = shoulder +
                 rotation_about(Vec3::UnitZ(), -options_.arms_down_rad) * Vec3(at - shoulder);
        }
        at.x() *= side < 0.0 ? -1.0 : 1.0;
        return options_.scale * (stand().rotation * at);
    }
    Vec3 place_along(const std::string& bone, double along, double side) const {
        const Vec3 from = place(bone, side);
        return from + along * (place(end_of(bone), side) - from);
    }

    Quat axes_of(const std::string& bone, double side) const {
        const Vec3 along = place(end_of(bone), side) - place(bone, side);
        if (convention_.axes == JointAxes::world || !(along.norm() > 0.0)) {
            return Quat::Identity();
        }
        const Vec3 axis = convention_.axes == JointAxes::y_along ? Vec3::UnitY() : Vec3::UnitX();
        const bool is_reversed = convention_.axes == JointAxes::x_along_mirrored && side < 0.0;
        return rotation_between(is_reversed ? Vec3(-axis) : axis, along.normalized());
    }

    void add_joint(const HumanoidJoint& joint, double side) {
        const std::string text = joint.place;
        const std::size_t cut = text.find('/');
        Placed placed{text.substr(0, cut), 0.0, side};
        if (cut != std::string::npos) {
            placed.along = std::stod(text.substr(cut + 1));
        }
        const std::string name = with_side(joint.name, side);
        made_.joints[name] = made_.figure.joints.size();
        if (joint.is_bone) {
            static const std::map<std::string, BodyBone> k_bones = {
                {"pelvis", BodyBone::trunk},        {"neck", BodyBone::neck},
                {"head", BodyBone::head},           {"clavicle", BodyBone::clavicle},
                {"upper_arm", BodyBone::upper_arm}, {"forearm", BodyBone::forearm},
                {"hand", BodyBone::hand},           {"thigh", BodyBone::thigh},
                {"shin", BodyBone::shin},           {"foot", BodyBone::foot}};
            if (const auto bone = k_bones.find(placed.bone); bone != k_bones.end()) {
                made_.expected[body_joint_text(
                    {bone->second, side < 0.0 ? HandSide::right : HandSide::left})] =
                    made_.figure.joints.size();
            }
        }
        made_.figure.joints.push_back(
            {name,
             -1,
             {place_along(placed.bone, placed.along, side), axes_of(placed.bone, side)},
             {}});
        parents_.push_back(with_side(joint.parent, side));
        placed_.push_back(placed);
        is_control_.push_back(name.starts_with("ORG") || name.starts_with("MCH") ||
                              name.starts_with("ik_") || name.find("ＩＫ") != std::string::npos ||
                              placed.bone == "ground");
    }
    void find_parents() {
        for (std::size_t i = 0; i < parents_.size(); ++i) {
            const auto parent = made_.joints.find(parents_[i]);
            made_.figure.joints[i].parent =
                parent == made_.joints.end() ? -1 : static_cast<std::int32_t>(parent->second);
        }
    }

    // The last joint with skin before `along` on a bone. A bone that the convention lacks is
    // represented by the one above.
    std::uint16_t joint_at(std::string bone, double along, double side) const {
        static const std::map<std::string, std::string> k_above = {
            {"index", "hand"},        {"thumb", "hand"},         {"hand", "forearm"},
            {"forearm", "upper_arm"}, {"upper_arm", "clavicle"}, {"clavicle", "chest"},
            {"toe", "foot"},          {"foot", "shin"},          {"shin", "thigh"},
            {"thigh", "pelvis"},      {"head", "neck"},          {"neck", "chest"},
            {"chest", "spine"},       {"spine", "pelvis"}};
        for (;;) {
            std::optional<std::size_t> best;
            for (std::size_t i = 0; i < placed_.size(); ++i) {
                const Placed& placed = placed_[i];
                if (placed.bone == bone && placed.along <= along + 1e-9 && !is_control_[i] &&
                    (placed.side == 0.0 || placed.side == side) &&
                    (!best || placed.along >= placed_[*best].along)) {
                    best = i;
                }
            }
            if (best) {
                return static_cast<std::uint16_t>(*best);
            }
            if (!k_above.contains(bone)) {
                return 0;
            }
            bone = k_above.at(bone);
            along = 1.0;
        }
    }

    struct Thickness {
        double from_x, from_z, to_x, to_z;
    };
    // A tube of elliptic rings from one place to the other; ends blend with the bones beside it.
    void add_tube(const std::string& bone, const std::string& before, double side,
                  const Thickness& thick, bool is_closed) {
        constexpr int k_rings = 7;
        constexpr int k_around = 12;
        const Vec3 a = place(bone, side);
        const Vec3 b = place(end_of(bone), side);
        const Vec3 along = (b - a).normalized();
        const Vec3 front = stand().rotation * Vec3::UnitZ();
        Vec3 v = front - along * front.dot(along);
        v = v.norm() > 0.2 ? Vec3(v.normalized()) : any_perpendicular(along);
        const Vec3 u = v.cross(along);
        const auto first = static_cast<std::uint32_t>(made_.figure.positions.size());
        for (int ring = 0; ring < k_rings; ++ring) {
            const double t = static_cast<double>(ring) / (k_rings - 1);
            const double shrink = is_closed && (ring == 0 || ring == k_rings - 1) ? 0.35 : 1.0;
            for (int k = 0; k < k_around; ++k) {
                const double angle = 2.0 * k_pi * k / k_around;
                const double x = thick.from_x + t * (thick.to_x - thick.from_x);
                const double z = thick.from_z + t * (thick.to_z - thick.from_z);
                made_.figure.positions.push_back(
                    a + t * (b - a) +
                    options_.scale * shrink * (x * std::cos(angle) * u + z * std::sin(angle) * v));
                made_.figure.weights.push_back(weights_at(bone, before, t, side));
            }
        }
        for (std::uint32_t ring = 0; ring + 1 < k_rings; ++ring) {
            for (std::uint32_t k = 0; k < k_around; ++k) {
                const std::uint32_t next = (k + 1) % k_around;
                const std::uint32_t p = first + ring * k_around + k;
                const std::uint32_t q = first + ring * k_around + next;
                made_.figure.triangles.push_back({p, q, q + k_around});
                made_.figure.triangles.push_back({p, q + k_around, p + k_around});
            }
        }
    }
    SkinWeights weights_at(const std::string& bone, const std::string& before, double t,
                           double side) const {
        const std::uint16_t own = joint_at(bone, t, side);
        if (t > 0.01 || before.empty()) {
            return {{own, 0, 0, 0}, {1.0F, 0.0F, 0.0F, 0.0F}};
        }
        return {{own, joint_at(before, 1.0, side), 0, 0}, {0.5F, 0.5F, 0.0F, 0.0F}};
    }

    void add_body() {
        add_tube("pelvis", "", 1.0, {0.15, 0.11, 0.14, 0.10}, false);
        add_tube("spine", "pelvis", 1.0, {0.14, 0.10, 0.17, 0.12}, false);
        add_tube("chest", "spine", 1.0, {0.17, 0.12, 0.07, 0.07}, false);
        add_tube("neck", "chest", 1.0, {0.05, 0.05, 0.05, 0.05}, false);
        add_tube("head", "neck", 1.0, {0.075, 0.095, 0.06, 0.08}, true);
        for (const double side : {1.0, -1.0}) {
            add_tube("clavicle", "chest", side, {0.05, 0.05, 0.06, 0.06}, false);
            add_tube("upper_arm", "clavicle", side, {0.055, 0.06, 0.04, 0.045}, true);
            add_tube("forearm", "upper_arm", side, {0.042, 0.045, 0.025, 0.03}, false);
            add_tube("hand", "forearm", side, {0.02, 0.035, 0.018, 0.045}, true);
            add_tube("index", "hand", side, {0.012, 0.04, 0.008, 0.03}, true);
            add_tube("thumb", "hand", side, {0.012, 0.012, 0.009, 0.009}, true);
            add_tube("thigh", "pelvis", side, {0.085, 0.09, 0.06, 0.06}, true);
            add_tube("shin", "thigh", side, {0.055, 0.06, 0.035, 0.04}, false);
            add_tube("foot", "shin", side, {0.045, 0.045, 0.045, 0.03}, true);
            add_tube("toe", "foot", side, {0.045, 0.02, 0.03, 0.015}, true);
        }
        add_nose();
    }
    // A part that shows where the figure looks.
    void add_nose() {
        const auto first = static_cast<std::uint32_t>(made_.figure.positions.size());
        const std::array<Vec3, 4> corners = {Vec3(-0.02, 1.60, 0.09), Vec3(0.02, 1.60, 0.09),
                                             Vec3(0.0, 1.66, 0.09), Vec3(0.0, 1.61, 0.14)};
        for (const Vec3& corner : corners) {
            made_.figure.positions.push_back(options_.scale * (stand().rotation * corner));
            made_.figure.weights.push_back(
                {{joint_at("head", 0.5, 1.0), 0, 0, 0}, {1.0F, 0.0F, 0.0F, 0.0F}});
        }
        made_.figure.triangles.push_back({first, first + 1, first + 3});
        made_.figure.triangles.push_back({first + 1, first + 2, first + 3});
        made_.figure.triangles.push_back({first + 2, first, first + 3});
    }
    void finish_normals() {
        SkinnedMesh& figure = made_.figure;
        figure.normals.assign(figure.positions.size(), Vec3::Zero());
        for (const auto& [a, b, c] : figure.triangles) {
            const Vec3 area = (figure.positions[b] - figure.positions[a])
                                  .cross(figure.positions[c] - figure.positions[a]);
            for (const std::uint32_t corner : {a, b, c}) {
                figure.normals[corner] += area;
            }
        }
        for (Vec3& normal : figure.normals) {
            normal = normal.norm() > 0.0 ? Vec3(normal.normalized()) : Vec3(Vec3::UnitY());
        }
    }

    const HumanoidConvention& convention_;
    HumanoidOptions options_;
    Humanoid made_;
    std::vector<std::string> parents_;
    std::vector<Placed> placed_;
    std::vector<bool> is_control_;
};

inline Humanoid make_humanoid(const HumanoidConvention& convention,
                              const HumanoidOptions& options = {}) {
    return HumanoidMaker(convention, options).make();
}

// The bytes of a .glb.
inline std::string write_humanoid(const Humanoid& humanoid) {
    const SkinnedMesh& figure = humanoid.figure;
    // Parents before children.
    std::vector<std::size_t> order;
    std::vector<std::int32_t> place(figure.joints.size(), -1);
    while (order.size() < figure.joints.size()) {
        for (std::size_t i = 0; i < figure.joints.size(); ++i) {
            const std::int32_t parent = figure.joints[i].parent;
            if (place[i] < 0 && (parent < 0 || place[static_cast<std::size_t>(parent)] >= 0)) {
                place[i] = static_cast<std::int32_t>(order.size());
                order.push_back(i);
            }
        }
    }
    GltfSkin skin;
    skin.name = "body";
    for (const std::size_t i : order) {
        SkinJoint joint = figure.joints[i];
        joint.parent = joint.parent < 0 ? -1 : place[static_cast<std::size_t>(joint.parent)];
        skin.joints.push_back(joint);
    }
    GltfSkinSurface surface;
    for (std::size_t i = 0; i < figure.positions.size(); ++i) {
        const auto to_float = [](const Vec3& v) {
            return std::array<float, 3>{static_cast<float>(v.x()), static_cast<float>(v.y()),
                                        static_cast<float>(v.z())};
        };
        surface.vertices.push_back({to_float(figure.positions[i]), to_float(figure.normals[i])});
        SkinWeights weights = figure.weights[i];
        for (std::uint16_t& joint : weights.joint) {
            joint = static_cast<std::uint16_t>(place[joint]);
        }
        surface.weights.push_back(weights);
    }
    for (const auto& triangle : figure.triangles) {
        surface.indices.insert(surface.indices.end(), triangle.begin(), triangle.end());
    }
    skin.surfaces.push_back(surface);
    const GltfMaterial material{"skin", {0.55F, 0.6F, 0.68F}};
    return write_skinned_glb({&material, 1}, skin);
}

}  // namespace handhold::test
