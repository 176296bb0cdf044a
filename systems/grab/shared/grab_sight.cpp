#include "systems/grab/shared/grab_sight.hpp"

#include "components/hand_indices.hpp"
#include "components/play_space.hpp"
#include "components/scaled_tuning.hpp"
#include "engine/core/parallel.hpp"

namespace handhold {
namespace {

Vec3 head_center_ws(const GrabSearch& io, Entity player, const HeadTuning& tuning) {
    return transform_point(io.origin.at(player).pose_ws,
                           head_center_ps(io.head.at(player), tuning));
}

// Pose of the space in which HandSight::outside_bs is given.
Pose sight_frame_ws(const GrabSearch& io, Entity frame) {
    const BodyPose* const body = io.body_pose.find(frame);
    return body != nullptr ? body->pose_ws : Pose{};
}

// Decides whether to cast sight rays in this frame. Short movements of an open hand are accumulated
// and tested with one ray, which starts at the point before them and therefore still crosses every
// wall. An empty hand that closes or pulls needs an exact HandSight.
bool needs_rays(const HandSight& sight, const Grab& grab, const HandTracking& hand,
                const SightLines& lines, const Vec3& palm_ws) {
    constexpr double k_step_m = 0.05;
    if (grab.kind == GripKind::surface) {
        return false;
    }
    const bool is_near = (palm_ws - lines.outside_ws).norm() < lines.scale * k_step_m;
    const bool is_empty_fist = hand.pressed && grab.kind == GripKind::none;
    return is_empty_fist || !is_near || !sight.is_known || !sight.is_clear;
}

// The outside point follows the palm while the palm is in sight. Otherwise, and while the hand
// grips a surface, it travels with the body that the player last gripped: a ship, a lift.
void update_sight(const GrabSearch& io, Entity entity, const Tuning& tuning) {
    const HandTracking& hand = io.hand.at(entity);
    if (hand.state != TrackingState::tracked) {
        return;
    }
    const HandOwner& owner = io.owner.at(entity);
    const Vec3 palm_ws =
        palm_ray(io.origin.at(owner.player).pose_ws * hand.start_ps, owner.side, tuning.hand)
            .palm_ws;
    const SightSkips skips = sight_skips(io, entity);
    SightLines lines = sight_lines(io, entity, palm_ws, skips, tuning.head);
    HandSight& sight = io.sight.at(entity);
    const Entity reference = io.reference.at(owner.player).body;
    const Entity frame = io.body_pose.contains(reference) ? reference : k_no_entity;
    const bool is_due = needs_rays(sight, io.grab.at(entity), hand, lines, palm_ws);
    if (!is_due && frame == sight.frame) {
        return;
    }
    if (is_due) {
        const SightLines::Sight palm_sight = lines.sight_of_palm(palm_ws);
        sight.is_known = true;
        sight.is_clear = palm_sight != SightLines::Sight::blocked;
        if (palm_sight == SightLines::Sight::clear_beyond) {
            lines.outside_ws = palm_ws;
        }
    }
    sight.frame = frame;
    sight.outside_bs = inverse_transform_point(sight_frame_ws(io, frame), lines.outside_ws);
}

}  // namespace

SightSkips sight_skips(const GrabSearch& io, Entity hand) {
    const Entity player = io.owner.at(hand).player;
    SightSkips skips;
    skips.ids[skips.count++] = io.persistent_id.at(player).value;
    const std::size_t index = io.grab.find_index(hand);
    for (const std::size_t each : {index, find_other_hand(io.owner, io.grab, index)}) {
        if (each < io.grab.size() && io.grab.elements()[each].kind == GripKind::held &&
            io.grab.elements()[each].phase != GrabPhase::fresh &&
            io.body.contains(io.grab.elements()[each].body)) {
            skips.ids[skips.count++] = io.persistent_id.at(io.grab.elements()[each].body).value;
        }
    }
    return skips;
}

SightLines sight_lines(const GrabSearch& io, Entity hand, const Vec3& palm_ws,
                       const SightSkips& skips, const HeadTuning& tuning) {
    const HandSight& sight = io.sight.at(hand);
    const Vec3 head_ws = head_center_ws(io, io.owner.at(hand).player, tuning);
    const bool is_known =
        sight.is_known && (is_null(sight.frame) || io.body_pose.contains(sight.frame));
    return {io.surfaces, skips.view(),
            is_known ? transform_point(sight_frame_ws(io, sight.frame), sight.outside_bs) : palm_ws,
            head_ws, io.origin.at(io.owner.at(hand).player).scale};
}

void update_sights(const GrabSearch& io, const Tuning& tuning) {
    constexpr std::size_t k_hands_per_slice = 8;
    const auto update = [&](std::size_t /*slice*/, std::size_t first, std::size_t last) {
        TuningOfPlayers tunings(tuning);
        for (std::size_t index = first; index < last; ++index) {
            const Entity hand = io.grab.owners()[index];
            update_sight(io, hand, tunings.of(io.origin.at(io.owner.at(hand).player)));
        }
    };
    if (io.surfaces.any_thread()) {
        parallel_slices(io.grab.size(), k_hands_per_slice, update);
    } else {
        update(0, 0, io.grab.size());
    }
}

}  // namespace handhold
