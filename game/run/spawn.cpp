#include "game/run/spawn.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "components/play_space.hpp"
#include "game/run/session_run.hpp"
#include "game/scene/place_scene.hpp"
#include "game/scene/random.hpp"
#include "game/session/playback.hpp"
#include "systems/input/read_tracking.hpp"

namespace handhold {
namespace {

constexpr int k_yaws = 12;
constexpr std::size_t k_surface_points = 600;  // number of surface points for each yaw
constexpr std::size_t k_played = 16;           // the best candidates are played; at most this many
// Number of head positions that are checked along the session.
constexpr std::size_t k_head_checks = 12;
constexpr double k_head_clearance_m = 0.06;  // distance from surfaces beyond the head's radius
constexpr double k_palm_gap_m = 0.02;        // gap between the first grab's palm and the surface

// The session as it would go if every grab gripped a fixed body. Poses are in play space, relative
// to the start origin.
struct Rehearsal {
    std::vector<PalmRay> grabs;  // palm rays at the starts of the grabs
    std::vector<Vec3> heads;     // centres of the head's collider over time
    std::size_t onsets = 0;
};

Rehearsal rehearse(const Recording& recording, const Tuning& tuning) {
    Rehearsal out;
    const std::array<Pose, k_hand_count> joints = {
        default_controller_to_hand(HandSide::left, tuning.hand),
        default_controller_to_hand(HandSide::right, tuning.hand)};
    Vec3 origin = Vec3::Zero();
    Vec3 drift_mps = Vec3::Zero();
    std::array<bool, k_hand_count> holds{};
    std::array<Vec3, k_hand_count> last{Vec3::Zero(), Vec3::Zero()};
    double last_t_s = recording.samples.front().t_s;
    const std::size_t head_stride =
        std::max<std::size_t>(1, recording.samples.size() / k_head_checks);
    for (std::size_t i = 0; i < recording.samples.size(); ++i) {
        const RecordedSample& sample = recording.samples[i];
        const double dt_s = sample.t_s - last_t_s;
        last_t_s = sample.t_s;
        Vec3 pull = Vec3::Zero();
        double pulling = 0.0;
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            const Pose hand = sample.hands[side].controller * joints[side];
            if (!is_valid(hand)) {
                continue;
            }
            if (holds[side]) {
                pull -= hand.position - last[side];
                pulling += 1.0;
            }
            last[side] = hand.position;
        }
        origin += pulling > 0.0 ? Vec3(pull / pulling) : Vec3(drift_mps * dt_s);
        if (pulling > 0.0 && dt_s > 0.0) {
            drift_mps = 0.8 * drift_mps + 0.2 * (pull / pulling / dt_s);
        }
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            const bool grab = (sample.hands[side].buttons & k_grab_buttons) != 0;
            if (grab && !holds[side] && is_valid(sample.hands[side].controller)) {
                Pose hand = sample.hands[side].controller * joints[side];
                hand.position += origin;
                out.grabs.push_back(
                    palm_ray(hand, side == 0 ? HandSide::left : HandSide::right, tuning.hand));
                ++out.onsets;
            }
            holds[side] = grab;
        }
        if (i % head_stride == 0 && is_valid(sample.head)) {
            out.heads.push_back(origin + transform_point(sample.head, tuning.head.center_m));
        }
    }
    return out;
}

struct Candidate {
    Pose origin_ws;
    double score = 0.0;
};

struct SpawnEvaluator {
    const CollisionWorld& collision;
    const Rehearsal& rehearsal;
    const HeadTuning& head;
    const HandTuning& hand;

    // Rates a start origin: the number of grabs that would find a surface; negative if the head
    // starts too near to a surface. Later positions of the head near a surface cost a little.
    double score(const Pose& origin_ws) const {
        double score = 0.0;
        for (std::size_t i = 0; i < rehearsal.heads.size(); ++i) {
            const Vec3 center_ws = transform_point(origin_ws, rehearsal.heads[i]);
            if (collision.closest_point(center_ws, head.radius_m + k_head_clearance_m)) {
                if (i == 0) {
                    return -1.0;
                }
                score -= 0.3;
            }
        }
        for (const PalmRay& ray : rehearsal.grabs) {
            const Vec3 palm_ws = transform_point(origin_ws, ray.palm_ws);
            const Vec3 from_ws = transform_point(origin_ws, ray.from_ws);
            const Vec3 to_ws = transform_point(origin_ws, ray.to_ws);
            if (collision.cast_ray(from_ws, to_ws) ||
                collision.closest_point(palm_ws, hand.reach_m)) {
                score += 1.0;
            }
        }
        return score;
    }
};

// Random points on the scene's surfaces, uniform by area, with their triangle's normal.
struct SurfaceSampler {
    struct Piece {
        const Mesh* mesh = nullptr;
        Pose pose_ws;
        std::size_t triangle = 0;
        double area_until_m2 = 0.0;
    };
    std::vector<Piece> pieces;

    explicit SurfaceSampler(const Scene& scene) {
        double area = 0.0;
        for (const SceneVisual& visual : scene.visuals) {
            if (scene.world.body.at(visual.body).kind == BodyKind::free) {
                continue;
            }
            const Pose& pose_ws = scene.world.body_pose.at(visual.body).pose_ws;
            for (std::size_t i = 0; i < visual.mesh->triangles.size(); ++i) {
                const auto& [a, b, c] = visual.mesh->triangles[i];
                const std::vector<Vec3>& at = visual.mesh->positions;
                area += 0.5 * (at[b] - at[a]).cross(at[c] - at[a]).norm();
                pieces.push_back({visual.mesh.get(), pose_ws, i, area});
            }
        }
    }

    struct Sample {
        Vec3 point_ws, normal_ws;
    };
    Sample draw(Random& random) const {
        const double wanted = random.unit() * pieces.back().area_until_m2;
        const auto piece =
            std::lower_bound(pieces.begin(), pieces.end() - 1, wanted,
                             [](const Piece& p, double area) { return p.area_until_m2 < area; });
        const auto& [ia, ib, ic] = piece->mesh->triangles[piece->triangle];
        const Vec3 a = transform_point(piece->pose_ws, piece->mesh->positions[ia]);
        const Vec3 b = transform_point(piece->pose_ws, piece->mesh->positions[ib]);
        const Vec3 c = transform_point(piece->pose_ws, piece->mesh->positions[ic]);
        double u = random.unit();
        double v = random.unit();
        if (u + v > 1.0) {
            u = 1.0 - u;
            v = 1.0 - v;
        }
        const Vec3 normal = (b - a).cross(c - a);
        return {a + u * (b - a) + v * (c - a),
                normal.norm() > 0.0 ? Vec3(normal.normalized()) : Vec3::UnitY()};
    }
};

std::vector<Candidate> propose(const Scene& scene, const SpawnEvaluator& evaluator) {
    std::vector<Candidate> best;
    const SurfaceSampler surface(scene);
    if (surface.pieces.empty()) {
        return best;
    }
    const Quat upright = rotation_between(Vec3::UnitY(), scene.up_ws);
    Random random(20);
    for (int yaw = 0; yaw < k_yaws; ++yaw) {
        const double angle = 6.283185307179586 * yaw / k_yaws;
        const Quat rotation = (upright * rotation_about(Vec3::UnitY(), angle)).normalized();
        for (std::size_t i = 0; i < k_surface_points; ++i) {
            const SurfaceSampler::Sample sample = surface.draw(random);
            // Chooses a side of the surface and one of the first three grabs (the head, if there
            // are none), which is placed next to the surface.
            const double side = random.unit() < 0.5 ? -1.0 : 1.0;
            const std::size_t grabs = std::min<std::size_t>(evaluator.rehearsal.grabs.size(), 3);
            const auto pick = static_cast<std::size_t>(random.unit() * static_cast<double>(grabs));
            const bool lay_head = grabs == 0;
            const Vec3 laid = lay_head ? evaluator.rehearsal.heads.front()
                                       : evaluator.rehearsal.grabs[pick].palm_ws;
            const double gap = lay_head ? 0.5 : k_palm_gap_m;
            const Pose origin_ws{sample.point_ws + side * gap * sample.normal_ws - rotation * laid,
                                 rotation};
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

// Plays the session in a copy of the world; `world` stays unchanged.
Played play_from(Scene& trial, const World& world, FrameCaches& caches, const Recording& recording,
                 const Pose& origin_ws, double hz) {
    trial.world = world;
    const PlayerEntities player =
        add_scene_player(trial, {free_player_name(world, "player0"), origin_ws});
    const RunLog log = run_session(trial, caches, {player}, &recording, {hz, 0.0, 1});
    Played played;
    Vec3 last = origin_ws.position;
    for (const FrameLog& frame : log.frames) {
        played.gripped += frame.stats.grabs_gripped;
        played.path_m += (frame.players[0].origin_ws - last).norm();
        last = frame.players[0].origin_ws;
    }
    return played;
}

}  // namespace

FoundSpawn find_spawn(const Scene& scene, FrameCaches& caches, const Recording& recording,
                      double hz) {
    Scene trial;  // scene whose shapes get the same ids as those of the caches
    *trial.shapes = *scene.shapes;
    trial.name = scene.name;
    trial.world = scene.world;
    trial.tuning = scene.tuning;
    trial.body_names = scene.body_names;
    trial.head_shape = scene.head_shape;
    place_scene(trial, caches);

    const Rehearsal rehearsal = rehearse(recording, scene.tuning);
    FoundSpawn found;
    found.onsets = rehearsal.onsets;
    found.origin_ws = scene.spawns.empty() ? Pose{} : scene.spawns.front().pose_ws;
    if (rehearsal.heads.empty()) {
        return found;
    }
    const SpawnEvaluator evaluator{caches.collision, rehearsal, scene.tuning.head,
                                   scene.tuning.hand};
    double best_path_m = -1.0;
    for (const Candidate& candidate : propose(scene, evaluator)) {
        const Played played =
            play_from(trial, scene.world, caches, recording, candidate.origin_ws, hz);
        if (best_path_m < 0.0 || played.gripped > found.gripped ||
            (played.gripped == found.gripped && played.path_m > best_path_m)) {
            found.origin_ws = candidate.origin_ws;
            found.gripped = played.gripped;
            best_path_m = played.path_m;
        }
    }
    return found;
}

}  // namespace handhold
