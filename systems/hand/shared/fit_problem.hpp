#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "engine/math/penalty_quadratic.hpp"
#include "systems/hand/shared/fit_terms.hpp"

namespace handhold {

// The term and the parts of the hand (digits, palm) to which the cost of a square or an inequality
// is booked: all of it to `a`, or half each to `a` and `b`.
struct FitPart {
    FitPart(FitTerm of, std::size_t only) : term(of), a(only), b(only) {}
    FitPart(FitTerm of, std::size_t one, std::size_t other) : term(of), a(one), b(other) {}

    FitTerm term;
    std::size_t a;  // index into FitTerms::cost_m2
    std::size_t b;
};

// Collects a fit's squares and inequalities, linearised at one pose, and their cost there.
class FitProblem {
  public:
    // `terms`: if not null, each cost is added to its entry for that term and part of the hand.
    // `rows`: buffer for the inequalities. The constructor reserves 72 kB in it, too much for a
    // small stack. Both must outlive the problem.
    FitProblem(int unknowns, FitTerms* terms, std::vector<PenaltyRow>& rows)
        : unknowns_(unknowns), terms_(terms), rows_(rows) {
        rows_.reserve(k_max_penalty_rows);
    }

    void clear() {
        rows_.clear();
        hessian_.setZero();
        gradient_.setZero();
        squares_m2_ = 0.0;
    }
    // Adds weight / 2 * (value + slope . x)^2.
    void add_square(const FitPart& part, double weight, double value, const Unknowns& slope) {
        std::array<int, k_max_unknowns> used;  // NOLINT(*-member-init): filled as far as used
        std::size_t count = 0;
        for (int i = 0; i < unknowns_; ++i) {
            used[count] = i;
            count += slope[i] != 0.0 ? 1U : 0U;
        }
        for (const int i : std::span(used).first(count)) {
            const double weighted = weight * slope[i];
            for (const int k : std::span(used).first(count)) {
                hessian_(i, k) += weighted * slope[k];
            }
            gradient_[i] += weight * value * slope[i];
        }
        add_constant(part, 0.5 * weight * value * value);
    }
    // The same for a slope of 1 at one place and 0 at all others.
    void add_square(const FitPart& part, double weight, double value, int place) {
        hessian_(place, place) += weight;
        gradient_[place] += weight * value;
        add_constant(part, 0.5 * weight * value * value);
    }
    void add_constant(const FitPart& part, double cost_m2) {
        squares_m2_ += cost_m2;
        charge(part, cost_m2);
    }
    // Adds the inequality slope . x + value >= 0 as a penalty: weight / 2 * violation^2.
    void add_row(const FitPart& part, const Unknowns& slope, double value, double weight) {
        rows_.push_back({slope, value, weight});
        charge(part, penalty_m2(rows_.back()));
    }
    // The same for a slope that is `sign` at one place and 0 at all others.
    void add_limit(const FitPart& part, int place, double sign, double value, double weight) {
        PenaltyRow& row = rows_.emplace_back();
        row.slope[place] = sign;
        row.value = value;
        row.weight = weight;
        row.only = place;
        charge(part, penalty_m2(row));
    }
    // Keeps an unknown at 0, by a stiffness much larger than all weights.
    void hold(int place) {
        constexpr double k_held = 1e6;
        hessian_(place, place) += k_held;
    }

    // The cost at x = 0, the pose at which the problem was linearised.
    double cost_m2() const {
        double sum_m2 = squares_m2_;
        for (const PenaltyRow& row : rows_) {
            sum_m2 += penalty_m2(row);
        }
        return sum_m2;
    }
    // Returns the x of least cost.
    Unknowns solve() const {
        return minimise_penalised(hessian_, gradient_, rows_, static_cast<std::size_t>(unknowns_));
    }
    // The same if only the unknowns from `first` on, `count` of them, change. Overwrites the
    // problem.
    Unknowns solve_some(int first, int count) {
        UnknownsSquare hessian = UnknownsSquare::Zero();
        hessian.topLeftCorner(count, count) = hessian_.block(first, first, count, count);
        std::size_t kept = 0;
        for (const PenaltyRow& row : rows_) {
            if (!row.slope.segment(first, count).isZero(0.0)) {
                PenaltyRow& to = rows_[kept++];
                to = {moved_to_front(row.slope, first, count), row.value, row.weight,
                      row.only >= 0 ? row.only - first : -1};
            }
        }
        const Unknowns some =
            minimise_penalised(hessian, moved_to_front(gradient_, first, count),
                               std::span(rows_).first(kept), static_cast<std::size_t>(count));
        Unknowns all = Unknowns::Zero();
        all.segment(first, count) = some.head(count);
        return all;
    }

  private:
    static Unknowns moved_to_front(const Unknowns& x, int first, int count) {
        Unknowns front = Unknowns::Zero();
        front.head(count) = x.segment(first, count);
        return front;
    }
    static double penalty_m2(const PenaltyRow& row) {
        const double violation = std::min(0.0, row.value);
        return 0.5 * row.weight * violation * violation;
    }
    void charge(const FitPart& part, double cost_m2) {
        if (terms_ != nullptr) {
            const auto term = static_cast<std::size_t>(part.term);
            terms_->cost_m2[part.a][term] += 0.5 * cost_m2;
            terms_->cost_m2[part.b][term] += 0.5 * cost_m2;
        }
    }

    const int unknowns_;
    FitTerms* const terms_;
    UnknownsSquare hessian_ = UnknownsSquare::Zero();
    Unknowns gradient_ = Unknowns::Zero();
    double squares_m2_ = 0.0;
    std::vector<PenaltyRow>& rows_;
};

}  // namespace handhold
