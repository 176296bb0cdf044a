#include "engine/io/vrm_humanoid.hpp"

#include <gtest/gtest.h>

namespace handhold::vrm_humanoid_test {
namespace {

using Humanoid = std::map<std::string, std::string>;

constexpr const char* k_nodes =
    R"("nodes": [{"name": "root"}, {"name": "a"}, {"name": "b"}, {"name": "twice"},
                 {"name": "twice"}, {}])";

Result<Humanoid> parse(const std::string& extensions) {
    return parse_vrm_humanoid(
        std::string(R"({"asset": {"version": "2.0"}, )") + k_nodes + extensions + "}", "x.vrm");
}

TEST(VrmHumanoid, ReadsBothVersions) {
    const Humanoid expected = {{"hips", "a"}, {"leftUpperArm", "b"}};
    const Result<Humanoid> version_0 = parse(
        R"(, "extensions": {"VRM": {"humanoid": {"humanBones": [
            {"bone": "hips", "node": 1}, {"bone": "leftUpperArm", "node": 2}]}}})");
    ASSERT_TRUE(version_0.ok()) << version_0.error().message();
    EXPECT_EQ(version_0.value(), expected);
    const Result<Humanoid> version_1 = parse(
        R"(, "extensions": {"VRMC_vrm": {"humanoid": {"humanBones": {
            "hips": {"node": 1}, "leftUpperArm": {"node": 2}}}}})");
    ASSERT_TRUE(version_1.ok()) << version_1.error().message();
    EXPECT_EQ(version_1.value(), expected);
}

TEST(VrmHumanoid, IsEmptyWithoutATable) {
    for (const char* extensions : {"", R"(, "extensions": {})", R"(, "extensions": {"VRM": {}})",
                                   R"(, "extensions": {"VRMC_vrm": {"humanoid": {}}})"}) {
        const Result<Humanoid> found = parse(extensions);
        ASSERT_TRUE(found.ok()) << found.error().message();
        EXPECT_TRUE(found.value().empty()) << extensions;
    }
}

// Joints are found by name later: ambiguous nodes are left out.
TEST(VrmHumanoid, LeavesOutNodesWithoutAUniqueName) {
    const Result<Humanoid> found = parse(
        R"(, "extensions": {"VRMC_vrm": {"humanoid": {"humanBones": {
            "hips": {"node": 3}, "neck": {"node": 5}, "head": {"node": 1}}}}})");
    ASSERT_TRUE(found.ok());
    EXPECT_EQ(found.value(), (Humanoid{{"head", "a"}}));
}

TEST(VrmHumanoid, RefusesNodesThatDoNotExistAndOtherTypes) {
    for (const char* bones : {R"({"hips": {"node": 6}})", R"({"hips": {"node": -1}})",
                              R"({"hips": {"node": "a"}})", R"({"hips": 1})"}) {
        const Result<Humanoid> found =
            parse(std::string(R"(, "extensions": {"VRMC_vrm": {"humanoid": {"humanBones": )") +
                  bones + "}}}");
        ASSERT_FALSE(found.ok()) << bones;
        EXPECT_NE(found.error().place.find("/extensions/VRMC_vrm/humanoid/humanBones/hips"),
                  std::string::npos)
            << found.error().message();
    }
    EXPECT_FALSE(parse(R"(, "extensions": {"VRM": {"humanoid": {"humanBones": [3]}}})").ok());
    EXPECT_FALSE(parse_vrm_humanoid("glTF", "x.vrm").ok());
}

}  // namespace
}  // namespace handhold::vrm_humanoid_test
