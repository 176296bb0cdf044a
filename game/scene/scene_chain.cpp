#include "game/scene/scene_chain.hpp"

#include <algorithm>
#include <utility>

#include "game/scene/scene_ranges.hpp"

namespace handhold {
namespace {

constexpr NumberRange k_link_radius_m = {1e-3, 1e3, false};
constexpr NumberRange k_friction_nm = {0.0, 1e12, false};
constexpr std::int64_t k_max_chain_links = 2000;

std::string read_body_name(const JsonValue& value, const SceneJointNames& names) {
    if (!value.exists()) {
        return {};
    }
    std::string name = value.text();
    if (!names.bodies.contains(name)) {
        value.refuse("the name of one of the scene's bodies");
    }
    return name;
}

}  // namespace

void read_scene_chain(const JsonValue& value, const std::string& name, SceneJointNames& names,
                      SceneFile& scene) {
    value.allow_only({"name", "links", "a", "b", "from_m", "to_m", "radius_m", "mass_kg",
                      "friction_nm", "color"});
    const auto links = std::max<std::int64_t>(1, value["links"].integer(1, k_max_chain_links));
    const auto count = static_cast<double>(links);
    const Vec3 from = value["from_m"].vector(k_coordinate_m);
    const Vec3 way = value["to_m"].vector(k_coordinate_m) - from;
    const double half_link_m = 0.5 * way.norm() / count;
    SceneBody link;
    link.kind = BodyKind::free;
    link.shape.kind = ShapeKind::capsule;
    link.shape.radius_m = value["radius_m"].number(k_link_radius_m);
    link.shape.half_height_m = half_link_m - link.shape.radius_m;
    link.mass_kg = value["mass_kg"].number(k_mass_kg) / count;
    if (const JsonValue color = value["color"]; color.exists()) {
        const Vec3 rgb = color.vector(k_unit_interval);
        link.color = {static_cast<float>(rgb.x()), static_cast<float>(rgb.y()),
                      static_cast<float>(rgb.z())};
    }
    SceneJoint joint;
    joint.joint.kind = JointKind::ball;
    joint.joint.friction = value["friction_nm"].number_or(0.0, k_friction_nm);
    std::string before = read_body_name(value["a"], names);
    const std::string last = read_body_name(value["b"], names);
    if (link.shape.half_height_m < 1e-3 || link.shape.half_height_m > 1e4) {
        value["to_m"].refuse(
            "a place so far from \"from_m\" that links are longer than thick, and up to 2e4 m");
        return;
    }
    link.pose.rotation = rotation_between(Vec3::UnitY(), way.normalized());
    const auto tie = [&](std::int64_t index, const std::string& to) {
        joint.name = name + "/joint/" + std::to_string(index);
        joint.a = before;
        joint.b = to;
        joint.pose.position = from + way * (static_cast<double>(index) / count);
        joint.end_a = joint.pose.position;
        names.joints.emplace(joint.name, joint.joint.kind);
        scene.joints.push_back(joint);
    };
    for (std::int64_t i = 0; i < links; ++i) {
        link.name = name + "/" + std::to_string(i);
        link.pose.position = from + way * ((static_cast<double>(i) + 0.5) / count);
        if (!names.bodies.emplace(link.name, link.kind).second) {
            value["name"].refuse("a name that makes no other body's: \"" + link.name + "\"");
        }
        tie(i, link.name);
        before = link.name;
        scene.bodies.push_back(link);
    }
    if (!last.empty()) {
        tie(links, last);
    }
}

}  // namespace handhold
