#include "systems/physics/shared/mass_shares.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/solver/scene.hpp"
#include "tests/random.hpp"

// Expected shares are those of the formulation: the forward phase moves no player (or by 1/kappa)
// and no heavy body, the backward phase has true masses, contacts outrank hands.
namespace handhold::mass_shares_test {
namespace {

using test::fixed_body;
using test::free_body;
using test::Random;
using test::row_block;
using test::translating_body;

constexpr double k_player_kg = 70.0;
constexpr std::uint32_t k_player = 0;
constexpr std::uint32_t k_wall = 1;
constexpr std::uint32_t k_free = 2;
constexpr std::uint32_t k_heavy = 3;
constexpr std::uint32_t k_other_player = 4;

// One island: a player, a free and a heavy body, and a wall, with the rows that a test adds.
struct Masses {
    FrameGraph frame;
    PhaseTuning tuning;

    explicit Masses(std::vector<RowBlock> blocks, double free_kg = 5.0) {
        std::vector<SolverBody>& bodies = frame.graph.bodies;
        bodies = {translating_body(1, k_player_kg), fixed_body(2),
                  free_body(3, free_kg, Vec3(0.1, 0.2, 0.3)),
                  free_body(4, 1e4, Vec3(100.0, 200.0, 300.0)), translating_body(5, 50.0)};
        bodies[k_heavy].role = BodyRole::heavy;
        frame.phase.resize(bodies.size());
        frame.graph.blocks = std::move(blocks);
        build_islands(frame.graph);
    }
    const Island& island() const { return frame.graph.islands.front(); }
    double share(std::uint32_t body) const {
        return frame.graph.bodies[body].inverse_mass * frame.graph.bodies[body].mass_kg;
    }
    double share_in(Phase phase, std::uint32_t body) {
        set_masses(island(), phase, frame);
        return share(body);
    }
    double velocity_share(std::uint32_t body) {
        set_velocity_masses(island(), tuning, frame);
        return share(body);
    }
};

RowBlock drive(std::uint32_t player, std::uint32_t body) {
    return row_block(RowKind::drive_weld, player, body);
}
RowBlock contact(std::uint32_t a, std::uint32_t b, double separation_m = 0.0) {
    return row_block(RowKind::contact, a, b, Vec3(0.0, separation_m, 0.0));
}

Masses all_in_one_island() { return Masses({drive(k_player, k_free), drive(k_player, k_heavy)}); }

TEST(MassShares, EachPhaseHasItsSharesAndInertiasFollowThem) {
    struct Expected {
        Phase phase;
        double on_surface, other_player, heavy, free;
    };
    Random random(1);
    for (int i = 0; i < 20; ++i) {
        const double kappa = random.between(0.0, 1.0);
        const Expected table[] = {{Phase::reach, 1.0, kappa, 1.0, 1.0},
                                  {Phase::forward, 0.0, kappa, 0.0, 1.0},
                                  {Phase::relax, 0.0, 0.0, 0.0, 1.0},
                                  {Phase::backward, 1.0, 1.0, 1.0, 1.0},
                                  {Phase::contradiction, 0.0, 0.0, 1.0, 1.0}};
        for (const Expected& expected : table) {
            Masses scene = all_in_one_island();
            scene.frame.phase[k_player].forward_share = kappa;
            EXPECT_NEAR(scene.share_in(expected.phase, k_player), expected.other_player, 1e-15);
            scene.frame.phase[k_player].grips_surface = true;
            EXPECT_NEAR(scene.share_in(expected.phase, k_player), expected.on_surface, 1e-15);
            EXPECT_NEAR(scene.share(k_heavy), expected.heavy, 1e-15);
            EXPECT_NEAR(scene.share(k_free), expected.free, 1e-15);
            const Vec3 heavy = expected.heavy * Vec3(1e-2, 5e-3, 1.0 / 300.0);
            EXPECT_LT((scene.frame.graph.bodies[k_heavy].inverse_inertia_bs - heavy).norm(), 1e-15);
            // The solver never rotates a play space.
            EXPECT_EQ(scene.frame.graph.bodies[k_player].inverse_inertia_bs, Vec3::Zero());
        }
    }
}

TEST(MassShares, OnlyBackwardHoldsLooseBodiesOfHeapsStill) {
    for (const Phase phase :
         {Phase::reach, Phase::forward, Phase::relax, Phase::backward, Phase::contradiction}) {
        Masses scene = all_in_one_island();
        scene.frame.graph.bodies[k_free].in_heap = true;
        EXPECT_EQ(scene.share_in(phase, k_free), phase == Phase::backward ? 0.0 : 1.0);
    }
}

TEST(MassShares, ContradictionMovesOnlyPlayersWhoTouchAndMayBePushed) {
    for (const bool touches : {false, true}) {
        for (const bool pushed : {false, true}) {
            Masses scene({drive(k_player, k_free), contact(touches ? k_player : k_free, k_wall)});
            scene.frame.phase[k_player].pushed = pushed;
            scene.frame.phase[k_player].grips_surface = true;
            EXPECT_EQ(scene.share_in(Phase::contradiction, k_player),
                      touches && pushed ? 1.0 : 0.0);
        }
    }
}

TEST(MassShares, PushNeedsASecondPlayerOrARowWithWhatForwardCannotMove) {
    const auto may = [](std::vector<RowBlock> blocks) {
        const Masses scene(std::move(blocks));
        return may_push(scene.frame.graph, scene.island());
    };
    EXPECT_FALSE(may({drive(k_player, k_free)}));
    EXPECT_TRUE(may({drive(k_player, k_free), drive(k_other_player, k_free)}));
    EXPECT_TRUE(may({drive(k_player, k_heavy)}));
    EXPECT_TRUE(may({drive(k_player, k_free), contact(k_free, k_wall)}));
    EXPECT_FALSE(may({drive(k_player, k_free), contact(k_free, k_wall, 1e-3)}));
    EXPECT_FALSE(may({contact(k_free, k_wall)}));  // no player
}

// Kappa's curve is 3t^2 - 2t^3: 0, 0.15625, 0.5, 1 at t = 0, 1/4, 1/2, 1.
TEST(MassShares, VelocitySharesOfAPushedPlayerFollowKappaAndTheRatioOfMasses) {
    const PhaseTuning phases;
    const auto mass_at = [&](double t) {
        return phases.kappa_light_kg + t * (phases.kappa_heavy_kg - phases.kappa_light_kg);
    };
    const std::vector<std::pair<double, double>> cases = {
        {mass_at(0.25), 0.15625},
        {mass_at(0.5), 0.5},
        {mass_at(1.0), 1.0},
        {2.0, 70.0 / 2000.0},  // the player counts as 2 t: 1000 times 2 kg
        {0.05, 1.0}};          // 1000 times as much is less than the player weighs
    for (const auto& [free_kg, share] : cases) {
        Masses scene({drive(k_player, k_free)}, free_kg);
        scene.frame.phase[k_player].pushed = true;
        EXPECT_NEAR(scene.velocity_share(k_player), share, 1e-12) << free_kg;
        scene.frame.phase[k_player].grips_surface = true;
        EXPECT_NEAR(scene.velocity_share(k_player), 1.0, 1e-15) << free_kg;
    }
}

TEST(MassShares, PushedPlayerHasTrueMassIfAWallTakesPartInTheExchange) {
    for (const auto& [separation_m, share] : {std::pair{0.0, 1.0}, std::pair{1e-3, 0.035}}) {
        Masses scene({drive(k_player, k_free), contact(k_free, k_wall, separation_m)}, 2.0);
        scene.frame.phase[k_player].pushed = true;
        EXPECT_NEAR(scene.velocity_share(k_player), share, 1e-12);
    }
}

// A hand that holds a light body yields nothing, so momentum given to a heavy body by contacts
// alone would come from nowhere.
TEST(MassShares, HeavyBodyTakesMomentumOnlyFromSomeoneWhoPays) {
    const std::vector<RowBlock> by_contact = {drive(k_player, k_free), contact(k_free, k_heavy)};
    Masses light_hand(by_contact);
    EXPECT_EQ(light_hand.velocity_share(k_heavy), 0.0);
    light_hand.frame.phase[k_player].pushed = light_hand.frame.phase[k_heavy].pushed = true;
    EXPECT_EQ(light_hand.velocity_share(k_heavy), 1.0);
    Masses firm_hand(by_contact);
    firm_hand.frame.phase[k_player].grips_surface = true;
    EXPECT_EQ(firm_hand.velocity_share(k_heavy), 1.0);
    EXPECT_EQ(Masses({contact(k_free, k_heavy)}).velocity_share(k_heavy), 0.0);
    EXPECT_EQ(all_in_one_island().velocity_share(k_heavy), 1.0);
}

TEST(MassShares, HostsPlayerIsAsHeavyAsTheHeldBodyNeeds) {
    const auto mass_kg = [](double free_kg, double kappa, bool grips_surface) {
        Masses scene({drive(k_player, k_free)}, free_kg);
        scene.frame.hand_blocks = scene.frame.graph.blocks;
        scene.frame.phase[k_player].forward_share = kappa;
        scene.frame.phase[k_player].grips_surface = grips_surface;
        return mass_for_host_kg(scene.frame, k_player, k_player_kg);
    };
    EXPECT_NEAR(mass_kg(1.0, 0.0, false), 1000.0, 1e-9);
    EXPECT_NEAR(mass_kg(0.05, 0.0, false), k_player_kg, 1e-12);
    EXPECT_NEAR(mass_kg(550.0, 0.5, false), 2.0 * k_player_kg, 1e-12);
    EXPECT_EQ(mass_kg(1.0, 0.0, true), k_player_kg);
    EXPECT_EQ(mass_for_host_kg(FrameGraph{}, 0, k_player_kg), k_player_kg);
}

TEST(MassShares, GripIsNotedForHandAndBody) {
    const auto noted = [](GripKind kind, bool jointed) {
        Masses scene({drive(k_player, k_free)}, 550.0);
        Grab grab;
        grab.kind = kind;
        grab.jointed = jointed;
        note_grip(grab, k_player, k_free, scene.tuning, scene.frame);
        return std::pair{scene.frame.phase[k_player], scene.frame.phase[k_free]};
    };
    const auto [holder, held] = noted(GripKind::held, false);
    EXPECT_NEAR(holder.forward_share, 0.5, 1e-12);  // kappa's curve at its middle
    EXPECT_FALSE(holder.grips_surface);
    EXPECT_TRUE(held.held);
    const auto [lever_hand, lever] = noted(GripKind::held, true);
    EXPECT_EQ(lever_hand.forward_share, 0.0);
    EXPECT_TRUE(lever.held);
    const auto [climber, wall] = noted(GripKind::surface, false);
    EXPECT_TRUE(climber.grips_surface);
    EXPECT_FALSE(wall.grips_surface || wall.held);
    const auto [one, other] = noted(GripKind::player, false);
    EXPECT_TRUE(one.grips_surface && other.grips_surface);
}

}  // namespace
}  // namespace handhold::mass_shares_test
