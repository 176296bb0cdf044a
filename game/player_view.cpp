#include "game/player_view.hpp"

#include "game/scene_picture.hpp"

namespace handhold {
namespace {

constexpr Color k_ray_color = {0.1F, 0.75F, 1.0F};
constexpr Color k_hit_color = {0.2F, 1.0F, 0.35F};
constexpr Color k_constraint_color = {1.0F, 0.55F, 0.05F};

}  // namespace

PlayerView::PlayerView(const Scene& scene, PlayerModels models, Renderer renderer)
    : scene_(&scene),
      renderer_(std::move(renderer)),
      hands_(std::move(models.hands), renderer_),
      body_(std::move(models.body), renderer_) {
    visuals_ = add_scene_meshes(scene, renderer_);
    if (models.controllers) {
        controllers_.emplace(*models.controllers, hands_, renderer_);
    }
}

std::optional<PlayerView> PlayerView::open(const Scene& scene, PlayerModels models, int width_px,
                                           int height_px, std::string& why_not,
                                           PictureQuality quality) {
    std::optional<Renderer> renderer = Renderer::create(width_px, height_px, why_not, quality);
    if (!renderer) {
        return std::nullopt;
    }
    return PlayerView(scene, std::move(models), std::move(*renderer));
}

void PlayerView::add_figure(const BodyMeasures& measures, const RenderPose& render,
                            BodyFigures::Seen seen, RenderFrame& frame) {
    body_.add(measures, render, seen, renderer_, frame);
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        const RenderPose::Hand& hand = render.hands[side];
        const bool grips = hand.grip != GripKind::none;
        const auto which = static_cast<HandSide>(side);
        const bool holds_controller = controllers_.has_value() && !grips;
        hands_.add(which, hand.shown_ws,
                   holds_controller ? controllers_->fingers(which) : hand.fingers, renderer_,
                   frame);
        if (holds_controller) {
            controllers_->add(which, hand.shown_ws, frame);
        }
        frame.lines.push_back(
            {hand.ray_from_ws, hand.ray_to_ws, grips ? k_hit_color : k_ray_color, 2.0});
        if (grips) {
            frame.lines.push_back(
                {render.head_ws.position, hand.shown_ws.position, k_constraint_color, 1.5});
            frame.lines.push_back(
                {hand.tracked_ws.position, hand.shown_ws.position, k_constraint_color, 4.0});
        }
    }
}

RenderFrame PlayerView::make_frame(const Camera& camera, std::optional<std::size_t> without_head,
                                   std::span<const Line> marks) {
    RenderFrame frame = make_scene_frame(*scene_, visuals_);
    hands_.begin();
    body_.begin();
    const Column<RenderPose>& players = scene_->world.render_pose;
    for (std::size_t i = 0; i < players.size(); ++i) {
        using enum BodyFigures::Seen;
        add_figure(scene_->world.body_measures.at(players.owners()[i]), players.rows()[i],
                   without_head == i ? by_himself : by_others, frame);
    }
    frame.lines.insert(frame.lines.end(), marks.begin(), marks.end());
    frame.camera = camera;
    return frame;
}

void PlayerView::draw(const Pose& camera_ws, double vertical_fov_rad,
                      std::optional<std::size_t> without_head, Image& out,
                      std::span<const Line> marks, const UiPicture* ui) {
    Camera camera;
    camera.pose_ws = camera_ws;
    camera.vertical_fov_rad = vertical_fov_rad;
    renderer_.draw(make_frame(camera, without_head, marks), out, ui);
}

void PlayerView::draw_eye(const Camera& eye, std::size_t whose, std::uint32_t texture, Image* copy,
                          const UiPicture* ui) {
    renderer_.draw_into(texture, make_frame(eye, whose, {}), copy, ui);
}

}  // namespace handhold
