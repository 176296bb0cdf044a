// Frames around a host's own solver. The oracle is step_frame: a host that solves the hand
// constraints exactly must move players and bodies as the runtime does, without any collider.
#include "systems/frame/frame_of_host.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/random.hpp"
#include "tests/systems/frame/scenario.hpp"

namespace handhold::frame_of_host_test {
namespace {

using test::Random;

constexpr double k_close_s = 0.1;
constexpr double k_open_s = 0.6;
constexpr double k_end_s = 0.8;

// Solves hand constraints in closed form: hands on fixed and kinematic bodies move the player, and
// a free body goes where its hand is.
class ExactHost {
  public:
    explicit ExactHost(const ShapeLibrary& shapes) : collision_(shapes) {}

    void step(World& world, FrameCaches& caches, const Tuning& tuning, const FrameInput& input,
              StageStats& stats) {
        place_surfaces(world);
        caches.host_surfaces = SurfaceQuery(collision_);
        begin_host_frame(world, caches, tuning, input, stats);
        std::vector<SolvedPlayer> solved;
        for (const Entity player : world.player.owners()) {
            solved.push_back(solve_player(world, caches.graph, player));
        }
        for (const RowBlock& block : caches.graph.hand_blocks) {
            if (block.kind == RowKind::drive_weld) {
                solve_body(world, block, solved);
            }
        }
        if (disturb) {
            disturb(world, solved);
        }
        end_host_frame(world, caches, tuning, input, solved, stats);
    }

    std::vector<std::pair<Entity, ShapeId>> surfaces;
    // Something else acts on what was solved: a wall, a defect.
    std::function<void(World&, std::vector<SolvedPlayer>&)> disturb;

  private:
    void place_surfaces(const World& world) {
        std::vector<ColliderProxy> proxies;
        for (const auto& [body, shape] : surfaces) {
            const Pose& pose_ws = world.body_pose.at(body).pose_ws;
            proxies.push_back({world.persistent_id.at(body).value, shape, pose_ws, pose_ws});
        }
        std::ranges::sort(proxies, {}, &ColliderProxy::id);
        collision_.set_proxies(proxies);
    }
    static SolvedPlayer solve_player(const World& world, const FrameGraph& frame, Entity player) {
        SolvedPlayer solved{player, world.player_origin.at(player).pose_ws.position,
                            world.player_velocity.at(player).linear_mps};
        for (const RowBlock& block : frame.hand_blocks) {
            const Grab& grab = world.grab.elements()[block.source];
            if (block.kind == RowKind::drive_point && grab.kind == GripKind::surface) {
                const Pose& body_ws = world.body_pose.at(grab.body).pose_ws;
                const Vec3 arm_ws = body_ws.rotation * grab.anchor_bs.position;
                const Quat play_space = world.player_origin.at(player).pose_ws.rotation;
                const BodyVelocity& velocity = world.body_velocity.at(grab.body);
                solved.origin_ws = body_ws.position + arm_ws - play_space * grab.target_ps.position;
                solved.velocity_mps = velocity.linear_mps + velocity.angular_radps.cross(arm_ws) -
                                      block.drive_velocity_ws_mps;
            }
        }
        return solved;
    }
    static void solve_body(World& world, const RowBlock& block,
                           const std::vector<SolvedPlayer>& solved) {
        const Grab& grab = world.grab.elements()[block.source];
        const Entity player = world.hand_owner.at(world.grab.owners()[block.source]).player;
        const auto at = std::ranges::find(solved, player, &SolvedPlayer::player);
        const Pose origin_ws{at->origin_ws, world.player_origin.at(player).pose_ws.rotation};
        const Pose end_ws = origin_ws * (grab.target_ps * inverse(grab.anchor_bs));
        const Vec3 arm_ws = end_ws.rotation * grab.anchor_bs.position;
        world.body_pose.at(grab.body).pose_ws = end_ws;
        world.body_velocity.at(grab.body) = {at->velocity_mps + block.drive_velocity_ws_mps -
                                                 block.drive_spin_ws_radps.cross(arm_ws),
                                             block.drive_spin_ws_radps};
    }

    CollisionWorld collision_;
};

// A right hand over a body under its palm, moving on a smooth random path; `by_host`: the bodies
// have no colliders.
struct OneHand {
    Scenario s;
    Entity body;
    std::unique_ptr<ExactHost> host;
    Vec3 sway_m;
    Vec3 turn_rad;

    OneHand(std::uint64_t seed, BodyKind kind, bool by_host) {
        Random random(seed);
        sway_m = random.vector(0.25);
        turn_rad = random.vector(0.6);
        s.fits_hands = false;
        s.tuning.locomotion.drift_drag_per_s = 0.0;
        const Vec3 palm = Vec3(0.3, 1.2, 0.3) + s.tuning.hand.palm_center_m;
        const ShapeId box = s.shapes.add_box(Vec3(0.1, 0.1, 0.1));
        const Pose pose_ws{palm - Vec3(0.0, 0.12, 0.0), Quat::Identity()};
        RigidBody rigid;
        rigid.kind = kind;
        rigid.mass_kg = 5.0;
        rigid.inertia_kgm2 = Vec3(0.1, 0.2, 0.3);
        body = s.add("body", rigid, by_host ? k_no_shape : box, pose_ws);
        if (kind == BodyKind::kinematic) {
            s.set_motion(body, Vec3(0.3, 0.1, -0.2), Vec3(0.1, 0.4, 0.0));
        }
        s.script.hands[1] = [this](double t) {
            const double wave = ease(t, k_close_s, k_end_s) + 0.2 * std::sin(5.0 * t);
            return Pose{Vec3(0.3, 1.2, 0.3) + wave * sway_m, rotation_from_vector(wave * turn_rad)};
        };
        s.script.grabs[1] = [](double t) { return t > k_close_s && t < k_open_s; };
        s.add_player_here();
        if (by_host) {
            host = std::make_unique<ExactHost>(s.shapes);
            host->surfaces = {{body, box}};
            s.frame = [this](World& w, FrameCaches& caches, const Tuning& tuning,
                             const FrameInput& input,
                             StageStats& stats) { host->step(w, caches, tuning, input, stats); };
        }
    }
    OneHand(const OneHand&) = delete;
    OneHand& operator=(const OneHand&) = delete;
};

// Runs both beside each other; returns whether the hand gripped.
bool moves_alike(OneHand& own, OneHand& host, double tolerance) {
    bool gripped = false;
    while (own.s.t_s() < k_end_s) {
        own.s.step();
        host.s.step();
        gripped = gripped || host.s.grab(HandSide::right).kind != GripKind::none;
        const bool is_alike =
            own.s.grab(HandSide::right).kind == host.s.grab(HandSide::right).kind &&
            (own.s.origin() - host.s.origin()).norm() < tolerance &&
            (own.s.velocity() - host.s.velocity()).norm() < 100.0 * tolerance &&
            (own.s.body(own.body).position - host.s.body(host.body).position).norm() < tolerance &&
            (own.s.body_velocity(own.body) - host.s.body_velocity(host.body)).norm() <
                100.0 * tolerance;
        if (!is_alike) {
            return false;
        }
    }
    return gripped;
}

RC_GTEST_PROP(HostFrame, HandOnAFixedBodyMovesThePlayerAsTheRuntimeDoes, (std::uint64_t seed)) {
    OneHand own(seed, BodyKind::fixed, false);
    OneHand host(seed, BodyKind::fixed, true);
    RC_ASSERT(moves_alike(own, host, 1e-7));
}

RC_GTEST_PROP(HostFrame, HeldBodyIsCarriedAndThrownAsByTheRuntime, (std::uint64_t seed)) {
    OneHand own(seed, BodyKind::free, false);
    OneHand host(seed, BodyKind::free, true);
    RC_ASSERT(moves_alike(own, host, 1e-6));
}

RC_GTEST_PROP(HostFrame, HandOnADrivenBodyMovesThePlayerAsTheRuntimeDoes, (std::uint64_t seed)) {
    OneHand own(seed, BodyKind::kinematic, false);
    OneHand host(seed, BodyKind::kinematic, true);
    RC_ASSERT(moves_alike(own, host, 1e-7));
}

RC_GTEST_PROP(HostFrame, HandOnADrivenBodyStaysOnItsAnchor, (std::uint64_t seed)) {
    OneHand host(seed, BodyKind::kinematic, true);
    bool gripped = false;
    while (host.s.t_s() < k_end_s) {
        host.s.step();
        gripped = gripped || host.s.grab(HandSide::right).kind == GripKind::surface;
        RC_ASSERT(host.s.stats.hand_error_m < 1e-9);
    }
    RC_ASSERT(gripped);
}

TEST(HostFrame, BodyThatAWallStopsKeepsTheHostsVelocity) {
    OneHand host(7, BodyKind::free, true);
    const Vec3 stopped_mps(0.01, 0.0, 0.0);
    host.host->disturb = [&](World& world, std::vector<SolvedPlayer>&) {
        const Grab& grab = host.s.grab(HandSide::right);
        if (grab.phase == GrabPhase::releasing) {
            world.body_pose.at(host.body).pose_ws.position += Vec3(0.05, 0.0, 0.0);
            world.body_velocity.at(host.body) = {stopped_mps, Vec3::Zero()};
        }
    };
    host.s.run(k_open_s + 0.05);
    EXPECT_EQ(host.s.grab(HandSide::right).kind, GripKind::none);
    EXPECT_EQ(host.s.body_velocity(host.body), stopped_mps);
}

TEST(HostFrame, SpeedsThatNoHandExplainsAreLimited) {
    OneHand crate(7, BodyKind::free, true);
    crate.host->disturb = [&](World& world, std::vector<SolvedPlayer>&) {
        if (crate.s.t_s() > 0.3 && crate.s.t_s() < 0.32) {
            world.body_velocity.at(crate.body).linear_mps = Vec3(100.0, 0.0, 0.0);
        }
    };
    OneHand wall(7, BodyKind::fixed, true);
    wall.host->disturb = [&](World&, std::vector<SolvedPlayer>& players) {
        if (wall.s.t_s() > 0.3 && wall.s.t_s() < 0.32) {
            players.front().velocity_mps = Vec3(0.0, 50.0, 0.0);
        }
    };
    double fastest_crate_mps = 0.0;
    double fastest_player_mps = 0.0;
    std::uint64_t counted = 0;
    crate.s.run(0.5, [&] {
        fastest_crate_mps = std::max(fastest_crate_mps, crate.s.body_velocity(crate.body).norm());
        counted += crate.s.fallbacks(Fallback::object_speed_clamped);
    });
    wall.s.run(
        0.5, [&] { fastest_player_mps = std::max(fastest_player_mps, wall.s.velocity().norm()); });
    EXPECT_LE(fastest_crate_mps, crate.s.tuning.locomotion.object_speed_max_mps + 1e-9);
    EXPECT_LE(fastest_player_mps, wall.s.tuning.locomotion.release_speed_max_mps + 1e-9);
    EXPECT_GE(counted, 1U);
}

// The host moves the player and says what the hand holds.
RC_GTEST_PROP(ShownFrame, HandStaysOnTheHeldBodyWhereverTheHostPutsBoth, (std::uint64_t seed)) {
    OneHand scene(seed, BodyKind::fixed, true);
    Random random(seed + 1);
    scene.s.frame = &show_host_frame;
    scene.s.run(0.05);
    const Entity hand = scene.s.player.hands[index_of(HandSide::right)];
    Grab& grab = scene.s.world.grab.at(hand);
    grab.kind = GripKind::surface;
    grab.phase = GrabPhase::holding;
    grab.body = scene.body;
    grab.anchor_bs = random.pose(0.2);
    for (int frame = 0; frame < 10; ++frame) {
        scene.s.world.body_pose.at(scene.body).pose_ws = random.pose();
        scene.s.world.player_origin.at(scene.s.player.player).pose_ws = random.pose();
        scene.s.step();
        const RenderPose& shown = scene.s.world.render_pose.at(scene.s.player.player);
        const Vec3 anchor_ws = transform_point(scene.s.world.body_pose.at(scene.body).pose_ws,
                                               grab.anchor_bs.position);
        RC_ASSERT((shown.hands[1].shown_ws.position - anchor_ws).norm() < 1e-9);
        RC_ASSERT(std::abs(scene.s.grab(HandSide::right).error_m -
                           (shown.hands[1].tracked_ws.position - anchor_ws).norm()) < 1e-9);
    }
    destroy(scene.s.world, scene.body);
    scene.s.step();
    RC_ASSERT(scene.s.grab(HandSide::right).kind == GripKind::none);
}

}  // namespace
}  // namespace handhold::frame_of_host_test
