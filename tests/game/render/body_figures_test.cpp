#include "game/render/body_figures.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "game/mesh/primitives.hpp"
#include "tests/game/climber/climber_scene.hpp"

namespace handhold::body_figures_test {
namespace {

constexpr int k_size_px = 96;

class BodyFiguresTest : public testing::Test {
  protected:
    void SetUp() override {
        std::string why_not;
        renderer_ = Renderer::create(k_size_px, k_size_px, why_not);
        if (!renderer_) {
            GTEST_SKIP() << "no picture can be drawn here: " << why_not;
        }
    }

    // A player at rest with eyes at `eyes`, looking along -Z.
    static RenderPose standing(const Vec3& eyes) {
        Scene scene = make_void();
        FrameCaches caches(scene.shapes(), &scene.grip_meshes());
        const PlayerEntities player = add_scene_player(
            scene, {"player0", {eyes - Vec3(0.0, 1.62, 0.0), Quat::Identity()}, 80.0});
        TrackingSample sample;
        sample.head_ps.position = Vec3(0.0, 1.62, 0.0);
        sample.controllers[0].controller_ps.position = Vec3(-0.25, 1.0, -0.3);
        sample.controllers[1].controller_ps.position = Vec3(0.25, 1.0, -0.3);
        StageStats stats;
        for (int i = 1; i <= 10; ++i) {
            sample.t_s = i / 90.0;
            const PlayerInput input{player.player, {&sample, 1}, {}};
            step_frame(scene.world(), caches, scene.tuning(), {1.0 / 90.0, {&input, 1}}, stats);
        }
        return scene.world().render_pose.at(player.player);
    }

    std::optional<Renderer> renderer_;
};

// Number of lit pixels in the picture's middle third, above row `y`.
int lit_above(const Image& image, int y) {
    int lit = 0;
    for (int row = 0; row < y; ++row) {
        for (int x = k_size_px / 3; x < 2 * k_size_px / 3; ++x) {
            const std::uint8_t* p = image.pixel(x, row);
            lit += std::max({p[0], p[1], p[2]}) > 8 ? 1 : 0;
        }
    }
    return lit;
}

TEST_F(BodyFiguresTest, OwnHeadIsHiddenAndOthersSeeIt) {
    BodyFigures figures(builtin_body_model(), *renderer_);
    const RenderPose player = standing(Vec3(0.0, 1.62, 0.0));
    int heads[2] = {};
    for (const auto seen : {BodyFigures::Seen::by_others, BodyFigures::Seen::by_himself}) {
        RenderFrame frame;
        figures.begin();
        figures.add({}, player, {}, seen, *renderer_, frame);
        frame.camera.pose_ws = look_along(Vec3(0.0, 1.6, -2.0), Vec3::UnitZ(), Vec3::UnitY());
        Image image;
        renderer_->draw(frame, image);
        heads[seen == BodyFigures::Seen::by_himself ? 1 : 0] = lit_above(image, k_size_px / 2);
        EXPECT_GT(lit_above(image, k_size_px), 100);
    }
    EXPECT_GT(heads[0], 50);
    EXPECT_LT(heads[1], heads[0] / 4);
}

TEST_F(BodyFiguresTest, PlayersHaveSeparateMeshesThatTheNextPictureReuses) {
    BodyFigures figures(builtin_body_model(), *renderer_);
    const RenderPose player = standing(Vec3(0.0, 1.62, 0.0));
    const auto draw = [&](int players) {
        RenderFrame frame;
        figures.begin();
        for (int i = 0; i < players; ++i) {
            figures.add({}, player, {}, BodyFigures::Seen::by_others, *renderer_, frame);
        }
        std::vector<MeshId> meshes;
        for (const Instance& instance : frame.instances) {
            meshes.push_back(instance.mesh);
        }
        std::sort(meshes.begin(), meshes.end());
        return meshes;
    };
    const std::vector<MeshId> two = draw(2);
    EXPECT_EQ(std::adjacent_find(two.begin(), two.end()), two.end());
    EXPECT_EQ(draw(2), two);
}

TEST(ChooseBodyModel, ErrorNamesWhatIsWrongWithAFile) {
    const Result<BodyModel> missing = choose_body_model("/nonexistent/figure.glb", "");
    ASSERT_FALSE(missing.ok());
    EXPECT_NE(missing.error().message().find("figure.glb"), std::string::npos);
}

}  // namespace
}  // namespace handhold::body_figures_test
