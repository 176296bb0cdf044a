#pragma once

#include <array>
#include <memory>
#include <string>

#include "game/climber/climber.hpp"
#include "game/scene/place_scene.hpp"
#include "game/scene/scene.hpp"

namespace handhold {

inline Entity add_block(Scene& scene, const std::string& name, const Vec3& half_m,
                        const Vec3& center_ws) {
    BodyDescription block;
    block.name = name;
    block.shape = scene.shapes->add_box(half_m);
    block.pose_ws.position = center_ws;
    scene.body_names.push_back(name);
    return add_body(scene.world, block);
}

// An empty scene.
inline Scene make_void() {
    Scene scene;
    scene.name = "void";
    scene.head_shape = scene.shapes->add_sphere(scene.tuning.head.radius_m);
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
    scene.rails.push_back({bar, Vec3(0.0, 0.0, h - 0.3), Vec3(0.0, 0.0, 0.3 - h)});
    return scene;
}

// A single climber.
struct Solo {
    Scene& scene;
    FrameCaches caches;
    ClimberTask task;
    ClimberState state;
    std::vector<TrackingSample> samples;
    StageStats stats;
    std::uint64_t onsets = 0;
    std::uint64_t gripped = 0;
    std::uint64_t unseen = 0;  // refused: behind a wall

    Solo(Scene& in, const Vec3& head_ws, std::uint64_t seed, ClimberTask what = {})
        : scene(in), caches(*in.shapes, in.grip_meshes.get()), task(std::move(what)) {
        const Pose origin_ws{head_ws - Vec3(0.0, 1.6, 0.0), Quat::Identity()};
        task.player = add_scene_player(scene, {"player0", origin_ws, 80.0});
        state = begin_climber(scene, task, seed);
    }
    void step(double dt_s = 1.0 / 90.0) {
        place_scene(scene, caches);
        const PlayerCommands commands =
            climb({scene, caches.collision}, task, scene.world.clock.t_s + dt_s, state, samples);
        const PlayerInput input{task.player.player, samples, commands};
        step_frame(scene.world, caches, scene.tuning, {dt_s, {&input, 1}}, stats);
        onsets += stats.grab_onsets;
        gripped += stats.grabs_gripped;
        unseen += stats.fallbacks[static_cast<std::size_t>(Fallback::grab_out_of_sight)];
    }
    double now_s() const { return scene.world.clock.t_s; }
    const RenderPose& render() const { return scene.world.render_pose.at(task.player.player); }
    Vec3 head_ws() const { return render().head_center_ws; }
    bool grips(std::size_t side) const { return render().hands[side].grip != GripKind::none; }
};

}  // namespace handhold
