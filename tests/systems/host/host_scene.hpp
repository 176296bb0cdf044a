#pragma once

#include <array>
#include <string>

#include <handhold/handhold.hpp>
#include <handhold/math.hpp>

// A host of one player whose palms face -Z, for tests of the C interface.
namespace handhold::test {

inline constexpr double k_step_s = 1.0 / 90.0;
inline constexpr hh::Vec3 k_wall_m = {0.0, 1.5, -0.6};  // position of the scene's wall
inline constexpr hh::Quat k_palm_ahead{0.7071067811865476, 0.0, 0.0, 0.7071067811865476};

inline double distance_m(hh::Vec3 a, hh::Vec3 b) { return hh::length(a - b); }

// A dynamic cube of 0.2 m and 2 kg.
inline hh_body_def crate(hh::World& world, hh::Vec3 position) {
    hh_body_def def = hh::body_def();
    def.kind = HH_DYNAMIC;
    def.mass_kg = 2.0;
    def.shape = *world.add_box({0.1, 0.1, 0.1});
    def.pose.position = position;
    return def;
}

struct HostScene {
    hh::World world;
    hh::Player player{};
    std::array<hh::Vec3, 2> hand_at = {hh::Vec3{-0.2, 1.4, -0.43}, hh::Vec3{0.2, 1.4, -0.43}};
    std::array<bool, 2> closed = {};
    std::string log;  // grips, releases, refusals and slips so far
    int frame = 0;

    explicit HostScene(std::uint32_t grab_layers = ~0U) {
        hh_player_def def = hh::player_def();
        def.name = "player";
        def.grab_layers = grab_layers;
        player = *world.add(def);
        is_good = static_cast<bool>(world.use_wrists(player));
    }
    // A static wall. Its face is at z = -0.5.
    hh::Body add_wall() { return add_wall("wall", HH_STATIC); }
    // The same wall, which the host moves.
    hh::Body add_lift() { return add_wall(nullptr, HH_KINEMATIC); }
    hh::Sample sample() const {
        hh::Sample made = hh::sample();
        made.time_s = world.time_s() + k_step_s;
        made.head.position = {0.0, 1.6, 0.0};
        for (std::size_t side = 0; side < 2; ++side) {
            made.hands[side] = hh::pose_at(hand_at[side], k_palm_ahead);
            made.grab[side] = closed[side];
        }
        return made;
    }
    void step(int count = 1) {
        for (int i = 0; i < count; ++i) {
            const hh::Sample now = sample();
            is_good = is_good && world.step(k_step_s, hh::input(player, {&now, 1}));
            ++frame;
            note_events();
        }
    }
    hh_hand_state hand(hh::Side side) const { return *world.hand(player, side); }

    bool is_good = true;

  private:
    hh::Body add_wall(const char* name, hh_body_kind kind) {
        hh_body_def wall = hh::body_def();
        wall.name = name;
        wall.kind = kind;
        wall.shape = *world.add_box({2.0, 2.0, 0.1});
        wall.pose.position = k_wall_m;
        return *world.add(wall);
    }
    static const char* text_of(hh_reason reason) {
        switch (reason) {
            case HH_REASON_NOT_ALLOWED:
                return "not_allowed";
            case HH_REASON_NEEDS_TWO_HANDS:
                return "needs_two";
            case HH_REASON_NO_SURFACE:
                return "no_surface";
            case HH_REASON_BY_HOST:
                return "by_host";
            case HH_REASON_STRETCHED:
                return "stretched";
            case HH_REASON_BODY_GONE:
                return "body_gone";
            default:
                return "";
        }
    }
    void note_events() {
        for (const hh::Event& event : world.events()) {
            const char* const verb = event.kind == HH_EVENT_GRABBED    ? "grab"
                                     : event.kind == HH_EVENT_RELEASED ? "release"
                                     : event.kind == HH_EVENT_REFUSED  ? "refuse"
                                     : event.kind == HH_EVENT_SLIPPED  ? "slip"
                                                                       : nullptr;
            if (verb != nullptr) {
                log += std::string(verb) + (event.side == HH_LEFT ? " left" : " right");
                const std::string reason = text_of(event.reason);
                log += (reason.empty() ? "" : " " + reason) + ";";
            }
        }
    }
};

}  // namespace handhold::test
