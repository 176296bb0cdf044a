#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "engine/geometry/chain_patch.hpp"
#include "engine/geometry/disc_contact.hpp"
#include "engine/math/math.hpp"

// A chain of hinged capsules in space, and what it is in its own plane: disc space (_ds,
// disc_contact.hpp).
namespace handhold {

using ChainAngles = std::array<double, k_max_disc_links>;

// Link i begins at hinge i. At angle 0 all of them lie along the base's -Z; a positive angle turns
// from -Z towards -Y.
struct HingeChain {
    Pose base;
    std::uint32_t link_count = 3;  // 1 to k_max_disc_links
    std::array<double, k_max_disc_links> length_m = {};
    std::array<double, k_max_disc_links> radius_m = {};
    ChainAngles open_rad = {};
    ChainAngles closed_rad = {};
    ChainAngles rest_rad = {};  // where nothing is touched
};

struct Capsule {
    std::array<Vec3, 2> ends = {Vec3::Zero(), Vec3::Zero()};
    double radius_m = 0.0;
};
std::array<Capsule, k_max_disc_links> chain_capsules(const HingeChain& chain,
                                                     const ChainAngles& angle_rad);

// The hinges, and the last link's end.
std::array<Vec2, k_max_disc_links + 1> chain_points_ds(const HingeChain& chain,
                                                       const ChainAngles& angle_rad);

double max_radius_m(const HingeChain& chain);
double reach_m(const HingeChain& chain);  // from the first hinge

// Where a plane lies across the chain: the middle one is plane 0, and of those beside it
// `plane_offset` is the place in mean link radii.
double plane_offset_m(const HingeChain& chain, double plane_offset, std::size_t plane);
// Of all that the chain and its planes can meet.
double half_width_m(const HingeChain& chain, double plane_offset);

// Where the chain can be with each hinge anywhere between two angles: a box for each link, `more_m`
// wider than it. As far across as its thickest link. Precondition: no angle of least_rad is above
// that of most_rad.
ChainReach chain_reach(const HingeChain& chain, const ChainAngles& min_rad,
                       const ChainAngles& max_rad, double extra_radius_m = 0.0);
// By hinge.
ChainAngles lowest(const ChainAngles& a, const ChainAngles& b);
ChainAngles highest(const ChainAngles& a, const ChainAngles& b);

// As its planes cut it; closes from fully open to fully closed.
DiscChain flat_chain(const HingeChain& chain, double plane_offset);

// How deep a chain is sunk in what was gathered around it, and which link is sunk deepest. What is
// beyond the place where a surface goes through the chain is taken for sunk as well: whether it
// is, only a solid could tell.
struct ChainDepth {
    double depth_m = 0.0;
    std::size_t link = 0;
    // Of each link that was looked at: how near a surface is to its middle, no more than where it
    // begins to count, and what is beyond a surface that goes through.
    std::array<double, k_max_disc_links> nearest_m = {};
    std::array<double, k_max_disc_links> beyond_m = {};
    // Where on its middle that is, and the way there from the surface (CapsulePenetration).
    std::array<Vec2, k_max_disc_links> nearest_ds = {Vec2::Zero(), Vec2::Zero(), Vec2::Zero()};
    std::array<Vec2, k_max_disc_links> away_ds = {Vec2::Zero(), Vec2::Zero(), Vec2::Zero()};
    std::size_t end = 0;  // those from here on were not looked at
};
struct DepthQuery {
    double extra_radius_m = 0.0;         // of a chain that is so much thicker
    std::size_t first = 0;               // links before it are left out
    std::size_t end = k_max_disc_links;  // and those from here on
    double sufficient_depth_m = std::numeric_limits<double>::infinity();  // as deep as this, how
                                                                          // deep is of no interest
};
ChainDepth chain_depth(const HingeChain& chain, const ChainAngles& angle_rad, ChainPatch& patch,
                       const DepthQuery& query = {});
// ChainDepth::depth_m at these angles, of what the chain can meet there, which `patch` then has.
// The chain and the meshes are in one frame.
double posed_depth_m(const HingeChain& chain, const ChainAngles& angle_rad,
                     std::span<const PlacedMesh> meshes, ChainPatch& patch);
// How deep one chain is in several poses, of which some have their first link in common: that is
// looked at once.
class ChainDepths {
  public:
    ChainDepths(const HingeChain& chain, ChainPatch& patch) : chain_(chain), patch_(patch) {}

    // As ChainDepth::depth_m; as deep as `sufficient_depth_m`, how deep is of no interest.
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

// What a thicker chain says of the chain itself, of links before `end`.
ChainDepth own_depth(const HingeChain& chain, const ChainDepth& thicker, std::size_t end);

}  // namespace handhold
