// The game's clips, and sessions that play them.
#include "game/assets/body_clips_asset.hpp"

#include <gtest/gtest.h>

#include "game/assets/assets.hpp"
#include "game/play/desktop_session.hpp"
#include "systems/rigs/body_clips_json.hpp"
#include "systems/snapshot/snapshot.hpp"
#include "tests/game/climber/climber_scene.hpp"

namespace handhold::body_clips_asset_test {
namespace {

BodyClips game_body_clips() {
    return parse_body_clips(game_asset("body_clips.json"), "body_clips.json").value();
}

TEST(BodyClipsAsset, HasEveryClip) {
    const BodyClips clips = game_body_clips();
    for (std::size_t i = 0; i < k_body_clip_count; ++i) {
        EXPECT_GE(clips.clips[i].keys.size(), 3U) << i;
    }
    EXPECT_FALSE(clips.reach.empty());
}

// Idle loops, and a push-off ends with a zero offset.
TEST(BodyClipsAsset, BeginsAndEndsWithTheBodyAsItIs) {
    const BodyClips clips = game_body_clips();
    for (const BodyClipName name : {BodyClipName::idle, BodyClipName::push_off}) {
        for (const ClipKey* key : {&clips.at(name).keys.front(), &clips.at(name).keys.back()}) {
            for (const Vec3& turn : key->turns) {
                EXPECT_EQ(turn, Vec3::Zero());
            }
        }
    }
}

// A drifting player's spine differs from the one without clips, and a restored state continues with
// the clips.
TEST(BodyClipsAsset, SnapshotsGoOnWithThem) {
    const auto drift = [](World& world, FrameCaches& caches, const Tuning& tuning, Entity player,
                          int frames) {
        StageStats stats;
        for (int i = 0; i < frames; ++i) {
            TrackingSample sample;
            sample.t_s = world.clock.t_s + 1.0 / 90.0;
            sample.head_ps.position = Vec3(0.0, 1.62, 0.0);
            sample.controllers[0].controller_ps.position = Vec3(-0.25, 1.0, -0.3);
            sample.controllers[1].controller_ps.position = Vec3(0.25, 1.0, -0.3);
            const PlayerInput input{player, {&sample, 1}, {}};
            step_frame(world, caches, tuning, {1.0 / 90.0, {&input, 1}}, stats);
        }
    };
    Scene scene = make_void();
    const PlayerEntities player = add_scene_player(scene, {"player0", {}, 80.0});
    FrameCaches caches(scene.shapes(), &scene.grip_meshes());
    caches.body_clips = game_body_clips();
    drift(scene.world(), caches, scene.tuning(), player.player, 130);
    const SnapshotAssets assets(scene.shapes());
    std::vector<std::byte> bytes;
    save_snapshot(scene.world(), assets, bytes);

    World again;
    ASSERT_FALSE(restore_snapshot(bytes, assets, again));
    World bare;
    ASSERT_FALSE(restore_snapshot(bytes, assets, bare));
    FrameCaches fresh(scene.shapes(), &scene.grip_meshes());
    fresh.body_clips = game_body_clips();
    FrameCaches none(scene.shapes(), &scene.grip_meshes());
    drift(scene.world(), caches, scene.tuning(), player.player, 200);
    drift(again, fresh, scene.tuning(), player.player, 200);
    drift(bare, none, scene.tuning(), player.player, 200);
    EXPECT_EQ(hash_state(again), hash_state(scene.world()));
    const auto foot = [&](const World& world) {
        return world.render_pose.at(player.player).spine.legs[0].foot_ws.position;
    };
    EXPECT_GT((foot(bare) - foot(scene.world())).norm(), 1e-3);
}

}  // namespace
}  // namespace handhold::body_clips_asset_test
