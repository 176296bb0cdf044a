#include "tools/lab/grip_command.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <utility>

#include "engine/core/profile.hpp"
#include "engine/core/text_file.hpp"
#include "engine/io/gltf.hpp"
#include "engine/io/gltf_skin.hpp"
#include "game/play/progress.hpp"
#include "systems/rigs/builtin_hand_rig.hpp"
#include "systems/rigs/hand_rig_fit.hpp"
#include "tools/lab/exit_status.hpp"
#include "tools/lab/grip_files.hpp"
#include "tools/lab/recorded_grips.hpp"

namespace handhold::lab {
namespace {

// Returns all parts of a file as one mesh, in the frame of the file's scene.
Result<Mesh> load_mesh(const std::filesystem::path& path) {
    const Result<GltfLevel> level = load_gltf_level(path);
    if (!level) {
        return level.error();
    }
    Mesh whole;
    for (const LevelPart& part : level.value().parts) {
        const auto first = static_cast<std::uint32_t>(whole.positions.size());
        whole.positions.insert(whole.positions.end(), part.mesh.positions.begin(),
                               part.mesh.positions.end());
        for (const auto& [a, b, c] : part.mesh.triangles) {
            whole.triangles.push_back({first + a, first + b, first + c});
        }
    }
    if (whole.triangles.empty()) {
        return FileError{path.string(), "", "expected a mesh, found no triangle"};
    }
    return whole;
}

Result<HandRig> load_rig(const GripOptions& options) {
    const HandSide side = options.hand == "left" ? HandSide::left : HandSide::right;
    if (options.rig == "builtin") {
        return builtin_hand_rig(side);
    }
    const Result<SkinnedMesh> skin = load_gltf_skin(options.rig);
    if (!skin) {
        return skin.error();
    }
    return hand_rig_from_skin(skin.value(), side);
}

FingerMethod finger_method_of(const std::string& name) {
    return name == "talk"      ? FingerMethod::talk
           : name == "spheres" ? FingerMethod::spheres
           : name == "closing" ? FingerMethod::closing
                               : FingerMethod::fit;
}

SearchOrder search_order_of(const std::string& name) {
    return name == "bfs"     ? SearchOrder::breadth_first
           : name == "flood" ? SearchOrder::flood
                             : SearchOrder::best_first;
}

// A search other than the runtime's exists only for the method "talk".
std::string fingers_of(const GripOptions& options) {
    if (!options.fingers.empty()) {
        return options.fingers;
    }
    return options.search == "astar" ? "fit" : "talk";
}

GripVariant variant_of(const GripOptions& options) {
    GripVariant variant;
    variant.sync = options.sync == "on";
    variant.order = search_order_of(options.search);
    variant.palm = options.palm == "ray" ? PalmChoice::ray_only : PalmChoice::smallest_sync;
    variant.fingers = finger_method_of(fingers_of(options));
    variant.shown_after = options.shown_after;
    return variant;
}

std::string pose_all(const GripOptions& options, const GripMesh& mesh, const HandRig& rig,
                     const std::vector<Placement>& placements) {
    const GripVariant variant = variant_of(options);
    const Tuning tuning;
    Progress progress("grip");
    std::string text;
    for (std::size_t i = 0; i < placements.size(); ++i) {
        const PosedHand posed = pose_cold_hand(mesh, rig, placements[i].wrist, tuning, variant);
        text += posed_hand_line(placements[i].id, rig, posed);
        progress.show(static_cast<double>(i + 1) / static_cast<double>(placements.size()));
    }
    return text;
}

// The value at place floor(share (n - 1)) of the n sorted values, counted from 0; 0 if n is 0.
template <typename Value>
Value quantile(std::vector<Value> values, double share) {
    if (values.empty()) {
        return {};
    }
    const auto place = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(place),
                     values.end());
    return values[place];
}

void append(const WarmHand& one, WarmHand& all) {
    all.moving_us.insert(all.moving_us.end(), one.moving_us.begin(), one.moving_us.end());
    all.stand_us.insert(all.stand_us.end(), one.stand_us.begin(), one.stand_us.end());
    all.pops.insert(all.pops.end(), one.pops.begin(), one.pops.end());
    all.joint_frames += one.joint_frames;
    all.jumps += one.jumps;
    all.shown_jumps += one.shown_jumps;
}

void print_figures(const WarmHand& all) {
    std::printf("moving_us median %.1f p99 %.1f\nstand_us median %.2f p99 %.2f\n",
                quantile(all.moving_us, 0.5), quantile(all.moving_us, 0.99),
                quantile(all.stand_us, 0.5), quantile(all.stand_us, 0.99));
    std::printf("pops_a_disc median %u p95 %u\njumps %u of %u joint-frames, shown %u\n",
                quantile(all.pops, 0.5), quantile(all.pops, 0.95), all.jumps, all.joint_frames,
                all.shown_jumps);
}

std::optional<FileError> move_all(const GripOptions& options, const GripMesh& mesh,
                                  const HandRig& rig, const std::vector<Placement>& placements) {
    const Result<std::vector<RecordedGrip>> grips = load_recorded_grips(options.motions);
    if (!grips) {
        return grips.error();
    }
    const auto frames = static_cast<std::size_t>(options.warm_frames);
    const auto motions = wrist_motions(grips.value(), frames, placements.size());
    if (motions.size() < placements.size()) {
        return FileError{
            options.motions.string(), "",
            "expected a grip of more than " + std::to_string(frames) + " frames, found none"};
    }
    WarmHand all;
    std::string moved;
    Progress progress("warm");
    for (std::size_t i = 0; i < placements.size(); ++i) {
        const WarmHand one =
            move_hand(mesh, rig, placements[i].wrist, {}, variant_of(options), motions[i]);
        append(one, all);
        moved += posed_hand_line(placements[i].id, rig, one.moved);
        progress.show(static_cast<double>(i + 1) / static_cast<double>(placements.size()));
    }
    print_figures(all);
    if (!options.moved_out.empty()) {
        if (auto error = write_file_atomically(options.moved_out, moved)) {
            return error;
        }
    }
    return options.warm_json.empty()
               ? std::nullopt
               : write_file_atomically(options.warm_json, warm_hands_json(all));
}

}  // namespace

int grip_command(const GripOptions& options) {
    if (options.search != "astar" && fingers_of(options) != "talk") {
        std::fprintf(stderr, "handhold-lab: --search %s needs --fingers talk\n",
                     options.search.c_str());
        return k_exit_usage;
    }
    const Result<HandRig> rig = load_rig(options);
    if (!rig) {
        return refuse(rig.error());
    }
    if (!options.rig_json.empty()) {
        if (const auto error =
                write_file_atomically(options.rig_json, hand_rig_json(rig.value()))) {
            return refuse(*error);
        }
    }
    const Result<Mesh> mesh = load_mesh(options.mesh);
    if (!mesh) {
        return refuse(mesh.error());
    }
    const Result<std::vector<Placement>> placements = load_placements(options.placements);
    if (!placements) {
        return refuse(placements.error());
    }
    set_stage_clock(StageClock::thread_cpu);
    GripMeshSettings settings;
    settings.search.edge_m = 1e-3 * options.grip_edge_mm;
    const GripMesh grip_mesh = build_grip_mesh(mesh.value(), settings);
    const std::string text = pose_all(options, grip_mesh, rig.value(), placements.value());
    if (const auto error = write_file_atomically(options.out, text)) {
        return refuse(*error);
    }
    if (options.warm_frames > 0) {
        if (const auto error = move_all(options, grip_mesh, rig.value(), placements.value())) {
            return refuse(*error);
        }
    }
    return 0;
}

}  // namespace handhold::lab
