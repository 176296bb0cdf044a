#include "game/ui/hud.hpp"

#include <array>
#include <cmath>

#include <imgui.h>

namespace handhold {
namespace {

constexpr ImU32 k_ink = IM_COL32(235, 240, 245, 255);
constexpr ImU32 k_lit = IM_COL32(70, 255, 110, 255);
constexpr ImU32 k_shade = IM_COL32(0, 0, 0, 190);

struct HelpLine {
    const char* keys;
    const char* what;
};
constexpr std::array<HelpLine, 13> k_help = {{
    {"Mouse", "look around; the mark is green where a hand can reach, a ring shows the place"},
    {"Left, right button", "that hand reaches, and grips while you hold it"},
    {"W A S D  Q E", "pull yourself by what you grip"},
    {"Wheel", "farther, nearer"},
    {"Shift, Space", "faster, brake"},
    {"Z C", "turn left, right"},
    {"P  O  R", "pause, one step, rewind while held"},
    {"F1", "this help"},
    {"F2", "inspector: what the runtime does, and its numbers"},
    {"F3", "scenes and settings"},
    {"F4", "see yourself: from the front, from behind, flying"},
    {"Tab, Esc", "free the mouse, leave"},
    {"Gamepad", "triggers grip, left stick pulls, right stick looks"},
}};

void show_mark(bool can_reach) {
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const ImVec2 middle(0.5F * size.x, 0.5F * size.y);
    const float radius = std::fmax(size.y / 180.0F, 2.0F) * (can_reach ? 1.5F : 1.0F);
    list.AddCircleFilled(middle, radius + 2.0F, k_shade, 20);
    list.AddCircleFilled(middle, radius, can_reach ? k_lit : k_ink, 20);
}

// Darkens the edges: movement in the periphery causes motion sickness, movement in the centre does
// not.
void show_vignette(double strength) {
    constexpr int k_parts = 48;
    constexpr float k_inner = 0.62F;  // fraction of the half diagonal
    constexpr float k_outer = 1.02F;
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const ImVec2 middle(0.5F * size.x, 0.5F * size.y);
    const float radius = std::hypot(middle.x, middle.y);
    const float wide = size.x / std::fmax(size.y, 1.0F);
    const auto alpha = static_cast<int>(std::lround(245.0 * std::fmin(strength, 1.0)));
    const ImU32 dark = IM_COL32(0, 0, 0, alpha);
    const ImVec2 white = ImGui::GetIO().Fonts->TexUvWhitePixel;
    const float shrink = 1.0F - 0.35F * static_cast<float>(std::fmin(strength, 1.0));
    list.PrimReserve(6 * k_parts, 2 * (k_parts + 1));
    const auto base = list._VtxCurrentIdx;
    for (int i = 0; i <= k_parts; ++i) {
        const float angle = 6.2831853F * static_cast<float>(i) / k_parts;
        const float x = std::cos(angle) * (wide > 1.0F ? 1.15F : 1.0F);
        const float y = std::sin(angle) * 0.8F;
        const float from = radius * k_inner * shrink;
        const float to = radius * k_outer * 2.0F;
        list.PrimWriteVtx(ImVec2(middle.x + from * x, middle.y + from * y), white,
                          IM_COL32(0, 0, 0, 0));
        list.PrimWriteVtx(ImVec2(middle.x + to * x, middle.y + to * y), white, dark);
    }
    for (unsigned i = 0; i < k_parts; ++i) {
        for (const unsigned corner : {0U, 1U, 2U, 2U, 1U, 3U}) {
            list.PrimWriteIdx(static_cast<ImDrawIdx>(base + 2 * i + corner));
        }
    }
}

void begin_note(const char* name, ImVec2 place, ImVec2 pivot) {
    ImGui::SetNextWindowPos(place, ImGuiCond_Always, pivot);
    ImGui::SetNextWindowBgAlpha(0.62F);
    ImGui::Begin(name, nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs |
                     ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoBringToFrontOnFocus);
}

void show_help() {
    const float margin = ImGui::GetFontSize();
    begin_note("help", ImVec2(margin, margin), ImVec2(0.0F, 0.0F));
    if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
        for (const HelpLine& line : k_help) {
            ImGui::TableNextColumn();
            ImGui::TextColored(ImVec4(0.55F, 0.85F, 1.0F, 1.0F), "%s", line.keys);
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(line.what);
        }
        ImGui::EndTable();
    }
    ImGui::End();
}

}  // namespace

const char* help_text() {
    return "Look around with the mouse. The mark is green where a hand can reach.\n"
           "Left, right button: that hand reaches, and grips while you hold it.\n"
           "W A S D, Q E: pull yourself by what you grip. F1 shows all keys.";
}

void show_caption(const std::string& caption) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    begin_note("caption", ImVec2(0.5F * size.x, 0.96F * size.y), ImVec2(0.5F, 1.0F));
    ImGui::TextUnformatted(caption.c_str());
    ImGui::End();
}

void show_hud(const Hud& hud) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    if (hud.vignette > 0.01) {
        show_vignette(hud.vignette);
    }
    if (hud.shows_mark) {
        show_mark(hud.can_reach);
    }
    if (hud.shows_help) {
        show_help();
    }
    if (hud.paused) {
        begin_note("paused", ImVec2(0.5F * size.x, 0.06F * size.y), ImVec2(0.5F, 0.0F));
        if (hud.rewound_s > 0.0) {
            ImGui::Text("paused, %.2f s back: P continues from here, O one step", hud.rewound_s);
        } else {
            ImGui::TextUnformatted("paused: P continues, O one step, R rewinds");
        }
        ImGui::End();
    }
    if (!hud.score.empty()) {
        begin_note("score", ImVec2(0.5F * size.x, 0.02F * size.y), ImVec2(0.5F, 0.0F));
        ImGui::TextUnformatted(hud.score.c_str());
        ImGui::End();
    }
    if (!hud.hint.empty() && !hud.paused) {
        begin_note("hint", ImVec2(0.5F * size.x, 0.86F * size.y), ImVec2(0.5F, 1.0F));
        ImGui::TextUnformatted(hud.hint.c_str());
        ImGui::End();
    }
    if (!hud.footer.empty()) {
        begin_note("cost", ImVec2(4.0F, size.y - 4.0F), ImVec2(0.0F, 1.0F));
        ImGui::TextUnformatted(hud.footer.c_str());
        ImGui::End();
    }
}

}  // namespace handhold
