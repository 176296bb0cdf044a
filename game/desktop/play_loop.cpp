#include "game/desktop/play_loop.hpp"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>
#include <vector>

#include "game/devices/comfort.hpp"
#include "game/play/real_clock.hpp"
#include "game/ui/hud.hpp"
#include "game/ui/inspector.hpp"
#include "game/ui/menu.hpp"
#include "game/view/drawn_match.hpp"
#include "game/view/free_camera.hpp"

namespace handhold {
namespace {

constexpr double k_status_s = 0.1;
// Longest time by which one picture advances the free camera and the overlay.
constexpr double k_longest_picture_s = 0.1;
constexpr double k_look_s = 0.002;  // longest wait for messages of a match

// Clears the input that applies to the first step only, if a poll is followed by several steps.
// Buttons that are held down stay.
void clear_momentary_input(DesktopInput& input) {
    input.turn_left_rad = input.look_up_rad = input.farther_m = 0.0;
    input.snap_turns = 0;
    input.opened = {};
}
void accumulate_input(const DesktopInput& now, DesktopInput& input) {
    const DesktopInput before = input;
    input = now;
    input.turn_left_rad += before.turn_left_rad;
    input.look_up_rad += before.look_up_rad;
    input.farther_m += before.farther_m;
    input.snap_turns += before.snap_turns;
    for (std::size_t side = 0; side < 2; ++side) {
        input.opened[side] = input.opened[side] || before.opened[side];
    }
}

// A green ring on the surface that a reaching hand would grip.
void add_aim_ring(const hh::Pose& origin_ws, const PalmTarget& aim_ps, std::vector<Line>& marks) {
    constexpr int k_parts = 20;
    constexpr double k_radius_m = 0.03;
    constexpr double k_above_m = 0.004;  // keeps the ring out of the surface
    constexpr Color k_green = {0.27F, 1.0F, 0.43F};
    const hh::Vec3 across =
        hh::normalized(aim_ps.fingers - aim_ps.away * hh::dot(aim_ps.away, aim_ps.fingers));
    const hh::Vec3 aside = hh::cross(aim_ps.away, across);
    const auto at = [&](int part) {
        double sine = 0.0;
        double cosine = 0.0;
        sin_cos(2.0 * k_pi * part / k_parts, sine, cosine);
        const hh::Vec3 out_ps = k_radius_m * (cosine * across + sine * aside);
        return from_host(
            hh::transform_point(origin_ws, aim_ps.palm + k_above_m * aim_ps.away + out_ps));
    };
    for (int part = 0; part < k_parts; ++part) {
        marks.push_back({at(part), at(part + 1), k_green, 3.0});
    }
}

class Loop {
  public:
    explicit Loop(PlayStage& stage)
        : stage_(stage), outside_(stage.session.scene()), viewpoint_(stage.viewpoint) {
        inspector_.gizmos = stage.gizmos;
        inspector_.turn_to = stage.page;
        hold_mouse(!stage.panels.inspector && !stage.panels.menu);
        if (viewpoint_ == PlayerViewpoint::free) {
            viewpoint_ = PlayerViewpoint::eyes;
            look_from(PlayerViewpoint::free);
        }
    }

    PlayEnd run() {
        while (!ends_) {
            take_events(stage_.window.poll(stage_.settings));
            if (stage_.match != nullptr) {
                advance_match();
                continue;
            }
            const int due = clock_.advance();
            if (due == 0) {
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
                continue;
            }
            advance(due);
            draw(due * DesktopSession::k_dt_s);
        }
        return end_;
    }

  private:
    const Scene& scene() const { return stage_.session.scene(); }
    const hh::World& world() const { return scene().host; }
    Entity player() const { return entity_of(stage_.session.player()); }

    void take_key(PlayKey key) {
        PlayPanels& panels = stage_.panels;
        if (stage_.match != nullptr &&
            (key == PlayKey::inspector || key == PlayKey::pause || key == PlayKey::step)) {
            return;
        }
        switch (key) {
            case PlayKey::help:
                panels.help = !panels.help;
                break;
            case PlayKey::inspector:
                panels.inspector = !panels.inspector;
                hold_mouse(!panels.inspector && !panels.menu);
                break;
            case PlayKey::menu:
                panels.menu = !panels.menu;
                hold_mouse(!panels.inspector && !panels.menu);
                break;
            case PlayKey::view:
                if (stage_.match != nullptr && stage_.match->peer.watches()) {
                    return;  // nobody's eyes
                }
                look_from(static_cast<PlayerViewpoint>((static_cast<int>(viewpoint_) + 1) %
                                                       k_player_viewpoints));
                break;
            case PlayKey::free_mouse:
                hold_mouse(!holds_mouse_);
                break;
            case PlayKey::pause:
                paused_ = !paused_;
                rewound_ = 0;
                break;
            case PlayKey::step:
                paused_ = true;
                ++steps_;
                break;
            case PlayKey::leave:
                if (panels.inspector || panels.menu) {
                    panels.inspector = panels.menu = false;
                    hold_mouse(true);
                } else {
                    ends_ = true;
                }
                break;
        }
    }

    void look_from(PlayerViewpoint viewpoint) {
        if (viewpoint == PlayerViewpoint::free) {
            free_.begin(camera_ws(), stage_.session.scene().up_ws, held_);
        }
        viewpoint_ = viewpoint;
    }

    // Not const: outside cameras update the walls they avoid.
    Pose camera_ws() {
        const std::size_t index = scene().world().render_pose.find_index(player());
        const RenderPose render = drawn_.of(index, scene().world().render_pose.elements()[index]);
        switch (viewpoint_) {
            case PlayerViewpoint::mirror:
                return outside_.before(render);
            case PlayerViewpoint::behind:
                return outside_.behind(render);
            case PlayerViewpoint::free:
                return free_.pose_ws();
            case PlayerViewpoint::eyes:
                break;
        }
        return render.head_ws;
    }

    void hold_mouse(bool held) {
        holds_mouse_ = held;
        stage_.window.hold_mouse(held);
    }

    void take_events(const WindowEvents& events) {
        ui_ = events.ui;
        wheel_ += events.ui.wheel;
        typed_ += events.ui.text;
        ends_ = ends_ || events.quit;
        const bool types = stage_.overlay.takes_keys();
        for (const PlayKey key : events.pressed) {
            if (!types || key == PlayKey::leave) {
                take_key(key);
            }
        }
        rewinds_ = events.rewinds && !types && stage_.match == nullptr;
        DesktopInput now = types ? DesktopInput{} : events.input;
        if (events.gamepad) {
            const double now_s = 1e-9 * static_cast<double>(clock_ns());
            const double dt_s = gamepad_s_ > 0.0 ? std::min(now_s - gamepad_s_, 0.1) : 0.0;
            gamepad_s_ = now_s;
            now = combine(now, read_gamepad(*events.gamepad, stage_.settings, dt_s, gamepad_));
        }
        held_.grip = now.grip;
        accumulate_input(now, input_);
    }

    void step() {
        const std::int64_t begin_ns = clock_ns();
        history_.step(stage_.session, input_);
        clear_momentary_input(input_);
        note_frame(us_since(begin_ns), DesktopSession::k_dt_s);
    }

    // The world has advanced by `dt_s`, at `us` a frame.
    void note_frame(double us, double dt_s) {
        stage_.tally.add_frame(world(), stage_.session.player(), us, dt_s);
        if (stage_.status != nullptr && world().time_s() >= next_status_s_) {
            next_status_s_ = world().time_s() + k_status_s;
            const std::string line =
                status_line(world(), stage_.session.player(), stage_.tally.figures(),
                            stage_.session.body().can_reach());
            std::fputs(line.c_str(), stage_.status);
            std::fflush(stage_.status);
        }
    }

    void advance(int due) {
        if (viewpoint_ == PlayerViewpoint::free) {
            free_.fly(input_, due * DesktopSession::k_dt_s);
            input_ = free_.held();
        }
        if (rewinds_) {
            paused_ = true;
            rewound_ += history_.rewind(stage_.session, static_cast<std::size_t>(due));
            clear_momentary_input(input_);
            return;
        }
        const int steps = paused_ ? std::exchange(steps_, 0) : due;
        for (int i = 0; i < steps && !ends_; ++i) {
            step();
            rewound_ = rewound_ > 0 ? rewound_ - 1 : 0;
            ends_ = stage_.end_s > 0.0 && world().time_s() >= stage_.end_s;
        }
        if (paused_) {
            clear_momentary_input(input_);
        }
    }

    // The match says how many ticks are due, and steps them. Pictures have the display's rate.
    void advance_match() {
        const std::int64_t begin_ns = clock_ns();
        const double until_picture_s = 1e-9 * static_cast<double>(next_picture_ns_ - begin_ns);
        const std::uint32_t ticks = stage_.match->peer.poll(
            std::clamp(until_picture_s, 0.0, k_look_s), [this](double end_s, PeerInput& input) {
                input.commands =
                    stage_.session.advance_devices(played_input(), end_s, input.samples);
                if (!flies()) {
                    clear_momentary_input(input_);
                }
                ticked_ns_ = clock_ns();
            });
        ends_ = ends_ || !stage_.match->goes_on();
        if (ticks > 0) {
            note_frame(us_since(begin_ns) / ticks, ticks * DesktopSession::k_dt_s);
        }
        match_s_ += ticks * DesktopSession::k_dt_s;
        ends_ = ends_ || (stage_.end_s > 0.0 && match_s_ >= stage_.end_s);
        if (stage_.match->peer.states() == 0) {
            clear_momentary_input(input_);  // nobody turns while the state comes
        } else if (const std::int64_t now_ns = clock_ns(); now_ns >= next_picture_ns_) {
            const auto picture_ns = static_cast<std::int64_t>(1e9 * stage_.window.picture_s());
            next_picture_ns_ = std::max(next_picture_ns_ + picture_ns, now_ns);
            const double dt_s = 1e-6 * us_since(std::exchange(pictured_ns_, now_ns));
            draw_match(std::min(dt_s, k_longest_picture_s));
        }
    }

    bool flies() const {
        return viewpoint_ == PlayerViewpoint::free || stage_.match->peer.watches();
    }
    DesktopInput played_input() const { return flies() ? free_.held() : input_; }

    void draw_match(double dt_s) {
        std::optional<hh::Sample> newest;
        if (flies()) {
            free_.fly(input_, dt_s);
            clear_momentary_input(input_);
        } else {
            newest = stage_.session.devices_in(input_, 1e-6 * us_since(ticked_ns_));
        }
        note_drawn(stage_.match->peer, scene(), newest ? &*newest : nullptr, drawn_);
        draw(dt_s);
    }

    void draw(double dt_s) {
        ui_.wheel = std::exchange(wheel_, 0.0F);
        ui_.text = std::exchange(typed_, {});
        if (holds_mouse_) {
            ui_.mouse_px = UiInput{}.mouse_px;
            ui_.buttons = {};
        }
        stage_.overlay.begin(ui_, dt_s);
        advance_hint(dt_s);
        show_panels();
        const UiPicture& ui = stage_.overlay.end();
        const std::int64_t begin_ns = clock_ns();
        marks_.clear();
        add_gizmos(scene().world(), scene().caches(), scene().tuning(), inspector_.gizmos, marks_);
        const bool own_eyes = viewpoint_ == PlayerViewpoint::eyes;
        if (const auto& aim_ps = stage_.session.body().aim_ps(); own_eyes && aim_ps) {
            add_aim_ring(world().pose(stage_.session.player())->origin, *aim_ps, marks_);
        }
        stage_.view.show_drawn(stage_.match != nullptr ? &drawn_ : nullptr);
        stage_.view.draw(camera_ws(), stage_.settings.fov_rad,
                         own_eyes ? std::optional(scene().world().render_pose.find_index(player()))
                                  : std::nullopt,
                         stage_.picture, marks_, &ui);
        stage_.view.show_drawn(nullptr);
        const double draw_us = us_since(begin_ns);
        const std::int64_t shown_ns = clock_ns();
        stage_.window.show(stage_.picture);
        stage_.tally.add_picture(draw_us, us_since(shown_ns));
    }

    void advance_hint(double dt_s) {
        const hh::Player player = stage_.session.player();
        const hh::Vec3 at_ws = world().pose(player)->origin.position;
        stage_.panels.hint.advance(
            {stage_.session.body().can_reach(),
             world().moves_player(player, HH_LEFT) || world().moves_player(player, HH_RIGHT),
             hh::length(at_ws - last_ws_.value_or(at_ws))},
            dt_s);
        last_ws_ = at_ws;
    }

    void show_panels() {
        Hud hud;
        hud.hint = viewpoint_ == PlayerViewpoint::eyes ? stage_.panels.hint.text() : "";
        hud.can_reach = stage_.session.body().can_reach();
        hud.shows_mark = holds_mouse_ && viewpoint_ == PlayerViewpoint::eyes;
        hud.shows_help = stage_.panels.help && !stage_.panels.inspector && !stage_.panels.menu;
        hud.paused = paused_;
        hud.rewound_s = static_cast<double>(rewound_) * DesktopSession::k_dt_s;
        hud.vignette = vignette_of(world(), stage_.session.player(), stage_.settings.vignette);
        if (const auto& arena = stage_.session.scene().arena) {
            hud.score = score_text(arena->state);
        }
        hud.footer = stage_.panels.inspector ? cost_line() : "";
        show_hud(hud);
        if (stage_.panels.inspector) {
            show_inspector({stage_.session, history_, stage_.tally, inspector_});
        }
        if (stage_.panels.menu) {
            obey(show_menu(stage_.session.scene().name, stage_.settings));
        }
    }

    std::string cost_line() const {
        char text[120];
        std::snprintf(text, sizeof text, "runtime %.2f ms a frame, drawing %.1f ms a picture",
                      1e-3 * stage_.tally.runtime_us(), 1e-3 * stage_.tally.draw_us());
        return text;
    }

    void obey(const MenuChoice& choice) {
        if (choice.quality) {
            std::string why_not;
            auto view = PlayerView::open(scene(), stage_.models, stage_.picture_size[0],
                                         stage_.picture_size[1], why_not, stage_.settings.quality);
            if (view) {
                stage_.view = std::move(*view);
            }
        }
        if (choice.goes_on || !choice.scene.empty()) {
            stage_.panels.menu = false;
            hold_mouse(!stage_.panels.inspector);
        }
        if (!choice.scene.empty()) {
            end_ = {false, choice.scene};
        }
        ends_ = ends_ || choice.leaves || !choice.scene.empty();
    }

    PlayStage& stage_;
    SessionHistory history_;
    OutsideCamera outside_;
    FreeCamera free_;
    PlayerViewpoint viewpoint_;
    InspectorMemory inspector_;
    std::optional<hh::Vec3> last_ws_;   // place of the play space in the last picture
    DrawnMatch drawn_;                  // empty when playing alone
    std::int64_t ticked_ns_ = 0;        // last tick of the match
    std::int64_t next_picture_ns_ = 0;  // when the match's next picture is due
    std::int64_t pictured_ns_ = 0;      // last picture of the match
    std::vector<Line> marks_;           // reused memory
    StepClock clock_{DesktopSession::k_dt_s};
    DesktopInput input_;
    DesktopInput held_;  // grips held at the last poll
    GamepadMemory gamepad_;
    double gamepad_s_ = 0.0;
    UiInput ui_;
    float wheel_ = 0.0F;
    std::string typed_;
    bool holds_mouse_ = true;
    bool paused_ = false;
    bool rewinds_ = false;
    int steps_ = 0;
    std::size_t rewound_ = 0;
    double next_status_s_ = 0.0;
    double match_s_ = 0.0;  // time played in a match
    bool ends_ = false;
    PlayEnd end_;
};

}  // namespace

PlayEnd play(PlayStage& stage) { return Loop(stage).run(); }

}  // namespace handhold
