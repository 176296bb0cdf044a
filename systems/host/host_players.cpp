// Players of the C interface (handhold/players.h).
#include "components/play_space.hpp"
#include "components/scaled_tuning.hpp"
#include "components/world_edit.hpp"
#include "systems/host/host_world.hpp"
#include "systems/input/read_tracking.hpp"

namespace handhold {
namespace {

BodyMeasures read_measures(const hh_measures& measures) {
    return {measures.eye_height_m, measures.shoulder_width_m, measures.upper_arm_m,
            measures.forearm_m};
}

// True for the measures of hh_default_player_def: nobody measured the player.
bool is_default(const hh_measures& measures) {
    const BodyMeasures usual;
    return measures.eye_height_m == usual.eye_height_m &&
           measures.shoulder_width_m == usual.shoulder_width_m &&
           measures.upper_arm_m == usual.upper_arm_m && measures.forearm_m == usual.forearm_m;
}

// Measures that a player of that scale may have.
BodyMeasures checked_measures(const hh_measures& measures, double scale) {
    const BodyMeasures read = read_measures(measures);
    const WrongMeasure wrong = wrong_measure(read, scale);
    require(wrong.name == nullptr, HH_ERROR_VALUE, [&] {
        return std::string("measures.") + wrong.name + " is " + number_text(wrong.value_m) +
               ": it must lie within 0.05 to 5 m" +
               (scale == 1.0 ? "" : " times the player's scale, " + number_text(scale));
    });
    return read;
}

hh_measures write_measures(const BodyMeasures& measures) {
    return {measures.eye_height_m, measures.shoulder_width_m, measures.upper_arm_m,
            measures.forearm_m};
}

}  // namespace
Pose hand_in_controller(const hh_world& host, Entity player, HandSide side) {
    if (const ControllerToHand* const own =
            host.world.controller_to_hand.find(hand_of(host.world, player, side))) {
        return own->hand_in_controller;
    }
    TuningOfPlayers tunings(host.tuning);
    return default_controller_to_hand(side, tunings.of(host.world.player_origin.at(player)).hand);
}

}  // namespace handhold

using namespace handhold;

hh_result hh_default_player_def_sized(hh_player_def* filled, size_t size) {
    hh_player_def def{};
    def.origin = hh_identity_pose();
    def.mass_kg = PlayerBody{}.mass_kg;
    def.measures = write_measures(BodyMeasures{});
    def.scale = 1.0;
    def.head_collides = true;
    def.layers = CollisionFilter{}.layers;
    def.mask = CollisionFilter{}.mask;
    def.grab_layers = GrabLayers{}.layers;
    return write_default(filled, size, def);
}

hh_result hh_player_add(hh_world* world, const hh_player_def* wanted, hh_player* player) {
    return call([&] {
        hh_world& host = world_of(world);
        const hh_player_def def = read_def(wanted, hh_default_player_def());
        require(player != nullptr, HH_ERROR_NULL, "the output is null");
        const std::string name = new_name(host, def.name, "player");
        for (const char* const hand : {"/left_hand", "/right_hand"}) {
            require(is_null(find_by_name(host.world, name + hand)), HH_ERROR_NAME,
                    "the name of one of the player's hands is taken");
        }
        const double scale = checked(def.scale, PlayerOrigin::k_min_scale,
                                     PlayerOrigin::k_max_scale, "scale must lie in [0.01, 100]");
        PlayerDescription description;
        description.name = name;
        description.body.mass_kg = def.mass_kg;
        description.origin_ws = checked(def.origin);
        description.velocity_mps = checked(def.velocity_mps, world_limits::k_max_speed_mps,
                                           "a velocity beyond 1e6 m/s, or NaN");
        description.scale = scale;
        description.measures = checked_measures(def.measures, 1.0);
        description.is_measured = !is_default(def.measures);
        checked(def.mass_kg, world_limits::k_min_mass_kg, world_limits::k_max_mass_kg,
                "a player needs a mass within 1e-12 to 1e15 kg");
        description.head_shape = k_no_shape;
        if (def.head_collides) {
            description.head_shape = head_shape(host, scale * host.tuning.head.radius_m);
        }
        const Entity entity = add_player(host.world, description, host.shapes).player;
        if (def.layers != CollisionFilter{}.layers || def.mask != CollisionFilter{}.mask) {
            host.world.filter.add(entity, {def.layers, def.mask});
        }
        if (def.grab_layers != GrabLayers{}.layers) {
            host.world.grab_layers.add(entity, {def.grab_layers});
        }
        set_user_data(host, entity, def.user_data);
        *player = id_of<hh_player>(entity);
    });
}

hh_result hh_player_remove(hh_world* world, hh_player player) {
    return call([&] {
        hh_world& host = world_of(world);
        remove_entity(host, player_of(host, player));
    });
}

uint8_t hh_player_is_valid(const hh_world* world, hh_player player) {
    return world != nullptr && world->world.player.contains(entity_of(player));
}

hh_result hh_world_players(const hh_world* world, hh_player* players, size_t capacity,
                           size_t* count) {
    return call([&] {
        const hh_world& host = world_of(world);
        write_list(host.world.player.size(), players, capacity, count, [&](std::size_t index) {
            return id_of<hh_player>(host.world.player.owners()[index]);
        });
    });
}

hh_result hh_player_teleport(hh_world* world, hh_player player, hh_pose origin) {
    return call([&] {
        hh_world& host = world_of(world);
        require_idle(host);
        const Entity entity = player_of(host, player);
        teleport_player(host.world, entity, play_space_ws(host, entity, checked(origin)));
    });
}

hh_result hh_player_velocity(const hh_world* world, hh_player player, hh_vec3* velocity_mps) {
    return call([&] {
        const hh_world& host = world_of(world);
        require(velocity_mps != nullptr, HH_ERROR_NULL, "the output is null");
        *velocity_mps = to_c(host.world.player_velocity.at(player_of(host, player)).linear_mps);
    });
}

hh_result hh_player_set_velocity(hh_world* world, hh_player player, hh_vec3 velocity_mps) {
    return call([&] {
        hh_world& host = world_of(world);
        const Entity entity = player_of(host, player);
        host.world.player_velocity.at(entity).linear_mps = checked(
            velocity_mps, world_limits::k_max_speed_mps, "a velocity beyond 1e6 m/s, or NaN");
    });
}

hh_result hh_player_reference_velocity(const hh_world* world, hh_player player,
                                       hh_vec3* velocity_mps) {
    return call([&] {
        const hh_world& host = world_of(world);
        require(velocity_mps != nullptr, HH_ERROR_NULL, "the output is null");
        *velocity_mps = to_c(host.world.reference_velocity.at(player_of(host, player)).linear_mps);
    });
}

hh_result hh_player_push_back(const hh_world* world, hh_player player, double* distance_m) {
    return call([&] {
        const hh_world& host = world_of(world);
        require(distance_m != nullptr, HH_ERROR_NULL, "the output is null");
        *distance_m = host.world.render_pose.at(player_of(host, player)).push_back_m;
    });
}

hh_result hh_player_mass(const hh_world* world, hh_player player, double* mass_kg) {
    return call([&] {
        const hh_world& host = world_of(world);
        require(mass_kg != nullptr, HH_ERROR_NULL, "the output is null");
        *mass_kg = host.world.player.at(player_of(host, player)).mass_kg;
    });
}

hh_result hh_player_head(const hh_world* world, hh_player player, hh_vec3* center, double* radius_m,
                         uint8_t* is_tracked) {
    return call([&] {
        const hh_world& host = world_of(world);
        const Entity entity = player_of(host, player);
        const HeadTracking& head = host.world.head_tracking.at(entity);
        const auto& [origin_ws, scale] = host.world.player_origin.at(entity);
        if (center != nullptr) {
            *center =
                to_c(transform_point(origin_ws, head_center_ps(head, scale, host.tuning.head)));
        }
        if (radius_m != nullptr) {
            *radius_m = scale * host.tuning.head.radius_m;
        }
        if (is_tracked != nullptr) {
            *is_tracked = head.state == TrackingState::tracked && !head.is_inferred;
        }
    });
}

hh_result hh_player_measures(const hh_world* world, hh_player player, hh_measures* measures) {
    return call([&] {
        const hh_world& host = world_of(world);
        require(measures != nullptr, HH_ERROR_NULL, "the output is null");
        *measures = write_measures(host.world.body_measures.at(player_of(host, player)));
    });
}

hh_result hh_player_set_measures(hh_world* world, hh_player player, const hh_measures* measures) {
    return call([&] {
        hh_world& host = world_of(world);
        require(measures != nullptr, HH_ERROR_NULL, "the measures are null");
        const Entity entity = player_of(host, player);
        host.world.body_measures.at(entity) =
            checked_measures(*measures, host.world.player_origin.at(entity).scale);
        host.world.size_estimate.at(entity).is_measured = true;
    });
}

hh_result hh_player_set_user_data(hh_world* world, hh_player player, uint64_t user_data) {
    return call([&] {
        hh_world& host = world_of(world);
        set_user_data(host, player_of(host, player), user_data);
    });
}

hh_result hh_player_user_data(const hh_world* world, hh_player player, uint64_t* user_data) {
    return call([&] {
        const hh_world& host = world_of(world);
        require(user_data != nullptr, HH_ERROR_NULL, "the output is null");
        *user_data = user_data_of(host, player_of(host, player));
    });
}

hh_result hh_player_set_hand_in_controller(hh_world* world, hh_player player, hh_side side,
                                           const hh_pose* hand_in_controller) {
    return call([&] {
        hh_world& host = world_of(world);
        const Entity hand = hand_of(host.world, player_of(host, player), side_of(side));
        if (hand_in_controller == nullptr) {
            host.world.controller_to_hand.remove(hand);
            return;
        }
        constexpr double k_max_offset_m = 10.0;
        const Pose pose = checked(*hand_in_controller);
        checked(hand_in_controller->position, k_max_offset_m, "a wrist beyond 10 m");
        if (ControllerToHand* const known = host.world.controller_to_hand.find(hand)) {
            known->hand_in_controller = pose;
        } else {
            host.world.controller_to_hand.add(hand, {pose});
        }
    });
}

hh_result hh_player_hand_in_controller(const hh_world* world, hh_player player, hh_side side,
                                       hh_pose* hand_in_controller) {
    return call([&] {
        const hh_world& host = world_of(world);
        require(hand_in_controller != nullptr, HH_ERROR_NULL, "the output is null");
        *hand_in_controller =
            to_c(handhold::hand_in_controller(host, player_of(host, player), side_of(side)));
    });
}

hh_result hh_world_hand_in_controller(const hh_world* world, hh_side side,
                                      hh_pose* hand_in_controller) {
    return call([&] {
        const hh_world& host = world_of(world);
        require(hand_in_controller != nullptr, HH_ERROR_NULL, "the output is null");
        *hand_in_controller = to_c(default_controller_to_hand(side_of(side), host.tuning.hand));
    });
}
