#include "tools/lab/recorded_grips.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "engine/core/profile.hpp"
#include "engine/core/text_file.hpp"
#include "game/assets/body_clips_asset.hpp"
#include "game/play/loading.hpp"
#include "game/play/progress.hpp"
#include "game/run/session_run.hpp"
#include "game/run/spawn.hpp"
#include "systems/hand/fit_hands.hpp"
#include "systems/hand/shared/hand_fit.hpp"
#include "systems/hand/shared/outside_surfaces.hpp"
#include "systems/rigs/hand_kinematics.hpp"
#include "tools/lab/exit_status.hpp"
#include "tools/lab/grip_files.hpp"
#include "tools/lab/measure.hpp"

namespace handhold::lab {
namespace {

using Json = nlohmann::ordered_json;

double hand_stages_us(const RunStats& stats) {
    double sum_us = 0.0;
    for (const Stage stage : {Stage::gather_surroundings, Stage::search_grip,
                              Stage::constrain_palms, Stage::sweep_fingers, Stage::fit_hands}) {
        sum_us += stats.stage_us[static_cast<std::size_t>(stage)];
    }
    return sum_us;
}

// Records the grips of a player's hands, frame by frame.
class GripWatch {
  public:
    GripWatch(const PlayerEntities& player, std::string recording)
        : player_(player), recording_(std::move(recording)) {}

    void take(const World& world, const Tuning& tuning, const HandScratch& scratch,
              const RunStats& stats) {
        std::array<const HandSurroundings*, k_hand_count> gripping = {};
        double count = 0.0;
        for (const HandSurroundings& around : scratch.surroundings) {
            for (std::size_t side = 0; side < k_hand_count; ++side) {
                if (around.hand == player_.hands[side] && around.is_gripping &&
                    !around.meshes.empty()) {
                    gripping[side] = &around;
                    count += 1.0;
                }
            }
        }
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            take_hand(world, tuning, side, gripping[side],
                      hand_stages_us(stats) / std::max(1.0, count));
        }
    }

    std::vector<RecordedGrip> grips;

  private:
    struct Current {
        std::size_t grip = 0;  // index into grips
        Entity body = k_no_entity;
        double since_s = 0.0;
        Pose first_bs;
    };

    void take_hand(const World& world, const Tuning& tuning, std::size_t side,
                   const HandSurroundings* around, double us) {
        std::optional<Current>& current = current_[side];
        if (around == nullptr) {
            current.reset();
            return;
        }
        const double since_s = world.grab.at(around->hand).since_s;
        if (!current || current->body != around->body || current->since_s != since_s) {
            current = {grips.size(), around->body, since_s, around->wrist_bs};
            grips.push_back({recording_, side == 0 ? "left" : "right", {}, {}, {}, {}, {}});
        }
        const Pose moved = inverse(current->first_bs) * around->wrist_bs;
        grips[current->grip].wrists.push_back(side == 0 ? mirror_hand_pose(moved) : moved);
        grips[current->grip].us.push_back(us);
        take_depths(world, tuning, *around, grips[current->grip]);
        grips[current->grip].out_of_sight.push_back(
            is_palm_behind(*around, world.palm_pose.at(around->hand)));
    }

    static bool is_palm_behind(const HandSurroundings& around, const PalmPose& palm) {
        const Pose wrist = inverse(around.body_ws) * palm.pose_ws;
        const Pose wrist_bs = {wrist.position / around.scale, wrist.rotation};
        return around.eye_bs && is_behind(around.meshes.front(), *around.eye_bs,
                                          transform_point(wrist_bs, around.rig->palm_center_hs));
    }

    static void take_depths(const World& world, const Tuning& tuning,
                            const HandSurroundings& around, RecordedGrip& grip) {
        const auto terms = shown_fit_terms(around, world.grip_surface.at(around.hand),
                                           world.palm_pose.at(around.hand),
                                           world.finger_pose.at(around.hand), tuning);
        double thumb_mm = 0.0;
        double fingers_mm = 0.0;
        for (std::size_t f = 0; terms && f < around.rig->fingers.size(); ++f) {
            double& deepest_mm =
                around.rig->fingers[f].name == FingerName::thumb ? thumb_mm : fingers_mm;
            deepest_mm = std::max(deepest_mm, -1e3 * terms->gap_m[f]);
        }
        grip.thumb_depth_mm.push_back(thumb_mm);
        grip.fingers_depth_mm.push_back(fingers_mm);
    }

    PlayerEntities player_;
    std::string recording_;
    std::array<std::optional<Current>, k_hand_count> current_;
};

// Plays a recording from the place that find_spawn chooses and returns the grips of its player.
Result<std::vector<RecordedGrip>> watch(const std::string& scene_file, const std::string& input) {
    const Result<Recording> recording = load_recording(input);
    if (!recording) {
        return recording.error();
    }
    Result<Scene> loaded = load_scene_with_progress(scene_file);
    if (!loaded) {
        return loaded.error();
    }
    Scene& scene = loaded.value();
    load_game_body_clips(scene.host);
    const Pose origin_ws = from_host(find_spawn(scene, recording.value(), k_recorded_hz).origin_ws);
    const PlayerEntities player = add_scene_player(scene, {"player0", origin_ws, 80.0});
    GripWatch watched(player, std::filesystem::path(input).filename().string());
    RunSettings settings;
    settings.hz = k_recorded_hz;
    settings.keep_frames = false;
    run_session(scene, player_ids({&player, 1}), &recording.value(), settings,
                [&](const Scene& played, const FrameLog& frame) {
                    watched.take(played.world(), played.tuning(), played.caches().hands,
                                 frame.stats);
                });
    return std::move(watched.grips);
}

std::string line_of(const RecordedGrip& grip) {
    Json wrists = Json::array();
    for (const Pose& wrist : grip.wrists) {
        const Vec3& p = wrist.position;
        const Quat& q = wrist.rotation;
        wrists.push_back({{"position_m", {p.x(), p.y(), p.z()}},
                          {"rotation_xyzw", {q.x(), q.y(), q.z(), q.w()}}});
    }
    const Json line = {{"recording", grip.recording},
                       {"hand", grip.hand},
                       {"us", grip.us},
                       {"thumb_depth_mm", grip.thumb_depth_mm},
                       {"fingers_depth_mm", grip.fingers_depth_mm},
                       {"out_of_sight", grip.out_of_sight},
                       {"wrists", std::move(wrists)}};
    return line.dump() + "\n";
}

// Frames of a grip in which the shown hand is still closing.
constexpr std::size_t k_closing_frames = 27;

// Counts frames in which a digit of a shown hand is deep in a surface.
class Depths {
  public:
    void add(const RecordedGrip& grip, std::size_t frame) {
        ++frames_;
        deep_thumbs_ += grip.thumb_depth_mm[frame] > k_deep_mm ? 1U : 0U;
        deep_fingers_ += grip.fingers_depth_mm[frame] > k_deep_mm ? 1U : 0U;
    }
    void print(const char* when) const {
        const double percent = 100.0 / static_cast<double>(std::max<std::size_t>(1, frames_));
        std::printf("deeper than %.0f mm in %s: thumb %.2f %%, fingers %.2f %% of frames\n",
                    k_deep_mm, when, percent * static_cast<double>(deep_thumbs_),
                    percent * static_cast<double>(deep_fingers_));
    }

  private:
    static constexpr double k_deep_mm = 3.0;
    std::size_t frames_ = 0;
    std::size_t deep_thumbs_ = 0;
    std::size_t deep_fingers_ = 0;
};

void print_figures(const std::vector<RecordedGrip>& grips) {
    Series speed_mps;
    Series turn_dps;
    Series onset_us;
    Series later_us;
    Series warm_us;
    Depths onset_depths;
    Depths held_depths;
    std::size_t frames = 0;
    std::size_t hidden = 0;
    for (const RecordedGrip& grip : grips) {
        frames += grip.out_of_sight.size();
        hidden += static_cast<std::size_t>(std::ranges::count(grip.out_of_sight, true));
        for (std::size_t i = 0; i < grip.wrists.size(); ++i) {
            (i == 0 ? onset_us : i <= k_thumb_tries ? later_us : warm_us).add(grip.us[i]);
            (i < k_closing_frames ? onset_depths : held_depths).add(grip, i);
            if (i > 0) {
                const Pose step = inverse(grip.wrists[i - 1]) * grip.wrists[i];
                speed_mps.add(k_recorded_hz *
                              (grip.wrists[i].position - grip.wrists[i - 1].position).norm());
                turn_dps.add(k_recorded_hz / k_degree * rotation_to_vector(step.rotation).norm());
            }
        }
    }
    std::printf("%zu grips, %zu frames after their first\n", grips.size(), speed_mps.values.size());
    const auto print = [](const char* name, const Series& series) {
        std::printf("%-22s median %8.3f  90 %% %8.3f  99 %% %8.3f\n", name, series.quantile(0.5),
                    series.quantile(0.9), series.quantile(0.99));
    };
    print("wrist speed, m/s", speed_mps);
    print("wrist turning, deg/s", turn_dps);
    print("a warm hand, us", warm_us);
    print("six frames after, us", later_us);
    print("a closing hand, us", onset_us);
    onset_depths.print("0.3 s of a grip");
    held_depths.print("later");
    std::printf("palm out of sight, behind what it grips: %.2f %% of frames\n",
                100.0 * static_cast<double>(hidden) /
                    static_cast<double>(std::max<std::size_t>(1, frames)));
}

}  // namespace

int recorded_grips_command(const RecordedGripsOptions& options) {
    set_stage_clock(StageClock::thread_cpu);
    std::vector<RecordedGrip> grips;
    Progress progress("recordings");
    for (std::size_t i = 0; i < options.inputs.size(); ++i) {
        const Result<std::vector<RecordedGrip>> watched = watch(options.scene, options.inputs[i]);
        if (!watched) {
            return refuse(watched.error());
        }
        grips.insert(grips.end(), watched.value().begin(), watched.value().end());
        progress.show(static_cast<double>(i + 1) / static_cast<double>(options.inputs.size()));
    }
    print_figures(grips);
    std::string text;
    for (const RecordedGrip& grip : grips) {
        text += line_of(grip);
    }
    if (const auto error = write_file_atomically(options.out, text)) {
        return refuse(*error);
    }
    return 0;
}

std::vector<std::vector<Pose>> wrist_motions(const std::vector<RecordedGrip>& grips,
                                             std::size_t frames, std::size_t count) {
    // Grip and first frame of each stretch.
    std::vector<std::pair<const RecordedGrip*, std::size_t>> stretches;
    for (const RecordedGrip& grip : grips) {
        for (std::size_t begin = 0; begin + frames < grip.wrists.size(); begin += frames) {
            stretches.emplace_back(&grip, begin);
        }
    }
    std::vector<std::vector<Pose>> motions;
    for (std::size_t i = 0; i < count && !stretches.empty(); ++i) {
        const auto& [grip, begin] = stretches[i * stretches.size() / count];
        const Pose to_first = inverse(grip->wrists[begin]);
        std::vector<Pose> motion;
        for (std::size_t frame = 1; frame <= frames; ++frame) {
            motion.push_back(to_first * grip->wrists[begin + frame]);
        }
        motions.push_back(std::move(motion));
    }
    return motions;
}

Result<std::vector<RecordedGrip>> load_recorded_grips(const std::filesystem::path& path) {
    std::vector<RecordedGrip> grips;
    const auto error = read_json_lines(path, [&](const JsonValue& root) {
        RecordedGrip& grip = grips.emplace_back();
        grip.recording = root["recording"].text();
        grip.hand = root["hand"].text();
        for (const JsonValue& us : root["us"].items()) {
            grip.us.push_back(us.number(k_not_negative));
        }
        for (const JsonValue& hidden : root["out_of_sight"].optional_items()) {
            grip.out_of_sight.push_back(hidden.flag());
        }
        for (const JsonValue& wrist : root["wrists"].items()) {
            constexpr NumberRange k_range = {-1e7, 1e7, false};
            grip.wrists.push_back(
                {wrist["position_m"].vector(k_range), wrist["rotation_xyzw"].rotation()});
        }
    });
    if (error) {
        return *error;
    }
    return grips;
}

}  // namespace handhold::lab
