// Rigs, body clips and authored grips of the C interface (handhold/skeletons.h, handhold/world.h).
#include <filesystem>

#include "components/world_edit.hpp"
#include "engine/io/gltf_skin.hpp"
#include "engine/io/vrm_humanoid.hpp"
#include "systems/host/host_skeleton.hpp"
#include "systems/host/host_world.hpp"
#include "systems/rigs/body_clips_json.hpp"
#include "systems/rigs/body_rig_fit.hpp"
#include "systems/rigs/hand_rig_fit.hpp"

namespace handhold {
namespace {

// Returns the value of a file reader's result, or throws HH_ERROR_DATA. `name` stands for the file
// in the message, because bytes in memory have no file name.
template <typename T>
T value_or_throw(Result<T> result, const char* name) {
    if (!result) {
        FileError error = result.error();
        error.file = name;
        throw HostError{HH_ERROR_DATA, error.message()};
    }
    return std::move(result.value());
}

std::string_view text_of_bytes(const void* bytes, std::size_t size) {
    return {static_cast<const char*>(bytes), size};
}

FingerAngles read_angles(const double (&curl_rad)[k_max_links], double opposition_rad) {
    constexpr const char* k_text = "an angle of a finger beyond pi, or NaN";
    FingerAngles angles;
    for (std::size_t link = 0; link < k_max_links; ++link) {
        angles.curl_rad[link] = checked(curl_rad[link], -k_pi, k_pi, k_text);
    }
    angles.opposition_rad = checked(opposition_rad, -k_pi, k_pi, k_text);
    return angles;
}

AuthoredHand read_hand(const hh_world& host, Entity body, const hh_grip_hand& hand) {
    AuthoredHand read;
    read.is_there = hand.is_used != 0;
    if (!hand.is_used) {
        return read;
    }
    read.wrist_bs = from_host_bs(host, body, checked(hand.wrist));
    for (std::size_t finger = 0; finger < k_finger_count; ++finger) {
        const hh_finger& from = hand.fingers[finger];
        read.is_posed[finger] = from.is_posed != 0;
        if (!from.is_posed) {
            continue;
        }
        read.fingers[finger] = read_angles(from.curl_rad, from.opposition_rad);
        read.follows_trigger[finger] = from.follows_trigger != 0;
        if (from.follows_trigger) {
            read.pressed[finger] = read_angles(from.pressed_curl_rad, from.pressed_opposition_rad);
        }
    }
    return read;
}

BodyRigSlot& rig_of(hh_world& host, Entity player) {
    BodyRigSlot* const slot = host.body_rigs.find(player);
    require(slot != nullptr, HH_ERROR_STATE, "the player has no body rig");
    return *slot;
}

void set_rig(hh_world& host, Entity player, BodyRig rig) {
    host.body_rigs.remove(player);
    host.body_rigs.add(player, {std::make_unique<BodyRig>(std::move(rig)), {}});
}

}  // namespace
}  // namespace handhold

using namespace handhold;

hh_result hh_player_set_hand_rig(hh_world* world, hh_player player, hh_side side, const void* gltf,
                                 size_t size) {
    return call([&] {
        hh_world& host = world_of(world);
        const HandSide which = side_of(side);
        const Entity hand = hand_of(host.world, player_of(host, player), which);
        if (gltf == nullptr) {
            host.world.hand_rig.remove(hand);
            return;
        }
        const SkinnedMesh skin =
            value_or_throw(parse_gltf_skin(text_of_bytes(gltf, size), {}), "hand rig");
        HandRig rig = value_or_throw(hand_rig_from_skin(skin, which), "hand rig");
        const auto index = static_cast<std::uint32_t>(host.caches.more_hand_rigs.size());
        host.caches.more_hand_rigs.push_back(std::move(rig));
        host.world.hand_rig.remove(hand);
        host.world.hand_rig.add(hand, {index});
    });
}

hh_result hh_player_set_body_rig(hh_world* world, hh_player player, const void* gltf, size_t size) {
    return call([&] {
        hh_world& host = world_of(world);
        const Entity entity = player_of(host, player);
        if (gltf == nullptr) {
            host.body_rigs.remove(entity);
            return;
        }
        const std::string_view bytes = text_of_bytes(gltf, size);
        const SkinnedMesh figure = value_or_throw(parse_gltf_figure(bytes, {}), "body rig");
        const BodyMap map =
            body_map_of_vrm(value_or_throw(parse_vrm_humanoid(bytes, {}), "body rig"));
        set_rig(host, entity, value_or_throw(fit_body_rig(figure, map), "body rig"));
    });
}

hh_result hh_player_set_body_skeleton(hh_world* world, hh_player player,
                                      const hh_skeleton_joint* joints, size_t count,
                                      hh_space space) {
    return call([&] {
        hh_world& host = world_of(world);
        const Entity entity = player_of(host, player);
        if (count == 0) {
            host.body_rigs.remove(entity);
            return;
        }
        require(joints != nullptr, HH_ERROR_NULL, "the joints are null");
        require(count <= k_max_skin_joints, HH_ERROR_VALUE, "a skeleton has 1 to 1024 joints");
        set_rig(host, entity, fit_skeleton({joints, count}, space));
    });
}

hh_result hh_player_skeleton_fingers(const hh_world* world, hh_player player, hh_side side,
                                     size_t* count) {
    return call([&] {
        const hh_world& host = world_of(world);
        require(count != nullptr, HH_ERROR_NULL, "the output is null");
        const BodyRigSlot* const slot = host.body_rigs.find(player_of(host, player));
        require(slot != nullptr, HH_ERROR_STATE, "the player has no body rig");
        *count = slot->rig->finger_count(side_of(side));
    });
}

hh_result hh_world_load_body_clips(hh_world* world, const char* json, size_t size) {
    return call([&] {
        hh_world& host = world_of(world);
        host.caches.body_clips =
            json == nullptr
                ? BodyClips{}
                : value_or_throw(parse_body_clips({json, size}, "body clips"), "body clips");
    });
}

hh_result hh_player_skeleton(hh_world* world, hh_player player, hh_space space, hh_pose* joints,
                             size_t capacity, size_t* count) {
    return call([&] {
        hh_world& host = world_of(world);
        require(space == HH_SPACE_WORLD || space == HH_SPACE_PARENT, HH_ERROR_VALUE,
                "a space is HH_SPACE_WORLD or HH_SPACE_PARENT");
        const Entity entity = player_of(host, player);
        BodyRigSlot& slot = rig_of(host, entity);
        pose_skeleton(*slot.rig, host.world.body_measures.at(entity),
                      host.world.render_pose.at(entity), shown_hand_joints(host, entity),
                      slot.pose);
        const std::vector<Pose>& posed =
            space == HH_SPACE_WORLD ? slot.pose.joint_ws : slot.pose.joint_ls;
        write_list(posed.size(), joints, capacity, count,
                   [&](std::size_t i) { return to_c(posed[i]); });
    });
}

hh_result hh_player_skeleton_joint(const hh_world* world, hh_player player, size_t joint,
                                   const char** name, int32_t* parent) {
    return call([&] {
        const hh_world& host = world_of(world);
        const BodyRigSlot* const slot = host.body_rigs.find(player_of(host, player));
        require(slot != nullptr, HH_ERROR_STATE, "the player has no body rig");
        require(joint < slot->rig->joints.size(), HH_ERROR_VALUE, "no joint with this index");
        const BodyRig::Joint& found = slot->rig->joints[joint];
        if (name != nullptr) {
            *name = found.name.c_str();
        }
        if (parent != nullptr) {
            *parent = found.parent;
        }
    });
}

hh_result hh_default_grip_def_sized(hh_grip_def* filled, size_t size) {
    hh_grip_def def{};
    def.hands[0].wrist = def.hands[1].wrist = hh_identity_pose();
    def.snap_radius_m = AuthoredGrip{}.snap_radius_m;
    def.snap_angle_rad = AuthoredGrip{}.snap_angle_rad;
    return write_default(filled, size, def);
}

hh_result hh_body_add_grip(hh_world* world, hh_body body, const hh_grip_def* wanted) {
    return call([&] {
        hh_world& host = world_of(world);
        const hh_grip_def def = read_def(wanted, hh_default_grip_def());
        const Entity entity = body_of(host, body);
        AuthoredGrip grip;
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            grip.hands[side] = read_hand(host, entity, def.hands[side]);
        }
        grip.priority = def.priority;
        constexpr double k_max_radius_m = 10.0;
        grip.snap_radius_m =
            checked(def.snap_radius_m, 0.0, k_max_radius_m, "snap_radius_m must lie in [0, 10]");
        grip.snap_angle_rad =
            checked(def.snap_angle_rad, 0.0, k_pi, "snap_angle_rad must lie in [0, pi]");
        AuthoredGrips* grips = host.world.authored_grips.find(entity);
        require(grips == nullptr || grips->count < k_max_authored_grips, HH_ERROR_STATE,
                "a body has at most 4 authored grips");
        if (grips == nullptr) {
            grips = &host.world.authored_grips.add(entity);
        }
        grips->grips[grips->count++] = grip;
    });
}
