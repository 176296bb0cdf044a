#include "game/session/session_script.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace handhold {

using hh::cross;
using hh::dot;
using hh::interpolate;
using hh::inverse;
using hh::normalized;
using hh::rotation_about;

namespace {

constexpr double k_sample_hz = 90.0;
constexpr double k_lift_m = 0.07;       // height of a moving hand above the surface
constexpr double k_rest_after_s = 0.7;  // duration of an idle hand's way down to its rest pose

hh::Vec3 eyes_at(const std::vector<ScriptedBody>& body, double t_s) {
    const auto next = std::find_if(body.begin(), body.end(),
                                   [t_s](const ScriptedBody& key) { return key.t_s > t_s; });
    if (next == body.begin()) {
        return body.front().eyes;
    }
    const ScriptedBody& a = *(next - 1);
    if (next == body.end()) {
        return a.eyes + (t_s - a.t_s) * a.velocity_mps;
    }
    const double span = next->t_s - a.t_s;
    const double u = (t_s - a.t_s) / span;
    const double u2 = u * u;
    const double u3 = u2 * u;
    return (2 * u3 - 3 * u2 + 1) * a.eyes + ((u3 - 2 * u2 + u) * span) * a.velocity_mps +
           (3 * u2 - 2 * u3) * next->eyes + ((u3 - u2) * span) * next->velocity_mps;
}

constexpr double k_turn_rad = 2.0 * std::numbers::pi;

double smooth_share(double x, double from, double to) {
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

// A hand at one time of the plan.
struct HandKey {
    double t_s = 0.0;
    hh::Pose hand = hh::k_origin;  // the wrist
    hh::Vec3 away = hh::k_y;
    bool holds = false;  // holds until the next key
};

// Rest pose of a hand: beside and in front of the chest, palm down, relative to the eyes at that
// time.
HandKey rest_key(const SessionScript& script, hh::Side side, double t_s, const HandShape& shape) {
    const double outward = side == HH_RIGHT ? 1.0 : -1.0;
    const hh::Vec3 palm =
        eyes_at(script.body, t_s) + script.play_space * hh::Vec3{0.22 * outward, -0.42, -0.30};
    const hh::Vec3 up = script.play_space * hh::k_y;
    return {t_s, hand_on({palm, up, script.play_space * -hh::k_z}, side, shape.palm_center_m), up,
            false};
}

std::vector<HandKey> keys_of(const SessionScript& script, hh::Side side, const HandShape& shape) {
    std::vector<HandKey> keys;
    for (const ScriptedHold& hold : script.holds) {
        if (hold.side == side) {
            const hh::Pose pose =
                hand_on({hold.palm, hold.away, hold.fingers}, side, shape.palm_center_m);
            keys.push_back({hold.from_s, pose, hold.away, true});
            keys.push_back({hold.until_s, pose, hold.away, false});
        }
    }
    for (const ScriptedReach& reach : script.reaches) {
        if (reach.side == side) {
            keys.push_back(
                {reach.t_s,
                 hand_on({reach.palm, reach.away, reach.fingers}, side, shape.palm_center_m),
                 reach.away, false});
        }
    }
    std::stable_sort(keys.begin(), keys.end(),
                     [](const HandKey& a, const HandKey& b) { return a.t_s < b.t_s; });
    // A reach during a hold moves the held body. It does not end the hold.
    bool holds = false;
    for (HandKey& key : keys) {
        const bool inside =
            std::any_of(script.holds.begin(), script.holds.end(), [&](const ScriptedHold& hold) {
                return hold.side == side && hold.from_s <= key.t_s && key.t_s < hold.until_s;
            });
        holds = inside;
        key.holds = holds;
    }
    if (keys.empty() || keys.front().t_s > 0.0) {
        keys.insert(keys.begin(), rest_key(script, side, 0.0, shape));
    }
    return keys;
}

struct HandNow {
    hh::Pose hand = hh::k_origin;
    bool holds = false;
};

HandNow hand_at(const SessionScript& script, hh::Side side, const std::vector<HandKey>& keys,
                double t_s, const HandShape& shape) {
    const auto next =
        std::find_if(keys.begin(), keys.end(), [t_s](const HandKey& key) { return key.t_s > t_s; });
    const HandKey& a = *(next - 1);
    HandKey b = next != keys.end() ? *next : rest_key(script, side, t_s, shape);
    const double end_s = next != keys.end() ? b.t_s : a.t_s + k_rest_after_s;
    const double u = smooth_share(t_s, a.t_s, std::max(end_s, a.t_s + 1e-3));
    HandNow now;
    now.hand = interpolate(a.hand, b.hand, u);
    now.holds = a.holds;
    if (!a.holds) {
        now.hand.position +=
            (k_lift_m * hh::sine(0.5 * k_turn_rad * u)) * normalized(a.away + b.away);
    }
    return now;
}

// Pose of the head: the eyes look ahead, and partly at the hands.
hh::Pose head_pose(const SessionScript& script, double t_s, const hh::Vec3& between_hands) {
    hh::Pose pose = hh::k_origin;
    pose.position = eyes_at(script.body, t_s);
    const hh::Vec3 ahead = script.play_space * -hh::k_z;
    const hh::Vec3 up = script.play_space * hh::k_y;
    const hh::Vec3 look = normalized(1.3 * ahead + normalized(between_hands - pose.position));
    const hh::Vec3 right = normalized(cross(look, up));
    const hh::Quat ahead_at = hh::rotation_from_axes(right, cross(right, look), -look);
    const double yaw = 0.08 * hh::sine(0.9 * t_s) + 0.04 * hh::sine(2.1 * t_s);
    const double pitch = 0.05 * hh::sine(1.3 * t_s + 0.5);
    pose.rotation =
        normalized(ahead_at * rotation_about(hh::k_y, yaw) * rotation_about(hh::k_x, pitch));
    return pose;
}

double trigger_at(const SessionScript& script, hh::Side side, double t_s) {
    constexpr double k_press_s = 0.15;
    double pressed = 0.0;
    for (const ScriptedPress& press : script.presses) {
        if (press.side == side) {
            const double inside_s = std::min(t_s - press.from_s, press.until_s - t_s);
            pressed = std::max(pressed, std::clamp(inside_s / k_press_s, 0.0, 1.0));
        }
    }
    return pressed;
}

}  // namespace

void add_crawl(const ScriptedCrawl& crawl, SessionScript& script) {
    constexpr double k_period_s = 1.6;  // period of one hand's holds
    constexpr double k_held = 0.64;     // fraction of the period; the hands' holds overlap
    int step = 0;
    for (double t_s = crawl.from_s; t_s < crawl.until_s; t_s += 0.5 * k_period_s, ++step) {
        ScriptedHold hold;
        hold.side = step % 2 == 0 ? HH_LEFT : HH_RIGHT;
        hold.from_s = t_s;
        hold.until_s = std::min(t_s + k_held * k_period_s, crawl.until_s);
        if (hold.until_s - hold.from_s < 0.2) {
            break;
        }
        // The hold is where the body will be after half of the hold's time.
        const hh::Vec3 eyes = eyes_at(script.body, t_s + 0.5 * k_held * k_period_s);
        const hh::Vec3 on_bar =
            crawl.bar_start + crawl.along * dot(crawl.along, eyes - crawl.bar_start);
        hold.palm = on_bar + crawl.palm_off_axis_m * crawl.away;
        hold.away = crawl.away;
        hold.fingers = crawl.fingers;
        script.holds.push_back(hold);
    }
}

hh::Pose session_origin(const SessionScript& script) {
    hh::Pose origin = hh::k_origin;
    origin.rotation = script.play_space;
    origin.position =
        eyes_at(script.body, 0.0) - script.play_space * hh::Vec3{0.0, script.eye_height_m, 0.0};
    return origin;
}

Recording record_session(const SessionScript& script, const HandShape& shape) {
    Recording recording;
    const hh::Pose start = session_origin(script);
    const auto count = static_cast<int>(script.duration_s * k_sample_hz) + 1;
    std::array<std::vector<HandKey>, 2> keys;
    std::array<hh::Pose, 2> hand_to_controller;
    for (const hh::Side side : {HH_LEFT, HH_RIGHT}) {
        keys[side] = keys_of(script, side, shape);
        hand_to_controller[side] = inverse(shape.in_controller[side]);
    }
    for (int i = 0; i < count; ++i) {
        RecordedSample sample;
        sample.t_s = i / k_sample_hz;
        // The recorded person stands in the room and only sways; gripping hands move the play
        // space.
        const hh::Vec3 sway =
            hh::Vec3{0.02 * hh::sine(0.4 * sample.t_s), 0.01 * hh::sine(0.5 * sample.t_s),
                     0.02 * hh::sine(0.3 * sample.t_s)};
        const hh::Vec3 carried =
            eyes_at(script.body, sample.t_s) - eyes_at(script.body, 0.0) - script.play_space * sway;
        const hh::Pose origin{start.position + carried, start.rotation};
        const hh::Pose to_play_space = inverse(origin);
        hh::Vec3 between_hands = hh::Vec3{};
        for (const hh::Side side : {HH_LEFT, HH_RIGHT}) {
            const std::size_t s = side;
            HandNow now = hand_at(script, side, keys[s], sample.t_s, shape);
            between_hands += 0.5 * now.hand.position;
            const double phase = 7.3 * static_cast<double>(s) + k_turn_rad * 9.0 * sample.t_s;
            now.hand.position +=
                1e-4 * hh::Vec3{hh::sine(phase), hh::sine(1.13 * phase), hh::sine(0.91 * phase)};
            sample.hands[s].controller = to_play_space * now.hand * hand_to_controller[s];
            sample.hands[s].buttons = now.holds ? k_button_grip : 0;
            sample.hands[s].squeeze = now.holds ? 1.0 : 0.0;
            sample.hands[s].trigger = trigger_at(script, side, sample.t_s);
        }
        sample.head = to_play_space * head_pose(script, sample.t_s, between_hands);
        recording.samples.push_back(sample);
    }
    return recording;
}

}  // namespace handhold
