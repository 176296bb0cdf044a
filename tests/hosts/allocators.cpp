// A host with its own operator new, its own allocator in Bullet, and two worlds on two threads: the
// library takes nothing from it. Prints figures; exit status 0: all blocks came and went as they
// should.
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <thread>

#include <handhold/handhold.hpp>

namespace {

std::atomic<long> g_live{0};
std::atomic<long> g_all{0};
std::atomic<long> g_foreign{0};

// Blocks have a mark before them: one that another allocator made is found.
struct Mark {
    std::uint64_t magic;
    std::uint64_t unused;
};
constexpr std::uint64_t k_magic = 0x48414e44484f4c44ULL;

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
    if (memory == nullptr) {
        return;
    }
    Mark* const mark = static_cast<Mark*>(memory) - 1;
    if (mark->magic != k_magic) {
        ++g_foreign;
        return;
    }
    mark->magic = 0;
    --g_live;
    std::free(mark);
}

}  // namespace

void* operator new(std::size_t size) { return allocate(size); }
void operator delete(void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }

static std::uint64_t play() {
    hh::World world;
    hh_body_def wall = hh::body_def();
    wall.shape = *world.add_box({2.0, 2.0, 0.1});
    wall.pose.position = {0.0, 1.5, -0.6};
    (void)world.add(wall);
    hh_body_def crate = hh::body_def();
    crate.kind = HH_DYNAMIC;
    crate.shape = *world.add_box({0.1, 0.2, 0.1});
    crate.pose.position = {0.5, 1.5, -0.3};
    crate.velocity_mps = {-0.1, 0.0, -0.4};
    (void)world.add(crate);
    const hh::Player you = *world.add(hh::player_def());
    for (int frame = 1; frame <= 90; ++frame) {
        hh::Sample sample = hh::sample();
        sample.time_s = frame / 90.0;
        sample.head.position.y = 1.6;
        sample.hands[HH_RIGHT].position = {0.2, 1.4, -0.4};
        sample.grab[HH_RIGHT] = frame > 30;
        if (!world.step(1.0 / 90.0, hh::input(you, {&sample, 1}))) {
            return 0;
        }
    }
    return world.hash();
}

int main() {
    const std::uint64_t alone = play();
    const long live_before = g_live;
    std::uint64_t hashes[2] = {};
    std::thread first([&hashes] { hashes[0] = play(); });
    std::thread second([&hashes] { hashes[1] = play(); });
    first.join();
    second.join();
    // Blocks that threads keep until they end are gone with them.
    std::printf("%ld blocks from the host's operator new, %ld more than before, %ld foreign\n",
                g_all.load(), g_live - live_before, g_foreign.load());
    const bool is_right = alone != 0 && hashes[0] == alone && hashes[1] == alone && g_all > 1000 &&
                          g_foreign == 0 && g_live - live_before <= 0;
    return is_right ? 0 : 1;
}
