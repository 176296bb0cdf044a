#include "systems/snapshot/snapshot_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "components/body_clip_state.hpp"
#include "systems/snapshot/snapshot_schema.hpp"

namespace handhold {
namespace {

// Latest clock time. Beyond it, rounding would swallow part of a frame's length.
constexpr double k_max_time_s = 1e9;
constexpr double k_min_bone_ratio = 0.01;

bool is_duration(double seconds) { return seconds >= 1e-3 && seconds <= k_max_time_s; }

// Keeps the first violation; later checks have no effect.
class BreachFinder {
  public:
    BreachFinder(const World& world, const ShapeLibrary& shapes) : w_(world), shapes_(shapes) {}

    std::optional<WorldBreach> find() {
        check_globals();
        check_ids();
        if (!breach_) {  // all owners have ids from here on
            check_bodies();
            check_movers();
            check_joints();
            check_players();
            check_hands();
            check_colliders();
        }
        return breach_;
    }

  private:
    void check(bool is_good, const char* column, Entity owner, const char* field,
               const char* expected) {
        if (!is_good && !breach_) {
            const PersistentId* const id = w_.persistent_id.find(owner);
            breach_ = WorldBreach{std::string(column) + "[" +
                                      text_of(id != nullptr ? *id : PersistentId{}) + "]" + field,
                                  std::string("expected ") + expected};
        }
    }

    // Every owner of an element in `column` must have one in `required`.
    template <typename A, typename B>
    void require(const char* name, const Column<A>& column, const char* required_name,
                 const Column<B>& required) {
        for (const Entity owner : column.owners()) {
            if (!required.contains(owner)) {
                const std::string expected =
                    std::string("an element in ") + required_name + " of the same owner";
                check(false, name, owner, "", expected.c_str());
            }
        }
    }
    // Both columns must have the same owners.
    template <typename A, typename B>
    void require_both(const char* a_name, const Column<A>& a, const char* b_name,
                      const Column<B>& b) {
        require(a_name, a, b_name, b);
        require(b_name, b, a_name, a);
    }

    void check_globals() {
        if (!(std::abs(w_.clock.t_s) <= k_max_time_s)) {
            breach_ = WorldBreach{"clock.t_s", "expected a time within 1e9 s"};
        }
        if (!(w_.gravity_mps2.cwiseAbs().maxCoeff() <= world_limits::k_max_gravity_mps2)) {
            breach_ = WorldBreach{"gravity_mps2", "expected at most 1e4 m/s^2 per axis"};
        }
    }

    void check_ids() {
        visit_columns(w_, [this](const char* name, const auto& column) {
            require(name, column, "persistent_id", w_.persistent_id);
        });
        std::vector<PersistentId> ids(w_.persistent_id.elements().begin(),
                                      w_.persistent_id.elements().end());
        std::sort(ids.begin(), ids.end());
        const auto duplicate = std::adjacent_find(ids.begin(), ids.end());
        if (!breach_ && duplicate != ids.end()) {
            breach_ =
                WorldBreach{"persistent_id[" + text_of(*duplicate) + "]", "expected unique ids"};
        }
        constexpr std::uint64_t k_world_id = std::numeric_limits<std::uint64_t>::max();
        if (!breach_ && !ids.empty() &&
            (ids.front().value == 0 || ids.back().value == k_world_id)) {
            breach_ = WorldBreach{"persistent_id", "expected ids above 0 and below 2^64 - 1"};
        }
    }

    void check_bodies() {
        require_both("body", w_.body, "body_pose", w_.body_pose);
        require_both("body", w_.body, "body_start", w_.body_start);
        require_both("body", w_.body, "body_velocity", w_.body_velocity);
        for (std::size_t index = 0; index < w_.body.size(); ++index) {
            const Entity owner = w_.body.owners()[index];
            const RigidBody& body = w_.body.elements()[index];
            check(!w_.player.contains(owner), "body", owner, "",
                  "an entity that is not a player too");
            check(body.restitution >= 0.0 && body.restitution <= 1.0, "body", owner, ".restitution",
                  "a number in [0, 1]");
            check(body.friction >= 0.0, "body", owner, ".friction", "a number >= 0");
            if (body.kind == BodyKind::free) {
                check(body.mass_kg > 0.0, "body", owner, ".mass_kg", "a mass > 0");
                check(body.inertia_kgm2.minCoeff() > 0.0, "body", owner, ".inertia_kgm2",
                      "moments > 0");
            }
        }
    }

    void check_movers() {
        require("mover", w_.mover, "body", w_.body);
        require("path_mover", w_.path_mover, "body", w_.body);
        require("leg_mover", w_.leg_mover, "body", w_.body);
        require("move_target", w_.move_target, "body", w_.body);
        require("gravity_scale", w_.gravity_scale, "body", w_.body);
        require("grab_rule", w_.grab_rule, "body", w_.body);
        for (std::size_t index = 0; index < w_.gravity_scale.size(); ++index) {
            check(std::abs(w_.gravity_scale.elements()[index].scale) <= GravityScale::k_max,
                  "gravity_scale", w_.gravity_scale.owners()[index], ".scale",
                  "a number within 1000");
        }
        for (std::size_t index = 0; index < w_.move_target.size(); ++index) {
            const MoveTarget& target = w_.move_target.elements()[index];
            const Entity owner = w_.move_target.owners()[index];
            check(target.count <= MoveTarget::k_capacity, "move_target", owner, ".count",
                  "at most 8 moves");
            const auto moves = std::span(target.moves).first(breach_ ? 0 : target.count);
            check(std::ranges::all_of(moves,
                                      [](const MoveTarget::Move& m) { return m.span_s >= 1e-6; }),
                  "move_target", owner, ".moves", "times of 1e-6 s or more");
            check(target.moved_s <= w_.clock.t_s, "move_target", owner, ".moved_s",
                  "a time up to the clock's");
        }
        for (std::size_t index = 0; index < w_.path_mover.size(); ++index) {
            const PosePath& path = w_.path_mover.elements()[index].path;
            check(path.count >= 2 && path.count <= k_max_path_keys && is_duration(path.period_s),
                  "path_mover", w_.path_mover.owners()[index], ".path",
                  "2 to 16 keys and a period of 1e-3 to 1e9 s");
        }
        for (std::size_t index = 0; index < w_.leg_mover.size(); ++index) {
            const LegMover& mover = w_.leg_mover.elements()[index];
            const Entity owner = w_.leg_mover.owners()[index];
            check(is_duration(mover.gait.step_s) && mover.gait.standing > 0.0 &&
                      mover.gait.standing < 1.0,
                  "leg_mover", owner, ".gait", "steps of 1e-3 to 1e9 s and a share in (0, 1)");
            const auto [shorter, longer] = std::minmax(mover.leg.upper_m, mover.leg.lower_m);
            check(shorter >= k_min_bone_ratio * longer && longer > 0.0, "leg_mover", owner, ".leg",
                  "bone lengths > 0, none below a hundredth of the other");
        }
    }

    void check_joints() {
        require_both("joint", w_.joint, "joint_state", w_.joint_state);
        for (std::size_t index = 0; index < w_.joint.size(); ++index) {
            const Entity owner = w_.joint.owners()[index];
            const Joint& joint = w_.joint.elements()[index];
            const JointLatch& latch = joint.latch;
            check(joint.lower <= joint.upper, "joint", owner, ".lower", "a limit <= upper");
            check(joint.friction >= 0.0 && joint.detent_spacing >= 0.0 &&
                      joint.detent_strength >= 0.0 && latch.catch_range >= 0.0 &&
                      latch.strength >= 0.0,
                  "joint", owner, "", "friction, detents and latches >= 0");
            const bool may_move = joint.kind == JointKind::hinge || joint.kind == JointKind::slider;
            check(joint.motor.kind <= MotorKind::position &&
                      (may_move || joint.motor.kind == MotorKind::none) &&
                      joint.motor.time_s >= 0.0 && joint.motor.strength >= 0.0,
                  "joint", owner, ".motor", "a motor of a hinge or slider, numbers >= 0");
        }
    }

    void check_players() {
        require_both("player", w_.player, "player_origin", w_.player_origin);
        require_both("player", w_.player, "player_start", w_.player_start);
        require_both("player", w_.player, "player_velocity", w_.player_velocity);
        require_both("player", w_.player, "player_commands", w_.player_commands);
        require_both("player", w_.player, "reference_velocity", w_.reference_velocity);
        require_both("player", w_.player, "head_tracking", w_.head_tracking);
        require_both("player", w_.player, "head_ignores", w_.head_ignores);
        require_both("player", w_.player, "render_pose", w_.render_pose);
        for (std::size_t index = 0; index < w_.player_origin.size(); ++index) {
            const double scale = w_.player_origin.elements()[index].scale;
            check(scale >= PlayerOrigin::k_min_scale && scale <= PlayerOrigin::k_max_scale,
                  "player_origin", w_.player_origin.owners()[index], ".scale",
                  "a number in [0.01, 100]");
        }
        check_figures();
        for (const Entity player : w_.player.owners()) {
            check(w_.player.at(player).mass_kg > 0.0, "player", player, ".mass_kg", "a mass > 0");
            const HeadIgnores* const ignores = w_.head_ignores.find(player);
            check(ignores == nullptr || ignores->next < HeadIgnores::k_capacity, "head_ignores",
                  player, ".next", "an index into the array");
        }
    }

    void check_figures() {
        require_both("player", w_.player, "body_measures", w_.body_measures);
        require_both("player", w_.player, "calibration", w_.calibration);
        require_both("player", w_.player, "size_estimate", w_.size_estimate);
        require_both("player", w_.player, "arm_memory", w_.arm_memory);
        require_both("player", w_.player, "arm_estimate", w_.arm_estimate);
        require_both("player", w_.player, "arm_pose", w_.arm_pose);
        require_both("player", w_.player, "spine_memory", w_.spine_memory);
        require_both("player", w_.player, "spine_pose", w_.spine_pose);
        require_both("player", w_.player, "body_clip_state", w_.body_clip_state);
        check_body_clips();
        check_sizes();
        check_arm_memories();
        check_spine_memories();
    }

    void check_body_clips() {
        for (std::size_t index = 0; index < w_.body_clip_state.size(); ++index) {
            const BodyClipState& state = w_.body_clip_state.elements()[index];
            const Entity owner = w_.body_clip_state.owners()[index];
            check(state.idle_s >= 0.0 && state.push_off_s >= 0.0, "body_clip_state", owner, "",
                  "times >= 0");
            check(state.push_off_weight >= 0.0 && state.push_off_weight <= 1.0, "body_clip_state",
                  owner, ".push_off_weight", "a number in [0, 1]");
            check(state.outside >= 0.0 && state.outside <= 1.0, "body_clip_state", owner,
                  ".outside", "a number in [0, 1]");
        }
    }

    void check_sizes() {
        for (std::size_t index = 0; index < w_.body_measures.size(); ++index) {
            const Entity owner = w_.body_measures.owners()[index];
            const PlayerOrigin* const origin = w_.player_origin.find(owner);
            check(origin != nullptr &&
                      are_measures(w_.body_measures.elements()[index], origin->scale),
                  "body_measures", owner, "", "lengths of 0.05 to 5 m times the player's scale");
        }
        for (std::size_t index = 0; index < w_.calibration.size(); ++index) {
            const Calibration& c = w_.calibration.elements()[index];
            const Entity player = w_.calibration.owners()[index];
            check(c.held_s >= 0.0 && c.held_s <= 10.0, "calibration", player, ".held_s",
                  "0 to 10 s");
            check(has_possible_sums(c), "calibration", player, "",
                  "sums that T-poses held for held_s can have");
        }
        for (std::size_t index = 0; index < w_.size_estimate.size(); ++index) {
            const SizeEstimate& size = w_.size_estimate.elements()[index];
            const auto is_time = [](double time_s) { return time_s >= 0.0 && time_s <= 1e6; };
            check(std::ranges::all_of(size.eyes.time_s, is_time) &&
                      std::ranges::all_of(size.reach.time_s, is_time),
                  "size_estimate", w_.size_estimate.owners()[index], "", "times in [0, 1e6] s");
        }
    }

    void check_arm_memories() {
        for (std::size_t index = 0; index < w_.arm_memory.size(); ++index) {
            const ArmMemory& memory = w_.arm_memory.elements()[index];
            const auto is_level_unit = [](const Vec3& v) {
                constexpr double k_off = 1e-3;
                return std::abs(v.y()) < k_off && std::abs(v.norm() - 1.0) < k_off;
            };
            check(!memory.known ||
                      (is_level_unit(memory.facing_ps) &&
                       std::all_of(memory.looks_ps.begin(), memory.looks_ps.end(), is_level_unit)),
                  "arm_memory", w_.arm_memory.owners()[index], "", "horizontal unit vectors");
            for (const ArmMemory::Arm& arm : memory.arms) {
                check(arm.rest.share >= 0.0 && arm.rest.share <= 1.0, "arm_memory",
                      w_.arm_memory.owners()[index], ".arms", "shares in [0, 1]");
            }
        }
    }

    void check_spine_memories() {
        for (std::size_t index = 0; index < w_.spine_memory.size(); ++index) {
            const SpineMemory& memory = w_.spine_memory.elements()[index];
            const Entity owner = w_.spine_memory.owners()[index];
            check(memory.since_tick_s >= 0.0 && memory.since_tick_s <= 1.0, "spine_memory", owner,
                  ".since_tick_s", "a time in [0, 1] s");
            check(memory.rate_span_s >= 0.0, "spine_memory", owner, ".rate_span_s", "a time >= 0");
            for (const BodyContact& contact : memory.contacts) {
                check(std::abs(contact.normal_ps.norm() - 1.0) < 1e-3, "spine_memory", owner,
                      ".contacts", "unit normals");
            }
        }
    }

    void check_hands() {
        require_both("hand_owner", w_.hand_owner, "hand_tracking", w_.hand_tracking);
        require_both("hand_owner", w_.hand_owner, "hand_history", w_.hand_history);
        require_both("hand_owner", w_.hand_owner, "grab", w_.grab);
        require_both("hand_owner", w_.hand_owner, "hand_sight", w_.hand_sight);
        require_both("hand_owner", w_.hand_owner, "palm_pose", w_.palm_pose);
        require("controller_to_hand", w_.controller_to_hand, "hand_owner", w_.hand_owner);
        require("grab_order", w_.grab_order, "grab", w_.grab);
        require("hand_rig", w_.hand_rig, "hand_owner", w_.hand_owner);
        require("grab_layers", w_.grab_layers, "player", w_.player);
        require("early_samples", w_.early_samples, "player", w_.player);
        require("recenter_guess", w_.recenter_guess, "player", w_.player);
        for (std::size_t index = 0; index < w_.hand_tracking.size(); ++index) {
            const HandTracking& hand = w_.hand_tracking.elements()[index];
            const Entity owner = w_.hand_tracking.owners()[index];
            const auto is_share = [](double share) { return share >= 0.0 && share <= 1.0; };
            const auto is_curl = [&](double curl) {
                return is_share(curl) || curl == k_unknown_curl;
            };
            check(is_share(hand.squeeze) && is_share(hand.trigger), "hand_tracking", owner, "",
                  "squeeze and trigger in [0, 1]");
            check(std::ranges::all_of(hand.curls, is_curl), "hand_tracking", owner, ".curls",
                  "-1 or in [0, 1]");
        }
        for (std::size_t index = 0; index < w_.head_tracking.size(); ++index) {
            check(w_.head_tracking.elements()[index].state != TrackingState::inferred,
                  "head_tracking", w_.head_tracking.owners()[index], ".state",
                  "never, tracked or lost");
        }
        Column<std::array<std::uint8_t, k_hand_count>> has_hand;
        for (const Entity player : w_.player.owners()) {
            has_hand.add(player);
        }
        for (std::size_t index = 0; index < w_.hand_owner.size(); ++index) {
            const Entity hand = w_.hand_owner.owners()[index];
            const HandOwner& owner = w_.hand_owner.elements()[index];
            auto* const used_sides = has_hand.find(owner.player);
            check(used_sides != nullptr, "hand_owner", hand, ".player", "a player");
            if (used_sides != nullptr) {
                std::uint8_t& used = (*used_sides)[index_of(owner.side)];
                check(used == 0, "hand_owner", hand, ".side", "one hand per side");
                used = 1;
            }
        }
        for (std::size_t i = 0; i < w_.early_samples.size(); ++i) {
            check(w_.early_samples.elements()[i].count <= EarlySamples::k_capacity, "early_samples",
                  w_.early_samples.owners()[i], ".count", "at most as many as the array has");
        }
        for (std::size_t index = 0; index < w_.hand_history.size(); ++index) {
            const HandHistory& history = w_.hand_history.elements()[index];
            check(
                history.next < HandHistory::k_capacity && history.count <= HandHistory::k_capacity,
                "hand_history", w_.hand_history.owners()[index], "", "next and count in the array");
        }
        for (std::size_t index = 0; index < w_.grab.size(); ++index) {
            const Grab& grab = w_.grab.elements()[index];
            check((grab.kind == GripKind::none) == (grab.phase == GrabPhase::none), "grab",
                  w_.grab.owners()[index], ".phase", "a phase if and only if there is a grip");
            check(grab.kind != GripKind::authored, "grab", w_.grab.owners()[index], ".kind",
                  "a surface, a held object or a player: an authored grip is in authored_hold");
        }
        check_authored();
    }

    void check_authored() {
        require("authored_grips", w_.authored_grips, "body", w_.body);
        require("authored_hold", w_.authored_hold, "grab", w_.grab);
        require("body_hold", w_.body_hold, "grab", w_.grab);
        require("hand_pull", w_.hand_pull, "grab", w_.grab);
        for (std::size_t index = 0; index < w_.authored_grips.size(); ++index) {
            check(w_.authored_grips.elements()[index].count <= k_max_authored_grips,
                  "authored_grips", w_.authored_grips.owners()[index], ".count", "at most 4 grips");
        }
    }

    void check_colliders() {
        for (std::size_t index = 0; index < w_.collider.size(); ++index) {
            const Entity owner = w_.collider.owners()[index];
            const ShapeId shape = w_.collider.elements()[index].shape;
            const RigidBody* const body = w_.body.find(owner);
            check(body != nullptr || w_.player.contains(owner), "collider", owner, "",
                  "a body or a player");
            const bool is_new_head = body == nullptr && shape == k_no_shape;
            check(is_new_head || shapes_.has(shape), "collider", owner, ".shape",
                  "a shape that exists");
            if (breach_) {
                return;
            }
            if (body == nullptr || body->kind == BodyKind::free) {
                check(w_.last_valid.contains(owner), "collider", owner, "",
                      "an element in last_valid of the same owner");
                check(is_new_head || shapes_.at(shape).kind != ShapeKind::mesh, "collider", owner,
                      ".shape", "no mesh on a free body or player");
            }
        }
    }

    const World& w_;
    const ShapeLibrary& shapes_;
    std::optional<WorldBreach> breach_;
};

}  // namespace

std::optional<WorldBreach> find_breach(const World& world, const ShapeLibrary& shapes) {
    return BreachFinder(world, shapes).find();
}

}  // namespace handhold
