// Measures a hand's thickness from its skin. Uses medians and percentiles, so that outliers (nails,
// cuffs, seams) have little effect.
#include <algorithm>
#include <cmath>

#include "systems/rigs/hand_kinematics.hpp"
#include "systems/rigs/hand_skeleton_fit.hpp"

namespace handhold {
namespace {

constexpr double k_min_radius_m = 0.003;
constexpr double k_max_radius_m = 0.03;
// Skin of the palm belongs to a capsule if it is within this distance of the capsule's axis, seen
// along Y.
constexpr double k_half_width_m = 0.011;
// Largest radius of a thumb's first link / radius of its second link.
constexpr double k_max_ball = 1.3;
// Distance of the palm's centre from the wrist / distance of the knuckles' mean from the wrist.
constexpr double k_palm_center_share = 0.88;

// Returns the percentile `share` (from 0 to 1) of the values; `fallback` if there are none.
// Reorders the values.
double percentile(std::vector<double>& values, double share, double fallback) {
    if (values.empty()) {
        return fallback;
    }
    const auto place =
        static_cast<std::size_t>(std::floor(share * static_cast<double>(values.size() - 1) + 0.5));
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(place);
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

double clamp_radius(double radius_m) {
    return std::clamp(radius_m, k_min_radius_m, k_max_radius_m);
}

struct SkinPart {
    std::int32_t finger = RigJoint::k_palm;
    std::uint32_t link = 0;
};

// Returns the link (or the palm) on which a vertex has the largest sum of weights.
SkinPart part_of(const SkinWeights& weights, const HandRig& rig) {
    SkinPart best;
    float most = -1.0F;
    for (std::size_t k = 0; k < weights.joint.size(); ++k) {
        const RigJoint& joint = rig.joints[weights.joint[k]];
        float sum = 0.0F;
        for (std::size_t other = 0; other < weights.joint.size(); ++other) {
            const RigJoint& beside = rig.joints[weights.joint[other]];
            if (beside.finger == joint.finger && beside.link == joint.link) {
                sum += weights.weight[other];
            }
        }
        if (sum > most) {
            most = sum;
            best = {joint.finger, joint.link};
        }
    }
    return best;
}

// Measures the links of a finger. A link's radius is the median distance of the skin from the
// middle part of the bone. The last link ends one radius before the end of the skin.
void fit_finger_skin(const std::vector<Vec3>& positions_hs, const std::vector<SkinPart>& parts,
                     std::int32_t place, const FingerAngles& bind, FingerRig& finger) {
    const std::array<Pose, k_max_links> frames = finger_link_frames(finger, bind);
    std::array<std::vector<double>, k_max_links> distances_m;
    std::vector<double> ends_m;  // positions of the skin along the last link
    for (std::size_t i = 0; i < positions_hs.size(); ++i) {
        if (parts[i].finger != place) {
            continue;
        }
        const std::uint32_t link = parts[i].link;
        const Vec3 in_link = inverse_transform_point(frames[link], positions_hs[i]);
        const double along = -in_link.z() / finger.length_m[link];
        if (along > 0.1 && along < 0.9) {
            distances_m[link].push_back(
                std::sqrt(in_link.x() * in_link.x() + in_link.y() * in_link.y()));
        }
        if (link + 1 == finger.link_count) {
            ends_m.push_back(-in_link.z());
        }
    }
    double before_m = 0.1 * finger.length_m[0];
    for (std::size_t link = 0; link < finger.link_count; ++link) {
        finger.radius_m[link] = clamp_radius(percentile(distances_m[link], 0.5, before_m));
        before_m = finger.radius_m[link];
    }
    // A thumb's first link lies in the ball of the thumb, which is not round.
    if (finger.name == FingerName::thumb) {
        finger.radius_m[0] = std::min(finger.radius_m[0], k_max_ball * finger.radius_m[1]);
    }
    const std::size_t last = finger.link_count - 1;
    const double end_m = percentile(ends_m, 0.99, finger.length_m[last] + finger.radius_m[last]);
    finger.length_m[last] = std::max(end_m - finger.radius_m[last], 0.25 * finger.length_m[last]);
}

// Vertices of the palm's front and of its back.
struct PalmSkin {
    std::vector<Vec3> palmar, dorsal;  // hand space; normals towards -Y and +Y
};

PalmSkin collect_palm(const SkinnedMesh& skin, const std::vector<Vec3>& positions_hs,
                      const std::vector<SkinPart>& parts, const HandRigFit& fit) {
    constexpr double k_facing = 0.4;
    PalmSkin palm;
    for (std::size_t i = 0; i < positions_hs.size(); ++i) {
        // Skips the ball of the thumb, whose skin follows the thumb, so that a flat hand lies flat
        // on a surface.
        if (parts[i].finger != RigJoint::k_palm) {
            continue;
        }
        const double up = (fit.hand_ms.rotation.conjugate() * skin.normals[i]).y();
        if (up < -k_facing) {
            palm.palmar.push_back(positions_hs[i]);
        } else if (up > k_facing) {
            palm.dorsal.push_back(positions_hs[i]);
        }
    }
    return palm;
}

// Returns the median height (Y) of the skin near the line from a to b, seen along Y. Only skin
// between the shares `from` and `to` of the line's length counts.
double height_along(const std::vector<Vec3>& skin, const Vec3& a, const Vec3& b, double from,
                    double to, double fallback) {
    const Vec3 line(b.x() - a.x(), 0.0, b.z() - a.z());
    std::vector<double> heights;
    for (const Vec3& point : skin) {
        const Vec3 at(point.x() - a.x(), 0.0, point.z() - a.z());
        const double along = at.dot(line) / line.squaredNorm();
        if (along >= from && along <= to && (at - along * line).norm() <= k_half_width_m) {
            heights.push_back(point.y());
        }
    }
    return percentile(heights, 0.5, fallback);
}

// Returns a capsule along the line from a to b that is flush with the palm's skin and as thick as
// the hand. The Y of a and b, plus or minus spare_m, is used only if there is no skin.
PalmCapsule flush_capsule(const PalmSkin& skin, const Vec3& a, const Vec3& b, double spare_m) {
    const auto skin_at = [&](const std::vector<Vec3>& side, double from, double to, double spare) {
        return height_along(side, a, b, from, to,
                            height_along(side, a, b, -0.2, 1.2, 0.5 * (a.y() + b.y()) + spare));
    };
    const double below_a = skin_at(skin.palmar, -0.1, 0.5, -spare_m);
    const double below_b = skin_at(skin.palmar, 0.5, 1.1, -spare_m);
    const double above =
        0.5 * (skin_at(skin.dorsal, -0.1, 0.5, spare_m) + skin_at(skin.dorsal, 0.5, 1.1, spare_m));
    PalmCapsule capsule{a, b, clamp_radius(0.5 * (above - 0.5 * (below_a + below_b)))};
    // below_a and below_b are the heights at one and at three quarters of the length.
    const double rise = below_b - below_a;
    capsule.a_hs.y() = below_a - 0.5 * rise + capsule.radius_m;
    capsule.b_hs.y() = below_b + 0.5 * rise + capsule.radius_m;
    return capsule;
}

void fit_palm_capsules(const PalmSkin& skin, HandRig& rig) {
    const FingerRig* thumb = nullptr;
    std::vector<Vec3> knuckles;
    double radius_m = 0.0;
    for (const FingerRig& finger : rig.fingers) {
        if (finger.name == FingerName::thumb) {
            thumb = &finger;
            continue;
        }
        knuckles.push_back(finger.base_hs.position);
        radius_m = std::max(radius_m, finger.radius_m[0]);
    }
    for (const Vec3& knuckle : knuckles) {
        const Vec3 root(0.45 * knuckle.x(), 0.0, 0.2 * knuckle.z());
        rig.palm.push_back(flush_capsule(skin, root, 0.93 * knuckle, radius_m));
    }
    if (knuckles.size() > 1) {
        rig.palm.push_back(
            flush_capsule(skin, 0.92 * knuckles.front(), 0.92 * knuckles.back(), radius_m));
        const double heel_z = 0.14 * knuckles.front().z();
        rig.palm.push_back(flush_capsule(skin, Vec3(0.45 * knuckles.front().x(), 0.0, heel_z),
                                         Vec3(0.45 * knuckles.back().x(), 0.0, heel_z), radius_m));
    }
    if (thumb != nullptr && !knuckles.empty()) {
        const Vec3 base = thumb->base_hs.position;
        rig.palm.push_back(
            flush_capsule(skin, base, base + 0.45 * (knuckles.front() - base), radius_m));
    }
}

// Returns the height of the lowest triangle at (x, z); `fallback` if there is none.
double lowest_height(const SkinnedMesh& skin, const std::vector<Vec3>& positions_hs, double x,
                     double z, double fallback) {
    double lowest = fallback;
    bool is_found = false;
    for (const auto& [ia, ib, ic] : skin.triangles) {
        const Vec3& a = positions_hs[ia];
        const Vec3 ab = positions_hs[ib] - a;
        const Vec3 ac = positions_hs[ic] - a;
        const double area = ab.z() * ac.x() - ab.x() * ac.z();
        if (std::abs(area) < 1e-14) {
            continue;
        }
        const double dx = x - a.x();
        const double dz = z - a.z();
        const double u = (dz * ac.x() - dx * ac.z()) / area;
        const double v = (ab.z() * dx - ab.x() * dz) / area;
        if (u < 0.0 || v < 0.0 || u + v > 1.0) {
            continue;
        }
        const double height = a.y() + u * ab.y() + v * ac.y();
        if (!is_found || height < lowest) {
            lowest = height;
            is_found = true;
        }
    }
    return lowest;
}

}  // namespace

void fit_hand_skin(const SkinnedMesh& skin, const std::vector<Vec3>& positions_hs,
                   HandRigFit& fit) {
    std::vector<SkinPart> parts;
    parts.reserve(positions_hs.size());
    for (const SkinWeights& weights : skin.weights) {
        parts.push_back(part_of(weights, fit.rig));
    }
    Vec3 knuckles = Vec3::Zero();
    double count = 0.0;
    for (std::size_t i = 0; i < fit.rig.fingers.size(); ++i) {
        FingerRig& finger = fit.rig.fingers[i];
        fit_finger_skin(positions_hs, parts, static_cast<std::int32_t>(i), fit.bind[i], finger);
        if (finger.name != FingerName::thumb) {
            knuckles += finger.base_hs.position;
            count += 1.0;
        }
    }
    knuckles /= std::max(count, 1.0);
    fit_palm_capsules(collect_palm(skin, positions_hs, parts, fit), fit.rig);
    Vec3& center = fit.rig.palm_center_hs;
    center = k_palm_center_share * knuckles;
    const double spare_m = fit.rig.palm.empty() ? 0.01 : fit.rig.palm.front().radius_m;
    center.y() = lowest_height(skin, positions_hs, center.x(), center.z(), center.y() - spare_m);
    fit.rig.palm_normal_hs = -Vec3::UnitY();
}

}  // namespace handhold
