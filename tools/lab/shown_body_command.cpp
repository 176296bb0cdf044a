#include "tools/lab/shown_body_command.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <span>
#include <vector>

#include <nlohmann/json.hpp>

#include "components/body_tuning.hpp"
#include "engine/core/text_file.hpp"
#include "game/assets/body_clips_asset.hpp"
#include "game/levels/built_in_scenes.hpp"
#include "game/play/loading.hpp"
#include "game/run/session_run.hpp"
#include "game/run/spawn.hpp"
#include "game/scene/player_defaults.hpp"
#include "tools/lab/body_looks.hpp"
#include "tools/lab/exit_status.hpp"
#include "tools/lab/measure.hpp"

namespace handhold::lab {
namespace {

using Json = nlohmann::ordered_json;

// Radii of the body's parts for an eye height of k_scale_eye_m.
constexpr double k_trunk_radius_m = 0.11;
constexpr double k_thigh_radius_m = 0.07;
constexpr double k_shin_radius_m = 0.05;

// Measures how deep spheres are in the fixed and kinematic colliders of a scene.
class Walls {
  public:
    explicit Walls(const World& world) {
        for (std::size_t index = 0; index < world.persistent_id.size(); ++index) {
            const RigidBody* const body = world.body.find(world.persistent_id.owners()[index]);
            if (body == nullptr || body->kind == BodyKind::free) {
                skip_.push_back(world.persistent_id.elements()[index].value);
            }
        }
    }

    // Returns the head's position and those points around it that no wall separates from it: points
    // from which a player could look.
    std::vector<Vec3> viewpoints(const CollisionWorld& collision, const Vec3& head_ws) const {
        constexpr double k_aside_m = 0.35;
        std::vector<Vec3> points = {head_ws};
        for (int axis = 0; axis < 3; ++axis) {
            for (const double side : {-k_aside_m, k_aside_m}) {
                const Vec3 point = head_ws + side * Vec3::Unit(axis);
                if (!collision.cast_ray(head_ws, point, skip_)) {
                    points.push_back(point);
                }
            }
        }
        return points;
    }

    // Returns how deep a sphere is in the nearest wall; 0: outside. If walls hide the centre from
    // all viewpoints, it counts as behind a wall (a rail does not hide it from all). The depth is
    // then the centre's distance behind the nearest of the hiding surfaces, plus the radius.
    double depth_m(const CollisionWorld& collision, std::span<const Vec3> viewpoints,
                   const Vec3& centre_ws, double radius_m) const {
        double behind_m = 1e9;
        for (const Vec3& from : viewpoints) {
            const auto between = collision.cast_ray(from, centre_ws, skip_);
            behind_m = std::min(
                behind_m, between
                              ? std::max(0.0, between->normal_ws.dot(between->point_ws - centre_ws))
                              : 0.0);
        }
        if (behind_m > 0.0) {
            return radius_m + behind_m;
        }
        const auto nearest = collision.closest_point(centre_ws, radius_m, skip_);
        return nearest ? radius_m - (nearest->point_ws - centre_ws).norm() : 0.0;
    }

  private:
    std::vector<std::uint64_t> skip_;
};

struct Capsule {
    Vec3 from_ws;
    Vec3 to_ws;
    double radius_m;
};
double deepest_m(const Walls& walls, const CollisionWorld& collision,
                 std::span<const Vec3> viewpoints, const Capsule& capsule) {
    constexpr int k_points = 9;
    double deepest = 0.0;
    for (int i = 0; i < k_points; ++i) {
        const double along = static_cast<double>(i) / (k_points - 1);
        const Vec3 centre = capsule.from_ws + along * (capsule.to_ws - capsule.from_ws);
        deepest = std::max(deepest, walls.depth_m(collision, viewpoints, centre, capsule.radius_m));
    }
    return deepest;
}

double angle_deg(const Vec3& a, const Vec3& b) {
    return arc_tangent2(a.cross(b).norm(), a.dot(b)) * 180.0 / k_pi;
}

class ShownBody {
  public:
    ShownBody(const World& world, const PlayerEntities& player, double hz)
        : walls_(world),
          player_(player.player),
          hands_{player.hands[0], player.hands[1]},
          hz_(hz) {}

    void take(const World& world, const CollisionWorld& collision) {
        const SpinePose& spine = world.render_pose.at(player_).spine;
        take_depths(world, collision, spine);
        take_angles(world, spine);
        take_speeds(spine);
        looks_.take(spine, world.render_pose.at(player_).arms,
                    world.body_measures.at(player_).eye_height_m / k_scale_eye_m,
                    world.player_origin.at(player_).pose_ws.rotation.conjugate(), 1.0 / hz_);
    }

    // One line for each frame.
    std::string csv() const {
        std::string text =
            "frame,chest_mm,trunk_mm,pelvis_mm,thigh_mm,shin_mm,foot_mps,straight,crossed,high,"
            "ball,elbow,"
            "forearm,wrist\n";
        for (std::size_t i = 0; i < trunk_mm_.values.size(); ++i) {
            const BodyLooks::Frame& look = looks_.frames()[i];
            std::array<char, 128> row{};
            std::snprintf(row.data(), row.size(),
                          "%zu,%.2f,%.2f,%.2f,%.2f,%.2f,%.2f,%d,%d,%d,%d,%d,%d,%d\n", i + 1,
                          chest_mm_.values[i], trunk_mm_.values[i], pelvis_mm_.values[i],
                          thigh_mm_.values[i], shin_mm_.values[i],
                          i == 0 ? 0.0 : foot_mps_.values[i - 1], look.straight, look.crossed,
                          look.high, look.ball, look.elbow, look.forearm, look.wrist);
            text += row.data();
        }
        return text;
    }

    Json json() const {
        const auto spread = [](const Series& series) {
            return Json{{"median", series.quantile(0.5)},
                        {"p90", series.quantile(0.9)},
                        {"max", series.max()}};
        };
        return {{"chest_depth_mm", spread(chest_mm_)},
                {"trunk_depth_mm", spread(trunk_mm_)},
                {"pelvis_depth_mm", spread(pelvis_mm_)},
                {"thigh_depth_mm", spread(thigh_mm_)},
                {"shin_depth_mm", spread(shin_mm_)},
                {"trunk_from_grips_deg", spread(from_grips_)},
                {"pelvis_mps", spread(pelvis_mps_)},
                {"foot_mps", spread(foot_mps_)},
                {"foot_step_mps", spread(foot_step_mps_)},
                {"looks", looks_.json()}};
    }

  private:
    void take_depths(const World& world, const CollisionWorld& collision, const SpinePose& spine) {
        const double scale = world.body_measures.at(player_).eye_height_m / k_scale_eye_m;
        const std::vector<Vec3> viewpoints =
            walls_.viewpoints(collision, world.render_pose.at(player_).head_center_ws);
        const auto depth_mm = [&](const Vec3& from, const Vec3& to, double radius_m) {
            return 1e3 * deepest_m(walls_, collision, viewpoints, {from, to, scale * radius_m});
        };
        // The trunk's upper end follows the head and the hands, which are tracked: it counts alone.
        chest_mm_.add(
            depth_mm(spine.chest_ws.position, spine.spine_ws[1].position, k_trunk_radius_m));
        trunk_mm_.add(
            depth_mm(spine.spine_ws[1].position, spine.pelvis_ws.position, k_trunk_radius_m));
        pelvis_mm_.add(
            depth_mm(spine.pelvis_ws.position, spine.pelvis_ws.position, k_trunk_radius_m));
        double thigh = 0.0;
        double shin = 0.0;
        for (const SpinePose::Leg& leg : spine.legs) {
            thigh = std::max(
                thigh, depth_mm(leg.thigh_ws.position, leg.shin_ws.position, k_thigh_radius_m));
            shin = std::max(shin,
                            depth_mm(leg.shin_ws.position, leg.foot_ws.position, k_shin_radius_m));
        }
        thigh_mm_.add(thigh);
        shin_mm_.add(shin);
    }

    // Angle between the line from pelvis to chest and the mean direction to the gripping hands.
    void take_angles(const World& world, const SpinePose& spine) {
        const Vec3 up = spine.chest_ws.position - spine.pelvis_ws.position;
        Vec3 pull = Vec3::Zero();
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            if (world.grab.at(hands_[side]).kind == GripKind::surface) {
                pull += world.render_pose.at(player_).hands[side].shown_ws.position -
                        spine.chest_ws.position;
            }
        }
        if (pull.norm() > 0.1) {
            from_grips_.add(angle_deg(up, pull));
        }
    }

    // Speeds relative to the chest; foot_step_mps_: change of a foot's velocity in one frame.
    void take_speeds(const SpinePose& spine) {
        const Vec3 pelvis = spine.pelvis_ws.position - spine.chest_ws.position;
        const Vec3 foot = spine.legs[0].foot_ws.position - spine.chest_ws.position;
        if (last_pelvis_) {
            pelvis_mps_.add(hz_ * (pelvis - *last_pelvis_).norm());
            const Vec3 velocity = hz_ * (foot - *last_foot_);
            foot_mps_.add(velocity.norm());
            if (last_velocity_) {
                foot_step_mps_.add((velocity - *last_velocity_).norm());
            }
            last_velocity_ = velocity;
        }
        last_pelvis_ = pelvis;
        last_foot_ = foot;
    }

    Walls walls_;
    Entity player_;
    std::array<Entity, k_hand_count> hands_;
    double hz_;
    BodyLooks looks_;
    Series chest_mm_, trunk_mm_, pelvis_mm_, thigh_mm_, shin_mm_;
    Series from_grips_;
    Series pelvis_mps_, foot_mps_, foot_step_mps_;
    std::optional<Vec3> last_pelvis_, last_foot_, last_velocity_;
};

// A scene, its session, and where the player begins.
struct Session {
    Scene scene;
    Recording recording;
    hh::Pose origin_ws;
};
Result<Session> load_session(const ShownBodyOptions& options) {
    if (!options.input.empty()) {
        Result<Recording> recording = load_recording(options.input);
        if (!recording) {
            return recording.error();
        }
        Result<Scene> scene = load_scene_with_progress(options.scene);
        if (!scene) {
            return scene.error();
        }
        const hh::Pose origin_ws =
            find_spawn(scene.value(), recording.value(), options.hz).origin_ws;
        scene.value().tuning().pull.reach_m = k_pull_reach_m;
        return Session{std::move(scene.value()), std::move(recording.value()), origin_ws};
    }
    std::optional<Scene> scene = make_built_in_scene(options.scene);
    if (!scene || !scene->session || scene->session->built_in.empty()) {
        return FileError{options.scene, "", "expected a built-in scene with a session, or --input"};
    }
    Recording recording = *make_built_in_session(scene->session->built_in);
    const hh::Pose origin_ws = scene->spawns.front().pose_ws;
    return Session{std::move(*scene), std::move(recording), origin_ws};
}

}  // namespace

int shown_body_command(const ShownBodyOptions& options) {
    Result<Session> loaded = load_session(options);
    if (!loaded) {
        return refuse(loaded.error());
    }
    auto& [scene, recording, origin_ws] = loaded.value();
    scene.tuning().spine.hang = options.hang.value_or(scene.tuning().spine.hang);
    load_game_body_clips(scene.host);
    const PlayerEntities player = add_scene_player(scene, {"player0", from_host(origin_ws), 80.0});
    ShownBody body(scene.world(), player, options.hz);
    const auto observe = [&](const Scene& played, const FrameLog&) {
        body.take(played.world(), played.caches().collision);
    };
    run_session(scene, player_ids({&player, 1}), &recording, {options.hz, 0.0, 1}, observe);
    const Json json = {{"scene", options.scene}, {"hz", options.hz}, {"body", body.json()}};
    if (const auto error = write_file_atomically(options.json, json.dump(1) + "\n")) {
        return refuse(*error);
    }
    if (!options.csv.empty()) {
        if (const auto error = write_file_atomically(options.csv, body.csv())) {
            return refuse(*error);
        }
    }
    return 0;
}

}  // namespace handhold::lab
