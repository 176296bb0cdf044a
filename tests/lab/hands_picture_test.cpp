#include <gtest/gtest.h>

#include "tools/lab/hand_viewpoint.hpp"
#include "tools/lab/posed_hands.hpp"

namespace handhold::lab::hands_picture_test {
namespace {

const char* const k_line =
    R"({"id":3,"gripped":true,"wrist":{"position_m":[1,2,3],"rotation_xyzw":[0,0,0,1]},)"
    R"("capsules":[{"finger":"index","link":1,"a_m":[0,0,0],"b_m":[0,0,-0.03],"radius_m":0.008}]})";

TEST(PosedHands, ReadsWristAndCapsules) {
    const auto hands = parse_posed_hands(std::string(k_line) + "\n\n" + k_line + "\n", "G.jsonl");
    ASSERT_TRUE(hands.ok()) << hands.error().message();
    ASSERT_EQ(hands.value().size(), 2U);
    EXPECT_EQ(hands.value()[1].id, 3);
    EXPECT_EQ(hands.value()[1].wrist.position, Vec3(1, 2, 3));
    ASSERT_EQ(hands.value()[1].capsules.size(), 1U);
    EXPECT_EQ(hands.value()[1].capsules[0].finger, "index");
    EXPECT_EQ(hands.value()[1].capsules[0].b_m, Vec3(0, 0, -0.03));
}

TEST(PosedHands, ErrorNamesLineAndPointer) {
    std::string bad = k_line;
    bad.replace(bad.find("index"), 5, "elbow");
    const auto hands = parse_posed_hands(std::string(k_line) + "\n" + bad, "G.jsonl");
    ASSERT_FALSE(hands.ok());
    EXPECT_EQ(hands.error().place, "line 2 /capsules/0/finger");
}

// A finger below a plate is only visible from below.
TEST(HandViewpoint, LooksFromAnUnobstructedSide) {
    const std::vector<HandCapsule> finger = {
        {"index", 0, Vec3(-0.02, -0.02, 0), Vec3(0.02, -0.02, 0), 0.008}};
    Mesh plate;
    plate.positions = {Vec3(-1, 0, -1), Vec3(1, 0, -1), Vec3(1, 0, 1), Vec3(-1, 0, 1)};
    plate.triangles = {{0, 1, 2}, {0, 2, 3}};
    const std::vector<Triangle> around = triangles_near(std::span(&plate, 1), Vec3::Zero(), 0.5);
    EXPECT_EQ(around.size(), 2U);
    const HandView view = choose_hand_view(finger, Quat::Identity(), around, 0.4);
    EXPECT_LT(view.towards.y(), 0.1);
    EXPECT_NEAR(view.center.y(), -0.02, 1e-12);
    // Without obstacles the view is from above.
    EXPECT_GT(choose_hand_view(finger, Quat::Identity(), {}, 0.4).towards.y(), 0.0);
}

TEST(HandViewpoint, IgnoresFarTriangles) {
    Mesh plate;
    plate.positions = {Vec3(5, 0, 0), Vec3(6, 0, 0), Vec3(5, 1, 0)};
    plate.triangles = {{0, 1, 2}};
    EXPECT_TRUE(triangles_near(std::span(&plate, 1), Vec3::Zero(), 1.0).empty());
}

}  // namespace
}  // namespace handhold::lab::hands_picture_test
