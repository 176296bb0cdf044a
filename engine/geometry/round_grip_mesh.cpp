#include "engine/geometry/round_grip_mesh.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include "engine/core/check.hpp"
#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/shape_surface.hpp"

namespace handhold {
namespace {

// Each triangle's neighbours, over the edges from its first, second and third corner.
void link_turned(const TurnedIndex& at, SurfaceGraph& graph) {
    graph.neighbours.resize(graph.triangles.size());
    const std::uint32_t bands = at.rings - 1;
    for (std::uint32_t s = 0; s < at.sectors; ++s) {
        const std::uint32_t left = s + at.sectors - 1;
        const auto below = [&](std::uint32_t band) {
            return band < bands ? at.upper(band, s) : at.bottom(s);
        };
        const auto above = [&](std::uint32_t band) {
            return band > 0 ? at.lower(band - 1, s) : at.top(s);
        };
        graph.neighbours[at.top(s)] = {at.top(left), below(0), at.top(s + 1)};
        for (std::uint32_t band = 0; band < bands; ++band) {
            graph.neighbours[at.lower(band, s)] = {at.upper(band, left), below(band + 1),
                                                   at.upper(band, s)};
            graph.neighbours[at.upper(band, s)] = {at.lower(band, s), at.lower(band, s + 1),
                                                   above(band)};
        }
        graph.neighbours[at.bottom(s)] = {at.bottom(left), at.bottom(s + 1), above(bands)};
    }
}

SurfaceGraph turned_graph(const TurnedSurface& surface) {
    Mesh mesh = turned_mesh(surface);
    SurfaceGraph graph;
    graph.positions = std::move(mesh.positions);
    graph.triangles = std::move(mesh.triangles);
    link_turned(TurnedIndex(surface), graph);
    graph.normals.reserve(graph.triangles.size());
    for (std::size_t t = 0; t < graph.triangles.size(); ++t) {
        graph.normals.push_back(area_vector(corners_of(graph, t)).normalized());
    }
    graph.source_triangle.resize(graph.triangles.size());
    std::iota(graph.source_triangle.begin(), graph.source_triangle.end(), 0U);
    graph.report.triangles = graph.report.kept = static_cast<std::uint32_t>(graph.triangles.size());
    graph.report.parts = 1;
    return graph;
}

// Lists a turned surface's triangles so that those of any quarter, sixteenth and so on are close to
// each other: a grid of rows (caps and bands) and sectors is halved along its longer side.
class TreeOrder {
  public:
    explicit TreeOrder(const TurnedSurface& surface) : surface_(surface), at_(surface) {
        order_.reserve(std::size_t{at_.per_sector()} * at_.sectors);
        divide({0, at_.rings + 1, 0, at_.sectors});
    }
    const std::vector<std::uint32_t>& order() const { return order_; }

  private:
    struct Cells {
        std::uint32_t first_row;
        std::uint32_t last_row;
        std::uint32_t first_sector;
        std::uint32_t last_sector;
    };

    double height_m(const Cells& cells) const {
        const TurnedSurface::Point& high = surface_.profile[cells.first_row];
        const TurnedSurface::Point& low = surface_.profile[cells.last_row];
        return std::max(high.y_m - low.y_m, std::abs(high.radius_m - low.radius_m));
    }
    double width_m(const Cells& cells) const {
        const std::uint32_t middle = (cells.first_row + cells.last_row) / 2;
        return 2.0 * k_pi / at_.sectors * (cells.last_sector - cells.first_sector) *
               surface_.profile[middle].radius_m;
    }
    void add_cell(std::uint32_t row, std::uint32_t s) {
        if (row == 0) {
            order_.push_back(at_.top(s));
        } else if (row == at_.rings) {
            order_.push_back(at_.bottom(s));
        } else {
            order_.push_back(at_.lower(row - 1, s));
            order_.push_back(at_.upper(row - 1, s));
        }
    }
    void divide(const Cells& cells) {
        const std::uint32_t rows = cells.last_row - cells.first_row;
        const std::uint32_t columns = cells.last_sector - cells.first_sector;
        if (rows == 1 && columns == 1) {
            add_cell(cells.first_row, cells.first_sector);
            return;
        }
        Cells first = cells;
        Cells second = cells;
        if (columns == 1 || (rows > 1 && height_m(cells) > width_m(cells))) {
            first.last_row = second.first_row = cells.first_row + rows / 2;
        } else {
            first.last_sector = second.first_sector = cells.first_sector + columns / 2;
        }
        divide(first);
        divide(second);
    }

    const TurnedSurface& surface_;
    TurnedIndex at_;
    std::vector<std::uint32_t> order_;
};

struct Detail {
    SurfaceGraph graph;
    TriangleBvh bvh;
};

Detail detail_of(const TurnedSurface& surface) {
    Detail made;
    made.graph = turned_graph(surface);
    const TreeOrder order(surface);
    made.bvh = TriangleBvh(made.graph.positions, made.graph.triangles,
                           {order.order(), made.graph.normals});
    return made;
}

std::uint32_t search_sectors(double radius_m, const DetailLimits& limits) {
    const double by_edge = limits.edge_m > 0.0 ? limits.edge_m / radius_m : 2.0 * k_pi;
    return sectors_of(std::min(by_edge, sphere_step_rad(radius_m, limits.deviation_m)));
}

}  // namespace

GripMesh build_round_grip_mesh(const Shape& shape, const GripMeshSettings& settings) {
    HH_CHECK(shape.kind == ShapeKind::sphere || shape.kind == ShapeKind::capsule,
             "not a round shape", static_cast<int>(shape.kind));
    const double half_height_m = shape.kind == ShapeKind::capsule ? shape.half_height_m : 0.0;
    const std::uint32_t fine =
        sectors_of(sphere_step_rad(shape.radius_m, settings.shape_tolerance_m));
    const std::uint32_t coarse = std::min(fine, search_sectors(shape.radius_m, settings.search));
    GripMesh grip;
    Detail contact = detail_of(turned_capsule(shape.radius_m, half_height_m, fine));
    grip.contact = std::move(contact.graph);
    grip.contact_bvh = std::move(contact.bvh);
    grip.full_triangles = static_cast<std::uint32_t>(grip.contact.triangles.size());
    grip.digest = digest_of(grip.contact);
    if (coarse == fine) {
        grip.search = grip.contact;
        grip.search_bvh = grip.contact_bvh;
        return grip;
    }
    Detail search = detail_of(turned_capsule(shape.radius_m, half_height_m, coarse));
    grip.search = std::move(search.graph);
    grip.search_bvh = std::move(search.bvh);
    // The contact triangle at the same share of each sector.
    const auto count = static_cast<std::uint64_t>(grip.search.triangles.size());
    for (std::uint32_t t = 0; t < count; ++t) {
        grip.search.source_triangle[t] =
            static_cast<std::uint32_t>(t * std::uint64_t{grip.full_triangles} / count);
    }
    return grip;
}

}  // namespace handhold
