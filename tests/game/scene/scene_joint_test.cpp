// Joints and chains of a scene file: docs/reference/scene_format.md, "Joints" and "Chains".
#include "game/scene/scene_joint.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "game/scene/scene.hpp"
#include "game/scene/scene_file.hpp"

namespace handhold::scene_joint_test {
namespace {

using Json = nlohmann::json;

Json ball(const char* name, const char* kind, const Json& position) {
    Json body = {{"name", name},
                 {"kind", kind},
                 {"position_m", position},
                 {"shape", {{"type", "sphere"}, {"radius_m", 0.1}}}};
    if (std::string(kind) == "free") {
        body["mass_kg"] = 2.0;
    }
    return body;
}

using List = std::vector<Json>;

Json scene_with(const List& joints, const List& chains = {}) {
    return {{"name", "joints"},
            {"bodies",
             {ball("wall", "static", {0, 0, 0}), ball("post", "static", {0, 0, 9}),
              ball("crate", "free", {1, 0, 0}), ball("lid", "free", {2, 0, 0})}},
            {"joints", joints},
            {"chains", chains}};
}

Result<SceneFile> parse(const Json& scene) { return parse_scene_file(scene.dump(), "a.json"); }

Json hinge() {
    return {{"name", "hinge"},
            {"type", "hinge"},
            {"a", "wall"},
            {"b", "crate"},
            {"position_m", {0.5, 0, 0}},
            {"axis", {0, 2, 0}},
            {"limits_deg", {-90, 45}},
            {"friction_nm", 0.25},
            {"detent", {{"spacing_deg", 30}, {"strength_nm", 1.5}}}};
}
Json slider() {
    return {{"name", "slider"},
            {"type", "slider"},
            {"a", "crate"},
            {"b", "lid"},
            {"limits_m", {0, 0.3}},
            {"friction_n", 4},
            {"latch",
             {{"at_m", 0.1},
              {"catch_m", 0.01},
              {"strength_n", 50},
              {"handle", "hinge"},
              {"handle_deg", 30}}}};
}
Json rope() {
    return {{"name", "rope"},          {"type", "distance"},        {"b", "lid"},
            {"position_m", {2, 0, 0}}, {"position_a_m", {2, 1, 0}}, {"limits_m", {0, 1.25}}};
}
Json chain() {
    return {{"name", "cable"},  {"links", 10},         {"a", "wall"},
            {"b", "lid"},       {"from_m", {0, 0, 0}}, {"to_m", {2, 0, 0}},
            {"radius_m", 0.02}, {"mass_kg", 5},        {"friction_nm", 0.5}};
}

TEST(SceneJoint, ReadsAsWritten) {
    const Result<SceneFile> file = parse(scene_with({hinge(), slider(), rope()}));
    ASSERT_TRUE(file.ok()) << file.error().message();
    ASSERT_EQ(file.value().joints.size(), 3U);
    const SceneJoint& turns = file.value().joints[0];
    EXPECT_EQ(turns.joint.kind, JointKind::hinge);
    EXPECT_EQ(turns.a, "wall");
    EXPECT_LT((turns.pose.rotation * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-12);
    EXPECT_TRUE(turns.joint.limited);
    EXPECT_NEAR(turns.joint.lower, -90.0 * k_degree, 1e-12);
    EXPECT_NEAR(turns.joint.upper, 45.0 * k_degree, 1e-12);
    EXPECT_EQ(turns.joint.friction, 0.25);
    EXPECT_NEAR(turns.joint.detent_spacing, 30.0 * k_degree, 1e-12);
    EXPECT_EQ(turns.joint.detent_strength, 1.5);
    EXPECT_FALSE(turns.joint.collides);
    const SceneJoint& slides = file.value().joints[1];
    EXPECT_EQ(slides.joint.upper, 0.3);
    EXPECT_EQ(slides.joint.latch.at, 0.1);
    EXPECT_EQ(slides.joint.latch.catch_range, 0.01);
    EXPECT_EQ(slides.joint.latch.strength, 50.0);
    EXPECT_EQ(slides.handle, "hinge");
    EXPECT_NEAR(slides.joint.latch.handle_at, 30.0 * k_degree, 1e-12);
    const SceneJoint& holds = file.value().joints[2];
    EXPECT_EQ(holds.a, "");
    EXPECT_EQ(holds.end_a, Vec3(2.0, 1.0, 0.0));
    EXPECT_EQ(holds.joint.upper, 1.25);
}

TEST(SceneJoint, BodiesStandAtTimeZeroAsTheJointsWantThem) {
    const Result<SceneFile> file = parse(scene_with({hinge(), slider(), rope()}));
    const Result<Scene> built = build_scene(file.value(), "a.json");
    ASSERT_TRUE(built.ok()) << built.error().message();
    const World& world = built.value().world();
    ASSERT_EQ(world.joint.size(), 3U);
    for (const Joint& joint : world.joint.elements()) {
        const auto frame_ws = [&](Entity body, const Pose& frame_bs) {
            return body == k_no_entity ? frame_bs : world.body_pose.at(body).pose_ws * frame_bs;
        };
        const Pose a = frame_ws(joint.a, joint.frame_a_bs);
        const Pose b = frame_ws(joint.b, joint.frame_b_bs);
        const double apart_m = (a.position - b.position).norm();
        EXPECT_NEAR(apart_m, joint.kind == JointKind::distance ? 1.0 : 0.0, 1e-12);
        EXPECT_LT((a.rotation.inverse() * b.rotation).vec().norm(), 1e-12);
    }
}

TEST(SceneChain, MakesLinksAndTheirBalls) {
    const Result<SceneFile> file = parse(scene_with({}, {chain()}));
    ASSERT_TRUE(file.ok()) << file.error().message();
    const SceneFile& scene = file.value();
    ASSERT_EQ(scene.bodies.size(), 4U + 10U);
    ASSERT_EQ(scene.joints.size(), 11U);
    EXPECT_EQ(scene.bodies[4].name, "cable/0");
    EXPECT_EQ(scene.bodies[4].mass_kg, 0.5);
    EXPECT_LT((scene.bodies[13].pose.position - Vec3(1.9, 0.0, 0.0)).norm(), 1e-12);
    EXPECT_NEAR(scene.bodies[4].shape.half_height_m + scene.bodies[4].shape.radius_m, 0.1, 1e-12);
    EXPECT_EQ(scene.joints[0].a, "wall");
    EXPECT_EQ(scene.joints[10].b, "lid");
    EXPECT_EQ(scene.joints[5].joint.friction, 0.5);
    Json hanging = chain();
    hanging.erase("a");
    hanging.erase("b");
    const Result<SceneFile> loose = parse(scene_with({}, {hanging}));
    ASSERT_TRUE(loose.ok());
    EXPECT_EQ(loose.value().joints.size(), 10U);
    EXPECT_EQ(loose.value().joints[0].a, "");
}

struct BadJoint {
    const char* what;
    const char* place;
    List joints;
    List chains = {};
};
void PrintTo(const BadJoint& joint, std::ostream* stream) { *stream << joint.what; }

class MalformedJoint : public ::testing::TestWithParam<BadJoint> {};

TEST_P(MalformedJoint, IsRefusedAtItsPlace) {
    const Result<SceneFile> result = parse(scene_with(GetParam().joints, GetParam().chains));
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().place, GetParam().place) << result.error().message();
}

Json with(Json value, const char* pointer, const Json& other) {
    value[Json::json_pointer(pointer)] = other;
    return value;
}
Json without(Json value, const char* key) {
    value.erase(key);
    return value;
}

const BadJoint k_bad_joints[] = {
    {"no object", "/joints/0", {7}},
    {"no name", "/joints/0/name", {without(hinge(), "name")}},
    {"name of a body", "/joints/0/name", {with(hinge(), "/name", "crate")}},
    {"name twice", "/joints/1/name", {hinge(), hinge()}},
    {"unknown type", "/joints/0/type", {with(hinge(), "/type", "spring")}},
    {"no b", "/joints/0/b", {without(hinge(), "b")}},
    {"unknown body", "/joints/0/a", {with(hinge(), "/a", "nobody")}},
    {"tied to itself", "/joints/0/b", {with(hinge(), "/a", "crate")}},
    {"nothing that moves", "/joints/0/b", {with(hinge(), "/b", "post")}},
    {"axis of nothing", "/joints/0/axis", {with(hinge(), "/axis", {0, 0, 0})}},
    {"axis and rotation", "/joints/0/axis", {with(hinge(), "/rotation_xyzw", {0, 0, 0, 1})}},
    {"limits without where it stands",
     "/joints/0/limits_deg",
     {with(hinge(), "/limits_deg", {10, 45})}},
    {"limits crossed", "/joints/0/limits_deg", {with(hinge(), "/limits_deg", {1, 0})}},
    {"one limit", "/joints/0/limits_deg", {with(hinge(), "/limits_deg", {1})}},
    {"limits of another unit", "/joints/0/limits_m", {with(hinge(), "/limits_m", {0, 1})}},
    {"friction below zero", "/joints/0/friction_nm", {with(hinge(), "/friction_nm", -1)}},
    {"detent of nothing",
     "/joints/0/detent/spacing_deg",
     {with(hinge(), "/detent/spacing_deg", 0)}},
    {"unknown key of a detent", "/joints/0/detent/hold", {with(hinge(), "/detent/hold", 1)}},
    {"latch without a catch",
     "/joints/1/latch/catch_m",
     {hinge(), with(slider(), "/latch", Json::object())}},
    {"handle that comes later", "/joints/0/latch/handle", {slider(), hinge()}},
    {"handle that is a rope",
     "/joints/1/latch/handle",
     {rope(), with(slider(), "/latch/handle", "rope")}},
    {"handle of another unit",
     "/joints/1/latch/handle_deg",
     {hinge(),
      with(slider(), "/latch", {{"catch_m", 0.01}, {"handle", "hinge"}, {"handle_m", 1}})}},
    {"rope without a length", "/joints/0/limits_m", {without(rope(), "limits_m")}},
    {"rope of less than nothing", "/joints/0/limits_m", {with(rope(), "/limits_m", {-1, 1})}},
    {"rope of no length", "/joints/0/limits_m", {with(rope(), "/limits_m", {0, 0})}},
    {"handle's angle without a handle",
     "/joints/1/latch/handle_deg",
     {hinge(), with(slider(), "/latch", {{"catch_m", 0.01}, {"handle_deg", 3}})}},
    {"rope that rubs", "/joints/0/friction_n", {with(rope(), "/friction_n", 1)}},
    {"chain of nothing", "/chains/0/links", {}, {with(chain(), "/links", 0)}},
    {"chain of too much", "/chains/0/links", {}, {with(chain(), "/links", 1000000000)}},
    {"chain on nobody", "/chains/0/a", {}, {with(chain(), "/a", "nobody")}},
    {"links thicker than long", "/chains/0/to_m", {}, {with(chain(), "/radius_m", 0.2)}},
    {"chain of no length", "/chains/0/to_m", {}, {with(chain(), "/to_m", {0, 0, 0})}},
    {"chain of no mass", "/chains/0/mass_kg", {}, {with(chain(), "/mass_kg", 0)}},
    {"two chains of one name", "/chains/1/name", {}, {chain(), chain()}},
    {"unknown key of a chain", "/chains/0/stiff", {}, {with(chain(), "/stiff", 1)}},
};

INSTANTIATE_TEST_SUITE_P(Files, MalformedJoint, ::testing::ValuesIn(k_bad_joints));

}  // namespace
}  // namespace handhold::scene_joint_test
