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

// The scenes that constraint solvers are measured on, as plain descriptions: one builder makes a
// World of them (runtime_run), another a world of Bullet's own (bullet_run), a third the JSON.
// No gravity; hands and driven bodies are functions of the time. docs/reference/lab.md lists the
// scenes.
namespace handhold::lab {

inline constexpr int k_world = -1;
inline constexpr double k_never_s = std::numeric_limits<double>::infinity();

// kinematic: every hand is a kinematic body on the same way, tied to what it holds by a joint (by a
// ball joint where point_only, else rigidly), and there are no players.
enum class Holder : std::uint8_t { player, kinematic };

using PathOfTime = std::function<Pose(double t_s)>;

struct LabBody {
    std::string name;
    BodyKind kind = BodyKind::free;
    Pose pose_ws;
    BodyVelocity velocity;
    double mass_kg = 0.0;
    Vec3 half_m = Vec3::Zero();  // a box
    bool collides = false;       // has a collider
    bool is_mesh = false;        // fixed: its +x face as a one-sided mesh instead of the box
    double restitution = 0.0;
    double friction = 0.0;
    PathOfTime drive;  // kinematic: where it is

    Vec3 inertia_kgm2() const;
};

// Half a space that nothing may enter: normal . x >= offset; as seen by a body where it moves. Says
// what walls mean to whoever computes penetration; the walls themselves are bodies.
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
    Vec3 head_ps = Vec3(0.0, 0.6, 1.5);  // collider's centre: always there
    Vec3 velocity_mps = Vec3::Zero();
    bool head_meets_planes = false;  // planes have no end, walls do
};

// A hand that holds a body from the beginning, as an authored grip would.
struct LabHold {
    int player = 0;
    HandSide side = HandSide::right;
    int body = 0;
    Vec3 anchor_bs = Vec3::Zero();  // the hand's place in the body's frame
    PathOfTime hand_ps;
    double release_s = k_never_s;
    // What hangs on joints that lead to something fixed is held by a point, and so is what is
    // heavy.
    bool point_only = false;
};

// Everything of one scene at the end of one frame.
struct FrameRecord {
    double t_s = 0.0;
    double dt_s = 0.0;
    // By LabScene::bodies; then the players' origins or, without players, the hands by holds.
    std::vector<Pose> poses;
    std::vector<BodyVelocity> velocities;
    std::vector<Pose> targets;       // by LabScene::holds: the tracked hand in the world
    std::vector<std::uint8_t> held;  // by LabScene::holds: still
    double step_us = 0.0;            // physics stages, thread CPU time
    double frame_us = 0.0;           // the whole frame
    int iterations = 0;
};

// Named results of one scene against its closed form.
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

    // Until then every joint and hand can be met with the players where they were at the start:
    // there they must stay, bit for bit. 0: not a claim of this scene.
    double players_still_until_s = 0.0;
    // From then on nothing acts on the scene from outside: its momentum must stay as it is.
    double closed_from_s = k_never_s;
    bool closed_in_spin = false;  // its angular momentum too
    // Called after every frame, with players.
    std::function<void(const FrameRecord&, Figures&)> watch;
    // What Bullet's rigid bodies cannot express; empty where they can.
    std::string beyond_bullet;
    // The hand goes where what it holds cannot: somebody has to give way.
    bool needs_player = false;

    int player_id(int player) const { return static_cast<int>(bodies.size()) + player; }
    int add_body(LabBody body) {
        bodies.push_back(std::move(body));
        return static_cast<int>(bodies.size()) - 1;
    }
    // A joint whose frames meet at `frame_ws` as the bodies stand.
    void add_joint_at(LabJoint joint, const Pose& frame_ws);
    // A hand at `hand_ws` at time 0 on a body.
    void add_hold(LabHold hold);
};

// A free box that stands along the world's axes; returns its place in scene.bodies.
int add_box(LabScene& scene, const std::string& name, double mass_kg, const Vec3& half_m,
            const Vec3& center_ws);

struct SceneOptions {
    int links = 0;  // 0: the scene's own number
    std::string masses = "uniform";
    double duration_s = 10.0;
    double hz = 90.0;
    Holder holder = Holder::player;  // kinematic: levers, drawers and doors are not pulled too far
};

// All scenes' names, in the order of docs/reference/lab.md.
std::vector<std::string_view> scene_names();
// `name` is one of them.
LabScene make_scene(std::string_view name, const SceneOptions& options);
std::vector<std::string_view> mass_patterns();

}  // namespace handhold::lab
