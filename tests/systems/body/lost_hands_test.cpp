// Hands that are lost or were never tracked: one, both, from the start, for 0.2 to 60 s, while they
// grip, or left behind while the player walks away.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "systems/body/shared/rest_hand.hpp"
#include "tests/random.hpp"
#include "tests/systems/body/body_columns.hpp"

namespace handhold::lost_hands_test {
namespace {

using test::k_left;
using test::k_player;
using test::k_right;
using test::Random;

constexpr double k_longest_way_s = 3.0;  // from a rest pose to any hand within 1.5 m of the eyes
constexpr double k_drawn_most = 1.3;     // drawn length / length of the bones

// A sum of slow waves about a middle.
struct Wave {
    Vec3 middle = Vec3::Zero();
    Vec3 slow = Vec3::Zero();
    Vec3 quick = Vec3::Zero();
    double rate_hz = 0.1;

    static Wave of(Random& random, const Vec3& middle, double size_m) {
        const Vec3 slow = random.vector(size_m);
        const Vec3 quick = random.vector(0.3 * size_m);
        return {middle, slow, quick, random.between(0.03, 0.15)};
    }
    Vec3 at(double t_s) const {
        const double phase = 2.0 * k_pi * rate_hz * t_s;
        return middle + std::sin(phase) * slow + std::sin(4.3 * phase) * quick;
    }
};

// What one hand does: in turns tracked, lost or gripping, each for a random time.
class HandPlan {
  public:
    explicit HandPlan(Random& random) {
        double until_s = 0.0;
        for (int i = 0; i < 12; ++i) {
            // Never tracked if lost at once.
            const double kind = random.between(0.0, 1.0);
            const bool is_lost = kind < 0.55;
            const bool grips = kind > 0.4 && kind < 0.7;
            const double log_s = random.between(std::log(0.2), std::log(i == 5 ? 60.0 : 6.0));
            until_s += std::exp(log_s);
            phases_.push_back({until_s, is_lost, grips && until_s > 1.0});
        }
    }
    bool is_lost(double t_s) const { return at(t_s).is_lost; }
    bool grips(double t_s) const { return at(t_s).grips; }

  private:
    struct Phase {
        double until_s;
        bool is_lost;
        bool grips;
    };
    const Phase& at(double t_s) const {
        for (const Phase& phase : phases_) {
            if (t_s < phase.until_s) {
                return phase;
            }
        }
        return phases_.back();
    }
    std::vector<Phase> phases_;
};

struct Session {
    explicit Session(Random& random)
        : head(Wave::of(random, Vec3(0.0, 1.55, 0.0), 1.2)),
          look(Wave::of(random, Vec3(random.between(-3.0, 3.0), 0.0, 0.0), 1.5)),
          hands{Wave::of(random, Vec3(-0.2, -0.4, -0.3), 0.25),
                Wave::of(random, Vec3(0.2, -0.4, -0.3), 0.25)},
          plans{HandPlan(random), HandPlan(random)} {
        head.slow.y() *= 0.3;  // crouches, hardly hops
    }

    Pose head_at(double t_s) const {
        const Vec3 angles = look.at(t_s);
        return {head.at(t_s), rotation_about(Vec3::UnitY(), angles.x()) *
                                  rotation_about(Vec3::UnitX(), 0.4 * angles.y())};
    }
    // The real hand: moves with the player.
    Pose hand_at(std::size_t side, double t_s) const {
        const Vec3 along = hands[side].at(t_s);
        const Quat turn = rotation_about(Vec3::UnitY(), look.at(t_s).x());
        return {head.at(t_s) + turn * along,
                (turn * rotation_from_vector(2.0 * along)).normalized()};
    }

    Wave head;
    Wave look;
    std::array<Wave, k_hand_count> hands;
    std::array<HandPlan, k_hand_count> plans;
};

struct Player : test::BodyColumns {
    Player() {
        add_player();
        for (const Entity hand : k_hands) {
            tracking.at(hand).state = TrackingState::never;
        }
    }
    static constexpr std::array<Entity, k_hand_count> k_hands = {k_left, k_right};

    // Steps to time t_s as read_tracking and fit_hands would: lost hands are frozen.
    void step(const Session& session, double now_s, double dt_s) {
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            HandTracking& now = tracking.at(k_hands[side]);
            const bool is_lost = session.plans[side].is_lost(now_s);
            if (!is_lost) {
                now.state = TrackingState::tracked;
                now.pose_ps = session.hand_at(side, now_s);
            } else if (now.state != TrackingState::never) {
                now.state = TrackingState::lost;
            }
            const bool grips =
                session.plans[side].grips(now_s) && now.state != TrackingState::never;
            grab.at(k_hands[side]).kind = grips ? GripKind::surface : GripKind::none;
        }
        place(session.head_at(now_s), tracking.at(k_left).pose_ps, tracking.at(k_right).pose_ps);
        estimate_arms(dt_s);
        pose_arms();
    }
    bool is_away(std::size_t side) const { return arm_memory.at(k_player).arms[side].rest.is_away; }
    const Pose& shown(std::size_t side) const { return palm.at(k_hands[side]).pose_ws; }
    double drawn_ratio(std::size_t side) const {
        const ArmPose::Arm& arm = arm_pose.at(k_player).arms[side];
        const double drawn_m = (arm.forearm_ws.position - arm.upper_ws.position).norm() +
                               (arm.hand_ws.position - arm.forearm_ws.position).norm();
        const BodyMeasures& own = measures.at(k_player);
        return drawn_m / (own.upper_arm_m + own.forearm_m);
    }
};

bool is_same(const Pose& a, const Pose& b) {
    return a.position == b.position && a.rotation.coeffs() == b.rotation.coeffs();
}

// Away or on the way back a hand moves no faster than the player's view, the tracked hand and
// k_rest_speed_mps allow. Hands that grip, and hands that have been back for a while, are exact.
RC_GTEST_PROP(LostHands, RestAtABoundedRateAndNeverStretchTheirArms, ()) {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    const Session session(random);
    Player player;
    BodyMeasures& own = player.measures.at(k_player);
    own.upper_arm_m = random.between(0.2, 0.35);
    own.forearm_m = random.between(0.2, 0.35);
    const double hz = random.between(30.0, 144.0);
    std::array<double, k_hand_count> exact_from_s = {0.0, 0.0};
    std::size_t away = 0;
    std::size_t returning = 0;
    std::size_t gripping = 0;
    for (int frame = 1; frame < static_cast<int>(40.0 * hz); ++frame) {
        const double t_s = frame / hz;
        const Player before = player;
        player.step(session, t_s, 1.0 / hz);
        const ArmMemory& then = before.arm_memory.at(k_player);
        const double look_turn =
            2.0 * (session.look.at(t_s) - session.look.at(t_s - 2.0 / hz)).norm();
        const double head_m = (session.head_at(t_s).position - then.head_ps.position).norm();
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            const Entity hand = Player::k_hands[side];
            const Pose& given = player.tracking.at(hand).pose_ps;
            const Pose& shown = player.shown(side);
            RC_ASSERT(is_finite(shown.position));
            const bool grips = player.grab.at(hand).kind != GripKind::none;
            if (grips) {
                ++gripping;
                RC_ASSERT(is_same(shown, given));
            }
            if (player.is_away(side)) {
                ++away;
                RC_ASSERT(!grips);
                RC_ASSERT(player.drawn_ratio(side) <= k_drawn_most);
                exact_from_s[side] = t_s + k_longest_way_s;
            } else if (t_s > exact_from_s[side]) {
                RC_ASSERT(is_same(shown, given));
            } else if (!grips && !is_same(shown, given)) {
                ++returning;
            }
            // Such an arm was too long when its hand was lost, and is pulled in at once.
            const bool is_pulled_in = player.is_away(side) && player.drawn_ratio(side) > 1.001;
            if (frame > 1 && !grips && !is_pulled_in) {
                const double given_m =
                    (given.position - before.tracking.at(hand).pose_ps.position).norm();
                const double jumped =
                    then.arms[side].rest.is_away == player.is_away(side) ? 0.0 : 1.0;
                const double most_m =
                    k_rest_speed_mps / hz + given_m * (1.0 - jumped) + head_m + 1.6 * look_turn;
                RC_ASSERT((shown.position - before.shown(side).position).norm() < most_m + 1e-6);
            }
        }
    }
    RC_TAG(away > 0);
    RC_TAG(returning > 0);
    RC_TAG(gripping > 0);
}

// Two players differ only in the place where one hand was lost, or whether it was ever tracked.
RC_GTEST_PROP(LostHands, ThePlaceOfTheLossTurnsNobody, ()) {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    const Session session(random);
    const std::size_t lost = random.between(0.0, 1.0) < 0.5 ? 0.0 : 1.0;
    const bool both = random.between(0.0, 1.0) < 0.3;
    const bool never = random.between(0.0, 1.0) < 0.3;
    const double hz = random.between(45.0, 120.0);
    const Vec3 elsewhere = random.vector(0.5);
    std::array<Player, 2> players;
    for (int frame = 1; frame < static_cast<int>(8.0 * hz); ++frame) {
        const double t_s = frame / hz;
        const double lost_s = 1.5;
        for (std::size_t i = 0; i < players.size(); ++i) {
            Player& player = players[i];
            for (std::size_t side = 0; side < k_hand_count; ++side) {
                HandTracking& now = player.tracking.at(Player::k_hands[side]);
                const bool is_one = side == lost || both;
                const bool is_never = i == 1 && is_one && never;
                if (!is_one || (t_s < lost_s && !is_never)) {
                    now.state = TrackingState::tracked;
                    now.pose_ps = session.hand_at(side, t_s);
                    if (is_one && i == 1) {
                        now.pose_ps.position += elsewhere;
                    }
                } else if (now.state == TrackingState::tracked) {
                    now.state = TrackingState::lost;
                }
            }
            player.place(session.head_at(t_s), player.tracking.at(k_left).pose_ps,
                         player.tracking.at(k_right).pose_ps);
            player.estimate_arms(1.0 / hz);
            player.pose_arms();
        }
        if (t_s > lost_s + 3.0) {
            const Vec3& a = players[0].estimate.at(k_player).facing_ps;
            const Vec3& b = players[1].estimate.at(k_player).facing_ps;
            RC_ASSERT((a - b).norm() < 1e-3);
            RC_ASSERT((players[0].shown(lost).position - players[1].shown(lost).position).norm() <
                      1e-6);
        }
    }
}

TEST(LostHands, InferredHandsAreShownAsGiven) {
    Random random(3);
    const Session session(random);
    Player player;
    for (int frame = 1; frame < 400; ++frame) {
        const double t_s = frame / 90.0;
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            HandTracking& now = player.tracking.at(Player::k_hands[side]);
            now.pose_ps = session.hand_at(side, t_s);
            now.state = TrackingState::inferred;
        }
        player.place(session.head_at(t_s), player.tracking.at(k_left).pose_ps,
                     player.tracking.at(k_right).pose_ps);
        player.estimate_arms(1.0 / 90.0);
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            ASSERT_TRUE(is_same(player.shown(side), session.hand_at(side, t_s)));
        }
    }
}

// On the back and on the side: beside the trunk and above the floor, not where a standing player's
// hand would hang.
TEST(LostHands, RestHandsOfPlayersWhoLieAreOnTheFloor) {
    for (const double turn : {0.5 * k_pi, -0.5 * k_pi}) {
        for (const Vec3& axis : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitZ())}) {
            Player player;
            const Quat lies = rotation_about(axis, turn);
            const Pose head{Vec3(0.0, 0.2, 0.0), lies};
            player.place(head, {}, {});
            for (int i = 0; i < 5; ++i) {
                player.estimate_arms(1.0 / 90.0);
                player.pose_arms();
            }
            for (std::size_t side = 0; side < k_hand_count; ++side) {
                EXPECT_GT(player.shown(side).position.y(), 0.05);
                EXPECT_LT(player.drawn_ratio(side), k_drawn_most);
            }
        }
    }
}

}  // namespace
}  // namespace handhold::lost_hands_test
