#include "systems/hand/gather_surroundings.hpp"

#include <algorithm>
#include <cmath>

#include "components/play_space.hpp"
#include "engine/core/hash.hpp"

namespace handhold {
namespace {

// Hashes of the bodies near a hand and of their poses relative to the gripped one.
class Signatures {
  public:
    void add(std::uint64_t value) {
        fine_.add(value);
        coarse_.add(value);
    }
    // Rounded to 0.1 mm and axes to 1e-4, so that tiny numerical differences rarely change the fine
    // hash.
    void add(const PlacedMesh& placed) {
        constexpr double k_fine_step = 1e-4;
        const double lever_m = std::max(k_search_lever_m, placed.mesh->contact_bvh.farthest_m());
        fine_.add(placed.mesh->digest);
        coarse_.add(placed.mesh->digest);
        add(placed.pose, k_fine_step, k_fine_step, fine_);
        add(placed.pose, k_search_step_m, k_search_step_m / lever_m, coarse_);
    }
    // Never 0, which means that there is no body.
    std::uint64_t fine() const { return fine_.value() | 1U; }
    std::uint64_t coarse() const { return coarse_.value() | 1U; }

  private:
    static void add(const Pose& pose, double step_m, double axis_step, HashStream& stream) {
        constexpr double k_max_steps = 1e15;
        const auto add_rounded = [&](double steps) {
            stream.add(std::floor(std::clamp(steps, -k_max_steps, k_max_steps) + 0.5));
        };
        const Vec3 x_axis = pose.rotation * Vec3::UnitX();
        const Vec3 y_axis = pose.rotation * Vec3::UnitY();
        for (int axis = 0; axis < 3; ++axis) {
            add_rounded(pose.position[axis] * (1.0 / step_m));
            add_rounded(x_axis[axis] * (1.0 / axis_step));
            add_rounded(y_axis[axis] * (1.0 / axis_step));
        }
    }

    HashStream fine_;
    HashStream coarse_;
};

class Gatherer {
  public:
    Gatherer(const GatherSurroundingsIo& io, StageStats& stats) : io_(io), stats_(stats) {}

    void gather(std::size_t index, HandSurroundings& out) const {
        const Entity hand = io_.owner.owners()[index];
        const HandOwner& owner = io_.owner.elements()[index];
        const Grab& grab = io_.grab.at(hand);
        const auto& [origin_ws, scale] = io_.origin.at(owner.player);
        const Pose tracked_ws = origin_ws * io_.hand.at(hand).pose_ps;
        out.hand = hand;
        const HandRigChoice* const choice = io_.rig_choice.find(hand);
        out.rig = choice != nullptr && choice->index < io_.more_rigs.size()
                      ? &io_.more_rigs[choice->index]
                      : &io_.rigs[index_of(owner.side)];
        out.body = k_no_entity;
        out.body_ws = {};
        out.scale = scale;
        out.wrist_bs = tracked_ws;
        out.wrist_bs.position /= scale;
        out.meshes.clear();
        out.signature = 0;
        out.search_signature = 0;
        out.authored = nullptr;
        out.is_gripping = grab.kind != GripKind::none;
        out.eye_bs.reset();
        const bool body_exists =
            io_.body_pose.contains(grab.body) || io_.origin.contains(grab.body);
        if (grab.kind == GripKind::none || !body_exists) {
            return;
        }
        const BodyHold* const hold_on_part =
            grab.kind == GripKind::player ? io_.body_hold.find(hand) : nullptr;
        out.body_ws = gripped_pose_ws(io_.body_pose, io_.origin, io_.head, grab.body, hold_on_part);
        out.wrist_bs = grab.anchor_bs;
        out.wrist_bs.position /= scale;
        if (const HeadTracking& head = io_.head.at(owner.player);
            head.state != TrackingState::never) {
            const Vec3 eye_ws = (origin_ws * head.pose_ps).position;
            out.eye_bs = inverse_transform_point(out.body_ws, eye_ws) / scale;
        }
        if (may_turn_on_grip(grab)) {
            out.wrist_bs.rotation =
                (out.body_ws.rotation.conjugate() * tracked_ws.rotation).normalized();
        }
        if (const AuthoredHold* const hold = io_.authored_hold.find(hand);
            hold != nullptr && hold->body == grab.body) {
            out.authored = &hold->hand;
        }
        Signatures signatures;
        const GripMesh* const mesh = hold_on_part != nullptr
                                         ? enter_part(*hold_on_part, grab.body, out, signatures)
                                         : mesh_of(grab.body, scale);
        if (mesh != nullptr) {
            out.body = grab.body;
            out.meshes.push_back({mesh, {}});
            add_to_signatures(signatures, grab.body, out.meshes.back());
            add_nearby_meshes(out, signatures);
            out.signature = signatures.fine();
            out.search_signature = signatures.coarse();
        } else if ((io_.meshes.of_shapes != nullptr || !io_.meshes.of_bodies.empty()) &&
                   io_.body_pose.contains(grab.body)) {
            stats_.count(Fallback::body_no_surface);
        }
    }

  private:
    // True if the hand may turn on its anchor. False for a free object held in one hand: it turns
    // with the hand.
    static bool may_turn_on_grip(const Grab& grab) {
        return grab.kind != GripKind::held || grab.jointed || grab.two_handed;
    }

    // Returns the mesh of the part that the hand holds, and transforms `out` into the mesh's frame.
    // Null if hands are not fitted to parts.
    const GripMesh* enter_part(const BodyHold& hold, Entity player, HandSurroundings& out,
                               Signatures& signatures) const {
        if (io_.meshes.of_shapes == nullptr) {
            return nullptr;
        }
        const PartCapsule capsule = resized(
            part_capsule(io_.shown.at(player), io_.measures.at(player), hold.part), out.scale);
        signatures.add(static_cast<std::uint64_t>(hold.part));
        const Pose frame = PartMeshes::frame_of_mesh(capsule);
        out.body_ws = out.body_ws * Pose{out.scale * frame.position, frame.rotation};
        out.wrist_bs = inverse(frame) * out.wrist_bs;
        if (out.eye_bs) {
            out.eye_bs = inverse_transform_point(frame, *out.eye_bs);
        }
        return io_.meshes.of_parts.find(capsule);
    }

    // The body's mesh in the metres of hands of that scale; null: it has none.
    const GripMesh* mesh_of(Entity body, double scale) const {
        const std::shared_ptr<const GripMesh>* const mesh = mesh_of(body);
        return mesh == nullptr ? nullptr : of_scale(*mesh, scale);
    }
    const GripMesh* of_scale(const std::shared_ptr<const GripMesh>& mesh, double scale) const {
        return scale == 1.0 ? mesh.get() : &io_.meshes.resized.get(mesh, scale);
    }
    const std::shared_ptr<const GripMesh>* mesh_of(Entity body) const {
        if (!io_.body_pose.contains(body)) {
            return nullptr;
        }
        if (const BodySurface* const own = io_.meshes.of_bodies.find(body)) {
            return &own->mesh;
        }
        const Collider* const collider = io_.collider.find(body);
        const GripMeshLibrary* const of_shapes = io_.meshes.of_shapes;
        const bool is_known =
            of_shapes != nullptr && collider != nullptr && of_shapes->has(collider->shape);
        return is_known ? &of_shapes->shared_at(collider->shape) : nullptr;
    }

    // Adds the body, its mesh's digest and its pose.
    void add_to_signatures(Signatures& signatures, Entity body, const PlacedMesh& placed) const {
        signatures.add(io_.persistent_id.at(body).value);
        signatures.add(placed);
    }

    void add_nearby_meshes(HandSurroundings& out, Signatures& signatures) const {
        const Vec3 palm_ws = transform_point(
            out.body_ws, out.scale * transform_point(out.wrist_bs, out.rig->palm_center_hs));
        if (io_.near.collision == nullptr) {
            for (const Entity body : io_.near.bodies) {
                add_if_near(body, palm_ws, out, signatures);
            }
            return;
        }
        // Colliders are at the poses of the last contact search, up to millimetres from their
        // bodies. Grip meshes differ from their colliders by less than k_slack_m.
        constexpr double k_slack_m = 0.05;
        const Vec3 reach_m = Vec3::Constant(out.scale * k_hand_length_m + k_slack_m);
        for (const std::uint64_t id :
             io_.near.collision->find_near(palm_ws - reach_m, palm_ws + reach_m)) {
            const auto proxy =
                std::ranges::lower_bound(io_.near.proxies, id, {}, &ColliderProxy::id);
            const auto i = static_cast<std::size_t>(proxy - io_.near.proxies.begin());
            if (proxy != io_.near.proxies.end() && proxy->id == id) {
                add_if_near(io_.near.bodies[i], palm_ws, out, signatures);
            }
        }
    }

    void add_if_near(Entity body, const Vec3& palm_ws, HandSurroundings& out,
                     Signatures& signatures) const {
        const std::shared_ptr<const GripMesh>* const mesh =
            body == out.body ? nullptr : mesh_of(body);
        if (mesh == nullptr) {
            return;
        }
        const Pose& pose_ws = io_.body_pose.at(body).pose_ws;
        if (is_in_reach(**mesh, inverse_transform_point(pose_ws, palm_ws), out.scale)) {
            Pose placed = inverse(out.body_ws) * pose_ws;
            placed.position /= out.scale;
            out.meshes.push_back({of_scale(*mesh, out.scale), placed});
            add_to_signatures(signatures, body, out.meshes.back());
        }
    }

    // Whether a hand of that scale may touch the mesh. Resizing a mesh costs much more than the
    // exact distance.
    static bool is_in_reach(const GripMesh& mesh, const Vec3& palm_bs, double scale) {
        const double reach_m = scale * k_hand_length_m;
        return mesh.contact_bvh.may_be_near(palm_bs, reach_m) &&
               (scale == 1.0 || mesh.contact_bvh.closest_point(palm_bs, reach_m));
    }

    const GatherSurroundingsIo& io_;
    StageStats& stats_;
};

}  // namespace

void gather_surroundings(const GatherSurroundingsIo& io, std::size_t first, std::size_t last,
                         StageStats& stats) {
    const Gatherer gatherer(io, stats);
    for (std::size_t index = first; index < last; ++index) {
        gatherer.gather(index, io.surroundings[index]);
    }
}

void gather_surroundings(const GatherSurroundingsIo& io, StageStats& stats) {
    io.surroundings.resize(io.owner.size());
    gather_surroundings(io, 0, io.owner.size(), stats);
}

}  // namespace handhold
