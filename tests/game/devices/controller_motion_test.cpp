// What moves on controllers, against closed forms and against the ends that real models name.
#include "game/devices/controller_motion.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "game/view/controller_figures.hpp"
#include "systems/host/host_columns.hpp"
#include "tests/places.hpp"

namespace handhold::controller_motion_test {
namespace {

constexpr double k_near = 1e-12;

ControlValues with(Control control, double value) {
    ControlValues values = k_controls_at_rest;
    values[static_cast<std::size_t>(control)] = value;
    return values;
}

void expect_same(const Pose& a, const Pose& b, double tolerance = k_near) {
    EXPECT_LT((a.position - b.position).norm(), tolerance);
    EXPECT_LT(rotation_to_vector((a.rotation.conjugate() * b.rotation).normalized()).norm(),
              tolerance);
}

// A stick: its value node for x carries that for y, which carries the mesh.
class NestedStick : public testing::Test {
  protected:
    static Pose local(const Vec3& position, const Vec3& axis, double angle_rad) {
        return {position, rotation_about(axis, angle_rad)};
    }
    // The mesh's frame with the stick's nodes at these places between their ends.
    Pose mesh_at(double x, double y) const {
        return root_ * interpolate(left_, right_, x) * interpolate(ahead_, back_, y) * mesh_;
    }
    std::vector<ModelNode> nodes() const {
        const Pose x = root_ * interpolate(left_, right_, 0.5);
        const Pose y = x * interpolate(ahead_, back_, 0.5);
        const auto node = [](const char* name, const Pose& at, const char* pointer,
                             std::optional<std::size_t> parent) {
            return ModelNode{name, pointer, parent, to_host(at)};
        };
        return {node("root", root_, "/nodes/0", {}),
                node("x_value", x, "/nodes/1", 0),
                node("x_min", root_ * left_, "/nodes/2", 0),
                node("x_max", root_ * right_, "/nodes/3", 0),
                node("y_value", y, "/nodes/4", 1),
                node("y_min", x * ahead_, "/nodes/5", 1),
                node("y_max", x * back_, "/nodes/6", 1),
                node("stick", y * mesh_, "/nodes/7", 4)};
    }
    const std::vector<ControlledNode> controls_ = {{Control::stick_y, "y_value", "y_min", "y_max"},
                                                   {Control::stick_x, "x_value", "x_min", "x_max"}};
    const Pose root_ = local(Vec3(0.01, 0.02, -0.03), Vec3::UnitX(), 0.7);
    const Pose left_ = local(Vec3(0.0, 0.003, 0.0), Vec3::UnitZ(), 0.25);
    const Pose right_ = local(Vec3(0.001, 0.003, 0.0), Vec3::UnitZ(), -0.3);
    const Pose ahead_ = local(Vec3(0.0, 0.0, 0.002), Vec3::UnitX(), -0.2);
    const Pose back_ = local(Vec3::Zero(), Vec3::UnitX(), 0.3);
    const Pose mesh_ = local(Vec3(0.0, 0.01, 0.0), Vec3::UnitY(), 1.1);
};

TEST_F(NestedStick, StandsWhereTheNodesPutItsMesh) {
    const std::vector<ControlMove> moves = moves_of("/nodes/7", nodes(), controls_);
    ASSERT_EQ(moves.size(), 2U);
    for (const double x : {0.0, 0.5, 0.8, 1.0}) {
        for (const double y : {0.0, 0.3, 1.0}) {
            ControlValues values = with(Control::stick_x, x);
            values[static_cast<std::size_t>(Control::stick_y)] = y;
            expect_same(from_host(moved_by(moves, values)) * mesh_at(0.5, 0.5), mesh_at(x, y));
        }
    }
}

TEST_F(NestedStick, OthersControlsAndThoseBeyondTheirEndsMoveNothingMore) {
    const std::vector<ControlMove> moves = moves_of("/nodes/7", nodes(), controls_);
    expect_same(from_host(moved_by(moves, with(Control::trigger, 1.0))), {});
    expect_same(from_host(moved_by(moves, with(Control::stick_x, 7.0))),
                from_host(moved_by(moves, with(Control::stick_x, 1.0))));
    EXPECT_TRUE(moves_of("/nodes/2", nodes(), controls_).empty());
}

TEST_F(NestedStick, WhatTheModelDoesNotHaveMovesNothing) {
    EXPECT_TRUE(moves_of("/nodes/99", nodes(), controls_).empty());
    EXPECT_TRUE(moves_of("/nodes/7", nodes(), {}).empty());
    std::vector<ControlledNode> misnamed = controls_;
    misnamed[1].to = "nowhere";
    EXPECT_EQ(moves_of("/nodes/7", nodes(), misnamed).size(), 1U);
    std::vector<ModelNode> elsewhere = nodes();
    elsewhere[3].parent = 1;  // an end that does not lie beside
    EXPECT_EQ(moves_of("/nodes/7", elsewhere, controls_).size(), 1U);
    std::vector<ModelNode> squashed = nodes();
    squashed[4].pose_ms.reset();
    EXPECT_EQ(moves_of("/nodes/7", squashed, controls_).size(), 1U);
}

TEST(ControlValues, AreWebXrs) {
    HandReading hand;
    EXPECT_EQ(control_values(hand), k_controls_at_rest);
    hand.trigger = 0.25;
    hand.stick = {-1.0, 1.0};  // left and forward; its corner lies on the circle
    hand.brake = true;
    const ControlValues values = control_values(hand);
    const auto at = [&](Control control) { return values[static_cast<std::size_t>(control)]; };
    EXPECT_EQ(at(Control::trigger), 0.25);
    EXPECT_EQ(at(Control::squeeze), 0.0);
    EXPECT_NEAR(at(Control::stick_x), 0.5 - 0.5 * std::sqrt(0.5), k_near);
    EXPECT_NEAR(at(Control::stick_y), 0.5 - 0.5 * std::sqrt(0.5), k_near);
    EXPECT_EQ(at(Control::lower_button), 1.0);
    EXPECT_EQ(at(Control::upper_button), 0.0);
    EXPECT_EQ(closing_values(false), k_controls_at_rest);
}

// How far a mesh's vertices go from where they are at rest.
double farthest_m(const ControllerModel& model, std::size_t mesh, const ControlValues& values) {
    const Pose moved = from_host(moved_by(model.moves[mesh], values));
    double most_m = 0.0;
    for (const Vec3& point : model.meshes[mesh].mesh.positions) {
        most_m = std::max(most_m, (transform_point(moved, point) - point).norm());
    }
    return most_m;
}
double farthest_m(const ControllerModel& model, Control control, double value) {
    double most_m = 0.0;
    for (std::size_t i = 0; i < model.meshes.size(); ++i) {
        most_m = std::max(most_m, farthest_m(model, i, with(control, value)));
    }
    return most_m;
}

TEST(Wand, TriggerSqueezeAndPadMoveAndItsBodyDoesNot) {
    for (const ControllerModel& model : builtin_controllers(hand_shape(hh::World())).sides) {
        ASSERT_EQ(model.moves.size(), model.meshes.size());
        for (const Control control :
             {Control::trigger, Control::squeeze, Control::stick_x, Control::stick_y}) {
            EXPECT_GT(farthest_m(model, control, 1.0), 0.002);
            EXPECT_LT(farthest_m(model, control, 1.0), 0.012);
        }
        for (std::size_t i = 0; i < model.meshes.size(); ++i) {
            EXPECT_LT(farthest_m(model, i, k_controls_at_rest), k_near);
            EXPECT_EQ(model.moves[i].empty(), model.meshes[i].mesh.name.starts_with("wand/"));
        }
    }
}

// The profiles in the data are of controllers with a trigger, a squeeze and a stick or a pad.
TEST(RealControllers, EachControlMovesASmallPartOfItAndNothingElse) {
    const std::filesystem::path folder = data_dir() / "controllers";
    if (!std::filesystem::exists(folder)) {
        GTEST_SKIP() << "no data";
    }
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (!entry.is_directory()) {
            continue;
        }
        SCOPED_TRACE(entry.path().filename().string());
        const auto models = choose_controllers((entry.path() / "profile.json").string());
        ASSERT_TRUE(models.ok()) << models.error().message();
        for (const ControllerModel& model : models.value().sides) {
            for (const Control control :
                 {Control::trigger, Control::squeeze, Control::lower_button}) {
                EXPECT_GT(farthest_m(model, control, 1.0), 0.0002);
                EXPECT_LT(farthest_m(model, control, 1.0), 0.025);
            }
            std::size_t still = 0;
            for (std::size_t i = 0; i < model.meshes.size(); ++i) {
                EXPECT_LT(farthest_m(model, i, k_controls_at_rest), 0.0005);
                still += model.moves[i].empty() ? 1U : 0U;
            }
            EXPECT_GE(still, 1U);
            EXPECT_LE(still, model.meshes.size() - 3);
        }
    }
}

// Node by node with another reader of the file: its trigger turns from (-0.3638, -0.0027, -0.0054,
// 0.9314) to (-0.4868, -0.0034, -0.005, 0.8735), by 2 acos of the product.
TEST(RealControllers, TouchTriggerTurnsAsItsFileSays) {
    const std::filesystem::path file = data_dir() / "controllers/oculus-touch-v3/profile.json";
    if (!std::filesystem::exists(file)) {
        GTEST_SKIP() << "no data";
    }
    const auto models = choose_controllers(file.string());
    ASSERT_TRUE(models.ok());
    const ControllerModel& left = models.value().sides[0];
    const double dot = 0.3638 * 0.4868 + 0.0027 * 0.0034 + 0.0054 * 0.005 + 0.9314 * 0.8735;
    const double expected_rad = 2.0 * std::acos(dot);
    double most_rad = 0.0;
    for (const auto& moves : left.moves) {
        most_rad = std::max(
            most_rad,
            rotation_to_vector(from_host(moved_by(moves, with(Control::trigger, 1.0))).rotation)
                .norm());
    }
    EXPECT_NEAR(most_rad, expected_rad, 0.002);
}

}  // namespace
}  // namespace handhold::controller_motion_test
