#pragma once

#include "engine/math/math.hpp"

namespace handhold {

// The way of what moves in one frame: through where it was at both ends of the last frame and is
// now, so that a steady acceleration looks the same at any frame rate. Never back past either end.
class QuadraticPath {
  public:
    // It moved so far in span_s; before, at this rate for that long. Times > 0.
    QuadraticPath(const Vec3& moved_m, double span_s, const Vec3& before_mps, double before_s)
        : span_s_(span_s), rate_mps_(moved_m / span_s) {
        const Vec3 change = rate_mps_ - before_mps;
        half_acceleration_ = change / (span_s + before_s);
        // Twice what the way leaves the straight line at its ends must not exceed the line.
        const double most = rate_mps_.norm();
        const double ends = half_acceleration_.norm() * span_s;
        if (ends > most) {
            half_acceleration_ *= most / ends;
        }
    }
    Vec3 at(double t_s) const {
        return t_s * rate_mps_ + (t_s * (t_s - span_s_)) * half_acceleration_;
    }
    const Vec3& rate_mps() const { return rate_mps_; }

  private:
    double span_s_;
    Vec3 rate_mps_;
    Vec3 half_acceleration_;  // half the acceleration
};

}  // namespace handhold
