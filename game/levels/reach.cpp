#include "game/levels/reach.hpp"

#include <utility>

#include "engine/core/check.hpp"
#include "game/assets/assets.hpp"

namespace handhold {

Scene make_reach_scene() {
    const Result<SceneFile> file = parse_scene_file(game_asset("reach.json"), "reach.json");
    HH_CHECK(static_cast<bool>(file), "the bay's description is broken", 0);
    Result<Scene> scene = build_scene(file.value(), "reach.json");
    HH_CHECK(static_cast<bool>(scene), "the bay's description is broken", 0);
    scene.value().lamps = {{Vec3(-1.2, 2.5, 0.4), {2.4F, 2.3F, 2.2F}, 5.0},
                           {Vec3(1.2, 2.5, 0.4), {2.4F, 2.3F, 2.2F}, 5.0},
                           {Vec3(0.0, 2.5, -1.6), {2.6F, 2.5F, 2.4F}, 5.0}};
    return std::move(scene.value());
}

SessionScript reach_script() {
    SessionScript script;
    script.duration_s = 19.0;
    script.body = {{0.0, hh::Vec3{0.0, 1.45, 0.62}, hh::Vec3{}},
                   {19.0, hh::Vec3{0.0, 1.45, 0.62}, hh::Vec3{}}};
    const hh::Vec3 back = hh::k_z;  // direction of the backs of palms that face forward
    const hh::Vec3 up = hh::k_y;
    const auto hold = [&](hh::Side side, double from_s, double until_s, const hh::Vec3& palm) {
        script.holds.push_back({side, from_s, until_s, palm, back, up});
    };
    const auto move = [&](double t_s, const hh::Vec3& palm) {
        script.reaches.push_back({HH_RIGHT, t_s, palm, back, up});
    };
    const hh::Vec3 rail{0.0, 0.98, 0.18};
    hold(HH_LEFT, 0.3, 17.8, rail - hh::Vec3{0.25, 0.0, 0.0});
    // The right hand pulls the canister close, shows it from both sides, and releases it.
    const hh::Vec3 ahead{0.26, 1.36, 0.10};
    hold(HH_RIGHT, 1.4, 4.8, ahead);
    move(2.9, ahead);
    move(3.5, ahead + hh::Vec3{-0.16, 0.10, 0.10});
    move(4.1, ahead + hh::Vec3{0.14, -0.02, 0.12});
    move(4.7, ahead + hh::Vec3{0.16, -0.10, 0.10});
    // The right hand pulls at the safe, which is too heavy to move.
    hold(HH_RIGHT, 6.2, 7.0, hh::Vec3{0.12, 0.66, 0.12});
    // The right hand pulls the ball but opens early, so the ball flies past to the left.
    hold(HH_RIGHT, 8.4, 8.9, hh::Vec3{-0.55, 1.72, 0.05});
    // Both hands hold the rail and are tracked farther apart than their grips allow.
    hold(HH_RIGHT, 10.6, 13.4, rail + hh::Vec3{0.12, 0.0, 0.0});
    move(11.2, rail + hh::Vec3{0.12, 0.0, 0.0});
    move(12.0, rail + hh::Vec3{0.30, 0.16, 0.02});
    move(12.8, rail + hh::Vec3{0.30, 0.16, 0.02});
    // The right hand is pushed into the slab and withdrawn.
    move(14.4, hh::Vec3{0.50, 1.46, 0.16});
    move(15.4, hh::Vec3{0.55, 1.50, -0.17});
    move(16.6, hh::Vec3{0.58, 1.53, -0.19});
    move(17.6, hh::Vec3{0.45, 1.40, 0.20});
    return script;
}

}  // namespace handhold
