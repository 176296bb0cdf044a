// A host whose own physics is Bullet, with an allocator of its own (btAlignedAllocSetCustom),
// beside worlds of Handhold's, which uses the same Bullet inside. Prints figures; exit status 0:
// every block that the allocator got back was its own, and none is left.
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <vector>

#include <btBulletDynamicsCommon.h>
#include <handhold/handhold.hpp>

namespace {

std::atomic<long> g_live{0};
std::atomic<long> g_all{0};
std::atomic<long> g_foreign{0};

struct alignas(16) Mark {
    std::uint64_t magic;
};
constexpr std::uint64_t k_magic = 0x42554c4c4554484fULL;

void* allocate(std::size_t size) {
    auto* const mark = static_cast<Mark*>(std::malloc(size + sizeof(Mark)));
    if (mark == nullptr) {
        std::abort();
    }
    mark->magic = k_magic;
    ++g_live;
    ++g_all;
    return mark + 1;
}

void release(void* memory) {
    Mark* const mark = static_cast<Mark*>(memory) - 1;
    if (mark->magic != k_magic) {
        ++g_foreign;
        return;
    }
    mark->magic = 0;
    --g_live;
    std::free(mark);
}

// The host's own world: a ball falls on a box. Returns its height.
double play_with_bullet() {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
    btBoxShape floor_shape(btVector3(5.0, 0.5, 5.0));
    btSphereShape ball_shape(0.25);
    btRigidBody floor(btRigidBody::btRigidBodyConstructionInfo(0.0, nullptr, &floor_shape));
    btRigidBody ball(btRigidBody::btRigidBodyConstructionInfo(1.0, nullptr, &ball_shape,
                                                              btVector3(0.1, 0.1, 0.1)));
    ball.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0.0, 2.0, 0.0)));
    world.addRigidBody(&floor);
    world.addRigidBody(&ball);
    for (int frame = 0; frame < 300; ++frame) {
        world.stepSimulation(1.0 / 90.0, 1, 1.0 / 90.0);
    }
    const double height_m = ball.getWorldTransform().getOrigin().y();
    world.removeRigidBody(&ball);
    world.removeRigidBody(&floor);
    return height_m;
}

// A world of Handhold's with every kind of collider that Bullet gets to see.
std::uint64_t play_with_handhold() {
    hh::World world;
    const std::vector<float> xyz = {-5, 0, -5, -5, 0, 5, 5, 0, 5, 5, 0, -5};
    const std::vector<std::uint32_t> indices = {0, 1, 2, 0, 2, 3};
    const hh::Mesh mesh(xyz, indices);
    hh_body_def floor = hh::body_def();
    floor.shape = world.add_mesh(mesh).value_or({});
    (void)world.add(floor);
    hh_body_def crate = hh::body_def();
    crate.kind = HH_DYNAMIC;
    crate.shape = world.add_box({0.1, 0.2, 0.1}).value_or({});
    crate.pose.position = {0.2, 1.2, -0.4};
    crate.velocity_mps = {0.0, -1.0, 0.0};
    (void)world.add(crate);
    const hh::Player you = world.add(hh::player_def()).value_or({});
    for (int frame = 1; frame <= 120; ++frame) {
        hh::Sample sample = hh::sample();
        sample.time_s = frame / 90.0;
        sample.head.position.y = 1.6;
        sample.grab[HH_RIGHT] = frame > 10;
        sample.hands[HH_RIGHT].position = {0.2, 1.2, -0.3};
        if (!world.step(1.0 / 90.0, hh::input(you, {&sample, 1}))) {
            return 0;
        }
    }
    return world.hash();
}

}  // namespace

int main() {
    btAlignedAllocSetCustom(&allocate, &release);  // before the first world, as Bullet asks for
    // Blocks that threads keep until they end are gone with them.
    std::uint64_t alone = 0;
    std::uint64_t beside = 0;
    std::thread first([&alone] { alone = play_with_handhold(); });
    first.join();
    const double before_m = play_with_bullet();
    std::thread other([&beside] { beside = play_with_handhold(); });
    const double during_m = play_with_bullet();
    other.join();
    std::printf("%ld blocks from the host's Bullet allocator, %ld left, %ld foreign\n",
                g_all.load(), g_live.load(), g_foreign.load());
    const bool is_right = alone != 0 && alone == beside && std::fabs(before_m - 0.75) < 0.02 &&
                          before_m == during_m && g_all > 100 && g_live == 0 && g_foreign == 0;
    return is_right ? 0 : 1;
}
