#pragma once

#include <array>

#include "components/body_tuning.hpp"
#include "components/spine.hpp"
#include "engine/math/math.hpp"
#include "engine/math/scalar_rotation.hpp"

// In zero-G, the trunk of a player hangs from the gripping hands. Below a head that tilts, it stays
// upright as far as a neck bends.
namespace handhold {

// Advances BodyPull by one tick. `hands`: BodyPull::hands at the tick's time. The pull follows
// `hands` times SpineTuning::hang, shortened from its length p to p / sqrt(1 + p^2), without a jump
// of its velocity and without overshoot.
void follow_pull(const Vec3& hands, double tick_s, const SpineTuning& tuning, BodyPull& pull);

// Bend of the trunk: the shown chest turns about its X axis first, then each link of the spine
// turns against the link above.
struct TrunkLean {
    double chest_rad = 0.0;                      // turn about the chest's X axis
    std::array<Vec3, k_spine_links> rest_above;  // rest directions in the frames of the links above
};
inline constexpr double k_whole_lean_rad = 80.0 / 180.0 * k_pi;
inline constexpr double k_no_lean_rad = 130.0 / 180.0 * k_pi;

// `pull_cs`: BodyPull::now in the chest's axes, of length p < 1 at the angle a from +Y. The trunk
// turns by the angle a * p from the chest's -Y towards the opposite of the pull: not at all without
// a pull, and nearly all the way for a strong one. From a = k_whole_lean_rad on the bend fades, and
// is zero from k_no_lean_rad on: hands below the chest push rather than pull, and no trunk folds
// onto itself. `upright_rad`: upright_turn; fades as the pull grows.
TrunkLean lean_of(const Vec3& pull_cs, const Vec3& upright_rad = Vec3::Zero());

// Turn of the trunk below the chest back to upright: a rotation vector in the chest's axes, y = 0.
// The chest is estimated to lean with the head. From the head alone it is unknown whether the neck
// or the trunk bends. A lean that a neck can cause is taken as the neck's, and only the excess
// tilts the trunk. `up_cs`: the play space's up in the chest's axes, a unit vector. `lying`:
// ArmEstimate::lying; a trunk that lies is not turned.
Vec3 upright_turn(const Vec3& up_cs, double lying);

// Where trunk and legs point without a pull and without surfaces: a unit vector, play space.
Vec3 free_body(const Quat& chest_ps, double lying);

// Pull (BodyPull::hands) of a surface that trunk and thighs would meet if they hung along
// `free_ps`, a unit vector: the body swings out to lie along the surface, because legs that rise
// out of it would end beside the head. `contact`: of SpineMemory, k_free_body. `length_m`: of trunk
// and thighs. `back_ps`: backwards in the chest's axes; the body swings this way if the surface
// prefers no other.
Vec3 surface_pull(const BodyContact& contact, const Vec3& free_ps, const Vec3& back_ps,
                  double length_m);

inline Quat leaning_chest(const Quat& chest, const TrunkLean& lean) {
    return lean.chest_rad == 0.0 ? chest
                                 : product(chest, rotation_about(Vec3::UnitX(), lean.chest_rad));
}

}  // namespace handhold
