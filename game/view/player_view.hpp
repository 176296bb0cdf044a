#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "game/render/renderer.hpp"
#include "game/scene/scene.hpp"
#include "game/view/drawn_match.hpp"
#include "game/view/player_models.hpp"

namespace handhold {

// Draws a scene with its players: bodies and hands, palm rays, and lines to what the hands hold.
class PlayerView {
  public:
    // nullopt, with the reason in `why_not`, if nothing can be drawn on this machine. `scene` must
    // outlive the view.
    static std::optional<PlayerView> open(const Scene& scene, PlayerModels models, int width_px,
                                          int height_px, std::string& why_not,
                                          PictureQuality quality = PictureQuality::quick);

    // Draws the current state. `without_head`: index of the player whose eyes the camera is at;
    // their head is not drawn. `marks`: extra lines. `ui`: panels, may be null.
    void draw(const Pose& camera_ws, double vertical_fov_rad,
              std::optional<std::size_t> without_head, Image& out, std::span<const Line> marks = {},
              const UiPicture* ui = nullptr);
    // Draws one eye of a headset into a texture of the XR runtime (Renderer::draw_into). `whose`:
    // index of the player.
    void draw_eye(const Camera& eye, std::size_t whose, std::uint32_t texture, Image* copy,
                  const UiPicture* ui = nullptr);
    // Shows palm rays and grip lines. Default: on.
    void show_hand_lines(bool shows) { shows_hand_lines_ = shows; }
    // Sets RenderFrame::hidden_lines.
    void set_hidden_lines(float strength) { hidden_lines_ = strength; }
    // Sets the positions of the controls for the player at `index`. Other players' controls are
    // shown pressed or released as their hands are closed or open.
    void show_controls(std::size_t index, const std::array<ControlValues, k_hand_count>& values) {
        controls_ = PlayerControls{index, values};
    }
    // Draws players and bodies where `drawn` says, which is read by draw; null: as stepped.
    void show_drawn(const DrawnMatch* drawn) { drawn_ = drawn; }
    // Shows a sheet of panels in the world; nullopt: none.
    void show_sheet(const std::optional<Sheet>& sheet) { sheet_ = sheet; }
    // The OpenGL context. Valid as long as the view.
    const GlContext& context() const { return renderer_.context(); }
    const RenderCounters& counters() const { return renderer_.counters(); }

  private:
    PlayerView(const Scene& scene, PlayerModels models, Renderer renderer);
    RenderFrame make_frame(const Camera& camera, std::optional<std::size_t> without_head,
                           std::span<const Line> marks);
    void add_player(std::size_t index, BodyFigures::Seen seen, RenderFrame& frame);
    void add_hand(HandSide side, const RenderPose::Hand& hand, const Quat& forearm_ws,
                  const ControlValues& controls, RenderFrame& frame);
    std::array<FingerAngles, k_finger_count> fingers_of(HandSide side, const RenderPose::Hand& hand,
                                                        const ControlValues& controls) const;
    bool holds_controller(const RenderPose::Hand& hand) const;
    ControlValues controls_of(std::size_t index, HandSide side) const;
    void add_pull(Entity hand, const RenderPose::Hand& shown, RenderFrame& frame) const;
    void add_ghost_of(HandSide side, const Pose& wrist_ws,
                      const std::array<FingerAngles, k_finger_count>& fingers, const Ghost& like,
                      RenderFrame& frame);
    void add_snap_hint(Entity hand, RenderFrame& frame);
    void add_penetrating_hands(std::size_t first, RenderFrame& frame) const;
    void add_ghost(HandSide side, const RenderPose::Hand& hand, bool is_lost, RenderFrame& frame);

    struct PlayerControls {
        std::size_t index = 0;
        std::array<ControlValues, k_hand_count> values{};
    };

    const Scene* scene_;
    Renderer renderer_;            // each renderer has its own meshes
    std::vector<MeshId> visuals_;  // indexed as Scene::visuals
    HandFigures hands_;
    BodyFigures body_;
    std::optional<ControllerFigures> controllers_;
    std::optional<PlayerControls> controls_;
    std::optional<Sheet> sheet_;
    const DrawnMatch* drawn_ = nullptr;
    GhostSettings ghosts_;
    bool shows_hand_lines_ = true;
    float hidden_lines_ = RenderFrame{}.hidden_lines;
    RenderFrame ghost_parts_;  // scratch
};

}  // namespace handhold
