#include "game/view/film.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "game/render/video_writer.hpp"
#include "game/view/outside_camera.hpp"
#include "game/view/player_view.hpp"

namespace handhold {
namespace {

enum class View { first_person, outside };

// The player nearest to the first one within k_near_m; null if there is none.
const RenderPose* player_near_first(const World& world) {
    constexpr double k_near_m = 1.8;  // least distance between heads
    const auto& players = world.render_pose.elements();
    const RenderPose* nearest = nullptr;
    double nearest_m = k_near_m;
    for (std::size_t index = 1; index < players.size(); ++index) {
        const double distance_m =
            (players[index].head_ws.position - players[0].head_ws.position).norm();
        if (distance_m < nearest_m) {
            nearest_m = distance_m;
            nearest = &players[index];
        }
    }
    return nearest;
}

}  // namespace

struct SessionFilm::Impl {
    const Scene& scene;
    FilmSettings settings;
    double session_s;
    std::optional<PlayerView> still;
    std::optional<PlayerView> moving;
    std::unique_ptr<VideoWriter> video;
    std::string video_failure;
    OutsideCamera outside;
    double next_video_s = 0.0;
    double next_shot_s = 0.0;
    std::array<int, k_hand_count> last_grip{};
    std::vector<FilmShot> shots;
    Image image;

    Impl(const Scene& of_scene, const FilmSettings& with)
        : scene(of_scene), settings(with), session_s(0.0), outside(of_scene) {}

    void draw(PlayerView& stage, View view, double fov_rad) {
        const RenderPose& first = scene.world().render_pose.elements()[0];
        if (view == View::first_person) {
            stage.draw(first.head_ws, fov_rad, 0, image);
        } else {
            const RenderPose* const other = player_near_first(scene.world());
            stage.draw(other != nullptr ? outside.beside(first, *other) : outside.behind(first),
                       fov_rad, std::nullopt, image);
        }
    }

    void add_shot(View view, const FrameLog& frame) {
        if (!still) {
            return;
        }
        draw(*still, view, view == View::first_person ? 1.45 : 1.05);
        std::array<char, 96> text{};
        const char* const what = view == View::first_person ? "first person" : "from outside";
        std::snprintf(text.data(), text.size(), "%s at %.2f s", what, frame.t_s);
        std::array<char, 32> name{};
        std::snprintf(name.data(), name.size(), "%02d_%s", static_cast<int>(shots.size()),
                      view == View::first_person ? "first_person" : "outside");
        shots.push_back({name.data(), text.data(), encode_png(image)});
    }

    void watch(const FrameLog& frame) {
        bool grabbed = false;  // or holds another player
        for (std::size_t side = 0; side < k_hand_count && !frame.players.empty(); ++side) {
            const int grip = frame.players[0].hands[side].grip;
            grabbed = grabbed || (grip != 0 && last_grip[side] == 0) ||
                      grip == static_cast<int>(GripKind::player);
            last_grip[side] = grip;
        }
        const double interval = session_s / std::max(1, settings.shots / 2);
        const bool due =
            frame.t_s >= next_shot_s && (grabbed || frame.t_s >= next_shot_s + 0.6 * interval);
        if (due && static_cast<int>(shots.size()) + 1 < settings.shots + 1) {
            add_shot(View::first_person, frame);
            add_shot(View::outside, frame);
            next_shot_s = frame.t_s + interval;
        }
        if (video != nullptr && frame.t_s >= next_video_s &&
            frame.t_s <= settings.longest_video_s) {
            next_video_s += 1.0 / settings.video_fps;
            // Alternates between four seconds from the player's eyes and four from
            // outside.
            const View view = std::fmod(frame.t_s, 8.0) < 4.0 ? View::first_person : View::outside;
            draw(*moving, view, view == View::first_person ? 1.45 : 1.05);
            video->add(image);
        }
    }
};

SessionFilm::SessionFilm(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SessionFilm::~SessionFilm() = default;

std::unique_ptr<SessionFilm> SessionFilm::open(const Scene& scene, double session_s,
                                               const FilmSettings& settings, std::string& why_not) {
    auto impl = std::make_unique<Impl>(scene, settings);
    impl->session_s = session_s;
    impl->next_shot_s = std::min(1.0, 0.1 * session_s);
    impl->still =
        PlayerView::open(scene, settings.models, settings.width_px, settings.height_px, why_not);
    if (!impl->still) {
        return nullptr;
    }
    if (!settings.video.empty()) {
        VideoSettings video;
        video.width_px = settings.video_width_px;
        video.height_px = settings.video_height_px;
        video.frames_per_s = settings.video_fps;
        impl->video = VideoWriter::open(settings.video.string(), video, impl->video_failure);
        if (impl->video != nullptr) {
            impl->moving = PlayerView::open(scene, settings.models, settings.video_width_px,
                                            settings.video_height_px, why_not);
            if (!impl->moving) {
                return nullptr;
            }
        }
    }
    return std::unique_ptr<SessionFilm>(new SessionFilm(std::move(impl)));
}

void SessionFilm::watch(const FrameLog& frame) { impl_->watch(frame); }

const std::vector<FilmShot>& SessionFilm::shots() const { return impl_->shots; }

std::vector<FilmShot> SessionFilm::finish(std::string& why_not) {
    why_not = impl_->video_failure;
    if (impl_->video != nullptr) {
        impl_->video->finish(why_not);
        impl_->video.reset();
    }
    return std::move(impl_->shots);
}

}  // namespace handhold
