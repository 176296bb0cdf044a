// The tables that OpenXR is given, without OpenXR: names and paths as its specification allows.
#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include <gtest/gtest.h>

#include "game/xr/bindings.hpp"
#include "game/xr/session_phase.hpp"

namespace handhold::headset_bindings_test {
namespace {

bool is_lower(char c) {
    constexpr std::string_view k_other = "0123456789-_.";
    return (c >= 'a' && c <= 'z') || k_other.find(c) != std::string_view::npos;
}

TEST(HeadsetBindings, ActionsStandInTheirOrderWithNamesOfTheirOwn) {
    std::set<std::string_view> names;
    for (std::size_t i = 0; i < k_headset_actions.size(); ++i) {
        EXPECT_EQ(static_cast<std::size_t>(k_headset_actions[i].action), i);
        const std::string_view name = k_headset_actions[i].name;
        EXPECT_TRUE(std::ranges::all_of(name, is_lower)) << name;
        EXPECT_TRUE(names.insert(name).second) << name;
        EXPECT_FALSE(std::string_view(k_headset_actions[i].said).empty());
    }
}

TEST(HeadsetBindings, PathsAreWellFormed) {
    for (const HeadsetProfile& profile : headset_profiles()) {
        EXPECT_TRUE(std::string_view(profile.path).starts_with("/interaction_profiles/"));
        for (const HeadsetBinding& binding : profile.bindings) {
            const std::string_view path = binding.path;
            const ActionKind kind =
                k_headset_actions[static_cast<std::size_t>(binding.action)].kind;
            EXPECT_TRUE(path.starts_with(kind == ActionKind::shake ? "/output/" : "/input/"));
            EXPECT_EQ(path.ends_with("/pose"), kind == ActionKind::pose) << path;
            EXPECT_NE(path.back(), '/');
            EXPECT_TRUE(std::ranges::all_of(path, [](char c) { return is_lower(c) || c == '/'; }));
        }
    }
}

// The specification's list of each profile's components, section "Interaction Profile Paths".
TEST(HeadsetBindings, EveryProfileHasPosesAGrabAndAShakeForBothHands) {
    for (const HeadsetProfile& profile : headset_profiles()) {
        const auto reaches = [&](HeadsetAction action, HeadsetBinding::Hands hand) {
            return std::ranges::any_of(profile.bindings, [&](const HeadsetBinding& binding) {
                return binding.action == action &&
                       (binding.hands == HeadsetBinding::Hands::both || binding.hands == hand);
            });
        };
        for (const auto hand : {HeadsetBinding::Hands::left, HeadsetBinding::Hands::right}) {
            for (const HeadsetAction action :
                 {HeadsetAction::grip_pose, HeadsetAction::aim_pose, HeadsetAction::squeeze,
                  HeadsetAction::calibrate, HeadsetAction::shake}) {
                EXPECT_TRUE(reaches(action, hand))
                    << profile.path << " "
                    << k_headset_actions[static_cast<std::size_t>(action)].name;
            }
        }
    }
}

TEST(HeadsetBindings, NoControlOfAHandDoesTwoThings) {
    for (const HeadsetProfile& profile : headset_profiles()) {
        std::set<std::pair<std::string, int>> seen;
        for (const HeadsetBinding& binding : profile.bindings) {
            for (const int hand : {1, 2}) {
                const int hands = static_cast<int>(binding.hands);
                if (hands == 0 || hands == hand) {
                    EXPECT_TRUE(seen.insert({binding.path, hand}).second)
                        << profile.path << binding.path;
                }
            }
        }
    }
}

TEST(HeadsetBindings, FiveKindsOfControllersAreKnown) {
    std::set<std::string_view> paths;
    for (const HeadsetProfile& profile : headset_profiles()) {
        paths.insert(profile.path);
    }
    EXPECT_EQ(paths,
              (std::set<std::string_view>{"/interaction_profiles/oculus/touch_controller",
                                          "/interaction_profiles/valve/index_controller",
                                          "/interaction_profiles/htc/vive_controller",
                                          "/interaction_profiles/microsoft/motion_controller",
                                          "/interaction_profiles/khr/simple_controller"}));
}

// The specification's life of a session: idle, ready, synchronized, visible, focused and back, then
// stopping, idle, exiting. What a program must answer is begun once and ended once.
TEST(SessionPhase, AWholeLifeBeginsOnceEndsOnceAndLeaves) {
    using enum SessionState;
    int begun = 0;
    int ended = 0;
    bool left = false;
    for (const SessionState state : {idle, ready, synchronized, visible, focused, visible, focused,
                                     visible, synchronized, stopping, idle, exiting}) {
        const SessionDeed deed = deed_on(state);
        begun += deed == SessionDeed::begin ? 1 : 0;
        ended += deed == SessionDeed::end ? 1 : 0;
        EXPECT_LE(ended, begun);
        left = deed == SessionDeed::leave;
        EXPECT_NE(deed, SessionDeed::reopen);
    }
    EXPECT_EQ(begun, 1);
    EXPECT_EQ(ended, 1);
    EXPECT_TRUE(left);
    EXPECT_EQ(deed_on(loss_pending), SessionDeed::reopen);
    EXPECT_EQ(deed_on(unknown), SessionDeed::none);
}

}  // namespace
}  // namespace handhold::headset_bindings_test
