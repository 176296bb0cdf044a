#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

// A scene of boxes without joints, as text that tools/bench_peers writes, and the loop that times
// an engine on it.
//   hz F, frames N
//   body free|fixed|driven half(3) mass inertia(3) friction restitution position(3)
//   rotation(x,y,z,w) velocity(3) spin(3) pose position(3) rotation(4)       of the driven body,
//   one per frame
// Units are SI, everything is in the world's frame. At most one body is driven.
namespace handhold::peers {

enum class Motion { free, fixed, driven };

struct Placed {
    std::array<double, 3> position{};
    std::array<double, 4> rotation{0.0, 0.0, 0.0, 1.0};  // x, y, z, w
};

struct Body {
    Motion motion = Motion::free;
    std::array<double, 3> half_m{};
    double mass_kg = 0.0;
    std::array<double, 3> inertia_kgm2{};
    double friction = 0.0;
    double restitution = 0.0;
    Placed pose;
    std::array<double, 3> velocity_mps{};
    std::array<double, 3> spin_radps{};
};

struct Scene {
    double hz = 90.0;
    int frames = 0;
    std::vector<Body> bodies;
    std::vector<Placed> driven;  // poses of the driven body at the end of each frame
};

template <std::size_t N>
std::istream& operator>>(std::istream& in, std::array<double, N>& values) {
    for (double& value : values) {
        in >> value;
    }
    return in;
}

// Ends the program with status 2 if the file is not a scene.
inline Scene read_scene(const char* path) {
    std::ifstream in(path);
    Scene scene;
    std::string word;
    while (in >> word) {
        if (word == "hz") {
            in >> scene.hz;
        } else if (word == "frames") {
            in >> scene.frames;
        } else if (word == "body") {
            Body body;
            in >> word >> body.half_m >> body.mass_kg >> body.inertia_kgm2 >> body.friction >>
                body.restitution >> body.pose.position >> body.pose.rotation >> body.velocity_mps >>
                body.spin_radps;
            body.motion = word == "free"     ? Motion::free
                          : word == "driven" ? Motion::driven
                                             : Motion::fixed;
            scene.bodies.push_back(body);
        } else if (word == "pose") {
            in >> scene.driven.emplace_back().position >> scene.driven.back().rotation;
        } else {
            break;
        }
    }
    if (!in.eof() || scene.bodies.empty()) {
        std::fprintf(stderr, "%s: not a scene\n", path);
        std::exit(2);
    }
    return scene;
}

// CPU time of the calling thread, in microseconds.
inline double now_us() {
#ifdef CLOCK_THREAD_CPUTIME_ID
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
#else
    return std::chrono::duration<double, std::micro>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
#endif
}

// Calls step(frame) for each frame and prints the times of these calls, without the first, as one
// line of JSON. The first call allocates and fills caches.
inline void time_frames(const Scene& scene, const std::string& engine,
                        const std::function<void(int)>& step) {
    std::vector<double> us;
    for (int frame = 0; frame < scene.frames; ++frame) {
        const double begin_us = now_us();
        step(frame);
        const double spent_us = now_us() - begin_us;
        if (frame > 0 || scene.frames == 1) {
            us.push_back(spent_us);
        }
    }
    std::sort(us.begin(), us.end());
    const auto quantile = [&us](double share) {
        return us[static_cast<std::size_t>(share * static_cast<double>(us.size() - 1))];
    };
    std::printf(
        "{\"engine\":\"%s\",\"us_per_frame\":{\"median\":%.3f,\"p99\":%.3f,\"max\":%.3f}}\n",
        engine.c_str(), quantile(0.5), quantile(0.99), us.back());
}

}  // namespace handhold::peers
