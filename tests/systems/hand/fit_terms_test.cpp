// The terms of a hand's fit, against the cost that the fit reports and against closed forms.
#include "systems/hand/shared/fit_terms.hpp"

#include <gtest/gtest.h>

#include "beam.hpp"
#include "systems/hand/shared/hand_fit.hpp"
#include "systems/rigs/hand_kinematics.hpp"

namespace handhold::fit_terms_test {
namespace {

using test::FittedHand;
using test::k_right;
using test::k_unlimited_s;
using test::Random;
using test::wrist_with_palm_at;

constexpr std::size_t k_palm = FitTerms::k_palm;

double cost_of(const FitTerms& terms, std::size_t part, FitTerm term) {
    return terms.cost_m2.at(part).at(static_cast<std::size_t>(term));
}

struct FitTermsOfHand : testing::Test {
    GripMesh beam = build_grip_mesh(test::make_beam());
    GripMesh floor = build_grip_mesh(test::make_floor_mesh());
    const HandRig rig = builtin_hand_rig(HandSide::right);

    FingerAngles random_angles(std::size_t f, Random& random) const {
        FingerAngles angles;
        const FingerRig& finger = rig.fingers[f];
        for (std::size_t i = 0; i < finger.link_count; ++i) {
            angles.curl_rad[i] = random.between(finger.lower_rad[i], finger.upper_rad[i]);
        }
        angles.opposition_rad =
            random.between(finger.lower_opposition_rad, finger.upper_opposition_rad);
        return angles;
    }
    // Near the tracked wrist, with digits bent at random.
    HandFitGoal random_goal(const Pose& wrist_bs, Random& random) const {
        HandFitGoal goal;
        const Vec3 moved_m = random.vector(0.02);
        goal.first.wrist_bs = {
            wrist_bs.position + moved_m,
            (wrist_bs.rotation * rotation_about(random.direction(), 0.2)).normalized()};
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            goal.first.fingers[f] = random_angles(f, random);
            goal.touches[f] = random.between(0.0, 1.0) < 0.6;
            goal.is_clear[f] = random.between(0.0, 1.0) < 0.5;
        }
        return goal;
    }
    const GripMesh& random_mesh(Random& random) const {
        return random.between(0.0, 1.0) < 0.5 ? beam : floor;
    }
    Pose random_wrist(Random& random) const {
        const Vec3 up = (Vec3::UnitY() + random.vector(0.5)).normalized();
        return wrist_with_palm_at(rig, Vec3(0.0, 0.01, 0.0) + random.vector(0.02), up);
    }
    static FitTerms terms_of(const FittedHand& hand, const HandFitGoal& goal) {
        return fit_terms(hand.hands.front(), hand.surface.at(k_right), goal, hand.tuning.palm);
    }
};

TEST_F(FitTermsOfHand, TermsSumToTheCostOfTheFit) {
    Random random(2601);
    std::vector<PenaltyRow> rows;
    std::array<int, k_fit_term_count> seen = {};
    for (int i = 0; i < 200; ++i) {
        FittedHand hand{random_mesh(random), random_wrist(random)};
        hand.search();
        HandFitGoal goal = random_goal(hand.hands.front().wrist_bs, random);
        for (const std::int32_t rounds : {0, 6}) {
            goal.rounds = rounds;
            goal.first =
                fit_hand(hand.hands.front(), hand.surface.at(k_right), goal, hand.tuning.palm, rows)
                    .pose;
            goal.rounds = 0;
            const double cost_m2 =
                fit_hand(hand.hands.front(), hand.surface.at(k_right), goal, hand.tuning.palm, rows)
                    .cost;
            const FitTerms terms = terms_of(hand, goal);
            EXPECT_GT(cost_m2, 0.0);
            EXPECT_NEAR(sum_of(terms), cost_m2, 1e-12 * cost_m2) << i;
            for (const FitTerms::Costs& costs : terms.cost_m2) {
                for (std::size_t term = 0; term < k_fit_term_count; ++term) {
                    EXPECT_GE(costs[term], 0.0);
                    seen[term] += costs[term] > 0.0 ? 1 : 0;
                }
            }
        }
    }
    for (std::size_t term = 0; term < k_fit_term_count; ++term) {
        EXPECT_GT(seen[term], 0) << name_of(static_cast<FitTerm>(term));
    }
}

// The shown hand is at its target, so its terms are those of the fit.
TEST_F(FitTermsOfHand, ShownHandHasTheTermsOfItsFit) {
    Random random(2602);
    for (int i = 0; i < 20; ++i) {
        FittedHand hand{random_mesh(random), random_wrist(random)};
        hand.search();
        hand.frame(k_unlimited_s);
        const PalmOffset& offset = hand.offset.at(k_right);
        const auto terms = shown_fit_terms(hand.hands.front(), hand.surface.at(k_right),
                                           hand.palm.at(k_right), hand.pose(), hand.tuning);
        ASSERT_TRUE(terms);
        const Vec3 moved_m =
            hand.palm_center_bs() - transform_point(hand.wrist_bs(), rig.palm_center_hs);
        const double turned_m = 0.05 * offset.shown_turn_rad.norm();  // hand_fit.hpp: arm
        EXPECT_NEAR(cost_of(*terms, k_palm, FitTerm::sync),
                    0.5 * (moved_m.squaredNorm() + turned_m * turned_m), 1e-9)
            << i;
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            EXPECT_EQ(cost_of(*terms, f, FitTerm::sync), 0.0);
        }
    }
}

TEST_F(FitTermsOfHand, HandOnNoSurfaceHasNone) {
    const FittedHand hand(beam, {});
    EXPECT_FALSE(shown_fit_terms(hand.hands.front(), {}, {}, {}, hand.tuning));
}

TEST_F(FitTermsOfHand, ChangeOfOneFingerConcernsItAndItsNeighbours) {
    Random random(2603);
    for (int i = 0; i < 60; ++i) {
        FittedHand hand{random_mesh(random), random_wrist(random)};
        hand.search();
        HandFitGoal goal = random_goal(hand.hands.front().wrist_bs, random);
        const std::size_t changed = 1 + static_cast<std::size_t>(i) % 4;
        const FitTerms before = terms_of(hand, goal);
        goal.first.fingers[changed] = random_angles(changed, random);
        const FitTerms after = terms_of(hand, goal);
        EXPECT_NE(cost_of(after, changed, FitTerm::roll), cost_of(before, changed, FitTerm::roll));
        for (std::size_t part = 0; part < FitTerms::k_part_count; ++part) {
            const bool is_near = part != k_palm && part != 0 &&
                                 std::max(part, changed) - std::min(part, changed) <= 1;
            for (std::size_t term = 0; term < k_fit_term_count; ++term) {
                if (!is_near && static_cast<FitTerm>(term) != FitTerm::overlap) {
                    EXPECT_EQ(after.cost_m2[part][term], before.cost_m2[part][term])
                        << i << ": " << part << ", " << name_of(static_cast<FitTerm>(term));
                }
            }
        }
    }
}

// A finger whose last hinge bends 2/3 as far as the middle one, and that as far as the knuckle.
TEST_F(FitTermsOfHand, EvenlyBentFingersCostNothingForTheirShape) {
    Random random(2604);
    for (int i = 0; i < 30; ++i) {
        FittedHand hand{random_mesh(random), random_wrist(random)};
        hand.search();
        HandFitGoal goal = random_goal(hand.hands.front().wrist_bs, random);
        const double bend_rad = random.between(0.1, 1.0);
        for (std::size_t f = 1; f < rig.fingers.size(); ++f) {
            goal.first.fingers[f] = {{bend_rad, bend_rad, bend_rad * 2.0 / 3.0}, 0.0};
        }
        const FitTerms terms = terms_of(hand, goal);
        for (std::size_t f = 1; f < rig.fingers.size(); ++f) {
            for (const FitTerm term : {FitTerm::roll, FitTerm::couple, FitTerm::alike,
                                       FitTerm::apart, FitTerm::bend, FitTerm::claw}) {
                EXPECT_NEAR(cost_of(terms, f, term), 0.0, 1e-20) << name_of(term);
            }
        }
        goal.first.fingers[2].curl_rad[2] += 0.3;
        EXPECT_GT(cost_of(terms_of(hand, goal), 2, FitTerm::couple), 1e-9);
    }
}

// Straight fingers at a height over the floor. Closed form of hand_fit.hpp: pull(x) / 2 with
// x = height - radius of the last link, g = 3 cm, up to 6 cm.
TEST_F(FitTermsOfHand, TipsArePulledToTheSurface) {
    Random random(2606);
    const auto pull_m2 = [](double gap_m) {
        return gap_m * gap_m / (1.0 + gap_m * gap_m / (0.03 * 0.03));
    };
    int pulled = 0;
    int out_of_reach = 0;
    for (int i = 0; i < 60; ++i) {
        FittedHand hand(floor, wrist_with_palm_at(rig, {0.0, 0.02, 0.0}, Vec3::UnitY()));
        hand.search();
        HandFitGoal goal;
        goal.first.wrist_bs = hand.wrist_bs();
        goal.first.wrist_bs.position.y() += random.between(0.0, 0.08);
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            goal.first.fingers[f] = coupled_angles(rig.fingers[f], random.between(0.0, 0.4));
        }
        const FitTerms terms = terms_of(hand, goal);
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            const FingerRig& finger = rig.fingers[f];
            const Vec3 tip =
                transform_point(goal.first.wrist_bs,
                                finger_points(finger, goal.first.fingers[f])[finger.link_count]);
            const double gap_m = tip.y() - finger.radius_m[finger.link_count - 1];
            if (gap_m < 0.0 || std::abs(gap_m - k_tip_reach_m) < 1e-6) {
                continue;
            }
            const bool is_reached = gap_m < k_tip_reach_m;
            pulled += is_reached ? 1 : 0;
            out_of_reach += is_reached ? 0 : 1;
            const double reach_m = std::min(gap_m, k_tip_reach_m);
            const double of_finger_m2 = is_reached ? pull_m2(gap_m) : 0.0;
            EXPECT_NEAR(cost_of(terms, f, FitTerm::tip),
                        0.5 * (f == 0 ? reach_m * reach_m : of_finger_m2), 1e-9)
                << i << ", digit " << f;
        }
    }
    EXPECT_GT(pulled, 50);
    EXPECT_GT(out_of_reach, 10);
}

// A thumb at a height over the floor, at any angle: its pad costs by how far it is from facing it.
TEST_F(FitTermsOfHand, ThumbsPadFacesTheSurface) {
    Random random(2608);
    constexpr double k_lever2 = 0.05 * 0.05;
    int reached = 0;
    for (int i = 0; i < 60; ++i) {
        FittedHand hand(floor, wrist_with_palm_at(rig, {0.0, 0.02, 0.0}, Vec3::UnitY()));
        hand.search();
        HandFitGoal goal;
        goal.first.wrist_bs = hand.wrist_bs();
        goal.first.wrist_bs.position.y() += random.between(0.0, 0.08);
        goal.first.fingers[0] = random_angles(0, random);
        const FingerRig& thumb = rig.fingers[0];
        const auto frames_hs = finger_link_frames(thumb, goal.first.fingers[0]);
        const Pose last = goal.first.wrist_bs * frames_hs[thumb.link_count - 1];
        const Vec3 tip = transform_point(last, {0.0, 0.0, -thumb.length_m[thumb.link_count - 1]});
        const double gap_m = tip.y() - thumb.radius_m[thumb.link_count - 1];
        if (gap_m < 0.0 || std::abs(gap_m - k_tip_reach_m) < 1e-6) {
            continue;
        }
        const Vec3 pad = last.rotation * -Vec3::UnitY();
        const bool is_reached = gap_m < k_tip_reach_m;
        reached += is_reached ? 1 : 0;
        const double apart2 = is_reached ? (pad + Vec3::UnitY()).squaredNorm() : 4.0;
        EXPECT_NEAR(cost_of(terms_of(hand, goal), 0, FitTerm::pad), 0.5 * 0.05 * k_lever2 * apart2,
                    1e-12);
    }
    EXPECT_GT(reached, 20);
}

// Closed forms of hand_fit.hpp: claw, and the coupling of the thumb's last two hinges.
TEST_F(FitTermsOfHand, ClawsAndHookedThumbsCostWhatTheObjectiveSays) {
    Random random(2607);
    constexpr double k_lever2 = 0.05 * 0.05;
    int claws = 0;
    for (int i = 0; i < 60; ++i) {
        FittedHand hand{random_mesh(random), random_wrist(random)};
        hand.search();
        const HandFitGoal goal = random_goal(hand.hands.front().wrist_bs, random);
        const FitTerms terms = terms_of(hand, goal);
        const auto& thumb = goal.first.fingers[0].curl_rad;
        const double hook_rad = thumb[2] - thumb[1];
        EXPECT_NEAR(cost_of(terms, 0, FitTerm::couple), 0.5 * 0.15 * k_lever2 * hook_rad * hook_rad,
                    1e-12);
        EXPECT_EQ(cost_of(terms, 0, FitTerm::claw), 0.0);
        for (std::size_t f = 1; f < rig.fingers.size(); ++f) {
            const auto& curl_rad = goal.first.fingers[f].curl_rad;
            const double claw_rad =
                std::max(0.0, 0.6 * curl_rad[1] - 20.0 * k_degree - curl_rad[0]);
            claws += claw_rad > 0.0 ? 1 : 0;
            EXPECT_NEAR(cost_of(terms, f, FitTerm::claw),
                        0.5 * 4.0 * k_lever2 * claw_rad * claw_rad, 1e-12);
        }
    }
    EXPECT_GT(claws, 10);
}

// Closed forms of hand_fit.hpp: spread, its range, which shrinks to 40 % while the knuckle bends to
// 90 degrees, and converging neighbours.
TEST_F(FitTermsOfHand, SpreadFingersCostWhatTheObjectiveSays) {
    Random random(2608);
    constexpr double k_lever2 = 0.05 * 0.05;
    int beyond = 0;
    int converging = 0;
    for (int i = 0; i < 60; ++i) {
        FittedHand hand{random_mesh(random), random_wrist(random)};
        hand.search();
        const HandFitGoal goal = random_goal(hand.hands.front().wrist_bs, random);
        const FitTerms terms = terms_of(hand, goal);
        EXPECT_EQ(cost_of(terms, 0, FitTerm::spread), 0.0);
        for (std::size_t f = 1; f < rig.fingers.size(); ++f) {
            const FingerAngles& angles = goal.first.fingers[f];
            const double spread_rad = angles.opposition_rad;
            EXPECT_NEAR(cost_of(terms, f, FitTerm::spread),
                        0.5 * 0.2 * k_lever2 * spread_rad * spread_rad, 1e-15);
            const double bent = std::clamp(angles.curl_rad[0] / (90.0 * k_degree), 0.0, 1.0);
            const double range_rad = 10.0 * k_degree * (1.0 - 0.6 * bent);
            const double beyond_rad = std::max(0.0, std::abs(spread_rad) - range_rad);
            beyond += beyond_rad > 0.0 ? 1 : 0;
            EXPECT_NEAR(cost_of(terms, f, FitTerm::joints),
                        0.5 * 500.0 * k_lever2 * beyond_rad * beyond_rad, 1e-12);
        }
        HandFitGoal authored = goal;
        authored.is_fixed.fill(true);
        const FitTerms kept = terms_of(hand, authored);
        for (std::size_t f = 1; f < rig.fingers.size(); ++f) {
            EXPECT_EQ(cost_of(kept, f, FitTerm::joints), 0.0);
        }
        HandFitGoal parallel = goal;
        for (std::size_t f = 1; f < rig.fingers.size(); ++f) {
            parallel.first.fingers[f].opposition_rad = 0.0;
        }
        const FitTerms before = terms_of(hand, parallel);
        double converging_m2 = 0.0;
        double change_m2 = 0.0;
        for (std::size_t f = 1; f < rig.fingers.size(); ++f) {
            change_m2 += cost_of(terms, f, FitTerm::apart) - cost_of(before, f, FitTerm::apart);
            if (f + 1 < rig.fingers.size()) {
                const double towards_rad =
                    goal.first.fingers[f + 1].opposition_rad - goal.first.fingers[f].opposition_rad;
                const double over_rad = std::max(0.0, towards_rad - 4.0 * k_degree);
                converging += over_rad > 0.0 ? 1 : 0;
                converging_m2 += 0.5 * 500.0 * k_lever2 * over_rad * over_rad;
            }
        }
        EXPECT_NEAR(change_m2, converging_m2, 1e-12);
    }
    EXPECT_GT(beyond, 20);
    EXPECT_GT(converging, 20);
}

// Fits of random hands use their fingers' spread, never leave its range, and seldom cross.
TEST_F(FitTermsOfHand, FitsSpreadFingersWithinTheirLimits) {
    Random random(2609);
    std::vector<PenaltyRow> rows;
    int spread = 0;
    int crossed = 0;
    for (int i = 0; i < 100; ++i) {
        FittedHand hand{random_mesh(random), random_wrist(random)};
        hand.search();
        HandFitGoal goal = random_goal(hand.hands.front().wrist_bs, random);
        goal.rounds = 10;
        for (std::size_t f = 1; f < rig.fingers.size(); ++f) {
            goal.first.fingers[f].opposition_rad = 0.0;  // as a closing leaves them
        }
        const HandFit fit =
            fit_hand(hand.hands.front(), hand.surface.at(k_right), goal, hand.tuning.palm, rows);
        for (std::size_t f = 1; f < rig.fingers.size(); ++f) {
            const FingerAngles& angles = fit.pose.fingers[f];
            const double bent = std::clamp(angles.curl_rad[0] / (90.0 * k_degree), 0.0, 1.0);
            EXPECT_LE(std::abs(angles.opposition_rad), 10.0 * k_degree * (1.0 - 0.6 * bent) + 1e-9);
            spread += std::abs(angles.opposition_rad) > 1.0 * k_degree ? 1 : 0;
            if (f + 1 < rig.fingers.size()) {
                const double converging_rad =
                    fit.pose.fingers[f + 1].opposition_rad - angles.opposition_rad;
                crossed += converging_rad > 6.0 * k_degree ? 1 : 0;
            }
        }
    }
    EXPECT_GT(spread, 40);
    EXPECT_LE(crossed, 6);  // of 300 pairs, beyond what contradicting contacts share out
}

// Straight fingers pressed into the floor: their depth is their radius and what they are lowered.
TEST_F(FitTermsOfHand, PressedFingersNameThePenetration) {
    Random random(2605);
    for (int i = 0; i < 30; ++i) {
        const double lowered_m = random.between(-0.003, 0.003);
        FittedHand hand(floor, wrist_with_palm_at(rig, {0.0, 0.02, 0.0}, Vec3::UnitY()));
        hand.search();
        HandFitGoal goal;
        goal.first.wrist_bs = hand.wrist_bs();
        double knuckle_m = 1.0;
        for (std::size_t f = 1; f < rig.fingers.size(); ++f) {
            goal.first.fingers[f] = coupled_angles(rig.fingers[f], 0.0);
            knuckle_m = std::min(
                knuckle_m, transform_point(hand.wrist_bs(), rig.fingers[f].base_hs.position).y());
        }
        goal.first.wrist_bs.position.y() -= knuckle_m + lowered_m;
        const FitTerms terms = terms_of(hand, goal);
        for (std::size_t f = 1; f < rig.fingers.size(); ++f) {
            EXPECT_LT(terms.gap_m[f], -1e-3) << f;
            EXPECT_EQ(largest_of(terms.cost_m2[f]), FitTerm::penetration) << f;
        }
    }
}

}  // namespace
}  // namespace handhold::fit_terms_test
