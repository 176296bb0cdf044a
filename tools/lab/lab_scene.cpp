#include "tools/lab/lab_scene.hpp"

#include <algorithm>
#include <array>

#include "engine/core/check.hpp"
#include "tools/lab/scenes.hpp"

namespace handhold::lab {
namespace {

struct NamedScene {
    std::string_view name;
    LabScene (*make)(const SceneOptions&);
};

constexpr std::array k_scenes = {
    NamedScene{"chain", &make_chain},
    NamedScene{"lever", &make_lever},
    NamedScene{"drawer", &make_drawer},
    NamedScene{"door", &make_door},
    NamedScene{"wave", &make_wave},
    NamedScene{"shove", &make_shove},
    NamedScene{"shove_mesh", &make_shove_mesh},
    NamedScene{"step", &make_step},
    NamedScene{"lean_in", &make_lean_in},
    NamedScene{"ring", &make_ring},
    NamedScene{"two_hands", &make_two_hands},
    NamedScene{"two_players", &make_two_players},
    NamedScene{"contradict", &make_contradict},
    NamedScene{"climb", &make_climb},
    NamedScene{"teleport", &make_teleport},
    NamedScene{"jam", &make_jam},
    NamedScene{"ship_kinematic", &make_ship_kinematic},
    NamedScene{"ship_dynamic", &make_ship_dynamic},
    NamedScene{"push_off", &make_push_off},
    NamedScene{"throw", &make_throw},
    NamedScene{"bounce", &make_bounce},
    NamedScene{"slide", &make_slide},
    NamedScene{"hub", &make_hub},
    NamedScene{"heap", &make_heap},
    NamedScene{"impact", &make_impact},
    NamedScene{"debris", &make_debris},
    NamedScene{"overlap", &make_overlap},
};

Pose body_pose(const LabScene& scene, int body) {
    return body == k_world ? Pose{} : scene.bodies[static_cast<std::size_t>(body)].pose_ws;
}

}  // namespace

Vec3 LabBody::inertia_kgm2() const {
    if (is_ball) {
        return Vec3::Constant(0.4 * mass_kg * half_m.x() * half_m.x());
    }
    const Vec3 squares = half_m.cwiseAbs2();
    return mass_kg / 3.0 * (Vec3::Constant(squares.sum()) - squares);
}

void Figures::take_worst(const std::string& name, double value) {
    const auto [place, is_new] = values_.try_emplace(name, value);
    place->second = is_new ? value : std::max(place->second, value);
}

void LabScene::add_joint_at(LabJoint joint, const Pose& frame_ws) {
    joint.frame_a = inverse(body_pose(*this, joint.a)) * frame_ws;
    joint.frame_b = inverse(body_pose(*this, joint.b)) * frame_ws;
    joints.push_back(joint);
}

void LabScene::add_hold(LabHold hold) {
    const LabPlayer& player = players[static_cast<std::size_t>(hold.player)];
    hold.anchor_bs = inverse_transform_point(body_pose(*this, hold.body),
                                             player.origin_ws + hold.hand_ps(0.0).position);
    holds.push_back(std::move(hold));
}

std::vector<std::string_view> scene_names() {
    std::vector<std::string_view> names;
    names.reserve(k_scenes.size());
    for (const NamedScene& scene : k_scenes) {
        names.push_back(scene.name);
    }
    return names;
}

LabScene make_scene(std::string_view name, const SceneOptions& options) {
    const auto* const found = std::ranges::find(k_scenes, name, &NamedScene::name);
    HH_CHECK(found != k_scenes.end(), "no such scene", name.size());
    LabScene scene = found->make(options);
    scene.tuning.hand.max_arm_m = 1000.0;            // no arm limit: a chain is longer than an arm
    scene.tuning.tracking.max_hand_speed_mps = 1e6;  // hands jump: the solver is measured
    scene.name = name;
    return scene;
}

std::vector<std::string_view> mass_patterns() {
    return {"uniform",        "last_x100",   "last_x0.01",
            "alternate_x100", "middle_x100", "alternate_x1000"};
}

int add_box(LabScene& scene, const std::string& name, double mass_kg, const Vec3& half_m,
            const Vec3& center_ws) {
    LabBody body;
    body.name = name;
    body.mass_kg = mass_kg;
    body.half_m = half_m;
    body.pose_ws.position = center_ws;
    return scene.add_body(body);
}

}  // namespace handhold::lab
