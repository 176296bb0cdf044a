#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "components/hand.hpp"
#include "components/hand_surroundings.hpp"
#include "engine/geometry/surface_graph.hpp"

// A hand as spheres along its capsules, and their gaps to the surfaces around it.
namespace handhold {

// A wrist and all digits. `wrist_bs` is in the frame of HandSurroundings::meshes.
struct HandPose {
    Pose wrist_bs;
    std::array<FingerAngles, k_finger_count> fingers;  // indexed like HandRig::fingers
};

// Frames of all links in the frame in which the wrist is given: hinge at the origin, -Z along the
// link.
using HandLinkFrames = std::array<std::array<Pose, k_max_links>, k_finger_count>;
HandLinkFrames link_frames(const HandRig& rig, const HandPose& pose);

struct HandSphere {
    static constexpr std::int32_t k_palm = -1;
    std::int32_t finger = k_palm;  // index into HandRig::fingers
    std::size_t link = 0;          // link of that finger, or index into HandRig::palm
    double radius_m = 0.0;
    Vec3 center_ls = Vec3::Zero();  // centre in the link's frame, or in hand space for the palm
    // An extra sphere where the capsule's axis is nearest to the surface. Without it, an edge could
    // penetrate between two spheres.
    bool is_extra = false;
    bool is_tip = false;  // the end of a digit's last link

    // Written by HandSpheres::query.
    Vec3 center = Vec3::Zero();
    Vec3 away = Vec3::Zero();  // unit, from the nearest surface point to the centre, out of solids
    double gap_m = 0.0;        // negative: penetration depth
    bool has_gap = false;      // a surface is within reach of the sphere
    // Result of the last search: the centre, its gap (infinity: none), its signed distance to the
    // gripped mesh (at most the query radius), and the nearest triangle there.
    Vec3 searched_center = Vec3::Zero();
    double searched_gap_m = 0.0;
    double signed_m = 0.0;
    std::uint32_t triangle = k_no_triangle;
};

// True for the sphere at the base of a digit.
bool is_knuckle(const HandSphere& sphere);

inline constexpr double k_keep_travel_m = 1.2e-3;  // travel of a centre whose gap is kept
// Gaps up to this are found. Thin spheres find slightly larger gaps too, because every query
// reaches a minimum distance from the centre. A digit's tip can be far from a surface that its base
// touches.
inline constexpr double k_sphere_reach_m = 0.02;
inline constexpr double k_tip_reach_m = 0.06;

class HandSpheres {
  public:
    static constexpr int k_max_pieces = 4;  // maximum per link
    // A link has a sphere at the end of each piece and an extra one, a digit one more at its base.
    static constexpr std::size_t k_max_count =
        k_finger_count * (k_max_links * (std::size_t{k_max_pieces} + 1) + 1) +
        4 * k_max_palm_capsules;

    // `is_clear`: by finger, the first queried pose is known to be outside every solid, whatever
    // the meshes' windings say. Keeps a reference to `hand`. Preconditions: `surface` is on the
    // hand's first mesh; the rig has at most k_max_palm_capsules.
    HandSpheres(const HandSurroundings& hand, const GripSurface& surface,
                const std::array<bool, k_finger_count>& is_clear);

    // Computes all gaps at a pose. A sphere is not searched again if it has moved less than
    // k_keep_travel_m since its last search, or if it is surely neither close to a surface nor the
    // nearest of its digit (tips excepted). Its last gap is then corrected by its movement along
    // `away`.
    //
    // A centre is inside a solid if it is far enough below the plane of its nearest triangle. On
    // the gripped mesh this counts at the first call only. Later a centre changes sides only if its
    // path since its last search crosses a surface of that mesh: windings of open or broken meshes
    // cannot flip a finger through a wall.
    void query(const HandPose& pose, const HandLinkFrames& frames);
    // The same for one digit's spheres; the others keep their gaps. Precondition: query was called.
    void query_digit(std::size_t finger, const HandPose& pose, const HandLinkFrames& frames);

    std::span<const HandSphere> all() const { return {spheres_.data(), count_}; }
    std::span<const HandSphere> of_digit(std::size_t finger) const {
        return all().subspan(first_[finger], first_[finger + 1] - first_[finger]);
    }
    // The sphere of a digit with the smallest gap, knuckles left out; null: none in reach.
    const HandSphere* nearest(std::size_t finger) const;
    // The same of the palm.
    const HandSphere* nearest_of_palm() const;
    double penetration_m() const;  // depth of the deepest sphere, >= 0
    // Smallest gap of a digit, knuckles included; infinity: no surface in reach.
    double gap_m(std::size_t finger) const;

  private:
    void add(const HandSphere& sphere) { spheres_[count_++] = sphere; }
    // `spheres`: all, or those of one digit.
    void query(std::span<HandSphere> spheres, const HandPose& pose, const HandLinkFrames& frames);
    // For each digit, and last for the palm: spheres whose gap is surely larger than this keep
    // their last gap. They are not the nearest of their digit and need no extra sphere.
    std::array<double, k_finger_count + 1> keep_gaps_m(std::span<const HandSphere> spheres) const;
    // `near_sphere`: a sphere nearby, whose triangle bounds the search.
    void query_sphere(HandSphere& sphere, const HandSphere* near_sphere, bool is_first);
    static bool keeps_gap(HandSphere& sphere);
    double bound_m(const Vec3& center_ms, double radius_m, const HandSphere& sphere) const;
    void query_extra(const HandSphere& nearest, HandSphere& extra, const HandPose& pose,
                     const HandLinkFrames& frames);
    double side_of_gripped(const HandSphere& sphere, bool is_below, bool is_first) const;

    const HandSurroundings& hand_;
    std::array<bool, k_finger_count> is_clear_;
    double winding_ = 1.0;  // -1: the gripped mesh's outside is against its winding
    bool is_queried_ = false;
    std::array<HandSphere, k_max_count> spheres_;
    std::size_t count_ = 0;
    std::array<std::size_t, k_finger_count + 1> first_ = {};  // first sphere of each digit, and end
};

}  // namespace handhold
