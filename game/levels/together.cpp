#include "game/levels/together.hpp"

#include <utility>

#include "engine/core/check.hpp"
#include "game/assets/assets.hpp"

namespace handhold {
namespace {

const hh::Vec3 k_holder_eyes{0.0, 1.3, 0.25};
const hh::Vec3 k_partner_eyes{0.8, 1.9, 0.0};
constexpr double k_length_s = 14.0;

}  // namespace

Scene make_together_scene() {
    const Result<SceneFile> file = parse_scene_file(game_asset("together.json"), "together.json");
    HH_CHECK(static_cast<bool>(file), "the bay's description is broken", 0);
    Result<Scene> scene = build_scene(file.value(), "together.json");
    HH_CHECK(static_cast<bool>(scene), "the bay's description is broken", 0);
    scene.value().lamps = {{Vec3(-1.2, 2.8, 1.4), {2.4F, 2.3F, 2.2F}, 5.0},
                           {Vec3(1.2, 2.8, 1.4), {2.4F, 2.3F, 2.2F}, 5.0},
                           {Vec3(0.0, 2.8, -0.6), {2.6F, 2.5F, 2.4F}, 5.0}};
    return std::move(scene.value());
}

SessionScript together_script() {
    SessionScript script;
    script.duration_s = k_length_s;
    const hh::Vec3 nearer = k_holder_eyes + hh::Vec3{0.40, 0.05, 0.0};
    script.body = {{0.0, k_holder_eyes, hh::Vec3{}},
                   {6.8, k_holder_eyes, hh::Vec3{}},
                   {8.0, nearer, hh::Vec3{}},
                   {k_length_s, nearer, hh::Vec3{}}};
    const hh::Vec3 back = hh::k_z;
    const hh::Vec3 up = hh::k_y;
    script.holds.push_back(
        {HH_LEFT, 0.4, 13.6, hh::Vec3{-0.25, 1.05, -0.25} + 0.02 * back, back, up});
    // The right hand lies on the other's left forearm from above, fingers across it.
    const hh::Vec3 across = -hh::k_z;
    const hh::Vec3 on_arm{0.42, 1.52, 0.22};
    const auto move = [&](double t_s, const hh::Vec3& palm, const hh::Vec3& away,
                          const hh::Vec3& fingers) {
        script.reaches.push_back({HH_RIGHT, t_s, palm, away, fingers});
    };
    script.holds.push_back({HH_RIGHT, 1.6, 6.6, on_arm, up, across});
    move(2.4, on_arm, up, across);
    move(3.2, on_arm + hh::Vec3{-0.10, 0.12, 0.06}, up, across);
    move(4.2, on_arm + hh::Vec3{0.05, -0.12, -0.05}, up, across);
    move(5.2, on_arm + hh::Vec3{-0.06, 0.06, 0.05}, up, across);
    move(6.2, on_arm, up, across);
    // The partner has floated upwards since the first player's hand let go. The hand stops her by
    // the thigh, from the side.
    const hh::Vec3 side = hh::k_z;
    const hh::Vec3 on_leg{0.95, 1.23, 0.135};
    const hh::Vec3 forward = hh::k_x;
    script.holds.push_back({HH_RIGHT, 8.4, 12.4, on_leg, side, forward});
    move(9.0, on_leg, side, forward);
    move(10.0, on_leg + hh::Vec3{-0.12, 0.10, 0.05}, side, forward);
    move(11.0, on_leg + hh::Vec3{-0.02, -0.06, 0.08}, side, forward);
    move(12.0, on_leg, side, forward);
    return script;
}

SessionScript together_partner_script() {
    SessionScript script;
    script.play_space = hh::rotation_about(hh::k_y, k_half_pi);  // facing the holder
    script.duration_s = k_length_s;
    script.body = {{0.0, k_partner_eyes, hh::Vec3{}}, {k_length_s, k_partner_eyes, hh::Vec3{}}};
    const hh::Vec3 up = hh::k_y;
    const hh::Vec3 ahead = -hh::k_x;
    const hh::Vec3 palm{0.30, 1.45, 0.20};
    const auto move = [&](double t_s, const hh::Vec3& by) {
        script.reaches.push_back({HH_LEFT, t_s, palm + by, up, ahead});
    };
    move(0.8, hh::Vec3{});
    move(4.4, hh::Vec3{});
    move(4.9, hh::Vec3{0.05, 0.10, 0.05});
    move(5.4, hh::Vec3{0.05, -0.06, -0.05});
    move(6.0, hh::Vec3{});
    move(7.0, hh::Vec3{});
    move(7.8, hh::Vec3{0.25, 0.05, 0.10});
    move(13.0, hh::Vec3{0.25, 0.05, 0.10});
    return script;
}

}  // namespace handhold
