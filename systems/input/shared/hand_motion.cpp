#include "systems/input/shared/hand_motion.hpp"

#include <algorithm>

#include "systems/input/shared/motion_limit.hpp"

namespace handhold {
namespace {

// The length of the measuring window after enlarging it (measure_release).
double measured_window(const HandHistory& history, double t_s, double window_s) {
    for (int times = 1; times < k_longest_window; ++times) {
        double oldest_s = t_s;
        for (std::uint32_t i = 0; i < history.count; ++i) {
            const double at_s = history.entries[i].t_s;
            oldest_s = at_s >= t_s - times * window_s && at_s < oldest_s ? at_s : oldest_s;
        }
        if (t_s - oldest_s >= k_shortest_span_s) {
            return times * window_s;
        }
    }
    return k_longest_window * window_s;
}

}  // namespace

void remember(HandHistory& history, const HandTracking& hand) {
    history.entries[history.next] = {hand.sample_t_s, hand.sample_ps};
    history.next = (history.next + 1) % HandHistory::k_capacity;
    history.count = std::min<std::uint32_t>(history.count + 1, HandHistory::k_capacity);
}

void clear(HandHistory& history) { history.count = history.next = 0; }

Pose extrapolated(const HandTracking& hand, const HandHistory& history, double t_s) {
    if (history.count < 2) {
        return hand.sample_ps;
    }
    const HandHistory::Entry& before =
        history.entries[(history.next + HandHistory::k_capacity - 2) % HandHistory::k_capacity];
    return extrapolate(before.hand_ps, before.t_s, hand.sample_ps, hand.sample_t_s, t_s);
}

void measure_release(const HandHistory& history, double t_s, double window_s, HandTracking& hand) {
    double weight = 0.0;
    double mean_t = 0.0;
    const double from_s = t_s - measured_window(history, t_s, window_s);
    const auto for_window = [&](auto&& visit) {
        for (std::uint32_t i = 0; i < history.count; ++i) {
            const HandHistory::Entry& entry = history.entries[i];
            if (entry.t_s >= from_s && entry.t_s <= t_s) {
                visit(entry);
            }
        }
    };
    for_window([&](const HandHistory::Entry& entry) {
        weight += 1.0;
        mean_t += entry.t_s - t_s;
    });
    hand.release_velocity_ps_mps.setZero();
    hand.release_spin_ps_radps.setZero();
    if (weight < 2.0) {
        return;
    }
    mean_t /= weight;
    double spread = 0.0;
    Vec3 linear = Vec3::Zero();
    Vec3 angular = Vec3::Zero();
    for_window([&](const HandHistory::Entry& entry) {
        const double dt = entry.t_s - t_s - mean_t;
        spread += dt * dt;
        linear += dt * (entry.hand_ps.position - hand.edge_ps.position);
        angular +=
            dt * rotation_to_vector(entry.hand_ps.rotation * hand.edge_ps.rotation.conjugate());
    });
    constexpr double k_min_spread_s2 = 1e-6;
    if (spread > k_min_spread_s2) {
        hand.release_velocity_ps_mps = linear / spread;
        hand.release_spin_ps_radps = angular / spread;
    }
}

}  // namespace handhold
