// The palm of the robot's hand: a body between knuckles and wrist, a ridge over each metacarpal,
// pads below, a socket for the thumb; and the cuff behind the wrist. Built in hand space rotated
// half a turn about Y: fingers along +Z, a right hand's thumb at +X.
#include <algorithm>

#include "game/mesh/primitives.hpp"
#include "game/render/robot_hand.hpp"

namespace handhold {
namespace {

using enum FigureMaterial;

Vec3 turned(const Vec3& in_hand) { return {-in_hand.x(), in_hand.y(), -in_hand.z()}; }

// The palm's dimensions, in the rotated frame.
struct PalmFigures {
    std::vector<Vec3> knuckles;
    std::vector<double> radii;
    double low_x = -0.03, high_x = 0.03;  // outer sides of the first and last knuckle
    double end_z = 0.08;                  // end of the body, in front of the knuckles' drums
    double below = -0.014;                // y of the palm's surface
    double above = 0.011;                 // y of the back's surface
};

PalmFigures measure(const HandRig& rig) {
    PalmFigures palm;
    palm.below = rig.palm_center_hs.y();
    double high = 0.0;
    double end = 1.0;
    bool is_first = true;
    for (const FingerRig& finger : rig.fingers) {
        if (finger.name == FingerName::thumb) {
            continue;
        }
        const Vec3 at = turned(finger.base_hs.position);
        const double r = finger.radius_m[0];
        palm.knuckles.push_back(at);
        palm.radii.push_back(r);
        palm.low_x = is_first ? at.x() - r : std::min(palm.low_x, at.x() - r);
        palm.high_x = is_first ? at.x() + r : std::max(palm.high_x, at.x() + r);
        end = std::min(end, at.z() - 0.55 * r);
        high = std::max(high, at.y() + r);
        is_first = false;
    }
    palm.end_z = is_first ? palm.end_z : end;
    palm.above = is_first ? palm.above : std::max(high - 0.001, palm.below + 0.016);
    return palm;
}

void add_body(FigureKit& kit, const PalmFigures& palm) {
    const double x = 0.5 * (palm.low_x + palm.high_x);
    const double half = 0.5 * (palm.high_x - palm.low_x);
    const double y = 0.5 * (palm.above + palm.below) + 0.001;
    const double thick = 0.5 * (palm.above - palm.below) - 0.001;
    const double end = palm.end_z;
    const std::array<LoftSection, 8> sections = {
        {{0.008, 0.50 * half, 0.86 * thick, 0.60 * thick, 0.4 * x, y},
         {0.013, 0.62 * half, 1.00 * thick, 0.75 * thick, 0.5 * x, y},
         {0.30 * end, 0.80 * half, 1.02 * thick, 0.80 * thick, 0.8 * x, y},
         {0.55 * end, 0.93 * half, 0.98 * thick, 0.76 * thick, x, y},
         {0.80 * end, 0.98 * half, 0.90 * thick, 0.68 * thick, x, y - 0.0005},
         {0.94 * end, 0.98 * half, 0.84 * thick, 0.60 * thick, x, y - 0.0010},
         {0.985 * end, 0.95 * half, 0.74 * thick, 0.52 * thick, x, y - 0.0010},
         {end, 0.90 * half, 0.60 * thick, 0.42 * thick, x, y - 0.0010}}};
    kit.add(shell, loft_sections(sections));
}

// A plate over each metacarpal that ends in a fork around the knuckle's drum.
void add_ridge(FigureKit& kit, const Vec3& knuckle, double r, const PalmFigures& palm) {
    // The plate runs along the body's back, then down to the drum if the knuckle lies lower.
    const double back = palm.above - 0.0012;
    const Vec3 root(0.52 * knuckle.x(), back, 0.30 * palm.end_z);
    const Vec3 end(knuckle.x(), std::min(back, knuckle.y() + 0.80 * r), knuckle.z() - 0.72 * r);
    const double length = (end - root).norm();
    const double wide = 0.80 * r;
    const std::array<LoftSection, 5> sections = {
        {{0.0, 0.45 * wide, 0.0022, 0.0016, 0.0, 0.0},
         {0.003, 0.60 * wide, 0.0034, 0.0026, 0.0, 0.0},
         {0.6 * length, 0.92 * wide, 0.0036, 0.0028, 0.0, 0.0},
         {length - 0.0015, wide, 0.0032, 0.0026, 0.0, 0.0},
         {length, 0.88 * wide, 0.0022, 0.0018, 0.0, 0.0}}};
    const Quat turn = rotation_between(Vec3::UnitZ(), (end - root) / length);
    kit.add(shell, loft_sections(sections), {root, turn});
    kit.add(joint, make_cylinder(Vec3(knuckle.x() - 0.70 * r, knuckle.y(), end.z() - 0.0015),
                                 Vec3(knuckle.x() + 0.70 * r, knuckle.y(), end.z() - 0.0015),
                                 0.62 * r, 16));
    kit.add(metal,
            make_capsule(Vec3(knuckle.x(), knuckle.y(), end.z() - 0.006), knuckle, 0.45 * r, 12));
}

void add_back(FigureKit& kit, const PalmFigures& palm) {
    const double x = 0.3 * (palm.low_x + palm.high_x);
    const double end = palm.end_z;
    const std::array<LoftSection, 5> plate = {
        {{0.17 * end, 0.0125, 0.0026, 0.0020, x, palm.above - 0.0002},
         {0.20 * end, 0.0150, 0.0042, 0.0030, x, palm.above - 0.0002},
         {0.40 * end, 0.0165, 0.0044, 0.0032, x, palm.above - 0.0004},
         {0.50 * end, 0.0140, 0.0040, 0.0030, x, palm.above - 0.0006},
         {0.53 * end, 0.0115, 0.0026, 0.0020, x, palm.above - 0.0008}}};
    kit.add(accent, loft_sections(plate));
    const std::array<LoftSection, 4> inlay = {
        {{0.26 * end, 0.0070, 0.0020, 0.0015, x, palm.above + 0.0030},
         {0.28 * end, 0.0085, 0.0030, 0.0020, x, palm.above + 0.0026},
         {0.42 * end, 0.0085, 0.0030, 0.0020, x, palm.above + 0.0024},
         {0.44 * end, 0.0070, 0.0020, 0.0015, x, palm.above + 0.0024}}};
    kit.add(joint, loft_sections(inlay));
}

// Rubber pads in the palm: below the knuckles, at the heel, and on both sides in between.
void add_pads(FigureKit& kit, const PalmFigures& palm) {
    const double x = 0.5 * (palm.low_x + palm.high_x);
    const double half = 0.5 * (palm.high_x - palm.low_x);
    const double end = palm.end_z;
    const auto pad = [&](double from, double to, double center_x, double half_x) {
        const double y = palm.below + 0.0030;
        const std::array<LoftSection, 4> sections = {
            {{from, 0.84 * half_x, 0.0018, 0.0014, center_x, y},
             {from + 0.003, half_x, 0.0030, 0.0024, center_x, y},
             {to - 0.003, half_x, 0.0030, 0.0024, center_x, y},
             {to, 0.84 * half_x, 0.0018, 0.0014, center_x, y}}};
        kit.add(joint, loft_sections(sections));
    };
    pad(0.72 * end, 0.97 * end, x, 0.92 * half);
    pad(0.14 * end, 0.36 * end, 0.5 * x - 0.12 * half, 0.48 * half);
    pad(0.40 * end, 0.69 * end, palm.low_x + 0.62 * half, 0.50 * half);
    pad(0.40 * end, 0.69 * end, palm.high_x - 0.45 * half, 0.34 * half);
}

void add_thumb_socket(FigureKit& kit, const FingerRig& thumb, const PalmFigures& palm) {
    const Vec3 base = turned(thumb.base_hs.position);
    const double r = thumb.radius_m[0];
    kit.add(joint, make_sphere(1.06 * r, 20), {base, Quat::Identity()});
    const Vec3 inner(0.35 * base.x(), 0.5 * (palm.above + palm.below), base.z() + 0.004);
    const Vec3 axis = (base - inner).normalized();
    kit.add(shell, make_torus(1.00 * r, 0.26 * r, 28, 10),
            {base - 0.42 * r * axis, rotation_between(Vec3::UnitZ(), axis)});
    kit.add(shell, make_capsule(inner, base - 0.45 * r * axis, 0.96 * r, 18));
}

}  // namespace

FigureKit build_robot_cuff() {
    FigureKit kit;
    const std::array<ProfilePoint, 7> cuff = {{{0.0245, -0.036},
                                               {0.0285, -0.033},
                                               {0.0295, -0.018},
                                               {0.0285, -0.010},
                                               {0.0260, -0.006},
                                               {0.0215, -0.005},
                                               {0.0190, -0.006}}};
    kit.add(shell, make_revolved(cuff, 28), {Vec3(0.0, -0.001, 0.0), Quat::Identity()});
    kit.add(accent, make_torus(0.0291, 0.0019, 32, 8),
            {Vec3(0.0, -0.001, -0.024), Quat::Identity()});
    return kit.placed(figure_forward());
}

FigureKit build_robot_palm(const HandRig& right_rig) {
    FigureKit kit;
    const PalmFigures palm = measure(right_rig);
    add_body(kit, palm);
    for (std::size_t i = 0; i < palm.knuckles.size(); ++i) {
        add_ridge(kit, palm.knuckles[i], palm.radii[i], palm);
    }
    add_back(kit, palm);
    add_pads(kit, palm);
    for (const FingerRig& finger : right_rig.fingers) {
        if (finger.name == FingerName::thumb) {
            add_thumb_socket(kit, finger, palm);
        }
    }
    kit.add(joint, make_sphere(0.0195, 20), {Vec3(0.0, -0.001, 0.003), Quat::Identity()});
    return kit.placed(figure_forward());
}

}  // namespace handhold
