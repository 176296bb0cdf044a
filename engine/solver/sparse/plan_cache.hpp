// Solver, sparse: a small cache of elimination plans.

#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "engine/solver/sparse/elimination_plan.hpp"

namespace handhold {

// Keeps the plans of recent structures, because structures recur: with and without contacts, or
// with a body held still or not. Affects cost only, never the result. A Plan has `build`, `reserve`
// and `fits`, like EliminationPlan.
template <typename Plan>
class PlanCache {
  public:
    // Returns the plan of this structure: a cached one, or a new one that replaces the least
    // recently used.
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
        // Gives every plan in the cache the capacity of this one, so that later builds of this size
        // do not allocate.
        for (Plan& plan : plans_) {
            plan.reserve(plans_[oldest]);
        }
        return use(oldest);
    }
    // The plan chosen last.
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
