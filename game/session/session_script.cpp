#include "game/session/session_script.hpp"

#include <algorithm>
#include <cmath>

#include "game/session/hand_pose.hpp"
#include "systems/input/read_tracking.hpp"

namespace handhold {
namespace {

constexpr double k_sample_hz = 90.0;
constexpr double k_lift_m = 0.07;       // height of a moving hand above the surface
constexpr double k_rest_after_s = 0.7;  // duration of an idle hand's way down to its rest pose

Vec3 eyes_at(const std::vector<ScriptedBody>& body, double t_s) {
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

// A hand at one time of the plan.
struct HandKey {
    double t_s = 0.0;
    Pose hand;  // the wrist
    Vec3 away = Vec3::UnitY();
    bool holds = false;  // holds until the next key
};

// Rest pose of a hand: beside and in front of the chest, palm down, relative to the eyes at that
// time.
HandKey rest_key(const SessionScript& script, HandSide side, double t_s, const HandTuning& tuning) {
    const double outward = side == HandSide::right ? 1.0 : -1.0;
    const Vec3 palm =
        eyes_at(script.body, t_s) + script.play_space * Vec3(0.22 * outward, -0.42, -0.30);
    const Vec3 up = script.play_space * Vec3::UnitY();
    return {t_s, hand_on({palm, up, script.play_space * -Vec3::UnitZ()}, side, tuning), up, false};
}

std::vector<HandKey> keys_of(const SessionScript& script, HandSide side, const HandTuning& tuning) {
    std::vector<HandKey> keys;
    for (const ScriptedHold& hold : script.holds) {
        if (hold.side == side) {
            const Pose pose = hand_on({hold.palm, hold.away, hold.fingers}, side, tuning);
            keys.push_back({hold.from_s, pose, hold.away, true});
            keys.push_back({hold.until_s, pose, hold.away, false});
        }
    }
    for (const ScriptedReach& reach : script.reaches) {
        if (reach.side == side) {
            keys.push_back({reach.t_s,
                            hand_on({reach.palm, reach.away, reach.fingers}, side, tuning),
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
        keys.insert(keys.begin(), rest_key(script, side, 0.0, tuning));
    }
    return keys;
}

struct HandNow {
    Pose hand;
    bool holds = false;
};

HandNow hand_at(const SessionScript& script, HandSide side, const std::vector<HandKey>& keys,
                double t_s, const HandTuning& tuning) {
    const auto next =
        std::find_if(keys.begin(), keys.end(), [t_s](const HandKey& key) { return key.t_s > t_s; });
    const HandKey& a = *(next - 1);
    HandKey b = next != keys.end() ? *next : rest_key(script, side, t_s, tuning);
    const double end_s = next != keys.end() ? b.t_s : a.t_s + k_rest_after_s;
    const double u = smooth_step(t_s, a.t_s, std::max(end_s, a.t_s + 1e-3));
    HandNow now;
    now.hand = interpolate(a.hand, b.hand, u);
    now.holds = a.holds;
    if (!a.holds) {
        now.hand.position += (k_lift_m * sine(0.5 * k_two_pi * u)) * (a.away + b.away).normalized();
    }
    return now;
}

// Pose of the head: the eyes look ahead, and partly at the hands.
Pose head_pose(const SessionScript& script, double t_s, const Vec3& between_hands) {
    Pose pose;
    pose.position = eyes_at(script.body, t_s);
    const Vec3 ahead = script.play_space * -Vec3::UnitZ();
    const Vec3 up = script.play_space * Vec3::UnitY();
    const Vec3 look = (1.3 * ahead + (between_hands - pose.position).normalized()).normalized();
    const Vec3 right = look.cross(up).normalized();
    Mat3 axes;
    axes.col(0) = right;
    axes.col(1) = right.cross(look);
    axes.col(2) = -look;
    const double yaw = 0.08 * sine(0.9 * t_s) + 0.04 * sine(2.1 * t_s);
    const double pitch = 0.05 * sine(1.3 * t_s + 0.5);
    pose.rotation =
        (Quat(axes) * rotation_about(Vec3::UnitY(), yaw) * rotation_about(Vec3::UnitX(), pitch))
            .normalized();
    return pose;
}

double trigger_at(const SessionScript& script, HandSide side, double t_s) {
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
        hold.side = step % 2 == 0 ? HandSide::left : HandSide::right;
        hold.from_s = t_s;
        hold.until_s = std::min(t_s + k_held * k_period_s, crawl.until_s);
        if (hold.until_s - hold.from_s < 0.2) {
            break;
        }
        // The hold is where the body will be after half of the hold's time.
        const Vec3 eyes = eyes_at(script.body, t_s + 0.5 * k_held * k_period_s);
        const Vec3 on_bar = crawl.bar_start + crawl.along * crawl.along.dot(eyes - crawl.bar_start);
        hold.palm = on_bar + crawl.palm_off_axis_m * crawl.away;
        hold.away = crawl.away;
        hold.fingers = crawl.fingers;
        script.holds.push_back(hold);
    }
}

Pose session_origin(const SessionScript& script) {
    Pose origin;
    origin.rotation = script.play_space;
    origin.position =
        eyes_at(script.body, 0.0) - script.play_space * Vec3(0.0, script.eye_height_m, 0.0);
    return origin;
}

Recording record_session(const SessionScript& script, const HandTuning& tuning) {
    Recording recording;
    const Pose start = session_origin(script);
    const auto count = static_cast<int>(script.duration_s * k_sample_hz) + 1;
    std::array<std::vector<HandKey>, k_hand_count> keys;
    std::array<Pose, k_hand_count> hand_to_controller;
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        keys[index_of(side)] = keys_of(script, side, tuning);
        hand_to_controller[index_of(side)] = inverse(default_controller_to_hand(side, tuning));
    }
    for (int i = 0; i < count; ++i) {
        RecordedSample sample;
        sample.t_s = i / k_sample_hz;
        // The recorded person stands in the room and only sways; gripping hands move the play
        // space.
        const Vec3 sway = Vec3(0.02 * sine(0.4 * sample.t_s), 0.01 * sine(0.5 * sample.t_s),
                               0.02 * sine(0.3 * sample.t_s));
        const Vec3 carried =
            eyes_at(script.body, sample.t_s) - eyes_at(script.body, 0.0) - script.play_space * sway;
        const Pose origin{start.position + carried, start.rotation};
        const Pose to_play_space = inverse(origin);
        Vec3 between_hands = Vec3::Zero();
        for (const HandSide side : {HandSide::left, HandSide::right}) {
            const std::size_t s = index_of(side);
            HandNow now = hand_at(script, side, keys[s], sample.t_s, tuning);
            between_hands += 0.5 * now.hand.position;
            const double phase = 7.3 * static_cast<double>(s) + k_two_pi * 9.0 * sample.t_s;
            now.hand.position += 1e-4 * Vec3(sine(phase), sine(1.13 * phase), sine(0.91 * phase));
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
