#include "game/run/spawn.hpp"

#include <gtest/gtest.h>

#include "game/levels/built_in_scenes.hpp"
#include "game/session/hand_pose.hpp"
#include "tests/random.hpp"

namespace handhold::spawn_test {
namespace {

// A player who looks ahead and closes the right hand, held before the chest at any turn.
Recording one_grab(const hh::Pose& controller) {
    Recording recording;
    for (int i = 0; i < 90; ++i) {
        RecordedSample sample;
        sample.t_s = i / 90.0;
        sample.head.position = {0.0, 1.6, 0.0};
        sample.hands[0].controller.position = {-0.2, 1.0, -0.1};
        sample.hands[1].controller = controller;
        sample.hands[1].buttons = i >= 30 ? k_button_grip : 0;
        recording.samples.push_back(sample);
    }
    return recording;
}

// Cosine between the palm's direction and the normal, reversed, of the surface that its ray meets
// within hand.ray_length_m; 0: none.
double facing(hh::World& world, const hh::Pose& origin_ws, const hh::Pose& controller) {
    const HandShape shape = hand_shape(world);
    const hh::Pose hand_ws = origin_ws * controller * shape.in_controller[1];
    const hh::Vec3 palm_ws = hh::transform_point(hand_ws, shape.palm_center_m);
    const hh::Vec3 outward = hand_ws.rotation * -hh::k_y;
    const auto hit = world.cast_ray(palm_ws - *world.tuning("hand.ray_back_m") * outward,
                                    palm_ws + *world.tuning("hand.ray_length_m") * outward);
    return hit ? -hh::dot(outward, hit->normal) : 0.0;
}

TEST(FindSpawn, PalmsFaceWhatTheyGrip) {
    Scene scene = *make_built_in_scene("station");
    test::Random random(5003);
    int gripped = 0;
    for (int i = 0; i < 8; ++i) {
        const Vec3 axis = random.direction();
        const hh::Pose controller{{0.2, 1.2, -0.4},
                                  hh::rotation_about(to_host(axis), random.between(0.0, 3.0))};
        const FoundSpawn found = find_spawn(scene, one_grab(controller), 90.0);
        EXPECT_EQ(found.onsets, 1U);
        gripped += found.gripped == 1 ? 1 : 0;
        EXPECT_GE(facing(scene.host, found.origin_ws, controller), 0.5) << i;
    }
    EXPECT_GE(gripped, 7);  // places whose grabs grip win, if there is one
}

}  // namespace
}  // namespace handhold::spawn_test
