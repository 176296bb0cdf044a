#include "engine/geometry/chain_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace handhold {
namespace {

// The disc (disc_trace.hpp) of cutting plane `plane`, in the mesh's frame.
Disc disc_of(const HingeChain& chain, const Pose& mesh, const ChainFitSettings& settings,
             std::size_t plane) {
    const Pose base = inverse(mesh) * chain.base;
    Disc disc;
    disc.x_axis = base.rotation * -Vec3::UnitZ();
    disc.y_axis = base.rotation * -Vec3::UnitY();
    disc.normal = base.rotation * -Vec3::UnitX();
    disc.center = base.position + plane_offset_m(chain, settings.plane_offset, plane) * disc.normal;
    disc.radius_m = reach_m(chain);
    disc.plane = static_cast<std::uint32_t>(plane);
    return disc;
}

bool has_start(const ChainSeed& seed) {
    return seed[0].triangle != k_no_triangle || seed[1].triangle != k_no_triangle;
}

// Closes the chain over the cuts that the graph searches find; if these do not suffice, over all
// cuts.
class ChainFitter {
  public:
    ChainFitter(const HingeChain& chain, std::span<const PlacedMesh> meshes,
                const ChainFitSettings& settings, ChainFitScratch& scratch)
        : chain_(chain),
          flat_(flat_chain(chain, settings.plane_offset)),
          meshes_(meshes),
          settings_(settings),
          scratch_(scratch) {}

    ChainFit run(const ChainSeed& seed) {
        gather();
        if (meshes_.empty()) {
            return_to_rest();
            return fit_;
        }
        close_from_open(seed);
        if (fit_.contact_link == DiscClosure::k_none) {
            return_to_rest();
        }
        if (!settings_.depenetrates) {
            fit_.needs_depenetration =
                fit_.depth_m > std::min(settings_.search_depth_m, settings_.open_depth_m);
            return fit_;
        }
        if (fit_.depth_m > settings_.search_depth_m) {
            depenetrate();
        }
        if (fit_.depth_m > settings_.open_depth_m) {
            open();
        }
        return fit_;
    }

  private:
    using Angles = ChainAngles;
    struct CutRange {
        std::ptrdiff_t first = 0;
        std::ptrdiff_t end = 0;
    };

    // Closes over the cuts found by the graph searches. If they do not suffice, uses all cuts in
    // reach.
    void close_from_open(const ChainSeed& seed) {
        bool is_complete = false;
        if (has_start(seed)) {
            is_complete = search_cuts(seed);
            close();
        }
        const bool touches = fit_.contact_link != DiscClosure::k_none;
        if (!is_complete || !touches || fit_.depth_m > settings_.search_depth_m) {
            close_over_all_cuts(touches);
        }
    }

    // Gathers the triangles in reach and cuts them with the planes.
    void gather() {
        // Enough for one chain. On very dense meshes the vectors grow once.
        constexpr std::size_t k_usual_segments = 2048;
        scratch_.cuts.reserve(k_usual_segments);
        scratch_.segments.reserve(k_usual_segments);
        scratch_.disc.pairs.reserve(k_usual_segments);
        scratch_.disc.paired.reserve(k_usual_segments);
        scratch_.disc.bounds.reserve(k_usual_segments / 4);
        ChainReach reach = chain_reach(chain_, lowest(chain_.open_rad, chain_.rest_rad),
                                       highest(chain_.closed_rad, chain_.rest_rad));
        reach.half_width_m = half_width_m(chain_, settings_.plane_offset);
        scratch_.patch.gather(reach, meshes_);
        scratch_.cuts.clear();
        for (std::size_t plane = 0; plane < k_disc_planes; ++plane) {
            const std::size_t first = scratch_.cuts.size();
            const std::size_t of_first_mesh =
                scratch_.patch.cut(plane_offset_m(chain_, settings_.plane_offset, plane),
                                   static_cast<std::uint32_t>(plane), scratch_.cuts);
            own_cuts_[plane] = of_first_mesh;
            other_cuts_[plane] = {static_cast<std::ptrdiff_t>(first + of_first_mesh),
                                  static_cast<std::ptrdiff_t>(scratch_.cuts.size())};
        }
    }

    // True if the searches found a cut in every plane that cuts the first mesh.
    bool search_cuts(const ChainSeed& seed) {
        scratch_.segments.clear();
        bool is_complete = true;
        ChainSeed start = seed;
        GraphPoint contact_start;
        for (std::size_t plane = 0; plane < k_disc_planes; ++plane) {
            const auto [first, end] = other_cuts_[plane];
            scratch_.segments.insert(scratch_.segments.end(), scratch_.cuts.begin() + first,
                                     scratch_.cuts.begin() + end);
            if (own_cuts_[plane] > 0) {
                is_complete = search_cut(plane, start, contact_start) && is_complete;
            }
        }
        return is_complete;
    }

    // Finds the first mesh's cut with one plane. The next plane's search starts at the point found
    // here, because the planes are only millimetres apart.
    bool search_cut(std::size_t plane, ChainSeed& start, GraphPoint& contact_start) {
        const GripMesh& mesh = *meshes_.front().mesh;
        const Disc disc = disc_of(chain_, meshes_.front().pose, settings_, plane);
        const CrossingSearch found = find_crossing(mesh.search, disc, start, scratch_.trace);
        ++fit_.discs;
        fit_.pops += found.pops;
        if (found.triangle == k_no_triangle) {
            return false;
        }
        start = {{{found.triangle, found.point}}};
        walk_contact(mesh, disc, found, contact_start);
        return true;
    }

    // Finds on the contact detail the cut that was found on the search detail, and follows it.
    void walk_contact(const GripMesh& mesh, const Disc& disc, const CrossingSearch& found,
                      GraphPoint& contact_start) {
        if (contact_start.triangle == k_no_triangle) {
            const auto near = mesh.contact_bvh.closest_point(found.point, k_detail_apart_m);
            if (!near) {
                return;
            }
            contact_start = {near->triangle, near->point};
        }
        const CrossingSearch onto =
            find_crossing(mesh.contact, disc, {&contact_start, 1}, scratch_.trace);
        fit_.walked += onto.pops;
        if (onto.triangle == k_no_triangle) {
            return;
        }
        contact_start = {onto.triangle, onto.point};
        fit_.walked +=
            walk_crossing(mesh.contact, disc, onto.triangle, scratch_.trace, scratch_.segments);
    }

    void close() {
        const DiscClosure closure = close_chain(flat_, scratch_.segments, {}, scratch_.disc);
        fit_.contact_link = closure.contact_link;
        set_angles(closure.angle_rad);
    }

    // Makes this pose the fit. If it penetrates, its deepest link counts as touching.
    void stay_at(const Angles& angle_rad, const ChainDepth& depth) {
        fit_.angle_rad = angle_rad;
        fit_.depth_m = depth.depth_m;
        fit_.contact_link =
            depth.depth_m > 0.0 ? static_cast<std::int32_t>(depth.link) : DiscClosure::k_none;
    }

    void set_angles(const Angles& angle_rad) {
        fit_.angle_rad = angle_rad;
        fit_.depth_m = depth_of(angle_rad).depth_m;
    }

    void close_over_all_cuts(bool had_contact) {
        const ChainFit before = fit_;
        scratch_.segments.assign(scratch_.cuts.begin(), scratch_.cuts.end());
        close();
        const bool is_better = !had_contact || fit_.depth_m < before.depth_m;
        if (is_better) {
            fit_.fallback = ChainFallback::all_cuts;
        } else {
            fit_ = before;
        }
    }

    // Best sample poses for a chain that penetrates after closing. A pose is clear if it penetrates
    // at most as deep as evaluate_sample_poses is told.
    struct SamplePoses {
        std::optional<Angles> touching;           // clear and touching, nearest to rest_rad
        std::optional<Angles> clear;              // clear, nearest to rest_rad
        std::optional<Angles> least_penetrating;  // the least penetrating pose, if none is clear
        double min_m = 0.0;                       // depth of least_penetrating
    };

    // Replaces a penetrating pose by a sample pose. A clear pose may exist although closing ended
    // with penetration: the chain may have penetrated from the start, or have closed onto a surface
    // that it only grazes. Prefers a clear pose that touches. If a clear pose touches nothing,
    // closes it again until it does. If no pose is clear, takes the one that penetrates least.
    void depenetrate() {
        const double clear_m = std::min(settings_.open_depth_m, fit_.depth_m);
        const Angles penetrating_rad = fit_.angle_rad;
        const SamplePoses poses = evaluate_sample_poses(clear_m);
        if (poses.touching) {
            stay_at_sample(*poses.touching);
        } else if (poses.clear) {
            const bool is_clear = depth_of(chain_.rest_rad).depth_m <= clear_m;
            stay_at_sample(is_clear ? chain_.rest_rad : *poses.clear);
            if (fit_.depth_m <= 0.0) {
                touch_between(fit_.angle_rad, penetrating_rad, depth_of(penetrating_rad).link);
            }
        } else if (poses.least_penetrating) {
            stay_at_sample(*poses.least_penetrating);
        }
    }

    SamplePoses evaluate_sample_poses(double clear_m) {
        SamplePoses poses;
        poses.min_m = fit_.depth_m;
        ChainDepths depths(chain_, scratch_.patch);
        for (int first = 0; first < k_pose_samples; ++first) {
            for (int others = 0; others < k_pose_samples; ++others) {
                const Angles angle_rad =
                    sample_pose(static_cast<double>(first) / k_pose_samples,
                                static_cast<double>(others) / (k_pose_samples - 1));
                const double depth_m = depths.depth_m(angle_rad, std::max(poses.min_m, clear_m));
                if (depth_m <= clear_m && depth_m < fit_.depth_m) {
                    keep_if_nearer(angle_rad, poses.clear);
                    // The open pose is no candidate, because closing it led to the penetration.
                    const bool is_straight = angle_rad == chain_.open_rad;
                    if (depth_m > 0.0 && !is_straight) {
                        keep_if_nearer(angle_rad, poses.touching);
                    }
                } else if (depth_m < poses.min_m) {
                    poses.min_m = depth_m;
                    poses.least_penetrating = angle_rad;
                }
            }
        }
        return poses;
    }

    void stay_at_sample(const Angles& angle_rad) {
        stay_at(angle_rad, depth_of(angle_rad));
        fit_.fallback = ChainFallback::sample_pose;
    }

    void keep_if_nearer(const Angles& angle_rad, std::optional<Angles>& kept) const {
        if (!kept || distance_to_rest_rad(angle_rad) < distance_to_rest_rad(*kept)) {
            kept = angle_rad;
        }
    }

    double distance_to_rest_rad(const Angles& angle_rad) const {
        double off_rad = 0.0;
        for (std::size_t i = 0; i < chain_.link_count; ++i) {
            off_rad += std::abs(angle_rad[i] - chain_.rest_rad[i]);
        }
        return off_rad;
    }

    Angles sample_pose(double first, double others) const {
        Angles angle_rad = {};
        for (std::size_t i = 0; i < chain_.link_count; ++i) {
            angle_rad[i] = chain_.open_rad[i] +
                           (i == 0 ? first : others) * (chain_.closed_rad[i] - chain_.open_rad[i]);
        }
        return angle_rad;
    }

    ChainDepth depth_of(const Angles& angle_rad) const {
        return chain_depth(chain_, angle_rad, scratch_.patch);
    }

    // Opens the hinges up to the deepest link step by step while this reduces the penetration. If
    // the chain becomes clear, closes it again until it just touches.
    void open() {
        Angles angle_rad = fit_.angle_rad;
        ChainDepth depth = depth_of(angle_rad);
        for (std::int32_t step = 0; step < settings_.open_steps; ++step) {
            const Angles before_rad = angle_rad;
            const std::size_t before_link = depth.link;
            for (std::size_t i = 0; i <= before_link; ++i) {
                angle_rad[i] = std::max(angle_rad[i] - settings_.open_step_rad, chain_.open_rad[i]);
            }
            if (angle_rad == before_rad) {
                break;  // all hinges up to the deepest link are fully open
            }
            depth = depth_of(angle_rad);
            if (depth.depth_m < fit_.depth_m) {
                stay_at(angle_rad, depth);
                fit_.fallback = ChainFallback::opened;
            }
            if (depth.depth_m <= settings_.open_depth_m) {
                if (depth.depth_m <= 0.0) {
                    touch_between(angle_rad, before_rad, before_link);
                }
                break;
            }
        }
    }

    // Bisects between a clear and a penetrating pose. Stops at a pose that just touches, or at the
    // last clear one.
    void touch_between(Angles clear_rad, Angles penetrating_rad, std::size_t penetrating_link) {
        constexpr int k_halvings = 7;
        constexpr double k_touches_m = 2e-4;
        ChainDepth depth;
        for (int i = 0; i < k_halvings && depth.depth_m <= 0.0; ++i) {
            Angles middle_rad = {};
            for (std::size_t k = 0; k < chain_.link_count; ++k) {
                middle_rad[k] = 0.5 * (clear_rad[k] + penetrating_rad[k]);
            }
            const ChainDepth middle = depth_of(middle_rad);
            penetrating_link = middle.depth_m > 0.0 ? middle.link : penetrating_link;
            if (middle.depth_m <= k_touches_m) {
                clear_rad = middle_rad;
                depth = middle;
            } else {
                penetrating_rad = middle_rad;
            }
        }
        fit_.angle_rad = clear_rad;
        fit_.depth_m = depth.depth_m;
        fit_.contact_link = static_cast<std::int32_t>(penetrating_link);
    }

    void return_to_rest() {
        set_angles(chain_.rest_rad);
        fit_.fallback = ChainFallback::rest_pose;
    }

    // Number of sampled values of each variable. The variables are the first hinge's angle and the
    // common angle of the others.
    static constexpr int k_pose_samples = 5;
    // Upper bound on the distance between the search detail and the contact detail.
    static constexpr double k_detail_apart_m = 0.02;

    const HingeChain& chain_;
    const DiscChain flat_;
    std::span<const PlacedMesh> meshes_;
    const ChainFitSettings& settings_;
    ChainFitScratch& scratch_;
    // Per plane: the number of the first mesh's cuts, and the range of the other meshes' cuts in
    // scratch_.cuts.
    std::array<std::size_t, k_disc_planes> own_cuts_ = {};
    std::array<CutRange, k_disc_planes> other_cuts_ = {};
    ChainFit fit_;
};

}  // namespace

CapsulePenetration find_penetration(const Capsule& capsule, std::span<const PlacedMesh> meshes) {
    const Vec3 along = capsule.ends[1] - capsule.ends[0];
    const double length_m = along.norm();
    ChainReach reach;
    reach.base.position = capsule.ends[0];
    reach.base.rotation =
        length_m > 0.0 ? rotation_between(-Vec3::UnitZ(), along / length_m) : Quat::Identity();
    reach.radius_m = length_m + capsule.radius_m;
    reach.half_width_m = capsule.radius_m;
    ChainPatch patch;
    patch.gather(reach, meshes);
    return patch.find_penetration({Vec2::Zero(), Vec2(length_m, 0.0)}, capsule.radius_m, 0);
}

ChainFit fit_chain(const HingeChain& chain, std::span<const PlacedMesh> meshes,
                   const ChainSeed& seed, const ChainFitSettings& settings,
                   ChainFitScratch& scratch) {
    return ChainFitter(chain, meshes, settings, scratch).run(seed);
}

}  // namespace handhold
