#pragma once

#include <cstdint>
#include <limits>

#include "engine/solver/packed/triad_system.hpp"
#include "tests/engine/solver/scene.hpp"

// Random islands and ropes for TriadSystem. In a namespace of its own, because other tests have
// functions of the same names.
namespace handhold::test::triads {

constexpr double k_touch_m = std::numeric_limits<double>::infinity();

inline std::uint32_t random_index(std::uint32_t count, Random& random) {
    return static_cast<std::uint32_t>(random.engine()() % count);
}

// A tree of balls, welds and drives on a fixed body; some bodies are connected twice, some are held
// still.
inline SolverScene random_tree(Random& random) {
    SolverScene scene;
    const std::uint32_t count = 3 + random_index(12, random);
    scene.graph.bodies = {test::fixed_body(1, test::random_pose(random))};
    for (std::uint32_t i = 1; i < count; ++i) {
        scene.graph.bodies.push_back(test::random_free_body(i + 1, random));
    }
    scene.graph.bodies.push_back(
        test::translating_body(count + 1, 80.0, test::random_pose(random)));
    const auto connect = [&](RowKind kind, std::uint32_t a, std::uint32_t b) {
        RowBlock block = test::random_block(kind, a, b, random);
        block.key = scene.graph.blocks.size();
        test::meet(scene.graph.bodies, block);
        scene.graph.blocks.push_back(block);
    };
    connect(RowKind::ball, 0, 1);
    for (std::uint32_t i = 2; i < count; ++i) {
        const RowKind kind = random_index(4, random) == 0 ? RowKind::fixed : RowKind::ball;
        connect(kind, i - 1 - random_index(2, random), i);
    }
    if (random_index(2, random) == 0 && count > 4) {
        connect(RowKind::ball, 1, count - 1);
    }
    connect(random_index(2, random) == 0 ? RowKind::drive_point : RowKind::drive_weld, count,
            count - 1);
    if (random_index(3, random) == 0) {
        connect(RowKind::drive_direction, count, count - 1);
    }
    for (SolverBody& body : scene.graph.bodies) {
        if (random_index(8, random) == 0) {  // held still by a phase
            body.inverse_mass = 0.0;
            body.inverse_inertia_bs.setZero();
        }
    }
    sort_blocks(scene.graph);
    build_islands(scene.graph);
    return scene;
}

inline bool loads(SolverScene& scene, double touch_m = k_touch_m) {
    build_islands(scene.graph);
    TriadSystem system;
    return system.load(scene.view(scene.graph.islands.front()), touch_m);
}

inline void move_freely(SolverBody& body) {
    if (body.role != BodyRole::fixed) {
        body.inverse_mass = 1.0 / body.mass_kg;
        body.inverse_inertia_bs = body.role == BodyRole::translating
                                      ? Vec3(Vec3::Zero())
                                      : Vec3(body.inertia_kgm2.cwiseInverse());
    }
}

// An island that TriadSystem takes.
inline SolverScene random_island(Random& random) {
    for (;;) {
        SolverScene scene = random_tree(random);
        if (loads(scene)) {
            return scene;
        }
    }
}

// Ropes of up to 150 links, solved in strands. Each end has a drive, a fixed body or nothing; some
// have a short branch or are closed to a ring; in some a link is held still or is a hundred times
// as heavy.
inline SolverScene random_rope(Random& random) {
    SolverScene scene;
    const std::uint32_t links = 20 + random_index(130, random);
    scene.graph.bodies = {test::fixed_body(1, test::random_pose(random))};
    const auto connect = [&](RowKind kind, std::uint32_t a, std::uint32_t b) {
        RowBlock block = test::random_block(kind, a, b, random);
        block.key = scene.graph.blocks.size();
        test::meet(scene.graph.bodies, block);
        scene.graph.blocks.push_back(block);
    };
    const bool sometimes_heavy = random_index(4, random) == 0;
    for (std::uint32_t i = 1; i <= links; ++i) {
        SolverBody link = test::random_free_body(i + 1, random);
        if (sometimes_heavy && random_index(8, random) == 0) {
            link = test::free_body(i + 1, 100.0 * link.mass_kg, 100.0 * link.inertia_kgm2,
                                   link.pose_ws);
        }
        link.pose_ws.position = scene.graph.bodies.back().pose_ws.position + random.vector(0.3);
        scene.graph.bodies.push_back(link);
        if (i > 1) {
            connect(RowKind::ball, i - 1, i);
        }
    }
    if (random_index(3, random) > 0) {
        connect(RowKind::ball, 0, 1);
    }
    if (random_index(4, random) == 0) {
        connect(RowKind::ball, links, 1);
    }
    if (random_index(3, random) == 0) {  // a branch
        scene.graph.bodies.push_back(test::random_free_body(links + 2, random));
        connect(RowKind::ball, 1 + random_index(links, random), links + 1);
    }
    const auto driver = static_cast<std::uint32_t>(scene.graph.bodies.size());
    scene.graph.bodies.push_back(
        test::translating_body(driver + 1, 80.0, test::random_pose(random)));
    if (random_index(3, random) > 0) {
        connect(random_index(3, random) > 0 ? RowKind::drive_point : RowKind::drive_weld, driver,
                links);
    }
    if (random_index(4, random) == 0) {
        SolverBody& still = scene.body(1 + random_index(links, random));
        still.inverse_mass = 0.0;
        still.inverse_inertia_bs.setZero();
    }
    sort_blocks(scene.graph);
    build_islands(scene.graph);
    return scene;
}

inline void disturb(SolverScene& scene, double size, Random& random) {
    for (SolverBody& body : scene.graph.bodies) {
        if (body.role == BodyRole::free) {
            body.pose_ws.position += random.vector(0.1 * size);
            body.pose_ws.rotation =
                (rotation_from_vector(random.vector(size)) * body.pose_ws.rotation).normalized();
        }
        // Immovable and driving bodies have one velocity, so that nothing contradicts.
        body.velocity_mps = body.inverse_mass > 0.0 ? random.vector(1.0) : Vec3(0.5, -0.2, 0.1);
        body.spin_radps = random.vector(body.inverse_inertia_bs.isZero(0.0) ? 0.0 : 5.0);
    }
}

inline SolverScene hanging_ball() {
    SolverScene scene;
    scene.graph.bodies = {test::fixed_body(1), test::ball(2, 1.0, 0.1)};
    scene.graph.blocks = {test::row_block(RowKind::ball, 0, 1)};
    return scene;
}

}  // namespace handhold::test::triads
