#include "game/view/explain_hand.hpp"

#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "components/play_space.hpp"

namespace handhold {
namespace {

constexpr double k_query_radius_m = 1.0;  // search radius for the nearest surface beyond reach
constexpr double k_pointed_cos = 0.9962;

[[gnu::format(printf, 1, 2)]] std::string format_text(const char* format, ...) {
    char text[240];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return text;
}

// Explains what the palm would grip if it closed now, by the rules of update_grabs.
void explain_reach(const Scene& scene, const CollisionWorld& collision, const HandOwner& owner,
                   const Pose& hand_ws, HandStory& story) {
    const HandTuning& tuning = scene.tuning().hand;
    const World& world = scene.world();
    const std::array own_head = {world.persistent_id.at(owner.player).value};
    const PalmRay ray = palm_ray(hand_ws, owner.side, tuning);
    const auto name = [&](std::uint64_t id) {
        return name_of_entity(scene, find_by_id(world, PersistentId{id}));
    };
    const double before_palm_m = tuning.ray_length_m - tuning.ray_back_m;
    if (const auto hit = collision.cast_ray(ray.from_ws, ray.to_ws, own_head)) {
        story.reasons.push_back(
            format_text("The palm's ray meets %s, %.1f cm before the palm: if it closed "
                        "now, it grips there.",
                        name(hit->id).c_str(), 100.0 * (hit->distance_m - tuning.ray_back_m)));
        return;
    }
    story.reasons.push_back(
        format_text("The palm's ray meets nothing within %.0f cm.", 100.0 * before_palm_m));
    const auto near = collision.closest_point(ray.palm_ws, k_query_radius_m, own_head);
    if (!near) {
        story.reasons.emplace_back("No surface within 1 m of the palm.");
    } else if (near->distance_m <= tuning.reach_m) {
        story.reasons.push_back(
            format_text("%s is %.1f cm from the palm, within reach (%.0f cm): if it closes "
                        "now, it grips there.",
                        name(near->id).c_str(), 100.0 * near->distance_m, 100.0 * tuning.reach_m));
    } else {
        story.reasons.push_back(
            format_text("The nearest surface, %s, is %.1f cm from the palm: farther "
                        "than hand.reach_m, %.0f cm.",
                        name(near->id).c_str(), 100.0 * near->distance_m, 100.0 * tuning.reach_m));
    }
}

std::string body_effect_text(const World& world, const Tuning& tuning, const Grab& grab) {
    const RigidBody* const body = world.body.find(grab.body);
    if (body == nullptr) {
        return "It is another player: both players move, by their masses.";
    }
    if (body->kind == BodyKind::fixed) {
        return "It is fixed: the hand holds the anchor and the player moves.";
    }
    if (body->kind == BodyKind::kinematic) {
        return "It is kinematic: the hand holds the anchor and the player moves with it.";
    }
    const double mass_kg = body->mass_kg;
    if (mass_kg >= tuning.phases.heavy_body_kg) {
        return format_text(
            "It weighs %.0f kg, at least phases.heavy_body_kg (%.0f): gripped like a wall.",
            mass_kg, tuning.phases.heavy_body_kg);
    }
    if (grab.jointed) {
        return format_text(
            "It weighs %.1f kg and is jointed to something fixed: three rows, "
            "the hand may rotate on it.",
            mass_kg);
    }
    return mass_kg < tuning.phases.kappa_light_kg
               ? format_text(
                     "It weighs %.1f kg, less than phases.kappa_light_kg (%.0f): it never moves "
                     "the "
                     "player.",
                     mass_kg, tuning.phases.kappa_light_kg)
               : format_text(
                     "It weighs %.0f kg, between phases.kappa_light_kg and kappa_heavy_kg: it "
                     "moves "
                     "the player partly.",
                     mass_kg);
}

void explain_grip(const Scene& scene, Entity hand, const Pose& hand_ws, HandStory& story) {
    const World& world = scene.world();
    const Grab& grab = world.grab.at(hand);
    story.headline = (grab.kind == GripKind::held ? "holds " : "grips ") +
                     name_of_entity(scene, grab.body) +
                     format_text(", for %.1f s", world.clock.t_s - grab.since_s);
    story.reasons.push_back(body_effect_text(world, scene.tuning(), grab));
    const AuthoredHold* const hold = world.authored_hold.find(hand);
    if (hold != nullptr && hold->body == grab.body) {
        const auto grips = scene.grips.find(name_of_entity(scene, grab.body));
        const bool is_named = grips != scene.grips.end() && hold->grip < grips->second.size();
        story.reasons.push_back(format_text(
            "It closed in the zone of an authored grip, %s: the hand takes that grip's pose.",
            is_named ? grips->second[hold->grip].name.c_str() : "without a name"));
    }
    const Pose body_ws = gripped_pose_ws(world.body_pose, world.player_origin, world.head_tracking,
                                         grab.body, world.body_hold.find(hand));
    story.reasons.push_back(
        format_text("When it closed, the surface was %.1f cm from the wrist.",
                    100.0 * (transform_point(body_ws, grab.hit_bs) - hand_ws.position).norm()));
    story.reasons.push_back(
        format_text("The hand is %.3f mm from its anchor; it lets go at %.0f mm "
                    "(hand.max_stretch_m).",
                    1e3 * grab.error_m, 1e3 * scene.tuning().hand.max_stretch_m));
    if (grab.two_handed) {
        story.reasons.emplace_back(
            "Two-handed hold: the first hand sets the position; the line between the "
            "hands and their twist set the rotation.");
    }
}

}  // namespace

std::string name_of_entity(const Scene& scene, Entity entity) {
    const World& world = scene.world();
    const std::size_t index = world.body.find_index(entity);
    if (world.body.contains(entity) && index < scene.body_names.size()) {
        return scene.body_names[index];
    }
    if (const HandOwner* const owner = world.hand_owner.find(entity)) {
        return owner->side == HandSide::left ? "left hand" : "right hand";
    }
    if (world.player.contains(entity)) {
        return format_text("player %zu", world.player.find_index(entity));
    }
    if (const Joint* const joint = world.joint.find(entity)) {
        return "joint of " + name_of_entity(scene, joint->b);
    }
    const PersistentId* const id = world.persistent_id.find(entity);
    return id != nullptr ? format_text("0x%016llx", static_cast<unsigned long long>(id->value))
                         : "nobody";
}

HandStory explain_hand(const Scene& scene, const CollisionWorld& collision, Entity hand) {
    const World& world = scene.world();
    const HandOwner& owner = world.hand_owner.at(hand);
    const HandTracking& tracking = world.hand_tracking.at(hand);
    const Grab& grab = world.grab.at(hand);
    const Pose hand_ws = world.player_origin.at(owner.player).pose_ws * tracking.pose_ps;
    HandStory story;
    if (tracking.state == TrackingState::never) {
        story.headline = "is absent: no valid sample received yet";
        return story;
    }
    if (tracking.state == TrackingState::lost) {
        story.reasons.push_back(format_text(
            "Its tracking has been lost for %.2f s: it is frozen and neither grips nor releases.",
            world.clock.t_s - tracking.sample_t_s));
    }
    if (tracking.state == TrackingState::inferred) {
        story.reasons.emplace_back(
            "No camera sees it: its pose is the runtime's guess, with which it neither grips nor "
            "moves the player.");
    }
    if (grab.kind != GripKind::none) {
        explain_grip(scene, hand, hand_ws, story);
        return story;
    }
    if (tracking.pressed) {
        story.headline = "is closed on nothing";
        story.reasons.emplace_back(
            "A hand grips only at the moment it closes: nothing "
            "was in reach then, or the grip has been lost since. Open it first.");
    } else {
        story.headline = "is open";
    }
    explain_reach(scene, collision, owner, hand_ws, story);
    return story;
}

std::optional<Entity> hand_pointed_at(const World& world, const Vec3& eye_ws, const Vec3& look_ws) {
    std::optional<Entity> best;
    double best_cos = k_pointed_cos;
    for (std::size_t index = 0; index < world.hand_owner.size(); ++index) {
        const HandOwner& owner = world.hand_owner.elements()[index];
        const RenderPose* const render = world.render_pose.find(owner.player);
        if (render == nullptr) {
            continue;
        }
        const Vec3 to = render->hands[index_of(owner.side)].shown_ws.position - eye_ws;
        const double cosine = to.dot(look_ws) / std::fmax(to.norm(), 1e-9);
        if (cosine > best_cos) {
            best_cos = cosine;
            best = world.hand_owner.owners()[index];
        }
    }
    return best;
}

}  // namespace handhold
