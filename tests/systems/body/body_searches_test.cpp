// Surfaces beside trunk and legs are searched only when the answer can have changed.
#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/random.hpp"
#include "tests/systems/body/hanging_body.hpp"

namespace handhold::body_searches_test {
namespace {

using test::HangingBody;
using test::joints_of;
using test::k_player;
using test::Random;

// A wall of 1 m and a crate, whose queries are counted.
class CountedSurfaces {
  public:
    explicit CountedSurfaces(const Pose& wall_ws) : wall_ws_(wall_ws), world_(shapes_) {
        place(Vec3(0.0, 1.0, 20.0));
    }
    void place(const Vec3& crate_ws) {
        const Pose crate = test::pose_at(crate_ws);
        world_.set_proxies(std::vector<ColliderProxy>{{9, wall_, wall_ws_, wall_ws_, false},
                                                      {10, crate_, crate, crate, true}});
    }
    int take_casts() { return std::exchange(casts_, 0); }

    std::optional<RayHit> cast_ray(const Vec3& from_ws, const Vec3& to_ws,
                                   std::span<const std::uint64_t> skip) const {
        return world_.cast_ray(from_ws, to_ws, skip);
    }
    std::optional<RayHit> cast_sphere(double radius_m, const Vec3& from_ws, const Vec3& to_ws,
                                      std::span<const std::uint64_t> skip) const {
        ++casts_;
        return world_.cast_sphere(radius_m, from_ws, to_ws, skip);
    }
    std::optional<SurfacePoint> closest_point(const Vec3& point_ws, double max_distance_m,
                                              std::span<const std::uint64_t> skip) const {
        return world_.closest_point(point_ws, max_distance_m, skip);
    }
    std::optional<SurfacePoint> closest_point_on(std::uint64_t id, const Vec3& point_ws) const {
        return world_.closest_point_on(id, point_ws);
    }
    std::uint64_t hash_near(const Vec3& low_ws, const Vec3& high_ws,
                            std::span<const std::uint64_t> skip) const {
        return world_.hash_near(low_ws, high_ws, skip);
    }

  private:
    ShapeLibrary shapes_;
    ShapeId wall_ = shapes_.add_box({5.0, 5.0, 0.5});
    ShapeId crate_ = shapes_.add_box({0.2, 0.2, 0.2});
    Pose wall_ws_;
    CollisionWorld world_;
    mutable int casts_ = 0;
};

// The same surfaces, which do not say whether they have moved.
struct SilentSurfaces {
    const CountedSurfaces* surfaces;

    std::optional<RayHit> cast_ray(const Vec3& from_ws, const Vec3& to_ws,
                                   std::span<const std::uint64_t> skip) const {
        return surfaces->cast_ray(from_ws, to_ws, skip);
    }
    std::optional<RayHit> cast_sphere(double radius_m, const Vec3& from_ws, const Vec3& to_ws,
                                      std::span<const std::uint64_t> skip) const {
        return surfaces->cast_sphere(radius_m, from_ws, to_ws, skip);
    }
    std::optional<SurfacePoint> closest_point(const Vec3& point_ws, double max_distance_m,
                                              std::span<const std::uint64_t> skip) const {
        return surfaces->closest_point(point_ws, max_distance_m, skip);
    }
    std::optional<SurfacePoint> closest_point_on(std::uint64_t id, const Vec3& point_ws) const {
        return surfaces->closest_point_on(id, point_ws);
    }
};

constexpr int k_frames_between_searches = 6;  // at 90 Hz

// Moves the head and chest to where a tracker with noise sees them.
void track(HangingBody& body, const Vec3& offset_m, Random& random) {
    const Vec3 moved_m = offset_m + random.vector(0.0005);
    body.estimate.at(k_player).chest_ps.position = Vec3(0.0, 1.4, 0.0) + moved_m;
    body.head.at(k_player).pose_ps.position = Vec3(0.0, 1.65, -0.08) + moved_m;
}

TEST(BodySearches, RepeatWhenAPartOrANearSurfaceHasMovedAndOnlyThen) {
    CountedSurfaces surfaces(test::pose_at(Vec3(0.0, 1.0, 0.62)));
    HangingBody body;
    body.surfaces = SurfaceQuery(surfaces);
    Random random(31);
    const auto casts_in = [&](int frames, const Vec3& offset_m) {
        (void)surfaces.take_casts();
        for (int i = 0; i < frames; ++i) {
            track(body, offset_m, random);
            body.step(1.0 / 90.0);
        }
        return surfaces.take_casts();
    };
    const auto k_parts = static_cast<int>(k_body_parts);
    EXPECT_GE(casts_in(450, Vec3::Zero()), k_parts);  // until the body hangs still
    EXPECT_LE(casts_in(180, Vec3::Zero()), k_parts);  // 30 times fewer than without the rule
    EXPECT_GE(casts_in(k_frames_between_searches, Vec3(0.0, 0.03, 0.0)), k_parts);
    (void)casts_in(450, Vec3(0.0, 0.03, 0.0));
    surfaces.place(Vec3(0.0, 1.0, 18.0));
    EXPECT_LE(casts_in(90, Vec3(0.0, 0.03, 0.0)), k_parts);
    surfaces.place(Vec3(0.0, 0.9, -0.3));
    EXPECT_GE(casts_in(k_frames_between_searches, Vec3(0.0, 0.03, 0.0)), k_parts);
}

TEST(BodySearches, FewerOfThemLetNoJointDeeperIntoAWall) {
    constexpr double k_moved_m = 0.005;  // so far a part may move before it is searched again
    Random random(37);
    int casts = 0;
    int all_casts = 0;
    for (int round = 0; round < 30; ++round) {
        const Vec3 face{random.between(-0.3, 0.3), 0.0, random.between(0.1, 0.4)};
        const Pose wall{Vec3(0.0, 1.0, 0.5) + face, rotation_from_vector(random.vector(0.4))};
        const auto deepest_m = [&](const HangingBody& body) {
            double depth_m = -1.0;
            for (const Vec3& joint : joints_of(body.spine_pose.at(k_player))) {
                depth_m = std::max(depth_m, 0.5 + inverse_transform_point(wall, joint).z());
            }
            return depth_m;
        };
        CountedSurfaces surfaces(wall);
        const SilentSurfaces silent{&surfaces};
        HangingBody kept;
        HangingBody searched;
        kept.surfaces = SurfaceQuery(surfaces);
        searched.surfaces = SurfaceQuery(silent);
        double kept_m = -1.0;
        double searched_m = -1.0;
        for (int i = 0; i < 270; ++i) {
            const std::uint64_t seed = random.engine()();
            const Vec3 offset_m(0.0, 0.0, 0.002 * std::clamp(i - 150, 0, 60));
            for (HangingBody* body : {&kept, &searched}) {
                Random noise(seed);
                track(*body, offset_m, noise);
                (void)surfaces.take_casts();
                body->step(1.0 / 90.0);
                (body == &kept ? casts : all_casts) += surfaces.take_casts();
            }
            kept_m = std::max(kept_m, deepest_m(kept));
            searched_m = std::max(searched_m, deepest_m(searched));
        }
        EXPECT_LT(kept_m, searched_m + k_moved_m) << round;
    }
    EXPECT_LT(4 * casts, 3 * all_casts);  // 0.45 to 0.58 of them with 20 seeds
}

}  // namespace
}  // namespace handhold::body_searches_test
