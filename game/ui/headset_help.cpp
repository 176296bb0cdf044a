#include "game/ui/headset_help.hpp"

#include <imgui.h>

namespace handhold {
namespace {

void help_line(const char* control, const char* what) {
    constexpr float k_second_column_ems = 11.5F;
    ImGui::TextColored(ImVec4(0.55F, 0.85F, 1.0F, 1.0F), "%s", control);
    ImGui::SameLine(k_second_column_ems * ImGui::GetFontSize());
    ImGui::TextUnformatted(what);
}

}  // namespace

// Shows a panel of fixed size without a table: a table takes its widths from the previous frame,
// but each picture here is laid out from scratch.
void show_headset_help(const HeadsetHelp& help) {
    ImGui::SetNextWindowPos(ImVec2(0.0F, 0.0F));
    ImGui::SetNextWindowSize(
        ImVec2(static_cast<float>(k_headset_help_px[0]), static_cast<float>(k_headset_help_px[1])));
    ImGui::SetNextWindowBgAlpha(0.88F);
    ImGui::Begin("headset help", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs);
    help_line("Squeeze or trigger", "close the hand: it grips what the palm touches");
    help_line("Pull, push", "move yourself by what you grip; let go to drift");
    if (help.pulls) {
        help_line("Close on nothing", "pulls what the palm points at");
    }
    help_line("Right stick", help.turn == TurnKind::snap ? "turn, by steps" : "turn");
    if (help.has_jets) {
        help_line("Left stick", "jets, where you look");
    }
    help_line("X, A, trackpad", "brake");
    help_line("Y, B, menu: left", "show or hide this sheet");
    help_line("Y, B, menu: both", "measure me: hold a T-pose for a second");
    if (!help.notice.empty()) {
        ImGui::Separator();
        ImGui::TextColored(ImVec4(1.0F, 0.8F, 0.35F, 1.0F), "%s", help.notice.c_str());
    }
    ImGui::End();
}

}  // namespace handhold
