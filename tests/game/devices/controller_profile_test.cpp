// Controllers as data: what their profiles say, how they sit in hands, and what is refused.
#include "game/devices/controller_profile.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "engine/core/text_file.hpp"
#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/segment_triangle.hpp"
#include "game/play/desktop_session.hpp"
#include "game/view/controller_figures.hpp"
#include "systems/input/read_tracking.hpp"
#include "systems/rigs/builtin_hand_rig.hpp"
#include "systems/rigs/hand_kinematics.hpp"
#include "tests/game/climber/climber_scene.hpp"
#include "tests/places.hpp"

namespace handhold::controller_profile_test {
namespace {

const char* const k_own = R"({"name": "wand",
  "left": {"model": "l.glb", "handle": {}},
  "right": {"model": "sub/r.glb",
            "grip": {"position_m": [0, 0.02, 0.01], "rotation_xyzw": [0.70710678, 0, 0, 0.70710678]},
            "aim": {"position_m": [0, 0, -0.05]},
            "hand": {"position_m": [0, 0, 0.09]}}})";

const char* const k_webxr = R"({"profileId": "some-pair", "fallbackProfileIds": ["generic"],
  "layouts": {"left-right": {"selectComponentId": "t", "components": {}, "assetPath": "both.glb"}}})";

ControllerProfile parse(const std::string& text) {
    const auto profile = parse_controller_profile(text, "folder/p.json");
    EXPECT_TRUE(profile.ok()) << (profile.ok() ? "" : profile.error().message());
    return profile.ok() ? profile.value() : ControllerProfile{};
}

std::string with(const std::string& text, const std::string& part, const std::string& other) {
    std::string changed = text;
    const std::size_t at = changed.find(part);
    EXPECT_NE(at, std::string::npos) << part;
    return changed.replace(at, part.size(), other);
}

void expect_near(const Vec3& found, const Vec3& expected, double tolerance = 1e-7) {
    EXPECT_LT((found - expected).norm(), tolerance)
        << found.transpose() << " against " << expected.transpose();
}

TEST(ControllerProfile, ReadsModelsAndPoses) {
    const ControllerProfile profile = parse(k_own);
    EXPECT_EQ(profile.name, "wand");
    EXPECT_EQ(profile.sides[0].model, std::filesystem::path("folder/l.glb"));
    EXPECT_EQ(profile.sides[1].model, std::filesystem::path("folder/sub/r.glb"));
    const ControllerFit& right = profile.sides[1].fit;
    EXPECT_EQ(from_host(right.grip_ms.position), Vec3(0, 0.02, 0.01));
    EXPECT_EQ(from_host(right.aim_ms.position), Vec3(0, 0, -0.05));
    EXPECT_EQ(from_host(right.hand_in_grip.position), Vec3(0, 0, 0.09));
    const ControllerFit& left = profile.sides[0].fit;
    EXPECT_EQ(from_host(left.grip_ms.position), Vec3(Vec3::Zero()));
    const Pose held = from_host(left.hand_in_grip *
                                handle_in_hand(HH_LEFT, {}, to_host(HandTuning{}.palm_center_m)));
    expect_near(held.position, Vec3::Zero());
    EXPECT_LT(rotation_to_vector(held.rotation).norm(), 1e-12);
}

// The grip pose stands a quarter turn about x in the model, the wrist 9 cm behind it: in the
// model's frame the wrist is at (0, 0.02, 0.01) + 0.09 (0, -1, 0).
TEST(ControllerProfile, ModelStandsInTheHandAsGripAndJointSay) {
    const Pose in_hand = from_host(controller_in_hand(parse(k_own).sides[1].fit));
    expect_near(transform_point(in_hand, Vec3(0.0, -0.07, 0.01)), Vec3::Zero());
    // The model's -y is the wrist's z, its z the wrist's y.
    expect_near(in_hand.rotation * -Vec3::UnitY(), Vec3::UnitZ());
    expect_near(in_hand.rotation * Vec3::UnitZ(), Vec3::UnitY());
}

TEST(ControllerProfile, HandleLiesOnThePalmWithOpenXrsAxes) {
    const HandTuning tuning;
    const HandleGrip handle = {0.02, 0.3, 0.01};
    const Pose right = from_host(handle_in_hand(HH_RIGHT, handle, to_host(tuning.palm_center_m)));
    const Vec3 to_thumb(-std::cos(0.3), 0.0, -std::sin(0.3));
    expect_near(right.position, tuning.palm_center_m - Vec3(0.0, 0.02, 0.0) + 0.01 * to_thumb,
                1e-12);
    expect_near(right.rotation * -Vec3::UnitZ(), to_thumb, 1e-12);
    expect_near(right.rotation * Vec3::UnitX(), Vec3::UnitY(), 1e-12);  // into the palm
    const Pose left = from_host(handle_in_hand(HH_LEFT, handle, to_host(tuning.palm_center_m)));
    const Vec3 mirror(-1.0, 1.0, 1.0);
    expect_near(left.position, mirror.cwiseProduct(right.position), 1e-12);
    expect_near(left.rotation * -Vec3::UnitZ(), mirror.cwiseProduct(to_thumb), 1e-12);
    expect_near(left.rotation * Vec3::UnitX(), -Vec3::UnitY(), 1e-12);  // out of the palm
}

TEST(ControllerProfile, WebXrLayoutMayServeBothHands) {
    const ControllerProfile profile = parse(k_webxr);
    EXPECT_EQ(profile.name, "some-pair");
    for (const ControllerSide& side : profile.sides) {
        EXPECT_EQ(side.model, std::filesystem::path("folder/both.glb"));
        EXPECT_TRUE(side.fit.grip_ms.position == hh::Vec3{});
    }
}

TEST(ControllerProfile, ReadsWhatMovesOfOursAndOfWebXrs) {
    const std::string controls =
        R"("handle": {}, "controls": [{"control": "squeeze", "node": "s", "from": "a", "to": "b"}])";
    const ControllerProfile own = parse(with(k_own, R"("handle": {})", controls));
    ASSERT_EQ(own.sides[0].controls.size(), 1U);
    EXPECT_EQ(own.sides[0].controls[0].control, Control::squeeze);
    EXPECT_EQ(own.sides[0].controls[0].to, "b");
    EXPECT_TRUE(own.sides[1].controls.empty());
    const std::string components = R"("components": {
      "menu": {"visualResponses": {"m": {"componentProperty": "button",
        "valueNodeProperty": "transform", "valueNodeName": "m", "minNodeName": "n", "maxNodeName": "o"}}},
      "thumbrest": {"visualResponses": {"r": {"componentProperty": "button",
        "valueNodeProperty": "transform", "valueNodeName": "r", "minNodeName": "s", "maxNodeName": "t"}}},
      "xr-standard-touchpad": {"visualResponses": {
        "seen": {"componentProperty": "state", "valueNodeProperty": "visibility", "valueNodeName": "v"},
        "tilt": {"componentProperty": "yAxis", "valueNodeProperty": "transform",
                 "valueNodeName": "y", "minNodeName": "ahead", "maxNodeName": "back"}}}})";
    const ControllerProfile webxr = parse(with(k_webxr, R"("components": {})", components));
    const std::vector<ControlledNode>& found = webxr.sides[1].controls;
    ASSERT_EQ(found.size(), 2U);
    EXPECT_EQ(found[0].control, Control::upper_button);
    EXPECT_EQ(found[0].node, "m");
    EXPECT_EQ(found[1].control, Control::stick_y);
    EXPECT_EQ(found[1].from, "ahead");
}

TEST(ControllerProfile, RefusesWithFilePointerAndWhatWasExpected) {
    const auto expect_refused = [](const std::string& text, const std::string& place,
                                   const std::string& expected) {
        const auto profile = parse_controller_profile(text, "folder/p.json");
        ASSERT_FALSE(profile.ok()) << text;
        EXPECT_EQ(profile.error().file, "folder/p.json");
        EXPECT_EQ(profile.error().place, place) << profile.error().message();
        EXPECT_NE(profile.error().expected.find(expected), std::string::npos)
            << profile.error().message();
    };
    const std::string own = k_own;
    expect_refused(with(own, R"("name": "wand",)", ""), "/name", "nothing");
    expect_refused(with(own, R"("left":)", R"("links":)"), "/links", "left");
    expect_refused(with(own, R"("handle": {})", R"("handle": {}, "hand": {})"), "/left", "either");
    expect_refused(with(own, R"(, "handle": {})", ""), "/left", "either");
    expect_refused(with(own, R"("handle": {})", R"("handle": {"radius_m": 0.5})"),
                   "/left/handle/radius_m", "0.5");
    expect_refused(with(own, R"("handle": {})", R"("handle": {"width_m": 0.5})"),
                   "/left/handle/width_m", "radius_m");
    expect_refused(with(own, "[0, 0, -0.05]", "[0, 0]"), "/right/aim/position_m", "");
    expect_refused(with(own, "[0, 0, 0.09]", "[0, 0, 9]"), "/right/hand/position_m/2", "9");
    expect_refused(with(own, "[0.70710678, 0, 0, 0.70710678]", "[1, 0, 0, 1]"),
                   "/right/grip/rotation_xyzw", "");
    expect_refused(with(own, R"("sub/r.glb")", "7"), "/right/model", "7");
    expect_refused(
        with(own, R"("handle": {})", R"("handle": {}, "controls": [{"control": "knob"}])"),
        "/left/controls/0/control", "trigger");
    expect_refused(
        with(own, R"("handle": {})", R"("handle": {}, "controls": [{"control": "trigger"}])"),
        "/left/controls/0/node", "nothing");
    expect_refused(with(k_webxr, R"("components": {})", R"("components": [])"),
                   "/layouts/left-right/components", "an object");
    expect_refused(with(k_webxr, "left-right", "left"), "/layouts", "right hand");
    expect_refused(with(k_webxr, "assetPath", "asset"), "/layouts/left-right/assetPath", "nothing");
    EXPECT_FALSE(parse_controller_profile("{", "folder/p.json").ok());
}

TEST(ControllerProfile, MissingFilesAreNamed) {
    const auto absent = choose_controllers("no/such/profile.json");
    ASSERT_FALSE(absent.ok());
    EXPECT_NE(absent.error().message().find("profile.json"), std::string::npos);
    const auto folder = std::filesystem::path(testing::TempDir());
    ASSERT_FALSE(write_file_atomically(folder / "wand_profile.json", k_own));
    const auto without_model = choose_controllers((folder / "wand_profile.json").string());
    ASSERT_FALSE(without_model.ok());
    EXPECT_NE(without_model.error().message().find("l.glb"), std::string::npos);
}

TEST(ControllerJoints, MoveTheControllerNotTheHandOfWhoPlaysAtADesk) {
    DesktopSession plain(make_void(), hh::k_origin);
    DesktopSession own(make_void(), hh::k_origin);
    const ControllerProfile profile = parse(k_own);
    std::array<hh::Pose, 2> joints{};
    for (std::size_t side = 0; side < 2; ++side) {
        joints[side] = profile.sides[side].fit.hand_in_grip;
    }
    own.set_controller_joints(joints);
    for (int frame = 0; frame < 5; ++frame) {
        plain.step({});
        own.step({});
    }
    for (const hh::Side side : {HH_LEFT, HH_RIGHT}) {
        EXPECT_TRUE(own.world().hand_in_controller(own.player(), side)->position ==
                    joints[side].position);
        const auto hand_ps = [&](const DesktopSession& session) {
            const World& world = session.scene().world();
            return world.hand_tracking.at(player_entities(world, session.player()).hands[side])
                .pose_ps.position;
        };
        expect_near(hand_ps(own), hand_ps(plain), 1e-9);
    }
}

// How near a hand's fingers come to a controller's triangles, by capsules against triangles.
struct FingerGap {
    double skin_m = 1.0;  // below 0: penetrating
    double bone_m = 1.0;  // 0: a triangle goes through the capsule's middle
};
std::vector<FingerGap> finger_gaps(const ControllerModel& model, const HandRig& rig,
                                   const std::array<FingerAngles, k_finger_count>& fingers,
                                   const ControlValues& values) {
    const Pose wrist = from_host(hh::inverse(controller_in_hand(model.fit)));
    std::vector<FingerGap> gaps;
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        const auto points = finger_points(rig.fingers[f], fingers[f]);
        FingerGap gap;
        for (std::size_t i = 0; i < rig.fingers[f].link_count; ++i) {
            const std::array<Vec3, 2> link = {transform_point(wrist, points[i]),
                                              transform_point(wrist, points[i + 1])};
            for (std::size_t m = 0; m < model.meshes.size(); ++m) {
                const Mesh& part = model.meshes[m].mesh;
                const Pose moved = from_host(moved_by(model.moves[m], values));
                for (const auto& [a, b, c] : part.triangles) {
                    const Corners corners = {transform_point(moved, part.positions[a]),
                                             transform_point(moved, part.positions[b]),
                                             transform_point(moved, part.positions[c])};
                    const double away_m = nearest_between(link, corners).distance_m;
                    gap.bone_m = std::min(gap.bone_m, away_m);
                    gap.skin_m = std::min(gap.skin_m, away_m - rig.fingers[f].radius_m[i]);
                }
            }
        }
        gaps.push_back(gap);
    }
    return gaps;
}

std::vector<FingerGap> gaps_at_rest(const ControllerModel& model, const HandRig& rig) {
    return finger_gaps(model, rig, fingers_around(model, rig), k_controls_at_rest);
}

// At least three fingers on it, none with its bones through it. Thumbs and index fingers begin in a
// head that is thick where the palm is: there nothing but another place of the palm helps, and that
// is the joint's.
void expect_held(const ControllerModels& models) {
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        int touching = 0;
        for (const FingerGap& gap :
             gaps_at_rest(models.sides[index_of(side)], builtin_hand_rig(side))) {
            touching += gap.skin_m < 2e-3 ? 1 : 0;
            EXPECT_GT(gap.bone_m, 0.0) << models.name;
        }
        EXPECT_GE(touching, 3) << models.name;
    }
}

// The index finger moves with the trigger, and however far the trigger is pressed, no finger's bone
// enters the controller.
void expect_followed(const ControllerModels& models) {
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        const ControllerModel& model = models.sides[index_of(side)];
        const HandRig rig = builtin_hand_rig(side);
        const FollowingFingers fingers(model, rig);
        const auto at = [&](double share) {
            ControlValues values = k_controls_at_rest;
            values[static_cast<std::size_t>(Control::trigger)] = share;
            return values;
        };
        for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
            for (const FingerGap& gap : finger_gaps(model, rig, fingers.at(at(share)), at(share))) {
                EXPECT_GT(gap.bone_m, 0.0) << models.name << " trigger " << share;
            }
        }
        const auto index = std::ranges::find(rig.fingers, FingerName::index, &FingerRig::name);
        const auto f = static_cast<std::size_t>(index - rig.fingers.begin());
        const auto tip = [&](double share) {
            return finger_points(*index, fingers.at(at(share))[f])[index->link_count];
        };
        EXPECT_GT((tip(1.0) - tip(0.0)).norm(), 3e-3) << models.name;
    }
}

TEST(Controllers, BuiltinIsHeldInTheFistByTheTuningsJoint) {
    const HandTuning tuning;
    const ControllerModels models = builtin_controllers(hand_shape(hh::World()));
    EXPECT_FALSE(models.has_own_joint);
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        const ControllerFit& fit = models.sides[index_of(side)].fit;
        expect_near(from_host(fit.hand_in_grip.position),
                    default_controller_to_hand(side, tuning).position);
        EXPECT_LT((from_host(controller_in_hand(fit)).position - tuning.palm_center_m).norm(),
                  0.025);
    }
    expect_held(models);
    expect_followed(models);
}

TEST(Controllers, EveryRealProfileLoadsAndIsHeldByBothHands) {
    const std::filesystem::path folder = data_dir() / "controllers";
    if (!std::filesystem::exists(folder)) {
        GTEST_SKIP() << "no data";
    }
    int seen = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (!entry.is_directory()) {
            continue;
        }
        const auto models = choose_controllers((entry.path() / "profile.json").string());
        ASSERT_TRUE(models.ok()) << models.error().message();
        EXPECT_EQ(models.value().name, entry.path().filename().string());
        EXPECT_TRUE(models.value().has_own_joint);
        for (const ControllerModel& model : models.value().sides) {
            for (const LevelMesh& part : model.meshes) {
                for (const Vec3& position : part.mesh.positions) {
                    ASSERT_LT(position.norm(), 0.25) << part.mesh.name;
                }
            }
        }
        expect_held(models.value());
        expect_followed(models.value());
        ++seen;
    }
    EXPECT_GE(seen, 1);
}

}  // namespace
}  // namespace handhold::controller_profile_test
