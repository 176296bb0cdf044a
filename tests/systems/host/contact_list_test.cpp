// Contacts, names of events, and levels from glTF in the C interface.
#include <array>
#include <string>
#include <string_view>

#include <gtest/gtest.h>
#include <handhold/handhold.hpp>

#include "tests/systems/host/host_scene.hpp"

namespace handhold::host_contact_list_test {
namespace {

using namespace test;

// A resting body is carried by impulses that add up to m g dt.
TEST(HostContacts, OfARestingCrateCarryItsWeight) {
    HostScene scene;
    ASSERT_EQ(hh_world_set_gravity(scene.world.get(), {0.0, -9.81, 0.0}), HH_OK);
    hh_body_def floor = hh::body_def();
    floor.shape = *scene.world.add_box({1.0, 0.1, 1.0});
    floor.pose.position = {5.0, -0.1, 0.0};
    const hh::Body ground = *scene.world.add(floor);
    const hh::Body resting = *scene.world.add(crate(scene.world, {5.0, 0.1, 0.0}));
    scene.step(60);
    std::array<hh_contact, 16> contacts{};
    std::size_t count = 0;
    ASSERT_EQ(hh_world_contacts(scene.world.get(), contacts.data(), contacts.size(), &count),
              HH_OK);
    ASSERT_GT(count, 0U);
    double impulse_ns = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const hh_contact& contact = contacts[i];
        const bool is_crate_a = contact.body_a.index == resting.index;
        EXPECT_EQ((is_crate_a ? contact.body_b : contact.body_a).index, ground.index);
        EXPECT_NEAR(contact.normal.y, is_crate_a ? 1.0 : -1.0, 1e-6);
        EXPECT_NEAR(contact.point.y, 0.0, 1e-3);
        EXPECT_NEAR(contact.depth_m, 0.0, 1e-3);
        impulse_ns += contact.impulse_ns;
    }
    EXPECT_NEAR(impulse_ns, 2.0 * 9.81 * k_step_s, 1e-3);
    EXPECT_EQ(hh_world_contacts(scene.world.get(), contacts.data(), 0, &count), HH_ERROR_CAPACITY);
    hh_world_stats stats = hh_default_world_stats();
    ASSERT_EQ(hh_world_get_stats(scene.world.get(), &stats), HH_OK);
    if (stats.deepest_a.generation != 0) {
        EXPECT_TRUE(stats.deepest_a.index == resting.index ||
                    stats.deepest_a.index == ground.index);
    }
}

TEST(HostNames, EveryEventAndReasonHasOne) {
    for (int kind = 0; kind <= HH_EVENT_RECENTRED; ++kind) {
        EXPECT_NE(hh_event_kind_name(static_cast<hh_event_kind>(kind)), nullptr) << kind;
    }
    for (int reason = 0; reason <= HH_REASON_OTHER_HAND; ++reason) {
        EXPECT_NE(hh_reason_name(static_cast<hh_reason>(reason)), nullptr) << reason;
    }
    EXPECT_EQ(std::string_view(hh_event_kind_name(HH_EVENT_SLIPPED)), "slipped");
    EXPECT_EQ(std::string_view(hh_reason_name(HH_REASON_BY_HOST)), "by_host");
    EXPECT_EQ(hh_event_kind_name(static_cast<hh_event_kind>(99)), nullptr);
    EXPECT_EQ(hh_reason_name(static_cast<hh_reason>(99)), nullptr);
}

TEST(HostLevels, AGltfFileBecomesStaticBodiesInOneCall) {
    // Two nodes with the triangle (0, 0, 0), (1, 0, 0), (0, 1, 0); the second is 3 m ahead.
    const std::string level =
        R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],)"
        R"("nodes":[{"name":"panel","mesh":0},{"name":"panel","mesh":0,"translation":[0,0,-3]}],)"
        R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
        R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",)"
        R"("min":[0,0,0],"max":[1,1,0]}],"bufferViews":[{"buffer":0,"byteLength":36}],)"
        R"("buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,)"
        R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
    HostScene scene;
    hh_world* const world = scene.world.get();
    std::array<hh::Body, 2> bodies{};
    std::size_t count = 0;
    EXPECT_EQ(hh_world_add_gltf_level(world, level.data(), level.size(), hh_identity_pose(),
                                      bodies.data(), 1, &count),
              HH_ERROR_CAPACITY);
    EXPECT_EQ(count, 2U);
    ASSERT_EQ(hh_world_add_gltf_level(world, level.data(), level.size(), hh::pose_at({0, 0, -2.0}),
                                      bodies.data(), bodies.size(), &count),
              HH_OK)
        << hh_last_error();
    const char* name = nullptr;
    ASSERT_EQ(hh_body_name(world, bodies[1], &name), HH_OK);
    EXPECT_EQ(std::string_view(name), "panel 2");
    hh_hit hit{};
    ASSERT_EQ(hh_world_cast_ray(world, {0.2, 0.2, 0.0}, {0.2, 0.2, -9.0}, {}, &hit), HH_OK);
    EXPECT_NEAR(hit.distance_m, 2.0, 1e-9);
    EXPECT_EQ(hit.body.index, bodies[0].index);
    EXPECT_EQ(hh_world_add_gltf_level(world, "{}", 2, hh_identity_pose(), nullptr, 0, &count),
              HH_ERROR_DATA);
    EXPECT_EQ(std::string_view(hh_last_error()).substr(0, 6), "level:") << hh_last_error();
    // A level that is refused adds neither bodies nor shapes.
    std::size_t before = 0;
    ASSERT_EQ(hh_world_shape_count(world, &before), HH_OK);
    EXPECT_NE(hh_world_add_gltf_level(world, level.data(), level.size(), hh::pose_at({0, 0, -1e12}),
                                      nullptr, 0, &count),
              HH_OK);
    std::size_t after = 0;
    ASSERT_EQ(hh_world_shape_count(world, &after), HH_OK);
    EXPECT_EQ(after, before);
}

}  // namespace
}  // namespace handhold::host_contact_list_test
