// The guide's sample of tuning a world: a number, a file's text, and what a bad value gives.
#include <cstdio>

#include <handhold/handhold.hpp>

int main() {
    hh::World world;
    // [tuning]
    // A file's text; numbers that it lacks get their defaults.
    const hh::Status loaded = world.load_tuning(R"({"palm": {"rate_mps": 0.4}})");
    const hh::Status tuned = world.tune("hand.reach_m", 0.12);
    const hh::Status refused = world.tune("hand.reach_m", -1.0);  // keeps 0.12
    std::printf("%s\n", hh_last_error());

    hh_tuning_info info = hh_default_tuning_info();
    for (std::size_t i = 0; hh_tuning_describe(i, &info) == HH_OK; ++i) {
        std::printf("%-36s %-6s [%g, %g] %s\n", info.name, info.unit, info.low, info.high,
                    info.what);
    }
    // [tuning]
    const bool is_kept =
        *world.tuning("hand.reach_m") == 0.12 && *world.tuning("palm.rate_mps") == 0.4;
    return tuned && loaded && !refused && is_kept ? 0 : 1;
}
