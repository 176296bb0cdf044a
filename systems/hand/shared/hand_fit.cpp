#include "systems/hand/shared/hand_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "engine/collision/closest_point.hpp"
#include "engine/math/penalty_quadratic.hpp"
#include "systems/rigs/hand_kinematics.hpp"

namespace handhold {
namespace {

constexpr double k_lever_m = 0.05;
constexpr std::size_t k_max_spheres = 128;
constexpr std::size_t k_max_rows = 320;
constexpr double k_margin_m = 0.02;
constexpr double k_inside_m = 0.03;

// Where a hand's parameters lie among the unknowns.
struct Layout {
    std::array<int, k_finger_count> first = {};
    std::array<int, k_finger_count> opposition = {};  // -1: none
    std::size_t count = 6;
    explicit Layout(const HandRig& rig) {
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            const FingerRig& finger = rig.fingers[f];
            first[f] = static_cast<int>(count);
            count += finger.link_count;
            opposition[f] = -1;
            if (finger.upper_opposition_rad > finger.lower_opposition_rad) {
                opposition[f] = static_cast<int>(count++);
            }
        }
    }
};

struct FitSphere {
    int finger = -1;
    std::size_t link = 0;
    double along_m = 0.0;           // on the link
    Vec3 center_hs = Vec3::Zero();  // palm only
    double radius_m = 0.0;
    bool is_refined = false;
    // Query state.
    Vec3 center = Vec3::Zero();
    Vec3 away = Vec3::Zero();
    double gap_m = 1.0;
    double distance_m = 0.0;  // signed
    bool has_gap = false;
    bool is_known = false;
};

class Fitter {
  public:
    Fitter(const HandSurroundings& hand, const GripSurface& surface, const HandFitGoal& goal,
           const PalmTuning& palm, const FitTuning& tuning, const HandPose& first)
        : hand_(hand), rig_(*hand.rig), surface_(surface), goal_(goal), palm_(palm),
          tuning_(tuning), layout_(rig_), first_(first), pose_(first) {
        const PlacedMesh& placed = hand.meshes.front();
        const Vec3 wound = placed.pose.rotation * placed.mesh->search.normals[surface.triangle];
        side_ = wound.dot(surface.normal_bs) < 0.0 ? -1.0 : 1.0;
        add_spheres();
    }

    HandFit run() {
        place();
        query(true);
        HandFit best = {pose_, penetration_m(), merit()};
        for (int round = 0; round < tuning_.rounds; ++round) {
            step();
            place();
            query(false);
            const double now = merit();
            if (now < best.merit) {
                best = {pose_, penetration_m(), now};
            }
        }
        return best;
    }

  private:
    void add_spheres() {
        for (const PalmCapsule& capsule : rig_.palm) {
            for (int i = 0; i < 3; ++i) {
                FitSphere sphere;
                sphere.center_hs = capsule.a_hs + 0.5 * i * (capsule.b_hs - capsule.a_hs);
                sphere.radius_m = capsule.radius_m;
                spheres_[sphere_count_++] = sphere;
            }
            FitSphere refined;
            refined.link = static_cast<std::size_t>(&capsule - rig_.palm.data());
            refined.radius_m = capsule.radius_m;
            refined.is_refined = true;
            spheres_[sphere_count_++] = refined;
        }
        constexpr double k_spacing_m = 0.012;
        for (std::size_t f = 0; f < rig_.fingers.size(); ++f) {
            const FingerRig& finger = rig_.fingers[f];
            for (std::size_t link = 0; link < finger.link_count; ++link) {
                const double length_m = finger.length_m[link];
                const int pieces = std::clamp(static_cast<int>(length_m / k_spacing_m + 0.99), 1, 6);
                for (int i = link == 0 ? 0 : 1; i <= pieces && sphere_count_ + 1 < k_max_spheres;
                     ++i) {
                    FitSphere sphere;
                    sphere.finger = static_cast<int>(f);
                    sphere.link = link;
                    sphere.along_m = length_m * i / pieces;
                    sphere.radius_m = finger.radius_m[link];
                    spheres_[sphere_count_++] = sphere;
                }
                FitSphere sphere;
                sphere.finger = static_cast<int>(f);
                sphere.link = link;
                sphere.radius_m = finger.radius_m[link];
                sphere.is_refined = true;
                spheres_[sphere_count_++] = sphere;
            }
        }
    }

    void place() {
        center_ = transform_point(pose_.wrist_bs, rig_.palm_center_hs);
        for (std::size_t f = 0; f < rig_.fingers.size(); ++f) {
            const auto frames = finger_link_frames(rig_.fingers[f], pose_.fingers[f]);
            for (std::size_t link = 0; link < rig_.fingers[f].link_count; ++link) {
                frames_[f][link] = pose_.wrist_bs * frames[link];
            }
        }
    }

    Vec3 center_of(const FitSphere& sphere) const {
        if (sphere.finger < 0) {
            return transform_point(pose_.wrist_bs, sphere.center_hs);
        }
        return transform_point(frames_[static_cast<std::size_t>(sphere.finger)][sphere.link],
                               Vec3(0.0, 0.0, -sphere.along_m));
    }

    void query(bool is_first) {
        std::size_t nearest = 0;  // of the present link
        for (std::size_t i = 0; i < sphere_count_; ++i) {
            FitSphere& sphere = spheres_[i];
            if (sphere.is_refined) {
                refine(spheres_[nearest], sphere, is_first);
                nearest = i + 1;
                continue;
            }
            query_sphere(sphere, is_first);
            if (nearest < i && sphere.has_gap &&
                (!spheres_[nearest].has_gap || sphere.gap_m < spheres_[nearest].gap_m)) {
                nearest = i;
            }
        }
    }

    // Queries the link where its axis is nearest to the surface point of its nearest sphere.
    void refine(const FitSphere& nearest, FitSphere& sphere, bool is_first) {
        sphere.has_gap = false;
        sphere.is_known = false;
        constexpr double k_near_m = 0.004;
        if (!nearest.has_gap || nearest.gap_m > k_near_m || nearest.finger != sphere.finger) {
            return;
        }
        const Vec3 point = nearest.center - nearest.away * nearest.distance_m;
        if (sphere.finger < 0) {
            const PalmCapsule& capsule = rig_.palm[sphere.link];
            const Vec3 point_hs = inverse_transform_point(pose_.wrist_bs, point);
            sphere.center_hs = closest_on_segment(point_hs, capsule.a_hs, capsule.b_hs);
            sphere.center = nearest.center;
            sphere.distance_m = nearest.distance_m;
            sphere.is_known = true;
            query_sphere(sphere, false);
            return;
        }
        const auto f = static_cast<std::size_t>(sphere.finger);
        const double along_m = std::clamp(-inverse_transform_point(frames_[f][sphere.link], point).z(),
                                          0.0, rig_.fingers[f].length_m[sphere.link]);
        if (nearest.link == sphere.link && std::abs(along_m - nearest.along_m) < 0.001) {
            return;
        }
        sphere.along_m = along_m;
        sphere.center = nearest.center;
        sphere.distance_m = nearest.distance_m;
        sphere.is_known = true;
        query_sphere(sphere, false);
    }

    void query_sphere(FitSphere& sphere, bool is_first) {
        const Vec3 center = center_of(sphere);
        const Vec3 before = sphere.center;
        const double distance_before_m = sphere.distance_m;
        const bool was_known = sphere.is_known && !is_first;
        sphere.center = center;
        sphere.has_gap = false;
        sphere.is_known = true;
        double smallest_m = std::numeric_limits<double>::infinity();
        for (std::size_t m = 0; m < hand_.meshes.size(); ++m) {
            const PlacedMesh& placed = hand_.meshes[m];
            const double radius_m = std::max(sphere.radius_m + k_margin_m, k_inside_m);
            const Vec3 local = inverse_transform_point(placed.pose, center);
            const auto near = placed.mesh->contact_bvh.closest_point(local, radius_m);
            if (!near) {
                if (m == 0) {
                    sphere.distance_m = radius_m;
                }
                continue;
            }
            double sign = 1.0;
            Vec3 outward = placed.mesh->contact.normals[near->triangle];
            outward = placed.pose.rotation * Vec3((m == 0 ? side_ : 1.0) * outward);
            const Vec3 point = transform_point(placed.pose, near->point);
            const Vec3 offset = center - point;
            const bool is_below = outward.dot(offset) < -0.5 * near->distance_m;
            if (m == 0 && was_known) {
                sign = distance_before_m < 0.0 ? -1.0 : 1.0;
                const double moved_m = (center - before).norm();
                if (moved_m > 0.999 * std::abs(distance_before_m)) {
                    const auto hit = placed.mesh->contact_bvh.cast_ray(
                        inverse_transform_point(placed.pose, before), local);
                    sign = hit ? -sign : sign;
                }
            } else if (sphere.finger < 0 || !goal_.is_clear[static_cast<std::size_t>(sphere.finger)]) {
                sign = is_below ? -1.0 : 1.0;
            }
            const double signed_m = sign * near->distance_m;
            if (m == 0) {
                sphere.distance_m = signed_m;
            }
            const double gap_m = signed_m - sphere.radius_m;
            if (gap_m < smallest_m) {
                smallest_m = gap_m;
                sphere.gap_m = gap_m;
                sphere.has_gap = true;
                sphere.away = near->distance_m > 1e-9 ? Vec3(sign / near->distance_m * offset) : outward;
            }
        }
    }

    // Change of a point on a digit (or the palm) per unit of every unknown, projected on `along`.
    Unknowns slope_at(const Vec3& point, int finger, std::size_t link, const Vec3& along) const {
        Unknowns slope = Unknowns::Zero();
        slope.head<3>() = along;
        slope.segment<3>(3) = (point - center_).cross(along);
        if (finger < 0) {
            return slope;
        }
        const auto f = static_cast<std::size_t>(finger);
        for (std::size_t i = 0; i <= link; ++i) {
            const Pose& frame = frames_[f][i];
            const Vec3 axis = frame.rotation * -Vec3::UnitX();
            slope[layout_.first[f] + static_cast<int>(i)] =
                axis.cross(point - frame.position).dot(along);
        }
        if (layout_.opposition[f] >= 0) {
            const Vec3 axis = pose_.wrist_bs.rotation * rig_.fingers[f].opposition_axis_hs;
            slope[layout_.opposition[f]] =
                axis.cross(point - frames_[f][0].position).dot(along);
        }
        return slope;
    }

    void add_row(const Unknowns& slope, double value, double weight) {
        if (row_count_ < rows_.size()) {
            rows_[row_count_++] = {slope, value, weight};
        }
    }

    void add_square(double weight, double value, const Unknowns& slope) {
        for (int i = 0; i < static_cast<int>(layout_.count); ++i) {
            if (slope[i] != 0.0) {
                hessian_.row(i) += weight * slope[i] * slope.transpose();
            }
        }
        gradient_ += weight * value * slope;
        energy_ += 0.5 * weight * value * value;
    }

    Unknowns unit(int place, double value = 1.0) const {
        Unknowns slope = Unknowns::Zero();
        slope[place] = value;
        return slope;
    }

    double bend(std::size_t f) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < rig_.fingers[f].link_count; ++i) {
            sum += pose_.fingers[f].curl_rad[i];
        }
        return sum;
    }
    void bend_slope(std::size_t f, double sign, Unknowns& slope) const {
        for (std::size_t i = 0; i < rig_.fingers[f].link_count; ++i) {
            slope[layout_.first[f] + static_cast<int>(i)] = sign;
        }
    }

    void build() {
        row_count_ = 0;
        energy_ = 0.0;
        hessian_.setZero();
        gradient_.setZero();
        const Vec3 moved = center_ - transform_point(hand_.wrist_bs, rig_.palm_center_hs);
        const Vec3 turned = rotation_to_vector(
            (pose_.wrist_bs.rotation * hand_.wrist_bs.rotation.conjugate()).normalized());
        const double arm2 = tuning_.turn_arm_m * tuning_.turn_arm_m;
        for (int i = 0; i < 3; ++i) {
            hessian_(i, i) += 1.0;
            gradient_[i] += moved[i];
            hessian_(3 + i, 3 + i) += arm2;
            gradient_[3 + i] += arm2 * turned[i];
        }
        energy_ += 0.5 * moved.squaredNorm() + 0.5 * arm2 * turned.squaredNorm();
        for (std::size_t f = 0; f < rig_.fingers.size(); ++f) {
            build_finger(f);
        }
        build_neighbours();
        build_contacts();
        build_palm_limits();
        build_trust_region();
    }

    void build_trust_region() {
        constexpr double k_max_flex_rad = 0.4;
        const double weight = tuning_.limit * k_lever_m * k_lever_m;
        for (int i = 6; i < static_cast<int>(layout_.count); ++i) {
            add_row(unit(i), k_max_flex_rad, weight);
            add_row(unit(i, -1.0), k_max_flex_rad, weight);
        }
    }

    void build_finger(std::size_t f) {
        const FingerRig& finger = rig_.fingers[f];
        const FingerAngles& angles = pose_.fingers[f];
        const double lever2 = k_lever_m * k_lever_m;
        double beyond_m = 0.0;
        for (std::size_t i = finger.link_count; i-- > 0;) {
            beyond_m += finger.length_m[i];
            const int place = layout_.first[f] + static_cast<int>(i);
            const double angle = angles.curl_rad[i];
            const bool is_thumb = finger.name == FingerName::thumb;
            if (goal_.touches[f]) {
                const double close = is_thumb ? tuning_.thumb_close : tuning_.close;
                add_square(close * beyond_m * beyond_m, angle - finger.upper_rad[i], unit(place));
                add_square(tuning_.first * lever2, angle - first_.fingers[f].curl_rad[i],
                           unit(place));
            }
            const double rest = is_thumb && !goal_.touches[f] ? tuning_.alike_free : tuning_.rest;
            add_square(rest * lever2, angle - finger.rest_rad[i], unit(place));
            add_row(unit(place), angle - finger.lower_rad[i], tuning_.limit * lever2);
            add_row(unit(place, -1.0), finger.upper_rad[i] - angle, tuning_.limit * lever2);
        }
        if (finger.link_count == 3 && finger.name != FingerName::thumb) {
            Unknowns slope = unit(layout_.first[f] + 2);
            slope[layout_.first[f] + 1] = -2.0 / 3.0;
            add_square(tuning_.couple * lever2, angles.curl_rad[2] - 2.0 / 3.0 * angles.curl_rad[1],
                       slope);
        }
        if (finger.name != FingerName::thumb) {
            Unknowns slope = Unknowns::Zero();
            bend_slope(f, -1.0, slope);
            add_row(slope, tuning_.max_fold_rad - bend(f), tuning_.style * lever2);
        }
        if (const int place = layout_.opposition[f]; place >= 0) {
            add_square(tuning_.oppose * lever2,
                       angles.opposition_rad - first_.fingers[f].opposition_rad, unit(place));
            add_row(unit(place), angles.opposition_rad - finger.lower_opposition_rad,
                    tuning_.limit * lever2);
            add_row(unit(place, -1.0), finger.upper_opposition_rad - angles.opposition_rad,
                    tuning_.limit * lever2);
        }
    }

    // Fingers in the order of the rig; thumbs have no neighbour.
    void build_neighbours() {
        const double lever2 = k_lever_m * k_lever_m;
        int before = -1;
        for (std::size_t f = 0; f < rig_.fingers.size(); ++f) {
            if (rig_.fingers[f].name == FingerName::thumb) {
                continue;
            }
            if (before >= 0) {
                const auto b = static_cast<std::size_t>(before);
                const bool is_free = !goal_.touches[f] || !goal_.touches[b];
                const double weight = is_free ? tuning_.alike_free : tuning_.alike;
                const std::size_t links =
                    std::min(rig_.fingers[f].link_count, rig_.fingers[b].link_count);
                for (std::size_t i = 0; i < links; ++i) {
                    Unknowns slope = unit(layout_.first[f] + static_cast<int>(i));
                    slope[layout_.first[b] + static_cast<int>(i)] = -1.0;
                    add_square(weight * lever2,
                               pose_.fingers[f].curl_rad[i] - pose_.fingers[b].curl_rad[i], slope);
                }
                Unknowns slope = Unknowns::Zero();
                bend_slope(f, 1.0, slope);
                bend_slope(b, -1.0, slope);
                const double apart = bend(f) - bend(b);
                add_row(slope, tuning_.max_apart_rad + apart, tuning_.style * lever2);
                add_row(-slope, tuning_.max_apart_rad - apart, tuning_.style * lever2);
            }
            before = static_cast<int>(f);
        }
    }

    // The digit's nearest sphere that is not touching is drawn to the surface.
    void build_attraction() {
        for (std::size_t f = 0; f < rig_.fingers.size(); ++f) {
            const FitSphere* nearest = nullptr;
            for (std::size_t i = 0; i < sphere_count_; ++i) {
                const FitSphere& sphere = spheres_[i];
                if (sphere.finger == static_cast<int>(f) && sphere.has_gap &&
                    (sphere.link > 0 || sphere.along_m > 0.0) &&
                    (nearest == nullptr || sphere.gap_m < nearest->gap_m)) {
                    nearest = &sphere;
                }
            }
            if (nearest != nullptr && nearest->gap_m > 0.0) {
                add_square(tuning_.touch, nearest->gap_m,
                           slope_at(nearest->center, nearest->finger, nearest->link, nearest->away));
            }
        }
    }

    void build_contacts() {
        build_attraction();
        for (std::size_t i = 0; i < sphere_count_; ++i) {
            const FitSphere& sphere = spheres_[i];
            if (!sphere.has_gap) {
                continue;
            }
            const Unknowns slope =
                slope_at(sphere.center, sphere.finger, sphere.link, sphere.away);
            add_row(slope, sphere.gap_m - tuning_.clear_m, tuning_.contact);
            if (sphere.finger >= 0 && !sphere.is_refined) {
                const FingerRig& finger = rig_.fingers[static_cast<std::size_t>(sphere.finger)];
                const bool is_tip = finger.name == FingerName::thumb &&
                                    sphere.link + 1 == finger.link_count &&
                                    sphere.along_m == finger.length_m[sphere.link];
                if (is_tip && sphere.gap_m > 0.0) {
                    add_square(tuning_.tip, sphere.gap_m, slope);
                }
            }
        }
    }

    void build_palm_limits() {
        const Vec3& normal = surface_.normal_bs;
        const double height_m = (center_ - surface_.point_bs).dot(normal);
        Unknowns slope = Unknowns::Zero();
        slope.head<3>() = normal;
        add_row(slope, height_m - palm_.min_height_m, tuning_.height_weight);
        add_row(-slope, std::max(palm_.min_height_m, tuning_.max_height_m) - height_m,
                tuning_.height_weight);
        const Vec3 up = pose_.wrist_bs.rotation * -rig_.palm_normal_hs;
        const Vec3 across = up.cross(normal);
        if (across.norm() > 1e-9) {
            const double angle_rad = arc_tangent2(across.norm(), up.dot(normal));
            Unknowns turn = Unknowns::Zero();
            turn.segment<3>(3) = across.normalized();
            add_row(turn, tuning_.max_angle_rad - angle_rad,
                    tuning_.height_weight * tuning_.turn_arm_m * tuning_.turn_arm_m);
        }
    }

    double merit() {
        build();
        double sum = energy_;
        for (std::size_t i = 0; i < row_count_; ++i) {
            const double violation = std::min(0.0, rows_[i].value);
            sum += 0.5 * rows_[i].weight * violation * violation;
        }
        return sum;
    }

    double penetration_m() const {
        double depth_m = 0.0;
        for (std::size_t i = 0; i < sphere_count_; ++i) {
            depth_m = std::max(depth_m, spheres_[i].has_gap ? -spheres_[i].gap_m : 0.0);
        }
        return depth_m;
    }

    // Precondition: merit() was called at this pose.
    void step() {
        build();
        fix_unknowns();
        Unknowns change =
            minimise_penalised(hessian_, gradient_, {rows_.data(), row_count_}, layout_.count);
        constexpr double k_max_move_m = 0.02;
        constexpr double k_max_turn_rad = 0.3;
        constexpr double k_max_flex_rad = 0.4;
        double scale = 1.0;
        scale = std::min(scale, k_max_move_m / std::max(k_max_move_m, change.head<3>().norm()));
        scale = std::min(scale,
                         k_max_turn_rad / std::max(k_max_turn_rad, change.segment<3>(3).norm()));
        change *= scale;
        for (int i = 6; i < static_cast<int>(layout_.count); ++i) {
            change[i] = std::clamp(change[i], -k_max_flex_rad, k_max_flex_rad);
        }
        apply(change);
    }

    void fix_unknowns() {
        constexpr double k_fixed = 1e6;
        for (std::size_t f = 0; f < rig_.fingers.size(); ++f) {
            for (std::size_t i = 0; goal_.is_fixed[f] && i < rig_.fingers[f].link_count; ++i) {
                const int place = layout_.first[f] + static_cast<int>(i);
                hessian_(place, place) += k_fixed;
            }
        }
    }

    void apply(const Unknowns& change) {
        Pose& wrist = pose_.wrist_bs;
        const Vec3 center = center_ + change.head<3>();
        wrist.rotation =
            (rotation_from_vector(change.segment<3>(3)) * wrist.rotation).normalized();
        wrist.position = center - wrist.rotation * rig_.palm_center_hs;
        for (std::size_t f = 0; f < rig_.fingers.size(); ++f) {
            const FingerRig& finger = rig_.fingers[f];
            for (std::size_t i = 0; i < finger.link_count; ++i) {
                double& angle = pose_.fingers[f].curl_rad[i];
                angle = std::clamp(angle + change[layout_.first[f] + static_cast<int>(i)],
                                   finger.lower_rad[i], finger.upper_rad[i]);
            }
            if (const int place = layout_.opposition[f]; place >= 0) {
                double& angle = pose_.fingers[f].opposition_rad;
                angle = std::clamp(angle + change[place], finger.lower_opposition_rad,
                                   finger.upper_opposition_rad);
            }
        }
    }

    const HandSurroundings& hand_;
    const HandRig& rig_;
    const GripSurface& surface_;
    const HandFitGoal& goal_;
    const PalmTuning& palm_;
    const FitTuning& tuning_;
    Layout layout_;
    const HandPose& first_;
    HandPose pose_;
    double side_ = 1.0;
    Vec3 center_ = Vec3::Zero();
    std::array<std::array<Pose, k_max_links>, k_finger_count> frames_;
    std::array<FitSphere, k_max_spheres> spheres_;
    std::size_t sphere_count_ = 0;
    std::array<PenaltyRow, k_max_rows> rows_;
    std::size_t row_count_ = 0;
    UnknownsSquare hessian_ = UnknownsSquare::Zero();
    Unknowns gradient_ = Unknowns::Zero();
    double energy_ = 0.0;
};

}  // namespace

HandFit fit_hand(const HandSurroundings& hand, const GripSurface& surface, const HandPose& first,
                 const HandFitGoal& goal, const PalmTuning& palm, const FitTuning& tuning) {
    Fitter fitter(hand, surface, goal, palm, tuning, first);
    return fitter.run();
}

}  // namespace handhold
