// Talk row 10: authored grips in scene files, and through an animation package.
#include "game/commands/grip_file.hpp"

#include <string>

#include <gtest/gtest.h>

#include "engine/geometry/grip_mesh_library.hpp"
#include "engine/io/gltf_nodes.hpp"
#include "game/commands/exported_objects.hpp"
#include "game/commands/hand_export.hpp"
#include "game/levels/gun.hpp"
#include "game/levels/station_scene.hpp"
#include "game/scene/scene.hpp"
#include "game/scene/scene_file_writer.hpp"
#include "game/view/controller_figures.hpp"
#include "game/view/grip_fit.hpp"
#include "systems/host/host_columns.hpp"
#include "systems/rigs/builtin_hand_rig.hpp"
#include "systems/rigs/hand_kinematics.hpp"

namespace handhold::grip_file_test {
namespace {

const std::array<HandRig, k_hand_count>& rigs() {
    static const std::array<HandRig, k_hand_count> made = {builtin_hand_rig(HandSide::left),
                                                           builtin_hand_rig(HandSide::right)};
    return made;
}

std::string scene_with(const std::string& grips) {
    return R"({"name": "a", "bodies": [{"name": "gun", "kind": "static",
               "shape": {"type": "box", "half_m": [0.1, 0.1, 0.1]}, "grips": )" +
           grips + "}]}";
}
std::string error_of(const std::string& grips) {
    const Result<SceneFile> scene = parse_scene_file(scene_with(grips), "a.json");
    return scene ? "accepted" : scene.error().message();
}

constexpr const char* k_hand = R"({"position_m": [0.1, 0.2, 0.3], "rotation_xyzw": [0, 0, 0, 1]})";

std::string grip_with(const std::string& more) {
    return R"([{"name": "g", "right": )" + std::string(k_hand) + more + "}]";
}

// --- Scene files ---------------------------------------------------------------------------------

TEST(SceneGripFile, ReadsEveryField) {
    const Result<SceneFile> scene =
        parse_scene_file(scene_with(R"([{"name": "handle", "right": {"position_m": [0.1, 0.2, 0.3],
            "rotation_xyzw": [0, 0.6, 0, 0.8], "fingers": {
              "index": {"curl_deg": [10, 20, 30], "spread_deg": 5, "pressed_curl_deg": [10, 40, 50]},
              "thumb": {"curl_deg": [1, 2], "opposition_deg": -45}}},
            "mirror": "x", "priority": -3, "snap_radius_m": 0.05, "snap_angle_deg": 90}])"),
                         "a.json");
    ASSERT_TRUE(scene.ok()) << scene.error().message();
    ASSERT_EQ(scene.value().bodies[0].grips.size(), 1U);
    const SceneGrip& grip = scene.value().bodies[0].grips[0];
    EXPECT_EQ(grip.name, "handle");
    EXPECT_EQ(grip.grip.priority, -3);
    EXPECT_EQ(grip.grip.snap_radius_m, 0.05);
    EXPECT_NEAR(grip.grip.snap_angle_rad, k_half_pi, 1e-15);
    const AuthoredHand& right = grip.grip.hands[1];
    EXPECT_EQ(right.wrist_bs.position, Vec3(0.1, 0.2, 0.3));
    EXPECT_EQ(right.is_posed, (std::array{true, true, false, false, false}));
    EXPECT_NEAR(right.fingers[1].curl_rad[2], 30.0 * k_degree, 1e-15);
    EXPECT_NEAR(right.fingers[0].opposition_rad, -45.0 * k_degree, 1e-15);
    EXPECT_NEAR(right.fingers[1].opposition_rad, 5.0 * k_degree, 1e-15);
    EXPECT_EQ(right.pressed[1].opposition_rad, 0.0);
    EXPECT_EQ(right.fingers[0].curl_rad[2], 0.0);
    EXPECT_EQ(right.follows_trigger, (std::array{false, true, false, false, false}));
    EXPECT_NEAR(right.pressed[1].curl_rad[2], 50.0 * k_degree, 1e-15);
    const AuthoredHand& left = grip.grip.hands[0];
    EXPECT_TRUE(left.is_there);
    EXPECT_EQ(left.wrist_bs.position, Vec3(-0.1, 0.2, 0.3));
    EXPECT_EQ(left.is_posed, right.is_posed);
}

TEST(SceneGripFile, WithoutAMirrorTheOtherHandHasNoGrip) {
    const Result<SceneFile> scene = parse_scene_file(scene_with(grip_with("")), "a.json");
    ASSERT_TRUE(scene.ok());
    EXPECT_TRUE(scene.value().bodies[0].grips[0].grip.hands[1].is_there);
    EXPECT_FALSE(scene.value().bodies[0].grips[0].grip.hands[0].is_there);
    EXPECT_EQ(scene.value().bodies[0].grips[0].grip.hands[1].is_posed,
              (std::array<bool, k_finger_count>{}));
}

TEST(SceneGripFile, RefusesInvalidGripsWithPointerAndValue) {
    const struct {
        std::string grips, expected;
    } cases[] = {
        {R"([{"name": "g"}])", "/bodies/0/grips/0: expected a grip with a \"right\" or a \"left\""},
        {R"([{"right": )" + std::string(k_hand) + "}]", "/bodies/0/grips/0/name"},
        {R"([{"name": "g", "right": {"position_m": [0, 0, 0]}}])",
         "/bodies/0/grips/0/right/rotation_xyzw"},
        {R"([{"name": "g", "right": {"rotation_xyzw": [0, 0, 0, 1], "position_m": [0, 2e3, 0]}}])",
         "/bodies/0/grips/0/right/position_m/1: expected a number in [-1000, 1000], found 2000"},
        {grip_with(R"(, "priority": 101)"), "/bodies/0/grips/0/priority"},
        {grip_with(R"(, "priority": 0.5)"), "/bodies/0/grips/0/priority"},
        {grip_with(R"(, "snap_radius_m": 0)"), "/bodies/0/grips/0/snap_radius_m"},
        {grip_with(R"(, "snap_radius_m": 1.5)"), "/bodies/0/grips/0/snap_radius_m"},
        {grip_with(R"(, "snap_angle_deg": 181)"), "/bodies/0/grips/0/snap_angle_deg"},
        {grip_with(R"(, "mirror": "w")"), "/bodies/0/grips/0/mirror: expected \"x\", \"y\" or"},
        {grip_with(R"(, "mirror": "x", "left": )" + std::string(k_hand)),
         "/bodies/0/grips/0/mirror: expected nothing beside two hands"},
        {grip_with(R"(, "glove": 1)"), "/bodies/0/grips/0/glove"},
        {R"([{"name": "g", "right": {"position_m": [0, 0, 0], "rotation_xyzw": [0, 0, 0, 1],
              "fingers": "flat"}}])",
         "/bodies/0/grips/0/right/fingers: expected \"fit\" or an object of fingers"},
        {R"([{"name": "g", "right": {"position_m": [0, 0, 0], "rotation_xyzw": [0, 0, 0, 1],
              "fingers": {"sixth": {}}}}])",
         "/bodies/0/grips/0/right/fingers/sixth"},
        {R"([{"name": "g", "right": {"position_m": [0, 0, 0], "rotation_xyzw": [0, 0, 0, 1],
              "fingers": {"index": {"curl_deg": [10]}}}}])",
         "/bodies/0/grips/0/right/fingers/index/curl_deg: expected 2 or 3 angles"},
        {R"([{"name": "g", "right": {"position_m": [0, 0, 0], "rotation_xyzw": [0, 0, 0, 1],
              "fingers": {"index": {"curl_deg": [10, 200, 0]}}}}])",
         "/bodies/0/grips/0/right/fingers/index/curl_deg/1"},
        {R"([{"name": "g", "right": {"position_m": [0, 0, 0], "rotation_xyzw": [0, 0, 0, 1],
              "fingers": {"index": {"curl_deg": [10, 20, 0], "opposition_deg": 3}}}}])",
         "/bodies/0/grips/0/right/fingers/index/opposition_deg"},
        {R"([{"name": "g", "right": {"position_m": [0, 0, 0], "rotation_xyzw": [0, 0, 0, 1],
              "fingers": {"index": {"curl_deg": [10, 20, 0], "pressed_curl_deg": [200, 0]}}}}])",
         "/bodies/0/grips/0/right/fingers/index/pressed_curl_deg/0"},
    };
    for (const auto& [grips, expected] : cases) {
        EXPECT_NE(error_of(grips).find(expected), std::string::npos) << grips << "\n"
                                                                     << error_of(grips);
    }
    const std::string one = grip_with("").substr(1, grip_with("").size() - 2);
    EXPECT_NE(error_of("[" + one + "," + one + "]").find("/bodies/0/grips/1/name"),
              std::string::npos);
    EXPECT_NE(error_of("[" + one + "," + one + "," + one + "," + one + "," + one + "]")
                  .find("/bodies/0/grips: expected at most 4 grips"),
              std::string::npos);
}

TEST(SceneGripFile, WrittenAndReadAgainIsTheSame) {
    SceneFile file;
    file.name = "gun";
    file.description = "a gun";
    GunModel gun = make_gun();
    SceneBody body;
    body.name = "gun";
    body.kind = BodyKind::free;
    body.shape = gun.shape;
    body.grips = gun.grips;
    file.bodies.push_back(body);
    const Result<SceneFile> again = parse_scene_file(write_scene_file(file), "gun.json");
    ASSERT_TRUE(again.ok()) << again.error().message();
    ASSERT_EQ(again.value().bodies[0].grips.size(), gun.grips.size());
    for (std::size_t i = 0; i < gun.grips.size(); ++i) {
        const SceneGrip& read = again.value().bodies[0].grips[i];
        EXPECT_EQ(read.name, gun.grips[i].name);
        EXPECT_EQ(read.mirror_axis, gun.grips[i].mirror_axis);
        EXPECT_EQ(read.grip.priority, gun.grips[i].grip.priority);
        EXPECT_EQ(read.grip.snap_radius_m, gun.grips[i].grip.snap_radius_m);
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            const AuthoredHand& before = gun.grips[i].grip.hands[side];
            const AuthoredHand& after = read.grip.hands[side];
            EXPECT_EQ(after.is_posed, before.is_posed);
            EXPECT_EQ(after.follows_trigger, before.follows_trigger);
            EXPECT_EQ(after.wrist_bs.position, before.wrist_bs.position);
            EXPECT_LT((after.wrist_bs.rotation.coeffs() - before.wrist_bs.rotation.coeffs()).norm(),
                      1e-15);
            for (std::size_t f = 0; f < k_finger_count; ++f) {
                for (std::size_t link = 0; link < k_max_links; ++link) {
                    EXPECT_NEAR(after.fingers[f].curl_rad[link], before.fingers[f].curl_rad[link],
                                1e-14);
                    EXPECT_NEAR(after.pressed[f].curl_rad[link], before.pressed[f].curl_rad[link],
                                1e-14);
                }
            }
        }
    }
}

// --- Through an animation package ----------------------------------------------------------------

class GunGrips : public testing::Test {
  public:
    GunModel gun = make_gun();
    Scene scene;

    GunGrips() {
        SceneFile file;
        file.name = "gun";
        SceneBody body;
        body.name = "gun";
        body.kind = BodyKind::free;
        body.shape = gun.shape;
        body.grips = gun.grips;
        file.bodies.push_back(std::move(body));
        scene = std::move(build_scene(file, "gun.json").value());
    }
    const GripMesh& mesh() const {
        return scene.grip_meshes().at(scene.world().collider.elements()[0].shape);
    }
    const AuthoredGrips& in_body() const { return scene.world().authored_grips.elements()[0]; }
    FittedGrip fitted(std::size_t grip, HandSide side) const {
        const AuthoredHand& hand = in_body().grips[grip].hands[index_of(side)];
        return fit_grip(mesh(), rigs()[index_of(side)], hand.wrist_bs, scene.tuning(), &hand);
    }
    GripScene grip_scene(std::size_t grip, HandSide side) const {
        GripScene out;
        out.grip = gun.grips[grip];
        out.side = side;
        out.fingers = fitted(grip, side).fingers;
        return out;
    }
};

// Expected: the points of all links and the wrist unchanged, within a micrometre.
TEST_F(GunGrips, RoundTripThroughGltfKeepsEveryLinkWithinAMicrometre) {
    for (std::size_t i = 0; i < gun.grips.size(); ++i) {
        for (const HandSide side : {HandSide::left, HandSide::right}) {
            GripScene out = grip_scene(i, side);
            const HandRig& rig = rigs()[index_of(side)];
            const std::string glb = write_grip_glb(out, rig);
            const Result<SceneGrip> read = parse_grip_glb(glb, "gun.glb", rigs());
            ASSERT_TRUE(read.ok()) << read.error().message();
            EXPECT_EQ(read.value().name, gun.grips[i].name);
            EXPECT_EQ(read.value().grip.priority, gun.grips[i].grip.priority);
            EXPECT_EQ(read.value().grip.snap_radius_m, gun.grips[i].grip.snap_radius_m);
            EXPECT_NEAR(read.value().grip.snap_angle_rad, gun.grips[i].grip.snap_angle_rad, 1e-12);
            for (const HandSide other : {HandSide::left, HandSide::right}) {
                const AuthoredHand& before = gun.grips[i].grip.hands[index_of(other)];
                const AuthoredHand& after = read.value().grip.hands[index_of(other)];
                ASSERT_TRUE(after.is_there);
                EXPECT_EQ(after.is_posed, before.is_posed);
                EXPECT_EQ(after.follows_trigger, before.follows_trigger);
                for (std::size_t f = 0; f < k_finger_count; ++f) {
                    for (std::size_t link = 0; link < k_max_links; ++link) {
                        EXPECT_NEAR(after.pressed[f].curl_rad[link],
                                    before.pressed[f].curl_rad[link], 1e-12);
                    }
                }
                EXPECT_LT((after.wrist_bs.position - before.wrist_bs.position).norm(), 1e-6);
            }
            const AuthoredHand& hand = read.value().grip.hands[index_of(side)];
            for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
                const auto name = static_cast<std::size_t>(rig.fingers[f].name);
                if (!hand.is_posed[name]) {
                    continue;
                }
                const auto before = finger_points(rig.fingers[f], out.fingers[f]);
                const auto after = finger_points(rig.fingers[f], hand.fingers[name]);
                for (std::size_t link = 0; link < before.size(); ++link) {
                    EXPECT_LT((transform_point(out.grip.grip.hands[index_of(side)].wrist_bs,
                                               before[link]) -
                               transform_point(hand.wrist_bs, after[link]))
                                  .norm(),
                              1e-6);
                }
            }
        }
    }
}

TEST_F(GunGrips, FileHasHandControllerAndObjectAndOpensAsASkin) {
    GripScene out = grip_scene(0, HandSide::right);
    out.materials.push_back({"steel"});
    GltfSurface surface;
    surface.name = "gun";
    for (const Vec3& corner : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}) {
        surface.vertices.push_back({{static_cast<float>(corner.x()), static_cast<float>(corner.y()),
                                     static_cast<float>(corner.z())},
                                    {0.0F, 0.0F, 1.0F}});
    }
    surface.indices = {0, 1, 2};
    out.object.push_back(surface);
    out.controller = {{"controller", {Vec3(0.0, 0.02, -0.05), Quat::Identity()}}};
    const std::string glb = write_grip_glb(out, rigs()[1]);
    const auto skin = parse_gltf_skin(glb, "gun.glb");
    ASSERT_TRUE(skin.ok()) << skin.error().message();
    const auto nodes = parse_gltf_nodes(glb, "gun.glb");
    ASSERT_TRUE(nodes.ok());
    int known = 0;
    for (const GltfNode& node : nodes.value()) {
        if (node.name == "controller") {
            const Pose expected =
                out.grip.grip.hands[1].wrist_bs * Pose{Vec3(0.0, 0.02, -0.05), Quat::Identity()};
            EXPECT_LT((node.pose_ms->position - expected.position).norm(), 1e-12);
        }
        known += node.name == "controller" || node.name == "object" ||
                         node.name == "grip/handle/right" || node.name == "gun"
                     ? 1
                     : 0;
    }
    EXPECT_EQ(known, 4);
}

TEST_F(GunGrips, FileHasTheModelOfTheControllerWhereTheHandHoldsIt) {
    const ControllerModels models = builtin_controllers(hand_shape(hh::World()));
    GripScene out = grip_scene(0, HandSide::right);
    const ControllerModel& model = models.sides[1];
    out.controller = controller_objects(model, out.materials);
    const auto nodes = parse_gltf_nodes(write_grip_glb(out, rigs()[1]), "gun.glb");
    ASSERT_TRUE(nodes.ok());
    const Pose wrist = out.grip.grip.hands[1].wrist_bs;
    std::size_t parts = 0;
    int with_trigger = 0;
    for (const GltfNode& node : nodes.value()) {
        if (node.name == "controller") {
            const Pose joint = inverse(*node.pose_ms) * wrist;
            EXPECT_LT((joint.position - from_host(model.fit.hand_in_grip.position)).norm(), 1e-12);
            EXPECT_LT(joint.rotation.angularDistance(from_host(model.fit.hand_in_grip.rotation)),
                      1e-7);
        } else if (node.name.starts_with("controller-part-") && !node.name.ends_with("mesh")) {
            const Pose expected = wrist * from_host(controller_in_hand(model.fit));
            EXPECT_LT((node.pose_ms->position - expected.position).norm(), 1e-12);
            with_trigger += node.numbers.contains(k_pressed_trigger_key) ? 1 : 0;
            ++parts;
        }
    }
    EXPECT_EQ(parts, model.meshes.size());
    EXPECT_GE(with_trigger, 1);
}

// An author may move the object instead of the hand.
TEST_F(GunGrips, OnlyTheHandRelativeToTheObjectCounts) {
    const GripScene out = grip_scene(0, HandSide::right);
    std::string glb = write_grip_glb(out, rigs()[1]);
    const std::string before = R"("name":"object","translation":[0.0,0.0,0.0])";
    const std::string after = R"("name":"object","translation":[0.5,0.0,2.0])";
    const std::size_t at = glb.find(before);
    ASSERT_NE(at, std::string::npos);
    glb.replace(at, before.size(), after);
    const Result<SceneGrip> read = parse_grip_glb(glb, "gun.glb", rigs());
    ASSERT_TRUE(read.ok());
    const Vec3 expected = out.grip.grip.hands[1].wrist_bs.position - Vec3(0.5, 0.0, 2.0);
    EXPECT_LT((read.value().grip.hands[1].wrist_bs.position - expected).norm(), 1e-9);
}

TEST_F(GunGrips, FilesWithoutAGripAreRefused) {
    const Result<SceneGrip> hand = parse_grip_glb(export_robot_hand(rigs()[1]), "hand.glb", rigs());
    ASSERT_FALSE(hand.ok());
    EXPECT_NE(hand.error().message().find("expected a \"grip/<name>/<right or left>\" node"),
              std::string::npos)
        << hand.error().message();
    EXPECT_FALSE(parse_grip_glb("no file", "hand.glb", rigs()).ok());
    std::string glb = write_grip_glb(grip_scene(0, HandSide::right), rigs()[1]);
    const std::string name = "index-finger-phalanx-distal";
    for (std::size_t at = glb.find(name); at != std::string::npos; at = glb.find(name)) {
        glb.replace(at, name.size(), "somebody-else's-knucklebone");
    }
    const Result<SceneGrip> maimed = parse_grip_glb(glb, "gun.glb", rigs());
    ASSERT_FALSE(maimed.ok());
    EXPECT_NE(maimed.error().message().find(name), std::string::npos) << maimed.error().message();
}

// --- The gun -------------------------------------------------------------------------------------

TEST_F(GunGrips, PosedFingersOfEitherHandDoNotPenetrateTheGun) {
    for (std::size_t i = 0; i < gun.grips.size(); ++i) {
        for (const HandSide side : {HandSide::left, HandSide::right}) {
            ASSERT_TRUE(in_body().grips[i].hands[index_of(side)].is_there);
            const FittedGrip fit = fitted(i, side);
            EXPECT_EQ(fit.penetrating_fingers, 0U) << gun.grips[i].name;
            EXPECT_TRUE(fit.is_gripping);
        }
    }
}

TEST(Gun, IsSymmetricAndMirroredGripsAreForIt) {
    const GunModel gun = make_gun();
    ASSERT_EQ(gun.grips.size(), 2U);
    for (const SceneGrip& grip : gun.grips) {
        EXPECT_EQ(grip.mirror_axis, 0) << grip.name;
    }
    for (const Mesh& part : gun.visual.parts) {
        double sum_x = 0.0;
        for (const Vec3& position : part.positions) {
            sum_x += position.x();
        }
        EXPECT_LT(std::abs(sum_x / static_cast<double>(part.positions.size())), 1e-4) << part.name;
    }
}

}  // namespace
}  // namespace handhold::grip_file_test
