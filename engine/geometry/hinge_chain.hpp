#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "engine/geometry/chain_patch.hpp"
#include "engine/geometry/disc_contact.hpp"
#include "engine/math/math.hpp"

// A chain of hinged capsules. Its hinge axes are parallel, so all links move in one plane: disc
// space (_ds, disc_contact.hpp).
namespace handhold {

using ChainAngles = std::array<double, k_max_disc_links>;

// Link i begins at hinge i. At angle 0 every link lies along the base's -Z; a positive angle turns
// from -Z towards -Y.
struct HingeChain {
    Pose base;
    std::uint32_t link_count = 3;  // 1 to k_max_disc_links
    std::array<double, k_max_disc_links> length_m = {};
    std::array<double, k_max_disc_links> radius_m = {};
    ChainAngles open_rad = {};
    ChainAngles closed_rad = {};
    ChainAngles rest_rad = {};  // pose of a chain that touches nothing
};

struct Capsule {
    std::array<Vec3, 2> ends = {Vec3::Zero(), Vec3::Zero()};
    double radius_m = 0.0;
};
std::array<Capsule, k_max_disc_links> chain_capsules(const HingeChain& chain,
                                                     const ChainAngles& angle_rad);

// Positions of the hinges and of the last link's end.
std::array<Vec2, k_max_disc_links + 1> chain_points_ds(const HingeChain& chain,
                                                       const ChainAngles& angle_rad);

double max_radius_m(const HingeChain& chain);
// Distance of the straight chain's farthest point from the first hinge, including the radius.
double reach_m(const HingeChain& chain);

// Offset of a cutting plane from the chain's own plane, metres. Plane 0 is the chain's own; planes
// 1 and 2 lie on either side at `plane_offset` times the mean link radius.
double plane_offset_m(const HingeChain& chain, double plane_offset, std::size_t plane);
// Half thickness, across the chain's plane, of the region that the links and the cutting planes can
// meet.
double half_width_m(const HingeChain& chain, double plane_offset);

// Region that the chain sweeps if each hinge takes all angles in [min_rad, max_rad]: one box per
// link. The half width is the largest link radius. Precondition: min_rad[i] <= max_rad[i].
ChainReach chain_reach(const HingeChain& chain, const ChainAngles& min_rad,
                       const ChainAngles& max_rad);
// Minimum and maximum of each hinge's angle.
ChainAngles lowest(const ChainAngles& a, const ChainAngles& b);
ChainAngles highest(const ChainAngles& a, const ChainAngles& b);

// The chain's cross-sections in its cutting planes; closes from open_rad to closed_rad.
DiscChain flat_chain(const HingeChain& chain, double plane_offset);

// Penetration of a chain into the gathered surfaces. If a surface crosses a link's axis, the chain
// beyond the crossing counts as penetrating: without closed solids it cannot be known whether the
// chain comes out again.
struct ChainDepth {
    double depth_m = 0.0;
    std::size_t link = 0;     // deepest link
    bool is_crossed = false;  // a surface crosses the axis of a queried link
};
struct DepthQuery {
    std::size_t first = 0;               // first link queried
    std::size_t end = k_max_disc_links;  // one past the last link queried
    // The query stops at a link that is at least this deep. The depth found may then be too small.
    double sufficient_depth_m = std::numeric_limits<double>::infinity();
};
ChainDepth chain_depth(const HingeChain& chain, const ChainAngles& angle_rad, ChainPatch& patch,
                       const DepthQuery& query = {});
// ChainDepth::depth_m at these angles. Gathers into `patch` the triangles that the chain can meet
// there. The chain and the meshes are in one frame.
double posed_depth_m(const HingeChain& chain, const ChainAngles& angle_rad,
                     std::span<const PlacedMesh> meshes, ChainPatch& patch);
// Penetration of one chain in several poses. The first link is queried once for all poses with the
// same angle of the first hinge.
class ChainDepths {
  public:
    ChainDepths(const HingeChain& chain, ChainPatch& patch) : chain_(chain), patch_(patch) {}

    // ChainDepth::depth_m at these angles; exact only if it is below `sufficient_depth_m`.
    double depth_m(const ChainAngles& angle_rad, double sufficient_depth_m);

  private:
    struct FirstLink {
        double angle_rad = 0.0;
        double depth_m = 0.0;
        bool is_crossed = false;
    };
    const FirstLink& first_link(const ChainAngles& angle_rad);

    const HingeChain& chain_;
    ChainPatch& patch_;
    std::array<FirstLink, 5> known_;
    std::size_t known_count_ = 0;
};

}  // namespace handhold
