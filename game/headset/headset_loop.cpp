#include "game/headset/headset_loop.hpp"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "game/devices/comfort.hpp"
#include "game/devices/headset_hands.hpp"
#include "game/headset/headset_panel.hpp"
#include "game/play/real_clock.hpp"
#include "game/ui/headset_help.hpp"
#include "game/ui/hud.hpp"
#include "game/ui/overlay.hpp"

namespace handhold {
namespace {

constexpr double k_between_lines_s = 0.1;
constexpr auto k_retry_interval = std::chrono::milliseconds(500);
constexpr int k_max_find_attempts = 60;

// Copies an eye's picture into a half of `both`. `which`: 0 left, 1 right.
void put_beside(const Image& eye, std::size_t which, Image& both) {
    const int width = eye.width_px;
    both.width_px = 2 * width;
    both.height_px = eye.height_px;
    both.rgba.resize(2 * eye.rgba.size());
    const auto row = 4 * static_cast<std::ptrdiff_t>(width);
    const auto left = which == 0 ? 0 : row;
    for (std::ptrdiff_t y = 0; y < eye.height_px; ++y) {
        std::copy_n(eye.rgba.begin() + y * row, row, both.rgba.begin() + 2 * y * row + left);
    }
}

class HeadsetLoop {
  public:
    HeadsetLoop(HeadsetStage& stage, std::unique_ptr<Headset> headset)
        : stage_(stage), headset_(std::move(headset)) {
        if (stage.view != nullptr) {
            overlay_.emplace(k_headset_help_px[0], k_headset_letters_for_px);
        }
    }

    bool run(std::string& why_not) {
        if (!begin(why_not)) {
            return false;
        }
        while (!ends_) {
            look_around();
            switch (headset_->poll()) {
                case HeadsetState::runs:
                    frame();
                    break;
                case HeadsetState::waits:
                    break;
                case HeadsetState::leaves:
                    ends_ = true;
                    break;
                case HeadsetState::lost:
                    if (!find_again(why_not)) {
                        return ends_;
                    }
                    break;
            }
        }
        leave();
        return true;
    }

  private:
    const hh::World& world() const { return stage_.session.world(); }
    // The world's columns, for drawing and notices.
    const World& columns() const { return stage_.session.scene().world(); }

    bool begin(std::string& why_not) {
        const GlContext* const gl = stage_.view != nullptr ? &stage_.view->context() : nullptr;
        if (!headset_->begin(gl, stage_.eye_size, why_not)) {
            return false;
        }
        std::printf("headset: %s\n", headset_->description().c_str());
        std::fflush(stdout);
        return true;
    }

    bool find_again(std::string& why_not) {
        std::fprintf(stderr, "the headset's runtime is lost; looking for it\n");
        ++figures_.losses;
        for (int i = 0; i < k_max_find_attempts && !ends_; ++i) {
            headset_.reset();
            std::this_thread::sleep_for(k_retry_interval);
            look_around();
            headset_ = Headset::open(stage_.options.xr_headless, why_not);
            if (headset_ != nullptr && begin(why_not)) {
                clock_.pause();
                return true;
            }
        }
        return false;
    }

    // Ends the session. Submits empty frames until the runtime has ended it, as OpenXR requires.
    void leave() {
        constexpr int k_max_frames = 200;
        headset_->ask_to_leave();
        for (int i = 0; i < k_max_frames && headset_->poll() == HeadsetState::runs; ++i) {
            HeadsetFrame frame = headset_->begin_frame();
            frame.is_seen = false;
            headset_->end_frame(frame, {});
        }
    }

    // Reads requests to end the session that do not come from the headset: a signal, or the mirror
    // window.
    void look_around() {
        ends_ = ends_ || (stage_.asked_to_end != nullptr && *stage_.asked_to_end != 0);
        if (stage_.mirror == nullptr) {
            return;
        }
        const WindowEvents events = stage_.mirror->poll(stage_.options.settings);
        ends_ = ends_ || events.quit ||
                std::ranges::find(events.pressed, PlayKey::leave) != events.pressed.end();
    }

    void frame() {
        const HeadsetFrame frame = headset_->begin_frame();
        if (frame.display_ns == 0) {  // the runtime is lost; the next poll() reports it
            return;
        }
        headset_->sync();
        figures_.has_focus = headset_->has_focus();
        const int due = clock_.advance(frame.display_ns, frame.period_ns);
        stage_.hz = clock_.hz();
        for (int i = due; i-- > 0 && !ends_;) {
            step(clock_.frame_ns(i));
        }
        if (frame.is_seen && frames_ > 0) {
            const std::int64_t begin_ns = clock_ns();
            lay_out_panel();
            const UiPicture& ui = darken_edges(due * clock_.dt_s());
            if (!headset_->end_frame(frame, [&](const EyePicture& eye) { draw(eye, ui); })) {
                return;
            }
            const double draw_us = us_since(begin_ns);
            const std::int64_t shown_ns = clock_ns();
            show_mirror();
            ++figures_.pictures;
            stage_.tally.add_picture(draw_us, us_since(shown_ns));
        } else {
            headset_->end_frame({frame.display_ns, frame.period_ns, false}, {});
        }
    }

    void step(std::int64_t time_ns) {
        figures_.reading = headset_->read(time_ns);
        panel_.follow(figures_.reading);
        figures_.shows_panel = panel_.shows();
        HeadsetSession& session = stage_.session;
        const std::int64_t begin_ns = clock_ns();
        const hh::Sample sample =
            read_headset(figures_.reading, session.t_s(), hand_shape(session.world()), memory_,
                         session.controller_joints());
        session.step(sample,
                     read_headset_commands(figures_.reading, stage_.options.settings.turn, memory_),
                     clock_.dt_s());
        ++frames_;
        stage_.tally.add_frame(world(), session.player(), us_since(begin_ns), clock_.dt_s());
        const std::array<HapticPulse, 2> pulses = session.pulses();
        for (std::size_t side = 0; side < 2; ++side) {
            const bool shook = headset_->shake(static_cast<hh::Side>(side), pulses[side]);
            figures_.shakes[side] += shook ? 1U : 0U;
        }
        write_status();
        ends_ =
            ends_ || (stage_.options.seconds > 0.0 && world().time_s() >= stage_.options.seconds);
    }

    void write_status() {
        if (stage_.status == nullptr || world().time_s() < next_status_s_) {
            return;
        }
        next_status_s_ = world().time_s() + k_between_lines_s;
        const std::string line =
            status_line(world(), stage_.session.player(), stage_.tally.figures(), false, &figures_);
        std::fputs(line.c_str(), stage_.status);
        std::fflush(stage_.status);
    }

    // A line about the player's own tracking and calibration.
    std::string notice() const {
        const PlayerEntities player = player_entities(columns(), stage_.session.player());
        for (const HandSide side : {HandSide::left, HandSide::right}) {
            if (columns().hand_tracking.at(player.hands[index_of(side)]).state ==
                TrackingState::lost) {
                return side == HandSide::left ? "The left hand is out of sight."
                                              : "The right hand is out of sight.";
            }
        }
        const Calibration& calibration = columns().calibration.at(player.player);
        return calibration.held_s > 0.0 ? "Hold still: you are being measured."
               : calibration.done       ? "You are measured."
                                        : "";
    }

    void lay_out_panel() {
        if (!panel_.shows()) {
            return;
        }
        const Tuning& tuning = stage_.session.scene().tuning();
        overlay_->resize(k_headset_help_px[0], k_headset_help_px[1]);
        overlay_->begin({}, clock_.dt_s());
        show_headset_help({stage_.options.settings.turn, tuning.locomotion.thruster_mps2 > 0.0,
                           tuning.pull.reach_m > 0.0, notice()});
        sheet_ui_ = overlay_->end();
    }

    // The panel has the same pose relative to the head in the world as in the room.
    std::optional<Sheet> sheet_before(const Pose& head_ws) const {
        if (!panel_.shows()) {
            return std::nullopt;
        }
        return Sheet{&sheet_ui_, k_headset_help_px,
                     head_ws * from_host(hh::inverse(head_ps_) * panel_.pose_ps()),
                     HeadsetPanel::k_width_m};
    }

    const UiPicture& darken_edges(double dt_s) {
        Hud hud;
        hud.shows_mark = hud.shows_help = false;
        hud.vignette =
            vignette_of(world(), stage_.session.player(), stage_.options.settings.vignette);
        overlay_->resize(stage_.eye_size.width_px, stage_.eye_size.height_px);
        overlay_->begin({}, dt_s);
        show_hud(hud);
        return overlay_->end();
    }

    // The eye has the same pose relative to the head in the world as in the room.
    void draw(const EyePicture& eye, const UiPicture& ui) {
        const Entity player = entity_of(stage_.session.player());
        const RenderPose& render = columns().render_pose.at(player);
        if (figures_.reading.head_ps) {
            head_ps_ = *figures_.reading.head_ps;
        }
        Camera camera;
        camera.pose_ws = render.head_ws * from_host(hh::inverse(head_ps_) * eye.eye_ps);
        camera.frustum = eye.frustum;
        stage_.view->show_sheet(sheet_before(render.head_ws));
        const auto& hands = figures_.reading.hands;
        stage_.view->show_controls(columns().render_pose.find_index(player),
                                   {control_values(hands[0]), control_values(hands[1])});
        const bool keeps = !stage_.options.picture.empty();
        const bool mirrors = stage_.mirror != nullptr && eye.eye == 0;
        stage_.view->draw_eye(camera, columns().render_pose.find_index(player), eye.texture,
                              keeps || mirrors ? &eye_image_ : nullptr, &ui);
        if (keeps) {
            put_beside(eye_image_, eye.eye, stage_.picture);
        }
        if (mirrors) {
            std::swap(mirror_image_, eye_image_);
        }
    }

    void show_mirror() {
        if (stage_.mirror != nullptr && mirror_image_.width_px > 0) {
            stage_.mirror->show(mirror_image_);
        }
    }

    HeadsetStage& stage_;
    std::unique_ptr<Headset> headset_;
    HeadsetClock clock_;
    HeadsetMemory memory_;
    HeadsetFigures figures_;
    std::optional<Overlay> overlay_;  // overlay for both eyes and the panel; none: headless
    HeadsetPanel panel_;
    UiPicture sheet_ui_;               // panel content; used only while the panel is shown
    hh::Pose head_ps_ = hh::k_origin;  // head in the last reading
    Image eye_image_;                  // reused
    Image mirror_image_;               // the left eye's picture
    std::uint64_t frames_ = 0;
    double next_status_s_ = 0.0;
    bool ends_ = false;
};

}  // namespace

bool play_in_headset(HeadsetStage& stage, std::unique_ptr<Headset> headset, std::string& why_not) {
    return HeadsetLoop(stage, std::move(headset)).run(why_not);
}

}  // namespace handhold
