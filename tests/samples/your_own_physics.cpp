// The guide's host with physics of its own: a wall, a crate, and a solver of a few lines. First the
// host's solver moves players by Handhold's hand constraints, then the host moves them itself.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include <handhold/handhold.hpp>

namespace {

constexpr double k_dt_s = 1.0 / 90.0;

struct Box {  // of your engine; its boxes are not turned
    hh::Vec3 position;
    hh::Vec3 half_m;
    hh::Vec3 velocity;
    hh::Body id;
    bool is_movable = false;
};
using Boxes = std::vector<Box>;

hh::Vec3 operator+(hh::Vec3 a, hh::Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
hh::Vec3 operator-(hh::Vec3 a, hh::Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
hh::Vec3 operator*(double s, hh::Vec3 v) { return {s * v.x, s * v.y, s * v.z}; }
std::array<double, 3> axes(hh::Vec3 v) { return {v.x, v.y, v.z}; }

bool is_skipped(const Box& box, const hh_body* skip, size_t count) {
    return std::any_of(skip, skip + count, [&](hh_body id) { return id == box.id; });
}

// Nearest point of a box's surface. False if it is farther away than max_m.
bool closest_on(const Box& box, hh::Vec3 point, double max_m, hh_surface_hit& hit) {
    const auto p = axes(point);
    const auto c = axes(box.position);
    const auto h = axes(box.half_m);
    std::array<double, 3> q = p;
    std::array<double, 3> n = {};
    double square = 0.0;
    std::size_t exit = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        q[i] = std::clamp(p[i], c[i] - h[i], c[i] + h[i]);
        n[i] = p[i] - q[i];
        square += n[i] * n[i];
        exit = h[i] - std::fabs(p[i] - c[i]) < h[exit] - std::fabs(p[exit] - c[exit]) ? i : exit;
    }
    if (square == 0.0) {  // inside: out by the nearest face
        n[exit] = std::copysign(1.0, p[exit] - c[exit]);
        q[exit] = c[exit] + n[exit] * h[exit];
    }
    hit = {box.id, {q[0], q[1], q[2]}, {n[0], n[1], n[2]}, std::sqrt(square)};
    return hit.distance_m <= max_m;
}

// Marches along the segment; your engine casts rays better.
bool cast_ray(const Boxes& boxes, hh::Vec3 from, hh::Vec3 to, const hh_body* skip, size_t count,
              hh_surface_hit& hit) {
    constexpr int k_steps = 1000;
    for (int step = 0; step <= k_steps; ++step) {
        const double t = static_cast<double>(step) / k_steps;
        const hh::Vec3 point = from + t * (to - from);
        for (const Box& box : boxes) {
            if (!is_skipped(box, skip, count) && closest_on(box, point, 0.0, hit)) {
                return step > 0;  // a ray from inside finds nothing in this sketch
            }
        }
    }
    return false;
}

// [queries]
// Handhold's three questions to your level. `context` is yours.
hh_surface_query queries(const Boxes& boxes) {
    hh_surface_query query = hh_default_surface_query();
    query.context = const_cast<Boxes*>(&boxes);
    query.cast_ray = [](void* context, hh_vec3 from, hh_vec3 to, const hh_body* skip, size_t count,
                        hh_surface_hit* hit) -> std::uint8_t {
        return cast_ray(*static_cast<const Boxes*>(context), from, to, skip, count, *hit);
    };
    query.closest_point = [](void* context, hh_vec3 point, double max_m, const hh_body* skip,
                             size_t count, hh_surface_hit* hit) -> std::uint8_t {
        hh_surface_hit here{};
        bool is_found = false;
        for (const Box& box : *static_cast<const Boxes*>(context)) {
            if (!is_skipped(box, skip, count) && closest_on(box, point, max_m, here)) {
                *hit = here;
                max_m = here.distance_m;
                is_found = true;
            }
        }
        return is_found;
    };
    query.closest_point_on = [](void* context, hh_body body, hh_vec3 point,
                                hh_surface_hit* hit) -> std::uint8_t {
        for (const Box& box : *static_cast<const Boxes*>(context)) {
            if (box.id == body) {
                return closest_on(box, point, HUGE_VAL, *hit);
            }
        }
        return false;
    };
    return query;
}
// [queries]

// Moves a crate by the least way out of the boxes that never move.
hh::Vec3 way_out(const Boxes& boxes, hh::Vec3 crate, hh::Vec3 half_m) {
    std::array<double, 3> out = {};
    for (const Box& box : boxes) {
        if (box.is_movable) {
            continue;
        }
        std::size_t least = 0;
        std::array<double, 3> overlap_m = {};
        for (std::size_t i = 0; i < 3; ++i) {
            overlap_m[i] = axes(box.half_m)[i] + axes(half_m)[i] -
                           std::fabs(axes(crate)[i] - axes(box.position)[i]);
            least = overlap_m[i] < overlap_m[least] ? i : least;
        }
        if (overlap_m[least] > 0.0) {
            out[least] =
                std::copysign(overlap_m[least], axes(crate)[least] - axes(box.position)[least]);
        }
    }
    return {out[0], out[1], out[2]};
}

bool is_movable(const Boxes& boxes, hh_body id) {
    return std::any_of(boxes.begin(), boxes.end(),
                       [&](const Box& box) { return box.id == id && box.is_movable; });
}

// [solver]
// Your solver: hands on the wall move the player, a crate moves with its hand and stops at walls. A
// real one gets a joint for each constraint: tests/hosts/ode_hands.cpp does it for ODE.
void solve(const hh::World& world, Boxes& boxes, std::vector<hh_solved_player>& players) {
    players.clear();
    for (const hh_player_motion& motion : world.player_motions()) {
        hh::Vec3 end = motion.origin + k_dt_s * motion.velocity_mps;
        for (const hh_hand_constraint& hand : world.hand_constraints()) {
            if (hand.player == motion.player && !is_movable(boxes, hand.body)) {
                end = hand.anchor_end.position - hand.target.position;
            }
        }
        players.push_back({motion.player, end, (1.0 / k_dt_s) * (end - motion.origin)});
    }
    for (Box& box : boxes) {
        hh_solved_player* holder = nullptr;
        hh::Vec3 end = box.position + k_dt_s * box.velocity;
        for (const hh_hand_constraint& hand : world.hand_constraints()) {
            // These boxes never turn. Of two hands on one crate the first holds its point.
            if (box.is_movable && hand.body == box.id && hand.rows != HH_ROWS_DIRECTION) {
                holder = &players.front();
                end = holder->origin + hand.target.position - hand.anchor.position;
            }
        }
        const hh::Vec3 out = box.is_movable ? way_out(boxes, end, box.half_m) : hh::Vec3{};
        if (holder != nullptr) {  // the hand stays exact: the player moves back with the crate
            holder->origin = holder->origin + out;
            holder->velocity_mps = holder->velocity_mps + (1.0 / k_dt_s) * out;
        }
        box.velocity = (1.0 / k_dt_s) * (end + out - box.position);
        box.position = end + out;
    }
}
// [solver]

// [step]
// One frame in which hands pull the player through your solver.
bool step(hh::World& world, Boxes& boxes, const hh_player_input& input) {
    std::vector<hh_body_motion> motions;
    std::vector<hh_solved_player> players;
    if (!world.begin_step(k_dt_s, {&input, 1})) {
        return false;
    }
    solve(world, boxes, players);
    for (const Box& box : boxes) {
        motions.push_back({box.id, hh::pose_at(box.position), box.velocity, {}});
    }
    if (!world.place(motions) || !world.end_step(players)) {
        return false;
    }
    for (const hh_velocity_change& change :
         world.velocity_changes()) {  // thrown and limited bodies
        for (Box& box : boxes) {
            box.velocity = box.id == change.body ? change.velocity_mps : box.velocity;
        }
    }
    return true;
}
// [step]

hh::Sample devices_at(double t_s) {
    hh::Sample sample = hh::sample();
    sample.time_s = t_s;
    sample.head.position.y = 1.6;
    const hh::Quat palm_ahead{std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)};
    // The right hand pulls on the wall and lets go. Then the left one presses the crate against the
    // post, which stops it after 0.2 m of 0.3: the player moves back by the rest, and drifts on.
    const double pulled_m = 0.4 * (std::clamp(t_s, 0.5, 1.0) - 0.5);
    const double pressed_m = 0.5 * (std::clamp(t_s, 1.2, 1.8) - 1.2);
    sample.hands[HH_LEFT] = hh::pose_at({-0.2 - pressed_m, 1.4, -0.43}, palm_ahead);
    sample.hands[HH_RIGHT] = hh::pose_at({0.2, 1.4, -0.43 + pulled_m}, palm_ahead);
    sample.grab[HH_LEFT] = t_s >= 0.2 && t_s < 1.9;
    sample.grab[HH_RIGHT] = t_s >= 0.2 && t_s < 1.15;
    return sample;
}

}  // namespace

int main() {
    Boxes boxes = {{{1.0, 1.5, -0.6}, {0.9, 2.0, 0.1}, {}, {}, false},      // a wall
                   {{-0.6, 1.5, -1.0}, {0.1, 2.0, 0.6}, {}, {}, false},     // a post, to the left
                   {{-0.2, 1.48, -0.65}, {0.1, 0.1, 0.15}, {}, {}, true}};  // a crate
    // [register]
    hh::World world;
    const hh_surface_query query = queries(boxes);  // boxes must outlive its use
    if (!world.set_surface_query(query)) {
        return 1;
    }
    for (Box& box : boxes) {
        hh_body_def def = hh::body_def();  // without a shape; static unless it says otherwise
        def.pose.position = box.position;
        if (box.is_movable) {
            def.kind = HH_DYNAMIC;
            def.mass_kg = 5.0;
            def.inertia_kgm2 = {0.05, 0.05, 0.05};
        }
        box.id = *world.add(def);
    }
    const hh::Player you = *world.add(hh::player_def());
    // [register]
    if (!world.use_wrists(you)) {
        return 1;
    }
    double error_m = 0.0;
    double pushed_back_m = 0.0;
    for (int frame = 1; frame <= 180; ++frame) {
        const hh::Sample sample = devices_at(frame * k_dt_s);
        if (!step(world, boxes, hh::input(you, {&sample, 1}))) {
            return 1;
        }
        error_m = std::fmax(error_m, world.stats()->hand_error_m);
        if (frame == 162) {  // the left hand stops
            pushed_back_m = world.pose(you)->origin.position.x;
        }
    }
    const hh_player_pose pulled = *world.pose(you);

    // [locomotion]
    // Or your own locomotion: you say where the player is and what a hand holds.
    const hh::Body wall = boxes.front().id;
    const hh_surface_hit under_palm = *world.find_grip(you, HH_RIGHT);
    if (under_palm.body != wall || !world.hold(you, HH_RIGHT, under_palm.body)) {
        return 1;
    }
    for (int frame = 181; frame <= 270; ++frame) {
        hh::Pose origin = pulled.origin;
        origin.position.y += 0.001 * (frame - 180);  // a lift
        const hh::Sample sample = devices_at(frame * k_dt_s);
        const hh_player_input input = hh::input(you, {&sample, 1});
        if (!world.place(you, origin, {0.0, 0.09, 0.0}) || !world.step_hands(k_dt_s, {&input, 1})) {
            return 1;
        }
    }
    const hh_hand_state hand = *world.hand(you, HH_RIGHT);  // hand.shown stayed on the wall
    // [locomotion]

    std::printf(
        "hand error %.2g mm, pulled %.3f m, pushed back %.3f m, crate at %.3f m/s, "
        "%.3f m from the anchor\n",
        1e3 * error_m, pulled.origin.position.z, pushed_back_m, boxes.back().velocity.x,
        hand.error_m);
    const bool is_right = error_m < 1e-9 && std::fabs(pulled.origin.position.z + 0.2) < 1e-9 &&
                          std::fabs(pushed_back_m - 0.1) < 1e-9 &&
                          std::fabs(boxes.back().velocity.x - 0.5) < 2e-3 && hand.body == wall &&
                          std::fabs(hand.error_m - 0.09) < 1e-9;
    return is_right ? 0 : 1;
}
