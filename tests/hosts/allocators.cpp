// A host with its own operator new, which takes each thread's blocks from that thread's arena, and
// two worlds on two threads: the shared library uses it for everything. Prints figures; exit status
// 0: each world's blocks came from its own arena, and went back to it.
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <thread>

#include <handhold/handhold.hpp>

namespace {

// One arena a thread of the host's; arena 0 is everybody else's.
struct Arena {
    std::atomic<long> live{0};
    std::atomic<long> all{0};
};
Arena g_arenas[3];
std::atomic<long> g_foreign{0};
std::atomic<long> g_strays{0};  // freed by another thread than the one that took it
thread_local std::uint64_t t_arena = 0;

// Blocks have a mark before them: one that another allocator made is found.
struct Mark {
    std::uint64_t magic;
    std::uint64_t arena;
};
constexpr std::uint64_t k_magic = 0x48414e44484f4c44ULL;

void* allocate(std::size_t size) {
    auto* const mark = static_cast<Mark*>(std::malloc(size + sizeof(Mark)));
    if (mark == nullptr) {
        std::abort();
    }
    mark->magic = k_magic;
    mark->arena = t_arena;
    ++g_arenas[t_arena].live;
    ++g_arenas[t_arena].all;
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
    g_strays += mark->arena != 0 && mark->arena != t_arena ? 1 : 0;
    --g_arenas[mark->arena].live;
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
    std::uint64_t hashes[2] = {};
    const auto play_in = [&hashes](std::uint64_t arena) {
        t_arena = arena;
        hashes[arena - 1] = play();
    };
    const long strays_before = g_strays;
    std::thread first(play_in, 1);
    std::thread second(play_in, 2);
    first.join();
    second.join();
    // Blocks that threads keep until they end are gone with them.
    const long strays = g_strays - strays_before;
    bool is_right = alone != 0 && hashes[0] == alone && hashes[1] == alone && g_foreign == 0;
    for (int i : {1, 2}) {
        is_right = is_right && g_arenas[i].all > 1000 && g_arenas[i].live == 0;
    }
    std::printf(
        "%ld and %ld blocks from the arenas of two threads, %ld and %ld left, %ld freed by "
        "the other, %ld foreign\n",
        g_arenas[1].all.load(), g_arenas[2].all.load(), g_arenas[1].live.load(),
        g_arenas[2].live.load(), strays, g_foreign.load());
    return is_right && strays == 0 ? 0 : 1;
}
