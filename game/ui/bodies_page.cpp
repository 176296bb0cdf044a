#include <imgui.h>

#include "game/ui/inspector.hpp"
#include "game/view/explain_hand.hpp"
#include "game/view/explain_size.hpp"

namespace handhold {

void show_bodies_page(const InspectorView& view) {
    const Scene& scene = view.session.scene();
    for (const Entity player : scene.world().player.owners()) {
        const SizeStory story = explain_size(scene.world(), player);
        const bool is_own = player == entity_of(view.session.player());
        ImGui::TextColored(ImVec4(0.55F, 0.85F, 1.0F, 1.0F), "%s%s",
                           name_of_entity(scene, player).c_str(), is_own ? " (you)" : "");
        ImGui::Text("eye height %.2f m, arms %.2f m, shoulders %.2f m apart", story.eye_height_m,
                    story.arm_m, story.shoulder_width_m);
        ImGui::PushTextWrapPos(0.0F);
        ImGui::TextColored(ImVec4(0.62F, 0.66F, 0.70F, 1.0F), "%s", story.reason.c_str());
        ImGui::PopTextWrapPos();
        ImGui::Spacing();
    }
}

}  // namespace handhold
