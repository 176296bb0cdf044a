// Bodies as capsules. The oracle is the collision world's own capsule.
#include "systems/grab/shared/body_parts.hpp"

#include <array>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "engine/collision/collision_world.hpp"
#include "tests/systems/frame/column_scene.hpp"

namespace handhold::body_parts_test {
namespace {

using test::Random;

constexpr Entity k_player = test::entity(0);

// A player in a random pose whose joints need not make sense.
struct Body {
    Column<GrippableBody> bodies;
    Column<BodyMeasures> measures;
    Column<PersistentId> persistent_id;
    Column<PlayerOrigin> origin;
    Column<HeadTracking> head;

    explicit Body(Random& random) {
        persistent_id.add(k_player, {100});
        measures.add(k_player).eye_height_m = random.between(1.0, 2.0);
        origin.add(k_player, {random.pose()});
        head.add(k_player).start_ps = random.pose();
        GrippableBody& pose = bodies.add(k_player);
        const auto near = [&] {
            Pose joint = random.pose(0.5);
            joint.position += head_ws();
            return joint;
        };
        for (ArmPose::Arm& arm : pose.arms.arms) {
            arm = {near(), near(), near(), near()};
        }
        for (Pose& link : pose.spine.spine_ws) {
            link = near();
        }
        pose.spine.pelvis_ws = near();
        for (SpinePose::Leg& leg : pose.spine.legs) {
            leg = {near(), near(), near()};
        }
    }
    GrippableBodies parts() const {
        return {.bodies = bodies,
                .measures = measures,
                .persistent_id = persistent_id,
                .origin = origin,
                .head = head};
    }
    Vec3 head_ws() const {
        return transform_point(origin.at(k_player).pose_ws, head.at(k_player).start_ps.position);
    }
};

// The parts as colliders, with the ids 1 + part.
struct Oracle {
    ShapeLibrary shapes;
    std::unique_ptr<CollisionWorld> world;

    explicit Oracle(const Body& body) {
        std::vector<ColliderProxy> proxies;
        for (std::size_t i = 0; i < k_gripped_parts; ++i) {
            const PartCapsule capsule = part_capsule(
                body.bodies.at(k_player), body.measures.at(k_player), static_cast<BodyPart>(i));
            const double length_m = capsule.end_bs.norm();
            const Pose middle_ws =
                capsule.frame_ws *
                Pose{0.5 * capsule.end_bs, Quat::FromTwoVectors(Vec3::UnitY(), capsule.end_bs)};
            proxies.push_back({1 + i, shapes.add_capsule(capsule.radius_m, 0.5 * length_m),
                               middle_ws, middle_ws, true});
        }
        world = std::make_unique<CollisionWorld>(shapes);
        world->set_proxies(proxies);
    }
};

TEST(BodyParts, RaysHitWhatCapsulesAsCollidersStop) {
    Random random(11);
    int hits = 0;
    for (int i = 0; i < 40; ++i) {
        const Body body(random);
        const Oracle oracle(body);
        for (int ray = 0; ray < 40; ++ray) {
            const Vec3 from = body.head_ws() + 2.0 * random.direction();  // outside of all parts
            const Vec3 to = body.head_ws() + random.vector(0.6);
            const auto expected = oracle.world->cast_ray(from, to);
            const auto found = body.parts().cast_ray(from, to, {});
            ASSERT_EQ(found.has_value(), expected.has_value());
            if (found) {
                ++hits;
                ASSERT_NEAR(found->distance_m, expected->distance_m, 1e-6);
                ASSERT_LE((found->point_ws - expected->point_ws).norm(), 1e-6);
                ASSERT_LE((found->normal_ws - expected->normal_ws).norm(), 1e-5);
            }
        }
    }
    EXPECT_GT(hits, 200);
}

TEST(BodyParts, NearestPointIsThatOfCapsulesAsColliders) {
    Random random(12);
    int outside = 0;
    for (int i = 0; i < 40; ++i) {
        const Body body(random);
        const Oracle oracle(body);
        for (int point = 0; point < 40; ++point) {
            const Vec3 at = body.head_ws() + random.vector(0.8);
            const auto expected = oracle.world->closest_point(at, 0.3);
            const auto found = body.parts().closest_point(at, 0.3, {});
            ASSERT_EQ(found.has_value(), expected.has_value());
            if (found && expected->distance_m > 0.0) {
                ++outside;
                ASSERT_NEAR(found->distance_m, expected->distance_m, 1e-6);
                ASSERT_LE((found->point_ws - expected->point_ws).norm(), 1e-6);
                ASSERT_LE((found->normal_ws - expected->normal_ws).norm(), 1e-5);
            } else if (found) {
                ASSERT_LE(found->distance_m, 1e-9);  // inside
            }
        }
    }
    EXPECT_GT(outside, 200);
}

TEST(BodyParts, SkippedPlayersAreNotFound) {
    Random random(13);
    const Body body(random);
    const std::array skip = {std::uint64_t{100}};
    const Vec3 on_body = body.bodies.at(k_player).spine.pelvis_ws.position;
    EXPECT_TRUE(body.parts().closest_point(on_body, 0.3, {}).has_value());
    EXPECT_FALSE(body.parts().closest_point(on_body, 0.3, skip).has_value());
}

// The anchor travels along a straight line, by the given distance or until it arrives.
TEST(BodyParts, FollowingAnchorTravelsNoFartherThanAllowed) {
    Random random(15);
    for (int i = 0; i < 200; ++i) {
        const Pose from = random.pose();
        const Pose to = random.pose();
        const Vec3 anchor = random.vector(0.3);
        const Vec3 start = transform_point(from, anchor);
        const Vec3 end = transform_point(to, anchor);
        const double most_m = random.between(0.0, 2.0);
        const double share = i % 2 == 0 ? 1.0 : random.between(0.0, 1.0);
        const Vec3 now = transform_point(follow_part(from, to, anchor, {share, most_m}), anchor);
        const double travel_m = std::min(most_m, share * (end - start).norm());
        ASSERT_LE((now - (start + travel_m * (end - start).normalized())).norm(), 1e-9);
    }
}

}  // namespace
}  // namespace handhold::body_parts_test
