#include "engine/geometry/chain_fit.hpp"

#include <algorithm>
#include <cmath>

#include "engine/geometry/segment_triangle.hpp"

namespace handhold {
namespace {

Vec3 along_link(const Pose& hinge) { return hinge.rotation * -Vec3::UnitZ(); }

double reach_m(const HingeChain& chain) {
    double reach = 0.0;
    double thickest = 0.0;
    for (std::size_t i = 0; i < chain.link_count; ++i) {
        reach += chain.length_m[i];
        thickest = std::max(thickest, chain.radius_m[i]);
    }
    return reach + thickest;
}

double plane_offset_m(const HingeChain& chain, const ChainFitSettings& settings,
                      std::size_t plane) {
    double mean = 0.0;
    for (std::size_t i = 0; i < chain.link_count; ++i) {
        mean += chain.radius_m[i] / chain.link_count;
    }
    constexpr std::array<double, k_disc_planes> k_places = {0.0, 1.0, -1.0};
    return k_places[plane] * settings.plane_offset * mean;
}

DiscChain flat_chain(const HingeChain& chain, const ChainFitSettings& settings) {
    DiscChain flat;
    flat.link_count = chain.link_count;
    flat.length_m = chain.length_m;
    flat.open_rad = chain.open_rad;
    flat.closed_rad = chain.closed_rad;
    for (std::size_t plane = 0; plane < k_disc_planes; ++plane) {
        const double offset = plane_offset_m(chain, settings, plane);
        for (std::size_t i = 0; i < chain.link_count; ++i) {
            const double squared = chain.radius_m[i] * chain.radius_m[i] - offset * offset;
            flat.radius_m[plane][i] = squared > 0.0 ? std::sqrt(squared) : -1.0;
        }
    }
    return flat;
}

// In the mesh's frame.
Disc disc_of(const HingeChain& chain, const Pose& mesh, const ChainFitSettings& settings,
             std::size_t plane) {
    const Pose base = inverse(mesh) * chain.base;
    Disc disc;
    disc.x_axis = along_link(base);
    disc.y_axis = base.rotation * -Vec3::UnitY();
    disc.normal = base.rotation * -Vec3::UnitX();
    disc.center = base.position + plane_offset_m(chain, settings, plane) * disc.normal;
    disc.radius_m = reach_m(chain);
    disc.plane = static_cast<std::uint32_t>(plane);
    return disc;
}

// The chain over cuts that searches find; or over all cuts.
class ChainFitter {
  public:
    ChainFitter(const HingeChain& chain, std::span<const PlacedMesh> meshes,
                const ChainFitSettings& settings, ChainFitScratch& scratch)
        : chain_(chain),
          flat_(flat_chain(chain, settings)),
          meshes_(meshes),
          settings_(settings),
          scratch_(scratch) {}

    ChainFit run(const ChainSeed& seed) {
        // As much as one chain meets but in the thickest of meshes: then it grows, and stays.
        constexpr std::size_t k_usual_segments = 2048;
        scratch_.segments.reserve(k_usual_segments);
        scratch_.disc.pairs.reserve(k_usual_segments);
        if (meshes_.empty()) {
            relax();
            return fit_;
        }
        bool is_complete = false;
        if (seed.triangle != k_no_triangle) {
            is_complete = search_cuts(seed);
            close();
        }
        const bool touches = fit_.contact_link != DiscClosure::k_none;
        if (seed.triangle == k_no_triangle ||
            (settings_.mends &&
             (!is_complete || !touches || fit_.depth_m > settings_.search_depth_m))) {
            close_over_all_cuts(touches);
        }
        if (fit_.contact_link == DiscClosure::k_none) {
            relax();
        }
        if (!settings_.mends) {
            return fit_;
        }
        if (fit_.depth_m > settings_.search_depth_m) {
            bend_clear();
        }
        if (fit_.depth_m > settings_.open_depth_m) {
            open();
        }
        return fit_;
    }

  private:
    // True where every plane's search found the surface.
    bool search_cuts(const ChainSeed& seed) {
        scratch_.segments.clear();
        bool is_complete = true;
        const GripMesh& mesh = *meshes_.front().mesh;
        for (std::size_t plane = 0; plane < k_disc_planes; ++plane) {
            const Disc disc = disc_of(chain_, meshes_.front().pose, settings_, plane);
            CrossingSearch found = find_crossing(mesh.search, disc, seed.triangle, seed.point,
                                                 settings_.order, scratch_.trace);
            ++fit_.discs;
            fit_.pops += found.pops;
            is_complete = is_complete && found.triangle != k_no_triangle;
            if (found.triangle == k_no_triangle) {
                continue;
            }
            if (plane == 0) {
                fit_.contact_triangle = found.triangle;
            }
            walk_contact(mesh, disc, found);
        }
        for (const PlacedMesh& other : meshes_.subspan(1)) {
            cut_mesh(other);
        }
        return is_complete;
    }

    // From the search detail over to the surface itself.
    void walk_contact(const GripMesh& mesh, const Disc& disc, const CrossingSearch& found) {
        const auto near = mesh.contact_bvh.closest_point(found.point, k_detail_apart_m);
        if (!near) {
            return;
        }
        const CrossingSearch onto = find_crossing(mesh.contact, disc, near->triangle, near->point,
                                                  SearchOrder::best_first, scratch_.trace);
        fit_.walked += onto.pops;
        if (onto.triangle == k_no_triangle) {
            return;
        }
        fit_.walked +=
            walk_crossing(mesh.contact, disc, onto.triangle, scratch_.trace, scratch_.segments);
    }

    void cut_mesh(const PlacedMesh& placed) {
        for (std::size_t plane = 0; plane < k_disc_planes; ++plane) {
            const Disc disc = disc_of(chain_, placed.pose, settings_, plane);
            cut_all(placed.mesh->contact, placed.mesh->contact_bvh, disc, scratch_.segments);
        }
    }

    void close() {
        const DiscClosure closure = close_chain(flat_, scratch_.segments, {}, scratch_.disc);
        fit_.angle_rad = closure.angle_rad;
        fit_.contact_link = closure.contact_link;
        fit_.depth_m = depth_of(fit_.angle_rad).depth_m;
    }

    void close_over_all_cuts(bool had_touch) {
        const ChainFit before = fit_;
        scratch_.segments.clear();
        for (const PlacedMesh& placed : meshes_) {
            cut_mesh(placed);
        }
        close();
        const bool is_better = !had_touch || fit_.depth_m < before.depth_m;
        if (is_better) {
            fit_.fallback = ChainFallback::all_cuts;
        } else {
            fit_ = before;
        }
    }

    // Straight, it reaches into what is before it, and may be clear when it is bent: at the first
    // hinge, at the others, or at all. Closes from the first pose that is clear, the straightest
    // first; where none is, stays at the one that is sunk least.
    void bend_clear() {
        const ChainFit before = fit_;
        DiscChain bent = flat_;
        double least_m = fit_.depth_m;
        constexpr int k_bends = 5;
        for (int sum = 0; sum <= 2 * (k_bends - 1); ++sum) {
            for (int first = std::max(0, sum - k_bends + 1); first <= std::min(sum, k_bends - 1);
                 ++first) {
                const std::array<double, k_most_disc_links> angle_rad =
                    bend(static_cast<double>(first) / k_bends,
                         static_cast<double>(sum - first) / (k_bends - 1));
                const double depth_m = depth_of(angle_rad).depth_m;
                if (depth_m < least_m) {
                    least_m = depth_m;
                    bent.open_rad = angle_rad;
                }
                if (depth_m <= settings_.open_depth_m) {
                    bent.open_rad = angle_rad;
                    close_from(bent, before);
                    return;
                }
            }
        }
        if (least_m < before.depth_m) {
            fit_.angle_rad = bent.open_rad;
            fit_.depth_m = least_m;
            fit_.fallback = ChainFallback::bent;
        }
    }

    std::array<double, k_most_disc_links> bend(double first, double others) const {
        std::array<double, k_most_disc_links> angle_rad = {};
        for (std::size_t i = 0; i < chain_.link_count; ++i) {
            angle_rad[i] = chain_.open_rad[i] +
                           (i == 0 ? first : others) * (chain_.closed_rad[i] - chain_.open_rad[i]);
        }
        return angle_rad;
    }

    void close_from(const DiscChain& bent, const ChainFit& before) {
        const DiscClosure closure = close_chain(bent, scratch_.segments, {}, scratch_.disc);
        fit_.angle_rad = closure.angle_rad;
        fit_.contact_link = closure.contact_link;
        fit_.depth_m = depth_of(fit_.angle_rad).depth_m;
        fit_.fallback = ChainFallback::bent;
        if (closure.contact_link == DiscClosure::k_none || fit_.depth_m >= before.depth_m) {
            fit_.angle_rad = bent.open_rad;
            fit_.depth_m = depth_of(fit_.angle_rad).depth_m;
        }
    }

    // What is beyond the place where a surface goes through the chain is taken for sunk as well:
    // whether it is, only a solid could tell.
    struct Depth {
        double depth_m = 0.0;
        std::size_t link = 0;
    };
    Depth depth_of(const std::array<double, k_most_disc_links>& angle_rad) const {
        Depth deepest;
        const auto capsules = chain_capsules(chain_, angle_rad);
        for (std::size_t i = 0; i < chain_.link_count; ++i) {
            const SunkCapsule sunk = find_sunk(capsules[i], meshes_);
            double depth_m = sunk.depth_m;
            if (sunk.crossed_at) {
                depth_m += (1.0 - *sunk.crossed_at) * chain_.length_m[i];
                for (std::size_t rest = i + 1; rest < chain_.link_count; ++rest) {
                    depth_m += chain_.length_m[rest];
                }
            }
            if (depth_m > deepest.depth_m) {
                deepest = {depth_m, i};
            }
            if (sunk.crossed_at) {
                break;
            }
        }
        return deepest;
    }

    // Opens the hinges up to the deepest link, step by step, as far as that helps.
    void open() {
        std::array<double, k_most_disc_links> angle_rad = fit_.angle_rad;
        Depth depth = depth_of(angle_rad);
        for (std::int32_t step = 0; step < settings_.open_steps; ++step) {
            for (std::size_t i = 0; i <= depth.link; ++i) {
                angle_rad[i] = std::max(angle_rad[i] - settings_.open_step_rad, chain_.open_rad[i]);
            }
            depth = depth_of(angle_rad);
            if (depth.depth_m < fit_.depth_m) {
                fit_.angle_rad = angle_rad;
                fit_.depth_m = depth.depth_m;
                fit_.fallback = ChainFallback::opened;
            }
            if (depth.depth_m <= settings_.open_depth_m) {
                break;
            }
        }
    }

    void relax() {
        fit_.angle_rad = chain_.relaxed_rad;
        fit_.depth_m = depth_of(fit_.angle_rad).depth_m;
        fit_.fallback = ChainFallback::relaxed;
    }

    static constexpr double k_detail_apart_m = 0.02;  // the search detail never errs so much

    const HingeChain& chain_;
    const DiscChain flat_;
    std::span<const PlacedMesh> meshes_;
    const ChainFitSettings& settings_;
    ChainFitScratch& scratch_;
    ChainFit fit_;
};

}  // namespace

std::array<Capsule, k_most_disc_links> chain_capsules(
    const HingeChain& chain, const std::array<double, k_most_disc_links>& angle_rad) {
    std::array<Capsule, k_most_disc_links> capsules;
    Pose at = chain.base;
    for (std::size_t i = 0; i < chain.link_count; ++i) {
        at.rotation = at.rotation * rotation_about(-Vec3::UnitX(), angle_rad[i]);
        const Vec3 end = at.position + chain.length_m[i] * along_link(at);
        capsules[i] = {{at.position, end}, chain.radius_m[i]};
        at.position = end;
    }
    return capsules;
}

SunkCapsule find_sunk(const Capsule& capsule, std::span<const PlacedMesh> meshes) {
    double nearest_m = capsule.radius_m;
    SunkCapsule sunk;
    for (const PlacedMesh& placed : meshes) {
        const std::array<Vec3, 2> ends = {inverse_transform_point(placed.pose, capsule.ends[0]),
                                          inverse_transform_point(placed.pose, capsule.ends[1])};
        const SurfaceGraph& surface = placed.mesh->contact;
        const TriangleBvh& bvh = placed.mesh->contact_bvh;
        const double length_m = (ends[1] - ends[0]).norm();
        const Vec3 low = ends[0].cwiseMin(ends[1]) - bvh.origin();
        const Vec3 high = ends[0].cwiseMax(ends[1]) - bvh.origin();
        bvh.visit_boxes(
            [&](const Vec3& box_low, const Vec3& box_high) {
                return (box_low - high).cwiseMax(low - box_high).maxCoeff() <= nearest_m;
            },
            [&](std::uint32_t triangle) {
                const auto& [a, b, c] = surface.triangles[triangle];
                const Corners corners = {surface.positions[a], surface.positions[b],
                                         surface.positions[c]};
                const double height_0 = surface.normals[triangle].dot(ends[0] - corners[0]);
                const double height_1 = surface.normals[triangle].dot(ends[1] - corners[0]);
                if (std::min(height_0, height_1) > nearest_m ||
                    std::max(height_0, height_1) < -nearest_m ||
                    least_distance(ends, corners) > nearest_m) {
                    return;
                }
                const SegmentTriangle found = nearest_between(ends, corners);
                nearest_m = std::min(nearest_m, found.distance_m);
                if (found.distance_m == 0.0 && length_m > 0.0) {
                    const double share = (found.on_segment - ends[0]).norm() / length_m;
                    sunk.crossed_at = std::min(sunk.crossed_at.value_or(1.0), share);
                }
            });
    }
    sunk.depth_m = capsule.radius_m - nearest_m;
    return sunk;
}

ChainFit fit_chain(const HingeChain& chain, std::span<const PlacedMesh> meshes,
                   const ChainSeed& seed, const ChainFitSettings& settings,
                   ChainFitScratch& scratch) {
    return ChainFitter(chain, meshes, settings, scratch).run(seed);
}

}  // namespace handhold
