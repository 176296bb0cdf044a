#include "tools/lab/runtime_run.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "components/play_space.hpp"
#include "engine/core/profile.hpp"

namespace handhold::lab {
namespace {

constexpr std::array k_solve = {Stage::predict_bodies, Stage::build_constraints,
                                Stage::solve_phases,   Stage::solve_velocities,
                                Stage::book_momentum,  Stage::record_valid_poses};
// Their times include place_colliders, which runs before each of them.
constexpr std::array k_contacts = {Stage::update_grabs, Stage::find_contacts};

double sum_us(const StageStats& stats, std::span<const Stage> stages) {
    double sum = 0.0;
    for (const Stage stage : stages) {
        sum += stats.stage_us[static_cast<std::size_t>(stage)];
    }
    return sum;
}

// A box's +x face as a one-sided mesh of two by two quads, facing outward.
std::shared_ptr<const Mesh> face_mesh(const Vec3& half_m) {
    auto mesh = std::make_shared<Mesh>();
    constexpr std::uint32_t k_quads = 2;
    for (std::uint32_t j = 0; j <= k_quads; ++j) {
        for (std::uint32_t i = 0; i <= k_quads; ++i) {
            const double u = 2.0 * i / k_quads - 1.0;
            const double v = 2.0 * j / k_quads - 1.0;
            mesh->positions.emplace_back(half_m.x(), u * half_m.y(), v * half_m.z());
        }
    }
    for (std::uint32_t j = 0; j < k_quads; ++j) {
        for (std::uint32_t i = 0; i < k_quads; ++i) {
            const std::uint32_t a = j * (k_quads + 1) + i;
            const std::uint32_t c = a + k_quads + 1;
            mesh->triangles.push_back({a, a + 1, c + 1});
            mesh->triangles.push_back({a, c + 1, c});
        }
    }
    return mesh;
}

// Makes a hand grip the body from the first frame on, whether or not a surface is near. Button and
// tracking are set as if the hand had closed before.
void write_grip(World& world, const PlayerEntities& player, const LabScene& scene,
                const LabHold& hold, Entity body) {
    const Entity hand = player.hands[index_of(hold.side)];
    const Pose hand_ps = hold.hand_ps(0.0);
    HandTracking& tracking = world.hand_tracking.at(hand);
    tracking.pose_ps = tracking.start_ps = tracking.sample_ps = hand_ps;
    tracking.state = TrackingState::tracked;
    tracking.pressed = tracking.raw_pressed = true;
    HandHistory& history = world.hand_history.at(hand);
    history.entries[0] = {0.0, hand_ps};
    history.next = history.count = 1;

    const Pose& body_ws = world.body_pose.at(body).pose_ws;
    const RigidBody& rigid = world.body.at(body);
    const bool holds = is_light(rigid, scene.tuning.phases.heavy_body_kg);
    Grab& grab = world.grab.at(hand);
    grab.kind = holds ? GripKind::held : GripKind::surface;
    grab.phase = GrabPhase::holding;
    grab.body = body;
    grab.anchor_bs = {hold.anchor_bs, body_ws.rotation.conjugate() * hand_ps.rotation};
    grab.target_ps = hand_ps;
    grab.jointed = holds && hold.point_only;
    if (holds) {
        HeadIgnores& ignores = world.head_ignores.at(player.player);
        ignores.bodies[index_of(hold.side)] = body;
    }
}

}  // namespace

RuntimeRun::RuntimeRun(const LabScene& scene, Holder holder, double hz, PositionSolver solver)
    : scene_(scene), holder_(holder), dt_s_(1.0 / hz), solver_(solver) {
    add_bodies();
    add_joints();
    if (holder_ == Holder::player) {
        for (std::size_t i = 0; i < scene.players.size(); ++i) {
            add_player(i);
        }
    }
    for (std::size_t i = 0; i < scene.holds.size(); ++i) {
        if (holder_ == Holder::player) {
            add_player_hand(i);
        } else {
            add_kinematic_hand(i);
        }
    }
    caches_ = std::make_unique<FrameCaches>(shapes_);
}

void RuntimeRun::add_bodies() {
    for (const LabBody& body : scene_.bodies) {
        RigidBody rigid;
        rigid.kind = body.kind;
        rigid.restitution = body.restitution;
        rigid.friction = body.friction;
        if (body.kind == BodyKind::free) {
            rigid.mass_kg = body.mass_kg;
            rigid.inertia_kgm2 = body.inertia_kgm2();
        }
        ShapeId shape = k_no_shape;
        if (body.collides) {
            shape = body.is_mesh   ? shapes_.add_mesh(face_mesh(body.half_m))
                    : body.is_ball ? shapes_.add_sphere(body.half_m.x())
                                   : shapes_.add_box(body.half_m);
        }
        bodies_.push_back(
            add_body(world_, {"body/" + body.name, rigid, body.pose_ws, body.velocity, shape}));
    }
}

void RuntimeRun::add_joints() {
    for (std::size_t i = 0; i < scene_.joints.size(); ++i) {
        const LabJoint& from = scene_.joints[i];
        Joint joint;
        joint.kind = from.kind;
        joint.a = from.a == k_world ? k_no_entity : bodies_[static_cast<std::size_t>(from.a)];
        joint.b = bodies_[static_cast<std::size_t>(from.b)];
        joint.frame_a_bs = from.frame_a;
        joint.frame_b_bs = from.frame_b;
        joint.limited = from.limited;
        joint.lower = from.lower;
        joint.upper = from.upper;
        add_joint(world_, {"joint/" + std::to_string(i), joint});
    }
}

void RuntimeRun::add_player(std::size_t index) {
    const LabPlayer& player = scene_.players[index];
    const std::string name = "player/" + std::to_string(index);
    PlayerDescription description{name,
                                  {},
                                  {player.origin_ws, Quat::Identity()},
                                  player.velocity_mps,
                                  shapes_.add_sphere(scene_.tuning.head.radius_m)};
    players_.push_back(handhold::add_player(world_, description));
    for (const Entity hand : players_.back().hands) {
        world_.controller_to_hand.add(hand, {});  // hands are given directly, without controllers
    }
}

void RuntimeRun::add_player_hand(std::size_t hold_index) {
    const LabHold& hold = scene_.holds[hold_index];
    write_grip(world_, players_[static_cast<std::size_t>(hold.player)], scene_, hold,
               bodies_[static_cast<std::size_t>(hold.body)]);
}

void RuntimeRun::add_kinematic_hand(std::size_t hold_index) {
    const LabHold& hold = scene_.holds[hold_index];
    const Vec3& origin = scene_.players[static_cast<std::size_t>(hold.player)].origin_ws;
    const std::string name = "hand/" + std::to_string(hold_index);
    const Pose start = Pose{origin, Quat::Identity()} * hold.hand_ps(0.0);
    RigidBody rigid;
    rigid.kind = BodyKind::kinematic;
    const Entity hand = add_body(world_, {name, rigid, start, {}, k_no_shape});
    Joint joint;
    joint.kind = hold.point_only ? JointKind::ball : JointKind::fixed;
    joint.a = hand;
    joint.b = bodies_[static_cast<std::size_t>(hold.body)];
    const Pose& held_ws = world_.body_pose.at(joint.b).pose_ws;
    joint.frame_b_bs = {hold.anchor_bs, held_ws.rotation.conjugate() * start.rotation};
    kinematic_hands_.push_back(hand);
    const bool holds_free =
        scene_.bodies[static_cast<std::size_t>(hold.body)].kind == BodyKind::free;
    hand_joints_.push_back(holds_free ? add_joint(world_, {name + "/joint", joint}) : k_no_entity);
}

// Moves a kinematic body as a host program does: before the step, sets pose and velocity for the
// end of the frame.
void RuntimeRun::drive(World& world, Entity body, const Pose& pose_ws) const {
    Pose& now = world.body_pose.at(body).pose_ws;
    world.body_start.at(body).pose_ws = now;
    world.body_velocity.at(body) = {
        (pose_ws.position - now.position) / dt_s_,
        rotation_to_vector((pose_ws.rotation * now.rotation.conjugate()).normalized()) / dt_s_};
    now = pose_ws;
}

void RuntimeRun::drive_all(World& world, double end_s) const {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        if (scene_.bodies[i].drive) {
            drive(world, bodies_[i], scene_.bodies[i].drive(end_s));
        }
    }
    for (std::size_t i = 0; i < kinematic_hands_.size(); ++i) {
        const LabHold& hold = scene_.holds[i];
        const Vec3& origin = scene_.players[static_cast<std::size_t>(hold.player)].origin_ws;
        drive(world, kinematic_hands_[i], Pose{origin, Quat::Identity()} * hold.hand_ps(end_s));
        if (end_s >= hold.release_s && !is_null(hand_joints_[i])) {
            destroy(world, hand_joints_[i]);  // ignores a joint that no longer exists
        }
    }
}

// Makes one tracking sample per player, at the frame's end, with the hands at their scripted poses.
void RuntimeRun::sample_devices(double end_s) {
    samples_.assign(players_.size(), TrackingSample{});
    inputs_.assign(players_.size(), PlayerInput{});
    for (std::size_t i = 0; i < players_.size(); ++i) {
        samples_[i].t_s = end_s;
        samples_[i].head_ps.position = scene_.players[i].head_ps - scene_.tuning.head.center_m;
    }
    for (const LabHold& hold : scene_.holds) {
        if (holder_ == Holder::player) {
            TrackingSample& sample = samples_[static_cast<std::size_t>(hold.player)];
            sample.controllers[index_of(hold.side)] = {hold.hand_ps(end_s), end_s < hold.release_s};
        }
    }
    for (std::size_t i = 0; i < players_.size(); ++i) {
        inputs_[i] = {players_[i].player, std::span(samples_).subspan(i, 1), {}};
    }
}

void RuntimeRun::warm_up() {
    World copy = world_;
    drive_all(copy, end_s());
    sample_devices(end_s());
    step_frame_with(solver_, copy, *caches_, scene_.tuning, {dt_s_, inputs_}, stats_);
}

void RuntimeRun::step(FrameRecord& record) {
    const double t_s = end_s();
    drive_all(world_, t_s);
    sample_devices(t_s);
    const std::int64_t begin_ns = stage_now_ns();
    step_frame_with(solver_, world_, *caches_, scene_.tuning, {dt_s_, inputs_}, stats_);
    record.frame_us = 1e-3 * static_cast<double>(stage_now_ns() - begin_ns);
    record.solve_us = sum_us(stats_, k_solve);
    record.step_us = record.solve_us + sum_us(stats_, k_contacts);
    record.iterations = static_cast<int>(stats_.newton_iterations);
    record.t_s = t_s;
    record.dt_s = dt_s_;
    read_bodies(record);
    read_hands(record);
}

void RuntimeRun::read_bodies(FrameRecord& record) const {
    record.poses.clear();
    record.velocities.clear();
    for (const Entity body : bodies_) {
        record.poses.push_back(world_.body_pose.at(body).pose_ws);
        record.velocities.push_back(world_.body_velocity.at(body));
    }
    for (const PlayerEntities& player : players_) {
        record.poses.push_back(world_.player_origin.at(player.player).pose_ws);
        record.velocities.push_back(
            {world_.player_velocity.at(player.player).linear_mps, Vec3::Zero()});
    }
    for (const Entity hand : kinematic_hands_) {
        record.poses.push_back(world_.body_pose.at(hand).pose_ws);
        record.velocities.push_back(world_.body_velocity.at(hand));
    }
}

void RuntimeRun::read_hands(FrameRecord& record) const {
    record.targets.clear();
    record.held.clear();
    for (const LabHold& hold : scene_.holds) {
        const auto player = static_cast<std::size_t>(hold.player);
        const bool is_driven = holder_ == Holder::kinematic;
        const Pose origin_ws = is_driven ? Pose{scene_.players[player].origin_ws, Quat::Identity()}
                                         : record.poses[scene_.bodies.size() + player];
        record.targets.push_back(origin_ws * hold.hand_ps(record.t_s));
        const bool held = is_driven
                              ? record.t_s < hold.release_s
                              : world_.grab.at(players_[player].hands[index_of(hold.side)]).kind !=
                                    GripKind::none;
        record.held.push_back(held ? 1 : 0);
    }
}

}  // namespace handhold::lab
