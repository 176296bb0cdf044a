#include "game/render/body_figures.hpp"

#include <array>
#include <map>
#include <optional>
#include <utility>

#include "engine/core/check.hpp"
#include "engine/core/text_file.hpp"
#include "engine/io/vrm_humanoid.hpp"
#include "game/render/figure_kit.hpp"
#include "game/render/robot_body.hpp"
#include "systems/rigs/arm_twist.hpp"

namespace handhold {
namespace {

enum class Region { body, head, hand };

// The region of a vertex. Parts above the shoulders count as head, because they would block the
// view from the eyes.
Region region_of(const BodyRig& rig, const Vec3& position_ms, const SkinWeights& weights) {
    switch (rig.carriers[rig.joints[heaviest_joint(weights)].carrier].bone) {
        case BodyBone::head:
        case BodyBone::neck:
            return Region::head;
        case BodyBone::hand:
        case BodyBone::finger:
            return Region::hand;
        case BodyBone::trunk: {
            const Pose& shoulders_ms = rig.carriers[BodyRig::k_chest].rest_ms;
            const double above = inverse_transform_point(shoulders_ms, position_ms).y();
            return above > 0.0 ? Region::head : Region::body;
        }
        default:
            return Region::body;
    }
}

// Rebinds skin that is bound to a hand to the same side's forearm joint nearest the wrist. The
// figure's hands are not drawn, so the visible skin at the wrists must not bend with them.
void bind_wrists_to_forearms(const BodyRig& rig, SkinnedMesh& figure) {
    std::array<std::optional<std::uint16_t>, k_hand_count> ends;
    const auto carrier_of = [&rig](std::size_t joint) -> const BodyRig::Carrier& {
        return rig.carriers[rig.joints[joint].carrier];
    };
    for (std::size_t joint = 0; joint < rig.joints.size(); ++joint) {
        const BodyRig::Carrier& carrier = carrier_of(joint);
        if (carrier.bone != BodyBone::forearm) {
            continue;
        }
        std::optional<std::uint16_t>& end = ends[index_of(carrier.side)];
        if (!end || carrier.along > carrier_of(*end).along) {
            end = static_cast<std::uint16_t>(joint);
        }
    }
    for (SkinWeights& weights : figure.weights) {
        for (std::size_t i = 0; i < weights.joint.size(); ++i) {
            const BodyRig::Carrier& carrier = carrier_of(weights.joint[i]);
            if (carrier.bone == BodyBone::hand && ends[index_of(carrier.side)]) {
                weights.joint[i] = *ends[index_of(carrier.side)];
            }
        }
    }
}

// Merges the user's map with a VRM figure's table; the user's entries win.
Result<BodyMap> read_body_map(std::string_view figure, const std::string& figure_file,
                              const std::string& map_file) {
    BodyMap map;
    if (!map_file.empty()) {
        Result<BodyMap> loaded = load_body_map(map_file);
        if (!loaded) {
            return loaded.error();
        }
        map = std::move(loaded.value());
    }
    const auto humanoid = parse_vrm_humanoid(figure, figure_file);
    if (!humanoid) {
        return humanoid.error();
    }
    map.merge(body_map_of_vrm(humanoid.value()));
    return map;
}

}  // namespace

BodyModel builtin_body_model() {
    BodyModel model;
    model.figure = make_robot_body();
    Result<BodyRig> rig = fit_body_rig(model.figure);
    HH_CHECK(rig.ok(), "the robot has a body's joints", rig.ok());
    model.rig = std::move(rig.value());
    spread_arm_twist(model.figure, model.rig);
    return model;
}

Result<BodyModel> choose_body_model(const std::string& figure_file, const std::string& map_file) {
    if (figure_file.empty()) {
        return builtin_body_model();
    }
    const Result<std::string> bytes = read_file(figure_file);
    if (!bytes) {
        return bytes.error();
    }
    Result<SkinnedMesh> figure = parse_gltf_figure(bytes.value(), figure_file);
    if (!figure) {
        return figure.error();
    }
    const Result<BodyMap> map = read_body_map(bytes.value(), figure_file, map_file);
    if (!map) {
        return map.error();
    }
    Result<BodyRig> rig = fit_body_rig(figure.value(), map.value());
    if (!rig) {
        FileError error = rig.error();
        error.expected += " (--body-map)";
        return error;
    }
    BodyModel model{std::move(figure.value()), std::move(rig.value())};
    spread_arm_twist(model.figure, model.rig);
    return model;
}

BodyFigures::BodyFigures(BodyModel model, Renderer& renderer) : model_(std::move(model)) {
    cut_pieces();
    copies_.push_back(make_copy(renderer));
}

bool BodyFigures::has_hands() const {
    return model_.rig.finger_count(HandSide::left) > 1 &&
           model_.rig.finger_count(HandSide::right) > 1;
}

// Splits the figure into pieces: each triangle belongs to the region of most of its corners. The
// triangles of hands without fingers are left out.
void BodyFigures::cut_pieces() {
    const SkinnedMesh& figure = model_.figure;
    std::vector<Region> regions;
    for (std::size_t i = 0; i < figure.positions.size(); ++i) {
        regions.push_back(region_of(model_.rig, figure.positions[i], figure.weights[i]));
    }
    if (!has_hands()) {
        bind_wrists_to_forearms(model_.rig, model_.figure);
    }
    for (std::size_t run = 0; run < figure.color_runs.size(); ++run) {
        const ColorRun& color = figure.color_runs[run];
        const std::size_t to = run + 1 < figure.color_runs.size()
                                   ? figure.color_runs[run + 1].first_triangle
                                   : figure.triangles.size();
        std::array<Piece, 3> parts;  // indexed by Region
        std::array<std::map<std::uint32_t, std::uint32_t>, 3> places;
        for (std::size_t i = color.first_triangle; i < to; ++i) {
            const auto& corners = figure.triangles[i];
            const Region second = regions[corners[1]];
            const Region region = second == regions[corners[2]] ? second : regions[corners[0]];
            if (region == Region::hand && !has_hands()) {
                continue;
            }
            const auto part = static_cast<std::size_t>(region);
            std::array<std::uint32_t, 3> triangle{};
            for (std::size_t corner = 0; corner < 3; ++corner) {
                const auto [place, is_new] = places[part].try_emplace(
                    corners[corner], static_cast<std::uint32_t>(parts[part].vertices.size()));
                if (is_new) {
                    parts[part].vertices.push_back(corners[corner]);
                }
                triangle[corner] = place->second;
            }
            parts[part].triangles.push_back(triangle);
        }
        for (std::size_t part = 0; part < parts.size(); ++part) {
            if (parts[part].triangles.empty()) {
                continue;
            }
            parts[part].color = color.color;
            parts[part].look.gloss = color.gloss;
            parts[part].look.emissive = color.emissive;
            parts[part].is_head = part == static_cast<std::size_t>(Region::head);
            pieces_.push_back(std::move(parts[part]));
        }
    }
}

BodyFigures::Copy BodyFigures::make_copy(Renderer& renderer) const {
    Copy copy;
    for (const Piece& piece : pieces_) {
        copy.push_back(renderer.add_moving_mesh(piece.triangles, piece.color));
    }
    return copy;
}

void BodyFigures::begin() { used_ = 0; }

void BodyFigures::add(const BodyMeasures& measures, const RenderPose& render,
                      const std::array<PosedHandJoints, k_hand_count>& hands, Seen seen,
                      Renderer& renderer, RenderFrame& frame) {
    if (used_ == copies_.size()) {
        copies_.push_back(make_copy(renderer));
    }
    const SkinnedMesh& figure = model_.figure;
    pose_skeleton(model_.rig, measures, render, hands, pose_);
    // Vertices are relative to the head, to keep float precision far from the origin.
    const Pose origin_ws{render.head_ws.position, Quat::Identity()};
    for (Affine& carry : pose_.carry_ws) {
        carry.translation -= origin_ws.position;
    }
    skin_vertices({figure.positions, figure.normals, figure.weights, pose_.carry_ws}, positions_,
                  normals_);
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
        const Piece& piece = pieces_[i];
        if (piece.is_head && seen == Seen::by_himself) {
            continue;
        }
        piece_positions_.clear();
        piece_normals_.clear();
        for (const std::uint32_t vertex : piece.vertices) {
            piece_positions_.push_back(positions_[vertex]);
            piece_normals_.push_back(normals_[vertex]);
        }
        renderer.move_mesh(copies_[used_][i], piece_positions_, piece_normals_);
        const bool is_shell = piece.color == figure_color(FigureMaterial::shell);
        frame.instances.push_back(
            {copies_[used_][i], origin_ws, is_shell ? shell_ : std::nullopt, piece.look});
    }
    ++used_;
}

}  // namespace handhold
