#pragma once

#include "engine/math/math.hpp"

namespace handhold {

// Quadratic motion within one frame, through the positions at the start of the last frame and at
// the start and end of this one. So a constant acceleration looks the same at any frame rate. Never
// overshoots an end.
class QuadraticPath {
  public:
    // The position moves by `moved_m` in this frame, which takes span_s seconds. In the last frame
    // it moved at `before_mps` for before_s seconds. Times > 0.
    QuadraticPath(const Vec3& moved_m, double span_s, const Vec3& before_mps, double before_s)
        : span_s_(span_s), rate_mps_(moved_m / span_s) {
        const Vec3 change = rate_mps_ - before_mps;
        half_acceleration_ = change / (span_s + before_s);
        // The rate at an end must not reverse: |a| span / 2 <= |rate|.
        const double rate_norm_mps = rate_mps_.norm();
        const double end_change_mps = half_acceleration_.norm() * span_s;
        if (end_change_mps > rate_norm_mps) {
            half_acceleration_ *= rate_norm_mps / end_change_mps;
        }
    }
    Vec3 at(double t_s) const {
        return t_s * rate_mps_ + (t_s * (t_s - span_s_)) * half_acceleration_;
    }
    const Vec3& rate_mps() const { return rate_mps_; }

  private:
    double span_s_;
    Vec3 rate_mps_;
    Vec3 half_acceleration_;
};

}  // namespace handhold
