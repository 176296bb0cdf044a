#include "engine/anim/pose_path.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/check.hpp"

namespace handhold {
namespace {

// Position and quaternion as one array, because the spline treats all seven components alike.
using PoseArray = std::array<double, 7>;

PoseArray to_array(const Pose& pose) {
    const Quat& q = pose.rotation;
    return {pose.position.x(), pose.position.y(), pose.position.z(), q.x(), q.y(), q.z(), q.w()};
}

// Index of a neighbouring key, wrapping around. A path with a full turn ends at the negated
// quaternion.
struct Neighbour {
    std::size_t index = 0;
    double sign = 1.0;  // factor for the quaternion
};

double sign_of(std::size_t number, const Neighbour& neighbour) {
    return number < 3 ? 1.0 : neighbour.sign;
}

class PeriodicSpline {
  public:
    PeriodicSpline(std::span<const Pose> poses, double step_s) : step_s_(step_s) {
        count_ = poses.size();
        Quat before = poses[0].rotation.normalized();
        for (std::size_t i = 0; i < count_; ++i) {
            Pose pose{poses[i].position, poses[i].rotation.normalized()};
            const double cosine = before.dot(pose.rotation);
            check_turn(cosine, i);
            if (cosine < 0.0) {
                pose.rotation.coeffs() = -pose.rotation.coeffs();
            }
            before = pose.rotation;
            points_[i] = to_array(pose);
        }
        const Quat first = poses[0].rotation.normalized();
        check_turn(before.dot(first), 0);
        closing_sign_ = before.dot(first) < 0.0 ? -1.0 : 1.0;
    }

    // Continuous second derivatives require m[i-1] + 4 m[i] + m[i+1] = 3 (p[i+1] - p[i-1]) / h for
    // the rates m at the points p, h seconds apart. The system is diagonally dominant: each
    // Gauss-Seidel sweep at least halves the error, so 64 sweeps reach full precision.
    void solve_rates() {
        for (int sweep = 0; sweep < 64; ++sweep) {
            for (std::size_t i = 0; i < count_; ++i) {
                const Neighbour before = previous(i);
                const Neighbour after = next(i);
                for (std::size_t n = 0; n < rates_[i].size(); ++n) {
                    const double rise = sign_of(n, after) * points_[after.index][n] -
                                        sign_of(n, before) * points_[before.index][n];
                    const double others = sign_of(n, after) * rates_[after.index][n] +
                                          sign_of(n, before) * rates_[before.index][n];
                    rates_[i][n] = 0.25 * (3.0 * rise / step_s_ - others);
                }
            }
        }
    }

    PathKey key(std::size_t i) const {
        const PoseArray& p = points_[i];
        const PoseArray& m = rates_[i];
        return {{Vec3(p[0], p[1], p[2]), Quat(p[6], p[3], p[4], p[5])},
                Vec3(m[0], m[1], m[2]),
                {m[3], m[4], m[5], m[6]}};
    }

  private:
    static void check_turn(double cosine, std::size_t key) {
        // `cosine`: of half the angle between the rotations.
        double sine = 0.0;
        double min_cosine = 1.0;
        sin_cos(0.5 * k_max_path_turn_rad, sine, min_cosine);
        HH_CHECK(std::abs(cosine) >= min_cosine, "a path turns too far between two poses", key);
    }
    Neighbour previous(std::size_t i) const {
        return i > 0 ? Neighbour{i - 1, 1.0} : Neighbour{count_ - 1, closing_sign_};
    }
    Neighbour next(std::size_t i) const {
        return i + 1 < count_ ? Neighbour{i + 1, 1.0} : Neighbour{0, closing_sign_};
    }

    double step_s_;
    std::size_t count_ = 0;
    double closing_sign_ = 1.0;
    std::array<PoseArray, k_max_path_keys> points_ = {};
    std::array<PoseArray, k_max_path_keys> rates_ = {};
};

using Vec4 = Eigen::Vector4d;

Vec4 rate_of(const PathKey& key) {
    return {key.quaternion_rate[0], key.quaternion_rate[1], key.quaternion_rate[2],
            key.quaternion_rate[3]};
}

// Cubic Hermite segment from value a with rate ra to value b with rate rb. It takes step_s; s is
// the fraction of it.
template <typename Vector>
struct Cubic {
    Vector value;
    Vector rate;
};
template <typename Vector>
Cubic<Vector> cubic(const Vector& a, const Vector& ra, const Vector& b, const Vector& rb,
                    double step_s, double s) {
    const double s2 = s * s;
    const double s3 = s2 * s;
    const Vector value = (2.0 * s3 - 3.0 * s2 + 1.0) * a + (step_s * (s3 - 2.0 * s2 + s)) * ra +
                         (3.0 * s2 - 2.0 * s3) * b + (step_s * (s3 - s2)) * rb;
    const Vector rate = (6.0 * (s2 - s) / step_s) * (a - b) + (3.0 * s2 - 4.0 * s + 1.0) * ra +
                        (3.0 * s2 - 2.0 * s) * rb;
    return {value, rate};
}

}  // namespace

PosePath make_pose_path(std::span<const Pose> poses, double period_s) {
    HH_CHECK(poses.size() >= 2 && poses.size() <= k_max_path_keys, "a path has 2 to 16 poses",
             poses.size());
    HH_CHECK(period_s > 0.0 && std::isfinite(period_s), "the period must be above 0", period_s);
    for (const Pose& pose : poses) {
        HH_CHECK(is_valid(pose), "the pose is not valid", pose.rotation.norm());
    }
    PeriodicSpline spline(poses, period_s / static_cast<double>(poses.size()));
    spline.solve_rates();
    PosePath path;
    path.count = static_cast<std::uint32_t>(poses.size());
    path.period_s = period_s;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        path.keys[i] = spline.key(i);
    }
    return path;
}

PosePathState evaluate(const PosePath& path, double t_s) {
    HH_CHECK(path.count >= 2 && path.count <= k_max_path_keys, "not a path", path.count);
    const double step_s = path.period_s / path.count;
    const double laps = t_s / path.period_s;
    const double steps = (laps - std::floor(laps)) * path.count;
    const std::uint32_t index = std::min(static_cast<std::uint32_t>(steps), path.count - 1);
    const PathKey& a = path.keys[index];
    const PathKey& b = path.keys[index + 1 < path.count ? index + 1 : 0];
    const double sign = a.pose.rotation.dot(b.pose.rotation) < 0.0 ? -1.0 : 1.0;
    const double s = steps - index;
    const Cubic<Vec3> place =
        cubic<Vec3>(a.pose.position, a.velocity_mps, b.pose.position, b.velocity_mps, step_s, s);
    const Vec4 to = sign * b.pose.rotation.coeffs();
    const Cubic<Vec4> turn =
        cubic<Vec4>(a.pose.rotation.coeffs(), rate_of(a), to, sign * rate_of(b), step_s, s);
    // q = c / |c| with the cubic c. So q' is c' / |c| without its part along q, and the angular
    // velocity is 2 q' q*.
    const double length = turn.value.norm();
    const Vec4 unit = turn.value / length;
    const Vec4 rate = (turn.rate - unit * unit.dot(turn.rate)) / length;
    const Quat rotation(unit[3], unit[0], unit[1], unit[2]);
    const Quat rotation_rate(rate[3], rate[0], rate[1], rate[2]);
    const Quat spin = rotation_rate * rotation.conjugate();
    return {{place.value, rotation}, place.rate, 2.0 * spin.vec()};
}

}  // namespace handhold
