// More than 300 joints of every kind in one island, through whole frames: a gantry on a rail; on it
// a rope of 128 links to a hand, a ring, rows of levers and drawers, and a tree of all kinds of
// joints. Errors are computed from poses.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/core/parallel.hpp"
#include "systems/snapshot/snapshot.hpp"
#include "tests/random.hpp"
#include "tests/systems/physics/joint_errors.hpp"

namespace handhold::scenario_machinery_test {
namespace {

using test::Random;
using Hashes = std::vector<std::uint64_t>;

constexpr int k_links = 128;
constexpr double k_link_m = 0.1;
constexpr double k_along_m = 0.098;  // of a link of the zigzag rope

class Machinery {
  public:
    Scenario scene;
    std::vector<Entity> joints;
    test::JointErrors worst;
    double worst_excess = 0.0;  // worst excess of a coordinate over its limits, rad or m
    // From here on the hand moves away, farther than the rope is long.
    double pull_s = 1e9;

    // Adds that many loose, swinging ropes. Order 0: bodies and joints are created in the order of
    // the code; others: shuffled.
    explicit Machinery(int loose_ropes = 0, std::uint64_t order = 0) {
        plan_gantry();
        plan_held_rope();
        plan_ring();
        plan_levers();
        plan_drawers();
        plan_tree();
        for (int i = 0; i < loose_ropes; ++i) {
            plan_rope("loose" + std::to_string(i) + "_", "", k_rope + Vec3(2.0 + i, 0.0, 0.0),
                      Moves::yes);
        }
        make(order);
        script();
    }

    void run(
        int frames, const std::function<void()>& after_frame = [] {}) {
        for (int i = 0; i < frames; ++i) {
            scene.step();
            for (const Entity joint : joints) {
                worst.take(test::error_of(scene, joint));
                worst_excess = std::max(worst_excess, passed_by(joint));
            }
            after_frame();
        }
    }
    Hashes hashes(
        int frames, const std::function<void()>& before_frame = [] {}) {
        Hashes all;
        for (int i = 0; i < frames; ++i) {
            before_frame();
            scene.step();
            all.push_back(hash_state(scene.world));
        }
        return all;
    }
    double passed_by(Entity entity) const {
        const Joint& joint = scene.world.joint.at(entity);
        const double coordinate = scene.world.joint_state.at(entity).coordinate;
        return joint.limited ? std::max(joint.lower - coordinate, coordinate - joint.upper) : 0.0;
    }
    // Largest displacement of these joints from their initial coordinate, rad or m.
    double farthest_of(const char* prefix) const {
        double farthest = 0.0;
        for (const Tie& tie : ties_) {
            if (tie.name.starts_with(prefix)) {
                const Entity joint = find_by_id(scene.world, persistent_id_from_name(tie.name));
                farthest =
                    std::max(farthest, std::abs(scene.world.joint_state.at(joint).coordinate));
            }
        }
        return farthest;
    }

  private:
    enum class Moves : std::uint8_t { no, yes };
    struct Part {
        std::string name;
        double mass_kg = 1.0;
        Vec3 half_m;
        Pose pose;
        Moves moves = Moves::yes;  // initially
    };
    struct Tie {
        std::string name;
        std::string a;  // empty: the world
        std::string b;
        Joint joint;
        Pose frame;
    };

    void part(const std::string& name, double mass_kg, const Vec3& half_m, const Pose& pose,
              Moves moves = Moves::yes) {
        parts_.push_back({name, mass_kg, half_m, pose, moves});
    }
    void tie(const std::string& a, const std::string& b, const Joint& joint, const Vec3& point,
             const Vec3& axis = Vec3::UnitX()) {
        ties_.push_back({a + "-" + b, a, b, joint, {point, rotation_between(Vec3::UnitX(), axis)}});
    }
    static Joint joint_of(JointKind kind) {
        Joint joint;
        joint.kind = kind;
        return joint;
    }
    static Joint limited(JointKind kind, double lower, double upper) {
        Joint joint = joint_of(kind);
        joint.limited = true;
        joint.lower = lower;
        joint.upper = upper;
        return joint;
    }

    // The gantry: a body on a slider joint that is parallel to the rope.
    void plan_gantry() {
        part("gantry", 60.0, Vec3(0.8, 0.05, 0.3), {k_gantry, Quat::Identity()}, Moves::no);
        Joint rail = limited(JointKind::slider, -0.25, 0.25);
        rail.friction = 5.0;
        tie("", "gantry", rail, k_gantry, Vec3::UnitZ());
    }
    // In a zigzag along z, light and heavy links alternating. Returns its end.
    Vec3 plan_rope(const std::string& link, const std::string& from, const Vec3& start,
                   Moves moves) {
        const double up_m = std::sqrt(k_link_m * k_link_m - k_along_m * k_along_m);
        const auto at = [&](int i) { return Vec3(start + Vec3(0, i % 2 * up_m, k_along_m * i)); };
        for (int i = 0; i < k_links; ++i) {
            const Vec3 along = at(i + 1) - at(i);
            const Quat turned = rotation_between(Vec3::UnitZ(), along.normalized());
            const std::string name = link + std::to_string(i);
            part(name, i % 2 == 0 ? 1.0 : 0.1, Vec3(0.02, 0.02, 0.05),
                 {0.5 * (at(i) + at(i + 1)), turned}, moves);
            tie(i == 0 ? from : link + std::to_string(i - 1), name, joint_of(JointKind::ball),
                at(i));
        }
        return at(k_links);
    }
    // From the gantry to the hand.
    void plan_held_rope() {
        const Vec3 end = plan_rope("link", "gantry", k_rope, Moves::no);
        handle_ = end + Vec3(0.0, 0.0, 0.05);
        part("handle", 0.5, Vec3(0.02, 0.02, 0.05), {handle_, Quat::Identity()}, Moves::no);
        tie("link" + std::to_string(k_links - 1), "handle", joint_of(JointKind::ball), end);
    }
    void plan_ring() {
        constexpr int k_count = 32;
        const double radius_m = k_link_m / (2.0 * std::sin(k_pi / k_count));
        const Vec3 center = k_gantry + Vec3(-0.6, -radius_m - 0.2, 0.0);
        const auto at = [&](int i) {
            const double angle = 2.0 * k_pi * i / k_count;
            return Vec3(center + radius_m * Vec3(std::sin(angle), std::cos(angle), 0.0));
        };
        for (int i = 0; i < k_count; ++i) {
            const Quat turned = rotation_between(Vec3::UnitX(), (at(i + 1) - at(i)).normalized());
            part("ring" + std::to_string(i), 1.0, Vec3(0.05, 0.02, 0.02),
                 {0.5 * (at(i) + at(i + 1)), turned});
        }
        for (int i = 0; i < k_count; ++i) {
            tie("ring" + std::to_string((i + k_count - 1) % k_count), "ring" + std::to_string(i),
                joint_of(JointKind::ball), at(i));
        }
        tie("gantry", "ring0", joint_of(JointKind::ball), at(0));
    }
    // Side by side, with rods between neighbours' tips: loops.
    void plan_levers() {
        constexpr int k_count = 20;
        for (int i = 0; i < k_count; ++i) {
            const Vec3 foot = k_gantry + Vec3(-0.5 + 0.05 * i, 0.05, 0.2);
            const std::string name = "lever" + std::to_string(i);
            part(name, 0.3, Vec3(0.01, 0.1, 0.01), {foot + 0.1 * Vec3::UnitY(), Quat::Identity()});
            Joint hinge = limited(JointKind::hinge, -0.8, 0.8);
            hinge.friction = 0.01;
            hinge.detent_spacing = i % 4 == 0 ? 0.2 : 0.0;
            hinge.detent_strength = 0.02;
            tie("gantry", name, hinge, foot, Vec3::UnitX());
            if (i > 0) {
                const Vec3 tip = foot + 0.2 * Vec3::UnitY();
                Joint rod = limited(JointKind::distance, 0.05, 0.05);
                rod.frame_a_bs.position = tip - 0.05 * Vec3::UnitX();
                ties_.push_back({"rod" + std::to_string(i),
                                 "lever" + std::to_string(i - 1),
                                 name,
                                 rod,
                                 {tip, Quat::Identity()}});
            }
        }
    }
    // Below it, each with a fixed knob.
    void plan_drawers() {
        constexpr int k_count = 20;
        for (int i = 0; i < k_count; ++i) {
            const Vec3 center = k_gantry + Vec3(-0.5 + 0.05 * i, -0.1, 0.2);
            const std::string name = "drawer" + std::to_string(i);
            const std::string knob = "knob" + std::to_string(i);
            part(name, 0.5, Vec3(0.02, 0.02, 0.1), {center, Quat::Identity()});
            const Vec3 front = center + 0.1 * Vec3::UnitZ();
            part(knob, 0.05, Vec3(0.01, 0.01, 0.01), {front, Quat::Identity()});
            Joint slider = limited(JointKind::slider, -0.02, 0.02 + 0.01 * i);
            slider.friction = 0.02;
            tie("gantry", name, slider, center, Vec3::UnitZ());
            tie(name, knob, joint_of(JointKind::fixed), front);
        }
    }
    // Of all kinds, masses from 30 g to 30 kg; attached to the ring.
    void plan_tree() {
        constexpr int k_count = 80;
        Random random(7);
        std::vector<Vec3> places;
        for (int i = 0; i < k_count; ++i) {
            const int parent = i == 0 ? 0 : static_cast<int>(random.between(0.0, i - 1e-9));
            const Vec3 from = i == 0 ? Vec3(k_gantry - Vec3(0.6, 1.3, 0.0))
                                     : places[static_cast<std::size_t>(parent)];
            places.push_back(from + 0.15 * random.direction());
            const std::string name = "tree" + std::to_string(i);
            const double mass_kg = 0.03 * std::pow(1000.0, random.between(0.0, 1.0));
            part(name, mass_kg, Vec3(0.05, 0.04, 0.03), {places.back(), random.rotation()});
            const JointKind kinds[] = {JointKind::ball, JointKind::hinge, JointKind::slider,
                                       JointKind::fixed};
            const JointKind kind = kinds[i % 4];
            Joint joint = kind == JointKind::hinge || kind == JointKind::slider
                              ? limited(kind, -0.4, 0.3)
                              : joint_of(kind);
            tie(i == 0 ? "ring16" : "tree" + std::to_string(parent), name, joint,
                0.5 * (from + places.back()), random.direction());
        }
    }

    Entity body_named(const std::string& name) const {
        return name.empty() ? k_no_entity : find_by_id(scene.world, persistent_id_from_name(name));
    }
    template <typename T>
    static void shuffle(std::vector<T>& items, Random& random) {
        for (std::size_t i = items.size(); i > 1; --i) {
            std::swap(items[i - 1], items[static_cast<std::size_t>(
                                        random.between(0.0, static_cast<double>(i) - 1e-9))]);
        }
    }
    void make(std::uint64_t order) {
        Random random(order);
        std::vector<Tie> ties = ties_;
        if (order != 0) {
            shuffle(parts_, random);
            shuffle(ties, random);
        }
        for (const Part& one : parts_) {
            const ShapeId shape = scene.shapes.add_box(one.half_m);
            const RigidBody body{BodyKind::free, one.mass_kg,
                                 solid_inertia(scene.shapes.at(shape), one.mass_kg), 0.0};
            Random own(persistent_id_from_name(one.name).value);
            const BodyVelocity velocity = one.moves == Moves::yes
                                              ? BodyVelocity{own.vector(0.5), own.vector(2.0)}
                                              : BodyVelocity{};
            const bool is_handle = one.name == "handle";  // nothing else collides
            scene.add(one.name, body, is_handle ? shape : k_no_shape, one.pose, velocity);
        }
        for (const Tie& one : ties) {
            Joint joint = one.joint;
            joint.a = body_named(one.a);
            joint.b = body_named(one.b);
            Joint made = joint_at(scene.world, joint, one.frame);
            if (joint.kind == JointKind::distance) {
                made.frame_a_bs = inverse(scene.world.body_pose.at(joint.a).pose_ws) *
                                  Pose{one.joint.frame_a_bs.position, Quat::Identity()};
            }
            joints.push_back(add_joint(scene.world, {one.name, made}));
        }
    }
    // The right hand grips the handle and moves it at up to 1.5 m/s; the rope stays slack.
    void script() {
        const Vec3 rest = hand_for_palm(scene, handle_ + Vec3(0.0, 0.035, 0.0));
        scene.script.hands[1] = [this, rest](double t_s) {
            const double w = ease(t_s, 0.2, 0.7);
            const Vec3 wave(0.2 * std::sin(4.0 * t_s), 0.1 * std::sin(5.0 * t_s),
                            0.35 * std::sin(3.0 * t_s));
            const double away_m = 1.2 * std::max(0.0, t_s - pull_s);
            return Pose{rest + w * wave + Vec3(0.0, 0.0, away_m),
                        rotation_from_vector(w * Vec3(0.0, 0.4 * std::sin(3.0 * t_s), 0.0))};
        };
        scene.script.grabs[1] = [](double t_s) { return t_s > 0.1; };
        scene.script.head = [this](double) {
            return Pose{handle_ + Vec3(0.0, 0.6, 0.8), Quat::Identity()};
        };
        scene.add_player_here();
    }

    static inline const Vec3 k_gantry = Vec3(0.0, 1.2, -12.0);
    static inline const Vec3 k_rope = Vec3(0.0, 1.2, -11.7);
    Vec3 handle_ = Vec3::Zero();
    std::vector<Part> parts_;
    std::vector<Tie> ties_;
};

TEST(Machinery, ThreeHundredJointsHoldAndTheHolderIsBitwiseUnmoved) {
    Machinery machinery;
    EXPECT_GE(machinery.joints.size(), 300U);
    const Vec3 before = machinery.scene.origin_ws();
    machinery.run(180, [&] {
        ASSERT_EQ(machinery.scene.stats.islands, 1U);
        ASSERT_EQ(machinery.scene.origin_ws(), before);
        ASSERT_LE(machinery.scene.grab(HandSide::right).error_m, 1e-6);
    });
    EXPECT_EQ(machinery.scene.grab(HandSide::right).kind, GripKind::held);
    EXPECT_LE(machinery.worst.m, 1e-6);
    EXPECT_LE(machinery.worst.rad, 1e-4 * k_degree);
    EXPECT_LE(machinery.worst_excess, 1e-6);
    // Some limits were reached.
    EXPECT_NEAR(machinery.farthest_of("-gantry"), 0.25, 1e-4);
    EXPECT_NEAR(machinery.farthest_of("gantry-lever"), 0.8, 1e-4);
    EXPECT_NEAR(machinery.farthest_of("gantry-drawer19"), 0.21, 1e-4);
    EXPECT_GT(machinery.farthest_of("tree"), 0.3);
}

// The hand moves two metres beyond the reach of rope and rail; the player is pulled along by the
// difference.
TEST(Machinery, PulledBeyondItsReachHoldsAndStopsThePlayer) {
    Machinery machinery;
    machinery.pull_s = 1.0;
    machinery.run(270, [&] { ASSERT_LE(machinery.scene.grab(HandSide::right).error_m, 1e-6); });
    EXPECT_EQ(machinery.scene.grab(HandSide::right).kind, GripKind::held);
    EXPECT_LE(machinery.worst.m, 1e-6);
    EXPECT_LE(machinery.worst.rad, 1e-4 * k_degree);
    EXPECT_LE(machinery.worst_excess, 1e-6);
    EXPECT_LT(machinery.scene.origin().z(), 0.6 - 2.0 * 1.2);
}

// --- Bitwise equal frames ------------------------------------------------------------------------

constexpr int k_loose_ropes = 4;
constexpr int k_frames = 90;

TEST(MachineryThreaded, GivesTheSameFramesForAnyNumberOfThreads) {
    set_thread_count(1);
    const Hashes expected = Machinery(k_loose_ropes).hashes(k_frames);
    for (const int threads : {2, 5, 16}) {
        set_thread_count(threads);
        EXPECT_EQ(Machinery(k_loose_ropes).hashes(k_frames), expected) << threads;
    }
    set_thread_count(1);
}

TEST(Machinery, GivesTheSameFramesInAnyCreationOrder) {
    const Hashes expected = Machinery(k_loose_ropes).hashes(k_frames);
    for (const std::uint64_t order : {1U, 2U}) {
        EXPECT_EQ(Machinery(k_loose_ropes, order).hashes(k_frames), expected) << order;
    }
}

TEST(Machinery, GivesTheSameFramesWithoutCaches) {
    const Hashes expected = Machinery(k_loose_ropes).hashes(k_frames);
    Machinery machinery(k_loose_ropes);
    EXPECT_EQ(machinery.hashes(k_frames, [&] { machinery.scene.drop_caches(); }), expected);
}

// Devices follow the clock, which is state: after a restore they repeat their motion.
TEST(Machinery, GivesTheSameFramesAfterARollback) {
    Machinery machinery(k_loose_ropes);
    const SnapshotAssets assets(machinery.scene.shapes);
    std::vector<std::byte> saved;
    for (int i = 0; i < 2; ++i) {
        save_snapshot(machinery.scene.world, assets, saved);
        const Hashes expected = machinery.hashes(60);
        const auto error = restore_snapshot(saved, assets, machinery.scene.world);
        ASSERT_FALSE(error) << error->message();
        machinery.scene.rewind_devices();
        EXPECT_EQ(machinery.hashes(60), expected) << i;
    }
}

}  // namespace
}  // namespace handhold::scenario_machinery_test
