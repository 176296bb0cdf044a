#include "game/render/frame_view.hpp"

#include <algorithm>
#include <cmath>

namespace handhold {
namespace {

constexpr double k_far_m = 4000.0;

Matrix4 to_matrix4(const Eigen::Matrix4d& m) {
    Matrix4 out{};
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            out[4 * static_cast<std::size_t>(column) + static_cast<std::size_t>(row)] =
                static_cast<float>(m(row, column));
        }
    }
    return out;
}

}  // namespace

FrameView make_frame_view(const Camera& camera, int width_px, int height_px) {
    FrameView view;
    view.eye_ws = camera.pose_ws.position;
    view.from_view = camera.pose_ws.rotation;
    view.near_m = camera.near_m;
    view.half_height = std::tan(0.5 * camera.vertical_fov_rad);
    view.half_width = view.half_height * width_px / height_px;
    if (camera.frustum) {
        const EyeFrustum& sides = *camera.frustum;
        view.half_width = 0.5 * (sides.right - sides.left);
        view.half_height = 0.5 * (sides.up - sides.down);
        view.middle_x = 0.5 * (sides.right + sides.left);
        view.middle_y = 0.5 * (sides.up + sides.down);
    }
    view.depth_scale = -(k_far_m + view.near_m) / (k_far_m - view.near_m);
    view.depth_offset = -2.0 * k_far_m * view.near_m / (k_far_m - view.near_m);
    Eigen::Matrix4d projection = Eigen::Matrix4d::Zero();
    projection(0, 0) = 1.0 / view.half_width;
    projection(1, 1) = 1.0 / view.half_height;
    projection(0, 2) = view.middle_x / view.half_width;
    projection(1, 2) = view.middle_y / view.half_height;
    projection(2, 2) = view.depth_scale;
    projection(2, 3) = view.depth_offset;
    projection(3, 2) = -1.0;
    Eigen::Matrix4d to_view = Eigen::Matrix4d::Identity();
    to_view.topLeftCorner<3, 3>() = view.from_view.conjugate().toRotationMatrix();
    view.cs_to_clip = to_matrix4(projection * to_view);
    return view;
}

std::array<double, 4> to_clip(const FrameView& view, const Vec3& point_cs) {
    const Vec3 p = view.from_view.conjugate() * point_cs;
    return {(p.x() + view.middle_x * p.z()) / view.half_width,
            (p.y() + view.middle_y * p.z()) / view.half_height,
            view.depth_scale * p.z() + view.depth_offset, -p.z()};
}

bool sees_sphere(const FrameView& view, const Vec3& center_cs, double radius_m) {
    const Vec3 c = view.from_view.conjugate() * center_cs;
    const double ahead = -c.z();
    // Signed distance of the centre outside two opposite sides of the frustum, the larger of both;
    // negative inside. At distance 1, the picture extends from middle - half to middle + half.
    const auto outside = [ahead](double across, double middle, double half) {
        const double above = middle + half;
        const double below = middle - half;
        return std::max((across - above * ahead) / std::sqrt(1.0 + above * above),
                        (below * ahead - across) / std::sqrt(1.0 + below * below));
    };
    return ahead > view.near_m - radius_m && ahead < k_far_m + radius_m &&
           outside(c.x(), view.middle_x, view.half_width) < radius_m &&
           outside(c.y(), view.middle_y, view.half_height) < radius_m;
}

ShadowView make_shadow_view(const KeyLight& key, const FrameView& view, int size_px) {
    ShadowView shadow;
    shadow.radius_m = key.shadow_radius_m;
    shadow.reach_m = key.caster_reach_m;
    shadow.texel_m = 2.0 * shadow.radius_m / size_px;
    const Vec3 towards = key.towards_ws.normalized();
    const Vec3 side = std::abs(towards.y()) < 0.9 ? Vec3::UnitY() : Vec3::UnitX();
    shadow.axes_ws.col(2) = towards;
    shadow.axes_ws.col(0) = side.cross(towards).normalized();
    shadow.axes_ws.col(1) = towards.cross(shadow.axes_ws.col(0));
    const Vec3 forward = view.from_view * -Vec3::UnitZ();
    const Vec3 wanted_ws = view.eye_ws + 0.7 * shadow.radius_m * forward;
    Vec3 in_light = shadow.axes_ws.transpose() * wanted_ws;
    for (int axis = 0; axis < 2; ++axis) {
        in_light[axis] = std::floor(in_light[axis] / shadow.texel_m) * shadow.texel_m;
    }
    shadow.center_cs = shadow.axes_ws * in_light - view.eye_ws;
    // Receivers are up to the region's diameter below its centre plane, casters up to reach_m
    // above.
    const double depth = shadow.reach_m + 2.0 * shadow.radius_m;
    Eigen::Matrix4d to_clip = Eigen::Matrix4d::Identity();
    to_clip.row(0).head<3>() = shadow.axes_ws.col(0).transpose() / shadow.radius_m;
    to_clip.row(1).head<3>() = shadow.axes_ws.col(1).transpose() / shadow.radius_m;
    to_clip.row(2).head<3>() = -2.0 / depth * towards.transpose();
    to_clip.col(3).head<3>() = -to_clip.topLeftCorner<3, 3>() * shadow.center_cs;
    to_clip(2, 3) += 2.0 * shadow.reach_m / depth - 1.0;
    Eigen::Matrix4d to_texture = to_clip;
    to_texture.topRows<3>() *= 0.5;
    to_texture.col(3).head<3>() += Vec3::Constant(0.5);
    shadow.cs_to_clip = to_matrix4(to_clip);
    shadow.cs_to_texture = to_matrix4(to_texture);
    return shadow;
}

bool casts_shadow(const ShadowView& shadow, const Vec3& center_cs, double radius_m) {
    const Vec3 c = shadow.axes_ws.transpose() * (center_cs - shadow.center_cs);
    return std::abs(c.x()) < shadow.radius_m + radius_m &&
           std::abs(c.y()) < shadow.radius_m + radius_m && c.z() < shadow.reach_m + radius_m &&
           c.z() > -2.0 * shadow.radius_m - radius_m;
}

Matrix4 make_model_matrix(const Quat& rotation, const Vec3& origin_cs) {
    Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
    m.topLeftCorner<3, 3>() = rotation.toRotationMatrix();
    m.col(3).head<3>() = origin_cs;
    return to_matrix4(m);
}

std::vector<Lamp> choose_lamps(const RenderFrame& frame, std::size_t limit) {
    const Vec3 focus =
        frame.camera.pose_ws.position - frame.camera.pose_ws.rotation * Vec3::UnitZ();
    const auto distance = [&](const Lamp& lamp) {
        return (lamp.position_ws - focus).norm() - lamp.reach_m;
    };
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < frame.lamps.size(); ++i) {
        if (is_finite(frame.lamps[i].position_ws)) {
            order.push_back(i);
        }
    }
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return distance(frame.lamps[a]) < distance(frame.lamps[b]);
    });
    order.resize(std::min(order.size(), limit));
    std::sort(order.begin(), order.end());
    std::vector<Lamp> chosen;
    chosen.reserve(order.size());
    for (const std::size_t i : order) {
        chosen.push_back(frame.lamps[i]);
    }
    return chosen;
}

void build_line_vertices(const RenderFrame& frame, const FrameView& view,
                         std::array<int, 2> size_px, std::vector<LineVertex>& out) {
    const Vec3 forward = view.from_view * -Vec3::UnitZ();
    for (const Line& line : frame.lines) {
        Vec3 a = line.a_ws - view.eye_ws;
        Vec3 b = line.b_ws - view.eye_ws;
        const double depth_a = a.dot(forward);
        const double depth_b = b.dot(forward);
        const double cut = 1.01 * view.near_m;
        if (!is_finite(a) || !is_finite(b) || (depth_a < cut && depth_b < cut)) {
            continue;
        }
        if (depth_a < cut) {
            a += (b - a) * ((cut - depth_a) / (depth_b - depth_a));
        } else if (depth_b < cut) {
            b += (a - b) * ((cut - depth_b) / (depth_a - depth_b));
        }
        const std::array<double, 4> clip_a = to_clip(view, a);
        const std::array<double, 4> clip_b = to_clip(view, b);
        // Offset of half the line's width, perpendicular to the line: in pixels, then in clip
        // units.
        const double dx = (clip_b[0] / clip_b[3] - clip_a[0] / clip_a[3]) * size_px[0];
        const double dy = (clip_b[1] / clip_b[3] - clip_a[1] / clip_a[3]) * size_px[1];
        const double length = std::max(std::sqrt(dx * dx + dy * dy), 1e-9);
        const double across_x = -dy / length * line.width_px / size_px[0];
        const double across_y = dx / length * line.width_px / size_px[1];
        const auto add = [&](const std::array<double, 4>& clip, double side) {
            out.push_back({{static_cast<float>(clip[0] + side * across_x * clip[3]),
                            static_cast<float>(clip[1] + side * across_y * clip[3]),
                            static_cast<float>(clip[2]), static_cast<float>(clip[3])},
                           line.color});
        };
        add(clip_a, -1.0);
        add(clip_b, -1.0);
        add(clip_b, 1.0);
        add(clip_a, -1.0);
        add(clip_b, 1.0);
        add(clip_a, 1.0);
    }
}

}  // namespace handhold
