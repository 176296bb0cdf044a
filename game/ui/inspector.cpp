#include "game/ui/inspector.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <imgui.h>

#include "game/report/fallback_meanings.hpp"
#include "game/view/explain_fit.hpp"
#include "game/view/explain_hand.hpp"
#include "systems/rigs/hand_kinematics.hpp"

namespace handhold {
namespace {

const ImVec4 k_key_color(0.55F, 0.85F, 1.0F, 1.0F);
const ImVec4 k_soft(0.62F, 0.66F, 0.70F, 1.0F);
constexpr double k_listed_cost_m2 = 0.05e-6;
const ImVec4 k_warm(1.0F, 0.75F, 0.25F, 1.0F);

void show_figure(const char* name, const char* format, double value) {
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(name);
    ImGui::TableNextColumn();
    ImGui::Text(format, value);
}

void show_stage_times(const InspectorView& view) {
    const StageStats& stats = view.session.scene().stats();
    InspectorMemory& memory = view.memory;
    double total_us = 0.0;
    double longest_us = 1e-6;
    for (std::size_t i = 0; i < memory.smooth_us.size(); ++i) {
        constexpr double k_share = 0.1;  // weight of the newest value
        memory.smooth_us[i] += k_share * (stats.stage_us[i] - memory.smooth_us[i]);
        total_us += memory.smooth_us[i];
        longest_us = std::fmax(longest_us, memory.smooth_us[i]);
    }
    if (!ImGui::BeginTable("stages", 3, ImGuiTableFlags_SizingStretchProp)) {
        return;
    }
    for (std::size_t i = 0; i < memory.smooth_us.size(); ++i) {
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(name_of(static_cast<Stage>(i)));
        ImGui::TableNextColumn();
        ImGui::Text("%.1f us", memory.smooth_us[i]);
        ImGui::TableNextColumn();
        ImGui::ProgressBar(static_cast<float>(memory.smooth_us[i] / longest_us),
                           ImVec2(-1.0F, 0.8F * ImGui::GetFontSize()), "");
    }
    show_figure("all stages", "%.1f us", total_us);
    ImGui::TableNextColumn();
    ImGui::TextColored(k_soft, "%.1f %% of a frame at 90 Hz", total_us / 111.11);
    ImGui::EndTable();
}

void show_work(const InspectorView& view) {
    const StageStats& stats = view.session.scene().stats();
    if (!ImGui::BeginTable("work", 4, ImGuiTableFlags_SizingStretchProp)) {
        return;
    }
    show_figure("islands", "%.0f", static_cast<double>(stats.islands));
    show_figure("of them pushed", "%.0f", static_cast<double>(stats.islands_pushed));
    show_figure("contacts", "%.0f", static_cast<double>(stats.contacts));
    show_figure("contact rounds", "%.0f", static_cast<double>(stats.contact_rounds));
    show_figure("Newton iterations", "%.0f", static_cast<double>(stats.newton_iterations));
    show_figure("worst overlap", "%.4f mm", 1e3 * stats.residual_m);
    show_figure("worst joint", "%.4f mm", 1e3 * stats.joint_error_m);
    show_figure("worst hand", "%.4f mm", 1e3 * stats.hand_error_m);
    show_figure("drawing", "%.1f ms", 1e-3 * view.tally.draw_us());
    show_figure("history", "%.1f MB", 1e-6 * static_cast<double>(view.history.bytes()));
    ImGui::EndTable();
    ImGui::TextColored(k_soft, "R rewinds by up to %.1f s",
                       static_cast<double>(view.history.frames()) * DesktopSession::k_dt_s);
}

// Shows the counts of fallbacks; highlights recent ones for a while.
void show_fallbacks(const InspectorView& view) {
    InspectorMemory& memory = view.memory;
    const auto& counts = view.tally.figures().fallbacks;
    const double now_s = ImGui::GetTime();
    bool any = false;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (counts[i] != memory.counted[i]) {
            memory.counted[i] = counts[i];
            memory.counted_at_s[i] = now_s;
        }
        if (counts[i] == 0) {
            continue;
        }
        any = true;
        constexpr double k_new_s = 2.0;
        const bool is_new = now_s - memory.counted_at_s[i] < k_new_s;
        ImGui::TextColored(is_new ? k_warm : k_key_color, "%s  %llu",
                           name_of(static_cast<Fallback>(i)),
                           static_cast<unsigned long long>(counts[i]));
        ImGui::PushTextWrapPos(0.0F);
        ImGui::TextColored(k_soft, "%s", meaning_of(static_cast<Fallback>(i)));
        ImGui::PopTextWrapPos();
    }
    if (!any) {
        ImGui::TextColored(k_soft, "None yet.");
    }
}

void show_story(const char* name, const HandStory& story) {
    ImGui::TextColored(k_key_color, "%s", name);
    ImGui::SameLine();
    ImGui::TextUnformatted(story.headline.c_str());
    for (const std::string& reason : story.reasons) {
        ImGui::Bullet();
        ImGui::SameLine();
        ImGui::PushTextWrapPos(0.0F);
        ImGui::TextUnformatted(reason.c_str());
        ImGui::PopTextWrapPos();
    }
    ImGui::Spacing();
}

ImVec4 text_color(FitTerm term) {
    const Color color = color_of(term);
    return {color[0], color[1], color[2], 1.0F};
}

// One column of the table of costs, for the palm or a finger: its gap, then the cost of each listed
// term. The term that most shapes it is shown in colour.
struct FitColumn {
    const char* name;
    const FitTerms::Costs* cost_m2;
    double gap_m;  // infinity: no surface in reach
};

void show_cost(const FitColumn& column, FitTerm term) {
    const double cost_m2 = (*column.cost_m2)[static_cast<std::size_t>(term)];
    ImGui::TableNextColumn();
    if (cost_m2 < k_listed_cost_m2) {
        ImGui::TextColored(k_soft, "-");
    } else if (shaping_term(*column.cost_m2) == term) {
        ImGui::TextColored(text_color(term), "%.1f", 1e6 * cost_m2);
    } else {
        ImGui::Text("%.1f", 1e6 * cost_m2);
    }
}

void show_terms(std::span<const FitColumn> columns) {
    const auto row = [&](const char* name, const ImVec4& color) {
        ImGui::TableNextColumn();
        ImGui::TextColored(color, "%s", name);
    };
    row("gap, mm", k_soft);
    for (const FitColumn& column : columns) {
        ImGui::TableNextColumn();
        if (std::isfinite(column.gap_m)) {
            ImGui::Text("%.1f", 1e3 * column.gap_m);
        }
    }
    for (std::size_t i = 0; i < k_fit_term_count; ++i) {
        const bool is_listed = std::ranges::any_of(columns, [&](const FitColumn& column) {
            return (*column.cost_m2)[i] >= k_listed_cost_m2;
        });
        if (is_listed) {
            const auto term = static_cast<FitTerm>(i);
            row(name_of(term), text_color(term));
            for (const FitColumn& column : columns) {
                show_cost(column, term);
            }
        }
    }
    row("sum", k_soft);
    for (const FitColumn& column : columns) {
        ImGui::TableNextColumn();
        ImGui::Text("%.1f", 1e6 * sum_of(*column.cost_m2));
    }
}

// Shows why a gripping hand is shaped as it is. Shows nothing for other hands.
void show_fit(const InspectorView& view, Entity hand) {
    const Scene& scene = view.session.scene();
    const FrameCaches& caches = std::as_const(view.session).scene().caches();
    const auto terms = fit_terms_of(scene.world(), caches, scene.tuning(), hand);
    if (!terms) {
        return;
    }
    const HandRig& rig =
        *std::ranges::find(caches.hands.surroundings, hand, &HandSurroundings::hand)->rig;
    std::vector<FitColumn> columns = {
        {"palm", &terms->cost_m2[FitTerms::k_palm], std::numeric_limits<double>::infinity()}};
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        columns.push_back({finger_text(rig.fingers[f].name), &terms->cost_m2[f], terms->gap_m[f]});
    }
    for (const FitColumn& column : columns) {
        if (const auto term = shaping_term(*column.cost_m2)) {
            ImGui::TextColored(text_color(*term), "%s", column.name);
            ImGui::SameLine();
            ImGui::TextColored(k_soft, "%s (%s)", meaning_of(*term), name_of(*term));
        }
    }
    ImGui::PushID(static_cast<int>(hand.slot));
    if (ImGui::BeginTable("fit", static_cast<int>(columns.size()) + 1,
                          ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_RowBg)) {
        ImGui::TableNextColumn();
        ImGui::TextColored(k_soft, "cost, mm^2");
        for (const FitColumn& column : columns) {
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(column.name);
        }
        show_terms(columns);
        ImGui::EndTable();
    }
    ImGui::PopID();
    ImGui::Spacing();
}

}  // namespace

void show_frame_page(const InspectorView& view) {
    ImGui::TextColored(k_soft, "frame %llu, %.2f s; stage times, smoothed",
                       static_cast<unsigned long long>(view.session.scene().world().clock.frame),
                       view.session.scene().world().clock.t_s);
    show_stage_times(view);
    ImGui::Separator();
    show_work(view);
    ImGui::Separator();
    ImGui::TextUnformatted("Fallbacks (requests that could not be met)");
    show_fallbacks(view);
}

void show_hands_page(const InspectorView& view) {
    const Scene& scene = view.session.scene();
    const CollisionWorld& collision = std::as_const(view.session).scene().caches().collision;
    const PlayerEntities player = player_entities(scene.world(), view.session.player());
    show_story("Left hand", explain_hand(scene, collision, player.hands[0]));
    show_fit(view, player.hands[0]);
    show_story("Right hand", explain_hand(scene, collision, player.hands[1]));
    show_fit(view, player.hands[1]);
    ImGui::Separator();
    const Pose& head_ws = scene.world().render_pose.at(player.player).head_ws;
    const auto pointed =
        hand_pointed_at(scene.world(), head_ws.position, head_ws.rotation * -Vec3::UnitZ());
    if (pointed) {
        view.memory.pointed_hand = pointed;
    }
    const auto& hand = view.memory.pointed_hand;
    if (hand && scene.world().hand_owner.contains(*hand)) {
        const HandOwner& owner = scene.world().hand_owner.at(*hand);
        const std::string name =
            name_of_entity(scene, owner.player) + ", " + name_of_entity(scene, *hand);
        ImGui::TextColored(k_soft, "Pointed at:");
        show_story(name.c_str(), explain_hand(scene, collision, *hand));
        if (owner.player != player.player) {
            show_fit(view, *hand);
        }
    } else {
        ImGui::TextColored(k_soft, "Look at any hand, and it is explained here.");
    }
}

void show_gizmos_page(const InspectorView& view) {
    GizmoSet& on = view.memory.gizmos;
    if (ImGui::Button("All")) {
        on.fill(true);
    }
    ImGui::SameLine();
    if (ImGui::Button("None")) {
        on.fill(false);
    }
    if (ImGui::BeginTable("gizmos", 2)) {
        ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthFixed);
        ImGui::TableSetupColumn("what", ImGuiTableColumnFlags_WidthStretch);
        for (std::size_t i = 0; i < on.size(); ++i) {
            const GizmoInfo info = info_of(static_cast<Gizmo>(i));
            ImGui::TableNextColumn();
            ImGui::Checkbox(info.name, &on[i]);
            ImGui::TableNextColumn();
            ImGui::PushTextWrapPos(0.0F);
            ImGui::TextColored(k_soft, "%s: %s", info.stage, info.what);
            ImGui::PopTextWrapPos();
        }
        ImGui::EndTable();
    }
}

void show_inspector(const InspectorView& view) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const float margin = 0.5F * ImGui::GetFontSize();
    const float width = std::fmin(34.0F * ImGui::GetFontSize(), 0.6F * size.x);
    ImGui::SetNextWindowPos(ImVec2(size.x - width - margin, margin), ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize(ImVec2(width, size.y - 2.0F * margin), ImGuiCond_FirstUseEver);
    ImGui::Begin("Inspector (F2)");
    if (ImGui::BeginTabBar("pages")) {
        const auto page = [&](const char* name, void (*show)(const InspectorView&)) {
            const bool turns = view.memory.turn_to == name;
            if (ImGui::BeginTabItem(name, nullptr, turns ? ImGuiTabItemFlags_SetSelected : 0)) {
                ImGui::BeginChild(name);
                show(view);
                ImGui::EndChild();
                ImGui::EndTabItem();
            }
        };
        page("Frame", show_frame_page);
        page("Hands", show_hands_page);
        page("Bodies", show_bodies_page);
        page("Tuning", show_tuning_page);
        page("Entities", show_entities_page);
        page("Gizmos", show_gizmos_page);
        ImGui::EndTabBar();
        view.memory.turn_to.clear();
    }
    ImGui::End();
}

}  // namespace handhold
