#pragma once

// A small engine around Open Dynamics Engine, which owns every body: what a host of level (b) or
// (c) has anyway. Nothing in it knows Handhold, except for the functions named `...for_hands`.
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <handhold/handhold.hpp>
#include <ode/ode.h>

namespace host {

inline hh::Vec3 operator+(hh::Vec3 a, hh::Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline hh::Vec3 operator-(hh::Vec3 a, hh::Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline hh::Vec3 operator*(double s, hh::Vec3 v) { return {s * v.x, s * v.y, s * v.z}; }
double length(hh::Vec3 v);
hh::Vec3 cross(hh::Vec3 a, hh::Vec3 b);
hh::Vec3 rotate(hh::Quat q, hh::Vec3 v);
hh::Quat multiply(hh::Quat a, hh::Quat b);
hh::Quat conjugate(hh::Quat q);
hh::Quat turn_about(hh::Vec3 unit_axis, double angle_rad);
inline hh::Vec3 at(const hh::Pose& pose, hh::Vec3 point) {
    return pose.position + rotate(pose.rotation, point);
}

enum class Kind { fixed, driven, dynamic };

// A box of the engine, and the id that it has in Handhold's world.
struct Box {
    Kind kind = Kind::fixed;
    dBodyID body = nullptr;  // null: fixed
    dGeomID geom = nullptr;
    hh::Vec3 half_m{};
    hh::Body id{};

    hh::Pose pose() const;
};

struct PlayerBody {
    hh::Player id{};
    dBodyID body = nullptr;
};

class Engine {
  public:
    Engine();
    ~Engine();
    Engine(const Engine&) = delete;
    Engine& operator=(const Engine&) = delete;

    std::size_t add_box(Kind kind, hh::Vec3 half_m, hh::Pose pose, double mass_kg);
    // About the world's vertical axis through `at`; limits against where the body is now.
    void add_hinge(std::size_t box, hh::Vec3 at, double low_rad, double high_rad);
    // Before a step: where a driven body will be at its end.
    void drive(std::size_t box, hh::Pose end, double dt_s);
    // Contacts, constraints, integration.
    void step(double dt_s);

    const Box& box(std::size_t i) const { return boxes_[i]; }
    Box& box(std::size_t i) { return boxes_[i]; }
    std::size_t box_count() const { return boxes_.size(); }
    hh::Vec3 velocity(std::size_t box) const;
    // Held bodies that something else moves do not move in the solver, but push what does.
    void set_kinematic(std::size_t box, bool is_kinematic);
    void set_motion(std::size_t box, hh::Pose pose, hh::Vec3 velocity, hh::Vec3 spin);

    // --- For Handhold ---
    void register_for_hands(hh::World& world);
    hh_surface_query queries_for_hands();
    // What Handhold must know before each step.
    void place_for_hands(hh::World& world);
    void add_player_for_hands(hh::Player id);
    // One step of level (c). False if a call failed.
    bool step_for_hands(hh::World& world, double dt_s, std::span<const hh_player_input> inputs);
    double hands_us() const { return hands_us_; }  // of begin and end of all steps
    long queries() const { return queries_; }      // that Handhold made

  private:
    struct Driven {
        std::size_t box = 0;
        hh::Pose end{};
    };
    const Box* find(hh::Body id) const;
    bool cast_ray(hh::Vec3 from, hh::Vec3 to, std::span<const hh_body> skip,
                  hh_surface_hit& hit) const;
    bool closest_point(hh::Vec3 point, double max_m, std::span<const hh_body> skip,
                       hh_surface_hit& hit) const;
    void set_player(const hh_player_motion& motion);
    void add_hand(const hh_hand_constraint& hand);
    void add_direction(const Box& box, const hh_hand_constraint& hand);
    dBodyID player_body(hh::Player id) const;

    dWorldID world_;
    dSpaceID space_;
    dJointGroupID contacts_;
    std::vector<dJointID> hands_;
    std::vector<Box> boxes_;
    std::vector<Driven> driven_;
    std::vector<PlayerBody> players_;
    std::vector<hh_body_motion> motions_;
    std::vector<hh_solved_player> solved_;
    double hands_us_ = 0.0;
    double step_s_ = 0.0;
    long queries_ = 0;
};

// The point of a solid box nearest to `point`, with the normal out of it. Returns the distance, 0
// inside.
double closest_on_box(const hh::Pose& pose, hh::Vec3 half_m, hh::Vec3 point, hh::Vec3& nearest,
                      hh::Vec3& normal);
// Where the segment first crosses the box's surface, as a fraction; above 1: nowhere.
double cast_on_box(const hh::Pose& pose, hh::Vec3 half_m, hh::Vec3 from, hh::Vec3 to,
                   hh::Vec3& normal);

}  // namespace host
