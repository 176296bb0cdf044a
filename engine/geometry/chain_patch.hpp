#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/collision/closest_point.hpp"
#include "engine/geometry/disc_contact.hpp"
#include "engine/geometry/grip_mesh.hpp"
#include "engine/geometry/reach_slab.hpp"
#include "engine/math/float4.hpp"
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
struct CapsulePenetration {
    double depth_m = 0.0;    // at least 0: its radius less the distance of its middle
    double nearest_m = 0.0;  // that distance, where it is less than the radius; else the radius
    std::optional<double> crossed_at;  // in [0, 1] from its first end: where the first surface goes
                                       // through its middle
    // Of the nearest pair of points, where there is one: that on its middle, and the way there from
    // the surface, unit, what of it lies in the plane. Zero where a surface goes through.
    Vec2 nearest_ds = Vec2::Zero();
    Vec2 away_ds = Vec2::Zero();
};

// Disc space (_ds, disc_contact.hpp) with a third axis, across the plane: base's -Z, -Y and -X.
// Keeps its memory between gatherings. What floats tell from what is asked is never looked at more
// closely; of the rest each triangle is once, when it is first asked for.
class ChainPatch {
  public:
    // Every triangle of the meshes' contact detail with a point in reach, and few more.
    void gather(const ChainReach& reach, std::span<const PlacedMesh> meshes);

    // What the plane `offset_m` across cuts out of the triangles within the reach, as `plane` in
    // the segments, which are added to; the first mesh's come before the others'. In floats, the
    // reach's edge too. Precondition: the plane is within the half width. Returns how many are the
    // first mesh's.
    std::size_t cut(double offset_m, std::uint32_t plane, std::vector<DiscSegment>& segments);

    // Of a capsule whose middle lies in the plane, within box `box` of the reach that was gathered
    // for; where that has no boxes, anywhere in it.
    CapsulePenetration find_penetration(const std::array<Vec2, 2>& middle_ds, double radius_m,
                                        std::size_t box);

    std::size_t size() const;  // triangles

  private:
    struct Triangle {
        Corners corners;
        Vec3 normal;  // unit
    };

    // From one mesh into disc space, in doubles.
    class Frame {
      public:
        Frame(const GripMesh& mesh, const Pose& base, std::size_t first);
        Triangle triangle(std::uint32_t slot) const;
        std::uint32_t number(std::uint32_t slot) const;  // the mesh's own
        std::size_t first() const { return first_; }     // of the fours that are this mesh's

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
    const Triangle& exact(std::uint32_t place);  // four times the four, and its lane

    // Of four triangles, those in one box.
    struct Boxed {
        Int4 is_near = {};
        std::uint32_t four = 0;
    };

    static constexpr std::uint32_t k_not_placed = ~0U;

    // By four, in the order of the meshes and their trees.
    std::vector<ReachedTriangles4> fours_;
    std::vector<Int4> is_near_;  // in any box
    std::vector<std::uint32_t> first_slot_;
    std::vector<std::array<std::uint32_t, 4>> placed_;  // which of triangles_, or k_not_placed
    std::array<std::vector<Boxed>, k_max_disc_links> boxed_;
    std::size_t box_count_ = 1;
    std::vector<Triangle> triangles_;  // those that were asked for
    std::vector<Frame> frames_;        // by mesh
    double rounding_margin_m_ = 0.0;   // more than floats round off
    double radius_m_ = 0.0;
};

}  // namespace handhold
