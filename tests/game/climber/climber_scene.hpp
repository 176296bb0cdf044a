#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "game/climber/climber.hpp"
#include "game/scene/scene.hpp"

namespace handhold {

inline Entity add_block(Scene& scene, const std::string& name, const Vec3& half_m,
                        const Vec3& center_ws) {
    BodyDescription block;
    block.name = name;
    block.shape = scene.shapes().add_box(half_m);
    block.pose_ws.position = center_ws;
    scene.body_names.push_back(name);
    return add_body(scene.world(), block);
}

// An empty scene.
inline Scene make_void() {
    Scene scene;
    scene.name = "void";
    return scene;
}

// A closed tunnel about the origin, 2 m wide and high, along z, with a rail along its left wall.
inline Scene make_tunnel(double half_length_m) {
    Scene scene = make_void();
    const double h = half_length_m;
    add_block(scene, "left", Vec3(0.1, 1.2, h), Vec3(-1.1, 0.0, 0.0));
    add_block(scene, "right", Vec3(0.1, 1.2, h), Vec3(1.1, 0.0, 0.0));
    add_block(scene, "floor", Vec3(1.2, 0.1, h), Vec3(0.0, -1.1, 0.0));
    add_block(scene, "ceiling", Vec3(1.2, 0.1, h), Vec3(0.0, 1.1, 0.0));
    add_block(scene, "near", Vec3(1.2, 1.2, 0.1), Vec3(0.0, 0.0, h));
    add_block(scene, "far", Vec3(1.2, 1.2, 0.1), Vec3(0.0, 0.0, -h));
    const Entity bar = add_block(scene, "bar", Vec3(0.015, 0.015, h - 0.3), Vec3(-0.94, 0.2, 0.0));
    scene.rails.push_back({body_id(bar), {0.0, 0.0, h - 0.3}, {0.0, 0.0, 0.3 - h}});
    return scene;
}

// A single climber.
struct Solo {
    Scene& scene;
    ClimberTask task;
    ClimberState state;
    std::vector<hh::Sample> samples;
    std::uint64_t onsets = 0;
    std::uint64_t gripped = 0;
    std::uint64_t unseen = 0;  // refused: behind a wall

    Solo(Scene& in, const Vec3& head_ws, std::uint64_t seed, ClimberTask what = {})
        : scene(in), task(std::move(what)) {
        task.player = add_scene_player(scene, "player0",
                                       hh::pose_at(to_host(Vec3(head_ws - Vec3(0.0, 1.6, 0.0)))));
        state = begin_climber(scene.host, task, seed);
    }
    void step(double dt_s = 1.0 / 90.0) {
        const hh_commands commands =
            climb(sight_of(scene), task, scene.host.time_s() + dt_s, state, samples);
        hh_player_input input = hh::input(task.player, samples, commands);
        input.repeats_samples = true;
        if (!scene.host.step(dt_s, input)) {
            throw std::runtime_error(hh_last_error());
        }
        const StageStats& stats = scene.stats();
        onsets += stats.grab_onsets;
        gripped += stats.grabs_gripped;
        unseen += stats.fallbacks[static_cast<std::size_t>(Fallback::grab_out_of_sight)];
    }
    double now_s() const { return scene.host.time_s(); }
    const RenderPose& render() const {
        return scene.world().render_pose.at(entity_of(task.player));
    }
    Vec3 head_ws() const { return render().head_center_ws; }
    bool grips(std::size_t side) const { return render().hands[side].grip != GripKind::none; }
};

}  // namespace handhold
