#include "engine/geometry/disc_contact.hpp"

#include <cstdlib>
#include <iostream>
#include <optional>

#include <gtest/gtest.h>

#include "disc_oracle.hpp"
#include "tests/engine/allocation_count.hpp"

namespace handhold::disc_contact_test {
namespace {

using test::ClosingOracle;
using test::Random;

int case_count() {
    const char* const text = std::getenv("HANDHOLD_CHAIN_CASES");
    return text != nullptr ? std::atoi(text) : 20000;
}

// All angles at which a one-link chain (a stadium about the origin) just touches the segment, in
// closed form. A corner of the segment touches the link's side or its round end; the segment's
// interior touches the round end. Drops angles at which another part overlaps. Returns the first
// touch as a closing fraction.
std::optional<double> first_touch_of_one_hinge(const DiscChain& chain, const DiscSegment& segment) {
    const double length_m = chain.length_m[0];
    const double radius_m = chain.radius_m[segment.plane][0];
    std::vector<double> angles;
    const auto add_about = [&](double middle, double cosine) {
        if (std::abs(cosine) <= 1.0) {
            angles.push_back(middle + std::acos(cosine));
            angles.push_back(middle - std::acos(cosine));
        }
    };
    for (const Vec2& corner : {segment.a_ds, segment.b_ds}) {
        const double far_m = corner.norm();
        const double middle = std::atan2(corner.y(), corner.x());
        add_about(middle, (length_m * length_m + far_m * far_m - radius_m * radius_m) /
                              (2.0 * length_m * far_m));
        if (far_m >= radius_m) {
            angles.push_back(middle - std::asin(radius_m / far_m));
            angles.push_back(middle + std::asin(radius_m / far_m));
        }
    }
    const Vec2 along = (segment.b_ds - segment.a_ds).normalized();
    const Vec2 normal(-along.y(), along.x());
    for (const double side : {-1.0, 1.0}) {
        add_about(std::atan2(normal.y(), normal.x()),
                  (normal.dot(segment.a_ds) + side * radius_m) / length_m);
    }
    std::optional<double> first;
    const double range_rad = chain.closed_rad[0] - chain.open_rad[0];
    for (const double angle : angles) {
        for (const double whole_turn : {-2.0 * M_PI, 0.0, 2.0 * M_PI}) {
            const double at = (angle + whole_turn - chain.open_rad[0]) / range_rad;
            const ClosingOracle oracle{chain};
            if (at > 0.0 && at <= 1.0 && at < first.value_or(2.0) &&
                std::abs(oracle.separation_m(0, segment, at)) < 1e-9) {
                first = at;
            }
        }
    }
    return first;
}

struct Tally {
    double worst_depth_m = 0.0;    // of a link in a segment during the motion
    double worst_early_m = 0.0;    // gap between a link and the segment that stopped it
    double worst_tip_m = 0.0;      // error of the stopped link's end, firm contacts only
    double worst_any_tip_m = 0.0;  // the same for all contacts
    int firm = 0;
    int contacts = 0;
    int far_tips = 0;
    int missed = 0;
};

// Steps from `from` to `to` and bisects the first step in which a link comes nearer than `gap_m`.
std::optional<double> first_nearer(const ClosingOracle& oracle,
                                   std::span<const DiscSegment> segments, double from, double to,
                                   double gap_m) {
    constexpr int k_steps = 160;
    double before = from;
    for (int i = 1; i <= k_steps; ++i) {
        double after = from + (to - from) * i / k_steps;
        if (oracle.min_separation_m(segments, after) < gap_m) {
            for (int halving = 0; halving < 50; ++halving) {
                const double middle = 0.5 * (before + after);
                (oracle.min_separation_m(segments, middle) < gap_m ? after : before) = middle;
            }
            return after;
        }
        before = after;
    }
    return std::nullopt;
}

// Approach speed of the nearest link relative to the speed of the link's end.
double firmness(const ClosingOracle& oracle, std::span<const DiscSegment> segments,
                std::size_t link, double at) {
    constexpr double k_step = 1e-6;
    const double approach_m =
        oracle.min_separation_m(segments, at - k_step) - oracle.min_separation_m(segments, at);
    const Vec2 motion = oracle.points_at(at)[link + 1] - oracle.points_at(at - k_step)[link + 1];
    return approach_m / motion.norm();
}

// Compares the end of the stopped link with the oracle's. A contact is firm if the approach speed
// is at least half the end's speed. A grazing contact has no sharp angle: a rounding error decides
// whether it touches.
void compare_tips(const ClosingOracle& oracle, std::span<const DiscSegment> segments,
                  std::size_t link, double at, double from, Tally& tally) {
    const auto exact = first_nearer(oracle, segments, from, 1.0, 0.0);
    if (!exact) {
        return;
    }
    const double tip_m =
        (oracle.points_at(at)[link + 1] - oracle.points_at(*exact)[link + 1]).norm();
    ++tally.contacts;
    tally.far_tips += tip_m > k_disc_accuracy_m ? 1 : 0;
    tally.worst_any_tip_m = std::max(tally.worst_any_tip_m, tip_m);
    constexpr double k_firm_share = 0.5;
    if (firmness(oracle, segments, link, at) > k_firm_share &&
        firmness(oracle, segments, link, *exact) > k_firm_share) {
        ++tally.firm;
        tally.worst_tip_m = std::max(tally.worst_tip_m, tip_m);
    }
}

// Replays the closure stop by stop. A segment that overlaps a link at the beginning of an interval
// (the next link at a hinge that just touched) is left out there.
void replay(const DiscChain& chain, std::span<const DiscSegment> segments,
            const DiscClosure& closure, Tally& tally) {
    ClosingOracle oracle{chain};
    double from = 0.0;
    while (oracle.first_free_hinge < chain.link_count) {
        std::size_t stopped = oracle.first_free_hinge;
        while (stopped < chain.link_count && (closure.touching >> stopped & 1U) == 0) {
            ++stopped;
        }
        const bool touches = stopped < chain.link_count;
        const std::size_t hinge = oracle.first_free_hinge;
        const double at = touches ? (closure.angle_rad[hinge] - chain.open_rad[hinge]) /
                                        (chain.closed_rad[hinge] - chain.open_rad[hinge])
                                  : 1.0;
        std::vector<DiscSegment> clear;
        for (const DiscSegment& segment : segments) {
            if (oracle.min_separation_m({&segment, 1}, from) > 2.0 * k_disc_accuracy_m) {
                clear.push_back(segment);
            }
        }
        const auto penetrating = first_nearer(oracle, clear, from, at, -k_disc_accuracy_m);
        tally.missed += penetrating ? 1 : 0;
        tally.worst_depth_m = std::max(tally.worst_depth_m, -oracle.min_separation_m(clear, at));
        if (touches) {
            double gap_m = std::numeric_limits<double>::infinity();
            for (const DiscSegment& segment : segments) {
                gap_m = std::min(gap_m, oracle.separation_m(stopped, segment, at));
            }
            tally.worst_early_m = std::max(tally.worst_early_m, gap_m);
            if (clear.size() == segments.size()) {
                compare_tips(oracle, clear, stopped, at, from, tally);
            }
        }
        const std::size_t last = touches ? stopped : chain.link_count - 1;
        for (std::size_t i = oracle.first_free_hinge; i <= last; ++i) {
            oracle.frozen_rad[i] = closure.angle_rad[i];
            EXPECT_NEAR(closure.angle_rad[i],
                        chain.open_rad[i] + at * (chain.closed_rad[i] - chain.open_rad[i]), 1e-12);
        }
        oracle.first_free_hinge = last + 1;
        from = at;
    }
}

TEST(DiscDistance, MatchesClosedFormWithinHalfMicrometre) {
    Random random(1401);
    for (int i = 0; i < 20000; ++i) {
        const auto point = [&] {
            return Vec2{random.between(-0.3, 0.3), random.between(-0.3, 0.3)};
        };
        const Vec2 a0 = point();
        const Vec2 b0 = point();
        const double size = std::pow(10.0, random.between(-4.0, 0.0));
        const Vec2 a1 = a0 + size * point();
        const Vec2 b1 = b0 + point();
        ASSERT_NEAR(disc_distance(a0, a1, b0, b1), test::exact_distance(a0, a1, b0, b1), 5e-7)
            << a0.transpose() << ", " << a1.transpose() << "; " << b0.transpose() << ", "
            << b1.transpose();
    }
}

TEST(CloseChain, SingleHingeStopsAtClosedFormAngle) {
    Random random(1402);
    int contacts = 0;
    int firm = 0;
    for (int i = 0; i < case_count(); ++i) {
        DiscChain chain = test::random_chain(random);
        chain.link_count = 1;
        const DiscSegment segment =
            test::random_clear_segments(chain, 2.0 * k_disc_accuracy_m, random).front();
        if (chain.radius_m[segment.plane][0] < 0.0) {
            continue;
        }
        DiscScratch scratch;
        const DiscClosure closure = close_chain(chain, {&segment, 1}, {}, scratch);
        const auto exact = first_touch_of_one_hinge(chain, segment);
        const double at =
            (closure.angle_rad[0] - chain.open_rad[0]) / (chain.closed_rad[0] - chain.open_rad[0]);
        const ClosingOracle oracle{chain};
        ASSERT_GT(oracle.separation_m(0, segment, at), -k_disc_accuracy_m) << "case " << i;
        if (closure.contact_link == DiscClosure::k_none) {
            // A grazing contact shallower than the tolerance may be missed.
            const double deepest_at = std::min(exact.value_or(1.0) + 1e-3, 1.0);
            ASSERT_TRUE(!exact || oracle.separation_m(0, segment, deepest_at) > -k_disc_accuracy_m)
                << "case " << i << " is to touch at " << *exact;
            continue;
        }
        ++contacts;
        ASSERT_LT(oracle.separation_m(0, segment, at), k_disc_accuracy_m) << "case " << i;
        const Vec2 tip = oracle.points_at(at)[1];
        const double exact_at = exact.value_or(at);
        const double rise = oracle.separation_m(0, segment, exact_at - 1e-6) / 1e-6;
        const double speed = chain.length_m[0] * (chain.closed_rad[0] - chain.open_rad[0]);
        if (rise > 0.5 * speed) {
            ++firm;
            ASSERT_LT((tip - oracle.points_at(exact_at)[1]).norm(), k_disc_accuracy_m)
                << "case " << i;
        }
    }
    EXPECT_GT(contacts, case_count() / 50);
    EXPECT_GT(firm, contacts / 2);
}

TEST(CloseChain, StopsWhereBisectionStopsAndMissesNoContact) {
    Random random(1403);
    Tally tally;
    DiscScratch scratch;
    for (int i = 0; i < case_count(); ++i) {
        const DiscChain chain = test::random_chain(random);
        const auto segments = test::random_clear_segments(chain, 2.0 * k_disc_accuracy_m, random);
        replay(chain, segments, close_chain(chain, segments, {}, scratch), tally);
    }
    std::cout << "contacts " << tally.contacts << ", firm " << tally.firm << ", tips off by more "
              << "than 0.05 mm " << tally.far_tips << ", worst " << 1e3 * tally.worst_any_tip_m
              << " mm; firm ones " << 1e3 * tally.worst_tip_m << " mm; penetrating "
              << 1e3 * tally.worst_depth_m << " mm, early " << 1e3 * tally.worst_early_m
              << " mm, missed " << tally.missed << "\n";
    RecordProperty("worst_tip_mm", std::to_string(1e3 * tally.worst_tip_m));
    EXPECT_GT(tally.firm, case_count() / 4);
    EXPECT_EQ(tally.missed, 0);
    EXPECT_LT(tally.worst_depth_m, k_disc_accuracy_m);
    EXPECT_LT(tally.worst_early_m, k_disc_accuracy_m);
    EXPECT_LT(tally.worst_tip_m, k_disc_accuracy_m);
}

TEST(CloseChain, IndependentOfSegmentOrder) {
    Random random(1404);
    DiscScratch scratch;
    for (int i = 0; i < 2000; ++i) {
        const DiscChain chain = test::random_chain(random);
        auto segments = test::random_clear_segments(chain, -1.0, random);
        const DiscClosure before = close_chain(chain, segments, {}, scratch);
        std::shuffle(segments.begin(), segments.end(), random.engine());
        const DiscClosure after = close_chain(chain, segments, {}, scratch);
        ASSERT_EQ(before.angle_rad, after.angle_rad) << "case " << i;
        ASSERT_EQ(before.contact_link, after.contact_link);
        ASSERT_EQ(before.touching, after.touching);
    }
}

// One link, 10 cm long and of 1 cm radius, that turns from +X to +Y.
DiscChain quarter_turn() {
    DiscChain chain;
    chain.link_count = 1;
    chain.length_m = {0.1};
    for (auto& radius_m : chain.radius_m) {
        radius_m = {0.01};
    }
    chain.closed_rad = {M_PI / 2.0};
    return chain;
}

TEST(CloseChain, IgnoresOverlapThatMovesApart) {
    const DiscChain chain = quarter_turn();
    const std::vector<DiscSegment> below = {{{0.03, -0.006}, {0.09, -0.006}, 0, 7}};
    DiscScratch scratch;
    const DiscClosure closure = close_chain(chain, below, {}, scratch);
    EXPECT_EQ(closure.contact_link, DiscClosure::k_none);
    EXPECT_EQ(closure.touching, 0U);
    EXPECT_DOUBLE_EQ(closure.angle_rad[0], M_PI / 2.0);
}

// Deepening is checked in 64 steps of the closing, so that it may deepen slightly in between.
TEST(CloseChain, IgnoresOverlapOnlyWhileItDoesNotDeepen) {
    Random random(1406);
    DiscScratch scratch;
    double worst_m = 0.0;
    int overlapping = 0;
    while (overlapping < 3000) {
        const DiscChain chain = test::random_chain(random);
        const DiscSegment segment = test::random_segment(random);
        const ClosingOracle oracle{chain};
        const double before_m = oracle.min_separation_m({&segment, 1}, 0.0);
        if (before_m > -2e-4 || before_m < -4e-3) {
            continue;
        }
        ++overlapping;
        const DiscClosure closure = close_chain(chain, {&segment, 1}, {}, scratch);
        const double stop =
            (closure.angle_rad[0] - chain.open_rad[0]) / (chain.closed_rad[0] - chain.open_rad[0]);
        for (int i = 0; i <= 400; ++i) {
            const double min_m = oracle.separation_m(0, segment, stop * i / 400.0);
            const double first_m = oracle.separation_m(0, segment, 0.0);
            worst_m = std::max(worst_m, std::min(first_m, 0.0) - min_m);
        }
    }
    EXPECT_LT(worst_m, 3e-4);
}

TEST(CloseChain, StopsAtOverlapThatDeepens) {
    const DiscChain chain = quarter_turn();
    const std::vector<DiscSegment> above = {{{0.03, 0.006}, {0.09, 0.006}, 0, 7}};
    DiscScratch scratch;
    const DiscClosure closure = close_chain(chain, above, {}, scratch);
    EXPECT_EQ(closure.contact_link, 0);
    EXPECT_EQ(closure.segment, 0U);
    EXPECT_EQ(closure.angle_rad[0], 0.0);
}

TEST(CloseChain, IgnoredSegmentStopsChainOnceItHasSeparated) {
    // The link turns almost a full circle: out of the segment below it, and into it again from the
    // other side.
    DiscChain chain = quarter_turn();
    chain.closed_rad = {6.2};
    const std::vector<DiscSegment> below = {{{0.05, -0.009}, {0.05, -0.03}, 0, 7}};
    DiscScratch scratch;
    const DiscClosure closure = close_chain(chain, below, {}, scratch);
    EXPECT_EQ(closure.contact_link, 0);
    // From that side it first touches the far corner (0.05, -0.03).
    const double far_m = std::hypot(0.05, 0.03);
    const double exact = 2.0 * M_PI - std::atan2(0.03, 0.05) - std::asin(0.01 / far_m);
    EXPECT_NEAR(0.1 * closure.angle_rad[0], 0.1 * exact, k_disc_accuracy_m);
}

TEST(CloseChain, LinksBeyondFirstContactGoOnClosing) {
    // A wall stops the first of two links at 45 degrees; the second closes unhindered.
    DiscChain chain = quarter_turn();
    chain.link_count = 2;
    chain.length_m = {0.05, 0.03};
    for (auto& radius_m : chain.radius_m) {
        radius_m = {0.008, 0.006};
    }
    chain.closed_rad = {M_PI / 2.0, M_PI / 2.0};
    // Point that the first link's side reaches at 45 degrees.
    const Vec2 side(-std::sqrt(0.5), std::sqrt(0.5));
    const Vec2 corner = 0.03 * Vec2(std::sqrt(0.5), std::sqrt(0.5)) + 0.008 * side;
    const std::vector<DiscSegment> wall = {{corner, corner + 0.02 * side, 1, 3}};
    DiscScratch scratch;
    const DiscClosure closure = close_chain(chain, wall, {}, scratch);
    EXPECT_EQ(closure.touching, 1U);
    EXPECT_NEAR(0.05 * closure.angle_rad[0], 0.05 * M_PI / 4.0, k_disc_accuracy_m);
    EXPECT_DOUBLE_EQ(closure.angle_rad[1], M_PI / 2.0);
}

TEST(CloseChain, PlaneThatMissesLinkDoesNotStopIt) {
    DiscChain chain = quarter_turn();
    chain.radius_m[2][0] = -1.0;
    const std::vector<DiscSegment> wall = {{{-0.02, 0.05}, {0.2, 0.05}, 2, 0}};
    DiscScratch scratch;
    EXPECT_EQ(close_chain(chain, wall, {}, scratch).contact_link, DiscClosure::k_none);
}

TEST(CloseChain, EndsAtEndOfSweep) {
    DiscScratch scratch;
    const DiscClosure closure = close_chain(quarter_turn(), {}, {0.25, 0.5}, scratch);
    EXPECT_DOUBLE_EQ(closure.angle_rad[0], M_PI / 4.0);
}

TEST(CloseChain, AllocatesNothingOnceWarm) {
    if (!counts_allocations()) {
        GTEST_SKIP() << "the sanitizers bring operators of their own";
    }
    Random random(1405);
    DiscScratch scratch;
    const DiscChain chain = test::random_chain(random);
    const auto segments = test::random_clear_segments(chain, 1e-4, random);
    close_chain(chain, segments, {}, scratch);
    const std::size_t before = allocation_count();
    for (int i = 0; i < 10; ++i) {
        close_chain(chain, segments, {}, scratch);
    }
    EXPECT_EQ(allocation_count(), before);
}

}  // namespace
}  // namespace handhold::disc_contact_test
