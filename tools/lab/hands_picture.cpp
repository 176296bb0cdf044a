#include "tools/lab/hands_picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>

#include "engine/io/gltf.hpp"
#include "game/mesh/level_meshes.hpp"
#include "game/mesh/primitives.hpp"
#include "game/play/progress.hpp"
#include "game/render/hand_figures.hpp"
#include "game/render/renderer.hpp"
#include "tools/lab/exit_status.hpp"
#include "tools/lab/posed_hands.hpp"

namespace handhold::lab {
namespace {

constexpr double k_fov_rad = 0.55;

Color color_of(const HandCapsule& capsule) {
    static const std::map<std::string, Color> colors = {
        {"thumb", {0.80F, 0.16F, 0.06F}},  {"index", {0.85F, 0.45F, 0.04F}},
        {"middle", {0.42F, 0.55F, 0.05F}}, {"ring", {0.03F, 0.40F, 0.45F}},
        {"little", {0.28F, 0.16F, 0.60F}}, {"palm", {0.55F, 0.50F, 0.44F}}};
    Color color = colors.at(capsule.finger);
    for (float& part : color) {
        part *= capsule.link % 2 == 0 ? 1.0F : 0.72F;  // distinguishes neighbouring links
    }
    return color;
}

std::vector<DrawnHand> choose_hands(std::vector<DrawnHand> all,
                                    const HandsPictureOptions& options) {
    std::vector<DrawnHand> chosen;
    if (!options.ids.empty()) {
        for (const std::int64_t id : options.ids) {
            const auto found = std::find_if(all.begin(), all.end(),
                                            [&](const DrawnHand& hand) { return hand.id == id; });
            if (found != all.end()) {
                chosen.push_back(*found);
            }
        }
        return chosen;
    }
    const std::size_t count = std::min(all.size(), static_cast<std::size_t>(options.count));
    for (std::size_t i = 0; i < count; ++i) {
        chosen.push_back(std::move(all[i * all.size() / count]));
    }
    return chosen;
}

// The frame for a close view of a mesh: lit from above the viewer's left shoulder, with bright
// surroundings.
RenderFrame make_frame(const HandView& view, double distance_m) {
    RenderFrame frame;
    const Vec3 up = std::abs(view.towards.y()) < 0.97 ? Vec3(Vec3::UnitY()) : Vec3(-Vec3::UnitZ());
    const Pose eye = look_along(view.center + distance_m * view.towards, -view.towards, up);
    frame.camera.pose_ws = eye;
    frame.camera.vertical_fov_rad = k_fov_rad;
    frame.camera.near_m = 0.02;
    frame.key.towards_ws = eye.rotation * Vec3(-0.6, 0.9, 0.8);
    frame.key.color = {0.85F, 0.82F, 0.78F};
    frame.key.caster_reach_m = 0.3;
    frame.key.shadow_radius_m = 0.35;
    frame.up_ws = eye.rotation * Vec3::UnitY();
    frame.sky_ambient = {0.42F, 0.43F, 0.45F};
    frame.ground_ambient = {0.26F, 0.25F, 0.24F};
    frame.head_light = 0.10F;
    frame.haze_per_m = 0.0F;
    frame.background = {0.30F, 0.33F, 0.37F};
    return frame;
}

// The meshes of one file, and their instances.
struct Studio {
    std::vector<Mesh> meshes;
    std::vector<Instance> instances;
};

Studio build_stage(GltfLevel level, Renderer& renderer) {
    Studio stage;
    for (const LevelMesh& part : make_level_meshes(level)) {
        stage.instances.push_back({renderer.add_mesh(part.mesh), {}, std::nullopt, part.look});
    }
    for (LevelPart& part : level.parts) {
        stage.meshes.push_back(std::move(part.mesh));
    }
    return stage;
}

void add_capsules(const DrawnHand& hand, Renderer& renderer, RenderFrame& frame) {
    for (const HandCapsule& capsule : hand.capsules) {
        const Vec3 axis = capsule.b_m - capsule.a_m;
        // If both ends coincide, the capsule is practically a sphere.
        const Vec3 b = axis.norm() > 1e-6 ? axis : Vec3(1e-6 * Vec3::UnitX());
        Mesh mesh = make_capsule(Vec3::Zero(), b, capsule.radius_m, 24);
        mesh.color = color_of(capsule);
        frame.instances.push_back(
            {renderer.add_mesh(mesh), {capsule.a_m, Quat::Identity()}, std::nullopt, {}});
    }
}

// Draws one hand at a time on the stage.
class Artist {
  public:
    Artist(const Studio& stage, const HandsPictureOptions& options, Renderer& renderer)
        : stage_(stage), options_(options), renderer_(renderer) {
        if (options.style == "skin") {
            figures_.emplace(builtin_hand_models(), renderer);
        }
    }

    // Draws the hand from its best viewpoint; if `other` is given, from clearly another side.
    // Returns the view.
    HandView draw(const DrawnHand& hand, const HandView* other, Image& picture) {
        const HandView bounds = hand_bounds(hand.capsules);
        const double distance_m = 1.02 * bounds.radius_m / std::sin(0.5 * k_fov_rad);
        HandView view = choose_hand_view(hand.capsules, hand.wrist.rotation,
                                         triangles_near(stage_.meshes, bounds.center, distance_m),
                                         distance_m, other);
        RenderFrame frame = make_frame(view, distance_m);
        frame.instances = stage_.instances;
        if (figures_) {
            add_figure(hand, frame);
        } else {
            add_capsules(hand, renderer_, frame);
        }
        renderer_.draw(frame, picture);
        return view;
    }

  private:
    void add_figure(const DrawnHand& hand, RenderFrame& frame) {
        const HandSide side = options_.hand == "left" ? HandSide::left : HandSide::right;
        const HandRig& rig = figures_->rig(side);
        std::array<FingerAngles, k_finger_count> fingers;
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            fingers[f] = hand.angles[static_cast<std::size_t>(rig.fingers[f].name)];
        }
        figures_->begin();
        figures_->add(side, hand.wrist, fingers, renderer_, frame);
    }

    const Studio& stage_;
    const HandsPictureOptions& options_;
    Renderer& renderer_;
    std::optional<HandFigures> figures_;
};

void copy_into(const Image& picture, int column, int row, Image& sheet) {
    for (int y = 0; y < picture.height_px; ++y) {
        const auto from = picture.rgba.begin() + std::ptrdiff_t{4} * y * picture.width_px;
        const std::ptrdiff_t to =
            std::ptrdiff_t{4} *
            ((row * picture.height_px + y) * sheet.width_px + column * picture.width_px);
        std::copy(from, from + std::ptrdiff_t{4} * picture.width_px, sheet.rgba.begin() + to);
    }
}

}  // namespace

int hands_picture_command(const HandsPictureOptions& options) {
    Result<std::vector<DrawnHand>> loaded = load_posed_hands(options.hands);
    if (!loaded) {
        return refuse(loaded.error());
    }
    const std::vector<DrawnHand> hands = choose_hands(std::move(loaded.value()), options);
    if (hands.empty()) {
        return refuse({options.hands.string(), "", "expected at least one of the requested hands"});
    }
    Result<GltfLevel> level = load_gltf_level(options.mesh);
    if (!level) {
        return refuse(level.error());
    }
    const auto open = [&](std::string& why_not) {
        return Renderer::create(options.width_px, options.height_px, why_not, PictureQuality::fine);
    };
    std::string why_not;
    std::optional<Renderer> renderer = open(why_not);
    if (!renderer) {
        return refuse({options.out.string(), "", "expected a machine that can draw: " + why_not});
    }
    const Studio stage = build_stage(std::move(level.value()), *renderer);
    const int views = options.views;
    const int columns = std::min(options.columns, static_cast<int>(hands.size()));
    const int rows = (static_cast<int>(hands.size()) + columns - 1) / columns;
    Image sheet{columns * views * options.width_px, rows * options.height_px, {}};
    sheet.rgba.assign(std::size_t{4} * static_cast<std::size_t>(sheet.width_px) *
                          static_cast<std::size_t>(sheet.height_px),
                      255);
    Artist artist(stage, options, *renderer);
    Progress progress("pictures");
    Image picture;
    for (std::size_t i = 0; i < hands.size(); ++i) {
        const int place = static_cast<int>(i);
        HandView last;
        for (int view = 0; view < views; ++view) {
            last = artist.draw(hands[i], view > 0 ? &last : nullptr, picture);
            copy_into(picture, place % columns * views + view, place / columns, sheet);
        }
        std::printf("%lld%c", static_cast<long long>(hands[i].id),
                    (place + 1) % columns == 0 || i + 1 == hands.size() ? '\n' : ' ');
        progress.show(static_cast<double>(i + 1) / static_cast<double>(hands.size()));
    }
    const auto error = save_png(sheet, options.out.string());
    return error ? refuse(*error) : 0;
}

}  // namespace handhold::lab
