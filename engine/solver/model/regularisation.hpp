// Solver, model: regularisation R of the normal equations (J W J^T + R) lambda = -C.
//
// R is diagonal. With A = J W J^T and i a row,
//   R_ii = factor * r_i * s_i
//   r_i      dimensionless, by the row's group: `relative_regularisation`
//   s_i      A_ii; for drive rows the harmonic mean of all A_ii instead, so that two drives on
//            bodies of different masses share an error evenly: `HarmonicMean`. Geometric stiffness
//            may lower the mean only to a share of its value without stiffness: `DriveScale`
//   factor   1, or larger if a step was rejected
// RowSystem (`regularise`) and TriadSystem (`factorise`) both evaluate this formula. A row with a
// larger r_i is less stiff: if rows contradict each other, their errors end in proportion to R_ii.

#pragma once

#include <algorithm>

#include "engine/solver/model/rows.hpp"

namespace handhold {

// The relative regularisation r_i of each row group; > 0. The defaults are those of the position
// solve.
struct Regularisation {
    double drive = 1e-8;
    double contact = 1e-7;
    // joints and locked limits; other limits: k_limit_regularisation times this
    double joint = 1e-10;
};

// Limits are less stiff than joints, because limits of different joints may contradict each other.
inline constexpr double k_limit_regularisation = 100.0;

inline double relative_regularisation(const Row& row, const Regularisation& regularisation) {
    switch (row.group) {
        case RowGroup::drive:
            return regularisation.drive;
        case RowGroup::contact:
            return regularisation.contact;
        case RowGroup::limit:
            return row.unilateral ? k_limit_regularisation * regularisation.joint
                                  : regularisation.joint;
        case RowGroup::joint:
            break;
    }
    return regularisation.joint;
}

// Harmonic mean of the diagonal of J W J^T. The rows of one vector-valued error enter with the mean
// of their diagonal entries, so that the result does not depend on the world's orientation.
class HarmonicMean {
  public:
    // Adds one error of `width` rows with this sum of diagonal entries. Ignored if the sum is 0:
    // nothing can move the rows.
    void add(double width, double diagonal_sum) {
        if (diagonal_sum > 0.0) {
            add_inverse(width, width * width / diagonal_sum);
        }
    }
    // Adds several errors at once: their number of rows, and the sum of width^2 / diagonal_sum.
    void add_inverse(double rows, double inverse_sum) {
        inverse_sum_ += inverse_sum;
        count_ += rows;
    }
    double value() const { return inverse_sum_ > 0.0 ? count_ / inverse_sum_ : 0.0; }

  private:
    double inverse_sum_ = 0.0;
    double count_ = 0.0;
};

// The scale s_i of drive rows over the steps of a solve. Drives that contradict each other have
// multipliers in proportion to 1 / R_ii. The geometric stiffness grows with the multipliers and
// lowers the A_ii of angular rows without bound. A mean that followed it would lower R_ii, and with
// it the multipliers would grow in every step. The A_ii of point rows have a part that stiffness
// does not change, 1 / mass, so that islands without angular rows hardly reach the bound.
class DriveScale {
  public:
    // `mean`: HarmonicMean of this step. Before the first step without stiffness it has no bound.
    void update(double mean, bool has_stiffness) {
        if (!has_stiffness) {
            unstiffened_ = mean;
        }
        value_ = std::max(mean, k_min_share * unstiffened_);
    }
    double value() const { return value_; }

  private:
    static constexpr double k_min_share = 0.1;
    double value_ = 0.0;
    double unstiffened_ = 0.0;  // mean of the last step without stiffness
};

}  // namespace handhold
