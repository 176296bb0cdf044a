#include "game/ui/menu.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include <imgui.h>

#include "game/levels/built_in_scenes.hpp"

namespace handhold {
namespace {

const ImVec4 k_soft(0.62F, 0.66F, 0.70F, 1.0F);
const ImVec4 k_lit(0.27F, 1.0F, 0.43F, 1.0F);

// The built-in scenes' names and descriptions. The list is made once, because a scene must be built
// to get its description.
const std::vector<std::pair<std::string, std::string>>& scenes_with_texts() {
    static const std::vector<std::pair<std::string, std::string>> scenes = [] {
        std::vector<std::pair<std::string, std::string>> list;
        for (const std::string_view name : built_in_scenes()) {
            if (const auto scene = make_built_in_scene(name)) {
                list.emplace_back(scene->name, scene->description);
            }
        }
        return list;
    }();
    return scenes;
}

void slider(const char* name, double& value, double low, double high, const char* format) {
    ImGui::SliderScalar(name, ImGuiDataType_Double, &value, &low, &high, format,
                        ImGuiSliderFlags_AlwaysClamp);
}

void show_scenes(const std::string& playing, MenuChoice& choice) {
    for (const auto& [name, what] : scenes_with_texts()) {
        ImGui::PushID(name.c_str());
        if (ImGui::Button(name == playing ? "Again" : "Play",
                          ImVec2(4.5F * ImGui::GetFontSize(), 0.0F))) {
            choice.scene = name;
        }
        ImGui::SameLine();
        if (name == playing) {
            ImGui::TextColored(k_lit, "%s", name.c_str());
        } else {
            ImGui::TextUnformatted(name.c_str());
        }
        ImGui::Indent(5.2F * ImGui::GetFontSize());
        ImGui::PushTextWrapPos(0.0F);
        ImGui::TextColored(k_soft, "%s", what.c_str());
        ImGui::PopTextWrapPos();
        ImGui::Unindent(5.2F * ImGui::GetFontSize());
        ImGui::PopID();
    }
}

void show_settings(PlaySettings& settings, MenuChoice& choice) {
    constexpr double k_thousand = 1e3;
    double mouse = k_thousand * settings.mouse_rad_per_px;
    slider("mouse, mrad/pixel", mouse, 0.2, 20.0, "%.1f");
    settings.mouse_rad_per_px = mouse / k_thousand;
    slider("gamepad look, rad/s", settings.stick_look_radps, 0.2, 8.0, "%.1f");
    slider("field of view, rad", settings.fov_rad, 0.6, 2.0, "%.2f");
    slider("comfort vignette", settings.vignette, 0.0, 1.0, "%.2f");
    int turn = static_cast<int>(settings.turn);
    if (ImGui::Combo("Z and C turn", &turn, "in steps\0smoothly\0")) {
        settings.turn = static_cast<TurnKind>(turn);
    }
    int quality = static_cast<int>(settings.quality);
    if (ImGui::Combo("pictures", &quality,
                     "plain: no shadows, no glow\0quick\0fine: four samples a pixel\0")) {
        settings.quality = static_cast<PictureQuality>(quality);
        choice.quality = true;
    }
}

}  // namespace

MenuChoice show_menu(const std::string& playing, PlaySettings& settings) {
    MenuChoice choice;
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const float width = std::fmin(36.0F * ImGui::GetFontSize(), 0.55F * size.x);
    ImGui::SetNextWindowPos(ImVec2(0.03F * size.x, 0.05F * size.y), ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize(ImVec2(width, 0.9F * size.y), ImGuiCond_FirstUseEver);
    ImGui::Begin("Handhold (F3)");
    if (ImGui::CollapsingHeader("Scenes", ImGuiTreeNodeFlags_DefaultOpen)) {
        show_scenes(playing, choice);
    }
    if (ImGui::CollapsingHeader("Settings", ImGuiTreeNodeFlags_DefaultOpen)) {
        show_settings(settings, choice);
    }
    ImGui::Spacing();
    choice.goes_on = ImGui::Button("Go on");
    ImGui::SameLine();
    choice.leaves = ImGui::Button("Leave the game");
    ImGui::End();
    return choice;
}

}  // namespace handhold
