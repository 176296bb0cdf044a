// The dimensions are those of an adult's hand. For example, the middle finger's bones are 44, 27
// and 18 mm long, and the knuckles are 20 mm apart.
#include "systems/rigs/builtin_hand_rig.hpp"

#include <span>
#include <string>

#include "systems/rigs/hand_kinematics.hpp"
#include "systems/rigs/hand_limits.hpp"

namespace handhold {
namespace {

constexpr double k_mm = 1e-3;

using Links = std::array<double, k_max_links>;

Links scaled(const Links& values, double scale) {
    return {values[0] * scale, values[1] * scale, values[2] * scale};
}

// Dimensions of a finger of the right hand.
struct FingerFigures {
    FingerName name;
    const char* joints;          // prefix of the joints' names
    std::array<double, 3> base;  // mm
    double spread_deg;     // angle of the finger from straight ahead, positive towards the thumb
    Links length, radius;  // mm
};
constexpr std::array<FingerFigures, 4> k_fingers = {{{FingerName::index,
                                                      "index-finger",
                                                      {-29.5, 0.0, -88.0},
                                                      4.0,
                                                      {42.0, 25.0, 18.0},
                                                      {8.8, 8.0, 7.2}},
                                                     {FingerName::middle,
                                                      "middle-finger",
                                                      {-9.0, 2.0, -92.0},
                                                      0.5,
                                                      {44.0, 27.0, 18.5},
                                                      {9.0, 8.2, 7.4}},
                                                     {FingerName::ring,
                                                      "ring-finger",
                                                      {11.5, 1.0, -88.0},
                                                      -3.0,
                                                      {41.0, 25.0, 18.0},
                                                      {8.6, 7.8, 7.0}},
                                                     {FingerName::little,
                                                      "pinky-finger",
                                                      {30.5, -2.0, -80.0},
                                                      -7.0,
                                                      {33.0, 19.0, 16.5},
                                                      {7.6, 6.9, 6.2}}}};

constexpr std::array<double, 3> k_thumb_base = {-24.0, -6.0, -26.0};  // mm
constexpr Links k_thumb_length = {46.0, 34.0, 25.0};                  // mm
constexpr Links k_thumb_radius = {10.0, 9.2, 8.4};                    // mm
// Angle between the thumb's first link and the opposition axis at curl 0.
constexpr double k_thumb_away_deg = 52.0;

Vec3 from_mm(const std::array<double, 3>& mm) { return k_mm * Vec3(mm[0], mm[1], mm[2]); }

FingerRig make_finger(const FingerFigures& figures) {
    FingerRig finger;
    finger.name = figures.name;
    finger.base_hs = {from_mm(figures.base),
                      rotation_about(Vec3::UnitY(), figures.spread_deg * k_degree)};
    finger.length_m = scaled(figures.length, k_mm);
    finger.radius_m = scaled(figures.radius, k_mm);
    set_hand_limits(HandSide::right, finger);
    return finger;
}

FingerRig make_thumb() {
    FingerRig thumb;
    thumb.name = FingerName::thumb;
    thumb.length_m = scaled(k_thumb_length, k_mm);
    thumb.radius_m = scaled(k_thumb_radius, k_mm);
    set_hand_limits(HandSide::right, thumb);
    // The thumb's disc contains the opposition axis: a curl turns the links from one side of the
    // axis to the other.
    const Vec3 axis = -thumb.opposition_axis_hs;  // towards the fingers, on a right hand
    double away_sine = 0.0;
    double away_cosine = 1.0;
    sin_cos(k_thumb_away_deg * k_degree, away_sine, away_cosine);
    // Direction towards the thumb's side, perpendicular to the axis.
    const Vec3 beside = (-Vec3::UnitX() + axis * axis.x()).normalized();
    const Vec3 out = rotation_about(thumb.opposition_axis_hs, k_thumb_below_rad) * beside;
    Mat3 axes;
    axes.col(2) = -(away_cosine * axis + away_sine * out);  // +Z: back along the link
    // +Y: opposite to the direction in which the thumb curls
    axes.col(1) = away_cosine * out - away_sine * axis;
    axes.col(0) = axes.col(1).cross(axes.col(2));
    thumb.base_hs = {from_mm(k_thumb_base), Quat(axes).normalized()};
    return thumb;
}

// The undersides of all capsules are 14 mm below the wrist, like the palm's centre, so that a flat
// hand lies flat on a wall.
std::vector<PalmCapsule> make_palm() {
    const auto capsule = [](const std::array<double, 3>& a, const std::array<double, 3>& b,
                            double radius_mm) {
        return PalmCapsule{from_mm(a), from_mm(b), k_mm * radius_mm};
    };
    return {capsule({-27.0, -4.0, -80.0}, {27.0, -4.0, -80.0}, 10.0),   // knuckles
            capsule({-13.0, -1.5, -18.0}, {-28.0, -2.0, -78.0}, 11.0),  // metacarpals
            capsule({-4.0, -1.0, -16.0}, {-9.0, -0.5, -82.0}, 11.5),
            capsule({5.0, -1.5, -16.0}, {11.0, -1.0, -78.0}, 11.5),
            capsule({13.0, -2.5, -18.0}, {28.5, -3.5, -70.0}, 10.5),
            capsule({-13.0, -3.0, -12.0}, {14.0, -3.0, -12.0}, 11.5),  // heel
            // Edge of the hand below the little finger.
            capsule({21.0, -4.0, -26.0}, {25.0, -4.0, -56.0}, 10.5),
            capsule({-20.0, -4.5, -28.0}, {-24.0, -4.0, -52.0}, 11.0)};  // ball of the thumb
}

// A joint's frame is its hinge's frame; the tip joint is at the end of the last link.
void add_finger_joints(const std::string& prefix, std::span<const char* const> names,
                       std::int32_t place, HandRig& rig) {
    const FingerRig& finger = rig.fingers[static_cast<std::size_t>(place)];
    for (std::uint32_t link = 0; link < finger.link_count; ++link) {
        rig.joints.push_back({prefix + names[link], place, link, {}});
    }
    const std::uint32_t last = finger.link_count - 1;
    rig.joints.push_back(
        {prefix + "-tip", place, last, {Vec3(0.0, 0.0, -finger.length_m[last]), Quat::Identity()}});
}

void add_joints(HandRig& rig) {
    constexpr std::array k_thumb_joints = {"-metacarpal", "-phalanx-proximal", "-phalanx-distal"};
    constexpr std::array k_finger_joints = {"-phalanx-proximal", "-phalanx-intermediate",
                                            "-phalanx-distal"};
    rig.joints.push_back({"wrist", RigJoint::k_palm, 0, {}});
    add_finger_joints("thumb", k_thumb_joints, 0, rig);
    for (std::size_t i = 0; i < k_fingers.size(); ++i) {
        const std::string prefix = k_fingers[i].joints;
        const Vec3 knuckle = rig.fingers[i + 1].base_hs.position;
        const Vec3 root(0.45 * knuckle.x(), 0.0, -0.022);
        rig.joints.push_back(
            {prefix + "-metacarpal",
             RigJoint::k_palm,
             0,
             {root, rotation_between(-Vec3::UnitZ(), (knuckle - root).normalized())}});
        add_finger_joints(prefix, k_finger_joints, static_cast<std::int32_t>(i) + 1, rig);
    }
}

}  // namespace

HandRig builtin_hand_rig(HandSide side) {
    HandRig rig;
    rig.side = HandSide::right;
    rig.fingers.push_back(make_thumb());
    for (const FingerFigures& figures : k_fingers) {
        rig.fingers.push_back(make_finger(figures));
    }
    rig.palm = make_palm();
    rig.palm_center_hs = Vec3(0.0, -0.014, -0.080);
    rig.palm_normal_hs = -Vec3::UnitY();
    add_joints(rig);
    return side == HandSide::right ? rig : mirror_hand_rig(rig);
}

}  // namespace handhold
