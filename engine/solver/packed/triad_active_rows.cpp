// What TriadSystem tells of its errors, and which of its rows are worth another step.
#include <algorithm>
#include <cmath>

#include "engine/solver/packed/triad_system.hpp"

namespace handhold {

double TriadSystem::worst_value() { return std::sqrt(kernels_->worst_square(arrays())); }

double TriadSystem::worst_hand_value() const {
    double worst = 0.0;
    for (std::size_t i = 0; has_hand_ && i < hands_.size(); ++i) {
        worst = hands_[i] != 0 ? std::max(worst, dot3(values_[i].v, values_[i].v)) : worst;
    }
    return std::sqrt(worst);
}

JointError TriadSystem::worst_joints() const {
    Four of_strands = zero_four();
    for (const FourLinks& links : links_) {
        of_strands = larger(of_strands, dot(links.value, links.value));
    }
    double points = largest(of_strands);
    double turns = 0.0;
    const std::span<const std::uint32_t> rest = plans_.current().rest();
    for (std::size_t i = 0; i < rest.size(); ++i) {
        if (hands_[i] == 0) {
            double& worst = triads_[rest[i]].turns ? turns : points;
            worst = std::max(worst, dot3(values_[i].v, values_[i].v));
        }
    }
    return {std::sqrt(points), std::sqrt(turns) / k_angle_m};
}

void TriadSystem::widen() {
    is_narrow_ = false;
    windows_.clear();
    for (const TriadPlan::Braid& braid : plans_.current().braids()) {
        windows_.push_back({0, braid.length + 1});
    }
}

// What the last solve moved in the window, and some rows around it; all of it where nothing moved.
RowWindow TriadSystem::busy_window(const TriadPlan::Braid& braid, const RowWindow& window,
                                   double still_m) const {
    constexpr std::uint32_t k_margin = 4;  // pulls fade by a factor of four or so a link
    RowWindow busy{window.end, window.begin};
    for (std::uint32_t row = window.begin; row < window.end; ++row) {
        const FourBodies& bodies = bodies_[braid.row + row];
        const double turn_square = largest(dot(bodies.turn, bodies.turn));
        const double square =
            std::max(largest(dot(bodies.move, bodies.move)), k_angle_m * k_angle_m * turn_square);
        if (square >= still_m * still_m) {
            busy = {std::min(busy.begin, row), row + 1};
        }
    }
    if (busy.begin >= busy.end) {
        return window;
    }
    const std::uint32_t begin = busy.begin - std::min(busy.begin, k_margin);
    return {std::max(window.begin, begin), std::min(window.end, busy.end + k_margin)};
}

void TriadSystem::narrow(double still_m) {
    constexpr std::uint32_t k_short = 48;  // looking for a part of it costs as much as it saves
    const std::span<const TriadPlan::Braid> braids = plans_.current().braids();
    for (std::size_t i = 0; i < braids.size(); ++i) {
        if (braids[i].length < k_short) {
            continue;
        }
        windows_[i] = busy_window(braids[i], windows_[i], still_m);
    }
    is_narrow_ = busy_rows() < strand_rows();
}

std::size_t TriadSystem::busy_rows() const {
    std::size_t rows = 0;
    for (const RowWindow& window : windows_) {
        rows += window.end - window.begin;
    }
    return rows;
}
std::size_t TriadSystem::strand_rows() const {
    return plans_.current().braid_steps() + plans_.current().braids().size();
}

}  // namespace handhold
