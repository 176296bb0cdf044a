#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "engine/collision/closest_point.hpp"
#include "engine/geometry/disc_contact.hpp"
#include "engine/geometry/grip_mesh.hpp"
#include "engine/math/four_floats.hpp"
#include "engine/math/math.hpp"

// What of the surfaces one chain can come to, gathered once: whatever is asked after that (cuts,
// depths) goes through a short list, and through no tree.
namespace handhold {

// A mesh, and where it is in the frame that a chain is in.
struct PlacedMesh {
    const GripMesh* mesh = nullptr;
    Pose pose;
};

// How deep a capsule is sunk in the surfaces.
struct SunkCapsule {
    double depth_m = 0.0;    // at least 0: its radius less the distance of its middle
    double nearest_m = 0.0;  // that distance, where it is less than the radius; else the radius
    std::optional<double> crossed_at;  // in [0, 1] from its first end: where the first surface goes
                                       // through its middle
};

// An upright box in disc space.
struct ReachBox {
    Vec2 low = Vec2::Constant(-std::numeric_limits<double>::infinity());
    Vec2 high = Vec2::Constant(std::numeric_limits<double>::infinity());
};

// Where a chain's links can be: a disc with a thickness, and of that what is in a box of one of
// the links.
struct ChainReach {
    Pose base;                // the first hinge: links along -Z at angle 0, turning towards -Y
    double radius_m = 0;      // about the hinge, in the plane
    double half_width_m = 0;  // across the plane
    std::array<ReachBox, k_most_disc_links> boxes = {};  // in the plane
    std::uint32_t box_count = 0;                         // 0: all of the disc
};

// Disc space (_ds, disc_contact.hpp) with a third axis, across the plane: base's -Z, -Y and -X.
// Keeps its memory between gatherings.
class ChainPatch {
  public:
    // Every triangle of the meshes' contact detail with a point in reach, and few more.
    void gather(const ChainReach& reach, std::span<const PlacedMesh> meshes);

    // What the plane `offset_m` across cuts out of the triangles within the reach, as `plane` in
    // the segments, which are added to; the first mesh's come before the others'. Precondition: the
    // plane is within the half width. Returns how many are the first mesh's.
    std::size_t cut(double offset_m, std::uint32_t plane, std::vector<DiscSegment>& segments) const;

    // Of a capsule whose middle lies in the plane, within what was gathered for.
    SunkCapsule find_sunk(const std::array<Vec2, 2>& middle_ds, double radius_m) const;

    std::size_t size() const { return triangles_.size(); }

  private:
    struct Triangle {
        Corners corners;
        Vec3 normal;  // unit
        std::uint32_t number = 0;
    };

    struct Across {
        double low = 0.0;
        double high = 0.0;
    };
    // Where the plane of a triangle meets the chain's own: normal . point = offset.
    struct Line {
        Vec2 normal;
        double offset = 0.0;
    };

    class SunkSearch;

    void gather_mesh(const ChainReach& reach, const PlacedMesh& placed);
    void settle(SunkSearch& search) const;

    // By triangle; what is asked most lies together.
    std::vector<FlatBounds> bounds_;
    std::vector<Across> across_;
    std::vector<Line> lines_;
    std::vector<Triangle> triangles_;
    std::size_t of_first_mesh_ = 0;
    double radius_m_ = 0.0;
};

}  // namespace handhold
