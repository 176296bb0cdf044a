#include "tools/lab/body_command.hpp"

#include <cstdio>

#include "engine/core/text_file.hpp"
#include "game/assets/assets.hpp"
#include "game/play/progress.hpp"
#include "systems/rigs/body_clips_json.hpp"
#include "tools/lab/body_files.hpp"
#include "tools/lab/body_looks.hpp"
#include "tools/lab/body_player.hpp"
#include "tools/lab/exit_status.hpp"

namespace handhold::lab {
namespace {

constexpr double k_first_frame_s = 1.0 / 90.0;
constexpr const char* k_header =
    "clip,t,chest_yaw_deg,lshx,lshy,lshz,rshx,rshy,rshz,lelx,lely,lelz,relx,rely,relz,"
    "l_arm_ratio,r_arm_ratio,shown_lshx,shown_lshy,shown_lshz,shown_rshx,shown_rshy,shown_rshz,"
    "shown_lelx,shown_lely,shown_lelz,shown_relx,shown_rely,shown_relz,"
    "chestx,chesty,chestz,chestqx,chestqy,chestqz,chestqw,waistx,waisty,waistz,"
    "hipsx,hipsy,hipsz,lfootx,lfooty,lfootz,rfootx,rfooty,rfootz\n";

class BodyRow {
  public:
    explicit BodyRow(std::string& text) : text_(text) {}

    void number(double value) {
        char cell[40];
        std::snprintf(cell, sizeof cell, ",%.6f", value);
        text_ += cell;
    }
    void point(const Vec3& p) {
        number(p.x());
        number(p.y());
        number(p.z());
    }
    // Shoulders, then elbows.
    void joints(const ArmPose& pose) {
        for (const ArmPose::Arm& arm : pose.arms) {
            point(arm.upper_ws.position);
        }
        for (const ArmPose::Arm& arm : pose.arms) {
            point(arm.forearm_ws.position);
        }
    }

  private:
    std::string& text_;
};

void append_row(const BodySample& sample, const BodyPlayer& player, std::string& text) {
    text += std::to_string(sample.clip);
    BodyRow row(text);
    row.number(sample.t_s);
    row.number(player.chest_yaw_deg());
    row.joints(player.arms());
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        row.number(player.arm_ratio(side));
    }
    row.joints(player.shown_arms());
    const SpinePose& spine = player.shown_spine();
    row.point(spine.chest_ws.position);
    for (const double part : spine.chest_ws.rotation.coeffs()) {
        row.number(part);
    }
    row.point(spine.spine_ws.back().position);
    row.point(spine.pelvis_ws.position);
    for (const SpinePose::Leg& leg : spine.legs) {
        row.point(leg.foot_ws.position);
    }
    text += '\n';
}

}  // namespace

std::vector<std::string> estimator_names() { return {"full", "talk", "naive"}; }

int body_command(const BodyOptions& options) {
    const auto samples = load_body_samples(options.in);
    if (!samples) {
        return refuse(samples.error());
    }
    const auto measures = load_body_measures(options.calib);
    if (!measures) {
        return refuse(measures.error());
    }
    auto clips = parse_body_clips(game_asset("body_clips.json"), "body_clips.json");
    if (!clips) {
        return refuse(clips.error());
    }
    std::string text = k_header;
    BodyPlayer player(options.estimator, std::move(clips.value()));
    BodyLooks looks;
    Progress progress("body");
    const std::vector<BodySample>& rows = samples.value();
    for (std::size_t row = 0; row < rows.size(); ++row) {
        const bool first = row == 0 || rows[row - 1].clip != rows[row].clip;
        if (first) {
            const auto found = measures.value().find(rows[row].clip);
            if (found == measures.value().end()) {
                return refuse({options.in.string(), "line " + std::to_string(row + 2),
                               "expected a clip that " + options.calib.string() + " has, found " +
                                   std::to_string(rows[row].clip)});
            }
            player.start(found->second);
            looks.restart();
        }
        const double dt_s = first ? k_first_frame_s : rows[row].t_s - rows[row - 1].t_s;
        player.step(rows[row], dt_s);
        append_row(rows[row], player, text);
        looks.take(player.shown_spine(), player.shown_arms(),
                   player.measures().eye_height_m / k_scale_eye_m, Quat::Identity(), dt_s);
        progress.show(static_cast<double>(row + 1) / static_cast<double>(rows.size()));
    }
    if (const auto error = write_file_atomically(options.out, text)) {
        return refuse(*error);
    }
    if (!options.looks.empty()) {
        if (const auto error = write_file_atomically(options.looks, looks.json().dump(1) + "\n")) {
            return refuse(*error);
        }
    }
    return 0;
}

}  // namespace handhold::lab
