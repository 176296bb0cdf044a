#pragma once

#include <vector>

#include "systems/hand/shared/fit_problem.hpp"
#include "systems/hand/shared/hand_fit.hpp"
#include "systems/hand/shared/hand_spheres.hpp"
#include "systems/hand/shared/hand_unknowns.hpp"

namespace handhold {

// Share of a digit's range of opposition that its first hinge leaves: all of a thumb's; a finger's
// spread has less the more the knuckle is bent.
double opposition_share(const FingerRig& finger, double knuckle_rad);

// The objective of hand_fit.hpp for one hand: its terms and inequalities, linearised at one pose.
// Keeps references to its constructor's arguments.
class HandObjective {
  public:
    // `rows` and `terms`: see FitProblem.
    HandObjective(const HandSurroundings& hand, const GripSurface& surface, const HandFitGoal& goal,
                  const PalmTuning& tuning, std::vector<PenaltyRow>& rows, FitTerms* terms)
        : hand_(hand),
          rig_(*hand.rig),
          surface_(surface),
          goal_(goal),
          tuning_(tuning),
          layout_(rig_),
          spheres_(hand, surface, goal.is_clear),
          problem_(layout_.end(), terms, rows) {}

    // Builds the problem at `pose` and returns its cost there.
    double evaluate(const HandPose& pose);
    // Solves the problem that evaluate() built and returns the change of the unknowns. Call it once
    // per evaluate(). goal.max_flex_rad and what the goal fixes are penalties here, so the result
    // may exceed them slightly: the caller clamps it.
    Unknowns solve();
    // The same for the terms of the thumb at index `t` alone. Gaps of the rest of the hand are
    // not updated. Precondition: evaluate() was called.
    double evaluate_thumb(const HandPose& pose, std::size_t t);
    Unknowns solve_thumb(std::size_t t);

    const HandUnknowns& layout() const { return layout_; }
    // These three are as of the last evaluate(). center(): of the palm, in the body's frame.
    const Vec3& center() const { return center_; }
    double gap_m(std::size_t f) const { return spheres_.gap_m(f); }
    double penetration_m() const { return spheres_.penetration_m(); }

  private:
    void begin(const HandPose& pose);  // all but the spheres' gaps
    void place_links();
    void add_wrist();
    void add_digit(std::size_t f);
    void add_step_limits(int first, int end);
    void add_hinges(std::size_t f);
    // Adds the couple term: the last hinge bends with its parent.
    void add_coupling(std::size_t f);
    // Adds the roll term and the bend and claw inequalities of a finger.
    void add_shape(std::size_t f);
    void add_opposition(std::size_t f);  // a thumb's
    void add_spread(std::size_t f);
    // Adds the touch and tip terms, which pull a digit's nearest sphere and its tip to the surface.
    // Spheres at knuckles are not pulled.
    void add_attraction(std::size_t f);
    void add_thumb_tip(std::size_t f, const HandSphere& tip);
    void add_palm_touch();
    // Adds pull / 2 * gap^2 / (1 + gap^2 / g^2), as the square that has the same slope here
    // (iteratively reweighted least squares). A gap of 0 is pulled too, so that the wrist does not
    // leave it.
    void add_pull(const FitPart& part, double pull, const HandSphere& sphere);
    // Adds the terms between neighbours: fingers next to each other in the rig, not counting
    // thumbs.
    void add_neighbours();
    // The weight s of hand_fit.hpp for one finger: 0 in contact, towards 1 far from all surfaces.
    double free_share(std::size_t f) const;
    // Adds fan, alike and apart. A finger whose angles are fixed, like a pointing one, has only the
    // apart inequalities with its neighbours.
    void add_neighbour(std::size_t a, std::size_t b);
    void add_alike(std::size_t a, std::size_t b);
    // Adds the inequality that keeps neighbours' sides out of each other.
    void add_converging(std::size_t a, std::size_t b);
    // Sum of the pose's curls, weighted by `slope`.
    double along(const Unknowns& slope) const;
    void add_contacts(std::span<const HandSphere> spheres);
    // Adds the inequalities that keep the thumb out of the fingers.
    void add_digit_gaps();
    void add_palm_limits();
    // Returns the change of a sphere's gap per unit of each unknown.
    Unknowns slope_of(const HandSphere& sphere) const;
    // Adds how far a point of a link moves along `away` per unit of the digit's angles.
    void add_digit_slope(std::size_t f, std::size_t link, const Vec3& point, const Vec3& away,
                         Unknowns& slope) const;
    void hold_fixed_unknowns();

    const HandSurroundings& hand_;
    const HandRig& rig_;
    const GripSurface& surface_;
    const HandFitGoal& goal_;
    const PalmTuning& tuning_;
    const HandUnknowns layout_;
    HandPose pose_;
    HandSpheres spheres_;
    Vec3 center_ = Vec3::Zero();
    HandLinkFrames frames_;
    // Axes of the hinges and of the oppositions, unit, in the body's frame.
    std::array<std::array<Vec3, k_max_links>, k_finger_count> hinge_axis_;
    std::array<Vec3, k_finger_count> opposition_axis_;
    FitProblem problem_;
};

}  // namespace handhold
