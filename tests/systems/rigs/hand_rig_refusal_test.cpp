// Hands that cannot be fitted, and the reasons that the errors give.
#include <functional>
#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "systems/rigs/builtin_hand_rig.hpp"
#include "systems/rigs/hand_rig_fit.hpp"
#include "tests/random.hpp"
#include "tests/systems/hand/tube_hand.hpp"

namespace handhold::hand_rig_refusal_test {
namespace {

using test::make_tube_hand;
using test::Random;
using test::relaxed;

const Pose k_somewhere{Vec3(3.0, -1.0, 2.0), rotation_about(Vec3(1.0, 2.0, -2.0) / 3.0, 1.1)};

struct BadHand {
    const char* what;
    const char* says;  // a part of the error
    std::function<void(SkinnedMesh&)> spoil;
};
void PrintTo(const BadHand& hand, std::ostream* stream) { *stream << hand.what; }

void rename(SkinnedMesh& skin, const std::string& from, const char* to) {
    for (SkinJoint& joint : skin.joints) {
        if (joint.name == from) {
            joint.name = to;
            return;
        }
    }
    FAIL() << from;
}

const BadHand k_bad_hands[] = {
    {"no wrist", "missing: wrist", [](SkinnedMesh& s) { rename(s, "wrist", "root"); }},
    {"two tips gone", "missing: index-finger-tip, pinky-finger-tip",
     [](SkinnedMesh& s) {
         rename(s, "index-finger-tip", "a");
         rename(s, "pinky-finger-tip", "b");
     }},
    {"one bone", "missing: ring-finger-phalanx-distal",
     [](SkinnedMesh& s) {
         rename(s, "ring-finger-phalanx-intermediate", "a");
         rename(s, "ring-finger-phalanx-distal", "b");
     }},
    {"a joint twice", "found \"thumb-tip\" again",
     [](SkinnedMesh& s) { rename(s, "index-finger-tip", "thumb-tip"); }},
    {"no names", "missing: wrist",
     [](SkinnedMesh& s) {
         for (SkinJoint& joint : s.joints) {
             joint.name.clear();
         }
     }},
    {"a bone of no length", "expected bones of at least 4 mm",
     [](SkinnedMesh& s) { s.joints[3].bind_ms = s.joints[2].bind_ms; }},
    {"a giant", "expected a hand of 0.05 to 1 m",
     [](SkinnedMesh& s) {
         for (SkinJoint& joint : s.joints) {
             joint.bind_ms.position *= 100.0;
         }
     }},
};

class MalformedHand : public ::testing::TestWithParam<BadHand> {};

TEST_P(MalformedHand, IsRefusedWithItsReason) {
    const HandRig rig = builtin_hand_rig(HandSide::right);
    SkinnedMesh skin = make_tube_hand(rig, relaxed(rig), {});
    GetParam().spoil(skin);
    const Result<HandRig> found = hand_rig_from_skin(skin, HandSide::right);
    ASSERT_FALSE(found.ok());
    EXPECT_NE(found.error().message().find(GetParam().says), std::string::npos)
        << found.error().message();
}
INSTANTIATE_TEST_SUITE_P(Hands, MalformedHand, ::testing::ValuesIn(k_bad_hands));

// For any joint axes.
TEST(HandRigFit, RefusesAHandOfTheOtherSide) {
    Random random(13);
    const HandRig rig = builtin_hand_rig(HandSide::right);
    SkinnedMesh skin = make_tube_hand(rig, relaxed(rig), k_somewhere);
    for (int i = 0; i < 20; ++i) {
        const Result<HandRig> found = hand_rig_from_skin(skin, HandSide::left);
        ASSERT_FALSE(found.ok());
        EXPECT_NE(found.error().expected.find("expected a left hand"), std::string::npos);
        for (SkinJoint& joint : skin.joints) {
            joint.bind_ms.rotation = random.rotation();
        }
    }
}

}  // namespace
}  // namespace handhold::hand_rig_refusal_test
