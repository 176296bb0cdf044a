// Pictures of the renderer, checked by where objects must appear. A pinhole camera puts a point at
// x = w/2 (1 + X / (-Z tan(fov/2) w/h)), y = h/2 (1 - Y / (-Z tan(fov/2))) (X, Y, Z in its axes).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

#include <gtest/gtest.h>

#include "engine/core/check.hpp"
#include "game/mesh/primitives.hpp"
#include "game/render/renderer.hpp"

namespace handhold::render_picture_test {
namespace {

constexpr int k_width_px = 160;
constexpr int k_height_px = 120;

class RenderPicture : public testing::Test {
  protected:
    void SetUp() override {
        std::string why_not;
        renderer_ = Renderer::create(k_width_px, k_height_px, why_not);
        if (!renderer_) {
            GTEST_SKIP() << "no picture can be drawn here: " << why_not;
        }
    }
    Image draw(const RenderFrame& frame) {
        Image image;
        renderer_->draw(frame, image);
        return image;
    }
    Instance box(const Vec3& center, const Vec3& half_m, const Color& color) {
        return {renderer_->add_mesh(make_box(half_m)), {center, Quat::Identity()}, color, {}};
    }

    std::optional<Renderer> renderer_;
};

enum class Seen { nothing, red, green, other };

Seen seen_at(const Image& image, int x, int y) {
    const std::uint8_t* p = image.pixel(x, y);
    const int strongest = std::max({p[0], p[1], p[2]});
    if (strongest < 8) {
        return Seen::nothing;
    }
    if (p[0] > 2 * p[1] && p[0] > 2 * p[2]) {
        return Seen::red;
    }
    return p[1] > 2 * p[0] && p[1] > 2 * p[2] ? Seen::green : Seen::other;
}

// The frame of most tests: black, no haze, the camera at the origin.
RenderFrame black_frame() {
    RenderFrame frame;
    frame.haze_per_m = 0.0F;
    frame.camera.vertical_fov_rad = 1.0;
    return frame;
}

constexpr Color k_red = {0.8F, 0.02F, 0.02F};
constexpr Color k_green = {0.02F, 0.8F, 0.02F};

double mean_difference(const Image& a, const Image& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) {
        sum += std::abs(static_cast<int>(a.rgba[i]) - static_cast<int>(b.rgba[i]));
    }
    return sum / static_cast<double>(a.rgba.size());
}

TEST_F(RenderPicture, EmptyFrameIsTheBackgroundEverywhere) {
    const Image image = draw(black_frame());
    ASSERT_EQ(image.width_px, k_width_px);
    ASSERT_EQ(image.height_px, k_height_px);
    for (int y = 0; y < k_height_px; ++y) {
        for (int x = 0; x < k_width_px; ++x) {
            const std::uint8_t* p = image.pixel(x, y);
            ASSERT_EQ(std::max({p[0], p[1], p[2]}), 0) << x << ", " << y;
            ASSERT_EQ(p[3], 255);
        }
    }
}

TEST_F(RenderPicture, RedBoxCoversTheRectangleThatItsFrontFaceProjectsTo) {
    RenderFrame frame = black_frame();
    const Vec3 center(0.3, 0.2, -2.0);
    const Vec3 half(0.25, 0.15, 0.01);
    frame.instances.push_back(box(center, half, k_red));
    const Image image = draw(frame);
    const double front = -(center.z() + half.z());
    const double scale = 0.5 * k_height_px / std::tan(0.5) / front;
    const double left = 0.5 * k_width_px + scale * (center.x() - half.x());
    const double right = 0.5 * k_width_px + scale * (center.x() + half.x());
    const double top = 0.5 * k_height_px - scale * (center.y() + half.y());
    const double bottom = 0.5 * k_height_px - scale * (center.y() - half.y());
    constexpr double k_margin_px = 2.0;  // edges are smoothed over two pixels
    for (int y = 0; y < k_height_px; ++y) {
        for (int x = 0; x < k_width_px; ++x) {
            const double px = x + 0.5;
            const double py = y + 0.5;
            if (px > left + k_margin_px && px < right - k_margin_px && py > top + k_margin_px &&
                py < bottom - k_margin_px) {
                ASSERT_EQ(seen_at(image, x, y), Seen::red) << x << ", " << y;
            } else if (px < left - k_margin_px || px > right + k_margin_px ||
                       py < top - k_margin_px || py > bottom + k_margin_px) {
                ASSERT_EQ(seen_at(image, x, y), Seen::nothing) << x << ", " << y;
            }
        }
    }
}

TEST_F(RenderPicture, NearerBoxHidesFartherOneInEitherOrder) {
    const Instance near = box(Vec3(0.0, 0.0, -1.0), Vec3(0.1, 0.1, 0.1), k_red);
    const Instance far = box(Vec3(0.0, 0.0, -2.0), Vec3(0.6, 0.6, 0.1), k_green);
    for (const bool near_first : {true, false}) {
        RenderFrame frame = black_frame();
        frame.instances =
            near_first ? std::vector<Instance>{near, far} : std::vector<Instance>{far, near};
        const Image image = draw(frame);
        EXPECT_EQ(seen_at(image, k_width_px / 2, k_height_px / 2), Seen::red);
        // 0.4 m off the centre of the far box's face, 1.9 m away: beside the near box.
        const int x = k_width_px / 2 + static_cast<int>(0.4 * 60.0 / std::tan(0.5) / 1.9);
        EXPECT_EQ(seen_at(image, x, k_height_px / 2), Seen::green);
    }
}

TEST_F(RenderPicture, BothSidesOfATriangleAreLitEqually) {
    Mesh sheet;
    sheet.positions = {Vec3(-0.5, -0.5, 0.0), Vec3(0.5, -0.5, 0.0), Vec3(0.0, 0.5, 0.0)};
    sheet.triangles = {{0, 1, 2}};
    Mesh turned = sheet;
    turned.triangles = {{0, 2, 1}};
    RenderFrame frame = black_frame();
    frame.instances = {
        {renderer_->add_mesh(sheet), {Vec3(0, 0, -1.5), Quat::Identity()}, k_red, {}}};
    const Image front = draw(frame);
    frame.instances[0].mesh = renderer_->add_mesh(turned);
    EXPECT_LT(mean_difference(front, draw(frame)), 0.01);
    EXPECT_EQ(seen_at(front, k_width_px / 2, k_height_px / 2), Seen::red);
}

// A small scene with every kind of input, moved as a whole.
RenderFrame scene_at(Renderer& renderer, const Vec3& place) {
    RenderFrame frame;
    frame.camera.pose_ws =
        look_along(place + Vec3(0.4, 0.5, 1.6), Vec3(-0.2, -0.3, -1.0), Vec3::UnitY());
    const auto put = [&](const Mesh& mesh, const Vec3& at, const Look& look) {
        frame.instances.push_back(
            {renderer.add_mesh(mesh), {place + at, Quat::Identity()}, std::nullopt, look});
    };
    put(make_box(Vec3(1.0, 0.05, 1.0)), Vec3(0.0, -0.3, 0.0), {});
    put(make_sphere(0.25), Vec3(-0.3, 0.0, 0.0), {});
    put(make_rock(0.2, 1), Vec3(0.4, 0.0, 0.1), {});
    put(make_box(Vec3(0.3, 0.3, 0.01)), Vec3(0.2, 0.1, 0.6), {0.0F, 0.2F, 0.9F});
    frame.lines.push_back({place + Vec3(-0.5, 0.1, 0.3), place + Vec3(0.5, 0.3, 0.2)});
    frame.lamps.push_back({place + Vec3(0.5, 0.8, 0.3), {0.7F, 0.6F, 0.5F}, 3.0});
    return frame;
}

TEST_F(RenderPicture, TenKilometresFromTheOriginLooksLikeTheOrigin) {
    const Image here = draw(scene_at(*renderer_, Vec3::Zero()));
    const Image there = draw(scene_at(*renderer_, Vec3(10000.0, -7000.0, 4000.0)));
    EXPECT_LT(mean_difference(here, there), 1.0);
    EXPECT_GT(mean_difference(here, draw(black_frame())), 20.0);  // the picture shows something
}

TEST_F(RenderPicture, SameFrameGivesTheSameBytes) {
    const RenderFrame frame = scene_at(*renderer_, Vec3::Zero());
    EXPECT_EQ(draw(frame).rgba, draw(frame).rgba);
}

TEST_F(RenderPicture, LineShowsInFrontAndFaintlyBehind) {
    RenderFrame frame = black_frame();
    frame.instances.push_back(box(Vec3(0.5, 0.0, -2.0), Vec3(0.4, 0.6, 0.05), {0.0F, 0.0F, 0.02F}));
    Line line;
    line.a_ws = Vec3(-1.0, 0.0, -3.0);
    line.b_ws = Vec3(1.0, 0.0, -3.0);
    line.color = {0.0F, 1.0F, 0.0F};
    line.width_px = 5.0;
    frame.lines.push_back(line);
    const Image image = draw(frame);
    const int free_x = k_width_px / 2 - 20;
    const int hidden_x = k_width_px / 2 + 25;
    const int open = image.pixel(free_x, k_height_px / 2)[1];
    const int hidden = image.pixel(hidden_x, k_height_px / 2)[1];
    EXPECT_GT(open, 220);
    EXPECT_GT(hidden, 15);
    EXPECT_LT(hidden, open / 2);
    EXPECT_LT(image.pixel(free_x, k_height_px / 2 - 12)[1], 15);
}

TEST_F(RenderPicture, LineFromBehindTheCameraIsClippedAndDrawn) {
    RenderFrame frame = black_frame();
    frame.lines.push_back({Vec3(0.0, -0.1, 1.0), Vec3(0.0, 0.0, -4.0)});
    const Image image = draw(frame);
    EXPECT_NE(seen_at(image, k_width_px / 2, k_height_px / 2 + 3), Seen::nothing);
}

TEST_F(RenderPicture, KeyLightCastsAShadow) {
    RenderFrame frame = black_frame();
    frame.camera.pose_ws = look_along(Vec3(0.0, 2.0, 0.02), Vec3(0.0, -1.0, 0.0), -Vec3::UnitZ());
    frame.key.towards_ws = Vec3(1.0, 1.0, 0.0);
    frame.key.caster_reach_m = 3.0;
    frame.instances.push_back(box(Vec3(0, -0.05, 0), Vec3(1, 0.05, 1), {0.6F, 0.6F, 0.6F}));
    frame.instances.push_back(box(Vec3(0.5, 0.5, 0), Vec3(0.1, 0.01, 0.1), {0.6F, 0.6F, 0.6F}));
    const Image image = draw(frame);
    // Light at 45 degrees: the small plate at height 0.5 shadows the floor around x = 0.
    const double scale = 60.0 / std::tan(0.5) / 2.0;
    const auto at = [&](double x) {
        return static_cast<int>(image.pixel(static_cast<int>(80 + scale * x), 60)[1]);
    };
    EXPECT_LT(at(0.0), at(-0.5) - 25);
}

TEST_F(RenderPicture, SkipsInstancesAndLinesThatAreNotFinite) {
    RenderFrame frame = black_frame();
    constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
    const Instance broken = box(Vec3(k_nan, 0.0, -1.0), Vec3(0.1, 0.1, 0.1), k_red);
    frame.instances = {broken, box(Vec3(0.0, 0.0, -1.0), Vec3(0.1, 0.1, 0.1), k_green)};
    frame.lines.push_back(
        {Vec3(0.0, std::numeric_limits<double>::infinity(), 0.0), Vec3(0.0, 0.0, -1.0)});
    const Image image = draw(frame);
    EXPECT_EQ(seen_at(image, k_width_px / 2, k_height_px / 2), Seen::green);
}

TEST_F(RenderPicture, InstancesOutOfSightAreCulled) {
    RenderFrame frame = black_frame();
    frame.instances = {box(Vec3(0, 0, -2), Vec3(0.1, 0.1, 0.1), k_red),
                       box(Vec3(0, 0, 5), Vec3(0.1, 0.1, 0.1), k_red),
                       box(Vec3(9, 0, -2), Vec3(0.1, 0.1, 0.1), k_red)};
    draw(frame);
    EXPECT_EQ(renderer_->counters().instances_seen, 1);
    EXPECT_EQ(renderer_->counters().instances_given, 3);
}

TEST_F(RenderPicture, SecondRendererDoesNotAffectTheFirst) {
    RenderFrame frame = black_frame();
    frame.instances.push_back(box(Vec3(0, 0, -1), Vec3(0.1, 0.1, 0.1), k_red));
    const Image before = draw(frame);
    {
        std::string why_not;
        std::optional<Renderer> other = Renderer::create(64, 64, why_not, PictureQuality::fine);
        ASSERT_TRUE(other) << why_not;
        Image small;
        other->draw(black_frame(), small);
        EXPECT_EQ(small.width_px, 64);
    }
    EXPECT_EQ(before.rgba, draw(frame).rgba);
}

TEST_F(RenderPicture, UnknownMeshIsRefused) {
    RenderFrame frame = black_frame();
    frame.instances.push_back({MeshId{77}, {}, std::nullopt, {}});
    Image image;
    EXPECT_THROW(renderer_->draw(frame, image), PreconditionError);
}

// A headset's eye: sides at distance 1 instead of an angle.
TEST_F(RenderPicture, AsymmetricFrustumProjectsByItsSides) {
    RenderFrame frame = black_frame();
    frame.camera.frustum = EyeFrustum{-0.9, 0.5, -0.6, 0.8};
    const Vec3 center(0.2, 0.5, -2.0);
    frame.instances = {box(center, Vec3::Constant(0.03), {1.0F, 0.0F, 0.0F})};
    const Image image = draw(frame);
    const int x = static_cast<int>((0.1 + 0.9) / 1.4 * k_width_px);
    const int y = static_cast<int>((0.8 - 0.25) / 1.4 * k_height_px);
    EXPECT_EQ(seen_at(image, x, y), Seen::red);
    EXPECT_EQ(seen_at(image, k_width_px / 2, k_height_px / 2), Seen::nothing);
    EXPECT_EQ(renderer_->counters().instances_seen, 1);
}

TEST_F(RenderPicture, FrustumFromAnAngleGivesTheSamePicture) {
    RenderFrame frame = black_frame();
    frame.backdrop = Backdrop::space;
    frame.instances = {box({0.3, -0.2, -1.5}, Vec3::Constant(0.2), {1.0F, 0.0F, 0.0F})};
    const Image by_angle = draw(frame);
    const double up = std::tan(0.5 * frame.camera.vertical_fov_rad);
    const double right = up * k_width_px / k_height_px;
    frame.camera.frustum = EyeFrustum{-right, right, -up, up};
    EXPECT_EQ(draw(frame).rgba, by_angle.rgba);
}

}  // namespace
}  // namespace handhold::render_picture_test
