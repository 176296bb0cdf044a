#pragma once

#include <array>
#include <cstddef>

#include "engine/geometry/disc_contact.hpp"
#include "engine/math/math.hpp"

// Motion of a closing chain, for disc_contact.cpp only. Inline because it runs in the inner loop.
//
// Time is the closing fraction: 0 is fully open, 1 is fully closed. Velocities and accelerations
// are therefore in metres per full closing.
namespace handhold {

// Positions and velocities of the hinges and of the last link's end, in disc space.
struct ChainMotion {
    std::array<Vec2, k_max_disc_links + 1> point;
    std::array<Vec2, k_max_disc_links + 1> velocity_m;  // displacement per full closing
};

// A closing chain whose hinges before `first_free_hinge` are frozen at their angles.
class ClosingChain {
  public:
    ClosingChain(const DiscChain& chain, double at) : chain_(chain) {
        for (std::size_t i = 0; i < chain.link_count; ++i) {
            angle_rad_[i] = angle_at(i, at);
        }
        cache_frozen_links();
    }

    double angle_at(std::size_t hinge, double at) const {
        return chain_.open_rad[hinge] + at * (chain_.closed_rad[hinge] - chain_.open_rad[hinge]);
    }

    ChainMotion motion_at(double at) const {
        ChainMotion motion;
        for (std::size_t i = 0; i <= first_free_hinge_; ++i) {
            motion.point[i] = frozen_points_[i];
            motion.velocity_m[i] = Vec2::Zero();
        }
        double angle = frozen_angle_rad_;
        for (std::size_t i = first_free_hinge_; i < chain_.link_count; ++i) {
            angle += angle_at(i, at);
            const Vec2 link = chain_.length_m[i] * direction(angle);
            motion.point[i + 1] = motion.point[i] + link;
            motion.velocity_m[i + 1] =
                motion.velocity_m[i] + turn_rad_[i] * Vec2(-link.y(), link.x());
        }
        return motion;
    }

    // Upper bound on the acceleration of point `point`, metres per full closing squared.
    double acceleration_m(std::size_t point) const { return acceleration_m_[point]; }

    // Freezes the hinges up to and including `last` at their angles at time `at`.
    void freeze(std::size_t last, double at) {
        for (std::size_t i = first_free_hinge_; i <= last; ++i) {
            angle_rad_[i] = angle_at(i, at);
        }
        first_free_hinge_ = last + 1;
        cache_frozen_links();
    }

    std::size_t first_free_hinge() const { return first_free_hinge_; }
    const std::array<double, k_max_disc_links>& angle_rad() const { return angle_rad_; }

  private:
    static Vec2 direction(double angle) {
        double sine = 0.0;
        double cosine = 1.0;
        sin_cos(angle, sine, cosine);
        return {cosine, sine};
    }

    // Computes everything that stays constant until the next hinge is frozen.
    void cache_frozen_links() {
        frozen_angle_rad_ = 0.0;
        frozen_points_[0] = Vec2::Zero();
        for (std::size_t i = 0; i < first_free_hinge_; ++i) {
            frozen_angle_rad_ += angle_rad_[i];
            frozen_points_[i + 1] =
                frozen_points_[i] + chain_.length_m[i] * direction(frozen_angle_rad_);
        }
        acceleration_m_.fill(0.0);
        double turn_rad = 0.0;
        for (std::size_t i = first_free_hinge_; i < chain_.link_count; ++i) {
            turn_rad += chain_.closed_rad[i] - chain_.open_rad[i];
            turn_rad_[i] = turn_rad;
            acceleration_m_[i + 1] = acceleration_m_[i] + turn_rad * turn_rad * chain_.length_m[i];
        }
    }

    const DiscChain& chain_;
    std::array<double, k_max_disc_links> angle_rad_ = {};
    std::size_t first_free_hinge_ = 0;
    double frozen_angle_rad_ = 0.0;  // absolute angle of the last frozen link
    std::array<Vec2, k_max_disc_links + 1> frozen_points_;
    std::array<double, k_max_disc_links> turn_rad_ = {};  // turn of each link over a full closing
    std::array<double, k_max_disc_links + 1> acceleration_m_ = {};
};

}  // namespace handhold
