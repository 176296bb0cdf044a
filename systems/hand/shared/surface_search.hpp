#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "components/hand_surroundings.hpp"
#include "components/tuning.hpp"
#include "engine/geometry/surface_graph.hpp"
#include "engine/geometry/triangle_set.hpp"

// Triangles around a palm in the order of what it takes to hold the palm to them: search_grip's
// search. All in the frame of the mesh. Talk rows 11, 17.
namespace handhold {

struct PalmFrame {
    Vec3 center;
    Vec3 up;  // unit: towards the back of the hand
};

struct PalmCost {
    double cost_m = std::numeric_limits<double>::infinity();
    Vec3 point = Vec3::Zero();  // under the palm, on the triangle
};

// What it takes to hold the palm to one triangle, in closed form: along the triangle's normal into
// the range of heights, then about the palm's own centre, which keeps its height, into the range of
// angles. Precondition: the graph has the triangle.
PalmCost cost_of(const SurfaceGraph& graph, std::uint32_t triangle, const PalmFrame& palm,
                 const PalmTuning& tuning);

// Of two places on a surface, with unit normals: the one is hardly another one than the other.
bool is_duplicate_place(const Vec3& point, const Vec3& normal, const Vec3& other,
                        const Vec3& other_normal);

// Best first over the neighbours of what it is seeded with, within PalmTuning::reach_m. Refers to
// all that it is made of; the scratch is its alone while it lives.
class SurfaceSearch {
  public:
    using Candidate = GripSearchScratch::Candidate;
    static constexpr std::uint32_t k_max_pops = 300;  // in all calls of run

    SurfaceSearch(const SurfaceGraph& graph, const PalmFrame& palm, const PalmTuning& tuning,
                  GripSearchScratch& scratch);

    // A triangle that the graph has not is left out.
    void add_seed(std::uint32_t triangle);
    // Goes on until `patience` pops in a row found nothing cheaper; may be called again.
    void run(std::uint32_t patience);

    // The cheapest of those found that is not near any of `tried` and alike; none where there is
    // none.
    std::optional<Candidate> cheapest_excluding(std::span<const Candidate> excluded) const;
    // Adds to the first `count` of `tried` what cheapest_excluding would, one after the other, as
    // long as it costs less than most_m and there is room. Returns how many there are then.
    // Precondition: count <= tried.size().
    std::size_t append_cheapest_excluding(std::span<Candidate> excluded, std::size_t count,
                                          double most_m) const;
    // The cheapest of those found that is near `other` and alike.
    std::optional<Candidate> cheapest_near(const Vec3& other, std::uint32_t other_triangle) const;

  private:
    void push(std::uint32_t triangle);
    bool is_duplicate_of(const Candidate& found, const Candidate& other) const;

    const SurfaceGraph& graph_;
    const PalmFrame& palm_;
    const PalmTuning& tuning_;
    std::vector<GripSearchScratch::Node>& open_;
    TriangleSet<2048> seen_;
    std::uint32_t pushed_ = 0;
    std::vector<Candidate>& visited_;
    std::vector<Candidate>& remaining_;
    double best_m_ = 0.0;
    std::uint32_t pops_ = 0;
};

}  // namespace handhold
