// Solver, packed: islands whose rows are all bilateral: ropes, chains, rings, driven bodies.
//
// Solves the same equations as RowSystem (newton/active_set.hpp),
//   K lambda = -C,   K = J W J^T + R,   dx = W J^T lambda
//   C       residuals, metres (positions) or m/s (velocities); angles times k_angle_lever_m
//   J       dC/dx, one row per residual, six columns per body (translation, rotation vector)
//   W       inverse masses and world inverse inertias, 0 for bodies that a phase holds still
//   R       diagonal regularisation (model/regularisation.hpp)
//   lambda  multipliers: impulses, or displacements times mass
//   dx      translations and rotation vectors of the bodies
// but with 3x3 blocks only, and for four bodies at a time.
//
// Terms
//   triad        three rows, one per world axis: point on point (ball, drive_point), or rotation on
//                rotation (drive_direction). A weld is two triads. One 3x3 block row of K.
//   end          one side of a triad: 2 * triad + 0 (body a) or + 1 (body b)
//   slot         index of a body within its island, by persistent id
//   lane         one of the four doubles of a vector register (Double4)
//   place        where a body is packed: 4 * group + lane
//   link         point triad of a joint that shares each of its bodies with at most one other triad
//   run          sequence of links, each of which has a body in common with the next
//   separator    one or two links that cut a run
//   strand       part of a run between two separators
//   strand pack  four strands of equal length, one per lane
//   rest         all triads that are in no strand: separators, drives, welds, branches, short runs
//   anchor       an end at an immovable body
//
// Elimination order (nested dissection of each run, then minimum degree)
//   run:     end - - lane 0 - -> S - - lane 1 - -> S <- - lane 2 - - S <- - lane 3 - - end
//   1. Strands. Step k eliminates link k of all four strands. Strands are coupled only through
//      separators (S), so the lanes need no exchange. The coupling with the triad `before` a strand
//      fades from link to link. It is dropped once it is negligible.
//   2. The rest, in the order of an EliminationPlan, block by block.
//   Substitution runs through 1 and 2 in this order, then back in the opposite order.
//
// Layout of a strand pack: row r holds four bodies, step k connects rows k and k + 1
//                       lane 0   lane 1   lane 2   lane 3
//   bodies[row + 0]     body     body     body     body      Bodies4 (structure of arrays)
//   links[step + 0]     link     link     link     link      Links4: residual, factor row, impulse
//   bodies[row + 1]     body     body     body     body
//   links[step + 1]     link     link     link     link
//   ...
//   bodies[row + length]
//   body_ends[2 * r], body_ends[2 * r + 1]: row r's ends of the link before and of the link after
//   multipliers[bound + 0 .. length + 1]: lambda of `before`, of each step, of `after`
//   Bodies of the rest follow in groups of four, with any number of ends each (TriadPlan::Group).
//
// Determinism: order and lane of every body and triad follow from the topology of the sorted graph.
// Sums within a lane have a fixed order; AVX2 and portable kernels give the same bits.
// Limits: at most k_hub_nodes triads per body; no unilateral, friction, motor or limit row in use.
// Otherwise `load` returns false and the island is solved row by row.

#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/solver/model/island_view.hpp"
#include "engine/solver/model/regularisation.hpp"
#include "engine/solver/packed/triad_kernels.hpp"
#include "engine/solver/packed/triad_plan.hpp"
#include "engine/solver/sparse/plan_cache.hpp"

namespace handhold {

// Solves RowSystem's equations for an island whose rows are all bilateral triads, with a fraction
// of the instructions. Works on packed copies of bodies and rows, loaded once per solve.
class TriadSystem {
  public:
    explicit TriadSystem(const TriadKernels& kernels = triad_kernels()) : kernels_(&kernels) {}

    // Loads the island's bodies and the blocks that take part. Returns false if a row may be
    // unilateral, slide or stop, or if more than k_hub_nodes triads share a body; then no other
    // function may be called. Contacts with a separation of at least `touch_m` are ignored. The
    // position solve uses infinity, because any contact may close.
    bool load(const IslandView& island, double touch_m = std::numeric_limits<double>::infinity());
    // Loads only the velocities; everything else stays as loaded before. Returns false unless
    // `load` and `store_poses` were called in the same revision of the graph, masses and poses are
    // unchanged and there are no contacts.
    bool resume(const IslandView& island);
    // store_poses writes the poses of the movable bodies. store_velocities writes their velocities,
    // and the impulses of the blocks that take part.
    void store_poses(const IslandView& island) const;
    void store_velocities(const IslandView& island) const;

    // Computes the residuals at the current poses, metres; angles times k_angle_lever_m.
    void evaluate(const IslandView& island);
    // Calls `evaluate` unless the bodies have not moved since its last call.
    void evaluate_if_moved(const IslandView& island);
    // Computes the velocity residuals, m/s, with the arms of the last `evaluate`. They include the
    // velocities of the drives' targets.
    void evaluate_velocities(const IslandView& island);
    double worst_residual();
    double worst_drive_residual() const;  // maximum over drives only
    JointError worst_joints() const;      // maximum over all other triads

    // Restricts the following steps to the rows near bodies that the last solve moved by at least
    // `min_move_m` (rotations count times k_angle_lever_m). A long rope moves where it is pulled
    // and is at rest elsewhere. Call only if the residuals are those of the current poses.
    void restrict_to_active(double min_move_m);
    // Undoes the restriction; `load` and `resume` do so too.
    void activate_all_rows();
    // Rows of strand packs (four bodies each): active, and in total.
    std::size_t active_rows() const;
    std::size_t strand_rows() const;

    void clear_stiffness() { has_stiffness_ = false; }
    // Computes geometric stiffness from the last multipliers and the current arms.
    void gather_stiffness();
    // Factorises J W J^T + R at the current arms; R as in model/regularisation.hpp.
    void factorise(const Regularisation& regularisation, double factor);
    // Solves for the multipliers and the bodies' moves with the last factor.
    void solve();
    // Longest translation and largest rotation of the last solve; metres, radians.
    double longest_move() const { return longest_move_; }
    double largest_rotation() const { return largest_rotation_; }

    // Moves the bodies by `scale` times the last solve. Returns the longest move, metres.
    double apply_moves(double scale);
    // Adds the last solve to the velocities and impulses.
    void apply_impulses();

  private:
    struct Triad {
        std::uint32_t block = 0;  // index into the graph's blocks
        bool is_angular = false;  // rotation on rotation, else point on point
        bool is_drive = false;
    };
    // An end at an immovable body. If the end is the first of a strand, `place` is where the body
    // that replaces the immovable one is packed (body_at). Otherwise `rest_end` is the end in the
    // numbering of TriadPlan.
    struct Anchor {
        std::uint32_t end = 0;   // 2 * triad + side
        std::uint32_t body = 0;  // index into the graph's bodies
        Vec3 point_bs;
        std::uint32_t rest_end = k_no_slot;
        std::uint32_t place = k_no_slot;
    };

    static double sign_of(std::uint32_t end) { return end % 2 == 0 ? 1.0 : -1.0; }
    void read_bodies(const IslandView& island);
    void pack_bodies(const IslandView& island);
    void pack_velocities(const IslandView& island);
    bool add(const IslandView& island, std::uint32_t index, bool is_angular);
    void resize(std::size_t triads);
    void plan_nodes();
    void place_anchors();
    void clear_impulses();
    void load_ends();
    Bodies4& group_of(std::uint32_t place) { return bodies_[place / TriadPlan::k_lanes]; }
    const Bodies4& group_of(std::uint32_t place) const {
        return bodies_[place / TriadPlan::k_lanes];
    }
    bool matches_loaded_state(const IslandView& island) const;
    Quat rotation_at(const IslandView& island, std::uint32_t end) const;
    double mean_diagonal() const;
    RowWindow active_window(const TriadPlan::StrandPack& strand_pack, const RowWindow& window,
                            double min_move_m) const;

    // Spans into this object's arrays; made for each kernel call.
    TriadArrays arrays();

    const TriadKernels* kernels_;
    std::uint64_t revision_ = 0;  // revision of the graph loaded last; 0: `resume` is not possible
    std::vector<std::uint32_t> body_indices_;  // index of each slot in the graph's bodies
    std::size_t triad_count_ = 0;
    std::vector<Triad> triads_;
    std::vector<Anchor> anchors_;
    // one per end; x, y, z: anchor point times the sign; w: the sign
    std::vector<TriadVector> points_;
    std::vector<TriadVector> impulses_;  // sum of the lambdas of each triad outside strands

    // Storage of `arrays`; documented at TriadArrays.
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
    std::vector<RowWindow> windows_;  // indexed by strand pack

    PlanCache<TriadPlan> plans_;
    std::vector<RowNode> nodes_;
    std::vector<std::uint8_t> may_turn_;  // indexed by slot
    std::vector<std::uint8_t> uses_;      // number of triads at each slot's body
    DriveScale drive_scale_;              // updated by every unrestricted factorisation
    double longest_move_ = 0.0;
    double largest_rotation_ = 0.0;
    bool is_evaluated_ = false;  // residuals are those of the current poses
    bool is_restricted_ = false;
    bool has_stiffness_ = false;
    bool has_drive_rows_ = false;
    bool has_turn_ = false;
};

}  // namespace handhold
