#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/solver/model/island_view.hpp"
#include "engine/solver/newton/regularisation.hpp"
#include "engine/solver/packed/triad_kernels.hpp"
#include "engine/solver/packed/triad_plan.hpp"
#include "engine/solver/sparse/plan_cache.hpp"

namespace handhold {

// The rows of an island that all hold, always, in threes: ropes, chains, rings, things in hands.
// RowSystem's equations in a fraction of its instructions: every block is three by three, and
// bodies and rows are packed copies, four bodies side by side, that are read in once a solve.
class TriadSystem {
  public:
    explicit TriadSystem(const TriadKernels& kernels = triad_kernels()) : kernels_(&kernels) {}

    // Takes over the bodies of the island and its blocks that take part. False where one of them
    // may let go, slide or stop, or where so many meet in one body that RowSystem's hubs serve
    // better: nothing else may be called then. `touch_m`: contacts farther apart do not count; a
    // solve of positions may bring any of them near.
    bool load(const IslandView& island, double touch_m = std::numeric_limits<double>::infinity());
    // Takes over the velocities alone, where it still has all the rest: `load` and `store_poses`
    // came before, in the same revision of the graph, and masses and poses are as they were. False
    // where it has not, or where contacts might count by now.
    bool resume(const IslandView& island);
    // Writes the bodies back, those that something moves: poses; or velocities, and the impulses
    // of the island's blocks that take part.
    void store_poses(const IslandView& island) const;
    void store_velocities(const IslandView& island) const;

    // What the triads lack at the present poses: `worst_residual` metres. Angles at
    // k_angle_lever_m.
    void evaluate(const IslandView& island);
    // Where they have not been evaluated since they moved.
    void evaluate_if_moved(const IslandView& island);
    // The same of the velocities, m/s, against what drives the hands; at the arms of `evaluate`.
    void evaluate_velocities(const IslandView& island);
    double worst_residual();
    double worst_drive_residual() const;  // of the hands' alone
    JointError worst_joints() const;      // of all others: points and rotations

    // From here on only what is near to bodies that the last solve moved by this much or more, or
    // turned by as much at k_angle_lever_m: a long rope is busy where it is pulled, and at rest
    // elsewhere. Call where the errors are those of the present poses.
    void restrict_to_active(double min_move_m);
    // All of them, as after `load` and `resume`.
    void activate_all_rows();
    // Rows of strands, four bodies each, that steps move and that there are.
    std::size_t active_rows() const;
    std::size_t strand_rows() const;

    void clear_stiffness() { has_stiffness_ = false; }
    // From the last multipliers and the present arms.
    void gather_stiffness();
    // J W J^T + diag(alpha) at the present arms, and its factor. Alpha as `regularise` has it.
    void factorise(const Regularisation& regularisation, double factor);
    // Multipliers against the values with the last factor, and how they move the bodies.
    void solve();
    // Of the last solve: metres, radians.
    double longest_move() const { return longest_move_; }
    double largest_rotation() const { return largest_rotation_; }

    // Moves the bodies by so much of the last solve. Returns the longest step, metres.
    double apply_moves(double scale);
    // Adds the last solve to the velocities and impulses here.
    void apply_impulses();

  private:
    struct Triad {
        std::uint32_t block = 0;  // into the graph's blocks
        bool is_angular = false;  // rotation on rotation
        bool is_drive = false;
    };
    // An end at a body that nothing moves. Where a strand begins with it, a still body at its point
    // stands for it among the four; else it has no place there.
    struct Anchor {
        std::uint32_t end = 0;   // 2 * triad + side
        std::uint32_t body = 0;  // into the graph's bodies
        Vec3 point_bs;
        std::uint32_t rest_end = k_no_slot;
        std::uint32_t place = k_no_slot;
    };

    void read_bodies(const IslandView& island);
    void pack_bodies(const IslandView& island);
    void pack_velocities(const IslandView& island);
    bool add(const IslandView& island, std::uint32_t index, bool is_angular);
    void resize(std::size_t triads);
    void plan_nodes();
    void place_anchors();
    void clear_impulses();
    void load_ends();
    Bodies4& four_of(std::uint32_t place) { return bodies_[place / TriadPlan::k_lanes]; }
    const Bodies4& four_of(std::uint32_t place) const {
        return bodies_[place / TriadPlan::k_lanes];
    }
    bool matches_loaded_state(const IslandView& island) const;
    Quat rotation_at(const IslandView& island, std::uint32_t end) const;
    double drive_scale() const;
    RowWindow active_window(const TriadPlan::StrandPack& strand_pack, const RowWindow& window,
                            double min_move_m) const;

    // Made for each call: it points into this.
    TriadArrays arrays();

    const TriadKernels* kernels_;
    std::uint64_t revision_ = 0;               // of the graph that `resume` may go on with; 0: none
    std::vector<std::uint32_t> body_indices_;  // by slot: into the graph's bodies
    std::size_t triad_count_ = 0;
    std::vector<Triad> triads_;
    std::vector<Anchor> anchors_;
    std::vector<TriadVector> points_;    // by end: times the sign; the sign
    std::vector<TriadVector> impulses_;  // by triad of the rest: sums of lambdas

    // What `arrays` is made of.
    std::vector<Bodies4> bodies_;
    std::vector<Ends4> body_ends_;
    std::vector<WideSymmetric> stiffness_;
    std::vector<Links4> links_;
    std::vector<Wide3> multipliers_;
    std::vector<Strands4> strands_;
    std::vector<TriadVector> ends_;
    std::vector<TriadVector> values_;
    std::vector<TriadVector> lambdas_;
    std::vector<std::uint8_t> is_drive_;
    std::vector<Rows3> blocks_;
    std::vector<Rows3> inverses_;
    std::vector<TriadVector> unknowns_;
    std::vector<RowWindow> windows_;  // by braid

    PlanCache<TriadPlan> plans_;
    std::vector<RowNode> nodes_;
    std::vector<std::uint8_t> may_turn_;  // by slot
    std::vector<std::uint8_t> uses_;      // by slot: how many triads meet in it
    double drive_scale_ = 0.0;            // of the last factor of all rows
    double longest_move_ = 0.0;
    double largest_rotation_ = 0.0;
    bool is_evaluated_ = false;  // at the present poses
    bool is_restricted_ = false;
    bool has_stiffness_ = false;
    bool has_drive_rows_ = false;
    bool has_turn_ = false;
};

}  // namespace handhold
