#include "engine/solver/newton/island_system.hpp"

#include <algorithm>
#include <cmath>

#include "engine/solver/newton/geometric_stiffness.hpp"

namespace handhold {

bool has_contact(std::span<const Row> rows) {
    return std::ranges::any_of(rows, [](const Row& row) { return row.group == RowGroup::contact; });
}

double longest_move(const SolveScratch& scratch) {
    double longest = 0.0;
    for (const Vec3& move : scratch.moves_m) {
        longest = std::max(longest, move.norm());
    }
    return longest;
}

void clear_stiffness(const IslandView& island, SolveScratch& scratch) {
    scratch.stiffness.assign(island.island_bodies.size(), Mat3::Zero());
}

void prepare_inertia(const IslandView& island, SolveScratch& scratch) {
    scratch.inverse_inertia_ws.resize(island.island_bodies.size());
    for (const std::uint32_t index : island.island_bodies) {
        const SolverBody& body = island.bodies[index];
        Mat3& inverse = scratch.inverse_inertia_ws[body.slot];
        if (body.inverse_inertia_bs.squaredNorm() == 0.0) {
            inverse.setZero();
            continue;
        }
        inverse = stiffened(inverse_inertia_ws(body), scratch.stiffness[body.slot]);
    }
}

namespace {

constexpr double k_limit = 100.0;  // times a joint: limits may contradict each other

double regularisation_of(const Row& row, const Regularisation& regularisation) {
    switch (row.group) {
        case RowGroup::drive:
            return regularisation.drive;
        case RowGroup::contact:
            return regularisation.contact;
        case RowGroup::limit:
            return row.unilateral ? k_limit * regularisation.joint : regularisation.joint;
        case RowGroup::joint:
            break;
    }
    return regularisation.joint;
}

}  // namespace

void regularise(std::span<const Row> rows, const Regularisation& regularisation, double factor,
                RowSystem& system) {
    double inverse_sum = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < system.size();) {
        const std::size_t width = rows[i].width;
        double sum = 0.0;
        for (std::size_t end = i + width; i < end; ++i) {
            sum += system.diagonal(i);
        }
        if (sum > 0.0) {
            const double size = static_cast<double>(width);
            inverse_sum += size * size / sum;
            count += size;
        }
    }
    const double mean = inverse_sum > 0.0 ? count / inverse_sum : 0.0;
    for (std::size_t i = 0; i < system.size(); ++i) {
        const double size = rows[i].group == RowGroup::drive ? mean : system.diagonal(i);
        system.alpha()[i] = factor * regularisation_of(rows[i], regularisation) * size;
    }
}

double gather_moves(SolveScratch& scratch) {
    const std::span<const RowSystem::Twist> moves = scratch.system.moves();
    scratch.moves_m.resize(moves.size());
    scratch.rotations_rad.resize(moves.size());
    double largest = 0.0;
    for (std::size_t slot = 0; slot < moves.size(); ++slot) {
        const RowSystem::Twist& move = moves[slot];
        scratch.moves_m[slot] = Vec3(move[0], move[1], move[2]);
        scratch.rotations_rad[slot] = Vec3(move[3], move[4], move[5]);
        largest = std::max(largest, scratch.rotations_rad[slot].squaredNorm());
    }
    return std::sqrt(largest);
}

}  // namespace handhold
