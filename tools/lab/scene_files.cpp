#include "tools/lab/scene_files.hpp"

#include <charconv>

#include <nlohmann/json.hpp>

#include "components/player.hpp"

namespace handhold::lab {
namespace {

using Json = nlohmann::ordered_json;

Json list(const Vec3& v) { return Json::array({v.x(), v.y(), v.z()}); }

Json frame(const Pose& pose) {
    const Quat& q = pose.rotation;
    return {{"position_m", list(pose.position)},
            {"rotation_xyzw", Json::array({q.x(), q.y(), q.z(), q.w()})}};
}

const char* name_of(BodyKind kind) {
    switch (kind) {
        case BodyKind::fixed:
            return "static";
        case BodyKind::kinematic:
            return "kinematic";
        case BodyKind::free:
            break;
    }
    return "free";
}

const char* name_of(JointKind kind) {
    switch (kind) {
        case JointKind::hinge:
            return "hinge";
        case JointKind::slider:
            return "slider";
        case JointKind::fixed:
            return "fixed";
        case JointKind::ball:
        case JointKind::distance:
            break;
    }
    return "ball";
}

Json body_json(std::size_t id, const std::string& name, double mass_kg, const Vec3& inertia,
               const Vec3& half_m, const char* kind) {
    return {{"id", id},
            {"name", name},
            {"mass_kg", mass_kg},
            {"inertia_kgm2", list(inertia)},
            {"half_m", list(half_m)},
            {"kind", kind}};
}

Json bodies_json(const LabScene& scene, Holder holder) {
    Json bodies = Json::array();
    for (const LabBody& body : scene.bodies) {
        const bool is_free = body.kind == BodyKind::free;
        bodies.push_back(body_json(bodies.size(), body.name, is_free ? body.mass_kg : 0.0,
                                   is_free ? body.inertia_kgm2() : Vec3(Vec3::Zero()), body.half_m,
                                   name_of(body.kind)));
        bodies.back()["collides"] = body.collides;
        bodies.back()["friction"] = body.friction;
        bodies.back()["restitution"] = body.restitution;
    }
    const std::size_t others = holder == Holder::player ? scene.players.size() : scene.holds.size();
    for (std::size_t i = 0; i < others; ++i) {
        const bool is_player = holder == Holder::player;
        bodies.push_back(body_json(bodies.size(),
                                   (is_player ? "player" : "hand") + std::to_string(i),
                                   is_player ? PlayerBody{}.mass_kg : 0.0, Vec3::Zero(),
                                   Vec3::Zero(), is_player ? "player" : "kinematic"));
        if (is_player) {
            // The player's only collider: a sphere at a fixed position in play space.
            bodies.back()["head"] = {{"offset_m", list(scene.players[i].head_ps)},
                                     {"radius_m", scene.tuning.head.radius_m},
                                     {"meets_planes", scene.players[i].head_meets_planes}};
        }
    }
    return bodies;
}

Json joints_json(const LabScene& scene, Holder holder) {
    Json joints = Json::array();
    for (const LabJoint& joint : scene.joints) {
        joints.push_back({{"type", name_of(joint.kind)},
                          {"a", joint.a},
                          {"b", joint.b},
                          {"frame_a", frame(joint.frame_a)},
                          {"frame_b", frame(joint.frame_b)},
                          {"lower", joint.limited ? Json(joint.lower) : Json(nullptr)},
                          {"upper", joint.limited ? Json(joint.upper) : Json(nullptr)}});
    }
    for (std::size_t i = 0; i < scene.holds.size(); ++i) {
        const LabHold& hold = scene.holds[i];
        const bool is_player = holder == Holder::player;
        const std::size_t a =
            scene.bodies.size() + (is_player ? static_cast<std::size_t>(hold.player) : i);
        const Pose hand_ps = hold.hand_ps(0.0);
        const Pose& held = scene.bodies[static_cast<std::size_t>(hold.body)].pose_ws;
        const Pose anchor{hold.anchor_bs, held.rotation.conjugate() * hand_ps.rotation};
        joints.push_back({{"type", "grab"},
                          {"a", a},
                          {"b", hold.body},
                          {"frame_a", frame(is_player ? hand_ps : Pose{})},
                          {"frame_b", frame(anchor)},
                          {"lower", nullptr},
                          {"upper", nullptr},
                          {"rows", hold.point_only ? 3 : 6}});
    }
    return joints;
}

Json planes_json(const LabScene& scene) {
    Json planes = Json::array();
    for (const LabPlane& plane : scene.planes) {
        planes.push_back({{"normal", list(plane.normal)}, {"offset_m", plane.offset_m}});
        if (plane.body != k_world) {
            planes.back()["body"] = plane.body;  // body whose frame the plane is in
        }
    }
    return planes;
}

Json worst_and_p99(const Series& series) {
    return {{"max", series.max()},
            {"p99", series.quantile(0.99)},
            {"worst_frame", series.worst_frame()}};
}

Json times(const Series& series) {
    return {{"median", series.quantile(0.5)},
            {"p99", series.quantile(0.99)},
            {"max", series.max()},
            {"worst_frame", series.worst_frame()}};
}

void append(std::string& text, double value) {
    char digits[32];
    const std::to_chars_result end = std::to_chars(digits, digits + sizeof digits, value);
    text += ',';
    text.append(digits, end.ptr);
}

void append(std::string& text, const Vec3& v) {
    for (const double value : v) {
        append(text, value);
    }
}

void append_row(std::string& text, int frame, const std::string& body, const Pose& pose,
                const BodyVelocity& velocity) {
    text += std::to_string(frame);
    text += ',';
    text += body;
    append(text, pose.position);
    append(text, pose.rotation.x());
    append(text, pose.rotation.y());
    append(text, pose.rotation.z());
    append(text, pose.rotation.w());
    append(text, velocity.linear_mps);
    append(text, velocity.angular_radps);
    text += '\n';
}

}  // namespace

std::string scene_json(const LabScene& scene, Holder holder, const RunLabels& labels,
                       const Measure& measure, const ResidualCurve& curve) {
    Json json = {{"scene", scene.name},     {"solver", labels.solver}, {"hz", labels.hz},
                 {"frames", labels.frames}, {"links", labels.links},   {"masses", labels.masses},
                 {"holder", labels.holder}};
    json["bodies"] = bodies_json(scene, holder);
    json["planes"] = planes_json(scene);
    json["joints"] = joints_json(scene, holder);
    json["joint_error_mm"] = worst_and_p99(measure.joint_mm);
    json["joint_error_deg"] = worst_and_p99(measure.joint_deg);
    json["grab_error_mm"] = worst_and_p99(measure.grab_mm);
    json["player_error_mm"] = {{"max", measure.player_mm.max()}};
    json["penetration_mm"] = {{"max", measure.penetration_mm.max()}};
    json["us_per_step"] = times(measure.step_us);
    json["us_per_solve"] = times(measure.solve_us);
    json["us_per_frame"] = times(measure.frame_us);
    json["iterations"] = {{"median", measure.iterations.quantile(0.5)},
                          {"max", measure.iterations.max()}};
    json["momentum_residual"] = measure.momentum_residual;
    json["scene_figures"] = measure.figures.values();
    if (curve.frame >= 0) {
        json["residual_frame"] = curve.frame;
        json["residual_per_iteration"] = curve.residual_m;
    }
    return json.dump(1) + "\n";
}

FrameCsv::FrameCsv(const LabScene& scene)
    : scene_(scene), text_("frame,body,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz\n") {}

void FrameCsv::take(int frame, const FrameRecord& record) {
    for (std::size_t i = 0; i < record.poses.size(); ++i) {
        append_row(text_, frame, std::to_string(i), record.poses[i], record.velocities[i]);
    }
    for (std::size_t i = 0; i < scene_.holds.size(); ++i) {
        if (record.held[i] != 0) {
            const std::size_t joint = scene_.joints.size() + i;
            // The hand's own velocity is an input and not measured.
            append_row(text_, frame, "grab" + std::to_string(joint), record.targets[i], {});
        }
    }
}

}  // namespace handhold::lab
