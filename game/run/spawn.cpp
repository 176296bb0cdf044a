#include "game/run/spawn.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <handhold/math.hpp>

#include "game/run/session_run.hpp"
#include "game/scene/random.hpp"
#include "game/session/hand_pose.hpp"

namespace handhold {

using hh::cross;
using hh::dot;
using hh::length;
using hh::normalized;
using hh::transform_point;

namespace {

constexpr int k_yaws = 12;
constexpr std::size_t k_surface_points = 600;  // number of surface points for each yaw
constexpr std::size_t k_played = 16;           // the best candidates are played; at most this many
// Number of head positions that are checked along the session.
constexpr std::size_t k_head_checks = 12;
constexpr double k_head_clearance_m = 0.06;  // distance from surfaces beyond the head's radius
constexpr double k_palm_gap_m = 0.02;        // gap between the first grab's palm and the surface
constexpr double k_min_facing_cosine = 0.5;  // least cosine between ray and normal
// Score of a grab near a surface that its palm does not face.
constexpr double k_unfaced_score = 0.25;

// The ray along which a closing hand looks for a surface, its palm, and the head's centre then.
struct GrabRay {
    hh::Vec3 from{};
    hh::Vec3 to{};
    hh::Vec3 palm{};
    hh::Vec3 head{};
};

// What the search needs of a world's tuning.
struct SpawnTuning {
    explicit SpawnTuning(const hh::World& world)
        : shape(hand_shape(world)),
          head_center_m(*world.tuning_vector("head.center_m")),
          head_radius_m(*world.tuning("head.radius_m")),
          ray_back_m(*world.tuning("hand.ray_back_m")),
          ray_length_m(*world.tuning("hand.ray_length_m")),
          reach_m(*world.tuning("hand.reach_m")) {}

    GrabRay ray(const hh::Pose& hand, hh::Side side) const {
        hh::Vec3 palm = shape.palm_center_m;
        palm.x *= side == HH_RIGHT ? 1.0 : -1.0;
        const hh::Vec3 outward = hand.rotation * -hh::k_y;
        const hh::Vec3 at = transform_point(hand, palm);
        const hh::Vec3 from = at - ray_back_m * outward;
        return {from, from + ray_length_m * outward, at, {}};
    }

    HandShape shape;
    hh::Vec3 head_center_m;
    double head_radius_m;
    double ray_back_m;
    double ray_length_m;
    double reach_m;
};

// The session as it would go if every grab gripped a fixed body. Poses are relative to the play
// space at the start.
struct Rehearsal {
    std::vector<GrabRay> grabs;   // palm rays at the starts of the grabs
    std::vector<hh::Vec3> heads;  // centres of the head's collider over time
    std::size_t onsets = 0;
};

Rehearsal rehearse(const Recording& recording, const SpawnTuning& tuning) {
    Rehearsal out;
    const std::array<hh::Pose, 2>& joints = tuning.shape.in_controller;
    hh::Vec3 origin = hh::Vec3{};
    hh::Vec3 drift_mps = hh::Vec3{};
    std::array<bool, 2> holds{};
    std::array<hh::Vec3, 2> last{hh::Vec3{}, hh::Vec3{}};
    double last_t_s = recording.samples.front().t_s;
    const std::size_t head_stride =
        std::max<std::size_t>(1, recording.samples.size() / k_head_checks);
    for (std::size_t i = 0; i < recording.samples.size(); ++i) {
        const RecordedSample& sample = recording.samples[i];
        const double dt_s = sample.t_s - last_t_s;
        last_t_s = sample.t_s;
        hh::Vec3 pull = hh::Vec3{};
        double pulling = 0.0;
        for (std::size_t side = 0; side < 2; ++side) {
            const hh::Pose hand = sample.hands[side].controller * joints[side];
            if (!hh::is_valid(hand)) {
                continue;
            }
            if (holds[side]) {
                pull -= hand.position - last[side];
                pulling += 1.0;
            }
            last[side] = hand.position;
        }
        origin += pulling > 0.0 ? (pull / pulling) : (drift_mps * dt_s);
        if (pulling > 0.0 && dt_s > 0.0) {
            drift_mps = 0.8 * drift_mps + 0.2 * (pull / pulling / dt_s);
        }
        for (std::size_t side = 0; side < 2; ++side) {
            const bool grab = (sample.hands[side].buttons & k_grab_buttons) != 0;
            if (grab && !holds[side] && hh::is_valid(sample.hands[side].controller)) {
                hh::Pose hand = sample.hands[side].controller * joints[side];
                hand.position += origin;
                GrabRay& ray =
                    out.grabs.emplace_back(tuning.ray(hand, side == 0 ? HH_LEFT : HH_RIGHT));
                ray.head = hh::is_valid(sample.head)
                               ? origin + transform_point(sample.head, tuning.head_center_m)
                               : ray.palm;
                ++out.onsets;
            }
            holds[side] = grab;
        }
        if (i % head_stride == 0 && hh::is_valid(sample.head)) {
            out.heads.push_back(origin + transform_point(sample.head, tuning.head_center_m));
        }
    }
    return out;
}

struct Candidate {
    hh::Pose origin_ws = hh::k_origin;
    double score = 0.0;
};

struct SpawnEvaluator {
    hh::World& world;
    const Rehearsal& rehearsal;
    const SpawnTuning& tuning;

    // True if nothing is between the head and the palm, or only what the palm is in.
    bool is_seen(const hh::Vec3& head_ws, const hh::Vec3& palm_ws) const {
        constexpr double k_in_m = 0.03;
        const hh::Vec3 sight = palm_ws - head_ws;
        const double length_m = length(sight);
        return length_m <= k_in_m ||
               !world.cast_ray(head_ws, head_ws + (1.0 - k_in_m / length_m) * sight);
    }

    // Rates a grab: 1 if the player sees the palm and it faces the surface on its ray,
    // k_unfaced_score if the player sees it and a surface is near, else 0.
    double grab_score(const hh::Pose& origin_ws, const GrabRay& ray) const {
        const hh::Vec3 palm_ws = transform_point(origin_ws, ray.palm);
        const hh::Vec3 from_ws = transform_point(origin_ws, ray.from);
        const hh::Vec3 to_ws = transform_point(origin_ws, ray.to);
        const auto hit = world.cast_ray(from_ws, to_ws);
        if ((!hit && !world.closest_point(palm_ws, tuning.reach_m)) ||
            !is_seen(transform_point(origin_ws, ray.head), palm_ws)) {
            return 0.0;
        }
        const bool faces =
            hit && dot(normalized(from_ws - to_ws), hit->normal) >= k_min_facing_cosine;
        return faces ? 1.0 : k_unfaced_score;
    }

    // Rates a start origin: the sum over the grabs, minus 0.3 for each later head position too near
    // a surface; -1 if the first head position is too near a surface.
    double score(const hh::Pose& origin_ws) const {
        double score = 0.0;
        for (std::size_t i = 0; i < rehearsal.heads.size(); ++i) {
            const hh::Vec3 center_ws = transform_point(origin_ws, rehearsal.heads[i]);
            if (world.closest_point(center_ws, tuning.head_radius_m + k_head_clearance_m)) {
                if (i == 0) {
                    return -1.0;
                }
                score -= 0.3;
            }
        }
        for (const GrabRay& ray : rehearsal.grabs) {
            score += grab_score(origin_ws, ray);
        }
        return score;
    }
};

// Random points on the scene's surfaces, uniform by area, with their triangle's normal.
struct SurfaceSampler {
    struct Piece {
        const Mesh* mesh = nullptr;
        hh::Pose pose_ws = hh::k_origin;
        std::size_t triangle = 0;
        double area_until_m2 = 0.0;
    };
    std::vector<Piece> pieces;

    explicit SurfaceSampler(const Scene& scene) {
        double area = 0.0;
        for (const SceneVisual& visual : scene.visuals) {
            const hh::Body body = body_id(visual.body);
            if (*scene.host.kind(body) == HH_DYNAMIC) {
                continue;
            }
            const hh::Pose pose_ws = *scene.host.pose(body);
            for (std::size_t i = 0; i < visual.mesh->triangles.size(); ++i) {
                const auto& [a, b, c] = visual.mesh->triangles[i];
                const auto at = [&](std::uint32_t vertex) {
                    return to_host(visual.mesh->positions[vertex]);
                };
                area += 0.5 * length(cross(at(b) - at(a), at(c) - at(a)));
                pieces.push_back({visual.mesh.get(), pose_ws, i, area});
            }
        }
    }

    struct Sample {
        hh::Vec3 point_ws{};
        hh::Vec3 normal_ws{};
    };
    Sample draw(Random& random) const {
        const double wanted = random.unit() * pieces.back().area_until_m2;
        const auto piece =
            std::lower_bound(pieces.begin(), pieces.end() - 1, wanted,
                             [](const Piece& p, double area) { return p.area_until_m2 < area; });
        const auto& [ia, ib, ic] = piece->mesh->triangles[piece->triangle];
        const hh::Vec3 a = transform_point(piece->pose_ws, to_host(piece->mesh->positions[ia]));
        const hh::Vec3 b = transform_point(piece->pose_ws, to_host(piece->mesh->positions[ib]));
        const hh::Vec3 c = transform_point(piece->pose_ws, to_host(piece->mesh->positions[ic]));
        double u = random.unit();
        double v = random.unit();
        if (u + v > 1.0) {
            u = 1.0 - u;
            v = 1.0 - v;
        }
        const hh::Vec3 normal = cross(b - a, c - a);
        return {a + u * (b - a) + v * (c - a),
                length(normal) > 0.0 ? (normalized(normal)) : hh::k_y};
    }
};

std::vector<Candidate> propose(const Scene& scene, const SpawnEvaluator& evaluator) {
    std::vector<Candidate> best;
    const SurfaceSampler surface(scene);
    if (surface.pieces.empty()) {
        return best;
    }
    const hh::Quat upright = hh::rotation_between(hh::k_y, to_host(scene.up_ws));
    Random random(20);
    for (int yaw = 0; yaw < k_yaws; ++yaw) {
        const double angle = 6.283185307179586 * yaw / k_yaws;
        const hh::Quat rotation = normalized(upright * hh::rotation_about(hh::k_y, angle));
        for (std::size_t i = 0; i < k_surface_points; ++i) {
            const SurfaceSampler::Sample sample = surface.draw(random);
            // Chooses at random one of the first three grabs and places its palm before the
            // surface. Without grabs, places the head.
            const auto& grabs = evaluator.rehearsal.grabs;
            const auto pick = static_cast<std::size_t>(
                random.unit() * static_cast<double>(std::min<std::size_t>(grabs.size(), 3)));
            const bool lays_head = grabs.empty();
            const hh::Vec3 head = lays_head ? evaluator.rehearsal.heads.front() : grabs[pick].head;
            const hh::Vec3 laid = lays_head ? head : grabs[pick].palm;
            const double gap = lays_head ? 0.5 : k_palm_gap_m;
            const hh::Pose origin_ws{sample.point_ws + gap * sample.normal_ws - rotation * laid,
                                     rotation};
            const hh::Vec3 to_head = transform_point(origin_ws, head) - sample.point_ws;
            if (dot(to_head, sample.normal_ws) <= 0.0) {
                continue;  // the player would see the surface from behind
            }
            const double score = evaluator.score(origin_ws);
            if (score >= 0.0) {
                best.push_back({origin_ws, score});
            }
        }
    }
    std::stable_sort(best.begin(), best.end(),
                     [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
    best.resize(std::min(best.size(), k_played));
    return best;
}

struct Played {
    std::size_t gripped = 0;
    double path_m = 0.0;
};

// Plays the session from `origin_ws`. Leaves the scene's world at the last frame.
Played play_from(Scene& scene, const Recording& recording, const hh::Pose& origin_ws, double hz) {
    const hh::Player player = add_scene_player(scene, "player0", origin_ws);
    const RunLog log = run_session(scene, {&player, 1}, &recording, {hz, 0.0, 1});
    Played played;
    hh::Vec3 last = origin_ws.position;
    for (const FrameLog& frame : log.frames) {
        played.gripped += frame.stats.grabs_gripped;
        played.path_m += length(frame.players[0].origin_ws - last);
        last = frame.players[0].origin_ws;
    }
    return played;
}

}  // namespace

FoundSpawn find_spawn(Scene& scene, const Recording& recording, double hz) {
    const SpawnTuning tuning(scene.host);
    const Rehearsal rehearsal = rehearse(recording, tuning);
    FoundSpawn found;
    found.onsets = rehearsal.onsets;
    found.origin_ws = scene.spawns.empty() ? hh::k_origin : scene.spawns.front().pose_ws;
    if (rehearsal.heads.empty()) {
        return found;
    }
    std::vector<std::byte> before;
    if (const hh::Status saved = scene.host.save(before); !saved) {
        throw std::logic_error(std::string(saved.text()));
    }
    double best_path_m = -1.0;
    double best_score = 0.0;
    for (const Candidate& candidate : propose(scene, {scene.host, rehearsal, tuning})) {
        const Played played = play_from(scene, recording, candidate.origin_ws, hz);
        if (const hh::Status restored = scene.host.restore(before); !restored) {
            throw std::logic_error(std::string(restored.text()));
        }
        const double score = candidate.score + static_cast<double>(played.gripped);
        if (best_path_m < 0.0 || score > best_score ||
            (score == best_score && played.path_m > best_path_m)) {
            best_score = score;
            found.origin_ws = candidate.origin_ws;
            found.gripped = played.gripped;
            best_path_m = played.path_m;
        }
    }
    return found;
}

}  // namespace handhold
