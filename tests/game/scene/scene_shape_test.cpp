#include "game/scene/scene_shape.hpp"

#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/geometry/mass_properties.hpp"
#include "game/scene/scene.hpp"
#include "game/scene/scene_file.hpp"
#include "tests/places.hpp"

namespace handhold::scene_shape_test {
namespace {

using Json = nlohmann::json;

Json cube_points(double half) {
    Json points = Json::array();
    for (unsigned i = 0; i < 8; ++i) {
        points.push_back({(i & 1U) != 0 ? half : -half, (i & 2U) != 0 ? half : -half,
                          (i & 4U) != 0 ? half : -half});
    }
    return points;
}

Json scene_with(const Json& shape, const char* kind = "static") {
    Json body = {{"name", "thing"}, {"kind", kind}, {"shape", shape}};
    if (std::string(kind) == "free") {
        body["mass_kg"] = 2.0;
    }
    return {{"name", "shapes"}, {"bodies", {body}}};
}

Result<SceneFile> parse(const Json& scene) { return parse_scene_file(scene.dump(), "a.json"); }

Json cylinder() { return {{"type", "cylinder"}, {"radius_m", 0.2}, {"half_height_m", 0.3}}; }
Json hull() { return {{"type", "hull"}, {"points_m", cube_points(0.5)}}; }
Json compound() {
    return {{"type", "compound"},
            {"children",
             {{{"shape", cylinder()}, {"position_m", {1, 0, 0}}},
              {{"shape", hull()}, {"rotation_xyzw", {0, 0, 1, 0}}}}}};
}

TEST(SceneShape, KindsReadAsWritten) {
    const Result<SceneFile> file = parse(scene_with(compound()));
    ASSERT_TRUE(file.ok()) << file.error().message();
    const SceneShape& shape = file.value().bodies[0].shape;
    ASSERT_EQ(shape.parts.size(), 2U);
    EXPECT_EQ(shape.parts[0].shape.kind, ShapeKind::cylinder);
    EXPECT_EQ(shape.parts[0].shape.radius_m, 0.2);
    EXPECT_EQ(shape.parts[0].shape.half_height_m, 0.3);
    EXPECT_EQ(shape.parts[0].pose.position, Vec3::UnitX());
    EXPECT_EQ(shape.parts[1].shape.hull.corners.size(), 8U);
    EXPECT_EQ(shape.parts[1].shape.hull.faces.size(), 6U);
    EXPECT_EQ(shape.parts[1].pose.rotation.z(), 1.0);

    const Json mesh = {{"type", "mesh"}, {"file", "x.glb"}, {"scale", 2.5}};
    EXPECT_EQ(parse(scene_with(mesh)).value().bodies[0].shape.scale, Vec3::Constant(2.5));
    Json level = {{"name", "l"}, {"levels", {{{"file", "x.glb"}, {"scale", {1, 2, 3}}}}}};
    EXPECT_EQ(parse(level).value().levels[0].scale, Vec3(1.0, 2.0, 3.0));
}

struct BadShape {
    const char* what;
    const char* place;  // after /bodies/0/shape
    Json shape;
};
std::ostream& operator<<(std::ostream& stream, const BadShape& shape) {
    return stream << shape.what;
}

class MalformedShape : public ::testing::TestWithParam<BadShape> {};

TEST_P(MalformedShape, IsRefusedAtItsPlace) {
    const Result<SceneFile> result = parse(scene_with(GetParam().shape));
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().place, std::string("/bodies/0/shape") + GetParam().place)
        << result.error().message();
}

Json with(Json shape, const char* pointer, const Json& value) {
    shape[Json::json_pointer(pointer)] = value;
    return shape;
}

const BadShape k_bad_shapes[] = {
    {"cylinder without height", "/half_height_m", {{"type", "cylinder"}, {"radius_m", 1}}},
    {"cylinder too thin", "/radius_m", with(cylinder(), "/radius_m", 1e-9)},
    {"cylinder of text", "/radius_m", with(cylinder(), "/radius_m", "wide")},
    {"cylinder with points", "/points_m", with(cylinder(), "/points_m", Json::array())},
    {"hull of nothing", "/file", {{"type", "hull"}}},
    {"hull of points and file", "/file", with(hull(), "/file", "x.glb")},
    {"hull of scaled points", "/scale", with(hull(), "/scale", 2)},
    {"hull of no points", "/points_m", with(hull(), "/points_m", Json::array())},
    {"hull of three points", "/points_m",
     with(hull(), "/points_m", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})},
    {"flat hull", "/points_m",
     with(hull(), "/points_m", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.3, 0.3, 0}})},
    {"hull too thin", "/points_m",
     with(hull(), "/points_m", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, 0.0009}})},
    {"hull too far", "/points_m/1/0", with(hull(), "/points_m/1/0", 1e5)},
    {"hull of numbers", "/points_m/0", with(hull(), "/points_m", {1, 2, 3, 4})},
    {"compound of nothing", "/children", with(compound(), "/children", Json::array())},
    {"compound of too many", "/children",
     with(compound(), "/children", Json(65, compound()["children"][0]))},
    {"compound in a compound", "/children/0/shape/type",
     with(compound(), "/children/0/shape", compound())},
    {"mesh in a compound", "/children/1/shape/type",
     with(compound(), "/children/1/shape", {{"type", "mesh"}, {"file", "x.glb"}})},
    {"child without shape", "/children/0/shape",
     with(compound(), "/children/0", {{"position_m", {0, 0, 0}}})},
    {"child too far", "/children/0/position_m/0",
     with(compound(), "/children/0/position_m", {2e4, 0, 0})},
    {"some masses", "/children/1/mass_kg", with(compound(), "/children/0/mass_kg", 1)},
    {"a mass too many", "/children/1/mass_kg", with(compound(), "/children/1/mass_kg", 1)},
    {"mass of nothing", "/children/0/mass_kg", with(compound(), "/children/0/mass_kg", 0)},
    {"scale 0", "/scale", {{"type", "mesh"}, {"file", "x.glb"}, {"scale", 0}}},
    {"mirrored", "/scale/0", {{"type", "mesh"}, {"file", "x.glb"}, {"scale", {-1, 1, 1}}}},
    {"two scales", "/scale", {{"type", "mesh"}, {"file", "x.glb"}, {"scale", {1, 1}}}},
    {"box with a scale", "/scale", {{"type", "box"}, {"half_m", {1, 1, 1}}, {"scale", 1}}},
};
INSTANTIATE_TEST_SUITE_P(Kinds, MalformedShape, ::testing::ValuesIn(k_bad_shapes));

// Scenes are built without a file; shapes from files are tested with the real data.
Result<Scene> build(const Json& scene) {
    const Result<SceneFile> file = parse(scene);
    return file.ok() ? build_scene(file.value(), "a.json") : Result<Scene>(file.error());
}

TEST(SceneShape, FreeCompoundMovesToItsCentreOfMassAndStaysWhereItIs) {
    // A 1 m cube at the origin and a cylinder of 0.2 x 0.2 x pi x 0.6 m^3 one metre along x.
    const Result<Scene> scene = build(scene_with(compound(), "free"));
    ASSERT_TRUE(scene.ok()) << scene.error().message();
    const double cylinder_m3 = 0.04 * 3.14159265358979 * 0.6;
    const Entity body = scene.value().world().body_pose.owners()[0];
    const Pose& pose = scene.value().world().body_pose.at(body).pose_ws;
    EXPECT_LT((pose.position - cylinder_m3 / (1.0 + cylinder_m3) * Vec3::UnitX()).norm(), 1e-12);
    // The visual's bounds in the world are those of the parts.
    const auto& visual = scene.value().visuals.front();
    Vec3 low = Vec3::Constant(1e9);
    Vec3 high = -low;
    for (const Vec3& position : visual.mesh->positions) {
        low = low.cwiseMin(transform_point(pose, position));
        high = high.cwiseMax(transform_point(pose, position));
    }
    EXPECT_LT((low - Vec3::Constant(-0.5)).norm(), 1e-9);
    EXPECT_LT((high - Vec3(1.2, 0.5, 0.5)).norm(), 1e-9);
    const Shape& shape = scene.value().shapes().at(scene.value().world().collider.at(body).shape);
    EXPECT_LT((scene.value().world().body.at(body).inertia_kgm2 - solid_inertia(shape, 2.0)).norm(),
              1e-12);
}

TEST(SceneShape, HullsAndScaledMeshesOfOneFileShareIt) {
    const std::string path = (data_dir() / "objects" / "teacup.glb").string();
    if (!std::filesystem::exists(path)) {
        GTEST_SKIP() << "no object data";
    }
    Json scene = scene_with({{"type", "mesh"}, {"file", path}});
    for (int i = 0; i < 3; ++i) {
        Json body = scene["bodies"][0];
        body["name"] = "copy " + std::to_string(i);
        body["shape"]["scale"] = {1.0, 1.5, 2.0 + i};
        scene["bodies"].push_back(body);
    }
    Json held = {{"name", "held"}, {"kind", "free"}, {"mass_kg", 0.3}};
    held["shape"] = {{"type", "hull"}, {"file", path}, {"scale", 2}};
    scene["bodies"].push_back(held);
    const Result<Scene> built = build(scene);
    ASSERT_TRUE(built.ok()) << built.error().message();
    const ShapeLibrary& shapes = built.value().shapes();
    const Mesh* mesh = nullptr;
    int meshes = 0;
    int hulls = 0;
    for (std::uint32_t i = 0; i < shapes.size(); ++i) {
        const Shape& shape = shapes.at({i});
        if (shape.kind == ShapeKind::mesh) {
            ++meshes;
            EXPECT_TRUE(mesh == nullptr || mesh == shape.mesh.get());
            mesh = shape.mesh.get();
        }
        hulls += shape.kind == ShapeKind::hull ? 1 : 0;
    }
    EXPECT_EQ(meshes, 4);
    EXPECT_GE(hulls, 1);
}

TEST(SceneShape, PicturesOfSolidsAreClosed) {
    // Gauss: the volume under a closed surface's triangles is the solid's, whatever the origin.
    ShapeLibrary shapes;
    std::vector<Vec3> corners;
    for (const Json& point : cube_points(0.2)) {
        corners.emplace_back(point[0].get<double>() + 1.0, point[1].get<double>(),
                             point[2].get<double>());
    }
    const ShapeId cube = shapes.add_hull(corners);
    const std::vector<CompoundChild> children = {{cube, {}, 0}, {shapes.add_box({1, 1, 1}), {}, 0}};
    for (const ShapeId id : {cube, shapes.add_compound(children), shapes.add_cylinder(0.3, 0.5)}) {
        const Shape& shape = shapes.at(id);
        double volume_m3 = 0.0;
        const std::shared_ptr<const Mesh> mesh = make_shape_mesh(shape);
        for (const auto& [a, b, c] : mesh->triangles) {
            volume_m3 += mesh->positions[a].dot(mesh->positions[b].cross(mesh->positions[c])) / 6.0;
        }
        // A cylinder's visual is a prism of 24 sides, smaller by sin(x) / x at x = 2 pi / 24.
        const double share = shape.kind == ShapeKind::cylinder ? 0.98862 : 1.0;
        EXPECT_NEAR(volume_m3, share * mass_properties(shape).volume_m3, 1e-5);
    }
}

}  // namespace
}  // namespace handhold::scene_shape_test
