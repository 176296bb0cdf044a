// A tool dragged through clutter by a hand that jumps: even if not all contacts can be satisfied,
// nothing penetrates at the end of the frame.
#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/collision/scene.hpp"
#include "tests/systems/frame/scenario.hpp"

namespace handhold::scenario_clutter_test {
namespace {

using test::Random;

struct ClutterResult {
    double worst_overlap_m = 0.0;  // as reported by the frame
    double worst_seen_m = 0.0;     // from the tool's final pose
    int frames_held = 0;
    std::uint64_t restored_last_valid_pose = 0;
};

enum class Clutter : std::uint8_t { boxes, one_mesh, boxes_and_loose };

// The surface of a box.
void add_box_sides(const Vec3& half_m, const Pose& pose, Mesh& mesh) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 sign((corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 1.0 : -1.0,
                        (corner & 4) != 0 ? 1.0 : -1.0);
        mesh.positions.push_back(transform_point(pose, half_m.cwiseProduct(sign)));
    }
    constexpr std::array<std::array<std::uint32_t, 3>, 12> k_sides = {{{0, 1, 3},
                                                                       {0, 3, 2},
                                                                       {4, 6, 7},
                                                                       {4, 7, 5},
                                                                       {0, 4, 5},
                                                                       {0, 5, 1},
                                                                       {2, 3, 7},
                                                                       {2, 7, 6},
                                                                       {0, 2, 6},
                                                                       {0, 6, 4},
                                                                       {1, 5, 7},
                                                                       {1, 7, 3}}};
    for (const auto& [a, b, c] : k_sides) {
        mesh.triangles.push_back({first + a, first + b, first + c});
    }
}

void add_clutter(Clutter kind, const Vec3& center, Random& random, Scenario& s) {
    auto mesh = std::make_shared<Mesh>();
    for (int i = 0; i < 80; ++i) {
        const Vec3 half{random.between(0.02, 0.12), random.between(0.02, 0.12),
                        random.between(0.02, 0.12)};
        const Vec3 place = center + random.arm(0.35, 0.7);
        const Pose pose{place, random.rotation()};
        if (kind != Clutter::one_mesh) {
            s.add("box" + std::to_string(i), {}, s.shapes.add_box(half), pose);
        } else {
            add_box_sides(half, pose, *mesh);
        }
    }
    if (kind == Clutter::one_mesh) {
        s.add("rack", {}, s.shapes.add_mesh(mesh), {});
    }
    if (kind == Clutter::boxes_and_loose) {
        for (int i = 0; i < 30; ++i) {
            const Vec3 half = Vec3::Constant(random.between(0.02, 0.04));
            const double mass_kg = random.between(0.3, 20.0);
            const ShapeId shape = s.shapes.add_box(half);
            const Entity body =
                s.add("loose" + std::to_string(i),
                      {BodyKind::free, mass_kg, solid_inertia(s.shapes.at(shape), mass_kg), 1.0},
                      shape, {center + random.arm(0.2, 0.3), random.rotation()});
            s.set_motion(body, random.direction() * 5.0, Vec3::Zero());
        }
    }
}

// Penetration of a body into fixed bodies at its current pose, without sweeps.
double overlap_where_it_is(const Scenario& s, Entity body) {
    std::vector<ColliderProxy> proxies;
    for (const Entity entity : s.world.body.owners()) {
        const bool is_free = s.world.body.at(entity).kind == BodyKind::free;
        if (entity == body || !is_free) {
            proxies.push_back(test::resting(s.world.persistent_id.at(entity).value,
                                            s.world.collider.at(entity).shape,
                                            s.world.body_pose.at(entity).pose_ws, is_free));
        }
    }
    return std::max(0.0, -test::deepest(test::contacts_of(s.shapes, proxies)));
}

// Eighty boxes around a tool of 30 cm, and a hand that jumps ten times a second, by up to half a
// metre and 100 degrees.
ClutterResult drag_through_clutter(std::uint64_t seed, Clutter kind) {
    Random random(seed);
    Scenario s;
    s.tuning.tracking.max_hand_speed_mps = 1e3;  // jumps are followed
    const Vec3 palm(0.3, 1.2, -0.5);
    const Vec3 half_m(0.02, 0.02, 0.15);
    const Entity tool = s.add_crate("tool", 3.0, palm - Vec3(0.0, half_m.y(), 0.0), half_m);
    add_clutter(kind, palm, random, s);
    // The other hand holds a bar, so that the player cannot be pushed out of the clutter.
    const Vec3 other_palm(-0.3, 1.2, 0.3);
    s.add_wall("bar", Vec3(0.3, 0.02, 0.02), other_palm - Vec3(0.0, 0.025, 0.0));
    s.script.hands[0] = [other = hand_for_palm(s, other_palm)](double) {
        return Pose{other, Quat::Identity()};
    };
    s.script.grabs[0] = [](double t) { return t > 0.05; };
    s.add_player_here();
    const Vec3 hand = hand_for_palm(s, palm);
    std::vector<Pose> jumps;
    for (int i = 0; i < 40; ++i) {
        jumps.push_back({hand + random.vector(0.3), rotation_from_vector(random.vector(1.0))});
    }
    s.script.grabs[1] = [](double t) { return t > 0.05; };
    s.script.hands[1] = [=](double t) {
        const auto jump = static_cast<std::size_t>(std::max(0.0, (t - 0.1) * 10.0));
        return t < 0.2 ? Pose{hand, Quat::Identity()} : jumps[jump % jumps.size()];
    };
    ClutterResult result;
    // Loose boxes may begin in others, and leave them.
    s.run(kind == Clutter::boxes_and_loose ? 0.3 : 0.0, [] {});
    s.run(4.0, [&] {
        result.worst_overlap_m = std::max(result.worst_overlap_m, s.stats.residual_m);
        if (kind == Clutter::one_mesh) {
            result.worst_seen_m = std::max(result.worst_seen_m, overlap_where_it_is(s, tool));
        }
        result.frames_held += s.grab(HandSide::right).body == tool ? 1 : 0;
        result.restored_last_valid_pose += s.fallbacks(Fallback::restored_last_valid_pose);
    });
    return result;
}

TEST(Clutter, ToolOfAJumpingHandPenetratesNothing) {
    std::uint64_t restored_last_valid_pose = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        const ClutterResult result = drag_through_clutter(seed, Clutter::boxes);
        EXPECT_LT(result.worst_overlap_m, 2e-4) << seed;
        EXPECT_GT(result.frames_held, 20) << seed;
        restored_last_valid_pose += result.restored_last_valid_pose;
    }
    EXPECT_GT(restored_last_valid_pose, 0U);  // about 1 frame in 300
}

// Thirty boxes bounce between the fixed ones. A tool that is restored to its last valid pose may
// find one of them there.
TEST(Clutter, LooseBodiesPenetrateNothingEither) {
    std::uint64_t restored_last_valid_pose = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        const ClutterResult result = drag_through_clutter(seed, Clutter::boxes_and_loose);
        EXPECT_LT(result.worst_overlap_m, 1e-3) << seed;
        restored_last_valid_pose += result.restored_last_valid_pose;
    }
    EXPECT_GT(restored_last_valid_pose, 0U);
}

// Contacts are found where the tool's motion first touches the mesh. Penetration at its end into
// another part of the mesh must not be missed, or that pose would count as valid.
TEST(Clutter, ToolDoesNotPenetrateTheFarSideOfItsObstacle) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        const ClutterResult result = drag_through_clutter(seed, Clutter::one_mesh);
        EXPECT_LT(result.worst_overlap_m, 2e-4) << seed;
        EXPECT_LT(result.worst_seen_m, 2e-4) << seed;
        EXPECT_GT(result.frames_held, 10) << seed;
    }
}

}  // namespace
}  // namespace handhold::scenario_clutter_test
