#include <algorithm>
#include <array>
#include <cstdio>
#include <span>
#include <string>
#include <type_traits>

#include <imgui.h>

#include "components/fields.hpp"
#include "game/ui/inspector.hpp"
#include "game/view/explain_hand.hpp"

namespace handhold {
namespace {

const ImVec4 k_key_color(0.55F, 0.85F, 1.0F, 1.0F);
const ImVec4 k_soft(0.62F, 0.66F, 0.70F, 1.0F);
constexpr std::size_t k_max_listed = 8;  // elements shown of an array

// Shows every field of a component; structs and arrays as trees.
class FieldShower {
  public:
    explicit FieldShower(const Scene& scene) : scene_(scene) {}

    void operator()(const char* name, const auto& field) const { show(name, field); }

  private:
    static void begin(const char* name) {
        ImGui::TextColored(k_soft, "%s", name);
        ImGui::SameLine(12.0F * ImGui::GetFontSize());
    }
    static void show(const char* name, double value) {
        begin(name);
        ImGui::Text("%.6g", value);
    }
    static void show(const char* name, std::uint64_t id) {
        begin(name);
        ImGui::Text("0x%016llx", static_cast<unsigned long long>(id));
    }
    static void show(const char* name, bool value) {
        begin(name);
        ImGui::TextUnformatted(value ? "yes" : "no");
    }
    static void show(const char* name, const Vec3& v) {
        begin(name);
        ImGui::Text("%.4f  %.4f  %.4f", v.x(), v.y(), v.z());
    }
    static void show(const char* name, const Quat& q) {
        begin(name);
        ImGui::Text("%.4f  %.4f  %.4f  %.4f", q.x(), q.y(), q.z(), q.w());
    }
    static void show(const char* name, const Pose& pose) {
        show(name, pose.position);
        show("", pose.rotation);
    }
    void show(const char* name, Entity entity) const {
        begin(name);
        ImGui::TextUnformatted(is_null(entity) ? "none" : name_of_entity(scene_, entity).c_str());
    }
    static void show(const char* name, ShapeId shape) {
        begin(name);
        ImGui::Text("shape %u", shape.index);
    }
    template <typename T, std::size_t N>
    void show(const char* name, const std::array<T, N>& values) const {
        show(name, std::span<const T>(values));
    }
    template <typename T>
    void show(const char* name, std::span<const T> values) const {
        for (std::size_t i = 0; i < std::min(values.size(), k_max_listed); ++i) {
            show((std::string(name) + "[" + std::to_string(i) + "]").c_str(), values[i]);
        }
        if (values.size() > k_max_listed) {
            begin(name);
            ImGui::TextColored(k_soft, "and %zu more", values.size() - k_max_listed);
        }
    }
    template <typename T>
    void show(const char* name, const T& value) const {
        if constexpr (std::is_integral_v<T> || std::is_enum_v<T>) {
            begin(name);
            ImGui::Text("%lld", static_cast<long long>(value));
        } else if (ImGui::TreeNode(name)) {
            visit_fields(value, *this);
            ImGui::TreePop();
        }
    }

    const Scene& scene_;
};

std::string kind_of(const World& world, Entity entity) {
    const RigidBody* const body = world.body.find(entity);
    if (body != nullptr) {
        return body->kind == BodyKind::free    ? "free body"
               : body->kind == BodyKind::fixed ? "fixed body"
                                               : "kinematic body";
    }
    return world.player.contains(entity)       ? "player"
           : world.hand_owner.contains(entity) ? "hand"
           : world.joint.contains(entity)      ? "joint"
                                               : "entity";
}

void show_list(const Scene& scene, InspectorMemory& memory) {
    const std::string wanted = memory.filter.data();
    ImGui::BeginChild("list", ImVec2(0.0F, 0.38F * ImGui::GetContentRegionAvail().y), true);
    for (const Entity entity : scene.world().persistent_id.owners()) {
        const std::string name =
            name_of_entity(scene, entity) + "  (" + kind_of(scene.world(), entity) + ")";
        if (name.find(wanted) == std::string::npos) {
            continue;
        }
        ImGui::PushID(static_cast<int>(entity.slot));
        if (ImGui::Selectable(name.c_str(), memory.selected == entity)) {
            memory.selected = entity;
        }
        ImGui::PopID();
    }
    ImGui::EndChild();
}

}  // namespace

void show_entities_page(const InspectorView& view) {
    const Scene& scene = view.session.scene();
    InspectorMemory& memory = view.memory;
    if (!scene.world().entities.is_alive(memory.selected)) {
        memory.selected = entity_of(view.session.player());
    }
    ImGui::SetNextItemWidth(14.0F * ImGui::GetFontSize());
    ImGui::InputText("find", memory.filter.data(), memory.filter.size());
    ImGui::SameLine();
    ImGui::TextColored(k_soft, "%zu entities", scene.world().persistent_id.size());
    show_list(scene, memory);
    ImGui::TextColored(k_key_color, "%s", name_of_entity(scene, memory.selected).c_str());
    ImGui::BeginChild("components");
    visit_columns(scene.world(), [&](const char* name, const auto& column) {
        const auto* const component = column.find(memory.selected);
        if (component != nullptr && ImGui::CollapsingHeader(name, ImGuiTreeNodeFlags_DefaultOpen)) {
            ImGui::PushID(name);
            visit_fields(*component, FieldShower(scene));
            ImGui::PopID();
        }
    });
    ImGui::EndChild();
}

}  // namespace handhold
