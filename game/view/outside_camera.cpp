#include "game/view/outside_camera.hpp"

#include <algorithm>

#include "game/mesh/primitives.hpp"

namespace handhold {

void OutsideCamera::place_walls() {
    std::vector<ColliderProxy> proxies;
    const World& world = scene_->world();
    for (std::size_t index = 0; index < world.body.size(); ++index) {
        const Entity body = world.body.owners()[index];
        const Collider* const collider = world.collider.find(body);
        if (collider != nullptr && world.body.elements()[index].kind != BodyKind::free) {
            const Pose& pose = world.body_pose.at(body).pose_ws;
            proxies.push_back(
                {world.persistent_id.at(body).value, collider->shape, pose, pose, false});
        }
    }
    std::sort(proxies.begin(), proxies.end(),
              [](const ColliderProxy& a, const ColliderProxy& b) { return a.id < b.id; });
    walls_.set_proxies(proxies);
}

Pose OutsideCamera::look_from(std::span<const Offset> offsets, const Vec3& head_ws,
                              const Vec3& target_ws, const Vec3& ahead_ws) {
    constexpr double k_camera_radius_m = 0.08;
    constexpr double k_min_gain_m = 0.15;
    const Vec3 up = scene_->up_ws;
    const Vec3 side = ahead_ws.cross(up);
    place_walls();
    const auto reach = [&](const Vec3& wanted) {
        // The sweep starts at the head, which penetrates nothing.
        const Vec3 sweep = wanted - head_ws;
        const auto hit = walls_.cast_sphere(k_camera_radius_m, head_ws, wanted);
        const double share = hit ? hit->distance_m / sweep.norm() : 1.0;
        return Vec3(head_ws + std::max(0.0, share - 0.02) * sweep);
    };
    Vec3 best = reach(head_ws - 0.3 * ahead_ws);
    for (const auto& [forward, height, sideways] : offsets) {
        const Vec3 place = reach(target_ws + forward * ahead_ws + height * up + sideways * side);
        if ((place - target_ws).norm() > (best - target_ws).norm() + k_min_gain_m) {
            best = place;
        }
    }
    return look_along(best, target_ws - best, up);
}

Vec3 OutsideCamera::level_ahead(const RenderPose& render) const {
    const Vec3 up = scene_->up_ws;
    Vec3 ahead = render.head_ws.rotation * -Vec3::UnitZ();
    ahead -= up * up.dot(ahead);
    const double length = ahead.norm();
    return length > 1e-6 ? Vec3(ahead / length) : Vec3(up.unitOrthogonal());
}

Pose OutsideCamera::behind(const RenderPose& render) {
    constexpr std::array<Offset, 5> k_offsets = {{{-1.3, 0.45, 0.75},
                                                  {-1.3, 0.45, -0.75},
                                                  {-1.4, 0.2, 0.0},
                                                  {0.9, 0.3, 0.9},
                                                  {0.9, 0.3, -0.9}}};
    const Vec3 ahead = level_ahead(render);
    const Vec3& head_ws = render.head_ws.position;
    return look_from(k_offsets, head_ws, head_ws - 0.25 * scene_->up_ws + 0.25 * ahead, ahead);
}

Pose OutsideCamera::before(const RenderPose& render) {
    constexpr std::array<Offset, 3> k_offsets = {
        {{1.5, 0.15, 0.0}, {1.3, 0.2, 0.7}, {1.3, 0.2, -0.7}}};
    constexpr double k_min_m = 0.6;
    const Vec3 target_ws = render.head_ws.position - 0.3 * scene_->up_ws;
    const Pose camera =
        look_from(k_offsets, render.head_ws.position, target_ws, level_ahead(render));
    return (camera.position - target_ws).norm() < k_min_m ? behind(render) : camera;
}

Pose OutsideCamera::beside(const RenderPose& first, const RenderPose& second) {
    constexpr std::array<Offset, 4> k_offsets = {
        {{-2.1, 0.3, 0.0}, {-1.8, 0.4, 1.0}, {-1.8, 0.4, -1.0}, {2.1, 0.3, 0.0}}};
    const Vec3 up = scene_->up_ws;
    const Vec3& first_ws = first.head_ws.position;
    const Vec3 between = second.head_ws.position - first_ws;
    Vec3 across = between.cross(up);
    const double length = across.norm();
    if (length < 1e-3) {  // the players are one above the other
        return behind(first);
    }
    across *= (across.dot(level_ahead(first)) < 0.0 ? -1.0 : 1.0) / length;
    const Vec3 target_ws = first_ws + 0.5 * between - 0.3 * up;
    return look_from(k_offsets, first_ws, target_ws, across);
}

}  // namespace handhold
