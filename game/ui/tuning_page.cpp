#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

#include <imgui.h>

#include "engine/core/text_file.hpp"
#include "game/ui/inspector.hpp"
#include "systems/host/tuning_json.hpp"

namespace handhold {
namespace {

const ImVec4 k_soft(0.62F, 0.66F, 0.70F, 1.0F);
const ImVec4 k_changed(1.0F, 0.75F, 0.25F, 1.0F);

// A number format with enough digits for this range.
const char* format_of(double low, double high) {
    constexpr double k_tiny = 1e-3;
    constexpr double k_many_decades = 1e4;
    return low > 0.0 && (low < k_tiny || high / low > k_many_decades) ? "%.3g" : "%.4g";
}

bool edit(const TuningInfo& info, double& field) {
    const bool by_decades = info.low > 0.0 && info.high / info.low > 1e3;
    const auto speed = static_cast<float>(std::fmax(std::fabs(field), 1e-3) * 0.01);
    return ImGui::DragScalar(
        "##value", ImGuiDataType_Double, &field, speed, &info.low, &info.high,
        format_of(info.low, info.high),
        ImGuiSliderFlags_AlwaysClamp | (by_decades ? ImGuiSliderFlags_Logarithmic : 0));
}
bool edit(const TuningInfo& info, Vec3& field) {
    return ImGui::DragScalarN("##value", ImGuiDataType_Double, field.data(), 3, 0.001F, &info.low,
                              &info.high, "%.3f", ImGuiSliderFlags_AlwaysClamp);
}
bool edit(const TuningInfo& info, std::int32_t& field) {
    const auto low = static_cast<std::int32_t>(info.low);
    const auto high = static_cast<std::int32_t>(info.high);
    return ImGui::DragScalar("##value", ImGuiDataType_S32, &field, 0.1F, &low, &high, "%d",
                             ImGuiSliderFlags_AlwaysClamp);
}
bool edit(const TuningInfo& /*info*/, SupportFollow& field) {
    int choice = static_cast<int>(field);
    const bool changed = ImGui::Combo("##value", &choice, "off\0yaw\0full\0");
    field = static_cast<SupportFollow>(choice);
    return changed;
}

template <typename T>
T default_of(const TuningInfo& info) {
    const Tuning standard;
    T value{};
    visit_tuning(standard, [&](const TuningInfo& other, const auto& field) {
        if constexpr (std::is_same_v<std::decay_t<decltype(field)>, T>) {
            if (std::string_view(other.name) == info.name) {
                value = field;
            }
        }
    });
    return value;
}

// Shows one value: name, field, unit and range. A click on the name restores the default.
template <typename T>
bool show_number(const TuningInfo& info, T& field) {
    const T standard = default_of<T>(info);
    const bool is_default = field == standard;
    const std::string_view name = info.name;
    const char* const short_name = info.name + name.find('.') + 1;
    ImGui::PushID(info.name);
    ImGui::TableNextColumn();
    ImGui::AlignTextToFramePadding();
    bool changed = false;
    if (is_default) {
        ImGui::TextUnformatted(short_name);
    } else {
        ImGui::TextColored(k_changed, "%s", short_name);
        if (ImGui::IsItemClicked()) {
            field = standard;
            changed = true;
        }
    }
    if (ImGui::IsItemHovered()) {
        ImGui::SetTooltip("%s%s", info.what,
                          is_default ? "" : "\n(changed; click to restore the default)");
    }
    ImGui::TableNextColumn();
    ImGui::SetNextItemWidth(-1.0F);
    changed = edit(info, field) || changed;
    ImGui::TableNextColumn();
    ImGui::AlignTextToFramePadding();
    ImGui::TextColored(k_soft, "%s  [%g, %g]", info.unit, info.low, info.high);
    ImGui::PopID();
    return changed;
}

// Begins the table of one group; false if the group is collapsed. Columns have the same width in
// all groups.
bool begin_group(const std::string& name) {
    if (!ImGui::CollapsingHeader(name.c_str(), ImGuiTreeNodeFlags_DefaultOpen) ||
        !ImGui::BeginTable(name.c_str(), 3)) {
        return false;
    }
    ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch, 1.2F);
    ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch, 1.0F);
    ImGui::TableSetupColumn("range", ImGuiTableColumnFlags_WidthStretch, 1.0F);
    return true;
}

// Shows every value of Tuning, grouped by the first part of its name.
bool show_numbers(Tuning& tuning) {
    std::string_view group;
    bool open = false;
    bool changed = false;
    visit_tuning(tuning, [&](const TuningInfo& info, auto& field) {
        const std::string_view name = info.name;
        const std::string_view head = name.substr(0, name.find('.'));
        if (head != group) {
            if (open) {
                ImGui::EndTable();
            }
            group = head;
            open = begin_group(std::string(head));
        }
        if (open) {
            changed = show_number(info, field) || changed;
        }
    });
    if (open) {
        ImGui::EndTable();
    }
    return changed;
}

void save_tuning(const Tuning& tuning, InspectorMemory& memory) {
    const auto error = write_file_atomically(memory.tuning_file.data(), tuning_to_json(tuning));
    memory.tuning_message =
        error ? error->message() : std::string("saved to ") + memory.tuning_file.data();
}

void load_tuning(Tuning& tuning, InspectorMemory& memory) {
    const std::string file = memory.tuning_file.data();
    const Result<std::string> text = read_file(file);
    const Result<Tuning> read = text ? parse_tuning(text.value(), file) : text.error();
    if (read) {
        tuning = read.value();
    }
    memory.tuning_message = read ? "loaded " + file : read.error().message();
}

}  // namespace

void show_tuning_page(const InspectorView& view) {
    InspectorMemory& memory = view.memory;
    Tuning& tuning = view.session.scene().tuning();
    ImGui::SetNextItemWidth(12.0F * ImGui::GetFontSize());
    ImGui::InputText("##file", memory.tuning_file.data(), memory.tuning_file.size());
    ImGui::SameLine();
    if (ImGui::Button("Save")) {
        save_tuning(tuning, memory);
    }
    ImGui::SameLine();
    if (ImGui::Button("Load")) {
        load_tuning(tuning, memory);
    }
    ImGui::SameLine();
    if (ImGui::Button("Defaults")) {
        tuning = Tuning{};
        memory.tuning_message = "all values are at their defaults";
    }
    ImGui::PushTextWrapPos(0.0F);
    ImGui::TextColored(k_soft, "%s",
                       memory.tuning_message.empty()
                           ? "Drag a number, or double-click to type it. Changes apply from the "
                             "next frame on; head.radius_m applies only in a scene file."
                           : memory.tuning_message.c_str());
    ImGui::PopTextWrapPos();
    ImGui::BeginChild("numbers");
    Tuning wanted = tuning;
    if (show_numbers(wanted)) {
        // Applies the checks of tuning files: a rejected value is not used.
        const Result<Tuning> checked = parse_tuning(tuning_to_json(wanted), "tuning");
        if (checked) {
            tuning = wanted;
        }
        memory.tuning_message = checked ? "" : checked.error().message();
    }
    ImGui::EndChild();
}

}  // namespace handhold
