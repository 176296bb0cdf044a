#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "engine/solver/sparse/elimination_plan.hpp"

namespace handhold {

// The plans of the structures that an island has had of late. Structures come back: with and
// without contacts, with the player held still or not. Which were kept changes nothing but the
// cost. A Plan has `build`, `reserve` and `fits` as EliminationPlan.
template <typename Plan>
class PlanCache {
  public:
    // The plan of this structure: a kept one, or a new one in place of the one used longest ago.
    const Plan& choose(std::span<const RowNode> nodes, std::span<const std::uint8_t> can_rotate) {
        ++uses_;
        std::size_t oldest = current_;
        for (std::size_t i = 0; i < k_plans; ++i) {
            const std::size_t candidate = (current_ + i) % k_plans;
            if (used_[candidate] != 0 && plans_[candidate].fits(nodes, can_rotate)) {
                return use(candidate);
            }
            oldest = used_[candidate] < used_[oldest] ? candidate : oldest;
        }
        plans_[oldest].build(nodes, can_rotate);
        // All grow together: it is the first of its size that allocates, not the first six.
        for (Plan& plan : plans_) {
            plan.reserve(plans_[oldest]);
        }
        return use(oldest);
    }
    // The one chosen last.
    const Plan& current() const { return plans_[current_]; }

  private:
    const Plan& use(std::size_t plan) {
        current_ = plan;
        used_[plan] = uses_;
        return plans_[plan];
    }

    static constexpr std::size_t k_plans = 6;
    std::array<Plan, k_plans> plans_;
    std::array<std::uint64_t, k_plans> used_{};
    std::uint64_t uses_ = 0;
    std::size_t current_ = 0;
};

}  // namespace handhold
