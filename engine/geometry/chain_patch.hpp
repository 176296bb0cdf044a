#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/disc_contact.hpp"
#include "engine/geometry/grip_mesh.hpp"
#include "engine/geometry/reach_slab.hpp"
#include "engine/math/float4.hpp"
#include "engine/math/math.hpp"

// The triangles within one chain's reach, gathered once. Cuts and depth queries then scan this
// short list instead of searching a tree.
namespace handhold {

// A mesh and its pose in the chain's frame.
struct PlacedMesh {
    const GripMesh* mesh = nullptr;
    Pose pose;
};

// Penetration of a capsule into the surfaces.
struct CapsulePenetration {
    double depth_m = 0.0;    // radius minus the axis's distance to the surface, >= 0
    double nearest_m = 0.0;  // distance of the axis to the surface, at most the radius
    // Smallest fraction of the axis at which a surface crosses it; nullopt if no surface does.
    std::optional<double> crossed_at;
};

// Works in disc space (_ds, disc_contact.hpp): the base's -Z and -Y axes, and as third axis -X,
// across the plane. Memory is reused between gatherings. Float tests reject most triangles. The
// others are transformed in doubles, on first use.
class ChainPatch {
  public:
    // Gathers the triangles of the meshes' contact detail that reach into `reach`, and possibly
    // others.
    void gather(const ChainReach& reach, std::span<const PlacedMesh> meshes);

    // Cuts the gathered triangles with the plane at `offset_m`. Appends the segments with the label
    // `plane`, the first mesh's before the others', and returns the number of the first mesh's.
    // Computed in floats, as is the reach's boundary. Precondition: |offset_m| <= half width of the
    // reach.
    std::size_t cut(double offset_m, std::uint32_t plane, std::vector<DiscSegment>& segments);

    // Penetration of a capsule whose axis lies in the chain's plane and inside box `box` of the
    // gathered reach. If the reach has no boxes, the axis may lie anywhere in it.
    CapsulePenetration find_penetration(const std::array<Vec2, 2>& middle_ds, double radius_m,
                                        std::size_t box);

    std::size_t size() const;  // number of triangles

  private:
    struct Triangle {
        Corners corners;
        Vec3 normal;  // unit
    };

    // Transforms one mesh's triangles into disc space, in doubles.
    class Frame {
      public:
        Frame(const GripMesh& mesh, const Pose& base, std::size_t first);
        Triangle triangle(std::uint32_t slot) const;
        std::uint32_t number(std::uint32_t slot) const;  // triangle index in the mesh
        // Index into fours_ of this mesh's first entry.
        std::size_t first() const { return first_; }

      private:
        Vec3 turned(const Vec3& direction) const;

        const GripMesh* mesh_;
        std::size_t first_;
        Vec3 base_;
        Vec3 x_axis_;
        Vec3 y_axis_;
        Vec3 across_;
    };

    class PenetrationSearch;

    void gather_mesh(const ChainReach& reach, const PlacedMesh& placed);
    const Triangle& exact(std::uint32_t place);  // place = 4 * index into fours_ + lane

    // Which triangles of one group of four reach into a box.
    struct Boxed {
        Int4 is_near = {};
        std::uint32_t four = 0;  // index into fours_
    };

    static constexpr std::uint32_t k_not_placed = ~0U;

    // Groups of four triangles, in the order of meshes, then of their trees.
    std::vector<ReachedTriangles4> fours_;
    std::vector<Int4> is_near_;  // triangles of each group that reach into any box
    std::vector<std::uint32_t> first_slot_;
    std::vector<std::array<std::uint32_t, 4>> placed_;  // index into triangles_, or k_not_placed
    std::array<std::vector<Boxed>, k_max_disc_links> boxed_;
    std::size_t box_count_ = 1;
    std::vector<Triangle> triangles_;  // transformed on first use
    std::vector<Frame> frames_;        // one per mesh
    double rounding_margin_m_ = 0.0;   // upper bound on the float rounding error
    double radius_m_ = 0.0;
};

}  // namespace handhold
