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

// Step 1 of search_grip: a best-first search over the triangles around a palm, in the order of the
// cost of fitting the palm to them. All positions are in the mesh's frame. Talk rows 11, 17.
namespace handhold {

struct PalmFrame {
    Vec3 center;  // point on the palm's skin
    Vec3 up;      // unit, towards the back of the hand
};

struct PalmCost {
    double cost_m = std::numeric_limits<double>::infinity();
    Vec3 point = Vec3::Zero();  // point on the triangle, under the palm
};

// Cost of fitting the palm to one triangle, in closed form:
//   cost = |c' - c| + tilt_cost_m_per_rad * max(0, angle - max_angle_rad) + backface cost
// c is the palm's centre, and c' the nearest point over the triangle within the height limits.
// angle is between palm.up and the triangle's normal, which is negated for a backface. Tilting
// turns about the palm's centre and does not change its height. Precondition: the graph has the
// triangle.
PalmCost cost_of(const SurfaceGraph& graph, std::uint32_t triangle, const PalmFrame& palm,
                 const PalmTuning& tuning);

inline constexpr double k_duplicate_place_m = 0.025;
inline constexpr double k_duplicate_place_cosine = 0.7;

// True if two surface points with unit normals count as the same place: within k_duplicate_place_m,
// with a cosine between the normals above k_duplicate_place_cosine.
bool is_duplicate_place(const Vec3& point, const Vec3& normal, const Vec3& other,
                        const Vec3& other_normal);

// Visits triangles best first, from the seeds to their neighbours, within PalmTuning::reach_m.
// Keeps references to its constructor arguments. No one else may use `scratch` during its lifetime.
class SurfaceSearch {
  public:
    using Candidate = GripSearchScratch::Candidate;
    static constexpr std::uint32_t k_max_pops = 300;  // maximum in all calls of run together

    SurfaceSearch(const SurfaceGraph& graph, const PalmFrame& palm, const PalmTuning& tuning,
                  GripSearchScratch& scratch);

    // Ignores triangles that the graph does not have.
    void add_seed(std::uint32_t triangle);
    // Continues until `max_idle_pops` consecutive pops have found no cheaper triangle, until no
    // triangle within reach is left, or until k_max_pops. Can be called again.
    void run(std::uint32_t max_idle_pops);

    // Returns the cheapest visited triangle that is not a duplicate place of any in `excluded`;
    // nullopt: there is none.
    std::optional<Candidate> cheapest_excluding(std::span<const Candidate> excluded) const;
    // Appends the result of cheapest_excluding() to the first `count` candidates. Repeats this
    // while the result costs less than max_cost_m and `candidates` has space. Returns the new
    // count. Precondition: count <= candidates.size().
    std::size_t append_cheapest_excluding(std::span<Candidate> candidates, std::size_t count,
                                          double max_cost_m) const;
    // Returns the cheapest visited triangle that is a duplicate place of the point `other` on
    // `other_triangle`; nullopt: there is none.
    std::optional<Candidate> cheapest_near(const Vec3& other, std::uint32_t other_triangle) const;

  private:
    void push(std::uint32_t triangle);
    // True if the triangle is at the back of the hand and faces it: nothing that a palm can grip.
    bool is_behind(const GripSearchScratch::Node& node) const;
    bool is_duplicate_of(const Candidate& found, const Candidate& other) const;

    const SurfaceGraph& graph_;
    const PalmFrame& palm_;
    const PalmTuning& tuning_;
    std::vector<GripSearchScratch::Node>& open_;
    TriangleSet<2048> seen_;
    std::uint32_t pushed_ = 0;
    std::vector<Candidate>& visited_;
    std::vector<Candidate>& remaining_;
    double best_m_ = std::numeric_limits<double>::infinity();
    std::uint32_t pops_ = 0;
};

}  // namespace handhold
