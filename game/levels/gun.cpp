#include "game/levels/gun.hpp"

#include <array>
#include <utility>

#include "engine/core/check.hpp"
#include "engine/io/json.hpp"
#include "game/assets/assets.hpp"
#include "game/levels/station_kit.hpp"
#include "game/mesh/primitives.hpp"

namespace handhold {
namespace {

// A bolt gun, about 0.47 m long. The handle is a raked stack of twelve-cornered rings, listed from
// the bottom up.
struct GunRing {
    double y, z, half_x, half_z;
};
constexpr std::array<GunRing, 5> k_gun_handle = {{{-0.100, 0.0395, 0.0150, 0.0225},
                                                  {-0.094, 0.0378, 0.0168, 0.0242},
                                                  {-0.055, 0.0262, 0.0172, 0.0238},
                                                  {-0.020, 0.0158, 0.0160, 0.0222},
                                                  {0.014, 0.0060, 0.0155, 0.0215}}};
constexpr int k_gun_corners = 12;

const Vec3 k_receiver(0.0, 0.036, -0.040);
const Vec3 k_receiver_half(0.0185, 0.0260, 0.105);
constexpr double k_barrel_y = 0.040;
constexpr double k_barrel_radius_m = 0.0155;
constexpr double k_fore_end_y = 0.0235;
constexpr double k_fore_end_radius_m = 0.0195;

const Quat k_along_z = rotation_about(Vec3::UnitX(), k_half_pi);

// A corner of a rounded cross-section, fuller than an ellipse but inside the bounding box.
Vec3 gun_corner(const GunRing& ring, int corner) {
    double s = 0.0;
    double c = 1.0;
    sin_cos(k_two_pi * (corner + 0.5) / k_gun_corners, s, c);
    const double fuller =
        1.0 / (0.55 + 0.45 * (std::abs(s) > std::abs(c) ? std::abs(s) : std::abs(c)));
    return {ring.half_x * std::min(1.0, std::max(-1.0, fuller * c)), ring.y,
            ring.z + ring.half_z * std::min(1.0, std::max(-1.0, fuller * s))};
}

std::vector<Vec3> handle_corners() {
    std::vector<Vec3> corners;
    for (const GunRing& ring : k_gun_handle) {
        for (int i = 0; i < k_gun_corners; ++i) {
            corners.push_back(gun_corner(ring, i));
        }
    }
    return corners;
}

Mesh handle_mesh() {
    Mesh mesh;
    mesh.positions = handle_corners();
    const auto id = [](std::size_t ring, int corner) {
        return static_cast<std::uint32_t>(ring * k_gun_corners +
                                          static_cast<std::size_t>(corner % k_gun_corners));
    };
    for (std::size_t ring = 0; ring + 1 < k_gun_handle.size(); ++ring) {
        for (int i = 0; i < k_gun_corners; ++i) {
            mesh.triangles.push_back({id(ring, i), id(ring + 1, i), id(ring, i + 1)});
            mesh.triangles.push_back({id(ring, i + 1), id(ring + 1, i), id(ring + 1, i + 1)});
        }
    }
    const std::size_t top = k_gun_handle.size() - 1;
    for (int i = 1; i + 1 < k_gun_corners; ++i) {
        mesh.triangles.push_back({id(0, 0), id(0, i), id(0, i + 1)});
        mesh.triangles.push_back({id(top, 0), id(top, i + 1), id(top, i)});
    }
    return mesh;
}

SceneShape gun_box(const Vec3& half_m) {
    SceneShape shape;
    shape.kind = ShapeKind::box;
    shape.half_m = half_m;
    return shape;
}
SceneShape gun_rod(ShapeKind kind, double radius_m, double half_height_m) {
    SceneShape shape;
    shape.kind = kind;
    shape.radius_m = radius_m;
    shape.half_height_m = half_height_m;
    return shape;
}

SceneShape gun_shape() {
    SceneShape handle;
    handle.kind = ShapeKind::hull;
    std::optional<ConvexHull> hull = make_convex_hull(handle_corners());
    HH_CHECK(hull && is_solid(*hull), "the handle is solid", k_gun_handle.size());
    handle.hull = std::move(*hull);
    SceneShape gun;
    gun.kind = ShapeKind::compound;
    const auto at = [](double y, double z) { return Pose{Vec3(0.0, y, z), k_along_z}; };
    gun.parts = {
        {gun_box(k_receiver_half), {k_receiver, Quat::Identity()}, 0.0},
        {gun_rod(ShapeKind::cylinder, k_barrel_radius_m, 0.085), at(k_barrel_y, -0.228), 0.0},
        {gun_rod(ShapeKind::capsule, k_fore_end_radius_m, 0.048), at(k_fore_end_y, -0.208), 0.0},
        {gun_box(Vec3(0.0145, 0.0190, 0.0260)), {Vec3(0.0, 0.036, 0.088), Quat::Identity()}, 0.0},
        {std::move(handle), {}, 0.0}};
    return gun;
}

Mesh rod_along_z(double radius_m, double y, double z0, double z1, int segments = 24) {
    return make_cylinder(Vec3(0.0, y, z0), Vec3(0.0, y, z1), radius_m, segments);
}

void draw_body(StationKit& kit) {
    kit.beam(Material::panel, {}, k_receiver, k_receiver_half);
    kit.beam(Material::dark, {}, Vec3(0.0, 0.062, -0.045), Vec3(0.0105, 0.0050, 0.098));
    for (int i = 0; i < 9; ++i) {
        kit.block(Material::dark, {}, Vec3(0.0, 0.0690, -0.130 + 0.019 * i),
                  Vec3(0.0095, 0.0028, 0.0052));
    }
    kit.beam(Material::dark, {}, Vec3(0.0, 0.036, 0.088), Vec3(0.0145, 0.0190, 0.0260));
    kit.block(Material::accent, {}, Vec3(0.0, 0.036, 0.1125), Vec3(0.0110, 0.0140, 0.0030));
    for (const double side : {-1.0, 1.0}) {
        kit.beam(Material::accent, {}, Vec3(side * 0.0183, 0.047, -0.030),
                 Vec3(0.0016, 0.0085, 0.070));
        kit.block(Material::lamp, {}, Vec3(side * 0.0194, 0.047, -0.088),
                  Vec3(0.0010, 0.0022, 0.0075));
        for (int i = 0; i < 4; ++i) {
            kit.block(Material::dark, {}, Vec3(side * 0.0184, 0.026, -0.120 + 0.014 * i),
                      Vec3(0.0008, 0.0075, 0.0036));
        }
        kit.beam(Material::metal, {}, Vec3(side * 0.0050, 0.0765, 0.040),
                 Vec3(0.0022, 0.0065, 0.0045));
    }
    kit.beam(Material::metal, {}, Vec3(0.0, 0.0765, -0.128), Vec3(0.0018, 0.0065, 0.0050));
    // The battery, in front of the trigger guard.
    kit.beam(Material::dark, {}, Vec3(0.0, -0.004, -0.106), Vec3(0.0140, 0.0200, 0.0230));
    kit.block(Material::accent, {}, Vec3(0.0, -0.0235, -0.106), Vec3(0.0150, 0.0030, 0.0240));
}

void draw_barrel(StationKit& kit) {
    kit.add(Material::dark, rod_along_z(k_barrel_radius_m, k_barrel_y, -0.145, -0.313), {});
    for (int i = 0; i < 3; ++i) {
        const double z = -0.268 - 0.014 * i;
        kit.add(Material::metal, rod_along_z(0.0180, k_barrel_y, z, z - 0.006), {});
    }
    kit.add(Material::accent, rod_along_z(0.0195, k_barrel_y, -0.309, -0.322), {});
    kit.add(Material::metal, rod_along_z(0.0135, k_barrel_y, -0.320, -0.330), {});
    kit.add(Material::lamp, rod_along_z(0.0075, k_barrel_y, -0.326, -0.3305, 16), {});
    kit.add(Material::panel,
            make_capsule(Vec3(0.0, k_fore_end_y, -0.160), Vec3(0.0, k_fore_end_y, -0.256),
                         k_fore_end_radius_m, 24),
            {});
    for (int i = 0; i < 5; ++i) {
        const double z = -0.172 - 0.017 * i;
        kit.add(Material::dark,
                rod_along_z(k_fore_end_radius_m + 0.0006, k_fore_end_y, z, z - 0.006), {});
    }
}

void draw_handle(StationKit& kit) {
    kit.add(Material::dark, handle_mesh(), {});
    kit.beam(Material::accent, {Vec3(0.0, -0.1015, 0.0400), Quat::Identity()}, Vec3::Zero(),
             Vec3(0.0165, 0.0045, 0.0240));
    const std::array<Vec3, 6> guard = {Vec3(0.0, 0.012, -0.078),   Vec3(0.0, -0.012, -0.0755),
                                       Vec3(0.0, -0.0225, -0.064), Vec3(0.0, -0.0260, -0.044),
                                       Vec3(0.0, -0.0260, -0.022), Vec3(0.0, -0.0230, -0.004)};
    kit.hose(Material::metal, {}, guard, 0.0030);
    const std::array<Vec3, 4> trigger = {Vec3(0.0, 0.013, -0.032), Vec3(0.0, 0.002, -0.0345),
                                         Vec3(0.0, -0.008, -0.0375), Vec3(0.0, -0.015, -0.0430)};
    kit.hose(Material::accent, {}, trigger, 0.0030);
}

std::vector<SceneGrip> gun_grips() {
    const Result<JsonDocument> document =
        JsonDocument::parse(game_asset("gun_grips.json"), "gun_grips.json");
    HH_CHECK(document.ok(), "the gun's grips are JSON", 0);
    std::vector<SceneGrip> grips;
    std::set<std::string> names;
    for (const JsonValue& grip : document.value().root().items()) {
        grips.push_back(read_scene_grip(grip, names));
    }
    HH_CHECK(!document.value().failed(), "the gun's grips are good", grips.size());
    return grips;
}

}  // namespace

GunModel make_gun() {
    constexpr Color k_gun_accent = {0.85F, 0.28F, 0.03F};
    GunModel gun;
    gun.shape = gun_shape();
    gun.mass_kg = 1.8;
    StationKit kit(gun.visual, "gun", k_gun_accent);
    draw_body(kit);
    draw_barrel(kit);
    draw_handle(kit);
    kit.finish();
    gun.grips = gun_grips();
    return gun;
}

}  // namespace handhold
