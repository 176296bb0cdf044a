#include "game/ui/overlay.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>

#include <imgui.h>

#include "engine/core/check.hpp"

namespace handhold {
namespace {

// From Debian's fonts-dejavu-core. If the file is missing, panels use ImGui's small default font.
constexpr const char* k_font = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

constexpr std::array<ImGuiKey, static_cast<std::size_t>(UiKey::count)> k_keys = {
    ImGuiKey_Tab,       ImGuiKey_LeftArrow, ImGuiKey_RightArrow, ImGuiKey_UpArrow,
    ImGuiKey_DownArrow, ImGuiKey_PageUp,    ImGuiKey_PageDown,   ImGuiKey_Home,
    ImGuiKey_End,       ImGuiKey_Delete,    ImGuiKey_Backspace,  ImGuiKey_Enter,
    ImGuiKey_Escape,    ImGuiKey_A,         ImGuiKey_C,          ImGuiKey_V,
    ImGuiKey_X};

void set_style(float scale) {
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.WindowRounding = 6.0F;
    style.FrameRounding = 4.0F;
    style.GrabRounding = 4.0F;
    style.TabRounding = 4.0F;
    style.WindowBorderSize = 0.0F;
    style.WindowPadding = ImVec2(12.0F, 10.0F);
    style.ItemSpacing = ImVec2(8.0F, 5.0F);
    style.Colors[ImGuiCol_WindowBg] = ImVec4(0.055F, 0.065F, 0.08F, 0.90F);
    style.Colors[ImGuiCol_TitleBg] = ImVec4(0.05F, 0.10F, 0.14F, 1.0F);
    style.Colors[ImGuiCol_TitleBgActive] = ImVec4(0.06F, 0.20F, 0.28F, 1.0F);
    style.Colors[ImGuiCol_FrameBg] = ImVec4(0.17F, 0.22F, 0.28F, 1.0F);
    style.ScaleAllSizes(std::max(scale, 0.6F));
}

Image glyphs_of(ImFontAtlas& atlas) {
    unsigned char* pixels = nullptr;
    Image image;
    atlas.GetTexDataAsRGBA32(&pixels, &image.width_px, &image.height_px);
    image.rgba.assign(pixels, pixels + 4 * static_cast<std::ptrdiff_t>(image.width_px) *
                                           static_cast<std::ptrdiff_t>(image.height_px));
    return image;
}

}  // namespace

struct Overlay::Impl {
    ImGuiContext* context = nullptr;
    UiPicture picture;
};

Overlay::Overlay(int width_px, int height_px) : impl_(std::make_unique<Impl>()) {
    HH_CHECK(ImGui::GetCurrentContext() == nullptr, "only one overlay may exist", 1);
    IMGUI_CHECKVERSION();
    impl_->context = ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;  // writes no settings file into the working directory
    io.DisplaySize = ImVec2(static_cast<float>(width_px), static_cast<float>(height_px));
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    for (std::size_t i = 0; i < k_keys.size(); ++i) {
        io.KeyMap[k_keys[i]] = static_cast<int>(i);
    }
    constexpr float k_lines_a_picture = 45.0F;
    const float letters_px =
        std::clamp(static_cast<float>(height_px) / k_lines_a_picture, 11.0F, 40.0F);
    set_style(letters_px / 16.0F);
    std::error_code ignored;
    if (std::filesystem::exists(k_font, ignored)) {
        static constexpr ImWchar k_letters[] = {0x20, 0xFF, 0x2013, 0x2014, 0x2190, 0x2193, 0};
        io.Fonts->AddFontFromFileTTF(k_font, letters_px, nullptr, k_letters);
    } else {
        io.Fonts->AddFontDefault();
    }
    impl_->picture.glyphs = glyphs_of(*io.Fonts);
    impl_->picture.glyphs_revision = 1;
}

Overlay::~Overlay() { ImGui::DestroyContext(impl_->context); }

void Overlay::resize(int width_px, int height_px) {
    ImGui::SetCurrentContext(impl_->context);
    ImGui::GetIO().DisplaySize =
        ImVec2(static_cast<float>(width_px), static_cast<float>(height_px));
}

void Overlay::begin(const UiInput& input, double dt_s) {
    ImGui::SetCurrentContext(impl_->context);
    ImGuiIO& io = ImGui::GetIO();
    io.DeltaTime = static_cast<float>(std::clamp(dt_s, 1e-4, 1.0));
    io.MousePos = ImVec2(input.mouse_px[0], input.mouse_px[1]);
    std::copy(input.buttons.begin(), input.buttons.end(), io.MouseDown);
    io.MouseWheel += input.wheel;
    std::copy(input.keys.begin(), input.keys.end(), io.KeysDown);
    io.KeyCtrl = input.ctrl;
    io.KeyShift = input.shift;
    io.AddInputCharactersUTF8(input.text.c_str());
    ImGui::NewFrame();
}

const UiPicture& Overlay::end() {
    ImGui::Render();
    const ImDrawData& data = *ImGui::GetDrawData();
    UiPicture& out = impl_->picture;
    out.vertices.clear();
    out.indices.clear();
    out.commands.clear();
    static_assert(sizeof(UiVertex) == sizeof(ImDrawVert));
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        const auto first_vertex = static_cast<std::uint32_t>(out.vertices.size());
        const auto first_index = static_cast<std::uint32_t>(out.indices.size());
        out.vertices.resize(out.vertices.size() + static_cast<std::size_t>(list.VtxBuffer.Size));
        if (!list.VtxBuffer.empty()) {
            std::memcpy(out.vertices.data() + first_vertex, list.VtxBuffer.Data,
                        static_cast<std::size_t>(list.VtxBuffer.size_in_bytes()));
        }
        for (const ImDrawCmd& command : list.CmdBuffer) {
            for (unsigned k = 0; k < command.ElemCount; ++k) {
                const auto index = static_cast<int>(command.IdxOffset + k);
                out.indices.push_back(first_vertex + command.VtxOffset + list.IdxBuffer[index]);
            }
            out.commands.push_back(
                {{static_cast<int>(command.ClipRect.x), static_cast<int>(command.ClipRect.y),
                  static_cast<int>(command.ClipRect.z), static_cast<int>(command.ClipRect.w)},
                 first_index + command.IdxOffset,
                 command.ElemCount});
        }
    }
    return out;
}

bool Overlay::takes_keys() const {
    ImGui::SetCurrentContext(impl_->context);
    return ImGui::GetIO().WantTextInput;
}

}  // namespace handhold
