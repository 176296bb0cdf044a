#include "game/commands/shot_film.hpp"

#include <algorithm>
#include <array>
#include <tuple>

#include "game/mesh/primitives.hpp"
#include "game/render/video_writer.hpp"
#include "game/ui/hud.hpp"
#include "game/ui/overlay.hpp"
#include "game/view/outside_camera.hpp"
#include "game/view/player_view.hpp"

namespace handhold {
namespace {

constexpr double k_shot_palm_m = 0.08;  // distance of the palm from the wrist, towards the fingers

}  // namespace

struct ShotFilm::Impl {
    const Scene& scene;
    std::vector<Shot> shots;  // sorted by start time
    ShotFilmSettings settings;
    PlayerView view;
    OutsideCamera outside;
    Overlay overlay;
    std::unique_ptr<VideoWriter> video;  // film of the running shot; null: none is running
    std::size_t now = 0;                 // index of the running shot or, if none runs, of the next
    double next_frame_s = 0.0;
    std::size_t saved = 0;
    std::string failure;
    std::vector<Line> marks;
    Image image;

    Impl(const Scene& of_scene, std::vector<Shot> wanted, const ShotFilmSettings& with,
         PlayerView drawn_by)
        : scene(of_scene),
          shots(std::move(wanted)),
          settings(with),
          view(std::move(drawn_by)),
          outside(of_scene),
          overlay(with.width_px, with.height_px) {}

    const RenderPose& first() const { return scene.world().render_pose.elements()[0]; }

    Vec3 looked_at(const Shot& shot) const {
        const Entity named = find_by_id(scene.world(), persistent_id_from_name(shot.body));
        const RenderPose* const other = scene.world().render_pose.find(named);
        const BodyPose* const thing = scene.world().body_pose.find(named);
        switch (shot.view) {
            case ShotView::gaze:
            case ShotView::hand:
                return transform_point(first().hands[index_of(shot.side)].shown_ws,
                                       Vec3(0.0, 0.0, -k_shot_palm_m));
            case ShotView::chest:
                return first().spine.chest_ws.position;
            case ShotView::pelvis:
                return first().spine.pelvis_ws.position;
            case ShotView::player:
                return other != nullptr ? other->head_ws.position : Vec3::Zero();
            case ShotView::body:
                return thing != nullptr ? thing->pose_ws.position : Vec3::Zero();
            default:
                return first().head_ws.position;
        }
    }

    Pose camera_ws(const Shot& shot) {
        switch (shot.view) {
            case ShotView::eyes:
                return first().head_ws;
            case ShotView::gaze: {
                const Vec3& eyes_ws = first().head_ws.position;
                return look_along(eyes_ws, looked_at(shot) - eyes_ws,
                                  first().head_ws.rotation * Vec3::UnitY());
            }
            case ShotView::behind:
                return outside.behind(first());
            case ShotView::before:
                return outside.before(first());
            case ShotView::place:
                return look_along(shot.from_m, shot.target_m - shot.from_m, scene.up_ws);
            default:
                break;
        }
        const Quat& play_space = scene.world().player_origin.elements()[0].pose_ws.rotation;
        const Vec3 middle_ws = looked_at(shot);
        const Vec3 target_ws = middle_ws + play_space * shot.target_m;
        const Vec3 up_ws = play_space * Vec3::UnitY();
        Vec3 eye_ws = middle_ws + play_space * shot.from_m;
        if (shot.free) {
            eye_ws = free_eye(middle_ws, eye_ws, up_ws);
        }
        return look_along(eye_ws, target_ws - eye_ws, up_ws);
    }

    // Shot::free. A body that the player holds counts as a surface too.
    Vec3 free_eye(const Vec3& middle_ws, const Vec3& eye_ws, const Vec3& up_ws) const {
        constexpr double k_camera_m = 0.06;
        constexpr double k_step_rad = 0.4;
        constexpr int k_sides = 8;  // steps to each side: half a turn
        const std::array<std::uint64_t, 1> skip = {
            scene.world().persistent_id.at(scene.world().render_pose.owners()[0]).value};
        Vec3 best_ws = middle_ws;
        for (int i = 0; i <= 2 * k_sides; ++i) {
            const int steps = (i + 1) / 2;
            const double turn_rad = k_step_rad * steps * (i % 2 == 0 ? 1.0 : -1.0);
            const Vec3 way = rotation_about(up_ws, turn_rad) * (eye_ws - middle_ws);
            const auto hit =
                scene.caches().collision.cast_sphere(k_camera_m, middle_ws, middle_ws + way, skip);
            if (!hit) {
                return middle_ws + way;
            }
            if (hit->distance_m > (best_ws - middle_ws).norm()) {
                best_ws = middle_ws + way * (hit->distance_m / way.norm());
            }
        }
        return best_ws == middle_ws ? eye_ws : best_ws;
    }

    void draw(const Shot& shot) {
        marks.clear();
        add_gizmos(scene.world(), scene.caches(), scene.tuning(), shot.gizmos, marks);
        overlay.begin({}, 1.0 / settings.video_fps);
        if (!shot.caption.empty()) {
            show_caption(shot.caption);
        }
        const UiPicture& ui = overlay.end();
        view.show_hand_lines(shot.marks);
        view.set_hidden_lines(static_cast<float>(shot.through));
        const bool is_at_eyes = shot.view == ShotView::eyes || shot.view == ShotView::gaze;
        view.draw(camera_ws(shot), shot.fov_deg * k_degree,
                  is_at_eyes ? std::optional<std::size_t>(0) : std::nullopt, image, marks, &ui);
    }

    std::string file(const Shot& shot, const char* extension) const {
        return (settings.out / (shot.name + extension)).string();
    }

    void fail(const std::string& reason) {
        if (failure.empty()) {
            failure = reason;
        }
    }

    void take_picture(const Shot& shot) {
        draw(shot);
        if (const auto error = save_png(image, file(shot, ".png"))) {
            fail(error->message());
        } else {
            ++saved;
        }
    }

    void begin_video(const Shot& shot, double t_s) {
        std::string why_not;
        VideoSettings with;
        with.width_px = settings.width_px;
        with.height_px = settings.height_px;
        with.frames_per_s = settings.video_fps;
        video = VideoWriter::open(file(shot, ".mp4"), with, why_not);
        if (video == nullptr) {
            fail(why_not);
        }
        next_frame_s = t_s;
    }

    void end_video() {
        std::string why_not;
        if (video->finish(why_not)) {
            ++saved;
        } else {
            fail(why_not);
        }
        video.reset();
    }

    // Draws the shot if it is due at `t_s`. Returns true if the shot is complete.
    bool advance(const Shot& shot, double t_s) {
        constexpr double k_rounding_s = 1e-6;
        if (t_s + k_rounding_s < shot.at_s) {
            return false;
        }
        if (shot.until_s <= shot.at_s) {
            take_picture(shot);
            return true;
        }
        if (video == nullptr) {
            begin_video(shot, t_s);
        }
        if (video != nullptr && t_s + k_rounding_s >= next_frame_s) {
            next_frame_s += 1.0 / settings.video_fps;
            draw(shot);
            video->add(image);
        }
        if (t_s + k_rounding_s < shot.until_s && video != nullptr) {
            return false;
        }
        if (video != nullptr) {
            end_video();
        }
        return true;
    }
};

ShotFilm::ShotFilm(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ShotFilm::~ShotFilm() = default;

std::unique_ptr<ShotFilm> ShotFilm::open(const Scene& scene, std::vector<Shot> shots,
                                         const ShotFilmSettings& settings, std::string& why_not) {
    std::optional<PlayerView> view = PlayerView::open(
        scene, settings.models, settings.width_px, settings.height_px, why_not, settings.quality);
    if (!view) {
        return nullptr;
    }
    std::stable_sort(shots.begin(), shots.end(), [](const Shot& a, const Shot& b) {
        return std::tie(a.at_s, a.until_s) < std::tie(b.at_s, b.until_s);
    });
    return std::unique_ptr<ShotFilm>(
        new ShotFilm(std::make_unique<Impl>(scene, std::move(shots), settings, std::move(*view))));
}

double ShotFilm::length_s() const {
    double end_s = 0.0;
    for (const Shot& shot : impl_->shots) {
        end_s = std::max(end_s, shot.until_s);
    }
    return end_s;
}

void ShotFilm::watch(double t_s) {
    while (impl_->now < impl_->shots.size() && impl_->advance(impl_->shots[impl_->now], t_s)) {
        ++impl_->now;
    }
}

std::size_t ShotFilm::finish(std::string& why_not) {
    if (impl_->video != nullptr) {
        impl_->end_video();
    }
    if (impl_->saved < impl_->shots.size()) {
        impl_->fail("the session ended before its last shot");
    }
    why_not = impl_->failure;
    return impl_->saved;
}

}  // namespace handhold
