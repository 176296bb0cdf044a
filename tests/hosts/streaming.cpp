// A level that streams in: shapes that come and go beside a large mesh, without a look at the rest.
// Prints figures; exit status 0: outcomes are right. Times are printed only.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>
#include <vector>

#include <handhold/handhold.hpp>

namespace {

// A bumpy floor of 2 * side^2 triangles, 1 m a square.
hh::Mesh floor_mesh(int side, float height_m) {
    std::vector<float> xyz;
    std::vector<std::uint32_t> indices;
    const auto corner = [side](int x, int z) {
        return static_cast<std::uint32_t>(z * (side + 1) + x);
    };
    for (int z = 0; z <= side; ++z) {
        for (int x = 0; x <= side; ++x) {
            xyz.push_back(static_cast<float>(x));
            xyz.push_back(height_m * std::sin(0.7F * static_cast<float>(x + 3 * z)));
            xyz.push_back(static_cast<float>(z));
        }
    }
    for (int z = 0; z < side; ++z) {
        for (int x = 0; x < side; ++x) {
            indices.insert(indices.end(), {corner(x, z), corner(x, z + 1), corner(x + 1, z + 1),
                                           corner(x, z), corner(x + 1, z + 1), corner(x + 1, z)});
        }
    }
    return {xyz, indices, false};
}

double now_ms() {
    return std::chrono::duration<double, std::milli>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

}  // namespace

int main() {
    hh::World world;
    const hh::Mesh level = floor_mesh(400, 0.1F);  // 320,000 triangles
    hh_body_def ground = hh::body_def();
    ground.shape = *world.add_mesh(level);
    (void)world.add(ground);
    hh_body_def ball = hh::body_def();
    ball.kind = HH_DYNAMIC;
    ball.shape = *world.add_sphere(0.2);
    ball.pose.position = {200.0, 4.0, 200.0};
    ball.velocity_mps = {0.0, -3.0, 0.0};
    const hh::Body ball_id = *world.add(ball);
    if (!world.step(1.0 / 90.0)) {
        return 1;
    }
    hh::Mesh piece;
    std::thread loading([&piece] { piece = floor_mesh(7, 0.0F); });  // about 100 triangles
    loading.join();
    double worst_ms = 0.0;
    hh::Shape shape{};
    for (int i = 0; i < 200; ++i) {
        const double begin_ms = now_ms();
        shape = *world.add_mesh(piece);
        hh_body_def tile = hh::body_def();
        tile.shape = shape;
        tile.pose.position = {0.0, 10.0, 0.0};
        const hh::Body tile_id = *world.add(tile);
        const double added_ms = now_ms() - begin_ms;
        worst_ms = std::fmax(worst_ms, added_ms);
        if (!world.step(1.0 / 900.0) || world.remove(shape) || !world.remove(tile_id) ||
            !world.remove(shape) || world.has(shape) || !world.step(1.0 / 900.0)) {
            return 1;
        }
    }
    size_t count = 0;
    if (hh_world_shape_count(world.get(), &count) != HH_OK || count != 2) {
        return 1;  // ids and memory of removed shapes are used again
    }
    // A platform appears under the ball and stops it above the floor.
    hh_body_def platform = hh::body_def();
    platform.shape = *world.add_box({1.0, 0.1, 1.0});
    platform.pose.position = {200.0, 0.5, 200.0};
    (void)world.add(platform);
    for (int frame = 0; frame < 90; ++frame) {
        if (!world.step(1.0 / 90.0)) {
            return 1;
        }
    }
    const double height_m = world.pose(ball_id)->position.y;
    std::printf("adding a shape of 98 triangles: at most %.3f ms; the ball is at %.3f m\n",
                worst_ms, height_m);
    return std::fabs(height_m - 0.8) < 1e-3 ? 0 : 1;
}
