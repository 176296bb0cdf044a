#pragma once

#include <functional>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "components/body.hpp"
#include "components/joint.hpp"
#include "components/tracking.hpp"
#include "components/tuning.hpp"

// Benchmark scenes for constraint solvers, as plain descriptions. runtime_run builds a World from a
// scene, bullet_run a Bullet world, and scene_files the JSON. There is no gravity; hands and driven
// bodies are functions of time. docs/reference/lab.md lists the scenes.
namespace handhold::lab {

inline constexpr int k_world = -1;
inline constexpr double k_never_s = std::numeric_limits<double>::infinity();

// Who moves the hands. With `kinematic`, there are no players. Every hand is a kinematic body on
// the same path, joined to the body it holds (by a ball joint if point_only, else rigidly).
enum class Holder : std::uint8_t { player, kinematic };

using PathOfTime = std::function<Pose(double t_s)>;

struct LabBody {
    std::string name;
    BodyKind kind = BodyKind::free;
    Pose pose_ws;
    BodyVelocity velocity;
    double mass_kg = 0.0;
    Vec3 half_m = Vec3::Zero();  // half extents of a box
    bool collides = false;       // true: has a collider
    // Fixed body: a one-sided mesh of the box's +x face instead of the box.
    bool is_mesh = false;
    bool is_ball = false;  // true: a ball of radius half_m.x() instead of the box
    double restitution = 0.0;
    double friction = 0.0;
    PathOfTime drive;  // kinematic body: its pose over time

    Vec3 inertia_kgm2() const;
};

// Bodies must stay where normal . x >= offset_m, in the frame of `body`. Used only to measure
// penetration; the walls that stop bodies are bodies themselves.
struct LabPlane {
    Vec3 normal = Vec3::UnitY();
    double offset_m = 0.0;
    int body = k_world;
};

struct LabJoint {
    JointKind kind = JointKind::ball;
    int a = k_world;
    int b = 0;
    Pose frame_a;  // axis: local x
    Pose frame_b;
    bool limited = false;
    double lower = 0.0;  // m or rad
    double upper = 0.0;
};

struct LabPlayer {
    Vec3 origin_ws = Vec3::Zero();
    Vec3 head_ps = Vec3(0.0, 0.6, 1.5);  // centre of the head's collider; constant
    Vec3 velocity_mps = Vec3::Zero();
    // True: the head is tested against the planes. False if the head can pass beside a wall,
    // because planes are infinite.
    bool head_meets_planes = false;
};

// A hand that holds a body from the start, whether or not a surface is near.
struct LabHold {
    int player = 0;
    HandSide side = HandSide::right;
    int body = 0;
    Vec3 anchor_bs = Vec3::Zero();  // hand's position in the body's frame
    PathOfTime hand_ps;
    double release_s = k_never_s;
    // The hand holds only a point and may rotate, as it does with heavy bodies and with bodies
    // jointed to something fixed.
    bool point_only = false;
};

// State of a scene at the end of one frame.
struct FrameRecord {
    double t_s = 0.0;
    double dt_s = 0.0;
    // First the bodies, in the order of LabScene::bodies. Then the players' origins or, with
    // Holder::kinematic, the hands in the order of LabScene::holds.
    std::vector<Pose> poses;
    std::vector<BodyVelocity> velocities;
    // Both are indexed as LabScene::holds. Poses of the tracked hands in the world, and 1 for each
    // hand that still holds its body.
    std::vector<Pose> targets;
    std::vector<std::uint8_t> held;
    double step_us = 0.0;   // thread CPU time of the physics stages, contacts included
    double solve_us = 0.0;  // the same without placing colliders and finding contacts
    double frame_us = 0.0;  // time of the whole frame
    int iterations = 0;
};

// Named results of a scene, for example the error against its closed form.
class Figures {
  public:
    void set(const std::string& name, double value) { values_[name] = value; }
    void take_worst(const std::string& name, double value);
    const std::map<std::string, double>& values() const { return values_; }

  private:
    std::map<std::string, double> values_;
};

struct LabScene {
    std::string name;
    std::vector<LabBody> bodies;
    std::vector<LabPlayer> players;
    std::vector<LabJoint> joints;
    std::vector<LabHold> holds;
    std::vector<LabPlane> planes;
    Tuning tuning;

    // Until this time, every joint and hand can be satisfied without moving the players, so the
    // players must stay exactly at their start. 0: the scene does not claim this.
    double players_still_until_s = 0.0;
    // From this time on the scene has no external forces, so its momentum must be conserved.
    double closed_from_s = k_never_s;
    bool closed_in_spin = false;  // angular momentum must be conserved too
    // Called after every frame, unless kinematic hands replace the scene's players.
    std::function<void(const FrameRecord&, Figures&)> watch;
    // The part of the scene that Bullet cannot express; empty: none.
    std::string beyond_bullet;
    // The hand moves where the held body cannot follow, so a player must yield.
    bool needs_player = false;

    int player_id(int player) const { return static_cast<int>(bodies.size()) + player; }
    int add_body(LabBody body) {
        bodies.push_back(std::move(body));
        return static_cast<int>(bodies.size()) - 1;
    }
    // Adds a joint whose frames coincide at `frame_ws` in the bodies' current poses.
    void add_joint_at(LabJoint joint, const Pose& frame_ws);
    // Adds a hand at `hand_ws` (time 0) that holds a body.
    void add_hold(LabHold hold);
};

// Adds a free axis-aligned box; returns its index in scene.bodies.
int add_box(LabScene& scene, const std::string& name, double mass_kg, const Vec3& half_m,
            const Vec3& center_ws);

struct SceneOptions {
    int links = 0;  // 0: the scene's default
    std::string masses = "uniform";
    double duration_s = 10.0;
    double hz = 90.0;
    // kinematic: levers, drawers and doors are not pulled beyond their range
    Holder holder = Holder::player;

    int links_or(int count) const { return links > 0 ? links : count; }
};

// Names of all scenes, in the order of docs/reference/lab.md.
std::vector<std::string_view> scene_names();
// Precondition: `name` is in scene_names().
LabScene make_scene(std::string_view name, const SceneOptions& options);
std::vector<std::string_view> mass_patterns();

}  // namespace handhold::lab
