#include "game/levels/station_kit.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "engine/core/hash.hpp"
#include "game/mesh/primitives.hpp"

namespace handhold {
namespace {

struct MaterialLook {
    const char* name;
    Color color;
    Look look;
};

// Name and look of each Material.
constexpr std::array<MaterialLook, k_material_count> k_materials = {{
    {"hull", {0.62F, 0.63F, 0.66F}, {0.0F, 1.0F, 0.35F}},
    {"liner", {0.115F, 0.120F, 0.130F}, {0.0F, 1.0F, 0.10F}},
    {"panels", {0.56F, 0.56F, 0.53F}, {0.0F, 1.0F, 0.22F}},
    {"accents", {0.5F, 0.5F, 0.5F}, {0.0F, 1.0F, 0.25F}},
    {"metal", {0.36F, 0.37F, 0.39F}, {0.0F, 1.0F, 0.60F}},
    {"lamps", {1.0F, 0.97F, 0.90F}, {1.9F, 1.0F, 0.0F}},
    {"rails", {0.80F, 0.42F, 0.03F}, {0.0F, 1.0F, 0.55F}},
    {"cables", {0.05F, 0.07F, 0.12F}, {0.0F, 1.0F, 0.30F}},
    {"stowage", {0.58F, 0.54F, 0.46F}, {0.0F, 1.0F, 0.0F}},
    {"screens", {0.10F, 0.42F, 0.60F}, {1.1F, 1.0F, 0.5F}},
    {"glass", {0.10F, 0.13F, 0.16F}, {0.0F, 0.10F, 1.0F}},
    {"dark", {0.035F, 0.037F, 0.042F}, {0.0F, 1.0F, 0.30F}},
    {"leaves", {0.07F, 0.24F, 0.045F}, {0.0F, 1.0F, 0.20F}},
    {"soil", {0.060F, 0.042F, 0.030F}, {0.0F, 1.0F, 0.0F}},
    {"grow_lamps", {0.95F, 0.35F, 0.80F}, {1.5F, 1.0F, 0.0F}},
    {"solar", {0.020F, 0.030F, 0.085F}, {0.0F, 1.0F, 0.75F}},
    {"foil", {0.62F, 0.44F, 0.12F}, {0.0F, 1.0F, 0.80F}},
}};

constexpr double k_post_spacing_m = 0.85;

// Rounds through memory, because GCC 12's vectoriser loses the conversion (double)(float)x in the
// last elements of a loop.
double to_nearest_float(double x) {
    const volatile float rounded = static_cast<float>(x);
    return static_cast<double>(rounded);
}

double bevel_of(const Vec3& half_m) { return std::min(0.006, 0.4 * half_m.minCoeff()); }

}  // namespace

StationKit::StationKit(Structure& out, std::string section, const Color& accent)
    : out_(out), section_(std::move(section)) {
    for (std::size_t i = 0; i < k_material_count; ++i) {
        meshes_[i].name = section_ + "/" + k_materials[i].name;
        meshes_[i].color = k_materials[i].color;
    }
    meshes_[static_cast<std::size_t>(Material::accent)].color = accent;
}

void StationKit::finish() {
    for (std::size_t i = 0; i < k_material_count; ++i) {
        if (!meshes_[i].triangles.empty()) {
            for (Vec3& position : meshes_[i].positions) {
                for (double& coordinate : position) {
                    coordinate = to_nearest_float(coordinate);
                }
            }
            weld(meshes_[i]);
            out_.parts.push_back(std::move(meshes_[i]));
            out_.looks.push_back(k_materials[i].look);
        }
    }
}

void StationKit::add(Material material, const Mesh& solid, const Pose& frame) {
    append(meshes_[static_cast<std::size_t>(material)], solid, frame);
}

void StationKit::panel(Material material, const Pose& frame, const Vec3& center,
                       const Vec3& half_m) {
    add(material, make_bevelled_slab(half_m, bevel_of(half_m)),
        frame * Pose{center, Quat::Identity()});
}

void StationKit::beam(Material material, const Pose& frame, const Vec3& center,
                      const Vec3& half_m) {
    add(material, make_bevelled_box(half_m, bevel_of(half_m)),
        frame * Pose{center, Quat::Identity()});
}

void StationKit::rim(Material material, const Pose& frame, const RimShape& shape) {
    // The rings lie in the XZ plane, counter-clockwise seen from +Y, in the order that
    // LoftEnds::looped needs.
    const auto ring = [&](double inset, double y) {
        const double x = shape.half_x - inset;
        const double z = shape.half_z - inset;
        const Vec3 center(shape.x, y, shape.z);
        return Ring{center + Vec3(-x, 0.0, -z), center + Vec3(-x, 0.0, z), center + Vec3(x, 0.0, z),
                    center + Vec3(x, 0.0, -z)};
    };
    const double bevel = 0.004;
    const std::array<Ring, 6> rings = {
        ring(shape.width, shape.y0),         ring(0.0, shape.y0),
        ring(0.0, shape.y1 - bevel),         ring(bevel, shape.y1),
        ring(shape.width - bevel, shape.y1), ring(shape.width, shape.y1 - bevel)};
    add(material, make_loft(rings, LoftEnds::looped), frame);
}

void StationKit::block(Material material, const Pose& frame, const Vec3& center,
                       const Vec3& half_m) {
    add(material, make_box(half_m), frame * Pose{center, Quat::Identity()});
}

void StationKit::handrail(const std::string& name, const Pose& frame, const Vec3& a,
                          const Vec3& b) {
    const double height = k_rail_clearance_m + k_rail_radius_m;
    const Vec3 up(0.0, height, 0.0);
    const Vec3 low(0.0, -0.012, 0.0);  // offset of the ends of bar and posts, inside the wall
    const Vec3 along = (b - a).normalized();
    const double bend = 0.028;
    const std::array<Vec3, 6> path = {a + low,
                                      a + up - Vec3(0.0, bend, 0.0),
                                      a + up + bend * along,
                                      b + up - bend * along,
                                      b + up - Vec3(0.0, bend, 0.0),
                                      b + low};
    add(Material::rail, make_tube(path, k_rail_radius_m, 10), frame);
    const double length = (b - a).norm();
    const int spans = std::max(1, static_cast<int>(std::lround(length / k_post_spacing_m)));
    for (int i = 0; i <= spans; ++i) {
        const Vec3 foot = a + along * (length * i / spans);
        // X is along the bar. Adds a foot plate and, between the ends, a flat post.
        const Pose turned = frame * Pose{foot, rotation_between(Vec3::UnitX(), along)};
        block(Material::rail, turned, Vec3(0.0, -0.003, 0.0), Vec3(0.030, 0.009, 0.024));
        if (i > 0 && i < spans) {
            block(Material::rail, turned, 0.5 * (up + low),
                  Vec3(0.014, 0.5 * (height + 0.012), 0.006));
        }
    }
    out_.rails.push_back({section_ + "/" + name, transform_point(frame, a + up + bend * along),
                          transform_point(frame, b + up - bend * along), k_rail_radius_m});
}

void StationKit::hose(Material material, const Pose& frame, std::span<const Vec3> points,
                      double radius_m) {
    constexpr int k_steps = 4;
    std::vector<Vec3> path;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const Vec3& a = points[i];
        const Vec3& b = points[i + 1];
        const Vec3 before = i > 0 ? points[i - 1] : Vec3(2.0 * a - b);
        const Vec3 after = i + 2 < points.size() ? points[i + 2] : Vec3(2.0 * b - a);
        for (int step = 0; step < k_steps; ++step) {
            const double s = static_cast<double>(step) / k_steps;
            const Vec3 bend = 2.0 * before - 5.0 * a + 4.0 * b - after;
            path.emplace_back(
                a + 0.5 * s * ((b - before) + s * (bend + s * (3.0 * (a - b) + after - before))));
        }
    }
    path.push_back(points.back());
    // Wide hoses have twelve sides, whose 30 degree edges are shaded smooth.
    add(material, make_tube(path, radius_m, radius_m > 0.046 ? 12 : 6), frame);
}

void StationKit::bracket(Material material, const Pose& frame, const Vec3& foot, double width_m) {
    constexpr double k_sheet_half_m = 0.0015;
    constexpr double k_leg_half_m = 0.022;
    const double half = 0.5 * width_m;
    block(material, frame, foot + Vec3(0.0, k_sheet_half_m, k_leg_half_m),
          Vec3(half, k_sheet_half_m, k_leg_half_m));
    block(material, frame, foot + Vec3(0.0, k_leg_half_m, k_sheet_half_m),
          Vec3(half, k_leg_half_m, k_sheet_half_m));
}

void StationKit::lamp(const Vec3& position, const Color& color, double reach_m) {
    out_.lamps.push_back({position, color, reach_m});
}

void StationKit::spawn(const std::string& name, const Pose& pose) {
    out_.spawns.push_back({name, pose});
}

double chance(std::size_t a, std::size_t b, std::size_t c) {
    const std::uint64_t hash = mix64(mix64(mix64(a + 0x9e3779b97f4a7c15ULL) + b) + 31 * c);
    return static_cast<double>(hash >> 11U) * 0x1p-53;
}

}  // namespace handhold
