#include "game/view/player_view.hpp"

#include "game/levels/arena.hpp"
#include "game/view/scene_picture.hpp"
#include "game/view/snap_hint.hpp"
#include "systems/rigs/authored_hand.hpp"
#include "systems/rigs/hand_kinematics.hpp"

namespace handhold {
namespace {

constexpr Color k_ray_color = {0.1F, 0.75F, 1.0F};
constexpr Color k_hit_color = {0.2F, 1.0F, 0.35F};
constexpr Color k_pull_color = {0.75F, 0.35F, 1.0F};
constexpr Color k_constraint_color = {1.0F, 0.55F, 0.05F};

void add_hand_lines(const Vec3& head_ws, const RenderPose::Hand& hand, RenderFrame& frame) {
    const bool grips = hand.grip != GripKind::none;
    frame.lines.push_back(
        {hand.ray_from_ws, hand.ray_to_ws, grips ? k_hit_color : k_ray_color, 2.0});
    if (grips) {
        frame.lines.push_back({head_ws, hand.shown_ws.position, k_constraint_color, 1.5});
        frame.lines.push_back(
            {hand.tracked_ws.position, hand.shown_ws.position, k_constraint_color, 4.0});
    }
}

}  // namespace

PlayerView::PlayerView(const Scene& scene, PlayerModels models, Renderer renderer)
    : scene_(&scene),
      renderer_(std::move(renderer)),
      hands_(std::move(models.hands), renderer_),
      body_(std::move(models.body), renderer_),
      ghosts_(models.ghosts) {
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

ControlValues PlayerView::controls_of(std::size_t index, HandSide side) const {
    if (controls_ && controls_->index == index) {
        return controls_->values[index_of(side)];
    }
    const World& world = scene_->world();
    const Entity player = world.render_pose.owners()[index];
    for (std::size_t i = 0; i < world.hand_owner.size(); ++i) {
        const HandOwner& owner = world.hand_owner.elements()[i];
        if (owner.player == player && owner.side == side) {
            return closing_values(world.hand_tracking.at(world.hand_owner.owners()[i]).pressed);
        }
    }
    return k_controls_at_rest;
}

bool PlayerView::holds_controller(const RenderPose::Hand& hand) const {
    return controllers_.has_value() && hand.grip == GripKind::none;
}

std::array<FingerAngles, k_finger_count> PlayerView::fingers_of(
    HandSide side, const RenderPose::Hand& hand, const ControlValues& controls) const {
    return holds_controller(hand) ? controllers_->fingers(side, controls) : hand.fingers;
}

void PlayerView::add_hand(HandSide side, const RenderPose::Hand& hand, const Quat& forearm_ws,
                          const ControlValues& controls, RenderFrame& frame) {
    if (!body_.has_hands()) {
        hands_.add(side, hand.shown_ws, forearm_ws, fingers_of(side, hand, controls), renderer_,
                   frame);
    }
    if (holds_controller(hand)) {
        controllers_->add(side, hand.shown_ws, controls, frame);
    }
}

// Adds a ghost at the tracked pose, if the hand is shown elsewhere.
void PlayerView::add_ghost(HandSide side, const RenderPose::Hand& hand, bool is_lost,
                           RenderFrame& frame) {
    const auto share = static_cast<float>(ghost_share(hand, ghosts_));
    if (share <= 0.0F) {
        return;
    }
    std::array<FingerAngles, k_finger_count> open;
    for (std::size_t i = 0; i < hands_.rig(side).fingers.size(); ++i) {
        open[i] = relaxed_angles(hands_.rig(side).fingers[i]);
    }
    add_ghost_of(side, hand.tracked_ws, open,
                 {{},
                  {},
                  is_lost ? ghosts_.lost : ghosts_.tracked,
                  share * ghosts_.seen,
                  share * ghosts_.hidden},
                 frame);
}

// Shows an empty hand as it would grip the authored grip nearby.
void PlayerView::add_snap_hint(Entity hand, RenderFrame& frame) {
    const std::optional<SnapHint> hint =
        find_snap_hint(scene_->world(), hand, scene_->tuning().hand);
    if (!hint) {
        return;
    }
    const HandSide side = scene_->world().hand_owner.at(hand).side;
    const HandRig& rig = hands_.rig(side);
    std::array<FingerAngles, k_finger_count> posed;
    for (std::size_t i = 0; i < rig.fingers.size(); ++i) {
        posed[i] =
            posed_angles(rig.fingers[i], hint->hand).value_or(relaxed_angles(rig.fingers[i]));
    }
    const float strength = hint->is_within
                               ? ghosts_.snap_within
                               : static_cast<float>(2.0 * hint->nearness) * ghosts_.snap_near;
    add_ghost_of(side, hint->wrist_ws, posed, {{}, {}, ghosts_.snap, strength, 0.5F * strength},
                 frame);
}

void PlayerView::add_ghost_of(HandSide side, const Pose& wrist_ws,
                              const std::array<FingerAngles, k_finger_count>& fingers,
                              const Ghost& like, RenderFrame& frame) {
    ghost_parts_.instances.clear();
    hands_.add(side, wrist_ws, fingers, renderer_, ghost_parts_);
    for (const Instance& part : ghost_parts_.instances) {
        frame.ghosts.push_back(like);
        frame.ghosts.back().mesh = part.mesh;
        frame.ghosts.back().pose_ws = part.pose_ws;
    }
}

// Adds a line from the palm of a pulling hand to the pulled body.
void PlayerView::add_pull(Entity hand, const RenderPose::Hand& shown, RenderFrame& frame) const {
    const HandPull* const pull = scene_->world().hand_pull.find(hand);
    const BodyPose* const body =
        pull != nullptr ? scene_->world().body_pose.find(pull->body) : nullptr;
    if (body != nullptr) {
        frame.lines.push_back({shown.ray_from_ws, body->pose_ws.position, k_pull_color, 3.0});
    }
}

// Adds a ghost of each instance from index `first` on. These ghosts show an empty hand through
// geometry that is not the player's own.
void PlayerView::add_penetrating_hands(std::size_t first, RenderFrame& frame) const {
    for (std::size_t i = first; i < frame.instances.size(); ++i) {
        const Instance& part = frame.instances[i];
        frame.ghosts.push_back({part.mesh, part.pose_ws, ghosts_.tracked, 0.0F, ghosts_.penetrating,
                                ghosts_.fade_start_m, ghosts_.fade_full_m, true});
    }
}

void PlayerView::add_player(std::size_t index, BodyFigures::Seen seen, RenderFrame& frame) {
    // This player's snap hints are drawn in every view, other players' only in their own view.
    constexpr std::size_t k_who_plays = 0;
    const World& world = scene_->world();
    const Entity player = world.render_pose.owners()[index];
    const RenderPose& stepped = world.render_pose.elements()[index];
    const RenderPose render = drawn_ != nullptr ? drawn_->of(index, stepped) : stepped;
    const std::size_t first_own = frame.instances.size();
    if (scene_->arena) {
        const bool is_blue = team_of(index) == ArenaTeam::blue;
        body_.paint_shell(is_blue ? k_blue_team : k_orange_team);
        hands_.paint_shell(is_blue ? k_blue_team : k_orange_team);
    }
    std::array<PosedHandJoints, k_hand_count> joints;
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        const RenderPose::Hand& hand = render.hands[index_of(side)];
        joints[index_of(side)] =
            pose_hand_joints(hands_.rig(side), world.player_origin.at(player).scale,
                             fingers_of(side, hand, controls_of(index, side)), hand.shown_ws);
    }
    body_.add(world.body_measures.at(player), render, joints, seen, renderer_, frame);
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        const RenderPose::Hand& hand = render.hands[index_of(side)];
        const bool grips = hand.grip != GripKind::none;
        const std::size_t first = frame.instances.size();
        add_hand(side, hand, render.arms.arms[index_of(side)].forearm_ws.rotation,
                 controls_of(index, side), frame);
        if (seen == BodyFigures::Seen::by_himself && !grips) {
            add_penetrating_hands(first, frame);
        }
        if (shows_hand_lines_) {
            add_hand_lines(render.head_ws.position, hand, frame);
        }
    }
    for (std::size_t i = first_own; i < frame.instances.size(); ++i) {
        frame.instances[i].is_own = seen == BodyFigures::Seen::by_himself;
    }
    for (std::size_t hand = 0; hand < world.hand_owner.size(); ++hand) {
        const HandOwner& owner = world.hand_owner.elements()[hand];
        if (owner.player == player) {
            const Entity entity = world.hand_owner.owners()[hand];
            if (seen == BodyFigures::Seen::by_himself || index == k_who_plays) {
                add_snap_hint(entity, frame);
            }
            add_pull(entity, render.hands[index_of(owner.side)], frame);
            add_ghost(owner.side, render.hands[index_of(owner.side)],
                      world.hand_tracking.at(entity).state == TrackingState::lost, frame);
        }
    }
}

RenderFrame PlayerView::make_frame(const Camera& camera, std::optional<std::size_t> without_head,
                                   std::span<const Line> marks) {
    RenderFrame frame = make_scene_frame(*scene_, visuals_);
    // The scene's instances come first, in the order of its visuals.
    for (std::size_t i = 0; drawn_ != nullptr && i < drawn_->visuals_ws.size(); ++i) {
        frame.instances[i].pose_ws = drawn_->visuals_ws[i];
    }
    hands_.begin();
    body_.begin();
    const Column<RenderPose>& players = scene_->world().render_pose;
    for (std::size_t i = 0; i < players.size(); ++i) {
        using enum BodyFigures::Seen;
        add_player(i, without_head == i ? by_himself : by_others, frame);
    }
    frame.lines.insert(frame.lines.end(), marks.begin(), marks.end());
    frame.hidden_lines = hidden_lines_;
    frame.sheet = sheet_;
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
