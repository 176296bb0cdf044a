// The guide's level: a mesh prepared on a loading thread, a lift, a door, rules, and a piece that
// streams out again.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <thread>
#include <vector>

#include <handhold/handhold.hpp>

namespace {

bool is_near(double a, double b) { return std::fabs(a - b) < 1e-3; }

}  // namespace

int main() {
    hh::World world;
    // [mesh]
    // A floor of two triangles, in your renderer's buffers. Meshes may be as large as 2^21
    // triangles.
    const std::vector<float> xyz = {-5, 0, -5, -5, 0, 5, 5, 0, 5, 5, 0, -5};
    const std::vector<std::uint32_t> indices = {0, 1, 2, 0, 2, 3};
    hh::Mesh mesh;
    std::thread loading([&] { mesh = hh::Mesh(xyz, indices); });  // the expensive part
    loading.join();

    hh_body_def floor = hh::body_def();
    floor.name = "floor";
    floor.shape = *world.add_mesh(mesh);  // cheap: between two steps
    const hh::Body floor_id = *world.add(floor);
    // [mesh]

    // [lift]
    hh_body_def lift = hh::body_def();
    lift.kind = HH_KINEMATIC;
    lift.shape = *world.add_box({1.0, 0.1, 1.0});
    lift.pose.position = {3.0, 0.5, 0.0};
    const hh::Body lift_id = *world.add(lift);
    for (int frame = 1; frame <= 90; ++frame) {
        hh::Pose target = lift.pose;
        target.position.y += frame / 90.0;  // a metre in a second
        if (!world.move_kinematic(lift_id, target) || !world.step(1.0 / 90.0)) {
            return 1;
        }
    }
    // [lift]

    // [door]
    hh_body_def panel = hh::body_def();
    panel.kind = HH_DYNAMIC;
    panel.mass_kg = 12.0;
    panel.shape = *world.add_box({0.4, 1.0, 0.02});
    panel.pose.position = {-2.0, 1.1, 0.0};
    panel.angular_velocity_radps = {0.0, 2.0, 0.0};  // somebody pushed it
    const hh::Body panel_id = *world.add(panel);

    hh_joint_def hinge = hh::joint_def();
    hinge.kind = HH_HINGE;
    hinge.body_b = panel_id;  // body_a is null: the world
    // The joint's x axis is the hinge's: turned here to point up, at the panel's edge.
    hinge.frame = hh::pose_at({-2.4, 1.1, 0.0}, {0.0, 0.0, std::sqrt(0.5), std::sqrt(0.5)});
    hinge.limited = true;
    hinge.upper = 1.5;  // radians
    hinge.friction = 1.0;
    const hh::Joint hinge_id = *world.add(hinge);
    // [door]

    // [rules]
    hh_body_def glass = hh::body_def();
    glass.shape = *world.add_box({0.5, 0.5, 0.01});
    glass.pose.position = {0.0, 1.0, 3.0};
    glass.grab_left = glass.grab_right = false;  // too smooth for hands
    glass.layers = 2;                            // touches only what has this bit in its mask
    const hh::Body glass_id = *world.add(glass);
    // [rules]

    double furthest_rad = 0.0;
    for (int frame = 0; frame < 180; ++frame) {
        if (!world.step(1.0 / 90.0)) {
            return 1;
        }
        double angle_rad = 0.0;
        if (hh_joint_state(world.get(), hinge_id, &angle_rad, nullptr, nullptr) != HH_OK) {
            return 1;
        }
        furthest_rad = std::fmax(furthest_rad, angle_rad);
    }

    // [out]
    // A piece leaves: bodies first, then their shape. Its id finds nothing from then on.
    const bool is_gone = world.remove(glass_id) && world.remove(glass.shape) &&
                         !world.has(glass_id) && world.step(1.0 / 90.0);
    // [out]
    const double lift_m = world.pose(lift_id)->position.y;
    std::printf("lift at %.3f m, door opened to %.3f rad\n", lift_m, furthest_rad);
    const bool is_right = is_gone && is_near(lift_m, 1.5) && furthest_rad > 0.1 &&
                          furthest_rad < 1.501 && *world.find_body("floor") == floor_id;
    return is_right ? 0 : 1;
}
