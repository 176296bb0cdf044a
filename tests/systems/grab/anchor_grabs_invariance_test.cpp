// The result of anchor_grabs depends neither on the order in which the world lists hands, nor on
// the position of the world.
#include <algorithm>
#include <array>
#include <span>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/systems/grab/anchoring.hpp"

namespace handhold::anchor_grabs_test {
namespace {

using test::distance;

struct HandState {
    GripKind kind;
    GrabPhase phase;
    GrabEdge edge;
};
constexpr HandState k_hand_states[] = {{GripKind::none, GrabPhase::none, GrabEdge::none},
                                       {GripKind::surface, GrabPhase::fresh, GrabEdge::onset},
                                       {GripKind::surface, GrabPhase::holding, GrabEdge::none},
                                       {GripKind::surface, GrabPhase::releasing, GrabEdge::release},
                                       {GripKind::held, GrabPhase::fresh, GrabEdge::onset},
                                       {GripKind::held, GrabPhase::holding, GrabEdge::none},
                                       {GripKind::held, GrabPhase::releasing, GrabEdge::release}};

void set_state(Anchoring& scene, Entity hand, const HandState& state, double edge_at) {
    scene.set_grip(hand, state.kind, state.phase, state.kind == GripKind::held ? k_ship : k_wall,
                   scene.grab.at(hand).anchor_bs);
    scene.set_edge(hand, state.edge, edge_at);
}

// All pairs of hand states, because a hand-over within one frame must not depend on the order of
// hands. Poses at button edges lie beside the straight path, as with real samples. Both edges may
// have the same time.
RC_GTEST_PROP(AnchorGrabs, OrderOfHandsDoesNotMatterInAnyPairOfStates, (std::uint64_t seed)) {
    for (const HandState& left : k_hand_states) {
        for (const HandState& right : k_hand_states) {
            Random random(seed);
            Anchoring forth = random_anchoring(random);
            const double left_at = random.between(0.0, 1.0);
            const bool at_once = random.between(0.0, 1.0) < 0.5;
            const double right_at = at_once ? left_at : random.between(0.0, 1.0);
            const Vec3 bend = random.vector(0.01);
            Random again(seed);
            Anchoring back = random_anchoring(again, {k_right, k_left});
            for (Anchoring* const scene : {&forth, &back}) {
                set_state(*scene, k_left, left, left_at);
                set_state(*scene, k_right, right, right_at);
                scene->hand.at(k_left).edge_ps.position += bend;
                scene->hand.at(k_right).edge_ps.position -= 0.5 * bend;
                const bool led = left.kind == GripKind::held && right.kind == GripKind::held &&
                                 left.phase != GrabPhase::fresh && right.phase != GrabPhase::fresh;
                for (const Entity hand : {k_left, k_right}) {
                    scene->grab.at(hand).two_handed = led && !at_once;
                    scene->grab.at(hand).since_s = hand == k_left ? 1.0 : 1.0 + bend.x();
                }
                scene->run();
            }
            for (const Entity hand : {k_left, k_right}) {
                RC_ASSERT(forth.grab.at(hand).kind == back.grab.at(hand).kind);
                RC_ASSERT(forth.grab.at(hand).phase == back.grab.at(hand).phase);
                RC_ASSERT(forth.grab.at(hand).two_handed == back.grab.at(hand).two_handed);
                RC_ASSERT(distance(forth.grab.at(hand).anchor_bs, back.grab.at(hand).anchor_bs) <
                          1e-12);
                RC_ASSERT(distance(forth.grab.at(hand).target_ps, back.grab.at(hand).target_ps) <
                          1e-12);
            }
            RC_ASSERT(forth.stats.fallbacks == back.stats.fallbacks);
        }
    }
}

// Two players with hands in random states, on a wall and on a ship that is free or attached to a
// hinge. The order of hands must not matter.
RC_GTEST_PROP(AnchorGrabs, OrderOfTwoPlayersHandsDoesNotMatter, (std::uint64_t seed)) {
    constexpr Entity k_other_player = test::entity(20);
    constexpr Entity k_other_left = test::entity(21);
    constexpr Entity k_other_right = test::entity(22);
    struct Listed {
        Entity hand;
        Entity player;
    };
    std::array<Listed, 4> hands = {{{k_left, k_player},
                                    {k_right, k_player},
                                    {k_other_left, k_other_player},
                                    {k_other_right, k_other_player}}};
    Random random(seed);
    const Anchoring poses = random_anchoring(random);
    const Pose other_from = random.pose();
    const Vec3 other_way = random.vector(0.05);
    const bool jointed = random.between(0.0, 1.0) < 0.5;
    std::array<HandState, 4> states;
    std::array<double, 4> edges;
    std::array<Pose, 4> starts;
    std::array<Vec3, 4> ways;
    std::array<bool, 4> resumed;
    for (std::size_t i = 0; i < hands.size(); ++i) {
        states[i] = k_hand_states[static_cast<std::size_t>(random.between(0.0, 6.999))];
        edges[i] = random.between(0.0, 1.0);
        starts[i] = random.pose(0.5);
        ways[i] = random.vector(0.05);
        resumed[i] = random.between(0.0, 1.0) < 0.15;
    }
    const auto anchored = [&](std::span<const std::size_t> order) {
        Anchoring scene({});
        scene.move_player(poses.player_start.at(k_player).pose_ws,
                          poses.origin.at(k_player).pose_ws);
        scene.player_start.add(k_other_player, {other_from});
        scene.origin.add(k_other_player,
                         {Pose{other_from.position + other_way, other_from.rotation}});
        for (const Entity body : {k_wall, k_ship}) {
            scene.move_body(body, poses.body_start.at(body).pose_ws,
                            poses.body_pose.at(body).pose_ws);
        }
        scene.rigid_body.add(k_ship, {BodyKind::free, 5.0, Vec3(0.1, 0.2, 0.3), 0.5});
        if (jointed) {
            Joint& hinge = scene.joint.add(test::entity(30));
            hinge.kind = JointKind::hinge;
            hinge.b = k_ship;
            hinge.frame_a_bs = poses.body_start.at(k_ship).pose_ws;
            scene.joint_state.add(test::entity(30));
        }
        for (const std::size_t i : order) {
            const auto& [hand, player] = hands[i];
            scene.add_hand(player, hand, i % 2 == 0 ? HandSide::left : HandSide::right);
            scene.move_hand(hand, starts[i], {starts[i].position + ways[i], starts[i].rotation});
            scene.hand.at(hand).resumed = resumed[i];
            set_state(scene, hand, states[i], edges[i]);
            scene.grab.at(hand).jointed = jointed && states[i].kind == GripKind::held;
            scene.grab.at(hand).since_s = 1.0 + edges[i];
        }
        scene.run();
        return scene;
    };
    const std::array<std::size_t, 4> forth_order = {0, 1, 2, 3};
    std::array<std::size_t, 4> back_order = {3, 2, 1, 0};
    const auto turns = static_cast<std::ptrdiff_t>(random.between(0.0, 3.999));
    std::rotate(back_order.begin(), back_order.begin() + turns, back_order.end());
    const Anchoring forth = anchored(forth_order);
    const Anchoring back = anchored(back_order);
    for (const Listed& listed : hands) {
        const Grab& one = forth.grab.at(listed.hand);
        const Grab& other = back.grab.at(listed.hand);
        RC_ASSERT(one.kind == other.kind);
        RC_ASSERT(one.phase == other.phase);
        RC_ASSERT(one.two_handed == other.two_handed);
        RC_ASSERT(distance(one.anchor_bs, other.anchor_bs) < 1e-9);
        RC_ASSERT(distance(one.target_ps, other.target_ps) < 1e-9);
    }
    RC_ASSERT(forth.stats.fallbacks == back.stats.fallbacks);
}

RC_GTEST_PROP(AnchorGrabs, MovedAndRotatedWorldGivesTheSameAnchors, (std::uint64_t seed)) {
    Random random(seed);
    Anchoring here = random_anchoring(random);
    set_state(here, k_left, k_hand_states[2], 0.0);
    set_state(here, k_right, k_hand_states[1], random.between(0.0, 1.0));
    Anchoring there = here;
    const Pose moved = random.pose(1e3);
    there.move_player(moved * here.player_start.at(k_player).pose_ws,
                      moved * here.origin.at(k_player).pose_ws);
    for (const Entity body : {k_wall, k_ship}) {
        there.move_body(body, moved * here.body_start.at(body).pose_ws,
                        moved * here.body_pose.at(body).pose_ws);
    }
    here.run();
    there.run();
    RC_ASSERT(distance(here.grab.at(k_right).anchor_bs, there.grab.at(k_right).anchor_bs) < 1e-7);
    RC_ASSERT(distance(here.grab.at(k_right).target_ps, there.grab.at(k_right).target_ps) == 0.0);
}

}  // namespace
}  // namespace handhold::anchor_grabs_test
