// Panels in pictures: their positions, without a window.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "game/mesh/primitives.hpp"
#include "game/render/renderer.hpp"
#include "game/render/ui_picture.hpp"
#include "game/ui/hud.hpp"
#include "game/ui/inspector.hpp"
#include "game/ui/menu.hpp"
#include "game/ui/overlay.hpp"
#include "tests/game/climber/climber_scene.hpp"

namespace handhold::panels_test {
namespace {

constexpr std::array<std::uint8_t, 4> k_red = {255, 0, 0, 255};

// A red rectangle, visible only inside the clip rectangle.
UiPicture make_rectangle(float left, float top, float right, float bottom,
                         const std::array<int, 4>& clip_px) {
    UiPicture ui;
    for (const auto& place : {std::array{left, top}, std::array{right, top},
                              std::array{right, bottom}, std::array{left, bottom}}) {
        ui.vertices.push_back({place, {0.5F, 0.5F}, k_red});
    }
    ui.indices = {0, 1, 2, 0, 2, 3};
    ui.commands.push_back({clip_px, 0, 6});
    ui.glyphs = {1, 1, {255, 255, 255, 255}};
    ui.glyphs_revision = 1;
    return ui;
}

bool is_red(const Image& image, int x, int y) {
    const std::uint8_t* const pixel = image.pixel(x, y);
    return pixel[0] > 200 && pixel[1] < 40 && pixel[2] < 40;
}

TEST(UiPainter, DrawsFromTheUpperLeftCornerAndClips) {
    for (const PictureQuality quality :
         {PictureQuality::plain, PictureQuality::quick, PictureQuality::fine}) {
        std::string why_not;
        auto renderer = Renderer::create(64, 48, why_not, quality);
        if (!renderer) {
            GTEST_SKIP() << why_not;
        }
        const UiPicture ui = make_rectangle(8.0F, 4.0F, 40.0F, 20.0F, {0, 0, 24, 48});
        Image image;
        renderer->draw({}, image, &ui);
        for (int y = 0; y < 48; ++y) {
            for (int x = 0; x < 64; ++x) {
                const bool inside = x >= 8 && x < 24 && y >= 4 && y < 20;
                ASSERT_EQ(is_red(image, x, y), inside) << x << ", " << y;
            }
        }
        renderer->draw({}, image);
        EXPECT_FALSE(is_red(image, 10, 10));  // nothing is left of it
    }
}

struct Panels : testing::Test {
    DesktopSession session{make_tunnel(6.0), hh::pose_at({-0.45, 0.35 - 1.6, 2.0})};
    SessionHistory history;
    PlayTally tally;
    InspectorMemory memory;
    Overlay overlay{640, 360};

    void play(int frames) {
        DesktopInput input;
        input.turn_left_rad = 0.02;
        for (int i = 0; i < frames; ++i) {
            history.step(session, input);
            tally.add_frame(session.world(), session.player(), 50.0, DesktopSession::k_dt_s);
        }
    }
    InspectorView view() { return {session, history, tally, memory}; }
};

TEST_F(Panels, InspectorPagesDrawWithoutChangingState) {
    play(30);
    const std::uint64_t hash = session.world().hash();
    for (const char* const page : {"Frame", "Hands", "Bodies", "Tuning", "Entities", "Gizmos"}) {
        memory.turn_to = page;
        std::size_t triangles = 0;
        for (int i = 0; i < 3; ++i) {  // a page switch takes effect in the next picture
            overlay.begin({}, 0.01);
            show_inspector(view());
            triangles = overlay.end().indices.size() / 3;
        }
        EXPECT_GT(triangles, 400U) << page;
    }
    EXPECT_EQ(session.world().hash(), hash);
}

// Vertices of panels lie inside the picture, so drawing them needs no scissor.
TEST_F(Panels, HelpMarkAndPauseFitThePicture) {
    Hud hud;
    hud.paused = true;
    hud.rewound_s = 1.5;
    for (int i = 0; i < 2; ++i) {
        overlay.begin({}, 0.01);
        show_hud(hud);
        const UiPicture& ui = overlay.end();
        ASSERT_FALSE(ui.commands.empty());
        for (const UiVertex& vertex : ui.vertices) {
            EXPECT_GE(vertex.place_px[0], -1.0F);
            EXPECT_LE(vertex.place_px[0], 641.0F);
            EXPECT_GE(vertex.place_px[1], -1.0F);
            EXPECT_LE(vertex.place_px[1], 361.0F);
        }
    }
}

TEST_F(Panels, ClickOnASceneInTheMenuChoosesIt) {
    PlaySettings settings;
    std::string chosen;
    // Clicks down the left side of the menu until something is chosen. Starts below the heading,
    // which would close the menu; clicks slowly, since title bars react to double clicks.
    for (float y = 64.0F; y < 340.0F && chosen.empty(); y += 4.0F) {
        for (const bool down : {false, true, false}) {
            UiInput input;
            input.mouse_px = {50.0F, y};
            input.buttons[0] = down;
            overlay.begin(input, 0.5);
            const MenuChoice choice = show_menu("robot", settings);
            chosen = choice.scene.empty() ? chosen : choice.scene;
            overlay.end();
        }
    }
    EXPECT_EQ(chosen, "station");  // the first in the list
}

// A sheet 2 m ahead, facing the camera. A pinhole projects its corners at half its size times the
// focal length over 2 m from the picture's centre; the first row is at the top.
TEST(UiPainter, DrawsASheetByPinholeProjectionBehindOccluders) {
    constexpr int k_size_px = 64;
    for (const PictureQuality quality :
         {PictureQuality::plain, PictureQuality::quick, PictureQuality::fine}) {
        std::string why_not;
        auto renderer = Renderer::create(k_size_px, k_size_px, why_not, quality);
        if (!renderer) {
            GTEST_SKIP() << why_not;
        }
        // Only the upper left quarter of a sheet of 40 x 20 pixels and 1 m is red.
        const UiPicture ui = make_rectangle(0.0F, 0.0F, 40.0F, 20.0F, {0, 0, 20, 10});
        RenderFrame frame;
        frame.camera.vertical_fov_rad = 2.0 * std::atan(0.5);  // as wide at 2 m as the distance
        frame.sheet = Sheet{&ui, {40, 20}, {Vec3(0.0, 0.0, -2.0), Quat::Identity()}, 1.0};
        Image image;
        renderer->draw(frame, image);
        for (int y = 0; y < k_size_px; ++y) {
            for (int x = 0; x < k_size_px; ++x) {
                const bool inside = x >= 16 && x < 32 && y >= 24 && y < 32;
                ASSERT_EQ(is_red(image, x, y), inside) << x << ", " << y;
            }
        }
        // A box in front of its left half.
        frame.instances.push_back({renderer->add_mesh(make_box(Vec3(0.1, 0.5, 0.1))),
                                   {Vec3(-0.25, 0.0, -1.0), Quat::Identity()},
                                   {},
                                   {}});
        renderer->draw(frame, image);
        EXPECT_FALSE(is_red(image, 18, 28));
        frame.instances[0].pose_ws.position.z() = -3.0;
        renderer->draw(frame, image);
        EXPECT_TRUE(is_red(image, 18, 28));
    }
}

}  // namespace
}  // namespace handhold::panels_test
