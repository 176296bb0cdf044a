// Solver, packed: TriadSystem's error norms, and the choice of active rows in long strands.
#include <algorithm>
#include <cmath>

#include "engine/solver/packed/triad_system.hpp"

namespace handhold {

double TriadSystem::worst_residual() { return std::sqrt(kernels_->worst_square(arrays())); }

double TriadSystem::worst_drive_residual() const {
    double worst = 0.0;
    for (std::size_t i = 0; has_drive_rows_ && i < is_drive_.size(); ++i) {
        worst = is_drive_[i] != 0 ? std::max(worst, dot3(values_[i].v, values_[i].v)) : worst;
    }
    return std::sqrt(worst);
}

JointError TriadSystem::worst_joints() const {
    Double4 strand_squares = zero4();
    for (const Links4& links : links_) {
        strand_squares = larger(strand_squares, dot(links.value, links.value));
    }
    double points = largest(strand_squares);
    double is_angular = 0.0;
    const std::span<const std::uint32_t> rest = plans_.current().rest();
    for (std::size_t i = 0; i < rest.size(); ++i) {
        if (is_drive_[i] == 0) {
            double& worst = triads_[rest[i]].is_angular ? is_angular : points;
            worst = std::max(worst, dot3(values_[i].v, values_[i].v));
        }
    }
    return {std::sqrt(points), std::sqrt(is_angular) / k_angle_lever_m};
}

void TriadSystem::activate_all_rows() {
    is_restricted_ = false;
    windows_.clear();
    for (const TriadPlan::StrandPack& strand_pack : plans_.current().strand_packs()) {
        windows_.push_back({0, strand_pack.length + 1});
    }
}

// The rows of `window` that the last solve moved by at least min_move_m, and a margin on both
// sides. The whole window if no row moved that far.
RowWindow TriadSystem::active_window(const TriadPlan::StrandPack& strand_pack,
                                     const RowWindow& window, double min_move_m) const {
    constexpr std::uint32_t k_margin = 4;  // a pull fades by a factor of about four per link
    RowWindow active{window.end, window.begin};
    for (std::uint32_t row = window.begin; row < window.end; ++row) {
        const Bodies4& bodies = bodies_[strand_pack.row + row];
        const double turn_square = largest(dot(bodies.turn, bodies.turn));
        const double square = std::max(largest(dot(bodies.move, bodies.move)),
                                       k_angle_lever_m * k_angle_lever_m * turn_square);
        if (square >= min_move_m * min_move_m) {
            active = {std::min(active.begin, row), row + 1};
        }
    }
    if (active.begin >= active.end) {
        return window;
    }
    const std::uint32_t begin = active.begin - std::min(active.begin, k_margin);
    return {std::max(window.begin, begin), std::min(window.end, active.end + k_margin)};
}

void TriadSystem::restrict_to_active(double min_move_m) {
    // In shorter strands the search costs more than a window saves.
    constexpr std::uint32_t k_short = 48;
    const std::span<const TriadPlan::StrandPack> strand_packs = plans_.current().strand_packs();
    for (std::size_t i = 0; i < strand_packs.size(); ++i) {
        if (strand_packs[i].length < k_short) {
            continue;
        }
        windows_[i] = active_window(strand_packs[i], windows_[i], min_move_m);
    }
    is_restricted_ = active_rows() < strand_rows();
}

std::size_t TriadSystem::active_rows() const {
    std::size_t rows = 0;
    for (const RowWindow& window : windows_) {
        rows += window.end - window.begin;
    }
    return rows;
}
std::size_t TriadSystem::strand_rows() const {
    return plans_.current().strand_pack_steps() + plans_.current().strand_packs().size();
}

}  // namespace handhold
