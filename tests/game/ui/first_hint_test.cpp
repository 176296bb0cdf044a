#include "game/ui/first_hint.hpp"

#include <string>

#include <gtest/gtest.h>

namespace handhold::first_hint_test {
namespace {

constexpr double k_dt_s = 1.0 / 90.0;
constexpr FirstHint::Seen k_nothing{};
constexpr FirstHint::Seen k_green{.can_reach = true};
constexpr FirstHint::Seen k_gripping{.can_reach = true, .grips = true};
constexpr FirstHint::Seen k_pulling{.can_reach = true, .grips = true, .moved_m = 0.01};

std::string said_after(FirstHint& hint, const FirstHint::Seen& seen, int frames) {
    for (int frame = 0; frame < frames; ++frame) {
        hint.advance(seen, k_dt_s);
    }
    return hint.text();
}

bool names(const std::string& text, const char* word) {
    return text.find(word) != std::string::npos;
}

TEST(FirstHint, EachLineSaysWhatComesNext) {
    FirstHint hint;
    EXPECT_TRUE(names(said_after(hint, k_nothing, 1), "Look"));
    EXPECT_TRUE(names(said_after(hint, k_green, 1), "mouse button"));
    EXPECT_TRUE(names(said_after(hint, k_nothing, 1), "Look"));  // the mark is white again
    EXPECT_TRUE(names(said_after(hint, k_gripping, 1), "pull"));
    EXPECT_TRUE(names(said_after(hint, k_green, 1), "mouse button"));  // let go too early
    EXPECT_TRUE(names(said_after(hint, k_pulling, 60), "Let go"));
}

// However long it takes: only who has pulled needs no hint.
TEST(FirstHint, StaysUntilSomebodyHasPulled) {
    FirstHint hint;
    EXPECT_TRUE(names(said_after(hint, k_nothing, 6000), "Look"));
    EXPECT_TRUE(names(said_after(hint, k_green, 6000), "mouse button"));
    EXPECT_TRUE(names(said_after(hint, k_gripping, 6000), "pull"));
    // Way of several grips does not add up, and floating is no pull.
    for (int grip = 0; grip < 20; ++grip) {
        EXPECT_TRUE(names(said_after(hint, k_pulling, 10), "pull"));
        EXPECT_TRUE(names(said_after(hint, {.moved_m = 0.5}, 10), "Look"));
    }
}

TEST(FirstHint, GoesAwayForGood) {
    FirstHint hint;
    ASSERT_TRUE(names(said_after(hint, k_pulling, 60), "Let go"));
    EXPECT_TRUE(names(said_after(hint, k_nothing, 90), "Let go"));  // long enough to be read
    EXPECT_EQ(said_after(hint, k_nothing, 900), "");
    EXPECT_EQ(said_after(hint, k_green, 900), "");
    EXPECT_EQ(said_after(hint, k_pulling, 900), "");
}

}  // namespace
}  // namespace handhold::first_hint_test
